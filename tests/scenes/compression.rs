//! A column squeezed so slowly that steps are longer than the time in which it would buckle: the
//! Newton matrix loses its positive definiteness, and is factorized all the same.

use pliant::{
    Body, Cells, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Strain, Trajectory,
};

fn squeezed(method: Method) -> Trajectory {
    let mesh = Mesh::rectangle([0.1, 0.02], [21, 5], Cells::Rectangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 40.0 };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build().unwrap();
    let squeeze = Phase::until(200.0).hold("left").move_nodes("right", [-0.03 / 200.0, 0.0]);
    let settings = Settings { method, rtol: 1e-4, ..Settings::default() };
    Scene::new(body).phase(squeeze).simulate(&settings, &Sampling::every(20.0)).unwrap()
}

/// Two forms of the equations by two integrators come to the same state without failures of Newton's iteration.
#[test]
fn an_indefinite_newton_matrix_costs_no_steps() {
    let runs = [Method::Ida, Method::CvodeBdf].map(squeezed);
    for run in &runs {
        let counts = &run.report().phases[0].counts;
        let notice = counts.notice.as_deref().unwrap_or_default();
        println!("{} steps, {} failures: {notice}", counts.steps, counts.convergence_failures);
        assert!(notice.contains("not positive definite"), "{notice}");
        assert_eq!(counts.convergence_failures, 0);
    }
    let [a, b] = &runs;
    let apart = a.last().u.iter().zip(&b.last().u).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{apart:e} m apart");
    // rtol times 3 cm of motion is 3e-6 m
    assert!(apart < 1e-13, "{apart:e}");
}
