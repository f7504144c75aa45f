//! The rate alpha of the constraint stabilization.

use pliant::ode::Failure;
use pliant::output::Chart;
use pliant::rk::{DormandPrince, Integrator, Options};
use pliant::samples::{Pendulum, SQUARE_MATERIAL};
use pliant::{Body, Cells, Error, Mesh, Method, Phase, Sampling, Scene, Settings, Strain};

use super::Outcome;
use super::page::{Page, count, few};

/// Speed at which nodes of the square are told to move at once (m/s).
pub const SPEED: f64 = 0.16;

/// The first 0.1 s of Hirai's pressed square. It starts at rest, so that the rate R' of
/// the constraints is wrong by [`SPEED`]; unless velocities are projected.
pub fn pressed(projected: bool) -> Result<Scene, Error> {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build()?;
    let push = Phase::until(0.1).hold("bottom").move_nodes([14, 15], [0.0, -SPEED]);
    let push = if projected { push.project_velocity() } else { push };
    Ok(Scene::new(body).phase(push))
}

/// Steps taken and largest |R| (m) of the square.
pub fn square(method: Method, alpha: f64, projected: bool) -> Result<(usize, f64), Error> {
    let settings = Settings { method, alpha, ..Settings::default() };
    let motion = pressed(projected)?.simulate(&settings, &Sampling::phase_ends())?;
    Ok((motion.report().steps(), motion.report().constraint_drift))
}

/// A pendulum of length 1 m as a point with the constraint R = (|x|^2 - 1)/2, stabilized at the
/// rate alpha: what R'' = -2 alpha R' - alpha^2 R asks of the tension.
fn pendulum(alpha: f64) -> impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> {
    move |_t, s, sdot| {
        let (x, y, vx, vy) = (s[0], s[1], s[2], s[3]);
        let square = x * x + y * y;
        let stabilization = 2.0 * alpha * (x * vx + y * vy) + 0.5 * alpha * alpha * (square - 1.0);
        let tension = (vx * vx + vy * vy - Pendulum::GRAVITY * y + stabilization) / square;
        sdot.copy_from_slice(&[vx, vy, -tension * x, -tension * y - Pendulum::GRAVITY]);
        Ok(())
    }
}

/// How far the pendulum is from its length (m) at the end of each period of 2 s, and the steps in
/// all. It is let go with the outward speed `outward` (m/s), which no constraint would allow.
pub fn drift(alpha: f64, outward: f64, periods: usize) -> Outcome<(Vec<f64>, usize)> {
    let options = Options::new(1e-4, 1e-4).max_steps(10_000_000);
    let start = [1.0, 0.0, outward, 0.0];
    let mut settings = DormandPrince::new(pendulum(alpha), 0.0, &start, &options)?;
    let mut off = Vec::new();
    for period in 1..=periods {
        settings.solve_to(Pendulum::PERIOD * period as f64)?;
        let s = settings.y();
        off.push((s[0].hypot(s[1]) - 1.0).abs());
    }
    Ok((off, settings.statistics().steps as usize))
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## b. The stabilization rate alpha");
    page.say(
        "A constraint R = A^T u - b(t) = 0 is enforced by its second derivative, R'' + 2 alpha R' + \
         alpha^2 R = 0. What an integrator or a start gets wrong decays within about 1/alpha.",
    );
    unstabilized(page)?;
    let Err(refused) = square(Method::Rk, 0.0, false) else {
        return Err("alpha = 0 was not refused".into());
    };
    page.say(format!(
        "Scenes therefore refuse it: `{refused}`. Where all rows are linear and the start is \
         consistent, alpha matters little: every method used here keeps linear invariants."
    ));
    inconsistent(page)?;
    costs(page)
}

fn unstabilized(page: &mut Page) -> Outcome<()> {
    let periods = 50;
    let mut chart = Chart::new("A pendulum of 1 m that forgets its length (rtol 1e-4)")
        .axes("time (s)", "error of its length (m)")
        .logarithmic(true, true);
    let mut rows = Vec::new();
    for alpha in [0.0, 1.0, 10.0, 100.0, 1000.0] {
        let ((off, steps), (pulled, _)) =
            (drift(alpha, 0.0, periods)?, drift(alpha, 0.1, periods)?);
        rows.push([
            few(alpha),
            few(off[0]),
            few(off[periods - 1]),
            few(pulled[periods - 1]),
            count(steps),
        ]);
        let times = (1..).map(|period| Pendulum::PERIOD * f64::from(period));
        // what is below round-off has no place on a logarithmic axis
        let points = times.zip(off.iter().map(|off| off.max(1e-16)));
        chart = chart.series(format!("alpha {alpha} 1/s"), points);
    }
    page.say(
        "**alpha = 0 drifts without bound.** R'' = 0 keeps every error of R' for ever, and R grows with \
         time. A pendulum (a nonlinear constraint, explicit Runge-Kutta, rtol = atol = 1e-4, 50 \
         periods of 2 s):",
    );
    page.table(
        [
            "alpha (1/s)",
            "error of length after 2 s (m)",
            "after 100 s (m)",
            "after 100 s, let go with R' = 0.1 m/s (m)",
            "steps",
        ],
        &rows,
    );
    page.chart("alpha-drift", "drift of the pendulum's length", &chart)
}

fn inconsistent(page: &mut Page) -> Outcome<()> {
    page.say(format!(
        "**A start with R' not 0.** The pressed square starts at rest, and has to move with v = \
         {SPEED} m/s at once. Then R(t) = v t exp(-alpha t), v/(e alpha) at most. Projecting the velocity \
         at the start of the phase (`Phase::project_velocity`, an inelastic impact) leaves no R' to work \
         off."
    ));
    let mut rows = Vec::new();
    for alpha in [1e2, 1e3, 1e4, 1e5, 1e6] {
        let (jump, projected) =
            (square(Method::CvodeBdf, alpha, false)?, square(Method::CvodeBdf, alpha, true)?);
        rows.push([
            few(alpha),
            few(SPEED / std::f64::consts::E / alpha),
            few(jump.1),
            few(projected.1),
            count(jump.0),
            count(projected.0),
        ]);
    }
    page.table(
        [
            "alpha (1/s)",
            "v/(e alpha) (m)",
            "largest R (m)",
            "largest R, projected (m)",
            "steps",
            "steps, projected",
        ],
        &rows,
    );
    Ok(())
}

/// Those whose steps are counted.
const METHODS: [Method; 5] =
    [Method::Rk, Method::CvodeBdf, Method::Ida, Method::Arkode, Method::CentralDifference];

fn costs(page: &mut Page) -> Outcome<()> {
    let alphas = [1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8];
    let mut chart = Chart::new("Steps of the pressed square for 0.1 s at rtol 1e-5")
        .axes("alpha (1/s)", "steps")
        .logarithmic(true, true);
    let mut lines = Vec::new();
    for method in METHODS {
        let mut line = Vec::new();
        for alpha in alphas {
            // beyond, Runge-Kutta is as slow as one expects
            if method != Method::Rk || alpha <= 1e6 {
                line.push((alpha, square(method, alpha, true)?.0 as f64));
            }
        }
        chart = chart.marked(method.name(), line.clone());
        lines.push(line);
    }
    let limit = |alpha: f64| (alpha, 0.1 * alpha / super::explicit::LIMIT);
    chart = chart.reference("alpha T / 3.3066", [limit(1e4), limit(1e6)]);
    let rows: Vec<_> = alphas
        .iter()
        .enumerate()
        .map(|(k, alpha)| {
            let steps =
                |line: usize| lines[line].get(k).map_or("-".into(), |at| count(at.1 as usize));
            [few(*alpha), steps(0), steps(1), steps(2), steps(3), steps(4)]
        })
        .collect();
    page.say(
        "**A large alpha costs Runge-Kutta steps of 3.3/alpha, other methods nothing.** alpha is a \
         double eigenvalue -alpha of the equations. In the Newton matrix it stands beside the eliminated \
         rows only (`docs/decisions/0001-half-size-newton-matrix.md`), so that neither its size nor its condition changes. Central differences follow the known \
         solution of R'' + 2 alpha R' + alpha^2 R = 0 instead of integrating it.",
    );
    let [rk, bdf, ida, arkode, central] = METHODS.map(Method::name);
    page.table(["alpha (1/s)", rk, bdf, ida, arkode, central], &rows);
    page.chart("alpha-steps", "steps over alpha", &chart)?;
    page.say(
        "**What works:** any method but Runge-Kutta with alpha as large as one likes, and a projected start \
         where nodes are told to move at once. With Runge-Kutta alpha = 1e3, the default, costs \
         little as long as the body is stiffer than that.",
    );
    Ok(())
}
