//! The coefficients of Dormand and Prince's pair and the loops that use them.
//!
//! J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae", J. Comput. Appl.
//! Math. 6 (1980) 19-26; E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential
//! Equations I", 2nd ed. (HNW I), table II.5.2, and section II.6 for the dense output.

/// Number of stages; the last one is the first of the next step ("first same as last").
pub(super) const STAGES: usize = 7;

/// Abscissae c of the stages, as fractions of the step.
pub(super) const C: [f64; STAGES] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

/// Row i holds the weights of the stages before stage i.
pub(super) const A2: [f64; 1] = [1.0 / 5.0];
pub(super) const A3: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
pub(super) const A4: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
pub(super) const A5: [f64; 4] =
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0];
pub(super) const A6: [f64; 5] =
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0];

// The weights that follow omit stage 2, whose weight is zero in all of them: the entries
// belong to stages 1, 3, 4, 5, 6 and, where there is a sixth, 7.

/// Solution of order 5.
pub(super) const B: [f64; 5] =
    [35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

/// Order 5 minus the embedded order 4: the error estimate.
pub(super) const E: [f64; 6] = [
    71.0 / 57600.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Dense output: weights of the quartic bubble theta^2 (1 - theta)^2.
const D: [f64; 6] = [
    -12715105075.0 / 11282082432.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// The continuous extension of order 4: weights b_i(theta) with
/// y(t + theta h) = y(t) + h sum_i b_i(theta) k_i.
///
/// Cubic Hermite interpolation between both ends of the step plus the bubble.
pub(super) fn dense_weights(theta: f64) -> [f64; 6] {
    let rest = 1.0 - theta;
    let blend = theta * theta * (3.0 - 2.0 * theta);
    let bubble = (theta * rest).powi(2);
    combine_weights(blend, theta * rest * rest, -theta * theta * rest, bubble)
}

/// d b_i / d theta: the weights with which the stages give y'(t + theta h).
pub(super) fn dense_derivative_weights(theta: f64) -> [f64; 6] {
    let rest = 1.0 - theta;
    combine_weights(
        6.0 * theta * rest,
        rest * (1.0 - 3.0 * theta),
        theta * (3.0 * theta - 2.0),
        2.0 * theta * rest * (rest - theta),
    )
}

fn combine_weights(blend: f64, first: f64, last: f64, bubble: f64) -> [f64; 6] {
    let mut weights = D.map(|d| bubble * d);
    for (weight, b) in weights.iter_mut().zip(B) {
        *weight += blend * b;
    }
    weights[0] += first;
    weights[5] += last;
    weights
}

/// `out` = y + h sum_j weights_j k_j in one pass over memory.
#[inline(never)]
pub(super) fn advance<const M: usize>(
    out: &mut [f64],
    y: &[f64],
    h: f64,
    weights: [f64; M],
    k: [&[f64]; M],
) {
    let n = out.len();
    let weights = weights.map(|w| h * w);
    let (y, k) = (&y[..n], k.map(|k| &k[..n]));
    for i in 0..n {
        let mut sum = y[i];
        for j in 0..M {
            sum += weights[j] * k[j][i];
        }
        out[i] = sum;
    }
}

/// Independent partial sums, so that the compiler may keep them in vector registers.
const LANES: usize = 4;

/// Weighted root mean square of x = sum_j c_j x_j in one pass: sqrt(mean((weight_i x_i)^2)), with
/// the weights 1/(rtol |y_i| + atol_i) the norm of CVODE (user guide, "Mathematical
/// considerations").
#[inline(never)]
pub(super) fn norm<const M: usize>(c: [f64; M], x: [&[f64]; M], weight: &[f64]) -> f64 {
    let n = weight.len();
    let (blocks, rest) = weight.as_chunks::<LANES>();
    let x = x.map(|x| x[..n].as_chunks::<LANES>());
    let x_blocks = x.map(|(x, _)| &x[..blocks.len()]);
    let mut lanes = [0.0; LANES];
    for (i, weight) in blocks.iter().enumerate() {
        let mut sum = [0.0; LANES];
        for j in 0..M {
            for lane in 0..LANES {
                sum[lane] += c[j] * x_blocks[j][i][lane];
            }
        }
        for lane in 0..LANES {
            lanes[lane] += (weight[lane] * sum[lane]).powi(2);
        }
    }
    let mut total: f64 = lanes.iter().sum();
    for (i, weight) in rest.iter().enumerate() {
        let sum: f64 = c.iter().zip(&x).map(|(c, (_, x))| c * x[i]).sum();
        total += (weight * sum).powi(2);
    }
    (total / n as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of the full tableau, stage 2 included.
    fn rows() -> [Vec<f64>; STAGES] {
        let b = with_stage_2(&B);
        [vec![], A2.into(), A3.into(), A4.into(), A5.into(), A6.into(), b]
    }

    fn with_stage_2(weights: &[f64]) -> Vec<f64> {
        let mut full = weights.to_vec();
        full.insert(1, 0.0);
        full.resize(STAGES.min(weights.len() + 1), 0.0);
        full
    }

    /// The eight conditions of order 4 (HNW I, section II.2): |sum - 1/gamma|, largest.
    fn order_4_defect(weights: &[f64]) -> f64 {
        let rows = rows();
        let row_sum = |i: usize, value: &dyn Fn(usize) -> f64| -> f64 {
            rows[i].iter().enumerate().map(|(j, a)| a * value(j)).sum()
        };
        let total = |value: &dyn Fn(usize) -> f64| -> f64 {
            weights.iter().enumerate().map(|(i, w)| w * value(i)).sum()
        };
        let ac = |i| row_sum(i, &|j| C[j]);
        let conditions = [
            total(&|_| 1.0) - 1.0,
            total(&|i| C[i]) - 1.0 / 2.0,
            total(&|i| C[i].powi(2)) - 1.0 / 3.0,
            total(&ac) - 1.0 / 6.0,
            total(&|i| C[i].powi(3)) - 1.0 / 4.0,
            total(&|i| C[i] * ac(i)) - 1.0 / 8.0,
            total(&|i| row_sum(i, &|j| C[j].powi(2))) - 1.0 / 12.0,
            total(&|i| row_sum(i, &ac)) - 1.0 / 24.0,
        ];
        conditions.iter().fold(0.0, |largest, c| c.abs().max(largest))
    }

    // Tolerance: a few roundings of sums of weights of size up to 12.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn rows_add_up_to_the_nodes() {
        for (row, c) in rows().iter().zip(C) {
            assert!((row.iter().sum::<f64>() - c).abs() < ROUNDING, "{row:?} {c}");
        }
    }

    #[test]
    fn both_solutions_satisfy_the_conditions_of_order_4() {
        let mut b = with_stage_2(&B);
        b.resize(STAGES, 0.0);
        assert!(order_4_defect(&b) < ROUNDING);
        let embedded: Vec<f64> = b.iter().zip(with_stage_2(&E)).map(|(b, e)| b - e).collect();
        assert!(order_4_defect(&embedded) < ROUNDING);
    }

    /// Dense output of order 4 integrates t^q, q <= 3, exactly at every theta.
    #[test]
    fn dense_output_integrates_cubics() {
        for theta in [0.0, 0.1, 0.37, 0.5, 0.93, 1.0_f64] {
            let weights = with_stage_2(&dense_weights(theta));
            let slopes = with_stage_2(&dense_derivative_weights(theta));
            for q in 0..4 {
                let integral: f64 = weights.iter().zip(C).map(|(b, c)| b * c.powi(q)).sum();
                let slope: f64 = slopes.iter().zip(C).map(|(b, c)| b * c.powi(q)).sum();
                let exact = theta.powi(q + 1) / f64::from(q + 1);
                assert!((integral - exact).abs() < ROUNDING, "theta {theta} q {q}");
                assert!((slope - theta.powi(q)).abs() < ROUNDING * 10.0, "theta {theta} q {q}");
            }
        }
    }
}
