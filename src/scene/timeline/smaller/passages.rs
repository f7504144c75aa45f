//! Orifices, valves and pipes of a scene in its half.
//!
//! A chamber that the plane cuts has half of its gas or liquid there, which half of the flow fills as fast. Between a chamber and its own
//! mirror image nothing flows.

use super::components::{Component, Inputs};
use super::same::Same;
use crate::base::input::InputError;

impl<'s> Same<'s> {
    /// The passages of a kind in the half: `all` are their names, ends and properties.
    ///
    /// # Errors
    /// One without a mirror image; one from a chamber on this side of the plane to a chamber on the other.
    pub(super) fn passages(
        &self,
        chambers: &[Component<'s>],
        (kind, inputs): (&str, Inputs),
        all: Vec<(&'s str, &'s [String; 2], String)>,
    ) -> Result<Vec<Component<'s>>, InputError> {
        let own = |own: &(&'s str, &'s [String; 2], String)| {
            let &(name, of, ref likeness) = own;
            let of =
                of.each_ref().map(|end| (&**end, chambers.iter().find(|own| own.name == *end)));
            let mut ends = of.map(|(end, chamber)| chamber.map_or(end, |own| own.image));
            // the law is the same in both directions
            ends.sort_unstable();
            let is_image = |(_, others, other): &&(&str, &[String; 2], String)| {
                let mut others = others.each_ref().map(|end| &**end);
                others.sort_unstable();
                others == ends && other == likeness
            };
            let told = format!("\"{name}\"");
            let image = std::iter::once(own).chain(&all).find(is_image);
            let image = image.ok_or_else(|| self.refused(kind, &told))?.0;
            let chambers = of.iter().filter_map(|(_, chamber)| *chamber);
            let mut beside = chambers.filter(|end| end.image != end.name);
            let share = if image == name {
                beside.next().is_none().then_some(0.5)
            } else {
                let sides: Vec<bool> = beside.map(|end| end.share.is_some()).collect();
                if sides.iter().any(|side| *side != sides[0]) {
                    let help = "it leads across the plane of symmetry: leave the scene whole";
                    return Err(InputError::new(kind, told, help));
                }
                sides.contains(&true).then_some(1.0)
            };
            Ok(Component { name, image, share, inputs })
        };
        all.iter().map(own).collect()
    }
}
