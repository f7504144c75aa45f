//! Arcs and helices: curves that a screw motion of one point describes.

use nalgebra::{Rotation3, Unit, Vector3};

use super::nodes::{MOST_TURN, Nodes, across};
use crate::base::input::{InputError, finite};

/// The curve of a point that turns about an axis and moves along it in proportion.
#[derive(Debug, Clone)]
pub(super) struct Screw {
    pub(super) start: Vec<f64>,
    /// A point of the axis.
    pub(super) center: Vec<f64>,
    pub(super) axis: [f64; 3],
    /// Motion along the axis in a turn (m).
    pub(super) pitch: f64,
    /// Angle by which it turns (rad), right-handed.
    pub(super) angle: f64,
}

impl Screw {
    /// Nodes at equal distances; the directors are carried by the screw motion, so that strains are constant along the curve.
    pub(super) fn nodes(
        &self,
        elements: usize,
        normal: Option<[f64; 3]>,
    ) -> Result<Nodes, InputError> {
        let Self { start, center, axis, pitch, angle } = self;
        let dimension = start.len();
        if !(2..=3).contains(&dimension) || center.len() != dimension {
            let help =
                "start and center need two coordinates (m) each in the plane, three in space";
            return Err(InputError::new("start of the rod's path", format!("{start:?}"), help));
        }
        finite("start of the rod's path", start)?;
        finite("center of the rod's path", center)?;
        finite("axis of the rod's path", axis)?;
        finite("pitch and angle of the rod's path", &[*pitch, *angle])?;
        let wide = |x: &[f64]| Vector3::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0));
        let Some(axis) = Unit::try_new(Vector3::from(*axis), 0.0) else {
            let help =
                "it is the direction about which the path turns: give one of any length but 0";
            return Err(InputError::new("axis of the rod's path", format!("{axis:?}"), help));
        };
        let arm = wide(start) - wide(center);
        let along = axis.into_inner() * arm.dot(&axis);
        let (middle, radius) = (wide(center) + along, arm - along);
        if radius.norm() <= 1e-9 * arm.norm() || *angle == 0.0 {
            let help = "the path turns about its axis, and so it starts beside it and has an angle other than 0: give two points for a straight rod";
            return Err(InputError::new("angle of the rod's path", angle, help));
        }
        if elements == 0 || angle.abs() > MOST_TURN * elements as f64 {
            let fewest = (angle.abs() / MOST_TURN).ceil();
            let help =
                format!("each follows {MOST_TURN} rad of the path at most: it needs {fewest}");
            return Err(InputError::new("elements of the rod", elements, help));
        }
        let rise = pitch / std::f64::consts::TAU; // per radian
        let is_closed = rise == 0.0 && (angle.abs() - std::f64::consts::TAU).abs() < 1e-9;
        let tangent = (axis.cross(&radius) + axis.into_inner() * rise).normalize() * angle.signum();
        let first = match dimension {
            2 => Vector3::new(-tangent.y, tangent.x, 0.0),
            _ => across(&tangent, normal)?,
        };
        let at = |k: usize| {
            let turned = angle * (k as f64 / elements as f64);
            let turn = Rotation3::from_axis_angle(&axis, turned);
            let x = middle + turn * radius + axis.into_inner() * (rise * turned);
            (x, [turn * first, turn * tangent.cross(&first)])
        };
        let (x, d) = (0..elements + usize::from(!is_closed)).map(at).unzip();
        let length = angle.abs() * radius.norm().hypot(rise) / elements as f64;
        let curvature = radius.norm() / (radius.norm_squared() + rise * rise);
        Ok(Nodes { x, d, lengths: vec![length; elements], curvature, is_closed })
    }
}
