//! Arrows of gravity and the magnetic field beside the caption of each panel, and of remanences on the body.

use svg::node::element::{Group, Path};

use super::layout::Layout;
use super::mark::{Data, text};
use super::projection::{Point, drawn};
use crate::base::vector::norm;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::io::output::acting::{EVERYWHERE, Remanence, everywhere};

/// Colours and names of gravity and the magnetic field in the key.
const MEANINGS: [(&str, &str); 2] = [("#009e73", "gravity"), ("#7d3fa8", "magnetic field")];
const REMANENCE: &str = "#d55e00";
/// Length of the longest arrow beside a caption, and the space of each (px).
const LONGEST: f64 = 18.0;
const ROOM: f64 = 38.0;

/// Arrows of a run.
pub(super) struct Acting {
    /// The largest gravity (m/s^2) and field (T).
    largest: [f64; 2],
    remanence: Remanence,
}

/// Arrows of one panel.
pub(super) struct ActingAt {
    /// Gravity and the field as drawn, in parts of the largest of the run; nothing where the run has none.
    everywhere: [Option<Point>; 2],
    /// Ends of the arrows along remanences (m).
    remanence: Vec<[Point; 2]>,
}

impl Acting {
    pub(super) fn of(trajectory: &Trajectory) -> Result<Self, Error> {
        let mut largest = [0.0; 2];
        for sample in trajectory.samples() {
            let phase = trajectory.phase_of(sample)?;
            let all = everywhere(trajectory.scene(), phase, sample.time);
            largest.iter_mut().zip(all).for_each(|(most, x)| *most = norm(&x).max(*most));
        }
        Ok(Self { largest, remanence: Remanence::of(trajectory.scene())? })
    }

    /// Room that is needed beside a caption (px).
    pub(super) fn room(&self) -> f64 {
        self.largest.iter().filter(|&&largest| largest > 0.0).count() as f64 * ROOM
    }

    pub(super) fn at(&self, trajectory: &Trajectory, sample: &Sample) -> Result<ActingAt, Error> {
        let all = everywhere(trajectory.scene(), trajectory.phase_of(sample)?, sample.time)
            .map(|x| drawn(&x));
        let part = |k: usize| (self.largest[k] > 0.0).then(|| all[k].map(|x| x / self.largest[k]));
        let everywhere = [0, 1].map(part);
        let ends = |arrow: [Vec<f64>; 2]| {
            let [middle, along] = arrow.map(|x| drawn(&x));
            [-0.5, 0.5].map(|part| [0, 1].map(|i| middle[i] + part * along[i]))
        };
        let arrows = self.remanence.at(trajectory.body().mesh(), &sample.u);
        Ok(ActingAt { everywhere, remanence: arrows.into_iter().map(ends).collect() })
    }

    /// Colours and meanings of the arrows that there are.
    pub(super) fn meanings(&self) -> Vec<(&'static str, &'static str)> {
        let everywhere = MEANINGS.iter().zip(self.largest).filter(|(_, largest)| *largest > 0.0);
        let remanence = (self.remanence.count() > 0).then_some((REMANENCE, "remanence"));
        everywhere.map(|(meaning, _)| *meaning).chain(remanence).collect()
    }
}

impl ActingAt {
    /// Room beside the caption (px).
    pub(super) fn room(&self) -> f64 {
        self.everywhere.iter().flatten().count() as f64 * ROOM
    }

    /// The arrows beside the caption of a panel, named, from its right end; none where nothing acts.
    pub(super) fn beside_caption(&self, right: f64, baseline: f64) -> Vec<Group> {
        let mut arrows = Vec::new();
        let mut x = right - LONGEST / 2.0;
        for (k, along) in self.everywhere.iter().enumerate() {
            let Some(along) = along else { continue };
            let y = baseline - 4.5;
            let [dx, dy] = [0.5 * LONGEST * along[0], -0.5 * LONGEST * along[1]];
            if dx.hypot(dy) > 0.5 {
                let (name, (colour, _)) = (EVERYWHERE[k], MEANINGS[k]);
                let name = text(name, x - LONGEST / 2.0 - 3.0, baseline).set("text-anchor", "end");
                let arrow = arrow(&[[[x - dx, y - dy], [x + dx, y + dy]]], colour, 1.6);
                let named = Group::new().set("class", EVERYWHERE[k]).add(arrow);
                arrows.push(named.add(name.set("fill", colour)));
            }
            x -= ROOM;
        }
        arrows
    }

    /// The arrows on the body.
    pub(super) fn on_body(&self, layout: &Layout, panel: usize) -> Option<Group> {
        let place = |ends: &[Point; 2]| ends.map(|x| layout.place(panel, x));
        let arrows: Vec<[Point; 2]> = self.remanence.iter().map(place).collect();
        let length = |[from, to]: &[Point; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
        let longest = arrows.iter().map(length).fold(0.0, f64::max);
        // small arrows are fine ones
        let paths = arrow(&arrows, REMANENCE, (0.1 * longest).min(1.4));
        (longest > 0.0).then(|| Group::new().set("class", "remanence").add(paths))
    }
}

/// An arrow of the key, from `x` to the right, around the middle of the letters.
pub(super) fn sign(x: f64, baseline: f64, colour: &str) -> Path {
    arrow(&[[[x, baseline - 4.5], [x + LONGEST, baseline - 4.5]]], colour, 1.6)
}

/// Arrows (px), each from its first point to its second one.
fn arrow(arrows: &[[Point; 2]], colour: &str, width: f64) -> Path {
    let mut data = Data::default();
    for &[from, to] in arrows {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        if length == 0.0 {
            continue;
        }
        let head = (0.45 * length).min(6.0) / length;
        let base = [0, 1].map(|i| to[i] - head * along[i]);
        let side = |part: f64| [base[0] - part * head * along[1], base[1] + part * head * along[0]];
        data.polyline(&[from, base], false);
        data.polyline(&[to, side(0.45), side(-0.45)], true);
    }
    let path = Path::new().set("d", data.0).set("fill", colour).set("stroke", colour);
    path.set("stroke-width", width).set("stroke-linejoin", "round")
}
