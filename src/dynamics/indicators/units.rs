//! Evidence that a scene is in units other than metres, kilograms, seconds and pascals.

use crate::base::input::{four_digits, percent};
use crate::base::vector::{dot, norm};
use crate::dynamics::report::{Indicator, Verdict};
use crate::elements::body::Body;
use crate::elements::material::{Material, Plane};
use crate::scene::forces::VectorSignal;
use crate::scene::timeline::{DeviceInput, InputLimit, Phase, Quantity, Scene, Target};

/// Largest size (m) and mass (kg) of a soft body.
const LARGEST: f64 = 10.0;
const HEAVIEST: f64 = 1e4;
/// Densities (kg/m^3): foams have some 10 and more, osmium has 22,600.
const DENSITIES: [f64; 2] = [5.0, 25_000.0];
/// Largest moduli (Pa): of materials that laws of rubber are made for, and of any material (diamond has
/// 1e12).
const STIFFEST_RUBBER: f64 = 1e8;
const STIFFEST: f64 = 2e12;
/// Slowest and fastest waves sqrt(E/rho) in soft bodies (m/s): jelly has some 1 m/s, steel 5,000.
const SPEEDS: [f64; 2] = [0.1, 1e4];
/// Largest thickness of a body in the plane relative to its size there.
const THICKEST: f64 = 20.0;
/// Results in plane strain are given per metre.
const PER_METRE: f64 = 1.0;
/// Strain of a column as high as the body under its own weight.
const HEAVIEST_STRAIN: f64 = 1.0;

/// Largest remanence (T): magnets of neodymium have up to 1.5 T. Largest magnetic field (T): superconducting coils have more.
const STRONGEST: f64 = 2.0;
const STRONGEST_FIELD: f64 = 10.0;
/// Number of times of a phase at which fields and inputs of devices are checked.
const LOOKS: u32 = 20;

/// The indicators of the whole scene.
pub(super) fn of_scene(scene: &Scene) -> Vec<Indicator> {
    let mut all = if scene.magnets().is_empty() { Vec::new() } else { magnets(scene) };
    all.extend(devices(scene));
    as_meant(scene, all)
}

/// Those of magnets and their field.
fn magnets(scene: &Scene) -> Vec<Indicator> {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let remanence = largest(&mut scene.magnets().iter().map(|magnet| norm(magnet.remanence())));
    let most = |phase: &Phase, start: f64, field: &VectorSignal| {
        let size = |t| norm(&field.components(t, scene.body().dimension()));
        looks(phase, start, field.breaks()).map(size).fold(0.0, f64::max)
    };
    let field =
        largest(&mut phases(scene).filter_map(|(phase, start)| {
            phase.uniform_field().map(|field| most(phase, start, field))
        }));
    let measured = [
        ("remanence", remanence, STRONGEST, "a remanence", "magnets of neodymium have 1.3 T"),
        (
            "magnetic-field",
            field,
            STRONGEST_FIELD,
            "a magnetic field",
            "that of the earth is 5e-5 T, at a strong magnet there is 1 T",
        ),
    ];
    let all = measured.map(|(name, value, most, what, known)| {
        let said = format!("{what} is {} T (limit: {most} T)", four_digits(value));
        let beyond = || format!("{said}: is it in mT (0.001 T) or gauss (0.0001 T)? {known}");
        Indicator::trusted(name, (value, "T"), [0.0, most], || said.clone(), beyond)
    });
    all.into()
}

/// The phases, and when they begin (s).
fn phases(scene: &Scene) -> impl Iterator<Item = (&Phase, f64)> {
    let starts = [0.0].into_iter().chain(scene.phases().iter().map(Phase::end));
    scene.phases().iter().zip(starts)
}

/// The times (s) of a phase at which a signal with these breaks is checked.
fn looks(phase: &Phase, start: f64, breaks: &[f64]) -> impl Iterator<Item = f64> {
    let part = move |look| start + (phase.end() - start) * f64::from(look) / f64::from(LOOKS);
    (0..=LOOKS).map(part).chain(breaks.iter().copied())
}

/// Inputs of devices that have a limit: the largest of all devices for each.
fn devices(scene: &Scene) -> Vec<Indicator> {
    let mut largest: Vec<(&DeviceInput, InputLimit, f64)> = Vec::new();
    for device in scene.devices() {
        for input in device.inputs() {
            let Some(limit) = input.limit else { continue };
            let (quantity, target) = (Quantity::Device(input), Target::one(device.name()));
            let size = |phase, t| norm(&scene.input_at(phase, quantity, &target, t));
            let value = phases(scene).fold(0.0, |most: f64, (phase, start)| {
                let breaks = scene.input_breaks(phase, quantity, &target);
                looks(phase, start, &breaks).map(|t| size(phase, t)).fold(most, f64::max)
            });
            match largest.iter_mut().find(|(_, other, _)| other.name == limit.name) {
                Some((.., most)) => *most = most.max(value),
                None => largest.push((input, limit, value)),
            }
        }
    }
    let indicator = |(input, limit, value): (&DeviceInput, InputLimit, f64)| {
        let InputLimit { name, about, most, help } = limit;
        let unit = input.unit;
        let said = format!("{about} is {} {unit} (limit: {most} {unit})", four_digits(value));
        let beyond = || format!("{said}: {help}");
        Indicator::trusted(name, (value, unit), [0.0, most], || said.clone(), beyond)
    };
    largest.into_iter().map(indicator).collect()
}

/// The indicators of a body; those that the scene declares as [meant](Scene::unusual) count as within their limits.
pub(super) fn units(scene: &Scene, body: &Body) -> Vec<Indicator> {
    let mut all = extent(body);
    all.extend(materials(body));
    all.extend(thickness(body));
    all.extend(weight(scene, body));
    as_meant(scene, all)
}

/// Those that the scene declares as [meant](Scene::unusual) count as within their limits.
pub(super) fn as_meant(scene: &Scene, mut all: Vec<Indicator>) -> Vec<Indicator> {
    for indicator in &mut all {
        let is_meant = scene.unusual_quantities().iter().any(|name| name == indicator.name);
        if is_meant && indicator.is_beyond() {
            indicator.verdict = Verdict::Fine;
            indicator.text += " (the scene says that it is meant)";
        } else if indicator.is_beyond() {
            indicator.text += &format!("; if it is meant, say unusual = [\"{}\"]", indicator.name);
        }
    }
    all
}

fn extent(body: &Body) -> Vec<Indicator> {
    let (size, mass) = (body.mesh().size(), body.mass());
    let help = "is the mesh in mm? Coordinates are metres: divide them by 1000, or by 100 if they are in cm (in Gmsh: \
                Mesh.ScalingFactor = 0.001)";
    let size_told = format!("the body is {size:.3} m across (limit: {LARGEST} m)");
    let size_beyond = || format!("{size_told}: {help}");
    let size =
        Indicator::trusted("size", (size, "m"), [0.0, LARGEST], || size_told.clone(), size_beyond);
    let mass_told = format!("the body weighs {mass:.3e} kg (limit: {HEAVIEST} kg)");
    let mass_beyond = || format!("{mass_told}: {help}");
    let mass = Indicator::trusted(
        "mass",
        (mass, "kg"),
        [0.0, HEAVIEST],
        || mass_told.clone(),
        mass_beyond,
    );
    // one remedy for both
    let mass = Some(mass).filter(|_| !size.is_beyond());
    [size].into_iter().chain(mass).collect()
}

fn materials(body: &Body) -> Vec<Indicator> {
    let mut all = Vec::new();
    // materials that no cell is made of do not count
    let used = body.substances().filter(|used| body.materials().any(|own| *own == used.material));
    for substance in used {
        let material = &substance.material;
        let density = material.density;
        let said = format!(
            "the density is {} kg/m^3 (limits: {} to {} kg/m^3)",
            four_digits(density),
            DENSITIES[0],
            DENSITIES[1]
        );
        let beyond =
            || format!("{said}: is it in g/cm^3? Water has 1000 kg/m^3, which is 1 g/cm^3");
        let value = (density, "kg/m^3");
        let density = Indicator::trusted("density", value, DENSITIES, || said.clone(), beyond);
        let is_rubber = substance.law.is_some_and(|law| law.information().is_rubber);
        let (most, of) = match is_rubber {
            true => (STIFFEST_RUBBER, "a law of rubber"),
            false => (STIFFEST, "any material"),
        };
        let young = material.young;
        let said = format!(
            "young is {} Pa (limit for {of}: {} Pa)",
            four_digits(young),
            four_digits(most)
        );
        let beyond = || {
            format!(
                "{said}: soft silicone has 1e5 Pa, hard rubber 1e7; is it in other units than Pa?"
            )
        };
        let stiff =
            Indicator::trusted("young", (young, "Pa"), [0.0, most], || said.clone(), beyond);
        let speed = material.wave_speed();
        let said = format!(
            "waves run through the body at {speed:.2e} m/s (limits: {} to {} m/s)",
            SPEEDS[0], SPEEDS[1]
        );
        let beyond = || format!("{said}: young is in Pa, density in kg/m^3");
        let waves =
            Indicator::trusted("wave-speed", (speed, "m/s"), SPEEDS, || said.clone(), beyond);
        // a wrong density or modulus makes the speed wrong, too
        let is_known = density.is_beyond() || stiff.is_beyond();
        all.extend([density, stiff]);
        all.extend((!is_known).then_some(waves));
    }
    all
}

/// Thickness of a body in the plane.
fn thickness(body: &Body) -> Option<Indicator> {
    let mesh = body.mesh();
    let (thickness, size) = (body.section(), mesh.size());
    let is_per_metre = body.plane() == Some(Plane::Strain) && thickness == PER_METRE;
    if body.is_axisymmetric() {
        return None;
    }
    if mesh.kind().dimension() != 2 || mesh.is_surface() || is_per_metre {
        return None;
    }
    let part = thickness / size;
    let said = format!(
        "the body is {} m thick, {} times as much as it is across (limit: {THICKEST} times)",
        four_digits(thickness),
        four_digits(part)
    );
    let beyond = || format!("{said}: is thickness in mm? It is in metres");
    Some(Indicator::trusted("thickness", (part, "1"), [0.0, THICKEST], || said.clone(), beyond))
}

/// Compressive strain of a column of the softest material, as high as the body, under its own weight: rho g H /
/// E.
fn weight(scene: &Scene, body: &Body) -> Option<Indicator> {
    let gravities = scene.phases().iter().filter_map(|phase| scene.gravity_in(phase));
    let gravity = gravities.max_by(|a, b| norm(a).total_cmp(&norm(b)))?;
    let strength = norm(gravity);
    if strength == 0.0 {
        return None;
    }
    let heights =
        body.mesh().positions().chunks_exact(body.dimension()).map(|x| dot(x, gravity) / strength);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
        (low.min(height), high.max(height))
    });
    let strain = |material: &Material| material.density * strength * (high - low) / material.young;
    let strain = body.materials().map(strain).fold(0.0, f64::max);
    let said = format!(
        "a column as high as the body is strained by {} under its own weight (limit: {})",
        percent(strain),
        percent(HEAVIEST_STRAIN)
    );
    let beyond = || {
        format!(
            "{said}: such a body collapses under its own weight; check the units of young (Pa), density (kg/m^3), gravity (m/s^2) and the mesh (m)"
        )
    };
    Some(Indicator::trusted(
        "weight",
        (strain, "1"),
        [0.0, HEAVIEST_STRAIN],
        || said.clone(),
        beyond,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::indicators::gas::gas;
    use crate::dynamics::indicators::pressed::pressed;
    use crate::dynamics::indicators::pressed::tests::touching;
    use crate::scene::devices::Dipole;
    use crate::scene::forces::{Chamber, Gas, Magnet, Orifice};
    use crate::scene::timeline::UNITS;
    use crate::studies::samples::square_jump;

    /// The names that a scene may call unusual are those of the indicators here.
    #[test]
    fn what_may_be_unusual_is_what_is_measured() {
        let scene = square_jump(4).unwrap().gravity([0.0, -9.8]).phase(Phase::until(9.0));
        let scene =
            scene.magnet(Magnet::new([0.1, 0.0])).dipole(Dipole::new([1.0, 0.0], [0.0, 9.0]));
        let scene = scene
            .chamber(Chamber::within("air", [1, 4, 16, 13]))
            .gas(Gas::in_chamber("air"))
            .orifice(Orifice::new("vent", "air", "atmosphere", 1e-9));
        let mut all = units(&scene, scene.body());
        all.extend(of_scene(&scene));
        all.extend(gas(&scene));
        all.extend(pressed(&touching(1e-4)));
        let mut names: Vec<&str> = all.iter().map(|indicator| indicator.name).collect();
        names.sort_unstable();
        // a mesh from a file has facets
        let mut known: Vec<&str> = UNITS.into_iter().filter(|name| *name != "facets").collect();
        known.sort_unstable();
        assert_eq!(names, known);
    }
}
