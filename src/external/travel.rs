//! How obstacles move.

use std::sync::Arc;

use crate::constraint::{Prescribed, Spline};
use crate::input::{InputError, finite};
use crate::vector::norm;

/// How an obstacle moves, from where it was said to be. Components beyond the dimension are 0.
#[derive(Debug, Clone)]
pub(super) enum Travel {
    /// With a constant velocity (m/s); without components it rests.
    Uniform(Vec<f64>),
    /// Along a smooth path through points.
    Path(Arc<Waypoints>),
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
                    let mend = format!("it needs {dimension} component(s) (m/s)");
                    return Err(InputError::new(input("velocity"), format!("{velocity:?}"), mend));
                }
                finite(&input("velocity"), velocity)
            }
            Self::Path(path) => {
                let input = input("path");
                for displacement in &path.displacements {
                    if displacement.len() != dimension {
                        let mend = format!("each displacement needs {dimension} component(s) (m)");
                        return Err(InputError::new(input, format!("{displacement:?}"), mend));
                    }
                }
                let mut splines = path.splines.iter();
                splines.try_for_each(|spline| spline.validate(&input, "m"))?;
                if path.splines.is_empty() {
                    let mend = "a path needs two points at least (s, m)";
                    return Err(InputError::new(input, "[]", mend));
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
        }
    }

    /// Velocity (m/s) at time `t` (s).
    pub(super) fn velocity(&self, t: f64) -> [f64; 3] {
        match self {
            Self::Uniform(velocity) => components(velocity),
            Self::Path(path) => path.at(t, |at| at.velocity),
        }
    }

    /// A bound on its speed (m/s).
    pub(super) fn fastest(&self) -> f64 {
        match self {
            Self::Uniform(velocity) => norm(&components(velocity)),
            Self::Path(path) => {
                norm(&path.splines.iter().map(Spline::fastest).collect::<Vec<f64>>())
            }
        }
    }

    /// The splines of a path, one per component.
    pub(super) fn splines(&self) -> &[Spline] {
        match self {
            Self::Uniform(_) => &[],
            Self::Path(path) => &path.splines,
        }
    }
}

impl Waypoints {
    fn at(&self, t: f64, part: impl Fn(Prescribed) -> f64) -> [f64; 3] {
        std::array::from_fn(|i| self.splines.get(i).map_or(0.0, |spline| part(spline.at(t))))
    }
}

fn components(vector: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| vector.get(i).copied().unwrap_or(0.0))
}
