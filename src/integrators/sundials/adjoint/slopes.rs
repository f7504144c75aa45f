//! Checks of the slopes that a functional supplies, as of the Jacobians that a system supplies.

use crate::integrators::{
    common::{Cause, JacobianCheck, Point, Tolerances, Wanted},
    ode::Failure,
};

/// A value and its slopes by the unknowns and by the parameters, which are compared with differences of it.
pub(super) struct SlopesCheck {
    by_y: JacobianCheck,
    by_p: JacobianCheck,
}

impl SlopesCheck {
    /// For a function of so many unknowns, within these tolerances, and parameters.
    pub(super) fn new((n, tolerances): (usize, &Tolerances), parameters: usize) -> Self {
        // sizes of parameters are their values, or 1
        let sizes = Tolerances::new(0.5, 0.0);
        Self {
            by_y: JacobianCheck::of_rows(1, n, tolerances),
            by_p: JacobianCheck::of_rows(1, parameters, &sizes),
        }
    }

    /// Whether the slopes that were just evaluated are to be checked: the first, the second, the fourth and so on.
    pub(super) fn is_due(&mut self) -> bool {
        self.by_y.is_due()
    }

    /// Refuses slopes at (y, p) that differences of `value` refute.
    pub(super) fn check(
        &mut self,
        name: &'static str,
        [y, p]: [&[f64]; 2],
        slopes: [&[f64]; 2],
        mut value: impl FnMut(&[f64], &[f64]) -> Result<f64, Failure>,
    ) -> Result<(), Failure> {
        let Self { by_y, by_p } = self;
        for (check, own, slopes, by) in [(by_y, y, slopes[0], "y"), (by_p, p, slopes[1], "p")] {
            let point = Point { y: own, yp: &[], cj: 0.0 };
            let found = check.find(Some(name), point, &mut |wanted, out| {
                let result = match wanted {
                    Wanted::Product(v) => Ok(slopes.iter().zip(v).map(|(a, b)| a * b).sum()),
                    Wanted::Entry(..) => return true,
                    Wanted::Equations([moved, _]) if by == "y" => value(moved, p),
                    Wanted::Equations([moved, _]) => value(y, moved),
                };
                result.map(|value| out[0] = value).is_ok()
            });
            if let Some(Cause::WrongJacobian { column, supplied, difference, .. }) = found {
                let place = column.map_or("a direction".into(), |column| format!("{by}[{column}]"));
                let message = format!(
                    "{name} of the functional is wrong: its slope by {place} is {supplied:e}, but {difference:e} by \\
                     differences (ode::check::functional looks at all of them)"
                );
                return Err(Failure::Fatal(message.into()));
            }
        }
        Ok(())
    }
}
