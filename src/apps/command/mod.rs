//! The command `pliant`: soft bodies from scene files, without a line of Rust.
//!
//! A program with [devices](crate::Device) of its own has the whole command, with their tables in scene files, reference and
//! schema, by one line:
//!
//! ```text
//! fn main() -> ExitCode {
//!     pliant::command::main_with(&[DeviceTable::of::<Fan>("fan")])
//! }
//! ```
//!
//! The example `own_device` does so.

mod accuracy;
mod advise;
mod beside;
mod chart;
mod check;
mod engine;
mod failure;
mod files;
mod fit;
mod gradient;
mod laws;
mod methods;
mod new;
mod optimize;
#[cfg(feature = "play")]
mod play;
mod plot;
mod progress;
mod reduce;
mod reference;
mod run;
mod scene;
mod schema;
mod settings;
mod shell;
mod statics;
mod sweep;
mod task;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use pliant::{DeviceTable, SceneReader};

use self::failure::Failure;
use self::scene::SceneArguments;

/// Dynamics of soft elastic bodies, from scene files.
///
/// Ends with code 0; 1 if a computation failed or was interrupted (what was computed is kept, and
/// report.json says where and why); 2 for bad input.
#[derive(Parser)]
#[command(version = version())]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// The version, with those of the linked libraries.
fn version() -> String {
    format!("{} ({})", env!("CARGO_PKG_VERSION"), pliant::sundials::description())
}

#[derive(Subcommand)]
enum Command {
    #[command(allow_negative_numbers = true)]
    Run(run::Arguments),
    #[cfg(feature = "play")]
    Play(play::Arguments),
    Static(statics::Arguments),
    Plot(plot::Arguments),
    #[command(allow_negative_numbers = true)]
    Advise(advise::Arguments),
    Beside(beside::Arguments),
    #[command(allow_negative_numbers = true)]
    Fit(fit::Arguments),
    #[command(allow_negative_numbers = true)]
    Gradient(gradient::Arguments),
    #[command(allow_negative_numbers = true)]
    Optimize(optimize::Arguments),
    Reduce(reduce::Arguments),
    Sweep(sweep::Arguments),
    Check(check::Arguments),
    Chart(chart::Arguments),
    Laws(laws::Arguments),
    Methods(methods::Arguments),
    New(new::Arguments),
    Reference(reference::Arguments),
    Schema(schema::Arguments),
}

impl Command {
    /// The scene file that it is about.
    fn scene(&mut self) -> Option<&mut SceneArguments> {
        Some(match self {
            Self::Run(arguments) => &mut arguments.scene,
            #[cfg(feature = "play")]
            Self::Play(arguments) => &mut arguments.scene,
            Self::Static(arguments) => &mut arguments.scene,
            Self::Advise(arguments) => &mut arguments.scene,
            Self::Fit(arguments) => &mut arguments.scene,
            Self::Gradient(arguments) => &mut arguments.scene,
            Self::Optimize(arguments) => &mut arguments.scene,
            Self::Reduce(arguments) => &mut arguments.scene,
            Self::Check(arguments) => &mut arguments.scene,
            Self::Chart(arguments) => &mut arguments.scene,
            _ => return None,
        })
    }
}

/// The command, by the arguments of the process, whose scene files may have these tables of devices. Returns what the process
/// ends with.
pub fn main_with(devices: &[DeviceTable]) -> ExitCode {
    let reader = SceneReader::new(devices);
    let mut command = Cli::parse().command;
    if let Some(scene) = command.scene() {
        scene.reader = reader.clone();
    }
    let result = match command {
        Command::Run(arguments) => run::run(&arguments),
        #[cfg(feature = "play")]
        Command::Play(arguments) => play::run(&arguments),
        Command::Static(arguments) => statics::run(&arguments),
        Command::Plot(arguments) => plot::run(&arguments),
        Command::Advise(arguments) => advise::run(&arguments),
        Command::Beside(arguments) => beside::run(&arguments),
        Command::Fit(arguments) => fit::run(&arguments),
        Command::Gradient(arguments) => gradient::run(&arguments),
        Command::Optimize(arguments) => optimize::run(&arguments),
        Command::Reduce(arguments) => reduce::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments, reader),
        Command::Check(arguments) => check::run(&arguments),
        Command::Chart(arguments) => chart::run(&arguments),
        Command::Laws(arguments) => laws::run(&arguments),
        Command::Methods(arguments) => methods::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Reference(arguments) => reference::run(&arguments, Cli::command(), &reader),
        Command::Schema(arguments) => schema::run(&arguments, &reader),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { code, message }) => {
            // if the standard error is closed, nobody wants the message
            let _ = writeln!(io::stderr(), "pliant: {message}");
            ExitCode::from(code)
        }
    }
}
