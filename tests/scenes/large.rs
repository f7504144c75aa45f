//! A solid so large that its Newton systems are solved by iterations and not by factors.

use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Body, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells, Strain, Trajectory,
};
use rayon::ThreadPoolBuilder;

/// A block that stands on the ground and sags, of 9450 unknowns.
fn block() -> Scene {
    let mesh = Mesh::cuboid([0.1; 3], [15; 3], SolidCells::Tetrahedra).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Green).build().unwrap();
    Scene::new(body).gravity([3.0, 0.0, -9.8]).phase(Phase::until(0.001).hold("bottom"))
}

fn motion(scene: &Scene, method: Method, rtol: f64) -> Trajectory {
    let settings = Settings { method, rtol, ..Settings::default() };
    scene.simulate(&settings, &Sampling::every(0.0005)).unwrap()
}

/// Largest distance of a displacement from another method's, relative to the largest displacement.
fn apart(a: &Trajectory, b: &Trajectory) -> f64 {
    let size = b.last().u.iter().fold(0.0, |size: f64, u| size.max(u.abs()));
    let pairs = a.samples().iter().zip(b.samples());
    let pairs = pairs.flat_map(|(a, b)| a.u.iter().zip(&b.u));
    pairs.fold(0.0, |apart: f64, (a, b)| apart.max((a - b).abs())) / size
}

/// Implicit methods without a single factor move as an explicit one does, which solves no such systems.
#[test]
fn iterations_give_the_motion() {
    let scene = block();
    let explicit = motion(&scene, Method::Rk, 1e-6);
    assert_eq!(explicit.report().linear_iterations(), 0);
    for method in [Method::CvodeBdf, Method::Arkode, Method::Ida, Method::Rosenbrock] {
        let implicit = motion(&scene, method, 1e-6);
        let report = implicit.report();
        assert_eq!(report.factorizations(), 0, "{method}");
        assert!(report.linear_iterations() > report.steps(), "{method}");
        let apart = apart(&implicit, &explicit);
        assert!(apart < 1e-4, "{method}: {apart:e}");
    }
}

/// However many threads there are, a motion is the same to the last bit.
#[test]
fn threads_iterate_alike() {
    let scene = block();
    let on = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| motion(&scene, Method::CvodeBdf, 1e-4))
    };
    let (one, three) = (on(1), on(3));
    assert!(one.report().linear_iterations() > 0);
    assert_eq!(one.samples(), three.samples());
}
