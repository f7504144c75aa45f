//! The server of the page, on the loopback interface.

use std::io::{self, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;

use serde_json::Value;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message as Parcel, WebSocket};

use super::door::{AccessToken, Route};
use super::http::{Head, Refusal, answer};
use super::message::Message;
use super::record::Original;
use super::session::{Request, Session, error_answer};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::io::output::Picture;
use crate::io::scene_file::SceneReader;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

const PAGE: &str = include_str!("page/play.html");
const STYLE: &str = include_str!("page/play.css");
const SCRIPTS: [&str; 2] = [include_str!("page/live.js"), include_str!("page/play.js")];

/// Connections at the same time.
const MOST: usize = 32;
/// The longest message of a page (bytes).
const LONGEST: usize = 64 * 1024;
/// How long a browser may take to accept an answer.
const PATIENCE: Duration = Duration::from_secs(20);
/// Default of [`Player::quiet`].
const QUIET: Duration = Duration::from_secs(10);
/// Pause after a connection that could not be accepted.
const RECOVERY: Duration = Duration::from_millis(50);

/// A scene that is played in a web browser on this machine.
///
/// A person starts and stops time, sets pressures, valves, forces of actuators and loads by sliders, and pulls
/// nodes with the mouse.
///
/// ```no_run
/// use pliant::play::Player;
/// use pliant::{Settings, samples};
///
/// let player = Player::new(&samples::square_jump(4)?, &Settings::default(), "A square", 0)?;
/// println!("{}", player.address());
/// player.serve()?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub struct Player {
    listener: TcpListener,
    door: AccessToken,
    /// Initial data of the page.
    data: Value,
    session: Session,
    quiet: Duration,
}

/// Shared state of the connections.
struct ServerState {
    door: AccessToken,
    page: String,
    quiet: Duration,
    requests: Sender<Request>,
    connections: Arc<AtomicUsize>,
    /// Pages that are open.
    pages: Arc<AtomicUsize>,
}

/// A counted connection; it counts until it is dropped, also by a panic.
struct ConnectionCount {
    count: Arc<AtomicUsize>,
    /// Number of connections, including this one.
    number: usize,
}

impl ConnectionCount {
    fn among(count: &Arc<AtomicUsize>) -> Self {
        let number = count.fetch_add(1, Ordering::SeqCst) + 1;
        Self { count: count.clone(), number }
    }
}

impl Drop for ConnectionCount {
    fn drop(&mut self) {
        self.count.fetch_sub(1, Ordering::SeqCst);
    }
}

/// An open page; when it is dropped, the simulation is notified.
struct Page<'a> {
    house: &'a ServerState,
    guest: Option<ConnectionCount>,
}

impl Drop for Page<'_> {
    fn drop(&mut self) {
        drop(self.guest.take());
        let was_last = self.house.pages.load(Ordering::SeqCst) == 0;
        // without a simulation there is nothing to notify
        let _ = self.house.requests.send(Request::Gone { was_last });
    }
}

impl Player {
    /// Starts `scene` and takes `port` of the loopback interface, 0 for any that is free. `title` is the
    /// heading of the page.
    ///
    /// # Errors
    /// As [`Scene::start`]; a port that is not available.
    pub fn new(scene: &Scene, settings: &Settings, title: &str, port: u16) -> Result<Self, Error> {
        let (session, mut data) = Session::new(scene, settings)?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = listener.map_err(|error| no_port(port, &error))?;
        let port = listener.local_addr().map_err(|error| no_port(port, &error))?.port();
        data["title"] = title.into();
        Ok(Self { listener, door: AccessToken::new(port)?, data, session, quiet: QUIET })
    }

    /// Shows the readings of the sensors of `sampling` over time, below the energies. They are read as often as the
    /// energies, so [`Sampling::phase_ends`] is enough for its times.
    ///
    /// # Errors
    /// Sensors of items that the scene does not have; invalid times.
    pub fn sensors(mut self, sampling: &Sampling) -> Result<Self, Error> {
        self.data["sensors"] = self.session.read(sampling)?;
        Ok(self)
    }

    /// Allows slider moves to be saved as a scene file.
    ///
    /// This is the file at `path` with the text `text`, from which the scene was read by `reader`, with tables of
    /// pressures, forces and loads in place of its own.
    pub fn saving(
        mut self,
        text: impl Into<String>,
        path: impl Into<PathBuf>,
        reader: &SceneReader,
    ) -> Self {
        let original = Original { text: text.into(), path: path.into(), reader: reader.clone() };
        self.data["saves"] = original.new_name().into();
        self.session.original = Some(original);
        self
    }

    /// How long a page may be silent until its browser is asked whether it is still there, and how long the browser
    /// may take to answer: 10 s unless set, more than 0. A scene that no page shows any more stops.
    pub fn quiet(mut self, longest: Duration) -> Self {
        self.quiet = longest;
        self
    }

    /// The address of the page. Whoever knows it controls the simulation.
    pub fn address(&self) -> String {
        self.door.address()
    }

    /// Serves the page as long as the program runs.
    ///
    /// # Errors
    /// A thread that the system cannot start.
    pub fn serve(self) -> Result<(), Error> {
        let Self { listener, door, data, session, quiet } = self;
        let page = Picture::page(PAGE, STYLE, SCRIPTS, &data);
        let (requests, inbox) = channel();
        let simulation = thread::Builder::new().name("simulation".into());
        simulation.spawn(move || session.run(&inbox)).map_err(|error| {
            InputError::new("threads", error, "the simulation needs one of its own")
        })?;
        let house = Arc::new(ServerState {
            door,
            page,
            quiet,
            requests,
            connections: Arc::default(),
            pages: Arc::default(),
        });
        for stream in listener.incoming() {
            let Ok(stream) = stream else {
                thread::sleep(RECOVERY);
                continue;
            };
            let guest = ConnectionCount::among(&house.connections);
            if guest.number > MOST {
                continue;
            }
            let house = house.clone();
            let visit = move || {
                let _guest = guest;
                house.receive(stream);
            };
            // if no thread can be started, the guest is dropped
            let _ = thread::Builder::new().name("page".into()).spawn(visit);
        }
        Ok(())
    }
}

fn no_port(port: u16, error: &io::Error) -> InputError {
    let help = format!("{error}; choose another one, or 0 for any that is free");
    InputError::new("port", port, help)
}

impl ServerState {
    /// Answers a connection. One that is closed without a request gets no answer.
    fn receive(&self, mut stream: TcpStream) {
        if stream.set_write_timeout(Some(PATIENCE)).is_err() {
            return;
        }
        let head = match Head::read(&mut stream) {
            Ok(head) => head,
            Err(refusal) => return refuse(&mut stream, refusal),
        };
        match self.door.admit(&head) {
            Ok(Route::Page) => {
                let _ = answer(&mut stream, "200 OK", "text/html", &self.page);
            }
            Ok(Route::Socket(key)) => self.converse(stream, &key, head.rest),
            Err(refusal) => refuse(&mut stream, Some(refusal)),
        }
    }

    /// Answers the messages of a page until it is closed.
    fn converse(&self, mut stream: TcpStream, key: &str, rest: Vec<u8>) {
        let accepted = format!(
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
             Sec-WebSocket-Accept: {}\r\n\r\n",
            derive_accept_key(key.as_bytes())
        );
        // messages are short, and each waits for its answer
        let ready = stream
            .write_all(accepted.as_bytes())
            .and_then(|()| stream.set_nodelay(true))
            .and_then(|()| stream.set_read_timeout(Some(self.quiet)));
        if ready.is_err() {
            return;
        }
        let config = WebSocketConfig::default()
            .max_message_size(Some(LONGEST))
            .max_frame_size(Some(LONGEST));
        let mut socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
        let _page = Page { house: self, guest: Some(ConnectionCount::among(&self.pages)) };
        let mut was_asked = false;
        loop {
            let answer = match socket.read() {
                Ok(Parcel::Text(text)) => Some(Parcel::text(self.pass_on(&text).to_string())),
                Ok(Parcel::Binary(_)) => {
                    let answer = error_answer("a message is text, this was none");
                    Some(Parcel::text(answer.to_string()))
                }
                // pings and closing handshakes are answered by the next call
                Ok(_) => None,
                // a page that does not draw sends nothing, but its browser answers a ping
                Err(tungstenite::Error::Io(error)) if is_late(&error) && !was_asked => {
                    was_asked = true;
                    if socket.send(Parcel::Ping(Default::default())).is_err() {
                        return;
                    }
                    continue;
                }
                // closed, or no longer answering
                Err(_) => return,
            };
            was_asked = false;
            if answer.is_some_and(|answer| socket.send(answer).is_err()) {
                return;
            }
        }
    }

    /// Passes a message to the simulation, and returns its answer.
    fn pass_on(&self, text: &str) -> Value {
        let message = match Message::parse(text) {
            Ok(message) => message,
            Err(error) => return error_answer(&error),
        };
        let (answers, answer) = channel();
        let sent = self.requests.send(Request::Message(message, answers));
        let answer = sent.ok().and_then(|()| answer.recv().ok());
        answer
            .unwrap_or_else(|| error_answer("the simulation has ended: start `pliant play` again"))
    }
}

/// Whether the read has timed out.
fn is_late(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

fn refuse(stream: &mut TcpStream, refusal: Option<Refusal>) {
    if let Some(Refusal { status, reason }) = refusal {
        let _ = answer(stream, status, "text/plain", &format!("{reason}\n"));
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    /// A panic in a connection does not occupy a place forever.
    #[test]
    fn guests_who_panic_are_gone() {
        let count = Arc::default();
        let first = ConnectionCount::among(&count);
        let visit = AssertUnwindSafe(|| {
            let guest = ConnectionCount::among(&count);
            assert_eq!(guest.number, 1, "this one is the second");
        });
        assert!(catch_unwind(visit).is_err());
        assert_eq!((first.number, count.load(Ordering::SeqCst)), (1, 1));
        drop(first);
        assert_eq!(count.load(Ordering::SeqCst), 0);
    }
}
