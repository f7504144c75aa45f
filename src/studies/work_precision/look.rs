//! A first look at a scene: a coarse run, and its conclusions about the model.

use std::fmt;
use std::ops::ControlFlow;
use std::time::Instant;

use serde_json::{Value, json};

use crate::base::input::{four_digits, positive};
use crate::dynamics::error::Error;
use crate::dynamics::report::Indicator;
use crate::dynamics::simulate::{Progress, Sampling};
use crate::io::output::OfIndicator;
use crate::scene::settings::{Method, Settings};
use crate::scene::timeline::Scene;

/// Findings of a coarse run of a scene: whether its motion can be trusted, and whether less would do.
///
/// ```
/// use pliant::study::Look;
/// use pliant::{Settings, Verdict, samples};
///
/// let look = Look::of(&samples::square_jump(4)?, &Settings::default(), Look::SECONDS)?;
/// let strain = look.indicators().iter().find(|indicator| indicator.name == "strain").unwrap();
/// assert_eq!(strain.verdict, Verdict::Doubtful); // it is pressed to half of its height
/// println!("{look}");
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Look {
    indicators: Vec<Indicator>,
    until: f64,
    end: f64,
    cause: Option<String>,
}

/// Relative tolerance of the run, and how many samples are taken.
const RTOL: f64 = 1e-2;
const SAMPLES: f64 = 200.0;
/// Indicators that compare with how far nodes go: it is not known of a run that ends early.
const OF_THE_WAY: [&str; 3] = ["tolerance", "creep", "path-leap"];

impl Look {
    /// Wall-clock time (s) that is enough for most scenes.
    pub const SECONDS: f64 = 2.0;

    /// Runs the scene as it is written, by [`Method::Auto`] and a relative tolerance of 1e-2, for `seconds`
    /// of wall-clock time at most (and until the step then in progress is done), and measures all that
    /// [`Trajectory::indicators`](crate::Trajectory::indicators) measure. A run that ends early counts as far
    /// as it came.
    ///
    /// # Errors
    /// Bad input; all failures except a run that ends early.
    pub fn of(scene: &Scene, settings: &Settings, seconds: f64) -> Result<Self, Error> {
        positive("seconds", seconds, "s")?;
        settings.validate()?;
        scene.refuse_ends("the first look")?;
        let Settings { alpha, contact_events, .. } = *settings;
        let (method, rtol) = (Method::Auto, RTOL);
        let coarse = Settings { method, rtol, alpha, contact_events, ..Settings::default() };
        let clock = Instant::now();
        let patience = |_: &Progress<'_>| match clock.elapsed().as_secs_f64() > seconds {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let sampling = Sampling::every(scene.end() / SAMPLES);
        let (motion, cause) = match scene.simulate_with(&coarse, &sampling, patience) {
            Ok(motion) => (motion, None),
            Err(Error::Integration(stopped)) => {
                let cause = match stopped.is_interruption() {
                    true => format!("{} s of computing", four_digits(seconds)),
                    false => stopped.cause(),
                };
                (stopped.trajectory, Some(cause))
            }
            Err(error) => return Err(error),
        };
        let (mut indicators, until) = (motion.indicators(), motion.last().time);
        if cause.is_some() {
            indicators.retain(|indicator| !OF_THE_WAY.contains(&indicator.name));
        }
        Ok(Self { indicators, until, end: scene.end(), cause })
    }

    /// All that was measured.
    pub fn indicators(&self) -> &[Indicator] {
        &self.indicators
    }

    /// The time (s) until which the scene was run: its end, or less.
    pub fn until(&self) -> f64 {
        self.until
    }

    /// Reason for the end of the run before that of the scene, if it ended early.
    pub fn cause(&self) -> Option<&str> {
        self.cause.as_deref()
    }

    /// All of it as data: `until`, `end` (s), `cause` and `indicators`, each as in `report.json`.
    pub fn to_json(&self) -> Value {
        let Self { indicators, until, end, cause } = self;
        json!({
            "until": until,
            "end": end,
            "cause": cause,
            "indicators": indicators.iter().map(OfIndicator::object).collect::<Vec<_>>(),
        })
    }
}

impl fmt::Display for Look {
    /// A line for each indicator, and one before them if the run ended early.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { indicators, until, end, cause } = self;
        if let Some(cause) = cause {
            writeln!(
                f,
                "looked at until t = {} s of {} s: {cause}",
                four_digits(*until),
                four_digits(*end)
            )?;
        }
        let lines: Vec<String> = indicators.iter().map(Indicator::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}
