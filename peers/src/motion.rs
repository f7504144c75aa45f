//! A scene, integrated phase by phase by someone else.

use std::fmt;

use pliant::{Error, InputError, Scene};
use rustix::time::{ClockId, clock_gettime};

use crate::stage::Stage;

/// Runs are repeated so often; the least time counts.
pub const REPETITIONS: usize = 5;
/// Those that take so long (s) in all are repeated no more.
pub const ENOUGH: f64 = 0.6;

/// What a run found, and what it cost.
#[derive(Debug, Clone, Default)]
pub struct Solved {
    /// Displacements (m) of all nodes, time by time.
    pub u: Vec<f64>,
    /// Processor time (s).
    pub seconds: f64,
    pub steps: usize,
    /// Evaluations of the forces.
    pub evaluations: usize,
    pub factorizations: usize,
}

/// Why a run ended early.
#[derive(Debug)]
pub struct GaveUp(pub String);

impl GaveUp {
    /// It took more processor time than `limit` (s).
    #[must_use]
    pub fn timeout(limit: f64) -> Self {
        Self(format!("{TIMEOUT} {limit:.0} s"))
    }

    /// Whether time ran out.
    #[must_use]
    pub fn is_timeout(&self) -> bool {
        self.0.starts_with(TIMEOUT)
    }
}

const TIMEOUT: &str = "it took more than";

impl fmt::Display for GaveUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for GaveUp {}

impl From<Error> for GaveUp {
    fn from(error: Error) -> Self {
        Self(error.to_string())
    }
}

impl From<InputError> for GaveUp {
    fn from(error: InputError) -> Self {
        Self(error.to_string())
    }
}

/// One phase to be integrated.
pub struct Span<'a> {
    /// Start and end (s).
    pub from: f64,
    pub to: f64,
    /// Free displacements and velocities at the start; at the end, those at the end.
    pub u: &'a mut Vec<f64>,
    pub v: &'a mut Vec<f64>,
    /// Times (s) at which free displacements are wanted, and where to put them.
    pub times: &'a [f64],
    pub samples: &'a mut Vec<Vec<f64>>,
    pub clock: &'a Clock,
    pub solved: &'a mut Solved,
}

impl Span<'_> {
    /// Samples the times up to `t1` by the cubic through displacements and velocities at both ends of
    /// the step from `t0` to `t1`.
    pub fn sample_step(&mut self, [t0, t1]: [f64; 2], ends: [[&[f64]; 2]; 2]) {
        let [[u0, v0], [u1, v1]] = ends;
        let h = t1 - t0;
        while let Some(&t) = self.times.get(self.samples.len()).filter(|&&t| t <= t1) {
            let s = (t - t0) / h;
            let r = 1.0 - s;
            let weights =
                [(1.0 + 2.0 * s) * r * r, s * s * (3.0 - 2.0 * s), h * s * r * r, -h * s * s * r];
            let value = |i: usize| {
                weights[0] * u0[i] + weights[1] * u1[i] + weights[2] * v0[i] + weights[3] * v1[i]
            };
            self.samples.push((0..u0.len()).map(value).collect());
        }
    }
}

/// Processor time of this program since it was started.
pub struct Clock {
    start: f64,
    limit: f64,
}

impl Clock {
    #[must_use]
    pub fn new(limit: f64) -> Self {
        Self { start: processor_time(), limit }
    }

    #[must_use]
    pub fn seconds(&self) -> f64 {
        processor_time() - self.start
    }

    /// # Errors
    /// That it took too long.
    pub fn check(&self) -> Result<(), GaveUp> {
        match self.seconds() > self.limit {
            true => Err(GaveUp::timeout(self.limit)),
            false => Ok(()),
        }
    }
}

fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Integrates all phases of `scene` by `phase` and samples it at `times`.
///
/// # Errors
/// Why `phase` gave up.
pub fn solve(
    scene: &Scene,
    times: &[f64],
    limit: f64,
    mut phase: impl FnMut(Stage, Span) -> Result<Stage, GaveUp>,
) -> Result<Solved, GaveUp> {
    let rest = vec![0.0; scene.body().dofs()];
    let (mut all_u, mut all_v) = (rest.clone(), rest);
    let mut solved = Solved::default();
    let clock = Clock::new(limit);
    let (mut from, mut taken) = (0.0, 0);
    for number in 0..scene.phases().len() {
        let to = scene.phases()[number].end();
        let stage = Stage::new(scene, number, &all_u, &all_v)?;
        let (mut u, mut v) = (stage.free_part(&all_u), stage.free_part(&all_v));
        let own = times[taken..].iter().filter(|&&t| t <= to).count();
        let mut samples = Vec::new();
        let times = &times[taken..taken + own];
        taken += own;
        let span = Span {
            from,
            to,
            u: &mut u,
            v: &mut v,
            times,
            samples: &mut samples,
            clock: &clock,
            solved: &mut solved,
        };
        let mut stage = phase(stage, span)?;
        for (t, sample) in times.iter().zip(&samples) {
            solved.u.extend_from_slice(stage.complete(*t, sample, &v)[0]);
        }
        let [u, v] = stage.complete(to, &u, &v);
        (all_u, all_v) = (u.to_vec(), v.to_vec());
        from = to;
    }
    solved.seconds = clock.seconds();
    Ok(solved)
}
