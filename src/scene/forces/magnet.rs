//! Hard magnets in a body, and the field that acts on them.

use super::signal::{VectorSignal, finite_at};
use super::time_table::TimeTable;
use crate::base::input::{InputError, finite};
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{Body, CellSelection, MagnetizedPoints, Magnets};
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::integrators::ode::Failure;

/// A part of a body that is a hard magnet: its remanence b (T), of the undeformed shape, moves along with the material.
///
/// In a magnetic field B ([`Phase::magnetic_field`](crate::Phase::magnetic_field)) it has the energy
/// -(F b) . B / mu_0 per natural volume, F being the deformation gradient: the ideal hard-magnetic material of R. Zhao, Y. Kim,
/// S. A. Chester, P. Sharma, X. Zhao, Journal of the Mechanics and Physics of Solids 124 (2019) 244-263. A uniform field turns it, one with a gradient
/// pulls, too. Effects of its own field on itself, on other magnets and on the applied field are neglected, as for a weakly magnetized
/// material of the permeability of vacuum. Work of the field counts as supplied.
///
/// ```
/// use pliant::{Body, Cells, Magnet, Material, Mesh, Phase, Plane, Scene, Statics};
///
/// // a strip that is magnetized along itself turns into a field across it
/// let mesh = Mesh::rectangle([0.02, 0.001], [41, 3], Cells::Rectangles9)?;
/// let material = Material { density: 2000.0, young: 1e6, poisson: 0.45, viscosity: 1e3 };
/// let body = Body::new(mesh, material).thickness(0.005).plane(Plane::Stress).build()?;
/// let scene = Scene::new(body)
///     .magnet(Magnet::new([0.1, 0.0]))
///     .phase(Phase::until(1.0).hold("left").magnetic_field([0.0, 0.005]));
/// let bent = scene.equilibrium(&Statics::default())?;
/// let tip = 2 * (41 * 3 - 1);
/// assert!(bent.trajectory().last().u[tip + 1] > 0.005);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Magnet {
    remanence: Vec<f64>,
    cells: Option<CellSelection>,
}

impl Magnet {
    /// A magnet with this `remanence` (T), one component per dimension, in all of the body.
    pub fn new(remanence: impl Into<Vec<f64>>) -> Self {
        Self { remanence: remanence.into(), cells: None }
    }

    /// The cells that it consists of (default: all). Where magnets overlap, their remanences add up.
    pub fn within(self, cells: impl Into<CellSelection>) -> Self {
        Self { cells: Some(cells.into()), ..self }
    }

    /// Its remanence (T).
    pub fn remanence(&self) -> &[f64] {
        &self.remanence
    }

    /// The same with the cells that `change` makes of those it was given.
    pub(crate) fn with_cells(
        &self,
        change: impl Fn(&CellSelection) -> Result<CellSelection, InputError>,
    ) -> Result<Self, InputError> {
        Ok(Self { cells: self.cells.as_ref().map(change).transpose()?, ..self.clone() })
    }

    /// Adds itself to the magnetization of a body; `number` is its own, from 1.
    ///
    /// # Errors
    /// Cells that the body does not have; a remanence of another dimension, or out of range.
    pub(crate) fn add_to(
        &self,
        body: &Body,
        number: usize,
        magnets: &mut Magnets,
    ) -> Result<(), InputError> {
        let blamed = |error| blamed(number, error);
        let dimension = body.dimension();
        if self.remanence.len() != dimension {
            let help = format!("it needs {dimension} component(s) (T)");
            let value = format!("{:?}", self.remanence);
            return Err(blamed(InputError::new("remanence", value, help)));
        }
        finite("remanence", &self.remanence).map_err(blamed)?;
        let cells = self.cells_in(body, number)?;
        body.magnetize(&cells, &self.remanence, magnets).map_err(blamed)
    }

    /// Adds its strain points to those of a body; its remanence has been [checked](Self::add_to).
    ///
    /// # Errors
    /// Cells that the body does not have.
    pub(crate) fn add_points_to(
        &self,
        body: &Body,
        number: usize,
        points: &mut Vec<Box<dyn MagnetizedPoints>>,
    ) -> Result<(), InputError> {
        body.add_magnetized_points(&self.cells_in(body, number)?, &self.remanence, points);
        Ok(())
    }

    /// Its cells, counted from 0; `number` is its own, from 1.
    ///
    /// # Errors
    /// Cells that the body does not have.
    pub(crate) fn cells_in(&self, body: &Body, number: usize) -> Result<Vec<usize>, InputError> {
        let cells = CellSelection::cells_or_all(self.cells.as_ref(), body.mesh());
        cells.map_err(|error| blamed(number, error))
    }
}

/// An error of the magnet with a `number`, from 1.
fn blamed(number: usize, error: InputError) -> InputError {
    InputError { input: format!("magnet {number} {}", error.input), ..error }
}

/// A magnetic field (T) that acts on the magnets of a scene: one vector, constant or changing with time, everywhere, and a gradient that
/// does not change.
///
/// Vectors convert into uniform constant fields.
#[derive(Debug, Clone)]
pub struct MagneticField {
    pub(crate) field: VectorSignal,
    pub(crate) gradient: Option<Gradient>,
}

/// The change of a field in space.
#[derive(Debug, Clone)]
pub(crate) struct Gradient {
    /// d B_i / d x_j (T/m), row by row.
    rows: Vec<Vec<f64>>,
    /// Position at which it adds nothing (m).
    centre: Vec<f64>,
}

impl Gradient {
    /// The rows (T/m), and the point at which it adds nothing (m).
    #[cfg(feature = "play")]
    pub(crate) fn rows(&self) -> (&[Vec<f64>], &[f64]) {
        (&self.rows, &self.centre)
    }

    pub(crate) fn times(&self, factor: f64) -> Self {
        let rows = self.rows.iter().map(|row| row.iter().map(|x| factor * x).collect()).collect();
        Self { rows, centre: self.centre.clone() }
    }
}

impl MagneticField {
    /// The same field (T), one component per dimension, everywhere and all the time.
    pub fn uniform(field: impl Into<Vec<f64>>) -> Self {
        Self::of(VectorSignal::Constant(field.into()))
    }

    /// A field (T) that changes with time (s).
    pub fn with<const D: usize>(field: impl Fn(f64) -> [f64; D] + Send + Sync + 'static) -> Self {
        Self::of(VectorSignal::function(field))
    }

    /// A field that has the values `fields` (T) at the `times` (s, ascending). In between it is interpolated linearly; before and after it is constant.
    pub fn table(
        times: impl Into<Vec<f64>>,
        fields: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        let fields = fields.into_iter().map(Into::into).collect();
        Self::of(VectorSignal::TimeTable(TimeTable::new(times.into(), fields)))
    }

    pub(crate) fn of(field: VectorSignal) -> Self {
        Self { field, gradient: None }
    }

    /// The same field plus G (x - `centre`): `rows` are those of G, d B_i / d x_j (T/m), symmetric, as outside of currents, and in
    /// space without trace, as fields have no sources. `centre` is a point (m).
    pub fn gradient(
        self,
        rows: impl IntoIterator<Item: Into<Vec<f64>>>,
        centre: impl Into<Vec<f64>>,
    ) -> Self {
        let rows = rows.into_iter().map(Into::into).collect();
        Self { gradient: Some(Gradient { rows, centre: centre.into() }), ..self }
    }

    /// Its value (T) at time `t` (s) at a point (m).
    pub(crate) fn at(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let mut field = self.field.components(t, x.len());
        if let Some(Gradient { rows, centre }) = &self.gradient {
            for (field, row) in field.iter_mut().zip(rows) {
                let from_centre = x.iter().zip(centre).map(|(x, centre)| x - centre);
                *field += row.iter().zip(from_centre).map(|(g, x)| g * x).sum::<f64>();
            }
        }
        field
    }

    fn validate(&self, input: &str, dimension: usize) -> Result<(), InputError> {
        self.field.validate(input, dimension, "T")?;
        let Some(Gradient { rows, centre }) = &self.gradient else { return Ok(()) };
        let name = format!("gradient of {input}");
        let wrong = |help: String| InputError::new(name.clone(), format!("{rows:?} T/m"), help);
        if rows.len() != dimension || rows.iter().any(|row| row.len() != dimension) {
            return Err(wrong(format!("it needs {dimension} rows of {dimension} numbers")));
        }
        if centre.len() != dimension {
            let help = format!("it needs {dimension} coordinates (m)");
            return Err(InputError::new(
                format!("centre of the {name}"),
                format!("{centre:?}"),
                help,
            ));
        }
        finite(&format!("centre of the {name}"), centre)?;
        rows.iter().try_for_each(|row| finite(&name, row))?;
        let most = rows.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let is_apart = |a: f64, b: f64| (a - b).abs() > 1e-6 * most;
        if (0..dimension).any(|i| (0..i).any(|j| is_apart(rows[i][j], rows[j][i]))) {
            return Err(wrong(
                "it has to be symmetric: a field outside of currents has no curl".into(),
            ));
        }
        let trace: f64 = (0..dimension).map(|i| rows[i][i]).sum();
        if dimension == 3 && is_apart(trace, 0.0) {
            let help = format!(
                "its diagonal adds up to {trace} T/m, and has to add up to 0: a field has no sources"
            );
            return Err(wrong(help));
        }
        Ok(())
    }

    /// Its force on `magnets` in `body`; `input` is where it was given.
    ///
    /// # Errors
    /// Numbers out of range, of another dimension; a gradient that no field can have.
    pub(crate) fn force(
        &self,
        body: &Body,
        magnets: Magnets,
        input: String,
    ) -> Result<MagnetForce, InputError> {
        let dimension = body.dimension();
        self.validate(&input, dimension)?;
        let mut gradient = [[0.0; 3]; 3];
        let mut at_origin = [0.0; 3];
        let mut natural = Vec::new();
        if let Some(Gradient { rows, centre }) = &self.gradient {
            for (i, row) in rows.iter().enumerate() {
                gradient[i][..dimension].copy_from_slice(row);
                at_origin[i] = -row.iter().zip(centre).map(|(g, x)| g * x).sum::<f64>();
            }
            natural = vec![0.0; body.dofs()];
            magnets.products.add_product(dimension, 1.0, body.mesh().positions(), &mut natural);
        }
        let varies = self.gradient.is_some();
        let field = self.field.clone();
        Ok(MagnetForce { input, dimension, magnets, field, at_origin, gradient, natural, varies })
    }
}

impl From<Vec<f64>> for MagneticField {
    fn from(field: Vec<f64>) -> Self {
        Self::uniform(field)
    }
}

impl<const D: usize> From<[f64; D]> for MagneticField {
    fn from(field: [f64; D]) -> Self {
        Self::uniform(field)
    }
}

/// The force of a magnetic field on the magnets of a body.
pub(crate) struct MagnetForce {
    /// Source of the field.
    input: String,
    dimension: usize,
    magnets: Magnets,
    field: VectorSignal,
    /// Contribution of the gradient at the origin (T).
    at_origin: [f64; 3],
    /// d B_i / d x_j (T/m)
    gradient: [[f64; 3]; 3],
    /// S times the undeformed positions (A m^2); empty in a uniform field.
    natural: Vec<f64>,
    /// Whether the field changes in space.
    varies: bool,
}

impl Force for MagnetForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let d = self.dimension;
        let mut field = [0.0; 3];
        self.field.at(t, &mut field[..d]);
        for (b, at_origin) in field.iter_mut().zip(self.at_origin) {
            finite_at(t, format_args!("{}", self.input), *b)?;
            *b += at_origin;
        }
        let applied = &mut *forces.applied;
        let nodes = applied.chunks_exact_mut(d).zip(&self.magnets.poles).enumerate();
        for (node, (force, pole)) in nodes {
            if self.varies {
                let product = |j: usize| {
                    let dof = node * d + j;
                    self.natural[dof] + self.magnets.products.row_product(d, dof, u)
                };
                for (j, product) in (0..d).map(product).enumerate() {
                    for (i, force) in force.iter_mut().enumerate() {
                        *force += self.gradient[i][j] * product;
                    }
                }
            }
            force.iter_mut().zip(field).for_each(|(force, b)| *force += pole * b);
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        let (d, products) = (self.dimension, &self.magnets.products);
        if self.varies {
            for row in 0..self.magnets.poles.len() {
                for (entry, column) in products.pattern().row(row) {
                    let product = products.values()[entry];
                    let Some(block) = stiffness.block_mut(row, column) else { continue };
                    for (place, value) in block.iter_mut().enumerate() {
                        *value -= product * self.gradient[place / d][place % d];
                    }
                }
            }
        }
        Tangents::Added
    }

    fn is_nonlinear(&self) -> bool {
        self.varies
    }
}
