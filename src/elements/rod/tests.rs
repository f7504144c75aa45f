//! Forces of rods against differences of their energy; helices, whose strains are known.

use nalgebra::{Rotation3, Vector3};

use super::*;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::Body;

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.4, viscosity: 300.0 };

/// Numbers that look random, within 1.
fn scattered(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|k| (12.9898 * (k as f64 + 1.0) + 78.233 * seed).sin()).collect()
}

/// A rod around a corner, with sections of two axes.
fn bent(dimension: usize) -> Rod {
    let points = [[0.0, 0.0, 0.0], [0.1, 0.02, -0.01], [0.15, 0.1, 0.05]];
    let points: Vec<Vec<f64>> = points.iter().map(|point| point[..dimension].to_vec()).collect();
    Rod::new(points, 4, RodSection::Ellipse { radii: [0.01, 0.006] })
        .end(RodSection::Ellipse { radii: [0.007, 0.008] })
}

/// Displacements by which the rod turns as a whole, and bends, stretches and swells.
fn displaced(mesh: &Mesh, most: f64) -> Vec<f64> {
    let d = mesh.dimension();
    let turn = Rotation3::from_scaled_axis(Vector3::new(0.0, 0.0, 2.5));
    let noise = scattered(mesh.node_count() * d, 0.3);
    (0..mesh.node_count())
        .flat_map(|node| {
            let x = Vector3::from_fn(|i, _| mesh.position(node).get(i).copied().unwrap_or(0.0));
            let moved = turn * x - x;
            (0..d).map(|i| moved[i] + most * noise[node * d + i]).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn forces_are_the_slope_of_the_energy() {
    for dimension in [2, 3] {
        let rod = bent(dimension);
        let elements = rod.elements(&RUBBER, &[]).unwrap();
        for most in [2e-4, 2e-3] {
            let u = displaced(&rod.mesh().unwrap(), most);
            let (mut forces, mut none) = (vec![0.0; u.len()], vec![0.0; u.len()]);
            elements.add_forces(&u, &vec![0.0; u.len()], &mut forces, &mut none).unwrap();
            let largest = forces.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            for dof in 0..u.len() {
                let step = 1e-7;
                let at = |by: f64| {
                    let mut u = u.clone();
                    u[dof] += by;
                    elements.energy(&u)
                };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                assert!(
                    (forces[dof] + slope).abs() < 1e-6 * largest + 1e-7,
                    "{dof}: {} {slope}",
                    forces[dof]
                );
            }
        }
    }
}

#[test]
fn tangents_are_the_slopes_of_the_forces() {
    for dimension in [2, 3] {
        let rod = bent(dimension);
        let body = Body::rod(rod.clone(), RUBBER).unwrap().build().unwrap();
        let elements = rod.elements(&RUBBER, &[]).unwrap();
        let u = displaced(body.mesh(), 2e-3);
        let v = scattered(u.len(), 0.7);
        let pattern = body.inertia().pattern();
        let mut stiffness = BlockMatrix::zeros(pattern, dimension);
        let mut damping = stiffness.clone();
        elements.add_tangents(&u, &v, &mut stiffness, &mut damping);
        let total = |u: &[f64], v: &[f64]| {
            let (mut forces, mut viscous) = (vec![0.0; u.len()], vec![0.0; u.len()]);
            elements.add_forces(u, v, &mut forces, &mut viscous).unwrap();
            forces.iter().zip(viscous).map(|(a, b)| a + b).collect::<Vec<f64>>()
        };
        let largest = stiffness.values().iter().fold(0.0_f64, |most, k| most.max(k.abs()));
        let most_damping = damping.values().iter().fold(0.0_f64, |most, k| most.max(k.abs()));
        for dof in 0..u.len() {
            let step = 1e-6;
            let moved = |x: &[f64], by: f64| {
                let mut x = x.to_vec();
                x[dof] += by;
                x
            };
            let (after, before) = (total(&moved(&u, step), &v), total(&moved(&u, -step), &v));
            let (faster, slower) = (total(&u, &moved(&v, 1.0)), total(&u, &moved(&v, -1.0)));
            for row in 0..u.len() {
                let slope = (before[row] - after[row]) / (2.0 * step);
                assert!((stiffness.get(row, dof) - slope).abs() < 1e-6 * largest, "{row} {dof}");
                let slope = (slower[row] - faster[row]) / 2.0;
                assert!((damping.get(row, dof) - slope).abs() < 1e-9 * most_damping, "{row} {dof}");
            }
        }
    }
}

#[test]
fn elements_of_a_helix_have_its_strains() {
    // curvature k and twist t about axes that the section carries along: x' = R e_3, R' = R [w], by closed form of one turn axis
    let (curvature, twist, stretch, length) = (Vector3::new(3.0, -8.0, 5.0), 0.0, 1.1, 0.3);
    let _ = twist;
    let turn = |s: f64| Rotation3::from_scaled_axis(curvature * s);
    let place = |s: f64| {
        let (norm, axis) = (curvature.norm(), curvature.normalize());
        let e = Vector3::z() * stretch;
        let along = axis * axis.dot(&e);
        let across = e - along;
        along * s
            + across * ((norm * s).sin() / norm)
            + axis.cross(&across) * ((1.0 - (norm * s).cos()) / norm)
    };
    for (from, to) in [(0.0, length), (0.0, 0.01), (0.1, 0.13)] {
        let at = |s: f64| Section {
            x: place(s).into(),
            d: [0, 1].map(|i| (turn(s) * Vector3::ith(i, 1.0)).into()),
        };
        let strains = Deformed::new(to - from, [at(from), at(to)]).strains();
        let kappa = Vector3::from(strains.kappa) - curvature;
        let gamma = Vector3::from(strains.gamma) - Vector3::z() * stretch;
        assert!(kappa.norm() < 1e-11 && gamma.norm() < 1e-12, "{kappa} {gamma}");
    }
}
