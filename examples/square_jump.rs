//! The jumping square of Hirai's Figs 4.5 and 4.6: pressed for half a second, held for another,
//! then released over a floor.
//!
//! `cargo run --release --example square_jump -- --nodes 10 --method ida`
//!
//! What to look for: the square leaves the floor after 65 ms and flies on (Hirai has no
//! gravity). It turns while it flies, for no reason but the triangles, whose diagonals all lean the
//! same way: 21 degrees on 4 x 4 nodes, 5 on 10 x 10. With `--gravity 9.8` Hirai's soft
//! floor hardly lets it jump; with a hard one, `--floor 4e6 --until 3`, it flies 3 m high.
//! With `--cells rectangles` (Fig. 4.7) it keeps its symmetry, as it does with any other division
//! that is symmetric itself, such as `--cells crossed --nodes 5`.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_animation, write_csv, write_vtk};
use pliant::samples::{SquareJump, pushed_nodes};
use pliant::{Cells, Error, Sample, Sampling, Trajectory};

/// The jumping square: a table of its phases, key figures, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Nodes along a side of the square
    #[arg(long, default_value_t = 4)]
    nodes: usize,
    /// How the square is divided: triangles, crossed, rectangles or triangles6
    #[arg(long, default_value_t = Cells::Triangles)]
    cells: Cells,
    /// Stiffness of the floor under the whole bottom (N/m)
    #[arg(long, default_value_t = 400.0)]
    floor: f64,
    /// Gravity (m/s^2)
    #[arg(long, default_value_t = 0.0)]
    gravity: f64,
    /// End of the jump (s)
    #[arg(long, default_value_t = 1.5)]
    until: f64,
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { nodes, cells, floor, gravity, until, ref common } = arguments;
    let scene =
        SquareJump { nodes, cells, floor, gravity, until, ..SquareJump::default() }.scene()?;
    let trajectory = scene.simulate(&common.settings(), &Sampling::every(0.005))?;

    println!("Jumping square, {nodes} x {nodes} nodes\n{}", trajectory.report());
    print_jump(&trajectory);

    let directory = common.out.join(format!("square_jump_{nodes}x{nodes}"));
    let title = format!("Jumping of an elastic square body, {nodes} x {nodes} nodes");
    let times = [0.0, 0.25, 0.5, 1.0, 1.02, 1.04, 1.06, 1.1, 1.2, 1.3, 1.4, 1.5];
    Snapshots::at(times).title(&title).write(&trajectory, directory.join("snapshots.svg"))?;
    write_animation(&trajectory, directory.join("animation.html"), &title)?;
    let series = |value: &dyn Fn(&Sample) -> f64| -> Vec<(f64, f64)> {
        trajectory.samples().iter().map(|sample| (sample.time, value(sample))).collect()
    };
    Chart::new("Height of the centre of mass")
        .axes("time (s)", "height (m)")
        .series("centre of mass", series(&|sample| trajectory.centre_of_mass(sample)[1]))
        .write(directory.join("height.svg"))?;
    Chart::new("Rotation of the square")
        .axes("time (s)", "angle (degrees)")
        .series("mean over the mass", series(&|sample| degrees(&trajectory, sample)))
        .write(directory.join("rotation.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), Some(&pushed_nodes(nodes).into()))?;
    write_vtk(&trajectory, directory.join("vtk"), "square")?;
    println!(
        "written to {}: animation.html, snapshots.svg, height.svg, rotation.svg, trajectory.csv, vtk/",
        directory.display()
    );
    Ok(())
}

/// Prints what the square does after its release.
fn print_jump(trajectory: &Trajectory) {
    let free = || trajectory.samples().iter().filter(|sample| sample.phase == 2);
    let height = |sample: &Sample| trajectory.centre_of_mass(sample)[1];
    let take_off = free().find(|sample| lowest_node(trajectory, sample) > 0.0);
    if let Some(sample) = take_off {
        let velocity = trajectory.mean_velocity(sample)[1];
        println!(
            "takes off {:.0} ms after the release, at {velocity:.4} m/s",
            1e3 * (sample.time - 1.0)
        );
    }
    if let Some(top) = free().max_by(|a, b| height(a).total_cmp(&height(b))) {
        println!(
            "greatest height of the centre of mass {:.4} m, at {:.3} s",
            height(top),
            top.time
        );
        println!("turned by {:.1} degrees then", degrees(trajectory, top));
    }
}

/// Height of the lowest node (m).
fn lowest_node(trajectory: &Trajectory, sample: &Sample) -> f64 {
    let natural = trajectory.body().mesh().positions().iter();
    let heights = natural.zip(&sample.u).skip(1).step_by(2).map(|(y, u)| y + u);
    heights.fold(f64::INFINITY, f64::min)
}

fn degrees(trajectory: &Trajectory, sample: &Sample) -> f64 {
    trajectory.rotation(sample).unwrap_or(0.0).to_degrees()
}
