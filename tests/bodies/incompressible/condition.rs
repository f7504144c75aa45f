//! What near incompressibility does to matrices, steps, and the search for an equilibrium.

use faer::{Mat, Side};
use pliant::{
    Body, Cells, Dilatation, Law, Material, Mesh, Method, Phase, Sampling, Scene, Settings,
    Statics, Strain,
};

use super::{Kind, body};

fn material(poisson: f64) -> Material {
    Material { density: 1e3, young: 1e6, poisson, viscosity: 0.0 }
}

/// Equilibria of linear bodies are found whatever their Poisson's ratio. With 0.49999 the forces of quadratic cells are so much smaller
/// than the terms that add up to them that round-off is above the tolerance, 1e-10 of the largest force: a third
/// iteration finds out that nothing becomes better.
#[test]
fn linear_bodies_come_to_rest() {
    for kind in Kind::ALL {
        for poisson in [0.3, 0.49999] {
            for &dilatation in kind.dilatations() {
                let cells = if kind.is_plane() { 8 } else { 2 };
                let body = body(kind.mesh(cells), material(poisson), dilatation);
                let body = body.strain(Strain::Cauchy).build().unwrap();
                let mut load = vec![0.0; body.dimension()];
                load[1] = 1e3;
                let phase = Phase::until(1.0).hold("left").traction("right", load);
                let name = format!("{kind:?} {dilatation:?} {poisson}");
                let rest = Scene::new(body).phase(phase).equilibrium(&Statics::default());
                let rest = rest.unwrap_or_else(|error| panic!("{name}: {error}"));
                let left = rest.residual / rest.force_scale;
                println!("{name}: {} iterations, {left:.1e} of the forces left", rest.iterations);
                let most = if poisson < 0.4 { [2.0, 1e-10] } else { [3.0, 1e-8] };
                assert!(rest.iterations as f64 <= most[0] && left < most[1], "{name}: {left:e}");
            }
        }
    }
}

/// A cantilever of 0.1 x 0.025 m in plane strain, 16 x 4 cells.
fn cantilever(poisson: f64, cells: Cells, dilatation: Dilatation) -> Body {
    let mesh = Mesh::rectangle([0.1, 0.025], [17, 5], cells).unwrap();
    let body = Body::new(mesh, material(poisson).law(Law::NeoHookean)).thickness(0.01);
    body.dilatation(dilatation).build().unwrap()
}

/// Largest over lowest eigenvalue of K of a body with its left end held.
fn condition(body: &Body) -> f64 {
    let held = &body.mesh().sets()["left"];
    let free: Vec<usize> = (0..body.dofs()).filter(|dof| !held.contains(&(dof / 2))).collect();
    let k = |i: usize, j: usize| body.stiffness().get(free[i], free[j]);
    let found = Mat::from_fn(free.len(), free.len(), k).self_adjoint_eigenvalues(Side::Lower);
    let found = found.unwrap();
    found[found.len() - 1] / found[0]
}

/// The table of docs/notes/elements.md: conditions grow as 1 / (1 - 2 nu), and steps know nothing of it; here in a quarter of
/// its span.
#[test]
fn conditions_and_steps() {
    for (cells, dilatation) in [
        (Cells::Rectangles, Dilatation::Mean),
        (Cells::Triangles6, Dilatation::Mean),
        (Cells::Rectangles9, Dilatation::Linear),
    ] {
        let mut first = None;
        for poisson in [0.3, 0.4999] {
            let body = cantilever(poisson, cells, dilatation);
            let condition = condition(&body);
            let swings = Phase::until(0.05).hold("left").traction("right", [0.0, -2e3]);
            let scene = Scene::new(body).phase(swings);
            let settings = Settings { method: Method::Arkode, rtol: 1e-4, ..Settings::default() };
            let motion = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
            let work = [motion.report().steps(), motion.report().factorizations()];
            println!(
                "{cells:?} {poisson}: condition {condition:.2e}, steps and factorizations {work:?}"
            );
            let (least, steps) = *first.get_or_insert((condition, work[0]));
            // lambda + 2 mu over mu at fixed E, beside those of 0.3
            let stiffer = |nu: f64| (1.0 - nu) / (1.0 - 2.0 * nu);
            assert!(condition / least < 3.0 * stiffer(poisson) / stiffer(0.3), "{condition:e}");
            assert!(work[0] < 2 * steps, "{work:?}, {steps}");
        }
    }
}
