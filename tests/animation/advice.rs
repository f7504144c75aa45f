//! The page of the adviser: its chart, and the motions below.

use std::ops::ControlFlow;

use pliant::Sampling;
use pliant::samples::clamped_beam;
use pliant::study::Adviser;

use super::Outcome;
use super::browser::Browser;

/// The chart has a point for each candidate with an error, within it; what was written and what is enough are played by one clock.
pub fn the_advice_has_its_motions(browser: &mut Browser) -> Outcome {
    let scene = clamped_beam([6, 2], 100.0)?.ended_at(0.1);
    let advice = Adviser::new(&scene, 0.05).run(&mut |_| ControlFlow::Continue(()))?;
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("advice.html");
    let sampling = Sampling::every(0.02);
    advice.write_page(&scene, &sampling, &path, "Beam", &mut |_| ControlFlow::Continue(()))?;
    browser.open(&path)?;
    assert_eq!(browser.text("document.querySelector('h1').textContent")?, "Beam");
    let measured = advice.candidates.iter().filter(|candidate| candidate.error.is_some()).count();
    let points = "document.querySelectorAll('.pareto .points > g').length";
    assert_eq!(browser.number(points)?, measured as f64);
    let outside = "[...document.querySelectorAll('.pareto .points > g')].filter((point) => { \
                   const [chart, own] = [point.ownerSVGElement, point].map((one) => one.getBoundingClientRect()); \
                   return own.left < chart.left || own.right > chart.right || own.top < chart.top || \
                   own.bottom > chart.bottom; }).length";
    assert_eq!(browser.number(outside)?, 0.0);
    let rows = "document.querySelectorAll('tbody tr').length";
    assert_eq!(browser.number(rows)?, advice.candidates.len() as f64);
    let names =
        "[...document.querySelectorAll('figcaption')].map((name) => name.textContent).join()";
    assert_eq!(browser.text(names)?, "As written,Enough");
    let clock = "Number(document.querySelector('#time').value)";
    assert_eq!(browser.number(clock)?, 0.0);
    browser.press("ArrowRight", false)?;
    assert!(browser.number(clock)? > 0.0);
    Ok(())
}
