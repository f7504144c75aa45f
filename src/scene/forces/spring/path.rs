//! The path of a spring or a cable: straight lines from place to place.

use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, norm};
use crate::integrators::ode::Failure;

/// A line that is shorter than this fraction of its natural length after a step has collapsed:
/// its direction, and with it the force, is about to flip.
pub(super) const COLLAPSED: f64 = 0.01;

/// Below this fraction of its natural length the direction of a line is round-off. At trial points of a
/// step it may be shorter than [`COLLAPSED`], so that steps are not made smaller to keep away from that.
const NO_DIRECTION: f64 = 1e-9;

/// Straight lines from place to place.
#[derive(Clone)]
pub(super) struct Path {
    pub(super) name: String,
    pub(super) dimension: usize,
    /// The nodes that are its places, in order; none where that is a point of space.
    pub(super) nodes: Vec<Option<usize>>,
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

impl Path {
    /// Number of lines.
    pub(super) fn lines(&self) -> usize {
        self.natural.len()
    }

    /// Difference of `x` between the two ends of a line; it is 0 at a point of space.
    fn difference(&self, line: usize, x: &[f64]) -> [f64; 3] {
        let d = self.dimension;
        let [first, second] = [self.nodes[line], self.nodes[line + 1]]
            .map(|node| node.map_or(&[0.0; 3][..d], |node| &x[node * d..][..d]));
        std::array::from_fn(|i| if i < d { second[i] - first[i] } else { 0.0 })
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
            "{of}spring \"{}\" has collapsed at t = {t} s: {how}, its natural length is {} m. Without a length it \
             has no direction: pull it with less force, or make it stiffer",
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
        let ends = [self.nodes[line], self.nodes[line + 1]];
        for (node, sign) in ends.into_iter().zip([-1.0, 1.0]) {
            let Some(node) = node else { continue };
            for i in 0..self.dimension {
                nodal[node * self.dimension + i] += sign * force * direction[i];
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
        let places = self.nodes.len();
        let pairs = (0..places).flat_map(|p| (p + 1..places).map(move |q| (p, q)));
        let some = pairs.filter(|&(p, q)| all || q == p + 1);
        some.filter_map(|(p, q)| Some([self.nodes[p]?, self.nodes[q]?])).collect()
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

    /// Adds the tangents of a `force` along all lines (N), which pushes apart and falls by `k` (N/m) with the length and
    /// by `c` (N s/m) with its rate: -df/du of place p by place q is k g_p g_q^T + c g_p g_q'^T, and for each
    /// line -(f/l) (I - e e^T) at its ends; -df/dv is c g_p g_q^T.
    pub(super) fn add_tangents(
        &self,
        [k, c]: [f64; 2],
        force: f64,
        (u, v): (&[f64], &[f64]),
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let d = self.dimension;
        for (p, row) in self.nodes.iter().enumerate() {
            let Some(row) = *row else { continue };
            let [of_row, _] = self.gradient(0, p, u, v);
            for (q, column) in self.nodes.iter().enumerate() {
                let Some(column) = *column else { continue };
                if p.abs_diff(q) > 1 && k == 0.0 && c == 0.0 {
                    continue;
                }
                let [of_column, turning] = self.gradient(0, q, u, v);
                if let Some(block) = stiffness.block_mut(row, column) {
                    for (entry, x) in block.iter_mut().enumerate() {
                        let (i, j) = (entry / d, entry % d);
                        let bent = of_row[i] * (k * of_column[j] + c * turning[j]);
                        *x += bent + self.turn(force, (p, q), (i, j), (u, v));
                    }
                }
                if c == 0.0 {
                    continue;
                }
                if let Some(block) = damping.block_mut(row, column) {
                    for (entry, x) in block.iter_mut().enumerate() {
                        *x += c * of_row[entry / d] * of_column[entry % d];
                    }
                }
            }
        }
    }

    /// The tangent of a constant force along the lines that join the places p and q, which turns with them.
    fn turn(
        &self,
        force: f64,
        (p, q): (usize, usize),
        (i, j): (usize, usize),
        (u, v): (&[f64], &[f64]),
    ) -> f64 {
        let of_line = |line: usize| {
            let Line { length, direction: e, .. } = self.line(line, u, v);
            -force / length * (f64::from(i == j) - e[i] * e[j])
        };
        match p.abs_diff(q) {
            0 => {
                let before = p.checked_sub(1).map(of_line);
                let after = (p < self.lines()).then(|| of_line(p));
                before.into_iter().chain(after).sum()
            }
            1 => -of_line(p.min(q)),
            _ => 0.0,
        }
    }
}
