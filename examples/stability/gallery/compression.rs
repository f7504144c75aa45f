//! St. Venant-Kirchhoff material under compression.

use pliant::output::Chart;
use pliant::samples::BEAM_MATERIAL;
use pliant::{
    Body, Cells, Error, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Stability,
    Statics, Strain, Trajectory,
};

use super::Outcome;
use super::page::{Page, count, few};

/// Length (m), area (m^2) and cells of the bar.
const LENGTH: f64 = 0.1;
const AREA: f64 = 2e-4;
const CELLS: usize = 5;

/// Stretch at which the tangent E A (3 s^2 - 1)/2 of a bar vanishes.
pub const CRITICAL: f64 = 0.577_350_269_189_625_8;

/// Force of a bar at the stretch s (N), positive in tension: (E A/2)(s^3 - s).
pub fn force(s: f64) -> f64 {
    0.5 * BEAM_MATERIAL.young * AREA * (s * s * s - s)
}

/// Largest force of compression (N): E A/(3 sqrt 3).
pub fn limit() -> f64 {
    -force(CRITICAL)
}

/// The eigenvalue of the slowest motion of a bar held at both ends, over that at s = 1; below the
/// critical stretch that of the shape that grows fastest, the one from node to node.
pub fn eigenvalue(s: f64) -> f64 {
    // of linear cells: omega_k^2 ~ (1 - cos a)/(2 + cos a), a = k pi/cells
    let omega_square = |k: usize| {
        let cos = (std::f64::consts::PI * k as f64 / CELLS as f64).cos();
        (1.0 - cos) / (2.0 + cos)
    };
    let softening = 0.5 * (3.0 * s * s - 1.0);
    let shape = if softening > 0.0 { 1 } else { CELLS - 1 };
    softening * omega_square(shape) / omega_square(1)
}

fn bar(strain: Strain) -> Result<Scene, Error> {
    let mesh = Mesh::bar(LENGTH, CELLS + 1)?;
    Ok(Scene::new(Body::new(mesh, BEAM_MATERIAL).area(AREA).strain(strain).build()?))
}

/// A bar held at both ends at a stretch: its force (N), and the eigenvalue omega^2 (1/s^2) of its
/// slowest motion, negative if it is unstable.
pub fn held_at(stretch: f64) -> Result<(f64, f64), Error> {
    let phase = Phase::until(1.0).hold("left").move_nodes("right", [(stretch - 1.0) * LENGTH]);
    let equilibrium = bar(Strain::Green)?.phase(phase).equilibrium(&Statics::default())?;
    let trajectory = equilibrium.trajectory();
    let reading = trajectory.constraint_force(equilibrium.sample(), "right")?[0];
    let square = match equilibrium.stability {
        Stability::Stable { frequency } => (std::f64::consts::TAU * frequency).powi(2),
        Stability::Neutral => 0.0,
        Stability::Unstable { growth } => -growth * growth,
    };
    Ok((reading, square))
}

/// A bar under a load that grows within a second to `part` of the largest it can carry.
pub fn crushed(strain: Strain, part: f64, method: Method) -> Result<Trajectory, Error> {
    let load = [[0.0], [-part * limit()]];
    let phase = Phase::until(1.0).named("crush").hold("left");
    let settings = Settings { method, ..Settings::default() };
    let scene = bar(strain)?.phase(phase.load_table("right", [0.0, 1.0], load));
    scene.simulate(&settings, &Sampling::every(0.01))
}

/// Least volume of a cell over its natural volume at the end of a motion.
pub fn least_volume(motion: &Trajectory) -> f64 {
    motion.body().volume_ratios(&motion.last().u).into_iter().fold(f64::INFINITY, f64::min)
}

/// A column of 10 x 2 cm, pressed together by 3 cm within `time` (s).
pub fn column(time: f64, method: Method) -> Result<Trajectory, Error> {
    let mesh = Mesh::rectangle([0.1, 0.02], [21, 5], Cells::Rectangles)?;
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 40.0 };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build()?;
    let squeeze = Phase::until(time).hold("left").move_nodes("right", [-0.03 / time, 0.0]);
    let settings = Settings { method, rtol: 1e-4, ..Settings::default() };
    Scene::new(body).phase(squeeze).simulate(&settings, &Sampling::every(0.05 * time))
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## g. St. Venant-Kirchhoff material under compression");
    page.say(format!(
        "Green strain with a linear law softens under compression: a bar at stretch s resists with (E A/2)(s - \
         s^3), which is largest at s = 1/sqrt 3 = 0.577, and vanishes as s does. Below that stretch the tangent \
         is negative; a load beyond E A/(3 sqrt 3) = {} N finds no equilibrium, and the cell turns inside \
         out.",
        few(limit())
    ));
    equilibria(page)?;
    crush(page)?;
    squeeze(page)?;
    page.say(
        "**What works:** below the limit, everything: indefinite tangents are factorized by LU, and the report \
         counts them; beyond it, nothing does, because the model has no answer: the runs end with the cell, \
         the time and the load that was reached, and keep the motion until then (`tests/bodies/statics/stability.rs`, \
         `tests/scenes/compression.rs`). Cauchy strain has no limit and no complaint, and is wrong for longer.",
    );
    Ok(())
}

fn equilibria(page: &mut Page) -> Outcome<()> {
    let (mut rows, mut found, mut eigenvalues) = (Vec::new(), Vec::new(), Vec::new());
    let (_, natural) = held_at(1.0)?;
    for stretch in [1.0, 0.9, 0.8, 0.7, 0.65, 0.6, 0.58, 0.57, 0.55, 0.5] {
        match held_at(stretch) {
            Ok((reading, found_eigenvalue)) => {
                found.push((stretch, -reading));
                eigenvalues.push((stretch, found_eigenvalue / natural));
                rows.push([
                    few(stretch),
                    format!("{:.4}", 0.0 - reading),
                    format!("{:.4}", 0.0 - force(stretch)),
                    format!("{:.4}", found_eigenvalue / natural),
                    format!("{:.4}", eigenvalue(stretch)),
                    if found_eigenvalue > 0.0 { "stable" } else { "unstable" }.into(),
                ]);
            }
            Err(error) => rows.push([
                few(stretch),
                "-".into(),
                format!("{:.4}", 0.0 - force(stretch)),
                "-".into(),
                format!("{:.4}", eigenvalue(stretch)),
                format!("`{error}`"),
            ]),
        }
    }
    page.say(format!(
        "**Loss of definiteness is found.** A bar of {CELLS} cells held at both ends: the force that it \
         resists with, and the eigenvalue omega^2 of its slowest motion over that at s = 1, (3 s^2 - 1)/2 as long as it is stable. Beyond, all shapes grow, the \
         one from node to node fastest: refining the mesh makes it worse."
    ));
    page.table(
        [
            "stretch",
            "force (N)",
            "closed form",
            "omega^2 / omega_0^2",
            "closed form",
            "reported as",
        ],
        &rows,
    );
    let curve =
        |value: fn(f64) -> f64| (50..=100).map(f64::from).map(move |s| (0.01 * s, value(0.01 * s)));
    let chart = Chart::new("A bar under compression: what it resists with, and its stability")
        .axes("stretch", "force (N); eigenvalue")
        .marked("force", found)
        .marked("eigenvalue", eigenvalues)
        .reference("closed form, force", curve(|s| -force(s)))
        .reference("closed form, eigenvalue", curve(eigenvalue));
    page.chart("compression-bar", "force and stability over stretch", &chart)
}

fn crush(page: &mut Page) -> Outcome<()> {
    let mut rows = Vec::new();
    for (strain, method, part) in [
        (Strain::Green, Method::CvodeBdf, 0.95),
        (Strain::Green, Method::CvodeBdf, 1.2),
        (Strain::Green, Method::Ida, 1.2),
        (Strain::Green, Method::Rk, 1.2),
        (Strain::Cauchy, Method::CvodeBdf, 1.2),
        (Strain::Cauchy, Method::CvodeBdf, 6.0),
    ] {
        let outcome = match crushed(strain, part, method) {
            Ok(motion) => {
                format!("ends; least volume ratio {}", few(least_volume(&motion)))
            }
            Err(Error::Integration(end)) => format!("`{end}`"),
            Err(other) => return Err(other.into()),
        };
        rows.push([format!("{strain:?}"), method.to_string(), few(part), outcome]);
    }
    page.say(
        "**Inversion is named.** The same bar, one end loaded up to a part of the limit within a second. \
         A cell with det F <= 0 is refused at every trial point; when no step avoids it, the run ends. The bar of \
         Cauchy strain passes through itself, and a warning tells.",
    );
    page.table(["strain", "method", "load / limit", "outcome"], &rows);
    Ok(())
}

fn squeeze(page: &mut Page) -> Outcome<()> {
    let mut rows = Vec::new();
    for time in [2.0, 20.0, 200.0] {
        let motion = column(time, Method::Ida)?;
        let counts = &motion.report().phases[0].counts;
        rows.push([
            few(time),
            count(counts.steps),
            count(counts.factorizations),
            counts.notice.clone().unwrap_or("-".into()),
        ]);
    }
    page.say(
        "**Indefinite Newton matrices are survived.** A column of 10 x 2 cm pressed together by 3 cm, ever \
         slower (`ida`, rtol 1e-4): steps longer than the time in which it would buckle meet a matrix \
         M + gamma D + gamma^2 K that is not positive definite.",
    );
    page.table(["time (s)", "steps", "factorizations", "notice of the report"], &rows);
    Ok(())
}
