//! Shape functions of faces by their kind.

use super::{
    Quadrilateral, Quadrilateral8, Quadrilateral9, ReferenceCell, Segment, Segment3, Triangle,
    Triangle6, Triangle7,
};
use crate::elements::mesh::FaceKind;

/// Nodes of a face at most.
pub(crate) const MOST_NODES: usize = 9;

/// Calls a function that is generic over the reference cell of a face, its number of nodes and its dimension.
macro_rules! with_face {
    ($kind:expr, $function:ident ( $($argument:expr),* ), $of_point:expr) => {
        match $kind {
            FaceKind::Point => $of_point,
            FaceKind::Segment => $function::<Segment, 2, 1>($($argument),*),
            FaceKind::Segment3 => $function::<Segment3, 3, 1>($($argument),*),
            FaceKind::Triangle => $function::<Triangle, 3, 2>($($argument),*),
            FaceKind::Triangle6 => $function::<Triangle6, 6, 2>($($argument),*),
            FaceKind::Triangle7 => $function::<Triangle7, 7, 2>($($argument),*),
            FaceKind::Quadrilateral => $function::<Quadrilateral, 4, 2>($($argument),*),
            FaceKind::Quadrilateral8 => $function::<Quadrilateral8, 8, 2>($($argument),*),
            FaceKind::Quadrilateral9 => $function::<Quadrilateral9, 9, 2>($($argument),*),
        }
    };
}

/// A point of a reference face; entries beyond the nodes and coordinates of the face are 0.
#[derive(Debug, Clone)]
pub(crate) struct FacePoint {
    /// The shape functions N_a.
    pub(crate) values: [f64; MOST_NODES],
    /// Their derivatives by the reference coordinates.
    pub(crate) derivatives: [[f64; 2]; MOST_NODES],
    /// Its weight in a quadrature rule.
    pub(crate) weight: f64,
}

impl FacePoint {
    /// The point with the reference coordinates `xi` on a face of a kind.
    pub(crate) fn new(kind: FaceKind, xi: [f64; 2], weight: f64) -> Self {
        with_face!(
            kind,
            point_at(xi, weight),
            Self {
                values: std::array::from_fn(|a| if a == 0 { 1.0 } else { 0.0 }),
                derivatives: [[0.0; 2]; MOST_NODES],
                weight,
            }
        )
    }

    /// Derivatives of the position by the reference coordinates.
    pub(crate) fn tangents(&self, x: &[[f64; 3]]) -> [[f64; 3]; 2] {
        let mut tangents = [[0.0; 3]; 2];
        for (x, derivatives) in x.iter().zip(&self.derivatives) {
            for (tangent, derivative) in tangents.iter_mut().zip(derivatives) {
                tangent.iter_mut().zip(x).for_each(|(sum, x)| *sum += derivative * x);
            }
        }
        tangents
    }
}

/// A point of a face of a kind with its nodes at `at`, and the derivatives of its position by the reference coordinates.
pub(crate) fn position(kind: FaceKind, at: &[[f64; 3]], xi: [f64; 2]) -> [[f64; 3]; 3] {
    with_face!(kind, position_of(at, xi), [at[0], [0.0; 3], [0.0; 3]])
}

/// Second derivatives of the shape functions by the reference coordinates, N_a,11, N_a,22 and N_a,12: differences of
/// the first ones, which are quadratic in each coordinate at most, so that these are exact.
pub(crate) fn second_derivatives(kind: FaceKind, xi: [f64; 2]) -> [[f64; 3]; MOST_NODES] {
    let none = [[0.0; 3]; MOST_NODES];
    if is_affine(kind) { none } else { with_face!(kind, seconds_of(xi), none) }
}

/// Whether the position is a linear function of the reference coordinates on every face of a kind.
pub(crate) fn is_affine(kind: FaceKind) -> bool {
    matches!(kind, FaceKind::Point | FaceKind::Segment | FaceKind::Triangle)
}

/// The reference coordinates of a node of a face.
pub(crate) fn reference_node(kind: FaceKind, node: usize) -> [f64; 2] {
    with_face!(kind, node_of(node), [0.0; 2])
}

/// The most that the sizes of the shape functions add up to at a point of the face (Lebesgue's constant), or a little
/// more: no point moves farther than this times its nodes.
pub(crate) fn reach(kind: FaceKind) -> f64 {
    match kind {
        FaceKind::Point | FaceKind::Segment | FaceKind::Triangle | FaceKind::Quadrilateral => 1.0,
        FaceKind::Segment3 => 1.25,
        FaceKind::Triangle6 => 1.67,
        FaceKind::Triangle7 => 1.46,
        FaceKind::Quadrilateral8 => 3.0,
        FaceKind::Quadrilateral9 => 1.5625,
    }
}

/// Points (Bezier's control points) in whose convex hull a face of a kind lies, with its nodes `at` these positions, and
/// their number: its corners, those of its edges from the mid-side nodes, and one more inside.
pub(crate) fn control_points(kind: FaceKind, at: &[[f64; 3]]) -> ([[f64; 3]; MOST_NODES], usize) {
    let mut points = [[0.0; 3]; MOST_NODES];
    points[..at.len()].copy_from_slice(at);
    for edge in kind.edges() {
        if let &[a, b, middle] = *edge {
            points[middle] =
                std::array::from_fn(|i| 2.0 * at[middle][i] - 0.5 * (at[a][i] + at[b][i]));
        }
    }
    let sum = |of: &[[f64; 3]], i: usize| of.iter().map(|x| x[i]).sum::<f64>();
    let inside: fn(f64, f64, f64) -> f64 = match kind {
        FaceKind::Segment3 => {
            let [a, b, middle] = [at[0], at[1], at[2]];
            points[2] = std::array::from_fn(|i| 2.0 * middle[i] - 0.5 * (a[i] + b[i]));
            return (points, 3);
        }
        // the coefficient of 6 times the product of the three coordinates, from which the bubble adds 27 times its part
        FaceKind::Triangle7 => {
            let sums = |i: usize| [sum(&at[..3], i), sum(&at[3..6], i)];
            points[6] = std::array::from_fn(|i| {
                let [corners, mids] = sums(i);
                let bubble = at[6][i] + corners / 9.0 - 4.0 / 9.0 * mids;
                sum(&points[3..6], i) / 3.0 + 4.5 * bubble
            });
            return (points, 7);
        }
        FaceKind::Quadrilateral8 => |corners, mids, _| mids - 0.75 * corners,
        FaceKind::Quadrilateral9 => |corners, mids, centre| 4.0 * centre - mids + 0.25 * corners,
        _ => return (points, at.len()),
    };
    points[8] = std::array::from_fn(|i| {
        let centre = at.get(8).map_or(0.0, |x| x[i]);
        inside(sum(&at[..4], i), sum(&at[4..8], i), centre)
    });
    (points, 9)
}

fn point_at<C: ReferenceCell<N, M>, const N: usize, const M: usize>(
    xi: [f64; 2],
    weight: f64,
) -> FacePoint {
    let xi: [f64; M] = std::array::from_fn(|k| xi[k]);
    let (mut values, mut derivatives) = ([0.0; MOST_NODES], [[0.0; 2]; MOST_NODES]);
    values[..N].copy_from_slice(&C::values(xi));
    for (to, from) in derivatives.iter_mut().zip(C::derivatives(xi)) {
        to[..M].copy_from_slice(&from);
    }
    FacePoint { values, derivatives, weight }
}

fn position_of<C: ReferenceCell<N, M>, const N: usize, const M: usize>(
    at: &[[f64; 3]],
    xi: [f64; 2],
) -> [[f64; 3]; 3] {
    let xi: [f64; M] = std::array::from_fn(|k| xi[k]);
    let mut sums = [[0.0; 3]; 3];
    for ((x, value), derivatives) in at.iter().zip(C::values(xi)).zip(C::derivatives(xi)) {
        let [position, tangents @ ..] = &mut sums;
        (0..3).for_each(|i| position[i] += value * x[i]);
        for (tangent, derivative) in tangents.iter_mut().zip(derivatives) {
            (0..3).for_each(|i| tangent[i] += derivative * x[i]);
        }
    }
    sums
}

fn seconds_of<C: ReferenceCell<N, M>, const N: usize, const M: usize>(
    xi: [f64; 2],
) -> [[f64; 3]; MOST_NODES] {
    let xi: [f64; M] = std::array::from_fn(|k| xi[k]);
    let difference_along = |axis: usize| {
        let moved = |by: f64| {
            C::derivatives(std::array::from_fn(|k| if k == axis { xi[k] + by } else { xi[k] }))
        };
        let (ahead, behind) = (moved(0.5), moved(-0.5));
        std::array::from_fn::<[f64; M], N, _>(|a| {
            std::array::from_fn(|k| ahead[a][k] - behind[a][k])
        })
    };
    let mut seconds = [[0.0; 3]; MOST_NODES];
    let along = difference_along(0);
    seconds.iter_mut().zip(along).for_each(|(second, along)| second[0] = along[0]);
    if M == 2 {
        let across = difference_along(1);
        let seconds = seconds.iter_mut().zip(across);
        seconds.for_each(|(second, across)| (second[1], second[2]) = (across[1], across[0]));
    }
    seconds
}

fn node_of<C: ReferenceCell<N, M>, const N: usize, const M: usize>(node: usize) -> [f64; 2] {
    padded(C::NODES[node])
}

/// The quadrature points of all faces of a kind. They integrate the normal times a shape function exactly.
pub(crate) fn face_points(kind: FaceKind) -> Vec<FacePoint> {
    with_face!(kind, mass_points(), vec![FacePoint::new(kind, [0.0; 2], 1.0)])
}

fn mass_points<C: ReferenceCell<N, M>, const N: usize, const M: usize>() -> Vec<FacePoint> {
    C::MASS_RULE.iter().map(|&(xi, weight)| point_at::<C, N, M>(padded(xi), weight)).collect()
}

fn padded<const M: usize>(xi: [f64; M]) -> [f64; 2] {
    std::array::from_fn(|k| xi.get(k).copied().unwrap_or(0.0))
}
