//! Motions side by side.

use std::error::Error;
use std::fs;

use pliant::output::{join_animations, write_animation, write_animations};
use pliant::{
    Body, Cells, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings, SolidCells, Strain,
    Trajectory,
};

use super::Outcome;
use super::browser::Browser;
use super::page::*;
use super::saving::offered;

/// When the other square ends (s), how fast it is pressed (m/s).
const SHORT: f64 = 0.1;
const SLOW: f64 = 0.2;

/// Another square of the same size and place: its moved nodes are 0.2 m apart, it is pressed more slowly, ends earlier,
/// and is sampled at other times. An obstacle passes by without touching it.
fn other() -> Result<Trajectory, pliant::Error> {
    let mesh = Mesh::rectangle([0.3, 0.3], [7, 7], Cells::Rectangles)?;
    let body = Body::new(mesh, RUBBER).strain(Strain::Green).thickness(0.01).build()?;
    let phase = Phase::until(SHORT).hold("bottom").move_nodes([44, 48], [0.0, -SLOW]);
    let passes = Obstacle::box_between([0.5, 0.0], [0.55, 0.1]).velocity([1.0, 0.0]).stiffness(1.0);
    let scene = Scene::new(body).obstacle(passes).phase(phase);
    scene.simulate(&Settings::default(), &Sampling::every(0.015))
}

/// Opens a page of motions, paused at the start.
fn opened(browser: &mut Browser, motions: &[(&str, &Trajectory)]) -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("beside.html");
    write_animations(motions, &path, "")?;
    browser.open(&path)
}

/// The page has both names as text. A metre has as many pixels in both, at the same place. The clock goes on after the end
/// of one of them, which stays, and says so; keys go from sample to sample of either; charts tell of both.
pub fn two_are_played_by_one_clock(browser: &mut Browser) -> Outcome {
    let (long, short) = (square()?, other()?);
    opened(browser, &[("<i>one</i>", &long), ("other", &short)])?;
    assert_eq!(browser.text("document.querySelector('h1').textContent")?, "<i>one</i> | other");
    let names =
        "[...document.querySelectorAll('figcaption')].map((name) => name.textContent).join()";
    assert_eq!(browser.text(names)?, "<i>one</i>,other");
    let (one, other) = (moved_dots(browser, "#stage")?, moved_dots(browser, "#stage-2")?);
    let ([a, b], [c, d]) = (&one[..], &other[..]) else {
        return Err(format!("{one:?} {other:?}").into());
    };
    let scale = (b[0] - a[0]) / 0.1;
    // centres of dots are known to half a pixel
    assert!((d[0] - c[0] - 0.2 * scale).abs() < 1.0, "{one:?} {other:?}");
    assert!((a[0] - c[0] - 0.05 * scale).abs() < 1.0 && (a[1] - c[1]).abs() < 1.0);

    // samples of the one every 0.01 s, of the other every 0.015 s
    for expected in [0.01, 0.015, 0.02, 0.03, 0.04, 0.045, 0.05, 0.06] {
        browser.press("ArrowRight", false)?;
        assert_eq!(clock(browser)?, expected);
    }
    for (number, trajectory) in [&long, &short].into_iter().enumerate() {
        let sample = trajectory.samples().iter().find(|sample| (sample.time - 0.06).abs() < 1e-9);
        let strain = sample.ok_or("no sample")?.energy.strain;
        let [told, digit] = energy(browser, "strain", number)?;
        assert!((told - strain).abs() <= 1.01 * digit, "{told} is not {strain}");
    }
    let down = (moved_dots(browser, "#stage-2")?[0][1] - c[1]) / scale;
    assert!((down - SLOW * 0.06).abs() < 1.0 / scale, "{down} m");

    for _ in 0..5 {
        browser.press("ArrowRight", false)?;
    }
    assert_eq!(clock(browser)?, SHORT);
    let ended = browser.text("document.querySelector('#stage-2').toDataURL()")?;
    browser.press("End", false)?;
    assert_eq!(clock(browser)?, END);
    // the obstacle that passes by stands still as well
    assert!(browser.text("document.querySelector('#stage-2').toDataURL()")? == ended);
    let phase = "document.querySelector('#phase-2').textContent";
    assert!(browser.text(phase)?.ends_with("ended at 0.1000 s"), "{}", browser.text(phase)?);
    let down = (moved_dots(browser, "#stage-2")?[0][1] - c[1]) / scale;
    assert!((down - SLOW * SHORT).abs() < 1.0 / scale, "{down} m");
    let [told, digit] = energy(browser, "strain", 1)?;
    let strain = short.last().energy.strain;
    assert!((told - strain).abs() <= 1.01 * digit, "{told} is not {strain}");

    // both move as it is played
    browser.press("Home", false)?;
    let pictures =
        "['#stage', '#stage-2'].map((id) => document.querySelector(id).toDataURL()).join()";
    let before = browser.text(pictures)?;
    browser.click("#play")?;
    browser.wait_until("Number(document.querySelector('#time').value) > 0.01")?;
    browser.press(" ", false)?;
    let after = browser.text(pictures)?;
    assert!(before.split(',').zip(after.split(',')).filter(|(a, b)| a != b).count() == 2);

    // energies that neither of them has are not shown: without gravity, contact and springs these are five
    opened(browser, &[("one", &short), ("other", &short)])?;
    assert_eq!(browser.number("document.querySelectorAll('#series button').length")?, 5.0);
    Ok(())
}

/// Colour (RGB) of the pixel at a place in a canvas (px).
fn pixel(
    browser: &mut Browser,
    canvas: &str,
    [x, y]: [f64; 2],
) -> Result<[f64; 3], Box<dyn Error>> {
    let found = browser.evaluate(&format!(
        "[...({PIXELS})({canvas:?}).data.slice(4 * (Math.round({y}) *
           document.querySelector({canvas:?}).width + Math.round({x}))).slice(0, 3)]"
    ))?;
    Ok(serde_json::from_value(found)?)
}

/// Two squares are strained alike, steadily and evenly, one of a tenth of the stiffness: its stress at the end is that
/// of the other after a tenth of the time, and has the same colour.
pub fn colours_mean_the_same(browser: &mut Browser) -> Outcome {
    let strained = |young: f64| {
        let mesh = Mesh::rectangle([0.3, 0.3], [2, 2], Cells::Triangles)?;
        let body = Body::new(mesh, Material { young, ..RUBBER }).strain(Strain::Cauchy);
        // something is left to be solved for
        let body = body.thickness(0.01).point_mass("bob", [0.5, 0.1], 0.1).build()?;
        let phase = Phase::until(0.1).hold("bottom").move_nodes("top", [0.0, -0.2]);
        Scene::new(body).phase(phase).simulate(&Settings::default(), &Sampling::every(0.01))
    };
    let (stiff, soft) = (strained(1e6)?, strained(1e5)?);
    opened(browser, &[("stiff", &stiff), ("soft", &soft)])?;
    let dots = moved_dots(browser, "#stage")?;
    let side = dots[1][0] - dots[0][0];
    // within a cell, away from its edges, also when it is pressed
    let place = [dots[0][0] + 0.25 * side, dots[0][1] + 0.4 * side];
    browser.press("ArrowRight", false)?;
    let early = pixel(browser, "#stage", place)?;
    browser.press("End", false)?;
    let [late, strong] = [pixel(browser, "#stage-2", place)?, pixel(browser, "#stage", place)?];
    // the next of 256 colours is some 4 away
    let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    assert!(apart(early, late) <= 4.0, "{early:?} {late:?}");
    assert!(apart(strong, late) > 100.0, "{strong:?} {late:?}");
    Ok(())
}

/// A cube at the origin whose front is marked.
fn cube(size: f64, nodes: usize) -> Result<Trajectory, pliant::Error> {
    let mesh = Mesh::cuboid([size; 3], [nodes; 3], SolidCells::Hexahedra)?;
    let phase = Phase::until(0.01).move_nodes("front", [0.0; 3]);
    let scene = Scene::new(Body::new(mesh, RUBBER).strain(Strain::Cauchy).build()?).phase(phase);
    scene.simulate(&Settings::default(), &Sampling::every(0.01))
}

/// The dots to the left and the right (px), and the lowest of those to the left.
fn extent(dots: &[[f64; 2]]) -> Result<[f64; 3], Box<dyn Error>> {
    let [first, .., last] = dots else { return Err(format!("{dots:?}").into()) };
    let left = dots.iter().filter(|[x, _]| x - first[0] < 2.0);
    Ok([first[0], last[0], left.map(|dot| dot[1]).fold(0.0, f64::max)])
}

/// A cube of twice the size is drawn twice as large, with its corner in the same place; who turns one turns both.
pub fn bodies_in_space_are_as_large_and_turn_together(browser: &mut Browser) -> Outcome {
    let (large, small) = (cube(0.1, 3)?, cube(0.05, 2)?);
    opened(browser, &[("large", &large), ("small", &small)])?;
    let compare = |browser: &mut Browser| -> Outcome {
        let [a, b, c] = extent(&moved_dots(browser, "#stage")?)?;
        let [d, e, f] = extent(&moved_dots(browser, "#stage-2")?)?;
        assert!((b - a - 2.0 * (e - d)).abs() < 2.0, "{a} {b}, {d} {e}");
        assert!((a - d).abs() < 1.0 && (c - f).abs() < 1.0, "{a} {c}, {d} {f}");
        Ok(())
    };
    compare(browser)?;
    let picture = "document.querySelector('#stage-2').toDataURL()";
    let before = browser.text(picture)?;
    let middle = browser.place("#stage", [0.5, 0.5])?;
    browser.drag(&[middle, [middle[0] + 20.0, middle[1] + 10.0]])?;
    assert_ne!(browser.text(picture)?, before);
    compare(browser)
}

/// A metre has as many pixels in the plane as in space, where the front is seen askew, by 30 degrees.
pub fn a_plane_and_a_space_have_one_scale(browser: &mut Browser) -> Outcome {
    let (square, cube) = (square()?, cube(0.3, 2)?);
    opened(browser, &[("square", &square), ("cube", &cube)])?;
    let [a, b, _] = extent(&moved_dots(browser, "#stage")?)?;
    let [c, d, _] = extent(&moved_dots(browser, "#stage-2")?)?;
    let [flat, solid] = [(b - a) / 0.1, (d - c) / (0.3 * (3.0_f64 / 4.0).sqrt())];
    // a pixel of 0.1 m, of which there are 50 or so
    assert!((flat / solid - 1.0).abs() < 0.03, "{flat} {solid} pixels per metre");
    Ok(())
}

/// A saved frame has the names and the cells of all motions.
pub fn all_of_them_are_saved(browser: &mut Browser) -> Outcome {
    opened(browser, &[("<one>", &square()?), ("other", &other()?)])?;
    let [_, _, text] = offered(browser, "#svg")?;
    let document = roxmltree::Document::parse(&text)?;
    let written = |name| document.descendants().any(|node| node.text() == Some(name));
    assert!(written("<one>") && written("other"), "{text}");
    let cells = |corners| {
        let is_cell = |node: &roxmltree::Node| {
            let path = node.attribute("d").unwrap_or_default();
            path.matches(['M', 'L']).count() == corners
                && node.attribute("fill").is_some_and(|fill| fill.starts_with("rgb"))
        };
        document.descendants().filter(is_cell).count()
    };
    assert_eq!([cells(3), cells(4)], [18, 36]);
    let [_, kind, _] = offered(browser, "#png")?;
    assert_eq!(kind, "image/png");
    Ok(())
}

pub fn they_stand_one_below_the_other_on_a_phone(browser: &mut Browser) -> Outcome {
    opened(browser, &[("one", &square()?), ("other", &other()?)])?;
    let tops = "['#stage', '#stage-2'].map((id) => document.querySelector(id).getBoundingClientRect().top)";
    let below = |browser: &mut Browser| browser.number(&format!("(([a, b]) => b - a)({tops})"));
    assert_eq!(below(browser)?, 0.0);
    browser.resize([360, 740], true)?;
    browser
        .wait_until("innerWidth === 360 && document.querySelector('#stage').clientWidth < 360")?;
    assert_eq!(browser.number("document.documentElement.scrollWidth")?, 360.0);
    assert!(below(browser)? > 200.0);
    Ok(())
}

/// Pages that were written before give the same page as the motions themselves, to the last byte.
#[test]
fn pages_are_joined() -> Outcome {
    let directory = tempfile::tempdir()?;
    let [one, other_page, both, joined] =
        ["one", "other", "both", "joined"].map(|name| directory.path().join(name));
    let (long, short) = (square()?, other()?);
    write_animation(&long, &one, "a title")?;
    write_animation(&short, &other_page, "")?;
    write_animations(&[("<1>", &long), ("2", &short)], &both, "Both")?;
    join_animations(&[("<1>", &one), ("2", &other_page)], &joined, "Both")?;
    assert!(fs::read(&both)? == fs::read(&joined)?);

    let [strange, old] = ["strange", "old"].map(|name| directory.path().join(name));
    fs::write(&strange, "<p>a page</p>")?;
    fs::write(&old, fs::read_to_string(&one)?.replace("\"version\":\"", "\"version\":\"0."))?;
    for (page, part) in [
        (&strange, "no animation of pliant"),
        (&old, "written by version 0."),
        (&both, "it shows 2 motions"),
        (&directory.path().join("nowhere"), "nowhere"),
    ] {
        let error = join_animations(&[("1", &one), ("2", page)], &joined, "").unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
    let error = write_animations(&[], &both, "").unwrap_err().to_string();
    assert!(error.contains("at least one"), "{error}");
    Ok(())
}
