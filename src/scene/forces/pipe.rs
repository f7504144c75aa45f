//! Pipes between chambers with liquids: what drives the liquid in them, and what brakes it.

use super::signal::{Signal, finite_at};
use crate::base::input::{InputError, not_negative, positive};
use crate::integrators::ode::Failure;

/// Viscosity of water at 20 C (Pa s).
const WATER: f64 = 1e-3;

/// A pipe, a tube or a channel between two chambers with a [liquid](crate::Liquid), or between one and a [supply](crate::Scene::supply) or the atmosphere.
///
/// The liquid in it has inertia: with the length l, the area A of its section and the density rho the flow q (m^3/s, from the first end to the second) follows
///
/// ```text
/// (rho l/A) dq/dt = p_1 - p_2 + rho g (z_1 - z_2) - R q - zeta rho q |q|/(2 A^2),   R = 8 pi mu l/A^2,
/// ```
///
/// with the friction R of a slow flow in a round pipe (G. Hagen, J. L. M. Poiseuille) and losses at ends and bends by a coefficient zeta. Of a chamber that is full p is the mean pressure
/// and z the height of its middle, of one with a [surface](crate::Liquid::surface) p is 0 and z the level, wherever in the chamber the pipe ends: in a liquid at rest pressure and height make
/// up for each other. A supply, whose pressure is absolute, and the atmosphere are at the height that the chamber at the other end has in the undeformed
/// shape, its middle or its level, and are unlimited.
///
/// The amounts and the flow are unknowns under error control. The kinetic energy of the liquid in the pipe counts with that of the bodies, friction and losses
/// as dissipated, and the work of a supply as supplied.
///
/// ```
/// use pliant::simulate::Reading;
/// use pliant::{Body, Cells, Chamber, Liquid, Material, Mesh, Phase, Pipe, Sampling, Scene, Settings};
///
/// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 100.0 };
/// let ring = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles)?;
/// let scene = Scene::new(Body::new(ring, rubber).thickness(0.01).build()?)
///     .chamber(Chamber::within("bladder", "inner"))
///     .liquid(Liquid::in_chamber("bladder"))
///     .supply("syringe", 101325.0 + 500.0)
///     .pipe(Pipe::new("tube", "syringe", "bladder", 0.5, 7e-6))
///     .phase(Phase::until(0.2).hold([1, 2, 3]));
/// let sampling = Sampling::phase_ends().read("flow", Reading::pipe_flow("tube"));
/// let motion = scene.simulate(&Settings::default(), &sampling)?;
/// assert!(motion.last().sensors[0] > 0.0);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Pipe {
    name: String,
    ends: [String; 2],
    length: f64,
    area: f64,
    viscosity: f64,
    loss: f64,
}

impl Pipe {
    /// A pipe of this `length` l (m) and `area` A of its section (m^2) between two ends, each the name of a chamber with a liquid, of a supply, or `atmosphere`; one of them
    /// is a chamber.
    pub fn new(
        name: impl Into<String>,
        from: impl Into<String>,
        to: impl Into<String>,
        length: f64,
        area: f64,
    ) -> Self {
        let ends = [from.into(), to.into()];
        Self { name: name.into(), ends, length, area, viscosity: WATER, loss: 0.0 }
    }

    /// Viscosity mu of the liquid (Pa s). Default: 1e-3, water.
    pub fn viscosity(mut self, viscosity: f64) -> Self {
        self.viscosity = viscosity;
        self
    }

    /// Loss coefficient zeta, the sum over ends, bends and valves: about 0.5 for a sharp-edged inlet, 1 for an outlet into a chamber. Default: 0.
    pub fn loss(mut self, coefficient: f64) -> Self {
        self.loss = coefficient;
        self
    }

    /// Name of the pipe.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Names of its ends.
    pub(crate) fn ends(&self) -> &[String; 2] {
        &self.ends
    }

    /// Its properties but for its name and its ends, as a text.
    pub(crate) fn likeness(&self) -> String {
        let (name, ends) = (String::new(), [const { String::new() }; 2]);
        format!("{:?}", Self { name, ends, ..self.clone() })
    }

    /// A pipe through which a `share` of that flows between the same pressures, as fast.
    pub(crate) fn times(self, share: f64) -> Self {
        // R goes with mu/A^2, and is to grow as 1/A
        Self { area: share * self.area, viscosity: share * self.viscosity, ..self }
    }

    /// The flow between `ends` of a liquid of this `density`.
    ///
    /// # Errors
    /// Numbers out of range.
    pub(crate) fn flow(&self, ends: [Mouth; 2], density: f64) -> Result<PipeFlow, InputError> {
        let input = |key: &str| format!("pipe \"{}\" {key}", self.name);
        let length = positive(&input("length"), self.length, "m")?;
        let area = positive(&input("area"), self.area, "m^2")?;
        let viscosity = not_negative(&input("viscosity"), self.viscosity, "Pa s")?;
        let loss = not_negative(&input("loss"), self.loss, "1")?;
        Ok(PipeFlow {
            name: self.name.clone(),
            ends,
            density,
            area,
            inertance: density * length / area,
            resistance: 8.0 * std::f64::consts::PI * viscosity * length / area.powi(2),
            loss: loss * density / (2.0 * area.powi(2)),
        })
    }
}

/// Boundary at an end of a pipe.
pub(crate) enum Mouth {
    /// The liquid of that number, among those of the scene.
    Liquid(usize),
    /// A supply or the atmosphere, of this absolute pressure (Pa), in air of the other one (Pa).
    Given(Signal, f64),
}

/// The flow through a pipe.
pub(crate) struct PipeFlow {
    name: String,
    pub(super) ends: [Mouth; 2],
    pub(super) density: f64,
    pub(super) area: f64,
    /// rho l/A (kg/m^4)
    pub(super) inertance: f64,
    /// R (Pa s/m^3) and zeta rho/(2 A^2) (kg/m^7).
    resistance: f64,
    loss: f64,
}

impl PipeFlow {
    /// Pressure (Pa) that brakes the flow q (m^3/s), and its derivative by it.
    pub(super) fn friction(&self, q: f64) -> [f64; 2] {
        [self.resistance * q + self.loss * q * q.abs(), self.resistance + 2.0 * self.loss * q.abs()]
    }

    /// Kinetic energy (J) of the flow q (m^3/s).
    pub(super) fn kinetic(&self, q: f64) -> f64 {
        0.5 * self.inertance * q * q
    }

    /// By what the pressure of a supply exceeds that of the air (Pa) at time `t` (s).
    ///
    /// # Errors
    /// One that is not finite.
    pub(super) fn given(&self, t: f64, pressure: &Signal, outside: f64) -> Result<f64, Failure> {
        let name = &self.name;
        let pressure = finite_at(t, format_args!("the supply of pipe \"{name}\""), pressure.at(t))?;
        Ok(pressure - outside)
    }
}
