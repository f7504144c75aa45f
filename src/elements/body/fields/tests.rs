//! Closed forms of uniform strain, and consistency of arbitrary fields with nodal forces, energies and rigid
//! motions.

use nalgebra::{Matrix3, Vector3};

use super::super::tests::{bodies, noise, rigid_motion};
use super::super::{Body, CellSelection, Strain};
use crate::elements::force::NodalForces;
use crate::elements::material::{Material, Plane};
use crate::elements::mesh::{CellKind, Cells, Mesh, SolidCells};

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };

/// Displacements that map the undeformed position X of every node to A X.
fn mapped(mesh: &Mesh, a: &Matrix3<f64>) -> Vec<f64> {
    mesh.field(|x| {
        let natural = Vector3::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0));
        (a * natural - natural).as_slice()[..x.len()].to_vec()
    })
}

/// Compares all cells and nodes of `body` under A with `strain` and `stress`, to round-off.
fn check(body: &Body, a: &Matrix3<f64>, strain: Matrix3<f64>, stress: Matrix3<f64>) {
    let scale = body.material().young;
    let u = mapped(body.mesh(), a);
    let of_cells = body.cell_fields(&u).into_iter().map(|field| (field.strain, field.stress));
    let of_nodes = body.nodal_fields(&u).into_iter().map(|field| (field.strain, field.stress));
    for (found_strain, found_stress) in of_cells.chain(of_nodes) {
        let apart = (Matrix3::from(found_strain) - strain).abs().max();
        assert!(apart < 1e-13, "{body:?}: {found_strain:?} is not {strain}");
        let apart = (Matrix3::from(found_stress) - stress).abs().max();
        assert!(apart < 1e-12 * scale, "{body:?}: {found_stress:?} is not {stress}");
    }
}

fn flat(cells: Cells, strain: Strain, plane: Plane) -> Body {
    let mesh = Mesh::rectangle([0.2, 0.1], [3, 4], cells).unwrap();
    Body::new(mesh, SOFT).thickness(0.01).strain(strain).plane(plane).build().unwrap()
}

const FLAT_CELLS: [Cells; 4] =
    [Cells::Triangles, Cells::Triangles6, Cells::Rectangles, Cells::Rectangles9];
const TURN: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);

fn diagonal(entries: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&entries.into())
}

#[test]
fn stretch_and_shear_in_plane_strain() {
    let (lambda, mu) = (SOFT.elastic().lambda, SOFT.elastic().mu);
    for cells in FLAT_CELLS {
        let small = flat(cells, Strain::Cauchy, Plane::Strain);
        let (x, y, k) = (0.02, -0.01, 0.03);
        let strained = Matrix3::new(1.0 + x, k, 0.0, 0.0, 1.0 + y, 0.0, 0.0, 0.0, 1.0);
        let pressure = lambda * (x + y);
        let stress = Matrix3::new(
            pressure + 2.0 * mu * x,
            mu * k,
            0.0,
            mu * k,
            pressure + 2.0 * mu * y,
            0.0,
            0.0,
            0.0,
            pressure,
        );
        let strain = Matrix3::new(x, k / 2.0, 0.0, k / 2.0, y, 0.0, 0.0, 0.0, 0.0);
        check(&small, &strained, strain, stress);

        let large = flat(cells, Strain::Green, Plane::Strain);
        // E = (s^2 - 1)/2; force s S per natural length acts on the present one of the other side
        let (ex, ey) = (0.22, -0.095);
        let [sx, sy, sz] = [ex, ey, 0.0].map(|e| lambda * (ex + ey) + 2.0 * mu * e);
        let stress = diagonal([sx * 1.2 / 0.9, sy * 0.9 / 1.2, sz / (1.2 * 0.9)]);
        check(&large, &diagonal([1.2, 0.9, 1.0]), diagonal([ex, ey, 0.0]), stress);

        // simple shear keeps the volume: sigma = F S F^T
        let k = 0.5_f64;
        let sheared = Matrix3::new(1.0, k, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        let across = lambda * k * k / 2.0;
        let (xy, yy) = (mu * k, across + mu * k * k);
        let strain = Matrix3::new(0.0, k / 2.0, 0.0, k / 2.0, k * k / 2.0, 0.0, 0.0, 0.0, 0.0);
        let xx = across + 2.0 * k * xy + k * k * yy;
        let shear = xy + k * yy;
        let stress = Matrix3::new(xx, shear, 0.0, shear, yy, 0.0, 0.0, 0.0, across);
        check(&large, &sheared, strain, stress);
    }
}

#[test]
fn plane_stress_has_none_across() {
    let Material { young, poisson, .. } = SOFT;
    let modulus = young / (1.0 - poisson * poisson);
    let (x, y) = (0.02, -0.005);
    let across = -poisson / (1.0 - poisson) * (x + y);
    let (sx, sy) = (modulus * (x + poisson * y), modulus * (y + poisson * x));
    for cells in FLAT_CELLS {
        let small = flat(cells, Strain::Cauchy, Plane::Stress);
        let (strain, stress) = (diagonal([x, y, across]), diagonal([sx, sy, 0.0]));
        let stretched = diagonal([1.0 + x, 1.0 + y, 1.0]);
        check(&small, &stretched, strain, stress);
        for field in small.cell_fields(&mapped(small.mesh(), &stretched)) {
            let expected = (sx * sx - sx * sy + sy * sy).sqrt();
            assert!((field.von_mises() / expected - 1.0).abs() < 1e-12);
        }
        let large = flat(cells, Strain::Green, Plane::Stress);
        let (a, b) = (1.0 + x, 1.0 + y);
        let (ex, ey) = ((a * a - 1.0) / 2.0, (b * b - 1.0) / 2.0);
        let sx = modulus * (ex + poisson * ey) * a / b;
        let sy = modulus * (ey + poisson * ex) * b / a;
        let strain = diagonal([ex, ey, -poisson / (1.0 - poisson) * (ex + ey)]);
        check(&large, &stretched, strain, diagonal([sx, sy, 0.0]));
    }
}

#[test]
fn membranes_carry_their_tensors_with_them() {
    for plane in [Plane::Strain, Plane::Stress] {
        for (strain, a) in [
            (Strain::Cauchy, Matrix3::new(1.02, 0.01, 0.0, 0.0, 0.99, 0.0, 0.0, 0.0, 1.0)),
            (Strain::Green, Matrix3::new(1.3, 0.4, 0.0, -0.1, 0.8, 0.0, 0.0, 0.0, 1.0)),
        ] {
            let flat = flat(Cells::Rectangles, strain, plane);
            let field = flat.cell_fields(&mapped(flat.mesh(), &a))[0];
            let turned = |tensor: [[f64; 3]; 3]| TURN * Matrix3::from(tensor) * TURN.transpose();
            let mesh = flat.mesh().clone().mapped(|x| [0.0, x[0], x[1]]).unwrap();
            let body = Body::new(mesh, SOFT).thickness(0.01).strain(strain).plane(plane);
            let body = body.build().unwrap();
            let a = TURN * a * TURN.transpose();
            check(&body, &a, turned(field.strain), turned(field.stress));
            if strain == Strain::Green {
                // turned once more, out of its plane: Green's strain stays, the stress turns
                let stress = TURN * turned(field.stress) * TURN.transpose();
                check(&body, &(TURN * a), turned(field.strain), stress);
            }
        }
    }
}

#[test]
fn strings_are_pulled_along_themselves() {
    let Material { young, poisson, .. } = SOFT;
    let bar = Body::new(Mesh::bar(0.1, 4).unwrap(), SOFT).strain(Strain::Cauchy).area(1e-4);
    let uniaxial = diagonal([0.03, -poisson * 0.03, -poisson * 0.03]);
    let stress = diagonal([young * 0.03, 0.0, 0.0]);
    check(&bar.build().unwrap(), &diagonal([1.03, 1.0, 1.0]), uniaxial, stress);

    let natural = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    let mesh = Mesh::bar(0.1, 4).unwrap().mapped(|x| (natural * x[0]).into());
    let string = Body::new(mesh.unwrap(), SOFT).area(1e-4).strain(Strain::Green).build().unwrap();
    let a = Matrix3::new(1.1, 0.2, 0.0, 0.3, 0.9, -0.1, 0.0, 0.4, 1.2);
    let present = a * natural;
    let e = (present.norm_squared() - 1.0) / 2.0;
    let along = natural * natural.transpose();
    let strain = along * e - (Matrix3::identity() - along) * (poisson * e);
    // force: stretch times S, along the present direction
    let stress = present * present.transpose() * (young * e / present.norm());
    check(&string, &a, strain, stress);
}

#[test]
fn stretch_and_shear_of_solids() {
    let (lambda, mu) = (SOFT.elastic().lambda, SOFT.elastic().mu);
    for cells in SolidCells::ALL {
        let mesh = Mesh::cuboid([0.1, 0.2, 0.1], [2, 3, 2], cells).unwrap();
        let solid = |strain| Body::new(mesh.clone(), SOFT).strain(strain).build().unwrap();
        let linear = |e: [f64; 3]| e.map(|x| lambda * e.iter().sum::<f64>() + 2.0 * mu * x);
        let e = [0.01, -0.02, 0.03];
        let stress = diagonal(linear(e));
        check(&solid(Strain::Cauchy), &diagonal([1.01, 0.98, 1.03]), diagonal(e), stress);
        let (s, e) = ([1.1, 0.9, 1.2], [0.105, -0.095, 0.22]);
        let [x, y, z] = linear(e);
        let sides = [s[0] / (s[1] * s[2]), s[1] / (s[0] * s[2]), s[2] / (s[0] * s[1])];
        let stress = diagonal([x * sides[0], y * sides[1], z * sides[2]]);
        check(&solid(Strain::Green), &diagonal(s), diagonal(e), stress);
        // pure shear: von Mises sqrt(3) times the shear stress
        let k = 1e-3;
        let shear = Matrix3::new(1.0, 0.0, k, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        let body = solid(Strain::Cauchy);
        for field in body.cell_fields(&mapped(&mesh, &shear)) {
            assert!((field.von_mises() / (3.0_f64.sqrt() * mu * k) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn cells_have_the_stress_of_their_region() {
    let mesh = Mesh::bar(0.2, 3).unwrap();
    let hard = Material { young: 7e5, ..SOFT };
    let body = Body::new(mesh, SOFT)
        .strain(Strain::Cauchy)
        .area(1e-4)
        .region(CellSelection::Numbers(vec![2]), hard);
    let body = body.build().unwrap();
    let fields = body.cell_fields(&[0.0, 0.001, 0.002]);
    for (field, young) in fields.iter().zip([1e5, 7e5]) {
        assert!((field.stress[0][0] - young * 0.01).abs() < 1e-9);
        assert!((field.energy_density - young * 0.5e-4).abs() < 1e-11);
    }
}

#[test]
fn rigid_motions_strain_green_bodies_nowhere() {
    for (name, body) in bodies(Strain::Green) {
        let (u, _) = rigid_motion(&body);
        for field in body.cell_fields(&u) {
            let worst = Matrix3::from(field.strain).abs().max();
            // round-off of displacement gradients of size 1 to 2
            assert!(worst < 1e-14, "{name}: strain {worst:e}");
            assert!(field.von_mises() < 1e-13 * body.material().elastic().lambda, "{name}");
        }
    }
}

#[test]
fn energy_densities_add_up_to_the_energy() {
    for (name, body) in [bodies(Strain::Cauchy), bodies(Strain::Green)].concat() {
        let volumes = body.cell_volumes();
        let volume = body.mass() / body.material().density;
        assert!((volumes.iter().sum::<f64>() / volume - 1.0).abs() < 1e-13, "{name}: volume");
        let u = noise(body.dofs(), 0.05, 3.0);
        let cells = body.cell_fields(&u).into_iter().zip(&volumes);
        let sum: f64 = cells.map(|(field, volume)| field.energy_density * volume).sum();
        let energy = match (body.strain(), body.elastic()) {
            (Strain::Green, Some(elastic)) => {
                crate::elements::force::Force::potential(&elastic, 0.0, &u)
            }
            _ => 0.5 * body.stiffness().quadratic_form(&u),
        };
        assert!((sum / energy - 1.0).abs() < 1e-12, "{name}: {sum} is not {energy}");
    }
}

/// Nodal forces of constant stress: the sum of x f^T over the nodes is the stress times the present
/// volume (in the undeformed shape, with Cauchy strain), along all directions within the cells.
#[test]
fn stresses_are_those_of_the_nodal_forces() {
    let a = Matrix3::new(1.2, 0.3, -0.1, -0.2, 0.9, 0.2, 0.1, 0.05, 1.1);
    for (name, body) in [bodies(Strain::Cauchy), bodies(Strain::Green)].concat() {
        let d = body.dimension();
        let mut x: Vec<f64> = body.mesh().positions().to_vec();
        let mut volumes = body.cell_volumes();
        let mut forces = NodalForces::zeros(body.dofs());
        let u = match body.strain() {
            Strain::Cauchy => {
                let u = noise(body.dofs(), 0.05, 5.0);
                body.stiffness().add_product(-1.0, &u, &mut forces.conservative);
                u
            }
            Strain::Green => {
                let u = mapped(body.mesh(), &a);
                body.add_elastic_forces(&u, &mut forces).unwrap();
                x.iter_mut().zip(&u).for_each(|(x, u)| *x += u);
                let ratios = body.volume_ratios(&u);
                volumes.iter_mut().zip(ratios).for_each(|(volume, ratio)| *volume *= ratio);
                u
            }
        };
        let position = |node: usize| {
            Vector3::from_fn(|i, _| x[d * node..][..d].get(i).copied().unwrap_or(0.0))
        };
        let mut moment = Matrix3::zeros();
        for (node, f) in forces.conservative.chunks(d).enumerate() {
            let force = Vector3::from_fn(|i, _| f.get(i).copied().unwrap_or(0.0));
            moment -= position(node) * force.transpose();
        }
        let fields = body.cell_fields(&u).into_iter().zip(&volumes);
        let sum: Matrix3<f64> = fields.map(|(field, v)| Matrix3::from(field.stress) * *v).sum();
        let scale = sum.abs().max();
        let directions: Vec<_> =
            (1..body.mesh().node_count()).map(|node| position(node) - position(0)).collect();
        for s in &directions {
            for t in &directions {
                let apart = (s.transpose() * (sum - moment) * t)[0].abs();
                assert!(apart < 1e-12 * scale, "{name}: {sum} is not {moment}");
            }
        }
    }
}

/// Pure bending about the z axis, a motion of degree 2: sigma_xx = E k y, and no other stress.
#[test]
fn stress_that_is_linear_is_exact_at_nodes_of_quadratic_cells() {
    let (young, nu, k) = (SOFT.young, SOFT.poisson, 0.02);
    let flat = |cells| {
        let mesh = Mesh::rectangle([0.2, 0.1], [4, 3], cells).unwrap();
        let body = Body::new(mesh, SOFT).thickness(0.01).plane(Plane::Stress);
        body.strain(Strain::Cauchy).build().unwrap()
    };
    let solid = |cells| {
        let mesh = Mesh::cuboid([0.2, 0.1, 0.1], [3, 2, 3], cells).unwrap();
        Body::new(mesh, SOFT).strain(Strain::Cauchy).build().unwrap()
    };
    for body in [
        flat(Cells::Triangles6),
        flat(Cells::Rectangles9),
        solid(SolidCells::Tetrahedra10),
        solid(SolidCells::Hexahedra20),
        solid(SolidCells::Hexahedra27),
    ] {
        let mesh = body.mesh();
        let u = mesh.field(|x| {
            let z = x.get(2).copied().unwrap_or(0.0);
            let up = -k / 2.0 * (x[0] * x[0] + nu * (x[1] * x[1] - z * z));
            [k * x[0] * x[1], up, -nu * k * x[1] * z][..x.len()].to_vec()
        });
        let fields = body.nodal_fields(&u);
        for (node, field) in fields.iter().enumerate() {
            let expected = diagonal([young * k * mesh.position(node)[1], 0.0, 0.0]);
            let apart = (Matrix3::from(field.stress) - expected).abs().max();
            // stresses of 200 Pa from gradients of displacements, to round-off: 5e-13 was found, with 9 nodes 6e-12
            assert!(apart < 1e-11, "node {node}: {:?} is not {expected}", field.stress);
        }
        // and between nodes, where shape functions interpolate
        for x in [[0.031, 0.047, 0.02], [0.2, 0.0, 0.1], [0.11, 0.1, 0.03]] {
            let x = &x[..body.dimension()];
            let probe = body.probe(&body.shares_at(x).unwrap());
            let found = body.probed(&probe, &u, &[]).stress[0][0];
            assert!((found - young * k * x[1]).abs() < 5e-12, "{found} at {x:?}");
        }
    }
}

/// Bent bilinear cells have a sigma_xx that is linear across them, exact at their Gauss points and so at
/// their nodes, and a spurious shear: only the stress along x is compared.
#[test]
fn bilinear_cells_extrapolate_what_they_have_at_gauss_points() {
    let k = 0.02;
    let rigid = Material { poisson: 0.0, ..SOFT };
    let mesh = Mesh::rectangle([0.2, 0.1], [3, 2], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, rigid).thickness(0.01).strain(Strain::Cauchy).build().unwrap();
    let u = body.mesh().field(|x| vec![k * x[0] * x[1], 0.0]);
    for (node, field) in body.nodal_fields(&u).iter().enumerate() {
        let expected = SOFT.young * k * body.mesh().position(node)[1];
        assert!((field.stress[0][0] - expected).abs() < 5e-12, "{node}: {:?}", field.stress);
    }
}

/// The mean over the cells around a node, weighted by their volumes, written out.
#[test]
fn nodes_between_cells_have_the_mean_over_their_volumes() {
    let mesh = Mesh::new(1, vec![0.0, 0.01, 0.04], CellKind::Segment, vec![0, 1, 1, 2]);
    let bar = Body::new(mesh.unwrap(), SOFT).area(1e-4).strain(Strain::Cauchy).build().unwrap();
    let fields = bar.nodal_fields(&[0.0, 0.001, 0.0016]);
    let stress = |node: usize| fields[node].stress[0][0];
    let expected = [0.1, (0.1 + 3.0 * 0.02) / 4.0, 0.02].map(|strain| SOFT.young * strain);
    for (node, expected) in expected.into_iter().enumerate() {
        assert!((stress(node) - expected).abs() < 1e-9, "{}", stress(node));
    }
}

#[test]
fn points_are_found_in_their_cells_or_not_at_all() {
    for (name, body) in bodies(Strain::Cauchy) {
        let (mesh, d) = (body.mesh(), body.dimension());
        let cell = mesh.cells().nth(mesh.cell_count() / 2).unwrap();
        // within the cell, by corners that are not all of one face
        let locals: &[usize] =
            if mesh.kind().faces().len() == 6 { &[0, 1, 3, 4] } else { &[0, 1, 2, 3] };
        let corners: Vec<usize> =
            locals[..mesh.kind().dimension() + 1].iter().map(|&local| cell[local]).collect();
        let weights: Vec<f64> = (1..=corners.len()).map(|k| k as f64).collect();
        let sum: f64 = weights.iter().sum();
        let x: Vec<f64> = (0..d)
            .map(|i| {
                let of = |(node, w): (&usize, &f64)| mesh.position(*node)[i] * w / sum;
                corners.iter().zip(&weights).map(of).sum()
            })
            .collect();
        let shares = body.shares_at(&x).unwrap();
        for (i, x) in x.iter().enumerate() {
            let there: f64 = shares.iter().map(|(node, n)| n * mesh.position(*node)[i]).sum();
            assert!((there - x).abs() < 1e-12, "{name}: {there} is not {x}");
        }
        let outside = body.shares_at(&vec![1e3; d]).unwrap_err().to_string();
        assert!(outside.contains("outside the body"), "{outside}");
        assert!(body.shares_at(&vec![0.0; d + 1]).is_err());
        assert!(body.shares_at(&vec![f64::NAN; d]).is_err());
    }
}
