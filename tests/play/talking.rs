//! What a page says, and what is answered.

use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use pliant::play::Player;
use pliant::{Sampling, Scene, SceneFile, SceneReader, Settings};
use serde_json::json;
use tungstenite::Message;

use super::client::{Client, apart, places, singles};
use super::{BEAM, Outcome, PATH, served, served_scene};

/// Where the nodes are at the end of a scene that is run as a film.
fn filmed(scene: &Scene, settings: &Settings) -> Result<Vec<[f64; 2]>, pliant::Error> {
    let trajectory = scene.simulate(settings, &Sampling::phase_ends())?;
    let natural = trajectory.body().mesh().positions().chunks_exact(2);
    let moved = natural.zip(trajectory.last().u.chunks_exact(2));
    Ok(moved.map(|(x, u)| [x[0] + u[0], x[1] + u[1]]).collect())
}

/// Places are told in single precision, in a picture of a tenth of a metre; the integrator's error is smaller.
const CLOSE: f64 = 1e-6;

/// Untouched, a scene plays as it runs; a slider changes the motion; and what it did is a scene file, whose run
/// is that motion.
#[test]
fn sliders_move_the_scene_and_are_saved() -> Outcome {
    let file = SceneFile::parse(BEAM, Path::new(PATH))?;
    let mut client = Client::at(&served(|_| {})?)?;
    let nothing = client.answer(Message::text(json!({ "do": "save" }).to_string()))?;
    assert!(
        nothing["error"].as_str().is_some_and(|error| error.contains("no slider")),
        "{nothing}"
    );

    let end = client.play()?;
    assert_eq!(
        (&end["time"], &end["atEnd"], &end["phase"]),
        (&json!(0.1), &json!(true), &json!(1))
    );
    assert_eq!(end["sliders"], json!([500.0, 0.0]));
    assert!(end["steps"].as_u64() > Some(10) && end["colours"]["scale"].as_f64() > Some(0.0));
    let untouched = filmed(&file.scene, &file.settings)?;
    assert!(apart(&places(&end)?, &untouched) < CLOSE);

    client.order(json!({ "do": "start" }))?;
    assert_eq!(client.look()?["time"], 0.0);
    client.order(json!({ "do": "slide", "slider": 0, "value": 4000.0 }))?;
    client.order(json!({ "do": "slide", "slider": 1, "value": -0.5 }))?;
    client.order(json!({ "do": "slide", "slider": 1, "value": 0.25 }))?;
    let end = client.play()?;
    let by_hand = places(&end)?;
    // the next phase is as the file has it
    assert_eq!(end["sliders"], json!([500.0, 0.0]));
    assert!(apart(&by_hand, &untouched) > 1e-4, "{}", apart(&by_hand, &untouched));

    let saved = client.answer(Message::text(json!({ "do": "save" }).to_string()))?;
    let saved = saved["file"].as_str().ok_or_else(|| saved.to_string())?;
    let saved = SceneFile::parse(saved, Path::new(PATH))?;
    let again = filmed(&saved.scene, &saved.settings)?;
    assert!(apart(&by_hand, &again) < CLOSE, "{}", apart(&by_hand, &again));
    Ok(())
}

/// A scene that is played for longer than its file says is saved as it was played.
#[test]
fn the_end_that_was_played_is_saved() -> Outcome {
    let file = SceneFile::parse(BEAM, Path::new(PATH))?;
    let player = Player::new(&file.scene.lasting(0.13), &file.settings, "", 0)?;
    let player = player.saving(BEAM, PATH, &SceneReader::default());
    let address = player.address();
    thread::spawn(move || player.serve());
    let mut client = Client::at(&address)?;
    client.order(json!({ "do": "slide", "slider": 1, "value": 0.25 }))?;
    let by_hand = places(&client.play()?)?;
    let saved = client.answer(Message::text(json!({ "do": "save" }).to_string()))?;
    let saved = saved["file"].as_str().ok_or_else(|| saved.to_string())?;
    assert!(saved.contains("until = 0.05 # s") && saved.contains("until = 0.13"), "{saved}");
    let saved = SceneFile::parse(saved, Path::new(PATH))?;
    assert_eq!(saved.scene.end(), 0.13);
    let again = filmed(&saved.scene, &saved.settings)?;
    assert!(apart(&by_hand, &again) < CLOSE, "{}", apart(&by_hand, &again));
    Ok(())
}

/// A page that vanishes without a word, as a machine that sleeps does, leaves no scene playing: its browser is asked.
#[test]
fn a_page_that_vanished_stops_the_scene() -> Outcome {
    let file = SceneFile::parse(BEAM, Path::new(PATH))?;
    let player = Player::new(&file.scene, &file.settings, "", 0)?;
    let player = player.quiet(Duration::from_secs(2));
    let address = player.address();
    thread::spawn(move || player.serve());
    let mut vanished = Client::at(&address)?;
    // it would take hundreds of seconds
    vanished.order(json!({ "do": "speed", "value": 2e-4 }))?;
    vanished.order(json!({ "do": "play" }))?;
    // its connection stays open, and answers nothing; one page more would keep the scene playing
    thread::sleep(Duration::from_secs(8));
    let mut client = Client::at(&address)?;
    let frame = client.look()?;
    assert_eq!((&frame["playing"], &frame["atEnd"]), (&json!(false), &json!(false)));
    assert!(vanished.look().is_err());
    Ok(())
}

/// The beam with loads in its two phases.
fn loaded([first, second]: [&str; 2]) -> String {
    let with = |until: &str, loads: &str| format!("{until}\nload = [{loads}]");
    BEAM.replace("until = 0.05 # s", &with("until = 0.05", first))
        .replace("until = 0.1", &with("until = 0.1", second))
}

/// Sliders of loads do what tables of a scene file do that are written with the ramp of a slider, 0.005 times 0.1 s;
/// a load in total stays one; what is not touched stays; and it is saved.
#[test]
fn loads_are_moved_by_sliders() -> Outcome {
    let second = "{ nodes = 17, force = [0.0, -0.05] }";
    let own = loaded([
        "{ nodes = \"right\", total = [0.0, -0.03] },
         { nodes = 17, times = [0.01, 0.02], forces = [[0.0, 0.0], [0.02, 0.0]] }",
        second,
    ]);
    let mut client = Client::at(&served_scene(&own, |_| {})?)?;
    assert_eq!(client.look()?["sliders"], json!([0.0, 0.0, 0.0, -0.03, 0.0, 0.0]));
    for (slider, value) in [(2, 0.06), (3, 0.5), (3, 0.03), (5, 0.03)] {
        client.order(json!({ "do": "slide", "slider": slider, "value": value }))?;
    }
    let end = client.play()?;
    assert_eq!(end["sliders"], json!([500.0, 0.0, 0.0, 0.0, 0.0, -0.05]));
    let by_hand = places(&end)?;

    let written = loaded([
        "{ nodes = \"right\", times = [0.0, 0.0005], totals = [[0.0, -0.03], [0.06, 0.03]] },
         { nodes = 17, times = [0.0, 0.0005, 0.01, 0.02],
           forces = [[0.0, 0.0], [0.0, 0.03], [0.0, 0.03], [0.02, 0.03]] }",
        second,
    ]);
    let saved = client.answer(Message::text(json!({ "do": "save" }).to_string()))?;
    let saved = saved["file"].as_str().ok_or_else(|| saved.to_string())?;
    // the second phase was not touched
    assert!(saved.contains(second) && saved.contains("totals = "), "{saved}");
    let end_of = |text: &str| -> Result<_, Box<dyn std::error::Error>> {
        let file = SceneFile::parse(text, Path::new(PATH))?;
        Ok(filmed(&file.scene, &file.settings)?)
    };
    let untouched = apart(&by_hand, &end_of(&own)?);
    assert!(untouched > 1e-4, "{untouched}");
    for text in [&written, saved] {
        let distance = apart(&by_hand, &end_of(text)?);
        assert!(distance < CLOSE, "{distance}: {text}");
    }
    Ok(())
}

/// The energies of the chart, from the start to the end by thousandths of the scene, are those of the scene as it runs.
#[test]
fn the_past_is_told() -> Outcome {
    let file = SceneFile::parse(BEAM, Path::new(PATH))?;
    let mut client = Client::at(&served(|_| {})?)?;
    let end = client.play()?;
    let past = end["past"].as_array().ok_or("no past")?;
    let time_of = |moment: &serde_json::Value| moment[0].as_f64().unwrap_or(f64::NAN);
    let times: Vec<f64> = past.iter().map(time_of).collect();
    assert_eq!((times.first(), times.last()), (Some(&0.0), Some(&0.1)));
    assert!(times.is_sorted_by(|a, b| a < b), "{times:?}");
    let widest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(widest < 1.001e-4, "{widest}");
    let trajectory = file.scene.simulate(&file.settings, &Sampling::phase_ends())?;
    let energy = &trajectory.last().energy;
    let last = &past[past.len() - 1][1];
    for (number, expected) in [energy.kinetic, energy.strain, energy.gravity].iter().enumerate() {
        let found = last[number].as_f64().ok_or("no energy")?;
        assert!((found - expected).abs() < 1e-4 * energy.strain, "{found} {expected}");
    }
    let look = json!({ "do": "look", "since": times[5] }).to_string();
    let later = client.answer(Message::text(look))?["frame"]["past"].take();
    assert_eq!(later.as_array().map(Vec::as_slice), Some(&past[6..]));
    Ok(())
}

/// The beam with sensors.
pub const READ: &str = r#"
[[sensor]]
name = "tip"
kind = "position"
nodes = 33
component = "y"

[[sensor]]
name = "inside"
kind = "pressure"
chamber = "inside"

[[sensor]]
name = "clamp"
kind = "constraint-force"
nodes = "left"
component = "x"
"#;

/// What sensors read over time is what they read of the scene as it runs, from its start to its end, also after going
/// back; and reading leaves the motion alone.
#[test]
fn sensors_are_told() -> Outcome {
    let text = format!("{BEAM}{READ}");
    let file = SceneFile::parse(&text, Path::new(PATH))?;
    let mut client = Client::at(&served_scene(&text, |_| {})?)?;
    let trajectory = file.scene.simulate(&file.settings, &file.output.sampling())?;
    let samples = trajectory.samples();
    for _ in 0..2 {
        let end = client.play()?;
        let past = end["past"].as_array().ok_or("no past")?;
        for (moment, sample) in [(past.first(), samples.first()), (past.last(), samples.last())] {
            let (moment, sample) = (moment.ok_or("no moment")?, sample.ok_or("no sample")?);
            assert_eq!(moment[0], sample.time);
            let read: Vec<f64> = serde_json::from_value(moment[2].clone())?;
            assert_eq!(read.len(), 3);
            for (number, (found, expected)) in read.iter().zip(&sample.sensors).enumerate() {
                // of a tip that moves by mm, a pressure of 500 Pa, a force of some 0.1 N
                let close = [CLOSE, 1e-9, 1e-3][number];
                assert!((found - expected).abs() < close, "{number}: {found} {expected}");
            }
        }
        // the tip is a corner of the picture
        let tip = past[past.len() - 1][2][0].as_f64().ok_or("no tip")?;
        let places = places(&end)?;
        assert!(places.iter().any(|place| (place[1] - tip).abs() < CLOSE), "{tip}");

        let mut unread = Client::at(&served(|_| {})?)?;
        assert_eq!(unread.play()?["places"], end["places"]);
        client.order(json!({ "do": "start" }))?;
    }
    Ok(())
}

/// A node follows the hand, and goes back when it is let go.
#[test]
fn a_hand_pulls() -> Outcome {
    let mut client = Client::at(&served(|_| {})?)?;
    let start = places(&client.look()?)?;
    let right =
        (0..start.len()).max_by(|&a, &b| start[a][0].total_cmp(&start[b][0])).ok_or("none")?;
    let to = [start[right][0], start[right][1] + 0.1];
    let pull = json!({ "do": "pull", "node": right, "to": to, "strength": 1.0 });
    client.order(pull)?;
    let frame = client.play()?;
    assert_eq!(frame["pull"]["node"], right);
    // the pull of a hundred times its weight is stronger than gravity
    let risen = places(&frame)?[right][1] - start[right][1];
    assert!(risen > 2e-3, "{risen}");
    client.order(json!({ "do": "let go" }))?;
    client.order(json!({ "do": "start" }))?;
    let frame = client.play()?;
    assert!(frame["pull"].is_null());
    let sunk = places(&frame)?[right][1] - start[right][1];
    assert!(sunk < 1e-3, "{sunk}");
    Ok(())
}

#[test]
fn what_cannot_be_done_is_said() -> Outcome {
    let mut client = Client::at(&served(|_| {})?)?;
    for (message, part) in [
        ("", "not JSON"),
        ("{\"do\":", "not JSON"),
        ("7", "an object"),
        ("{\"do\": \"dance\"}", "dance"),
        ("{\"do\": \"speed\", \"value\": -1}", "between"),
        ("{\"do\": \"speed\", \"value\": 1e999}", "not JSON"),
        ("{\"do\": \"slide\", \"slider\": 2, \"value\": 1}", "2 sliders"),
        ("{\"do\": \"slide\", \"slider\": 0}", "\"value\""),
        ("{\"do\": \"pull\", \"node\": 99, \"to\": [0, 0], \"strength\": 1}", "no node 99"),
        ("{\"do\": \"pull\", \"node\": 1, \"to\": [0], \"strength\": 1}", "2 coordinates"),
    ] {
        let answer = client.answer(Message::text(message))?;
        let error = answer["error"].as_str().unwrap_or_default();
        assert!(error.contains(part), "{message}: {answer}");
    }
    let answer = client.answer(Message::binary(vec![1, 2, 3]))?;
    assert!(answer["error"].is_string(), "{answer}");
    assert_eq!(client.look()?["time"], 0.0);
    Ok(())
}

/// An integrator that gives up stops the scene where it is, and says why; the start can be had again.
#[test]
fn an_integrator_that_fails_is_heard() -> Outcome {
    let mut client = Client::at(&served(|settings| settings.max_steps = 7)?)?;
    for _ in 0..2 {
        let frame = client.play()?;
        assert!(
            frame["trouble"].as_str().is_some_and(|trouble| trouble.contains("max_steps")),
            "{frame}"
        );
        assert!(frame["time"].as_f64() > Some(0.0) && frame["atEnd"] == false);
        client.order(json!({ "do": "start" }))?;
        let frame = client.look()?;
        assert!(frame["time"] == 0.0 && frame["trouble"].is_null());
    }
    Ok(())
}

/// When the last page is closed, time stops; the next one finds the scene as it was left.
#[test]
fn pages_come_and_go() -> Outcome {
    let address = served(|_| {})?;
    let mut client = Client::at(&address)?;
    client.order(json!({ "do": "speed", "value": 1e-3 }))?;
    client.order(json!({ "do": "play" }))?;
    while client.look()?["time"] == 0.0 {}
    drop(client);
    let mut client = Client::at(&address)?;
    let deadline = Instant::now() + Duration::from_secs(30);
    while client.look()?["playing"] == true {
        assert!(Instant::now() < deadline);
        // it is known that a page is gone as soon as the connection is
        thread::sleep(Duration::from_millis(10));
        drop(std::mem::replace(&mut client, Client::at(&address)?));
    }
    assert!(client.look()?["time"].as_f64() > Some(0.0));
    Ok(())
}

/// Gravity and the field are told as they are, the field after a slider, too; and arrows along the remanence of a magnet, at rest in the middles of its two cells, half of its length apart.
#[test]
fn what_acts_is_told() -> Outcome {
    let scene = r#"
        gravity = [0.0, -9.8]
        [body]
        mesh = { kind = "rectangle", size = [0.1, 0.04], nodes = [3, 2], cells = "rectangles" }
        thickness = 0.01
        material = { density = 1e3, young = 1e6, poisson = 0.3, viscosity = 100.0 }
        [[magnet]]
        remanence = [0.0, 0.1]
        [[phase]]
        until = 0.1
        hold = [{ nodes = "left" }]
        magnetic_field = { field = [0.0, 0.01] }
    "#;
    let mut client = Client::at(&served_scene(scene, |_| {})?)?;
    let frame = client.look()?;
    assert_eq!(frame["everywhere"], json!([[0.0, -9.8], [0.0, 0.01]]));
    let arrows = singles(&frame["remanence"])?;
    let expected = [0.025, 0.02, 0.0, 0.0375, 0.075, 0.02, 0.0, 0.0375];
    assert_eq!(arrows.len(), 8);
    assert!(arrows.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-8), "{arrows:?}");
    client.order(json!({ "do": "slide", "slider": 0, "value": 0.02 }))?;
    assert_eq!(client.play()?["everywhere"], json!([[0.0, -9.8], [0.02, 0.01]]));
    Ok(())
}
