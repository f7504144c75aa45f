//! Liquids in chambers, of nearly constant volume.
//!
//! An amount m has the natural volume V_m = m/rho, and in a chamber of the volume V the mean pressure p = K (V_m - V)/V_m above that outside, and the energy
//! K (V_m - V)^2/(2 V_m), whose derivative by V is -p. Its weight has the energy -m g S/V, with the integral S of the depth over the chamber: that of the
//! amount in the middle of the chamber. With b = m g/V the pressure at the depth d is then p + b (d - S/V), and the forces on the nodes are
//!
//! ```text
//! p dV/du + b s,   s = dS/du - (S/V) dV/du.
//! ```
//!
//! What flows in brings dE/dm = (p - p^2/(2 K))/rho - g S/V for each kilogram, wherever the inlet is: pressure and height make up for each other.
//!
//! The pressure acts on dV/du, but with the density m/V the weight changes, too: with q = -dp/dV both are q (dV/du + b/(q V) s) for a change of the volume or the
//! amount. The tangent has the square of that vector; -(b/V)^2/q s s^T is left out of it, which is b L/K times the tangent of the weight for a chamber L high:
//! 4e-7 for 0.1 m of water.

#[cfg(test)]
mod tests;

use super::chamber::{ChamberForce, TURNED};
use super::content::Content;
use super::moment::Moment;
use super::signal::{self, Signal, finite_at};
use crate::base::input::{InputError, positive};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;
use crate::integrators::ode::Failure;

/// Bulk modulus (Pa) and density (kg/m^3) of water.
const WATER: [f64; 2] = [2.2e9, 1000.0];

/// A liquid that fills a [chamber](crate::Chamber) whole, in place of a pressure that phases give it.
///
/// Its volume hardly changes: the pressure is p = K (V_m - V)/V_m, with the bulk modulus K, the volume V of the chamber and the natural volume V_m that is in
/// it, which [phases](crate::Phase::flow) change, as a syringe or a pump does. Where there is gravity, it has weight: p is the mean, and the pressure
/// on the walls grows with depth. p counts from that outside, and may be below 0: no bubbles form. Its own motion in the chamber, its inertia, is
/// left out; [`Fluid::added_mass`](crate::Fluid::added_mass) on the walls may stand in for it.
///
/// ```
/// use pliant::simulate::Reading;
/// use pliant::{Body, Cells, Chamber, Liquid, Material, Mesh, Phase, Sampling, Scene, Settings};
///
/// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 100.0 };
/// let ring = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles)?;
/// let ring = Body::new(ring, rubber).thickness(0.01).build()?;
/// let scene = Scene::new(ring)
///     .chamber(Chamber::within("bladder", "inner"))
///     .liquid(Liquid::in_chamber("bladder"))
///     .phase(Phase::until(0.5).flow("bladder", 2e-6)); // m^3/s
/// let sampling = Sampling::phase_ends().read("volume", Reading::chamber_volume("bladder"));
/// let motion = scene.simulate(&Settings::default(), &sampling)?;
/// let [first, last] = [&motion.samples()[0], motion.last()].map(|sample| sample.sensors[0]);
/// assert!((last - first - 1e-6).abs() < 1e-9);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Liquid {
    chamber: String,
    bulk_modulus: f64,
    density: f64,
    fill: f64,
}

impl Liquid {
    /// Water in the chamber of that name.
    pub fn in_chamber(chamber: impl Into<String>) -> Self {
        let [bulk_modulus, density] = WATER;
        Self { chamber: chamber.into(), bulk_modulus, density, fill: 1.0 }
    }

    /// Name of the chamber that it fills.
    pub fn chamber(&self) -> &str {
        &self.chamber
    }

    /// Bulk modulus K (Pa). Default: 2.2e9.
    pub fn bulk_modulus(mut self, modulus: f64) -> Self {
        self.bulk_modulus = modulus;
        self
    }

    /// Density rho (kg/m^3) without pressure. Default: 1000.
    pub fn density(mut self, density: f64) -> Self {
        self.density = density;
        self
    }

    /// The natural volume that is in the chamber at the start, as a part of its undeformed volume. Default: 1, with which there is no pressure at first.
    pub fn fill(mut self, fill: f64) -> Self {
        self.fill = fill;
        self
    }

    /// The liquid within `walls` of `dofs` displacement components, with its weight where there is one, and what flows in (m^3/s).
    ///
    /// # Errors
    /// Numbers that are not above 0; a chamber without volume in the undeformed shape.
    pub(crate) fn pour(
        &self,
        walls: ChamberForce,
        dofs: usize,
        weight: Option<Weight>,
        flow: Vec<Signal>,
    ) -> Result<Poured, InputError> {
        let input = |key: &str| format!("liquid in chamber \"{}\" {key}", self.chamber);
        let bulk = positive(&input("bulk_modulus"), self.bulk_modulus, "Pa")?;
        let density = positive(&input("density"), self.density, "kg/m^3")?;
        let fill = positive(&input("fill"), self.fill, "1")?;
        let walls = walls.anchored();
        let rest = vec![0.0; dofs];
        let volume = walls.volume(&rest);
        if !walls.has_room() {
            let help = "in the undeformed shape the chamber must enclose a volume (m^3), which the liquid fills";
            return Err(InputError::new(input("volume"), format!("{volume:.1e}"), help));
        }
        // depths count from the middle of the undeformed chamber
        let weight = weight.map(|Weight { moment, gravity }| {
            let middle = moment.value(&rest) / volume;
            Weight { moment: moment.deeper(-middle), gravity }
        });
        let amount = density * fill * volume;
        let mut poured = Poured { walls, bulk, density, amount, zero: 0.0, weight, flow };
        poured.zero = poured.strain_energy(volume, amount);
        Ok(poured)
    }
}

/// The weight of a liquid.
pub(crate) struct Weight {
    pub(crate) moment: Moment,
    /// Strength of gravity (m/s^2).
    pub(crate) gravity: f64,
}

/// A liquid within walls.
pub(crate) struct Poured {
    walls: ChamberForce,
    bulk: f64,
    density: f64,
    /// The amount (kg) at the start, and the energy (J) that its compression stores there.
    amount: f64,
    zero: f64,
    weight: Option<Weight>,
    flow: Vec<Signal>,
}

/// What an amount has in a state.
struct Full {
    /// p (Pa) and V (m^3).
    pressure: f64,
    volume: f64,
    /// b (Pa/m) and S/V (m).
    heaviness: f64,
    middle: f64,
}

impl Poured {
    /// The natural volume (m^3) of an `amount` (kg).
    pub(crate) fn natural(&self, amount: f64) -> f64 {
        amount / self.density
    }

    /// The rate (kg/s) at which it flows in at time `t` (s).
    ///
    /// # Errors
    /// A rate that is not finite.
    pub(crate) fn rate(&self, t: f64) -> Result<f64, Failure> {
        let rate = signal::sum(&self.flow, t);
        let name = self.walls.name();
        Ok(self.density * finite_at(t, format_args!("the flow into chamber \"{name}\""), rate)?)
    }

    /// dE/dm (J/kg) of an `amount` (kg), and its derivative by the amount in a chamber that stays (J/kg^2).
    ///
    /// # Errors
    /// As [`Content::press`].
    pub(crate) fn brought(&self, u: &[f64], amount: f64) -> Result<[f64; 2], Failure> {
        let Full { pressure, volume, middle, .. } = self.full(u, amount)?;
        let part = pressure / self.bulk;
        let compressed = pressure * (1.0 - 0.5 * part) / self.density;
        let gravity = self.weight.as_ref().map_or(0.0, |weight| weight.gravity);
        let slope = (1.0 - part) / self.density * self.pressing(volume, amount);
        Ok([compressed - gravity * middle, slope])
    }

    /// dp/dm (Pa/kg)
    fn pressing(&self, volume: f64, amount: f64) -> f64 {
        self.bulk * volume / self.natural(amount) / amount
    }

    fn strain_energy(&self, volume: f64, amount: f64) -> f64 {
        let natural = self.natural(amount);
        0.5 * self.bulk * (natural - volume).powi(2) / natural
    }

    fn full(&self, u: &[f64], amount: f64) -> Result<Full, Failure> {
        let (volume, name) = (self.walls.volume(u), self.walls.name());
        let refused = |words: String| {
            Err(Failure::Recoverable(format!("chamber \"{name}\" with a liquid {words}")))
        };
        if volume <= 0.0 {
            return refused(format!("encloses {volume:.1e} m^3: {TURNED}"));
        }
        if amount <= 0.0 {
            return refused(format!("has {amount:.1e} kg of it: let less flow out"));
        }
        let natural = self.natural(amount);
        let pressure = self.bulk * (natural - volume) / natural;
        let [heaviness, middle] = self.weight.as_ref().map_or([0.0; 2], |weight| {
            [amount * weight.gravity / volume, weight.moment.value(u) / volume]
        });
        Ok(Full { pressure, volume, heaviness, middle })
    }
}

impl Content for Poured {
    fn walls(&self) -> &ChamberForce {
        &self.walls
    }

    fn amount(&self) -> f64 {
        self.amount
    }

    fn press(&self, u: &[f64], amount: f64, forces: &mut NodalForces) -> Result<(), Failure> {
        let Full { pressure, heaviness, middle, .. } = self.full(u, amount)?;
        let forces = &mut forces.conservative;
        self.walls.add_gradient(pressure - heaviness * middle, u, forces);
        if let Some(weight) = &self.weight {
            weight.moment.add_gradient(heaviness, u, forces);
        }
        Ok(())
    }

    fn linearize(
        &self,
        u: &[f64],
        amount: f64,
        stiffness: &mut BlockMatrix,
        gradient: &mut [f64],
    ) -> Option<[f64; 3]> {
        let Full { pressure, volume, heaviness, middle } = self.full(u, amount).ok()?;
        let stiff = self.bulk / self.natural(amount);
        let part = heaviness / (stiff * volume);
        self.walls.add_hessian(heaviness * middle - pressure, u, stiffness);
        self.walls.add_gradient(1.0 - part * middle, u, gradient);
        if let Some(weight) = &self.weight {
            weight.moment.add_hessian(-heaviness, u, stiffness);
            weight.moment.add_gradient(part, u, gradient);
        }
        Some([pressure, stiff, self.pressing(volume, amount)])
    }

    fn potential(&self, u: &[f64], amount: f64) -> f64 {
        let Ok(Full { volume, heaviness, middle, .. }) = self.full(u, amount) else {
            return f64::NAN;
        };
        self.strain_energy(volume, amount) - self.zero - heaviness * volume * middle
    }

    fn gauge(&self, u: &[f64], amount: f64) -> Result<f64, Failure> {
        Ok(self.full(u, amount)?.pressure)
    }
}
