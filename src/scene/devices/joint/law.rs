//! The forces along the coordinate q of a joint: spring, stops, damping, friction, and a motor.
//!
//! ```text
//! spring     -k (q - q_0)
//! stops      -k_s (q - q_1) above q_1, below q_2 likewise
//! damping    -c q'
//! friction   -F h(q'/w),   h(x) = (3 x - x^3)/2 up to |x| = 1, then the sign of x
//! motor      Q + k_p (q_t - q) + k_d (q'_t - q'),   no larger than F_m, while it drives than F_m (1 - |q'|/w_0), to which it bends
//! ```
//!
//! Q, q_t and q'_t are inputs. Differences of angles are those without whole turns, so that no force has to count them: a spring and a servo turn
//! over half a turn away. Friction creeps below the speed w (Coulomb's law, regularized).

use crate::base::input::{InputError, finite, four_digits, not_negative, positive};

/// The numbers of the law; 0 of what is not there.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct JointLaw {
    pub(super) stiffness: f64,
    pub(super) rest: f64,
    pub(super) damping: f64,
    /// Lower and upper stop, with their stiffness.
    pub(super) stops: Option<([f64; 2], f64)>,
    /// Force, and the speed from which on it slides.
    pub(super) friction: Option<[f64; 2]>,
    /// Gains of a servo: k_p and k_d.
    pub(super) servo: [f64; 2],
    /// Largest force of the motor.
    pub(super) most: Option<f64>,
    /// Speed at which the motor has no force left.
    pub(super) no_load_speed: Option<f64>,
}

/// A force along a coordinate, with its derivatives by the coordinate and its rate.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Part {
    pub(super) force: f64,
    pub(super) slopes: [f64; 2],
}

/// Part of the way between the stops by which a state may lean on one at the start.
const LEANING: f64 = 0.05;
/// Coordinate (rad, m) below which a joint is in the undeformed shape.
const UNDEFORMED: f64 = 1e-9;

impl JointLaw {
    /// Whether the state of the joint has a part in its forces.
    pub(super) fn is_of_state(&self) -> bool {
        self.stiffness > 0.0
            || self.damping > 0.0
            || self.stops.is_some()
            || self.friction.is_some()
            || self.servo != [0.0; 2]
            || self.no_load_speed.is_some()
    }

    /// # Errors
    /// Numbers out of range, stops that cross or, of an angle, are a turn apart, anything at all where there is no coordinate; `name` is that of the joint.
    pub(super) fn validate(
        &self,
        name: &str,
        moves: bool,
        is_angle: bool,
    ) -> Result<(), InputError> {
        let input = |word: &str| format!("{word} of joint \"{name}\"");
        if !moves && *self != Self::default() {
            let help = "revolute, prismatic and screw joints alone have springs, damping, stops, friction and motors";
            return Err(InputError::new(input("kind"), "without a coordinate", help));
        }
        not_negative(&input("stiffness"), self.stiffness, "")?;
        finite(&input("rest"), &[self.rest])?;
        not_negative(&input("damping"), self.damping, "")?;
        for (word, gain) in ["stiffness", "damping"].into_iter().zip(self.servo) {
            not_negative(&input(&format!("servo_{word}")), gain, "")?;
        }
        if let Some((stops, stiffness)) = self.stops {
            finite(&input("stops"), &stops)?;
            positive(&input("stop_stiffness"), stiffness, "")?;
            let [low, high] = stops;
            let value = format!("[{low}, {high}]");
            if low >= high {
                let help = "the lower one comes first: the joint moves between them";
                return Err(InputError::new(input("stops"), value, help));
            }
            if is_angle && high - low >= std::f64::consts::TAU {
                let help = "they must be less than a whole turn apart: leave them out";
                return Err(InputError::new(input("stops"), value, help));
            }
        }
        if let Some([force, speed]) = self.friction {
            not_negative(&input("friction"), force, "")?;
            positive(&input("sticking_speed"), speed, "")?;
        }
        self.most.map_or(Ok(0.0), |most| positive(&input("motor_limit"), most, ""))?;
        let Some(speed) = self.no_load_speed else { return Ok(()) };
        positive(&input("no_load_speed"), speed, "")?;
        match self.most {
            Some(_) => Ok(()),
            None => {
                let help = "it needs the force at rest, too: give the limit of the motor";
                Err(InputError::new(input("no_load_speed"), speed, help))
            }
        }
    }

    /// # Errors
    /// A target that is commanded, of place (0) or speed (1), without the gain of the servo that leads to it.
    pub(super) fn check_targets(
        &self,
        name: &str,
        is_set: impl Fn(usize) -> bool,
    ) -> Result<(), InputError> {
        let without = (0..2).find(|&target| is_set(target) && self.servo[target] == 0.0);
        let Some(target) = without else { return Ok(()) };
        let (word, gain) = [("angle or displacement", "stiffness"), ("speed", "damping")][target];
        let help =
            format!("no servo leads to it: give servo_{gain}, or command the torque or force");
        Err(InputError::new(format!("{word} of joint \"{name}\""), "commanded", help))
    }

    /// # Errors
    /// A start `q` beyond a stop; one that is not in the undeformed shape may lean on it, by a twentieth of the way between the stops.
    pub(super) fn check_start(
        &self,
        name: &str,
        q: f64,
        wrapped: impl Fn(f64) -> f64,
    ) -> Result<(), InputError> {
        let Some(([low, high], _)) = self.stops else { return Ok(()) };
        let [_, behind] = self.strains(q, wrapped);
        let allowed = if q.abs() < UNDEFORMED { 0.0 } else { LEANING * (high - low) };
        if behind.abs() <= allowed {
            return Ok(());
        }
        let help = format!(
            "the joint starts at {}, {} beyond a stop, which would throw it back: its coordinate is 0 in the undeformed shape; draw it between the stops, \
             or move these",
            four_digits(q),
            four_digits(behind.abs()),
        );
        let input = format!("stops of joint \"{name}\"");
        Err(InputError::new(input, format!("[{low}, {high}]"), help))
    }

    /// How far `q` is from the rest, and behind a stop; both without whole turns by `wrapped`.
    fn strains(&self, q: f64, wrapped: impl Fn(f64) -> f64) -> [f64; 2] {
        let behind = self.stops.map_or(0.0, |([low, high], _)| {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            let from_middle = wrapped(q - middle);
            from_middle - from_middle.clamp(-half, half)
        });
        [if self.stiffness > 0.0 { wrapped(q - self.rest) } else { 0.0 }, behind]
    }

    /// Energy of spring and stops (J).
    pub(super) fn potential(&self, q: f64, wrapped: impl Fn(f64) -> f64) -> f64 {
        let [strain, behind] = self.strains(q, wrapped);
        let stop = self.stops.map_or(0.0, |(_, stiffness)| stiffness);
        0.5 * (self.stiffness * strain * strain + stop * behind * behind)
    }

    /// The force of spring and stops.
    pub(super) fn elastic(&self, q: f64, wrapped: impl Fn(f64) -> f64) -> Part {
        let [strain, behind] = self.strains(q, wrapped);
        let stop = self.stops.map_or(0.0, |(_, stiffness)| stiffness);
        let slope = self.stiffness + if behind == 0.0 { 0.0 } else { stop };
        Part { force: -self.stiffness * strain - stop * behind, slopes: [-slope, 0.0] }
    }

    /// The force of damping and friction.
    pub(super) fn resistance(&self, rate: f64) -> Part {
        let [mut force, mut slope] = [-self.damping * rate, -self.damping];
        if let Some([most, speed]) = self.friction {
            let x = (rate / speed).clamp(-1.0, 1.0);
            force -= most * 0.5 * x * (3.0 - x * x);
            slope -= most / speed * 1.5 * (1.0 - x * x);
        }
        Part { force, slopes: [0.0, slope] }
    }

    /// The force of the motor, with the inputs [Q, q_t, q'_t].
    pub(super) fn motor(
        &self,
        [given, target, speed]: [f64; 3],
        [q, rate]: [f64; 2],
        wrapped: impl Fn(f64) -> f64,
    ) -> Part {
        let [by_place, by_rate] = self.servo;
        let asked = given + by_place * wrapped(target - q) + by_rate * (speed - rate);
        let free = Part { force: asked, slopes: [-by_place, -by_rate] };
        let Some(most) = self.most else { return free };
        let (mut limit, mut by_speed) = (most, 0.0);
        if let Some(no_load) = self.no_load_speed {
            let share = 1.0 - asked.signum() * rate / no_load;
            limit = most * share.clamp(0.0, 1.0);
            let is_between = share > 0.0 && share < 1.0;
            by_speed = if is_between { -most / no_load } else { 0.0 };
        }
        let [force, by_asked, by_limit] = limited(asked, limit);
        let slopes = [-by_place * by_asked, -by_rate * by_asked + by_limit.abs() * by_speed];
        Part { force, slopes }
    }
}

/// Part of a limit over which forces bend to it.
const BEND: f64 = 0.1;

/// `asked`, no larger than `limit`, with the derivatives by both: a parabola leads from one to the other, so that no step ends there.
fn limited(asked: f64, limit: f64) -> [f64; 3] {
    let (sign, size) = (asked.signum(), asked.abs());
    // 0 where it begins to bend, 1 where it is at the limit
    let bent = (size - (1.0 - BEND) * limit) / (2.0 * BEND * limit);
    if bent <= 0.0 {
        [asked, 1.0, 0.0]
    } else if bent < 1.0 {
        let force = size - BEND * limit * bent * bent;
        [sign * force, 1.0 - bent, sign * bent * (1.0 - BEND + BEND * bent)]
    } else {
        // without any force left, also where it is 0 that is asked for
        [sign * limit, 0.0, sign]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives against central differences, away from kinks: the laws are polynomials of third order there, off by h^2 and round-off.
    #[test]
    fn slopes_are_those_of_differences() {
        let law = JointLaw {
            stiffness: 2.0,
            rest: 0.3,
            damping: 0.1,
            stops: Some(([-0.5, 1.0], 50.0)),
            friction: Some([0.4, 0.2]),
            servo: [5.0, 0.7],
            most: Some(1.5),
            no_load_speed: Some(4.0),
        };
        let whole = |difference: f64| difference;
        let parts = |q: f64, rate: f64| {
            [
                law.elastic(q, whole),
                law.resistance(rate),
                law.motor([0.2, 0.5, 0.0], [q, rate], whole),
            ]
        };
        let h = 1e-6;
        for q in [-0.8, 0.1, 0.45, 1.2] {
            for rate in [-5.0, -1.0, 0.05, 0.1, 2.0] {
                let pairs = [[q + h, rate], [q - h, rate], [q, rate + h], [q, rate - h]];
                let near = pairs.map(|[q, rate]| parts(q, rate));
                for (k, part) in parts(q, rate).into_iter().enumerate() {
                    for way in 0..2 {
                        let slope =
                            (near[2 * way][k].force - near[2 * way + 1][k].force) / (2.0 * h);
                        assert!((slope - part.slopes[way]).abs() < 1e-7, "{k} {q} {rate} {slope}");
                    }
                }
                let slope = (law.potential(q + h, whole) - law.potential(q - h, whole)) / (2.0 * h);
                assert!((slope + parts(q, rate)[0].force).abs() < 1e-7);
            }
        }
    }

    /// While it drives, a motor is on the line from its stall torque to its no-load speed; braking it has all of the torque.
    #[test]
    fn a_motor_is_on_its_line() {
        let law = JointLaw { most: Some(2.0), no_load_speed: Some(10.0), ..JointLaw::default() };
        let force = |given: f64, rate: f64| law.motor([given, 0.0, 0.0], [0.0, rate], |x| x).force;
        assert_eq!(
            [force(9.0, 0.0), force(9.0, 2.5), force(9.0, 11.0), force(9.0, -5.0), force(1.0, 2.5)],
            [2.0, 1.5, 0.0, 2.0, 1.0]
        );
        assert_eq!([force(-9.0, -2.5), force(-9.0, 5.0)], [-1.5, -2.0]);
    }
}
