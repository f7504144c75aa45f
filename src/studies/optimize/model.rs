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

    /// The step d between `ends` that makes the model least, and by how much: passes over the components in turn (Gauss and Seidel) find
    /// those that are at their ends, and Cholesky factors the best values of the others.
    pub(super) fn least(&self, slopes: &DVector<f64>, ends: &[[f64; 2]]) -> (DVector<f64>, f64) {
        let mut step = DVector::zeros(slopes.len());
        for _ in 0..MOST_PASSES {
            let before = step.clone();
            self.pass(slopes, ends, &mut step);
            self.improve_inner(slopes, ends, &mut step);
            let widths = ends.iter().map(|[low, high]| (high - low).max(f64::MIN_POSITIVE));
            if (&step - before).iter().zip(widths).all(|(d, width)| d.abs() < SETTLED * width) {
                break;
            }
        }
        let gain = -(slopes.dot(&step) + 0.5 * step.dot(&(&self.0 * &step)));
        (step, gain)
    }

    /// Makes the model least along each component in turn.
    fn pass(&self, slopes: &DVector<f64>, ends: &[[f64; 2]], step: &mut DVector<f64>) {
        for (k, [low, high]) in ends.iter().enumerate() {
            let (slope, curvature) = (slopes[k] + self.0.row(k).tr_dot(step), self.0[(k, k)]);
            step[k] = match curvature > 0.0 {
                true => (step[k] - slope / curvature).clamp(*low, *high),
                // nothing is known of it
                false if slope > 0.0 => *low,
                false if slope < 0.0 => *high,
                false => step[k],
            };
        }
    }

    /// Continues to the minimum over all components that are between their ends, or to the first end before it, if there is one
    /// such value.
    fn improve_inner(&self, slopes: &DVector<f64>, ends: &[[f64; 2]], step: &mut DVector<f64>) {
        let is_inner = |k: &usize| ends[*k][0] < step[*k] && step[*k] < ends[*k][1];
        let inner: Vec<usize> = (0..ends.len()).filter(is_inner).collect();
        let slopes = slopes + &self.0 * &*step;
        let matrix = self.0.select_rows(&inner).select_columns(&inner);
        let Some(factors) = matrix.cholesky() else { return };
        let way = factors.solve(&-slopes.select_rows(&inner));
        let room = |(&k, way): (&usize, &f64)| match *way {
            0.0 => 1.0,
            way => (ends[k][usize::from(way > 0.0)] - step[k]) / way,
        };
        let part = inner.iter().zip(&way).map(room).fold(1.0, f64::min);
        for (&k, way) in inner.iter().zip(&way) {
            step[k] = (step[k] + part * way).clamp(ends[k][0], ends[k][1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::Model;

    /// Squares whose influences nearly coincide, so that single components hardly tell them apart: the step solves them exactly, and
    /// with an end that one is held at, the slopes of the others are 0.
    #[test]
    fn influences_that_are_nearly_alike() {
        let rows = [[1.0, 1.0, 1.0], [1.0, 1.01, 1.02], [1.0, 1.02, 1.0401]];
        let rows = rows.map(|row| DVector::from_row_slice(&row));
        let model = Model::of_squares(&rows, 3);
        let exact = DVector::from_row_slice(&[0.3, -0.5, 0.4]);
        let slopes = -(&model.0 * &exact);
        let (step, gain) = model.least(&slopes, &[[-1.0, 1.0]; 3]);
        assert!((&step - &exact).amax() < 1e-6, "{step}");
        assert!((gain / (0.5 * exact.dot(&(&model.0 * &exact))) - 1.0).abs() < 1e-9, "{gain}");
        let (step, _) = model.least(&slopes, &[[-1.0, 1.0], [-1.0, 1.0], [-1.0, 0.39]]);
        let left = &slopes + &model.0 * &step;
        assert!(step[2] == 0.39 && left[2] < 0.0, "{step} {left}");
        assert!(left[0].abs() < 1e-9 && left[1].abs() < 1e-9, "{left}");
    }
}
