//! The distance of a touch beside the bodies that feel it.

use std::fmt;

use super::force::TouchForce;
use super::spec::Touch;
use crate::base::input::four_digits;
use crate::elements::body::Body;
use crate::scene::forces::thickness;

/// The distance of a [`Touch`], given or by default, and the thinnest of its bodies.
///
/// Shown as `fingers: within 1.8e-3 m by default, 0.15 of the thickness of "finger"`.
#[derive(Debug, Clone, PartialEq)]
pub struct TouchDistance {
    /// Name of the touch.
    pub touch: String,
    /// The distance (m) beyond which there is no force.
    pub distance: f64,
    /// Whether it is the default.
    pub is_default: bool,
    /// Name and thickness (m), 2 V/A, of the thinnest of its bodies; none of strings and membranes.
    pub thinnest: Option<(String, f64)>,
}

impl TouchDistance {
    pub(crate) fn new(touch: &Touch, force: &TouchForce, body: &Body) -> Self {
        let own = body.parts().filter(|part| touch.is_of(part.name));
        let thicknesses =
            own.filter_map(|part| Some((part.name.to_owned(), thickness(part.body)?)));
        Self {
            touch: touch.name().to_owned(),
            distance: force.distance(),
            is_default: touch.has_default_distance(),
            thinnest: thicknesses.min_by(|(_, a), (_, b)| a.total_cmp(b)),
        }
    }
}

impl fmt::Display for TouchDistance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let by_default = if self.is_default { " by default" } else { "" };
        write!(f, "{}: within {:.2e} m{by_default}", self.touch, self.distance)?;
        match &self.thinnest {
            Some((name, thickness)) => {
                let part = four_digits(self.distance / thickness);
                write!(f, ", {part} of the thickness of \"{name}\"")
            }
            None => Ok(()),
        }
    }
}
