//! `pliant play`

use std::fs;
use std::path::PathBuf;
use std::process;

use clap::Args;
use pliant::play::Player;
use pliant::{Error, SceneFile};

use crate::failure::{Failure, print};
use crate::settings::SettingsArguments;

/// Play a scene live in the web browser
///
/// Prints the address of a page, which this machine alone can open. On it time goes on and stops as you want,
/// slower or faster; sliders set the pressures of chambers, the forces of actuators and the loads on nodes, and the
/// mouse pulls nodes. The page shows the energies and what the integrator does, and saves what was done by the sliders as a
/// scene file. Flags override the table [solver] of the
/// file. Ctrl-C ends it.
#[derive(Args)]
pub struct Arguments {
    /// Scene file
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Port of the page on this machine; 0 takes any that is free
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    /// End the scene at this time (s); the last phase goes on until then if it would end before
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene: path, settings, port, until } = arguments;
    let mut file = SceneFile::read(path)?;
    let text =
        fs::read_to_string(path).map_err(|source| Error::Read { path: path.clone(), source })?;
    settings.apply(&mut file.settings)?;
    if let Some(end) = *until {
        file.scene = file.scene.lasting(end);
    }
    let player = Player::new(&file.scene, &file.settings, &file.title, *port)?;
    let player = player.saving(text, path);
    // nothing is kept that would have to be saved
    ctrlc::set_handler(|| process::exit(0))
        .map_err(|error| Failure::failed(format!("cannot watch for Ctrl-C: {error}")))?;
    print(format_args!(
        "Open {} in a web browser of this machine. Ctrl-C ends it.",
        player.address()
    ))?;
    player.serve()?;
    Ok(())
}
