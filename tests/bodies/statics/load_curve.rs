//! Load curves: in steps of the load, and by arc length past limit points, against closed forms and displacement control.

use pliant::{
    Axis, Body, Cells, Equilibrium, Error, Law, Material, Mesh, Obstacle, Phase, Scene, Stability,
    Statics, Strain,
};

use super::stability::truss;
use super::{RUBBER, bar};

#[test]
fn each_load_step_is_a_sample() {
    let (steps, force) = (5, 8.0);
    let pulled = Phase::until(2.0).hold("left").load("right", [force]);
    let scene = Scene::new(bar(Strain::Green)).phase(pulled);
    let curve = scene.equilibrium(&Statics { load_steps: steps, ..Statics::default() }).unwrap();
    let samples = curve.trajectory().samples();
    assert_eq!(samples.len(), steps + 1);
    assert_eq!(curve.trajectory().sensors()[0].name, "load factor");
    for (k, sample) in samples.iter().enumerate() {
        let part = k as f64 / steps as f64;
        assert!(
            (sample.time - 2.0 * part).abs() < 1e-15 && (sample.sensors[0] - part).abs() < 1e-15
        );
        // E A = 10 N, and (E A/2)(s^3 - s) is the force at a stretch s
        let s = 1.0 + sample.u[5] / 0.1;
        let found = 5.0 * (s.powi(3) - s);
        // rtol 1e-10 of some 10 N; measured: 1.3e-11
        assert!((found - part * force).abs() < 1e-10, "{k}: {found}");
        // what held the bar balances it
        let held = curve.trajectory().constraint_force(sample, "left").unwrap()[0];
        assert!((held + part * force).abs() < 1e-10, "{k}: {held}");
    }
    // one step is no curve
    let one = scene.equilibrium(&Statics::default()).unwrap();
    assert_eq!((one.trajectory().samples().len(), one.trajectory().sensors().len()), (2, 0));
    assert_eq!(one.sample().time, 2.0);
}

/// The highest of points (x, y), by the parabola through the first maximum and its neighbours.
fn first_maximum(points: &[[f64; 2]]) -> f64 {
    let top = points.windows(3).find(|p| p[1][1] >= p[0][1] && p[1][1] > p[2][1]).unwrap();
    let [[x0, y0], [x1, y1], [x2, y2]] = [top[0], top[1], top[2]];
    let (left, right) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
    let bend = (right - left) / (x2 - x0);
    let x = 0.5 * (x0 + x1 - left / bend);
    y0 + (x - x0) * (left + bend * (x - x1))
}

/// Von Mises' truss: with the apex at y its load is force(y), a cubic, whose limit point is at y = h/sqrt 3. All
/// samples lie on it, on the way down, too.
#[test]
fn a_truss_is_followed_through_its_snap() {
    let (h, square): (f64, f64) = (0.2, 1.04);
    let force = |y: f64| -2.0 * 10.0 * (y * y - h * h) / (2.0 * square) * y / square.sqrt();
    let limit = force(h / 3f64.sqrt());
    let load = 1.5 * limit;
    let scene = truss(h, Phase::until(1.0).load([2], [0.0, -load]));
    let statics = Statics { load_steps: 40, arc_steps: 1000, ..Statics::default() };
    let snapped = scene.equilibrium(&statics).unwrap();
    let curve: Vec<[f64; 2]> = snapped
        .trajectory()
        .samples()
        .iter()
        .map(|sample| [-sample.u[3], sample.sensors[0] * load])
        .collect();
    for [sinks, carried] in &curve {
        let exact = force(h - sinks);
        assert!((exact - carried).abs() < 1e-10 * limit, "at {sinks} m: {exact} {carried}");
    }
    // it comes within a step of the lower limit, too
    let least = curve.iter().map(|point| point[1]).fold(0.0, f64::min);
    assert!(least < -0.99 * limit, "{least} {limit}");
    let top = first_maximum(&curve);
    // measured: 3.4e-7
    assert!((top / limit - 1.0).abs() < 2e-6, "{top} {limit}");
    assert!(h + snapped.displacements()[3] < -h, "it has come out on the other side");
    assert!(matches!(snapped.stability, Stability::Stable { .. }));
    assert_eq!(snapped.sample().time, 1.0);
    assert!(curve.len() < 400 && snapped.failed_steps == 0, "{} points, {snapped}", curve.len());

    let few = Statics { arc_steps: 20, ..statics };
    let Err(Error::Statics(end)) = scene.equilibrium(&few) else { panic!("too few steps") };
    assert!(end.to_string().contains("in 20 steps"), "{end}");
    assert_eq!(end.trajectory.samples().len(), 21);
}

/// A shallow arch of 20 x 0.5 cm that rises by 1 cm, of quadratic cells, clamped at both ends.
fn arch(phase: Phase) -> Scene {
    let flat = Mesh::rectangle([0.2, 0.005], [41, 3], Cells::Triangles6).unwrap();
    let lift = |x: &[f64]| [x[0], x[1] + 0.01 * (std::f64::consts::PI * x[0] / 0.2).sin()];
    let positions = flat.positions().chunks(2).flat_map(lift).collect();
    let cells = flat.cells().flatten().copied().collect();
    let mesh = Mesh::new(2, positions, flat.kind(), cells).unwrap();
    let ends = |at: usize| [at, at + 41, at + 82];
    let mesh = mesh.name_nodes("left", ends(1)).unwrap().name_nodes("right", ends(41)).unwrap();
    let rubber = Material { poisson: 0.3, ..RUBBER };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build().unwrap();
    Scene::new(body).phase(phase.hold("left").hold("right"))
}

const CROWN: usize = 103;
/// Half as much again as the limit load (N).
const LOAD: f64 = 0.04;

/// The limit load of the arch by arc length, and by moving its crown down, where the force is that of the constraint.
#[test]
fn an_arch_snaps_at_the_load_that_displacement_control_finds() {
    let scene = arch(Phase::until(1.0).load([CROWN], [0.0, -LOAD]));
    let statics = Statics { load_steps: 20, arc_steps: 400, ..Statics::default() };
    let snapped = match scene.equilibrium(&statics) {
        Ok(snapped) => snapped.trajectory().clone(),
        Err(Error::Statics(end)) => panic!("{end}"),
        Err(error) => panic!("{error}"),
    };
    let dof = 2 * CROWN - 1;
    let curve: Vec<[f64; 2]> =
        snapped.samples().iter().map(|s| [-s.u[dof], LOAD * s.sensors[0]]).collect();
    let down = |depth: f64, load_steps| -> Equilibrium {
        let scene = arch(Phase::until(1.0).move_axis([CROWN], Axis::Y, -depth));
        scene.equilibrium(&Statics { load_steps, ..Statics::default() }).unwrap()
    };
    let pushed = down(0.02, 80);
    let force = |sample| -pushed.trajectory().constraint_force(sample, [CROWN]).unwrap()[1];
    let samples = pushed.trajectory().samples();
    let controlled: Vec<[f64; 2]> = samples.iter().map(|s| [-s.u[dof], force(s)]).collect();
    let [by_arc, by_depth] = [first_maximum(&curve), first_maximum(&controlled)];
    // both by parabolas through points on the curve; measured: 5e-6
    assert!((by_arc / by_depth - 1.0).abs() < 2e-5, "{by_arc} {by_depth}");
    // on the way down as well, at the same depth
    let top = curve.iter().position(|p| p[1] > 0.99 * by_arc).unwrap();
    let falling = curve.iter().skip(top).filter(|p| p[0] < 0.02 && p[1] < 0.95 * by_arc);
    let mut count = 0;
    for &[depth, carried] in falling.step_by(3) {
        let rest = down(depth, 10);
        let found = -rest.trajectory().constraint_force(rest.sample(), [CROWN]).unwrap()[1];
        // measured: 2e-12
        assert!((found - carried).abs() < 1e-11 * by_arc, "at {depth} m: {found} {carried}");
        count += 1;
    }
    assert!(count > 2);
}

/// Half of a shallow arch of 20 x 0.2 cm that rises by 1 cm, level at both ends. Between its limit points other branches pass so
/// near by that steps beside the tangent end on them. None does, so that it comes out where the whole load at once leads.
#[test]
fn no_step_leads_to_another_branch() {
    let flat = Mesh::rectangle([0.1, 0.002], [21, 2], Cells::Triangles6).unwrap();
    let rise = |x: f64| 0.01 * (0.5 * std::f64::consts::PI * x / 0.1).sin().powi(2);
    let mesh = flat.mapped(|x| [x[0], x[1] - 0.001 + rise(x[0])]).unwrap();
    let soft = Material { density: 1000.0, young: 1e6, poisson: 0.0, viscosity: 0.0 };
    let body = Body::new(mesh, soft.law(Law::Corotated)).thickness(0.01).build().unwrap();
    let phase = Phase::until(1.0)
        .hold("left")
        .symmetry("right", [1.0, 0.0])
        .load_total("right", [0.0, -0.005]);
    let scene = Scene::new(body).phase(phase);
    let statics = Statics { load_steps: 5, arc_steps: 400, ..Statics::default() };
    let found = scene.equilibrium(&statics).unwrap();
    let samples = found.trajectory().samples();

    let count = scene.body().mesh().node_count();
    let pairs = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
    let masses = pairs.map(|(i, j)| (i, j, scene.body().inertia().get(i, j)));
    let masses: Vec<_> = masses.filter(|(_, _, mass)| *mass != 0.0).collect();
    let way = |pair: &[pliant::Sample]| {
        let way: Vec<f64> = pair[1].u.iter().zip(&pair[0].u).map(|(u, v)| u - v).collect();
        let product = |&(i, j, m): &(usize, usize, f64)| {
            m * (way[2 * i] * way[2 * j] + way[2 * i + 1] * way[2 * j + 1])
        };
        masses.iter().map(product).sum::<f64>().sqrt()
    };
    let ways: Vec<f64> = samples.windows(2).map(way).collect();
    let longest = ways.iter().fold(0.0, |most: f64, way| most.max(*way));
    println!("{} steps, the longest {:.3} times the first", ways.len(), longest / ways[0]);
    // a step is longer than its way along the tangent by a tenth at most
    assert!(longest < 1.1 * ways[0], "{ways:?}");

    let at_once = scene.equilibrium(&Statics::default()).unwrap();
    let apart = at_once.displacements().iter().zip(found.displacements());
    let apart = apart.map(|(u, v)| (u - v).abs()).fold(0.0, f64::max);
    println!("{apart:e} m, {found}");
    assert!(apart < 1e-9, "{apart}");
}

#[test]
fn what_arc_length_cannot_follow_is_told() {
    let arc = Statics { arc_steps: 10, ..Statics::default() };
    let refused = |scene: Scene| scene.equilibrium(&arc).unwrap_err().to_string();
    let free = Scene::new(bar(Strain::Green)).phase(Phase::until(1.0));
    assert!(refused(free.clone()).contains("for arc length, hold more of its nodes"));
    let held = || Phase::until(1.0).hold("left");
    let plate = Obstacle::half_plane([0.12], [-1.0]).velocity([-0.04]).stiffness(300.0);
    let message = refused(Scene::new(bar(Strain::Green)).obstacle(plate).phase(held()));
    assert!(message.starts_with("statics.arc_steps for phase \"phase 1\" = 10"), "{message}");
    let message = refused(Scene::new(bar(Strain::Green)).phase(held()));
    assert!(message.contains("the load moves nothing"), "{message}");
    // where there is nothing to pass, the path is that of load steps
    let pulled = Scene::new(bar(Strain::Cauchy)).phase(held().load("right", [1.5]));
    let steps = Statics { load_steps: 4, ..arc };
    let u = pulled.equilibrium(&steps).unwrap();
    assert!((u.displacements()[5] - 0.015).abs() < 1e-14);
}
