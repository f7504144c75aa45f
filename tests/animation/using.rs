//! What a person does with an animation.

use super::Outcome;
use super::browser::Browser;
use super::page::*;

/// Time goes on while it plays, and by the real time divided by the speed; it stands still when it is
/// paused, and at the end.
pub fn it_plays_and_pauses(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &square()?)?;
    assert_eq!(clock(browser)?, 0.0);
    let [coloured, different] = colours(browser, "#stage")?;
    assert!(coloured > 5000 && different > 0, "{coloured} pixels, {different} colours");
    browser.click("#play")?;
    browser.wait_until("Number(document.querySelector('#time').value) > 0.01")?;
    assert_eq!(browser.text("document.querySelector('#play').ariaLabel")?, "Pause");
    browser.click("#play")?;
    let paused = browser.number("Number(document.querySelector('#time').value)")?;
    assert!(paused > 0.01 && (clock(browser)? - paused).abs() < 1e-3);
    let two_frames = "new Promise((done) =>
        requestAnimationFrame(() => requestAnimationFrame(() => done(true))))";
    browser.evaluate(two_frames)?;
    assert_eq!(browser.number("Number(document.querySelector('#time').value)")?, paused);

    // a hundredth of real time: what passes on the page is a hundredth of what passes here
    browser.evaluate("document.querySelector('#speed').selectedIndex = 3")?;
    let speed = "document.querySelector('#speed').selectedOptions[0].text";
    assert_eq!(browser.text(speed)?, "1/100 \u{d7}");
    browser.press("Home", false)?;
    browser.press(" ", false)?;
    // a look after each frame of the page, which has the same time stamp
    let ratio = browser.number(
        "new Promise((done) => {
           let from;
           const look = (stamp) => {
             const time = Number(document.querySelector('#time').value);
             from ??= [stamp, time];
             if (time > from[1] + 0.003) done((1000 * (time - from[1])) / (stamp - from[0]));
             else requestAnimationFrame(look);
           };
           requestAnimationFrame(look); })",
    )?;
    assert!((ratio / 0.01 - 1.0).abs() < 1e-6, "{ratio} instead of 1/100");

    browser.evaluate("document.querySelector('#speed').selectedIndex = 9")?;
    browser.wait_until("document.querySelector('#play').ariaLabel === 'Play'")?;
    assert_eq!(clock(browser)?, END);
    browser.click("#play")?;
    browser.wait_until("Number(document.querySelector('#time').value) < 0.16")?;
    Ok(())
}

/// Clicks on the slider and on the chart go to the time there; picture, line and energies follow. Where
/// the moved nodes are drawn is known: 0.1 m apart, 0.3 m high at first, moving down steadily.
pub fn picture_and_energies_follow_the_slider(browser: &mut Browser) -> Outcome {
    let trajectory = square()?;
    let _page = shown(browser, &trajectory)?;
    let high = moved_dots(browser, "#stage")?;
    let [[left, top], [right, _]] = high[..] else { return Err(format!("{high:?}").into()) };
    let scale = (right - left) / 0.1;
    let edges = {
        let start = cursor(browser)?;
        browser.press("End", false)?;
        [start, cursor(browser)?]
    };
    for share in [0.25, 0.5, 0.6] {
        let spot = browser.place("#time", [share, 0.5])?;
        browser.drag(&[spot])?;
        let time = browser.number("Number(document.querySelector('#time').value)")?;
        // the knob of the slider takes some room at both ends
        assert!((time / END - share).abs() < 0.02, "{time} at {share}");
        assert!((clock(browser)? - time).abs() < 1e-3);
        let expected = edges[0] + time / END * (edges[1] - edges[0]);
        assert!((cursor(browser)? - expected).abs() < 1.0, "at {time}");
        let dots = moved_dots(browser, "#stage")?;
        for [_, y] in &dots {
            let down = (y - top) / scale;
            // the centres of dots are known to half a pixel
            assert!((down - PUSH * time).abs() < 0.5 / scale, "{down} m at {time} s");
        }
        assert_eq!(dots.len(), 2, "at {time} s");
    }

    let from = browser.place("#plot", [0.3, 0.5])?;
    browser.drag(&[from, [edges[0], from[1]], [edges[1] + 300.0, from[1] + 40.0]])?;
    assert_eq!(clock(browser)?, END);
    let last = trajectory.last().energy;
    let expected = [
        ("kinetic", last.kinetic),
        ("strain", last.strain),
        ("gravity", last.gravity),
        ("contact", last.contact),
        ("springs", last.springs),
        ("dissipated", last.dissipated),
        ("supplied", last.supplied),
        ("balance", last.balance()),
    ];
    for (name, value) in expected {
        let [told, digit] = energy(browser, name, 0)?;
        assert!((told - value).abs() <= 1.01 * digit, "{name}: {told} is not {value}");
    }
    browser.drag(&[[edges[0] + 5.0 / 16.0 * (edges[1] - edges[0]), from[1]]])?;
    assert!((clock(browser)? - 0.05).abs() < 1e-3);
    let [told, digit] = energy(browser, "strain", 0)?;
    let sample = trajectory.samples().iter().find(|s| (s.time - 0.05).abs() < 1e-9);
    let strain = sample.ok_or("no sample")?.energy.strain;
    // within a pixel of that time, the square is pressed on
    let near = |value: f64| (told - value).abs() < digit + 0.02 * value;
    assert!(near(strain), "{told} is not {strain}");

    // a series that is switched off is not drawn, and the others fill the chart
    let [before, _] = colours(browser, "#plot")?;
    for button in 1..=8 {
        browser.click(&format!("#series button:nth-child({button})"))?;
    }
    let pressed =
        "[...document.querySelectorAll('#series button')].map((b) => b.ariaPressed).join()";
    assert_eq!(browser.text(pressed)?, ["false"; 8].join(","));
    let [none, _] = colours(browser, "#plot")?;
    browser.click("#series button:nth-child(2)")?;
    let [one, _] = colours(browser, "#plot")?;
    // letters have coloured rims, where screens are made so
    assert!(none < 100 && one > 1000 && before > one, "{none}, {one}, {before} coloured pixels");
    Ok(())
}

/// Cells have the colours of their values, those of the quantity that is chosen; its scale is told.
pub fn the_colours_are_those_of_the_chosen_quantity(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &square()?)?;
    for _ in 0..10 {
        browser.press("ArrowRight", false)?;
    }
    let scale = "document.querySelector('#ends').textContent";
    let picture = "document.querySelector('#stage').toDataURL()";
    let stress = (browser.text(scale)?, browser.text(picture)?);
    // a square pressed in the middle: few of its 18 cells are stressed alike
    let [_, of_stress] = colours(browser, "#stage")?;
    assert!(stress.0.ends_with("kPa"), "{}", stress.0);
    browser.evaluate("document.querySelector('#quantity').focus()")?;
    browser.press("ArrowDown", false)?;
    let density = (browser.text(scale)?, browser.text(picture)?);
    assert!(density.0.ends_with("kJ/m\u{b3}") && density.1 != stress.1, "{}", density.0);
    browser.press("ArrowDown", false)?;
    let pressure = (browser.text(scale)?, browser.text(picture)?);
    assert!(pressure.0.starts_with('\u{2212}') && pressure.0.ends_with("kPa"), "{}", pressure.0);
    assert_ne!(pressure.1, density.1);
    for _of_contact in 0..3 {
        browser.press("ArrowDown", false)?;
    }
    assert_eq!(browser.evaluate("document.querySelector('#scale').hidden")?, true);
    let [_, of_none] = colours(browser, "#stage")?;
    // blends along edges make more colours of each
    assert!(of_none * 3 < of_stress, "{of_none} colours without a quantity, {of_stress} with one");
    Ok(())
}

pub fn all_of_it_works_by_keyboard(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &square()?)?;
    // from sample to sample
    for (key, shift, expected) in [
        ("ArrowRight", false, 0.01),
        ("ArrowRight", false, 0.02),
        ("ArrowLeft", false, 0.01),
        ("ArrowRight", true, 0.11),
        ("End", false, END),
        ("ArrowRight", false, END),
        ("ArrowLeft", true, 0.06),
        ("Home", false, 0.0),
        ("ArrowLeft", false, 0.0),
    ] {
        browser.press(key, shift)?;
        assert_eq!(clock(browser)?, expected, "after {key}");
    }
    let speed = "document.querySelector('#speed').selectedIndex";
    let usual = browser.number(speed)?;
    browser.press("+", true)?;
    assert_eq!(browser.number(speed)?, usual + 1.0);
    browser.press("-", false)?;
    browser.press("-", false)?;
    assert_eq!(browser.number(speed)?, usual - 1.0);

    // everything is reached by Tab, has a name, and shows that it has the focus
    let mut reached = Vec::new();
    for _ in 0..16 {
        browser.press("Tab", false)?;
        reached.push(browser.text("document.activeElement.id || document.activeElement.tagName")?);
        let outline = browser.text("getComputedStyle(document.activeElement).outlineStyle")?;
        assert_eq!(outline, "solid", "focus on {reached:?}");
    }
    let mut expected = vec!["quantity", "play", "time", "speed", "arrows", "png", "svg"];
    expected.extend(["BUTTON"; 8]);
    expected.extend(["SUMMARY"]);
    assert_eq!(reached, expected);
    let named = browser.accessible()?;
    for (role, name) in
        [("combobox", "Colour"), ("button", "Play"), ("slider", "Time"), ("combobox", "Speed")]
    {
        assert!(named.contains(&(role.into(), name.into())), "{role} {name} in {named:?}");
    }
    assert!(
        named.iter().all(|(role, name)| role == "RootWebArea" || !name.is_empty()),
        "{named:?}"
    );

    // with the focus on the slider, keys do the same; on a button, Space presses that one alone
    browser.evaluate("document.querySelector('#time').focus()")?;
    browser.press("ArrowRight", false)?;
    assert_eq!(clock(browser)?, 0.01);
    let told = browser.text("document.querySelector('#time').ariaValueText")?;
    assert!(told.starts_with("0.010") && told.contains("phase"), "{told}");
    browser.evaluate("document.querySelector('#play').focus()")?;
    browser.press(" ", false)?;
    browser.wait_until("Number(document.querySelector('#time').value) > 0.011")?;
    browser.press(" ", false)?;
    let sign = "document.querySelector('#play').ariaLabel";
    assert_eq!(browser.text(sign)?, "Play");
    browser.evaluate("document.querySelector('#series button').focus()")?;
    browser.press(" ", false)?;
    assert_eq!(browser.text("document.querySelector('#series button').ariaPressed")?, "false");
    assert_eq!(browser.text(sign)?, "Play");
    Ok(())
}
