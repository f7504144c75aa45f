//! Checks of the numbers of gas: pressures that are not absolute, conductances of orifices in a wrong unit.

use super::units::as_meant;
use crate::base::input::four_digits;
use crate::dynamics::report::Indicator;
use crate::scene::forces::{End, Signal};
use crate::scene::timeline::{Phase, Scene};

/// Absolute pressures below this (Pa), half of the atmosphere, are likely to be gauge pressures.
const LEAST: f64 = 5e4;
/// Largest area of a hole, relative to a face of a cube as large as the chamber.
const WIDEST: f64 = 1.0;
/// Number of times of a phase at which supplies are checked.
const LOOKS: u32 = 20;

/// The indicators of gas, if there is any; those that the scene declares as [meant](Scene::unusual) count as within their limits.
pub(super) fn gas(scene: &Scene) -> Vec<Indicator> {
    if !scene.has_gas() {
        return Vec::new();
    }
    let all = pressure(scene).into_iter().chain(area(scene));
    as_meant(scene, all.collect())
}

/// The least absolute pressure of gases, supplies and the atmosphere.
fn pressure(scene: &Scene) -> Option<Indicator> {
    let air = scene.outside();
    let gases = scene.gases().map(|gas| {
        (format!("gas in chamber \"{}\" begins with", gas.chamber), gas.absolute_pressure())
    });
    let supplies = scene
        .supplies()
        .map(|(name, pressure)| (format!("supply \"{name}\" has"), least(scene, pressure)));
    let all = gases.chain(supplies).chain([("the atmosphere has".to_owned(), air)]);
    let (what, least) = all.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let said = format!("{what} {} Pa, absolute (limit: {LEAST} Pa)", four_digits(least));
    let beyond = || format!("{said}: if that is a gauge pressure, write {} Pa", least + air);
    let range = [LEAST, f64::INFINITY];
    Some(Indicator::trusted("absolute-pressure", (least, "Pa"), range, || said.clone(), beyond))
}

/// The least value of a signal in all phases.
fn least(scene: &Scene, signal: &Signal) -> f64 {
    let starts = [0.0].into_iter().chain(scene.phases().iter().map(Phase::end));
    let times = scene.phases().iter().zip(starts).flat_map(|(phase, start)| {
        (0..=LOOKS).map(move |k| start + (phase.end() - start) * f64::from(k) / f64::from(LOOKS))
    });
    let times = times.chain(signal.breaks().iter().copied()).chain([0.0]);
    times.map(|t| signal.at(t)).fold(f64::INFINITY, f64::min)
}

/// The orifice that is largest relative to a chamber at one of its ends.
fn area(scene: &Scene) -> Option<Indicator> {
    let gases = scene.filled().ok()?;
    let phase = scene.first_phase().ok()?;
    let mut widest: Option<(f64, f64, &str)> = None;
    for (number, orifice) in scene.orifices().iter().enumerate() {
        let Ok(flow) = scene.orifice_flow(number, phase) else { continue };
        let area = flow.area();
        for end in flow.ends() {
            let End::Gas(gas) = end else { continue };
            let part = area / gases[*gas].natural_volume().powf(2.0 / 3.0);
            if widest.is_none_or(|(most, ..)| part > most) {
                widest = Some((part, area, orifice.name()));
            }
        }
    }
    let (part, area, name) = widest?;
    let said = format!(
        "orifice \"{name}\" has the flow of a hole of {} m^2, {} times a face of a cube as large as the chamber (limit: {WIDEST})",
        four_digits(area),
        four_digits(part)
    );
    let beyond = || {
        format!(
            "{said}: is the conductance in l/(s bar)? It is in m^3/(s Pa), 1e-8 of that; small valves have 1e-9 to 1e-8"
        )
    };
    Some(Indicator::trusted("orifice-area", (part, "1"), [0.0, WIDEST], || said.clone(), beyond))
}
