//! All ways to solve one block, as a problem of pliant's studies.
//!
//! The error is the distance of the tip, the middle of the free end, from where the reference has it: root mean square over
//! 101 times, relative to its motion.
//!
//! **Reference.** Richardson's extrapolation of pliant's 10-node tetrahedra on three meshes, with the order that they
//! show among themselves, and a correction in time: the difference that a finer tolerance makes on the coarsest of them. What
//! the extrapolation from the two coarser meshes says instead is told as its resolution.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use pliant::study::{Failed, Line, Measured, Point, Problem};
use pliant::{Error, Lame, Method, Sampling, Settings, SolidCells};

use super::{Block, END, GRAVITY, SIZE};
use crate::comparison::TOO_SLOW;
use crate::external::Program;
use pliant_peers::motion::{Clock, ENOUGH, GaveUp, REPETITIONS, Solved};

const TIMES: usize = 101;
/// Meshes of the reference, and its tolerances, the second on the first mesh alone; in full and quickly.
const REFERENCES: [([usize; 3], [f64; 2]); 2] =
    [([2, 3, 4], [1e-4, 1e-6]), ([1, 2, 3], [1e-3, 1e-5])];
/// Processor time (s) that each run of the reference may take.
const REFERENCE_LIMIT: f64 = 300.0;

/// A way to solve a block.
#[derive(Debug, Clone)]
pub enum Way {
    /// pliant's automatic choice on these cells. The setting is rtol.
    Pliant(SolidCells),
    /// Another program. The setting is the number of steps.
    Program(Program),
}

/// How fine a run is.
#[derive(Debug, Clone, Copy)]
pub struct Fineness {
    /// Grid cells across the block.
    pub across: usize,
    pub setting: f64,
}

/// A block, all ways to solve it, and the true motion of its tip.
pub struct Space<'a> {
    block: &'a Block,
    quick: bool,
    folder: PathBuf,
    lines: Vec<Line>,
    ways: Vec<(Way, Vec<Fineness>)>,
    /// Displacements (m) of the tip, time by time, and their root mean square.
    truth: Vec<f64>,
    scale: f64,
    seconds: BTreeMap<(usize, usize), f64>,
    /// Lines that have taken too long.
    slow: BTreeSet<usize>,
}

impl<'a> Space<'a> {
    /// No lines yet; `folder` takes what programs write.
    pub fn new(block: &'a Block, folder: &Path, quick: bool) -> Self {
        Self {
            block,
            quick,
            folder: folder.into(),
            lines: Vec::new(),
            ways: Vec::new(),
            truth: Vec::new(),
            scale: 1.0,
            seconds: BTreeMap::new(),
            slow: BTreeSet::new(),
        }
    }

    pub fn line(&mut self, name: &str, family: &str, way: Way, finenesses: Vec<Fineness>) {
        let point = |fineness: &Fineness| {
            let Fineness { across, setting } = fineness;
            Point { name: format!("{across}, {setting}"), rtol: 1.0 / *across as f64 }
        };
        let points = finenesses.iter().map(point).collect();
        self.lines.push(Line { name: name.into(), family: family.into(), points });
        self.ways.push((way, finenesses));
    }

    /// The motion of the tip by pliant, and the number of its states.
    fn pliant(
        &self,
        cells: SolidCells,
        across: usize,
        settings: &Settings,
        limit: f64,
    ) -> Result<(Solved, usize), GaveUp> {
        let scene = self.block.scene(cells, across)?;
        let mesh = scene.body().mesh();
        let tip = [SIZE[0], 0.5 * SIZE[1], 0.5 * SIZE[2]];
        let distance = |node: usize| {
            let x = mesh.position(node);
            (0..3).map(|i| (x[i] - tip[i]).powi(2)).sum::<f64>()
        };
        let nearest = (0..mesh.node_count()).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let tip = 3 * nearest.unwrap_or(0);
        let times: Vec<f64> = (1..=TIMES).map(|k| END * (k as f64 / TIMES as f64)).collect();
        let clock = Clock::new(limit);
        let patience = |_: &pliant::simulate::Progress| match clock.check() {
            Ok(()) => std::ops::ControlFlow::Continue(()),
            Err(_) => std::ops::ControlFlow::Break(()),
        };
        let trajectory = scene.simulate_with(settings, &Sampling::at(times), patience);
        clock.check()?;
        let (trajectory, seconds) = (trajectory?, clock.seconds());
        // the first sample is the start
        let samples = trajectory.samples().iter().skip(1).take(TIMES);
        let report = trajectory.report();
        let solved = Solved {
            u: samples.flat_map(|sample| sample.u[tip..tip + 3].to_vec()).collect(),
            seconds,
            steps: report.steps(),
            evaluations: report.evaluations(),
            factorizations: report.factorizations(),
        };
        Ok((solved, 2 * scene.body().dofs()))
    }

    fn solve(&self, way: &Way, fineness: Fineness, limit: f64) -> Result<(Solved, usize), GaveUp> {
        let Fineness { across, setting } = fineness;
        match way {
            Way::Pliant(cells) => {
                let settings = Settings { rtol: setting, ..Settings::default() };
                self.pliant(*cells, across, &settings, limit)
            }
            Way::Program(program) => {
                let pair = |Lame { lambda, mu }| [lambda, mu];
                let material = &self.block.material;
                let cells = [3 * across, across, across].map(|count| count as f64);
                let mut numbers = cells.to_vec();
                numbers.push(setting);
                numbers.extend(SIZE);
                numbers.extend([END, material.density, GRAVITY]);
                match program.method.starts_with('P') {
                    true => {
                        numbers.extend(pair(material.elastic()));
                        numbers.extend(pair(material.viscous()));
                    }
                    false => numbers.extend([material.young, material.poisson]),
                }
                let words: Vec<String> = [program.method.to_owned()]
                    .into_iter()
                    .chain(numbers.iter().map(f64::to_string))
                    .collect();
                let out = self.folder.join(format!("{}-tip", self.block.name));
                let solved = program.call(words.iter().map(OsStr::new), &out, 3 * TIMES, limit)?;
                Ok((solved, 0))
            }
        }
    }
}

/// Root mean square and largest distance of two motions of a point.
fn distance(a: &[f64], b: &[f64]) -> [f64; 2] {
    let squares = a
        .as_chunks::<3>()
        .0
        .iter()
        .zip(b.as_chunks::<3>().0)
        .map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>());
    let (sum, largest) = squares.fold((0.0, 0.0_f64), |(sum, most), x| (sum + x, most.max(x)));
    [(sum / (a.len() / 3) as f64).sqrt(), largest.sqrt()]
}

/// The order p at which the differences of three meshes fall as m^-p: (m0^-p - m1^-p) / (m1^-p - m2^-p) = `ratio`, by bisection.
pub fn order(meshes: [f64; 3], ratio: f64) -> f64 {
    let of = |p: f64| {
        let [a, b, c] = meshes.map(|m| m.powf(-p));
        (a - b) / (b - c)
    };
    let [mut low, mut high] = [0.5, 6.0];
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if of(middle) < ratio { low = middle } else { high = middle }
    }
    low
}

/// What the motions on two meshes tend to, by order p.
pub fn extrapolated(p: f64, [coarse, fine]: [f64; 2], a: &[f64], b: &[f64]) -> Vec<f64> {
    let factor = 1.0 / ((fine / coarse).powf(p) - 1.0);
    a.iter().zip(b).map(|(a, b)| b + factor * (b - a)).collect()
}

impl Problem for Space<'_> {
    fn title(&self) -> &str {
        self.block.title
    }

    fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn fingerprint(&self, line: usize, point: usize) -> u64 {
        (1000 * line + point) as u64
    }

    fn prepare(&mut self, _limit: Duration, tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        let (meshes, rtols) = REFERENCES[usize::from(self.quick)];
        let method = match self.block.material.viscosity > 0.0 {
            true => Method::CvodeBdf,
            false => Method::Arkode,
        };
        let mut motion = |across: usize, rtol: f64| {
            tell(&format!("reference: {method} at rtol {rtol:e}, {across} cells across"));
            let settings = Settings { method, rtol, ..Settings::default() };
            let cells = SolidCells::Tetrahedra10;
            match self.pliant(cells, across, &settings, REFERENCE_LIMIT) {
                Ok((solved, _)) => Ok(solved.u),
                Err(failure) => Err(Error::Reference {
                    rtol,
                    failures: failure.to_string(),
                    help: "allow more time".into(),
                }),
            }
        };
        let [a, b, c] = [
            motion(meshes[0], rtols[0])?,
            motion(meshes[1], rtols[0])?,
            motion(meshes[2], rtols[0])?,
        ];
        let fine = motion(meshes[0], rtols[1])?;
        let m = meshes.map(|across| across as f64);
        let p = order(m, distance(&a, &b)[0] / distance(&b, &c)[0]);
        tell(&format!("reference: order {p:.2} of the mesh"));
        let coarser = extrapolated(p, [m[0], m[1]], &a, &b);
        let finer = extrapolated(p, [m[1], m[2]], &b, &c);
        let rest = vec![0.0; finer.len()];
        self.scale = distance(&finer, &rest)[0];
        let in_time = fine.iter().zip(&a).map(|(fine, a)| fine - a);
        self.truth = finer.iter().zip(in_time).map(|(u, more)| u + more).collect();
        Ok(distance(&coarser, &finer)[0] / self.scale)
    }

    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        if self.slow.contains(&line) {
            return Err(TOO_SLOW.into());
        }
        let (way, finenesses) = &self.ways[line];
        let (mut solved, states) = match self.solve(way, finenesses[point], limit.as_secs_f64()) {
            Ok(solved) => solved,
            Err(failure) => {
                // what is finer takes no less
                if failure.is_timeout() {
                    self.slow.insert(line);
                }
                return Err(failure.into());
            }
        };
        let mut seconds = vec![solved.seconds];
        while seconds.len() < REPETITIONS && seconds.iter().sum::<f64>() < ENOUGH {
            seconds.push(self.solve(way, finenesses[point], f64::INFINITY)?.0.seconds);
        }
        solved.seconds = seconds.into_iter().fold(f64::INFINITY, f64::min);
        let [error, largest] = distance(&self.truth, &solved.u);
        self.seconds.insert((line, point), solved.seconds);
        Ok(Measured {
            error: error / self.scale,
            largest_error: largest / self.scale,
            seconds: solved.seconds,
            states,
            steps: solved.steps,
            evaluations: solved.evaluations,
            factorizations: solved.factorizations,
            energy_error: None,
        })
    }

    fn time(&mut self, line: usize, point: usize) -> Result<f64, Failed> {
        self.seconds.get(&(line, point)).copied().ok_or_else(|| "it was not measured".into())
    }
}
