//! Rods beyond their model: curvature within an element that is too large for the section, rods that are not slender.

use crate::base::input::{four_digits, short};
use crate::dynamics::report::Indicator;
use crate::elements::body::Body;
use crate::elements::rod::SLENDER;

/// Largest reach of a section over the radius of curvature in an element: beyond it adjacent sections intersect.
const MOST: f64 = 1.0;

/// Adjacent sections that overlap, in a single body that is a rod.
pub(super) fn kinked(body: &Body) -> Option<Indicator> {
    let bend = body.sharpest_bend()?;
    let value = bend.reach * bend.angle / bend.length;
    let name = body.name().unwrap_or("rod");
    let said = format!(
        "rod \"{name}\" turns by {:.0} degrees along element {}, {} m long, where its section reaches {} m: {} times the radius of curvature (limit: {MOST})",
        bend.angle.to_degrees(),
        bend.element + 1,
        short(bend.length),
        short(bend.reach),
        four_digits(value),
    );
    let beyond = || {
        format!(
            "{said}; sections overlap at the inside of the kink, which no rod has: round the path off by an arc, or take longer elements, over which a corner is rounded off"
        )
    };
    Some(Indicator::trusted("rod-curvature", (value, "1"), [0.0, MOST], || said.clone(), beyond))
}

/// The slenderness of a single body that is a rod.
pub(super) fn stubby(body: &Body) -> Option<Indicator> {
    let [length, width] = body.rod_extent()?;
    let name = body.name().unwrap_or("rod");
    let value = length / width;
    let said = format!(
        "rod \"{name}\" is {} m long and {} m wide: {} times (at least: {SLENDER})",
        short(length),
        short(width),
        four_digits(value),
    );
    let beyond = || {
        format!(
            "{said}; what a clamp or a load at an end does to the section reaches a width into the body, which a rod leaves out: make it longer or thinner, or \
             model it as a solid; if its section is given by numbers, their units are m^2 and m^4"
        )
    };
    let limits = [SLENDER, f64::INFINITY];
    Some(Indicator::trusted("rod-slenderness", (value, "1"), limits, || said.clone(), beyond))
}
