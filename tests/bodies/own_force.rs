//! The forces of the example `own_force`, which are not of the crate: tangents against finite differences of
//! the forces, and the force of the magnet against its potential. What becomes of forces without tangents is in
//! `differences`.

mod differences;
#[path = "../../examples/own_force/forces.rs"]
mod forces;

use forces::{Magnet, Wind};
use pliant::force::{Force, NodalForces};
use pliant::samples::SQUARE_MATERIAL;
use pliant::{Body, Cells, Mesh, Phase, Scene, Strain};

fn body() -> Body {
    let mesh = Mesh::rectangle([0.02, 0.02], [2, 2], Cells::Triangles).unwrap();
    Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap()
}

fn magnet(body: &Body) -> Magnet {
    Magnet::new(body, [0.03, 0.01], 2e-3, 0.01)
}

fn wind() -> Wind {
    Wind::new(vec![0, 2, 3], 0.2, |t| [3.0 * t, -1.0])
}

/// Displacements (m) and velocities (m/s).
fn state() -> [Vec<f64>; 2] {
    let wave = |k: usize, phase: f64| (0.7 * k as f64 + phase).sin();
    [(0..8).map(|k| 2e-3 * wave(k, 0.0)).collect(), (0..8).map(|k| wave(k, 1.0)).collect()]
}

#[test]
fn tangents_are_the_derivatives_of_the_forces() {
    let [u, v] = state();
    let with = |act: bool| {
        let (body, scene) = (body(), Scene::new(body()).phase(Phase::until(1.0)));
        let scene = if act { scene.force(magnet(&body)).force(wind()) } else { scene };
        scene.equations(0, &[0.0; 8]).unwrap()
    };
    let (mut all, mut bare) = (with(true), with(false));
    // what the body does itself is left out
    let mut own = |u: &[f64], v: &[f64]| {
        let [mut f, mut without] = [vec![0.0; 8], vec![0.0; 8]];
        all.forces(0.7, u, v, &mut f).unwrap();
        bare.forces(0.7, u, v, &mut without).unwrap();
        f.iter().zip(without).map(|(f, without)| f - without).collect::<Vec<f64>>()
    };
    let mut slopes = Vec::new();
    for by_u in [true, false] {
        let h = if by_u { 1e-6 } else { 1e-3 };
        for j in 0..8 {
            let mut shifted = |by: f64| {
                let [mut u, mut v] = [u.clone(), v.clone()];
                if by_u {
                    u[j] += by
                } else {
                    v[j] += by
                }
                own(&u, &v)
            };
            let (ahead, behind) = (shifted(h), shifted(-h));
            slopes.push((0..8).map(|i| (behind[i] - ahead[i]) / (2.0 * h)).collect::<Vec<f64>>());
        }
    }
    let all = all.tangents(0.7, &u, &v).map(|matrix| matrix.to_dense());
    let bare = bare.tangents(0.7, &u, &v).map(|matrix| matrix.to_dense());
    for (kind, (all, bare)) in all.iter().zip(&bare).enumerate() {
        let slopes = &slopes[8 * kind..][..8];
        let scale = slopes.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(scale > 0.0);
        for (j, column) in slopes.iter().enumerate() {
            for (i, slope) in column.iter().enumerate() {
                let tangent = all[(i, j)] - bare[(i, j)];
                println!("{kind} ({i}, {j}): {tangent:.6e} {slope:.6e}");
                // of central differences: (h/size)^2, and round-off of the forces of the body over h
                assert!((tangent - slope).abs() < 1e-5 * scale, "{kind} ({i}, {j})");
            }
        }
    }
}

#[test]
fn the_force_of_the_magnet_is_the_slope_of_its_potential() {
    let [u, v] = state();
    let (magnet, mut f) = (magnet(&body()), NodalForces::zeros(8));
    magnet.add_forces(0.0, &u, &v, &mut f).unwrap();
    let largest = f.conservative.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    for j in 0..8 {
        let energy = |by: f64| {
            let mut u = u.clone();
            u[j] += by;
            magnet.potential(0.0, &u)
        };
        let slope = (energy(-1e-6) - energy(1e-6)) / 2e-6;
        // (h/size)^2 of the difference is 1e-8
        assert!((f.conservative[j] - slope).abs() < 1e-6 * largest, "{j}");
    }
}

/// What the wind supplies, less what becomes heat, is its power on the body; the heat is that of the stream past
/// the nodes.
#[test]
fn the_power_of_the_wind_is_accounted_for() {
    let [u, v] = state();
    let mut f = NodalForces::zeros(8);
    wind().add_forces(0.7, &u, &v, &mut f).unwrap();
    let power: f64 = f.dissipative.iter().zip(&v).map(|(f, v)| f * v).sum();
    let heat = f.carried_heat - power;
    let expected: f64 =
        [0, 2, 3].map(|n| 0.1 * (2.1 - v[2 * n]).hypot(-1.0 - v[2 * n + 1]).powi(3)).iter().sum();
    assert!((heat / expected - 1.0).abs() < 1e-13, "{heat} {expected}");
    assert!((f.carried_power - heat - power).abs() < 1e-13 * heat);
}
