//! Readings of a scene that is uniform along an axis, translated to its section.

use super::component::Component;
use super::reading::{ContactSource, OfContact, Reading, ReadingKind};
use super::spot::{At, Spot};
use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{InPlane, Scene};

impl Reading {
    /// The reading that has the same value in the section, `plane`, of a scene in `space` as this one has there; of all components those in
    /// the plane, along its axes.
    ///
    /// # Errors
    /// Readings that the section does not have, or of which that is not known.
    pub(crate) fn in_plane(&self, space: &Scene, plane: &InPlane) -> Result<Self, InputError> {
        let refused = |value: &str, help: String| Err(InputError::new("quantity", value, help));
        let axes = plane.prism.axes();
        let component = match self.component {
            None => None,
            Some(own) => {
                let place = |i: &usize| Axis::all(3)[*i].word() == own.word();
                let Some(k) = axes.iter().position(place) else {
                    let help = format!(
                        "the plane has components {} and {} alone: choose one of them",
                        Axis::all(3)[axes[0]].word(),
                        Axis::all(3)[axes[1]].word()
                    );
                    return refused(&format!("component \"{}\"", own.word()), help);
                };
                Some([Component::X, Component::Y][k])
            }
        };
        let select = |nodes: &Selection| space.body().mesh().select(nodes);
        // there may be more nodes in one place of the section than in another
        let mut counts = None;
        let mut means = |nodes: &Selection| -> Result<Selection, InputError> {
            let (own, of_each) = plane.standing_for(&select(nodes)?);
            let is_even = of_each.iter().all(|count| *count == of_each[0]);
            counts = (!is_even).then(|| of_each.into());
            Ok(Selection::of_nodes(own))
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
            ReadingKind::ConstraintForce(nodes) => match plane.prism.whole_columns(&select(nodes)?)
            {
                Some(own) => ReadingKind::ConstraintForce(Selection::of_nodes(own)),
                None => {
                    let help = "the section has that of all nodes of a line along the axis together: name all of them";
                    return refused(&format!("constraint force on {nodes}"), help.into());
                }
            },
            what @ (ReadingKind::CentreOfMass
            | ReadingKind::Momentum
            | ReadingKind::Contact(OfContact::Force, ContactSource::Obstacle(_), None)) => {
                what.clone()
            }
            _ => {
                let help = "the section has positions, displacements, velocities, centres of mass, momenta, constraint forces and forces of \
                            obstacles: name one of them";
                return refused("of another kind", help.into());
            }
        };
        Ok(Self { what, component, counts, ..self.clone() })
    }
}
