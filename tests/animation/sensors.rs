//! Charts of sensors.

use pliant::simulate::{Component, Reading};
use pliant::{Sampling, Settings, Trajectory};

use super::Outcome;
use super::browser::Browser;
use super::page::*;

/// When the reading that has no value has none (s).
const GAP: [f64; 2] = [0.05, 0.1];

/// The square with sensors of two units; one reads nothing for a while.
fn read() -> Result<Trajectory, pliant::Error> {
    let sampling = Sampling::every(0.01)
        .read("height", Reading::position([15]).component(Component::Y))
        .read("<b>", Reading::velocity([15]).component(Component::Y))
        .sensor("gap", "m", |_, sample| {
            let inside = sample.time > GAP[0] && sample.time < GAP[1];
            if inside { f64::NAN } else { 0.1 }
        });
    square_scene()?.simulate(&Settings::default(), &sampling)
}

/// What a sensor's button tells.
fn told(browser: &mut Browser, name: &str) -> Result<String, Box<dyn std::error::Error>> {
    browser.text(&format!(
        "[...document.querySelectorAll('#sensors button')].find((button) =>
           button.textContent.startsWith({name:?})).querySelector('.value').textContent"
    ))
}

/// A chart for each unit, whose lines, cursors and values follow the time; clicks go there. Where there is no value
/// there is no line.
pub fn sensors_have_charts(browser: &mut Browser) -> Outcome {
    let trajectory = read()?;
    let page = shown(browser, &trajectory)?;
    let number = |text: &str| text.replace('\u{2212}', "-");
    assert_eq!(browser.number("document.querySelectorAll('#sensors canvas').length")?, 2.0);
    let names = "[...document.querySelectorAll('#sensors .series')].map((list) =>
        [...list.querySelectorAll('button')].map((button) => button.childNodes[1].textContent).join()).join(';')";
    assert_eq!(browser.text(names)?, "height,gap;<b>");

    for sample in trajectory.samples() {
        let height = number(&told(browser, "height")?);
        let height: f64 = height.trim_end_matches(" mm").parse()?;
        assert!((height * 1e-3 - sample.sensors[0]).abs() < 0.501e-4, "{height} mm");
        let gap = told(browser, "gap")?;
        let expected = if sample.sensors[2].is_nan() { "no value" } else { "100.0 mm" };
        assert_eq!(gap, expected, "at {} s", sample.time);
        // each cursor stands below that of the energies
        let apart = browser.number(
            "Math.max(...[...document.querySelectorAll('.cursor')].map((cursor) => Math.abs(
               cursor.getBoundingClientRect().left - document.querySelector('#cursor').getBoundingClientRect().left)))",
        )?;
        assert!(apart < 0.01, "{apart} px");
        browser.press("ArrowRight", false)?;
    }

    // without the other line: columns of pixels, over the time of the gap, that have colour
    browser.click("#sensors button")?;
    let coloured = browser.evaluate(&format!(
        "(() => {{ const image = ({PIXELS})('#sensors canvas');
           const room = image.width - 58 - 14;
           const found = (share) => {{
             const x = Math.round(58 + share * room);
             for (let y = 20; y < image.height - 40; y++) {{
               const at = 4 * (y * image.width + x);
               const rgb = [...image.data.slice(at, at + 3)];
               if (image.data[at + 3] > 200 && Math.max(...rgb) - Math.min(...rgb) > 80) return true;
             }}
             return false; }};
           return [0.02, 0.04, 0.055, 0.075, 0.095, 0.12].map((time) => found(time / {END})); }})()"
    ))?;
    assert_eq!(coloured, serde_json::json!([true, true, false, false, false, true]));

    let spot = browser.place("#sensors canvas", [0.5, 0.5])?;
    browser.drag(&[spot])?;
    let time = clock(browser)?;
    assert!(time > 0.06 && time < 0.1, "{time}");
    drop(page);

    // without sensors the page has no place for them
    let _page = shown(browser, &square()?)?;
    assert_eq!(browser.evaluate("document.querySelector('#sensors').hidden")?, true);
    assert_eq!(browser.number("document.querySelectorAll('canvas').length")?, 2.0);
    Ok(())
}
