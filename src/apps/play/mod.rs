//! A scene played live, and controlled by a person, on a page in the web browser.
//!
//! The page is served on the loopback interface only, under an address with a random token. The scene runs
//! in one thread, as fast as the page requests or as fast as it can; each message of the page, JSON over a
//! WebSocket, gets one answer: data to show, a confirmation, or the reason of a failure.
//!
//! The page uses the scripts of animations, those of the one motion in the scope of the page: `live` takes
//! the place of `motion`, with the same names for data of the simulation, and `play` that of `player`.

mod door;
mod frame;
mod hand;
mod http;
mod message;
mod pace;
mod past;
mod record;
mod server;
mod session;
mod slider;

pub use self::server::Player;
