//! Pressures of liquids between the ends of steps.
//!
//! In a liquid that fills its chamber an error of the volume of a millionth is 2.2 kPa, and an interpolated state has
//! errors as large as its tolerances, so that it does not determine the pressure. At the ends of steps the pressure is part of a balance of
//! forces. It is interpolated in between, by a parabola, and the walls are moved to the corresponding volume: by less than
//! the tolerances, and as an impulse of the pressure would move them.

use super::ends::Ends;
use super::{System, flow_of};
use crate::base::simd::add_multiple;
use crate::base::vector::dot;
use crate::dynamics::state::{State, StateMut};

/// Multiples of the tolerance of an amount by which volumes are changed at most, each relative to the whole. Beyond them the pressure
/// deviates from a parabola.
const LARGEST_CHANGE: f64 = 10.0;

/// Rounds over the chambers: walls of one may be those of another.
const ROUNDS: usize = 3;

impl System {
    /// Whether liquids fill their chambers whole.
    pub(crate) fn holds_liquid(&self) -> bool {
        flow_of(&self.flow).is_some_and(|flow| flow.is_stiff())
    }

    /// Lets pressures between the ends of steps be interpolated, where amounts have these `tolerances`.
    pub(crate) fn settle_between(&mut self, tolerances: &[f64]) {
        if self.holds_liquid() {
            let nothing = vec![f64::NAN; tolerances.len()];
            let [gradient, motion] = [vec![0.0; self.dofs()], vec![0.0; self.dofs()]];
            let demands = vec![0.0; self.rows.len()];
            self.ends = Ends {
                tolerances: tolerances.to_vec(),
                times: [f64::NAN; 4],
                pressures: std::array::from_fn(|_| nothing.clone()),
                gradient,
                motion,
                multipliers: demands.clone(),
                demands,
            };
        }
    }

    /// Keeps the pressures of a `state` at time `t` (s) to which a step has led, or from which one begins.
    pub(crate) fn keep_end(&self, ends: &mut Ends, t: f64, state: &[f64]) {
        let Some(flow) = flow_of(&self.flow).filter(|_| !ends.tolerances.is_empty()) else {
            return;
        };
        if ends.times[3] == t {
            return;
        }
        ends.times.rotate_left(1);
        ends.pressures.rotate_left(1);
        ends.times[3] = t;
        let State { u, internal, .. } = self.layout.of(state);
        flow.write_pressures(u, self.layout.split(internal).1, &mut ends.pressures[3]);
    }

    /// The pressures at the ends of the last steps.
    pub(crate) fn ends_mut(&mut self) -> &mut Ends {
        &mut self.ends
    }

    /// Gives liquids in an interpolated `state` at time `t` (s) the pressures between those at the ends of the last step.
    pub(crate) fn settle(&mut self, t: f64, state: &mut [f64]) {
        let Self { flow, ends, rows, inertia, layout, .. } = self;
        let Some(flow) = flow_of(flow).filter(|_| !ends.tolerances.is_empty()) else { return };
        if !(ends.times[2]..=ends.times[3]).contains(&t) {
            return;
        }
        // rigid pieces turn on as they do
        inertia.edges.iter_mut().for_each(|edges| edges.demands.fill(0.0));
        let StateMut { u, internal, .. } = layout.of_mut(state);
        let (_, amounts) = layout.split(internal);
        for (room, &amount) in (0..ROUNDS).flat_map(|_| amounts.iter().enumerate()) {
            let pressure = ends.pressure(room, t);
            let Ends { tolerances, gradient, motion, demands, multipliers, .. } = &mut *ends;
            let lacks = flow.missing(room, u, [amount, pressure], gradient);
            let largest = LARGEST_CHANGE * tolerances[room] / amount;
            let Some([lacks, _]) = lacks.filter(|[lacks, volume]| lacks.abs() < largest * volume)
            else {
                continue;
            };
            inertia.solve(rows, gradient, demands, motion, multipliers);
            let compliance = dot(gradient, motion);
            if compliance > 0.0 {
                add_multiple(lacks / compliance, motion, u);
            }
        }
    }
}
