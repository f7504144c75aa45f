//! A liquid that fills its chamber whole, of nearly constant volume.
//!
//! An amount m has the natural volume V_m = m/rho, and in a chamber of the volume V the mean pressure p = K (V_m - V)/V_m above that outside, and the energy
//! K (V_m - V)^2/(2 V_m), whose derivative by V is -p. Its weight has the energy -m g S/V, with the integral S of the depth over the chamber: that of the
//! amount in the middle of the chamber. With b = m g/V the pressure at the depth d is then p + b (d - S/V), and the forces on the nodes are
//!
//! ```text
//! p dV/du + b s,   s = dS/du - (S/V) dV/du.
//! ```
//!
//! Inflow adds the specific energy dE/dm = (p - p^2/(2 K))/rho - g S/V, and g z of the middle of the undeformed
//! chamber, from which depths count, above the origin. The position of the inlet does not matter, as pressure and
//! height compensate each other.
//!
//! The pressure acts on dV/du, but with the density m/V the weight changes, too: with q = -dp/dV both are q (dV/du + b/(q V) s) for a change of the volume or the
//! amount. The tangent has the square of that vector; -(b/V)^2/q s s^T is left out of it, which is b L/K times the tangent of the weight for a chamber L high:
//! 4e-7 for 0.1 m of water.
//!
//! It is stiff and costs no more for that, as its part of the Newton matrix stays out of the pattern. Volumes
//! count from a node of the walls (`Enclosure::anchor`): round-off of a volume times K/V would be a pressure
//! that grows with the cube of the distance from the origin. Its weight has the second derivative of pressure
//! by depth (`Followed::bending`), so that forces have an energy to round-off and add up to m g for any mesh
//! and shape. With the mass m instead of rho V in it, p is the mean and nothing depends on the origin. Lids
//! have no faces, hence no weight on them: they are refused with gravity. Inertia of the liquid is left out,
//! as M would be full over the walls and change with the shape.

use super::held::Held;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;
use crate::integrators::ode::Failure;
use crate::scene::forces::chamber::{ChamberForce, TURNED};
use crate::scene::forces::chamber_fluid::{ChamberFluid, Fill};
use crate::scene::forces::moment::Moment;

/// A liquid that fills its walls.
pub(super) struct Whole {
    walls: ChamberForce,
    bulk: f64,
    density: f64,
    /// The amount (kg) at the start, and the energy (J) that its compression stores there.
    amount: f64,
    zero: f64,
    weight: Option<(Moment, f64)>,
    /// g z (J/kg) of the middle of the undeformed chamber.
    lifted: f64,
}

/// Pressure and weight terms of an amount in a state.
struct Full {
    /// p (Pa) and V (m^3).
    pressure: f64,
    volume: f64,
    /// b (Pa/m) and S/V (m).
    heaviness: f64,
    middle: f64,
}

impl Whole {
    /// An `amount` (kg) of this `density` without pressure; with its depth and the strength of gravity (m/s^2), if it has weight.
    pub(super) fn new(
        walls: ChamberForce,
        bulk: f64,
        [amount, density]: [f64; 2],
        weight: Option<(Moment, f64)>,
        dofs: usize,
    ) -> Self {
        let rest = vec![0.0; dofs];
        let volume = walls.volume(&rest);
        // depths count from the middle of the undeformed chamber
        let mut lifted = 0.0;
        let weight = weight.map(|(moment, gravity)| {
            let middle = moment.value(&rest) / volume;
            lifted = -gravity * middle;
            (moment.deeper(-middle), gravity)
        });
        let mut whole = Self { walls, bulk, density, amount, zero: 0.0, weight, lifted };
        whole.zero = whole.strain_energy(volume, amount);
        whole
    }

    /// The natural volume (m^3) of an `amount` (kg).
    fn natural(&self, amount: f64) -> f64 {
        amount / self.density
    }

    /// dp/dm (Pa/kg)
    fn pressing(&self, volume: f64, amount: f64) -> f64 {
        self.bulk * volume / self.natural(amount) / amount
    }

    fn strain_energy(&self, volume: f64, amount: f64) -> f64 {
        let natural = self.natural(amount);
        0.5 * self.bulk * (natural - volume).powi(2) / natural
    }

    fn full(&self, u: &[f64], Fill { amount, weight }: Fill) -> Result<Full, Failure> {
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
        let [heaviness, middle] = self.weight.as_ref().map_or([0.0; 2], |(moment, gravity)| {
            [weight * amount * gravity / volume, moment.value(u) / volume]
        });
        Ok(Full { pressure, volume, heaviness, middle })
    }
}

impl ChamberFluid for Whole {
    fn walls(&self) -> &ChamberForce {
        &self.walls
    }

    fn amount(&self) -> f64 {
        self.amount
    }

    fn press(&self, u: &[f64], fill: Fill, forces: &mut NodalForces) -> Result<(), Failure> {
        let Full { pressure, heaviness, middle, .. } = self.full(u, fill)?;
        let forces = &mut forces.conservative;
        self.walls.add_gradient(pressure - heaviness * middle, u, forces);
        if let Some((moment, _)) = &self.weight {
            moment.add_gradient(heaviness, u, forces);
        }
        Ok(())
    }

    fn linearize(
        &self,
        u: &[f64],
        fill: Fill,
        stiffness: &mut BlockMatrix,
        gradient: &mut [f64],
    ) -> Option<[f64; 3]> {
        let Full { pressure, volume, heaviness, middle } = self.full(u, fill).ok()?;
        let stiff = self.bulk / self.natural(fill.amount);
        let part = heaviness / (stiff * volume);
        self.walls.add_hessian(heaviness * middle - pressure, u, stiffness);
        self.walls.add_gradient(1.0 - part * middle, u, gradient);
        if let Some((moment, _)) = &self.weight {
            moment.add_hessian(-heaviness, u, stiffness);
            moment.add_gradient(part, u, gradient);
        }
        Some([pressure, stiff, self.pressing(volume, fill.amount)])
    }

    fn potential(&self, u: &[f64], fill: Fill) -> f64 {
        let Ok(Full { volume, heaviness, middle, .. }) = self.full(u, fill) else {
            return f64::NAN;
        };
        let lifted = fill.weight * self.lifted * (fill.amount - self.amount);
        self.strain_energy(volume, fill.amount) - self.zero + (lifted - heaviness * volume * middle)
    }

    fn gauge(&self, u: &[f64], amount: f64) -> Result<f64, Failure> {
        Ok(self.full(u, Fill::of(amount))?.pressure)
    }

    fn volume_under(&self, amount: f64, gauge: f64) -> Option<f64> {
        Some(self.natural(amount) * (1.0 - gauge / self.bulk))
    }
}

impl Held for Whole {
    fn brought(&self, u: &[f64], amount: f64) -> Result<[f64; 2], Failure> {
        let Full { pressure, volume, middle, .. } = self.full(u, Fill::of(amount))?;
        let part = pressure / self.bulk;
        let compressed = pressure * (1.0 - 0.5 * part) / self.density;
        let gravity = self.weight.as_ref().map_or(0.0, |(_, gravity)| *gravity);
        let slope = (1.0 - part) / self.density * self.pressing(volume, amount);
        Ok([compressed + self.lifted - gravity * middle, slope])
    }

    fn lifted(&self) -> f64 {
        self.lifted
    }
}
