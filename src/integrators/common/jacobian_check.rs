//! Checks whether a Jacobian is that of the equations, while an integrator uses it: a supplied one, or difference quotients on a pattern
//! that may lack entries.

use std::mem;

use super::{error::Cause, tolerances::Tolerances};

/// Checks products of a Jacobian with directions against difference quotients of the equations.
///
/// It checks the first Jacobian, the second, the fourth, the eighth and so on (where unknowns start at zero,
/// the first says little), along two directions that share no unknown. A check costs three evaluations of the
/// equations, more where product and quotient do not agree, and two products.
#[derive(Debug)]
pub(crate) struct JacobianCheck {
    tolerances: Tolerances,
    /// Number of Jacobians so far, and the number of the next one to check.
    seen: u64,
    next: u64,
    /// State of a generator of random numbers, the same in every run.
    random: u64,
    direction: Vec<f64>,
    /// The state moved along the direction, and the time derivative of a DAE.
    moved: [Vec<f64>; 2],
    /// Products with both directions.
    products: [Vec<f64>; 2],
    /// Size of the terms of each equation, which may cancel each other: the sum of the absolute values of its
    /// products with both directions.
    terms: Vec<f64>,
    base: Vec<f64>,
    ahead: Vec<f64>,
    behind: Vec<f64>,
    rows: Vec<RowState>,
}

/// Verdict on a row of the product.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RowState {
    /// Undecided.
    Open,
    /// Correct, within the accuracy of differences.
    Right,
    /// Wrong according to the difference quotient of the last shift.
    Suspicious(f64),
}

/// Kind of a checked Jacobian: dF/dy of equations F(y), or dF/dy + cj dF/dy' of equations F(y, y').
#[derive(Clone, Copy)]
pub(crate) struct Point<'a> {
    pub(crate) y: &'a [f64],
    /// Empty for an ODE.
    pub(crate) yp: &'a [f64],
    pub(crate) cj: f64,
}

/// Quantity that a check evaluates.
pub(crate) enum Wanted<'a> {
    /// The product of the Jacobian with a vector.
    Product(&'a [f64]),
    /// The equations at a state and time derivative.
    Equations([&'a [f64]; 2]),
    /// Whether the Jacobian has space for this entry: `false` if not.
    Entry(usize, usize),
}

/// Writes the requested values, and returns `false` where they are undefined. (`dyn`, as the check would else be compiled once
/// more for each type of system.)
pub(crate) type Compute<'a> = dyn FnMut(Wanted<'_>, &mut [f64]) -> bool + 'a;

/// Shifts relative to the sizes of the unknowns.
const SHIFTS: [f64; 3] = [1e-3, 1e-5, 1e-7];
/// Largest difference allowed between product and quotient, relative to the larger of both.
const TOLERANCE: f64 = 0.01;
/// Largest number of unknowns for which the wrong entry is searched.
const MOST_UNKNOWNS: usize = 1000;

impl JacobianCheck {
    /// For the integration of `n` equations within these tolerances.
    pub(crate) fn new(n: usize, tolerances: &Tolerances) -> Self {
        Self::of_rows(n, n, tolerances)
    }

    /// For so many functions of `n` unknowns, within these tolerances of the unknowns.
    pub(crate) fn of_rows(rows: usize, n: usize, tolerances: &Tolerances) -> Self {
        let zeros = || vec![0.0; rows];
        Self {
            tolerances: tolerances.clone(),
            seen: 0,
            next: 1,
            random: 1,
            direction: vec![0.0; n],
            moved: [vec![0.0; n], Vec::new()],
            products: [zeros(), zeros()],
            terms: zeros(),
            base: zeros(),
            ahead: zeros(),
            behind: zeros(),
            rows: vec![RowState::Open; rows],
        }
    }

    /// Whether the Jacobian that was just evaluated is to be checked.
    pub(crate) fn is_due(&mut self) -> bool {
        self.seen += 1;
        let is_due = self.seen == self.next;
        if is_due {
            self.next *= 2;
        }
        is_due
    }

    /// The error in the Jacobian at the point, which `method` supplied, or which are difference quotients.
    ///
    /// The result is `None` where differences cannot show an error: next to a jump or a kink, or where they do
    /// not converge.
    pub(crate) fn find(
        &mut self,
        method: Option<&'static str>,
        point: Point<'_>,
        compute: &mut Compute<'_>,
    ) -> Option<Cause> {
        let Point { y, yp, cj } = point;
        let [moved, moved_slope] = &mut self.moved;
        moved.copy_from_slice(y);
        moved_slope.clear();
        moved_slope.extend_from_slice(yp);
        if !compute(Wanted::Equations([y, yp]), &mut self.base) {
            return None;
        }
        let at = |compute: &mut Compute<'_>,
                  [moved, slope]: &mut [Vec<f64>; 2],
                  v: &[f64],
                  shift: f64,
                  out: &mut [f64]| {
            for (i, (v, y)) in v.iter().zip(y).enumerate() {
                moved[i] = y + shift * v;
                if let Some(slope) = slope.get_mut(i) {
                    *slope = yp[i] + cj * shift * v;
                }
            }
            compute(Wanted::Equations([moved, slope]), out) && out.iter().all(|x| x.is_finite())
        };
        let seed = self.random;
        self.terms.fill(0.0);
        for half in [0, 1] {
            self.random = seed;
            self.choose_direction(y, half);
            let product = &mut self.products[half];
            if !compute(Wanted::Product(&self.direction), product) {
                return None;
            }
            let sizes = self.terms.iter_mut().zip(product);
            sizes.for_each(|(size, product)| *size += product.abs());
        }
        for half in [0, 1] {
            // small terms of a row show in the direction that omits the largest one
            self.random = seed;
            self.choose_direction(y, half);
            if self.direction.iter().all(|v| *v == 0.0) {
                continue;
            }
            let Some((row, difference)) = self.wrong_row(compute, half, at) else { continue };
            let Some(method) = method else {
                match self.missing_entry(y, row, compute, at) {
                    Some(missing) => return Some(missing),
                    None => continue,
                }
            };
            let mut cause = (0.0, None, self.products[half][row], difference);
            let unknowns = if y.len() <= MOST_UNKNOWNS { y } else { &[] };
            for (j, &own) in unknowns.iter().enumerate() {
                let size = self.tolerances.size_of(j, own).copysign(own);
                self.direction.fill(0.0);
                self.direction[j] = size;
                let Self { direction, moved, products, ahead, .. } = self;
                let product = &mut products[half];
                if !compute(Wanted::Product(direction), product)
                    || !at(compute, moved, direction, SHIFTS[1], ahead)
                {
                    continue;
                }
                let quotient = (self.ahead[row] - self.base[row]) / SHIFTS[1];
                let entry = self.products[half][row];
                let off = (entry - quotient).abs();
                if off > cause.0 {
                    cause = (off, Some(j), entry / size, quotient / size);
                }
            }
            // whoever continues nevertheless gets this error again
            self.next = self.seen + 1;
            let (_, column, supplied, difference) = cause;
            return Some(Cause::WrongJacobian { method, row, column, supplied, difference });
        }
        None
    }

    /// The largest entry of a row that the Jacobian has no space for: of the unknowns without one, the half whose common change moves the
    /// row more, of that the half, and so on.
    fn missing_entry(
        &mut self,
        y: &[f64],
        row: usize,
        compute: &mut Compute<'_>,
        at: impl Fn(&mut Compute<'_>, &mut [Vec<f64>; 2], &[f64], f64, &mut [f64]) -> bool,
    ) -> Option<Cause> {
        let Self { direction, moved, ahead, base, tolerances, .. } = self;
        let size = |j: usize| tolerances.size_of(j, y[j]).copysign(y[j]);
        let mut columns: Vec<usize> =
            (0..y.len()).filter(|&j| !compute(Wanted::Entry(row, j), &mut [])).collect();
        let mut change = |columns: &[usize]| {
            direction.fill(0.0);
            columns.iter().for_each(|&j| direction[j] = size(j));
            let has_value = at(compute, moved, direction, SHIFTS[1], ahead);
            if has_value { ahead[row] - base[row] } else { 0.0 }
        };
        while columns.len() > 1 {
            let mut others = columns.split_off(columns.len() / 2);
            if change(&others).abs() > change(&columns).abs() {
                mem::swap(&mut columns, &mut others);
            }
        }
        let column = *columns.first()?;
        let change = change(&columns);
        let difference = change / (SHIFTS[1] * size(column));
        // an unknown that the equation does not depend on changes nothing, not even by rounding
        (change != 0.0).then_some(Cause::MissingEntry { row, column, difference })
    }

    /// A random direction away from zero: some of the unknowns, each in proportion to its size, or the
    /// others.
    fn choose_direction(&mut self, y: &[f64], half: usize) {
        for (j, (v, y)) in self.direction.iter_mut().zip(y).enumerate() {
            // Knuth's linear congruential generator, of which the upper bits are used
            self.random = self
                .random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let part = 0.5 + 0.5 * ((self.random >> 12) as f64 / (1_u64 << 52) as f64);
            let size = self.tolerances.size_of(j, *y).copysign(*y);
            *v = if self.random >> 63 == half as u64 { part * size } else { 0.0 };
        }
    }

    /// A row of the product that differences along the direction refute, and their value: the quotients of
    /// two shifts agree with each other, but not with the product.
    fn wrong_row(
        &mut self,
        compute: &mut Compute<'_>,
        half: usize,
        at: impl Fn(&mut Compute<'_>, &mut [Vec<f64>; 2], &[f64], f64, &mut [f64]) -> bool,
    ) -> Option<(usize, f64)> {
        let Self { direction, moved, products, terms, base, ahead, behind, rows, .. } = self;
        let product = &products[half];
        rows.fill(RowState::Open);
        for shift in SHIFTS {
            if !at(compute, moved, direction, shift, ahead) {
                continue;
            }
            for (i, row) in rows.iter_mut().enumerate() {
                let right = (ahead[i] - base[i]) / shift;
                if fits(product[i], right, rounding([base[i], ahead[i], terms[i]], shift)) {
                    *row = RowState::Right;
                }
            }
            if rows.iter().all(|row| *row == RowState::Right) {
                return None;
            }
            // the Jacobian may be that of the other side of a kink
            if !at(compute, moved, direction, -shift, behind) {
                continue;
            }
            for (i, row) in rows.iter_mut().enumerate().filter(|(_, row)| **row != RowState::Right)
            {
                let (right, left) = ((ahead[i] - base[i]) / shift, (base[i] - behind[i]) / shift);
                let mean = 0.5 * (right + left);
                let rounding = rounding([base[i], ahead[i], terms[i]], shift);
                let noise = (right - left).abs() + rounding;
                let before = *row;
                *row = if fits(product[i], left, rounding) || fits(product[i], mean, rounding) {
                    RowState::Right
                } else if noise > 0.5 * (product[i] - mean).abs() {
                    RowState::Open
                } else {
                    RowState::Suspicious(mean)
                };
                if let (RowState::Suspicious(before), RowState::Suspicious(mean)) = (before, *row)
                    && fits(before, mean, noise)
                {
                    return Some((i, mean));
                }
            }
        }
        None
    }
}

/// Largest rounding error of a quotient of an equation with values and terms of these sizes.
fn rounding(sizes: [f64; 3], shift: f64) -> f64 {
    let size = sizes.into_iter().fold(0.0, |most: f64, size| most.max(size.abs()));
    (1e3 * f64::EPSILON * size + f64::MIN_POSITIVE) / shift
}

/// Whether two numbers agree within the tolerance and rounding.
fn fits(a: f64, b: f64, rounding: f64) -> bool {
    (a - b).abs() <= TOLERANCE * a.abs().max(b.abs()) + rounding
}
