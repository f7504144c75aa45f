//! What acts within the material: magnets, dipoles beside them, and growth.

use super::{check, nodal_forces, noise};
use crate::elements::body::{Body, BodyBuilder, Dilatation};
use crate::elements::force::Force;
use crate::elements::material::{Law, Plane};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::scene::forces::{Dipole, Growth, Magnet, MagneticField, Signal};
use crate::scene::timeline::{Phase, Scene};
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

/// A dipole beside magnets in the plane, in space and in a bent membrane: its forces are the slope of the energy, its tangents are exact, they add up to
/// minus the force on the dipole, by the slope of the energy as that moves, and have minus the moment of it, m x B, where B is what the energy of
/// dipoles of other moments gives.
#[test]
fn dipoles() {
    let plane = Mesh::rectangle([0.1, 0.2], [2, 3], Cells::Triangles6).unwrap();
    let solid = Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], SolidCells::Hexahedra20).unwrap();
    let flat = Mesh::rectangle([0.1, 0.2], [2, 3], Cells::Rectangles).unwrap();
    let bent = flat.mapped(|x| [x[0], x[1], 0.0]).unwrap();
    for (mesh, b) in
        [(plane, vec![0.1, -0.2]), (solid, vec![0.1, -0.2, 0.3]), (bent, vec![0.1, -0.2, 0.0])]
    {
        let (d, is_solid) = (mesh.dimension(), mesh.has_inside());
        let body = Body::new(mesh, SQUARE_MATERIAL);
        let body = if is_solid && d == 3 { body } else { body.thickness(0.01) }.build().unwrap();
        let (p, m) = ([0.7, 0.5, -0.4], [2e6, 9e6, -6e6]);
        let force = |m: [f64; 3], p: [f64; 3]| {
            let scene = Scene::new(body.clone()).magnet(Magnet::new(b.clone()));
            let scene = scene.dipole(Dipole::new(m[..d].to_vec(), p[..d].to_vec()));
            scene.dipole_forces(&Phase::until(1.0)).unwrap().remove(0)
        };
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let (u, v) = (noise(body.dofs(), 0.02, 1.0), noise(body.dofs(), 1.0, 2.0));
        // differences over 1e-5 m, where the field changes over 0.5 m
        assert!(check(&force(m, p), (d, &cells), 0.3, &u, &v, 3e-9) > 1.0);
        let applied = nodal_forces(&force(m, p), 0.3, &u, &v).applied;
        let largest = applied.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
        let h = 1e-5;
        let energy = |m, p, u: &[f64]| force(m, p).energy(0.3, u);
        for (j, f) in applied.iter().enumerate() {
            let by = |h: f64| {
                let mut u = u.clone();
                u[j] += h;
                energy(m, p, &u)
            };
            let slope = (by(h) - by(-h)) / (2.0 * h);
            assert!((f + slope).abs() < 1e-8 * largest, "{j}: {f} {slope}");
        }
        let on_dipole: Vec<f64> = (0..d)
            .map(|axis| {
                let by = |h: f64| {
                    let mut p = p;
                    p[axis] += h;
                    energy(m, p, &u)
                };
                -(by(h) - by(-h)) / (2.0 * h)
            })
            .collect();
        let field = |axis: usize| {
            let mut m = [0.0; 3];
            m[axis] = 1.0;
            -energy(m, p, &u)
        };
        let places: Vec<f64> = body.mesh().positions().iter().zip(&u).map(|(x, u)| x + u).collect();
        for i in 0..d {
            let sum: f64 = applied.iter().skip(i).step_by(d).sum();
            assert!((sum + on_dipole[i]).abs() < 1e-8 * largest, "{sum} {}", on_dipole[i]);
            for j in 0..i {
                let nodes = applied.chunks(d).zip(places.chunks(d));
                let on_body: f64 = nodes.map(|(f, x)| x[i] * f[j] - x[j] * f[i]).sum();
                let moved = p[i] * on_dipole[j] - p[j] * on_dipole[i];
                let turned = m[i] * field(j) - m[j] * field(i);
                let left = on_body + moved + turned;
                assert!(left.abs() < 1e-8 * largest, "{on_body} {moved} {turned}");
            }
        }
    }
}
