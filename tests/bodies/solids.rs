//! Solids in equilibrium, against published values.

use pliant::samples::{ClampedBeam, FLAG_MATERIAL};
use pliant::{Body, Cells, Material, Mesh, Phase, Plane, Scene, Statics, Strain};

/// The flag of Turek and Hron: 0.35 x 0.02 m behind a cylinder of radius 0.05 m centred at (0.2, 0.2),
/// clamped on the cylinder's arc, under gravity of 2 m/s^2. Returns the displacement of its tip
/// A = (0.6, 0.2) in mm and the number of unknowns.
fn flag(cells: Cells, along: usize, across: usize, mu: f64) -> ([f64; 2], usize) {
    let mesh = Mesh::rectangle([1.0, 0.02], [along + 1, across + 1], cells).unwrap();
    let mesh = mesh.mapped(|x| {
        let y = 0.19 + x[1];
        let arc = 0.2 + (0.05_f64.powi(2) - (y - 0.2).powi(2)).sqrt();
        [arc + x[0] * (0.6 - arc), y]
    });
    let material = Material { density: 1000.0, young: 2.8 * mu, poisson: 0.4, viscosity: 0.0 };
    let body = Body::new(mesh.unwrap(), material).thickness(1.0).strain(Strain::Green);
    let body = body.build().unwrap();
    let tip = body
        .mesh()
        .positions()
        .chunks(2)
        .position(|x| (x[0] - 0.6).abs() < 1e-12 && (x[1] - 0.2).abs() < 1e-12);
    let scene = Scene::new(body).gravity([0.0, -2.0]).phase(Phase::until(1.0).hold("left"));
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let (u, tip) = (found.displacements(), tip.unwrap());
    ([1e3 * u[2 * tip], 1e3 * u[2 * tip + 1]], u.len())
}

/// CSM1: (-7.1878, -66.103) mm; CSM2: (-0.46900, -16.974) mm.
#[test]
fn quadratic_triangles_meet_turek_and_hron() {
    for (mu, expected) in [(0.5e6, [-7.1878, -66.103]), (2.0e6, [-0.46900, -16.974])] {
        let (found, unknowns) = flag(Cells::Triangles6, 140, 8, mu);
        println!("mu {mu:e}: {found:?} with {unknowns} unknowns");
        for axis in 0..2 {
            let error = (found[axis] / expected[axis] - 1.0).abs();
            assert!(error < 1e-3, "{found:?} {expected:?}");
        }
    }
}

/// Linear triangles lock in bending: on the same meshes they come to values measured before by an
/// independent program, 3 digits trusted.
#[test]
fn linear_triangles_lock_as_known() {
    for (cells, along, across, expected) in [
        (Cells::Triangles, 35, 2, -28.98),
        (Cells::Triangles, 70, 4, -49.9),
        (Cells::Crossed, 35, 2, -44.3),
        (Cells::Triangles6, 35, 2, -65.6),
    ] {
        let ([_, down], _) = flag(cells, along, across, 0.5e6);
        assert!((down / expected - 1.0).abs() < 2e-3, "{cells} {along} x {across}: {down}");
    }
}

/// The beam of the samples is the flag, clamped on a straight edge. The arc holds the flag up to 1 mm
/// further back: as deflection goes with the fourth power of length, the beam sinks by less, by up
/// to 4/350 of 66.103 mm. Its lowest frequency is that of a slender beam in plane strain, 1.875104^2
/// sqrt(E h^2/(12 (1 - nu^2) rho L^4)), but for shear, rotary inertia and the clamp that hinders the end
/// from widening, each of the order of (h/L)^2 = 0.3 %; and as its damping is its stiffness times
/// c/E, the damping ratio is omega c/(2 E), about 1 %.
#[test]
fn the_clamped_beam_sinks_and_swings_as_the_flag() {
    let (cells, viscosity) = (Cells::Triangles6, 4000.0);
    let beam = ClampedBeam { nodes: [71, 5], cells, viscosity, ..ClampedBeam::default() };
    let scene = beam.scene().unwrap();
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let tip = 2 * 71 + 70;
    let down = 1e3 * found.displacements()[2 * tip + 1];
    assert!(down < -66.103 * (1.0 - 4.0 / 350.0) && down > -66.103, "{down}");

    let Material { density, young, poisson, .. } = FLAG_MATERIAL;
    let stiffness = young * 0.02_f64.powi(2) / (12.0 * (1.0 - poisson.powi(2)));
    let slender = 1.875104_f64.powi(2) * (stiffness / (density * 0.35_f64.powi(4))).sqrt();
    let spectrum = scene.spectrum().unwrap()[0];
    let omega = spectrum.lowest_frequency.unwrap();
    assert!((omega / slender - 1.0).abs() < 0.01, "{omega} {slender}");
    let ratio = omega * viscosity / (2.0 * young);
    assert!((spectrum.lowest_damping_ratio / ratio - 1.0).abs() < 2e-8, "{spectrum:?}");
    assert!((ratio - 0.01).abs() < 1e-3, "{ratio}");
}

/// Cook's membrane: corners (0, 0), (48, 44), (48, 60), (0, 44), plane stress, E = 1, nu = 1/3, total
/// shear 1 on the right edge; (48, 52) rises by 23.9677 +- 0.0003. Cauchy strain.
#[test]
fn quadratic_triangles_meet_cooks_membrane() {
    let cells = 32;
    let mesh = Mesh::rectangle([1.0, 1.0], [cells + 1, cells + 1], Cells::Triangles6).unwrap();
    let mesh = mesh.mapped(|x| {
        let (s, t) = (x[0], x[1]);
        [48.0 * s, 44.0 * s + t * (44.0 * (1.0 - s) + 16.0 * s)]
    });
    let material = Material { density: 1.0, young: 1.0, poisson: 1.0 / 3.0, viscosity: 0.0 };
    let body = Body::new(mesh.unwrap(), material)
        .strain(Strain::Cauchy)
        .thickness(1.0)
        .plane(Plane::Stress);
    let body = body.build().unwrap();
    let place = |node: usize| body.mesh().position(node).to_vec();
    let middle = body.mesh().sets()["right"].iter().copied();
    let middle =
        middle.min_by(|&a, &b| (place(a)[1] - 52.0).abs().total_cmp(&(place(b)[1] - 52.0).abs()));
    // uniform traction on quadratic edges: 1/6, 4/6, 1/6 of each edge's share
    let mut phase = Phase::until(1.0).hold("left");
    let share = 1.0 / cells as f64;
    for face in body.mesh().boundary_faces() {
        if face.iter().all(|&node| (place(node)[0] - 48.0).abs() < 1e-9) {
            for (node, weight) in face.iter().zip([1.0 / 6.0, 1.0 / 6.0, 4.0 / 6.0]) {
                phase = phase.load([node + 1], [0.0, share * weight]);
            }
        }
    }
    let scene = Scene::new(body).phase(phase);
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let rise = found.displacements()[2 * middle.unwrap() + 1];
    println!("Cook's membrane, {cells} x {cells} quadratic triangles: {rise:.4}");
    assert!((rise - 23.968).abs() < 0.01, "{rise}");
}
