//! Orifices and valves of a scene in its half.
//!
//! A chamber that the plane cuts has half of its gas there, which half of the flow fills as fast. Between a chamber and its own
//! mirror image nothing flows.

use super::super::Quantity;
use super::components::Component;
use super::same::Same;
use crate::base::input::InputError;
use crate::scene::forces::Orifice;

impl<'s> Same<'s> {
    /// The orifices in the half; `placed` are the other components.
    ///
    /// # Errors
    /// One without a mirror image; one from a chamber on this side of the plane to a chamber on the other.
    pub(super) fn orifices(
        &self,
        placed: &[Component<'s>],
    ) -> Result<Vec<Component<'s>>, InputError> {
        let all = &self.scene.orifices;
        let own = |orifice: &'s Orifice| {
            let chambers = orifice.ends.each_ref().map(|end| {
                placed.iter().find(|own| own.quantity == Quantity::Pressure && own.name == *end)
            });
            let mut ends =
                [0, 1].map(|side| chambers[side].map_or(&*orifice.ends[side], |own| own.image));
            // the law of an orifice is the same in both directions
            ends.sort_unstable();
            let is_image = |other: &&Orifice| {
                let mut others = other.ends.each_ref().map(|end| &**end);
                others.sort_unstable();
                others == ends && other.is_like(orifice)
            };
            let same = all.iter().filter(|other| other.name == orifice.name);
            let name = format!("\"{}\"", orifice.name);
            let image = same.chain(all).find(is_image);
            let image = image.ok_or_else(|| self.refused("orifice", &name))?.name();
            let ends = chambers.iter().flatten();
            let share = if image == orifice.name {
                let is_between_images = ends.clone().any(|end| end.image != end.name);
                (!is_between_images).then_some(0.5)
            } else {
                let mut beside = ends.filter(|end| end.image != end.name);
                let is_kept = beside.clone().any(|end| end.share.is_some());
                if beside.any(|end| end.share.is_some() != is_kept) {
                    let help = "it leads across the plane of symmetry: leave the scene whole";
                    return Err(InputError::new("orifice", name, help));
                }
                is_kept.then_some(1.0)
            };
            let (name, quantity) = (orifice.name(), Quantity::Opening);
            Ok(Component { name, quantity, is_force: false, image, share })
        };
        all.iter().map(own).collect()
    }
}
