//! One check for all forces: force = -dU/du, tangents = -df/du and -df/dv by central differences.

mod within;
mod wrenches;

use std::sync::Arc;

use super::*;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::dot;
use crate::elements::body::{Body, Strain};
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::elements::mesh::{CellKind, Cells, Mesh, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

/// Numbers between -`size` and `size` without a pattern.
pub(super) fn noise(length: usize, size: f64, seed: f64) -> Vec<f64> {
    (0..length)
        .map(|i| size * (12.9898 * (i as f64 + seed)).sin().mul_add(43.758, 0.3).sin())
        .collect()
}

fn moved(x: &[f64], j: usize, by: f64) -> Vec<f64> {
    let mut x = x.to_vec();
    x[j] += by;
    x
}

pub(super) fn nodal_forces(force: &dyn Force, t: f64, u: &[f64], v: &[f64]) -> NodalForces {
    let mut forces = NodalForces::zeros(u.len());
    force.add_forces(t, u, v, &mut forces).unwrap();
    forces
}

/// Checks `force` on nodes with `dimension` components each at (t, u, v), to `tolerance` relative
/// to its largest tangent: central differences with h = 1e-5 are off by about (h/l)^2 where the
/// force changes over a length l, and by round-off, 1e-16 f/h. Returns its largest tangent.
/// Its tangents may couple the nodes of `cells` and those that it says it couples. Nodes that it does not name have no
/// force, and change none.
#[track_caller]
pub(super) fn check(
    force: &dyn Force,
    (dimension, cells): (usize, &[&[usize]]),
    t: f64,
    u: &[f64],
    v: &[f64],
    tolerance: f64,
) -> f64 {
    let (n, h) = (u.len(), 1e-5);
    let pattern = NodePattern::new(n / dimension, cells.iter().copied());
    let pattern = Arc::new(pattern.with_pairs(&force.couplings()));
    let mut stiffness = BlockMatrix::zeros(&pattern, dimension);
    let mut damping = stiffness.clone();
    let told = force.add_tangents(t, u, v, &mut stiffness, &mut damping);
    assert!(told == Tangents::Added || !force.is_nonlinear());
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    // a force that is cut off has tangents of 0
    let scales = [&stiffness, &damping].map(|matrix| largest(&matrix.values).max(1.0));
    let at = nodal_forces(force, t, u, v);
    let nodes = force.nodes();
    let is_named =
        |dof: usize| nodes.as_ref().is_none_or(|nodes| nodes.contains(&(dof / dimension)));
    let all = |f: &NodalForces| [&f.conservative, &f.dissipative, &f.applied].map(|f| f.to_vec());
    assert!(all(&at).iter().all(|f| (0..n).all(|i| is_named(i) || f[i] == 0.0)));
    for j in 0..n {
        let slope = force.potential(t, &moved(u, j, h)) - force.potential(t, &moved(u, j, -h));
        let apart = (at.conservative[j] + slope / (2.0 * h)).abs();
        assert!(apart <= tolerance * scales[0], "dU/du {j}: off by {apart}");
        let [ahead, behind] = [h, -h].map(|by| nodal_forces(force, t, &moved(u, j, by), v));
        let [faster, slower] = [h, -h].map(|by| nodal_forces(force, t, u, &moved(v, j, by)));
        assert!(is_named(j) || [&ahead, &faster].iter().all(|moved| all(moved) == all(&at)), "{j}");
        for i in 0..n {
            let total = |f: &NodalForces| f.conservative[i] + f.dissipative[i] + f.applied[i];
            let by_u = (total(&behind) - total(&ahead)) / (2.0 * h);
            let by_v = (total(&slower) - total(&faster)) / (2.0 * h);
            let found = stiffness.get(i, j);
            assert!((found - by_u).abs() <= tolerance * scales[0], "({i}, {j}) {found} {by_u}");
            let found = damping.get(i, j);
            assert!((found - by_v).abs() <= tolerance * scales[1], "({i}, {j}) {found} {by_v}");
        }
    }
    largest(&stiffness.values)
}

/// Two cells along a skew line; in any space.
pub(super) fn bar(dimension: usize) -> Mesh {
    let direction = [0.8, 0.3, -0.5];
    let positions = (0..3).flat_map(|k| (0..dimension).map(move |i| f64::from(k) * direction[i]));
    Mesh::new(dimension, positions.collect(), CellKind::Segment, vec![0, 1, 1, 2]).unwrap()
}

/// A body of them.
pub(super) fn bar_body(dimension: usize) -> Body {
    Body::new(bar(dimension), SQUARE_MATERIAL).area(1e-4).build().unwrap()
}

#[test]
fn springs() {
    for dimension in 1..=3 {
        let body = bar_body(dimension);
        let spring = Spring::between([3], [1]).named("s").stiffness(20.0).length(1.2).damping(3.0);
        let actuation = vec![Signal::constant(-2.0), Signal::function(|t| 5.0 * t)];
        let forces = spring.forces(&body, actuation).unwrap();
        let [force, actuator] = &forces[..] else { panic!("{}", forces.len()) };
        let point = [-0.3, 0.1, 0.4][..dimension].to_vec();
        let anchored = Spring::anchored([3], point).stiffness(20.0).length(1.2).damping(3.0);
        let anchored = &anchored.forces(&body, Vec::new()).unwrap()[0];
        assert_eq!(anchored.couplings(), Vec::<[usize; 2]>::new());
        for seed in [1.0, 2.0, 3.0] {
            let n = 3 * dimension;
            let (u, v) = (noise(n, 0.3, seed), noise(n, 2.0, 10.0 * seed));
            assert!(check(&**anchored, (dimension, &[]), 0.7, &u, &v, 1e-8) > 0.0);
            assert!(check(&**force, (dimension, &[]), 0.7, &u, &v, 1e-8) > 0.0);
            check(&**actuator, (dimension, &[]), 0.7, &u, &v, 1e-8);
            // nodes off the spring have no force, and action equals reaction
            let mut forces = nodal_forces(&**force, 0.7, &u, &v);
            actuator.add_forces(0.7, &u, &v, &mut forces).unwrap();
            for part in [&forces.conservative, &forces.dissipative, &forces.applied] {
                for i in 0..dimension {
                    assert_eq!(part[dimension + i], 0.0);
                    assert_eq!(part[i], -part[2 * dimension + i]);
                }
            }
            assert!(forces.powers(&v).0 > 0.0);
        }
    }
}

/// The law, written out: the second end feels (f - k (l - L) - c l') e.
#[test]
fn a_spring_pulls_its_second_end_back() {
    let spring = Spring::between([1], [3]).stiffness(20.0).length(1.5).damping(3.0);
    let forces = spring.forces(&bar_body(1), vec![Signal::constant(0.25)]).unwrap();
    let [force, actuator] = &forces[..] else { panic!("{}", forces.len()) };
    // from 1.6 m to 1.7 m, at 2 m/s
    let (u, v) = ([0.1, 0.0, 0.2], [1.0, 0.0, 3.0]);
    let mut forces = nodal_forces(&**force, 0.0, &u, &v);
    actuator.add_forces(0.0, &u, &v, &mut forces).unwrap();
    for (part, expected) in
        [(forces.conservative, -4.0), (forces.dissipative, -6.0), (forces.applied, 0.25)]
    {
        assert!((part[2] - expected).abs() < 1e-12, "{} {expected}", part[2]);
    }
    assert!((force.potential(0.0, &[0.1, 0.0, 0.2]) - 0.5 * 20.0 * 0.04).abs() < 1e-12);
}

fn plate(dimension: usize) -> Body {
    let flat = [0.0, 0.0, 1.0, 0.2, 1.3, 1.1, -0.1, 0.9];
    let space = |x: &[f64]| {
        let lifted = [x[0], x[1], 0.2 * x[0] - 0.4 * x[0] * x[1]];
        lifted.into_iter().take(dimension)
    };
    let positions = flat.chunks(2).flat_map(space).collect();
    let mesh = Mesh::new(dimension, positions, CellKind::Triangle, vec![0, 1, 2, 0, 2, 3]);
    Body::new(mesh.unwrap(), SQUARE_MATERIAL)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .build()
        .unwrap()
}

#[test]
fn chambers() {
    let polygon = Chamber::within("cell", [4, 3, 2, 1]);
    let surface = Chamber::surface("bag", [[1, 2, 3], [1, 3, 4], [2, 1, 4], [2, 4, 3]]);
    for (chamber, dimension) in [(polygon, 2), (surface, 3)] {
        let pressure = vec![Signal::constant(2e3), Signal::function(|t| 1e3 * t)];
        let force = chamber.force(&plate(dimension), pressure).unwrap();
        for seed in [1.0, 2.0] {
            let n = 4 * dimension;
            let (u, v) = (noise(n, 0.3, seed), noise(n, 2.0, 10.0 * seed));
            assert!(check(&force, (dimension, &[]), 0.7, &u, &v, 1e-9) > 0.0);
            let forces = nodal_forces(&force, 0.7, &u, &v);
            // a closed chamber has no net force
            for i in 0..dimension {
                let sum: f64 = forces.applied.iter().skip(i).step_by(dimension).sum();
                assert!(sum.abs() < 1e-12 * 2.7e3, "{sum}");
            }
        }
    }
}

/// Pressure on part of the boundary, of all kinds of faces, curved ones too.
#[test]
fn pressures_on_faces() {
    let bent = |x: &[f64]| [x[0] + 0.1 * x[1] * x[1], x[1] + 0.2 * x[0] * x[0] + 0.1 * x[0] * x[1]];
    let mut bodies = Vec::new();
    for cells in Cells::ALL {
        let mesh = Mesh::rectangle([1.0, 1.0], [3, 3], cells).unwrap().mapped(bent).unwrap();
        let flat = mesh.clone().mapped(|x| [x[0], x[1], 0.3 * x[0] - 0.2 * x[1] * x[0]]);
        // cells of 9 nodes fill a plane
        let flat = flat.ok().map(|flat| (flat, "all"));
        assert_eq!(flat.is_none(), cells == Cells::Rectangles9);
        bodies.extend([(mesh, "right")].into_iter().chain(flat).map(|(mesh, nodes)| {
            (Body::new(mesh, SQUARE_MATERIAL).thickness(0.2).build().unwrap(), nodes)
        }));
    }
    for cells in SolidCells::ALL {
        let mesh = Mesh::cuboid([1.0; 3], [2, 3, 2], cells).unwrap();
        let mesh = mesh.mapped(|x| [bent(x)[0], bent(x)[1], x[2] + 0.1 * x[1] * x[0]]).unwrap();
        if cells == SolidCells::Tetrahedra10 {
            let mesh = mesh.with_bubbles().unwrap();
            bodies.push((Body::new(mesh, SQUARE_MATERIAL).build().unwrap(), "right"));
        }
        bodies.push((Body::new(mesh, SQUARE_MATERIAL).build().unwrap(), "right"));
    }
    for (body, nodes) in bodies {
        let pressure = Signal::function(|t| 1e3 * t);
        let force = FacePressure::new(&body, &nodes.into(), pressure).unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let (n, dimension) = (body.dofs(), body.dimension());
        let (u, v) = (noise(n, 0.1, 1.0), noise(n, 2.0, 10.0));
        // forces are quadratic in u at most: differences are off by round-off alone, 1e-16 f/h
        assert!(check(&force, (dimension, &cells), 0.7, &u, &v, 1e-9) > 0.0);
    }
}

/// Pressure all over the boundary has the forces -p dV/du (by its work in a small change of volume), and so
/// no net force or moment: they are those of a chamber around the same cells, curved or not.
#[test]
fn pressure_all_around_is_that_of_a_chamber() {
    let plate = |cells| Mesh::rectangle([1.0, 0.7], [4, 3], cells).unwrap();
    let block = |cells| Mesh::cuboid([1.0, 0.7, 0.5], [3, 3, 2], cells).unwrap();
    let plates = Cells::ALL.into_iter().map(plate);
    let with_bubbles = [plate(Cells::Triangles6), block(SolidCells::Tetrahedra10)]
        .map(|mesh| mesh.with_bubbles().unwrap());
    let blocks = SolidCells::ALL.into_iter().map(block);
    for mesh in plates.chain(blocks).chain(with_bubbles) {
        let is_flat = mesh.dimension() == 2;
        let body = Body::new(mesh, SQUARE_MATERIAL);
        let body = if is_flat { body.thickness(0.2) } else { body }.build().unwrap();
        let pressure = Signal::constant(2e3);
        let faces = FacePressure::new(&body, &"boundary".into(), pressure.clone()).unwrap();
        let world = Chamber::within("world", "boundary").force(&body, vec![pressure]).unwrap();
        let (u, v) = (noise(body.dofs(), 0.05, 3.0), vec![0.0; body.dofs()]);
        let [found, expected] =
            [&faces as &dyn Force, &world].map(|force| nodal_forces(force, 0.0, &u, &v).applied);
        for (found, expected) in found.iter().zip(expected.iter()) {
            assert!((found - expected).abs() < 1e-12 * 2e3, "{found} {expected}");
        }
    }
}

/// A quarter of a cylinder of inner radius r, pressed from within: along either axis the resultant is p r
/// times the length, whatever the faces, if their ends are on the circle; errors are round-off alone.
#[test]
fn pressure_on_an_arc_has_the_resultant_of_its_chord() {
    for cells in Cells::ALL {
        let mesh = Mesh::rectangle([1.0, 1.0], [4, 3], cells).unwrap();
        let angle = |s: f64| std::f64::consts::FRAC_PI_2 * (1.0 - s);
        let mesh = mesh.mapped(|x| {
            [(1.0 + 0.2 * x[1]) * angle(x[0]).cos(), (1.0 + 0.2 * x[1]) * angle(x[0]).sin()]
        });
        let body = Body::new(mesh.unwrap(), SQUARE_MATERIAL).thickness(0.3).build().unwrap();
        let force = FacePressure::new(&body, &"bottom".into(), Signal::constant(1e3)).unwrap();
        let rest = vec![0.0; body.dofs()];
        let applied = nodal_forces(&force, 0.0, &rest, &rest).applied;
        for axis in 0..2 {
            let sum: f64 = applied.iter().skip(axis).step_by(2).sum();
            assert!((sum - 300.0).abs() < 1e-10, "{cells}: {sum}");
        }
    }
}

/// A regular polygon of n nodes on a circle of radius r: S = (n/2) r^2 sin(2 pi/n), and the force on
/// each node points outward, p h r sin(2 pi/n).
#[test]
fn pressure_in_a_regular_polygon() {
    let (n, r, p, h) = (7, 0.3, 2e3, 0.01);
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
    // a wheel: the hub is the last node
    let rim = (0..n).flat_map(|k| [r * angle(k).cos(), r * angle(k).sin()]);
    let positions = rim.chain([0.0, 0.0]).collect();
    let spokes = (0..n).flat_map(|k| [k, (k + 1) % n, n]).collect();
    let mesh = Mesh::new(2, positions, CellKind::Triangle, spokes).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(h).build().unwrap();
    let around: Vec<usize> = (1..=n).collect();
    let backwards: Vec<usize> = around.iter().rev().copied().collect();
    // as part of its boundary, the body is pressed from outside
    let outside = crate::Selection::from("boundary");
    for (nodes, p) in [(around.into(), p), (backwards.into(), p), (outside, -p)] {
        let chamber = Chamber::within("wheel", nodes);
        let force = chamber.force(&body, vec![Signal::constant(2e3)]).unwrap();
        let rest = vec![0.0; body.dofs()];
        let forces = nodal_forces(&force, 0.0, &rest, &rest).applied;
        for k in 0..n {
            let outward = forces[2 * k] * angle(k).cos() + forces[2 * k + 1] * angle(k).sin();
            let across = forces[2 * k + 1] * angle(k).cos() - forces[2 * k] * angle(k).sin();
            let expected = p * h * r * angle(1).sin();
            assert!((outward / expected - 1.0).abs() < 1e-13, "{outward} {expected}");
            assert!(across.abs() < 1e-13 * expected.abs(), "{across}");
        }
        assert_eq!(forces[2 * n..], [0.0; 2]);
        // blown up by a tenth: the work is p h times the change of area (1.1^2 - 1) S
        let positions = body.mesh().positions();
        let grown: Vec<f64> = positions.iter().map(|x| 0.1 * x).collect();
        let middle: Vec<f64> = positions.iter().map(|x| 0.05 * x).collect();
        // forces are linear in u: the middle gives the mean
        let work = dot(&nodal_forces(&force, 0.0, &middle, &rest).applied, &grown);
        let area = 0.5 * n as f64 * r * r * angle(1).sin();
        assert!((work / (p * h * 0.21 * area) - 1.0).abs() < 1e-12, "{work}");
    }
}

/// An octahedron with corners at distance r: V = (4/3) r^3, and the force on each corner points
/// outward, p dV/dr / 6 = (2/3) p r^2.
#[test]
fn pressure_in_an_octahedron() {
    let (r, p) = (0.3, 2e3);
    let mut positions = Vec::new();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            positions.extend((0..3).map(|i| if i == axis { sign * r } else { 0.0 }));
        }
    }
    // +x -x +y -y +z -z: each octant a triangle, outward
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let [x, y, z] = [octant & 1, octant >> 1 & 1, octant >> 2 & 1];
        let corners = [1 + x, 3 + y, 5 + z];
        let outward = (x + y + z) % 2 == 0;
        triangles.push(if outward { corners } else { [corners[1], corners[0], corners[2]] });
    }
    let connectivity = triangles.iter().flatten().map(|number| number - 1).collect();
    let mesh = Mesh::new(3, positions, CellKind::Triangle, connectivity).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.001).build().unwrap();
    let inward: Vec<_> = triangles.iter().map(|&[a, b, c]| [b, a, c]).collect();
    for walls in [triangles, inward] {
        let force = Chamber::surface("bag", walls).force(&body, vec![Signal::constant(p)]);
        let rest = vec![0.0; body.dofs()];
        let forces = nodal_forces(&force.unwrap(), 0.0, &rest, &rest).applied;
        for (force, x) in forces.iter().zip(body.mesh().positions()) {
            let expected = 2.0 / 3.0 * p * r * x;
            assert!((force - expected).abs() < 1e-12 * p * r * r, "{force} {expected}");
        }
    }
}

/// A square hole in a square plate: its walls are pushed outward, that is, into the body.
#[test]
fn pressure_in_a_hole_enlarges_it() {
    let grid = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Triangles).unwrap();
    let corners = [5, 6, 9, 10];
    let outside = grid.cells().filter(|cell| !cell.iter().all(|node| corners.contains(node)));
    let connectivity = outside.flatten().copied().collect();
    let mesh = Mesh::new(2, grid.positions().to_vec(), CellKind::Triangle, connectivity).unwrap();
    let mesh = mesh.name_nodes("hole", [6, 7, 10, 11]).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    assert_eq!(body.mesh().cell_count(), 16);
    let force = Chamber::within("hole", "hole").force(&body, vec![Signal::constant(1e3)]);
    let rest = vec![0.0; body.dofs()];
    let forces = nodal_forces(&force.unwrap(), 0.0, &rest, &rest).applied;
    for (node, [x, y]) in [(5, [-1.0, -1.0]), (6, [1.0, -1.0]), (9, [-1.0, 1.0]), (10, [1.0, 1.0])]
    {
        // half of each of two walls of 1 m and 1 cm
        assert!((forces[2 * node] - 5.0 * x).abs() < 1e-12, "{forces:?}");
        assert!((forces[2 * node + 1] - 5.0 * y).abs() < 1e-12, "{forces:?}");
    }
}

/// Obstacles that contain some nodes of a cell with its corners near 0 and 1, with all parts of the law, at
/// rest and in motion. A random point is never on a ridge or at d = 0.
#[test]
fn contacts() {
    let cut = |x: [f64; 3], dimension: usize| x[..dimension].to_vec();
    for dimension in 1..=3 {
        let corners = [[0.0; 3], [1.0, 0.1, 0.0], [0.1, 0.9, 0.2], [-0.1, 0.2, 1.0]];
        let positions = corners[..=dimension].iter().flat_map(|&x| cut(x, dimension)).collect();
        let kind = [CellKind::Segment, CellKind::Triangle, CellKind::Tetrahedron][dimension - 1];
        let mesh = Mesh::new(dimension, positions, kind, (0..=dimension).collect()).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy);
        let body = match dimension {
            1 => body.area(2.0),
            2 => body.thickness(2.0),
            _ => body,
        };
        let body = body.build().unwrap();
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let at = |x| cut(x, dimension);
        let mut shapes = vec![
            Shape::half_plane(at([0.5; 3]), at([-3.0, 4.0, 1.0])),
            Shape::disc(at([0.3; 3]), 0.9),
            Shape::cavity(at([0.3; 3]), 0.4),
            Shape::box_between(at([-0.5; 3]), at([0.8; 3])),
            Shape::union([Shape::disc(at([0.0; 3]), 0.5), Shape::disc(at([0.9, 0.1, 0.0]), 0.6)]),
        ];
        if dimension > 1 {
            shapes.push(Shape::capsule(at([0.0; 3]), at([0.5, 0.4, -0.3]), 0.7));
        }
        let n = body.dofs();
        let (u, v) = (noise(n, 0.1, 2.0), noise(n, 2.0, 20.0));
        for shape in shapes {
            for (adhesion, speed) in [(true, 1.0), (false, 1.0), (false, 100.0)] {
                for (obstacle, w) in [
                    (Obstacle::new(shape.clone()).stiffness(50.0), [0.0; 3]),
                    (Obstacle::new(shape.clone()).stiffness_density(40.0), [0.3, -0.2, 0.1]),
                ] {
                    let obstacle = obstacle.damping(7.0).tangential_damping(3.0).adhesion(adhesion);
                    let viscous = obstacle.velocity(at(w));
                    // what sticks, what has begun to slide, what slides
                    let rough = |v0: f64| {
                        viscous.clone().friction_coefficients(0.8, 0.5).sticking_speed(v0)
                    };
                    let rough = [20.0, 1.0, 0.01].map(|part| rough(part * speed));
                    // bristles, and those of the opposite way
                    let backward =
                        |e: [f64; 3], rough: &Obstacle| rough.clone().backward_friction(at(e), 2.9);
                    let bristly = rough.iter().map(|rough| backward([-1.0, 0.3, 0.2], rough));
                    let turned = rough.iter().map(|rough| backward([1.0, -0.3, -0.2], rough));
                    let bristly: Vec<Obstacle> = bristly.chain(turned).collect();
                    let v: Vec<f64> = v.iter().map(|v| speed * v).collect();
                    for obstacle in rough.iter().chain(&bristly).chain([&viscous]) {
                        println!("{dimension} {adhesion} {speed} {obstacle:?}");
                        let contact = Contact::new(&body, obstacle).unwrap();
                        let largest = check(&contact, (dimension, &cells), 0.2, &u, &v, 1e-7);
                        // without adhesion all may be cut off
                        assert!(largest > 0.0 || !adhesion);
                    }
                }
            }
        }
    }
}

/// Heat is counted by the velocity relative to an obstacle in motion, and its drive supplies the rest: the
/// change of potential by time alone, and f . w.
#[test]
fn a_moving_obstacle_supplies_what_its_drive_does() {
    let w = [0.4, -0.1];
    let slope = Obstacle::half_plane([0.5, 0.5], [-3.0, 4.0]).stiffness(50.0).damping(7.0);
    let contact = Contact::new(&plate(2), &slope.tangential_damping(3.0).velocity(w)).unwrap();
    let (u, v) = (noise(8, 0.1, 2.0), noise(8, 2.0, 20.0));
    let forces = nodal_forces(&contact, 0.2, &u, &v);
    let (dissipated, supplied) = forces.powers(&v);
    assert!(dissipated > 0.0);
    // with the velocities of the obstacle itself there is no heat, and its work is f . w
    let carried: Vec<f64> = w.into_iter().cycle().take(8).collect();
    assert_eq!(nodal_forces(&contact, 0.2, &u, &carried).powers(&carried).0, 0.0);
    let total: Vec<f64> = (0..8).map(|i| forces.conservative[i] + forces.dissipative[i]).collect();
    assert!((supplied - dot(&total, &carried)).abs() < 1e-12 * supplied.abs());
    // dU/dt + f . v + heat = supplied
    let h = 1e-5;
    let later = |by: f64| {
        let u: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u + by * v).collect();
        contact.potential(0.2 + by, &u)
    };
    let stored = (later(h) - later(-h)) / (2.0 * h);
    let balance = stored + dot(&total, &v) + dissipated - supplied;
    assert!(balance.abs() < 1e-7 * supplied.abs(), "{balance}");
}
