//! Problem 2 of Hirai's chapter: the rolling ring with Cauchy strain, compared with Green strain.
//!
//! `cargo run --release --example problem_2`
//!
//! What to look for: Cauchy strain takes rotation for compression. The ring swells as it turns, to
//! 1.69 times its area in the first swing, works against its own rotation, and comes to rest after
//! 22 degrees, still 1.16 times as large as it should be.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots};
use pliant::samples::RingRoll;
use pliant::{Error, Sample, Sampling, Strain, Trajectory};

/// The rolling ring with Cauchy and with Green strain.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse().common));
}

fn run(common: &Common) -> Result<(), Error> {
    let directory = common.out.join("problem_2");
    let mut rotations = Chart::new("Rotation of the ring").axes("time (s)", "angle (degrees)");
    let mut areas = Chart::new("Area of the ring").axes("time (s)", "area / undeformed area");
    for strain in [Strain::Green, Strain::Cauchy] {
        let scene = RingRoll { strain, ..RingRoll::default() }.scene()?;
        let trajectory = scene.simulate(&common.settings(), &Sampling::every(0.01))?;
        let series = |value: &dyn Fn(&Sample) -> f64| -> Vec<(f64, f64)> {
            trajectory.samples().iter().map(|sample| (sample.time, value(sample))).collect()
        };
        let turned = series(&|s| trajectory.rotation(s).unwrap_or(0.0).to_degrees());
        let area = series(&|s| area_ratio(&trajectory, s));
        let largest = area.iter().fold(0.0_f64, |largest, point| largest.max(point.1));
        println!("{strain:?} strain\n{}", trajectory.report());
        println!(
            "turned by {:.1} degrees at the end; largest area {largest:.3} of the natural one\n",
            turned.last().map_or(f64::NAN, |point| point.1)
        );
        rotations = rotations.series(format!("{strain:?} strain"), turned);
        areas = areas.series(format!("{strain:?} strain"), area);
        let name = format!("{strain:?}").to_lowercase();
        Snapshots::at([0.0, 0.2, 0.5, 1.0, 2.0, 5.0])
            .title(format!("Rolling ring, {strain:?} strain"))
            .columns(6)
            .mark([1])
            .write(&trajectory, directory.join(format!("{name}.svg")))?;
    }
    rotations.write(directory.join("rotation.svg"))?;
    areas.write(directory.join("area.svg"))?;
    println!("written to {}: green.svg, cauchy.svg, rotation.svg, area.svg", directory.display());
    Ok(())
}

/// Present over undeformed area. (All cells of the ring are about equally large.)
fn area_ratio(trajectory: &Trajectory, sample: &Sample) -> f64 {
    let ratios = trajectory.body().volume_ratios(&sample.u);
    ratios.iter().sum::<f64>() / ratios.len() as f64
}
