//! Readings of a slender solid, translated to the rod that stands for it.

use super::reading::{Reading, ReadingKind};
use super::spot::{At, Spot};
use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::elements::rod::SolidAxis;
use crate::scene::timeline::Scene;

impl Reading {
    /// The reading of the rod along the `axis` of a solid that stands for this one of the `solid`, whose nodes are in one cross section.
    ///
    /// # Errors
    /// Readings that a rod does not have; nodes that are in several cross sections, or in none at a node of the rod.
    pub(crate) fn of_rod(&self, solid: &Scene, axis: &SolidAxis) -> Result<Self, InputError> {
        use ReadingKind::{
            Acceleration, Accelerometer, AngularAcceleration, AngularVelocity, CentreOfMass,
            ConstraintForce, ConstraintMoment, Displacement, Gyroscope, Momentum, Position,
            Rotation, Velocity,
        };
        let input = || "nodes of a sensor".to_owned();
        let section = |nodes: &Selection, is_whole| {
            let sections = solid.sections_of(nodes, axis, is_whole, input)?;
            match sections[..] {
                [section] => Ok(Selection::of_nodes(axis.nodes(section))),
                _ => {
                    let help = "a rod reads those of one cross section: name these alone, or leave it a solid";
                    Err(InputError::new(input(), nodes, help))
                }
            }
        };
        let at = |spot: &Spot| {
            let (nodes, place) = match &spot.0 {
                At::Nodes(nodes) => {
                    let mesh = solid.body().mesh();
                    let all = self.counted(mesh.select(nodes)?);
                    let mean = |i| all.iter().map(|&node| mesh.position(node)[i]).sum::<f64>();
                    let place = (0..mesh.dimension()).map(|i| mean(i) / all.len() as f64);
                    (section(nodes, false)?, place.collect::<Vec<f64>>())
                }
                At::Marker(nodes, place) => (section(nodes, false)?, place.clone()),
                At::Inside(place) => match axis.section_at(place) {
                    Some(section) => (Selection::of_nodes(axis.nodes(section)), place.clone()),
                    None => {
                        let help = "it is in none of the cross sections between the elements of the rod: choose a number of elements with one there";
                        return Err(InputError::new(
                            "place of a sensor",
                            format!("{place:?}"),
                            help,
                        ));
                    }
                },
            };
            match (&nodes, axis.is_on_axis(&place)) {
                (Selection::Numbers(numbers), true) if axis.section_at(&place).is_some() => {
                    Ok(Selection::Numbers(vec![numbers[0]]).into())
                }
                _ => Ok::<_, InputError>(Spot::marker(nodes, place)),
            }
        };
        let on = |nodes: &Option<Selection>| {
            nodes.as_ref().map(|nodes| section(nodes, false)).transpose()
        };
        let what = match &self.what {
            Position(spot) => Position(at(spot)?),
            Displacement(spot) => Displacement(at(spot)?),
            Velocity(spot) => Velocity(at(spot)?),
            Acceleration(spot) => Acceleration(at(spot)?),
            Rotation(nodes) => Rotation(on(nodes)?),
            AngularVelocity(nodes) => AngularVelocity(on(nodes)?),
            AngularAcceleration(nodes) => AngularAcceleration(on(nodes)?),
            Accelerometer(nodes) => Accelerometer(on(nodes)?),
            Gyroscope(nodes) => Gyroscope(on(nodes)?),
            ConstraintForce(nodes) => ConstraintForce(section(nodes, true)?),
            ConstraintMoment(nodes, lever) => {
                ConstraintMoment(section(nodes, true)?, lever.clone())
            }
            what @ (CentreOfMass | Momentum) => what.clone(),
            _ => {
                let help = "a rod in place of a solid has places, velocities, accelerations and rotations of cross sections, constraint forces and \
                            moments, the centre of mass and the momentum: name one of them";
                return Err(InputError::new("quantity", "of another kind", help));
            }
        };
        Ok(Self { what, counts: None, ..self.clone() })
    }
}
