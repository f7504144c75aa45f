//! Switches of the equations, where derivatives are computed: at events, and where none was declared.
//!
//! A right-hand side that jumps where an unknown or a parameter says so makes derivatives jump, too. At events
//! that is known. Elsewhere it shows in steps that fail and become short: the equations are then evaluated along
//! the step, and a jump remains one however closely it is enclosed.

use super::{caution::Caution, error::Reason, run::Run, watch::Root};
use crate::base::vector::{noise, size_or_one};

/// The two sides of a jump of an equation along a step.
struct Edge {
    times: [f64; 2],
    states: [Vec<f64>; 2],
    slopes: [Vec<f64>; 2],
    /// Which equation jumps most, for its size.
    row: usize,
    values: [f64; 2],
}

/// Halvings of a step after which smooth equations have changed by less than [`SMOOTH`] of their change along it.
const FEWEST_HALVINGS: u32 = 4;
const SMOOTH: f64 = 0.4;

/// Changes of an equation, in parts of what changes the state by its tolerance within the step, that are rounding.
const ROUNDING: f64 = 0.01;

/// Shift of unknowns and parameters, relative to their sizes, that shows whether a switch moves with them.
const SHIFT: f64 = 1e-10;

impl Run<'_> {
    /// The sides of the events that the equations keep to; none without derivatives.
    pub(super) fn signs(&self) -> Vec<f64> {
        self.sides.as_ref().map_or(Vec::new(), |sides| sides.lock().signs.clone())
    }

    /// Makes the equations keep to these sides.
    pub(super) fn set_signs(&mut self, signs: &[f64]) {
        if let Some(sides) = &self.sides {
            sides.lock().signs.copy_from_slice(signs);
        }
    }

    /// Makes the equations keep to the sides of the present state; at the roots of events that were met, to
    /// those behind them.
    pub(super) fn choose_sides(&mut self, met: &[(usize, Root)]) -> Result<(), Reason> {
        if self.sides.is_none() {
            return Ok(());
        }
        let mut signs = vec![0.0; self.events.len()];
        for (i, event) in self.events.iter().enumerate() {
            let root = met.iter().find(|(met, root)| *met == i && root.sign != 0);
            let g = event.value(i, self.t, &self.y, &self.parameters)?;
            signs[i] = match root {
                Some((_, root)) if g.abs() <= root.noise => f64::from(root.sign),
                _ if g == 0.0 => 0.0,
                _ => g.signum(),
            };
        }
        self.set_signs(&signs);
        if !signs.contains(&0.0) {
            return Ok(());
        }
        // at a surface the flow leads to one of its sides
        let slope = self.slope_here()?;
        let unit = self.sign * self.unit_of_time(&self.y, &slope);
        for (i, sign) in signs.iter_mut().enumerate().filter(|(_, sign)| **sign == 0.0) {
            let mut values = [1e-9, 1e-7, 1e-5, 1e-3].into_iter().map(|part| {
                let (time, pairs) = (part * unit, self.y.iter().zip(&slope));
                let y: Vec<f64> = pairs.map(|(y, slope)| y + time * slope).collect();
                self.events[i].function.at(self.t + time, &y, &self.parameters)
            });
            let ahead = values.find(|g| *g != 0.0 && !g.is_nan());
            *sign = ahead.map_or(0.0, f64::signum);
        }
        self.set_signs(&signs);
        Ok(())
    }

    /// Tells the equations how the present state changes, after a start or a jump.
    pub(super) fn note_flow(&mut self) -> Result<(), Reason> {
        if self.sides.is_none() {
            return Ok(());
        }
        self.sharpen_derivative()?;
        let slope = self.slope_at(self.t, &self.y.clone(), self.yp.clone())?;
        if let Some(sides) = &self.sides {
            let mut sides = sides.lock();
            sides.flows = vec![(self.t, slope)];
            sides.p.clone_from(&self.parameters);
        }
        Ok(())
    }

    /// Finds the time derivative of a DAE at the present state, where the polynomial of a short step does not tell it.
    pub(super) fn sharpen_derivative(&mut self) -> Result<(), Reason> {
        let Some(sides) = self.sides.clone().filter(|_| !self.yp.is_empty()) else {
            return Ok(());
        };
        let found = self.slope_here()?;
        // of algebraic unknowns that of the last long step
        let flow = sides.lock().flows.first().cloned();
        let flow =
            flow.filter(|_| self.caution.is_short()).map_or(self.yp.clone(), |(_, flow)| flow);
        let pairs = found.into_iter().zip(flow);
        self.yp = pairs.map(|(found, flow)| if found == 0.0 { flow } else { found }).collect();
        Ok(())
    }

    /// Looks at the step just made: whether it may have passed a switch, and how the state changes at its end.
    pub(super) fn note_step(&mut self) -> Result<(), Reason> {
        let Some(sides) = &self.sides else { return Ok(()) };
        let (t, statistics) = (self.engine.t(), self.engine.statistics());
        let failures = statistics.error_test_failures + statistics.step_failures;
        let Caution { failures: before, last, mut until, .. } = self.caution;
        if failures > before {
            until = until.max(last);
        }
        let last = (t - self.t).abs();
        let is_on = failures > before || last < until;
        self.caution = Caution { failures, last, until: if is_on { until } else { 0.0 }, is_on };
        // the polynomial of a step that became short next to a switch is no measure
        let flows = &mut sides.lock().flows;
        if self.caution.is_short() && flows.first().is_some_and(|(at, _)| (t - at).abs() < until) {
            return Ok(());
        }
        flows.resize(1, (t, Vec::new()));
        let (noted, slope) = &mut flows[0];
        *noted = t;
        slope.resize(self.y.len(), 0.0);
        Ok(self.engine.interpolate(t, 1, slope)?)
    }

    /// After an action at event `i`: the equations keep to the side that the solution came from if it `turns`.
    pub(super) fn turn_side(&mut self, i: usize, turns: bool) {
        if let Some(sides) = self.sides.as_ref().filter(|_| turns && self.watches[i].value() == 0.0)
        {
            let signs = &mut sides.lock().signs;
            signs[i] = -signs[i];
        }
    }

    /// Passes to the other sides of these events, at time `t` in the state `y`; returns whether something may jump there, and then does
    /// not pass.
    pub(super) fn switches(
        &mut self,
        met: &[(usize, Root)],
        t: f64,
        y: &[f64],
    ) -> Result<bool, Reason> {
        if self.sides.is_none() {
            return Ok(false);
        }
        let signs = self.signs();
        let mut behind = signs.clone();
        for (i, root) in met.iter().filter(|(_, root)| root.sign != 0) {
            behind[*i] = f64::from(root.sign);
        }
        if behind == signs {
            return Ok(false);
        }
        // a residual has no scale, and a functional or integrands may switch, too
        let only_states = self.carried.as_ref().is_some_and(|carried| !carried.has_integrals());
        if !self.yp.is_empty() || !only_states {
            return Ok(true);
        }
        let left = self.slope_at(t, y, Vec::new())?;
        self.set_signs(&behind);
        let right = self.slope_at(t, y, Vec::new())?;
        let unit = self.unit_of_time(y, &left);
        let jumps = (0..y.len()).any(|i| {
            let tolerance = self.tolerances.rtol * self.tolerances.size_of(i, y[i]);
            (right[i] - left[i]).abs() * unit > 0.1 * tolerance
        });
        if jumps {
            self.set_signs(&signs);
        }
        Ok(jumps)
    }

    /// Refuses a switch of the equations that is no event and moves with unknowns or parameters, in the step just made, up to time `t`.
    pub(super) fn check_step(&mut self, t: f64) -> Result<(), Reason> {
        if self.sides.is_none() || !self.caution.is_on || t == self.t {
            return Ok(());
        }
        match self.find_edge(self.t, t) {
            Some(edge) => self.check_edge(&edge),
            None => Ok(()),
        }
    }

    /// Refuses equations that switch at the break at time `t`, but not because of its time alone.
    pub(super) fn check_break(&mut self, t: f64) -> Result<(), Reason> {
        if self.sides.is_none() {
            return Ok(());
        }
        let times = [self.just_before(t), t];
        let states = [self.y.clone(), self.y.clone()];
        let slopes = [self.yp.clone(), self.yp.clone()];
        let [Some(left), Some(right)] =
            [0, 1].map(|k| self.values(times[k], &states[k], &slopes[k]))
        else {
            return Ok(());
        };
        let jumps = (0..left.len()).map(|i| {
            let size = self.tolerances.size_of(i, self.y[i]);
            ((right[i] - left[i]).abs() / size, i)
        });
        match jumps.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((jump, row)) if jump > 0.0 => {
                let values = [left[row], right[row]];
                self.check_edge(&Edge { times, states, slopes, row, values })
            }
            _ => Ok(()),
        }
    }

    /// The equations at a time and a state, if they have values there.
    fn values(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Option<Vec<f64>> {
        let mut values = vec![0.0; y.len()];
        self.engine.equations(t, y, yp, &mut values).ok()?;
        values.iter().all(|value| value.is_finite()).then_some(values)
    }

    /// State and derivative (of a DAE) at a time within the last step.
    fn within_step(&mut self, t: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let (mut y, mut yp) = (vec![0.0; self.y.len()], vec![0.0; self.yp.len()]);
        self.engine.interpolate(t, 0, &mut y).ok()?;
        if !yp.is_empty() {
            self.engine.interpolate(t, 1, &mut yp).ok()?;
        }
        Some((y, yp))
    }

    fn values_within_step(&mut self, t: f64) -> Option<Vec<f64>> {
        let (y, yp) = self.within_step(t)?;
        self.values(t, &y, &yp)
    }

    /// A jump of an equation between two times of the last step.
    fn find_edge(&mut self, start: f64, end: f64) -> Option<Edge> {
        let (mut a, mut b) = (start, end);
        let (mut at_a, mut at_b) = (self.values_within_step(a)?, self.values_within_step(b)?);
        let (y, _) = self.within_step(b)?;
        let total: Vec<f64> = at_a.iter().zip(&at_b).map(|(a, b)| (b - a).abs()).collect();
        let tells = |i: usize| {
            let tolerance = self.tolerances.rtol * self.tolerances.size_of(i, y[i]);
            total[i] * (end - start).abs() > ROUNDING * tolerance
        };
        let rows: Vec<usize> = (0..y.len()).filter(|&i| tells(i)).collect();
        // the part of the change of the step that the most of the rows has between two points
        let part = |a: &[f64], b: &[f64]| {
            let parts = rows.iter().map(|&i| ((b[i] - a[i]).abs() / total[i], i));
            parts.fold((0.0, 0), |most, part| if part.0 > most.0 { part } else { most })
        };
        let mut halvings = 0;
        loop {
            let middle = 0.5 * (a + b);
            if middle == a || middle == b || (b - a).abs() < f64::EPSILON * (end - start).abs() {
                break;
            }
            let at_middle = self.values_within_step(middle)?;
            if part(&at_a, &at_middle).0 > part(&at_middle, &at_b).0 {
                (b, at_b) = (middle, at_middle);
            } else {
                (a, at_a) = (middle, at_middle);
            }
            halvings += 1;
            if halvings >= FEWEST_HALVINGS && part(&at_a, &at_b).0 < SMOOTH {
                return None;
            }
        }
        let (jump, row) = part(&at_a, &at_b);
        if jump < SMOOTH {
            return None;
        }
        // rounding is as large between other points
        let values = [at_a[row], at_b[row]];
        for k in 1..=8 {
            let distance = f64::from(k) * 1e-4;
            let points = [a + distance * (start - a), b + distance * (end - b)];
            for (point, value) in points.into_iter().zip(values) {
                let here = self.values_within_step(point)?[row];
                if (here - value).abs() > 0.5 * SMOOTH * (values[1] - values[0]).abs() {
                    return None;
                }
            }
        }
        let ((y, yp), (z, zp)) = (self.within_step(a)?, self.within_step(b)?);
        Some(Edge { times: [a, b], states: [y, z], slopes: [yp, zp], row, values })
    }

    /// Refuses a jump of the equations that moves with what the derivatives are to: one that comes at a fixed
    /// time adds nothing to them.
    fn check_edge(&mut self, edge: &Edge) -> Result<(), Reason> {
        let p = self.parameters.clone();
        let moves = self.directions(&edge.states[0]).iter().any(|(dy, dp)| {
            [SHIFT, -SHIFT].iter().any(|shift| {
                let along = |from: &[f64], direction: &[f64]| {
                    from.iter().zip(direction).map(|(x, d)| x + shift * d).collect::<Vec<f64>>()
                };
                self.engine.set_parameters(&along(&p, dp));
                let others = [0, 1].map(|k| {
                    let y = along(&edge.states[k], dy);
                    let values = self.values(edge.times[k], &y, &edge.slopes[k]);
                    values.map_or(edge.values[k], |values| values[edge.row])
                });
                let [left, right] = edge.values;
                let most = 0.5 * (right - left).abs();
                others.iter().zip(edge.values).any(|(other, value)| (other - value).abs() > most)
            })
        });
        self.engine.set_parameters(&p);
        if !moves {
            return Ok(());
        }
        let [before, after] = edge.values;
        Err(Reason::Switch { t: edge.times[1], equation: edge.row, before, after })
    }

    /// Directions in the unknowns and the parameters that the derivatives are to, each as long as these are large.
    fn directions(&self, y: &[f64]) -> Vec<(Vec<f64>, Vec<f64>)> {
        let p = &self.parameters;
        let sizes: Vec<f64> = (0..y.len()).map(|i| self.tolerances.size_of(i, y[i])).collect();
        let p_sizes: Vec<f64> = p.iter().map(|p| size_or_one(*p)).collect();
        let Some(carried) = &self.carried else {
            let random = |sizes: &[f64]| -> Vec<f64> {
                sizes.iter().zip(noise(sizes.len(), 1)).map(|(size, part)| size * part).collect()
            };
            let still = |x: &[f64]| vec![0.0; x.len()];
            return vec![(random(&sizes), still(p)), (still(y), random(&p_sizes))];
        };
        let columns = carried.s.chunks(y.len()).zip(carried.dp.chunks(p.len()));
        let scaled = columns.map(|(s, dp)| {
            let parts = s.iter().zip(&sizes).chain(dp.iter().zip(&p_sizes));
            let longest = parts.map(|(d, size)| (d / size).abs()).fold(f64::MIN_POSITIVE, f64::max);
            let scaled = |x: &[f64]| x.iter().map(|x| x / longest).collect();
            (scaled(s), scaled(dp))
        });
        scaled.collect()
    }
}
