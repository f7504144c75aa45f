//! Options of the search for an equilibrium.

use std::ops::RangeInclusive;

use crate::base::input::InputError;

/// Options of the search for an equilibrium.
///
/// All forces act as they do at rest: dampers, friction and obstacles in motion drag nothing along. Where a
/// body would stick to an obstacle depends on how it came there; [`Scene::simulate`](crate::Scene::simulate)
/// follows that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statics {
    /// Forces are in balance when no unbalanced one is larger than this part of the largest one. Default:
    /// 1e-10, some orders above round-off; allowed: 1e-14 to 1e-2.
    pub rtol: f64,
    /// Newton iterations in one load step. Default: 100; ten are enough unless the body has to move far.
    pub max_iterations: usize,
    /// Steps in which constraints and loads are applied. Default: 1, everything at once; take more if the
    /// search converges to an equilibrium other than the one that slow loading reaches. Steps that fail are halved.
    ///
    /// With more than one, the trajectory is a load curve: it has the equilibrium of each step, whose time is
    /// that part of the end of the phase, and a sensor `load factor` for the part.
    pub load_steps: usize,
    /// Largest number of steps by arc length; default: 0, the load is given.
    ///
    /// With arc length the load rises and falls along the path of equilibria, stable or not, past limit
    /// points in load or displacement (snap-through, snap-back), until it reaches 1 for the first time. The
    /// first step is that of a `load_steps`th of the load. No later one moves the body more than a tenth
    /// farther than that, or turns by more than 60 degrees: such steps are halved. The trajectory is the load
    /// curve, its samples evenly spread over the phase. Nothing is known about the equilibria between steps:
    /// take enough `load_steps`.
    pub arc_steps: usize,
    /// Smallest load step, as a part of the whole load, at most 1 (by arc length, as a part of the first step). Default: 1e-3.
    pub min_load_step: f64,
}

impl Default for Statics {
    fn default() -> Self {
        Self { rtol: 1e-10, max_iterations: 100, load_steps: 1, arc_steps: 0, min_load_step: 1e-3 }
    }
}

/// Relative tolerances that make sense: with larger ones a body that has not moved at all would count as one
/// in balance.
const RTOL: RangeInclusive<f64> = 1e-14..=1e-2;

/// Most steps of a load curve: so that a typing error does not fill the memory.
const MOST_STEPS: usize = 100_000;

impl Statics {
    /// Whether the trajectory is a load curve: the equilibria of all steps, with a sensor `load factor`.
    pub fn is_curve(&self) -> bool {
        self.load_steps > 1 || self.arc_steps > 0
    }

    pub(crate) fn validate(&self) -> Result<(), InputError> {
        if !RTOL.contains(&self.rtol) {
            let [least, most] = [RTOL.start(), RTOL.end()];
            let help = format!("it must lie between {least:e}, near round-off, and {most:e}");
            return Err(InputError::new("statics.rtol", self.rtol, help));
        }
        if !(self.min_load_step > 0.0 && self.min_load_step <= 1.0) {
            let help = "it is a part of the whole load, above 0 and at most 1";
            return Err(InputError::new("statics.min_load_step", self.min_load_step, help));
        }
        for (input, number) in [
            ("statics.max_iterations", self.max_iterations),
            ("statics.load_steps", self.load_steps),
        ] {
            if number == 0 {
                return Err(InputError::new(input, number, "it must be 1 at least"));
            }
        }
        for (input, number) in
            [("statics.load_steps", self.load_steps), ("statics.arc_steps", self.arc_steps)]
        {
            if number > MOST_STEPS {
                let help = format!("{MOST_STEPS} are the most, for all of them are kept");
                return Err(InputError::new(input, number, help));
            }
        }
        Ok(())
    }
}
