use super::*;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::Body;
use crate::elements::body::tests::{bodies, noise, some_of};
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::{Law, Plane, Strain};
use crate::elements::mesh::{CellKind, Cells, Mesh, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

const PROJECTIONS: [Dilatation; 2] = [Dilatation::Mean, Dilatation::Linear];

/// Bodies of all kinds of cells that can have a projected dilatation, by each of them and each law, nearly
/// incompressible.
fn projected() -> Vec<(String, Body)> {
    let rubber = SQUARE_MATERIAL;
    let laws = [
        (Strain::Cauchy, rubber.into()),
        (Strain::Green, rubber.into()),
        (Strain::Green, rubber.law(Law::NeoHookean)),
        (Strain::Green, rubber.law(Law::MooneyRivlin { second: 0.3 })),
    ];
    let mut found = Vec::new();
    for (strain, substance) in laws {
        for (name, body) in bodies(strain) {
            for dilatation in PROJECTIONS {
                let body = body.to_builder().material(substance.clone()).dilatation(dilatation);
                let name = format!("{name}, {dilatation:?}, {strain:?}, {:?}", substance.law);
                found.extend(body.build().map(|body| (name, body)));
            }
        }
    }
    // quadrilaterals of 4 and 9 nodes, triangles of 6 and 7, tetrahedra of 10 and 15, hexahedra of 8, 20 and 27; all but those of
    // 4, 6, 8 and 10 by linear functions, too; by four laws
    assert_eq!(found.len(), (9 + 5) * 4);
    found
}

fn forces(body: &Body, u: &[f64]) -> Vec<f64> {
    let mut forces = NodalForces::zeros(body.dofs());
    body.add_elastic_forces(u, &mut forces).unwrap();
    forces.conservative.to_vec()
}

fn energy(body: &Body, u: &[f64]) -> f64 {
    let fields = body.cell_fields(u).into_iter().zip(body.cell_volumes());
    let of_fields: f64 = fields.map(|(field, volume)| field.energy_density * volume).sum();
    let energy = body.continua[0].elements.energy(&body.continua[0].regions, u);
    assert!((of_fields / energy - 1.0).abs() < 1e-12, "{of_fields} {energy}");
    energy
}

fn moved(x: &[f64], j: usize, by: f64) -> Vec<f64> {
    let mut x = x.to_vec();
    x[j] += by;
    x
}

/// Forces are the derivatives of the energy, tangents those of the forces, and the constant stiffness is the
/// tangent at rest. By central differences: off by the square of h over the size 0.1 of cells, times third
/// derivatives, and by round-off of 1e-16/h.
#[test]
fn forces_and_tangents_are_derivatives() {
    let h = 1e-5;
    for (name, body) in projected() {
        let n = body.dofs();
        let u = noise(n, 0.03, 1.0);
        let at = forces(&body, &u);
        let scale = body.stiffness().values.iter().fold(0.0_f64, |s, k| s.max(k.abs()));
        let tangent = |u: &[f64]| match body.elastic() {
            None => body.stiffness().clone(),
            Some(elastic) => {
                let zeros = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
                let (mut stiffness, mut damping) = (zeros.clone(), zeros);
                elastic.add_tangents(0.0, u, &vec![0.0; n], &mut stiffness, &mut damping);
                stiffness
            }
        };
        let (stiffness, at_rest) = (tangent(&u), tangent(&vec![0.0; n]));
        for j in some_of(n) {
            let at = at[j];
            let slope =
                (energy(&body, &moved(&u, j, h)) - energy(&body, &moved(&u, j, -h))) / (2.0 * h);
            assert!((at + slope).abs() < 1e-7 * scale, "{name}: dU/du {j}: {at} {slope}");
            let [ahead, behind] = [h, -h].map(|by| forces(&body, &moved(&u, j, by)));
            for i in 0..n {
                let by_u = (behind[i] - ahead[i]) / (2.0 * h);
                let apart = (stiffness.get(i, j) - by_u).abs();
                assert!(apart < 1e-6 * scale, "{name}: -df/du ({i}, {j}) {by_u}, {apart:e}");
                let apart = (at_rest.get(i, j) - body.stiffness().get(i, j)).abs();
                assert!(apart < 1e-13 * scale, "{name}: K ({i}, {j}), {apart:e}");
            }
        }
    }
}

/// The same of objective viscosity: its forces by the velocities and the displacements.
#[test]
fn viscous_tangents_are_derivatives() {
    let h = 1e-5;
    for (name, body) in projected().into_iter().filter(|(_, body)| body.strain() == Strain::Green) {
        let n = body.dofs();
        let (u, v) = (noise(n, 0.03, 1.0), noise(n, 2.0, 7.0));
        let elastic = body.elastic().unwrap();
        let zeros = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
        let (mut stiffness, mut damping) = (zeros.clone(), zeros.clone());
        elastic.add_tangents(0.0, &u, &v, &mut stiffness, &mut damping);
        let (mut of_elasticity, mut none) = (zeros.clone(), zeros);
        elastic.add_tangents(0.0, &u, &vec![0.0; n], &mut of_elasticity, &mut none);
        let viscous = |u: &[f64], v: &[f64]| {
            let mut forces = NodalForces::zeros(n);
            elastic.add_forces(0.0, u, v, &mut forces).unwrap();
            forces.dissipative.to_vec()
        };
        let heat: f64 = viscous(&u, &v).iter().zip(&v).map(|(f, v)| -f * v).sum();
        assert!(heat > 0.0, "{name}: {heat}");
        let scale =
            |matrix: &BlockMatrix| matrix.values.iter().fold(0.0_f64, |s, k| s.max(k.abs()));
        let (by_u, by_v) = (scale(&stiffness), scale(&damping));
        for j in some_of(n) {
            let [ahead, behind] = [h, -h].map(|by| viscous(&moved(&u, j, by), &v));
            let [faster, slower] = [h, -h].map(|by| viscous(&u, &moved(&v, j, by)));
            for i in 0..n {
                let slope = (behind[i] - ahead[i]) / (2.0 * h);
                let apart = (stiffness.get(i, j) - of_elasticity.get(i, j) - slope).abs();
                assert!(apart < 1e-7 * by_u, "{name}: -df/du ({i}, {j}) {slope}, {apart:e}");
                let slope = (slower[i] - faster[i]) / (2.0 * h);
                let apart = (damping.get(i, j) - slope).abs();
                assert!(apart < 1e-7 * by_v, "{name}: -df/dv ({i}, {j}) {slope}, {apart:e}");
            }
        }
    }
}

/// Under a homogeneous deformation forces are those without a projected dilatation; under another one they differ.
#[test]
fn homogeneous_deformations_have_the_same_forces() {
    for (name, body) in projected() {
        let pointwise = body.to_builder().dilatation(Dilatation::AtPoints).build().unwrap();
        let d = body.dimension();
        let u: Vec<f64> = body
            .mesh()
            .positions()
            .chunks(d)
            .flat_map(|x| (0..d).map(|i| 0.1 * x[i] - 0.07 * x[(i + 1) % d]).collect::<Vec<_>>())
            .collect();
        let apart = |u: &[f64]| apart(&forces(&body, u), &forces(&pointwise, u));
        assert!(apart(&u) < 1e-12, "{name}: {:e}", apart(&u));
        assert!(apart(&noise(body.dofs(), 0.03, 1.0)) > 0.1, "{name}");
    }
}

/// The largest difference, over the largest force.
fn apart(forces: &[f64], others: &[f64]) -> f64 {
    let largest = others.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
    let apart = forces.iter().zip(others).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max) / largest
}

/// A motion of degree 2 has a linear dilatation. Its projection onto linear functions is itself, and forces are those
/// at the points, whatever the shape of the cells and however many a register holds; in the mean they are others. Cells
/// are such that they follow the motion exactly: those of Lagrange where edges are straight, hexahedra of 20
/// nodes where faces are parallel.
#[test]
fn linear_dilatations_have_the_same_forces() {
    let flat = Mesh::rectangle([1.0, 0.8], [4, 3], Cells::Rectangles9).unwrap();
    let flat = flat.mapped(|x| [x[0] + 0.3 * x[0] * x[1], x[1] - 0.2 * x[0] * x[1]]);
    let solid = |cells| Mesh::cuboid([1.0, 0.8, 0.7], [3, 4, 2], cells).unwrap();
    let skew = solid(SolidCells::Hexahedra20)
        .mapped(|x| [x[0] + 0.3 * x[1], x[1] - 0.2 * x[2], x[2] + 0.1 * x[0]]);
    let uneven = solid(SolidCells::Hexahedra27).mapped(|x| {
        let all = x[0] * x[1] * x[2];
        [x[0] + 0.3 * x[0] * x[1], x[1] - 0.2 * x[1] * x[2], x[2] + 0.2 * all]
    });
    let triangles = Mesh::rectangle([1.0, 0.8], [4, 3], Cells::Triangles6);
    let triangles = triangles.unwrap().mapped(|x| [x[0] + 0.3 * x[1], x[1] - 0.2 * x[0]]);
    let tetrahedra = solid(SolidCells::Tetrahedra10)
        .mapped(|x| [x[0] + 0.3 * x[1], x[1] - 0.2 * x[2], x[2] + 0.1 * x[0]]);
    let [triangles, tetrahedra] = [triangles, tetrahedra].map(|mesh| mesh.unwrap().with_bubbles());
    for mesh in [flat, skew, uneven, triangles, tetrahedra] {
        let mesh = mesh.unwrap();
        let (kind, d) = (mesh.kind(), mesh.dimension());
        let u = mesh.field(|x| {
            let [x, y, z] = [x[0], x[1], x.get(2).copied().unwrap_or(0.0)];
            let u = [x * x - y * y + 2.0 * z * x, 3.0 * x * y + z * z, y * z - 0.5 * z * z];
            u[..d].iter().map(|u| 0.01 * u).collect()
        });
        let by = |dilatation| {
            let body = Body::new(mesh.clone(), SQUARE_MATERIAL).strain(Strain::Cauchy);
            let body = if d == 2 { body.thickness(0.01) } else { body };
            forces(&body.dilatation(dilatation).build().unwrap(), &u)
        };
        let at_points = by(Dilatation::AtPoints);
        let [mean, linear] = PROJECTIONS.map(|dilatation| apart(&by(dilatation), &at_points));
        println!("{kind:?}: {linear:e}, in the mean {mean}");
        assert!(linear < 1e-13 && mean > 0.1, "{kind:?}: {linear:e} {mean}");
    }
}

#[test]
fn bodies_that_do_not_lock_refuse_it() {
    for (name, body) in bodies(Strain::Green) {
        let kind = body.mesh().kind();
        for dilatation in PROJECTIONS {
            let Err(error) = body.to_builder().dilatation(dilatation).build() else { continue };
            let message = error.to_string();
            let start = format!("dilatation = {} cannot be used: ", dilatation.name());
            assert!(message.starts_with(&start), "{name}: {message}");
            let part = match kind {
                _ if kind.dimension() < body.dimension().max(2) => {
                    "membranes, strings and bodies in plane stress are free to change"
                }
                CellKind::Triangle | CellKind::Tetrahedron => "one point",
                _ if dilatation == Dilatation::Mean => panic!("{name}: {message}"),
                CellKind::Triangle6 | CellKind::Tetrahedron10 => {
                    "triangles and tetrahedra without bubbles lock with a linear dilatation"
                }
                CellKind::Quadrilateral | CellKind::Hexahedron => {
                    "linear cells lock with a linear dilatation"
                }
                _ => panic!("{name}: {message}"),
            };
            assert!(message.contains(part), "{name}: {message}");
        }
    }
    let flat = Mesh::rectangle([1.0; 2], [2; 2], Cells::Rectangles9).unwrap();
    let flat = Body::new(flat, SQUARE_MATERIAL).thickness(0.01).plane(Plane::Stress);
    for dilatation in PROJECTIONS {
        let message = flat.clone().dilatation(dilatation).build().unwrap_err().to_string();
        assert!(
            message.contains("bodies in plane stress are free to change their thickness"),
            "{message}"
        );
    }
}
