//! Fibres in all cells: forces are derivatives of the energy, tangents those of forces.

use crate::base::sparse::BlockMatrix;
use crate::elements::body::tests::noise;
use crate::elements::body::{Body, Contraction};
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::{Fibres, Hill, Law};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

fn meshes() -> Vec<Mesh> {
    let plane = |cells| Mesh::rectangle([0.3, 0.2], [4, 3], cells).unwrap();
    let solid = |cells| Mesh::cuboid([0.3, 0.2, 0.2], [4, 3, 3], cells).unwrap();
    let membrane = plane(Cells::Triangles).mapped(|x| [x[0], x[1], 0.3 * x[0]]);
    vec![
        plane(Cells::Triangles),
        plane(Cells::Rectangles),
        plane(Cells::Triangles6),
        plane(Cells::Rectangles9),
        membrane.unwrap(),
        solid(SolidCells::Tetrahedra),
        solid(SolidCells::Hexahedra),
        solid(SolidCells::Tetrahedra10),
        solid(SolidCells::Hexahedra20),
        solid(SolidCells::Hexahedra27),
    ]
}

fn with_fibres(mesh: Mesh, fibres: [Fibres; 2]) -> Body {
    let is_thin = mesh.kind().dimension() == 2;
    let [first, second] = fibres;
    let substance = SQUARE_MATERIAL.law(Law::NeoHookean).fibres(first).fibres(second);
    let body = Body::new(mesh, substance);
    let body = if is_thin { body.thickness(0.01) } else { body };
    body.build().unwrap()
}

fn pair(dimension: usize) -> [Fibres; 2] {
    let along = |direction: &[f64]| Fibres::along(&direction[..dimension], 1e5).stiffening(3.0);
    let axis: &[f64] = if dimension == 3 { &[0.2, 1.0, 0.0] } else { &[] };
    let around = Fibres::around(&[-0.1, -0.2, 0.05][..dimension], axis, 2e5);
    [along(&[1.0, 0.4, -0.3]), if dimension == 3 { around.pitch(0.4) } else { around }]
}

/// Along one direction, by central differences: off by 1e-8 of the largest, by terms of third order and
/// round-off; more at points where a fibre is just becoming taut, of which there is none here.
#[test]
fn forces_and_tangents_are_derivatives() {
    for mesh in meshes() {
        let kind = mesh.kind();
        let dimension = mesh.dimension();
        let body = with_fibres(mesh, pair(dimension));
        let (n, h) = (body.dofs(), 1e-7);
        let (u, x) = (noise(n, 0.02, 1.0), noise(n, 1.0, 3.0));
        let still = vec![0.0; n];
        let force = body.reinforcement().unwrap();
        let moved = |by: f64| -> Vec<f64> { u.iter().zip(&x).map(|(u, x)| u + by * x).collect() };
        let at = |by: f64| {
            let mut forces = NodalForces::zeros(n);
            force.add_forces(0.0, &moved(by), &still, &mut forces).unwrap();
            forces.conservative.to_vec()
        };
        let by_energy =
            (force.potential(0.0, &moved(h)) - force.potential(0.0, &moved(-h))) / (2.0 * h);
        let work: f64 = at(0.0).iter().zip(&x).map(|(f, x)| f * x).sum();
        assert!(work.abs() > 1.0, "{kind:?}: {work}");
        assert!((work + by_energy).abs() < 1e-6 * work.abs(), "{kind:?}: {work} {by_energy}");
        let zeros = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
        let (mut stiffness, mut damping) = (zeros.clone(), zeros);
        force.add_tangents(0.0, &u, &still, &mut stiffness, &mut damping);
        assert!(damping.values.iter().all(|value| *value == 0.0));
        let mut product = vec![0.0; n];
        stiffness.add_product(1.0, &x, &mut product);
        let largest = product.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
        let (behind, ahead) = (at(-h), at(h));
        for (i, product) in product.iter().enumerate() {
            let apart = ((behind[i] - ahead[i]) / (2.0 * h) - product).abs();
            assert!(apart < 1e-6 * largest, "{kind:?} {i}: {apart:e} of {largest:e}");
        }
    }
}

/// The same of fibres that pull by a stress of their own, which has the potential stress V (l - 1) with the mean stretch l.
#[test]
fn pulls_and_their_tangents_are_derivatives() {
    for mesh in meshes() {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let body = Body::new(mesh, SQUARE_MATERIAL);
        let body = if kind.dimension() == 2 { body.thickness(0.01) } else { body };
        let body = body.build().unwrap();
        let (n, h, stress) = (body.dofs(), 1e-7, 3e5);
        let (u, x) = (noise(n, 0.02, 1.0), noise(n, 1.0, 3.0));
        let cells: Vec<usize> = (0..body.mesh().cell_count()).collect();
        for Fibres { course, .. } in pair(dimension) {
            let strands = body.strands(&cells, &course).unwrap();
            let moved =
                |by: f64| -> Vec<f64> { u.iter().zip(&x).map(|(u, x)| u + by * x).collect() };
            let at = |by: f64| {
                let mut forces = vec![0.0; n];
                strands.add_forces(stress, &moved(by), &mut forces).unwrap();
                forces
            };
            let potential = |by: f64| stress * body.volume() * strands.mean_stretch(&moved(by));
            let by_potential = (potential(h) - potential(-h)) / (2.0 * h);
            let work: f64 = at(0.0).iter().zip(&x).map(|(f, x)| f * x).sum();
            assert!(work.abs() > 1.0, "{kind:?}: {work}");
            assert!(
                (work + by_potential).abs() < 1e-6 * work.abs(),
                "{kind:?}: {work} {by_potential}"
            );
            let zeros = BlockMatrix::zeros(body.inertia().pattern(), dimension);
            let (mut stiffness, mut damping) = (zeros.clone(), zeros);
            strands.add_tangents(stress, &u, &mut stiffness, &mut damping);
            let mut product = vec![0.0; n];
            stiffness.add_product(1.0, &x, &mut product);
            let largest = product.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
            let (behind, ahead) = (at(-h), at(h));
            for (i, product) in product.iter().enumerate() {
                let apart = ((behind[i] - ahead[i]) / (2.0 * h) - product).abs();
                assert!(apart < 1e-6 * largest, "{kind:?} {i}: {apart:e} of {largest:e}");
            }
        }
    }
}

/// Tangents of a contraction by Hill's law, by displacements and by velocities, are derivatives of its forces. Some fibres lengthen and some shorten; at the fastest shortening
/// the slope jumps, which none of them comes near.
#[test]
fn tangents_of_contractions_are_derivatives() {
    let hill = Hill { optimal: 1.1, width: 0.1, rate: 3.0, ..Hill::new(4e5) };
    let contraction = Contraction { law: &hill, stress: 3e5 };
    for mesh in meshes() {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let body = Body::new(mesh, SQUARE_MATERIAL);
        let body = if kind.dimension() == 2 { body.thickness(0.01) } else { body };
        let body = body.build().unwrap();
        let (n, h) = (body.dofs(), 1e-7);
        let (u, v) = (noise(n, 0.01, 1.0), noise(n, 0.02, 2.0));
        let (x, none) = (noise(n, 1.0, 3.0), vec![0.0; n]);
        let cells: Vec<usize> = (0..body.mesh().cell_count()).collect();
        for Fibres { course, .. } in pair(dimension) {
            let strands = body.strands(&cells, &course).unwrap();
            let zeros = BlockMatrix::zeros(body.inertia().pattern(), dimension);
            let (mut stiffness, mut damping) = (zeros.clone(), zeros);
            strands.add_contraction_tangents(contraction, &u, &v, &mut stiffness, &mut damping);
            for (tangent, [by_u, by_v]) in [(&stiffness, [&x, &none]), (&damping, [&none, &x])] {
                let moved = |from: &[f64], x: &[f64], by: f64| -> Vec<f64> {
                    from.iter().zip(x).map(|(from, x)| from + by * x).collect()
                };
                let at = |by: f64| {
                    let mut forces = vec![0.0; n];
                    let (u, v) = (moved(&u, by_u, by), moved(&v, by_v, by));
                    strands.contract(contraction, &u, &v, &mut forces).unwrap();
                    forces
                };
                let mut product = vec![0.0; n];
                tangent.add_product(1.0, &x, &mut product);
                let largest = product.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
                assert!(largest > 1.0, "{kind:?}: {largest}");
                let (behind, ahead) = (at(-h), at(h));
                for (i, product) in product.iter().enumerate() {
                    let apart = ((behind[i] - ahead[i]) / (2.0 * h) - product).abs();
                    assert!(apart < 1e-6 * largest, "{kind:?} {i}: {apart:e} of {largest:e}");
                }
            }
        }
    }
}

/// K contains the fibres as if slightly stretched: along x they stiffen a bar of one row of cells by young
/// A / length.
#[test]
fn they_stiffen_the_undeformed_shape() {
    let mesh = Mesh::rectangle([1.0, 0.1], [5, 2], Cells::Rectangles).unwrap();
    let body = |substance: crate::Substance| {
        Body::new(mesh.clone(), substance).thickness(0.01).build().unwrap()
    };
    let plain = body(SQUARE_MATERIAL.into());
    let stiff = body(SQUARE_MATERIAL.fibres(Fibres::along([3.0, 0.0], 7e5)));
    let pulled: Vec<f64> = mesh.positions().chunks(2).flat_map(|x| [x[0], 0.0]).collect();
    let energy = |body: &Body| {
        let mut forces = vec![0.0; pulled.len()];
        body.stiffness().add_product(1.0, &pulled, &mut forces);
        forces.iter().zip(&pulled).map(|(f, u)| f * u).sum::<f64>()
    };
    assert!((energy(&stiff) - energy(&plain) - 7e5 * 1e-3).abs() < 1e-9 * 7e2);
}

/// Fibres that cannot exist are refused, with an error that names the key, the value and the help.
#[test]
fn nonsense_is_named() {
    let build = |fibres: Fibres| {
        let mesh = Mesh::cuboid([0.2, 0.2, 0.2], [3, 3, 3], SolidCells::Hexahedra).unwrap();
        Body::new(mesh, SQUARE_MATERIAL.fibres(fibres)).build().unwrap_err().to_string()
    };
    for (fibres, start) in [
        (
            Fibres::along([0.0; 3], 1e5),
            "fibres.along = [0.0, 0.0, 0.0] cannot be used: a direction needs a length",
        ),
        (
            Fibres::along([1.0, 0.0], 1e5),
            "fibres.along = [1.0, 0.0] cannot be used: it needs 3 numbers",
        ),
        (Fibres::along([1.0, 0.0, 0.0], -1.0), "fibres.young = -1"),
        (Fibres::along([1.0, 0.0, 0.0], 1e5).stiffening(f64::NAN), "fibres.stiffening = NaN"),
        (Fibres::around([0.0; 3], [], 1e5), "fibres.axis = [] cannot be used: it needs 3 numbers"),
    ] {
        let message = build(fibres);
        assert!(message.starts_with(start), "{message}");
    }
    let cauchy =
        Body::new(Mesh::bar(1.0, 3).unwrap(), SQUARE_MATERIAL.fibres(Fibres::along([1.0], 1.0)));
    let message = cauchy.strain(crate::Strain::Cauchy).area(1.0).build().unwrap_err().to_string();
    assert!(message.contains("fibres take tension alone"), "{message}");
}
