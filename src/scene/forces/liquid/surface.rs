//! A liquid with a level surface, under air of the pressure outside.
//!
//! The level h of an amount m follows from its volume: V(h, u) = V_m = m/rho. With the integral S of the depth below the level, its energy is that of its weight,
//!
//! ```text
//! U = rho g int z dV = rho g (h V_m - S(h, u)),   dU/dh = rho g (V_m - V) = 0,
//! ```
//!
//! so that the forces -dU/du = rho g dS/du are those of the pressure rho g (h - z) at a level that stays, and dU/dm = g h. The level follows the walls,
//! dh/du = -(dV/du)/A with the area A of the surface: the tangent is that of a level that stays plus rho g/A dV/du dV/du^T.
//!
//! To the Newton system this is a reservoir like others, with -dp/dV = rho g/A and dp/dm = g/A.

#[cfg(test)]
mod tests;

use super::held::Held;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;
use crate::integrators::ode::Failure;
use crate::scene::forces::basin::{Basin, Level, NoLevel};
use crate::scene::forces::chamber::{ChamberForce, TURNED};
use crate::scene::forces::chamber_fluid::{ChamberFluid, Fill};

/// A liquid that stands in its walls up to a level.
pub(super) struct Pool {
    walls: ChamberForce,
    basin: Basin,
    density: f64,
    /// Strength of gravity (m/s^2).
    gravity: f64,
    /// The amount (kg) at the start.
    amount: f64,
    /// The level (m) at the start in the undeformed shape, from which heights are counted, and its energy (J) there.
    first: f64,
    zero: f64,
}

impl Pool {
    /// An `amount` (kg) of this `density`.
    ///
    /// # Errors
    /// More than the undeformed walls hold.
    pub(super) fn new(
        walls: ChamberForce,
        basin: Basin,
        gravity: f64,
        [amount, density]: [f64; 2],
        dofs: usize,
    ) -> Result<Self, NoLevel> {
        let rest = vec![0.0; dofs];
        let mut pool = Self { walls, basin, density, gravity, amount, first: 0.0, zero: 0.0 };
        pool.first = pool.basin.level(pool.natural(amount), &rest)?.height;
        pool.zero = pool.potential(&rest, Fill::of(amount));
        Ok(pool)
    }

    fn natural(&self, amount: f64) -> f64 {
        amount / self.density
    }

    /// rho g (N/m^3)
    fn heaviness(&self) -> f64 {
        self.density * self.gravity
    }

    fn level_of(&self, u: &[f64], amount: f64) -> Result<Level, Failure> {
        let name = self.walls.name();
        let refused = |words: String| {
            Err(Failure::Recoverable(format!("chamber \"{name}\" with a liquid {words}")))
        };
        if amount <= 0.0 {
            return refused(format!("has {amount:.1e} kg of it: let less flow out"));
        }
        let natural = self.natural(amount);
        self.basin.level(natural, u).or_else(|reason| match reason {
            NoLevel::Turned(volume) => refused(format!("encloses {volume:.1e} m^3: {TURNED}")),
            NoLevel::Full(volume) => refused(format!(
                "is full to the rim: it has room for {volume:.4e} m^3, and {natural:.4e} m^3 are in it, which a free surface cannot follow. Fill it less, \
                 let less flow in, or leave its surface out: then it is full and under pressure"
            )),
        })
    }
}

impl ChamberFluid for Pool {
    fn walls(&self) -> &ChamberForce {
        &self.walls
    }

    fn amount(&self) -> f64 {
        self.amount
    }

    fn press(&self, u: &[f64], fill: Fill, forces: &mut NodalForces) -> Result<(), Failure> {
        let Level { height, .. } = self.level_of(u, fill.amount)?;
        let factors = [self.heaviness(), 0.0];
        self.basin.add_gradients(factors, height, u, &mut forces.conservative);
        Ok(())
    }

    /// The pressure is that by which the energy changes with the volume, rho g h.
    fn linearize(
        &self,
        u: &[f64],
        Fill { amount, .. }: Fill,
        stiffness: &mut BlockMatrix,
        gradient: &mut [f64],
    ) -> Option<[f64; 3]> {
        let Level { height, area } = self.level_of(u, amount).ok()?;
        let heaviness = self.heaviness();
        self.basin.add_hessian(-heaviness, height, u, stiffness);
        self.basin.add_gradients([0.0, 1.0], height, u, gradient);
        Some([heaviness * (height - self.first), heaviness / area, self.gravity / area])
    }

    fn potential(&self, u: &[f64], Fill { amount, .. }: Fill) -> f64 {
        let Ok(Level { height, .. }) = self.level_of(u, amount) else { return f64::NAN };
        let weight = (height - self.first) * self.natural(amount) - self.basin.moment(height, u);
        self.heaviness() * weight - self.zero + self.lifted() * (amount - self.amount)
    }

    /// At the lowest place of the walls.
    fn gauge(&self, u: &[f64], amount: f64) -> Result<f64, Failure> {
        let Level { height, .. } = self.level_of(u, amount)?;
        let [lowest, _] = self.basin.extent(u);
        Ok(self.heaviness() * (height - lowest))
    }
}

impl Held for Pool {
    fn brought(&self, u: &[f64], amount: f64) -> Result<[f64; 2], Failure> {
        let Level { height, area } = self.level_of(u, amount)?;
        Ok([self.gravity * height, self.gravity / (self.density * area)])
    }

    fn lifted(&self) -> f64 {
        self.gravity * self.first
    }

    fn level(&self, u: &[f64], amount: f64) -> f64 {
        self.level_of(u, amount).map_or(f64::NAN, |level| level.height)
    }

    #[cfg(feature = "output")]
    fn waterline(&self, u: &[f64], amount: f64) -> Vec<[[f64; 3]; 2]> {
        let level = self.level_of(u, amount);
        level.map_or_else(|_| Vec::new(), |level| self.basin.waterline(level.height, u))
    }
}
