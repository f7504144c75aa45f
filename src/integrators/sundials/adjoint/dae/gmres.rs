//! GMRES for the linear systems where the backward run of a DAE starts, outside of any integration.

use crate::base::vector::dot;
use crate::integrators::ode::Failure;

/// The residual that is aimed at, relative to the right-hand side, and the one that is enough.
const TARGET: f64 = 1e-12;
const ENOUGH: f64 = 1e-9;
/// Most iterations, of which each stores a vector.
const MOST: usize = 200;

/// Replaces the right-hand side `b` by the solution of A P^-1 P x = b, with products by `multiply`, and solutions with P in
/// place by `precondition`. Returns whether there is one.
///
/// Y. Saad, Iterative Methods for Sparse Linear Systems, section 9.3.2: preconditioned on the right, without restarts.
pub(super) fn solve(
    b: &mut [f64],
    mut multiply: impl FnMut(&[f64], &mut [f64]) -> Result<(), Failure>,
    precondition: impl Fn(&mut [f64]),
) -> Result<bool, Failure> {
    let norm = dot(b, b).sqrt();
    if norm == 0.0 {
        return Ok(true);
    }
    let mut basis = vec![b.iter().map(|b| b / norm).collect::<Vec<f64>>()];
    // columns of R, rotations, and the right-hand side of the least squares
    let (mut upper, mut rotations, mut rhs) = (Vec::new(), Vec::<[f64; 2]>::new(), vec![norm]);
    let mut z = vec![0.0; b.len()];
    while rhs[rotations.len()].abs() > TARGET * norm && rotations.len() < MOST.min(b.len()) {
        let k = rotations.len();
        z.copy_from_slice(&basis[k]);
        precondition(&mut z);
        let mut w = vec![0.0; b.len()];
        multiply(&z, &mut w)?;
        let mut column = Vec::with_capacity(k + 2);
        for v in &basis {
            let h = dot(&w, v);
            w.iter_mut().zip(v).for_each(|(w, v)| *w -= h * v);
            column.push(h);
        }
        let below = dot(&w, &w).sqrt();
        for (i, [c, s]) in rotations.iter().enumerate() {
            (column[i], column[i + 1]) =
                (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
        }
        let radius = column[k].hypot(below);
        if radius == 0.0 || !radius.is_finite() {
            return Ok(false);
        }
        let [c, s] = [column[k] / radius, below / radius];
        column[k] = radius;
        rotations.push([c, s]);
        rhs.push(-s * rhs[k]);
        rhs[k] *= c;
        upper.push(column);
        if below > 0.0 {
            basis.push(w.iter().map(|w| w / below).collect());
        } else {
            break;
        }
    }
    let count = rotations.len();
    if rhs[count].abs() > ENOUGH * norm {
        return Ok(false);
    }
    b.fill(0.0);
    for k in (0..count).rev() {
        let later: f64 = (k + 1..count).map(|j| upper[j][k] * rhs[j]).sum();
        rhs[k] = (rhs[k] - later) / upper[k][k];
        b.iter_mut().zip(&basis[k]).for_each(|(b, v)| *b += rhs[k] * v);
    }
    precondition(b);
    Ok(b.iter().all(|x| x.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::solve;

    /// A matrix without symmetry, with a diagonal as preconditioner, and a singular one.
    #[test]
    fn it_solves_what_is_regular() {
        let n = 40;
        let entry = |i: usize, j: usize| match i == j {
            true => 5.0 + i as f64,
            false => ((3 * i + 7 * j) as f64).sin() / n as f64,
        };
        let exact: Vec<f64> = (0..n).map(|i| 1.0 + (i as f64).cos()).collect();
        let multiply = |x: &[f64], out: &mut [f64]| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = (0..n).map(|j| entry(i, j) * x[j]).sum();
            }
            Ok(())
        };
        let mut b = vec![0.0; n];
        multiply(&exact, &mut b).unwrap();
        let diagonal =
            |x: &mut [f64]| x.iter_mut().enumerate().for_each(|(i, x)| *x /= entry(i, i));
        assert!(solve(&mut b, multiply, diagonal).unwrap());
        let error = b.iter().zip(&exact).map(|(x, e)| (x - e).abs()).fold(0.0, f64::max);
        println!("{error:e}");
        assert!(error < 1e-11, "{error:e}");

        let sum = |x: &[f64], out: &mut [f64]| {
            out.fill(x.iter().sum());
            Ok(())
        };
        assert!(!solve(&mut [1.0, 2.0, 3.0], sum, |_| ()).unwrap());
        assert!(solve(&mut [0.0; 3], sum, |_| ()).unwrap());
    }
}
