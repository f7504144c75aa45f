//! The index of the equations of motion as a differential-algebraic system.

use pliant::ode::Dae;
use pliant::output::Chart;
use pliant::samples::Pendulum;
use pliant::sundials::{Ida, IdaOptions, Integrator, Jacobian, LinearSolver};
use pliant::{Axis, Error, Method, Phase, Sampling, Scene, Settings, Trajectory};

use super::Outcome;
use super::forms::{Form, PRESS, PendulumForm, SquareForm, path, square_body};
use super::page::{Page, count, few};

/// Statistics of an IDA run on a form.
#[derive(Debug, Clone, Default)]
pub struct Run {
    /// Steps until the end, or until it gave up.
    pub steps: u64,
    /// Steps that were rejected.
    pub rejected: u64,
    /// Largest |R| at the end of a step (m).
    pub drift: f64,
    /// Error of the positions (m).
    pub error: f64,
    /// Error of the multiplier, as a part of its size.
    pub multiplier_error: f64,
    /// Message of IDA, if it gave up.
    pub failure: Option<String>,
}

/// Steps that a run may take.
const LIMIT: u64 = 10_000;

/// One step, or why there is none.
fn step<S: Dae>(settings: &mut Ida<S>, end: f64) -> Option<String> {
    if settings.statistics().steps == LIMIT {
        return Some(format!("{LIMIT} steps, at t = {} s", settings.t()));
    }
    settings.step(end).err().map(|error| error.to_string())
}

/// The pendulum, let go from the horizontal, for `periods` of 2 s. The multipliers take part in the
/// error test or not.
pub fn pendulum(form: Form, tested: bool, rtol: f64, periods: usize) -> Outcome<Run> {
    let (mut y, mut yp) = (Pendulum::DAE_Y0.to_vec(), Pendulum::DAE_YP0.to_vec());
    let mut differential = Pendulum::DIFFERENTIAL.to_vec();
    if form == Form::StabilizedTwo {
        y.push(0.0);
        yp.push(0.0);
        differential.push(false);
    }
    let options =
        IdaOptions::new(rtol, rtol).differential(differential).suppress_algebraic(!tested);
    let options = options.newton(LinearSolver::Dense(Jacobian::Supplied));
    let mut settings = Ida::new(PendulumForm(form), 0.0, &y, &yp, &options)?;
    let mut result = Run::default();
    let end = Pendulum::PERIOD * periods as f64;
    settings.set_stop_time(Some(end))?;
    while settings.t() < end {
        if let Some(failure) = step(&mut settings, end) {
            result.failure = Some(failure);
            break;
        }
        let s = settings.y();
        result.drift = result.drift.max((s[0].hypot(s[1]) - 1.0).abs());
    }
    let s = settings.y();
    result.error = (s[0] - 1.0).hypot(s[1]);
    let exact = 3.0 * -Pendulum::GRAVITY * s[1];
    result.multiplier_error = (s[4] - exact).abs() / (3.0 * Pendulum::GRAVITY);
    Ok(result.counted(&settings.statistics()))
}

impl Run {
    fn counted(self, statistics: &pliant::sundials::Statistics) -> Self {
        let rejected = statistics.error_test_failures + statistics.step_failures;
        Self { steps: statistics.steps, rejected, ..self }
    }
}

/// Hirai's pressed square with the smooth [`path`], as its scene has it: the reference.
pub fn pressed() -> Result<Trajectory, Error> {
    let push = Phase::until(PRESS[0]).hold("bottom").hold_axes([14, 15], [Axis::X]);
    let scene = Scene::new(square_body()?).phase(push.follow([14, 15], Axis::Y, path));
    let settings = Settings { method: Method::Rk, rtol: 1e-10, ..Settings::default() };
    scene.simulate(&settings, &Sampling::phase_ends())
}

/// The pressed square in a form, held against its scene.
pub fn square(form: Form, tested: bool, rtol: f64, exact: &Trajectory) -> Outcome<Run> {
    let system = SquareForm::new(form)?;
    let (n, m) = (system.body.size(), system.rows.len());
    let (y, yp) = system.start();
    // as scenes have it: strains of 1 %, velocities of 1 % of the speed of waves, multipliers of 1 N
    let tolerance = |i: usize| match i {
        i if i < n => 3e-3,
        i if i < 2 * n => 0.3,
        i if i < 2 * n + m => 1.0,
        _ => 3e-3,
    };
    let atol: Vec<f64> = (0..y.len()).map(|i| rtol * tolerance(i)).collect();
    let differential: Vec<bool> = (0..y.len()).map(|i| i < 2 * n).collect();
    let options =
        IdaOptions::new(rtol, atol).differential(differential).suppress_algebraic(!tested);
    let mut settings = Ida::new(system, 0.0, &y, &yp, &options)?;
    let mut result = Run::default();
    let end = PRESS[0];
    settings.set_stop_time(Some(end))?;
    while settings.t() < end {
        if let Some(failure) = step(&mut settings, end) {
            result.failure = Some(failure);
            break;
        }
        let (t, y, system) = (settings.t(), settings.y(), settings.system());
        for (k, &dof) in system.rows.iter().enumerate() {
            let off = (y[dof] - system.prescribed(k, t).displacement).abs();
            result.drift = result.drift.max(off);
        }
    }
    let (y, sample) = (settings.y(), exact.last());
    let apart = y[..n].iter().zip(&sample.u).map(|(a, b)| (a - b).abs());
    result.error = apart.fold(0.0, f64::max);
    let force: f64 = (0..m)
        .filter(|k| [27, 29].contains(&settings.system().rows[*k]))
        .map(|k| y[2 * n + k])
        .sum();
    let reading = exact.constraint_force(sample, [14, 15])?[1];
    result.multiplier_error = ((force - reading) / reading).abs();
    Ok(result.counted(&settings.statistics()))
}

/// Messages of IDA for an inconsistent start of a form that it integrates from a consistent one: a pendulum that is
/// thrown off its circle and one that hangs beside it, in the stabilized form of index 2; a wrong tension, in
/// index 1.
pub fn refusals() -> Outcome<[String; 3]> {
    let g = Pendulum::GRAVITY;
    let say = |form, y: &[f64], yp: &[f64]| -> Outcome<String> {
        let options = IdaOptions::new(1e-6, 1e-6)
            .differential((0..y.len()).map(|i| i < 4).collect::<Vec<_>>())
            .suppress_algebraic(form == Form::StabilizedTwo);
        let mut settings = Ida::new(PendulumForm(form), 0.0, y, yp, &options)?;
        Ok(match settings.solve_to(1.0) {
            Ok(_) => "accepted".into(),
            Err(error) => error.to_string(),
        })
    };
    let two = Form::StabilizedTwo;
    Ok([
        say(two, &[1.0, 0.0, 0.5, 0.0, 0.0, 0.0], &[0.5, 0.0, 0.0, -g, 0.0, 0.0])?,
        say(two, &[1.1, 0.0, 0.0, 0.0, 0.0, 0.0], &[0.0, 0.0, 0.0, -g, 0.0, 0.0])?,
        say(Form::One, &[1.0, 0.0, 0.0, 0.0, 5.0], &[0.0, 0.0, 0.0, -g, 0.0])?,
    ])
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## f. The index of the equations");
    page.say(
        "With the constraint R = 0 itself the equations have index 3: its multiplier follows from R''. BDF \
         divides by h^2 for that, so that in the multiplier an error of the Newton iteration counts 1/h^2 \
         times; the error test sees that, cuts h, and makes it worse. IDA is made for \
         index 1. Forms of lower index, all through the general layer, `rtol` = 1e-6; errors of the \
         multiplier are parts of its size.",
    );
    let exact = pressed()?;
    for (name, of) in [
        ("A pendulum of 1 m, 10 periods of 2 s:", None),
        (
            "Hirai's square (4 x 4 nodes, 12 rows, 76 unknowns), pressed by 4 cm in 0.25 s:",
            Some(&exact),
        ),
    ] {
        let mut rows = Vec::new();
        for form in Form::ALL {
            for tested in [true, false] {
                let result = match of {
                    None => pendulum(form, tested, 1e-6, 10)?,
                    Some(exact) => square(form, tested, 1e-6, exact)?,
                };
                let ended = result.failure.is_none();
                let cell = |x: f64| if ended { few(x) } else { "-".into() };
                rows.push([
                    form.name().to_string(),
                    if tested { "yes" } else { "no" }.into(),
                    if ended { "ends" } else { "fails" }.into(),
                    count(result.steps as usize),
                    count(result.rejected as usize),
                    few(result.drift),
                    cell(result.error),
                    cell(result.multiplier_error),
                ]);
            }
        }
        page.say(name);
        page.table(
            [
                "form",
                "multipliers tested",
                "",
                "steps",
                "rejected",
                "largest R (m)",
                "error of positions (m)",
                "error of multiplier",
            ],
            &rows,
        );
    }
    let failure = pendulum(Form::Three, true, 1e-6, 10)?.failure.unwrap_or("(it did not)".into());
    page.say(format!(
        "Runs that neither end nor fail are given {} steps. The message of index 3, from a consistent start: \
         `{failure}`. There is no discontinuity: what the error test cannot pass is the index.",
        count(LIMIT as usize)
    ));
    tolerances(page)?;
    let [thrown, off, wrong] = refusals()?;
    page.say(
        "**Starts that contradict the equations** are refused by name, in forms that integrate the consistent one:",
    );
    page.table(
        ["start", "what IDA says"],
        &[
            ["stabilized index 2, thrown off the circle (R' = 0.5 m/s)".into(), thrown],
            ["stabilized index 2, 10 cm off the circle".into(), off],
            ["index 1, tension 5 instead of 0".into(), wrong],
        ],
    );
    page.say(
        "**What works:** index 1 with stabilization, the form of scenes, whose consistent starts are \
         computed from the saddle-point system and whose nodal multipliers cost nothing; the stabilized form of index \
         2 with multipliers out of the error test (`suppress_algebraic`) where R has to vanish to the precision of \
         the Newton iteration.",
    );
    Ok(())
}

fn tolerances(page: &mut Page) -> Outcome<()> {
    let mut chart = Chart::new("A pendulum over ten periods: error of its length")
        .axes("rtol", "largest error of the length (m)")
        .logarithmic(true, true);
    for form in Form::ALL {
        let mut line = Vec::new();
        // multipliers are left out of the error test where they would end the run
        for rtol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
            let tested = matches!(form, Form::One | Form::StabilizedOne);
            let result = pendulum(form, tested, rtol, 10)?;
            if result.failure.is_none() {
                line.push((rtol, result.drift.max(1e-16)));
            }
        }
        if !line.is_empty() {
            chart = chart.marked(form.name(), line);
        }
    }
    page.chart("index-drift", "drift over tolerance (runs that fail are left out)", &chart)
}
