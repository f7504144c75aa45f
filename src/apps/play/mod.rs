//! A scene in the hands of a person: a page in the web browser that plays it live.
//!
//! The page is served on the loopback interface alone, under an address with a random token. The scene runs in
//! one thread, as fast as the page asks for or as it can; each message of the page, JSON over a WebSocket, has
//! one answer: what is to be seen, that it is done, or why not.

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
