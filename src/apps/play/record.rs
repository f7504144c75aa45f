//! Record of slider moves, phase by phase.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::slider::{Target, ascending};
use crate::io::scene_file::{Rewritten, SceneReader, rewritten};
use crate::scene::forces::{Signal, TimeTable, VectorSignal};
use crate::scene::timeline::{Input, Scene};

/// Part of the scene's duration over which a slider changes its value: a body should not get a jump.
const RAMP: f64 = 0.005;
/// The longest such time (s).
const LONGEST_RAMP: f64 = 0.02;

/// The moves of the sliders.
#[derive(Default)]
pub(super) struct Record {
    tracks: Vec<Track>,
}

/// The file that a scene was read from.
pub(super) struct Original {
    pub(super) text: String,
    pub(super) path: PathBuf,
    pub(super) reader: SceneReader,
}

impl Original {
    /// A name for the file that is made from it.
    pub(super) fn new_name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        format!("{stem}-by-hand.toml")
    }
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // a line end would end the comment
    name.chars().map(|c| if c.is_control() { '?' } else { c }).collect()
}

/// Moves of a slider in one phase: values at times (s), interpolated linearly.
struct Track {
    /// Number of the phase, from 0.
    phase: usize,
    target: Target,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Record {
    /// The scene file `original` of `scene` with these moves.
    ///
    /// # Errors
    /// No moves; a file that they cannot be written into.
    pub(super) fn saved(&self, scene: &Scene, original: &Original) -> Result<String, String> {
        if self.tracks.is_empty() {
            return Err("no slider was moved since the start: there is nothing to be saved".into());
        }
        let Original { text, path, reader } = original;
        let cannot = |reason: String| format!("{} cannot be changed: {reason}", path.display());
        let read = |text: &str| {
            reader.parse_with(text, path, &[]).map_err(|error| cannot(error.to_string()))
        };
        let written = read(text)?;
        let mut changes: Vec<Rewritten> = Vec::new();
        for (number, phase) in scene.phases().iter().enumerate() {
            let mut change = Rewritten { number, phase: phase.clone(), keys: BTreeSet::new() };
            for track in self.tracks.iter().filter(|track| track.phase == number) {
                // a file has no functions of time, which would be evaluated at this one time
                let input = self.input(scene, track, 0.0);
                change.keys.insert(input.quantity.row().keys[0]);
                change.phase.set(input);
            }
            // it was played for longer than in the file
            if written.scene.phases().get(number).is_some_and(|own| own.end() < phase.end()) {
                change.keys.insert("until");
            }
            if !change.keys.is_empty() {
                changes.push(change);
            }
        }
        let text = rewritten(text, scene, &changes).map_err(cannot)?;
        read(&text)?;
        let name = file_name(path);
        Ok(format!(
            "# {name} with the sliders moved by hand. Files that it names are sought beside it.\n{text}"
        ))
    }

    /// Moves `target` to `value` at time `t` (s). Returns the input from then on, including all earlier
    /// moves.
    pub(super) fn moved(&mut self, scene: &Scene, target: &Target, t: f64, value: f64) -> Input {
        let phases = scene.phases();
        let last = phases.len().saturating_sub(1);
        let number = phases.iter().position(|phase| t < phase.end()).unwrap_or(last);
        let known = |track: &Track| (track.phase, &track.target) == (number, target);
        let at = self.tracks.iter().position(known).unwrap_or_else(|| {
            self.tracks.push(Track::of(scene, number, target.clone(), t));
            self.tracks.len() - 1
        });
        self.tracks[at].go(t, (RAMP * scene.end()).min(LONGEST_RAMP), value);
        self.input(scene, &self.tracks[at], t)
    }

    /// The input that follows from a track, from time `t` (s) on; a component of a vector has the other components beside it.
    fn input(&self, scene: &Scene, track: &Track, t: f64) -> Input {
        let Target { quantity, of, axis } = &track.target;
        if axis.is_none() {
            return Input::new(*quantity, of.clone(), track.signal());
        }
        let phase = track.phase;
        let component = |axis| {
            let target = track.target.along(axis);
            let known = |other: &&Track| (other.phase, &other.target) == (phase, &target);
            match self.tracks.iter().find(known) {
                Some(moved) => moved.signal(),
                None => Track::of(scene, phase, target, t).signal(),
            }
        };
        let components: Vec<Signal> =
            (0..quantity.rank(scene.body().dimension())).map(component).collect();
        let times = ascending(components.iter().flat_map(Signal::breaks));
        let force = |t: &f64| components.iter().map(|signal| signal.at(*t)).collect();
        let forces = times.iter().map(force).collect();
        let vector = VectorSignal::TimeTable(TimeTable::new(times, forces));
        Input::new(*quantity, of.clone(), vector)
    }
}

impl Track {
    /// The scene's own values; for a function of time without breaks, its value at time `t` (s).
    fn of(scene: &Scene, number: usize, target: Target, t: f64) -> Self {
        let phase = scene.phases().get(number);
        let mut times = phase.map_or_else(Vec::new, |phase| target.breaks_in(scene, phase));
        if times.is_empty() {
            times.push(t);
        }
        let value = |t: &f64| phase.map_or(0.0, |phase| target.value_in(scene, phase, *t));
        let values = times.iter().map(value).collect();
        Self { phase: number, target, times, values }
    }

    /// Moves from its value at time `t` to `value` within a time `ramp` (s).
    fn go(&mut self, t: f64, ramp: f64, value: f64) {
        let present = self.signal().at(t);
        let before = self.times.partition_point(|&time| time < t);
        self.times.truncate(before);
        self.values.truncate(before);
        self.times.extend([t, t + ramp]);
        self.values.extend([present, value]);
    }

    fn signal(&self) -> Signal {
        Signal::table(self.times.clone(), self.values.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::timeline::Quantity;

    #[test]
    fn moves_begin_where_the_slider_is() {
        let (times, values) = (vec![0.0, 1.0], vec![0.0, 10.0]);
        let target = Target::of(Quantity::Pressure, "air");
        let mut track = Track { phase: 0, target, times, values };
        track.go(0.5, 0.1, 7.0);
        assert_eq!((&track.times, &track.values), (&vec![0.0, 0.5, 0.6], &vec![0.0, 5.0, 7.0]));
        // moved again before it has reached its value
        track.go(0.55, 0.1, 1.0);
        assert_eq!(track.times, [0.0, 0.5, 0.55, 0.55 + 0.1]);
        assert!((track.values[2] - 6.0).abs() < 1e-12 && track.values[3] == 1.0);
        // at the same moment twice
        track.go(0.55, 0.1, 2.0);
        assert_eq!(track.times.len(), 4);
    }
}
