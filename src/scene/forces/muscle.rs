//! Muscles: fibres in a body that pull by a stress of their own.
//!
//! They are fibres like those of a material under another law, W = s (l - 1), S = s / l, dS/dE = -s / l^3,
//! with the exact symmetric tangents of fibres; a force of the scene and not of the material, as phases and
//! commands drive it. With a signal s(t) the energy is no function of the shape alone, and all work counts as
//! supplied. By Hill's law the stress depends on the rate, too, which no elastic law does: it has terms of
//! its own in the loops (`elements/body/contraction.rs`), exact, and not symmetric by displacements where
//! fibres turn as they lengthen. Power of a muscle that lengthens stays in the same account. The activation
//! is a signal and no state.

use std::sync::Arc;

use super::actuator::{Actuator, ActuatorGauge, ActuatorKind, ComponentMap, Drive, Placed};
use super::signal::{self, Signal, finite_at};
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{Body, CellSelection, Contraction, Strands};
use crate::elements::force::{Force, Forces, NodalForces, Tangents};
use crate::elements::material::{FibreDirection, Hill};
use crate::elements::mesh::{Mesh, NodeMap};
use crate::integrators::ode::Failure;

/// A muscle: fibres through cells of a body with an active stress along them, which phases set
/// ([`Phase::actuate`](crate::Phase::actuate)), in addition to the elasticity of the material.
///
/// With the stretch l = |F a| of the fibres along a, which has length 1 in the undeformed shape, the stress s (Pa) adds
/// s (l - 1) to the energy per natural volume, and so s (F a) a^T / l to the first Piola stress: the muscle exerts
/// the force s per undeformed cross section, independent of its length. Positive stresses contract it, negative ones extend it. Its
/// work counts as supplied.
///
/// By [Hill's law](Self::hill) its stress is smaller away from the optimal length of its fibres, and as they shorten.
///
/// (Active stress in addition to the elasticity: G. Chagnon, M. Rebouah, D. Favier, Journal of Elasticity 120 (2015) 129-160
/// compare it with other models. Many prescribe the second Piola stress, s a a^T, for which the force per section
/// depends on the stretch.)
///
/// ```
/// use pliant::{Body, Cells, CellSelection, Material, Mesh, Muscle, Phase, Scene, Statics};
///
/// // a strip whose upper half contracts, so that it bends up
/// let mesh = Mesh::rectangle([0.1, 0.01], [21, 5], Cells::Rectangles9)?;
/// let silicone = Material { density: 1070.0, young: 2e5, poisson: 0.4, viscosity: 200.0 };
/// let body = Body::new(mesh, silicone).thickness(0.01).build()?;
/// let upper = CellSelection::inside([0.0, 0.005], [0.1, 0.01]);
/// let scene = Scene::new(body)
///     .muscle(Muscle::along([1.0, 0.0]).within(upper).named("upper"))
///     .phase(Phase::until(1.0).hold("left").actuate(["upper"], 1e4));
/// let bent = scene.equilibrium(&Statics::default())?;
/// let tip = 2 * (21 * 5 - 1); // the upper corner on the right
/// assert!(bent.trajectory().last().u[tip + 1] > 0.01);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Muscle {
    name: String,
    course: FibreDirection,
    cells: Option<CellSelection>,
    hill: Option<Hill>,
}

impl Muscle {
    /// A muscle whose fibres run along a `direction`, of any length above 0, in the undeformed shape.
    pub fn along(direction: impl Into<Vec<f64>>) -> Self {
        Self::new(FibreDirection::Along(direction.into()))
    }

    /// One whose fibres are rings around the axis through `centre` (m), in the direction of `axis`; in the plane
    /// `axis` is empty.
    pub fn around(centre: impl Into<Vec<f64>>, axis: impl Into<Vec<f64>>) -> Self {
        Self::new(FibreDirection::around(centre.into(), axis.into()))
    }

    /// A muscle whose fibres run as fibres of a material do.
    pub(crate) fn new(course: FibreDirection) -> Self {
        Self { name: String::new(), course, cells: None, hill: None }
    }

    /// Helices in place of rings, which climb along the axis by the angle `pitch` (rad); fibres along a vector do
    /// not change.
    pub fn pitch(self, angle: f64) -> Self {
        Self { course: self.course.with_pitch(angle), ..self }
    }

    /// The cells that it lies in (default: all).
    pub fn within(self, cells: impl Into<CellSelection>) -> Self {
        Self { cells: Some(cells.into()), ..self }
    }

    /// Lets the stress depend on the length of the fibres and on its rate, by a `law`: phases then give the stress of fibres of the best length at rest,
    /// from 0 to the largest. It acts as a damper, too.
    pub fn hill(self, law: Hill) -> Self {
        Self { hill: Some(law), ..self }
    }

    /// Hill's law, if it has one.
    pub fn law(&self) -> Option<&Hill> {
        self.hill.as_ref()
    }

    /// Name of the muscle (default: "muscle 1", "muscle 2", ... in the order of the scene). Springs have other names.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Name of the muscle.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// The cells that it lies in, counted from 0.
    fn cells(&self, mesh: &Mesh) -> Result<Vec<usize>, InputError> {
        let cells = CellSelection::cells_or_all(self.cells.as_ref(), mesh);
        cells.map_err(|error| self.blamed(error))
    }

    /// Its fibres.
    ///
    /// # Errors
    /// Cells that the body does not have, that are rigid, or whose strain is Cauchy's; a course that is none there; numbers that are none of
    /// Hill's law.
    fn strands(&self, body: &Body) -> Result<Strands, InputError> {
        let cells = self.cells(body.mesh())?;
        self.hill.iter().try_for_each(Hill::validate).map_err(|error| self.blamed(error))?;
        let strands = self.course.validate().and_then(|()| body.strands(&cells, &self.course));
        strands.map_err(|error| self.blamed(error))
    }

    fn blamed(&self, error: InputError) -> InputError {
        InputError { input: format!("muscle \"{}\" {}", self.name, error.input), ..error }
    }
}

pub(crate) const MUSCLE: ActuatorKind = ActuatorKind {
    name: "muscle",
    list: "muscles",
    drive: Drive::Stress,
    label: "stress",
    is_axisymmetric: false,
};

impl Muscle {
    /// Number of an output: the stress (Pa) by which it pulls, the mean over its volume.
    pub(crate) const STRESS: usize = 0;
    /// The mean stretch of its fibres (1).
    pub(crate) const STRETCH: usize = 1;
    /// Its activation by Hill's law (1).
    pub(crate) const ACTIVATION: usize = 2;
}

impl Actuator for Muscle {
    fn name(&self) -> &str {
        &self.name
    }

    fn kind(&self) -> &'static ActuatorKind {
        &MUSCLE
    }

    fn driven(&self, body: &Body, stress: Vec<Signal>) -> Result<Forces, InputError> {
        let strands = self.strands(body)?;
        Ok(match stress.is_empty() {
            true => Forces::new(),
            false => vec![Arc::new(MuscleForce { muscle: self.clone(), strands, stress })],
        })
    }

    fn gauge(&self, body: &Body) -> Result<ActuatorGauge, InputError> {
        let (strands, hill) = (self.strands(body)?, self.hill);
        Ok(Box::new(move |output, now| match (output, &hill) {
            (Self::STRETCH, _) => strands.mean_stretch(now.u),
            (Self::ACTIVATION, Some(law)) => (now.drive[0] / law.largest).clamp(0.0, 1.0),
            (_, Some(law)) => {
                strands.mean_pull(Contraction { law, stress: now.drive[0] }, now.u, now.v)
            }
            (_, None) => now.drive[0],
        }))
    }

    fn check(&self, stress: f64) -> Result<(), InputError> {
        let checked = self.hill.as_ref().map_or(Ok(()), |hill| hill.check_stress(stress));
        checked.map_err(|error| self.blamed(error))
    }

    fn hill(&self) -> Option<&Hill> {
        self.law()
    }

    fn mapped(&self, map: &ComponentMap<'_>) -> Result<Arc<dyn Actuator>, InputError> {
        let cells = self.cells.as_ref().map(map.cells).transpose()?;
        Ok(Arc::new(Self { cells, ..self.clone() }))
    }

    fn placed(&self, body: &Body, map: &NodeMap) -> Result<Placed, InputError> {
        let (cells, likeness) = (self.cells(body.mesh())?, format!("muscle {:?}", self.hill));
        Ok(Placed::within(likeness, &cells, Some(&self.course), body.mesh(), map))
    }
}

/// The force of a muscle.
struct MuscleForce {
    muscle: Muscle,
    strands: Strands,
    stress: Vec<Signal>,
}

impl Force for MuscleForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let stress = signal::sum(&self.stress, t);
        let applied = &mut forces.applied;
        finite_at(t, format_args!("the stress of muscle \"{}\"", self.muscle.name), stress)?;
        let Some(law) = &self.muscle.hill else {
            return self.strands.add_forces(stress, u, applied);
        };
        self.muscle
            .check(stress)
            .map_err(|error| Failure::Fatal(format!("at t = {t} s {error}").into()))?;
        self.strands.contract(Contraction { law, stress }, u, v, applied)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let stress = signal::sum(&self.stress, t);
        match &self.muscle.hill {
            None => self.strands.add_tangents(stress, u, stiffness, damping),
            Some(law) => {
                let contraction = Contraction { law, stress };
                self.strands.add_contraction_tangents(contraction, u, v, stiffness, damping);
            }
        }
        Tangents::Added
    }
}
