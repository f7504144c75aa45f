//! The gases of a scene with orifices: amounts that are unknowns.

use super::Filled;
use super::orifice::{End, OrificeFlow};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Flow, FlowDerivatives, Force, NodalForces, Tangents};
use crate::integrators::ode::Failure;

/// All gases of a scene and the orifices between them.
pub(crate) struct GasFlow {
    gases: Vec<Filled>,
    orifices: Vec<OrificeFlow>,
    start: Vec<f64>,
}

impl GasFlow {
    pub(crate) fn new(gases: Vec<Filled>, orifices: Vec<OrificeFlow>) -> Self {
        Self { start: gases.iter().map(Filled::amount).collect(), gases, orifices }
    }

    /// Adds the forces at the `amounts` (kg) and writes the pressures (Pa).
    fn press(
        &self,
        u: &[f64],
        amounts: &[f64],
        forces: &mut NodalForces,
        mut each: impl FnMut(usize, f64),
    ) -> Result<(), Failure> {
        for (number, (gas, &amount)) in self.gases.iter().zip(amounts).enumerate() {
            let [pressure, _] = gas.pressure(u, amount)?;
            gas.walls.add_gradient(gas.gauge(pressure), u, &mut forces.conservative);
            each(number, pressure);
        }
        Ok(())
    }
}

impl Flow for GasFlow {
    fn start(&self) -> &[f64] {
        &self.start
    }

    fn add_forces_of(
        &self,
        t: f64,
        [u, amounts]: [&[f64]; 2],
        forces: &mut NodalForces,
        [rates, pressures]: [&mut [f64]; 2],
    ) -> Result<f64, Failure> {
        self.press(u, amounts, forces, |number, pressure| pressures[number] = pressure)?;
        rates.fill(0.0);
        for orifice in &self.orifices {
            let [flow, ..] = orifice.rate(t, &self.gases, pressures)?;
            for (end, sign) in orifice.ends.iter().zip([-1.0, 1.0]) {
                if let End::Gas(number) = end {
                    rates[*number] += sign * flow;
                }
            }
        }
        let each = self.gases.iter().zip(&*rates).zip(&*pressures);
        Ok(each.map(|((gas, rate), &pressure)| gas.brought(pressure)[0] * rate).sum())
    }

    fn potential_of(&self, u: &[f64], amounts: &[f64]) -> f64 {
        self.gases.iter().zip(amounts).map(|(gas, &amount)| gas.potential(u, amount)).sum()
    }

    /// Leaves all at 0 where there is no pressure: the step will be refused by the forces.
    fn linearize(
        &self,
        t: f64,
        [u, amounts]: [&[f64]; 2],
        stiffness: &mut BlockMatrix,
        derivatives: &mut FlowDerivatives,
    ) {
        let FlowDerivatives { gradients, pressures: [stiff, pressing], rates, power, work } =
            derivatives;
        let ([by_volumes, by_amounts], [flows, pressures]) = (rates, work);
        let count = self.gases.len();
        gradients.fill(0.0);
        [&mut *by_volumes, by_amounts, stiff, pressing, flows].iter_mut().for_each(|x| x.fill(0.0));
        for (number, (gas, &amount)) in self.gases.iter().zip(amounts).enumerate() {
            let Ok([pressure, volume]) = gas.pressure(u, amount) else { return };
            gas.walls.add_hessian(-gas.gauge(pressure), u, stiffness);
            gas.walls.add_gradient(1.0, u, &mut gradients[number * u.len()..][..u.len()]);
            pressures[number] = pressure;
            stiff[number] = gas.exponent * pressure / volume;
            pressing[number] = gas.exponent * pressure / amount;
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
                    by_volumes[row * count + column] -= sign * slope * stiff[*column];
                    by_amounts[row * count + column] += sign * slope * pressing[*column];
                }
            }
        }
        let [power_by_volumes, power_by_amounts] = power;
        for column in 0..count {
            let slope = flows[column] * self.gases[column].brought(pressures[column])[1];
            power_by_volumes[column] = -slope * stiff[column];
            power_by_amounts[column] = slope * pressing[column];
            for (row, gas) in self.gases.iter().enumerate() {
                let [brought, _] = gas.brought(pressures[row]);
                power_by_volumes[column] += brought * by_volumes[row * count + column];
                power_by_amounts[column] += brought * by_amounts[row * count + column];
            }
        }
    }
}

/// As if the amounts stayed what they are at the start.
impl Force for GasFlow {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.press(u, &self.start, forces, |_, _| {})
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
        self.gases.iter().flat_map(|gas| gas.walls.couplings()).collect()
    }

    fn flow(&self) -> Option<&dyn Flow> {
        Some(self)
    }
}
