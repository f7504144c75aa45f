//! `pliant static`

use std::fs;
use std::path::Path;

use clap::Args;
use pliant::output::write_static_report;
use pliant::scene_file::Format;
use pliant::studies::work_precision::Quantity;
use pliant::{Equilibrium, Error, MeshEstimate, NoEquilibrium, OutputRequest, SceneFile};

use super::failure::{Failure, print};
use super::files::{Directory, OutputArguments, REFINED, REPORT, without_older};
use super::scene::SceneArguments;

/// Find the equilibrium of a phase of a scene
///
/// Its constraints, gravity, loads, obstacles and actuators are taken as they are at its end; there is
/// no motion. The search begins in the undeformed shape, or in the state of [initial] from. Writes trajectory.csv with one row, report.json, state.json (for other scenes to start from), and what --formats asks for, to
/// out/NAME-static for the scene file NAME.toml if --out does not say otherwise. With several steps these are
/// the load curve: one row and one frame for each equilibrium, with its load factor, over which the format plot draws the sensors.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
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
    /// Divide triangles and tetrahedra where that estimate says that it helps, until there are so many nodes; writes refined.toml, the
    /// scene file with that mesh
    #[arg(long, value_name = "NODES", requires = "quantity")]
    refine: Option<usize>,
    #[command(flatten)]
    output: OutputArguments,
}

impl Arguments {
    /// The scene file with the options of the command line, and these values in place of its own.
    fn read(&self, set: &[String]) -> Result<SceneFile, Failure> {
        let mut file = self.scene.read_with(set)?;
        self.output.apply(&mut file)?;
        let options = &mut file.statics.options;
        options.load_steps = self.load_steps.unwrap_or(options.load_steps);
        options.arc_steps = self.arc_steps.unwrap_or(options.arc_steps);
        file.statics.phase = self.phase.clone().or(file.statics.phase);
        Ok(file)
    }

    fn quantity(&self, file: &SceneFile) -> Result<Option<Quantity>, Error> {
        let name = self.quantity.as_deref();
        let quantity = name.map(|name| Quantity::named(name, &file.scene, &file.output.sensors));
        Ok(quantity.transpose()?)
    }

    /// The scene on a mesh of so many nodes, refined where the error estimate is large: the overrides for it, the file
    /// with them, and the equilibrium.
    fn refined(&self, nodes: usize) -> Result<(Vec<String>, SceneFile, Equilibrium), Failure> {
        let (mut places, mut set) = (self.scene.halved_in()?, Vec::new());
        let mut before = None;
        loop {
            let file = self.read(&set)?;
            let mut found = file.equilibrium()?;
            let Some(quantity) = self.quantity(&file)? else { return Ok((set, file, found)) };
            let estimate = MeshEstimate::of(&found, &quantity)?;
            let count = file.scene.body().mesh().node_count();
            if !self.output.quiet {
                let (value, unit) = (estimate.value, &estimate.unit);
                let by = |before: f64| 100.0 * ((value - before) / estimate.change).abs();
                let apart = before.map_or_else(String::new, |before| {
                    format!(", {:.2} % of its change from the one before", by(before))
                });
                // six digits, without zeros at the end
                let rounded = format!("{value:.5e}").parse().unwrap_or(value);
                print(format_args!("{count} nodes: {quantity} is {rounded} {unit}{apart}"))?;
            }
            if count >= nodes {
                found.mesh_estimate = Some(estimate);
                return Ok((set, file, found));
            }
            before = Some(estimate.value);
            let cells = estimate.worst_cells().into_iter().map(|cell| cell as i64 + 1);
            let cells: Vec<toml::Value> = cells.map(toml::Value::Integer).collect();
            places.push(toml::Table::from_iter([("cells".to_owned(), cells.into())]).into());
            set = vec![format!("body.mesh.halved_in={}", toml::Value::Array(places.clone()))];
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let place = arguments.output.place(&arguments.scene.path, "-static");
    without_older(&place, REPORT, run_in(arguments, &place))
}

fn run_in(arguments: &Arguments, place: &Path) -> Result<(), Failure> {
    let Arguments { scene, output, .. } = arguments;
    let file = arguments.read(&[])?;
    let mut directory = Directory::new(place.into())?;
    let quantity = arguments.quantity(&file)?;
    if let Some(quantity) = &quantity {
        MeshEstimate::check(&file.scene, quantity)?;
    }
    let request = &file.output.clone();
    if !file.statics.options.is_curve() && request.formats.iter().any(is_plot) && !output.quiet {
        print("plots are of load curves, as with --load-steps 20: a single equilibrium has none")?;
    }

    let (refined, file, result) = match arguments.refine {
        Some(nodes) => {
            let (set, file, found) = arguments.refined(nodes)?;
            (Some(set), file, Ok(found))
        }
        None => {
            let mut result = file.equilibrium();
            if let (Ok(found), Some(quantity)) = (&mut result, &quantity) {
                found.mesh_estimate = Some(MeshEstimate::of(found, quantity)?);
            }
            (None, file, result)
        }
    };
    let SceneFile { title, statics, .. } = &file;
    let outcome = match &result {
        Ok(equilibrium) => Ok(equilibrium),
        Err(Error::Statics(failure)) => Err(&**failure),
        Err(_) => return result.map(|_| ()).map_err(Failure::from),
    };
    directory.claim()?;
    if let Some(mut set) = refined {
        set.extend(scene.mesh_for(&directory.beside(REFINED))?);
        let text = scene.text(&set)?;
        directory.write(REFINED, |path| {
            fs::write(path, text).map_err(|source| Error::Output { path: path.into(), source })
        })?;
    }
    keep(outcome, statics.options.is_curve(), title, request, &mut directory)?;

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

/// Writes the equilibrium, or the last state of a failed search; all equilibria of a load curve.
pub fn keep(
    outcome: Result<&Equilibrium, &NoEquilibrium>,
    is_curve: bool,
    title: &str,
    request: &OutputRequest,
    directory: &mut Directory,
) -> Result<(), Failure> {
    let trajectory = match outcome {
        Ok(equilibrium) => equilibrium.trajectory(),
        Err(failure) => &failure.trajectory,
    };
    directory.claim()?;
    directory.write(REPORT, |path| write_static_report(outcome, path))?;
    // the states from the undeformed shape to a single equilibrium are not a motion of the body: only
    // pictures show both
    let found = if is_curve { trajectory.clone() } else { trajectory.at_end() };
    directory.write_table(&found, request)?;
    if outcome.is_ok() {
        directory.write_state(trajectory)?;
    }
    // a single state has nothing to plot
    let formats = request.formats.iter().filter(|format| is_curve || !is_plot(format));
    let (files, pictures) = formats.partition(|&&format| format == Format::Vtk);
    for (shown, formats) in [(&found, files), (trajectory, pictures)] {
        directory.write_formats(shown, title, &OutputRequest { formats, ..request.clone() })?;
    }
    Ok(())
}

fn is_plot(format: &Format) -> bool {
    [Format::Plot, Format::Png].contains(format)
}
