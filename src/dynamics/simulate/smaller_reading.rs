//! Readings of a scene, translated to a smaller one that stands for it.

use super::component::Component;
use super::reading::{ContactSource, OfContact, Reading, ReadingKind};
use super::spot::{At, Spot};
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::elements::mesh::{NodeMap, Selection};
use crate::scene::constraint::Axis;
use crate::scene::timeline::Scene;

impl Reading {
    /// The reading that has the same value in the smaller scene by a `map` as this one has in the `whole`; of all components those that the
    /// smaller scene has.
    ///
    /// # Errors
    /// Readings that the smaller scene does not have, or of which that is not known.
    pub(crate) fn by_map(&self, whole: &Scene, map: &NodeMap) -> Result<Self, InputError> {
        use ReadingKind::{
            CentreOfMass, ConstraintForce, Contact, Displacement, Momentum, Position, Velocity,
        };
        let refused = |value: &str, help: String| InputError::new("quantity", value, help);
        let axes: Vec<Axis> =
            map.axes().iter().filter(|i| **i != map.axis).map(|&i| Axis::all(3)[i]).collect();
        let place =
            self.component.map(|own| axes.iter().position(|axis| axis.word() == own.word()));
        let words: Vec<&str> = axes.iter().map(|axis| axis.word()).collect();
        let only_along = || {
            let value = self.component.map_or("all components", Component::word);
            let help = format!(
                "it is known along {} alone: choose a component there, or name nodes on one side",
                words.join(" and ")
            );
            refused(&format!("component \"{value}\""), help)
        };
        let is_along = place.is_none_or(|place| place.is_some());
        if map.is_section() && !is_along {
            return Err(only_along());
        }
        let component = match place.flatten().filter(|_| map.is_section()) {
            Some(place) => Some([Component::X, Component::Y][place]),
            None => self.component,
        };
        // a mean may have more nodes in one place than in another
        let mut counts = None;
        let mut means = |nodes: &Selection| -> Result<Spot, InputError> {
            let all = self.counted(whole.body().mesh().select(nodes)?);
            let has_far = all.iter().any(|&node| map.numbers[node].is_none());
            if has_far && !(is_along && self.component.is_some()) {
                return Err(only_along());
            }
            let mut own: Vec<usize> = all.iter().map(|&node| map.number(node)).collect();
            own.sort_unstable();
            let of_each: Box<[usize]> = own.chunk_by(|a, b| a == b).map(<[usize]>::len).collect();
            let is_even = of_each.iter().all(|count| *count == of_each[0]);
            counts = (!is_even).then_some(of_each);
            Ok(Selection::of_nodes(distinct(own)).into())
        };
        let what = match &self.what {
            Position(Spot(At::Nodes(nodes))) => Position(means(nodes)?),
            Displacement(Spot(At::Nodes(nodes))) => Displacement(means(nodes)?),
            Velocity(Spot(At::Nodes(nodes))) => Velocity(means(nodes)?),
            CentreOfMass if map.is_section() => CentreOfMass,
            CentreOfMass if is_along && self.component.is_some() => CentreOfMass,
            CentreOfMass => return Err(only_along()),
            ConstraintForce(nodes) if map.is_section() => {
                let own = map.whole(&whole.body().mesh().select(nodes)?).ok_or_else(|| {
                    let help = "the section has that of all nodes of a line along the axis together: name all of them";
                    refused(&format!("constraint force on {nodes}"), help.into())
                })?;
                ConstraintForce(Selection::of_nodes(own))
            }
            what @ (Momentum | Contact(OfContact::Force, ContactSource::Obstacle(_), None))
                if map.is_section() =>
            {
                what.clone()
            }
            what @ ReadingKind::Of(output, _) if output.is_the_same_in_halves() => what.clone(),
            _ => {
                let more = [
                    ", pressures, stresses and stretches of components",
                    ", momenta, constraint forces and forces of obstacles",
                ];
                let help = format!(
                    "the smaller scene has positions, displacements, velocities, centres of mass{}: name one of them",
                    more[usize::from(map.is_section())]
                );
                return Err(refused("of another kind", help));
            }
        };
        Ok(Self { what, component, counts, ..self.clone() })
    }
}
