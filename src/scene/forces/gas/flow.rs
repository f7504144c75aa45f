//! The gases and liquids of a scene whose amounts are unknowns, the actuators that lag, and the pipes between liquids.
//!
//! Absolute tolerances of amounts are to the first amount as those of strains are to 1.

use super::GasInChamber;
use super::orifice::{End, OrificeFlow};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::distinct;
use crate::elements::force::{Capabilities, Flow, FlowDerivatives, Force, NodalForces, Tangents};
use crate::integrators::ode::Failure;
use crate::scene::forces::chamber_fluid::{ChamberFluid, Fill};
use crate::scene::forces::lag::Lagging;
use crate::scene::forces::liquid::LiquidInChamber;
use crate::scene::forces::pipe::PipeFlow;

/// All gases of a scene and the orifices between them, behind them all liquids, what lags, and the pipes between liquids, whose flows are the last unknowns.
pub(crate) struct AmountFlow {
    pub(super) gases: Vec<GasInChamber>,
    orifices: Vec<OrificeFlow>,
    pub(super) liquids: Vec<LiquidInChamber>,
    lagging: Vec<Lagging>,
    pub(super) pipes: Vec<PipeFlow>,
    pub(super) start: Vec<f64>,
}

impl AmountFlow {
    /// `start` are the unknowns at the start of the scene.
    pub(crate) fn new(
        gases: Vec<GasInChamber>,
        orifices: Vec<OrificeFlow>,
        liquids: Vec<LiquidInChamber>,
        lagging: Vec<Lagging>,
        pipes: Vec<PipeFlow>,
        start: Vec<f64>,
    ) -> Self {
        Self { start, gases, orifices, liquids, lagging, pipes }
    }

    /// Numbers of the first liquid and of what lags first.
    fn parts(&self) -> [usize; 2] {
        [self.gases.len(), self.gases.len() + self.liquids.len()]
    }

    /// All gases, and then all liquids.
    fn all(&self) -> impl Iterator<Item = &dyn ChamberFluid> {
        let gases = self.gases.iter().map(|gas| gas as &dyn ChamberFluid);
        gases.chain(self.liquids.iter().map(|liquid| liquid as &dyn ChamberFluid))
    }
}

/// Whether it hardly changes its volume.
fn is_stiff(content: &dyn ChamberFluid) -> bool {
    content.volume_under(content.amount(), 0.0).is_some()
}

impl Flow for AmountFlow {
    fn reservoirs(&self) -> usize {
        self.gases.len() + self.liquids.len() + self.lagging.len()
    }

    /// Of flows those of speeds in their pipes.
    fn tolerances(&self, strain: f64, velocity: f64) -> Vec<f64> {
        let amounts = self.all().map(ChamberFluid::amount);
        let sizes = amounts.chain(self.lagging.iter().map(Lagging::size));
        let of_amounts = sizes.map(|size| strain * size);
        of_amounts.chain(self.pipes.iter().map(|pipe| velocity * pipe.area)).collect()
    }

    fn start(&self) -> &[f64] {
        &self.start
    }

    fn set(&self, t: f64, amounts: &[f64]) {
        let [_, first] = self.parts();
        let each = self.lagging.iter().zip(amounts.iter().skip(first));
        each.for_each(|(lagging, &state)| lagging.set(t, state));
    }

    fn add_forces_of(
        &self,
        t: f64,
        [u, amounts]: [&[f64]; 2],
        forces: &mut NodalForces,
        [rates, pressures]: [&mut [f64]; 2],
    ) -> Result<f64, Failure> {
        rates.fill(0.0);
        for (number, (gas, &amount)) in self.gases.iter().zip(amounts).enumerate() {
            pressures[number] = gas.push(u, amount, forces)?;
        }
        for orifice in &self.orifices {
            let [flow, ..] = orifice.rate(t, &self.gases, pressures)?;
            for (end, sign) in orifice.ends.iter().zip([-1.0, 1.0]) {
                if let End::Gas(number) = end {
                    rates[*number] += sign * flow;
                }
            }
        }
        let each = self.gases.iter().zip(&*rates).zip(&*pressures);
        let mut power: f64 =
            each.map(|((gas, rate), &pressure)| gas.brought(pressure)[0] * rate).sum();
        let [liquids, lagging] = self.parts();
        let each = amounts[liquids..].iter().zip(&mut rates[liquids..]);
        for (liquid, (&amount, rate)) in self.liquids.iter().zip(each) {
            liquid.press(u, Fill::of(amount), forces)?;
            *rate = liquid.rate(t)?;
            if *rate != 0.0 {
                power += liquid.brought(u, amount)?[0] * *rate;
            }
        }
        let each = amounts[lagging..].iter().zip(&mut rates[lagging..]);
        for (lagging, (&state, rate)) in self.lagging.iter().zip(each) {
            *rate = lagging.rate(t, state)?;
        }
        Ok(power + self.add_pipes(t, [u, amounts], forces, rates)?)
    }

    fn potential_of(&self, u: &[f64], amounts: &[f64]) -> f64 {
        self.all()
            .zip(amounts)
            .map(|(content, &amount)| content.potential(u, Fill::of(amount)))
            .sum()
    }

    fn kinetic_of(&self, unknowns: &[f64]) -> f64 {
        let flows = &unknowns[self.reservoirs()..];
        self.pipes.iter().zip(flows).map(|(pipe, &flow)| pipe.kinetic(flow)).sum()
    }

    fn check(&self, t: f64, u: &[f64], amounts: &[f64]) -> Result<(), Failure> {
        self.all().zip(amounts).try_for_each(|(content, &amount)| content.check(t, u, amount))
    }

    fn is_stiff(&self) -> bool {
        self.all().any(is_stiff)
    }

    fn write_pressures(&self, u: &[f64], amounts: &[f64], pressures: &mut [f64]) {
        pressures.fill(f64::NAN);
        let each = self.all().zip(amounts).zip(pressures);
        for ((content, &amount), pressure) in each.filter(|((content, _), _)| is_stiff(*content)) {
            *pressure = content.gauge(u, amount).unwrap_or(f64::NAN);
        }
    }

    fn missing(
        &self,
        room: usize,
        u: &[f64],
        [amount, pressure]: [f64; 2],
        gradient: &mut [f64],
    ) -> Option<[f64; 2]> {
        let content = self.all().nth(room)?;
        let volume = content.volume_under(amount, pressure)?;
        gradient.fill(0.0);
        content.walls().add_gradient(1.0, u, gradient);
        Some([volume - content.walls().volume(u), volume])
    }

    /// Leaves all at 0 where there is no pressure: the step will be refused by the forces.
    fn linearize(
        &self,
        t: f64,
        [u, v, amounts]: [&[f64]; 3],
        stiffness: &mut BlockMatrix,
        derivatives: &mut FlowDerivatives,
    ) {
        let FlowDerivatives { gradients, pressures, rates, power, work, trial, .. } =
            &mut *derivatives;
        let [stiff, pressing] = pressures;
        let ([by_volumes, by_amounts], [flows, pressures]) = (rates, work);
        let (rooms, count) = (self.reservoirs(), self.start.len());
        gradients.fill(0.0);
        [&mut *by_volumes, by_amounts, stiff, pressing, flows].iter_mut().for_each(|x| x.fill(0.0));
        for (number, (content, &amount)) in self.all().zip(amounts).enumerate() {
            let gradient = &mut gradients[number * u.len()..][..u.len()];
            let linear = content.linearize(u, Fill::of(amount), stiffness, gradient);
            let Some([pressure, by_volume, by_amount]) = linear else { return };
            (pressures[number], stiff[number], pressing[number]) = (pressure, by_volume, by_amount);
        }
        for orifice in &self.orifices {
            let Ok([flow, by_first, by_second]) = orifice.rate(t, &self.gases, pressures) else {
                return;
            };
            for (end, sign) in orifice.ends.iter().zip([-1.0, 1.0]) {
                let End::Gas(row) = end else { continue };
                flows[*row] += sign * flow;
                for (end, slope) in orifice.ends.iter().zip([by_first, by_second]) {
                    let End::Gas(column) = end else { continue };
                    by_volumes[row * rooms + column] -= sign * slope * stiff[*column];
                    by_amounts[row * count + column] += sign * slope * pressing[*column];
                }
            }
        }
        let [power_by_volumes, power_by_amounts] = power;
        for column in 0..self.gases.len() {
            let slope = flows[column] * self.gases[column].brought(pressures[column])[1];
            power_by_volumes[column] = -slope * stiff[column];
            power_by_amounts[column] = slope * pressing[column];
            for (row, gas) in self.gases.iter().enumerate() {
                let [brought, _] = gas.brought(pressures[row]);
                power_by_volumes[column] += brought * by_volumes[row * rooms + column];
                power_by_amounts[column] += brought * by_amounts[row * count + column];
            }
        }
        for (at, liquid) in (self.gases.len()..).zip(&self.liquids) {
            let Ok(rate) = liquid.rate(t) else { return };
            let Ok([_, slope]) = liquid.brought(u, amounts[at]) else { return };
            // d^2E/dm du is less the derivative of the forces by the amount
            power_by_volumes[at] = -rate * pressing[at];
            power_by_amounts[at] = rate * slope;
        }
        let [_, first] = self.parts();
        for (at, lagging) in (first..).zip(&self.lagging) {
            let gradient = &mut gradients[at * u.len()..][..u.len()];
            pressing[at] = 1.0;
            [by_amounts[at * count + at], power_by_amounts[at]] =
                lagging.linearize(t, [u, v], amounts[at], trial, gradient);
        }
        // as above
        let _ = self.linearize_pipes(t, [u, amounts], derivatives);
    }
}

/// As if the amounts stayed what they are at the start.
impl Force for AmountFlow {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let mut all = self.all().zip(&self.start);
        all.try_for_each(|(content, &amount)| content.press(u, Fill::of(amount), forces))
    }

    fn add_tangents(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        _stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        // those of the flow are taken in their place
        Tangents::Added
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        self.all().flat_map(|content| content.walls().couplings()).collect()
    }

    /// Those of actuators that lag, too.
    fn nodes(&self) -> Option<Vec<usize>> {
        let mut nodes = self.couplings().concat();
        for force in self.lagging.iter().filter_map(Lagging::force) {
            nodes.extend(force.nodes()?);
        }
        Some(distinct(nodes))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { flow: Some(self), ..Capabilities::default() }
    }
}
