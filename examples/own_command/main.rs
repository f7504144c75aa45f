//! The command `pliant` with a device of one's own: scene files may have `[[jet]]`.
//!
//! `cargo run --release --example own_command -- run examples/own_device/scene.toml`
//!
//! What to look for: `main` is one line. All of the command has the jet by it: `check`, `run`, `static`, `play` with sliders for
//! its thrust and angle, `sweep` over keys as `jet.tail.nozzle`, `reference` and `schema`.

#[path = "../own_device/jet.rs"]
mod jet;

use std::process::ExitCode;

use jet::Jet;
use pliant::DeviceTable;

fn main() -> ExitCode {
    pliant::command::main_with(&[DeviceTable::of::<Jet>("jet").described(Jet::ABOUT, &Jet::KEYS)])
}
