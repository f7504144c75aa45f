//! Forces of fluids: potential and tangents by differences, buoyancy, inertia, mistakes.

use super::*;
use crate::base::sparse::NodeMatrix;
use crate::elements::body::Strain;
use crate::elements::force::{Force, NodalForces};
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::scene::forces::tests::{check, noise};
use crate::studies::samples::SQUARE_MATERIAL;

const WATER: f64 = 1000.0;

/// Blocks in the plane and in space, of cells with all kinds of faces.
fn blocks() -> Vec<Body> {
    let plane = [Cells::Triangles, Cells::Rectangles, Cells::Triangles6, Cells::Rectangles9];
    let plane = plane.map(|cells| Mesh::rectangle([0.3, 0.2], [3, 3], cells).unwrap());
    let space =
        SolidCells::ALL.map(|cells| Mesh::cuboid([0.3, 0.2, 0.1], [3, 3, 3], cells).unwrap());
    let all = plane.into_iter().chain(space);
    all.map(|mesh| {
        let thickness = if mesh.dimension() == 2 { Some(0.1) } else { None };
        let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy);
        let body = match thickness {
            Some(thickness) => body.thickness(thickness),
            None => body,
        };
        body.build().unwrap()
    })
    .collect()
}

/// Gravity in a skew direction.
fn gravity(dimension: usize) -> Vec<f64> {
    [-3.0, -9.0, 2.0][..dimension].to_vec()
}

/// Potential and tangents, where the surface of the fluid crosses the body: on all faces, which have a potential, and on one side.
#[test]
fn tangents_are_those_of_the_forces() {
    let mesh = |cells| Mesh::rectangle([0.6, 0.4], [2, 2], cells).unwrap();
    let solid = |cells| Mesh::cuboid([0.6, 0.4, 0.5], [2, 2, 2], cells).unwrap();
    let sheet = mesh(Cells::Rectangles).mapped(|x| [x[0], x[1], 0.3 * x[0] * x[1]]).unwrap();
    for (mesh, is_thick) in [
        (mesh(Cells::Triangles), true),
        (mesh(Cells::Rectangles9), true),
        (solid(SolidCells::Hexahedra), false),
        (solid(SolidCells::Tetrahedra10), false),
        (sheet, true),
    ] {
        let (d, is_sheet) = (mesh.dimension(), mesh.kind().dimension() < mesh.dimension());
        let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy);
        let body = if is_thick { body.thickness(0.5) } else { body }.build().unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let current = [0.3, -0.2, 0.5][..d].to_vec();
        let level = |fluid: Fluid| fluid.level(0.21);
        let drag = |fluid: Fluid| fluid.drag(0.8, 0.1).velocity(current.clone());
        let side = |fluid: Fluid| fluid.on(if is_sheet { "all" } else { "right" });
        let fluid = || Fluid::new(10.0).named("f");
        for (fluid, is_closed) in [
            (level(fluid()), !is_sheet),
            (drag(fluid()), false),
            (side(level(drag(fluid()))), false),
        ] {
            let force = fluid.force(&body, Some(&gravity(d))).unwrap();
            assert_eq!(force.is_closed, is_closed);
            for seed in [1.0, 2.0] {
                let n = body.dofs();
                let (u, v) = (noise(n, 0.05, seed), noise(n, 2.0, 10.0 * seed));
                // the largest error measured is 2e-7: |w_t| w_t has a kink in its second derivative
                assert!(check(&force, (d, &cells), 0.3, &u, &v, 1e-6) > 0.0);
            }
        }
    }
}

/// A body that is wholly submerged and has turned, and been bent, is pushed against gravity by the weight of the fluid in its place, and by nothing across.
#[test]
fn a_submerged_body_is_as_light_as_archimedes_says() {
    for body in blocks() {
        let d = body.dimension();
        let gravity = gravity(d);
        let fluid = Fluid::new(WATER).level(1.0);
        let force = fluid.force(&body, Some(&gravity)).unwrap();
        let (cos, sin) = (0.8, 0.6);
        let mut u = vec![0.0; body.dofs()];
        for (u, x) in u.chunks_exact_mut(d).zip(body.mesh().positions().chunks_exact(d)) {
            let bent = x[1] + 2.0 * x[0] * x[0];
            u[0] = cos * x[0] - sin * bent - x[0];
            u[1] = sin * x[0] + cos * bent - x[1];
        }
        let volume: f64 = body
            .volume_ratios(&u)
            .iter()
            .zip(body.cell_volumes())
            .map(|(ratio, volume)| ratio * volume)
            .sum();
        let sum = force.on(0.0, &u, &vec![0.0; body.dofs()], None);
        let weight = WATER * volume;
        for (i, g) in gravity.iter().enumerate() {
            let off = (sum[i] / weight + g).abs();
            assert!(off < 1e-13, "{:?}: {sum:?}, axis {i} off by {off:.1e}", body.mesh().kind());
        }
    }
}

/// A weight that is held in a current of constant speed: heat is what the current supplies. And what moves along with the fluid feels nothing.
#[test]
fn a_current_supplies_the_heat() {
    for body in blocks() {
        let d = body.dimension();
        let current = [0.3, -0.2, 0.5][..d].to_vec();
        let fluid = Fluid::new(WATER).drag(0.8, 0.1).velocity(current.clone());
        let force = fluid.force(&body, None).unwrap();
        let still = vec![0.0; body.dofs()];
        let mut forces = NodalForces::zeros(body.dofs());
        force.add_forces(0.0, &still, &still, &mut forces).unwrap();
        let (heat, supplied) = forces.powers(&still);
        assert!(heat > 0.0 && heat == supplied, "{heat} {supplied}");
        let along = current.repeat(body.mesh().node_count());
        // 500 kg/m^3 on 0.22 m^2 at most, at the square of a speed of round-off
        let left = norm(&force.on(0.0, &still, &along, None));
        assert!(left < 110.0 * 2e-16_f64.powi(2), "{left:e}");
    }
}

/// Added mass is that of the area, whatever the cells, and no node of a body whose inertia is lumped is coupled by it.
#[test]
fn added_mass_is_that_of_the_area() {
    for body in blocks() {
        let area = if body.dimension() == 2 { 0.1 } else { 0.22 };
        for inertia in [Inertia::Consistent, Inertia::Lumped] {
            let body = body.to_builder().inertia(inertia).build().unwrap();
            let force = Fluid::new(WATER).added_mass(3.0).force(&body, None).unwrap();
            let mut added = NodeMatrix::zeros(body.inertia().pattern());
            force.capabilities().carried.iter().for_each(|&([a, b], mass)| added.add(a, b, mass));
            let sum: f64 = added.values().iter().sum();
            assert!((sum / (3.0 * area) - 1.0).abs() < 1e-14, "{sum} {area}");
            assert_eq!(added.is_diagonal(), inertia == Inertia::Lumped);
            let least = (0..body.mesh().node_count()).map(|node| added.get(node, node));
            assert!(least.fold(f64::INFINITY, f64::min) >= 0.0);
        }
    }
}

#[test]
fn mistakes_are_told() {
    let body = &blocks()[0];
    let down = [0.0, -9.8];
    let bar = Body::new(Mesh::bar(1.0, 3).unwrap(), SQUARE_MATERIAL).area(1e-4).build().unwrap();
    let said = |fluid: Fluid, body: &Body, gravity: Option<&[f64]>| {
        fluid.named("sea").force(body, gravity).err().unwrap().to_string()
    };
    let water = || Fluid::new(WATER).drag(1.0, 0.0);
    for (fluid, body, gravity, expected) in [
        (Fluid::new(-1.0).level(0.0), body, Some(&down[..]), "fluid \"sea\" density = -1"),
        (water().drag(-1.0, 0.0), body, None, "fluid \"sea\" drag = -1"),
        (water().drag(1.0, f64::NAN), body, None, "fluid \"sea\" skin_drag = NaN"),
        (water().added_mass(-2.0), body, None, "fluid \"sea\" added_mass = -2"),
        (
            water().velocity([1.0]),
            body,
            None,
            "fluid \"sea\" velocity = [1.0] cannot be used: it needs 2",
        ),
        (
            water().level(0.1),
            body,
            None,
            "fluid \"sea\" level = 0.1 m cannot be used: there is no gravity",
        ),
        (water().level(0.1), body, Some(&[0.0, 0.0]), "there is no gravity"),
        (Fluid::new(WATER), body, None, "it does nothing"),
        (water().on([5]), body, None, "none of them is on the boundary"),
        (water().on([1, 2, 9]), body, None, "node(s) 9 are on none"),
        (water().on("rihgt"), body, None, "did you mean \"right\""),
        (water(), &bar, None, "no face with a normal"),
    ] {
        let said = said(fluid, body, gravity);
        assert!(said.contains(expected), "{said}\n{expected}");
    }
}
