//! Choices of `pliant` where a scene file leaves them open, with reasons.

use super::contents::{AutoRequest, SceneFile};
use crate::base::input::{percent, short};
use crate::dynamics::indicators::largest_turn;
use crate::dynamics::trajectory::Trajectory;
use crate::elements::body::{Dilatation, Part, Strain};

/// Rotation (degrees) of cells below which Cauchy strain would do: it takes this for a strain of 0.01 %.
const FEW_DEGREES: f64 = 0.8;

impl SceneFile {
    /// Adds the title, and the choices with their reasons where the file says `auto`, to the report of a motion
    /// of its scene.
    ///
    /// See [`Report::chosen`](crate::Report::chosen). Choices of `accuracy` and `method = "auto"` are in the
    /// report already.
    pub fn explain(&self, motion: &mut Trajectory) {
        let parts = motion.body().parts().zip(&self.auto);
        let chosen = parts.flat_map(|(part, auto)| chosen(motion, &part, *auto)).collect();
        motion.report.chosen = chosen;
        motion.report.title.clone_from(&self.title);
    }
}

/// Choices for a body, with reasons.
fn chosen(
    motion: &Trajectory,
    part: &Part,
    AutoRequest { strain, cells }: AutoRequest,
) -> Vec<String> {
    let of = if motion.body().is_single() {
        String::new()
    } else {
        format!(" of body \"{}\"", part.name)
    };
    let mut chosen = Vec::new();
    if strain && part.body.strain() == Strain::Green {
        let turn = largest_turn(motion, part);
        let (degrees, false_strain) = (turn.to_degrees(), 1.0 - turn.cos());
        let why = match degrees < FEW_DEGREES {
            true => "Cauchy strain would do as well, at less cost per step",
            false => "pliant advise measures what that changes",
        };
        chosen.push(format!(
            "strain{of}: Green; cells turn by up to {} degrees, which Cauchy strain would take for a strain of {}: {why}",
            short(degrees),
            percent(false_strain)
        ));
    }
    if cells {
        let kind = part.body.mesh().kind().name();
        let dilatation = match part.body.dilatation() {
            Dilatation::Linear => " with a linear dilatation",
            _ => "",
        };
        chosen.push(format!(
            "cells{of}: {kind}{dilatation}, for linear ones lock or are too stiff in bending; pliant advise measures whether they are fine enough"
        ));
    }
    chosen
}
