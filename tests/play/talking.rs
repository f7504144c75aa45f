//! What a page says, and what is answered.

use std::path::Path;

use pliant::{Sampling, Scene, SceneFile, Settings};
use serde_json::json;
use tungstenite::Message;

use super::client::{Client, apart, places};
use super::{BEAM, Outcome, PATH, served};

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
    client.order(json!({ "do": "pressure", "name": "inside", "value": 4000.0 }))?;
    client.order(json!({ "do": "actuate", "name": "tendon", "value": -0.5 }))?;
    client.order(json!({ "do": "actuate", "name": "tendon", "value": 0.25 }))?;
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
        ("{\"do\": \"pressure\", \"name\": \"outside\", \"value\": 1}", "[\"inside\"]"),
        ("{\"do\": \"actuate\", \"name\": \"x\", \"value\": 1}", "[\"tendon\"]"),
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
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(30);
    while client.look()?["playing"] == true {
        assert!(std::time::Instant::now() < deadline);
        // it is known that a page is gone as soon as the connection is
        std::thread::sleep(std::time::Duration::from_millis(10));
        drop(std::mem::replace(&mut client, Client::at(&address)?));
    }
    assert!(client.look()?["time"].as_f64() > Some(0.0));
    Ok(())
}
