//! Amounts of gas and liquids, and states of actuators that lag, in the Newton system, eliminated, and with them the flows of pipes.
//!
//! With the volumes V(u) of the chambers, their gradients G = dV/du (a column each), the pressures p(m, V) and the flows
//! q(t, m, V), a step of the parameter gamma has, beside the system of `system/newton.rs`,
//!
//! ```text
//! (I - gamma Qm) xm - gamma Qv w = rm,       w = G^T xu
//! ... - gamma G (Pm xm - Pv w) = ...         Pv = -dp/dV, Pm = dp/dm, Qm = dq/dm, Qv = dq/dV
//! ```
//!
//! where xm has the changes of all unknowns of the flow, those of pipes behind the amounts, and Pm a column of 0 for each pipe; so that, with S = (I - gamma Qm)^-1 and C = Pv - gamma Pm S Qv,
//!
//! ```text
//! xm = S (rm + gamma Qv w)
//! (N + gamma^2 G C G^T) xv - A mu = ... - gamma G C G^T ru + gamma G Pm S rm
//! ```
//!
//! The pressure on one wall depends on where all others are: G C G^T is full over the nodes of all walls, and of the
//! rank of the number of chambers. It stays out of the pattern. With H = G^T N^-1 G, N^-1 being the solve that meets the
//! constraints (Woodbury's identity), the pressures s = gamma^2 C (I + gamma^2 H C)^-1 G^T N^-1 r resist, and
//! N xv - A mu = r - G s.
//!
//! That takes one solve for each chamber with a new factor, and one more in each iteration. (The latter could
//! be a sum over columns of N^-1 G; then multipliers and edges of rigid pieces would have to be corrected,
//! too.) It is never slower than the full pattern (`docs/notes/costs.md`). The states of actuators have C =
//! 0, so that S alone eliminates them.

use crate::base::simd::add_multiple;
use crate::base::vector::dot;
use crate::elements::force::FlowDerivatives;

/// Contribution of gas, liquids, lag states and pipe flows to the Newton system; matrices row by row.
pub(crate) struct FlowMatrix {
    /// Rooms, and unknowns: the amounts in them, and flows of pipes.
    pub(crate) rooms: usize,
    unknowns: usize,
    pub(crate) derivatives: FlowDerivatives,
    /// S, and its product with gamma Qv.
    response: Vec<f64>,
    following: Vec<f64>,
    /// C, and gamma^2 C (I + gamma^2 H C)^-1.
    stiffness: Vec<f64>,
    resistance: Vec<f64>,
    /// H.
    pub(crate) compliance: Vec<f64>,
    work: Vec<f64>,
    /// Changes of the volumes, and of the quantities that follow from them.
    volumes: Vec<f64>,
    changes: Vec<f64>,
    /// A column of N^-1 G.
    pub(crate) column: Vec<f64>,
}

impl FlowMatrix {
    /// For so many reservoirs and unknowns of a body with `dofs` displacement components.
    pub(crate) fn new([rooms, unknowns]: [usize; 2], dofs: usize) -> Self {
        let square = vec![0.0; rooms * rooms];
        Self {
            rooms,
            unknowns,
            derivatives: FlowDerivatives::zeros([rooms, unknowns], dofs),
            response: vec![0.0; unknowns * unknowns],
            following: vec![0.0; unknowns * rooms],
            stiffness: square.clone(),
            resistance: square.clone(),
            compliance: square,
            work: vec![0.0; unknowns * unknowns],
            volumes: vec![0.0; rooms],
            changes: vec![0.0; unknowns],
            column: vec![0.0; dofs],
        }
    }

    /// Sets S, S gamma Qv and C for a step of the parameter `gamma`.
    pub(crate) fn condense(&mut self, gamma: f64) {
        let Self { rooms, unknowns, derivatives, response, following, stiffness, work, .. } = self;
        let (k, n) = (*rooms, *unknowns);
        let FlowDerivatives { pressures: [stiff, pressing], rates, .. } = &*derivatives;
        let [by_volumes, by_amounts] = rates;
        for (at, x) in work.iter_mut().enumerate() {
            *x = unit(at, n) - gamma * by_amounts[at];
        }
        invert(work, response, n);
        multiply(response, by_volumes, following, [n, k]);
        following.iter_mut().for_each(|x| *x *= gamma);
        for (at, x) in stiffness.iter_mut().enumerate() {
            let row = at / k;
            *x = unit(at, k) * stiff[row] - pressing[row] * following[at];
        }
    }

    /// Whether that reservoir has a stiffness: a column of H is needed only where C has one.
    pub(crate) fn is_stiff(&self, room: usize) -> bool {
        self.stiffness.chunks(self.rooms).any(|row| row[room] != 0.0)
    }

    /// The rows of C.
    pub(crate) fn stiffness(&self) -> impl Iterator<Item = &[f64]> {
        self.stiffness.chunks(self.rooms)
    }

    /// Sets gamma^2 C (I + gamma^2 H C)^-1.
    pub(crate) fn resist_by(&mut self, gamma: f64) {
        let Self { rooms, stiffness, resistance, compliance, work, .. } = self;
        let (k, square) = (*rooms, gamma * gamma);
        let work = &mut work[..k * k];
        multiply(compliance, stiffness, work, [k, k]);
        for (at, x) in work.iter_mut().enumerate() {
            *x = unit(at, k) + square * *x;
        }
        invert(work, resistance, k);
        multiply(stiffness, resistance, work, [k, k]);
        resistance.iter_mut().zip(&*work).for_each(|(x, product)| *x = square * product);
    }

    /// Takes from the right-hand side the pressures that resist its solution `xv` without them.
    pub(crate) fn resist(&mut self, xv: &[f64], right: &mut [f64]) {
        self.swell(xv);
        let Self { derivatives, resistance, volumes, changes, .. } = self;
        apply(resistance, volumes, changes);
        push(derivatives, changes, -1.0, right);
    }

    /// Adds gamma G Pm S rm - gamma G C G^T ru to the right-hand side, of the residuals `ru` and `amounts`.
    pub(crate) fn add_residuals(
        &mut self,
        gamma: f64,
        ru: &[f64],
        amounts: &[f64],
        right: &mut [f64],
    ) {
        self.swell(ru);
        let Self { derivatives, response, stiffness, volumes, changes, .. } = self;
        apply(stiffness, volumes, changes);
        push(derivatives, changes, -gamma, right);
        apply(response, amounts, changes);
        let [_, pressing] = &derivatives.pressures;
        changes.iter_mut().zip(pressing).for_each(|(x, p)| *x *= p);
        push(derivatives, changes, gamma, right);
    }

    /// Turns the residuals `x` of the unknowns of the flow into their changes, by those of the displacements, `xu`. Returns the changes
    /// of the power (W) that becomes heat and of that which is supplied with them.
    pub(crate) fn solve(&mut self, xu: &[f64], x: &mut [f64]) -> [f64; 2] {
        self.swell(xu);
        let Self { derivatives, response, following, volumes, changes, .. } = self;
        apply(response, x, changes);
        x.copy_from_slice(changes);
        apply(following, volumes, changes);
        x.iter_mut().zip(&*changes).for_each(|(x, follows)| *x += follows);
        let [by_volumes, by_amounts] = &derivatives.power;
        [dot(&derivatives.heat, x), dot(by_volumes, volumes) + dot(by_amounts, x)]
    }

    /// Adds G Pv G^T `x`: the forces (N) of amounts that stay against the displacements `x` (m).
    pub(crate) fn add_stiffness(&self, x: &[f64], forces: &mut [f64]) {
        let FlowDerivatives { gradients, pressures: [stiff, _], .. } = &self.derivatives;
        for (gradient, stiff) in gradients.chunks(x.len()).zip(stiff) {
            add_multiple(stiff * dot(gradient, x), gradient, forces);
        }
    }

    /// Changes of the pressures (Pa) of the reservoirs, after those of the unknowns of the flow were [solved](Self::solve) for, `x`.
    pub(crate) fn pressure_changes(&self, x: &[f64]) -> impl Iterator<Item = f64> {
        let [stiff, pressing] = &self.derivatives.pressures;
        let by_volumes = stiff.iter().zip(&self.volumes).map(|(stiff, volume)| stiff * volume);
        let by_amounts = pressing.iter().zip(x).map(|(pressing, x)| pressing * x);
        by_amounts.zip(by_volumes).map(|(more, less)| more - less)
    }

    /// Sets `volumes` to G^T x.
    fn swell(&mut self, x: &[f64]) {
        let gradients = self.derivatives.gradients.chunks(x.len());
        self.volumes.iter_mut().zip(gradients).for_each(|(v, gradient)| *v = dot(gradient, x));
    }
}

/// Adds `factor` times G s.
fn push(derivatives: &FlowDerivatives, s: &[f64], factor: f64, right: &mut [f64]) {
    for (gradient, s) in derivatives.gradients.chunks(right.len()).zip(s) {
        right.iter_mut().zip(gradient).for_each(|(right, g)| *right += factor * s * g);
    }
}

/// Entry of the unit matrix of size `k` at that place.
fn unit(at: usize, k: usize) -> f64 {
    if at / k == at % k { 1.0 } else { 0.0 }
}

/// A product with as many rows as the matrix has.
fn apply(matrix: &[f64], x: &[f64], product: &mut [f64]) {
    product.iter_mut().zip(matrix.chunks(x.len())).for_each(|(y, row)| *y = dot(row, x));
}

/// The product of a matrix with `inner` columns and one with so many rows and `columns`.
fn multiply(a: &[f64], b: &[f64], product: &mut [f64], [inner, columns]: [usize; 2]) {
    for (at, x) in product.iter_mut().enumerate() {
        let (row, column) = (at / columns * inner, at % columns);
        *x = (0..inner).map(|j| a[row + j] * b[j * columns + column]).sum();
    }
}

/// The inverse of a small matrix, which is destroyed (Gauss and Jordan, with pivots of columns).
fn invert(matrix: &mut [f64], inverse: &mut [f64], k: usize) {
    inverse.iter_mut().enumerate().for_each(|(at, x)| *x = unit(at, k));
    for column in 0..k {
        let size = |row: &usize| matrix[row * k + column].abs();
        let pivot = (column..k).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(column);
        for at in 0..k {
            matrix.swap(column * k + at, pivot * k + at);
            inverse.swap(column * k + at, pivot * k + at);
        }
        let by = 1.0 / matrix[column * k + column];
        for at in 0..k {
            matrix[column * k + at] *= by;
            inverse[column * k + at] *= by;
        }
        for row in (0..k).filter(|row| *row != column) {
            let part = matrix[row * k + column];
            for at in 0..k {
                matrix[row * k + at] -= part * matrix[column * k + at];
                inverse[row * k + at] -= part * inverse[column * k + at];
            }
        }
    }
}
