//! `pliant check`

use std::collections::{BTreeMap, BTreeSet};

use clap::Args;
use pliant::scene_file::Format;
use pliant::studies::work_precision::Look;
use pliant::{
    Dilatation, Lame, Law, Part, PhaseSummary, Scene, SceneFile, Settings, Strain, Substance,
};

use super::failure::{Failure, print};
use super::scene::SceneArguments;

/// Check a scene file and print what the scene contains
///
/// For each phase: the number of constraints, the fastest rate (vibration or decay), the period of the
/// slowest vibration and its damping ratio, and what acts besides. Rates and periods are estimates for
/// the undeformed shape at rest; contacts and springs count as far as they act there. Warnings tell what makes any
/// motion of the scene doubtful.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,

    /// Run the scene coarsely, for 2 seconds at most, and print what it tells of the model
    ///
    /// One line for each number that is measured, on the scene and on its motion: `fine`, `doubtful`, or
    /// `more-than-needed`, where less would do.
    #[arg(long)]
    look: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let file = arguments.scene.read()?;
    let phases = file.scene.summary()?;
    if !file.title.is_empty() {
        print(&file.title)?;
    }
    body(&file.scene)?;
    surroundings(&file.scene)?;
    solver(&file)?;
    timeline(&phases)?;
    redundant(&phases)?;
    file.notes.iter().try_for_each(|note| print(format_args!("note: {note}")))?;
    if arguments.look {
        let look = Look::of(&file.scene, &file.settings, Look::SECONDS)?;
        return print(format_args!("\n{look}"));
    }
    file.scene.warnings().iter().try_for_each(|warning| print(format_args!("WARNING: {warning}")))
}

fn line(label: &str, text: &str) -> Result<(), Failure> {
    print(format_args!("{label:10} {text}"))
}

fn body(scene: &Scene) -> Result<(), Failure> {
    let body = scene.body();
    let mesh = body.mesh();
    let kinds = body.parts().map(|part| format!("{:?}", part.body.mesh().kind()).to_lowercase());
    let kind = kinds.collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>().join(", ");
    let (nodes, cells, boundary) =
        (mesh.node_count(), mesh.cell_count(), mesh.boundary_nodes().len());
    line("mesh", &format!("{nodes} nodes ({boundary} on the boundary), {cells} cells ({kind})"))?;
    let sets = mesh.sets().iter().map(|(name, nodes)| format!("{name} ({})", nodes.len()));
    line("node sets", &sets.collect::<Vec<_>>().join(", "))?;
    body.parts().try_for_each(|part| part_of(&part))
}

fn part_of(Part { name, body, .. }: &Part) -> Result<(), Failure> {
    let (size, mass, dofs) = (body.mesh().size(), body.mass(), body.dofs());
    let strain = format!("{:?}", body.strain()).to_lowercase();
    let viscosity = format!("{:?}", body.viscosity()).to_lowercase();
    let name = if name.is_empty() { String::new() } else { format!("\"{name}\": ") };
    let unknown = match body.independent_dofs() {
        own if own < dofs => format!(", {own} of them independent"),
        _ => String::new(),
    };
    line(
        "body",
        &format!("{name}{size:.4} m across, {mass:.4} kg, {dofs} displacements{unknown}"),
    )?;
    let dilatation = match body.dilatation() {
        Dilatation::AtPoints => "",
        Dilatation::Mean => ", mean dilatation",
        Dilatation::Linear => ", linear dilatation",
    };
    let plane = body.planes().map_or_else(String::new, |plane| format!(", {plane}"));
    line("", &format!("{strain} strain, {viscosity} viscosity{plane}{dilatation}"))?;
    let labels = std::iter::once("material").chain(std::iter::repeat("region"));
    labels
        .zip(body.substances())
        .try_for_each(|(label, substance)| line(label, &made_of(substance, body.strain())))
}

fn made_of(substance: &Substance, strain: Strain) -> String {
    let Substance { material, law, mass_damping, branches, fibres, is_rigid, mass } = substance;
    if let Some(mass) = mass {
        let by = if mass.moments.is_some() { "inertia by numbers" } else { "uniform" };
        let young = material.young;
        return format!("rigid, {} kg, {by}; E {young:.4e} Pa in equilibria", mass.mass);
    }
    if *is_rigid {
        return format!(
            "rigid, {} kg/m^3; E {:.4e} Pa in equilibria",
            material.density, material.young
        );
    }
    let law = match (law, strain) {
        (Some(law), _) => law.name(),
        (None, Strain::Cauchy) => "linear elasticity",
        (None, Strain::Green) => Law::StVenantKirchhoff.name(),
    };
    let Lame { lambda, mu } = material.elastic();
    let mut text = format!(
        "{law}, E {:.4e} Pa, nu {}, mu {mu:.4e} Pa, kappa {:.4e} Pa, {} kg/m^3",
        material.young,
        material.poisson,
        lambda + mu * 2.0 / 3.0,
        material.density
    );
    if material.viscosity > 0.0 {
        text += &format!(", viscosity {} Pa s", material.viscosity);
    }
    if *mass_damping > 0.0 {
        text += &format!(", mass damping {mass_damping} 1/s");
    }
    if material.viscosity == 0.0 && *mass_damping == 0.0 && branches.is_empty() {
        text += ", undamped";
    }
    for (count, what) in
        [(branches.len(), "Maxwell branches"), (fibres.len(), "families of fibres")]
    {
        if count > 0 {
            text += &format!(", {what}: {count}");
        }
    }
    text
}

fn surroundings(scene: &Scene) -> Result<(), Failure> {
    if let Some(gravity) = scene.acceleration() {
        line("gravity", &format!("{gravity:?} m/s^2"))?;
    }
    let mut actuators: Vec<(String, Vec<&str>)> = Vec::new();
    for (kind, name) in scene.actuator_names() {
        let label = format!("{kind}s");
        match actuators.iter_mut().find(|(own, _)| *own == label) {
            Some((_, names)) => names.push(name),
            None => actuators.push((label, vec![name])),
        }
    }
    let magnets = scene.magnets().iter().map(|magnet| format!("{:?} T", magnet.remanence()));
    let magnets: Vec<String> = magnets.collect();
    let mut devices: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for device in scene.devices() {
        devices.entry(format!("{}s", device.kind())).or_default().push(device.name());
    }
    let of_bodies = [
        ("lags of", scene.lags().map(|(name, _)| name).collect()),
        ("magnets", magnets.iter().map(String::as_str).collect::<Vec<_>>()),
    ];
    let others = [
        ("chambers", scene.chambers().iter().map(|chamber| chamber.name()).collect()),
        ("orifices", scene.orifices().iter().map(|orifice| orifice.name()).collect()),
        ("liquids", scene.liquids().iter().map(|liquid| liquid.chamber()).collect()),
        ("pipes", scene.pipes().iter().map(|pipe| pipe.name()).collect()),
        ("fluids", scene.fluids().iter().map(|fluid| fluid.name()).collect()),
        ("obstacles", scene.obstacles().iter().map(|obstacle| obstacle.name()).collect()),
    ];
    let devices = devices.iter().map(|(label, names)| (label.as_str(), names.clone()));
    let actuators = actuators.iter().map(|(label, names)| (label.as_str(), names.clone()));
    for (label, names) in actuators.chain(of_bodies).chain(devices).chain(others) {
        if !names.is_empty() {
            line(label, &names.join(", "))?;
        }
    }
    let touches = scene.touch_distances().map_err(pliant::Error::from)?;
    touches.iter().try_for_each(|touch| line("touch", &touch.to_string()))
}

fn solver(file: &SceneFile) -> Result<(), Failure> {
    let SceneFile { scene, settings, output, .. } = file;
    let Settings { method, rtol, alpha, max_order, contact_events, max_steps, max_time, .. } =
        settings;
    let atol = settings.tolerances(scene);
    line("solver", &format!("{method}, rtol {rtol:e}, alpha {alpha} 1/s"))?;
    let (position, velocity) = (atol.position, atol.velocity);
    line("", &format!("atol {position:.2e} m and {velocity:.2e} m/s"))?;
    let order = max_order.map_or(String::new(), |order| format!("order up to {order}, "));
    let events = format!("contact events: {contact_events}");
    let time = max_time.map_or(String::new(), |time| format!("{time} s of wall-clock time, "));
    line("", &format!("{order}up to {max_steps} steps in a phase, {time}{events}"))?;
    for model in &file.smaller {
        line("run as", &model.to_string())?;
    }
    if let Some(model) = scene.reduced_model() {
        line("reduced", &model.to_string())?;
        line("", &format!("learned from {}", model.learned_from()))?;
    }
    let step = match (&output.times, output.step) {
        (Some(times), _) => format!("at {} times", times.len()),
        (None, Some(step)) => format!("every {step} s"),
        (None, None) => "at the ends of the phases".into(),
    };
    if !output.sensors.is_empty() {
        let names: Vec<&str> = output.sensors.iter().map(|(name, _)| &name[..]).collect();
        line("sensors", &names.join(", "))?;
    }
    let formats: Vec<&str> = output.formats.iter().map(|format| Format::name(*format)).collect();
    line("output", &format!("{step}; {}", formats.join(", ")))
}

/// A table of the phases.
fn timeline(phases: &[PhaseSummary]) -> Result<(), Failure> {
    let width = phases.iter().map(|phase| phase.name.chars().count()).fold(5, usize::max);
    print(format_args!(
        "\n{:width$} {:>9} {:>9} {:>11} {:>13} {:>11} {:>9}  acting",
        "phase", "from (s)", "to (s)", "constraints", "fastest (1/s)", "slowest (s)", "damping"
    ))?;
    phases.iter().try_for_each(|phase| {
        let PhaseSummary { name, start, end, constraints, spectrum, .. } = phase;
        let (period, damping) = match spectrum.slowest_period() {
            Some(period) => (format!("{period:.3e}"), spectrum.lowest_damping_ratio),
            None => ("none".into(), 0.0),
        };
        let (rate, acting) = (spectrum.stiffest_rate(), acting(phase));
        print(format_args!(
            "{name:width$} {start:9} {end:9} {constraints:11} {rate:13.3e} {period:>11} \
             {damping:9.1e}  {acting}"
        ))
    })
}

/// Rows of joints that other constraints imply: the forces that they would carry are those of the others.
fn redundant(phases: &[PhaseSummary]) -> Result<(), Failure> {
    let of_phase = |phase: &PhaseSummary| {
        phase.redundant.iter().try_for_each(|(device, [count, all])| {
            print(format_args!(
                "note: {device} in phase \"{}\": {count} of its {all} rows follow from other constraints and are left out; \
                 their forces count with those",
                phase.name
            ))
        })
    };
    phases.iter().try_for_each(of_phase)
}

/// Text with the end, gravity, loads, actuators, pressures and contacts of a phase.
fn acting(phase: &PhaseSummary) -> String {
    let mut words: Vec<String> = phase.ends.iter().cloned().collect();
    if let Some(gravity) = &phase.gravity {
        words.push(format!("gravity {gravity:?} m/s^2"));
    }
    if phase.has_magnetic_field {
        words.push("magnetic field".into());
    }
    if phase.loaded_nodes > 0 {
        words.push(format!("loads on {} node(s)", phase.loaded_nodes));
    }
    for (what, names) in [
        ("actuators of", &phase.actuated),
        ("pressure in", &phase.pressurized),
        ("contact with", &phase.obstacles),
    ] {
        if !names.is_empty() {
            words.push(format!("{what} {}", names.join(", ")));
        }
    }
    words.join("; ")
}
