//! A quadratic model of a function, and its least value in a box.

use nalgebra::{DMatrix, DVector};

/// The second derivatives B of the model slopes . d + d . B d / 2 of a function near a point: symmetric, positive semidefinite.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Model(DMatrix<f64>);

/// Part of d . B d that y . d has at least in an update, for changes y of the slopes along a step d.
const LEAST_CURVATURE: f64 = 0.2;
/// Most passes over all components, and changes in the last one below which they end, as a part of the box.
const MOST_PASSES: usize = 1000;
const SETTLED: f64 = 1e-10;

impl Model {
    /// A model whose least value along the largest of the `slopes` is `radius` away.
    pub(super) fn at_distance(slopes: &DVector<f64>, radius: f64) -> Self {
        let size = slopes.len();
        Self(DMatrix::from_diagonal_element(size, size, slopes.amax() / radius))
    }

    /// The model of a sum of squares without the second derivatives of its terms (Gauss and Newton), 2 J^T J of the `rows` of J.
    pub(super) fn of_squares(rows: &[DVector<f64>], size: usize) -> Self {
        let empty = DMatrix::zeros(size, size);
        Self(rows.iter().fold(empty, |sum, row| sum + 2.0 * row * row.transpose()))
    }

    /// The same curvature in all directions that `change` of the slopes shows along a `step`, if it is positive.
    pub(super) fn scaled(&mut self, step: &DVector<f64>, change: &DVector<f64>) {
        let curvature = change.dot(step);
        if curvature > 0.0 {
            let size = step.len();
            self.0 = DMatrix::from_diagonal_element(size, size, change.norm_squared() / curvature);
        }
    }

    /// Takes in the `change` of the slopes along a `step` by the BFGS formula, damped so that it stays positive definite (J. Nocedal
    /// and S. J. Wright, "Numerical Optimization", 2nd edition (2006), procedure 18.2).
    pub(super) fn update(&mut self, step: &DVector<f64>, change: &DVector<f64>) {
        let pull = &self.0 * step;
        let [own, seen] = [step.dot(&pull), step.dot(change)];
        if own <= 0.0 {
            return;
        }
        let damped = match seen < LEAST_CURVATURE * own {
            true => {
                let weight = (1.0 - LEAST_CURVATURE) * own / (own - seen);
                weight * change + (1.0 - weight) * &pull
            }
            false => change.clone(),
        };
        self.0 += &damped * damped.transpose() / step.dot(&damped) - &pull * pull.transpose() / own;
    }

    /// The step d between `ends` that makes the model least, component by component in turn (Gauss and Seidel), and by how much.
    pub(super) fn least(&self, slopes: &DVector<f64>, ends: &[[f64; 2]]) -> (DVector<f64>, f64) {
        let mut step = DVector::zeros(slopes.len());
        for _ in 0..MOST_PASSES {
            let mut largest = 0.0_f64;
            for (k, [low, high]) in ends.iter().enumerate() {
                let (slope, curvature) = (slopes[k] + self.0.row(k).tr_dot(&step), self.0[(k, k)]);
                let old: f64 = step[k];
                let new = match curvature > 0.0 {
                    true => (old - slope / curvature).clamp(*low, *high),
                    // nothing is known of it
                    false if slope > 0.0 => *low,
                    false if slope < 0.0 => *high,
                    false => old,
                };
                step[k] = new;
                largest = largest.max((new - old).abs() / (high - low).max(f64::MIN_POSITIVE));
            }
            if largest < SETTLED {
                break;
            }
        }
        let gain = -(slopes.dot(&step) + 0.5 * step.dot(&(&self.0 * &step)));
        (step, gain)
    }
}
