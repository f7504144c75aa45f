//! The command of a program with a device of its own: this file is that program, if a variable of the environment says so, and
//! otherwise the tests that run it.

#[path = "../examples/own_device/jet.rs"]
mod jet;

use std::env;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Output};

use jet::Jet;
use pliant::{DeviceTable, SceneReader};

/// With this variable the process is the command.
const AS_COMMAND: &str = "PLIANT_TEST_AS_COMMAND";

fn tables() -> [DeviceTable; 1] {
    [DeviceTable::of::<Jet>("jet").described(Jet::ABOUT, &Jet::KEYS)]
}

fn main() -> ExitCode {
    if env::var_os(AS_COMMAND).is_some() {
        return pliant::command::main_with(&tables());
    }
    let place = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/own_device/scene.toml");
    let text = fs::read_to_string(scene).unwrap();
    fs::write(place.path().join("scene.toml"), text.replace("until = 2.0", "until = 0.2")).unwrap();
    println!("running the tests of a command with a device of its own");
    the_command_of_the_crate_refuses_the_table(place.path());
    scenes_are_checked_and_described(place.path());
    a_run_is_that_of_the_library(place.path());
    an_equilibrium_has_the_thrust(place.path());
    keys_of_the_table_are_varied(place.path());
    ExitCode::SUCCESS
}

fn output(program: &Path, place: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(program);
    command.args(arguments).env(AS_COMMAND, "1").current_dir(place).output().unwrap()
}

/// The output of the own command, which succeeds.
fn own(place: &Path, arguments: &[&str]) -> String {
    let output = output(&env::current_exe().unwrap(), place, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn the_command_of_the_crate_refuses_the_table(place: &Path) {
    let refused = output(Path::new(env!("CARGO_BIN_EXE_pliant")), place, &["check", "scene.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("jet"), "{refused:?}");
}

fn scenes_are_checked_and_described(place: &Path) {
    assert!(own(place, &["check", "scene.toml"]).contains("tail"));
    let schema: serde_json::Value = serde_json::from_str(&own(place, &["schema"])).unwrap();
    let keys = &schema["properties"]["jet"]["anyOf"][0]["properties"];
    assert!(keys["nozzle"]["description"].as_str().unwrap().contains("pushes"), "{keys}");
    let reference = own(place, &["reference"]);
    assert!(reference.contains("### `[[jet]]`\n\nA jet in the plane"), "no [[jet]]");
    assert!(reference.contains("| `nozzle` |"), "no nozzle");
}

/// The last row of the command's table has the readings of a run by the library, with all digits that the table has.
fn a_run_is_that_of_the_library(place: &Path) {
    own(place, &["run", "scene.toml", "--out", "run", "--quiet"]);
    let table = fs::read_to_string(place.join("run/trajectory.csv")).unwrap();
    let last: Vec<f64> =
        table.lines().last().unwrap().split(',').map(|x| x.parse().unwrap()).collect();
    let file = SceneReader::new(&tables()).read_with(place.join("scene.toml"), &[]).unwrap();
    let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    let sensors = &motion.last().sensors;
    println!("command {last:?}, library {sensors:?}");
    assert!(sensors[2].abs() > 1e-9, "the jet does no work: {sensors:?}");
    for reading in sensors {
        let is_it = |number: &f64| (number - reading).abs() <= 1e-12 * reading.abs();
        assert!(last.iter().any(is_it), "{reading} is not in {last:?}");
    }
}

/// The state that is written is the equilibrium that the library finds.
fn an_equilibrium_has_the_thrust(place: &Path) {
    own(place, &["static", "scene.toml", "--out", "static", "--quiet"]);
    let file = SceneReader::new(&tables()).read_with(place.join("scene.toml"), &[]).unwrap();
    let rest = file.equilibrium().unwrap();
    let most = rest.displacements().iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let state = fs::read_to_string(place.join("static/state.json")).unwrap();
    let written = state.split(['[', ']', ',', ':', '{', '}', ' ', '\n']);
    let written: Vec<f64> = written.filter_map(|word| word.parse().ok()).collect();
    println!("displaced by up to {most} m");
    assert!(most > 1e-4, "the jet does not act: {most}");
    assert!(written.iter().any(|number| (number.abs() - most).abs() <= 1e-12 * most), "no {most}");
}

/// A sweep over the nozzle: a jet on one corner moves the tip in another way than one on the whole end.
fn keys_of_the_table_are_varied(place: &Path) {
    let study = "scene = \"scene.toml\"\nquantities = [\"tip.y:end\"]\n\n[[key]]\nname = \"jet.1.nozzle\"\nvalues = [\"right\", \"top\"]\n";
    fs::write(place.join("study.toml"), study).unwrap();
    own(place, &["sweep", "study.toml", "--out", "sweep", "--quiet"]);
    let table = fs::read_to_string(place.join("sweep/table.csv")).unwrap();
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let tip = rows.headers().unwrap().iter().position(|head| head.starts_with("tip.y")).unwrap();
    let found: Vec<f64> = rows.records().map(|row| row.unwrap()[tip].parse().unwrap()).collect();
    println!("tip by nozzle: {found:?}");
    assert!(found.len() == 2 && found[0] != found[1], "{found:?}");
}
