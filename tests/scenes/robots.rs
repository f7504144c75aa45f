//! Robots of the scenes, by figures that geometry gives.

use std::path::Path;

use pliant::Trajectory;
use pliant::scene_file::SceneFile;

/// The motion of a scene, up to `until` (s), with its sensors.
fn motion(text: &str, until: f64) -> Trajectory {
    let file = SceneFile::parse(text, Path::new("robot.toml")).unwrap();
    let scene = file.scene.ended_at(until);
    scene.simulate(&file.settings, &file.output.sampling()).unwrap()
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
