//! A magnet outside of the bodies, as a dipole that acts on the magnets in them.

use std::fmt;
use std::sync::Arc;

use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{MagnetizedPoints, PointDipole, TooNear};
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::elements::mesh::Selection;
use crate::integrators::ode::Failure;
use crate::scene::forces::{Signals, finite_at};
use crate::scene::timeline::{
    Device, DeviceGauge, DeviceInput, DeviceOutput, DeviceSignals, DeviceSite, DeviceState,
    DeviceValue, Input, InputLimit, Phase, Quantity, Scene, Target,
};

/// An external magnet, or a small coil, with prescribed motion: a point dipole of the moment m (A m^2) at the position p (m). It acts on the
/// [magnets](crate::Magnet) of a scene by its field
///
/// ```text
/// B(x) = mu_0/(4 pi) (3 (m . r) r/|r|^5 - m/|r|^3),   r = x - p
/// ```
///
/// at the deformed position x of each strain point of their cells, which have the energy -(F b) . B(x) / mu_0 per natural volume. So it turns, bends
/// and pulls them. Its work counts as supplied, as that of other magnetic fields does. Their action on its motion is neglected, as that
/// is prescribed; the force on it is minus [that on them](crate::View::dipole_force).
///
/// A body in the plane lies in the plane z = 0 of space, and m and p lie in it, too, so that the field does: it is that of a dipole in space, not of a line of
/// them. The thickness of the body should be small beside the distance.
///
/// A magnet of the remanence b and the volume V has the moment b V/mu_0. A ball is a dipole; a block of the width a that is magnetized along its length 2 a
/// pulls along its axis by 2.5 (a/r)^2 more than one, which is 2.5 % at r = 10 a.
///
/// ```
/// use pliant::{Body, Cells, Dipole, Magnet, Material, Mesh, Phase, Plane, Scene, Statics};
///
/// // a strip that is magnetized along itself bends towards a magnet above its tip
/// let mesh = Mesh::rectangle([0.02, 0.001], [41, 3], Cells::Rectangles9)?;
/// let material = Material { density: 2000.0, young: 1e6, poisson: 0.45, viscosity: 1e3 };
/// let body = Body::new(mesh, material).thickness(0.005).plane(Plane::Stress).build()?;
/// let scene = Scene::new(body)
///     .magnet(Magnet::new([0.1, 0.0]))
///     .dipole(Dipole::new([0.0, 1.0], [0.02, 0.04]))
///     .phase(Phase::until(1.0).hold("left"));
/// let bent = scene.equilibrium(&Statics::default())?;
/// let tip = 2 * (41 * 3 - 1);
/// assert!(bent.trajectory().last().u[tip + 1] > 0.001);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Dipole {
    name: String,
    moment: DeviceValue,
    position: DeviceValue,
}

/// Largest moment (A m^2): that of a cube of neodymium of 20 cm.
const STRONGEST: f64 = 1e4;

impl Dipole {
    /// Its position (m), one component per dimension.
    pub const POSITION: DeviceInput = DeviceInput {
        keys: ["drive", KIND],
        is_scaled: false,
        ..DeviceInput::vector("position", "m")
    };
    /// Its moment (A m^2), likewise; 0 switches it off.
    pub const MOMENT: DeviceInput = DeviceInput {
        keys: ["drive", KIND],
        limit: Some(InputLimit {
            name: "dipole-moment",
            about: "the moment of a dipole",
            most: STRONGEST,
            help: "is it in emu (0.001 A m^2) or A mm^2 (1e-6 A m^2)? A cube of neodymium of 1 cm has 1 A m^2",
        }),
        ..DeviceInput::vector("moment", "A m^2")
    };
    /// The force (N) on all magnets; that on the dipole is minus this.
    pub const FORCE: DeviceOutput = DeviceOutput { word: "force", unit: "N", is_vector: true };

    /// A dipole of a `moment` (A m^2) at a `position` (m), one component per dimension, both of them constant or changing with time: vectors
    /// or other [`Signals`].
    pub fn new(moment: impl Into<Signals>, position: impl Into<Signals>) -> Self {
        Self { name: String::new(), moment: moment.into().into(), position: position.into().into() }
    }

    /// Name of the dipole (default: "dipole 1", "dipole 2", ... in the order of the scene).
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }
}

const KIND: &str = "dipole";
/// Numbers of the inputs; those of the outputs of the same words are one more.
const POSITION: usize = 0;
const MOMENT: usize = 1;

impl Scene {
    /// Adds a dipole, which acts on the [magnets](Self::magnet) in all phases.
    pub fn dipole(self, dipole: Dipole) -> Self {
        let name = match dipole.name.is_empty() {
            true => self.next_device(KIND, KIND),
            false => dipole.name.clone(),
        };
        self.device(dipole.named(name))
    }
}

impl Phase {
    /// Where a dipole of the scene is in this phase (m), in place of its [position](Dipole::new) in the scene.
    pub fn dipole_position(self, dipole: impl Into<String>, position: impl Into<Signals>) -> Self {
        self.with_dipole(dipole.into(), &Dipole::POSITION, position.into())
    }

    /// The moment (A m^2) of a dipole of the scene in this phase, in place of [that](Dipole::new) in the scene; 0 switches it off.
    pub fn dipole_moment(self, dipole: impl Into<String>, moment: impl Into<Signals>) -> Self {
        self.with_dipole(dipole.into(), &Dipole::MOMENT, moment.into())
    }

    fn with_dipole(mut self, dipole: String, input: &'static DeviceInput, value: Signals) -> Self {
        self.set(Input::new(Quantity::Device(input), Target::one(dipole), value.0));
        self
    }
}

impl Device for Dipole {
    fn name(&self) -> &str {
        &self.name
    }

    fn kind(&self) -> &'static str {
        KIND
    }

    fn inputs(&self) -> &'static [DeviceInput] {
        &[Self::POSITION, Self::MOMENT]
    }

    fn preset(&self, number: usize) -> Option<&DeviceValue> {
        Some(if number == POSITION { &self.position } else { &self.moment })
    }

    fn outputs(&self) -> &'static [DeviceOutput] {
        &[
            Self::FORCE,
            DeviceOutput { word: "position", unit: "m", is_vector: true },
            DeviceOutput { word: "moment", unit: "A m^2", is_vector: true },
        ]
    }

    fn force(
        &self,
        site: &DeviceSite<'_>,
        inputs: DeviceSignals,
    ) -> Result<Arc<dyn Force>, InputError> {
        let magnets = site.magnetized_points()?;
        if magnets.is_empty() {
            let help = "the scene has no magnet on which it acts: add one";
            return Err(InputError::new(KIND, format!("\"{}\"", self.name), help));
        }
        Ok(Arc::new(DipoleForce { name: self.name.clone(), inputs, magnets }))
    }

    /// Whether it is far enough from the magnets for the cells of these.
    fn check_start(&self, site: &DeviceSite<'_>, now: &DeviceState<'_>) -> Result<(), InputError> {
        let own = point_dipole(now);
        let is_finite = own.moment.iter().chain(&own.position).all(|x| x.is_finite());
        if own.is_off() || !is_finite {
            return Ok(()); // numbers that are not finite are refused where forces are evaluated
        }
        let mut forces = vec![0.0; now.u.len()];
        let magnets = site.magnetized_points()?;
        let mut all = magnets.iter();
        all.try_for_each(|magnet| magnet.add_forces(&own, now.u, &mut forces)).map_err(|near| {
            let input = format!("position of dipole \"{}\"", self.name);
            let position = &own.position[..site.body.dimension()];
            let t = now.time;
            InputError::new(input, format!("{position:?} m at t = {t} s"), near.to_string())
        })
    }

    fn gauge(&self, number: usize, site: &DeviceSite<'_>) -> Result<DeviceGauge, InputError> {
        let Some(input) = number.checked_sub(1) else {
            let magnets = site.magnetized_points()?;
            return Ok(Box::new(move |now| {
                let (own, mut force) = (point_dipole(now), [0.0; 3]);
                magnets.iter().for_each(|magnet| magnet.add_force(&own, now.u, &mut force));
                force
            }));
        };
        Ok(Box::new(move |now| now.input(input)))
    }

    fn on_finer_mesh(
        &self,
        _nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        Ok(Arc::new(self.clone()))
    }

    /// A needle along the moment.
    fn needles(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        vec![[now.input(POSITION), now.input(MOMENT)]]
    }
}

/// The dipole as it is now.
fn point_dipole(now: &DeviceState<'_>) -> PointDipole {
    PointDipole { position: now.input(POSITION), moment: now.input(MOMENT) }
}

/// The force of a dipole on the magnets of a body.
struct DipoleForce {
    name: String,
    inputs: DeviceSignals,
    magnets: Arc<[Box<dyn MagnetizedPoints>]>,
}

impl DipoleForce {
    fn at(&self, t: f64) -> PointDipole {
        let [position, moment] = [POSITION, MOMENT].map(|input| self.inputs.at(input, t));
        PointDipole { position, moment }
    }
}

impl fmt::Display for TooNear {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([distance, least], cell) = (self.distances, self.cell + 1);
        write!(
            f,
            "it is {distance:.2e} m from a point of cell {cell} of a magnet, whose field is resolved from {least:.2e} m on: move it away, or take \
             smaller cells there"
        )
    }
}

impl Force for DipoleForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let (now, name) = (self.at(t), &self.name);
        for (part, vector) in [("moment", now.moment), ("position", now.position)] {
            for x in vector {
                finite_at(t, format_args!("the {part} of dipole \"{name}\""), x)?;
            }
        }
        if now.is_off() {
            return Ok(());
        }
        let applied = &mut forces.applied;
        let mut all = self.magnets.iter();
        all.try_for_each(|magnet| magnet.add_forces(&now, u, applied))
            .map_err(|near| Failure::Recoverable(format!("dipole \"{name}\" at t = {t} s: {near}")))
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        let now = self.at(t);
        if !now.is_off() {
            self.magnets.iter().for_each(|magnet| magnet.add_tangents(&now, u, stiffness));
        }
        Tangents::Added
    }
}
