//! Liquids with a surface against their own derivatives, against levels in closed form and hydrostatic pressure.

use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, largest};
use crate::elements::body::{Body, Strain};
use crate::elements::force::{Force, NodalForces};
use crate::elements::mesh::{Cells, Mesh, Selection, SolidCells};
use crate::scene::forces::chamber_fluid::{ChamberFluid, Fill};
use crate::scene::forces::fixed_amount::FixedAmount;
use crate::scene::forces::liquid::{LiquidInChamber, Weight};
use crate::scene::forces::tests::{check, nodal_forces, noise};
use crate::scene::forces::{Chamber, Liquid};
use crate::studies::samples::SQUARE_MATERIAL;

const GRAVITY: f64 = 9.8;
const DENSITY: f64 = 900.0;
const THICKNESS: f64 = 0.7;

fn body(mesh: Mesh) -> Body {
    let is_plane = mesh.dimension() == 2;
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy);
    if is_plane { body.thickness(THICKNESS) } else { body }.build().unwrap()
}

/// The boundary of a rectangle with so many nodes along each side, as a room.
fn inside([across, up]: [usize; 2]) -> Chamber {
    let at = |i: usize, j: usize| 1 + i + across * j;
    let bottom = (0..across).map(|i| at(i, 0));
    let right = (1..up).map(|j| at(across - 1, j));
    let top = (0..across - 1).rev().map(|i| at(i, up - 1));
    let left = (1..up - 1).rev().map(|j| at(0, j));
    Chamber::within("tank", bottom.chain(right).chain(top).chain(left).collect::<Vec<usize>>())
}

fn poured(body: &Body, chamber: &Chamber, fill: f64, down: [f64; 3]) -> LiquidInChamber {
    let walls = chamber.force(body, Vec::new()).unwrap();
    let basin = chamber.basin(body, &walls, down).unwrap();
    let weight = Weight::OfSurface { basin, gravity: GRAVITY };
    let liquid = Liquid::in_chamber("tank").density(DENSITY).fill(fill).surface();
    liquid.pour(walls, body.dofs(), weight, Vec::new()).unwrap()
}

fn forces(liquid: &LiquidInChamber, u: &[f64], amount: f64) -> Vec<f64> {
    let mut forces = NodalForces::zeros(u.len());
    liquid.press(u, Fill::of(amount), &mut forces).unwrap();
    forces.conservative.to_vec()
}

/// Rooms with walls of all kinds of pieces: a polygon, holes in blocks with and without mid nodes, a cup with a lid.
fn rooms() -> Vec<(Body, Chamber)> {
    let hollow = |mesh: Mesh, dimension: usize, is_quadratic: bool| {
        let is_middle = |cell: &&[usize]| {
            let inside =
                |&node: &usize| mesh.position(node).iter().all(|x| (x - 0.15).abs() < 0.06);
            cell.iter().all(inside)
        };
        let around = mesh.cells().filter(|cell| !is_middle(cell));
        let around = around.flat_map(<[usize]>::to_vec).collect();
        let kind = mesh.kind();
        let mesh = Mesh::new(dimension, mesh.positions().to_vec(), kind, around).unwrap();
        if is_quadratic { mesh.quadratic().unwrap() } else { mesh }
    };
    let within = |dimension: usize| {
        let [min, max] = [0.1 - 1e-9, 0.2 + 1e-9].map(|corner| vec![corner; dimension]);
        Chamber::within("tank", Selection::Box { min, max })
    };
    let plane = || Mesh::rectangle([0.3; 2], [4; 2], Cells::Rectangles).unwrap();
    let cube = || Mesh::cuboid([0.3; 3], [4; 3], SolidCells::Hexahedra).unwrap();
    let tetrahedra = Mesh::cuboid([0.3; 3], [4; 3], SolidCells::Tetrahedra).unwrap();
    // the lower half of the skin of a block: a cup of its outer faces
    let cup = Mesh::cuboid([0.3, 0.2, 0.2], [3, 3, 3], SolidCells::Hexahedra).unwrap();
    let skin = cup
        .boundary_faces()
        .into_iter()
        .filter(|face| face.iter().all(|&node| cup.position(node)[2] < 0.11));
    let triangles = skin.flat_map(|face| {
        let [a, b, c, d] = face[..] else { panic!("four corners") };
        [[a, b, c], [a, c, d]].map(|triangle| triangle.map(|node| node + 1))
    });
    let cup_walls = Chamber::surface("tank", triangles).closed_by_lid();
    vec![
        (body(plane()), Chamber::within("tank", [1, 2, 3, 7, 11, 10, 9, 5])),
        (body(hollow(plane(), 2, true)), within(2)),
        (body(hollow(cube(), 3, false)), within(3)),
        (body(hollow(cube(), 3, true)), within(3)),
        (body(hollow(tetrahedra, 3, true)), within(3)),
        (body(cup), cup_walls),
    ]
}

/// Directions of gravity in the plane and in space.
const DOWN: [[f64; 3]; 2] = [[0.6, -0.8, 0.0], [0.48, 0.36, -0.8]];

/// Forces are the derivative of the energy, and what flows in brings that by the amount; the tangent is that of the forces: with a level that follows the walls, in rooms
/// whose walls are bent.
#[test]
fn forces_and_tangents_belong_to_the_energy() {
    for (number, (body, chamber)) in rooms().iter().enumerate() {
        let (d, n) = (body.dimension(), body.dofs());
        let cells: Vec<&[usize]> = body.mesh().cells().collect();
        let fills = [(0.2, 1.0), (0.5, 2.0), (0.8, 3.0)];
        // rooms of many nodes one level each
        let some = if n < 300 { &fills[..] } else { &fills[number % 3..][..1] };
        for &(fill, seed) in some {
            let u = noise(n, 0.01, seed);
            let liquid = poured(body, chamber, fill, DOWN[d - 2]);
            let amount = liquid.amount();
            let more = 1e-5 * amount;
            let [ahead, behind] = [more, -more].map(|x| liquid.potential(&u, Fill::of(amount + x)));
            let [brought, slope] = liquid.brought(&u, amount).unwrap();
            // of what lifting it by the height of the room takes
            let difference = (ahead - behind) / (2.0 * more);
            assert!((brought - difference).abs() < 1e-7 * GRAVITY * 0.3, "{brought} {difference}");
            let [ahead, behind] = [more, -more].map(|x| liquid.brought(&u, amount + x).unwrap()[0]);
            let difference = (ahead - behind) / (2.0 * more);
            assert!((slope / difference - 1.0).abs() < 1e-4, "{number}: {slope} {difference}");
            let amount = liquid.amount();
            let closed = FixedAmount::new(liquid, amount, n);
            // the tangent has a kink where a corner is at the level
            let size = check(&closed, (d, &cells), 0.0, &u, &vec![0.0; n], 1e-5);
            assert!(size > 1.0, "{number}: {size}");
        }
    }
}

/// Whatever its shape, its forces add up to its weight, and do not change with the place where it is; raising it costs its weight.
#[test]
fn forces_are_its_weight() {
    for (number, (body, chamber)) in rooms().iter().enumerate() {
        let (d, u) = (body.dimension(), noise(body.dofs(), 0.01, 4.0));
        let down = DOWN[d - 2];
        let liquid = poured(body, chamber, 0.6, down);
        let weight = liquid.amount() * GRAVITY;
        let found = forces(&liquid, &u, liquid.amount());
        for (axis, down) in down.iter().enumerate().take(d) {
            let sum: f64 = found.iter().skip(axis).step_by(d).sum();
            let off = (sum / weight - down).abs();
            assert!(off < 1e-12, "{number}, {axis}: {off:e}");
        }
        let far: Vec<f64> = u.iter().enumerate().map(|(k, u)| u - 0.5 * down[k % d]).collect();
        let lifted = [&far, &u].map(|u| liquid.potential(u, Fill::of(liquid.amount())));
        assert!(((lifted[0] - lifted[1]) / (0.5 * weight) - 1.0).abs() < 1e-12);
        let there = forces(&liquid, &far, liquid.amount());
        let apart: Vec<f64> = found.iter().zip(&there).map(|(a, b)| a - b).collect();
        // round-off of a place 0.5 m away over walls of 0.1 m
        assert!(largest(&apart) < 1e-13 * weight, "{number}: {:e}", largest(&apart) / weight);
    }
}

/// Waterlines lie in the surface, and in the plane have its length.
#[cfg(feature = "output")]
#[test]
fn waterlines_lie_in_the_surface() {
    for (number, (body, chamber)) in rooms().iter().enumerate() {
        let (d, u) = (body.dimension(), noise(body.dofs(), 0.01, 4.0));
        let down = DOWN[d - 2];
        let liquid = poured(body, chamber, 0.6, down);
        let amount = liquid.amount();
        let (level, lines) = (liquid.level(&u, amount), liquid.waterline(&u, amount));
        let off = lines.iter().flatten().map(|end| (level + dot(&down, end)).abs());
        assert!(off.fold(0.0, f64::max) < 1e-15 && !lines.is_empty(), "{number}");
        if d == 2 {
            let [_, slope] = liquid.brought(&u, amount).unwrap();
            let area = GRAVITY / (DENSITY * slope);
            let length = lines.iter().map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1])).sum::<f64>();
            assert!((THICKNESS * length / area - 1.0).abs() < 1e-13, "{number}: {length} {area}");
        }
    }
}

/// A tank with upright walls and a slope: levels, the force rho g h^2/2 and the moment rho g h^3/6 on a wall for each meter along it, and rho g/A of the tangent, exactly, also where the
/// level is between nodes.
#[test]
fn walls_feel_the_pressure_of_the_depth() {
    let (mesh, down) =
        (Mesh::rectangle([0.3, 0.2], [2, 6], Cells::Rectangles).unwrap(), [0.0, -1.0, 0.0]);
    let body = body(mesh);
    let liquid = poured(&body, &inside([2, 6]), 0.35, down);
    let (rest, height) = (vec![0.0; body.dofs()], 0.35 * 0.2);
    let amount = liquid.amount();
    assert!((liquid.level(&rest, amount) - height).abs() < 1e-15);
    assert!((liquid.gauge(&rest, amount).unwrap() - DENSITY * GRAVITY * height).abs() < 1e-10);
    let found = forces(&liquid, &rest, amount);
    let left = body.mesh().select(&"left".into()).unwrap();
    let force: f64 = left.iter().map(|node| found[2 * node]).sum();
    let moment: f64 =
        left.iter().map(|node| body.mesh().position(*node)[1] * found[2 * node]).sum();
    let heaviness = DENSITY * GRAVITY * THICKNESS;
    assert!((force / (-heaviness * height.powi(2) / 2.0) - 1.0).abs() < 1e-13, "{force}");
    assert!((moment / (-heaviness * height.powi(3) / 6.0) - 1.0).abs() < 1e-13, "{moment}");
    let mut stiffness = BlockMatrix::zeros(body.inertia().pattern(), 2);
    let mut gradient = vec![0.0; rest.len()];
    let [_, stiff, _] =
        liquid.linearize(&rest, Fill::of(amount), &mut stiffness, &mut gradient).unwrap();
    assert!((stiff / (DENSITY * GRAVITY / (0.3 * THICKNESS)) - 1.0).abs() < 1e-13);
    // a wedge of 45 degrees: the area w h^2/2 below the level
    let mesh = Mesh::rectangle([0.2, 0.2], [2, 2], Cells::Triangles).unwrap();
    let body = self::body(mesh);
    let liquid = poured(&body, &Chamber::within("tank", [1, 4, 3]), 0.5, down);
    let amount = liquid.amount();
    let closed = FixedAmount::new(liquid, amount, body.dofs());
    let felt = nodal_forces(&closed, 0.0, &[0.0; 8], &[0.0; 8]).conservative.to_vec();
    // from the upper side down to the lower left corner: V = w h^2/2 with h = 0.2 sqrt(0.5)
    let height = 0.2 * 0.5_f64.sqrt();
    let pushed: f64 = felt.iter().step_by(2).sum::<f64>();
    assert!(pushed.abs() < 1e-12, "{pushed}");
    assert!((closed.potential(0.0, &[0.0; 8])).abs() < 1e-12);
    let weight = DENSITY * GRAVITY * THICKNESS * 0.5 * height * height;
    let sunk: f64 = felt.iter().skip(1).step_by(2).sum();
    assert!((sunk / -weight - 1.0).abs() < 1e-12, "{sunk} {weight}");
}

/// A box that is tilted as a whole has a level surface: its energy is that of the centre of a prism whose top is cut aslant, (b/2) tan^2 of the angle over 12 h and more.
#[test]
fn a_tilted_box_has_a_level_surface() {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body = body(mesh);
    let liquid = poured(&body, &inside([4, 3]), 0.5, [0.0, -1.0, 0.0]);
    let (b, h) = (0.3, 0.1);
    let turned = |angle: f64| -> Vec<f64> {
        let (sin, cos) = angle.sin_cos();
        let nodes = body.mesh().positions().chunks(2);
        nodes
            .flat_map(|x| [cos * x[0] - sin * x[1] - x[0], sin * x[0] + cos * x[1] - x[1]])
            .collect()
    };
    for angle in [0.1_f64, -0.3, 0.5] {
        let u = turned(angle);
        let (tan, weight) = (angle.tan(), liquid.amount() * GRAVITY);
        // in the box the surface is y = h - (x - b/2) tan
        let x = b / 2.0 - b * b * tan / (12.0 * h);
        let y = h / 2.0 + b * b * tan * tan / (24.0 * h);
        let centre = angle.sin() * x + angle.cos() * y;
        let energy = liquid.potential(&u, Fill::of(liquid.amount()));
        let expected = weight * (centre - h / 2.0);
        assert!((energy - expected).abs() < 1e-12 * weight * b, "{energy} {expected}");
        let found = forces(&liquid, &u, liquid.amount());
        // as the body turns about the origin, the moment is that of the weight
        let along: Vec<f64> = (0..u.len() / 2)
            .flat_map(|node| {
                let x = body.mesh().position(node);
                [-(x[1] + u[2 * node + 1]), x[0] + u[2 * node]]
            })
            .collect();
        let lever = angle.cos() * x - angle.sin() * y;
        let moment = dot(&found, &along);
        assert!((moment / (-weight * lever) - 1.0).abs() < 1e-12, "{moment}");
    }
}

/// Errors report a full chamber, walls that have passed through each other, a negative amount, and a fill of 1.
#[test]
fn limits_are_told() {
    let body = body(Mesh::rectangle([0.3, 0.2], [2, 2], Cells::Rectangles).unwrap());
    let chamber = inside([2, 2]);
    let liquid = poured(&body, &chamber, 0.9, [0.0, -1.0, 0.0]);
    let narrow = [0.0, 0.0, -0.06, 0.0, 0.0, 0.0, -0.06, 0.0];
    let turned = [0.0, 0.0, -0.6, 0.0, 0.0, 0.0, -0.6, 0.0];
    let amount = liquid.amount();
    let mut nodal = NodalForces::zeros(8);
    for (u, amount, words) in [
        (narrow, amount, "is full to the rim: it has room for 3.3600e-2 m^3, and 3.7800e-2 m^3"),
        (turned, amount, "have passed through each other"),
        ([0.0; 8], -1.0, "let less flow out"),
    ] {
        let told =
            liquid.press(&u, Fill::of(amount), &mut nodal).unwrap_err().into_error().to_string();
        assert!(told.contains(words), "{told}");
    }
    let walls = chamber.force(&body, Vec::new()).unwrap();
    let full = Liquid::in_chamber("tank").surface();
    let told = full.pour(walls, 8, Weight::None, Vec::new()).err().unwrap().to_string();
    assert!(told.contains("fill = 1 cannot be used: with a surface it must be below 1"), "{told}");
}
