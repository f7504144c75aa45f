//! Explicit Runge-Kutta methods on viscous bodies.

use pliant::output::Chart;
use pliant::rk::{DormandPrince, Integrator, Options};
use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Body, Cells, Error, Inertia, InputError, Material, Mesh, Method, Phase, Sampling, Scene,
    Settings, Strain,
};

use super::Outcome;
use super::linear::{Dense, Linear};
use super::page::{Page, count, few};

/// Where |R(-x)| = 1 for the stability polynomial of Dormand and Prince's method.
pub const LIMIT: f64 = 3.3066;
/// Time that the square is given to come to rest (s).
pub const UNTIL: f64 = 0.05;

/// Hirai's square of 30 cm, with a viscosity (Pa s).
pub fn square(nodes: usize, viscosity: f64, inertia: Inertia) -> Result<Body, InputError> {
    let mesh = Mesh::rectangle([0.3, 0.3], [nodes, nodes], Cells::Triangles)?;
    let material = Material { viscosity, ..SQUARE_MATERIAL };
    Body::new(mesh, material).strain(Strain::Cauchy).thickness(0.01).inertia(inertia).build()
}

/// It stands on its bottom, pressed flat by a tenth, and is let go.
pub fn released(nodes: usize, viscosity: f64, inertia: Inertia) -> Result<Scene, Error> {
    let scene = Scene::new(square(nodes, viscosity, inertia)?);
    Ok(scene
        .initial_displacement(|x| vec![0.0, -0.1 * x[1]])
        .phase(Phase::until(UNTIL).hold("bottom")))
}

/// Steps that a method takes for it at a tolerance.
pub fn steps(scene: &Scene, method: Method, rtol: f64) -> Result<usize, Error> {
    let settings = Settings { method, rtol, ..Settings::default() };
    Ok(scene.simulate(&settings, &Sampling::phase_ends())?.report().steps())
}

/// The same square as matrices.
pub fn matrices(nodes: usize, viscosity: f64, inertia: Inertia) -> Result<Linear, Error> {
    Ok(Linear::new(&square(nodes, viscosity, inertia)?, &(0..nodes).collect::<Vec<_>>()))
}

/// Largest number of the state after each of `steps` steps of one size, a `part` of the limit of
/// stability. It is 1 at the start, and never again if all is well.
pub fn at_fixed_steps(body: &Linear, part: f64, steps: usize) -> Outcome<Vec<f64>> {
    let h = part * LIMIT / body.spectral_radius()?;
    // tolerances that no error exceeds: the step size stays
    let options = Options::new(0.5, 1e300).initial_step(h).max_step(h);
    let mut start = vec![1.0; body.size()];
    start.resize(2 * body.size(), 0.0);
    let mut settings = DormandPrince::new(Dense(body.jacobian()), 0.0, &start, &options)?;
    let mut sizes = Vec::new();
    for _ in 0..steps {
        settings.step(f64::MAX)?;
        // displacements alone: velocities have another unit
        let u = &settings.y()[..body.size()];
        sizes.push(u.iter().fold(0.0, |most, u| f64::max(most, u.abs())));
    }
    Ok(sizes)
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## a. Explicit Runge-Kutta methods on viscous bodies");
    page.say(format!(
        "An explicit method multiplies each part of the motion by R(h lambda) in a step h, lambda \
         being an eigenvalue of the equations of motion. Where damping rules, the largest ones are \
         real and negative, and Dormand and Prince's polynomial exceeds 1 once h |lambda| > {LIMIT}. \
         So h < {LIMIT} / rho(J), however smooth the motion is."
    ));

    let body = matrices(4, 4e3, Inertia::Consistent)?;
    let parts = [0.99, 1.01, 1.02, 1.05];
    let mut chart = Chart::new("The same square at four fixed step sizes")
        .axes("step", "largest displacement (m)")
        .logarithmic(false, true);
    let mut ends = Vec::new();
    for part in parts {
        let sizes = at_fixed_steps(&body, part, 300)?;
        ends.push(*sizes.last().unwrap_or(&f64::NAN));
        let name = format!("{part} of the limit");
        chart = chart.series(name, sizes.iter().enumerate().map(|(k, size)| (k as f64, *size)));
    }
    page.say(format!(
        "**Just beyond the limit it blows up.** Hirai's 4 x 4 square with c = 4000 Pa s \
         has rho(J) = {} 1/s. From displacements of 1 m the largest one after 300 steps is {} m at \
         0.99 of the limit, {} m at 1.01, {} m at 1.02 and {} m at 1.05 of it.",
        few(body.spectral_radius()?),
        few(ends[0]),
        few(ends[1]),
        few(ends[2]),
        few(ends[3]),
    ));
    page.chart("explicit-fixed", "displacements at fixed steps", &chart)?;

    page.say(
        "**Step size control does not blow up, it crawls.** `Method::Rk` finds the limit by its \
         error test and stays there. Its steps grow with the viscosity and with 1/h^2 of the mesh, in \
         proportion to rho(J); those of BDF do not.",
    );
    let viscosities = [4e2, 1.6e3, 6.4e3, 2.56e4, 1.024e5].map(|viscosity| (4, viscosity));
    let meshes = [4, 7, 10, 13].map(|nodes| (nodes, 4e3));
    let (mut rows, mut rk, mut bdf) = (Vec::new(), [Vec::new(), Vec::new()], Vec::new());
    for (line, cases) in [&viscosities[..], &meshes[..]].into_iter().enumerate() {
        for &(nodes, viscosity) in cases {
            let scene = released(nodes, viscosity, Inertia::Consistent)?;
            let rho = matrices(nodes, viscosity, Inertia::Consistent)?.spectral_radius()?;
            let (explicit, implicit) =
                (steps(&scene, Method::Rk, 1e-3)?, steps(&scene, Method::CvodeBdf, 1e-3)?);
            rk[line].push((rho, explicit as f64));
            bdf.push((rho, implicit as f64));
            rows.push([
                format!("{nodes} x {nodes}"),
                few(viscosity),
                few(rho),
                few(rho * UNTIL / LIMIT),
                count(explicit),
                count(implicit),
            ]);
        }
    }
    page.table(
        [
            "nodes",
            "c (Pa s)",
            "rho(J) (1/s)",
            "rho T / 3.3066",
            "steps, `rk`",
            "steps, `cvode-bdf`",
        ],
        &rows,
    );
    bdf.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends = [4e3, 1e6].map(|rho| (rho, rho * UNTIL / LIMIT));
    let [viscous, meshed] = rk;
    let chart = Chart::new("Steps for 0.05 s at rtol 1e-3")
        .axes("spectral radius rho(J) (1/s)", "steps")
        .logarithmic(true, true)
        .marked("rk, more viscous", viscous)
        .marked("rk, finer mesh", meshed)
        .marked("cvode-bdf, all of them", bdf)
        .reference("rho T / 3.3066", ends);
    page.chart("explicit-steps", "steps over spectral radius", &chart)?;
    central(page)?;
    page.say(
        "**What works:** an implicit method. `Scene::spectrum` estimates rho(J) before a run \
         (`pliant check` prints it), `Method::Rk` says in its notice that stability bounds its steps, \
         and `Method::Auto` does not choose it here.",
    );
    Ok(())
}

/// Central differences, whose limit is h < 2/omega: what explicit codes for structures live by.
fn central(page: &mut Page) -> Outcome<()> {
    let mut rows = Vec::new();
    for (nodes, viscosity) in
        [(4, 0.0), (7, 0.0), (13, 0.0), (4, 40.0), (4, 400.0), (4, 4e3), (7, 4e3)]
    {
        let scene = released(nodes, viscosity, Inertia::Lumped)?;
        let body = matrices(nodes, viscosity, Inertia::Lumped)?;
        let rho = body.spectral_radius()?;
        rows.push([
            format!("{nodes} x {nodes}"),
            few(viscosity),
            few(rho),
            few(0.5 * rho * UNTIL),
            count(steps(&scene, Method::CentralDifference, 0.5)?),
            count(steps(&scene, Method::Rk, 0.5)?),
            count(steps(&scene, Method::CvodeBdf, 0.5)?),
        ]);
    }
    page.say(
        "**Without viscosity** rho(J) is the highest frequency omega, and grows with 1/h only. Central \
         differences, with lumped inertia, live by h < 2/omega at one evaluation a step, against six of \
         Runge-Kutta. Viscosity bounds them, too, and sooner: it acts on velocities that are extrapolated, and \
         leaves steps of about 1/rho(J). At rtol 0.5, where accuracy asks for little:",
    );
    page.table(
        [
            "nodes, lumped",
            "c (Pa s)",
            "rho(J) (1/s)",
            "rho T / 2",
            "steps, `central-difference`",
            "`rk`",
            "`cvode-bdf`",
        ],
        &rows,
    );
    Ok(())
}
