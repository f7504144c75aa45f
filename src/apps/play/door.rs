//! Admission of requests.
//!
//! The server listens on 127.0.0.1 only. A request has to name this host and a path with 16 random bytes, a
//! WebSocket an origin that is the page's own: neither other users of the machine nor other pages in the
//! browser have access.

use std::fmt::Write;

use super::http::{Head, Refusal};
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// Bytes of the token.
const LENGTH: usize = 16;
/// The port that browsers leave out of an address.
const PORT_OF_HTTP: u16 = 80;

/// The address of the page, whose path is a secret.
#[derive(Clone)]
pub(super) struct AccessToken {
    port: u16,
    token: String,
}

/// Resource that a request asks for.
pub(super) enum Route {
    /// The page.
    Page,
    /// A WebSocket with this key.
    Socket(String),
}

impl AccessToken {
    /// An access check with a new secret token.
    ///
    /// # Errors
    /// An operating system without random numbers.
    pub(super) fn new(port: u16) -> Result<Self, Error> {
        let mut bytes = [0; LENGTH];
        getrandom::fill(&mut bytes).map_err(|error| {
            let help = "the page needs a random address, and the system gives no random numbers";
            InputError::new("random numbers", error, help)
        })?;
        let token = bytes.iter().fold(String::new(), |mut token, byte| {
            // writing to a string cannot fail
            let _ = write!(token, "{byte:02x}");
            token
        });
        Ok(Self { port, token })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// The resource that a request asks for, if it is admitted.
    ///
    /// # Errors
    /// A refusal with its reason.
    pub(super) fn admit(&self, head: &Head) -> Result<Route, Refusal> {
        let forbidden = |reason: &str| Refusal::new("403 Forbidden", reason);
        // other host names that resolve to this machine are refused
        let mut hosts: Vec<String> =
            ["127.0.0.1", "localhost"].map(|host| format!("{host}:{}", self.port)).into();
        if self.port == PORT_OF_HTTP {
            // browsers leave this port out
            hosts.extend(["127.0.0.1", "localhost"].map(String::from));
        }
        if !head.header("host").is_some_and(|host| hosts.iter().any(|own| own == host)) {
            return Err(forbidden("this is another machine's name: take the address as printed"));
        }
        let mut parts = head.path.split('?').next().unwrap_or_default().splitn(3, '/').skip(1);
        if !parts.next().is_some_and(|token| same(token, &self.token)) {
            return Err(forbidden(
                "the address is not complete: take it as `pliant play` printed it",
            ));
        }
        if head.method != "GET" {
            return Err(Refusal::new("405 Method Not Allowed", "only GET is known here"));
        }
        match parts.next() {
            Some("") => Ok(Route::Page),
            Some("socket") => self.socket(head, &hosts).map(Route::Socket),
            _ => Err(Refusal::new("404 Not Found", "there is nothing here")),
        }
    }

    /// The key of a WebSocket that a page of this server opens.
    fn socket(&self, head: &Head, hosts: &[String]) -> Result<String, Refusal> {
        let is_own = |origin: &str| hosts.iter().any(|host| origin == format!("http://{host}"));
        if !head.header("origin").is_some_and(is_own) {
            return Err(Refusal::new("403 Forbidden", "another page has no business here"));
        }
        let says = |name: &str, word: &str| {
            let words = head.header(name).unwrap_or_default();
            words.split(',').any(|part| part.trim().eq_ignore_ascii_case(word))
        };
        let key = head.header("sec-websocket-key");
        match key {
            Some(key)
                if says("upgrade", "websocket")
                    && says("connection", "upgrade")
                    && says("sec-websocket-version", "13") =>
            {
                Ok(key.to_owned())
            }
            _ => Err(Refusal::new("426 Upgrade Required", "this is the address of a WebSocket")),
        }
    }
}

/// Whether two texts are the same, in a time that does not reveal where they differ.
fn same(a: &str, b: &str) -> bool {
    let differ = a.bytes().zip(b.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
    a.len() == b.len() && differ == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Browsers leave port 80 out of the names of hosts and origins, and no other one.
    #[test]
    fn the_port_of_http_goes_without_saying() {
        for (port, host, is_let_in) in [
            (80, "127.0.0.1", true),
            (80, "localhost", true),
            (80, "127.0.0.1:80", true),
            (80, "evil.example", false),
            (8080, "127.0.0.1", false),
            (8080, "127.0.0.1:8080", true),
        ] {
            let door = AccessToken { port, token: "secret".into() };
            let socket = format!(
                "GET /secret/socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\n\
                 Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: k\r\n\r\n"
            );
            let page = format!("GET /secret/ HTTP/1.1\r\nHost: {host}\r\n\r\n");
            for request in [socket, page] {
                let head = Head::parse(request.as_bytes()).ok().flatten().unwrap();
                assert_eq!(door.admit(&head).is_ok(), is_let_in, "{port} {request}");
            }
        }
    }
}
