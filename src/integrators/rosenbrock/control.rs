//! Step size control.

/// Safety factor on the step that would just pass the error test.
const SAFETY: f64 = 0.9;
const SMALLEST_FACTOR: f64 = 0.2;
const LARGEST_FACTOR: f64 = 6.0;
/// Factor on the step after equations that could not be evaluated or solved.
const REFUSED_FACTOR: f64 = 0.25;
/// A step that could grow by less than this factor keeps its size, where its factorization can be used again.
const WORTH_A_FACTORIZATION: f64 = 1.2;

/// Proportional-integral step size control, the predictive controller of K. Gustafsson (ACM TOMS 20 (1994)
/// 496-517; HNW II, section IV.8), with the constants of the code RODAS (HNW II, appendix).
#[derive(Clone, Copy, Debug)]
pub(super) struct Controller {
    /// 1 / order of the method.
    exponent: f64,
    /// Size and error of the last accepted step.
    last: Option<(f64, f64)>,
    after_rejection: bool,
    /// Whether a step of the same size spares a factorization.
    keeps: bool,
}

impl Controller {
    pub(super) fn new(order: u32, keeps: bool) -> Self {
        Self { exponent: 1.0 / f64::from(order), last: None, after_rejection: false, keeps }
    }

    /// Step after an accepted one of size `h` with error norm at most 1.
    pub(super) fn accept(&mut self, h: f64, error: f64) -> f64 {
        let error = error.max(1e-10);
        let mut factor = SAFETY / error.powf(self.exponent);
        if let Some((h_last, error_last)) = self.last {
            let predicted = (error * error / error_last).powf(self.exponent);
            factor = factor.min(SAFETY * h / h_last / predicted);
        }
        let largest = if self.after_rejection { 1.0 } else { LARGEST_FACTOR };
        self.last = Some((h, error.max(1e-2)));
        self.after_rejection = false;
        let factor = factor.clamp(SMALLEST_FACTOR, largest);
        if self.keeps && (1.0..WORTH_A_FACTORIZATION).contains(&factor) { h } else { h * factor }
    }

    /// Step to retry with after an error norm above 1.
    pub(super) fn reject(&mut self, h: f64, error: f64) -> f64 {
        self.after_rejection = true;
        h * (SAFETY / error.powf(self.exponent)).max(SMALLEST_FACTOR)
    }

    /// Step to retry with when the equations could not be evaluated or solved.
    pub(super) fn refuse(&mut self, h: f64) -> f64 {
        self.after_rejection = true;
        h * REFUSED_FACTOR
    }
}
