//! The picture of `pliant play` in the README, made anew: a headless Chromium (Debian's package `chromium`) opens
//! the page of a scene, pulls a node of the body, lets it go, and puts what it saw side by side.
//!
//! `cargo run --release --features play --example play_picture` writes `docs/pictures/play.png`.

// its other users need what this picture does not
#[allow(dead_code)]
#[path = "../tests/animation/browser.rs"]
mod browser;

use std::error::Error;
use std::path::PathBuf;
use std::thread;

use clap::Parser;
use pliant::SceneFile;
use pliant::play::Player;
use serde_json::{Value, json};

use self::browser::Browser;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The picture of `pliant play`.
#[derive(Parser)]
struct Arguments {
    /// Where the picture goes
    #[arg(long, value_name = "FILE", default_value = "docs/pictures/play.png")]
    out: PathBuf,
}

/// A rectangle on its held bottom.
const SCENE: &str = "scenes/report-8.toml";
/// As wide as a phone, so that words are large in the picture (px).
const WINDOW: [u32; 2] = [330, 900];
/// Size of the whole picture (px).
const PICTURE: [u32; 2] = [1404, 436];
/// From the node that is pulled to the mouse, in parts of the picture of the body.
const PULL: [[f64; 2]; 2] = [[0.665, 0.24], [0.92, 0.1]];
/// Times of the simulation (s) at which it is looked at: pulled, and let go.
const TIMES: [f64; 2] = [0.1, 0.14];

const STAGE: &str = "document.querySelector('#stage').toDataURL()";
const CLOCK: &str = "document.querySelector('#clock').textContent";

fn main() -> Result<()> {
    let Arguments { out } = Arguments::parse();
    let file = SceneFile::read(SCENE)?;
    let player = Player::new(&file.scene, &file.settings, &file.title, 0)?;
    let address = player.address();
    thread::spawn(move || player.serve());
    let mut browser = Browser::start()?;
    browser.resize(WINDOW, false)?;
    browser.visit(&address)?;
    browser.wait_until(&format!("{CLOCK} === '0.000 s'"))?;
    browser.evaluate(
        "for (const [name, value] of [['speed', '1/20 \u{d7}'], ['strength', 0.6]]) {
           const control = document.getElementById(name);
           control.value = value;
           for (const event of ['input', 'change']) control.dispatchEvent(new Event(event));
         }",
    )?;

    let mut seen = vec![look(&mut browser, "At rest")?];
    let [node, mouse] = [browser.place("#stage", PULL[0])?, browser.place("#stage", PULL[1])?];
    browser.evaluate("document.querySelector('#play').click()")?;
    browser.mouse("mousePressed", node)?;
    browser.mouse("mouseMoved", mouse)?;
    browser.wait_until(&format!("parseFloat({CLOCK}) > {}", TIMES[0]))?;
    seen.push(look(&mut browser, "Pulled by the mouse")?);
    browser.mouse("mouseReleased", mouse)?;
    browser.wait_until(&format!("parseFloat({CLOCK}) > {}", TIMES[1]))?;
    seen.push(look(&mut browser, "Let go")?);
    browser.evaluate("document.querySelector('#play').click()")?;
    browser.wait_until("document.querySelector('#play').ariaLabel === 'Play'")?;

    browser.evaluate(&format!("({SIDE_BY_SIDE})({})", Value::from(seen)))?;
    browser.resize(PICTURE, false)?;
    browser.screenshot(&out)?;
    println!("{}", out.display());
    Ok(())
}

/// The picture of the body, with words for it and the time.
fn look(browser: &mut Browser, words: &str) -> Result<Value> {
    let words = format!("{words}, {}", browser.text(CLOCK)?);
    Ok(json!([words, browser.text(STAGE)?]))
}

/// Puts pictures of the body and the energies side by side, in the style of the page.
const SIDE_BY_SIDE: &str = "async (seen) => {
  const card = (title, ...content) => {
    const figure = Object.assign(document.createElement('figure'), { className: 'card' });
    const heading = Object.assign(document.createElement('h2'), { textContent: title });
    figure.append(heading, ...content);
    return figure;
  };
  const image = async (src) => {
    const element = Object.assign(new Image(), { src });
    await element.decode();
    return element;
  };
  const cards = await Promise.all(seen.map(async ([title, src]) => card(title, await image(src))));
  const plot = await image(document.getElementById('plot').toDataURL());
  cards.push(card('Energy', plot, document.getElementById('series')));
  document.body.replaceChildren(...cards);
  const columns = 'repeat(3, max-content) minmax(0, 1fr)';
  document.body.style = `max-width: none; display: grid; grid-template-columns: ${columns}; gap: 10px; padding: 10px`;
  document.head.append(Object.assign(document.createElement('style'), {
    textContent: `.card { margin: 0 } .series { display: grid; grid-template-columns: 1fr 1fr }
      .series .value { flex: 1; min-width: 0 }`,
  }));
}";
