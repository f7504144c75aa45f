//! The progress bar of a run, and Ctrl-C, SIGTERM and SIGHUP.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pliant::simulate::Simulation;

use super::failure::Failure;

/// Watches a run: shows how far it has come, and stops it when Ctrl-C was pressed.
pub struct RunProgress {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
    /// Whether steps are being taken: before and after that, Ctrl-C has nothing to wait for.
    stepping: Arc<AtomicBool>,
    /// End of the scene (s).
    end: f64,
    /// When the bar was drawn last.
    drawn: Instant,
    /// The notice that was shown last.
    noticed: Option<String>,
}

/// Parts into which the bar divides the time of the scene.
const PARTS: f64 = 1e4;
/// Time between two updates of the bar.
const PERIOD: Duration = Duration::from_millis(100);
/// Exit code after the second Ctrl-C, or one outside of steps: shells report it for programs ended by Ctrl-C.
pub const KILLED: i32 = 130;

impl RunProgress {
    /// Watches a run up to time `end` (s). The bar is drawn on a terminal only, and not if `quiet`.
    pub fn new(end: f64, quiet: bool) -> Result<Self, Failure> {
        let target = match quiet {
            true => ProgressDrawTarget::hidden(),
            false => ProgressDrawTarget::stderr(),
        };
        let bar = ProgressBar::with_draw_target(Some(PARTS as u64), target);
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %, {msg}, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));

        let interrupted = Arc::new(AtomicBool::new(false));
        let stepping = Arc::new(AtomicBool::new(false));
        let (asked, waits, shown) = (interrupted.clone(), stepping.clone(), bar.clone());
        let stop = move || {
            if asked.swap(true, Ordering::Relaxed) || !waits.load(Ordering::Relaxed) {
                process::exit(KILLED);
            }
            shown.suspend(|| {
                let note = "pliant: stopping after this step, then writing the results so far; \
                            press again to end at once";
                let _ = writeln!(io::stderr(), "{note}");
            });
        };
        ctrlc::set_handler(stop)
            .map_err(|error| Failure::failed(format!("cannot watch for Ctrl-C: {error}")))?;
        Ok(Self { bar, interrupted, stepping, end, drawn: Instant::now(), noticed: None })
    }

    /// Called before the directory is made: from then on Ctrl-C waits for the step under way.
    pub fn start(&self) {
        self.stepping.store(true, Ordering::Relaxed);
    }

    /// Called after each step; stops the run after Ctrl-C.
    pub fn see(&mut self, simulation: &Simulation) -> ControlFlow<()> {
        self.start();
        if self.interrupted.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        let notice = simulation.notice();
        if notice != self.noticed.as_deref() {
            self.noticed = notice.map(str::to_owned);
            if let Some(notice) = notice {
                let phase = simulation.phase();
                self.bar.suspend(|| {
                    let _ = writeln!(io::stderr(), "pliant: WARNING: phase \"{phase}\": {notice}");
                });
            }
        }
        if self.drawn.elapsed() > PERIOD && !self.bar.is_hidden() {
            let (time, name) = (simulation.time(), simulation.phase());
            let (step, order) = simulation.last_step();
            self.bar.set_position((PARTS * time / self.end) as u64);
            let end = self.end;
            self.bar.set_message(format!(
                "{name}: t = {time:.4} of {end} s, step {step:.1e} s, order {order}"
            ));
            self.drawn = Instant::now();
        }
        ControlFlow::Continue(())
    }

    /// Removes the bar.
    pub fn finish(self) {
        self.stepping.store(false, Ordering::Relaxed);
        self.bar.finish_and_clear();
    }
}

/// A spinner with the present trial, on a terminal only.
pub fn spinner(quiet: bool) -> ProgressBar {
    let target = match quiet {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr(),
    };
    let bar = ProgressBar::with_draw_target(None, target);
    let style = ProgressStyle::with_template("{elapsed}, {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar
}

/// Shows how many of so many rows are there, and how much time is left, on a terminal only.
pub fn rows_bar(count: usize, quiet: bool) -> ProgressBar {
    let target = match quiet {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr(),
    };
    let bar = ProgressBar::with_draw_target(Some(count as u64), target);
    let style = ProgressStyle::with_template("{bar:30} {pos} of {len} rows, {msg}, {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.set_message("0 failed");
    bar
}
