//! `pliant play`: who is let in, what is answered, and the page in a real browser.
//!
//! The browser needs Debian's package `chromium`.

// its other users need what these tests do not
#[allow(dead_code)]
#[path = "../animation/browser.rs"]
mod browser;
mod browsing;
mod client;
mod door;
mod talking;

use std::error::Error;
use std::path::Path;
use std::thread;

use pliant::play::Player;
use pliant::{SceneFile, SceneReader, Settings};

type Outcome = Result<(), Box<dyn Error>>;

/// A clamped beam of soft rubber with a chamber and a spring that can be actuated.
const BEAM: &str = r#"title = "A beam <b>by hand</b>"
gravity = [0.0, -9.8]

[body]
mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [11, 3], cells = "rectangles" }
thickness = 0.01
strain = "green"
material = { density = 1000.0, young = 1.0e6, poisson = 0.48, viscosity = 40.0 }

[[spring]]
name = "tendon"
ends = [11, 23]
stiffness = 20.0

[[chamber]]
name = "inside"
nodes = [1, 11, 33, 23]

[[phase]]
name = "first"
until = 0.05 # s
hold = [{ nodes = "left" }]

[[phase]]
name = "second"
until = 0.1
hold = [{ nodes = "left" }]
pressure = [{ chamber = "inside", value = 500.0 }]

[solver]
rtol = 1e-7
"#;

/// Where the beam is said to have been read from.
const PATH: &str = "beam.toml";

/// The beam with other settings, served by a thread that ends with the tests; the address of its page.
fn served(change: impl FnOnce(&mut Settings)) -> Result<String, Box<dyn Error>> {
    served_scene(BEAM, change)
}

/// The same with any scene file.
fn served_scene(text: &str, change: impl FnOnce(&mut Settings)) -> Result<String, Box<dyn Error>> {
    let mut file = SceneFile::parse(text, Path::new(PATH))?;
    change(&mut file.settings);
    let player = Player::new(&file.scene, &file.settings, &file.title, 0)?;
    let player =
        player.sensors(&file.output.sampling())?.saving(text, PATH, &SceneReader::default());
    let address = player.address();
    thread::spawn(move || player.serve());
    Ok(address)
}
