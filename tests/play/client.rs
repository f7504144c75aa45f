//! A page without a browser.

use std::error::Error;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// What a busy machine may take.
const PATIENCE: Duration = Duration::from_secs(60);

pub struct Client(WebSocket<TcpStream>);

impl Client {
    /// The conversation of the page at `address`, as a page of `origin` begins it.
    pub fn of(address: &str, origin: &str) -> Result<Self> {
        let rest = address.strip_prefix("http://").ok_or("no address")?;
        let host = rest.split('/').next().ok_or("no host")?;
        let mut request = format!("ws://{rest}socket").into_client_request()?;
        request.headers_mut().insert("origin", origin.parse()?);
        let stream = TcpStream::connect(host)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        let (socket, _) =
            tungstenite::client(request, stream).map_err(|error| error.to_string())?;
        Ok(Self(socket))
    }

    /// The same, as our own page does it.
    pub fn at(address: &str) -> Result<Self> {
        Self::of(address, address.rsplitn(3, '/').last().ok_or("no origin")?)
    }

    /// The answer to any message.
    pub fn answer(&mut self, message: Message) -> Result<Value> {
        self.0.send(message)?;
        loop {
            // whether it is still there, a page is asked by pings
            let answer = self.0.read()?;
            if answer.is_text() {
                return Ok(serde_json::from_str(answer.to_text()?)?);
            }
        }
    }

    /// Has something done.
    pub fn order(&mut self, message: Value) -> Result<()> {
        match self.answer(Message::text(message.to_string()))? {
            answer if answer["done"] == true => Ok(()),
            answer => Err(format!("{message} is answered by {answer}").into()),
        }
    }

    pub fn look(&mut self) -> Result<Value> {
        let look = json!({ "do": "look", "colours": 0 }).to_string();
        Ok(self.answer(Message::text(look))?["frame"].take())
    }

    /// Plays as fast as can be until it stops by itself; the last that is seen.
    pub fn play(&mut self) -> Result<Value> {
        self.order(json!({ "do": "speed", "value": 100.0 }))?;
        self.order(json!({ "do": "play" }))?;
        let deadline = Instant::now() + PATIENCE;
        loop {
            let frame = self.look()?;
            if frame["playing"] == false {
                return Ok(frame);
            }
            if Instant::now() > deadline {
                return Err("it plays without end".into());
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

/// Positions of the nodes (m), of a mesh that is drawn in the order of its cells.
pub fn places(frame: &Value) -> Result<Vec<[f64; 2]>> {
    Ok(singles(&frame["places"])?.as_chunks::<2>().0.to_vec())
}

/// Numbers in single precision.
pub fn singles(packed: &Value) -> Result<Vec<f64>> {
    let bytes = STANDARD.decode(packed.as_str().ok_or("no text")?)?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|&four| f32::from_le_bytes(four).into()).collect())
}

/// Largest distance between places and positions, each with the nearest.
pub fn apart(places: &[[f64; 2]], positions: &[[f64; 2]]) -> f64 {
    let distance = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let nearest = |place| {
        positions.iter().map(|position| distance(place, position)).fold(f64::INFINITY, f64::min)
    };
    places.iter().map(nearest).fold(0.0, f64::max)
}
