//! The part of a matrix that is not symmetric.
//!
//! Friction depends on the normal force, and the normal force does not depend on friction: N = P + S, with P symmetric and S skew.
//! P is factorized. Where contact is stiff, S is as large as P, and a step by P alone is not a Newton step. S has few rows, those of points
//! in friction, so that
//!
//! ```text
//! (I + S P^-1) z = f,   x = P^-1 z
//! ```
//!
//! is solved by GMRES over these rows alone (Y. Saad, M. H. Schultz, *GMRES: a generalized minimal residual algorithm for solving
//! nonsymmetric linear systems*, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869): the residual of z is that of x. P^-1 may be any
//! linear map that meets the constraints. Multipliers follow from z, too.

use crate::base::simd::add_multiple;
use crate::base::sparse::NodePattern;
use crate::base::vector::{dot, norm};
use crate::scene::constraint::ConstraintRow;

/// Directions at most; as many rows are solved exactly.
const MOST: usize = 60;

/// Fraction of two transposed entries below which their difference is round-off.
const ROUND_OFF: f64 = 1e-12;

/// S, and the directions of its iteration.
#[derive(Default)]
pub(crate) struct Skew {
    /// Degrees of freedom of the rows that are not 0, and for each degree of freedom its place among them.
    rows: Vec<usize>,
    places: Vec<usize>,
    /// Place of the row, column, value.
    entries: Vec<(usize, usize, f64)>,
    /// Orthonormal directions, one after the other, at the rows.
    directions: Vec<f64>,
    /// R of the least squares, column by column, its rotations and its right-hand side.
    triangle: Vec<f64>,
    rotations: Vec<[f64; 2]>,
    aim: Vec<f64>,
    /// f, and the demands, during an iteration.
    pub(crate) kept: [Vec<f64>; 3],
}

/// Place of a degree of freedom without entries, and of one that is prescribed.
const NONE: usize = usize::MAX;
const FIXED: usize = usize::MAX - 1;

impl Skew {
    /// Sets S to the skew part of the matrix on a `pattern` of blocks of this `dimension` whose entries `value` returns by block and
    /// place in the block.
    pub(crate) fn set(
        &mut self,
        (pattern, dimension): (&NodePattern, usize),
        constraints: &[ConstraintRow],
        value: impl Fn(usize, usize) -> f64,
    ) {
        let d = dimension;
        self.clear();
        let Self { rows, places, entries, .. } = self;
        places.clear();
        places.resize(pattern.nodes() * d, NONE);
        constraints
            .iter()
            .filter_map(ConstraintRow::nodal)
            .for_each(|(dof, _)| places[dof] = FIXED);
        let mut add = |row: usize, column: usize, value: f64| {
            if places[row] == NONE {
                places[row] = rows.len();
                rows.push(row);
            }
            if places[row] != FIXED {
                entries.push((places[row], column, value));
            }
        };
        for a in 0..pattern.nodes() {
            for (entry, b) in pattern.row(a).filter(|(_, b)| a <= *b) {
                let transposed = pattern.transposed(entry);
                for (i, j) in (0..d).flat_map(|i| (0..d).map(move |j| (i, j))) {
                    let (row, column) = (a * d + i, b * d + j);
                    let (own, across) = (value(entry, i * d + j), value(transposed, j * d + i));
                    let difference = own - across;
                    if row < column && difference.abs() > ROUND_OFF * (own.abs() + across.abs()) {
                        add(row, column, 0.5 * difference);
                        add(column, row, -0.5 * difference);
                    }
                }
            }
        }
    }

    /// Turns S into its transpose, -S.
    #[cfg(feature = "gradient")]
    pub(crate) fn transpose(&mut self) {
        self.entries.iter_mut().for_each(|(_, _, value)| *value = -*value);
    }

    /// Sets S to 0.
    pub(crate) fn clear(&mut self) {
        self.rows.clear();
        self.entries.clear();
    }

    /// Whether the matrix is symmetric.
    pub(crate) fn is_zero(&self) -> bool {
        self.entries.is_empty()
    }

    /// The number of directions that are enough.
    pub(crate) fn most(&self) -> usize {
        self.rows.len().min(MOST)
    }

    /// Norm of `f` without prescribed components.
    pub(crate) fn size(&self, f: &[f64]) -> f64 {
        let free = f.iter().zip(&self.places).filter(|(_, place)| **place != FIXED);
        free.map(|(f, _)| f * f).sum::<f64>().sqrt()
    }

    /// Begins where `x` = P^-1 f; returns the size of the residual.
    pub(crate) fn begin(&mut self, x: &[f64]) -> f64 {
        let (count, most) = (self.rows.len(), self.most());
        self.directions.resize((most + 1) * count, 0.0);
        self.triangle.resize(most * (most + 1), 0.0);
        self.aim.resize(most + 1, 0.0);
        self.rotations.clear();
        let first = &mut self.directions[..count];
        first.fill(0.0);
        self.entries.iter().for_each(|&(at, column, s)| first[at] -= s * x[column]);
        let size = norm(first);
        if size > 0.0 {
            first.iter_mut().for_each(|x| *x /= size);
        }
        self.aim[0] = size;
        size
    }

    /// Writes the direction of this `number` to `f`.
    pub(crate) fn write(&self, number: usize, f: &mut [f64]) {
        let direction = &self.directions[number * self.rows.len()..][..self.rows.len()];
        f.fill(0.0);
        self.rows.iter().zip(direction).for_each(|(&dof, x)| f[dof] = *x);
    }

    /// Adds a direction, `x` being P^-1 times the last one, of this `number`; returns the size of the residual that is left.
    pub(crate) fn extend(&mut self, number: usize, x: &[f64]) -> f64 {
        let (count, height) = (self.rows.len(), self.aim.len());
        let Self { entries, directions, triangle, rotations, aim, .. } = self;
        let (before, next) = directions.split_at_mut((number + 1) * count);
        let next = &mut next[..count];
        next.copy_from_slice(&before[number * count..]);
        entries.iter().for_each(|&(at, column, s)| next[at] += s * x[column]);
        let column = &mut triangle[number * height..][..height];
        column.fill(0.0);
        // twice is enough for directions that are orthogonal to round-off
        for _ in 0..2 {
            for (direction, h) in before.chunks_exact(count).zip(&mut *column) {
                let along = dot(direction, next);
                add_multiple(-along, direction, next);
                *h += along;
            }
        }
        let size = norm(next);
        if size > 0.0 {
            next.iter_mut().for_each(|x| *x /= size);
        }
        for (k, [c, s]) in rotations.iter().enumerate() {
            let [upper, lower] = [column[k], column[k + 1]];
            (column[k], column[k + 1]) = (c * upper + s * lower, c * lower - s * upper);
        }
        let radius = column[number].hypot(size);
        let [c, s] =
            if radius > 0.0 { [column[number] / radius, size / radius] } else { [1.0, 0.0] };
        rotations.push([c, s]);
        column[number] = radius;
        (aim[number], aim[number + 1]) = (c * aim[number], -s * aim[number]);
        aim[number + 1].abs()
    }

    /// Finds the components of z - f along each direction.
    pub(crate) fn finish(&mut self) {
        let height = self.aim.len();
        for k in (0..self.rotations.len()).rev() {
            let column = &self.triangle[k * height..][..=k];
            let share = if column[k] == 0.0 { 0.0 } else { self.aim[k] / column[k] };
            for (aim, r) in self.aim[..k].iter_mut().zip(column) {
                *aim -= share * r;
            }
            self.aim[k] = share;
        }
    }

    /// Adds `sign` times z - f.
    pub(crate) fn add(&self, sign: f64, f: &mut [f64]) {
        let directions = self.directions.chunks_exact(self.rows.len().max(1));
        for (direction, share) in directions.zip(&self.aim[..self.rotations.len()]) {
            for (&dof, x) in self.rows.iter().zip(direction) {
                f[dof] += sign * share * x;
            }
        }
    }
}
