//! Difference quotients by several steps, extrapolated to the step 0.

/// A derivative from difference quotients, of several functions at once.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Extrapolated {
    /// The derivative of each function.
    pub(super) slopes: Vec<f64>,
    /// Estimated error of that of the last function.
    pub(super) error: f64,
}

impl Extrapolated {
    pub(super) fn slope(&self) -> f64 {
        self.slopes.last().copied().unwrap_or(f64::NAN)
    }
}

/// The limit of difference `quotients`, each by a step half as long as that of the one before, whose errors are a series of the powers
/// `order`, 2 `order`, ... of the step: 2 of central quotients, 1 of others.
///
/// The entry of the tableau is taken that differs least from its neighbours of lower order, and the largest of these differences is the
/// error (C. J. F. Ridders, "Accurate computation of F'(x) and F'(x) F''(x)", Advances in Engineering Software 4 (1982) 75-76).
pub(super) fn extrapolated(quotients: &[Vec<f64>], order: i32) -> Option<Extrapolated> {
    let mut best: Option<Extrapolated> = None;
    let mut before: Vec<Vec<f64>> = Vec::new();
    for quotient in quotients {
        let mut row = vec![quotient.clone()];
        for (power, coarse) in (1..).zip(&before) {
            let factor = 2.0_f64.powi(order * power);
            let fine = &row[row.len() - 1];
            let better = fine.iter().zip(coarse).map(|(f, c)| (factor * f - c) / (factor - 1.0));
            let better: Vec<f64> = better.collect();
            let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
            let error = [fine, coarse].map(|other| (last(&better) - last(other)).abs());
            let error = error[0].max(error[1]);
            if best.as_ref().is_none_or(|best| error < best.error) {
                best = Some(Extrapolated { slopes: better.clone(), error });
            }
            row.push(better);
        }
        before = row;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::extrapolated;

    /// The derivative of exp at 1, from steps of a tenth and less: the estimated error holds, and was 1.5e-5 of one-sided
    /// quotients, whose actual error was 4e-8.
    #[test]
    fn quotients_lead_to_the_derivative() {
        let at = |x: f64| 1.0_f64.exp() * x.exp();
        let steps = [0.1, 0.05, 0.025, 0.0125];
        let central: Vec<_> = steps.iter().map(|h| vec![(at(*h) - at(-h)) / (2.0 * h)]).collect();
        let one_sided: Vec<_> = steps.iter().map(|h| vec![(at(*h) - at(0.0)) / h]).collect();
        for (quotients, order, bound) in [(central, 2, 1e-11), (one_sided, 1, 2e-5)] {
            let found = extrapolated(&quotients, order).unwrap();
            let off = (found.slope() - 1.0_f64.exp()).abs();
            assert!(off <= found.error && found.error < bound, "{off:e} {:e}", found.error);
        }
        assert_eq!(extrapolated(&[vec![1.0]], 2), None);
    }

    /// Noise of 1e-9 makes the shortest steps the worst ones: they are left out.
    #[test]
    fn noise_is_noticed() {
        let at = |x: f64, noise: f64| x.exp() + 1e-9 * noise;
        let quotient = |(h, noise): (f64, f64)| vec![(at(h, noise) - at(-h, 0.0)) / (2.0 * h)];
        let steps = [(0.1, 0.3), (0.05, -0.7), (1e-4, 1.0), (5e-5, -1.0), (2.5e-5, 0.2)];
        let found = extrapolated(&steps.map(quotient), 2).unwrap();
        assert!((found.slope() - 1.0).abs() <= found.error, "{found:?}");
    }
}
