//! A headless Chromium, used as a person uses a browser: by mouse and keyboard.
//!
//! It is driven over the pipes of `--remote-debugging-pipe` (Chrome DevTools Protocol: JSON messages,
//! each ended by a zero byte). What happens on the page meanwhile is kept: complaints in its console,
//! and whatever it asked the network for.

use std::error::Error;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use tempfile::TempDir;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// What a busy machine may take for an answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// No background traffic, and no window.
const FLAGS: [&str; 10] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
];

/// A browser with one page.
pub struct Browser {
    process: Child,
    commands: ChildStdin,
    messages: Receiver<Value>,
    sent: u64,
    session: Value,
    events: Vec<Value>,
    opened: Vec<String>,
    _profile: TempDir,
}

impl Browser {
    /// Starts a browser with an empty page.
    pub fn start() -> Result<Self> {
        let profile = tempfile::tempdir()?;
        // the protocol wants the pipes as file descriptors 3 and 4
        let mut process = Command::new("sh")
            .args(["-c", "exec chromium \"$@\" 3<&0 4>&1 </dev/null >/dev/null", "sh"])
            .args(FLAGS)
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let commands = process.stdin.take().ok_or("no pipe to chromium")?;
        let answers = process.stdout.take().ok_or("no pipe from chromium")?;
        let (sender, messages) = channel();
        thread::spawn(move || {
            for message in BufReader::new(answers).split(0).map_while(std::io::Result::ok) {
                let message = serde_json::from_slice(&message).unwrap_or(Value::Null);
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let mut browser = Self {
            process,
            commands,
            messages,
            sent: 0,
            session: Value::Null,
            events: Vec::new(),
            opened: Vec::new(),
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let target = target.map_err(|error| {
            format!(
                "chromium does not start: is the Debian package `chromium` installed \
                 (scripts/setup.sh chromium)? {error}"
            )
        })?;
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach)?["sessionId"].take();
        browser.session = session;
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}))?;
        }
        Ok(browser)
    }

    /// Makes the window as large as `size` (px), that of a phone if `mobile`.
    pub fn resize(&mut self, [width, height]: [u32; 2], mobile: bool) -> Result<()> {
        let metrics =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile });
        self.call("Emulation.setDeviceMetricsOverride", metrics)?;
        Ok(())
    }

    /// Tells the page that its reader likes a `light` or a `dark` one.
    pub fn prefer(&mut self, scheme: &str) -> Result<()> {
        let feature = json!({ "name": "prefers-color-scheme", "value": scheme });
        self.call("Emulation.setEmulatedMedia", json!({ "features": [feature] }))?;
        Ok(())
    }

    /// Opens a file and waits until it is there.
    pub fn open(&mut self, path: &Path) -> Result<()> {
        self.visit(&format!("file://{}", path.display()))
    }

    /// Opens an address and waits until it is there.
    pub fn visit(&mut self, url: &str) -> Result<()> {
        self.call("Page.navigate", json!({ "url": url }))?;
        let there = format!("location.href === {url:?} && document.readyState === 'complete'");
        self.opened.push(url.to_owned());
        self.wait_until(&there)
    }

    /// The value of a JavaScript expression on the page.
    pub fn evaluate(&mut self, expression: &str) -> Result<Value> {
        let mut answer = self.call(
            "Runtime.evaluate",
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true }),
        )?;
        match answer.get("exceptionDetails") {
            Some(details) => Err(format!("{expression}: {details}").into()),
            None => Ok(answer["result"]["value"].take()),
        }
    }

    /// The same, a number.
    pub fn number(&mut self, expression: &str) -> Result<f64> {
        let value = self.evaluate(expression)?;
        value.as_f64().ok_or_else(|| format!("{expression} is {value}, not a number").into())
    }

    /// The same, a text.
    pub fn text(&mut self, expression: &str) -> Result<String> {
        let value = self.evaluate(expression)?;
        let text = value.as_str().map(str::to_owned);
        text.ok_or_else(|| format!("{expression} is {value}, not a text").into())
    }

    /// Waits until a JavaScript expression is true.
    pub fn wait_until(&mut self, expression: &str) -> Result<()> {
        let deadline = Instant::now() + PATIENCE;
        while self.evaluate(expression)? != true {
            if Instant::now() > deadline {
                return Err(format!("waited in vain for {expression}").into());
            }
            thread::sleep(Duration::from_millis(20));
        }
        Ok(())
    }

    /// Presses and releases a key, by its name in JavaScript's events, with Shift or without.
    pub fn press(&mut self, key: &str, shift: bool) -> Result<()> {
        let code = match key {
            " " => "Space",
            key => key,
        };
        let virtual_key = match key {
            "Tab" => 9,
            " " => 32,
            "End" => 35,
            "Home" => 36,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            _ => 0,
        };
        let event = |kind: &str| {
            let modifiers = if shift { 8 } else { 0 };
            json!({
                "type": kind,
                "key": key,
                "code": code,
                "windowsVirtualKeyCode": virtual_key,
                "modifiers": modifiers,
            })
        };
        let mut down = event("keyDown");
        if key.chars().count() == 1 {
            down["text"] = key.into();
        }
        self.call("Input.dispatchKeyEvent", down)?;
        self.call("Input.dispatchKeyEvent", event("keyUp"))?;
        Ok(())
    }

    /// Where a point of an element is in the window (px); `share` from its upper left corner to the
    /// lower right one.
    pub fn place(&mut self, selector: &str, share: [f64; 2]) -> Result<[f64; 2]> {
        let of_box = self.evaluate(&format!(
            "(() => {{ const element = document.querySelector({selector:?});
               element.scrollIntoView({{ block: 'nearest' }});
               const box = element.getBoundingClientRect();
               return [box.left, box.top, box.width, box.height]; }})()"
        ))?;
        let of_box: Vec<f64> = serde_json::from_value(of_box)?;
        Ok([0, 1].map(|axis| of_box[axis] + share[axis] * of_box[axis + 2]))
    }

    /// Presses the mouse at the first of `points` (px), moves it along the others, and lets it go.
    pub fn drag(&mut self, points: &[[f64; 2]]) -> Result<()> {
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
            return Err("nowhere to drag".into());
        };
        self.mouse("mousePressed", first)?;
        points[1..].iter().try_for_each(|&point| self.mouse("mouseMoved", point))?;
        self.mouse("mouseReleased", last)
    }

    /// One event of the mouse, as the protocol names it.
    pub fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) -> Result<()> {
        let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", event)?;
        Ok(())
    }

    /// Clicks on the middle of an element.
    pub fn click(&mut self, selector: &str) -> Result<()> {
        let middle = self.place(selector, [0.5, 0.5])?;
        self.drag(&[middle])
    }

    /// Saves what the window shows as a picture (PNG).
    pub fn screenshot(&mut self, path: &Path) -> Result<()> {
        let shown = self.call("Page.captureScreenshot", json!({ "format": "png" }))?;
        let picture = STANDARD.decode(shown["data"].as_str().ok_or("no picture")?)?;
        Ok(std::fs::write(path, picture)?)
    }

    /// Role and name of everything that can have the focus, as a screen reader tells them.
    pub fn accessible(&mut self) -> Result<Vec<(String, String)>> {
        let tree = self.call("Accessibility.getFullAXTree", json!({}))?;
        let nodes = tree["nodes"].as_array().ok_or("no accessibility tree")?;
        let can_have_focus = |node: &&Value| {
            let properties = node["properties"].as_array();
            properties.is_some_and(|all| all.iter().any(|p| p["name"] == "focusable"))
        };
        let text = |value: &Value| value["value"].as_str().unwrap_or_default().to_owned();
        let entry = |node: &Value| (text(&node["role"]), text(&node["name"]));
        Ok(nodes.iter().filter(can_have_focus).map(entry).collect())
    }

    /// What the console complained about: exceptions, errors, warnings.
    pub fn complaints(&self) -> Vec<&Value> {
        let complains = |event: &&Value| match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Runtime.consoleAPICalled") => event["params"]["type"] != "log",
            Some("Log.entryAdded") => event["params"]["entry"]["level"] != "info",
            _ => false,
        };
        self.events.iter().filter(complains).collect()
    }

    /// The addresses of the pages that were opened.
    pub fn opened(&self) -> &[String] {
        &self.opened
    }

    /// The addresses that were asked for, without `data:` ones, which hold what they name.
    pub fn requests(&self) -> Vec<&str> {
        let sent = |event: &&Value| event["method"] == "Network.requestWillBeSent";
        let urls = self.events.iter().filter(sent);
        let urls = urls.filter_map(|event| event["params"]["request"]["url"].as_str());
        urls.filter(|url| !url.starts_with("data:")).collect()
    }

    /// Calls a method of the protocol and waits for its result.
    fn call(&mut self, method: &str, parameters: Value) -> Result<Value> {
        self.sent += 1;
        let mut command = json!({ "id": self.sent, "method": method, "params": parameters });
        if !self.session.is_null() {
            command["sessionId"] = self.session.clone();
        }
        self.commands.write_all(command.to_string().as_bytes())?;
        self.commands.write_all(&[0])?;
        self.commands.flush()?;
        loop {
            let mut message = self
                .messages
                .recv_timeout(PATIENCE)
                .map_err(|error| format!("no answer from chromium to {method}: {error}"))?;
            if message["id"] != self.sent {
                self.events.push(message);
                continue;
            }
            return match message.get("error") {
                Some(error) => Err(format!("{method}: {error}").into()),
                None => Ok(message["result"].take()),
            };
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        self.session = Value::Null;
        if self.call("Browser.close", json!({})).is_err() {
            let _ = self.process.kill();
        }
        let _ = self.process.wait();
    }
}
