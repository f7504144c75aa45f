//! Proper orthogonal decomposition: few shapes that span many states.
//!
//! By the method of snapshots (L. Sirovich, *Quarterly of Applied Mathematics* 45 (1987) 561-571): with the states as columns
//! of S, the eigenvectors v of S^T M S, of eigenvalues sigma^2, give the shapes S v / sigma.

use faer::{Mat, Side};
use rayon::prelude::*;

use crate::base::vector::dot;

/// Sizes relative to the largest one below which shapes are round-off, as eigenvalues of 1e-16 are.
const ROUND_OFF: f64 = 1e-7;

/// Relative norm of the remainder of a column after orthogonalization below which it depends linearly on those before it.
const DEPENDENT: f64 = 1e-10;

/// Adds M x to its second argument, or writes it there, for a symmetric and positive definite M.
pub(crate) type Mass<'a> = &'a dyn Fn(&[f64], &mut [f64]);

/// Shapes with Phi^T M Phi = I, and for each of them its singular value: the root of the sum of squares of its amplitudes
/// in all states. The largest comes first.
pub(crate) struct Pod {
    pub(crate) shapes: Vec<Vec<f64>>,
    pub(crate) sizes: Vec<f64>,
}

/// The shapes of `snapshots`, apart from round-off; none where all are 0, or where M or they are not finite.
pub(crate) fn pod(snapshots: &[Vec<f64>], mass: Mass) -> Pod {
    let none = Pod { shapes: Vec::new(), sizes: Vec::new() };
    let count = snapshots.len();
    let mut gram = Mat::zeros(count, count);
    let mut moved = vec![0.0; snapshots.first().map_or(0, Vec::len)];
    for (row, snapshot) in snapshots.iter().enumerate() {
        multiply(mass, snapshot, &mut moved);
        let products = snapshots[..=row].par_iter().map(|other| dot(other, &moved));
        let products: Vec<f64> = products.collect();
        products.iter().enumerate().for_each(|(column, x)| gram[(row, column)] = *x);
    }
    let Ok(eigen) = gram.self_adjoint_eigen(Side::Lower) else { return none };
    let sizes: Vec<f64> =
        (0..count).rev().map(|k| eigen.S().column_vector()[k].max(0.0).sqrt()).collect();
    let Some(&first) = sizes.first() else { return none };
    let kept = sizes.iter().take_while(|size| **size > ROUND_OFF * first).count();
    let combined = (0..kept).into_par_iter().map(|k| {
        let mut shape = vec![0.0; moved.len()];
        for (snapshot, amplitude) in snapshots.iter().zip(eigen.U().col(count - 1 - k).iter()) {
            let share = amplitude / sizes[k];
            shape.iter_mut().zip(snapshot).for_each(|(shape, x)| *shape += share * x);
        }
        shape
    });
    let shapes = orthonormal(&combined.collect::<Vec<_>>(), mass);
    // the last ones may be round-off after all
    Pod { sizes: sizes[..shapes.len()].to_vec(), shapes }
}

/// Columns with Q^T M Q = I that span the same space as `columns`, by the Gram-Schmidt process with reorthogonalization. Columns
/// that depend linearly on those before them are omitted.
pub(crate) fn orthonormal(columns: &[Vec<f64>], mass: Mass) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
    for column in columns {
        let (mut own, mut moved) = (column.clone(), vec![0.0; column.len()]);
        multiply(mass, &own, &mut moved);
        let before = dot(&own, &moved).max(0.0).sqrt();
        for _ in 0..2 {
            let along: Vec<f64> = all.par_iter().map(|other| dot(other, &moved)).collect();
            for (other, along) in all.iter().zip(along) {
                own.iter_mut().zip(other).for_each(|(own, x)| *own -= along * x);
            }
            multiply(mass, &own, &mut moved);
        }
        let length = dot(&own, &moved).max(0.0).sqrt();
        // false for NaN
        if length > DEPENDENT * before {
            own.iter_mut().for_each(|x| *x /= length);
            all.push(own);
        }
    }
    all
}

/// y = M x
fn multiply(mass: Mass, x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    mass(x, y);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::noise;

    const LENGTH: usize = 50;

    /// A tridiagonal matrix, positive definite.
    fn mass(x: &[f64], y: &mut [f64]) {
        for i in 0..x.len() {
            y[i] += (2.0 + (i % 3) as f64) * x[i];
            for j in [i.wrapping_sub(1), i + 1] {
                y[i] += 0.5 * x.get(j).unwrap_or(&0.0);
            }
        }
    }

    fn product(a: &[f64], b: &[f64]) -> f64 {
        let mut moved = vec![0.0; b.len()];
        mass(b, &mut moved);
        dot(a, &moved)
    }

    fn off_orthonormal(shapes: &[Vec<f64>]) -> f64 {
        let pairs = (0..shapes.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let off = pairs
            .map(|(i, j)| (product(&shapes[i], &shapes[j]) - f64::from(u8::from(i == j))).abs());
        off.fold(0.0, f64::max)
    }

    /// States a_k(t) phi_k with known orthonormal phi and amplitudes that are orthogonal over the states: the shapes are
    /// the phi, the sizes those of the amplitudes.
    #[test]
    fn shapes_of_which_states_were_made_are_found_again() {
        let numbers: Vec<Vec<f64>> = (0..3).map(|k| noise(LENGTH, k)).collect();
        let made_of = orthonormal(&numbers, &mass);
        assert!(off_orthonormal(&made_of) < 2e-15);
        let (count, sizes) = (24, [3.0, 0.5, 2e-4]);
        let amplitude = |k: usize, t: usize| {
            let angle = std::f64::consts::TAU * ((k + 1) * t) as f64 / count as f64;
            sizes[k] * (2.0 / count as f64).sqrt() * angle.sin()
        };
        let states: Vec<Vec<f64>> = (0..count)
            .map(|t| {
                (0..LENGTH).map(|i| (0..3).map(|k| amplitude(k, t) * made_of[k][i]).sum()).collect()
            })
            .collect();
        let found = pod(&states, &mass);
        assert_eq!(found.shapes.len(), 3);
        assert!(off_orthonormal(&found.shapes) < 2e-15);
        for k in 0..3 {
            // eigenvalues are exact to 1e-16 of the largest one
            let exact = 1e-16 * (sizes[0] / sizes[k]).powi(2);
            let off = found.sizes[k] / sizes[k] - 1.0;
            assert!(off.abs() < exact + 1e-15, "size {k}: {off:e}");
            let along = product(&found.shapes[k], &made_of[k]).abs();
            assert!((along - 1.0).abs() < 1e-14, "shape {k}: {along}");
        }
    }

    #[test]
    fn what_depends_on_others_is_left_out() {
        let [a, b] = [noise(LENGTH, 1), noise(LENGTH, 2)];
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 * a - b).collect();
        let near: Vec<f64> = a.iter().zip(noise(LENGTH, 3)).map(|(a, x)| a + 1e-6 * x).collect();
        let all = orthonormal(&[a, vec![0.0; LENGTH], b, sum, near], &mass);
        assert_eq!(all.len(), 3);
        assert!(off_orthonormal(&all) < 2e-15);
        assert!(pod(&[vec![0.0; LENGTH]], &mass).shapes.is_empty());
        assert!(pod(&[], &mass).shapes.is_empty());
    }
}
