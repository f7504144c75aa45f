//! Plane motions, and motions that are their own mirror images, for which a body in the plane or half of the body would
//! suffice.

use std::collections::HashMap;

use crate::base::input::percent;
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::Body;
use crate::elements::mesh::{Mesh, mirrored};

/// Largest deviation of a motion from a plane one, and from its mirror image, for which the simpler body suffices.
const PLANE: f64 = 0.01;
const MIRRORED: f64 = 1e-3;
/// Nodes this near to each other, over the size of the mesh, are in the same place.
const SAME: f64 = 1e-6;
/// Motions relative to the mean that are smaller than this, over the size of the mesh, count as none.
const SEEN: f64 = 1e-9;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Deviation of the motion of a body in space from the nearest motion in a plane: displacements normal to the
/// plane, and the change of those along it in the normal direction, relative to the deformation and rotation
/// of the body.
pub(super) fn plane(body: &Body, samples: &[&Sample]) -> Option<Indicator> {
    if body.parts().any(|part| part.body.mesh().kind().dimension() != 3) {
        return None;
    }
    let scale = motion(body, samples)?;
    let across = (0..3).filter_map(|axis| Some((axis, across(body, samples, axis)? / scale)));
    let (axis, part) = across.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let said = format!(
        "the motion is {} off one in a plane across {} (limit: {})",
        off(part),
        AXES[axis],
        percent(PLANE)
    );
    let enough = || format!("{said}: a body in the plane would do (`plane` in `[solver]`)");
    Some(Indicator::needed("plane", (part, "1"), PLANE, || said.clone(), enough))
}

/// Deviation of the motion from its mirror images about those middle planes of the body that are planes of
/// symmetry of its mesh.
pub(super) fn mirrors(body: &Body, samples: &[&Sample]) -> Vec<Indicator> {
    let d = body.dimension();
    let can_be_halved = d > 1 && !body.is_axisymmetric();
    let Some(scale) = motion(body, samples).filter(|_| can_be_halved) else { return Vec::new() };
    let meshes = body.meshes();
    let images = (0..d).filter_map(|axis| Some((axis, mirrored(&meshes, axis)?.1)));
    let parts = images.map(|(axis, partner)| {
        let square = |sample: &&Sample| {
            let off = |dof: usize| {
                let sign = if dof % d == axis { -1.0 } else { 1.0 };
                let image = sign * sample.u[partner[dof / d] * d + dof % d];
                // from the mean of both
                (0.5 * (sample.u[dof] - image)).powi(2)
            };
            (0..sample.u.len()).map(off).sum::<f64>()
        };
        (axis, samples.iter().map(square).sum::<f64>().sqrt() / scale)
    });
    let indicator = |(axis, part): (usize, f64)| {
        let (name, across) = (["mirror-x", "mirror-y", "mirror-z"][axis], AXES[axis]);
        let said = format!(
            "the motion is asymmetric across {across} by {} (limit: {})",
            off(part),
            percent(MIRRORED)
        );
        let enough = || {
            format!(
                "{said}: half of the body would do (`half` in `[solver]`, or its middle held by `symmetry`)"
            )
        };
        Indicator::needed(name, (part, "1"), MIRRORED, || said.clone(), enough)
    };
    parts.map(indicator).collect()
}

/// The text for a relative distance from a motion.
fn off(part: f64) -> String {
    if part < 0.5 { percent(part) } else { "far".into() }
}

/// Root of the sum of squares (m) of all displacements from their mean over nodes, if there are any.
fn motion(body: &Body, samples: &[&Sample]) -> Option<f64> {
    let (d, count) = (body.dimension(), body.mesh().node_count());
    let square = |sample: &&Sample| {
        let along = |i: usize| sample.u.iter().skip(i).step_by(d);
        let mean = |i: usize| along(i).sum::<f64>() / count as f64;
        (0..d).map(|i| along(i).map(|u| (u - mean(i)).powi(2)).sum::<f64>()).sum::<f64>()
    };
    let sum = samples.iter().map(square).sum::<f64>().sqrt();
    let least = SEEN * body.mesh().size() * ((count * samples.len()) as f64).sqrt();
    (sum > least).then_some(sum)
}

/// Root of the sum of squares (m) of the part that is not a motion in the plane normal to an axis; unknown if
/// the nodes of the mesh do not lie one behind the other along the axis.
fn across(body: &Body, samples: &[&Sample], axis: usize) -> Option<f64> {
    let mesh = body.mesh();
    let mut rows: HashMap<RoundedPosition, Vec<usize>> = HashMap::new();
    for node in 0..mesh.node_count() {
        let mut place = mesh.position(node).to_vec();
        place[axis] = 0.0;
        rows.entry(rounded(mesh, &place)).or_default().push(node);
    }
    if rows.values().any(|row| row.len() < 2) {
        return None;
    }
    let square = |sample: &&Sample| {
        let of_row = |row: &Vec<usize>| {
            let component = |i: usize| {
                let u = || row.iter().map(|node| sample.u[3 * node + i]);
                let mean = if i == axis { 0.0 } else { u().sum::<f64>() / row.len() as f64 };
                u().map(|u| (u - mean).powi(2)).sum::<f64>()
            };
            (0..3).map(component).sum::<f64>()
        };
        rows.values().map(of_row).sum::<f64>()
    };
    Some(samples.iter().map(square).sum::<f64>().sqrt())
}

type RoundedPosition = [i64; 3];

/// A place, rounded to steps within which places count as the same.
fn rounded(mesh: &Mesh, x: &[f64]) -> RoundedPosition {
    let step = SAME * mesh.size();
    // with an offset, as round numbers may lie in the middle between two steps
    let number = |i: usize| x.get(i).map_or(0, |x| (x / step + 0.123).round() as i64);
    std::array::from_fn(number)
}
