//! Springs, cables, muscles, growths, chambers and orifices of a scene in its half: each is its own mirror image or that of another one.
//!
//! Of two images one is left. A line in the plane of symmetry has half of its forces. Cells keep those on this side, and a
//! chamber is closed by the plane, in which the force of that wall is held; what flows into its gas does so through half of an
//! orifice (`orifices.rs`).

use std::iter;

use super::super::{Input, Phase, Quantity, Scene, Target};
use super::same::{SAME, Same, times};
use crate::base::input::InputError;
use crate::elements::body::CellSelection;
use crate::elements::mesh::Selection;
use crate::scene::forces::{ComponentMap, Drive, Placed};

/// A component of a scene, and what its half has of it.
pub(super) struct Component<'a> {
    pub(super) name: &'a str,
    pub(super) quantity: Quantity,
    /// Whether its signals are forces, of which the half has a share.
    pub(super) is_force: bool,
    /// Its mirror image: itself or another one.
    pub(super) image: &'a str,
    /// Share of it that the half has: half of a line or an orifice in the plane; none of what is on the other side.
    pub(super) share: Option<f64>,
}

impl<'s> Same<'s> {
    /// The components of the scene in its half.
    ///
    /// # Errors
    /// Those without a mirror image, or that phases drive otherwise; lines that cross the plane.
    pub(super) fn components(&self) -> Result<Vec<Component<'s>>, InputError> {
        let (scene, body) = (self.scene, &self.scene.body);
        let whole = |name, quantity, is_force, placed: Result<Placed, InputError>| {
            let (image, share) = (name, Some(1.0));
            placed.map(|placed| (Component { name, quantity, is_force, image, share }, placed))
        };
        let actuators = scene.actuators.iter().map(|own| {
            let is_force = own.kind().drive == Drive::Force;
            whole(own.name(), Quantity::Actuation, is_force, own.placed(body, self.map))
        });
        let chambers = scene.chambers.iter().map(|own| {
            whole(own.name(), Quantity::Pressure, false, own.placed(body.mesh(), self.map))
        });
        let placed = actuators.chain(chambers).collect::<Result<Vec<_>, _>>()?;
        let images = placed.iter().map(|own| self.image(own, &placed));
        let images = images.collect::<Result<Vec<_>, _>>()?;
        let placed = placed.into_iter().zip(images);
        let mut all: Vec<Component> =
            placed.map(|((own, _), (image, share))| Component { image, share, ..own }).collect();
        all.extend(self.orifices(&all)?);
        self.check_driven(&all)?;
        Ok(all)
    }

    /// The mirror image of a component among `all`, and the share of it that the half has.
    fn image(
        &self,
        own: &(Component<'s>, Placed),
        all: &[(Component<'s>, Placed)],
    ) -> Result<(&'s str, Option<f64>), InputError> {
        let (at, tolerance) = (self.map.ends[0], SAME * self.scene.body.size());
        let (d, kept) = (self.map.mesh.dimension(), self.map.mesh.positions());
        let is_upper = kept.iter().skip(self.map.axis).step_by(d).any(|x| *x > at + tolerance);
        let lag_and_gas = |name: &str| (self.scene.lag_of(name), self.scene.gas_of(name));
        // of several in one place each is its own
        let mut candidates = iter::once(own).chain(all);
        let (own, placed) = own;
        let is_image = |(other, at): &&(Component, Placed)| {
            let numbers = placed.at[1].iter().zip(&at.at[0]);
            placed.likeness == at.likeness
                && format!("{:?}", lag_and_gas(own.name))
                    == format!("{:?}", lag_and_gas(other.name))
                && placed.at[1].len() == at.at[0].len()
                && numbers.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)
        };
        let name = format!("\"{}\"", own.name);
        let image = candidates.find(is_image);
        let image = image.ok_or_else(|| self.refused("component", &name))?.0.name;
        let beside = placed.along.iter().filter(|x| (*x - at).abs() > tolerance);
        let sides: Vec<bool> = beside.map(|x| (*x > at) == is_upper).collect();
        let share = match (image == own.name, placed.is_line) {
            (true, false) => Some(1.0),
            (true, true) if sides.is_empty() && self.scene.lag_of(own.name).is_none() => Some(0.5),
            (false, _) if sides.iter().all(|side| *side) => Some(1.0),
            (false, _) if !sides.contains(&true) => None,
            _ => {
                let help = "it crosses the plane of symmetry, or lags in it: leave the scene whole";
                return Err(InputError::new("component", name, help));
            }
        };
        Ok((image, share))
    }

    /// Checks that phases drive components as their images.
    fn check_driven(&self, components: &[Component]) -> Result<(), InputError> {
        let mut start = 0.0;
        for phase in &self.scene.phases {
            for Component { name, quantity, image, .. } in components {
                let at = |name: &str, t: f64| -> f64 {
                    phase.signals_of(*quantity, name).map(|signal| signal.at(t)).sum()
                };
                if times(phase, start).iter().any(|&t| at(name, t) != at(image, t)) {
                    let input = quantity.of(&Target::one(*name));
                    let input = format!("{input} in phase \"{}\"", phase.name);
                    return Err(self.refused(input, format!("not that of \"{image}\"")));
                }
            }
            start = phase.until;
        }
        Ok(())
    }

    /// The inputs of the components that the half has.
    pub(super) fn driven(&self, phase: &Phase, components: &[Component]) -> Vec<Input> {
        let mut inputs = Vec::new();
        for Component { name, quantity, is_force, share, .. } in components {
            let Some(share) = share else { continue };
            let share = if *is_force { *share } else { 1.0 };
            for signal in phase.signals_of(*quantity, name) {
                let signal = match share == 1.0 {
                    true => signal.clone(),
                    false => signal.clone().times(share),
                };
                inputs.push(Input::new(*quantity, Target::one(*name), signal));
            }
        }
        inputs
    }

    /// Leaves the components of the half in its `scene`.
    pub(super) fn keep(
        &self,
        components: &[Component],
        scene: &mut Scene,
    ) -> Result<(), InputError> {
        let (whole, map, mesh) = (self.scene, self.map, self.scene.body.mesh());
        let (actuators, others) = components.split_at(whole.actuators.len());
        let (chambers, orifices) = others.split_at(whole.chambers.len());
        let nodes = |selection: &Selection| match selection {
            Selection::Numbers(_) => {
                let nodes = mesh.select(selection)?.into_iter();
                Ok(Selection::of_nodes(nodes.filter_map(|node| map.numbers[node])))
            }
            selection => Ok(selection.clone()),
        };
        let cells = |selection: &CellSelection| {
            let cells = selection.cells(mesh)?.into_iter();
            let own = cells.filter_map(|cell| Some(map.cells[cell]? + 1));
            Ok(CellSelection::Numbers(own.collect()))
        };
        scene.lags.retain(|(name, _)| {
            actuators.iter().any(|own| own.name == name && own.share.is_some())
        });
        let actuators = whole.actuators.iter().zip(actuators).filter_map(|(whole, own)| {
            let share = own.share?;
            Some(whole.mapped(&ComponentMap { nodes: &nodes, cells: &cells, share }))
        });
        scene.actuators = actuators.collect::<Result<_, _>>()?;
        let kept = whole.chambers.iter().zip(chambers).filter(|(_, own)| own.share.is_some());
        let chambers = kept.map(|(whole, own)| match own.name == own.image {
            true => whole.clone().with_nodes(nodes)?.closed_by_plane(mesh.dimension()),
            false => whole.clone().with_nodes(nodes),
        });
        scene.chambers = chambers.collect::<Result<_, InputError>>()?;
        scene.gases.retain(|gas| scene.chambers.iter().any(|own| own.name() == gas.chamber));
        let orifices = whole.orifices.iter().zip(orifices);
        let kept = orifices.filter_map(|(whole, own)| Some(whole.clone().times(own.share?)));
        scene.orifices = kept.collect();
        Ok(())
    }
}
