//! The reference motion of a scene, and distances from it.
//!
//! Of four methods of different families the two fastest give the reference, so that it suits stiff and
//! undamped scenes alike. Limits of runs count processor time, so that other users of the machine do not turn
//! slow runs into failed ones.

use std::ops::ControlFlow;
use std::time::Duration;

use super::Failed;
use super::quantity::{Distance, Quantity, Seen};
use super::timing::Budget;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::settings::{Method, Settings};
use crate::scene::timeline::Scene;

/// Methods of different families, each at its highest order: digits on which two of them agree are trusted.
const METHODS: [(Method, Option<u32>); 4] = [
    (Method::CvodeAdams, None),
    (Method::CvodeBdf, None),
    (Method::Arkode, Some(5)),
    (Method::Rk, None),
];
/// No tolerance is below this: rounding errors dominate there.
const LEAST_RTOL: f64 = 1e-13;

/// Observed quantity and its sample times.
#[derive(Debug, Clone)]
pub(crate) struct Probe {
    quantity: Quantity,
    /// The nodes that count for the whole motion, from 0.
    nodes: Vec<usize>,
    times: Vec<f64>,
}

impl Probe {
    pub(crate) fn new(scene: &Scene, quantity: Quantity, nodes: Vec<usize>) -> Self {
        let count = quantity.times();
        let times = (1..=count).map(|k| scene.end() * (k as f64 / count as f64)).collect();
        Self { quantity, nodes, times }
    }

    /// Runs `scene` to its end, for a processor time of `limit` at most.
    pub(crate) fn run(
        &self,
        scene: &Scene,
        settings: &Settings,
        limit: Duration,
    ) -> Result<(Seen, Trajectory), Error> {
        let mut budget = Budget::new(limit);
        let trajectory =
            scene.simulate_with(settings, &self.sampling(), |_| match budget.is_spent() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            })?;
        Ok((self.seen(&trajectory), trajectory))
    }

    /// Required sampling of a run, and its readings.
    pub(crate) fn sampling(&self) -> Sampling {
        self.quantity.read_by(Sampling::at(self.times.clone()))
    }

    /// Observation of a run that was sampled at these times.
    pub(crate) fn seen(&self, trajectory: &Trajectory) -> Seen {
        self.quantity.seen(trajectory, &self.nodes, self.samples(trajectory))
    }

    /// The samples at the times of the probe, without further ones at ends of phases.
    fn samples<'a>(&self, trajectory: &'a Trajectory) -> impl Iterator<Item = &'a Sample> {
        // a phase end within round-off of a time replaces it
        let apart = 2e-9 * trajectory.last().time;
        let mut samples = trajectory.samples().iter().peekable();
        self.times.iter().filter_map(move |time| {
            while samples.next_if(|sample| sample.time < time - apart).is_some() {}
            samples.peek().copied() // every time up to the end is sampled
        })
    }
}

/// A motion that stands for the exact one, and how far it can be trusted.
#[derive(Debug)]
pub(crate) struct Truth {
    seen: Seen,
    /// Relative error that the motion itself may have.
    pub(crate) resolution: f64,
}

impl Truth {
    /// Solves `scene` in two ways, more and more precisely until they agree to `target`. A `check` is, for
    /// example, the same scene on a mesh half as fine: the distance to it counts, too.
    pub(crate) fn find(
        scene: &Scene,
        probe: &Probe,
        check: Option<(&Scene, &Probe)>,
        alpha: f64,
        target: f64,
        limit: Duration,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, Error> {
        let mut rtol = target.max(LEAST_RTOL);
        let mut pair = fastest_two(
            scene,
            probe,
            &Settings { rtol, alpha, ..Settings::default() },
            limit,
            tell,
        )?;
        let mut truth = Self::of(&pair[0], &pair[1]);
        while truth.resolution > target && rtol > 2.0 * LEAST_RTOL {
            rtol = (0.1 * rtol).max(LEAST_RTOL);
            let mut finer = Vec::new();
            for way in &pair {
                match way.again(scene, probe, rtol, limit, tell) {
                    Ok(way) => finer.push(way),
                    Err(error) => tell(&format!("no better reference: {}", reason(error))),
                }
            }
            let Ok([first, second]) = <[Way; 2]>::try_from(finer) else { break };
            // The one that changed less was nearer to the truth already.
            let change = |old: &Way, new: &Way| old.seen.distance(&new.seen).mean;
            let better = match change(&pair[0], &first) <= change(&pair[1], &second) {
                true => Self::of(&first, &second),
                false => Self::of(&second, &first),
            };
            // Where rounding errors dominate, the methods agree no better.
            let gains = better.resolution < 0.5 * truth.resolution;
            if better.resolution < truth.resolution {
                truth = better;
            }
            if !gains {
                break;
            }
            pair = [first, second];
        }
        if let Some((scene, probe)) = check {
            tell(&format!("reference: the check, {} at rtol {rtol:.0e}", pair[0].settings.method));
            let (seen, _) =
                probe.run(scene, &Settings { rtol, ..pair[0].settings.clone() }, limit)?;
            let distance = truth.error(&seen).mean;
            truth.resolution = truth.resolution.max(distance);
        }
        Ok(truth)
    }

    fn of(best: &Way, other: &Way) -> Self {
        let seen = best.seen.clone();
        let resolution = seen.error(&other.seen).mean;
        Self { seen, resolution: resolution.max(f64::EPSILON) }
    }

    /// Distances from the true motion, relative to it.
    pub(crate) fn error(&self, seen: &Seen) -> Distance {
        self.seen.error(seen)
    }
}

/// A solution of the scene by one method.
#[derive(Debug)]
struct Way {
    settings: Settings,
    seen: Seen,
    /// Processor time.
    time: Duration,
}

impl Way {
    fn find(
        scene: &Scene,
        probe: &Probe,
        settings: Settings,
        limit: Duration,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, Error> {
        tell(&format!("reference: {} at rtol {:.0e}", settings.method, settings.rtol));
        let budget = Budget::new(limit);
        let (seen, _) = probe.run(scene, &settings, limit)?;
        Ok(Self { settings, seen, time: Duration::from_secs_f64(budget.spent()) })
    }

    fn again(
        &self,
        scene: &Scene,
        probe: &Probe,
        rtol: f64,
        limit: Duration,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, Error> {
        Self::find(scene, probe, Settings { rtol, ..self.settings.clone() }, limit, tell)
    }
}

/// The solutions by the two fastest methods, in all else as `settings` has it.
fn fastest_two(
    scene: &Scene,
    probe: &Probe,
    settings: &Settings,
    limit: Duration,
    tell: &mut dyn FnMut(&str),
) -> Result<[Way; 2], Error> {
    let (mut found, mut failures) = (Vec::<Way>::new(), Vec::new());
    for (method, max_order) in METHODS {
        // a method that is slower than the second is not waited for
        let limit = found.get(1).map_or(limit, |second| second.time);
        let settings = Settings { method, max_order, ..settings.clone() };
        match Way::find(scene, probe, settings, limit, tell) {
            Ok(way) => found.push(way),
            Err(error @ Error::Integration(_)) => failures.push(reason(error).to_string()),
            Err(error) => return Err(error),
        }
        found.sort_by_key(|way| way.time);
        found.truncate(2);
    }
    <[Way; 2]>::try_from(found).map_err(|_| Error::Reference {
        rtol: settings.rtol,
        failures: failures.join("; "),
        help: "allow more time, or ask for less accuracy".into(),
    })
}

/// The nodes that all meshes of `scenes` share, as they number them (from 0), in the same order.
///
/// # Errors
/// Scenes whose meshes share none.
pub(crate) fn shared_nodes(scenes: &[&Scene]) -> Result<Vec<Vec<usize>>, Error> {
    let meshes: Vec<_> = scenes.iter().map(|scene| scene.body().mesh()).collect();
    let Some(first) = meshes.first() else { return Ok(Vec::new()) };
    let mut shared = vec![Vec::new(); meshes.len()];
    let near = 1e-9 * first.size();
    'nodes: for node in 0..first.node_count() {
        let place = first.position(node);
        let mut numbers = Vec::with_capacity(meshes.len());
        for mesh in &meshes {
            let here = |&other: &usize| {
                let position = mesh.position(other);
                position.len() == place.len()
                    && position.iter().zip(place).all(|(a, b)| (a - b).abs() <= near)
            };
            // most often it has the same number
            let same = Some(node).filter(|node| *node < mesh.node_count()).filter(here);
            match same.or_else(|| (0..mesh.node_count()).find(here)) {
                Some(number) => numbers.push(number),
                None => continue 'nodes,
            }
        }
        shared.iter_mut().zip(numbers).for_each(|(list, number)| list.push(number));
    }
    if shared[0].is_empty() {
        let help = "errors are measured at nodes that all meshes share: let them have some";
        return Err(InputError::new("number of nodes that all meshes share", 0, help).into());
    }
    Ok(shared)
}

/// An error of a run as the reason of its failure.
pub(crate) fn reason(error: Error) -> Failed {
    match error {
        Error::Integration(failure) if failure.is_interruption() => {
            let report = failure.trajectory.report();
            let notice = report.phases.last().and_then(|phase| phase.counts.notice.as_deref());
            let notice = notice.map(|notice| format!(": {notice}")).unwrap_or_default();
            let (time, end) = (failure.time, failure.trajectory.scene().end());
            let steps = report.steps();
            format!("given up after {steps} steps at t = {time:.3e} s of {end} s{notice}").into()
        }
        Error::Integration(failure) => failure,
        other => Box::new(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studies::samples::{ClampedBeam, clamped_beam};

    #[test]
    fn meshes_share_the_nodes_that_are_at_the_same_places() {
        let coarse = clamped_beam([3, 2], 0.0).unwrap();
        let fine = clamped_beam([5, 3], 0.0).unwrap();
        let cells = crate::Cells::Triangles6;
        let quadratic = ClampedBeam { nodes: [3, 2], cells, ..ClampedBeam::default() };
        let quadratic = quadratic.scene().unwrap();
        let shared = shared_nodes(&[&fine, &quadratic, &coarse]).unwrap();
        // row by row of the finest: corners and middles of the lower and the upper edge
        assert_eq!(shared[0], [0, 2, 4, 10, 12, 14]);
        assert_eq!(shared[2], [0, 1, 2, 3, 4, 5]);
        let all = shared_nodes(&[&fine, &quadratic]).unwrap();
        assert_eq!(all[0].len(), 15);
    }
}
