//! Tables.

use std::io::{self, Write};
use std::path::Path;

use super::write_file;
use crate::error::Error;
use crate::mesh::Selection;
use crate::trajectory::{Sample, Trajectory};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Writes one row per sample, after a row with the names of the columns:
///
/// | columns | meaning |
/// | --- | --- |
/// | `t` | time (s) |
/// | `com_x`, ... | centre of mass (m) |
/// | `momentum_x`, ... | momentum (kg m/s) |
/// | `angular_momentum` | about the centre of mass (kg m^2/s), in two dimensions only |
/// | `kinetic`, `strain`, `gravity`, `contact`, `springs` | energies (J) |
/// | `dissipated`, `supplied` | energy turned into heat and energy supplied since t = 0 (J) |
/// | `energy_balance` | kinetic + potential + dissipated - supplied (J), constant but for errors |
/// | `constraint_drift` | largest error of a constraint (m) |
/// | `u<N>_x`, ... | displacement of each tracked node N (m), numbers counted from 1 |
///
/// Numbers have 17 significant digits: read back, they are the very same.
///
/// # Errors
/// [`Error::Input`] if `track` names a node or set that does not exist, before anything is written;
/// [`Error::Output`] if the file cannot be written.
///
/// ```
/// use pliant::output::write_csv;
/// # use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Solver};
/// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// # let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
/// #     .phase(Phase::until(0.01).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("trajectory.csv");
/// let trajectory = scene.simulate(&Solver::default(), &Sampling::every(0.01))?;
/// write_csv(&trajectory, &path, Some(&[14, 15].into()))?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn write_csv(
    trajectory: &Trajectory,
    path: impl AsRef<Path>,
    track: Option<&Selection>,
) -> Result<(), Error> {
    let nodes = match track {
        Some(selection) => trajectory.body().mesh().select(selection)?,
        None => Vec::new(),
    };
    write_file(path.as_ref(), |file| write(trajectory, &nodes, file))
}

fn write(trajectory: &Trajectory, nodes: &[usize], file: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(file);
    table.write_record(header(trajectory, nodes))?;
    for sample in trajectory.samples() {
        table.write_record(row(trajectory, nodes, sample).map(|x| format!("{x:.16e}")))?;
    }
    table.flush()
}

fn header(trajectory: &Trajectory, nodes: &[usize]) -> Vec<String> {
    let axes = &AXES[..trajectory.body().dimension()];
    let vector = |name: String| axes.iter().map(move |axis| format!("{name}_{axis}"));
    let mut names = vec!["t".to_owned()];
    names.extend(vector("com".into()));
    names.extend(vector("momentum".into()));
    if axes.len() == 2 {
        names.push("angular_momentum".into());
    }
    let energies = ["kinetic", "strain", "gravity", "contact", "springs"];
    let balance = ["dissipated", "supplied", "energy_balance", "constraint_drift"];
    names.extend(energies.iter().chain(&balance).map(|&name| name.to_owned()));
    names.extend(nodes.iter().flat_map(|node| vector(format!("u{}", node + 1))));
    names
}

fn row<'a>(
    trajectory: &'a Trajectory,
    nodes: &'a [usize],
    sample: &'a Sample,
) -> impl Iterator<Item = f64> + 'a {
    let (dimension, energy) = (trajectory.body().dimension(), &sample.energy);
    let energies = [energy.kinetic, energy.strain, energy.gravity, energy.contact, energy.springs];
    let balance = [energy.dissipated, energy.supplied, energy.balance(), sample.constraint_drift];
    [sample.time]
        .into_iter()
        .chain(trajectory.centre_of_mass(sample))
        .chain(trajectory.momentum(sample))
        .chain(trajectory.angular_momentum(sample))
        .chain(energies)
        .chain(balance)
        .chain(
            nodes.iter().flat_map(move |node| &sample.u[node * dimension..][..dimension]).copied(),
        )
}
