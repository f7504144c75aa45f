//! Checks of slopes that a functional or, as products with transposed Jacobians, a system supplies.

use crate::base::vector::dot;
use crate::integrators::{
    common::{Cause, JacobianCheck, Point, Tolerances, Wanted},
    ode::Failure,
};

/// A value and its slopes by the unknowns and by the parameters, which are compared with differences of it.
pub(super) struct SlopesCheck {
    by_y: JacobianCheck,
    by_p: JacobianCheck,
}

/// Names of slopes in messages.
#[derive(Clone, Copy)]
pub(super) struct Names {
    pub(super) slopes: &'static str,
    /// The variables of the derivatives.
    pub(super) by: [&'static str; 2],
    /// The function of [`ode::check`](crate::integrators::ode::check) that checks all of them.
    pub(super) all: &'static str,
}

impl Names {
    /// Those of a function of a functional.
    pub(super) const fn of_functional(slopes: &'static str) -> Self {
        Self { slopes, by: ["y", "p"], all: "functional" }
    }

    /// Those of products that a system supplies, by y and y'.
    pub(super) const fn of_products(method: &'static str) -> Self {
        Self { slopes: method, by: ["y", "y'"], all: method }
    }
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
        Names { slopes: name, by: [first, second], all }: Names,
        [y, p]: [&[f64]; 2],
        slopes: [&[f64]; 2],
        mut value: impl FnMut(&[f64], &[f64]) -> Result<f64, Failure>,
    ) -> Result<(), Failure> {
        let Self { by_y, by_p } = self;
        for (check, own, slopes, by) in [(by_y, y, slopes[0], first), (by_p, p, slopes[1], second)]
        {
            let point = Point { y: own, yp: &[], cj: 0.0 };
            let found = check.find(Some(name), point, &mut |wanted, out| {
                let result = match wanted {
                    Wanted::Product(v) => Ok(dot(slopes, v)),
                    Wanted::Entry(..) => return true,
                    Wanted::Equations([moved, _]) if by == first => value(moved, p),
                    Wanted::Equations([moved, _]) => value(y, moved),
                };
                result.map(|value| out[0] = value).is_ok()
            });
            if let Some(Cause::WrongJacobian { column, supplied, difference, .. }) = found {
                let place = column.map_or("a direction".into(), |column| format!("{by}[{column}]"));
                let message = format!(
                    "{name} is wrong: its slope by {place} is {supplied:e}, but {difference:e} by differences (ode::check::{all} looks \
                     at all of them)"
                );
                return Err(Failure::Fatal(message.into()));
            }
        }
        Ok(())
    }
}
