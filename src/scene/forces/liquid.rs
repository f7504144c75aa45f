//! Liquids in chambers, and what flows in and out of them.

mod held;
mod surface;
#[cfg(test)]
mod tests;
mod whole;

use std::fmt;

use super::chamber::ChamberForce;
use super::chamber_fluid::{ChamberFluid, Fill};
use super::gas::LEAST;
use super::moment::Moment;
use super::signal::{self, Signal, finite_at};
use crate::base::input::{InputError, positive};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;
use crate::integrators::ode::Failure;
use crate::scene::forces::basin::Basin;
use held::Held;
use surface::Pool;
use whole::Whole;

/// Remedy for a liquid with a surface whose initial fill is too large.
const FULL: &str = "with a surface it must be below 1: fill less, or leave the surface out";

/// Bulk modulus (Pa) and density (kg/m^3) of water.
const WATER: [f64; 2] = [2.2e9, 1000.0];

/// A liquid in a [chamber](crate::Chamber), in place of a pressure set by phases: it fills the chamber completely, or has a free [surface](Self::surface).
///
/// Its volume hardly changes: the pressure is p = K (V_m - V)/V_m, with the bulk modulus K, the volume V of the chamber and the natural volume V_m in
/// it, which [phases](crate::Phase::flow) change, as a syringe or a pump does. Under gravity it has weight: p is the mean, and the pressure
/// on the walls grows with depth. p is the gauge pressure, and may be negative: there is no cavitation. Its motion and inertia in the chamber are
/// neglected; [`Fluid::added_mass`](crate::Fluid::added_mass) on the walls can represent the inertia.
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
#[derive(Clone)]
pub struct Liquid {
    chamber: String,
    bulk_modulus: f64,
    pub(crate) density: f64,
    fill: f64,
    has_surface: bool,
}

/// As it was before liquids had surfaces, where this one has none: checkpoints tell scenes apart by it.
impl fmt::Debug for Liquid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = f.debug_struct("Liquid");
        parts.field("chamber", &self.chamber).field("bulk_modulus", &self.bulk_modulus);
        parts.field("density", &self.density).field("fill", &self.fill);
        if self.has_surface {
            parts.field("has_surface", &true);
        }
        parts.finish()
    }
}

impl Liquid {
    /// Water in the chamber of that name.
    pub fn in_chamber(chamber: impl Into<String>) -> Self {
        let [bulk_modulus, density] = WATER;
        Self { chamber: chamber.into(), bulk_modulus, density, fill: 1.0, has_surface: false }
    }

    /// Name of the chamber that it is in.
    pub fn chamber(&self) -> &str {
        &self.chamber
    }

    /// Bulk modulus K (Pa). Default: 2.2e9. One with a [surface](Self::surface) is not compressed.
    pub fn bulk_modulus(mut self, modulus: f64) -> Self {
        self.bulk_modulus = modulus;
        self
    }

    /// Density rho (kg/m^3) without pressure. Default: 1000.
    pub fn density(mut self, density: f64) -> Self {
        self.density = density;
        self
    }

    /// The natural volume in the chamber at the start, as a fraction of its undeformed volume. Default: 1, for which the initial pressure is 0;
    /// with a [surface](Self::surface) it has to be below 1.
    pub fn fill(mut self, fill: f64) -> Self {
        self.fill = fill;
        self
    }

    /// A free surface under air of the pressure outside, which fills the rest of the chamber: an open or vented vessel that is not full. Default: the liquid
    /// fills the chamber completely.
    ///
    /// Its volume is [`fill`](Self::fill) times that of the undeformed chamber plus the inflow, independently of pressure. The pressure on the walls is rho g (h - z) at the height z below
    /// the level h, which follows from that volume, and 0 above it; faces with mid nodes count as straight between the nodes. It needs
    /// gravity. The surface is that of a liquid in equilibrium: it does not slosh. A lid or a line that closes the chamber is a wall, over which nothing spills. Where the
    /// chamber becomes too small for the liquid, the run ends with an error: [`Reading::liquid_level`](crate::simulate::Reading::liquid_level) shows how near that is.
    ///
    /// ```
    /// use pliant::simulate::Reading;
    /// use pliant::{Body, Cells, Chamber, Liquid, Material, Mesh, Phase, Sampling, Scene, Settings};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 1e4 };
    /// let ring = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles)?;
    /// let ring = Body::new(ring, rubber).thickness(0.01).build()?;
    /// let scene = Scene::new(ring)
    ///     .gravity([0.0, -9.8])
    ///     .chamber(Chamber::within("bottle", "inner"))
    ///     .liquid(Liquid::in_chamber("bottle").fill(0.5).surface())
    ///     .phase(Phase::until(0.1).hold([1, 2, 3]));
    /// let sampling = Sampling::phase_ends().read("level", Reading::liquid_level("bottle"));
    /// let motion = scene.simulate(&Settings::default(), &sampling)?;
    /// assert!(motion.last().sensors[0].abs() < 1e-3); // the middle of the ring
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn surface(mut self) -> Self {
        self.has_surface = true;
        self
    }

    /// Its properties but for its chamber, as a text.
    pub(crate) fn likeness(&self) -> String {
        format!("{:?}", Self { chamber: String::new(), ..self.clone() })
    }

    /// Whether it has a surface.
    pub(crate) fn has_surface(&self) -> bool {
        self.has_surface
    }

    /// The liquid within `walls` of `dofs` displacement components, by what its weight takes, and what flows in (m^3/s).
    ///
    /// # Errors
    /// Numbers that are not above 0; a chamber without volume in the undeformed shape, or full to the rim with a surface.
    pub(crate) fn pour(
        &self,
        walls: ChamberForce,
        dofs: usize,
        weight: Weight,
        flow: Vec<Signal>,
    ) -> Result<LiquidInChamber, InputError> {
        let input = |key: &str| format!("liquid in chamber \"{}\" {key}", self.chamber);
        let bulk = positive(&input("bulk_modulus"), self.bulk_modulus, "Pa")?;
        let density = positive(&input("density"), self.density, "kg/m^3")?;
        let fill = positive(&input("fill"), self.fill, "1")?;
        let full = |help: &str| InputError::new(input("fill"), fill, help);
        if self.has_surface && fill >= 1.0 {
            return Err(full(FULL));
        }
        let walls = walls.anchored();
        let volume = walls.volume(&vec![0.0; dofs]);
        if !walls.has_room() {
            let help = "in the undeformed shape the chamber must enclose a volume (m^3), which the liquid fills";
            return Err(InputError::new(input("volume"), format!("{volume:.1e}"), help));
        }
        let amount = density * fill * volume;
        let held: Box<dyn Held> = match weight {
            Weight::OfSurface { basin, gravity } => {
                let pool = Pool::new(walls, basin, gravity, [amount, density], dofs);
                Box::new(pool.map_err(|_| full(FULL))?)
            }
            Weight::None => Box::new(Whole::new(walls, bulk, [amount, density], None, dofs)),
            Weight::Whole { moment, gravity } => {
                let weight = Some((moment, gravity));
                Box::new(Whole::new(walls, bulk, [amount, density], weight, dofs))
            }
        };
        let unloaded = if self.has_surface { LEAST * amount } else { density * volume };
        Ok(LiquidInChamber { held, density, unloaded, flow })
    }
}

/// Geometry for the weight of a liquid, with the strength of gravity (m/s^2).
pub(crate) enum Weight {
    None,
    /// Of one that fills its chamber whole.
    Whole {
        moment: Moment,
        gravity: f64,
    },
    /// Of one with a surface.
    OfSurface {
        basin: Basin,
        gravity: f64,
    },
}

/// A liquid within walls.
pub(crate) struct LiquidInChamber {
    held: Box<dyn Held>,
    density: f64,
    unloaded: f64,
    flow: Vec<Signal>,
}

impl LiquidInChamber {
    /// The natural volume (m^3) of an `amount` (kg).
    pub(crate) fn natural(&self, amount: f64) -> f64 {
        amount / self.density
    }

    /// The amount (kg) without pressure in the undeformed shape, apart from that of its weight; with a surface next to none.
    pub(crate) fn unloaded(&self) -> f64 {
        self.unloaded
    }

    /// The rate (kg/s) at which it flows in at time `t` (s).
    ///
    /// # Errors
    /// A rate that is not finite.
    pub(crate) fn rate(&self, t: f64) -> Result<f64, Failure> {
        let rate = signal::sum(&self.flow, t);
        let name = self.walls().name();
        Ok(self.density * finite_at(t, format_args!("the flow into chamber \"{name}\""), rate)?)
    }

    /// dE/dm (J/kg) of an `amount` (kg), and its derivative by the amount in a chamber that stays (J/kg^2).
    ///
    /// # Errors
    /// As [`ChamberFluid::press`].
    pub(crate) fn brought(&self, u: &[f64], amount: f64) -> Result<[f64; 2], Failure> {
        self.held.brought(u, amount)
    }

    /// g z (J/kg) of its middle, or of its surface, in the undeformed shape, above the origin.
    pub(crate) fn lifted(&self) -> f64 {
        self.held.lifted()
    }

    /// The level (m) of the surface of an `amount` (kg) above the origin; NaN where there is none.
    pub(crate) fn level(&self, u: &[f64], amount: f64) -> f64 {
        self.held.level(u, amount)
    }

    /// Lines along which that surface meets the walls (m); in the plane from wall to wall.
    #[cfg(feature = "output")]
    pub(crate) fn waterline(&self, u: &[f64], amount: f64) -> Vec<[[f64; 3]; 2]> {
        self.held.waterline(u, amount)
    }
}

impl ChamberFluid for LiquidInChamber {
    fn walls(&self) -> &ChamberForce {
        self.held.walls()
    }

    fn amount(&self) -> f64 {
        self.held.amount()
    }

    fn press(&self, u: &[f64], fill: Fill, forces: &mut NodalForces) -> Result<(), Failure> {
        self.held.press(u, fill, forces)
    }

    fn linearize(
        &self,
        u: &[f64],
        fill: Fill,
        stiffness: &mut BlockMatrix,
        gradient: &mut [f64],
    ) -> Option<[f64; 3]> {
        self.held.linearize(u, fill, stiffness, gradient)
    }

    fn potential(&self, u: &[f64], fill: Fill) -> f64 {
        self.held.potential(u, fill)
    }

    fn gauge(&self, u: &[f64], amount: f64) -> Result<f64, Failure> {
        self.held.gauge(u, amount)
    }

    fn volume_under(&self, amount: f64, gauge: f64) -> Option<f64> {
        self.held.volume_under(amount, gauge)
    }
}
