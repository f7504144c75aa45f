//! Who is let in.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;

use pliant::SceneFile;
use pliant::play::Player;

use super::client::Client;
use super::{BEAM, Outcome, PATH, served};

/// The answer to a request, as it is written.
fn asked(host: &str, request: &str) -> Result<String, Box<dyn std::error::Error>> {
    let mut stream = TcpStream::connect(host)?;
    stream.write_all(request.as_bytes())?;
    let mut answer = String::new();
    stream.read_to_string(&mut answer)?;
    Ok(answer)
}

#[test]
fn only_the_whole_address_is_answered() -> Outcome {
    let address = served(|_| {})?;
    let rest = address.strip_prefix("http://").ok_or("no address")?;
    let (host, path) = rest.split_once('/').ok_or("no path")?;
    assert!(host.starts_with("127.0.0.1:"), "{host}");
    // 16 random bytes and a slash
    assert_eq!(path.len(), 33, "{path}");
    let other = format!("{}0/", "0".repeat(31));
    let port = host.rsplit(':').next().ok_or("no port")?;
    let localhost = format!("localhost:{port}");
    for (method, path, host_named, status) in [
        ("GET", path, host, "200 OK"),
        ("GET", path, localhost.as_str(), "200 OK"),
        ("GET", "", host, "403"),
        ("GET", &path[..32], host, "404"),
        ("GET", &other, host, "403"),
        ("GET", "favicon.ico", host, "403"),
        ("GET", path, "evil.example", "403"),
        ("POST", path, host, "405"),
        ("GET", &format!("{path}other"), host, "404"),
        ("GET", &format!("{path}socket"), host, "403"),
    ] {
        let answer =
            asked(host, &format!("{method} /{path} HTTP/1.1\r\nHost: {host_named}\r\n\r\n"))?;
        let first = answer.lines().next().unwrap_or_default();
        assert!(first.contains(status), "{method} /{path} of {host_named}: {first}");
        assert_eq!(answer.contains("<html"), status == "200 OK", "{method} /{path}");
    }
    // names are text; nothing ends the data before its end
    let page = asked(host, &format!("GET /{path} HTTP/1.1\r\nHost: {host}\r\n\r\n"))?;
    assert!(page.contains("A beam \\u003cb>by hand"));
    let garbage = asked(host, "\u{1}\u{2} nonsense\r\n\r\n")?;
    assert!(garbage.starts_with("HTTP/1.1 400"), "{garbage}");
    let endless = asked(host, &format!("GET /{path} HTTP/1.1\r\nX: {}", "x".repeat(17_000)));
    // what is not read any more may break the connection before the answer is here
    assert!(endless.is_err() || endless.is_ok_and(|answer| answer.starts_with("HTTP/1.1 431")));
    Ok(())
}

#[test]
fn other_pages_are_not_listened_to() -> Outcome {
    let address = served(|_| {})?;
    for origin in ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"] {
        let error = Client::of(&address, origin).err().ok_or(origin)?.to_string();
        assert!(error.contains("403"), "{origin}: {error}");
    }
    Client::at(&address)?.look()?;
    Ok(())
}

#[test]
fn a_port_that_is_taken_is_named() -> Outcome {
    let file = SceneFile::parse(BEAM, Path::new(PATH))?;
    let player = Player::new(&file.scene, &file.settings, "", 0)?;
    let port: u16 = player.address().split([':', '/']).nth(4).ok_or("no port")?.parse()?;
    let error = Player::new(&file.scene, &file.settings, "", port).err().ok_or("taken twice")?;
    assert!(error.to_string().starts_with(&format!("port = {port} cannot be used")), "{error}");
    Ok(())
}
