//! Growth: cells that swell, or expand by heat.
//!
//! Elasticity of the body is then that of the other cells (regions whose law has no stiffness in these, as
//! with rigid pieces), and each growth one more loop over its cells. Power by the rate of g, 3 g^2 U + g
//! f(u') . x when alike in all directions, counts as supplied, as a jump between phases or by a command does.
//! Forks share their forces, so an evaluation takes buffers for u' and f from a list and returns them: no
//! lock is held while it runs.

use std::sync::Arc;

use super::actuator::{Actuator, ActuatorGauge, ActuatorKind, ComponentMap, Drive, Placed};
use super::signal::{self, Signal, finite_at};
use crate::base::input::{InputError, finite};
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{Body, CellSelection, Growing, Grown};
use crate::elements::force::{Force, Forces, NodalForces, Reservoir, Tangents};
use crate::elements::material::{FibreDirection, Stretches};
use crate::elements::mesh::NodeMap;
use crate::integrators::ode::Failure;

/// Cells of a body that grow: by swelling, by heat, or as an active material does.
///
/// Phases set the strain e of growth ([`Phase::actuate`](crate::Phase::actuate)): unconstrained cells get g = 1 + e times as long, without stress. For
/// thermal expansion it is the coefficient of expansion times the change of temperature. Growth is isotropic, or along
/// [one direction](Self::along), which may run [around](Self::around) an axis; across it cells [keep their size](Self::across), or [their
/// volume](Self::keeping_volume).
///
/// The deformation gradient is F = F_e G with G = g a a^T + g_t (I - a a^T), and det(G) W(F_e) the energy
/// per natural volume, W being that of the material's law (E. K. Rodriguez, A. Hoger, A. D. McCulloch, Journal of Biomechanics 27 (1994)
/// 455-467; of muscles "active strain": D. Ambrosi, S. Pezzuto, Journal of Elasticity 107 (2012) 199-212). Energy added by growth counts
/// as supplied. Mass, fibres and viscosity do not change.
///
/// Rods get longer along their axis, or [bend](Self::bending).
///
/// For Green's strain with any law; not with Maxwell branches. In plane strain growth across the plane is constrained and causes a pressure; in plane stress, membranes and
/// strings get thicker.
///
/// ```
/// use pliant::{Body, Cells, CellSelection, Growth, Material, Mesh, Phase, Plane, Scene, Statics};
///
/// // a strip of two layers, the lower of which swells by 2 %: it bends up
/// let mesh = Mesh::rectangle([0.1, 0.01], [21, 5], Cells::Rectangles9)?;
/// let gel = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 100.0 };
/// let body = Body::new(mesh, gel).thickness(0.01).plane(Plane::Stress).build()?;
/// let lower = CellSelection::inside([0.0, 0.0], [0.1, 0.005]);
/// let scene = Scene::new(body)
///     .growth(Growth::within(lower).named("lower"))
///     .phase(Phase::until(1.0).hold("left").actuate(["lower"], 0.02));
/// let bent = scene.equilibrium(&Statics::default())?;
/// let tip = 2 * (21 * 5 - 1);
/// assert!(bent.trajectory().last().u[tip + 1] > 0.01);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Growth {
    name: String,
    cells: Option<CellSelection>,
    course: Option<FibreDirection>,
    across: Option<Across>,
    /// Curvatures and twist (1/m) of rods per strain.
    bends: Option<[f64; 3]>,
}

/// Growth across the direction of growth.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Across {
    /// By the strain along the direction times this (1).
    Share(f64),
    /// So that its volume does not change.
    KeepsVolume,
}

impl Growth {
    /// Growth of the whole body.
    pub fn everywhere() -> Self {
        Self { name: String::new(), cells: None, course: None, across: None, bends: None }
    }

    /// Growth of these cells.
    pub fn within(cells: impl Into<CellSelection>) -> Self {
        Self { cells: Some(cells.into()), ..Self::everywhere() }
    }

    /// The same along a `direction`, of any length above 0, in the undeformed shape. In membranes its component along them counts.
    ///
    /// ```
    /// use pliant::{Body, Growth, Law, Material, Mesh, Phase, Scene, SolidCells, Statics};
    ///
    /// // an elastomer of liquid crystals shrinks along them by a third, and gets thicker
    /// let mesh = Mesh::cuboid([0.1, 0.01, 0.01], [11, 2, 2], SolidCells::Hexahedra20)?;
    /// let rubber = Material { density: 1100.0, young: 1e6, poisson: 0.49, viscosity: 0.0 };
    /// let body = Body::new(mesh, rubber.law(Law::NeoHookean)).build()?;
    /// let scene = Scene::new(body)
    ///     .growth(Growth::everywhere().along([1.0, 0.0, 0.0]).keeping_volume())
    ///     .phase(Phase::until(1.0).hold_axes("left", [pliant::Axis::X]).hold([1, 2]).actuate(["growth 1"], -1.0 / 3.0));
    /// # assert!(scene.validate().is_ok());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn along(self, direction: impl Into<Vec<f64>>) -> Self {
        self.along_course(FibreDirection::Along(direction.into()))
    }

    /// The same along rings around the axis through `centre` (m), in the direction of `axis`; in the plane `axis` is empty.
    pub fn around(self, centre: impl Into<Vec<f64>>, axis: impl Into<Vec<f64>>) -> Self {
        self.along_course(FibreDirection::around(centre.into(), axis.into()))
    }

    /// The same along a course as fibres of a material have.
    pub(crate) fn along_course(self, course: FibreDirection) -> Self {
        Self { course: Some(course), ..self }
    }

    /// Helices in place of rings, which climb along the axis by the angle `pitch` (rad); a vector does not change.
    pub fn pitch(self, angle: f64) -> Self {
        Self { course: self.course.map(|course| course.with_pitch(angle)), ..self }
    }

    /// Growth across the direction by the strain along it times this (1, default 0): g_t = 1 + `share` e. With 1 it is isotropic.
    pub fn across(self, share: f64) -> Self {
        Self { across: Some(Across::Share(share)), ..self }
    }

    /// Growth across the direction that keeps the volume, g_t = g^(-1/2): of muscles and of elastomers of liquid crystals, which change their shape and not
    /// their volume.
    pub fn keeping_volume(self) -> Self {
        Self { across: Some(Across::KeepsVolume), ..self }
    }

    /// Growth of rods by bending and twisting in place of length: a strain e adds e times these curvatures (1/m) about the axes d_1 and d_2 of their sections,
    /// and this twist (rad/m), to the stress-free ones. In the plane the second curvature applies.
    pub fn bending(self, curvatures: [f64; 2], twist: f64) -> Self {
        Self { bends: Some([curvatures[0], curvatures[1], twist]), ..self }
    }

    /// Name of the growth (default: "growth 1", "growth 2", ... in the order of the scene). Springs and muscles have other names.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Name of the growth.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// The cells that grow, counted from 0.
    ///
    /// # Errors
    /// Cells that the body does not have.
    fn cells(&self, body: &Body) -> Result<Vec<usize>, InputError> {
        let cells = CellSelection::cells_or_all(self.cells.as_ref(), body.mesh());
        cells.map_err(|error| self.blamed(error))
    }

    /// The elasticity of its cells.
    ///
    /// # Errors
    /// Cells that the body does not have, or that cannot grow; an invalid direction; growth across a direction that is not given.
    fn growing(&self, body: &Body) -> Result<Growing, InputError> {
        let cells = self.cells(body)?;
        let course = self.course.as_ref();
        let growing = self.check_across().and_then(|()| {
            course.map_or(Ok(()), FibreDirection::validate)?;
            finite("bend and twist", &self.bends.unwrap_or_default())?;
            body.growing(&cells, course, self.bends)
        });
        growing.map_err(|error| self.blamed(error))
    }

    fn check_across(&self) -> Result<(), InputError> {
        let help = "growth without a direction is isotropic: give along or centre, too";
        match (&self.across, &self.course) {
            (Some(Across::KeepsVolume), None) => Err(InputError::new("keeps_volume", true, help)),
            (Some(Across::Share(share)), None) => Err(InputError::new("across", share, help)),
            (Some(Across::Share(share)), Some(_)) => finite("across", &[*share]),
            _ => Ok(()),
        }
    }

    /// Stretches of unconstrained cells along the direction and across it, after a `strain` (1).
    fn stretches(&self, strain: f64) -> Stretches {
        let along = 1.0 + strain;
        let across = match (&self.course, self.across) {
            (None, _) => along,
            (_, None) => 1.0,
            (_, Some(Across::Share(share))) => 1.0 + share * strain,
            (_, Some(Across::KeepsVolume)) => 1.0 / along.sqrt(),
        };
        Stretches { along, across }
    }

    /// How fast these grow (1/s) by the `rate` of the strain.
    fn rates(&self, Stretches { along, across }: Stretches, rate: f64) -> [f64; 2] {
        let of_across = match (&self.course, self.across) {
            (None, _) => rate,
            (_, None) => 0.0,
            (_, Some(Across::Share(share))) => share * rate,
            (_, Some(Across::KeepsVolume)) => -0.5 * across / along * rate,
        };
        [rate, of_across]
    }

    fn blamed(&self, error: InputError) -> InputError {
        InputError { input: format!("growth \"{}\" {}", self.name, error.input), ..error }
    }

    /// Its force under the sum of the signals `strain` (1).
    ///
    /// # Errors
    /// As [`growing`](Self::growing).
    pub(super) fn force(
        &self,
        body: &Body,
        strain: Vec<Signal>,
    ) -> Result<GrowthForce, InputError> {
        Ok(GrowthForce { growth: self.clone(), growing: self.growing(body)?, strain })
    }
}

pub(crate) const GROWTH: ActuatorKind = ActuatorKind {
    name: "growth",
    list: "growths",
    drive: Drive::Strain,
    label: "growth",
    is_axisymmetric: false,
};

impl Actuator for Growth {
    fn name(&self) -> &str {
        &self.name
    }

    fn kind(&self) -> &'static ActuatorKind {
        &GROWTH
    }

    fn driven(&self, body: &Body, strain: Vec<Signal>) -> Result<Forces, InputError> {
        Ok(match strain.is_empty() {
            true => self.growing(body).map(|_| Forces::new())?,
            false => vec![Arc::new(self.force(body, strain)?)],
        })
    }

    fn gauge(&self, _body: &Body) -> Result<ActuatorGauge, InputError> {
        Ok(Box::new(|_, now| now.drive[0]))
    }

    fn grown(&self, body: &Body, strain: f64) -> Result<Option<Grown>, InputError> {
        // no cell changes its size
        if self.bends.is_some() {
            return Ok(None);
        }
        let (cells, course) = (self.cells(body)?, self.course.clone());
        Ok(Some(Grown { cells, course, stretches: self.stretches(strain) }))
    }

    fn mapped(&self, map: &ComponentMap<'_>) -> Result<Arc<dyn Actuator>, InputError> {
        let cells = self.cells.as_ref().map(map.cells).transpose()?;
        Ok(Arc::new(Self { cells, ..self.clone() }))
    }

    fn placed(&self, body: &Body, map: &NodeMap) -> Result<Placed, InputError> {
        let (cells, likeness) = (self.cells(body)?, format!("growth {:?}", self.across));
        Ok(Placed::within(likeness, &cells, self.course.as_ref(), body.mesh(), map))
    }
}

/// The elastic force of cells that grow.
pub(super) struct GrowthForce {
    growth: Growth,
    growing: Growing,
    strain: Vec<Signal>,
}

impl GrowthForce {
    fn stretches(&self, t: f64) -> Stretches {
        self.growth.stretches(signal::sum(&self.strain, t))
    }

    /// Checks that something is left in all directions at time `t` (s).
    fn check(&self, t: f64, Stretches { along, across }: Stretches) -> Result<(), Failure> {
        let (name, strain) = (&self.growth.name, signal::sum(&self.strain, t));
        finite_at(t, format_args!("the strain of growth \"{name}\""), strain)?;
        if along <= 0.0 {
            let help = format!(
                "the strain of growth \"{name}\" is {strain} at t = {t} s: nothing is left, it must be above -1"
            );
            return Err(Failure::Fatal(help.into()));
        }
        if across <= 0.0 {
            let across = across - 1.0;
            let help = format!(
                "the strain of growth \"{name}\" is {strain} at t = {t} s, and {across} across: nothing is left there, it must be above -1"
            );
            return Err(Failure::Fatal(help.into()));
        }
        Ok(())
    }
}

impl Force for GrowthForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let stretches = self.stretches(t);
        self.check(t, stretches)?;
        // steps end at kinks, and the power there is that of the way to them
        let rate = self.strain.iter().map(|signal| signal.rate_before(t)).sum();
        let rates = self.growth.rates(stretches, rate);
        self.growing.add_forces(stretches, rates, u, forces)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        self.growing.add_tangents(self.stretches(t), u, stiffness, damping);
        Tangents::Added
    }

    fn potential(&self, t: f64, u: &[f64]) -> f64 {
        self.growing.energy(self.stretches(t), u)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }
}
