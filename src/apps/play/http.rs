//! The subset of HTTP that one page needs.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The largest head of a request (bytes), and how long it may take.
const MOST: usize = 16 * 1024;
const PATIENCE: Duration = Duration::from_secs(10);
/// Headers of a request.
const HEADERS: usize = 64;

/// The head of a request.
pub(super) struct Head {
    pub(super) method: String,
    pub(super) path: String,
    /// Names in lower case.
    headers: Vec<(String, String)>,
    /// Bytes read after the head.
    pub(super) rest: Vec<u8>,
}

/// An answer that refuses a request.
pub(super) struct Refusal {
    pub(super) status: &'static str,
    pub(super) reason: String,
}

impl Refusal {
    pub(super) fn new(status: &'static str, reason: impl Into<String>) -> Self {
        Self { status, reason: reason.into() }
    }
}

impl Head {
    /// Reads the head of a request.
    ///
    /// # Errors
    /// A request that is not valid; `None` if the connection is gone or too slow to get an answer.
    pub(super) fn read(stream: &mut TcpStream) -> Result<Self, Option<Refusal>> {
        let deadline = Instant::now() + PATIENCE;
        let (mut bytes, mut part) = (Vec::new(), [0; 2048]);
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
                return Err(None);
            }
            let count = match stream.read(&mut part) {
                Ok(0) => return Err(None),
                Ok(count) => count,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return Err(None),
            };
            bytes.extend_from_slice(&part[..count]);
            if let Some(head) = Self::parse(&bytes).map_err(Some)? {
                return Ok(head);
            }
            if bytes.len() > MOST {
                let status = "431 Request Header Fields Too Large";
                return Err(Some(Refusal::new(status, "the request is too long")));
            }
        }
    }

    /// The head that `bytes` begin with, if it is complete.
    pub(super) fn parse(bytes: &[u8]) -> Result<Option<Self>, Refusal> {
        let mut headers = [httparse::EMPTY_HEADER; HEADERS];
        let mut request = httparse::Request::new(&mut headers);
        let bad = |error| Refusal::new("400 Bad Request", format!("this is not HTTP: {error}"));
        let httparse::Status::Complete(length) = request.parse(bytes).map_err(bad)? else {
            return Ok(None);
        };
        let header = |header: &httparse::Header| {
            let value = String::from_utf8_lossy(header.value).into_owned();
            (header.name.to_ascii_lowercase(), value)
        };
        Ok(Some(Self {
            method: request.method.unwrap_or_default().to_owned(),
            path: request.path.unwrap_or_default().to_owned(),
            headers: request.headers.iter().map(header).collect(),
            rest: bytes[length..].to_vec(),
        }))
    }

    /// The value of a header, by its name in lower case; `None` also if there are several.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(other, _)| other == name);
        let (_, value) = found.next()?;
        found.next().is_none().then_some(value)
    }
}

/// Sends an answer, after which the connection ends.
///
/// # Errors
/// A browser that is gone.
pub(super) fn answer(
    stream: &mut TcpStream,
    status: &str,
    kind: &str,
    body: &str,
) -> io::Result<()> {
    let length = body.len();
    // nothing is cached, no other page may embed this one, and the secret address is sent to no other site
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\n\
         Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
         Content-Security-Policy: frame-ancestors 'none'\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())?;
    stream.flush()
}
