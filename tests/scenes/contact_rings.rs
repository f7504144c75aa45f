//! Thin rings that are pressed flat, by blocks and by themselves, against the elastica.

use std::f64::consts::{FRAC_PI_2, PI};

use pliant::solve::{Method, Options, Problem, solve};
use pliant::{Axis, Body, Cells, Chamber, Material, Mesh, Phase, Plane, Scene, Statics, Touch};

/// What the equations y' = f(y) lead to at the end of `span`, by the integrators alone.
fn led<const N: usize>(
    start: [f64; N],
    span: [f64; 2],
    f: impl Fn(&[f64]) -> [f64; N] + Send + 'static,
) -> Vec<f64> {
    let rates = move |_: f64, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&f(y));
        Ok(())
    };
    let [from, to] = span;
    let problem = Problem::ode(rates, start.to_vec());
    let options = Options::new(1e-11, 1e-13);
    solve(problem, Method::DormandPrince, (from, to), &options).unwrap().at(to).unwrap()
}

/// The node of a mesh, counted from 1, that is nearest to a place.
fn node_at(mesh: &Mesh, place: [f64; 2]) -> usize {
    let off = |node: &usize| {
        let x = mesh.position(*node);
        (x[0] - place[0]).hypot(x[1] - place[1])
    };
    1 + (0..mesh.node_count()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
}

const RADIUS: f64 = 0.05;
const WALL: f64 = 1e-3;
/// Bending stiffness (N m^2) of the thin rings, 1 cm thick, of 1 MPa in plane stress.
const BENDING: f64 = 1e6 * 0.01 * WALL * WALL * WALL / 12.0;

fn ring() -> (Body, [usize; 3]) {
    let [inner, outer] = [RADIUS - 0.5 * WALL, RADIUS + 0.5 * WALL];
    let mesh = Mesh::ring(inner, outer, [96, 2], Cells::Rectangles9).unwrap();
    let nodes = [[0.0, inner], [0.0, -inner], [inner, 0.0]].map(|place| node_at(&mesh, place));
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let body = Body::new(mesh, rubber).thickness(0.01).plane(Plane::Stress).named("ring");
    (body.build().unwrap(), nodes)
}

/// A thin ring is pressed flat by two rigid blocks to 60 % of its height: the force is that of the elastica of a quarter ring,
/// kappa' = F cos(theta)/(2 E I), which begins at the block with theta = 0 and ends upright. For small forces that is
/// 0.1488 F R^3/(E I). A mesh of 96 cells is 0.33 % off, one of 192 cells 6e-5. (It begins 0.6 of the contact distance apart: at half of
/// it, where forces have a kink at the top of the ring, the search ends without a balance.)
#[test]
fn a_ring_between_two_blocks() {
    const DISTANCE: f64 = 5e-5;
    const SQUEEZED: f64 = 0.02;
    let (ring, [top, bottom, _]) = ring();
    let block = |name: &str, y: f64| {
        let mesh = Mesh::rectangle([0.06, 0.004], [25, 2], Cells::Rectangles).unwrap();
        let mesh = mesh.translated(&[-0.03, y]).unwrap();
        Body::new(mesh, Material::rigid(2000.0)).thickness(0.01).named(name).build().unwrap()
    };
    let outer = RADIUS + 0.5 * WALL + 0.6 * DISTANCE;
    let bodies = [ring, block("lower", -outer - 0.004), block("upper", outer)];
    let scene = Scene::new(Body::join(bodies).unwrap())
        .touch(Touch::all().distance(DISTANCE).stiffness_density(0.1 * 1e6 / DISTANCE))
        .phase(
            Phase::until(1.0)
                .hold("lower")
                .hold_axes([top, bottom], [Axis::X])
                .move_nodes("upper", [0.0, -SQUEEZED - DISTANCE]),
        );
    let found = scene.equilibrium(&Statics::default()).unwrap();
    let force = found.trajectory().constraint_force(found.sample(), "upper").unwrap()[1].abs();
    let u = found.displacements();
    let flattened = (u[2 * bottom - 1] - u[2 * top - 1]) / RADIUS;
    // height of a quarter ring of the radius 1 and the curvature at the block that lets it end upright
    let quarter = |load: f64, curvature: f64| {
        let f = move |y: &[f64]| [y[1], 0.5 * load * y[0].cos(), y[0].sin()];
        led([0.0, curvature, 0.0], [0.0, FRAC_PI_2], f)
    };
    let height = |load: f64| {
        let curvature = root([0.0, 1.0], |curvature| quarter(load, curvature)[0] - FRAC_PI_2);
        quarter(load, curvature)[2]
    };
    let load = root([1e-3, 2.6], |load| 2.0 - 2.0 * height(load) - flattened);
    let small = 2.0 * (1.0 - height(1e-3)) / 1e-3;
    assert!((small / (PI / 4.0 - 2.0 / PI) - 1.0).abs() < 1e-3, "{small}");
    let expected = load * BENDING / (RADIUS * RADIUS);
    println!("flattened by {flattened} R by {force} N; the elastica takes {expected} N");
    assert!((force / expected - 1.0).abs() < 5e-3, "{force} {expected}");
}

/// Where a function changes its sign.
fn root([mut from, mut to]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let rises = f(from) < 0.0;
    assert!(rises != (f(to) < 0.0), "no root between {from} and {to}");
    for _ in 0..40 {
        let middle = 0.5 * (from + to);
        if (f(middle) < 0.0) == rises { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}

/// A thin ring collapses under pressure from outside until its opposite sides touch: Flaherty, Keller and Rubinow (SIAM J.
/// Appl. Math. 23 (1972) 446) find that at p R^3/(E I) = 5.247. Before and after, the height and the width are those of a
/// quarter of the elastica, kappa' = cos(theta) (p x - C/2) - p y sin(theta), with the force C of the contact. The mesh of 96
/// cells is some 0.3 % too stiff: heights and widths are off by 2.4e-3 R.
#[test]
fn a_ring_touches_itself() {
    const DISTANCE: f64 = 1e-4;
    let (ring, [top, bottom, side]) = ring();
    let squeezed = |load: f64| {
        let small = 1e-3 * BENDING / (RADIUS * RADIUS);
        let pressure = load * BENDING / RADIUS.powi(3) / 0.01;
        // what presses inwards acts on the inner face, which is shorter than the middle line
        let pressure = pressure * RADIUS / (RADIUS - 0.5 * WALL);
        let scene = Scene::new(ring.clone())
            .touch(Touch::all().distance(DISTANCE).stiffness_density(0.1 * 1e6 / DISTANCE))
            .chamber(Chamber::within("inside", "inner"))
            .phase(
                Phase::until(1.0)
                    .hold_axes([top, bottom], [Axis::X])
                    .hold_axes([side], [Axis::Y])
                    .load([top], [0.0, -small])
                    .load([bottom], [0.0, small])
                    .pressure("inside", -pressure),
            );
        let found = scene.equilibrium(&Statics::default()).unwrap();
        let u = found.displacements();
        let height = 1.0 + 0.5 * (u[2 * top - 1] - u[2 * bottom - 1]) / RADIUS;
        [height, 1.0 + u[2 * (side - 1)] / RADIUS]
    };
    // angle and height at the side of a quarter ring that begins with a curvature at a height, and its width
    let quarter = |load: f64, [curvature, height, force]: [f64; 3]| {
        let f = move |y: &[f64]| {
            let (sin, cos) = y[0].sin_cos();
            let bending = cos * (load * y[2] - 0.5 * force) - load * y[3] * sin;
            [y[1], bending, cos, -sin]
        };
        let end = led([0.0, curvature, 0.0, height], [0.0, FRAC_PI_2], f);
        ([end[0] - FRAC_PI_2, end[3]], end[2])
    };
    // Newton's method for the curvature and one other unknown
    let solved = |mut z: [f64; 2], of: &dyn Fn([f64; 2]) -> ([f64; 2], f64)| {
        for _ in 0..20 {
            const H: f64 = 1e-6;
            let (e, _) = of(z);
            let [(a, _), (b, _)] = [of([z[0] + H, z[1]]), of([z[0], z[1] + H])];
            let slope = |i: usize| [(a[i] - e[i]) / H, (b[i] - e[i]) / H];
            let [s, t] = [slope(0), slope(1)];
            let determinant = s[0] * t[1] - s[1] * t[0];
            z[0] -= (e[0] * t[1] - s[1] * e[1]) / determinant;
            z[1] -= (s[0] * e[1] - e[0] * t[0]) / determinant;
        }
        (z, of(z).1)
    };
    let ([_, load], _) = solved([-1.0, 5.0], &|z| quarter(z[1], [z[0], 0.0, 0.0]));
    assert!((load - 5.247).abs() < 5e-4, "{load}");
    let ([_, height], width) = solved([-0.5, 0.3], &|z| quarter(4.0, [z[0], z[1], -1e-3]));
    let found = squeezed(4.0);
    println!("before: {found:?}, elastica [{height}, {width}]");
    assert!((found[0] - height).abs() < 3e-3 && (found[1] - width).abs() < 3e-3);
    let found = squeezed(8.0);
    // walls that nearly touch
    let least = 0.5 * WALL / RADIUS;
    assert!(found[0] > least && found[0] < least + 0.5 * DISTANCE / RADIUS, "{found:?}");
    let ([_, force], width) = solved([-0.5, 4.3], &|z| quarter(8.0, [z[0], found[0], z[1]]));
    println!("after: {found:?}, elastica {width} with the force {force}");
    assert!(force > 4.0 && (found[1] - width).abs() < 3e-3);
}
