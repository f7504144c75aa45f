//! The shown frame as a file, and the arrows in it.

use super::Outcome;
use super::browser::Browser;
use super::page::*;

/// What clicking on a button offers as a file: its ending, type and contents as a data address.
pub fn offered(
    browser: &mut Browser,
    button: &str,
) -> Result<[String; 3], Box<dyn std::error::Error>> {
    // what the page hands to the browser is kept, and not saved
    let text = browser.text(&format!(
        "new Promise((done) => {{
           let kept;
           URL.createObjectURL = (blob) => {{ kept = blob; return '#'; }};
           HTMLAnchorElement.prototype.click = function () {{
             const ending = this.download.split('.').pop();
             const reader = new FileReader();
             reader.onload = () => done([ending, kept.type, reader.result].join('\\n'));
             if (ending === 'svg') reader.readAsText(kept);
             else reader.readAsDataURL(kept);
           }};
           document.querySelector('{button}').click(); }})"
    ))?;
    let parts: Vec<String> = text.splitn(3, '\n').map(Into::into).collect();
    Ok(parts.try_into().map_err(|parts| format!("{parts:?}"))?)
}

/// The vectors are a file that XML parsers read, with each of the 18 cells as a filled path; the pixels are a PNG.
pub fn the_frame_is_saved(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &square()?)?;
    let [ending, kind, text] = offered(browser, "#svg")?;
    assert_eq!([&*ending, &*kind], ["svg", "image/svg+xml"]);
    assert!(!text.contains("NaN") && !text.contains("undefined"), "{text}");
    let document = roxmltree::Document::parse(&text)?;
    let cells = document.descendants().filter(|node| {
        let corners = node.attribute("d").unwrap_or_default().matches(['M', 'L']).count();
        let fill = node.attribute("fill").unwrap_or_default();
        node.has_tag_name("path") && corners == 3 && fill.starts_with("rgb")
    });
    assert_eq!(cells.count(), 18);

    let [ending, kind, address] = offered(browser, "#png")?;
    assert_eq!([&*ending, &*kind], ["png", "image/png"]);
    // the signature of PNG in base 64
    assert!(address.starts_with("data:image/png;base64,iVBORw0KGgo"), "{}", &address[..60]);
    Ok(())
}

/// The arrows can be switched on; how long they are is told then.
pub fn arrows_are_offered(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &square()?)?;
    assert_eq!(browser.evaluate("document.querySelector('#contacts').hidden")?, false);
    assert_eq!(browser.evaluate("document.querySelector('#newtons').hidden")?, true);
    browser.click("#arrows")?;
    assert_eq!(browser.evaluate("document.querySelector('#newtons').hidden")?, false);
    Ok(())
}
