//! Steps that are far too short for a phase: reported during the run, with their likely cause and what to try.

use crate::base::input::four_digits;
use crate::dynamics::report::Counts;

/// Mean step, as part of the phase, below which a run hardly gets on, and the number of steps of which the mean is taken.
const SHORT: f64 = 1e-9;
const MANY: usize = 1000;

/// Failures, for each step that is taken, from which on they are the cause.
const OFTEN: f64 = 0.05;

/// The last steps of a phase.
#[derive(Default)]
pub(super) struct Crawl {
    steps: usize,
    /// When they began (s).
    began: f64,
    /// The failures until then, if the first of them was short: of Newton's iteration, and of the error test.
    failures: Option<[usize; 2]>,
    /// The notice that was given of them.
    pub(super) told: Option<String>,
}

impl Crawl {
    /// Adds a step of a phase of a `length` (s); `touches` where surfaces do. Returns the notice that is due now.
    pub(super) fn add(
        &mut self,
        [start, end]: [f64; 2],
        length: f64,
        touches: bool,
        counts: impl Fn() -> Counts,
    ) -> Option<&str> {
        if self.told.is_some() {
            return None;
        }
        let failures = || {
            let counts = counts();
            [counts.convergence_failures, counts.error_test_failures]
        };
        if self.steps == 0 {
            self.began = start;
            // counts are not for each thousand steps of any run
            self.failures = (end - start < SHORT * length).then(failures);
        }
        self.steps += 1;
        if self.steps < MANY {
            return None;
        }
        self.steps = 0;
        let mean = (end - self.began) / MANY as f64;
        let before = self.failures.filter(|_| mean < SHORT * length)?;
        // an integrator that was started meanwhile counts from 0
        let now = failures();
        let [of_newton, of_errors] = [0, 1].map(|k| now[k].saturating_sub(before[k]));
        let often = |count: usize| count as f64 > OFTEN * MANY as f64;
        let cause = match () {
            _ if often(of_newton) && of_newton >= of_errors => {
                format!("{of_newton} times no balance of forces was found with longer ones")
            }
            _ if often(of_errors) => {
                format!("{of_errors} times the error of longer ones was too large")
            }
            _ => "longer ones are unstable, or forces change as fast".into(),
        };
        let help = match touches {
            true => {
                "where bodies touch: raise `sticking_speed`, lower `stiffness_density`, loosen rtol, or take another method"
            }
            false => {
                "look for a contact, spring or damper that is far stiffer than the body; loosen rtol, or take another method"
            }
        };
        self.told = Some(format!(
            "{MANY} steps up to t = {} s were {mean:.1e} s long in the mean, less than a billionth of the phase: {cause}; {help}",
            four_digits(end)
        ));
        self.told.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The notice after `steps` of a size (s) in a phase of 1 s, with so many failures of Newton's iteration and of the error test
    /// in each thousand of them.
    fn told(steps: usize, step: f64, [of_newton, of_errors]: [usize; 2]) -> Option<String> {
        let mut crawl = Crawl::default();
        for k in 0..steps {
            let ends = [k, k + 1].map(|k| k as f64 * step);
            crawl.add(ends, 1.0, true, || Counts {
                convergence_failures: (k + 1) / MANY * of_newton,
                error_test_failures: (k + 1) / MANY * of_errors,
                ..Counts::default()
            });
        }
        crawl.told
    }

    #[test]
    fn a_thousand_tiny_steps_are_told_with_their_cause() {
        assert!(told(999, 1e-10, [0, 0]).is_none());
        assert!(told(10_000, 1.1e-9, [0, 0]).is_none());
        let told = |failures| told(1000, 0.9e-9, failures).unwrap();
        assert!(told([0, 0]).contains("unstable"), "{}", told([0, 0]));
        assert!(told([51, 0]).contains("51 times no balance"), "{}", told([51, 0]));
        assert!(told([60, 700]).contains("700 times the error"), "{}", told([60, 700]));
        assert!(told([0, 0]).contains("9.0e-10 s long") && told([0, 0]).contains("sticking_speed"));
    }

    /// It is reported once.
    #[test]
    fn it_is_told_once() {
        let mut crawl = Crawl::default();
        let mut times = 0;
        for k in 0..5000 {
            let ends = [k, k + 1].map(|k| f64::from(k) * 1e-12);
            times += usize::from(crawl.add(ends, 1.0, false, Counts::default).is_some());
        }
        assert_eq!(times, 1);
    }
}
