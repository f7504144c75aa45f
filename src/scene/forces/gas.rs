//! Gas in chambers: amounts of it, closed in or fed and vented through orifices.
//!
//! The state of a gas is its density r, relative to that at the start: p = p_0 r^n with r = V_0 m/(V m_0). Its energy
//! belongs to it as p does: U = R T m L - R T (m - m_0) with L = (r^(n-1) - 1)/(n - 1), or ln r with n = 1, so that
//! -dU/dV = p; and what flows in brings mu = dU/dm = n R T L for each kilogram. From both mu of the standard atmosphere is
//! taken, for each kilogram, so that all gas counts from there.
//!
//! For n = 1 U is the free energy and mu the chemical potential, else mu is the enthalpy, those in the
//! chamber: losses in an orifice are never supplied. With the air around it, p_a (V - V_0), U belongs to the
//! reservoir of springs, and sum mu q of the flows q is supplied, so that the energy balance closes with and
//! without flow.
//!
//! As a constant, m makes the gas a force with a potential: statics, spectra and central differences need no
//! code of their own (`Scene::with_fixed_amounts`, `fixed_amount.rs`, `chamber_fluid.rs`). Its
//! tangent -(p - p_a) V'' + (n p/V) V' V'^T is full over the nodes of the walls, and so is the pattern. As unknowns,
//! for all other methods, amounts stand behind the strains of Maxwell branches, y = (u, v, G, m, E_d, E_s),
//! in a `Flow` (`elements/force.rs`) that `dynamics/linear/flow_matrix.rs` eliminates.

mod flow;
mod orifice;
mod pipes;
#[cfg(test)]
mod tests;

pub(crate) use flow::AmountFlow;
pub use orifice::Orifice;
pub(crate) use orifice::{End, OrificeFlow, Supply};

use super::chamber::{ChamberForce, TURNED};
use super::chamber_fluid::{ChamberFluid, Fill};
use crate::base::input::{InputError, not_negative, positive};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;
use crate::integrators::ode::Failure;

/// Absolute pressure of the atmosphere (Pa) where a scene does not say another one: the standard atmosphere.
pub(crate) const ATMOSPHERE: f64 = 101_325.0;

/// R T of the gas (J/kg): air of 1.185 kg/m^3 at 100 kPa and 20 C, the reference of ISO 6358.
pub(crate) const GAS_CONSTANT_TIMES_TEMPERATURE: f64 = 1e5 / 1.185;

/// Least part of an amount of gas, or of a liquid with a surface, with which statics begins: without any, a chamber has no pressure.
pub(crate) const LEAST: f64 = 1e-6;

/// An amount of gas in a [chamber](crate::Chamber), in place of a pressure set by phases.
///
/// Its absolute pressure follows the volume V of the chamber and the amount m, p = p_0 (V_0 m/(V m_0))^n, and the gauge pressure,
/// its difference from the [atmosphere](crate::Scene::atmosphere), acts on the walls. p_0 is the pressure in the undeformed
/// shape, whose volume V_0 it fills with m_0 = p_0 V_0/(R T) of air at 20 C. The amount is constant, unless the chamber
/// has an [`Orifice`].
///
/// ```
/// use pliant::{Body, Cells, Chamber, Gas, Material, Mesh, Phase, Scene};
///
/// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
/// let ring = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles)?;
/// let ring = Body::new(ring, rubber).thickness(0.01).build()?;
/// let scene = Scene::new(ring)
///     .chamber(Chamber::within("air", "inner"))
///     .gas(Gas::in_chamber("air").pressure(1.2e5).exponent(1.4))
///     .phase(Phase::until(0.1));
/// scene.validate()?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Gas {
    pub(crate) chamber: String,
    pressure: f64,
    exponent: f64,
}

impl Gas {
    /// Gas in the chamber of that name, at the pressure of the standard atmosphere and isothermal.
    pub fn in_chamber(chamber: impl Into<String>) -> Self {
        Self { chamber: chamber.into(), pressure: ATMOSPHERE, exponent: 1.0 }
    }

    /// Absolute pressure p_0 (Pa) in the undeformed shape. Default: 101325.
    pub fn pressure(mut self, pressure: f64) -> Self {
        self.pressure = pressure;
        self
    }

    pub(crate) fn absolute_pressure(&self) -> f64 {
        self.pressure
    }

    /// Absolute pressure p_0 (Pa) and exponent n.
    pub(crate) fn law(&self) -> [f64; 2] {
        [self.pressure, self.exponent]
    }

    /// Exponent n: 1 isothermal (slow, the default), 1.4 adiabatic (fast), between them polytropic.
    pub fn exponent(mut self, exponent: f64) -> Self {
        self.exponent = exponent;
        self
    }

    /// The gas within `walls` of `dofs` displacement components, in air of the pressure `outside` (Pa).
    ///
    /// # Errors
    /// A pressure or an exponent that is not above 0; a chamber without volume in the undeformed shape.
    pub(crate) fn fill(
        &self,
        walls: ChamberForce,
        dofs: usize,
        outside: f64,
    ) -> Result<GasInChamber, InputError> {
        let input = |key: &str| format!("gas in chamber \"{}\" {key}", self.chamber);
        let pressure = positive(&input("pressure"), self.pressure, "Pa, absolute")?;
        let exponent = positive(&input("exponent"), self.exponent, "")?;
        not_negative("atmosphere", outside, "Pa, absolute")?;
        let volume = walls.volume(&vec![0.0; dofs]);
        if !walls.has_room() {
            let help = "in the undeformed shape the chamber must enclose a volume (m^3), which the gas fills at first";
            return Err(InputError::new(input("volume"), format!("{volume:.1e}"), help));
        }
        let amount = pressure * volume / GAS_CONSTANT_TIMES_TEMPERATURE;
        let mut filled =
            GasInChamber { walls, pressure, volume, amount, exponent, outside, zero: 0.0 };
        filled.zero = filled.brought(ATMOSPHERE)[0];
        Ok(filled)
    }
}

/// Gas within walls.
pub(crate) struct GasInChamber {
    walls: ChamberForce,
    /// p_0 (Pa), V_0 (m^3) and m_0 (kg).
    pressure: f64,
    volume: f64,
    amount: f64,
    exponent: f64,
    /// Absolute pressure of the air around (Pa).
    outside: f64,
    /// n R T L at the standard atmosphere (J/kg).
    zero: f64,
}

impl GasInChamber {
    /// V_0 (m^3)
    pub(crate) fn natural_volume(&self) -> f64 {
        self.volume
    }

    /// Absolute pressure (Pa) of an `amount` (kg) under the displacements `u`, and the volume (m^3).
    ///
    /// # Errors
    /// Walls that have passed through each other; no gas that is left.
    pub(crate) fn pressure(&self, u: &[f64], amount: f64) -> Result<[f64; 2], Failure> {
        let (volume, name) = (self.walls.volume(u), self.walls.name());
        if volume <= 0.0 {
            return Err(Failure::Recoverable(format!(
                "chamber \"{name}\" with gas encloses {volume:.1e} m^3: {TURNED}"
            )));
        }
        // a trial point; what flows out of a chamber ceases with its pressure
        if amount <= 0.0 {
            return Err(Failure::Recoverable(format!(
                "chamber \"{name}\" has {amount:.1e} kg of gas"
            )));
        }
        let density = (self.volume / volume) * (amount / self.amount);
        Ok([self.pressure * density.powf(self.exponent), volume])
    }

    /// Adds its forces, and returns the absolute pressure (Pa).
    ///
    /// # Errors
    /// As [`pressure`](Self::pressure).
    fn push(&self, u: &[f64], amount: f64, forces: &mut NodalForces) -> Result<f64, Failure> {
        let [pressure, _] = self.pressure(u, amount)?;
        self.walls.add_gradient(self.above_outside(pressure), u, &mut forces.conservative);
        Ok(pressure)
    }

    /// The amount (kg) that has the pressure outside in the undeformed shape; in a vacuum next to none.
    pub(crate) fn unloaded(&self) -> f64 {
        let part = (self.outside / self.pressure).powf(1.0 / self.exponent);
        part.max(LEAST) * self.amount
    }

    /// Gauge pressure of the gas (Pa) at an `absolute` pressure (Pa).
    fn above_outside(&self, absolute: f64) -> f64 {
        absolute - self.outside
    }

    /// L and r^(n-1) at an absolute pressure (Pa).
    fn work(&self, pressure: f64) -> [f64; 2] {
        let logarithm = (pressure / self.pressure).ln() / self.exponent;
        let x = (self.exponent - 1.0) * logarithm;
        let mean = if x == 0.0 { 1.0 } else { x.exp_m1() / x };
        [logarithm * mean, x.exp()]
    }

    /// mu (J/kg) and dmu/dp (J/kg/Pa) at an absolute pressure (Pa).
    fn brought(&self, pressure: f64) -> [f64; 2] {
        let [work, heating] = self.work(pressure);
        let rt = GAS_CONSTANT_TIMES_TEMPERATURE;
        [self.exponent * rt * work - self.zero, rt * heating / pressure]
    }

    /// How the temperature falls with the pressure, d ln T/d ln p.
    fn cooling(&self) -> f64 {
        (self.exponent - 1.0) / self.exponent
    }
}

impl ChamberFluid for GasInChamber {
    fn walls(&self) -> &ChamberForce {
        &self.walls
    }

    fn amount(&self) -> f64 {
        self.amount
    }

    fn press(&self, u: &[f64], fill: Fill, forces: &mut NodalForces) -> Result<(), Failure> {
        self.push(u, fill.amount, forces).map(|_| ())
    }

    fn linearize(
        &self,
        u: &[f64],
        Fill { amount, .. }: Fill,
        stiffness: &mut BlockMatrix,
        gradient: &mut [f64],
    ) -> Option<[f64; 3]> {
        let [pressure, volume] = self.pressure(u, amount).ok()?;
        self.walls.add_hessian(-self.above_outside(pressure), u, stiffness);
        self.walls.add_gradient(1.0, u, gradient);
        let stiff = self.exponent * pressure / volume;
        Some([pressure, stiff, self.exponent * pressure / amount])
    }

    /// With that of the air around.
    fn potential(&self, u: &[f64], Fill { amount, .. }: Fill) -> f64 {
        let Ok([pressure, volume]) = self.pressure(u, amount) else { return f64::NAN };
        let [work, _] = self.work(pressure);
        let more = amount - self.amount;
        GAS_CONSTANT_TIMES_TEMPERATURE * (amount * work - more) - self.zero * more
            + self.outside * (volume - self.volume)
    }

    fn gauge(&self, u: &[f64], amount: f64) -> Result<f64, Failure> {
        let [pressure, _] = self.pressure(u, amount)?;
        Ok(self.above_outside(pressure))
    }
}
