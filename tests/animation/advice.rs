//! The page of the adviser.

use std::ops::ControlFlow;

use pliant::Sampling;
use pliant::samples::beam_jump;
use pliant::study::Adviser;

use super::Outcome;
use super::browser::Browser;

/// The answer stands above the motions, the chart has a point for each candidate that has an error, with its name, and both
/// motions play. On a phone nothing but the chart and the table is wider than the window.
pub fn advice_is_read_and_both_motions_play(browser: &mut Browser) -> Outcome {
    let scene = beam_jump()?;
    let go_on = &mut |_: &str| ControlFlow::Continue(());
    let advice = Adviser::new(&scene, 0.05).budget(5.0).run(go_on)?;
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("advice.html");
    advice.write_page(&scene, &Sampling::every(0.01), &path, "A <b>beam</b>", go_on)?;
    browser.open(&path)?;
    assert_eq!(browser.text("document.querySelector('h1').textContent")?, "A <b>beam</b>");
    let answer = browser.text("document.querySelector('.advice dd').textContent")?;
    let enough = advice.enough.as_ref().ok_or("nothing is enough")?;
    assert!(answer.starts_with(&enough.choice.to_string()), "{answer}");

    let measured = advice.candidates.iter().filter(|one| one.error.is_some()).count();
    let points = "[...document.querySelectorAll('.mark')]";
    assert_eq!(browser.number(&format!("{points}.length"))?, measured as f64);
    let titles = format!("{points}.every((point) => point.querySelector('title').textContent)");
    assert_eq!(browser.evaluate(&titles)?, true);
    let rows = browser.number("document.querySelectorAll('tbody tr').length")?;
    assert_eq!(rows, advice.candidates.len() as f64);

    let pictures =
        "['#stage', '#stage-2'].map((id) => document.querySelector(id).toDataURL()).join()";
    let before = browser.text(pictures)?;
    browser.evaluate("document.querySelector('#play').scrollIntoView({ block: 'center' })")?;
    browser.click("#play")?;
    browser.wait_until("Number(document.querySelector('#time').value) > 0.02")?;
    browser.press(" ", false)?;
    let after = browser.text(pictures)?;
    assert_eq!(before.split(',').zip(after.split(',')).filter(|(a, b)| a != b).count(), 2);

    browser.resize([360, 740], true)?;
    browser.wait_until("innerWidth === 360")?;
    assert_eq!(browser.number("document.documentElement.scrollWidth")?, 360.0);
    Ok(())
}
