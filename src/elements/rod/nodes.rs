//! Nodes of a rod along its path, with the directors there.

use nalgebra::{Rotation3, Unit, Vector3};

use super::strain::Section;
use crate::base::input::{InputError, finite};

/// Most that a section turns against the one before it (rad), by the path or by a twist: beyond it the turn between them is another one.
pub(super) const MOST_TURN: f64 = 2.0;

/// The nodes of a rod.
pub(super) struct Nodes {
    /// Positions (m).
    pub(super) x: Vec<Vector3<f64>>,
    /// Directors d_1 and d_2.
    pub(super) d: Vec<[Vector3<f64>; 2]>,
    /// Lengths of the elements between them (m).
    pub(super) lengths: Vec<f64>,
    /// Curvature of a smooth path (1/m); 0 of a polygon.
    pub(super) curvature: f64,
    /// Whether the last node is followed by the first.
    pub(super) is_closed: bool,
}

impl Nodes {
    /// Distances of the nodes from the first along the path, and that of its end (m).
    pub(super) fn distances(&self) -> (Vec<f64>, f64) {
        let mut along = vec![0.0];
        along.extend(self.lengths.iter().scan(0.0, |sum, length| {
            *sum += length;
            Some(*sum)
        }));
        let end = along[along.len() - 1];
        along.truncate(self.x.len());
        (along, end)
    }

    /// The position and the directors of node `k` (from 0).
    pub(super) fn section(&self, k: usize) -> Section<f64> {
        Section { x: self.x[k].into(), d: self.d[k].map(Into::into) }
    }

    /// The same with directors that turn about the path, by the angle `twist` (rad) in all.
    ///
    /// # Errors
    /// A ring, in which directors meet again, with a twist other than whole turns; a twist in the plane; one that elements do not follow.
    pub(super) fn twisted(mut self, twist: f64, dimension: usize) -> Result<Self, InputError> {
        finite("twist of the rod", &[twist])?;
        let turns = twist / std::f64::consts::TAU;
        if twist == 0.0 {
            return Ok(self);
        }
        if dimension == 2 || self.is_closed && (turns - turns.round()).abs() > 1e-9 {
            let help = match dimension {
                2 => "in the plane no section turns about the path: leave it out",
                _ => "the sections at both ends of a ring are one: whole turns alone fit",
            };
            return Err(InputError::new("twist of the rod", twist, help));
        }
        let (along, length) = self.distances();
        let longest = self.lengths.iter().copied().fold(0.0, f64::max);
        let most = twist.abs() * longest / length; // of an element
        if most > MOST_TURN {
            let fewest = (self.lengths.len() as f64 * most / MOST_TURN).ceil();
            let help = format!(
                "each element follows {MOST_TURN} rad of it at most: twist less, or give {fewest} elements"
            );
            return Err(InputError::new("twist of the rod", twist, help));
        }
        for (d, s) in self.d.iter_mut().zip(along) {
            let tangent = Unit::new_normalize(d[0].cross(&d[1]));
            let turn = Rotation3::from_axis_angle(&tangent, twist * s / length);
            *d = d.map(|d| turn * d);
        }
        Ok(self)
    }
}

/// The unit vector across a path with that `tangent`, as near as it can be to `normal`, or else to the axis of space that is most across.
pub(super) fn across(
    tangent: &Vector3<f64>,
    normal: Option<[f64; 3]>,
) -> Result<Vector3<f64>, InputError> {
    let wanted = match normal {
        Some(normal) => {
            finite("normal of the rod", &normal)?;
            Vector3::from(normal)
        }
        // the later one of two
        None => {
            let axes = [Vector3::z(), Vector3::y(), Vector3::x()];
            let along = |axis: &Vector3<f64>| (tangent.dot(axis).abs() * 1e6).round();
            axes.into_iter().min_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or_else(Vector3::z)
        }
    };
    let across = wanted - tangent * tangent.dot(&wanted);
    match Unit::try_new(across, 1e-6 * wanted.norm()) {
        Some(across) => Ok(across.into_inner()),
        None => {
            let help = "it lies along the path at its first point: choose a direction across it";
            Err(InputError::new("normal of the rod", format!("{wanted:?}"), help))
        }
    }
}
