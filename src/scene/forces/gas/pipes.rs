//! Coupling of pipes to the liquids at their ends.
//!
//! The specific energy is mu = dE/dm (J/kg) in a liquid, with its pressure and its height, and p/rho + g z in a supply.
//! The flow q of a pipe, an unknown of its own, is driven by rho (mu_1 - mu_2). So it changes the total energy of the
//! liquids and the pipe only by friction and by the supplies.
//!
//! In the elimination of amounts S, Qm and Qv have rows for the flows, C has none, as a flow exerts no force.
//! Heights count from the origin of the scene. Absolute tolerances of flows are those of velocities times the
//! area A; the kinetic energy of a pipe is (1/2) (rho l/A) q^2.

use super::AmountFlow;
use crate::elements::force::{Flow, FlowDerivatives, NodalForces};
use crate::integrators::ode::Failure;
use crate::scene::forces::pipe::{Mouth, PipeFlow};

/// Sense of the flow at both ends: out of the first, into the second.
const SENSES: [f64; 2] = [-1.0, 1.0];

impl AmountFlow {
    /// Adds the rates (kg/s) of the amounts of liquids, writes those of the flows (m^3/s^2), and adds the power (W) that becomes heat. Returns the power that supplies give.
    ///
    /// # Errors
    /// As [`mu`](Self::mu).
    pub(super) fn add_pipes(
        &self,
        t: f64,
        [u, unknowns]: [&[f64]; 2],
        forces: &mut NodalForces,
        rates: &mut [f64],
    ) -> Result<f64, Failure> {
        let mut supplied = 0.0;
        for (at, pipe) in (self.reservoirs()..).zip(&self.pipes) {
            let flow = unknowns[at];
            let [friction, _] = pipe.friction(flow);
            let mut drive = -friction;
            for (end, sense) in SENSES.into_iter().enumerate() {
                let [mu, _] = self.mu(t, pipe, end, [u, unknowns])?;
                drive -= sense * pipe.density * mu;
                match &pipe.ends[end] {
                    Mouth::Liquid(number) => {
                        rates[self.gases.len() + number] += sense * pipe.density * flow;
                    }
                    Mouth::Given(..) => supplied -= sense * pipe.density * mu * flow,
                }
            }
            rates[at] = drive / pipe.inertance;
            forces.carried_heat += friction * flow;
        }
        Ok(supplied)
    }

    /// Adds the derivatives of what [`add_pipes`](Self::add_pipes) adds; -dp/dV and dp/dm of the liquids are there.
    ///
    /// # Errors
    /// As [`add_pipes`](Self::add_pipes).
    pub(super) fn linearize_pipes(
        &self,
        t: f64,
        at: [&[f64]; 2],
        derivatives: &mut FlowDerivatives,
    ) -> Result<(), Failure> {
        let FlowDerivatives { pressures: [_, pressing], rates, power, heat, .. } = derivatives;
        let [by_volumes, by_unknowns] = rates;
        let (rooms, count) = (self.reservoirs(), self.start.len());
        for (row, pipe) in (rooms..).zip(&self.pipes) {
            let flow = at[1][row];
            let [friction, slope] = pipe.friction(flow);
            by_unknowns[row * count + row] = -slope / pipe.inertance;
            heat[row] = friction + slope * flow;
            power[1][row] = 0.0;
            for (end, sense) in SENSES.into_iter().enumerate() {
                let [mu, slope] = self.mu(t, pipe, end, at)?;
                match &pipe.ends[end] {
                    Mouth::Liquid(number) => {
                        let room = self.gases.len() + number;
                        let drive = -sense * pipe.density / pipe.inertance;
                        // d^2E/dm du is less the derivative of the forces by the amount
                        by_volumes[row * rooms + room] -= drive * pressing[room];
                        by_unknowns[row * count + room] += drive * slope;
                        by_unknowns[room * count + row] += sense * pipe.density;
                    }
                    Mouth::Given(..) => power[1][row] -= sense * pipe.density * mu,
                }
            }
        }
        Ok(())
    }

    /// mu (J/kg) at an end of a pipe, and its derivative by the amount there (J/kg^2).
    ///
    /// # Errors
    /// As those of [`ChamberFluid::press`](crate::scene::forces::Content::press); a supply that is not finite.
    fn mu(
        &self,
        t: f64,
        pipe: &PipeFlow,
        end: usize,
        [u, unknowns]: [&[f64]; 2],
    ) -> Result<[f64; 2], Failure> {
        match (&pipe.ends[end], &pipe.ends[1 - end]) {
            (Mouth::Liquid(number), _) => {
                self.liquids[*number].brought(u, unknowns[self.gases.len() + number])
            }
            (Mouth::Given(pressure, outside), other) => {
                let height = match other {
                    Mouth::Liquid(number) => self.liquids[*number].lifted(),
                    Mouth::Given(..) => 0.0,
                };
                Ok([pipe.given(t, pressure, *outside)? / pipe.density + height, 0.0])
            }
        }
    }
}
