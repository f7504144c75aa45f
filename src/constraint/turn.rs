//! Rotations: angular velocities, and components that turn about an axis.

use crate::input::{InputError, finite};

/// The angular velocity (rad/s) or axis that was given for `input`: one component in the plane,
/// counter-clockwise, three in space.
///
/// # Errors
/// Another number of components, numbers that are not finite.
pub(crate) fn angular(
    input: &str,
    given: &[f64],
    dimension: usize,
) -> Result<[f64; 3], InputError> {
    finite(input, given)?;
    match (dimension, given) {
        (2, &[omega]) => Ok([0.0, 0.0, omega]),
        (3, &[x, y, z]) => Ok([x, y, z]),
        _ => {
            let mend = match dimension {
                2 => "it needs 1 component, counter-clockwise",
                3 => "it needs 3 components",
                _ => "a body of 1 dimension cannot turn",
            };
            Err(InputError::new(input, format!("{given:?}"), mend))
        }
    }
}
