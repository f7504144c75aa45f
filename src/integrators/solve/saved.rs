//! A run that is saved and continued later.

use crate::base::input::InputError;
use crate::integrators::common::{check_finite, check_length};

/// The state of a run, for [`Problem::resume`](super::Problem::resume): plain numbers only.
///
/// The run continues from here with a new start of the integrator, which estimates its first step: the
/// solution is the same within the tolerances, not to the last bit.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Saved {
    /// Time.
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
    /// Its time derivative for a DAE; empty otherwise.
    pub yp: Vec<f64>,
    /// Parameters of the equations.
    pub parameters: Vec<f64>,
    /// How often each event was met.
    pub counts: Vec<u32>,
    /// Whether each event is armed: none is that occurred [once](super::Event::once), or was
    /// [disarmed](super::Jump::disarm). Empty: all are, except those that occurred once.
    #[cfg_attr(feature = "serde", serde(default))]
    pub armed: Vec<bool>,
    /// The sensitivities, one column after the other; empty if there are none.
    pub sensitivities: Vec<f64>,
    /// The derivatives of all parameters, which actions may have set, by those of the sensitivities, one column
    /// after the other; empty if there are none.
    #[cfg_attr(feature = "serde", serde(default))]
    pub parameter_sensitivities: Vec<f64>,
    /// The integrals since the start; empty if there are none.
    pub quadratures: Vec<f64>,
    /// The sensitivities of the integrals, one column after the other; empty if there are none.
    #[cfg_attr(feature = "serde", serde(default))]
    pub quadrature_sensitivities: Vec<f64>,
    /// Values of the event functions, all finite; 0 for one that is about to leave zero.
    pub event_values: Vec<f64>,
}

impl Saved {
    /// Checks that it fits a problem with these numbers of unknowns, derivatives, events and integrals.
    pub(super) fn check(
        &self,
        [n, derivatives, events, integrals]: [usize; 4],
    ) -> Result<(), InputError> {
        check_length("length of y in the saved run", self.y.len(), n)?;
        check_finite("time of the saved run", &[self.t])?;
        check_finite("y of the saved run", &self.y)?;
        check_finite("yp of the saved run", &self.yp)?;
        check_finite("parameters of the saved run", &self.parameters)?;
        check_finite("quadratures of the saved run", &self.quadratures)?;
        check_finite("event_values of the saved run", &self.event_values)?;
        if self.quadratures.len() != integrals {
            let help = format!("the equations have {integrals}");
            let input = "length of quadratures in the saved run";
            return Err(InputError::new(input, self.quadratures.len(), help));
        }
        if self.yp.len() != derivatives {
            let help = "a DAE has as many as unknowns, an ODE none";
            return Err(InputError::new("length of yp in the saved run", self.yp.len(), help));
        }
        let armed = if self.armed.is_empty() { events } else { self.armed.len() };
        let lengths = [
            ("counts", self.counts.len()),
            ("event_values", self.event_values.len()),
            ("armed", armed),
        ];
        for (what, count) in lengths {
            if count != events {
                let help = format!("the problem has {events} events");
                return Err(InputError::new(
                    format!("length of {what} in the saved run"),
                    count,
                    help,
                ));
            }
        }
        Ok(())
    }
}
