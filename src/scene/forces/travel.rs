//! Motion of obstacles.

use std::sync::Arc;

use super::passage::Path;
use crate::base::formula::Formula;
use crate::base::input::{InputError, finite};
use crate::base::vector::{difference, norm};
use crate::scene::constraint::{Prescribed, Spline};

/// Most parts into which an interval of time is cut to find cubics that agree with a formula.
const MOST_PARTS: usize = 4096;
/// Places within a part at which formula and cubic are compared.
const PLACES: usize = 7;

/// Motion of an obstacle, relative to its shape as given. Components beyond the dimension are 0.
#[derive(Debug, Clone)]
pub(super) enum Travel {
    /// With a constant velocity (m/s); without components it rests.
    Uniform(Vec<f64>),
    /// Along a smooth path through points.
    Path(Arc<Waypoints>),
    /// By smooth formulas of time, one per component (m).
    Formulas(Arc<[Formula]>),
}

/// Equal parts of an interval of time, in each of which an obstacle moves along cubics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cubics {
    pub(crate) parts: usize,
    /// A bound on the speed (m/s).
    pub(crate) fastest: f64,
}

/// Displacements (m) at given times (s), with the splines through their components.
#[derive(Debug)]
pub(super) struct Waypoints {
    displacements: Vec<Vec<f64>>,
    splines: Vec<Spline>,
}

impl Waypoints {
    pub(super) fn new(times: &[f64], displacements: Vec<Vec<f64>>) -> Self {
        let dimension = displacements.first().map_or(0, Vec::len).min(3);
        let along = |i: usize| {
            let x = displacements.iter().map(|x| x.get(i).copied().unwrap_or(f64::NAN));
            Spline::new(times.into(), x.collect())
        };
        Self { splines: (0..dimension).map(along).collect(), displacements }
    }
}

impl Travel {
    /// # Errors
    /// Numbers of components that do not fit the `dimension`, numbers that are not finite, times that do not
    /// ascend. `input` names a key of the obstacle.
    pub(super) fn validate(
        &self,
        dimension: usize,
        input: &impl Fn(&str) -> String,
    ) -> Result<(), InputError> {
        match self {
            Self::Uniform(velocity) if velocity.is_empty() => Ok(()),
            Self::Uniform(velocity) => {
                if velocity.len() != dimension {
                    let help = format!("it needs {dimension} component(s) (m/s)");
                    return Err(InputError::new(input("velocity"), format!("{velocity:?}"), help));
                }
                finite(&input("velocity"), velocity)
            }
            Self::Path(path) => {
                let input = input("path");
                for displacement in &path.displacements {
                    if displacement.len() != dimension {
                        let help = format!("each displacement needs {dimension} component(s) (m)");
                        return Err(InputError::new(input, format!("{displacement:?}"), help));
                    }
                }
                let mut splines = path.splines.iter();
                splines.try_for_each(|spline| spline.validate(&input, "m"))?;
                if path.splines.is_empty() {
                    let help = "a path needs two points at least (s, m)";
                    return Err(InputError::new(input, "[]", help));
                }
                Ok(())
            }
            Self::Formulas(formulas) => {
                let input = input("path");
                if formulas.len() != dimension {
                    let help = format!("it needs {dimension} component(s) (m)");
                    return Err(InputError::new(input, format!("{formulas:?}"), help));
                }
                for formula in &**formulas {
                    formula.check_smooth()?;
                    if formula.at(0.0).0.iter().any(|x| !x.is_finite()) {
                        let help = "it must be a finite number at t = 0, with its derivatives";
                        return Err(InputError::new(input, formula.text(), help));
                    }
                }
                Ok(())
            }
        }
    }

    /// Displacement (m) at time `t` (s).
    pub(super) fn displacement(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Uniform(velocity) => components(velocity).map(|velocity| velocity * t),
            Self::Path(path) => path.at(t, |at| at.displacement),
            Self::Formulas(formulas) => jets(formulas, t)[0],
        }
    }

    /// Velocity (m/s) at time `t` (s).
    pub(super) fn velocity(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Uniform(velocity) => components(velocity),
            Self::Path(path) => path.at(t, |at| at.velocity),
            Self::Formulas(formulas) => jets(formulas, t)[1],
        }
    }

    /// A bound on its speed (m/s) at all times; formulas have none.
    pub(super) fn fastest(&self) -> Option<f64> {
        match self {
            Self::Uniform(velocity) => Some(norm(&components(velocity))),
            Self::Path(path) => {
                Some(norm(&path.splines.iter().map(Spline::fastest).collect::<Vec<f64>>()))
            }
            Self::Formulas(_) => None,
        }
    }

    /// The cubics of formulas between two times (s). The parts are halved until the formula is no farther
    /// than `tolerance` (m) from the cubic with its displacements and velocities at both ends, as judged by
    /// accelerations at the ends and displacements at some places in between. Other motions need one part.
    pub(super) fn cubics(&self, [start, end]: [f64; 2], tolerance: f64) -> Cubics {
        let Self::Formulas(formulas) = self else {
            return Cubics { parts: 1, fastest: self.fastest().unwrap_or(0.0) };
        };
        if end <= start {
            return Cubics { parts: 1, fastest: norm(&self.velocity(start)) };
        }
        let mut parts = 1;
        loop {
            let span = (end - start) / parts as f64;
            let time = |part: f64| start + part * span;
            let (mut fastest, mut off, mut from) = (0.0_f64, 0.0_f64, jets(formulas, start));
            for k in 0..parts {
                let to = jets(formulas, time((k + 1) as f64));
                let ends = [0, 1].map(|n| [from, to].map(|at| at[n]));
                let cubic = Path::new(ends[0], ends[1], span);
                fastest = fastest.max(cubic.fastest(span));
                for (acceleration, bend) in [from[2], to[2]].iter().zip(cubic.bends()) {
                    // curves with the same values and slopes at both ends, but second derivatives that differ
                    // by this, are no farther apart in between
                    let unlike = difference(&acceleration.map(|a| a * span * span), &bend);
                    off = off.max(norm(&unlike) / 32.0);
                }
                for place in 1..=PLACES {
                    let s = place as f64 / (PLACES + 1) as f64;
                    let [exact, ..] = jets(formulas, time(k as f64 + s));
                    off = off.max(norm(&difference(&exact, &cubic.at(s)[0])));
                }
                from = to;
            }
            if off <= tolerance || parts == MOST_PARTS {
                return Cubics { parts, fastest };
            }
            parts *= 2;
        }
    }

    /// Some of its components.
    pub(super) fn part(&self, components: [usize; 2]) -> Self {
        let chosen = |x: &[f64]| components.map(|i| x[i]).to_vec();
        match self {
            Self::Uniform(velocity) if velocity.is_empty() => self.clone(),
            Self::Uniform(velocity) => Self::Uniform(chosen(velocity)),
            Self::Path(path) => {
                let times = path.splines.first().map_or(&[][..], Spline::times);
                let displacements = path.displacements.iter().map(|x| chosen(x)).collect();
                Self::Path(Arc::new(Waypoints::new(times, displacements)))
            }
            Self::Formulas(formulas) => {
                Self::Formulas(components.map(|i| formulas[i].clone()).into())
            }
        }
    }

    /// Whether its velocity is constant.
    #[cfg(feature = "checkpoint")]
    pub(super) fn is_uniform(&self) -> bool {
        matches!(self, Self::Uniform(_))
    }

    /// The splines of a path, one per component.
    pub(super) fn splines(&self) -> &[Spline] {
        match self {
            Self::Uniform(_) | Self::Formulas(_) => &[],
            Self::Path(path) => &path.splines,
        }
    }
}

impl Waypoints {
    fn at(&self, t: f64, part: impl Fn(Prescribed) -> f64) -> [f64; 3] {
        std::array::from_fn(|i| self.splines.get(i).map_or(0.0, |spline| part(spline.at(t))))
    }
}

/// Displacement (m), velocity and acceleration at time `t` (s).
fn jets(formulas: &[Formula], t: f64) -> [[f64; 3]; 3] {
    let mut at = [[0.0; 3]; 3];
    for (i, formula) in formulas.iter().enumerate().take(3) {
        for (part, x) in at.iter_mut().zip(formula.at(t).0) {
            part[i] = x;
        }
    }
    at
}

fn components(vector: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| vector.get(i).copied().unwrap_or(0.0))
}

#[cfg(all(test, feature = "scene-file"))]
mod tests {
    use super::*;

    fn along(text: &str) -> Travel {
        Travel::Formulas([text, "0.3*t"].map(|text| Formula::parse(text).unwrap()).into())
    }

    /// Within each part the cubics follow the formulas to the tolerance, and the bound on the speed holds and
    /// is at most about twice the speed: checked at ten thousand places. Oscillations have the same phase at
    /// both times, so that the ends alone do not reveal them.
    #[test]
    fn cubics_follow_formulas() {
        for (text, times, least) in [
            ("0.01*cos(2*pi*5*t)", [0.2, 1.4], 8),
            ("0.01*sin(2*pi*5*t)", [0.2, 1.4], 8),
            ("0.01*cos(2*pi*80*t)^3", [0.0, 0.1], 16),
            ("0.1*exp(-((t - 0.5)/0.05)^2)", [0.0, 1.0], 16),
            ("t^3 - t", [-1.0, 2.0], 1),
        ] {
            let (travel, tolerance) = (along(text), 1e-6);
            let Cubics { parts, fastest } = travel.cubics(times, tolerance);
            let at = |s: f64| times[0] + s * (times[1] - times[0]);
            let (mut off, mut speed) = (0.0_f64, 0.0_f64);
            for k in 0..10_000 {
                let place = f64::from(k) / 10_000.0 * parts as f64;
                let ends = [place.floor(), place.floor() + 1.0].map(|k| at(k / parts as f64));
                let [x, v] =
                    [ends.map(|t| travel.displacement(t)), ends.map(|t| travel.velocity(t))];
                let cubic = Path::new(x, v, ends[1] - ends[0]).at(place.fract())[0];
                let t = at(place / parts as f64);
                off = off.max(norm(&difference(&cubic, &travel.displacement(t))));
                speed = speed.max(norm(&travel.velocity(t)));
            }
            println!("{text}: {parts} parts, off by {off:e}, {fastest} for {speed} m/s");
            assert!(off <= tolerance && (least..2048).contains(&parts), "{text}: {parts} {off:e}");
            assert!(fastest >= 0.999 * speed && fastest < 2.1 * speed, "{text}: {fastest} {speed}");
        }
        let still = along("t").cubics([0.5, 0.5], 1e-6);
        assert_eq!(still, Cubics { parts: 1, fastest: 1.0_f64.hypot(0.3) });
    }
}
