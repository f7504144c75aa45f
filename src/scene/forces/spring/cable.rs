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

use super::path::{Line, Path};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, norm};
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
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
    /// The tension at the drive (N), which gives `value` and its `rate`.
    pub(super) fn tension_at_drive(&self, u: &[f64], v: &[f64], drive: [f64; 2]) -> f64 {
        self.tension(u, v, drive).total
    }

    /// The tension at the other end (N).
    pub(super) fn tension_at_end(&self, u: &[f64], v: &[f64], drive: [f64; 2]) -> f64 {
        let mut last = 1.0;
        self.each_line(u, v, |_, _, part| last = part);
        last * self.tension(u, v, drive).total
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

    /// Adds the tangents: with the tension T_k = r_k T of line k of length l_k, dT_k dl_k/du + T_k d2l_k/du2, where T changes with the
    /// length and its rate, and r_k with the angles at the places before the line and with the speeds there.
    fn add_tangents(
        &self,
        tension: &Tension,
        (u, v): (&[f64], &[f64]),
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let (path, d) = (&self.path, self.path.dimension);
        let Tension { total, slopes: [by_length, by_rate], .. } = *tension;
        for (q, column) in path.nodes.iter().enumerate() {
            let Some(column) = *column else { continue };
            let [of_length, turning] = path.gradient(0, q, u, v);
            // log r_k and its derivatives by the place q
            let (mut log, mut log_by_u, mut log_by_v) = (0.0, [0.0; 3], [0.0; 3]);
            let (mut behind, mut before) = (path.rate(u, v), None::<Line>);
            for k in 0..path.lines() {
                let line = path.line(k, u, v);
                if let (Some(coulomb), Some(before)) = (&self.friction, &before) {
                    let drag = coulomb.drag(behind.abs());
                    let bend = Bend::new(before, &line);
                    let (friction, by_place) = (-drag.per_speed * behind, bend.by_place(k, q));
                    let [of_behind, turning] = path.gradient(k, q, u, v);
                    log -= friction * bend.angle;
                    for i in 0..d {
                        log_by_u[i] +=
                            bend.angle * drag.along * turning[i] - friction * by_place[i];
                        log_by_v[i] += bend.angle * drag.along * of_behind[i];
                    }
                }
                let part = log.exp();
                let e = &line.direction;
                for (p, sign) in [(k, -1.0), (k + 1, 1.0)] {
                    let Some(row) = path.nodes[p] else { continue };
                    let bends = match q {
                        _ if q == p => 1.0,
                        _ if q == k || q == k + 1 => -1.0,
                        _ => 0.0,
                    };
                    if let Some(block) = stiffness.block_mut(row, column) {
                        for (entry, x) in block.iter_mut().enumerate() {
                            let (i, j) = (entry / d, entry % d);
                            let change = by_length * of_length[j]
                                + by_rate * turning[j]
                                + total * log_by_u[j];
                            let turn =
                                bends * total / line.length * (f64::from(i == j) - e[i] * e[j]);
                            *x += part * (sign * e[i] * change + turn);
                        }
                    }
                    if let Some(block) = damping.block_mut(row, column) {
                        for (entry, x) in block.iter_mut().enumerate() {
                            let (i, j) = (entry / d, entry % d);
                            let change = by_rate * of_length[j] + total * log_by_v[j];
                            *x += part * sign * e[i] * change;
                        }
                    }
                }
                behind -= line.rate;
                before = Some(line);
            }
        }
    }

    /// Passes the lines to `see`, each with its number and the part of the tension at the drive that friction leaves.
    fn each_line(&self, u: &[f64], v: &[f64], mut see: impl FnMut(usize, &Line, f64)) {
        let path = &self.path;
        let Some(coulomb) = &self.friction else {
            (0..path.lines()).for_each(|line| see(line, &path.line(line, u, v), 1.0));
            return;
        };
        // towards the drive slides what the lines behind lose in length
        let (mut behind, mut part) = (path.rate(u, v), 1.0);
        let mut before: Option<Line> = None;
        for number in 0..path.lines() {
            let line = path.line(number, u, v);
            if let Some(before) = &before {
                let speed = -behind;
                let friction = coulomb.drag(speed.abs()).per_speed * speed;
                part *= (-friction * Bend::new(before, &line).angle).exp();
            }
            see(number, &line, part);
            behind -= line.rate;
            before = Some(line);
        }
    }
}

/// Below this angle (rad) a bend is smoothed: its angle would have a kink where the cable is straight.
const STRAIGHT: f64 = 1e-3;

/// How the path turns from one line to the next.
struct Bend {
    /// theta^2/(theta^2 + s^2)^(1/2), with the angle theta and the angle s of what counts as straight.
    angle: f64,
    /// Its derivatives by the vectors along the two lines.
    by_lines: [[f64; 3]; 2],
}

impl Bend {
    fn new(before: &Line, behind: &Line) -> Self {
        let (a, b) = (&before.direction, &behind.direction);
        let [sum, difference] =
            [1.0, -1.0].map(|sign| norm(&std::array::from_fn::<f64, 3, _>(|i| a[i] + sign * b[i])));
        let theta = 2.0 * difference.atan2(sum);
        let smooth = theta.hypot(STRAIGHT);
        // d theta = -d(a.b)/sin(theta)
        let ratio = if theta < 1e-6 { 1.0 } else { theta / theta.sin() };
        let slope = -ratio * (theta * theta + 2.0 * STRAIGHT * STRAIGHT) / smooth.powi(3);
        let cosine = dot(a, b);
        let by_lines = [
            std::array::from_fn(|i| slope * (b[i] - cosine * a[i]) / before.length),
            std::array::from_fn(|i| slope * (a[i] - cosine * b[i]) / behind.length),
        ];
        Self { angle: theta * theta / smooth, by_lines }
    }

    /// Its derivative by the place `q`, where it is at the place `k` between the lines.
    fn by_place(&self, k: usize, q: usize) -> [f64; 3] {
        let [a, b] = &self.by_lines;
        match q {
            _ if q + 1 == k => a.map(|x| -x),
            _ if q == k => std::array::from_fn(|i| a[i] - b[i]),
            _ if q == k + 1 => *b,
            _ => [0.0; 3],
        }
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
        cable.each_line(u, v, |number, line, part| {
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

    fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        self.cable.path.check_step(t, before, after)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let tension = self.cable.tension(u, v, self.drive_at(t));
        if tension.total > 0.0 {
            self.cable.add_tangents(&tension, (u, v), stiffness, damping);
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
}
