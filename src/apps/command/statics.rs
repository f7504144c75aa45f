//! `pliant static`

use clap::Args;
use pliant::output::write_static_report;
use pliant::scene_file::Format;
use pliant::studies::work_precision::Quantity;
use pliant::{Error, MeshEstimate, OutputRequest, SceneFile};

use crate::failure::{Failure, print};
use crate::files::OutputArguments;
use crate::scene::SceneArguments;

/// Find the equilibrium of a phase of a scene
///
/// Its constraints, gravity, loads, obstacles and springs are taken as they are at its end; there is
/// no motion. Writes trajectory.csv with one row, report.json, state.json (for other scenes to start from), and what --formats asks for, to
/// out/NAME-static for the scene file NAME.toml if --out does not say otherwise. With several steps these are
/// the load curve: one row and one frame for each equilibrium, with its load factor.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Name of the phase [default: the first one]
    #[arg(long, value_name = "NAME")]
    phase: Option<String>,
    /// Steps in which constraints and loads are brought on
    #[arg(long, value_name = "STEPS")]
    load_steps: Option<usize>,
    /// Most steps by arc length, through snap-through and snap-back; the first is one of the load steps
    #[arg(long, value_name = "STEPS")]
    arc_steps: Option<usize>,
    /// Estimate by how much this is off because the mesh is not finer: a sensor or node set and a component such as tip.y,
    /// com.x
    #[arg(long, value_name = "QUANTITY")]
    quantity: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, phase, load_steps, arc_steps, quantity, output } = arguments;
    let mut file = scene.read()?;
    output.apply(&mut file)?;
    let options = &mut file.statics.options;
    options.load_steps = load_steps.unwrap_or(options.load_steps);
    options.arc_steps = arc_steps.unwrap_or(options.arc_steps);
    file.statics.phase = phase.clone().or(file.statics.phase);
    let mut directory = output.directory(&scene.path, "-static")?;
    let quantity = quantity.as_deref();
    let quantity = quantity.map(|name| Quantity::named(name, &file.scene, &file.output.sensors));
    let quantity = quantity.transpose()?;
    if let Some(quantity) = &quantity {
        MeshEstimate::check(&file.scene, quantity)?;
    }
    let SceneFile { title, statics, output: request, .. } = &file;
    let mut request = request.clone();
    // a single state has nothing to plot over time
    let asked = request.formats.len();
    request.formats.retain(|format| ![Format::Plot, Format::Png].contains(format));
    if request.formats.len() < asked && !output.quiet {
        print("plots over time are of motions: an equilibrium has none")?;
    }
    let request = &request;

    let mut result = file.equilibrium();
    if let (Ok(equilibrium), Some(quantity)) = (&mut result, &quantity) {
        equilibrium.mesh_estimate = Some(MeshEstimate::of(equilibrium, quantity)?);
    }
    let outcome = match &result {
        Ok(equilibrium) => Ok(equilibrium),
        Err(Error::Statics(failure)) => Err(&**failure),
        Err(_) => return result.map(|_| ()).map_err(Failure::from),
    };
    let trajectory = match outcome {
        Ok(equilibrium) => equilibrium.trajectory(),
        Err(failure) => &failure.trajectory,
    };
    directory.claim()?;
    directory.write("report.json", |path| write_static_report(outcome, path))?;
    // the states from the undeformed shape to a single equilibrium are not a motion of the body: only
    // pictures show both
    let found = if statics.options.is_curve() { trajectory.clone() } else { trajectory.at_end() };
    directory.write_table(&found, request)?;
    if outcome.is_ok() {
        directory.write_state(trajectory)?;
    }
    let (files, pictures) = request.formats.iter().partition(|&&format| format == Format::Vtk);
    for (shown, formats) in [(&found, files), (trajectory, pictures)] {
        directory.write_formats(shown, title, &OutputRequest { formats, ..request.clone() })?;
    }

    if !output.quiet && !title.is_empty() {
        print(title)?;
    }
    if let Ok(equilibrium) = outcome {
        print(equilibrium)?;
    }
    if !output.quiet {
        directory.tell()?;
    }
    result.map(|_| ()).map_err(Failure::from)
}
