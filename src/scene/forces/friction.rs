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
//!
//! A surface with bristles or scales holds what slides backward, along a unit vector e, by r times as much, less so at
//! an angle:
//!
//! ```text
//! mu(w) (1 + (r - 1) (3 q^2 - 2 q^3)),   q = h(w) s . e/w where that is above 0,
//!
//! h(w) = (3 x - x^3)/2 up to x = 1, then 1: mu(w)/mu_s of a law whose mu_s and mu_k are the same.
//! ```
//!
//! Backward, q is h: the force grows up to v0 and is smooth there, too.
//!
//! Points that stick creep at speeds below v0. Without creep a spring would tie a sticking point to the place
//! where it began to stick; such an anchor is a memory, and samples, pictures, sensors, forks and
//! checkpoints, which evaluate forces anew, would all have to carry it
//! (`docs/decisions/0007-contact-by-an-energy.md`). Tangents are exact and not symmetric: in sliding,
//! friction follows the normal force with the coupling mu K_p. The symmetric part of the Newton matrix is factorized,
//! the rest follows by an iteration (`dynamics/linear/skew.rs`, measured in `docs/notes/contact.md`). Friction that falls with the
//! speed is negative damping, so that a matrix is factorized by LU now and then. Where the normal force stops
//! pressing there is a switch, like the cut-off of damping without adhesion. Explicit steps are bounded as if
//! all sliding points stuck (`ContactForce::add_reserves`): a sticking point is a damper of the rate 3 mu_s N/(2 v0
//! m).

use crate::base::input::{InputError, not_negative, positive};
use crate::base::vector::{dot, norm};

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

/// Friction that is larger one way, as users give it.
#[derive(Debug, Clone)]
pub(super) struct Bristles {
    /// One component per dimension.
    pub(super) direction: Vec<f64>,
    /// The static coefficient that way.
    pub(super) coefficient: f64,
}

impl Bristles {
    /// Checks the numbers, beside the `friction` of the other ways; `input` names a key.
    pub(super) fn validate(
        &self,
        friction: &Friction,
        dimension: usize,
        input: &impl Fn(&str) -> String,
    ) -> Result<(), InputError> {
        let Self { ref direction, coefficient } = *self;
        let key = input("backward.direction");
        if direction.len() != dimension {
            let help = format!("give {dimension} components, one per dimension");
            return Err(InputError::new(key, format!("{direction:?}"), help));
        }
        positive(&format!("length of {key}"), norm(direction), "")?;
        let [at_rest, _] = friction.coefficients.unwrap_or_default();
        let key = input("backward");
        not_negative(&key, coefficient, "")?;
        let help = if at_rest == 0.0 && coefficient > 0.0 {
            "it goes with the friction of the other ways: give a friction_coefficient above 0, too"
        } else if coefficient < at_rest {
            "it must not be below the static coefficient of the other ways: turn the direction around"
        } else {
            return Ok(());
        };
        Err(InputError::new(key, coefficient, help))
    }

    /// Law of the larger `friction` in that direction.
    pub(super) fn law(&self, friction: &Friction) -> Option<Backward> {
        let [at_rest, _] = friction.coefficients.filter(|[at_rest, _]| *at_rest > 0.0)?;
        let length = norm(&self.direction);
        let component = |i: usize| self.direction.get(i).map_or(0.0, |x| x / length);
        let along = std::array::from_fn(component);
        Some(Backward { along, more: self.coefficient / at_rest - 1.0 })
    }
}

/// Additional friction of a surface against sliding in one direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Backward {
    /// e, a unit vector; 0 beyond the dimension.
    pub(super) along: [f64; 3],
    /// r - 1, 0 or above.
    pub(super) more: f64,
}

impl Backward {
    /// The factor 1 + (r - 1) (3 q^2 - 2 q^3) at the `sliding` velocity s (m/s) of the speed `w`, and its gradient by s
    /// (s/m).
    pub(super) fn factor(&self, coulomb: Coulomb, sliding: &[f64; 3], w: f64) -> (f64, [f64; 3]) {
        let Drag { per_speed, slope, .. } =
            Coulomb { at_rest: 1.0, sliding: 1.0, ..coulomb }.drag(w);
        let along = dot(&self.along, sliding);
        let q = (along * per_speed).clamp(0.0, 1.0);
        let steepness = 6.0 * self.more * q * (1.0 - q);
        let gradient = std::array::from_fn(|i| {
            steepness * (per_speed * self.along[i] + along * slope * sliding[i])
        });
        (1.0 + self.more * q * q * (3.0 - 2.0 * q), gradient)
    }

    /// A bound on how much steeper than at rest without it friction grows.
    pub(super) fn steepest(&self) -> f64 {
        1.0 + 1.25 * self.more
    }
}
