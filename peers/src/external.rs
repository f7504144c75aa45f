//! Peers that are programs of their own.
//!
//! Each is called with: case, `consistent` or `lumped`, method, setting, folder of the exported
//! case, file of the times, file for the displacements. (Systems of equations: name, method, rtol, file of atol,
//! file for the state at the end.) It writes these as double precision numbers, time by
//! time, and prints one line: processor time (s), steps, evaluations of the forces,
//! factorizations (-1 for what it does not know). A failure is a line that begins with "failed:".

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use pliant::study::Failed;
use pliant::{Inertia, Scene, Settings};

use pliant_peers::motion::{GaveUp, Solved};
use pliant_peers::scenes::Case;
use pliant_peers::stage::Stage;

/// A program, and the method that it is asked for.
#[derive(Debug, Clone)]
pub struct Program {
    pub command: Vec<String>,
    pub method: &'static str,
    /// How many times the limit of the others it may take.
    pub patience: f64,
}

/// Everything that a program gets to know.
pub struct Task<'a> {
    pub case: &'a Case,
    pub inertia: Inertia,
    pub setting: f64,
    /// Folder of the exported case, which also takes the displacements.
    pub folder: &'a Path,
    pub times: usize,
    pub dofs: usize,
    /// Processor time (s), repetitions included.
    pub limit: f64,
}

/// Processor time (s) that starting an interpreter may take.
const START: f64 = 2.0;

/// Processor time (s) of a child; where the system does not tell, time by the clock on the wall.
fn processor_time(child: &Child, clock: Instant) -> f64 {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks: Vec<f64> = after_name
        .split_whitespace()
        .skip(11)
        .take(2)
        .filter_map(|word| word.parse().ok())
        .collect();
    match ticks[..] {
        [user, system] => (user + system) / TICKS_PER_SECOND,
        _ => clock.elapsed().as_secs_f64(),
    }
}

fn gave_up(error: impl std::fmt::Display) -> GaveUp {
    GaveUp(error.to_string())
}

impl Program {
    /// Runs the program on a case.
    ///
    /// # Errors
    /// Why there is no result.
    pub fn solve(&self, task: &Task) -> Result<Solved, GaveUp> {
        let out = task.folder.join("displacements");
        let inertia = match task.inertia {
            Inertia::Consistent => "consistent",
            Inertia::Lumped => "lumped",
        };
        let setting = task.setting.to_string();
        let arguments = [task.case.name, inertia, self.method, &setting].map(OsStr::new);
        let times = task.folder.join("times");
        let files = [task.folder.as_os_str(), times.as_os_str()];
        self.call(arguments.into_iter().chain(files), &out, task.times * task.dofs, task.limit)
    }

    /// Runs the program, which writes so many numbers to `out`, and may take this processor time (s).
    ///
    /// # Errors
    /// Why there is no result.
    pub fn call<'a>(
        &self,
        arguments: impl Iterator<Item = &'a OsStr>,
        out: &Path,
        count: usize,
        limit: f64,
    ) -> Result<Solved, GaveUp> {
        let _ = fs::remove_file(out);
        let mut child = Command::new(&self.command[0])
            .args(&self.command[1..])
            .args(arguments)
            .arg(out)
            .envs(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"].map(|name| (name, "1")))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| GaveUp(format!("{}: {error}", self.command[0])))?;
        let clock = Instant::now();
        let allowed = self.patience * limit;
        let status = loop {
            match child.try_wait().map_err(gave_up)? {
                Some(status) => break status,
                None if processor_time(&child, clock) > allowed + START => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return Err(GaveUp::timeout(allowed));
                }
                None => sleep(Duration::from_millis(5)),
            }
        };
        let mut text = String::new();
        if let Some(mut pipe) = child.stdout.take() {
            pipe.read_to_string(&mut text).map_err(gave_up)?;
        }
        let last = text.lines().last().unwrap_or("").trim();
        if !status.success() || last.starts_with("failed") {
            let mut trouble = String::new();
            if let Some(mut pipe) = child.stderr.take() {
                pipe.read_to_string(&mut trouble).map_err(gave_up)?;
            }
            let reason = if last.is_empty() { trouble.lines().last().unwrap_or("") } else { last };
            return Err(GaveUp(reason.trim_start_matches("failed: ").into()));
        }
        let numbers: Vec<f64> =
            last.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let [seconds, steps, evaluations, factorizations] = numbers[..] else {
            return Err(GaveUp(format!("it said: {last}")));
        };
        let bytes = fs::read(out).map_err(gave_up)?;
        let u: Vec<f64> = bytes.as_chunks().0.iter().map(|x| f64::from_le_bytes(*x)).collect();
        if u.len() != count {
            return Err(GaveUp(format!("{} numbers, not {count}", u.len())));
        }
        let [steps, evaluations, factorizations] =
            [steps, evaluations, factorizations].map(|count| count.max(0.0) as usize);
        Ok(Solved { u, seconds, steps, evaluations, factorizations })
    }
}

/// Writes the case into a folder, for programs that do not call pliant: nodes, cells (numbers
/// from 1), the entries of M (one number per pair of nodes), nodes that may touch the floor, what
/// is held when, numbers of the material.
///
/// # Errors
/// Files that cannot be written.
pub fn export(
    case: &Case,
    scene: &Scene,
    times: &[f64],
    folder: PathBuf,
) -> Result<PathBuf, Failed> {
    fs::create_dir_all(&folder)?;
    let file = |name: &str| File::create(folder.join(name)).map(BufWriter::new);
    let (body, mesh) = (scene.body(), scene.body().mesh());
    let mut nodes = file("nodes")?;
    for node in 0..mesh.node_count() {
        let position = mesh.position(node);
        writeln!(nodes, "{:.17e} {:.17e}", position[0], position[1])?;
    }
    let mut cells = file("cells")?;
    for cell in mesh.cells() {
        writeln!(cells, "{} {} {}", cell[0] + 1, cell[1] + 1, cell[2] + 1)?;
    }
    let (mut masses, inertia) = (file("masses")?, body.inertia());
    for row in 0..mesh.node_count() {
        for (entry, column) in inertia.pattern().row(row) {
            writeln!(masses, "{} {} {:.17e}", row + 1, column + 1, inertia.values()[entry])?;
        }
    }
    let mut boundary = file("boundary")?;
    for node in mesh.boundary_nodes() {
        writeln!(boundary, "{}", node + 1)?;
    }
    // phase, component (from 1), velocity
    let (mut held, mut phases) = (file("held")?, file("phases")?);
    let mut u = vec![0.0; body.dofs()];
    let rest = u.clone();
    for (number, phase) in scene.phases().iter().enumerate() {
        let floor = if number == 2 { case.floor } else { 0.0 };
        writeln!(phases, "{:.17e} {floor:e}", phase.end())?;
        let start = number.checked_sub(1).map_or(0.0, |before| scene.phases()[before].end());
        for (dof, velocity) in Stage::new(scene, number, &u, &rest)?.paths() {
            writeln!(held, "{} {} {velocity:e}", number + 1, dof + 1)?;
            u[dof] += velocity * (phase.end() - start);
        }
    }
    let (elastic, viscous) = (body.material().elastic(), body.material().viscous());
    let gravity = scene.acceleration().map_or([0.0; 2], |g| [g[0], g[1]]);
    let is_green = u8::from(body.strain() == pliant::Strain::Green);
    let unit = Settings { rtol: 1e-3, ..Settings::default() }.tolerances(scene);
    let thickness = body.volume() / area(scene);
    // lambda, mu, their viscous counterparts, thickness, gravity, Green?, alpha, atol / rtol
    writeln!(
        file("numbers")?,
        "{:.17e} {:.17e} {:.17e} {:.17e} {thickness:.17e} {:e} {:e} {is_green} {:e} {:e} {:e}",
        elastic.lambda,
        elastic.mu,
        viscous.lambda,
        viscous.mu,
        gravity[0],
        gravity[1],
        Settings::default().alpha,
        unit.position / 1e-3,
        unit.velocity / 1e-3,
    )?;
    let mut list = file("times")?;
    for time in times {
        writeln!(list, "{time:.17e}")?;
    }
    Ok(folder)
}

/// Area of all cells (m^2).
fn area(scene: &Scene) -> f64 {
    let mesh = scene.body().mesh();
    let of = |cell: &[usize]| {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.position(cell[k]));
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    };
    mesh.cells().map(of).sum()
}
