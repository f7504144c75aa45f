//! Error and speed-up of a reduced model of the recommended model.

use std::fmt;

use crate::base::input::{percent, short};
use crate::studies::reduce::pays_from;
use crate::studies::work_precision::time_text;

/// A reduced model of the sufficient model, learned from its run.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedCandidate {
    /// Its unknowns: displacements of shapes.
    pub unknowns: usize,
    /// The cells whose forces it computes, and all of them; the first is 0 where it needs none.
    pub cells: [usize; 2],
    /// Change of the quantity by the reduced model, relative to the same scale as the accuracy.
    pub change: f64,
    /// Time (s) of a run by it, and of one of the sufficient model.
    pub seconds: f64,
    /// See `seconds`.
    pub full_seconds: f64,
    /// Time (s) that it took to learn it.
    pub training_seconds: f64,
}

impl ReducedCandidate {
    /// From which run on the time that learning has taken is won back; none if the model is not faster.
    pub fn pays_from(&self) -> Option<f64> {
        pays_from(self.training_seconds, self.full_seconds - self.seconds)
    }
}

impl fmt::Display for ReducedCandidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { unknowns, cells: [own, all], change, seconds, full_seconds, .. } = self;
        write!(f, "a reduced model of it, of {unknowns} unknowns")?;
        if *own > 0 {
            write!(f, " and {own} of {all} cells")?;
        }
        write!(f, ", changes it by {}", percent(*change))?;
        let (ratio, time) = (short(full_seconds / seconds), time_text(*seconds));
        match self.pays_from() {
            Some(run) => write!(
                f,
                " at {ratio} times the speed ({time}): learning it took {}, which pays from run {run} on (pliant reduce)",
                time_text(self.training_seconds)
            ),
            None => write!(f, ", and is no faster ({time})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn learning_pays_where_it_saves_time() {
        let fast = ReducedCandidate {
            unknowns: 12,
            cells: [54, 606],
            change: 0.0056,
            seconds: 0.2,
            full_seconds: 2.0,
            training_seconds: 25.0,
        };
        // 13.9 runs win the time of learning back
        assert_eq!(fast.pays_from(), Some(14.0));
        let told = fast.to_string();
        let parts =
            ["12 unknowns and 54 of 606 cells, changes it by 0.56 % at 10 times", "run 14 on"];
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
        let slow = ReducedCandidate { cells: [0, 606], seconds: 2.5, ..fast };
        assert_eq!(slow.pays_from(), None);
        let told = slow.to_string();
        assert!(!told.contains("cells") && told.contains("no faster"), "{told}");
    }
}
