//! The index of the equations of motion as a differential-algebraic system.

use std::f64::consts::PI;

use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use pliant::ode::{Dae, Failure};
use pliant::output::Chart;
use pliant::samples::{Pendulum, SQUARE_MATERIAL};
use pliant::sundials::{Ida, IdaOptions};
use pliant::{
    Axis, Body, Cells, Error, Mesh, Method, Phase, Prescribed, Sampling, Scene, Solver, Trajectory,
};

use super::Outcome;
use super::linear::Linear;
use super::page::{Page, count, few};

/// How the constraint R = 0 enters the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// R = 0.
    Three,
    /// R' = 0.
    Two,
    /// R = 0 and R' = 0, with a second multiplier in u' = v + A eta (C. W. Gear, G. K. Gupta,
    /// B. Leimkuhler, "Automatic integration of Euler-Lagrange equations with constraints", 1985).
    StabilizedTwo,
    /// R'' = 0.
    One,
    /// R'' + 2 alpha R' + alpha^2 R = 0.
    StabilizedOne,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 5] =
        [Self::Three, Self::Two, Self::StabilizedTwo, Self::One, Self::StabilizedOne];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Three => "index 3",
            Self::Two => "index 2",
            Self::StabilizedTwo => "index 2, stabilized (GGL)",
            Self::One => "index 1",
            Self::StabilizedOne => "index 1, stabilized",
        }
    }

    /// What the constraint is replaced by, from R, R' and R''.
    fn equation(self, [r, rate, second]: [f64; 3]) -> f64 {
        match self {
            Self::Three => r,
            Self::Two | Self::StabilizedTwo => rate,
            Self::One => second,
            Self::StabilizedOne => second + 2.0 * ALPHA * rate + ALPHA * ALPHA * r,
        }
    }
}

/// Rate of the stabilization of index 1 (1/s).
const ALPHA: f64 = 10.0;

/// A pendulum in Cartesian coordinates: x, y, vx, vy, tension T, and eta in the stabilized form of
/// index 2.
pub struct PendulumForm(pub Form);

impl Dae for PendulumForm {
    fn residual(&mut self, _t: f64, s: &[f64], sp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        let (x, y, vx, vy, tension) = (s[0], s[1], s[2], s[3], s[4]);
        let eta = if self.0 == Form::StabilizedTwo { s[5] } else { 0.0 };
        r[0] = sp[0] - vx + eta * x;
        r[1] = sp[1] - vy + eta * y;
        r[2] = sp[2] + tension * x;
        r[3] = sp[3] + tension * y + Pendulum::GRAVITY;
        let position = 0.5 * (x * x + y * y - 1.0);
        let second = vx * vx + vy * vy - Pendulum::GRAVITY * y - tension * (x * x + y * y);
        r[4] = self.0.equation([position, x * vx + y * vy, second]);
        if self.0 == Form::StabilizedTwo {
            r[5] = position;
        }
        Ok(())
    }
}

/// What IDA made of a form.
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
    /// What it said, if it gave up.
    pub failure: Option<String>,
}

/// Steps that a run may take.
const LIMIT: u64 = 10_000;

/// One step, or why there is none.
fn step<S: Dae>(solver: &mut Ida<S>, end: f64) -> Option<String> {
    if solver.statistics().steps == LIMIT {
        return Some(format!("{LIMIT} steps, at t = {} s", solver.t()));
    }
    solver.step(end).err().map(|error| error.to_string())
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
    let mut solver = Ida::new(PendulumForm(form), 0.0, &y, &yp, &options)?;
    let mut result = Run::default();
    let end = Pendulum::PERIOD * periods as f64;
    solver.set_stop_time(Some(end))?;
    while solver.t() < end {
        if let Some(failure) = step(&mut solver, end) {
            result.failure = Some(failure);
            break;
        }
        let s = solver.y();
        result.drift = result.drift.max((s[0].hypot(s[1]) - 1.0).abs());
    }
    let s = solver.y();
    result.error = (s[0] - 1.0).hypot(s[1]);
    let exact = 3.0 * -Pendulum::GRAVITY * s[1];
    result.multiplier_error = (s[4] - exact).abs() / (3.0 * Pendulum::GRAVITY);
    Ok(result.counted(&solver.statistics()))
}

impl Run {
    fn counted(self, statistics: &pliant::sundials::Statistics) -> Self {
        let rejected = statistics.error_test_failures + statistics.step_failures;
        Self { steps: statistics.steps, rejected, ..self }
    }
}

/// Time for which the square is pressed (s), and depth (m).
const PRESS: [f64; 2] = [0.25, 0.04];

/// The path of the pressed nodes: smooth, but for a jump of b'' at the start.
fn path(t: f64) -> Prescribed {
    let [time, depth] = PRESS;
    let (omega, half) = (PI / time, 0.5 * depth);
    Prescribed {
        displacement: -half * (1.0 - (omega * t).cos()),
        velocity: -half * omega * (omega * t).sin(),
        acceleration: -half * omega * omega * (omega * t).cos(),
    }
}

fn square_body() -> Result<Body, Error> {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).build()
}

/// The pressed square of the documents with the smooth [`path`], as its scene has it: the reference.
pub fn pressed() -> Result<Trajectory, Error> {
    let push = Phase::until(PRESS[0]).hold("bottom").hold_axes([14, 15], [Axis::X]);
    let scene = Scene::new(square_body()?).phase(push.follow([14, 15], Axis::Y, path));
    let solver = Solver { method: Method::Rk, rtol: 1e-10, ..Solver::default() };
    scene.simulate(&solver, &Sampling::phase_ends())
}

/// The same square as a DAE in one of the forms: u, v, lambda and, for one of them, eta.
pub struct SquareForm {
    form: Form,
    body: Linear,
    /// Degrees of freedom that are held or led.
    rows: Vec<usize>,
}

impl SquareForm {
    /// # Errors
    /// None.
    pub fn new(form: Form) -> Outcome<Self> {
        let nodes = [0, 1, 2, 3, 13, 14];
        let rows = nodes.into_iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
        Ok(Self { form, body: Linear::new(&square_body()?, &[]), rows })
    }

    fn prescribed(&self, row: usize, t: f64) -> Prescribed {
        let is_led = self.rows[row] >= 26 && self.rows[row] % 2 == 1;
        let rest = Prescribed { displacement: 0.0, velocity: 0.0, acceleration: 0.0 };
        if is_led { path(t) } else { rest }
    }

    fn has_eta(&self) -> bool {
        self.form == Form::StabilizedTwo
    }

    /// Consistent y and y' at t = 0, from M v' - A lambda = 0 and A^T v' = b''.
    pub fn start(&self) -> (Vec<f64>, Vec<f64>) {
        let (n, m) = (self.body.size(), self.rows.len());
        let saddle = Mat::from_fn(n + m, n + m, |i, j| match (i < n, j < n) {
            (true, true) => self.body.inertia[(i, j)],
            (true, false) => -f64::from(self.rows[j - n] == i),
            (false, true) => f64::from(self.rows[i - n] == j),
            (false, false) => 0.0,
        });
        let right = Mat::from_fn(n + m, 1, |i, _| match i.checked_sub(n) {
            Some(row) => self.prescribed(row, 0.0).acceleration,
            None => 0.0,
        });
        let found = PartialPivLu::new(saddle.as_ref()).solve(right);
        let size = 2 * n + m + if self.has_eta() { m } else { 0 };
        let (mut y, mut yp) = (vec![0.0; size], vec![0.0; size]);
        (0..n).for_each(|i| yp[n + i] = found[(i, 0)]);
        (0..m).for_each(|row| y[2 * n + row] = found[(n + row, 0)]);
        (y, yp)
    }
}

impl Dae for SquareForm {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        let (n, m) = (self.body.size(), self.rows.len());
        let (u, v, lambda) = (&y[..n], &y[n..2 * n], &y[2 * n..2 * n + m]);
        let Linear { inertia, stiffness, damping } = &self.body;
        for i in 0..n {
            r[i] = yp[i] - v[i];
            let row = |j: usize| {
                inertia[(i, j)] * yp[n + j] + damping[(i, j)] * v[j] + stiffness[(i, j)] * u[j]
            };
            r[n + i] = (0..n).map(row).sum();
        }
        for (k, &dof) in self.rows.iter().enumerate() {
            let b = self.prescribed(k, t);
            r[n + dof] -= lambda[k];
            let constraint =
                [u[dof] - b.displacement, v[dof] - b.velocity, yp[n + dof] - b.acceleration];
            r[2 * n + k] = self.form.equation(constraint);
            if self.has_eta() {
                r[dof] -= y[2 * n + m + k];
                r[2 * n + m + k] = constraint[0];
            }
        }
        Ok(())
    }
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
    let mut solver = Ida::new(system, 0.0, &y, &yp, &options)?;
    let mut result = Run::default();
    let end = PRESS[0];
    solver.set_stop_time(Some(end))?;
    while solver.t() < end {
        if let Some(failure) = step(&mut solver, end) {
            result.failure = Some(failure);
            break;
        }
        let (t, y, system) = (solver.t(), solver.y(), solver.system());
        for (k, &dof) in system.rows.iter().enumerate() {
            let off = (y[dof] - system.prescribed(k, t).displacement).abs();
            result.drift = result.drift.max(off);
        }
    }
    let (y, sample) = (solver.y(), exact.last());
    let apart = y[..n].iter().zip(&sample.u).map(|(a, b)| (a - b).abs());
    result.error = apart.fold(0.0, f64::max);
    let force: f64 =
        (0..m).filter(|k| [27, 29].contains(&solver.system().rows[*k])).map(|k| y[2 * n + k]).sum();
    let reading = exact.constraint_force(sample, [14, 15])?[1];
    result.multiplier_error = ((force - reading) / reading).abs();
    Ok(result.counted(&solver.statistics()))
}

/// What IDA says to a start that contradicts the equations: the tension of a pendulum that is thrown,
/// of index 3; a pendulum off its circle, of index 3; a wrong tension, of index 1.
pub fn refusals() -> Outcome<[String; 3]> {
    let g = Pendulum::GRAVITY;
    let say = |form, y: [f64; 5], yp: [f64; 5]| -> Outcome<String> {
        let mut solver = Ida::new(PendulumForm(form), 0.0, &y, &yp, &IdaOptions::new(1e-6, 1e-6))?;
        Ok(match solver.solve_to(1.0) {
            Ok(_) => "accepted".into(),
            Err(error) => error.to_string(),
        })
    };
    Ok([
        say(Form::Three, [1.0, 0.0, 0.5, 0.0, 0.0], [0.5, 0.0, 0.0, -g, 0.0])?,
        say(Form::Three, [1.1, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -g, 0.0])?,
        say(Form::One, [1.0, 0.0, 0.0, 0.0, 5.0], [0.0, 0.0, 0.0, -g, 0.0])?,
    ])
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## f. The index of the equations");
    page.say(
        "With the constraint R = 0 itself the equations have index 3: its multiplier follows from R''. BDF \
         divides by h^2 for that, so that in the multiplier an error of the Newton iteration counts 1/h^2 \
         times; the error test sees that, cuts h, and makes it worse. IDA's theory ends at \
         index 1. Forms of lower index, all through the general layer, `rtol` = 1e-6; errors of the \
         multiplier are parts of its size.",
    );
    let exact = pressed()?;
    for (name, of) in [
        ("A pendulum of 1 m, 10 periods of 2 s:", None),
        (
            "The square of the documents (4 x 4 nodes, 12 rows, 76 unknowns), pressed by 4 cm in 0.25 s:",
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
         `{failure}`. Its guess is wrong here: what the error test meets at t = 0 is the index, not the start.",
        count(LIMIT as usize)
    ));
    tolerances(page)?;
    let [thrown, off, wrong] = refusals()?;
    page.say("**Starts that contradict the equations** are refused by name, not integrated:");
    page.table(
        ["start", "what IDA says"],
        &[
            ["index 3, thrown off the circle (R' = 0.5 m/s)".into(), thrown],
            ["index 3, 10 cm off the circle".into(), off],
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
