//! Messages of the page.

use serde_json::{Map, Value};

/// A message of the page.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Message {
    /// Requests the present frame, with the colours of a quantity, and the past since a time (s).
    Look {
        colours: Option<usize>,
        since: Option<f64>,
    },
    Play,
    Pause,
    /// Back to the start.
    Start,
    /// Simulated seconds per second.
    Speed(f64),
    /// A slider, counted from 0, and its value (Pa, N).
    Slide(usize, f64),
    /// A drawn node is pulled towards a point (m), `strength` times as hard as usual.
    Pull {
        place: usize,
        to: Vec<f64>,
        strength: f64,
    },
    LetGo,
    /// The scene with the recorded slider moves.
    Save,
}

/// Allowed speeds, and strengths of a pull.
const SPEEDS: [f64; 2] = [1e-9, 1e9];
const STRENGTHS: [f64; 2] = [1e-3, 1e3];

impl Message {
    /// Reads a message.
    ///
    /// # Errors
    /// The mistake in an invalid message.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let value: Value =
            serde_json::from_str(text).map_err(|error| format!("this is not JSON: {error}"))?;
        let message = value.as_object().ok_or("a message is an object with the key \"do\"")?;
        let what = message.get("do").and_then(Value::as_str);
        match what.ok_or("a message needs the key \"do\", a text")? {
            "look" => Ok(Self::Look {
                colours: whole(message, "colours").ok(),
                since: number(message, "since").ok(),
            }),
            "play" => Ok(Self::Play),
            "pause" => Ok(Self::Pause),
            "start" => Ok(Self::Start),
            "speed" => Ok(Self::Speed(within(message, "value", SPEEDS)?)),
            "slide" => Ok(Self::Slide(whole(message, "slider")?, number(message, "value")?)),
            "pull" => Ok(Self::Pull {
                place: whole(message, "node")?,
                to: numbers(message, "to")?,
                strength: within(message, "strength", STRENGTHS)?,
            }),
            "let go" => Ok(Self::LetGo),
            "save" => Ok(Self::Save),
            other => Err(format!("nothing is known how to do \"{other}\"")),
        }
    }
}

fn number(message: &Map<String, Value>, key: &str) -> Result<f64, String> {
    // numbers of JSON are finite
    let number = message.get(key).and_then(Value::as_f64);
    number.ok_or_else(|| format!("it needs \"{key}\", a number"))
}

fn within(message: &Map<String, Value>, key: &str, [least, most]: [f64; 2]) -> Result<f64, String> {
    let number = number(message, key)?;
    match (least..=most).contains(&number) {
        true => Ok(number),
        false => Err(format!("\"{key}\" = {number} must lie between {least:e} and {most:e}")),
    }
}

fn whole(message: &Map<String, Value>, key: &str) -> Result<usize, String> {
    let number = message.get(key).and_then(Value::as_u64);
    number
        .and_then(|number| usize::try_from(number).ok())
        .ok_or_else(|| format!("it needs \"{key}\", a whole number from 0"))
}

fn numbers(message: &Map<String, Value>, key: &str) -> Result<Vec<f64>, String> {
    let wrong = || format!("it needs \"{key}\", a list of numbers");
    let list = message.get(key).and_then(Value::as_array).ok_or_else(wrong)?;
    list.iter().map(|x| x.as_f64().ok_or_else(wrong)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_with_a_message_is_said() {
        for (text, part) in [
            ("", "not JSON"),
            ("[", "not JSON"),
            ("[1]", "an object"),
            ("{}", "needs the key \"do\""),
            (r#"{"do": 1}"#, "needs the key \"do\""),
            (r#"{"do": "dance"}"#, "\"dance\""),
            (r#"{"do": "speed"}"#, "\"value\""),
            (r#"{"do": "speed", "value": 0}"#, "between"),
            (r#"{"do": "slide", "value": 1}"#, "\"slider\""),
            (r#"{"do": "slide", "slider": 0, "value": "1"}"#, "\"value\""),
            (r#"{"do": "pull", "node": -1}"#, "\"node\""),
            (r#"{"do": "pull", "node": 1, "to": [1, null], "strength": 1}"#, "\"to\""),
        ] {
            let error = Message::parse(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
        let pull = r#"{"do": "pull", "node": 1, "to": [1, 2.5], "strength": 2}"#;
        let expected = Message::Pull { place: 1, to: vec![1.0, 2.5], strength: 2.0 };
        assert_eq!(Message::parse(pull), Ok(expected));
    }
}
