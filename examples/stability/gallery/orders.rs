//! BDF near the imaginary axis: lightly damped vibrations and the order of the method.

use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use pliant::output::Chart;
use pliant::samples::{ClampedBeam, FLAG_MATERIAL};
use pliant::sundials::{Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver};
use pliant::{
    Body, Cells, Error, InputError, Material, Mesh, Method, Sampling, Scene, Settings, Strain,
    Trajectory,
};

use super::Outcome;
use super::heat::{Cell, heat_map};
use super::linear::{Dense, Linear};
use super::page::{Page, count, few, percent};

/// Damping ratios below which a vibration may lie in the instability of BDF of order 3, 4, 5: the
/// cosines of 86.03, 73.35 and 51.84 degrees (E. Hairer, G. Wanner, "Solving Ordinary Differential
/// Equations II", section V.2).
pub const CRITICAL: [f64; 3] = [0.0692, 0.2865, 0.6180];

/// The clamped beam under sudden gravity, `nodes` along and across, with this damping ratio of its
/// lowest vibration; those of the others are larger in proportion to their frequencies.
pub fn beam(nodes: [usize; 2], damping_ratio: f64, until: f64) -> Result<Scene, InputError> {
    let undamped = ClampedBeam { nodes, until, ..ClampedBeam::default() };
    let omega = undamped.scene()?.spectrum()?[0].lowest_frequency.unwrap_or(f64::NAN);
    let viscosity = 2.0 * damping_ratio * FLAG_MATERIAL.young / omega;
    ClampedBeam { viscosity, ..undamped }.scene()
}

/// A run, held against a reference.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    /// Steps until the end, or until it gave up.
    pub steps: usize,
    /// Largest error of a displacement, as a part of the largest displacement.
    pub error: f64,
    /// Largest rise of the energy balance, as a part of the largest energy.
    pub created: f64,
    /// Time at which it came to its end, or gave up (s).
    pub time: f64,
}

fn settings(method: Method, max_order: Option<u32>, rtol: f64, max_steps: usize) -> Settings {
    Settings { method, max_order, rtol, max_steps, ..Settings::default() }
}

/// Reference solution: diagonally implicit Runge-Kutta, at a thousandth of the tolerance of the others.
pub fn reference(scene: &Scene, rtol: f64) -> Result<Trajectory, Error> {
    scene.simulate(&settings(Method::Arkode, None, 1e-3 * rtol, 10_000_000), &Sampling::every(0.05))
}

/// BDF with its order capped, no more than `max_steps`.
pub fn bdf(
    scene: &Scene,
    order: u32,
    rtol: f64,
    max_steps: usize,
    reference: &Trajectory,
) -> Result<Run, Error> {
    let settings = settings(Method::CvodeBdf, Some(order), rtol, max_steps);
    let motion = match scene.simulate(&settings, &Sampling::every(0.05)) {
        Ok(motion) => motion,
        Err(Error::Integration(end)) => end.trajectory,
        Err(other) => return Err(other),
    };
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for (sample, exact) in motion.samples().iter().zip(reference.samples()) {
        // a run that gave up ends with a sample at a time of its own
        if sample.time == exact.time {
            for (u, exact) in sample.u.iter().zip(&exact.u) {
                error = error.max((u - exact).abs());
            }
        }
    }
    for u in reference.samples().iter().flat_map(|sample| &sample.u) {
        largest = largest.max(u.abs());
    }
    let report = motion.report();
    let created = report.energy_created / report.energy_scale;
    Ok(Run { steps: report.steps(), error: error / largest, created, time: motion.last().time })
}

/// The beam with linear forces, and its displacements and velocities when it is let go from the
/// shape that gravity gives it: the same motion, for options that scenes do not have.
pub struct LinearBeam {
    system: Linear,
    start: Vec<f64>,
}

impl LinearBeam {
    /// Of rectangles, `nodes` along and across.
    pub fn new([along, across]: [usize; 2], damping_ratio: f64) -> Outcome<Self> {
        let build = |viscosity| -> Result<Linear, Error> {
            let mesh = Mesh::rectangle([0.35, 0.02], [along, across], Cells::Rectangles)?;
            let held = mesh.select(&"left".into())?;
            let body = Body::new(mesh, Material { viscosity, ..FLAG_MATERIAL })
                .strain(Strain::Cauchy)
                .thickness(1.0);
            Ok(Linear::new(&body.build()?, &held))
        };
        let lowest = build(0.0)?.lowest_frequency()?;
        let system = build(2.0 * damping_ratio * FLAG_MATERIAL.young / lowest)?;
        let n = system.size();
        let weight: Vec<f64> = (0..n)
            .map(|i| (1..n).step_by(2).map(|j| -2.0 * system.inertia[(i, j)]).sum())
            .collect();
        let sag = PartialPivLu::new(system.stiffness.as_ref())
            .solve(Mat::from_fn(n, 1, |i, _| weight[i]));
        let start = (0..2 * n).map(|i| if i < n { sag[(i, 0)] } else { 0.0 }).collect();
        Ok(Self { system, start })
    }

    /// Steps and relative error of displacements after a second. `None`: it gave up.
    pub fn bdf(
        &self,
        order: u32,
        detection: bool,
        rtol: f64,
    ) -> Outcome<Option<(usize, f64, u64)>> {
        let n = self.system.size();
        let atol: Vec<f64> = (0..2 * n).map(|i| rtol * if i < n { 3.5e-3 } else { 0.4 }).collect();
        let options = CvodeOptions::new(rtol, atol)
            .newton(LinearSolver::Dense(Jacobian::Supplied))
            .max_order(order)
            .stability_limit_detection(detection)
            .max_steps(50_000);
        let system = Dense(self.system.jacobian());
        let mut settings = Cvode::new(system.clone(), 0.0, &self.start, &options)?;
        if settings.solve_to(1.0).is_err() {
            return Ok(None);
        }
        let exact = exponential(&system.0) * Mat::from_fn(2 * n, 1, |i, _| self.start[i]);
        let scale = self.start.iter().take(n).fold(0.0_f64, |most, u| most.max(u.abs()));
        let apart = settings.y().iter().enumerate().take(n).map(|(i, y)| (y - exact[(i, 0)]).abs());
        let statistics = settings.statistics();
        Ok(Some((
            statistics.steps as usize,
            apart.fold(0.0, f64::max) / scale,
            statistics.stability_reductions,
        )))
    }
}

/// exp(J), by Taylor's series of a small part and squaring.
fn exponential(jacobian: &Mat<f64>) -> Mat<f64> {
    let squarings = (jacobian.norm_l2().log2().ceil() as i32 + 2).max(0);
    let (n, part) = (jacobian.nrows(), jacobian * faer::Scale(0.5_f64.powi(squarings)));
    // by Horner's rule; the norm is below 1/4, and 0.25^14/14! below round-off
    let mut sum = Mat::<f64>::identity(n, n);
    for k in (1..=13).rev() {
        sum = Mat::<f64>::identity(n, n) + &part * &sum * faer::Scale(1.0 / f64::from(k));
    }
    (0..squarings).for_each(|_| sum = &sum * &sum);
    sum
}

/// Damping ratios of the map.
const RATIOS: [f64; 7] = [0.0, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1];

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## c. BDF of order 3 to 5 near the imaginary axis");
    page.say(format!(
        "BDF of order 1 and 2 damps every vibration. Order 3, 4 and 5 amplify some of those whose damping \
         ratio is below {}, {} and {}: a lightly damped body has many of them, and error tests notice \
         only when their amplitude is as large as the tolerance.",
        CRITICAL[0], CRITICAL[1], CRITICAL[2]
    ));
    undamped(page)?;
    map(page)?;
    detection(page)?;
    page.say(
        "So order 3 runs away where there is no damping at all, and order 5 crawls; what little damping a body \
         has ends the first and shortens the second. The error of displacements tells little: the energy that \
         is created sits in vibrations of single cells. Stability-limit detection helps a little where damping is next to \
         none, costs steps where there is none, and has nothing to do elsewhere.",
    );
    page.say(
        "**What works:** a cap of 2 below a damping ratio of about 1 %, or a method that is stable there at high \
         order (`arkode`); order 5 above, where it is both cheaper and more precise. `Method::Auto` measures the \
         damping ratio, chooses between them, and goes back if the energy balance shows creation (`tests/scenes/auto.rs`).",
    );
    Ok(())
}

fn undamped(page: &mut Page) -> Outcome<()> {
    let (rtol, limit) = (1e-3, 200_000);
    let scene = beam([36, 3], 0.0, 1.0)?;
    let exact = reference(&scene, rtol)?;
    let mut rows = Vec::new();
    for order in 1..=5 {
        let run = bdf(&scene, order, rtol, limit, &exact)?;
        rows.push([
            count(order as usize),
            count(run.steps),
            few(run.time),
            if run.time < 1.0 { "-".into() } else { few(run.error) },
            percent(run.created),
        ]);
    }
    page.say(format!(
        "**Without damping** a beam of 35 x 2 cm, clamped at one end, swings under sudden gravity for 1 s (36 x 3 \
         nodes, Green strain, 420 unknowns, rtol {rtol:e}, {} steps at most). Error: the largest one of a \
         displacement, as a part of the largest displacement, against `arkode` at rtol 1e-6. Energy created: the largest rise \
         of the energy balance, as a part of the largest energy; the report warns above 1 %.",
        count(limit)
    ));
    page.table(["cap of the order", "steps", "time reached (s)", "error", "energy created"], &rows);
    Ok(())
}

fn map(page: &mut Page) -> Outcome<()> {
    let (rtol, limit) = (1e-3, 20_000);
    let (mut rows, mut cells) = (Vec::new(), Vec::new());
    for ratio in RATIOS {
        let scene = beam([36, 3], ratio, 1.0)?;
        let exact = reference(&scene, rtol)?;
        let (mut row, mut line) = (vec![few(ratio)], Vec::new());
        for order in 1..=5 {
            let run = bdf(&scene, order, rtol, limit, &exact)?;
            let fate = match () {
                () if run.time < 1.0 => "gave up".to_string(),
                () => few(run.error),
            };
            row.push(format!("{} / {fate}", count(run.steps)));
            let is_bad = run.time < 1.0 || run.error > 0.5;
            let second =
                if run.time == 1.0 { format!("error {}", percent(run.error)) } else { fate };
            line.push(Cell { value: run.steps as f64, lines: [count(run.steps), second], is_bad });
        }
        rows.push(<[String; 6]>::try_from(row).map_err(|row| format!("{} cells", row.len()))?);
        cells.push(line);
    }
    page.say(format!(
        "**The map.** The same beam with damping, by the damping ratio of its lowest vibration: steps and \
         error. Runs end after {} steps.",
        count(limit)
    ));
    page.table(["damping ratio", "cap 1", "cap 2", "cap 3", "cap 4", "cap 5"], &rows);
    let svg = heat_map(
        "Steps of BDF for 1 s of a clamped beam, rtol 1e-3 (red frame: wrong or given up)",
        ["cap of the order", "damping ratio of the lowest vibration"],
        &["1", "2", "3", "4", "5"].map(String::from),
        &RATIOS.map(few),
        &cells,
    );
    page.picture("orders-map", "steps over damping ratio and cap of the order", &svg)
}

fn detection(page: &mut Page) -> Outcome<()> {
    let rtol = 1e-4;
    let mut rows = Vec::new();
    let mut lines = [Vec::new(), Vec::new(), Vec::new()];
    for ratio in [0.0, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3] {
        let beam = LinearBeam::new([21, 2], ratio)?;
        let mut row = vec![few(ratio)];
        for (line, (order, detection)) in lines.iter_mut().zip([(2, false), (5, false), (5, true)])
        {
            match beam.bdf(order, detection, rtol)? {
                Some((steps, error, reductions)) => {
                    let reductions = match detection {
                        true => format!(" / {reductions}"),
                        false => String::new(),
                    };
                    row.push(format!("{} / {}{reductions}", count(steps), few(error)));
                    if ratio > 0.0 {
                        line.push((ratio, steps as f64));
                    }
                }
                None => row.push("gave up".into()),
            }
        }
        rows.push(<[String; 4]>::try_from(row).map_err(|row| format!("{} cells", row.len()))?);
    }
    page.say(format!(
        "**Stability-limit detection** (`CVodeSetStabLimDet`, through the general layer) on the same beam \
         with linear forces (21 x 2 nodes, rectangles, let go from its sag, 1 s, rtol {rtol:e}): steps / \
         relative error / reductions of the order that it ordered."
    ));
    page.table(["damping ratio", "cap 2", "cap 5", "cap 5 with detection"], &rows);
    let [two, five, detecting] = lines;
    let chart = Chart::new("Steps for 1 s of the linear beam at rtol 1e-4")
        .axes("damping ratio of the lowest vibration", "steps")
        .logarithmic(true, true)
        .marked("cap 2", two)
        .marked("cap 5", five)
        .marked("cap 5 with detection", detecting);
    page.chart("orders-detection", "stability-limit detection", &chart)
}
