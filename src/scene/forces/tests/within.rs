//! What acts within the material: magnets and growth.

use super::{check, nodal_forces, noise};
use crate::elements::body::{Body, BodyBuilder, Dilatation};
use crate::elements::force::Force;
use crate::elements::material::{Law, Plane};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::scene::forces::{Growth, Magnet, MagneticField, Signal};
use crate::studies::samples::SQUARE_MATERIAL;

/// Magnets in a field with a gradient, in the plane and in space: exact tangents, and in a uniform field the force and the moment that its
/// energy, -m . B, gives.
#[test]
fn magnets() {
    let plane = Mesh::rectangle([0.1, 0.2], [2, 3], Cells::Triangles6).unwrap();
    let solid = Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], SolidCells::Hexahedra20).unwrap();
    for mesh in [plane, solid] {
        let d = mesh.dimension();
        let body = Body::new(mesh, SQUARE_MATERIAL);
        let body = if d == 2 { body.thickness(0.01) } else { body }.build().unwrap();
        let magnets = || {
            let mut magnets = body.without_magnets();
            Magnet::new([0.1, -0.2, 0.3][..d].to_vec()).add_to(&body, 1, &mut magnets).unwrap();
            magnets
        };
        let field = [0.01, 0.02, -0.03];
        let rows = [[1.0, 0.5, -0.2], [0.5, 2.0, 0.3], [-0.2, 0.3, -3.0]];
        let own = rows[..d].iter().map(|row| row[..d].to_vec());
        let uniform = MagneticField::uniform(field[..d].to_vec());
        let varying = uniform.clone().gradient(own, [0.05, -0.1, 0.1][..d].to_vec());
        let varying = varying.force(&body, magnets(), "field".into()).unwrap();
        let uniform = uniform.force(&body, magnets(), "field".into()).unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let (u, v) = (noise(body.dofs(), 0.02, 1.0), noise(body.dofs(), 1.0, 2.0));
        assert!(check(&varying, (d, &cells), 0.3, &u, &v, 1e-8) > 10.0);
        assert!(!uniform.is_nonlinear());
        let places: Vec<f64> = body.mesh().positions().iter().zip(&u).map(|(x, u)| x + u).collect();
        let (poles, applied) = (magnets().poles, nodal_forces(&uniform, 0.3, &u, &v).applied);
        let moment = |axis: usize| -> f64 {
            poles.iter().zip(places.chunks(d)).map(|(pole, x)| pole * x[axis]).sum()
        };
        let largest = moment(0).hypot(moment(1)) * 0.03;
        for axis in 0..d {
            let sum: f64 = applied.iter().skip(axis).step_by(d).sum();
            assert!(sum.abs() < 1e-12 * largest, "{sum}");
        }
        // a gradient pulls by G m, whatever the shape is
        let pulled = nodal_forces(&varying, 0.3, &u, &v).applied;
        for (axis, row) in rows.iter().take(d).enumerate() {
            let sum: f64 = pulled.iter().skip(axis).step_by(d).sum();
            let expected: f64 = (0..d).map(|j| row[j] * moment(j)).sum();
            assert!(
                (sum - expected).abs() < 1e-10 * moment(0).hypot(moment(1)),
                "{sum} {expected}"
            );
        }
        let turn = |i: usize, j: usize| -> f64 {
            let nodes = applied.chunks(d).zip(places.chunks(d));
            nodes.map(|(f, x)| x[i] * f[j] - x[j] * f[i]).sum()
        };
        for i in 0..d {
            for j in 0..i {
                let expected = moment(i) * field[j] - moment(j) * field[i];
                assert!((turn(i, j) - expected).abs() < 1e-12 * largest, "{}", turn(i, j));
            }
        }
    }
}

/// Growth with several laws and dilatations: its force is that of its energy, its tangents are exact, and the power that it supplies is what
/// its energy gains where nothing moves.
#[test]
fn growth() {
    let plane = || Mesh::rectangle([0.1, 0.2], [2, 3], Cells::Triangles6).unwrap();
    let solid = || Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], SolidCells::Hexahedra).unwrap();
    let soft = SQUARE_MATERIAL;
    let flat = |body: BodyBuilder| body.thickness(0.01).plane(Plane::Stress);
    let bodies = [
        flat(Body::new(plane(), soft)),
        flat(Body::new(plane(), soft.law(Law::NeoHookean))),
        Body::new(solid(), soft.law(Law::NeoHookean)).dilatation(Dilatation::Mean),
        Body::new(solid(), soft.law(Law::Corotated)),
    ];
    for body in bodies {
        let body = body.build().unwrap();
        let d = body.dimension();
        let strain = vec![Signal::constant(0.1), Signal::ramp(0.0, 0.3, 0.0, 1.0)];
        let force = Growth::everywhere().named("g").force(&body, strain).unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let (u, v) = (noise(body.dofs(), 0.01, 1.0), noise(body.dofs(), 1.0, 2.0));
        assert!(check(&force, (d, &cells), 0.7, &u, &v, 1e-6) > 10.0);
        let h = 1e-5;
        let gain = (force.potential(0.7 + h, &u) - force.potential(0.7 - h, &u)) / (2.0 * h);
        let power = nodal_forces(&force, 0.7, &u, &v).carried_power;
        assert!(gain.abs() > 1.0 && (power / gain - 1.0).abs() < 1e-7, "{power} {gain}");
    }
}
