//! Flags for the required accuracy of a motion, and for the quantity to which it applies.

use clap::Args;
use pliant::Fraction;
use pliant::scene_file::AccuracyRequest;

use super::failure::Failure;
use super::settings::SettingsArguments;

/// The flags, which override `accuracy` and `quantity` of `[solver]`.
#[derive(Args)]
pub struct AccuracyArguments {
    /// Run the scene with tighter and tighter tolerances, until two runs agree to this part of the motion: 1% or 0.01;
    /// their difference is written beside the motion
    #[arg(long, value_name = "PART")]
    accuracy: Option<Fraction>,
    /// Quantity that has to be as accurate: motion, a sensor or node set and a component such as tip.y, com.x, rotation; with
    /// :end, :max, :min, :mean, :frequency or :damping that alone [default: motion]
    #[arg(long, value_name = "QUANTITY")]
    quantity: Option<String>,
}

impl AccuracyArguments {
    /// Overrides the values of the scene file.
    pub fn apply(
        &self,
        request: &mut AccuracyRequest,
        settings: &SettingsArguments,
    ) -> Result<(), Failure> {
        if self.accuracy.is_some() && settings.has("rtol") {
            return Err(Failure::bad_input(
                "--accuracy finds rtol by itself: leave one of them out",
            ));
        }
        request.within = self.accuracy.or(request.within.filter(|_| !settings.has("rtol")));
        if let Some(quantity) = &self.quantity {
            request.quantity = Some(quantity.clone());
        }
        match (&self.quantity, request.within) {
            (Some(_), None) => Err(Failure::bad_input(
                "--quantity says what --accuracy is of: give both, as --accuracy 1% --quantity tip.y",
            )),
            _ => Ok(()),
        }
    }
}
