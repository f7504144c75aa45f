//! Robots of the scenes, by figures that geometry gives.

use std::path::Path;

use pliant::Trajectory;
use pliant::scene_file::SceneFile;

/// The motion of a scene, up to `until` (s), with its sensors.
fn motion(text: &str, until: f64) -> Trajectory {
    let file = SceneFile::parse(text, Path::new("scenes/robot.toml")).unwrap();
    let scene = file.scene.ended_at(until);
    scene.simulate(&file.settings, &file.output.sampling()).unwrap()
}

/// The quadruped with coarser cells, `until` (s), with changes of its text.
fn quadruped(until: f64, changes: &[(&str, &str)]) -> Trajectory {
    let mut text = include_str!("../../scenes/quadruped.toml").to_owned();
    let coarser = ("quadratic = true }", "}\ndilatation = \"mean\"");
    for (from, to) in [coarser].iter().chain(changes) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    motion(&text, until)
}

/// In each half of a cycle the feet that push stand still, and the robot goes on by as much as a foot swings beside it, less what
/// slips: 4.6 % with these cells, 6 % with those of the scene. What it gains in the next cycle is the same to 0.1 %.
#[test]
fn a_quadruped_gains_what_its_feet_swing() {
    let motion = quadruped(1.0, &[]);
    let read = |k: usize, column: usize| motion.samples()[k].sensors[column];
    // robot.x, .y, .z, left front foot.x, ...
    let beside: Vec<f64> = (25..=50).map(|k| read(k, 3) - read(k, 0)).collect();
    let swing = beside.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
        - beside.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    let gained = read(50, 0) - read(25, 0);
    println!("gains {gained:.6} m, feet swing by {swing:.6} m");
    assert!(gained < 2.0 * swing && gained > 0.93 * 2.0 * swing, "{gained} {swing}");
    assert!(gained > 5e-3, "{gained}");
}

/// Without friction nothing pushes along the floor: the centre of mass stays over its place, to round-off beside the millimetres
/// of the walk (4e-16 m were found).
#[test]
fn a_quadruped_on_ice_stays_where_it_is() {
    let motion = quadruped(0.3, &[("friction_coefficient = 0.6", "friction_coefficient = 0.0")]);
    let far = motion.samples().iter().map(|sample| sample.sensors[0].abs()).fold(0.0, f64::max);
    println!("{far:.1e} m");
    assert!(far < 1e-12, "{far}");
}

/// With the fore chambers half a cycle after the rear ones the gait is its own mirror image, and the robot goes nowhere: once
/// the start has died away it gains 0.3 micrometres in a cycle, where 5.9 mm are gained a twentieth of a cycle earlier.
#[test]
fn a_quadruped_with_a_gait_that_is_its_mirror_image_goes_nowhere() {
    let later = [
        ("[0.225, 0.235, 0.35, 0.36]", "[0.25, 0.26, 0.375, 0.385]"),
        ("[0.475, 0.485, 0.6, 0.61]", "[0.5, 0.51, 0.625, 0.635]"),
    ];
    let motion = quadruped(1.0, &later);
    let gained = motion.samples()[50].sensors[0] - motion.samples()[25].sensors[0];
    println!("gains {gained:.2e} m");
    assert!(gained.abs() < 3e-6, "{gained}");
}

/// In flight the centre of mass follows a parabola whatever the ring does: every sample tells the height of the jump, v^2/(2 g)
/// above it. And what was stored is there in height, in vibration and in heat.
#[test]
fn a_robot_jumps_as_high_as_its_energy_says() {
    let motion = motion(include_str!("../../scenes/jumping-robot.toml"), 1.0);
    let mass = motion.body().mass();
    // robot.x, .y, momentum.x, .y, floor.x, .y, string
    let top = |k: usize| {
        let read = &motion.samples()[k].sensors;
        read[1] + (read[3] / mass).powi(2) / (2.0 * 9.8)
    };
    let height = top(98);
    println!("jumps to {height:.8} m");
    for k in 84..=100 {
        assert!((top(k) / height - 1.0).abs() < 1e-9, "{k}: {} {height}", top(k));
    }
    // what stays in the ring: all but the motion of the centre of mass, which has none at the top
    let [crouched, flying] = [80, 98].map(|k| &motion.samples()[k]);
    let [from, to] = [crouched, flying].map(|sample| {
        let energy = &sample.energy;
        let whole = sample.sensors[3].powi(2) / (2.0 * mass);
        energy.kinetic - whole + energy.strain + energy.contact + energy.springs + energy.dissipated
    });
    let stored = crouched.energy.strain;
    let lifted = mass * 9.8 * (height - crouched.sensors[1]);
    println!("{stored:.4e} J stored, {lifted:.4e} J of height");
    assert!((lifted / (from - to) - 1.0).abs() < 1e-3, "{lifted} {}", from - to);
    assert!(lifted > 0.6 * stored && lifted < 0.75 * stored, "{lifted} {stored}");
}

/// What a jellyfish hardly heavier than nothing gains in its second cycle, with the margin so much (s) later than the top.
fn jellyfish(later: &str) -> f64 {
    let mut text = include_str!("../../scenes/jellyfish.toml").to_owned();
    let light = [("density = 1000.0, young", "density = 10.0, young"), ("added_mass = 5.0\n", "")];
    for (from, to) in light.iter().chain(&[("(t - 0.25)", later)]) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let motion = motion(&text, 2.0);
    motion.samples()[40].sensors[1] - motion.samples()[20].sensors[1]
}

/// Drag that is odd in the velocity, whatever its power, takes back on the way back what it gave (E. M. Purcell's scallop theorem, *Life at low Reynolds number*,
/// 1977): without inertia both muscles at once gain nothing, and the reversed order of them goes the other way. Of what mass is left
/// there are 0.38 mm, and 1.79 and -1.51 mm by order; a tenth of the mass leaves 0.21 mm.
#[test]
fn a_jellyfish_without_mass_swims_by_the_order_of_its_muscles() {
    let [later, both, earlier] = ["(t - 0.25)", "t", "(t + 0.25)"].map(jellyfish);
    println!("gains {later:.3e} m, both at once {both:.3e} m, reversed {earlier:.3e} m");
    assert!(later > 1.4e-3 && earlier < -1.2e-3, "{later} {earlier}");
    assert!((later + earlier).abs() < 0.2 * later, "{later} {earlier}");
    assert!(both.abs() < 0.25 * later, "{both} {later}");
}

/// What an inchworm gains in a second is by how much its feet come nearer to each other as it arches, less what it creeps
/// backward under friction that is smooth: 4.9 % of it were lost.
#[test]
fn an_inchworm_gains_what_its_feet_approach() {
    let motion = motion(include_str!("../../scenes/inchworm.toml"), 2.0);
    let read = |k: usize, column: usize| motion.samples()[k].sensors[column];
    // rear.x, rear.y, front.x, front.y, feet
    let nearest = (50..=100).map(|k| read(k, 4)).fold(f64::INFINITY, f64::min);
    let (gained, stroke) = (read(100, 0) - read(50, 0), read(0, 4) - nearest);
    println!("gains {gained:.5} m of {stroke:.5} m");
    assert!(gained < stroke && gained > 0.94 * stroke, "{gained} {stroke}");
}

/// What rolls without slipping goes as far in a turn as its convex hull is long around. The robot bends a little as it turns,
/// and its hull with it, by 0.9 %: 1.6 % less were found.
#[test]
fn a_magnetic_robot_rolls_along_its_outline() {
    let motion = motion(include_str!("../../scenes/rolling-robot.toml"), 1.2);
    let [from, to] = [70, 120].map(|k| &motion.samples()[k]);
    let gained = to.sensors[0] - from.sensors[0];
    let mesh = motion.body().mesh();
    let at = |node: usize| {
        let (x, u) = (mesh.position(node), &to.u[2 * node..]);
        [x[0] + u[0], x[1] + u[1]]
    };
    let outline = around((0..mesh.node_count()).map(at).collect());
    println!("gains {gained:.5} m, around {outline:.5} m");
    assert!((gained / outline - 1.0).abs() < 0.025, "{gained} {outline}");
}

/// Length around the convex hull of some points, by Andrew's monotone chain.
fn around(mut points: Vec<[f64; 2]>) -> f64 {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let lower = chain(points.iter());
    let upper = chain(points.iter().rev());
    let length = |of: Vec<[f64; 2]>| -> f64 {
        of.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
    };
    length(lower) + length(upper)
}

fn chain<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> Vec<[f64; 2]> {
    let mut hull: Vec<[f64; 2]> = Vec::new();
    for &c in points {
        while let [.., a, b] = hull[..] {
            let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if turn > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(c);
    }
    hull
}
