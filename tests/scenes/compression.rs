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

/// KLU, which knows nothing of definiteness, takes the same steps.
#[test]
fn an_indefinite_newton_matrix_costs_no_steps() {
    let (structured, klu) = (squeezed(Method::Ida), squeezed(Method::IdaKlu));
    let counts = |run: &Trajectory| run.report().phases[0].counts.clone();
    let notice = counts(&structured).notice.unwrap();
    assert!(notice.contains("not positive definite"), "{notice}");
    // other factors, other round-off: a Newton iteration more or less moves a step now and then
    let (ours, theirs) = (counts(&structured).steps, counts(&klu).steps);
    assert!(ours.abs_diff(theirs) <= theirs / 10, "{ours} {theirs}");
    let apart = structured.last().u.iter().zip(&klu.last().u).map(|(a, b)| (a - b).abs());
    // rtol times 3 cm of motion is 3e-6 m
    assert!(apart.fold(0.0, f64::max) < 1e-13);
}
