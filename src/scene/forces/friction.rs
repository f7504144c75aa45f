//! Coulomb's law of friction, smooth in the sliding speed.
//!
//! ```text
//! f = -N mu(w) s/w,   w = |s|,   s the sliding velocity,
//!
//! mu(w) = mu_s (3 x - x^3)/2               x = w/v0 up to 1: it sticks
//!         mu_s - (mu_s - mu_k) (3 y^2 - 2 y^3)   y = (w/v0 - 1)/2 up to 1
//!         mu_k                             from 3 v0 on: it slides
//! ```
//!
//! mu(w) has a continuous slope, and mu(w)/w is a polynomial in w^2 where it sticks, so that it is smooth at
//! rest. mu_s is reached at v0 and exceeded nowhere.

use crate::base::input::{InputError, not_negative, positive};

/// Friction as users give it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Friction {
    /// mu_s and mu_k
    pub(super) coefficients: Option<[f64; 2]>,
    /// v0 (m/s)
    pub(super) sticking_speed: Option<f64>,
}

impl Friction {
    /// Checks the numbers; `input` names a key.
    pub(super) fn validate(&self, input: &impl Fn(&str) -> String) -> Result<(), InputError> {
        if let Some([at_rest, sliding]) = self.coefficients {
            not_negative(&input("friction_coefficient"), at_rest, "")?;
            not_negative(&input("friction_coefficient"), sliding, "")?;
            if sliding > at_rest {
                let value = format!("{at_rest} at rest, {sliding} sliding");
                let help = "the kinetic coefficient must not be above the static one";
                return Err(InputError::new(input("friction_coefficient"), value, help));
            }
        }
        let Some(speed) = self.sticking_speed else { return Ok(()) };
        positive(&input("sticking_speed"), speed, "m/s")?;
        match self.coefficients {
            Some(_) => Ok(()),
            None => {
                let help = "it belongs to friction: give a friction coefficient, too";
                Err(InputError::new(input("sticking_speed"), speed, help))
            }
        }
    }

    /// Whether what slides is held back.
    pub(super) fn acts(&self) -> bool {
        self.coefficients.is_some_and(|[at_rest, _]| at_rest > 0.0)
    }

    /// The law for a body of `size` (m).
    pub(super) fn coulomb(&self, size: f64) -> Option<Coulomb> {
        self.coefficients.map(|of| Coulomb::new(of, self.sticking_speed, size))
    }
}

/// Default of v0, in sizes of the body per second (1/s).
const STICKING_SPEED: f64 = 1e-3;

/// The law's numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coulomb {
    /// mu_s
    pub(super) at_rest: f64,
    /// mu_k, not above mu_s.
    pub(super) sliding: f64,
    /// v0 (m/s)
    pub(super) sticking_speed: f64,
}

/// mu(w)/w and how it changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drag {
    /// mu(w)/w (s/m)
    pub(super) per_speed: f64,
    /// Its derivative by w, divided by w (s^3/m^3).
    pub(super) slope: f64,
    /// d mu/dw (s/m)
    pub(super) along: f64,
}

impl Coulomb {
    /// mu_s and mu_k with v0 as given, or its default for a body of `size` (m).
    fn new([at_rest, sliding]: [f64; 2], sticking_speed: Option<f64>, size: f64) -> Self {
        let sticking_speed = sticking_speed.unwrap_or(STICKING_SPEED * size);
        Self { at_rest, sliding, sticking_speed }
    }

    /// The law at the sliding speed `w` (m/s).
    pub(super) fn drag(&self, w: f64) -> Drag {
        let Self { at_rest, sliding, sticking_speed } = *self;
        let x = w / sticking_speed;
        if x < 1.0 {
            let (steepest, slope) = (self.steepest(), -at_rest / sticking_speed.powi(3));
            let per_speed = steepest * (1.0 - x * x / 3.0);
            return Drag { per_speed, slope, along: steepest * (1.0 - x * x) };
        }
        let y = (0.5 * (x - 1.0)).min(1.0);
        let fall = at_rest - sliding;
        let per_speed = (at_rest - fall * y * y * (3.0 - 2.0 * y)) / w;
        let along = -3.0 * fall * y * (1.0 - y) / sticking_speed;
        Drag { per_speed, slope: (along - per_speed) / (w * w), along }
    }

    /// Whether it holds what slides at the speed `w` (m/s).
    pub(super) fn sticks(&self, w: f64) -> bool {
        self.at_rest > 0.0 && w <= self.sticking_speed
    }

    /// The largest d mu/dw (s/m), that at rest.
    pub(super) fn steepest(&self) -> f64 {
        1.5 * self.at_rest / self.sticking_speed
    }
}
