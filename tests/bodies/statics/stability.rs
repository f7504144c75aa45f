//! Equilibria that turn unstable, snap through, collapse or are held by forces alone, against closed
//! forms.

use std::f64::consts::TAU;

use pliant::mesh::CellKind;
use pliant::{
    Axis, Body, Cells, Error, Material, Mesh, Obstacle, Phase, Scene, Stability, Statics, Strain,
};

use super::{RUBBER, frequency, solve};

/// A truss of two bars from (-1, 0) and (1, 0) to the apex (0, `height`), E A = 10.
pub(super) fn truss(height: f64, phase: Phase) -> Scene {
    let material = Material { density: 1.0, young: 10.0, poisson: 0.3, viscosity: 0.0 };
    let positions = vec![-1.0, 0.0, 0.0, height, 1.0, 0.0];
    let mesh = Mesh::new(2, positions, CellKind::Segment, vec![0, 1, 1, 2]).unwrap();
    let body = Body::new(mesh, material).area(1.0).strain(Strain::Green).build().unwrap();
    Scene::new(body).phase(phase.hold([1, 3]))
}

/// With the apex at y, each bar of natural length L is strained by e = (y^2 - h^2)/(2 L^2): the
/// apex pushes down with 2 E A e y/L, and resists a push aside with 2 (E A/L)(1/L^2 + e), which
/// is negative once y^2 < h^2 - 2.
#[test]
fn a_truss_pressed_flat_turns_unstable_where_it_must() {
    let (h, square): (f64, f64) = (2.0, 5.0);
    for y in [1.9, 1.6, 1.3, 1.0, 0.5] {
        let scene = truss(h, Phase::until(1.0).move_axis([2], Axis::Y, y - h));
        let equilibrium = solve(&scene);
        let e = (y * y - h * h) / (2.0 * square);
        let force = 2.0 * 10.0 * e * y / square.sqrt();
        let found = equilibrium.sample().multipliers[0];
        assert!((found - force).abs() < 1e-13, "y {y}: {found} {force}");
        // M at the apex: (rho A L/3) from each bar
        let omega_square =
            2.0 * 10.0 / square.sqrt() * (1.0 / square + e) / (2.0 * square.sqrt() / 3.0);
        let found = match equilibrium.stability {
            Stability::Stable { frequency } => (TAU * frequency).powi(2),
            Stability::Unstable { growth } => -growth * growth,
            Stability::Neutral => 0.0,
        };
        assert!((found - omega_square).abs() < 1e-13, "y {y}: {found} {omega_square}");
        assert_eq!(y * y < h * h - 2.0, found < 0.0);
    }
}

/// A flat truss snaps through under more than its limit load, to the other side.
#[test]
fn a_flat_truss_snaps_through() {
    let (h, square): (f64, f64) = (0.2, 1.04);
    let force = |y: f64| 2.0 * 10.0 * (y * y - h * h) / (2.0 * square) * y / square.sqrt();
    let limit = -force(h / 3f64.sqrt());
    for load in [0.9 * limit, 1.1 * limit] {
        let equilibrium = solve(&truss(h, Phase::until(1.0).load([2], [0.0, -load])));
        let y = h + equilibrium.displacements()[3];
        assert!((force(y) + load).abs() < 1e-9 * limit, "{y}: {} {load}", force(y));
        assert_eq!(y > h / 3f64.sqrt(), load < limit, "{y}");
        frequency(&equilibrium);
    }
}

/// A bar of 10 cm with E A = 10 N.
fn bar() -> Body {
    let material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
    let mesh = Mesh::bar(0.1, 6).unwrap();
    Body::new(mesh, material).area(2e-4).strain(Strain::Green).build().unwrap()
}

/// Beyond E A/(3 sqrt 3) a bar of St. Venant-Kirchhoff material collapses.
#[test]
fn a_collapse_is_told_with_the_load_that_was_reached() {
    let limit = 5e4 * 2e-4 / (3.0 * 3f64.sqrt());
    let scene = Scene::new(bar())
        .phase(Phase::until(1.0).named("crush").hold("left").load("right", [-1.5 * limit]));
    let Err(Error::Statics(failure)) = scene.equilibrium(&Statics::default()) else {
        panic!("it must not converge");
    };
    let reached = 1.0 / 1.5;
    // the last load step is 1e-3 at least
    assert!(failure.fraction < reached && failure.fraction > reached - 2e-3, "{failure}");
    assert!(failure.cause.contains("is inverted"), "{failure}");
    let message = failure.to_string();
    assert!(message.starts_with("phase \"crush\": no equilibrium at 66."), "{message}");
    // the state kept is an equilibrium: (E A / 2)(s^3 - s) is the load there
    let s = 1.0 + failure.trajectory.last().u[5] / 0.1;
    let force = 0.5 * 5e4 * 2e-4 * (s.powi(3) - s);
    assert!((force / (-1.5 * limit * failure.fraction) - 1.0).abs() < 1e-13);
}

/// Nothing holds a block but the floor: it sinks until the floor carries its weight, and slides
/// without force.
#[test]
fn a_block_rests_on_the_floor() {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(1000.0);
    let scene = Scene::new(body).gravity([0.0, -9.8]).obstacle(floor).phase(Phase::until(1.0));
    let equilibrium = solve(&scene);
    let u = equilibrium.displacements();
    let carried: f64 = u.iter().skip(1).step_by(2).take(4).map(|u| -1000.0 * u.min(0.0)).sum();
    assert!((carried / (0.9 * 9.8) - 1.0).abs() < 1e-12, "{carried}");
    assert_eq!(equilibrium.stability, Stability::Neutral);
}

/// A square held by one corner, let go with the corner at its lower left, hangs below it.
#[test]
fn a_square_hangs_from_its_corner() {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body = Body::new(mesh, RUBBER).thickness(0.01).strain(Strain::Green).build().unwrap();
    let scene = Scene::new(body).gravity([0.0, -9.8]).phase(Phase::until(1.0).hold([4]));
    let equilibrium = solve(&scene);
    let centre = equilibrium.trajectory().centre_of_mass(equilibrium.sample());
    assert!((centre[0] - 0.3).abs() < 1e-7 && centre[1] < -0.2, "{centre:?}");
    let hung = &equilibrium.sample().multipliers;
    assert!(hung[0].abs() < 1e-7 && (hung[1] - 0.9 * 9.8).abs() < 1e-8, "{hung:?}");
    // a stiff one would swing with omega^2 = m g r/J, J = 2 m a^2/3, r = a/sqrt 2; this one is soft
    let stiff = (9.8 / 2f64.sqrt() / (2.0 / 3.0 * 0.3)).sqrt() / TAU;
    assert!((frequency(&equilibrium) / stiff - 1.0).abs() < 0.02, "{}", frequency(&equilibrium));
}

/// A column of 10 x 0.2 cm under 1.15 of Euler's load, straight but for what its clamp does across: it is in equilibrium, and a
/// push aside grows, whatever Poisson's ratio.
#[test]
fn a_column_beyond_buckling_is_unstable() {
    for poisson in [0.0, 0.3] {
        let material = Material { density: 1000.0, young: 1e6, poisson, viscosity: 0.0 };
        let mesh = Mesh::rectangle([0.1, 0.002], [21, 3], Cells::Triangles6).unwrap();
        let body = Body::new(mesh, material).thickness(0.01).strain(Strain::Green).build().unwrap();
        // plane strain: E/(1 - nu^2)
        let euler = std::f64::consts::PI.powi(2) * 1e6 / (1.0 - poisson * poisson)
            * (0.01 * 0.002_f64.powi(3) / 12.0)
            / (4.0 * 0.1 * 0.1);
        for (part, is_unstable) in [(0.9, false), (1.15, true)] {
            let pressed = Phase::until(1.0).hold("left").load_total("right", [-part * euler, 0.0]);
            let found = solve(&Scene::new(body.clone()).phase(pressed));
            println!("nu {poisson}, {part}: {found}");
            assert_eq!(
                matches!(found.stability, Stability::Unstable { .. }),
                is_unstable,
                "{found}"
            );
        }
    }
}
