//! Hill's law of muscles: the stress of active fibres as a function of their length and its rate.

use crate::base::input::{InputError, positive};

/// Hill's law of a [muscle](crate::Muscle), which pulls less where its fibres are far from their best length and where
/// they shorten fast: by the stress s f_l f_v per section of the undeformed shape, s being that of its signal, the activation (0 to 1) times the
/// [largest](Self::largest) stress.
///
/// With the stretch l of the fibres, L = l / `optimal` and the speed V = (dL/dt) / `rate`, which is below 0 as they shorten,
///
/// ```text
/// f_l = exp(-(L - 1)^2 / width)
/// f_v = (1 + V) / (1 - V / shape)                                  -1 < V < 0, Hill's hyperbola; 0 below
///     = 1 + (eccentric - 1) V / (V + V_0)                          V >= 0, with V_0 = (eccentric - 1) / (1 + 1 / shape)
/// ```
///
/// (D. G. Thelen, Journal of Biomechanical Engineering 125 (2003) 70-77, for f_l, both hyperbolas, and the values of young adults that are defaults
/// here; after A. V. Hill, Proceedings of the Royal Society of London B 126 (1938) 136-195, and F. E. Zajac, Critical Reviews in Biomedical Engineering 17
/// (1989) 359-411. There, fibres that are stretched slowly resist with twice the slope of those that shorten slowly, and a low
/// activation shortens less fast; here the slope is the same on both sides, so that the tangent does not jump at rest, and `rate` is one number.)
///
/// ```
/// use pliant::{Hill, Muscle};
///
/// let muscle = Muscle::along([1.0, 0.0]).hill(Hill { rate: 5.0, ..Hill::new(2e5) });
/// # assert_eq!(muscle.name(), "");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hill {
    /// Largest stress (Pa), above 0: that of full activation at the best length, while it does not change.
    pub largest: f64,
    /// Stretch of the fibres (1) at their best length, above 0.
    pub optimal: f64,
    /// The square of the width of f_l (1), above 0: at L = 1 +- sqrt(width) the stress is 1/e of the largest.
    pub width: f64,
    /// Fastest shortening (1/s), in best lengths per second, above 0: so fast they do not pull.
    pub rate: f64,
    /// Hill's a by the force at rest (1), above 0: small ones bend the hyperbola more.
    pub shape: f64,
    /// Limit of f_v in fast lengthening (1), above 1.
    pub eccentric: f64,
}

impl Hill {
    /// The law with this `largest` stress (Pa), and else Thelen's values: the best length is that of the undeformed shape, `width` 0.45, `rate`
    /// 10/s, `shape` 0.25, `eccentric` 1.4.
    pub fn new(largest: f64) -> Self {
        Self { largest, optimal: 1.0, width: 0.45, rate: 10.0, shape: 0.25, eccentric: 1.4 }
    }

    /// Checks that it is one.
    pub(crate) fn validate(&self) -> Result<(), InputError> {
        positive("hill.largest", self.largest, "Pa")?;
        for (input, value, unit) in [
            ("hill.optimal", self.optimal, ""),
            ("hill.width", self.width, ""),
            ("hill.rate", self.rate, "1/s"),
            ("hill.shape", self.shape, ""),
        ] {
            positive(input, value, unit)?;
        }
        // false for NaN
        let is_above = self.eccentric > 1.0 && self.eccentric.is_finite();
        if !is_above {
            let help = "it must be above 1: fibres that are stretched resist more than at rest";
            return Err(InputError::new("hill.eccentric", self.eccentric, help));
        }
        Ok(())
    }

    /// Checks that a `stress` (Pa) is from 0 to the largest, but for round-off.
    pub(crate) fn check_stress(&self, stress: f64) -> Result<(), InputError> {
        let round_off = 1e-9 * self.largest;
        if (-round_off..=self.largest + round_off).contains(&stress) {
            return Ok(());
        }
        let help = format!(
            "by Hill's law it is activation (0 to 1) times the largest stress: from 0 to {} Pa",
            self.largest
        );
        Err(InputError::new("stress", format!("{stress} Pa"), help))
    }

    /// f_l f_v, and its derivatives by the stretch and by the rate of that (1/s).
    pub(crate) fn factors(&self, stretch: f64, rate: f64) -> [f64; 3] {
        let Self { optimal, width, shape, eccentric, .. } = *self;
        let off = stretch / optimal - 1.0;
        let of_length = (-off * off / width).exp();
        let by_length = -2.0 * off / (width * optimal) * of_length;
        let fastest = optimal * self.rate;
        let speed = rate / fastest;
        let at_rest = 1.0 + 1.0 / shape;
        let (of_speed, by_speed) = if speed <= -1.0 {
            (0.0, 0.0)
        } else if speed < 0.0 {
            let below = 1.0 - speed / shape;
            ((1.0 + speed) / below, at_rest / (below * below))
        } else {
            let most = eccentric - 1.0;
            let half_way = most / at_rest;
            let below = speed + half_way;
            (1.0 + most * speed / below, most * half_way / (below * below))
        };
        [of_length * of_speed, by_length * of_speed, of_length * by_speed / fastest]
    }
}
