//! Outputs: quantities of components that sensors and programs read.
//!
//! Each is one row of [`outputs`](super::outputs): its word in scene files, its unit, and the function that reads it. A row stands with
//! the functions by which programs read it.

use std::fmt;

use super::component::Component;
use super::view::View;
use crate::base::input::InputError;
use crate::base::vector::norm;
use crate::elements::body::von_mises;
use crate::scene::timeline::Scene;

/// The value of a quantity at one time; components beyond the dimension are 0.
pub(crate) enum Value {
    Number(f64),
    Vector([f64; 3]),
    Tensor([[f64; 3]; 3]),
}

/// A quantity of components of one kind, which have names.
pub(crate) struct Output {
    /// The kind of its sensor in scene files.
    pub(crate) word: &'static str,
    pub(crate) about: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) of: Kind,
    /// Its value for the component of a number (from 0).
    pub(super) read: Read,
}

/// The function that reads the value for a component.
pub(crate) enum Read {
    Number(fn(&View<'_>, usize) -> Result<f64, InputError>),
    /// A number that follows from the positions of nodes alone.
    OfPositions(fn(&View<'_>, usize) -> Result<f64, InputError>),
    Vector(fn(&View<'_>, usize) -> Result<[f64; 3], InputError>),
}

/// A kind of components that have the quantity.
#[derive(Clone, Copy)]
pub(crate) struct Kind {
    /// The key of its name in a sensor of a scene file.
    pub(crate) key: &'static str,
    pub(crate) about: &'static str,
    /// The number (from 0) of the component with a name; the last argument is where that was given.
    pub(super) find: fn(&Scene, &str, &str) -> Result<usize, InputError>,
}

impl Output {
    /// Whether half of the component that a plane of symmetry cuts has the same value: no force, volume, mass or flow has.
    pub(super) fn is_the_same_in_halves(&self) -> bool {
        ["Pa", "1", "K"].contains(&self.unit)
    }

    pub(super) fn value(&self, view: &View, number: usize) -> Result<Value, InputError> {
        Ok(match self.read {
            Read::Number(read) | Read::OfPositions(read) => Value::Number(read(view, number)?),
            Read::Vector(read) => Value::Vector(read(view, number)?),
        })
    }

    pub(super) fn find(&self, scene: &Scene, name: &str) -> Result<usize, InputError> {
        (self.of.find)(scene, name, self.of.key)
    }

    /// A number of the component with a `name`.
    ///
    /// # Errors
    /// A name that no such component has; a quantity that is undefined.
    pub(super) fn number(&self, view: &View, name: &str) -> Result<f64, InputError> {
        Ok(self.value(view, self.find(view.scene, name)?)?.part(Component::X))
    }
}

impl PartialEq for Output {
    fn eq(&self, other: &Self) -> bool {
        self.word == other.word
    }
}

impl fmt::Debug for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word)
    }
}

impl Value {
    /// A vector with as many components as there are dimensions.
    pub(super) fn of_vector(vector: &[f64]) -> Self {
        Self::Vector(std::array::from_fn(|i| vector.get(i).copied().unwrap_or(0.0)))
    }

    /// A component, which the quantity has.
    pub(super) fn part(&self, component: Component) -> f64 {
        match (self, component) {
            (Self::Number(number), _) => *number,
            (Self::Vector(x), Component::X) => x[0],
            (Self::Vector(x), Component::Y) => x[1],
            (Self::Vector(x), Component::Z) => x[2],
            (Self::Vector(x), _) => norm(x),
            (Self::Tensor(a), Component::XX) => a[0][0],
            (Self::Tensor(a), Component::YY) => a[1][1],
            (Self::Tensor(a), Component::ZZ) => a[2][2],
            (Self::Tensor(a), Component::XY) => a[0][1],
            (Self::Tensor(a), Component::YZ) => a[1][2],
            (Self::Tensor(a), Component::XZ) => a[0][2],
            (Self::Tensor(a), _) => von_mises(a),
        }
    }
}
