//! Penalty contact: its stiffness, its damping, its events, and a bar against the wave equation.

use std::f64::consts::PI;

use pliant::output::Chart;
use pliant::samples::{BEAM_MATERIAL, SQUARE_MATERIAL};
use pliant::{
    Body, Cells, ContactEvents, Error, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene,
    Settings, Strain, Trajectory,
};

use super::Outcome;
use super::page::{Page, count, few};

/// Height from which the square falls (m), and acceleration of gravity (m/s^2).
const HEIGHT: f64 = 0.05;
const GRAVITY: f64 = 9.8;

/// Hirai's square of 30 cm falls on a floor with this stiffness per node (N/m).
pub fn falling(stiffness: f64) -> Result<Scene, Error> {
    let mesh =
        Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Rectangles)?.translated(&[0.0, HEIGHT])?;
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build()?;
    Ok(Scene::new(body)
        .gravity([0.0, -GRAVITY])
        .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(stiffness))
        .phase(Phase::until(0.5)))
}

/// A run of it.
pub fn fall(
    stiffness: f64,
    method: Method,
    contact_events: ContactEvents,
    rtol: f64,
) -> Result<Trajectory, Error> {
    let settings = Settings { method, rtol, contact_events, ..Settings::default() };
    falling(stiffness)?.simulate(&settings, &Sampling::every(0.001))
}

/// Depth of the lowest node below the floor (m).
pub fn penetration(motion: &Trajectory) -> f64 {
    let rest = motion.body().mesh().positions();
    let heights = motion.samples().iter().flat_map(|sample| {
        sample.u.iter().zip(rest).skip(1).step_by(2).map(|(u, y)| y + u).collect::<Vec<_>>()
    });
    heights.fold(0.0, |depth, height| f64::max(depth, -height))
}

/// The same of a rigid square: m g d + m v^2/2 = 4 K_p d^2/2.
pub fn rigid_penetration(stiffness: f64, mass: f64) -> f64 {
    let sag = mass * GRAVITY / (4.0 * stiffness);
    sag + (sag * sag + 2.0 * sag * HEIGHT).sqrt()
}

/// Largest distance of the centre of mass from that of a reference with the same samples (m).
pub fn error(motion: &Trajectory, exact: &Trajectory) -> f64 {
    let height = |run: &Trajectory, k: usize| run.centre_of_mass(&run.samples()[k])[1];
    let apart = (0..exact.samples().len()).map(|k| (height(motion, k) - height(exact, k)).abs());
    apart.fold(0.0, f64::max)
}

/// Velocity after a bounce over that before, of a bar so stiff that it bounces as one mass, on a floor
/// with the damping ratio zeta = B_p / (2 sqrt(K_p m)), which may or may not pull.
pub fn restitution(zeta: f64, adhesion: bool) -> Result<f64, Error> {
    let stiff = Material { density: 1000.0, young: 1e9, poisson: 0.0, viscosity: 1e3 };
    let mesh = Mesh::bar(0.1, 2)?.translated(&[0.001])?;
    let body = Body::new(mesh, stiff).strain(Strain::Cauchy).area(2e-4).build()?;
    let floor_stiffness: f64 = 2e3;
    let damping = 2.0 * zeta * (floor_stiffness * body.mass()).sqrt();
    let floor = Obstacle::half_plane([0.0], [1.0]).stiffness(floor_stiffness);
    let scene = Scene::new(body)
        .obstacle(floor.damping(damping).adhesion(adhesion))
        .initial_velocity(|_| vec![-1.0])
        .phase(Phase::until(0.05));
    let settings = Settings { method: Method::CvodeBdf, rtol: 1e-7, ..Settings::default() };
    let settings = Settings { contact_events: ContactEvents::Locate, ..settings };
    let motion = scene.simulate(&settings, &Sampling::phase_ends())?;
    Ok(motion.mean_velocity(motion.last())[0])
}

/// The same of one mass. It leaves where d = 0 if the floor may pull; where the force is 0 if not.
pub fn exact_restitution(zeta: f64, adhesion: bool) -> f64 {
    let root = (1.0 - zeta * zeta).sqrt();
    let phase = match adhesion {
        true => PI,
        false => PI - (2.0 * zeta * root).atan2(1.0 - 2.0 * zeta * zeta),
    };
    (-zeta / root * phase).exp()
}

/// Length (m), area (m^2) and speed of impact (m/s) of the bar.
const BAR: [f64; 3] = [0.1, 2e-4, 0.1];

/// Speed of waves in it (m/s).
pub fn wave_speed() -> f64 {
    (BEAM_MATERIAL.young / BEAM_MATERIAL.density).sqrt()
}

/// An undamped bar, `cells` long, hits a floor `hardness` times as stiff as the bar: its motion until
/// t c/L = 5, c being the speed of waves.
pub fn bar(hardness: f64, cells: usize) -> Result<Trajectory, Error> {
    let [length, area, speed] = BAR;
    let material = Material { viscosity: 0.0, ..BEAM_MATERIAL };
    let body = Body::new(Mesh::bar(length, cells + 1)?, material)
        .strain(Strain::Cauchy)
        .area(area)
        .build()?;
    let until = 5.0 * length / wave_speed();
    let scene = Scene::new(body)
        .obstacle(Obstacle::half_plane([0.0], [1.0]).stiffness(floor(hardness)))
        .initial_velocity(move |_| vec![-speed])
        .phase(Phase::until(until));
    let settings = Settings { method: Method::Rk, rtol: 1e-6, ..Settings::default() };
    scene.simulate(&settings, &Sampling::every(until / 1000.0))
}

fn floor(hardness: f64) -> f64 {
    hardness * BEAM_MATERIAL.young * BAR[1] / BAR[0]
}

/// (t c/L, force / (E A v/c)), sample by sample; v the speed of impact.
pub fn bar_force(motion: &Trajectory, hardness: f64) -> Vec<(f64, f64)> {
    let [length, area, speed] = BAR;
    let (c, scale) = (wave_speed(), BEAM_MATERIAL.young * area * speed / wave_speed());
    let force = |u: f64| floor(hardness) * f64::max(-u, 0.0) / scale;
    motion.samples().iter().map(|s| (s.time * c / length, force(s.u[0]))).collect()
}

/// Time of contact in units of L/c: 2 on a rigid floor. Impulse over 2 m v, which is 1 there.
pub fn bar_contact(force: &[(f64, f64)]) -> [f64; 2] {
    let last = force.iter().rev().find(|at| at.1 > 0.0).map_or(0.0, |at| at.0);
    let impulse: f64 = force.windows(2).map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0)).sum();
    // E A v/c times L/c is m v c^2/c^2 = m v
    [last, 0.5 * impulse]
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## e. Penalty contact");
    stiffness(page)?;
    damping(page)?;
    waves(page)?;
    page.say(
        "**What works:** a floor some ten times as stiff as the body, no more; the balance of energies, \
         which tells how well a bounce was integrated; rtol 1e-6 or below for bounces on hard floors; \
         `adhesion(false)` where damping must not pull; located events with Runge-Kutta and \
         few contacts (`tests/scenes/contact_events.rs`).",
    );
    Ok(())
}

fn stiffness(page: &mut Page) -> Outcome<()> {
    let rtol = 1e-4;
    let mut rows = Vec::new();
    let names = ["rk", "rk, located", "arkode", "arkode, located"];
    let (mut steps, mut errors) = (vec![Vec::new(); 4], vec![Vec::new(); 4]);
    for stiffness in [1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
        let exact = fall(stiffness, Method::Rk, ContactEvents::Locate, 1e-10)?;
        let check = fall(stiffness, Method::CvodeAdams, ContactEvents::StepOver, 1e-9)?;
        let mut row = vec![
            few(stiffness),
            few(1e3 * penetration(&exact)),
            few(1e3 * rigid_penetration(stiffness, exact.body().mass())),
        ];
        let mut line = 0;
        for method in [Method::Rk, Method::Arkode] {
            for events in [ContactEvents::StepOver, ContactEvents::Locate] {
                let motion = fall(stiffness, method, events, rtol)?;
                let (report, error) = (motion.report(), error(&motion, &exact));
                let balance = report.energy_error / report.energy_scale;
                row.push(format!(
                    "{} / {} / {}",
                    count(report.steps()),
                    few(1e3 * error),
                    few(balance)
                ));
                steps[line].push((stiffness, report.steps() as f64));
                errors[line].push((stiffness, error));
                line += 1;
            }
        }
        row.push(few(1e3 * error(&check, &exact)));
        rows.push(<[String; 8]>::try_from(row).map_err(|row| format!("{} cells", row.len()))?);
    }
    page.say(format!(
        "**Stiffness.** The square of 30 cm falls by {HEIGHT} m on a floor of K_p per node, and bounces until \
         0.5 s, at rtol {rtol:e}. Each run: steps / largest error of the height of the centre of mass (mm) / \
         largest error of the energy balance, as a part of the largest energy. The reference is `rk` at \
         rtol 1e-10 with located events; the last column is how far `cvode-adams` at 1e-9 is from it."
    ));
    page.table(
        [
            "K_p (N/m)",
            "penetration (mm)",
            "rigid body (mm)",
            names[0],
            names[1],
            names[2],
            names[3],
            "check (mm)",
        ],
        &rows,
    );
    page.say(
        "Penetration shrinks with 1/sqrt(K_p) until the floor is stiffer than the body, whose nodes then \
         bounce one by one: steps grow with the frequency sqrt(K_p/m) of a node on its spring, and errors \
         with the jolts that a step does not see. At 1e7 N/m not even two references agree: the bounces of \
         single nodes amplify every error, and the trajectory is not to be had at any tolerance; penetration, steps and \
         balance still are.",
    );
    let axes = "stiffness of the floor per node (N/m)";
    let mut chart = Chart::new("Steps of the falling square, rtol 1e-4")
        .axes(axes, "steps")
        .logarithmic(true, true);
    for (name, line) in names.into_iter().zip(steps) {
        chart = chart.marked(name, line);
    }
    page.chart("contact-steps", "steps over stiffness", &chart)?;
    let mut chart = Chart::new("Error of the falling square, rtol 1e-4")
        .axes(axes, "error of the centre of mass (m)")
        .logarithmic(true, true);
    for (name, line) in names.into_iter().zip(errors) {
        chart = chart.marked(name, line);
    }
    page.chart("contact-errors", "errors over stiffness", &chart)
}

fn damping(page: &mut Page) -> Outcome<()> {
    let mut rows = Vec::new();
    for zeta in [0.0, 0.05, 0.1, 0.2, 0.4, 0.6] {
        rows.push([
            few(zeta),
            format!("{:.4}", restitution(zeta, true)?),
            format!("{:.4}", exact_restitution(zeta, true)),
            format!("{:.4}", restitution(zeta, false)?),
            format!("{:.4}", exact_restitution(zeta, false)),
        ]);
    }
    page.say(
        "**Damping.** B_p makes a bounce inelastic. A bar that bounces as one mass m leaves with a part e of \
         its speed; with zeta = B_p / (2 sqrt(K_p m)), e = exp(-zeta phi / sqrt(1 - zeta^2)), phi = pi if the \
         floor may pull until d = 0 (Hirai's law), and pi - atan(2 zeta sqrt(1 - zeta^2) / (1 - 2 \
         zeta^2)) if it may not (`adhesion(false)`).",
    );
    page.table(["zeta", "e", "closed form", "e, no pull", "closed form"], &rows);
    Ok(())
}

fn waves(page: &mut Page) -> Outcome<()> {
    let mut rows = Vec::new();
    let mut chart = Chart::new("Force on a bar of 200 cells that hits a floor")
        .axes("t c/L", "force / (E A v/c)");
    for hardness in [1.0, 10.0, 100.0, 1000.0] {
        let motion = bar(hardness, 200)?;
        let force = bar_force(&motion, hardness);
        let [time, impulse] = bar_contact(&force);
        let leaves = motion.mean_velocity(motion.last())[0] / BAR[2];
        let most = force.iter().map(|at| at.1).fold(0.0, f64::max);
        rows.push([few(hardness), few(time), few(most), few(impulse), few(leaves)]);
        // the ringing of the last one would fill the chart
        if hardness < 1000.0 {
            let until = force.iter().position(|at| at.0 > 3.6).unwrap_or(force.len());
            chart = chart.series(format!("floor {hardness} E A/L"), force[..until].to_vec());
        }
    }
    page.say(
        "**A bar against the wave equation.** On a rigid floor a bar of length L and wave speed c that comes \
         with v is pressed by E A v/c until the wave is back, at 2 L/c, and leaves with v, all of it. A floor \
         of stiffness K is felt as 1 - exp(-K c t/(E A)) of that force until then.",
    );
    page.table(
        [
            "K / (E A/L)",
            "contact until t c/L",
            "largest force / (E A v/c)",
            "impulse / (2 m v)",
            "speed after / v",
        ],
        &rows,
    );
    page.say(
        "A floor stiffer than a cell (200 E A/L here) makes the last node ring on it: the impulse stays right, \
         the force of a moment means nothing.",
    );
    let rigid = [(0.0, 0.0), (0.0, 1.0), (2.0, 1.0), (2.0, 0.0)];
    page.chart("contact-bar", "force over time", &chart.reference("rigid floor", rigid))
}
