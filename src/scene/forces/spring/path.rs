//! The path of a spring or a cable: straight lines from place to place.

use super::bend::Bend;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{distinct, dot, norm};
use crate::integrators::ode::Failure;
use crate::scene::forces::friction::Coulomb;

/// A line that is shorter than this fraction of its natural length after a step has collapsed:
/// its direction, and with it the force, is about to flip.
pub(super) const COLLAPSED: f64 = 0.01;

/// Below this fraction of its natural length the direction of a line is round-off. At trial points of a
/// step it may be shorter than [`COLLAPSED`], so that steps are not made smaller to keep away from that.
const NO_DIRECTION: f64 = 1e-9;

/// Straight lines from place to place.
#[derive(Clone)]
pub(super) struct Path {
    /// A spring or a cable, and its name.
    pub(super) what: &'static str,
    pub(super) name: String,
    pub(super) dimension: usize,
    /// The nodes with which its places move, in order, and their shares; none of points of space.
    pub(super) places: Vec<Vec<(usize, f64)>>,
    /// From each place to the next in the undeformed shape (m).
    pub(super) natural: Vec<[f64; 3]>,
    /// The natural length L of all lines together (m).
    pub(super) length: f64,
}

/// One of the lines at one instant; components beyond the dimension are 0.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) length: f64,
    /// Unit vector e from its first end to its second.
    pub(super) direction: [f64; 3],
    /// Rate of the length.
    pub(super) rate: f64,
    /// e', the transverse velocity divided by the length.
    turning: [f64; 3],
}

impl Line {
    /// Angle of the path to the `next` line.
    fn bend(&self, next: &Self) -> Bend {
        Bend::new([&self.direction, &next.direction], [self.length, next.length])
    }
}

impl Path {
    /// Number of lines.
    pub(super) fn lines(&self) -> usize {
        self.natural.len()
    }

    /// Difference of `x` between the two ends of a line; it is 0 at a point of space.
    fn difference(&self, line: usize, x: &[f64]) -> [f64; 3] {
        let (d, mut difference) = (self.dimension, [0.0; 3]);
        for (place, sign) in self.places[line..].iter().zip([-1.0, 1.0]) {
            for &(node, share) in place {
                let own = &x[node * d..][..d];
                difference.iter_mut().zip(own).for_each(|(sum, x)| *sum += sign * share * x);
            }
        }
        difference
    }

    /// From the first end of a line to its second, with its length.
    fn along(&self, line: usize, u: &[f64]) -> (f64, [f64; 3]) {
        let moved = self.difference(line, u);
        let along: [f64; 3] = std::array::from_fn(|i| self.natural[line][i] + moved[i]);
        (norm(&along), along)
    }

    /// The length l of all lines together under the displacements `u`.
    pub(super) fn length(&self, u: &[f64]) -> f64 {
        (0..self.lines()).map(|line| self.along(line, u).0).sum()
    }

    /// Its rate l'.
    pub(super) fn rate(&self, u: &[f64], v: &[f64]) -> f64 {
        (0..self.lines()).map(|line| self.line(line, u, v).rate).sum()
    }

    pub(super) fn line(&self, line: usize, u: &[f64], v: &[f64]) -> Line {
        let (length, along) = self.along(line, u);
        let direction = along.map(|x| x / length);
        let velocity = self.difference(line, v);
        let rate = dot(&direction, &velocity);
        let turning = std::array::from_fn(|i| (velocity[i] - rate * direction[i]) / length);
        Line { length, direction, rate, turning }
    }

    /// The length of a line by which it is judged: that of a spring with two ends is its own.
    fn natural_length(&self, line: usize) -> f64 {
        if self.lines() == 1 { self.length } else { norm(&self.natural[line]) }
    }

    fn collapsed(&self, t: f64, line: usize, how: &str) -> Failure {
        let of = match self.lines() {
            1 => String::new(),
            lines => format!("line {} of {lines} of ", line + 1),
        };
        Failure::Recoverable(format!(
            "{of}{} \"{}\" has collapsed at t = {t} s: {how}, its natural length is {} m. Without a length it \
             has no direction: pull it with less force, or make it stiffer",
            self.what,
            self.name,
            self.natural_length(line)
        ))
    }

    /// # Errors
    /// A line without length, and so without direction.
    pub(super) fn check_lengths(&self, t: f64, u: &[f64]) -> Result<(), Failure> {
        let none =
            |&line: &usize| self.along(line, u).0 <= NO_DIRECTION * self.natural_length(line);
        match (0..self.lines()).find(none) {
            Some(line) => Err(self.collapsed(t, line, "it has no length")),
            None => Ok(()),
        }
    }

    /// A line that turns by more than a right angle in one step has passed through a length of 0.
    pub(super) fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        for line in 0..self.lines() {
            let (length, along) = self.along(line, after);
            if length <= COLLAPSED * self.natural_length(line) {
                return Err(self.collapsed(t, line, &format!("it is {length:.1e} m long")));
            }
            if dot(&self.along(line, before).1, &along) <= 0.0 {
                let how = "its ends have passed each other within one step";
                return Err(self.collapsed(t, line, how));
            }
        }
        Ok(())
    }

    /// Adds a force along one of the lines (N), which pushes its ends apart.
    pub(super) fn add(&self, line: usize, force: f64, direction: &[f64; 3], nodal: &mut [f64]) {
        for (place, sign) in self.places[line..].iter().zip([-1.0, 1.0]) {
            for &(node, share) in place {
                let own = &mut nodal[node * self.dimension..][..self.dimension];
                own.iter_mut().zip(direction).for_each(|(x, e)| *x += sign * share * force * e);
            }
        }
    }

    /// Adds a force along all lines (N).
    pub(super) fn add_along(&self, force: f64, u: &[f64], v: &[f64], nodal: &mut [f64]) {
        for line in 0..self.lines() {
            self.add(line, force, &self.line(line, u, v).direction, nodal);
        }
    }

    /// The pairs of nodes that the lines join; with `all` those of all places, as their distances add up.
    pub(super) fn couplings(&self, all: bool) -> Vec<[usize; 2]> {
        let places = self.places.len();
        let pairs = (0..places).flat_map(|p| (p..places).map(move |q| (p, q)));
        let some = pairs.filter(|&(p, q)| all || q <= p + 1);
        let nodes = |place: usize| self.places[place].iter().map(|&(node, _)| node);
        let joined =
            some.flat_map(|(p, q)| nodes(p).flat_map(move |a| nodes(q).map(move |b| [a, b])));
        joined.filter(|[a, b]| a != b).collect()
    }

    /// The nodes with which its places move, each once.
    pub(super) fn nodes(&self) -> Vec<usize> {
        distinct(self.places.iter().flatten().map(|&(node, _)| node))
    }

    /// The derivative g of the length of the lines from number `first` on by a place, and g'.
    pub(super) fn gradient(
        &self,
        first: usize,
        place: usize,
        u: &[f64],
        v: &[f64],
    ) -> [[f64; 3]; 2] {
        let mut sum = [[0.0; 3]; 2];
        let mut add = |sign: f64, line: &Line| {
            for (sum, x) in sum.iter_mut().zip([line.direction, line.turning]) {
                sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += sign * x);
            }
        };
        if place > first {
            add(1.0, &self.line(place - 1, u, v));
        }
        if place >= first && place < self.lines() {
            add(-1.0, &self.line(place, u, v));
        }
        sum
    }

    /// Passes the lines to `see`, each with its number and the part of the tension at the first place that `friction` leaves.
    pub(super) fn each_line(
        &self,
        friction: Option<&Coulomb>,
        (u, v): (&[f64], &[f64]),
        mut see: impl FnMut(usize, &Line, f64),
    ) {
        let Some(coulomb) = friction else {
            (0..self.lines()).for_each(|line| see(line, &self.line(line, u, v), 1.0));
            return;
        };
        // towards the first place slides what the lines behind lose in length
        let (mut behind, mut part) = (self.rate(u, v), 1.0);
        let mut before: Option<Line> = None;
        for number in 0..self.lines() {
            let line = self.line(number, u, v);
            if let Some(before) = &before {
                let speed = -behind;
                let friction = coulomb.drag(speed.abs()).per_speed * speed;
                part *= (-friction * before.bend(&line).angle).exp();
            }
            see(number, &line, part);
            behind -= line.rate;
            before = Some(line);
        }
    }

    /// Adds the tangents of a `tension` T (N) in all lines, of which friction leaves the part r_k in line k of length l_k: with
    /// T_k = r_k T they are dT_k dl_k/du + T_k d2l_k/du2, where T changes with the length of the path (N/m) and its rate (N s/m),
    /// and r_k with the angles at the places before the line and with the speeds there.
    pub(super) fn add_tangents(
        &self,
        [by_length, by_rate]: [f64; 2],
        tension: f64,
        friction: Option<&Coulomb>,
        (u, v): (&[f64], &[f64]),
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let d = self.dimension;
        for (q, columns) in self.places.iter().enumerate() {
            if columns.is_empty() {
                continue;
            }
            let [of_length, turning] = self.gradient(0, q, u, v);
            // log r_k and its derivatives by the place q
            let (mut log, mut log_by_u, mut log_by_v) = (0.0, [0.0; 3], [0.0; 3]);
            let (mut behind, mut before) = (self.rate(u, v), None::<Line>);
            for k in 0..self.lines() {
                let line = self.line(k, u, v);
                if let (Some(coulomb), Some(before)) = (friction, &before) {
                    let drag = coulomb.drag(behind.abs());
                    let bend = before.bend(&line);
                    let (held, by_place) = (-drag.per_speed * behind, bend.by_place(k, q));
                    let [of_behind, turning] = self.gradient(k, q, u, v);
                    log -= held * bend.angle;
                    for i in 0..d {
                        log_by_u[i] += bend.angle * drag.along * turning[i] - held * by_place[i];
                        log_by_v[i] += bend.angle * drag.along * of_behind[i];
                    }
                }
                let part = log.exp();
                let e = &line.direction;
                for (p, sign) in [(k, -1.0), (k + 1, 1.0)] {
                    let bends = match q {
                        _ if q == p => 1.0,
                        _ if q == k || q == k + 1 => -1.0,
                        _ => 0.0,
                    };
                    let (mut by_place, mut by_speed) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
                    for i in 0..d {
                        for j in 0..d {
                            let change = by_length * of_length[j]
                                + by_rate * turning[j]
                                + tension * log_by_u[j];
                            let turn =
                                bends * tension / line.length * (f64::from(i == j) - e[i] * e[j]);
                            let along = sign * e[i];
                            by_place[i][j] = part * (along * change + turn);
                            by_speed[i][j] = part
                                * (by_rate * along * of_length[j] + along * tension * log_by_v[j]);
                        }
                    }
                    for &(row, of_row) in &self.places[p] {
                        for &(column, of_column) in columns {
                            let share = of_row * of_column;
                            add_shared(stiffness, [row, column], share, &by_place);
                            add_shared(damping, [row, column], share, &by_speed);
                        }
                    }
                }
                behind -= line.rate;
                before = Some(line);
            }
        }
    }
}

/// Adds `share` times the first rows and columns of `derivatives` to a block, if there is one.
fn add_shared(
    matrix: &mut BlockMatrix,
    [row, column]: [usize; 2],
    share: f64,
    derivatives: &[[f64; 3]; 3],
) {
    let Some(block) = matrix.block_mut(row, column) else { return };
    let d = block.len().isqrt();
    for (entry, x) in block.iter_mut().enumerate() {
        *x += share * derivatives[entry / d][entry % d];
    }
}
