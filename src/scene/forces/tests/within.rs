//! Forces within the material: magnets, dipoles beside them, and growth.

use super::{bar, check, nodal_forces, noise};
use crate::elements::body::{Body, BodyBuilder, Dilatation, PointDipole};
use crate::elements::force::Force;
use crate::elements::material::{Law, Plane};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::scene::devices::Dipole;
use crate::scene::forces::{Actuator, Growth, Magnet, MagneticField, Signal};
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

/// Growth by direction, and in plane strain, in all kinds of cells, with several laws and dilatations: likewise, and the fields have its energy.
#[test]
fn growth_by_direction() {
    let plane = |cells| Mesh::rectangle([0.1, 0.2], [2, 3], cells).unwrap();
    let solid = |cells| Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], cells).unwrap();
    let skin = || plane(Cells::Rectangles).mapped(|x| [x[0], x[1], 0.3 * x[0]]).unwrap();
    let soft = SQUARE_MATERIAL;
    let rubber = || soft.law(Law::NeoHookean);
    let ogden = || soft.law(Law::Ogden { exponents: [1.3, 5.0, -2.0], shares: [0.7, 0.1, 0.2] });
    let stress = |body: BodyBuilder| body.thickness(0.01).plane(Plane::Stress);
    let strain = |body: BodyBuilder| body.thickness(0.01).plane(Plane::Strain);
    let all = Growth::everywhere;
    let along = |direction: &[f64]| all().along(direction);
    let around = || all().around([-0.1, -0.2], []);
    let helix = || all().around([-0.1, -0.2, 0.0], [0.2, 0.0, 1.0]).pitch(0.4);
    let (mean, linear) = (Dilatation::Mean, Dilatation::Linear);
    let cases = [
        (Body::new(bar(1), soft).area(1e-2), along(&[-1.0])),
        (Body::new(bar(3), soft).area(1e-2), along(&[1.0, 0.0, 0.0]).keeping_volume()),
        (stress(Body::new(plane(Cells::Triangles6), soft)), along(&[0.4, 1.0])),
        (stress(Body::new(plane(Cells::Rectangles), rubber())), around().keeping_volume()),
        (stress(Body::new(skin(), ogden())), along(&[1.0, 1.0, 0.0]).across(0.3)),
        (strain(Body::new(skin(), rubber())), all()),
        (strain(Body::new(plane(Cells::Triangles6), soft)), all()),
        (strain(Body::new(plane(Cells::Rectangles), soft)).dilatation(mean), all()),
        (strain(Body::new(plane(Cells::Rectangles9), rubber())).dilatation(linear), all()),
        (strain(Body::new(plane(Cells::Rectangles), ogden())), around().across(-0.4)),
        (strain(Body::new(plane(Cells::Triangles), soft.law(Law::Corotated))), all()),
        (Body::new(solid(SolidCells::Hexahedra), rubber()).dilatation(mean), helix()),
        (Body::new(solid(SolidCells::Hexahedra), soft), helix().keeping_volume()),
        (Body::new(solid(SolidCells::Tetrahedra10), ogden()), along(&[1.0, 2.0, 3.0]).across(2.0)),
    ];
    for (number, (body, growth)) in cases.into_iter().enumerate() {
        let body = body.build().unwrap();
        let d = body.dimension();
        let strain = vec![Signal::constant(0.1), Signal::ramp(0.0, 0.3, 0.0, 1.0)];
        let force = growth.clone().named("g").force(&body, strain).unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let (u, v) = (noise(body.dofs(), 0.01, 1.0), noise(body.dofs(), 1.0, 2.0));
        assert!(check(&force, (d, &cells), 0.7, &u, &v, 1e-6) > 10.0);
        let h = 1e-5;
        let gain = (force.potential(0.7 + h, &u) - force.potential(0.7 - h, &u)) / (2.0 * h);
        let power = nodal_forces(&force, 0.7, &u, &v).carried_power;
        println!("{number}: {power} W, off by {:.1e}", power / gain - 1.0);
        assert!(gain.abs() > 0.01 && (power / gain - 1.0).abs() < 1e-7, "{power} {gain}");
        let fields = body.cell_fields_of(&u, &[growth.grown(&body, 0.31).unwrap().unwrap()]);
        let stored =
            fields.iter().zip(body.cell_volumes()).map(|(field, v)| field.energy_density * v);
        let off = stored.sum::<f64>() / force.potential(0.7, &u) - 1.0;
        assert!(off.abs() < 1e-12, "{number}: {off:e}");
    }
}

/// Growth along a direction and as much across it is growth alike in all directions.
#[test]
fn growth_across_as_along() {
    let solid = Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], SolidCells::Hexahedra20).unwrap();
    let body = Body::new(solid, SQUARE_MATERIAL.law(Law::NeoHookean)).build().unwrap();
    let u = noise(body.dofs(), 0.01, 1.0);
    let strain = || vec![Signal::ramp(0.0, 0.3, 0.0, 1.0)];
    let helix = Growth::everywhere().around([-0.1, -0.2, 0.0], [0.2, 0.0, 1.0]).pitch(0.4);
    let [alike, by_direction] = [Growth::everywhere(), helix.across(1.0)].map(|growth| {
        let force = growth.named("g").force(&body, strain()).unwrap();
        let forces = nodal_forces(&force, 0.7, &u, &u);
        let energy = force.potential(0.7, &u);
        (forces.conservative.to_vec(), [energy, forces.carried_power])
    });
    let largest = alike.0.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
    let apart = alike.0.iter().zip(&by_direction.0).map(|(a, b)| (a - b).abs() / largest);
    let apart = apart.fold(0.0, f64::max);
    println!("{apart:.1e} apart");
    assert!(apart < 1e-13, "{apart:e}");
    for (a, b) in alike.1.into_iter().zip(by_direction.1) {
        assert!((a / b - 1.0).abs() < 1e-13, "{a} {b}");
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
        let magnet = Magnet::new(b.clone());
        let scene = Scene::new(body.clone()).magnet(magnet.clone());
        let scene = scene.dipole(Dipole::new(m[..d].to_vec(), p[..d].to_vec()));
        let force = scene.device_forces(&Phase::until(1.0)).unwrap().remove(0);
        let mut magnets = Vec::new();
        magnet.add_points_to(&body, 1, &mut magnets).unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let (u, v) = (noise(body.dofs(), 0.02, 1.0), noise(body.dofs(), 1.0, 2.0));
        // differences over 1e-5 m, where the field changes over 0.5 m
        assert!(check(&*force, (d, &cells), 0.3, &u, &v, 3e-9) > 1.0);
        let applied = nodal_forces(&*force, 0.3, &u, &v).applied;
        let largest = applied.iter().fold(0.0_f64, |largest, f| largest.max(f.abs()));
        let h = 1e-5;
        let energy = |m: [f64; 3], p: [f64; 3], u: &[f64]| -> f64 {
            let within = |i: usize, x: f64| if i < d { x } else { 0.0 };
            let [moment, position] = [m, p].map(|x| std::array::from_fn(|i| within(i, x[i])));
            let dipole = PointDipole { moment, position };
            magnets.iter().map(|magnet| magnet.energy(&dipole, u)).sum()
        };
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
