//! `pliant play`

use std::iter;
use std::path::PathBuf;
use std::process;

use clap::Args;
use pliant::OutputRequest;
use pliant::play::Player;

use super::failure::{Failure, print};
use super::scene::SceneArguments;
use super::settings::SettingsArguments;

/// Play a scene live in the web browser
///
/// Prints the address of a page, which this machine alone can open. On it time goes on and stops as you want,
/// slower or faster; sliders set the pressures of chambers, valves, the forces of actuators and the loads on nodes,
/// and the mouse pulls nodes. The page shows the energies, what sensors read and what the integrator does, and saves what was done
/// by the sliders as a scene file, which has the values of --set in it. Flags override the table [solver] of the
/// file. Ctrl-C ends it.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Play it by this reduced model, a file of `pliant reduce`, in place of that of the scene file
    #[arg(long, value_name = "FILE")]
    reduced: Option<PathBuf>,
    /// Port of the page on this machine; 0 takes any that is free
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    /// End the scene at this time (s); the last phase goes on until then if it would end before
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, settings, reduced, port, until } = arguments;
    let (mut file, text) = (scene.read_reduced(reduced.as_deref())?, scene.text(&[])?);
    settings.apply(&mut file.settings)?;
    if let Some(end) = *until {
        file.scene = file.scene.lasting(end);
    }
    // a smaller model is not all that the file says
    let said = iter::once(file.title.clone()).chain(file.smaller.iter().map(ToString::to_string));
    let said: Vec<String> = said.filter(|part| !part.is_empty()).collect();
    let player = Player::new(&file.scene, &file.settings, &said.join(", "), *port)?;
    // sensors are read as often as the energies, whatever output times the file has
    let sensors = OutputRequest { step: None, times: None, ..file.output }.sampling();
    let mut player = player.sensors(&sensors)?;
    // nodes of a smaller model are no nodes of the file
    if file.smaller.is_empty() {
        player = player.saving(text, &scene.path, &scene.reader);
    }
    // there is nothing that would have to be saved first
    ctrlc::set_handler(|| process::exit(0))
        .map_err(|error| Failure::failed(format!("cannot watch for Ctrl-C: {error}")))?;
    print(format_args!(
        "Open {} in a web browser of this machine. Ctrl-C ends it.",
        player.address()
    ))?;
    player.serve()?;
    Ok(())
}
