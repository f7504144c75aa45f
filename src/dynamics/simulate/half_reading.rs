//! Readings of a symmetric scene, translated to its half.

use super::component::Component;
use super::reading::{Reading, ReadingKind};
use super::spot::{At, Spot};
use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::scene::timeline::{Half, Scene};

impl Reading {
    /// The reading that has the same value in the `half` of a symmetric scene, `whole`, as this one has there.
    ///
    /// # Errors
    /// Readings that the half does not have, or of which that is not known.
    pub(crate) fn in_half(&self, whole: &Scene, half: &Half) -> Result<Self, InputError> {
        let components = [Component::X, Component::Y, Component::Z];
        let is_along = self.component.is_some_and(|component| {
            components.contains(&component) && component != components[half.axis.index()]
        });
        let refused = |value: &str, help: String| InputError::new("quantity", value, help);
        let only_along = |value: &str| {
            let across = half.axis.word();
            let help = format!(
                "the half has it along the plane alone: choose a component other than {across}"
            );
            refused(value, help)
        };
        let means = |nodes: &Selection| {
            if self.counts.is_some() {
                let help = "the half of a section has no means of it in which some nodes count more than others: name nodes at one end";
                return Err(refused("of a side in space", help.into()));
            }
            let own = whole.body().mesh().select(nodes)?;
            match half.standing_for(&own) {
                Some((nodes, is_all)) if is_all || is_along => Ok(nodes),
                Some(_) => Err(only_along("of nodes on both sides")),
                None => {
                    let help = "the half has no such mean: name nodes on one side";
                    Err(refused("of nodes on both sides", help.into()))
                }
            }
        };
        let what = match &self.what {
            ReadingKind::Position(Spot(At::Nodes(nodes))) => {
                ReadingKind::Position(means(nodes)?.into())
            }
            ReadingKind::Displacement(Spot(At::Nodes(nodes))) => {
                ReadingKind::Displacement(means(nodes)?.into())
            }
            ReadingKind::Velocity(Spot(At::Nodes(nodes))) => {
                ReadingKind::Velocity(means(nodes)?.into())
            }
            ReadingKind::CentreOfMass if is_along => ReadingKind::CentreOfMass,
            ReadingKind::CentreOfMass => return Err(only_along("centre of mass")),
            _ => {
                let help = "the half has positions, displacements, velocities and centres of mass: name one of them";
                return Err(refused("of another kind", help.into()));
            }
        };
        Ok(Self { what, ..self.clone() })
    }
}
