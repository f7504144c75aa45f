//! What was done by the sliders, phase by phase.

use std::path::{Path, PathBuf};

use super::slider::{Kind, Slider, signals};
use crate::external::Signal;
use crate::scene::Scene;
use crate::scene_file::{Rewritten, SceneFile, rewritten};

/// Parts of the scene within which a slider brings its value about: a jump is none for a body.
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
}

impl Original {
    /// A name for what is made of it.
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

/// What a slider did in one phase: values at times (s), with straight lines in between.
struct Track {
    /// Number of the phase, from 0.
    phase: usize,
    kind: Kind,
    name: String,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Record {
    /// The scene file `original` of `scene` with these moves.
    ///
    /// # Errors
    /// No moves; a file in which there is no place for them.
    pub(super) fn saved(&self, scene: &Scene, original: &Original) -> Result<String, String> {
        if self.tracks.is_empty() {
            return Err("no slider was moved since the start: there is nothing to be saved".into());
        }
        let mut changes: Vec<Rewritten> = Vec::new();
        for track in &self.tracks {
            let number = track.phase;
            let known = changes.iter().position(|change| change.number == number);
            let at = known.or_else(|| {
                let phase = scene.phases().get(number)?.clone();
                changes.push(Rewritten { number, phase, changed: [false; 2] });
                Some(changes.len() - 1)
            });
            let Some(change) = at.map(|at| &mut changes[at]) else { continue };
            match track.kind {
                Kind::Pressure => change.phase.set_pressure(&track.name, track.signal()),
                Kind::Actuation => change.phase.set_actuation(&track.name, track.signal()),
            }
            change.changed[usize::from(track.kind == Kind::Actuation)] = true;
        }
        let Original { text, path } = original;
        let cannot = |reason: String| format!("{} cannot be changed: {reason}", path.display());
        let text = rewritten(text, &changes).map_err(cannot)?;
        SceneFile::parse(&text, path).map_err(|error| cannot(error.to_string()))?;
        let name = file_name(path);
        Ok(format!(
            "# {name} with the sliders moved by hand. Files that it names are sought beside it.\n{text}"
        ))
    }

    /// `slider` is moved to `value` at time `t` (s): what it brings about from then on, with all before.
    pub(super) fn moved(&mut self, scene: &Scene, slider: &Slider, t: f64, value: f64) -> Signal {
        let phases = scene.phases();
        let last = phases.len().saturating_sub(1);
        let number = phases.iter().position(|phase| t < phase.end()).unwrap_or(last);
        let known = |track: &Track| {
            (track.phase, track.kind, &track.name) == (number, slider.kind, &slider.name)
        };
        let at = self.tracks.iter().position(known).unwrap_or_else(|| {
            self.tracks.push(Track::of(scene, number, slider));
            self.tracks.len() - 1
        });
        let track = &mut self.tracks[at];
        track.go(t, (RAMP * scene.end()).min(LONGEST_RAMP), value);
        track.signal()
    }
}

impl Track {
    /// What the scene itself says.
    fn of(scene: &Scene, number: usize, slider: &Slider) -> Self {
        let own = scene.phases().get(number).into_iter();
        let own: Vec<&Signal> =
            own.flat_map(|phase| signals(phase, slider.kind, &slider.name)).collect();
        let mut times: Vec<f64> = own.iter().flat_map(|signal| signal.breaks()).copied().collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        // without a break it is constant
        if times.is_empty() {
            times.push(0.0);
        }
        let sum = |t: &f64| own.iter().map(|signal| signal.at(*t)).sum();
        let values = times.iter().map(sum).collect();
        Self { phase: number, kind: slider.kind, name: slider.name.clone(), times, values }
    }

    /// From its value at time `t` on it goes to `value` within a time `ramp` (s).
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

    #[test]
    fn moves_begin_where_the_slider_is() {
        let (times, values) = (vec![0.0, 1.0], vec![0.0, 10.0]);
        let mut track = Track { phase: 0, kind: Kind::Pressure, name: "air".into(), times, values };
        track.go(0.5, 0.1, 7.0);
        assert_eq!((&track.times, &track.values), (&vec![0.0, 0.5, 0.6], &vec![0.0, 5.0, 7.0]));
        // before it is there it is moved on
        track.go(0.55, 0.1, 1.0);
        assert_eq!(track.times, [0.0, 0.5, 0.55, 0.55 + 0.1]);
        assert!((track.values[2] - 6.0).abs() < 1e-12 && track.values[3] == 1.0);
        // at the same moment twice
        track.go(0.55, 0.1, 2.0);
        assert_eq!(track.times.len(), 4);
    }
}
