//! Error of the motion of a reduced model relative to that of all unknowns.
//!
//! A model is verified with all runs, including the training runs.

use crate::dynamics::trajectory::{Sample, Trajectory};

/// The largest distance of a node in `reduced` from where it is in `full`, over all samples, relative to the largest distance
/// of a node in `full` from where it was at first. Infinite if the runs were not sampled at the same times, as where one
/// has ended early.
pub fn error(full: &Trajectory, reduced: &Trajectory) -> f64 {
    let (off, way) = (distance(full, reduced), travel(full));
    // nothing moves in either of them
    if off == 0.0 { 0.0 } else { off / way }
}

/// The largest distance (m) of a node in `reduced` from where it is in `full`; infinite as [`error`].
pub(super) fn distance(full: &Trajectory, reduced: &Trajectory) -> f64 {
    let (samples, others) = (full.samples(), reduced.samples());
    let is_same = |(one, other): (&Sample, &Sample)| one.time == other.time;
    if samples.len() != others.len() || !samples.iter().zip(others).all(is_same) {
        return f64::INFINITY;
    }
    let dimension = full.scene().body().dimension();
    let off = samples.iter().zip(others).map(|(one, other)| farthest(&one.u, &other.u, dimension));
    off.fold(0.0, f64::max)
}

/// The largest distance (m) of a node in a run from where it was at first.
pub(super) fn travel(run: &Trajectory) -> f64 {
    let dimension = run.scene().body().dimension();
    let start = &run.samples()[0].u;
    run.samples().iter().map(|sample| farthest(&sample.u, start, dimension)).fold(0.0, f64::max)
}

/// The largest distance (m) of a node at displacements `u` from where it is at `other`; infinite where that is no number.
fn farthest(u: &[f64], other: &[f64], dimension: usize) -> f64 {
    let nodes = u.chunks(dimension).zip(other.chunks(dimension));
    nodes.fold(0.0, |most, (one, other)| {
        let apart: f64 = one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
        if apart.is_nan() { f64::INFINITY } else { apart.sqrt().max(most) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::simulate::Sampling;
    use crate::samples::square_jump;
    use crate::scene::settings::Settings;

    /// A node that is moved by a part of the largest way makes an error of that part, and a run that ends early an infinite one.
    #[test]
    fn errors_are_parts_of_the_largest_way() {
        let scene = square_jump(4).unwrap().ended_at(0.1);
        let full = scene.simulate(&Settings::default(), &Sampling::every(0.05)).unwrap();
        assert_eq!(error(&full, &full), 0.0);
        let sample = full.last();
        let way = sample.u.chunks(2).map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
        assert!(way > 1e-3, "{way}");
        let moved = |samples: &[Sample], by: f64| {
            let report = full.report().clone();
            let mut motion = Trajectory::new(&scene, report, samples[0].clone());
            for sample in &samples[1..] {
                let mut sample = sample.clone();
                (sample.u[0], sample.u[1]) = (sample.u[0] + 0.6 * by, sample.u[1] - 0.8 * by);
                motion.push(sample);
            }
            motion
        };
        // to rounding: way is the same sum of squares
        let found = error(&full, &moved(full.samples(), 0.3 * way));
        assert!((found - 0.3).abs() < 1e-12, "{found}");
        assert_eq!(error(&full, &moved(&full.samples()[..2], 0.0)), f64::INFINITY);
        assert_eq!(error(&full, &moved(full.samples(), f64::NAN)), f64::INFINITY);
    }
}
