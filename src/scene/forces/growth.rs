//! Growth: cells that swell, or expand by heat.

use super::signal::{self, Signal, finite_at};
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{Body, CellSelection, Growing};
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::integrators::ode::Failure;

/// Cells of a body that grow alike in all directions: by swelling, or by heat.
///
/// Phases give the strain e by which they grow ([`Phase::actuate`](crate::Phase::actuate)): what is free gets 1 + e times as long, without stress. Of heat it is the coefficient
/// of thermal expansion times the change of temperature. With g = 1 + e the deformation gradient is F = F_e g, and g^3 W(F_e) the energy
/// per natural volume, W being that of the material's law (E. K. Rodriguez, A. Hoger, A. D. McCulloch, Journal of Biomechanics 27 (1994)
/// 455-467). What growth adds to the energy counts as supplied. Mass stays, and so do fibres and viscosity.
///
/// For Green's strain with any law, in solids, plane stress, membranes and strings; not in plane strain, where what cannot grow across the plane is
/// pressed there, and not with Maxwell branches.
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
}

impl Growth {
    /// Growth of the whole body.
    pub fn everywhere() -> Self {
        Self { name: String::new(), cells: None }
    }

    /// Growth of these cells.
    pub fn within(cells: impl Into<CellSelection>) -> Self {
        Self { cells: Some(cells.into()), ..Self::everywhere() }
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

    /// The same with the cells that `change` makes of those it was given.
    pub(crate) fn with_cells(
        &self,
        change: impl Fn(&CellSelection) -> Result<CellSelection, InputError>,
    ) -> Result<Self, InputError> {
        Ok(Self { cells: self.cells.as_ref().map(change).transpose()?, ..self.clone() })
    }

    /// The cells that grow, counted from 0.
    ///
    /// # Errors
    /// Cells that the body does not have.
    pub(crate) fn cells(&self, body: &Body) -> Result<Vec<usize>, InputError> {
        let cells = CellSelection::cells_or_all(self.cells.as_ref(), body.mesh());
        cells.map_err(|error| self.blamed(error))
    }

    /// The elasticity of its cells.
    ///
    /// # Errors
    /// Cells that the body does not have, or that cannot grow.
    pub(crate) fn growing(&self, body: &Body) -> Result<Growing, InputError> {
        body.growing(&self.cells(body)?).map_err(|error| self.blamed(error))
    }

    fn blamed(&self, error: InputError) -> InputError {
        InputError { input: format!("growth \"{}\" {}", self.name, error.input), ..error }
    }

    /// Its force under the sum of the signals `strain` (1).
    ///
    /// # Errors
    /// As [`growing`](Self::growing).
    pub(crate) fn force(
        &self,
        body: &Body,
        strain: Vec<Signal>,
    ) -> Result<GrowthForce, InputError> {
        Ok(GrowthForce { name: self.name.clone(), growing: self.growing(body)?, strain })
    }
}

/// The elastic force of cells that grow.
pub(crate) struct GrowthForce {
    name: String,
    growing: Growing,
    strain: Vec<Signal>,
}

impl GrowthForce {
    /// How many times as long what is free is.
    fn stretch(&self, t: f64) -> f64 {
        1.0 + signal::sum(&self.strain, t)
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
        let stretch = self.stretch(t);
        let name = &self.name;
        finite_at(t, format_args!("the strain of growth \"{name}\""), stretch - 1.0)?;
        if stretch <= 0.0 {
            let strain = stretch - 1.0;
            let help = format!(
                "the strain of growth \"{name}\" is {strain} at t = {t} s: nothing is left, it must be above -1"
            );
            return Err(Failure::Fatal(help.into()));
        }
        // steps end at kinks, and the power there is that of the way to them
        let rate = self.strain.iter().map(|signal| signal.rate_before(t)).sum();
        self.growing.add_forces([stretch, rate], u, forces)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        self.growing.add_tangents(self.stretch(t), u, stiffness);
        Tangents::Added
    }

    fn potential(&self, t: f64, u: &[f64]) -> f64 {
        self.growing.energy(self.stretch(t), u)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }
}
