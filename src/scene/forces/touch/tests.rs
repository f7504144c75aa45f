use std::sync::Arc;

use super::Touch;
use super::force::TouchForce;
use super::site::TouchSite;
use super::surfaces::Surfaces;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{cross, dot, largest, noise, norm};
use crate::elements::body::Body;
use crate::elements::force::{ContactForce, Force, NodalForces, Step};
use crate::elements::material::Material;
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::elements::rod::{Rod, RodSection};

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };

/// Cells of blocks in the plane or in space.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Plane(Cells),
    Solid(SolidCells),
}

impl Kind {
    const SOME: [Self; 5] = [
        Self::Plane(Cells::Triangles),
        Self::Plane(Cells::Triangles6),
        Self::Solid(SolidCells::Tetrahedra10),
        Self::Solid(SolidCells::Hexahedra),
        Self::Solid(SolidCells::Hexahedra27),
    ];

    fn dimension(self) -> usize {
        if matches!(self, Self::Plane(_)) { 2 } else { 3 }
    }
}

/// Two blocks in the plane or in space, 1 mm apart, of cells that do not match.
fn blocks(kind: Kind) -> Body {
    let dimension = kind.dimension();
    let mesh = |at: f64, divisions: usize| {
        let n = divisions;
        let mesh = match kind {
            Kind::Plane(cells) => Mesh::rectangle([0.1, 0.05], [2 * n + 1, n + 1], cells),
            Kind::Solid(cells) => Mesh::cuboid([0.1, 0.05, 0.08], [n + 1, n + 1, n], cells),
        };
        let place = [0.01 * n as f64, at, 0.007 * n as f64];
        mesh.unwrap().translated(&place[..dimension]).unwrap()
    };
    let body = |mesh: Mesh, name: &str| {
        let body = Body::new(mesh, SOFT).named(name);
        if dimension == 2 { body.thickness(0.01) } else { body }.build().unwrap()
    };
    Body::join([body(mesh(0.0, 2), "lower"), body(mesh(0.051, 3), "upper")]).unwrap()
}

/// Two bars of 20 cm with square sections of 2 cm, which stand on edge: the upper one is turned by `angle` about the vertical,
/// and its lowest edge crosses the uppermost one of the other at a fifth of an edge, four fifths of its own, `gap` (m) above
/// it.
fn bars_on_edge(angle: f64, gap: f64) -> Body {
    let half = f64::hypot(0.01, 0.01);
    let bar = |name: &str, from: f64, up: f64, angle: f64| {
        let mesh = Mesh::cuboid([0.2, 0.02, 0.02], [3, 2, 2], SolidCells::Hexahedra).unwrap();
        let mesh = mesh.mapped(|x| {
            let ([y, z], root) = ([x[1] - 0.01, x[2] - 0.01], f64::sqrt(0.5));
            let [along, across] = [x[0] - from, root * (z - y)];
            let [cos, sin] = [angle.cos(), angle.sin()];
            [along * cos - across * sin, up + root * (y + z), along * sin + across * cos]
        });
        Body::new(mesh.unwrap(), SOFT).named(name).build().unwrap()
    };
    let upper = bar("upper", 0.08, 2.0 * half + gap, angle);
    Body::join([bar("lower", 0.12, 0.0, 0.0), upper]).unwrap()
}

fn forces_at(force: &TouchForce, u: &[f64], v: &[f64]) -> NodalForces {
    let mut forces = NodalForces::zeros(u.len());
    force.add_forces(0.0, u, v, &mut forces).unwrap();
    forces
}

fn total(force: &TouchForce, u: &[f64], v: &[f64]) -> Vec<f64> {
    let forces = forces_at(force, u, v);
    forces.conservative.iter().zip(&*forces.dissipative).map(|(a, b)| a + b).collect()
}

/// Forces are the slope of the energy, and tangents that of the forces, damping and friction included, for both laws
/// in two and three dimensions: against central differences, in rough states in which corners, edges and facets act.
#[test]
fn forces_and_tangents_are_derivatives() {
    for kind in Kind::SOME {
        let (body, touch) = (blocks(kind), Touch::all().distance(8e-3));
        assert_derivatives(&body, &touch, 0.0);
        assert_derivatives(&body, &touch.spring(), 0.0);
    }
}

/// The same for two edges, which cross at a right angle and at angles at which they count less.
#[test]
fn edges_that_cross_have_exact_tangents() {
    for sine in [1.0_f64, 0.04, 0.02] {
        let body = bars_on_edge(sine.asin(), 5e-4);
        for touch in [Touch::all(), Touch::all().spring()] {
            // downwards, so that all presses
            assert_derivatives(&body, &touch.distance(4e-3), 0.3);
        }
    }
}

/// The same for rods, whose friction turns them: one that tapers over a block, one across another one, and one in the plane over a block.
#[test]
fn tubes_have_exact_tangents() {
    let rod = |points: [Vec<f64>; 2], radii: [f64; 2], elements: usize, name: &str| {
        let section = |radius| RodSection::Circle { radius };
        let rod = Rod::new(points.to_vec(), elements, section(radii[0])).end(section(radii[1]));
        Body::rod(rod, SOFT).unwrap().named(name).build().unwrap()
    };
    let block = |dimension: usize| {
        let body = match dimension {
            2 => Body::new(Mesh::rectangle([0.1, 0.05], [3, 2], Cells::Triangles6).unwrap(), SOFT)
                .thickness(0.01),
            _ => {
                let mesh = Mesh::cuboid([0.1, 0.05, 0.1], [3; 3], SolidCells::Hexahedra);
                Body::new(mesh.unwrap(), SOFT)
            }
        };
        body.named("block").build().unwrap()
    };
    let over = [vec![0.01, 0.062, 0.02], vec![0.09, 0.06, 0.08]];
    let flat = over.clone().map(|x| x[..2].to_vec());
    let lower = [vec![0.05, 0.04, 0.0], vec![0.05, 0.04, 0.1]];
    let pairs = [
        [block(3), rod(over.clone(), [0.009, 0.007], 3, "rod")],
        [rod(lower, [0.01, 0.01], 3, "lower"), rod(over, [0.009, 0.008], 4, "upper")],
        [block(2), rod(flat, [0.009, 0.008], 3, "rod")],
    ];
    for (bodies, speed) in pairs.into_iter().zip([0.3, 0.3, 0.3]) {
        let body = Body::join(bodies).unwrap();
        for touch in [Touch::all(), Touch::all().spring()] {
            assert_derivatives(&body, &touch.distance(8e-3), speed);
        }
    }
}

/// Bodies at rest, away from gravity.
fn alone<'a>(body: &'a Body, u: &'a [f64]) -> TouchSite<'a> {
    TouchSite { body, glued: &[], planes: &[], u, v: &[], gravity: 0.0 }
}

/// As the second half of the nodes moves down at a `speed` (m/s).
fn assert_derivatives(body: &Body, touch: &Touch, speed: f64) {
    let (dofs, dimension) = (body.dofs(), body.dimension());
    let touch = touch.clone().damping_density(1e4).friction_coefficients(0.5, 0.3);
    let touch = touch.sticking_speed(0.3);
    let u: Vec<f64> = noise(dofs, 7).iter().map(|x| 4e-4 * x).collect();
    let mut v: Vec<f64> = noise(dofs, 3).iter().map(|x| 0.2 * x).collect();
    v[dofs / 2..].iter_mut().skip(1).step_by(dimension).for_each(|v| *v -= speed);
    let force = touch.force(&alone(body, &u)).unwrap();
    let conservative = forces_at(&force, &u, &v).conservative;
    assert!(norm(&conservative) > 0.1, "{dimension}: nothing touches");
    let pattern = body.inertia().pattern();
    let near = force.couplings_near(&u, pattern);
    let pattern = Arc::new(pattern.with_pairs(&near));
    assert!(force.couplings_near(&u, &pattern).is_empty());
    let [mut stiffness, mut damping] = [0, 1].map(|_| BlockMatrix::zeros(&pattern, dimension));
    force.add_tangents(0.0, &u, &v, &mut stiffness, &mut damping);
    for seed in 0..2 {
        let direction = noise(dofs, 20 + seed);
        let h = 1e-8;
        let moved = |at: &[f64], by: f64| -> Vec<f64> {
            at.iter().zip(&direction).map(|(x, d)| x + by * d).collect()
        };
        let [ahead, behind] = [h, -h].map(|by| moved(&u, by));
        let energy = |u: &[f64]| force.potential(0.0, u);
        let slope = (energy(&ahead) - energy(&behind)) / (2.0 * h);
        let exact = -dot(&conservative, &direction);
        assert!((slope - exact).abs() < 2e-6 * norm(&conservative), "{slope} {exact}");

        let difference = |a: Vec<f64>, b: Vec<f64>, by: f64| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * by)).collect()
        };
        let check = |found: Vec<f64>, tangent: &BlockMatrix, tolerance: f64, what: &str| {
            let mut exact = vec![0.0; dofs];
            tangent.add_product(-1.0, &direction, &mut exact);
            let off: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| a - b).collect();
            let part = largest(&off) / largest(&exact);
            assert!(part < tolerance, "{what} in {dimension} D is off by {part:e}");
        };
        let by_u = difference(total(&force, &ahead, &v), total(&force, &behind, &v), h);
        check(by_u, &stiffness, 2e-8, "stiffness");
        let h = 1e-6;
        let [ahead, behind] = [h, -h].map(|by| moved(&v, by));
        let by_v = difference(total(&force, &u, &ahead), total(&force, &u, &behind), h);
        check(by_v, &damping, 1e-9, "damping");
    }
}

/// Momentum is conserved, also with friction, and friction and damping dissipate energy.
#[test]
fn momentum_is_exchanged_and_energy_lost() {
    for kind in Kind::SOME {
        let (body, dimension) = (blocks(kind), kind.dimension());
        let touch = Touch::all().distance(8e-3).damping_density(1e4).friction_coefficient(0.5);
        let u: Vec<f64> = noise(body.dofs(), 5).iter().map(|x| 4e-4 * x).collect();
        let v: Vec<f64> = noise(body.dofs(), 4).iter().map(|x| 0.2 * x).collect();
        let force = touch.force(&alone(&body, &u)).unwrap();
        let forces = forces_at(&force, &u, &v);
        assert!(dot(&forces.dissipative, &v) < 0.0);
        for part in [&forces.conservative, &forces.dissipative] {
            for axis in 0..dimension {
                let along = part.iter().skip(axis).step_by(dimension);
                let (sum, size) =
                    along.fold((0.0, 0.0), |(sum, size), f| (sum + f, size + f.abs()));
                assert!(sum.abs() < 1e-13 * size, "{sum} of {size}");
            }
        }
    }
}

/// Two edges that cross where no point is near: their force is that of the closed form, on both alike, and turns nothing.
#[test]
fn edges_push_where_no_point_is_near() {
    let (gap, reach, k) = (4e-4, 2e-3, 1e7);
    let body = bars_on_edge(std::f64::consts::FRAC_PI_2, gap);
    let still = vec![0.0; body.dofs()];
    let touch = Touch::all().distance(reach).stiffness_density(k);
    let force = touch.force(&alone(&body, &still)).unwrap();
    // a third of two triangles of 10 x 2 cm, their geometric mean, a quarter of it; at a fifth of edges of 10 cm from an end
    let area = 0.25 * 2.0 * 1e-3 / 3.0;
    let (along, slope) = (0.8 * 0.8 * (3.0 - 2.0 * 0.8), 6.0 * 0.8 * (1.0 - 0.8) / 0.25 / 0.1);
    let within = 0.5 * reach;
    let pressure = 2.0 * k * (within - gap).powi(2) * (within + 2.0 * gap) / (3.0 * gap * gap);
    let energy = 2.0 * k * (within - gap).powi(3) / (3.0 * gap);
    // as the upper one moves along x and z, the places move forth on the lower one and back on itself
    let exact = [
        -area * slope * along * energy,
        area * along * along * pressure,
        -area * along * slope * energy,
    ];
    let forces = forces_at(&force, &still, &still).conservative;
    let upper = body.dofs() / 2;
    let (mut total, mut turning, mut size) = ([0.0; 3], [0.0; 3], 0.0);
    for (node, f) in forces.chunks_exact(3).enumerate() {
        let x: [f64; 3] = std::array::from_fn(|i| body.mesh().position(node)[i]);
        let moment = cross(&x, &[f[0], f[1], f[2]]);
        (0..3).for_each(|i| turning[i] += moment[i]);
        size += norm(&moment);
        if 3 * node >= upper {
            (0..3).for_each(|i| total[i] += f[i]);
        }
    }
    // distances are differences of places of some 0.1 m: some 1e-16 of 4e-4
    for (found, exact) in total.iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-11, "{found} {exact}");
    }
    assert!(norm(&turning) < 1e-13 * size, "{turning:?} of {size}");
    assert!((force.gap(&still) - gap).abs() < 1e-15);
}

/// A step that leads an edge through an edge is cut where they begin to act, though no point comes near a facet.
#[test]
fn a_step_through_an_edge_is_seen() {
    let (gap, reach) = (3e-3, 2e-3);
    let body = bars_on_edge(std::f64::consts::FRAC_PI_2, gap);
    let still = vec![0.0; body.dofs()];
    let force = Touch::all().distance(reach).force(&alone(&body, &still)).unwrap();
    let down: Vec<f64> = (0..body.dofs())
        .map(|k| if k >= body.dofs() / 2 && k % 3 == 1 { -2.0 * gap } else { 0.0 })
        .collect();
    let step = Step { times: [0.0, 1.0], u: [&still, &down], v: [&down, &down] };
    let time = force.passage(&step, 0.0, &mut []).unwrap();
    // the search ends between 0.81 and 0.9 of the distance from which edges act
    let left = (gap - 2.0 * gap * time) / (0.5 * reach);
    assert!(0.8 < left && left < 0.9, "{left}");
}

/// The weights of facets, edges and corners cancel all but the nearest place of a convex surface, whatever the mesh:
/// points around a block feel its distance.
#[test]
fn a_convex_surface_is_felt_once() {
    for kind in Kind::SOME {
        let (body, dimension) = (blocks(kind), kind.dimension());
        let surfaces = Surfaces::new(&body, &[0, 1], false, &[]).unwrap();
        let still = vec![0.0; body.dofs()];
        let (from, to, reach) = ([0.02, 0.0, 0.014], [0.12, 0.05, 0.094], 0.02);
        let of_other = |&point: &usize| surfaces.bodies(point, 0)[0] == 1;
        let stranger = (0..surfaces.points.len()).find(of_other).unwrap();
        let mut count = 0;
        for unit in noise(1500, 8).chunks_exact(3) {
            let mut x = [0.0; 3];
            for i in 0..dimension {
                x[i] = 0.5 * (from[i] + to[i]) + 0.8 * unit[i] * (to[i] - from[i]);
            }
            let out: [f64; 3] = std::array::from_fn(|i| {
                if i < dimension { x[i] - x[i].clamp(from[i], to[i]) } else { 0.0 }
            });
            let distance = norm(&out);
            if distance == 0.0 || distance >= reach {
                continue;
            }
            count += 1;
            let felt: f64 = (0..surfaces.features.len())
                .filter(|&feature| surfaces.bodies(stranger, feature)[1] == 0)
                .map(|feature| {
                    let at = surfaces.nodes_at(feature, &still);
                    let place = surfaces.features[feature].nearest(&at, &x);
                    let d = place.distance(&at, &x);
                    let weight = surfaces.weight(stranger, feature);
                    weight * (reach - d).max(0.0).powi(2)
                })
                .sum();
            let exact = (reach - distance).powi(2);
            assert!((felt - exact).abs() < 1e-13 * reach * reach, "{kind:?} {x:?}: {felt} {exact}");
        }
        assert!(count > 50, "{count}");
    }
}
