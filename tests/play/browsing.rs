//! The page in a browser.

use std::thread::sleep;
use std::time::Duration;

use super::browser::Browser;
use super::talking::READ;
use super::{BEAM, Outcome, served_scene};

/// The picture of the scene (px): where a node is drawn, by the functions of the page's own ruler.
const CLOCK: &str = "parseFloat(document.querySelector('#clock').textContent)";

#[test]
fn it_is_played_by_hand() -> Outcome {
    let address = served_scene(&format!("{BEAM}{READ}"), |_| {})?;
    let mut browser = Browser::start()?;
    browser.resize([1200, 800], false)?;
    browser.visit(&address)?;
    assert_eq!(browser.text("document.querySelector('h1').textContent")?, "A beam <b>by hand</b>");
    browser.wait_until("document.querySelector('#facts').textContent.includes('33 nodes')")?;
    assert_eq!(browser.number(CLOCK)?, 0.0);

    // time runs on, and stops
    browser.click("#play")?;
    browser.wait_until(&format!("{CLOCK} > 0.001"))?;
    browser.click("#play")?;
    browser.wait_until("document.querySelector('#play').ariaLabel === 'Play'")?;
    // what was computed when the button was pressed is still shown
    let mut paused = f64::NAN;
    while browser.number(CLOCK)? != paused {
        paused = browser.number(CLOCK)?;
        sleep(Duration::from_millis(300));
    }
    assert!(browser.text("document.querySelector('#facts').textContent")?.contains("order"));

    // a chart for each unit of the sensors
    let read = "[...document.querySelectorAll('#sensors .series button')].map((button) =>
        [...button.childNodes].slice(1).map((part) => part.textContent).join(' ')).join(';')";
    let told = browser.text(read)?;
    let [tip, inside, clamp] = told.split(';').collect::<Vec<_>>()[..] else {
        return Err(told.into());
    };
    assert!(tip.starts_with("tip ") && tip.ends_with(" mm"), "{told}");
    // 0 at first, and 500 Pa from some time on
    assert!(inside.starts_with("inside ") && inside.ends_with(" Pa"), "{told}");
    assert!(clamp.starts_with("clamp ") && clamp.ends_with('N'), "{told}");
    assert_eq!(browser.number("document.querySelectorAll('#sensors canvas').length")?, 3.0);

    // a node is pulled: a line goes from it to the mouse
    let picture = "document.querySelector('#stage').toDataURL()";
    let before = browser.text(picture)?;
    let tip = browser.place("#stage", [0.735, 0.48])?;
    // the space bar is the page's then, whatever was used before
    browser.evaluate("document.querySelector('#save').focus()")?;
    browser.mouse("mousePressed", tip)?;
    for k in 1..=5 {
        browser.mouse("mouseMoved", [tip[0], tip[1] - 14.0 * f64::from(k)])?;
    }
    browser.wait_until(&format!("{picture} !== {before:?}"))?;
    assert_eq!(browser.number(CLOCK)?, paused);
    browser.press(" ", false)?;
    browser.wait_until(&format!("{CLOCK} > {}", paused + 0.005))?;
    browser.mouse("mouseReleased", [tip[0], tip[1] - 70.0])?;

    // a slider by keyboard: the chamber's pressure, told with its unit
    let first = "document.querySelector('#sliders input')";
    browser.evaluate(&format!("{first}.focus()"))?;
    browser.press("ArrowRight", false)?;
    browser.wait_until("document.querySelector('#sliders output').textContent.endsWith('Pa')")?;
    browser.wait_until(&format!("{first}.valueAsNumber > 0"))?;

    // to the end, which is said; and back
    browser.evaluate(
        "document.querySelector('#speed').selectedIndex = 12;
         document.querySelector('#speed').dispatchEvent(new Event('change'))",
    )?;
    browser.wait_until(
        "document.querySelector('#trouble').textContent.includes('end of the scene')",
    )?;
    assert_eq!(browser.number(CLOCK)?, 0.1);
    browser.click("#start")?;
    browser.wait_until(&format!("{CLOCK} === 0"))?;
    let complaints = browser.complaints();
    assert!(complaints.is_empty(), "{complaints:?}");
    assert_eq!(browser.requests(), browser.opened());
    Ok(())
}
