//! Bodies that pass through themselves, of which the depth is known in closed form, and such that do not.

use std::f64::consts::TAU;

use pliant::mesh::CellKind;
use pliant::{
    Body, Cells, Indicator, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells,
    Strain, Touch, Trajectory, Verdict,
};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };

fn body(mesh: Mesh, strain: Strain) -> Body {
    let dimension = mesh.kind().dimension();
    let body = Body::new(mesh, SOFT).strain(strain);
    match dimension {
        1 => body.area(1e-4),
        2 => body.thickness(0.01),
        _ => body,
    }
    .build()
    .unwrap()
}

/// A body that begins where `map` takes it, and has no time to move.
fn begun(mesh: Mesh, map: impl Fn(&[f64]) -> Vec<f64>) -> Trajectory {
    let scene = Scene::new(body(mesh, Strain::Green))
        .initial_displacement(move |x| map(x).iter().zip(x).map(|(to, from)| to - from).collect())
        .phase(Phase::until(1e-9));
    // in one step, for which nothing has to be factorized
    let settings = Settings { method: Method::Rk, ..Settings::default() };
    scene.simulate(&settings, &Sampling::phase_ends()).unwrap()
}

fn overlap(motion: &Trajectory) -> Indicator {
    let indicators = &motion.report().indicators;
    indicators.iter().find(|indicator| indicator.name == "overlap").unwrap().clone()
}

/// Strips 4 mm thick, wound up to a turn and a half on a spiral that gains `pitch` times the thickness in each turn. Wound so tightly,
/// the boundary of each turn is within the next one by the smaller of the pitch and what is left of the thickness.
#[test]
fn strips_wound_into_themselves() {
    const THICK: f64 = 0.004;
    let length = 0.3;
    let wound = |pitch: f64| {
        let radius = length / (1.5 * TAU);
        move |x: &[f64]| {
            let turn = x[0] / radius;
            let across = *x.last().unwrap() - 0.5 * THICK;
            let r = radius + pitch * THICK * turn / TAU + across;
            let mut to = x.to_vec();
            to[0] = r * turn.sin();
            *to.last_mut().unwrap() = r * turn.cos();
            to
        }
    };
    let strips = || {
        let flat =
            Cells::ALL.map(|cells| Mesh::rectangle([length, THICK], [151, 3], cells).unwrap());
        let solid = SolidCells::ALL
            .map(|cells| Mesh::cuboid([length, 0.004, THICK], [76, 2, 2], cells).unwrap());
        flat.into_iter().chain(solid)
    };
    for strip in strips() {
        let kind = strip.kind();
        for (pitch, depth) in [(0.3, 0.3), (0.7, 0.3), (1.03, 0.0), (1.5, 0.0)] {
            let motion = begun(strip.clone(), wound(pitch));
            let told = overlap(&motion);
            if depth == 0.0 {
                assert_eq!(told.verdict, Verdict::Fine, "{kind:?} {pitch}: {told}");
                assert!(!motion.report().warnings().iter().any(|text| text.contains("passes")));
                continue;
            }
            // straight edges of 2 and 4 mm are off the circle of radius 32 mm by up to 0.06 mm, 0.016 of the thickness; the end of the
            // strip, too, is within the turn beside it, by half of the thickness at most
            let part = told.value / THICK;
            assert!((depth - 0.02..0.52).contains(&part), "{kind:?} {pitch}: {part}");
            let warnings = motion.report().warnings();
            let warning =
                warnings.iter().find(|text| text.contains("the body passes through itself"));
            let warning = warning.unwrap_or_else(|| panic!("{kind:?} {pitch}: {warnings:?}"));
            assert!(warning.contains("t = 0 s") && warning.contains("[[touch]]"), "{warning}");
        }
    }
}

/// Two blocks of 4 x 2 cm in one mesh, `gap` apart along x.
fn blocks(gap: f64, cells: Cells) -> Mesh {
    let one = Mesh::rectangle([0.04, 0.02], [9, 5], cells).unwrap();
    let shifted = |x: f64| one.positions().chunks(2).flat_map(move |at| [at[0] + x, at[1]]);
    let positions = shifted(0.0).chain(shifted(0.04 + gap)).collect();
    let count = one.node_count();
    let connectivity = [0, count]
        .into_iter()
        .flat_map(|first| one.cells().flatten().map(move |node| node + first));
    Mesh::new(2, positions, one.kind(), connectivity.collect()).unwrap()
}

/// The second of two blocks flies at 1 m/s at the first, 1 cm away, and through it: it is first seen at the first sample at which it
/// is deeper than a twentieth of its cell (0.25 mm). The deepest, with time on a grid of 1 ms, is when half of the lower
/// block's height of 2 cm is the nearest boundary.
#[test]
fn pieces_that_fly_through_each_other() {
    for cells in [Cells::Triangles, Cells::Rectangles, Cells::Triangles6, Cells::Rectangles9] {
        let scene = |end: f64| {
            Scene::new(body(blocks(0.01, cells), Strain::Green))
                .initial_velocity(|x| vec![if x[0] > 0.045 { -1.0 } else { 0.0 }, 0.0])
                .phase(Phase::until(end))
        };
        let run =
            |end: f64| scene(end).simulate(&Settings::default(), &Sampling::every(0.001)).unwrap();
        let free = overlap(&run(0.010));
        assert_eq!((free.verdict, free.value < 1e-6), (Verdict::Fine, true), "{free}");
        let motion = run(0.015);
        let told = overlap(&motion);
        // 5 mm in, all of it within the block's own boundary: rtol 1e-5 of a way of 15 mm, and what Newton leaves
        assert!((told.value - 0.005).abs() < 1e-6, "{told}");
        assert!(
            told.text.starts_with(
                "a piece of the body passes through another one from t = 0.011 s on: at t = 0.015 s"
            ),
            "{told}"
        );
        assert!(motion.report().warnings().contains(&told.text));
        // the nearest boundary of what is 8 mm in is the side that it came through, and none that is found earlier node by node
        let deep = overlap(&run(0.018));
        assert!((deep.value - 0.008).abs() < 1e-6, "{deep}");
        // depth is that in the body as it is, here stretched to one and a half times its length
        let stretched = begun(blocks(0.01, cells), |x| {
            vec![1.5 * if x[0] > 0.045 { x[0] - 0.015 } else { x[0] }, x[1]]
        });
        let stretched = overlap(&stretched);
        assert!((stretched.value - 0.0075).abs() < 1e-9, "{stretched}");
        // it was not drawn so
        assert!(!scene(0.015).warnings().iter().any(|text| text.contains("overlaps itself")));
    }
}

/// A mesh that overlaps itself as it is drawn is told before the run, and not again after it.
#[test]
fn drawn_into_each_other() {
    let scene = Scene::new(body(blocks(-0.006, Cells::Triangles6), Strain::Green))
        .phase(Phase::until(1e-3));
    let indicators = scene.indicators();
    let drawn = indicators.iter().find(|told| told.name == "drawn-overlap").unwrap();
    assert!((drawn.value - 0.006).abs() < 1e-12, "{drawn}");
    assert!(drawn.text.contains("the mesh overlaps itself as it is drawn"), "{drawn}");
    assert!(scene.warnings().contains(&drawn.text));
    let motion = scene.simulate(&Settings::default(), &Sampling::every(1e-4)).unwrap();
    assert_eq!(overlap(&motion).verdict, Verdict::Fine);
}

/// What touches does not overlap: two blocks side by side, as a slit has them, straight or bent, with one slid along the other by
/// a quarter of a cell. Straight edges are off the arc by L^2/(8 R) = 0.05 mm, a fifth of the limit.
#[test]
fn touching_is_no_overlap() {
    for cells in [Cells::Triangles, Cells::Triangles6, Cells::Rectangles, Cells::Rectangles9] {
        let scene = Scene::new(body(blocks(0.0, cells), Strain::Green)).phase(Phase::until(0.01));
        assert!(!scene.warnings().iter().any(|text| text.contains("overlaps")));
        let motion = begun(blocks(1e-9, cells), |x| {
            let (turn, r) = (x[1] / 0.07, 0.03 + x[0]);
            let turn = if x[0] > 0.04 + 5e-10 { turn + 0.02 } else { turn };
            vec![r * turn.cos(), r * turn.sin()]
        });
        let told = overlap(&motion);
        assert_eq!(told.verdict, Verdict::Fine, "{cells:?}: {told}");
    }
}

/// Two beams cross at right angles, with cells eight times as long as thick, so that no node of one is within the other: points
/// between the nodes are. Their depth is half of the thickness, up to where points are along an edge.
#[test]
fn slender_cells_that_cross_between_their_nodes() {
    let (long, thick) = (0.16, 0.002);
    let flat = |cells| Mesh::rectangle([long, thick], [11, 2], cells).unwrap();
    let solid = |cells| Mesh::cuboid([long, thick, thick], [11, 2, 2], cells).unwrap();
    for one in [
        flat(Cells::Rectangles),
        flat(Cells::Triangles6),
        flat(Cells::Rectangles9),
        solid(SolidCells::Hexahedra),
        solid(SolidCells::Hexahedra27),
    ] {
        let kind = one.kind();
        let d = one.dimension();
        let first = || one.positions().iter().copied();
        // beside the first one, upright
        let second = one.positions().chunks(d).flat_map(|x| {
            let mut at = x.to_vec();
            (at[0], at[1]) = (0.2 - x[1], x[0]);
            at
        });
        let count = one.node_count();
        let cells =
            [0, count].into_iter().flat_map(|k| one.cells().flatten().map(move |node| node + k));
        let mesh =
            Mesh::new(d, first().chain(second).collect(), one.kind(), cells.collect()).unwrap();
        // to the middle of a cell of the first, and of its own
        let moved = move |x: &[f64]| {
            let mut to = x.to_vec();
            if x[0] > 0.19 {
                to[0] -= 0.2 - 0.073;
                to[1] -= 0.0725;
                // not in the plane of the faces of the other
                to.iter_mut().skip(2).for_each(|z| *z += 0.0007);
            }
            to
        };
        let motion = begun(mesh, moved);
        let told = overlap(&motion);
        assert!(told.value > 0.2 * thick && told.value <= 0.5 * thick + 1e-9, "{kind:?}: {told}");
        assert_eq!(told.verdict, Verdict::Doubtful, "{told}");
    }
}

/// Bars on a line pass through each other by their ends; a string in the plane has no inside.
#[test]
fn bodies_of_one_dimension() {
    let positions = vec![0.0, 0.1, 0.2, 0.25, 0.35];
    let mesh = Mesh::new(1, positions, CellKind::Segment, vec![0, 1, 1, 2, 3, 4]).unwrap();
    let motion = begun(mesh, |x| vec![if x[0] > 0.22 { x[0] - 0.08 } else { x[0] }]);
    let told = overlap(&motion);
    assert!((told.value - 0.03).abs() < 1e-12, "{told}");
    let string = Mesh::bar(0.1, 5).unwrap().mapped(|x| [x[0], 0.0]).unwrap();
    let indicators = begun(string, <[f64]>::to_vec).report().indicators.clone();
    assert!(!indicators.iter().any(|indicator| indicator.name.contains("overlap")));
}

/// What passes through what is told with what helps there: a touch where there is none between them, harder springs.
#[test]
fn help_goes_by_what_touches() {
    let soft = Material { density: 1000.0, young: 1e4, poisson: 0.3, viscosity: 0.0 };
    let block = |name: &str, x: f64| {
        let mesh = Mesh::rectangle([0.04, 0.04], [3, 3], Cells::Triangles).unwrap();
        let mesh = mesh.translated(&[x, 0.0]).unwrap();
        Body::new(mesh, soft).thickness(0.01).named(name).build().unwrap()
    };
    let help = |touch: Touch| {
        let bodies = [block("left", 0.0), block("right", 0.05), block("far", 1.0)];
        let scene = Scene::new(Body::join(bodies).unwrap())
            .initial_velocity(|x| vec![if x[0] < 0.045 { 1.0 } else { 0.0 }, 0.0])
            .touch(touch)
            .phase(Phase::until(0.025));
        let told = overlap(&scene.simulate(&Settings::default(), &Sampling::every(5e-3)).unwrap());
        assert_eq!(told.verdict, Verdict::Doubtful, "{told}");
        println!("{told}");
        told.text
    };
    let springs = help(Touch::all().spring().stiffness_density(1e3));
    assert!(springs.contains("raise the stiffness_density"), "{springs}");
    for touch in [Touch::between(["left", "far"]), Touch::between(["left"])] {
        let apart = help(touch);
        assert!(
            apart.contains("Nothing keeps them apart") && apart.contains("[[touch]]"),
            "{apart}"
        );
    }
}
