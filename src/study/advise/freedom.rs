//! What may be chosen.

use super::choice::Choice;
use crate::settings::Settings;

/// What the adviser may choose; all else stays as it was written. Default: everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Freedom {
    /// The measure of strain.
    pub strain: bool,
    /// Finer and quadratic cells.
    pub cells: bool,
    /// The tolerance.
    pub rtol: bool,
    /// Inertia, alpha, the method, how contact events are met, and what is left out.
    pub others: bool,
}

impl Default for Freedom {
    fn default() -> Self {
        Self { strain: true, cells: true, rtol: true, others: true }
    }
}

impl Freedom {
    /// Whether `choice` leaves as `written` (with `settings`) what is not to be chosen.
    pub(super) fn allows(self, choice: &Choice, written: &Choice, settings: &Settings) -> bool {
        let mut expected = choice.clone();
        if !self.strain {
            expected.strain = written.strain;
        }
        if !self.cells {
            (expected.quadratic, expected.halved) = (written.quadratic, written.halved);
        }
        if !self.others {
            (expected.inertia, expected.without) = (written.inertia, written.without.clone());
            let rtol = expected.settings.rtol;
            expected.settings = Settings { rtol, ..settings.clone() };
        }
        if !self.rtol {
            expected.settings.rtol = settings.rtol;
        }
        *choice == expected
    }
}
