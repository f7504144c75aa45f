//! The force of a cable: one tension along its path, apart from friction at the places around which it runs.
//!
//! With the length l of the path and the natural length L, a cable of stiffness k and damping c that is driven by a
//! tension f has the tension
//!
//! ```text
//! T = max(0, k max(0, l - L) + f + c l')    0 where neither stretch nor drive keeps it taut
//! ```
//!
//! and one that a winch has drawn in by w
//!
//! ```text
//! T = max(0, k (l - L + w) + c (l' + w'))   0 where it is slack, l < L - w
//! ```
//!
//! The drive pulls at the first place. Where the cable turns by the angle theta around a place and slides towards the drive
//! with the speed s, the tension behind it is smaller by the factor exp(-mu(s) theta) (Euler and Eytelwein), with the
//! friction law of obstacles, which is odd in s. Its stretch is that of the tension at the drive.
//!
//! The force is -T dl/du and its tangent T d2l/du2 + dT/dl (dl/du)(dl/du)^T, which couples all places of the
//! path where it is elastic; a spring with two ends is a path of one line (`path.rs`). The sliding speed at a
//! place is the rate at which the lines behind it shorten, so that one sum over the path is enough, and its
//! heat is never below 0. With friction the exact tangents are not symmetric; the Newton matrix has their
//! symmetric part. Energy in the cable of a winch belongs to no reservoir, as it changes with time: all of
//! its work counts as supplied.

use super::path::Path;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Capabilities, Force, NodalForces, Reservoir, StepCheck, Tangents};
use crate::integrators::ode::Failure;
use crate::scene::forces::friction::Coulomb;
use crate::scene::forces::signal::{self, Signal, finite_at};

/// A cable on its path.
#[derive(Clone)]
pub(super) struct Cable {
    pub(super) path: Path,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    /// Whether its drive gives the length that is drawn in (m), not the tension (N).
    pub(super) is_winch: bool,
    pub(super) friction: Option<Coulomb>,
}

/// The force of a cable with its drive.
pub(super) struct CableForce {
    pub(super) cable: Cable,
    pub(super) drive: Vec<Signal>,
}

/// A tension (N), with its parts and slopes.
#[derive(Clone, Copy, Default)]
struct Tension {
    total: f64,
    /// The part that has a potential.
    elastic: f64,
    /// That of what drives the cable.
    driven: f64,
    /// Derivatives by l and l'.
    slopes: [f64; 2],
}

impl Cable {
    /// The tensions at the drive, which gives a value and its rate, and at the other end (N).
    pub(super) fn tensions_at_ends(&self, u: &[f64], v: &[f64], drive: [f64; 2]) -> [f64; 2] {
        let (at_drive, mut last) = (self.tension(u, v, drive).total, 1.0);
        self.path.each_line(self.friction.as_ref(), (u, v), |_, _, part| last = part);
        [at_drive, last * at_drive]
    }

    fn tension(&self, u: &[f64], v: &[f64], [value, rate]: [f64; 2]) -> Tension {
        let Self { path, stiffness, damping, is_winch, .. } = self;
        let stretch = path.length(u) - path.length + if *is_winch { value } else { 0.0 };
        let driven = if *is_winch { 0.0 } else { value.max(0.0) };
        if stretch <= 0.0 && driven == 0.0 {
            return Tension::default();
        }
        let elastic = stiffness * stretch.max(0.0);
        let lengthening = path.rate(u, v) + if *is_winch { rate } else { 0.0 };
        let total = elastic + driven + damping * lengthening;
        if total <= 0.0 {
            // the damper holds it back, as far as it is stretched or pulled
            return Tension { total: 0.0, elastic, driven, slopes: [0.0; 2] };
        }
        let slope = if stretch > 0.0 { *stiffness } else { 0.0 };
        Tension { total, elastic, driven, slopes: [slope, *damping] }
    }
}

impl CableForce {
    fn drive_at(&self, t: f64) -> [f64; 2] {
        [signal::sum(&self.drive, t), self.drive.iter().map(|signal| signal.rate(t)).sum()]
    }
}

impl Force for CableForce {
    /// The tension with a potential is conservative, that of the drive supplied, and the rest dissipates. All that a winch
    /// exerts is supplied: what its cable stores, too.
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let Self { cable, .. } = self;
        cable.path.check_lengths(t, u)?;
        let drive = self.drive_at(t);
        finite_at(t, format_args!("the drive of cable \"{}\"", cable.path.name), drive[0])?;
        let Tension { total, elastic, driven, .. } = cable.tension(u, v, drive);
        let NodalForces { conservative, dissipative, applied, .. } = forces;
        let (path, has_friction) = (&cable.path, cable.friction.is_some());
        path.each_line(cable.friction.as_ref(), (u, v), |number, line, part| {
            let add = |tension: f64, nodal: &mut [f64]| {
                path.add(number, -tension, &line.direction, nodal);
            };
            if cable.is_winch {
                add(total, applied);
            } else {
                add(elastic, conservative);
                if driven > 0.0 {
                    add(driven, applied);
                }
                if cable.damping > 0.0 {
                    add(total - elastic - driven, dissipative);
                }
            }
            if has_friction {
                add((part - 1.0) * total, dissipative);
            }
        });
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let Cable { path, friction, .. } = &self.cable;
        let Tension { total, slopes, .. } = self.cable.tension(u, v, self.drive_at(t));
        if total > 0.0 {
            path.add_tangents(slopes, total, friction.as_ref(), (u, v), stiffness, damping);
        }
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let Cable { path, stiffness, is_winch, .. } = &self.cable;
        if *is_winch {
            return 0.0;
        }
        0.5 * stiffness * (path.length(u) - path.length).max(0.0).powi(2)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        let Cable { path, stiffness, damping, friction, .. } = &self.cable;
        path.couplings(*stiffness > 0.0 || *damping > 0.0 || friction.is_some())
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.cable.path.nodes())
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { step_check: Some(self), ..Capabilities::default() }
    }
}

impl StepCheck for CableForce {
    fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        self.cable.path.check_step(t, before, after)
    }
}
