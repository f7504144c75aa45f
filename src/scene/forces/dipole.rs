//! A magnet outside of the bodies, as a dipole that acts on the magnets in them.

use std::fmt;
use std::sync::Arc;

use super::signal::{VectorSignal, finite_at};
use super::signals::Signals;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::{MagnetizedPoints, PointDipole, TooNear};
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::integrators::ode::Failure;

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
    moment: VectorSignal,
    position: VectorSignal,
}

/// Properties of a dipole that phases and commands change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum DipolePart {
    /// Its position (m).
    Position,
    /// Its moment (A m^2).
    Moment,
}

impl DipolePart {
    pub(crate) const ALL: [Self; 2] = [Self::Position, Self::Moment];

    /// Its word in files and messages.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Moment => "moment",
        }
    }

    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Position => "m",
            Self::Moment => "A m^2",
        }
    }
}

impl fmt::Display for DipolePart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl Dipole {
    /// A dipole of a `moment` (A m^2) at a `position` (m), one component per dimension, both of them constant or changing with time: vectors
    /// or other [`Signals`].
    pub fn new(moment: impl Into<Signals>, position: impl Into<Signals>) -> Self {
        Self { name: String::new(), moment: moment.into().0, position: position.into().0 }
    }

    /// Name of the dipole (default: "dipole 1", "dipole 2", ... in the order of the scene).
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Name of the dipole.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// Its moment or its position.
    pub(crate) fn part(&self, part: DipolePart) -> &VectorSignal {
        match part {
            DipolePart::Position => &self.position,
            DipolePart::Moment => &self.moment,
        }
    }

    /// The same with another moment or position.
    pub(crate) fn with(mut self, part: DipolePart, value: VectorSignal) -> Self {
        match part {
            DipolePart::Position => self.position = value,
            DipolePart::Moment => self.moment = value,
        }
        self
    }

    /// It as it is at time `t` (s).
    fn at(&self, t: f64, dimension: usize) -> PointDipole {
        point_dipole([&self.position, &self.moment], t, dimension)
    }

    /// Its force on `magnets` of a body in `dimension` dimensions.
    ///
    /// # Errors
    /// A moment or a position of another dimension, numbers out of range.
    pub(crate) fn force(
        &self,
        dimension: usize,
        magnets: Arc<[Box<dyn MagnetizedPoints>]>,
    ) -> Result<DipoleForce, InputError> {
        for part in DipolePart::ALL {
            let input = format!("{part} of dipole \"{}\"", self.name);
            self.part(part).validate(&input, dimension, part.unit())?;
        }
        Ok(DipoleForce { dipole: self.clone(), dimension, magnets })
    }
}

/// A dipole of this position and moment at time `t` (s).
pub(crate) fn point_dipole(
    [position, moment]: [&VectorSignal; 2],
    t: f64,
    dimension: usize,
) -> PointDipole {
    let mut now = PointDipole { moment: [0.0; 3], position: [0.0; 3] };
    moment.at(t, &mut now.moment[..dimension]);
    position.at(t, &mut now.position[..dimension]);
    now
}

/// The force of a dipole on the magnets of a body.
pub(crate) struct DipoleForce {
    dipole: Dipole,
    dimension: usize,
    magnets: Arc<[Box<dyn MagnetizedPoints>]>,
}

impl DipoleForce {
    /// Checks that it is far enough from the magnets at time `t` (s), under the displacements `u` (m).
    ///
    /// # Errors
    /// A dipole nearer than the cells of a magnet resolve; numbers that are not finite.
    pub(crate) fn check(&self, t: f64, u: &[f64]) -> Result<(), InputError> {
        let now = self.dipole.at(t, self.dimension);
        let mut forces = vec![0.0; u.len()];
        let mut all = self.magnets.iter();
        let is_finite = now.moment.iter().chain(&now.position).all(|x| x.is_finite());
        if now.is_off() || !is_finite {
            return Ok(()); // what is not finite is told where forces are evaluated
        }
        all.try_for_each(|magnet| magnet.add_forces(&now, u, &mut forces)).map_err(|near| {
            let input = format!("position of dipole \"{}\"", self.dipole.name);
            let position = &now.position[..self.dimension];
            InputError::new(input, format!("{position:?} m at t = {t} s"), near.to_string())
        })
    }

    /// The energy (J) of the magnets.
    #[cfg(test)]
    pub(crate) fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let now = self.dipole.at(t, self.dimension);
        self.magnets.iter().map(|magnet| magnet.energy(&now, u)).sum()
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
        let (now, name) = (self.dipole.at(t, self.dimension), &self.dipole.name);
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
        let now = self.dipole.at(t, self.dimension);
        if !now.is_off() {
            self.magnets.iter().for_each(|magnet| magnet.add_tangents(&now, u, stiffness));
        }
        Tangents::Added
    }
}
