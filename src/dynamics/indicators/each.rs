//! Indicators of several bodies, measured on each separately.

use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::body::{Body, Part};

/// Indicators of the motion, measured on each body separately.
pub(super) fn each_body(
    trajectory: &Trajectory,
    samples: &[&Sample],
    measure: impl Fn(&Body, &[&Sample]) -> Vec<Indicator>,
) -> Vec<Indicator> {
    let body = trajectory.body();
    if body.is_single() {
        return measure(body, samples);
    }
    let of_body = |part: Part| {
        let own = |sample: &&Sample| Sample {
            u: sample.u[part.dofs()].to_vec(),
            v: sample.v[part.dofs()].to_vec(),
            ..Sample::clone(sample)
        };
        let own: Vec<Sample> = samples.iter().map(own).collect();
        let own: Vec<&Sample> = own.iter().collect();
        named(part.name, body, measure(part.body, &own).into_iter())
    };
    body.parts().flat_map(of_body).collect()
}

/// Indicators of a body, with its name in front if it is one of several.
pub(super) fn named(
    name: &str,
    all: &Body,
    indicators: impl Iterator<Item = Indicator>,
) -> Vec<Indicator> {
    let is_single = all.is_single();
    let told = |mut indicator: Indicator| {
        if !is_single {
            indicator.text = format!("body \"{name}\": {}", indicator.text);
        }
        indicator
    };
    indicators.map(told).collect()
}
