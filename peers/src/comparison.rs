//! All ways to solve one case, as a problem of pliant's studies.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::Duration;

use pliant::study::{Failed, Line, Measured, Point, Problem};
use pliant::{Error, Inertia, Method, Sampling, Scene, Settings};

use crate::external::{Program, Task};
use crate::implicit;
use pliant_peers::motion::{Clock, ENOUGH, GaveUp, REPETITIONS, Solved, solve};
use pliant_peers::scenes::Case;

/// Times at which motions are compared, evenly from the start (without it) to the end.
const TIMES: usize = 101;
/// Processor time (s) that each of the two methods of the reference may take.
const REFERENCE_LIMIT: f64 = 120.0;

/// How the names of lines with lumped inertia end.
pub const LUMPED: &str = ", lumped";

/// Why a run was not even begun.
pub const TOO_SLOW: &str = "a rougher run took too long";

/// A way to solve a case, at a setting that makes it rough or fine.
#[derive(Debug, Clone)]
pub enum Way {
    /// pliant's own. The setting is rtol.
    Pliant(Method, Option<u32>),
    /// Generalized-alpha with this spectral radius. The setting is the number of steps of the whole motion.
    Implicit(f64),
    /// Another program.
    Program(Program),
}

/// A case with one kind of inertia, all ways to solve it, and its true motion.
pub struct Comparison {
    case: &'static Case,
    inertia: Inertia,
    scene: Scene,
    /// Position of the first component of the node whose error is given in mm.
    tip: usize,
    times: Vec<f64>,
    lines: Vec<Line>,
    ways: Vec<(Way, Vec<f64>)>,
    /// Solvers of the reference.
    references: [Settings; 2],
    folder: PathBuf,
    /// Displacements (m), time by time, and what errors are relative to (m).
    truth: Vec<f64>,
    scale: f64,
    seconds: BTreeMap<(usize, usize), f64>,
    /// Lines that have taken too long.
    slow: BTreeSet<usize>,
    /// Largest error of the tip (m) of each run.
    tips: BTreeMap<(String, String), f64>,
    /// Largest displacement of the tip (m).
    pub amplitude: f64,
}

impl Comparison {
    /// No lines yet. `folder` takes what programs read and write; `references` solve the case for
    /// comparison.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn new(
        case: &'static Case,
        inertia: Inertia,
        references: [Settings; 2],
        folder: PathBuf,
    ) -> Result<Self, Failed> {
        let scene = case.scene(inertia)?;
        let times: Vec<f64> =
            (1..=TIMES).map(|k| scene.end() * (k as f64 / TIMES as f64)).collect();
        let mesh = scene.body().mesh();
        let distance = |node: usize| {
            let x = mesh.position(node);
            (x[0] - case.tip[0]).hypot(x[1] - case.tip[1])
        };
        let nearest = (0..mesh.node_count()).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let folder = crate::external::export(case, &scene, &times, folder)?;
        Ok(Self {
            case,
            inertia,
            tip: 2 * nearest.unwrap_or(0),
            times,
            lines: Vec::new(),
            ways: Vec::new(),
            references,
            folder,
            truth: Vec::new(),
            scale: 1.0,
            seconds: BTreeMap::new(),
            slow: BTreeSet::new(),
            tips: BTreeMap::new(),
            amplitude: 0.0,
            scene,
        })
    }

    /// Adds a line.
    pub fn line(&mut self, name: &str, family: &str, way: Way, settings: &[f64]) {
        let name = match self.inertia {
            Inertia::Consistent => name.into(),
            Inertia::Lumped => format!("{name}{LUMPED}"),
        };
        let point = |&setting: &f64| Point { name: format!("{setting:e}"), rtol: setting };
        let points = settings.iter().map(point).collect();
        self.lines.push(Line { name, family: family.into(), points });
        self.ways.push((way, settings.to_vec()));
    }

    /// Largest error of the tip (m) of each run, by the names of line and point.
    pub fn tips(&self) -> &BTreeMap<(String, String), f64> {
        &self.tips
    }

    fn pliant(&self, solver: &Settings, limit: f64) -> Result<Solved, GaveUp> {
        let clock = Clock::new(limit);
        let patience = |_: &pliant::simulate::Progress| match clock.check() {
            Ok(()) => std::ops::ControlFlow::Continue(()),
            Err(_) => std::ops::ControlFlow::Break(()),
        };
        let sampling = Sampling::at(self.times.clone());
        let trajectory = self.scene.simulate_with(solver, &sampling, patience);
        // so that an interruption says whose
        clock.check()?;
        let (trajectory, seconds) = (trajectory?, clock.seconds());
        let apart = 2e-9 * self.scene.end();
        let mut u = Vec::with_capacity(TIMES * self.scene.body().dofs());
        let mut samples = trajectory.samples().iter().peekable();
        for time in &self.times {
            while samples.next_if(|sample| sample.time < time - apart).is_some() {}
            u.extend_from_slice(samples.peek().map_or(&[], |sample| &sample.u));
        }
        let report = trajectory.report();
        Ok(Solved {
            u,
            seconds,
            steps: report.steps(),
            evaluations: report.evaluations(),
            factorizations: report.factorizations(),
        })
    }

    fn solve(&self, way: &Way, setting: f64, limit: f64) -> Result<Solved, GaveUp> {
        let scene = &self.scene;
        let size = scene.body().mesh().size();
        match way {
            Way::Pliant(method, max_order) => {
                let (method, max_order) = (*method, *max_order);
                let solver = Settings { method, max_order, rtol: setting, ..Settings::default() };
                self.pliant(&solver, limit)
            }
            Way::Implicit(rho) => solve(scene, &self.times, limit, |stage, span| {
                let steps = (setting * (span.to - span.from) / scene.end()).ceil() as usize;
                implicit::integrate(stage, span, *rho, steps, size)
            }),
            Way::Program(program) => program.solve(&Task {
                case: self.case,
                inertia: self.inertia,
                setting,
                folder: &self.folder,
                times: TIMES,
                dofs: scene.body().dofs(),
                limit,
            }),
        }
    }

    /// Root mean square and largest distance (m) from `u` over nodes and times, and largest of the tip.
    fn distance(&self, truth: &[f64], u: &[f64]) -> [f64; 3] {
        let dofs = self.scene.body().dofs();
        let (mut sum, mut largest, mut tip) = (0.0, 0.0_f64, 0.0_f64);
        for (k, (a, b)) in truth.as_chunks::<2>().0.iter().zip(u.as_chunks::<2>().0).enumerate() {
            let distance = (a[0] - b[0]).hypot(a[1] - b[1]);
            sum += distance * distance;
            largest = largest.max(distance);
            if 2 * k % dofs == self.tip {
                tip = tip.max(distance);
            }
        }
        [(sum / (0.5 * truth.len() as f64)).sqrt(), largest, tip]
    }
}

impl Problem for Comparison {
    fn title(&self) -> &str {
        self.case.title
    }

    fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn fingerprint(&self, line: usize, point: usize) -> u64 {
        (1000 * line + point) as u64
    }

    fn prepare(&mut self, _limit: Duration, tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        let mut motions = Vec::new();
        for solver in &self.references {
            tell(&format!("reference: {} at rtol {:e}", solver.method, solver.rtol));
            let solved = self.pliant(solver, REFERENCE_LIMIT);
            let solved = solved.map_err(|failure| Error::Reference {
                rtol: solver.rtol,
                failures: failure.to_string(),
                help: "allow more time".into(),
            })?;
            tell(&format!("reference: {:.1} s", solved.seconds));
            motions.push(solved.u);
        }
        let rest = vec![0.0; motions[0].len()];
        [self.scale, _, self.amplitude] = self.distance(&rest, &motions[0]);
        let resolution = self.distance(&motions[0], &motions[1])[0] / self.scale;
        self.truth = motions.swap_remove(0);
        Ok(resolution)
    }

    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        if self.slow.contains(&line) {
            return Err(TOO_SLOW.into());
        }
        let (way, settings) = &self.ways[line];
        let mut solved = match self.solve(way, settings[point], limit.as_secs_f64()) {
            Ok(solved) => solved,
            Err(failure) => {
                // what is finer takes no less
                if failure.is_timeout() {
                    self.slow.insert(line);
                }
                return Err(failure.into());
            }
        };
        if !matches!(way, Way::Program(_)) {
            // programs repeat themselves
            let mut seconds = vec![solved.seconds];
            while seconds.len() < REPETITIONS && seconds.iter().sum::<f64>() < ENOUGH {
                seconds.push(self.solve(way, settings[point], f64::INFINITY)?.seconds);
            }
            solved.seconds = seconds.into_iter().fold(f64::INFINITY, f64::min);
        }
        let [error, largest, tip] = self.distance(&self.truth, &solved.u);
        let (name, setting) = (&self.lines[line].name, &self.lines[line].points[point].name);
        self.seconds.insert((line, point), solved.seconds);
        self.tips.insert((name.clone(), setting.clone()), tip);
        Ok(Measured {
            error: error / self.scale,
            largest_error: largest / self.scale,
            seconds: solved.seconds,
            states: 2 * self.scene.body().dofs(),
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
