//! Large steps over short pulses and over changes of phase.

use pliant::ode::Failure;
use pliant::output::Chart;
use pliant::samples::BEAM_MATERIAL;
use pliant::sundials::{Cvode, CvodeOptions, Integrator};
use pliant::{Body, Error, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Strain};

use super::Outcome;
use super::page::{Page, few};

/// Time at which the pulse begins (s), its impulse (N s), and the end of the run (s).
pub const BEGIN: f64 = 1.0;
pub const IMPULSE: f64 = 0.01;
const END: f64 = 2.0;

/// The force of a pulse of some width (s): up within a quarter, on for half, down within a quarter.
fn pulse(width: f64) -> ([f64; 4], [f64; 4]) {
    let top = IMPULSE / (0.75 * width);
    let times = [0.0, 0.25, 0.75, 1.0].map(|part| BEGIN + part * width);
    (times, [0.0, top, top, 0.0])
}

fn pulse_at(width: f64) -> impl Fn(f64) -> f64 {
    let (times, forces) = pulse(width);
    move |t| {
        let part =
            ((t - times[0]) / (times[1] - times[0])).min((times[3] - t) / (times[3] - times[2]));
        forces[1] * part.clamp(0.0, 1.0)
    }
}

/// A free bar that gets a pulse on one end.
#[derive(Debug, Clone, Copy)]
pub struct Pulse {
    /// Its width (s).
    pub width: f64,
    /// Whether the scene has it as a table, whose points end steps, or as a function of time.
    pub told: bool,
    /// Whether the bar vibrates before, so that steps are short, or rests.
    pub vibrates: bool,
}

impl Pulse {
    /// Momentum of the bar afterwards, over the impulse: 1.
    pub fn momentum(self, method: Method, rtol: f64) -> Result<f64, Error> {
        let Self { width, told, vibrates } = self;
        let material = Material {
            viscosity: if vibrates { 0.0 } else { BEAM_MATERIAL.viscosity },
            ..BEAM_MATERIAL
        };
        let body =
            Body::new(Mesh::bar(0.1, 6)?, material).strain(Strain::Cauchy).area(2e-4).build()?;
        let (times, forces) = pulse(width);
        let force = pulse_at(width);
        let phase = Phase::until(END);
        let phase = match told {
            true => phase.load_table("left", times, forces.map(|force| [force])),
            false => phase.load_with("left", move |t| [force(t)]),
        };
        let settings = Settings { method, rtol, ..Settings::default() };
        let speed = if vibrates { 0.1 } else { 0.0 };
        let scene = Scene::new(body).initial_velocity(|x| vec![speed * (20.0 * x[0] - 1.0)]);
        let motion = scene.phase(phase).simulate(&settings, &Sampling::phase_ends())?;
        Ok(motion.momentum(motion.last())[0] / IMPULSE)
    }
}

/// The same of a point mass through the general layer: CVODE with stop times at the points of the
/// table, or without.
pub fn general(width: f64, told: bool, rtol: f64) -> Outcome<f64> {
    let force = pulse_at(width);
    let mass = 0.02;
    let system = move |t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], force(t) / mass]);
        Ok::<(), Failure>(())
    };
    let mut settings = Cvode::new(system, 0.0, &[0.0; 2], &CvodeOptions::new(rtol, rtol))?;
    let breaks = pulse(width).0;
    for stop in breaks.into_iter().filter(|_| told) {
        settings.set_stop_time(Some(stop))?;
        while settings.t() < stop {
            settings.step(stop)?;
        }
        // the law changes here: what was learnt of it does not count any more
        let y = settings.y().to_vec();
        settings.reinit(stop, &y)?;
    }
    settings.solve_to(END)?;
    Ok(mass * settings.y()[1] / IMPULSE)
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## i. Large steps over phases and pulses");
    let (rtol, methods) =
        (1e-5, [Method::CvodeBdf, Method::CvodeAdams, Method::Ida, Method::Arkode, Method::Rk]);
    page.say(format!(
        "A bar floats; at t = {BEGIN} s one end gets a pulse of {IMPULSE} N s, as a function of time \
         (`load_with`) or as a table (`load_table`). If nothing happened until then, steps would be as long as they \
         may, and one of them would pass the pulse: no stage or iterate would lie within it, and the error estimate be 0. \
         Steps are therefore no longer than the time in which what acts is a polynomial of degree 4, to a tolerance; \
         functions are looked at ahead for that, at some 1e5 times between two breaks. \
         The bar rests before, or vibrates (undamped, 0.1 m/s at its ends, slowest period 28 ms). \
         Momentum at {END} s over the impulse, exactly 1, at rtol {rtol:e}:"
    ));
    let mut rows = Vec::new();
    let mut chart =
        Chart::new("Error of the momentum after a pulse, worst of five methods, rtol 1e-5")
            .axes("width of the pulse (s)", "relative error")
            .logarithmic(true, true);
    for vibrates in [false, true] {
        let (mut missed, mut met) = (Vec::new(), Vec::new());
        for width in [0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5] {
            let state = if vibrates { "vibrates" } else { "rests" };
            let mut row = vec![state.to_string(), few(1e3 * width)];
            let pulse = |told| Pulse { width, told, vibrates };
            let (mut told_error, mut untold_error) = (0.0_f64, 0.0_f64);
            for method in methods {
                let told = pulse(true).momentum(method, rtol)?;
                let untold = pulse(false).momentum(method, rtol)?;
                told_error = told_error.max((told - 1.0).abs());
                untold_error = untold_error.max((untold - 1.0).abs());
                // rounded, so that nothing is -0
                row.push(format!("{:.4}", (1e4 * untold).round() / 1e4 + 0.0));
            }
            row.push(few(told_error));
            met.push((width, told_error.max(1e-16)));
            missed.push((width, untold_error));
            rows.push(<[String; 8]>::try_from(row).map_err(|row| format!("{} cells", row.len()))?);
        }
        let state = if vibrates { "it vibrates" } else { "it rests" };
        chart = chart
            .marked(format!("a function, {state}"), missed)
            .marked(format!("a table, {state}"), met);
    }
    page.table(
        [
            "bar",
            "width (ms)",
            "function: `cvode-bdf`",
            "`cvode-adams`",
            "`ida`",
            "`arkode`",
            "`rk`",
            "table: worst error of the five",
        ],
        &rows,
    );
    page.chart("pulses", "error over width of the pulse", &chart)?;
    page.say(format!(
        "In the general layer a point mass under the same pulse, 1 ms wide, has {:.4} of its momentum if CVODE is \
         not told, and all but {} with stop times at its kinks.",
        general(1e-3, false, rtol)?,
        few((general(1e-3, true, rtol)? - 1.0).abs()),
    ));
    page.say(
        "**What works:** phases end steps; so do the points of tables (`load_table`, `actuate_table`, `pressure_table`) and of \
         paths, and kinks and jumps of formulas, which bounds on their parts find: `Scene::breaks` lists them, each is the end of a \
         leg with a fresh integrator, and no pulse is skipped, however short. Of a function (`load_with` and its like) pulses are \
         found that last longer than about a hundred-thousandth of the time between two breaks. **What does not:** shorter ones, which need \
         breaks (`Signal::with_breaks`) or a table. In the general layer, `set_stop_time` and `reinit` do the same.",
    );
    Ok(())
}
