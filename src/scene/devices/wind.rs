//! Wind over faces: the drag of air that flows everywhere alike.

use std::sync::Arc;

use crate::base::input::InputError;
use crate::elements::force::Force;
use crate::elements::mesh::Selection;
use crate::scene::forces::{Fluid, VectorSignal};
use crate::scene::timeline::{
    Device, DeviceGauge, DeviceInput, DeviceOutput, DeviceSignals, DeviceSite, DeviceState,
};

/// Density (kg/m^3) of air at 20 degrees.
const AIR: f64 = 1.2;

/// Wind: air that drags faces along with its velocity relative to theirs, as a [`Fluid`] does, and whose velocity
/// phases and commands set.
///
/// ```
/// use pliant::{
///     Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings, Wind, simulate::Reading,
/// };
///
/// // a plate that is held feels the drag of a plate, 1.2 times the stagnation pressure on its area
/// let mesh = Mesh::rectangle([0.01, 0.1], [2, 11], Cells::Rectangles)?;
/// let rubber = Material { density: 1000.0, young: 1e7, poisson: 0.3, viscosity: 1e3 };
/// let plate = Body::new(mesh, rubber).thickness(0.1).build()?;
/// let scene = Scene::new(plate)
///     .device(Wind::new("gust").drag(0.6, 0.0))
///     .phase(Phase::until(0.1).hold("all").device_input("gust", &Wind::VELOCITY, [10.0, 0.0]));
/// let sampling = Sampling::phase_ends().read("force", Reading::device("gust", &Wind::FORCE));
/// let motion = scene.simulate(&Settings::default(), &sampling)?;
/// let expected = 1.2 * 0.5 * 1.2 * 10.0 * 10.0 * 0.1 * 0.1; // N
/// assert!((motion.last().sensors[0] - expected).abs() < 1e-12);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Wind {
    name: String,
    density: f64,
    drag: [f64; 2],
    nodes: Option<Selection>,
}

impl Wind {
    /// The velocity (m/s) of the air, one component per dimension.
    pub const VELOCITY: DeviceInput = DeviceInput::vector("velocity", "m/s");
    /// The force (N) on the faces.
    pub const FORCE: DeviceOutput = DeviceOutput { word: "force", unit: "N", is_vector: true };

    /// Wind with a name, of air (1.2 kg/m^3), on all faces of the boundary.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), density: AIR, drag: [0.0; 2], nodes: None }
    }

    /// Density (kg/m^3) of what flows.
    pub fn density(self, density: f64) -> Self {
        Self { density, ..self }
    }

    /// Coefficients of drag along the normal of a face and along the face (1), as of [`Fluid::drag`].
    pub fn drag(self, normal: f64, tangential: f64) -> Self {
        Self { drag: [normal, tangential], ..self }
    }

    /// The nodes of the faces that it blows on, as of [`Fluid::on`] (default: all).
    pub fn on(self, nodes: impl Into<Selection>) -> Self {
        Self { nodes: Some(nodes.into()), ..self }
    }

    fn fluid(&self) -> Fluid {
        let fluid = Fluid::new(self.density).named(&self.name).drag(self.drag[0], self.drag[1]);
        self.nodes.iter().fold(fluid, |fluid, nodes| fluid.on(nodes.clone()))
    }
}

impl Device for Wind {
    fn name(&self) -> &str {
        &self.name
    }

    fn inputs(&self) -> &'static [DeviceInput] {
        &[Self::VELOCITY]
    }

    fn outputs(&self) -> &'static [DeviceOutput] {
        &[Self::FORCE]
    }

    fn force(
        &self,
        site: &DeviceSite<'_>,
        inputs: DeviceSignals,
    ) -> Result<Arc<dyn Force>, InputError> {
        let dimension = site.body.dimension();
        let write = Arc::new(move |t, velocity: &mut [f64]| {
            velocity.copy_from_slice(&inputs.at(0, t)[..dimension]);
        });
        let fluid = self.fluid().flowing(VectorSignal::Function { dimension, write });
        Ok(Arc::new(fluid.force(site.body, None)?))
    }

    fn gauge(&self, _number: usize, site: &DeviceSite<'_>) -> Result<DeviceGauge, InputError> {
        let force = self.fluid().force(site.body, None)?;
        Ok(Box::new(move |now| force.in_current(now.input(0), now.u, now.v, None)))
    }

    fn on_finer_mesh(
        &self,
        nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        let nodes = self.nodes.as_ref().map(nodes).transpose()?;
        Ok(Arc::new(Self { nodes, ..self.clone() }))
    }

    fn in_half(
        &self,
        nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        self.on_finer_mesh(nodes)
    }

    /// A line from the middle of the body along the velocity: as long as the body in a wind of 10 m/s.
    fn lines(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        const USUAL: f64 = 10.0;
        let (velocity, mut ends) = (now.input(0), [[0.0; 3]; 2]);
        let reach = now.body.mesh().size() / USUAL;
        for (axis, middle) in now.body.centre_of_mass(now.u).into_iter().enumerate() {
            ends[0][axis] = middle - reach * velocity[axis];
            ends[1][axis] = middle;
        }
        vec![ends]
    }
}
