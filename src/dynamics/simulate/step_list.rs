//! Runs by the steps of another run, for differences that are derivatives of the computed motion.
//!
//! The steps that error control chooses depend on every number of a scene, with jumps, so that differences of two runs have
//! errors of the tolerance divided by the difference. With the same steps the state at the end is a smooth function of the
//! numbers of the scene, and differences of a ten-thousandth are exact to nine digits ("internal numerical differentiation": H. G.
//! Bock, "Numerical treatment of inverse problems in chemical reaction kinetics", in: Modelling of Chemical Reaction
//! Systems, Springer, 1981). Steps are kept in parts of their interval, so that times of phases and of breaks may change, too.

use std::sync::Arc;

/// Steps of a run, for other runs that take the same ones: for each interval the ends of its steps, as fractions of its length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepList {
    pub(super) intervals: Arc<[Vec<f64>]>,
}

impl StepList {
    /// Number of steps.
    pub fn count(&self) -> usize {
        self.intervals.iter().map(Vec::len).sum()
    }
}

/// A list of steps that a run follows, and its position there.
#[derive(Debug)]
pub(super) struct Prescribed {
    list: StepList,
    /// Intervals begun so far, and the start and the end of the present one (s).
    begun: usize,
    span: [f64; 2],
    /// The next step in that interval.
    next: usize,
}

impl Prescribed {
    /// From the first step on.
    pub(super) fn new(list: StepList) -> Self {
        Self { list, begun: 0, span: [0.0; 2], next: 0 }
    }

    /// End of the step from `time` (s), in an interval up to `stop` whose last step ends at `last` (s).
    pub(super) fn end(&mut self, time: f64, stop: f64, last: f64) -> f64 {
        if self.begun == 0 || self.span[1] != stop {
            (self.begun, self.span, self.next) = (self.begun + 1, [time, stop], 0);
        }
        let Some(fractions) = self.list.intervals.get(self.begun - 1) else { return last };
        let [start, stop] = self.span;
        while let Some(&fraction) = fractions.get(self.next).filter(|fraction| **fraction < 1.0) {
            let end = start + fraction * (stop - start);
            if end > time {
                return end;
            }
            self.next += 1;
        }
        last
    }
}
