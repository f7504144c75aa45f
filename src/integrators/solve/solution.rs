//! Solution of a run.
//!
//! A step is kept by its states at Chebyshev's points, as many as the degree of the interpolant requires, and
//! evaluated by the barycentric formula: the polynomial of the integrator to round-off, in whatever form the
//! integrator has it.

use std::fmt;

use faer::MatRef;

use super::{method::MethodUse, saved::Saved};
use crate::base::input::InputError;
use crate::integrators::common::{Statistics, check_length, check_time};

/// An event that was met.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Occurrence {
    /// Which event, in the order of [`Problem::event`](super::Problem::event).
    pub event: usize,
    /// Time.
    pub t: f64,
    /// +1 where its function rises, -1 where it falls, 0 where it touches zero.
    pub sign: i32,
    /// State before any action.
    pub y: Vec<f64>,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum End {
    /// The end of the span is reached.
    Span,
    /// This event was terminal, or its action ended the run.
    Event(usize),
    /// The action of a break ended the run.
    Break,
    /// It was stopped; [`Stopped`](super::Stopped) has the reason.
    Early,
}

/// Times, states and events of a run; with [`Output::Steps`](super::Output::Steps) also all that lies
/// between.
///
/// States are kept one after the other: the one of time `t()[k]` is `y(k)`. Where the solution jumps, a time
/// occurs twice, with the state before and after.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(remote = "Self"))]
pub struct Solution {
    n: usize,
    t: Vec<f64>,
    states: Vec<f64>,
    /// For each time but the first, the index of the first inner node of its step, if interpolants are kept.
    inner: Option<Vec<usize>>,
    /// Inner nodes: states at the [`nodes`] of each step.
    nodes: Vec<f64>,
    /// The sensitivities of each time, one column after the other.
    sensitivities: Vec<f64>,
    /// The integrals of each time.
    quadratures: Vec<f64>,
    /// Their sensitivities, one column after the other.
    #[cfg_attr(feature = "serde", serde(default))]
    quadrature_sensitivities: Vec<f64>,
    pub(super) events: Vec<Occurrence>,
    pub(super) statistics: Statistics,
    pub(super) end: End,
    pub(super) saved: Saved,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) notice: Option<String>,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) methods: Vec<MethodUse>,
}

impl fmt::Debug for Solution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solution")
            .field("unknowns", &self.n)
            .field("times", &self.t.len())
            .field("t", &self.t.last())
            .field("events", &self.events.len())
            .field("end", &self.end)
            .finish_non_exhaustive()
    }
}

/// Saved values at one time: state, sensitivities (one column after the other), integrals and their sensitivities.
#[derive(Clone, Copy)]
pub(super) struct SavedPoint<'r> {
    pub(super) y: &'r [f64],
    pub(super) s: &'r [f64],
    pub(super) q: &'r [f64],
    pub(super) sq: &'r [f64],
}

/// Times of the inner nodes of a step for a polynomial of this degree: the extrema of Chebyshev's polynomial.
///
/// In a step of so few numbers that nodes would be the same ones, all numbers between its ends are nodes.
fn nodes(degree: usize, step: [f64; 2]) -> impl Iterator<Item = f64> {
    let numbers = numbers(step);
    // the nodes at the ends are the closest
    let are_distinct = numbers * extremum(1, degree) >= 1.0;
    let degree = if are_distinct { degree } else { numbers as usize };
    (1..degree).map(move |k| step[0] + node(k, degree, numbers) * (step[1] - step[0]))
}

/// Inner node `k` of a polynomial of this degree, as a fraction of a step of so many numbers.
fn node(k: usize, degree: usize, numbers: f64) -> f64 {
    if degree as f64 == numbers { k as f64 / numbers } else { extremum(k, degree) }
}

fn extremum(k: usize, degree: usize) -> f64 {
    0.5 - 0.5 * (std::f64::consts::PI * k as f64 / degree as f64).cos()
}

/// How many numbers a step has beyond its start.
fn numbers([from, to]: [f64; 2]) -> f64 {
    let latest = from.abs().max(to.abs());
    ((to - from).abs() / (latest.next_up() - latest)).round()
}

/// Steps of fewer numbers have nodes that are rounded by so much that polynomials show it.
const FINE: f64 = 1e8;

impl Solution {
    pub(super) fn new(t: f64, row: SavedPoint<'_>, dense: bool) -> Self {
        Self {
            n: row.y.len(),
            t: vec![t],
            states: row.y.to_vec(),
            inner: dense.then(Vec::new),
            nodes: Vec::new(),
            sensitivities: row.s.to_vec(),
            quadratures: row.q.to_vec(),
            quadrature_sensitivities: row.sq.to_vec(),
            events: Vec::new(),
            statistics: Statistics::default(),
            end: End::Early,
            saved: Saved::default(),
            notice: None,
            methods: Vec::new(),
        }
    }

    /// Adds the state at `t`; `at` writes the state at a time since the last one, if interpolants are
    /// kept.
    pub(super) fn push<E>(
        &mut self,
        t: f64,
        row: SavedPoint<'_>,
        degree: u32,
        mut at: impl FnMut(f64, &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Some(inner) = &mut self.inner {
            let (start, last) = (self.nodes.len(), self.t[self.t.len() - 1]);
            inner.push(start);
            for time in nodes(degree as usize, [last, t]) {
                let place = self.nodes.len();
                self.nodes.resize(place + self.n, 0.0);
                if let Err(error) = at(time, &mut self.nodes[place..]) {
                    inner.pop();
                    self.nodes.truncate(start);
                    return Err(error);
                }
            }
        }
        self.add(t, row);
        Ok(())
    }

    fn add(&mut self, t: f64, row: SavedPoint<'_>) {
        self.t.push(t);
        self.states.extend_from_slice(row.y);
        self.sensitivities.extend_from_slice(row.s);
        self.quadratures.extend_from_slice(row.q);
        self.quadrature_sensitivities.extend_from_slice(row.sq);
    }

    /// Adds the state after a jump.
    pub(super) fn push_jump(&mut self, t: f64, row: SavedPoint<'_>) {
        if let Some(inner) = &mut self.inner {
            inner.push(self.nodes.len());
        }
        self.add(t, row);
    }

    /// The times, in the order of the run.
    #[must_use]
    pub fn t(&self) -> &[f64] {
        &self.t
    }

    /// The state at time `t()[k]`.
    ///
    /// # Panics
    /// If there is no such time.
    #[must_use]
    pub fn y(&self, k: usize) -> &[f64] {
        &self.states[k * self.n..(k + 1) * self.n]
    }

    /// The last state.
    #[must_use]
    pub fn last(&self) -> &[f64] {
        &self.states[self.states.len() - self.n..]
    }

    /// The sensitivities at time `t()[k]`: entry (i, j) is the derivative of unknown i with respect to the
    /// j-th parameter of [`Options::sensitivities`](super::Options::sensitivities), at that fixed time, even
    /// where it is the time of an event that depends on the parameter.
    ///
    /// # Panics
    /// If there is no such time.
    #[must_use]
    pub fn sensitivities(&self, k: usize) -> MatRef<'_, f64> {
        let count = self.sensitivities.len() / self.t.len();
        let s = &self.sensitivities[k * count..(k + 1) * count];
        MatRef::from_column_major_slice(s, self.n, count / self.n)
    }

    /// The integrals of [`Ode::quadratures`](crate::integrators::ode::Ode::quadratures) from the start of the
    /// span to time `t()[k]`; none if the equations have none.
    ///
    /// # Panics
    /// If there is no such time.
    #[must_use]
    pub fn quadratures(&self, k: usize) -> &[f64] {
        let count = self.quadratures.len() / self.t.len();
        &self.quadratures[k * count..(k + 1) * count]
    }

    /// The sensitivities of the integrals at time `t()[k]`, if they are
    /// [wanted](crate::integrators::sundials::Sensitivities::integrals): entry (i, j) is the derivative of integral i with
    /// respect to the j-th parameter of [`Options::sensitivities`](super::Options::sensitivities).
    ///
    /// # Panics
    /// If there is no such time.
    #[must_use]
    pub fn quadrature_sensitivities(&self, k: usize) -> MatRef<'_, f64> {
        let times = self.t.len();
        let (count, rows) =
            (self.quadrature_sensitivities.len() / times, self.quadratures.len() / times);
        let q = &self.quadrature_sensitivities[k * count..(k + 1) * count];
        MatRef::from_column_major_slice(q, rows, count / rows.max(1))
    }

    /// The time derivative of the last state for a DAE; empty otherwise.
    #[must_use]
    pub fn last_yp(&self) -> &[f64] {
        &self.saved.yp
    }

    /// One unknown at all times.
    pub fn component(&self, i: usize) -> impl Iterator<Item = f64> {
        self.states.chunks_exact(self.n).filter_map(move |y| y.get(i).copied())
    }

    /// All states, one after the other: the columns of a matrix of n rows.
    #[must_use]
    pub fn states(&self) -> &[f64] {
        &self.states
    }

    /// All states as the columns of a matrix.
    #[must_use]
    pub fn as_matrix(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.states, self.n, self.t.len())
    }

    /// The state at any time of the run, by the polynomials of the integrator; after the jump where there is
    /// one.
    ///
    /// # Errors
    /// If `t` lies outside the run, or the solution was not kept between its times
    /// ([`Output`](super::Output)).
    pub fn at(&self, t: f64) -> Result<Vec<f64>, InputError> {
        let mut y = vec![0.0; self.n];
        self.at_into(t, &mut y)?;
        Ok(y)
    }

    /// As [`at`](Self::at), into `out`.
    ///
    /// # Errors
    /// As there; or if `out` has another length than the state.
    pub fn at_into(&self, t: f64, out: &mut [f64]) -> Result<(), InputError> {
        check_length("length of out", out.len(), self.n)?;
        check_time("t", t)?;
        let Some(inner) = &self.inner else {
            let help = "the solution between the times was not kept: use Output::Steps";
            return Err(InputError::new("output", "Times or End", help));
        };
        let (start, end) = (self.t[0], self.t[self.t.len() - 1]);
        let sign = if end < start { -1.0 } else { 1.0 };
        if (t - start) * sign < 0.0 || (end - t) * sign < 0.0 {
            return Err(InputError::new("t", t, format!("the run goes from {start} to {end}")));
        }
        // the last time that is not after t; where there is a jump, the entry after it
        let k = self.t.partition_point(|&at| (at - t) * sign <= 0.0) - 1;
        if self.t[k] == t {
            out.copy_from_slice(self.y(k));
            return Ok(());
        }
        let last = inner.get(k + 1).copied().unwrap_or(self.nodes.len());
        let (n, nodes) = (self.n, &self.nodes[inner[k]..last]);
        let degree = nodes.len() / n + 1;
        let state = |j: usize| match j {
            0 => self.y(k),
            j if j == degree => self.y(k + 1),
            j => &nodes[(j - 1) * n..j * n],
        };
        // the barycentric formula of Chebyshev's second kind (J.-P. Berrut, L. N. Trefethen, SIAM Review 46
        // (2004) 501-517)
        let [from, to] = [self.t[k], self.t[k + 1]];
        let part = (t - from) / (to - from);
        let numbers = numbers([from, to]);
        let is_fine = numbers >= FINE;
        let place = |j: usize| match j {
            0 => 0.0,
            j if j == degree => 1.0,
            j if is_fine => extremum(j, degree),
            j => (from + node(j, degree, numbers) * (to - from) - from) / (to - from),
        };
        let weight = |j: usize| {
            let half = if j == 0 || j == degree { 0.5 } else { 1.0 };
            let sign = if j.is_multiple_of(2) { 1.0 } else { -1.0 };
            let known = sign * half;
            let product =
                || (0..=degree).filter(|&i| i != j).map(|i| place(j) - place(i)).product::<f64>();
            (if is_fine { known } else { 1.0 / product() }) / (part - place(j))
        };
        if let Some(j) = (0..=degree).find(|&j| part == place(j)) {
            out.copy_from_slice(state(j));
            return Ok(());
        }
        let total: f64 = (0..=degree).map(weight).sum();
        out.fill(0.0);
        for j in 0..=degree {
            let share = weight(j) / total;
            out.iter_mut().zip(state(j)).for_each(|(out, y)| *out += share * y);
        }
        Ok(())
    }

    /// The events that were met, in the order of the run.
    #[must_use]
    pub fn events(&self) -> &[Occurrence] {
        &self.events
    }

    /// Why the run ended.
    #[must_use]
    pub fn end(&self) -> End {
        self.end
    }

    /// Cost counters of the run.
    #[must_use]
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The methods of the run, each with its first time and why it was used: [`Method::Auto`](super::Method::Auto) changes between several.
    #[must_use]
    pub fn methods(&self) -> &[MethodUse] {
        &self.methods
    }

    /// A warning about the steps, if they were many: [`Run::notice`](super::Run::notice) at the end of the run.
    #[must_use]
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// The state of the run at its end, to continue from there: [`Problem::resume`](super::Problem::resume).
    #[must_use]
    pub fn saved(&self) -> &Saved {
        &self.saved
    }

    /// The parameters of the equations at the end.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.saved.parameters
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Solution {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Solution {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let solution = Self::deserialize(deserializer)?;
        match solution.fits() {
            true => Ok(solution),
            false => {
                Err(serde::de::Error::custom("the arrays of the solution do not fit together"))
            }
        }
    }
}

#[cfg(feature = "serde")]
impl Solution {
    /// Whether the lengths of the arrays fit together, for a solution that was read.
    fn fits(&self) -> bool {
        let (n, times) = (self.n, self.t.len());
        let nodes = self.nodes.len();
        let inner = self.inner.as_ref().is_none_or(|inner| {
            let ends = inner.iter().copied().chain([nodes]);
            let ordered = ends.clone().zip(ends.clone().skip(1)).all(|(start, end)| start <= end);
            inner.len() + 1 == times && ordered && ends.into_iter().all(|end| end % n.max(1) == 0)
        });
        let integrals = self.quadratures.len();
        let fits_integrals = self.quadrature_sensitivities.is_empty()
            || integrals > 0 && self.quadrature_sensitivities.len().is_multiple_of(integrals);
        n > 0
            && times > 0
            && self.states.len() == n * times
            && self.sensitivities.len().is_multiple_of(n * times)
            && self.quadratures.len().is_multiple_of(times)
            && fits_integrals
            && inner
    }
}
