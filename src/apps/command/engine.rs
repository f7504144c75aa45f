//! Engines that compute a study elsewhere: task arrays of HyperQueue and of Slurm.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use clap::ValueEnum;

use super::failure::{Failure, print};
use super::shell::{absolute, quoted};
use super::task::array;

/// Who computes the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// The cores of this machine
    Local,
    /// A HyperQueue server: the rows are submitted to it as a task array
    Hyperqueue,
    /// Slurm: a script of an array job is written, to be looked at and given to sbatch
    Slurm,
}

/// A study as a task array.
pub struct TaskArray<'a> {
    /// Study file.
    pub study: &'a Path,
    /// Directory of the rows.
    pub directory: &'a Path,
    /// Tasks that have rows to be computed.
    pub tasks: &'a [usize],
    /// Rows in a task.
    pub batch: usize,
    /// Flags for each task besides these.
    pub flags: &'a [String],
}

/// Time between two looks at a job.
const PATIENCE: Duration = Duration::from_millis(200);

impl TaskArray<'_> {
    /// Submits the tasks to HyperQueue, and waits for them. `watch` is called again and again until they have ended.
    pub fn submit(&self, watch: &mut dyn FnMut()) -> Result<(), Failure> {
        let logs = absolute(self.directory)?.join("tasks");
        let mut command = Command::new("hq");
        command.args(["submit", "--wait", "--name", "pliant-sweep", "--cpus", "1", "--array"]);
        command.arg(array(self.tasks)).args(["--stdout", "none", "--stderr"]);
        command.arg(logs.join("%{TASK_ID}.txt")).arg("--");
        command.args(self.command("env:HQ_TASK_ID")?).stdout(Stdio::null());
        let mut job = command.spawn().map_err(|error| {
            Failure::bad_input(format!(
                "--engine hyperqueue: cannot run hq ({error}): install HyperQueue, start a server (hq server start) and \
                 workers (hq worker start), or use another engine"
            ))
        })?;
        loop {
            let ended = job.try_wait();
            watch();
            match ended.map_err(|error| Failure::failed(format!("cannot wait for hq: {error}")))? {
                Some(status) if status.success() => return Ok(()),
                Some(status) => {
                    return Err(Failure::failed(format!(
                        "hq submit ended with {status}: is a server there (hq server info)? What tasks said is in {}; \
                         give the command again to continue",
                        logs.display()
                    )));
                }
                None => thread::sleep(PATIENCE),
            }
        }
    }

    /// Writes the script of an array job for Slurm, and prints how to submit it. `memory` is that of a run (bytes).
    pub fn write_script(&self, memory: f64) -> Result<(), Failure> {
        let directory = absolute(self.directory)?;
        let [logs, path] = ["tasks", "slurm.sh"].map(|name| directory.join(name));
        let words: Vec<String> = self
            .command("$SLURM_ARRAY_TASK_ID")?
            .iter()
            .map(|word| match word.starts_with("$SLURM") {
                true => format!("\"{word}\""),
                false => quoted(word),
            })
            .collect();
        let mebibytes = 256 + (2.0 * memory / f64::from(1 << 20)) as u64;
        let text = format!(
            "#!/bin/sh\n#SBATCH --job-name=pliant-sweep\n#SBATCH --array={}\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n\
             #SBATCH --mem={mebibytes}M\n#SBATCH --output={}\n\nexec {}\n",
            array(self.tasks),
            quoted(&logs.join("%a.txt").to_string_lossy()),
            words.join(" ")
        );
        let failed =
            |error| Failure::failed(format!("cannot write to {}: {error}", path.display()));
        fs::create_dir_all(&logs).map_err(failed)?;
        fs::write(&path, text).map_err(failed)?;
        print(format_args!(
            "written: {}: {} tasks of up to {} rows. Look at it, give it to sbatch, and when it has ended: pliant sweep {} \
             --gather --out {}",
            path.display(),
            self.tasks.len(),
            self.batch,
            self.study.display(),
            self.directory.display()
        ))
    }

    /// The command that computes the task `task`.
    fn command(&self, task: &str) -> Result<Vec<String>, Failure> {
        let own = env::current_exe()
            .map_err(|error| Failure::failed(format!("cannot find the command pliant: {error}")))?;
        let text = |path: PathBuf| path.to_string_lossy().into_owned();
        let [study, directory] = [self.study, self.directory].map(absolute);
        let (study, directory) = (text(study?), text(directory?));
        let batch = self.batch.to_string();
        let words =
            [&text(own), "sweep", &study, "--task", task, "--batch", &batch, "--out", &directory];
        let words = words.into_iter().map(String::from).chain(["--quiet".into()]);
        Ok(words.chain(self.flags.iter().cloned()).collect())
    }
}
