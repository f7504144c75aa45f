//! Creep of surfaces in sticking friction.
//!
//! Friction is smooth in the sliding speed: a sticking point slides slowly enough that friction balances the tangential load, by the
//! law of `scene/forces/friction.rs` at 2 T/(3 mu N) of the sticking speed under a small load T. Creep between two samples is the
//! relative tangential displacement; if that is more than at the sticking speed, the point has come loose in between. Creep is a
//! vector: backward creep reduces it.

use std::collections::BTreeMap;
use std::ptr;

use super::rigid::travel;
use crate::base::input::{percent, short};
use crate::base::vector::{difference, norm};
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::forces::{Contact, Stuck};
use crate::scene::timeline::Phase;

/// Largest creep relative to the distance that nodes travel, ...
const MOST_CREEP: f64 = 0.01;
/// ... or to this fraction of the size of the body where that is more.
const LEAST_WAY: f64 = 0.01;

/// The creep on an obstacle, or where bodies touch.
#[derive(Default)]
struct Creep {
    /// By the nodes and weights of each point.
    points: BTreeMap<Vec<(usize, u64)>, Crept>,
    sticking_speed: f64,
}

#[derive(Default)]
struct Crept {
    /// Creep vector (m).
    by: [f64; 3],
    /// Impulse (N s) of the normal force meanwhile.
    impulse: f64,
}

impl Creep {
    /// Adds the creep of `stuck` points in a time of `dt` (s), in which they slide by `slide` (m).
    fn add(&mut self, stuck: &[Stuck], dt: f64, slide: impl Fn(&Stuck) -> [f64; 3]) {
        // a point may lie on several faces: it creeps by the mean
        let mut means = BTreeMap::<Vec<_>, ([f64; 3], f64)>::new();
        for point in stuck {
            self.sticking_speed = point.sticking_speed;
            let by = slide(point);
            if norm(&by) > point.sticking_speed * dt {
                continue;
            }
            let key = point.point.iter().map(|(node, share)| (*node, share.to_bits())).collect();
            let (sum, weight) = means.entry(key).or_default();
            sum.iter_mut().zip(by).for_each(|(sum, by)| *sum += point.pressing * by);
            *weight += point.pressing;
        }
        for (key, (sum, weight)) in means.into_iter().filter(|(_, (_, weight))| *weight > 0.0) {
            let crept = self.points.entry(key).or_default();
            crept.by.iter_mut().zip(sum).for_each(|(by, sum)| *by += sum / weight);
            crept.impulse += weight * dt;
        }
    }

    /// Creep distance (m): the mean over its points, weighted by their normal impulses.
    fn mean(&self) -> Option<f64> {
        let all: f64 = self.points.values().map(|crept| crept.impulse).sum();
        let sum: f64 = self.points.values().map(|crept| crept.impulse * norm(&crept.by)).sum();
        (all > 0.0).then(|| sum / all)
    }
}

/// Creep of surfaces that stick to an obstacle or to another body, contact by contact.
pub(super) fn creep(trajectory: &Trajectory, samples: &[&Sample]) -> Vec<Indicator> {
    let scene = trajectory.scene();
    let rubs = scene.obstacles().iter().any(|obstacle| obstacle.has_friction())
        || scene.touches().iter().any(|touch| touch.sticks_below(1.0).is_some());
    if !rubs {
        return Vec::new();
    }
    let d = scene.body().dimension();
    let touches = scene.touch_forces().unwrap_or_default();
    let mut all: BTreeMap<String, Creep> = BTreeMap::new();
    let mut acting: Option<(&Phase, Vec<Contact>)> = None;
    for pair in samples.windows(2) {
        let [from, to] = pair else { continue };
        let Ok(phase) = trajectory.phase_of(from) else { continue };
        if acting.as_ref().is_none_or(|(last, _)| !ptr::eq(*last, phase)) {
            acting = scene.contacts(phase).ok().map(|contacts| (phase, contacts));
        }
        let moved: Vec<f64> = to.u.iter().zip(&from.u).map(|(to, from)| to - from).collect();
        let (at, dt) = ([&from.u[..], &from.v[..]], to.time - from.time);
        let mut stuck = Vec::new();
        for contact in acting.iter().flat_map(|(_, contacts)| contacts) {
            let obstacle = contact.obstacle();
            stuck.clear();
            contact.each_stuck(from.time, at, |point| stuck.push(point));
            let [before, after] = [from, to].map(|sample| obstacle.displacement(sample.time));
            let carried = difference(&after, &before);
            let own = all.entry(format!("obstacle \"{}\"", obstacle.name())).or_default();
            own.add(&stuck, dt, |point| point.slide(&moved, carried, d));
        }
        for touch in touches.iter().filter(|_| phase.has_touch) {
            stuck.clear();
            touch.each_stuck(at, |point| stuck.push(point));
            let own = all.entry(format!("touch \"{}\"", touch.name)).or_default();
            own.add(&stuck, dt, |point| point.slide(&moved, [0.0; 3], d));
        }
    }
    let way = travel(scene.body(), samples).max(LEAST_WAY * scene.body().size());
    all.iter().filter_map(|(name, creep)| told(name, creep, way)).collect()
}

fn told(name: &str, creep: &Creep, way: f64) -> Option<Indicator> {
    let mean = creep.mean()?;
    let part = mean / way;
    let said = format!(
        "surfaces that stick by friction at {name} creep by {mean:.1e} m, {} of the travel of nodes (limit: {})",
        percent(part),
        percent(MOST_CREEP)
    );
    let beyond = || {
        format!(
            "{said}: they slide where they should stick; lower sticking_speed from {} m/s to {:.0e} m/s",
            short(creep.sticking_speed),
            creep.sticking_speed * MOST_CREEP / part
        )
    };
    let limits = [0.0, MOST_CREEP];
    Some(Indicator::trusted("creep", (part, "1"), limits, || said.clone(), beyond))
}
