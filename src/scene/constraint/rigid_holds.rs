//! Rows on a rigid piece that follow from others for small motions alone.
//!
//! With two of its nodes held along the line through both, a piece cannot turn, though it may for small motions: the length
//! between them changes by the square of the angle. No equations of motion have such a constraint, and the row, or an edge of
//! the piece, would be left out of them as if it were implied. Where what follows for small motions follows for large
//! ones, too, as between two nodes of an axis, nothing is lost.
//!
//! Two nodes that are held, or moved alike, along the line through both keep its direction, so that rows of that direction take the
//! place of the second one ([`with_directions`]). Other rows that are lost are refused.

use std::ptr;

use nalgebra::{DMatrix, DVector, Rotation3, Vector3};

use super::row::{ConstraintRow, NOTHING_NEW, RowMotion, independent_terms};
use super::start::PhaseStart;
use crate::base::input::InputError;
use crate::base::vector::{dot, norm};
use crate::elements::body::{Body, RigidPieces};

/// Terms of a row: the node, the component and the coefficient of each.
type Terms = Vec<(usize, usize, f64)>;

/// The motions that are tried, in radians and in parts of the size of a piece.
const TRIED: f64 = 0.1;
/// Largest change of an implied row in them, in parts of the size: an implied row is off by round-off, another one by about half
/// of the square of the motion, 5e-3.
const IMPLIED: f64 = 1e-6;
/// Rounds of the search for a motion that the other rows allow. Each leaves a tenth or so.
const ROUNDS: usize = 30;

/// Part of the distance of two nodes by which the line through both may be off the axis along which they are held.
const ALIGNED: f64 = 1e-5;

/// The rows with those of the direction of a line in the place of rows along it that are lost otherwise: two nodes of a rigid piece at a
/// distance r along n, held along n or moved alike, keep the components of r across n.
pub(super) fn with_directions(
    mut rows: Vec<ConstraintRow>,
    body: &Body,
    pieces: &RigidPieces,
    start: &PhaseStart,
) -> Vec<ConstraintRow> {
    for frame in pieces.frames() {
        loop {
            let piece = Piece::new(frame, &rows, (body, pieces), start.u);
            let lost = piece.lost_row().and_then(|(row, _)| {
                let own = rows.iter().position(|other| ptr::eq(other, row))?;
                let of_piece = piece.rows.iter().map(|(other, _)| *other);
                Some((own, directions(row, of_piece, body, start)?))
            });
            let Some((own, directions)) = lost else { break };
            rows.splice(own..=own, directions);
        }
    }
    rows
}

/// The rows of the direction of the line from the node of another one of the rows of a piece to that of `row`, which is along both; `None`
/// if there is no such row.
fn directions<'a>(
    row: &ConstraintRow,
    mut of_piece: impl Iterator<Item = &'a ConstraintRow>,
    body: &Body,
    start: &PhaseStart,
) -> Option<Vec<ConstraintRow>> {
    let d = body.dimension();
    let along = |row: &ConstraintRow| {
        let mut along = Vector3::zeros();
        row.terms.iter().for_each(|(dof, c)| along[dof % d] = *c);
        along.normalize()
    };
    let (node, own) = (row.node(d)?, along(row));
    let other = of_piece.find_map(|other| {
        let from = other.node(d).filter(|from| *from != node)?;
        let arm = place(body, start.u, node) - place(body, start.u, from);
        let is_along = |n: &Vector3<f64>| arm.cross(n).norm() < ALIGNED * arm.norm();
        (is_along(&own) && is_along(&along(other)) && other.motion.is_same(&row.motion))
            .then_some(from)
    })?;
    // the axes that are most across it, less their parts along it
    let mut axes: Vec<usize> = (0..d).collect();
    axes.sort_by(|a, b| own[*a].abs().total_cmp(&own[*b].abs()));
    let across = axes[..d - 1].iter().map(|&axis| {
        let unit = Vector3::from_fn(|i, _| if i == axis { 1.0 } else { 0.0 });
        let across = unit - own * own[axis];
        let of_node = |node: usize, sign: f64| {
            let components = (0..d).filter(move |&i| across[i] != 0.0);
            components.map(move |i| (node * d + i, sign * across[i]))
        };
        let mut terms: Vec<_> = of_node(node, 1.0).chain(of_node(other, -1.0)).collect();
        terms.sort_unstable_by_key(|(dof, _)| *dof);
        let at = terms.iter().map(|(dof, c)| c * start.u[*dof]).sum();
        let motion = RowMotion::Linear { start: at, since: start.time, velocity: 0.0 };
        ConstraintRow { terms, motion, is_of_rigid: true }
    });
    Some(across.collect())
}

/// # Errors
/// Rows on one rigid piece that others imply for small motions, and not for large ones.
pub(crate) fn check_rigid_holds(
    rows: &[ConstraintRow],
    body: &Body,
    phase: &str,
    start: &PhaseStart,
) -> Result<(), InputError> {
    let Some(pieces) = body.rigid_pieces() else { return Ok(()) };
    for frame in pieces.frames() {
        let piece = Piece::new(frame, rows, (body, pieces), start.u);
        let Some((row, change)) = piece.lost_row() else { continue };
        let label = row.label(body.dimension());
        let input = format!("constraint on {label} in phase \"{phase}\"");
        let help = format!(
            "for small motions the other constraints of its rigid piece and the shape of the piece imply it, for large ones they do not: \
             a motion that they allow by a tenth of the size of the piece moves {label} by {change:.1e} m. Leave it out, or \
             constrain nodes that are apart across the direction in which they are held, or hold the piece wholly"
        );
        return Err(InputError::new(input, row.motion.label(), help));
    }
    Ok(())
}

/// Of each rigid piece, whether its `rows` leave it no motion at the displacements `u` (m).
pub(crate) fn held_pieces(
    rows: &[ConstraintRow],
    (body, pieces): (&Body, &RigidPieces),
    u: &[f64],
) -> Vec<bool> {
    let is_held = |frame: &Vec<usize>| {
        let piece = Piece::new(frame, rows, (body, pieces), u);
        let (count, all) = (piece.freedoms(), piece.derivatives());
        all.len() >= count
            && DMatrix::from_fn(all.len(), count, |i, k| all[i][k]).rank(NOTHING_NEW) == count
    };
    pieces.frames().iter().map(is_held).collect()
}

/// Position of a node under the displacements `u` (m); 0 beyond the dimension.
fn place(body: &Body, u: &[f64], node: usize) -> Vector3<f64> {
    let (d, x) = (body.dimension(), body.mesh().position(node));
    Vector3::from_fn(|i, _| if i < d { x[i] + u[node * d + i] } else { 0.0 })
}

/// A rigid piece with the rows on it alone.
struct Piece<'a> {
    dimension: usize,
    /// Positions of its frame from their mean (m), and its size (m).
    arms: Vec<Vector3<f64>>,
    size: f64,
    /// Each row with its terms: node of the frame, axis and coefficient.
    rows: Vec<(&'a ConstraintRow, Terms)>,
}

impl<'a> Piece<'a> {
    fn new(
        frame: &[usize],
        rows: &'a [ConstraintRow],
        (body, pieces): (&Body, &RigidPieces),
        u: &[f64],
    ) -> Self {
        let d = body.dimension();
        let mut arms: Vec<Vector3<f64>> = frame.iter().map(|&node| place(body, u, node)).collect();
        let mean = arms.iter().sum::<Vector3<f64>>() / arms.len() as f64;
        arms.iter_mut().for_each(|arm| *arm -= mean);
        let size = arms.iter().map(Vector3::norm).fold(0.0, f64::max);
        let own = |row: &'a ConstraintRow| {
            let terms = independent_terms(&row.terms, Some(pieces), d).into_iter();
            let term = |(dof, c): (usize, f64)| {
                Some((frame.iter().position(|&node| node == dof / d)?, dof % d, c))
            };
            Some((row, terms.map(term).collect::<Option<Vec<_>>>()?))
        };
        Self { dimension: d, arms, size, rows: rows.iter().filter_map(own).collect() }
    }

    /// Number of unknowns of a rigid motion, its displacements in parts of the size and its angles: 3 in the plane, 6 in space.
    fn freedoms(&self) -> usize {
        self.dimension + self.dimension * (self.dimension - 1) / 2
    }

    /// Displacements (m) of the frame in a rigid motion.
    fn moved(&self, motion: &DVector<f64>) -> Vec<Vector3<f64>> {
        let d = self.dimension;
        let shift = Vector3::from_fn(|i, _| if i < d { self.size * motion[i] } else { 0.0 });
        let turn = match d {
            3 => Vector3::new(motion[3], motion[4], motion[5]),
            2 => Vector3::new(0.0, 0.0, motion[2]),
            _ => Vector3::zeros(),
        };
        let rotation = Rotation3::new(turn);
        self.arms.iter().map(|arm| rotation * arm - arm + shift).collect()
    }

    /// Change of each row (m) in a rigid motion.
    fn changes(&self, motion: &DVector<f64>) -> Vec<f64> {
        let moved = self.moved(motion);
        let change = |(_, terms): &(&ConstraintRow, Terms)| {
            terms.iter().map(|&(node, axis, c)| c * moved[node][axis]).sum()
        };
        self.rows.iter().map(change).collect()
    }

    /// The derivatives of the rows by the rigid motion, in the size, one column per row.
    fn derivatives(&self) -> Vec<Vec<f64>> {
        let count = self.freedoms();
        let small = 1e-7;
        let columns: Vec<Vec<f64>> = (0..count)
            .map(|k| {
                let along = |by: f64| {
                    self.changes(&DVector::from_fn(count, |i, _| if i == k { by } else { 0.0 }))
                };
                let pairs = along(small).into_iter().zip(along(-small));
                pairs.map(|(up, down)| (up - down) / (2.0 * small * self.size)).collect()
            })
            .collect();
        (0..self.rows.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
    }

    /// The first row that others imply for small motions and not for large ones, with what it changes by (m).
    fn lost_row(&self) -> Option<(&'a ConstraintRow, f64)> {
        if self.rows.len() < 2 {
            return None;
        }
        let (count, all) = (self.freedoms(), self.derivatives());
        let (mut kept, mut implied): (Vec<usize>, Vec<usize>) = Default::default();
        let mut known: Vec<Vec<f64>> = Vec::new();
        for (number, row) in all.iter().enumerate() {
            let mut rest = row.clone();
            for _ in 0..2 {
                for direction in &known {
                    let part = dot(direction, &rest);
                    rest.iter_mut().zip(direction).for_each(|(x, e)| *x -= part * e);
                }
            }
            let left = norm(&rest);
            if left > NOTHING_NEW * norm(row) {
                known.push(rest.into_iter().map(|x| x / left).collect());
                kept.push(number);
            } else {
                implied.push(number);
            }
        }
        if implied.is_empty() || known.len() == count {
            return None;
        }
        let held = DMatrix::from_fn(kept.len(), count, |i, k| all[kept[i]][k]);
        let inverse = held.pseudo_inverse(f64::EPSILON).ok()?;
        // motions that are left: those across the directions that are known
        let known = DMatrix::from_fn(known.len(), count, |i, k| known[i][k]);
        let left = (known.transpose() * known).symmetric_eigen();
        let free: Vec<DVector<f64>> = (0..count)
            .filter(|&k| left.eigenvalues[k] < 0.5)
            .map(|k| left.eigenvectors.column(k).into_owned())
            .collect();
        let pairs = (0..free.len()).flat_map(|a| (0..=a).map(move |b| (a, b)));
        let mut worst = (None, 0.0);
        for (a, b) in pairs {
            let mut motion = (&free[a] + &free[b]).normalize() * TRIED;
            for _ in 0..ROUNDS {
                let changes = self.changes(&motion);
                let off = DVector::from_fn(kept.len(), |i, _| changes[kept[i]] / self.size);
                motion -= &inverse * off;
            }
            let changes = self.changes(&motion);
            if kept.iter().any(|&row| changes[row].abs() > IMPLIED * self.size) {
                // no such motion was found
                continue;
            }
            for &row in &implied {
                if changes[row].abs() > f64::max(worst.1, IMPLIED * self.size) {
                    worst = (Some(self.rows[row].0), changes[row].abs());
                }
            }
        }
        Some((worst.0?, worst.1))
    }
}
