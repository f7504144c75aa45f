//! Boxes whose edges are not parallel to the axes.

use nalgebra::{Rotation3, Vector3};

use crate::base::input::{InputError, finite};
use crate::base::vector::padded;

/// Rotation of a box about its middle.
#[derive(Clone)]
pub(crate) struct Turned {
    /// As it was given: the angle in the plane, the axis times the angle in space (rad).
    pub(super) by: Vec<f64>,
    rotation: Rotation3<f64>,
}

impl Turned {
    pub(super) fn new(by: Vec<f64>) -> Self {
        let rotation = match by[..] {
            [angle] => Rotation3::from_axis_angle(&Vector3::z_axis(), angle),
            [x, y, z] => Rotation3::new(Vector3::new(x, y, z)),
            // refused when the scene is checked
            _ => Rotation3::identity(),
        };
        Self { by, rotation }
    }

    /// # Errors
    /// A wrong number of angles, or angles that are not finite.
    pub(super) fn validate(&self, dimension: usize, input: &str) -> Result<(), InputError> {
        finite(input, &self.by)?;
        if matches!((dimension, self.by.len()), (2, 1) | (3, 3)) {
            return Ok(());
        }
        let help = "one angle (rad) in the plane; in space three numbers, the axis times the angle";
        Err(InputError::new(input, format!("{:?}", self.by), help))
    }

    /// Position of a point before its rotation with the box between `min` and `max`.
    pub(super) fn back(&self, min: &[f64], max: &[f64], x: &[f64]) -> [f64; 3] {
        let middle = middle(min, max);
        let arm = self.rotation.inverse_transform_vector(&(Vector3::from(padded(x)) - middle));
        (middle + arm).into()
    }

    /// A direction that is turned with the box.
    pub(super) fn direction(&self, own: [f64; 3]) -> [f64; 3] {
        (self.rotation * Vector3::from(own)).into()
    }
}

/// The corners of a box: those at the number k in binary are at `max` along the axes of the digits 1, the first axis last.
pub(crate) fn corners(min: &[f64], max: &[f64], turned: Option<&Turned>) -> Vec<Vec<f64>> {
    let d = min.len();
    let corner = |k: usize| -> Vec<f64> {
        let own = (0..d).map(|axis| if (k >> axis) & 1 == 1 { max[axis] } else { min[axis] });
        let own: Vec<f64> = own.collect();
        let Some(turned) = turned else { return own };
        let middle = middle(min, max);
        let arm = turned.rotation * (Vector3::from(padded(&own)) - middle);
        (middle + arm).iter().take(d).copied().collect()
    };
    (0..1 << d).map(corner).collect()
}

fn middle(min: &[f64], max: &[f64]) -> Vector3<f64> {
    0.5 * (Vector3::from(padded(min)) + Vector3::from(padded(max)))
}
