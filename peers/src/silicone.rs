//! A clamped block of rubber or silicone that sags under its weight, in a plane and in space, from Poisson's ratio 0.3 to
//! 0.4999: all kinds of pliant's cells, dolfinx and CalculiX, on the same grids.
//!
//! The error is that of the sag of the middle of the free end. **Reference:** Richardson's extrapolation of `rectangles9` or
//! `hexahedra27` with a linear dilatation on three meshes, with the order that they show; what the two coarser ones say
//! instead is told as its resolution. dolfinx's P2-P1, which shares no code with it, tends to the same.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use pliant::simulate::{Component, Reading};
use pliant::study::{
    Failed, Findings, Line, LineFindings, Measured, Part, Point, Problem, Quantity, Study,
    time_text,
};
use pliant::{
    Body, Cells, Dilatation, Equilibrium, Error, InputError, Material, Mesh, MeshEstimate, Phase,
    Scene, SolidCells, Statics, Strain,
};

use crate::comparison::TOO_SLOW;
use crate::external::Program;
use crate::space::{extrapolated, order};
use crate::{here, report};
use pliant_peers::motion::{Clock, ENOUGH, GaveUp, REPETITIONS, Solved};

/// Size (m): the length, and what is across; in a plane its last is the thickness.
const SIZE: [f64; 3] = [0.1, 0.02, 0.02];
const GRAVITY: f64 = 9.81;
const RATIOS: [f64; 5] = [0.3, 0.45, 0.49, 0.499, 0.4999];
/// Grid cells along, for one across.
const SLENDERNESS: usize = 5;
/// Processor time (s) that a run may take, in full and quickly.
const LIMITS: [f64; 2] = [20.0, 2.0];
/// Errors, as parts of the sag, at which lines are compared.
const ACCURACIES: [f64; 5] = [0.1, 0.05, 0.02, 0.01, 0.005];
/// The accuracy at which Poisson's ratios are compared.
const ACCURACY: f64 = 0.02;

/// Kinds of cells: a name of a scene file.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Plane(Cells),
    Solid(SolidCells),
}

/// pliant's cells, and what keeps them from locking.
#[derive(Debug, Clone, Copy)]
struct Recipe {
    kind: Kind,
    bubbles: bool,
    dilatation: Dilatation,
}

#[derive(Debug, Clone)]
enum Way {
    Pliant(Recipe),
    /// From two cells across, divided time after time where dual-weighted residuals say that the sag is off; all passes count.
    Refined(Recipe),
    Program(Program),
}

/// The block with one Poisson's ratio.
struct Silicone {
    dimension: usize,
    poisson: f64,
    folder: PathBuf,
    title: String,
    lines: Vec<Line>,
    ways: Vec<(Way, &'static [usize])>,
    /// The sag (m) of the reference.
    truth: f64,
    quick: bool,
    seconds: BTreeMap<(usize, usize), f64>,
    /// Lines that have taken too long.
    slow: BTreeSet<usize>,
}

/// # Errors
/// Arguments that are wrong, files that cannot be written.
pub fn run(words: &[String]) -> Result<(), Failed> {
    let (mut quick, mut out, mut dimensions) = (false, PathBuf::from("out"), Vec::new());
    let mut words = words.iter().map(String::as_str);
    while let Some(word) = words.next() {
        match word {
            "--quick" => quick = true,
            "--out" => out = words.next().ok_or("--out needs a folder")?.into(),
            "silicone-plane" => dimensions.push(2),
            "silicone-space" => dimensions.push(3),
            name => {
                let known = "silicone-plane, silicone-space";
                return Err(format!("no case {name}: there are {known}").into());
            }
        }
    }
    if dimensions.is_empty() {
        dimensions = vec![2, 3];
    }
    fs::create_dir_all(&out)?;
    for dimension in dimensions {
        let mut found = Vec::new();
        for &poisson in if quick { &RATIOS[2..3] } else { &RATIOS[..] } {
            let mut silicone = Silicone::new(dimension, poisson, &out, quick);
            let name = silicone.name();
            // patience: a slow peer is told by its limit alone
            let limit = LIMITS[usize::from(quick)];
            let study = Study::new(&mut silicone).repetitions(1).limit(limit).patience(1e6);
            let findings = study.run(&mut |stage| eprintln!("{name}: {stage}"))?;
            findings.write_csv(out.join(format!("{name}.csv")))?;
            for ending in ["svg", "png"] {
                findings.write_chart(out.join(format!("{name}.{ending}")))?;
            }
            found.push((poisson, findings));
        }
        write(&out, dimension, &found)?;
    }
    Ok(())
}

impl Silicone {
    fn new(dimension: usize, poisson: f64, folder: &Path, quick: bool) -> Self {
        let place = ["in a plane", "in space"][dimension - 2];
        let mut silicone = Self {
            dimension,
            poisson,
            folder: folder.into(),
            title: format!("Clamped block {place} under its weight, Poisson's ratio {poisson}"),
            lines: Vec::new(),
            ways: Vec::new(),
            truth: 1.0,
            quick,
            seconds: BTreeMap::new(),
            slow: BTreeSet::new(),
        };
        match dimension {
            2 => silicone.add_lines_in_a_plane(),
            _ => silicone.add_lines_in_space(),
        }
        silicone
    }

    fn name(&self) -> String {
        format!("{}-{}", ["silicone-plane", "silicone-space"][self.dimension - 2], self.poisson)
    }

    fn add_lines_in_a_plane(&mut self) {
        let linear: &[usize] = &[2, 4, 8, 16, 32];
        let quadratic: &[usize] = &[1, 2, 4, 8, 16];
        for (cells, dilatations) in [
            (Cells::Triangles, &[Dilatation::AtPoints][..]),
            (Cells::Crossed, &[Dilatation::AtPoints]),
            (Cells::Rectangles, &[Dilatation::AtPoints, Dilatation::Mean]),
        ] {
            self.pliant(Kind::Plane(cells), dilatations, linear);
        }
        for (cells, dilatations) in [
            (Cells::Triangles6, &[Dilatation::AtPoints, Dilatation::Mean, Dilatation::Linear][..]),
            (Cells::Rectangles9, &[Dilatation::AtPoints, Dilatation::Linear]),
        ] {
            self.pliant(Kind::Plane(cells), dilatations, quadratic);
        }
        self.refined(&[1, 2, 3, 4, 5, 6]);
        self.dolfinx(quadratic);
    }

    fn add_lines_in_space(&mut self) {
        let linear: &[usize] = &[2, 4, 6, 8];
        let quadratic: &[usize] = &[1, 2, 3, 4];
        self.pliant(Kind::Solid(SolidCells::Tetrahedra), &[Dilatation::AtPoints], linear);
        let both = [Dilatation::AtPoints, Dilatation::Mean];
        self.pliant(Kind::Solid(SolidCells::Hexahedra), &both, linear);
        let all = [Dilatation::AtPoints, Dilatation::Mean, Dilatation::Linear];
        self.pliant(Kind::Solid(SolidCells::Tetrahedra10), &all, quadratic);
        self.pliant(Kind::Solid(SolidCells::Hexahedra20), &all, quadratic);
        self.pliant(Kind::Solid(SolidCells::Hexahedra27), &[Dilatation::Linear], quadratic);
        self.dolfinx(quadratic);
        let command = here(&[".venv/bin/python", "calculix/solve.py"]);
        // without a node in the middle of a face
        let even: &[usize] = &[2, 4];
        for (element, meshes) in [("C3D8I", linear), ("C3D20R", even), ("C3D10", quadratic)] {
            let program = Program { command: command.clone(), method: element, patience: 1.0 };
            self.line(format!("CalculiX {element}"), "CalculiX", Way::Program(program), meshes);
        }
    }

    fn pliant(&mut self, kind: Kind, dilatations: &[Dilatation], meshes: &'static [usize]) {
        for &dilatation in dilatations {
            let name = match kind {
                Kind::Plane(cells) => cells.name(),
                Kind::Solid(cells) => cells.name(),
            };
            // triangles and tetrahedra get their bubbles with it
            let bubbles = dilatation == Dilatation::Linear
                && matches!(
                    kind,
                    Kind::Plane(Cells::Triangles6) | Kind::Solid(SolidCells::Tetrahedra10)
                );
            let recipe = Recipe { kind, bubbles, dilatation };
            let more = match dilatation {
                Dilatation::AtPoints => String::new(),
                _ if bubbles => ", bubbles".into(),
                dilatation => format!(", {}", dilatation.name()),
            };
            let family = format!("pliant {}", if bubbles { "bubbles" } else { dilatation.name() });
            self.line(format!("pliant {name}{more}"), &family, Way::Pliant(recipe), meshes);
        }
    }

    fn dolfinx(&mut self, meshes: &'static [usize]) {
        let mut command = vec!["/usr/bin/python3".to_owned()];
        command.extend(here(&["dolfinx/equilibrium.py"]));
        for method in ["P2", "P2-P1", "P2-P0"] {
            let program = Program { command: command.clone(), method, patience: 1.0 };
            self.line(format!("dolfinx {method}"), "dolfinx", Way::Program(program), meshes);
        }
    }

    fn line(&mut self, name: String, family: &str, way: Way, meshes: &'static [usize]) {
        let meshes = if self.quick { &meshes[..3] } else { meshes };
        let unit = if matches!(way, Way::Refined(_)) { "passes" } else { "across" };
        let point =
            |&count: &usize| Point { name: format!("{count} {unit}"), rtol: 1.0 / count as f64 };
        let points = meshes.iter().map(point).collect();
        self.lines.push(Line { name, family: family.into(), points });
        self.ways.push((way, meshes));
    }

    /// Triangles with bubbles, divided in some places.
    fn refined(&mut self, passes: &'static [usize]) {
        let kind = Kind::Plane(Cells::Triangles6);
        let recipe = Recipe { kind, bubbles: true, dilatation: Dilatation::Linear };
        let name = "pliant triangles6, bubbles, refined".to_owned();
        self.line(name, "pliant bubbles", Way::Refined(recipe), passes);
    }

    fn material(&self) -> Material {
        Material { density: 1070.0, young: 5e5, poisson: self.poisson, viscosity: 0.0 }
    }

    fn mesh(kind: Kind, across: usize) -> Result<Mesh, InputError> {
        let [along, across] = [SLENDERNESS * across + 1, across + 1];
        match kind {
            Kind::Plane(cells) => Mesh::rectangle([SIZE[0], SIZE[1]], [along, across], cells),
            Kind::Solid(cells) => Mesh::cuboid(SIZE, [along, across, across], cells),
        }
    }

    fn on(&self, mesh: Mesh, recipe: Recipe) -> Result<Scene, InputError> {
        let mesh = if recipe.bubbles { mesh.with_bubbles()? } else { mesh };
        let body = Body::new(mesh, self.material()).strain(Strain::Green);
        let body = body.dilatation(recipe.dilatation);
        let body = if self.dimension == 2 { body.thickness(SIZE[2]) } else { body };
        let down = [[0.0, -GRAVITY, 0.0], [0.0, 0.0, -GRAVITY]][self.dimension - 2];
        Ok(Scene::new(body.build()?)
            .gravity(&down[..self.dimension])
            .phase(Phase::until(1.0).named("sags").hold("left")))
    }

    /// The sag of the middle of the free end, and the number of unknowns.
    fn by_pliant(&self, recipe: Recipe, across: usize) -> Result<(Solved, usize), GaveUp> {
        let clock = Clock::new(f64::INFINITY);
        let scene = self.on(Self::mesh(recipe.kind, across)?, recipe)?;
        let equilibrium = scene.equilibrium(&Statics::default())?;
        let sag = self.sag(scene.body().mesh(), &equilibrium);
        let seconds = clock.seconds();
        Ok((Solved { u: vec![sag], seconds, ..Solved::default() }, scene.body().dofs()))
    }

    /// The same on a mesh that is divided so many times where it helps.
    fn by_refinement(
        &self,
        recipe: Recipe,
        passes: usize,
        limit: f64,
    ) -> Result<(Solved, usize), GaveUp> {
        let clock = Clock::new(limit);
        let mesh = Self::mesh(recipe.kind, 2)?;
        let tip = Self::tip(&mesh);
        let mut mesh = mesh.name_nodes("tip", tip)?;
        let axis = [Component::Y, Component::Z][self.dimension - 2];
        let reading = Reading::displacement("tip").component(axis);
        let quantity = Quantity::reading("sag", reading).part(Part::End);
        for _ in 0..passes {
            let equilibrium = self.on(mesh.clone(), recipe)?.equilibrium(&Statics::default())?;
            clock.check()?;
            let estimate = MeshEstimate::of(&equilibrium, &quantity)?;
            mesh = mesh.halved_in(&estimate.worst_cells())?;
        }
        let scene = self.on(mesh, recipe)?;
        let equilibrium = scene.equilibrium(&Statics::default())?;
        let sag = self.sag(scene.body().mesh(), &equilibrium);
        let seconds = clock.seconds();
        clock.check()?;
        Ok((Solved { u: vec![sag], seconds, ..Solved::default() }, scene.body().dofs()))
    }

    /// The middle of the free end, or the nodes around it: numbers from 1.
    fn tip(mesh: &Mesh) -> Vec<usize> {
        let tip = [SIZE[0], 0.5 * SIZE[1], 0.5 * SIZE[2]];
        let distance = |node: usize| {
            mesh.position(node).iter().zip(tip).map(|(x, tip)| (x - tip).powi(2)).sum::<f64>()
        };
        let nodes = 0..mesh.node_count();
        let least = nodes.clone().map(distance).fold(f64::INFINITY, f64::min);
        let near = nodes.filter(|&node| distance(node) <= least * (1.0 + 1e-9) + 1e-18);
        near.map(|node| node + 1).collect()
    }

    fn sag(&self, mesh: &Mesh, equilibrium: &Equilibrium) -> f64 {
        let tip = Self::tip(mesh);
        let sag = |number: &usize| equilibrium.displacements()[self.dimension * number - 1];
        tip.iter().map(sag).sum::<f64>() / tip.len() as f64
    }

    fn solve(&self, way: &Way, across: usize, limit: f64) -> Result<(Solved, usize), GaveUp> {
        let program = match way {
            Way::Pliant(recipe) => return self.by_pliant(*recipe, across),
            Way::Refined(recipe) => return self.by_refinement(*recipe, across, limit),
            Way::Program(program) => program,
        };
        let cells = [SLENDERNESS * across, across, across].map(|count| count as f64);
        let Material { density, young, poisson, .. } = self.material();
        let mut numbers = Vec::new();
        if program.method.starts_with('P') {
            let elastic = self.material().elastic();
            numbers.push(self.dimension as f64);
            numbers.extend(&cells[..self.dimension]);
            numbers.extend(&SIZE[..self.dimension]);
            numbers.extend([density * GRAVITY, elastic.lambda, elastic.mu]);
        } else {
            numbers.extend(cells);
            numbers.push(0.0);
            numbers.extend(SIZE);
            numbers.extend([1.0, density, GRAVITY, young, poisson]);
        }
        let words: Vec<String> = [program.method.to_owned()]
            .into_iter()
            .chain(numbers.iter().map(f64::to_string))
            .collect();
        let out = self.folder.join("silicone-tip");
        let mut solved = program.call(words.iter().map(OsStr::new), &out, self.dimension, limit)?;
        solved.u = solved.u.last().copied().into_iter().collect();
        let unknowns = solved.steps;
        Ok((solved, unknowns))
    }
}

impl Problem for Silicone {
    fn title(&self) -> &str {
        &self.title
    }

    fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn fingerprint(&self, line: usize, point: usize) -> u64 {
        (1000 * line + point) as u64
    }

    fn prepare(&mut self, _limit: Duration, tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        let (kind, meshes) = match (self.dimension, self.quick) {
            (2, true) => (Kind::Plane(Cells::Rectangles9), [4, 8, 16]),
            (2, false) => (Kind::Plane(Cells::Rectangles9), [16, 32, 64]),
            (_, true) => (Kind::Solid(SolidCells::Hexahedra27), [2, 3, 4]),
            (_, false) => (Kind::Solid(SolidCells::Hexahedra27), [3, 4, 6]),
        };
        let recipe = Recipe { kind, bubbles: false, dilatation: Dilatation::Linear };
        let mut sags = [0.0; 3];
        for (sag, across) in sags.iter_mut().zip(meshes) {
            tell(&format!("reference: {across} cells across"));
            *sag = match self.by_pliant(recipe, across) {
                Ok((solved, _)) => solved.u[0],
                Err(failure) => {
                    let failures = failure.to_string();
                    return Err(Error::Reference { rtol: 0.0, failures, help: "none".into() });
                }
            };
        }
        let m = meshes.map(|across| across as f64);
        let [a, b, c] = sags;
        let p = order(m, (b - a) / (c - b));
        let coarser = extrapolated(p, [m[0], m[1]], &[a], &[b])[0];
        self.truth = extrapolated(p, [m[1], m[2]], &[b], &[c])[0];
        tell(&format!("reference: order {p:.2} of the mesh, sag {:.6e} m", self.truth));
        // where the order is that of all three meshes, the two agree; what is left is the finest mesh's own error
        let resolution = (coarser - self.truth).abs().max(0.1 * (c - self.truth).abs());
        Ok(resolution / self.truth.abs())
    }

    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        if self.slow.contains(&line) {
            return Err(TOO_SLOW.into());
        }
        let (way, meshes) = &self.ways[line];
        let across = meshes[point];
        let (solved, unknowns) = match self.solve(way, across, limit.as_secs_f64()) {
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
        // to start an interpreter takes longer than most of its runs
        let most = if matches!(way, Way::Program(_)) { 2 } else { REPETITIONS };
        while seconds.len() < most && seconds.iter().sum::<f64>() < ENOUGH {
            seconds.push(self.solve(way, across, f64::INFINITY)?.0.seconds);
        }
        let seconds = seconds.into_iter().fold(f64::INFINITY, f64::min);
        if seconds > limit.as_secs_f64() {
            self.slow.insert(line);
        }
        self.seconds.insert((line, point), seconds);
        let error = (solved.u[0] / self.truth - 1.0).abs();
        Ok(Measured {
            error,
            largest_error: error,
            seconds,
            // positions and velocities, as studies count
            states: 2 * unknowns,
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

fn write(out: &Path, dimension: usize, found: &[(f64, Findings)]) -> Result<(), Failed> {
    let name = ["silicone-plane", "silicone-space"][dimension - 2];
    let place = ["in a plane", "in space"][dimension - 2];
    let mut page = format!(
        "## Clamped block {place} under its weight, Poisson's ratio 0.3 to 0.4999\n\n\
         Processor time (s) to reach an error of the sag of {} %:\n\n| line |",
        1e2 * ACCURACY
    );
    for (poisson, _) in found {
        write!(page, " {poisson} |")?;
    }
    write!(page, "\n| --- |{}", " --- |".repeat(found.len()))?;
    let lines: Vec<&LineFindings> =
        found.first().map(|(_, first)| first.lines().iter().collect()).unwrap_or_default();
    for (number, line) in lines.iter().enumerate() {
        write!(page, "\n| {} |", line.name)?;
        for (_, findings) in found {
            match findings.lines()[number].time_to_reach(ACCURACY) {
                Some(time) => write!(page, " {} |", time_text(time))?,
                None => page += " |",
            }
        }
    }
    page += "\n";
    for (poisson, findings) in found {
        writeln!(page, "\n### Poisson's ratio {poisson}\n\n![chart]({name}-{poisson}.png)\n")?;
        page += "Processor time (s) to reach an error of the sag, and times as long as the fastest of pliant:\n\n";
        let lines: Vec<_> = findings.lines().iter().collect();
        let label = |error: f64| format!("{} %", (1e3 * error).round() / 10.0);
        page += &report::ranking(&lines, &ACCURACIES, label, time_text, |line, error| {
            line.time_to_reach(error)
        })?;
        page += "\n| line | cells across | error | unknowns | time, s |\n| --- | --- | --- | --- | --- |\n";
        for row in findings.rows() {
            let Some(error) = row.error else { continue };
            let unknowns = row.states.map_or(0, |states| states / 2);
            writeln!(
                page,
                "| {} | {} | {:.2} % | {unknowns} | {:.3} |",
                row.line,
                row.point,
                1e2 * error,
                row.seconds,
            )?;
        }
        page += "\n";
        for note in findings.notes().iter().filter(|note| !note.ends_with(TOO_SLOW)) {
            writeln!(page, "- {note}")?;
        }
    }
    fs::write(out.join(format!("{name}.md")), &page)?;
    println!("{page}");
    Ok(())
}
