//! What a person sees.

use pliant::samples::beam_jump;
use pliant::{
    Body, Cells, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings, SolidCells,
    Strain,
};

use super::Outcome;
use super::browser::Browser;
use super::page::*;

/// No part of the page is wider than a phone, and on it all is there; in the dark it is dark.
pub fn it_fits_a_phone_and_the_dark(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &square()?)?;
    let background = "getComputedStyle(document.documentElement).backgroundColor
        .match(/\\d+/g).map(Number).reduce((sum, x) => sum + x)";
    let ink = "getComputedStyle(document.querySelector('h1')).color
        .match(/\\d+/g).map(Number).reduce((sum, x) => sum + x)";
    assert!(browser.number(background)? > 600.0 && browser.number(ink)? < 150.0);
    let light = browser.text("document.querySelector('#plot').toDataURL()")?;
    browser.prefer("dark")?;
    browser.wait_until(&format!("({background}) < 100 && ({ink}) > 600"))?;
    // the picture follows, though nothing was pressed
    browser.wait_until(&format!("document.querySelector('#plot').toDataURL() !== {light:?}"))?;

    browser.resize([360, 740], true)?;
    browser
        .wait_until("innerWidth === 360 && document.querySelector('#stage').clientWidth < 360")?;
    browser.evaluate("document.querySelector('details').open = true")?;
    assert_eq!(browser.number("document.documentElement.scrollWidth")?, 360.0);
    let beyond = browser.text(
        "[...document.querySelectorAll('body *')].filter((element) => {
           const box = element.getBoundingClientRect();
           return box.width && (box.right > 360 || box.left < 0); })
         .map((element) => element.tagName + element.id).join()",
    )?;
    assert_eq!(beyond, "");
    let small = browser.text(
        "[...document.querySelectorAll('button, select, input')].filter((element) =>
           element.getBoundingClientRect().height < 32).map((element) => element.outerHTML).join()",
    )?;
    assert_eq!(small, "", "too small for a finger");
    let [coloured, _] = colours(browser, "#stage")?;
    assert!(coloured > 500, "{coloured} pixels");
    let width = browser.number("document.querySelector('#stage').width")?;
    assert_eq!(width, browser.number("document.querySelector('#stage').clientWidth")?);
    browser.click("#play")?;
    browser.wait_until("Number(document.querySelector('#time').value) > 0.01")?;
    Ok(())
}

/// Whatever stands in a title or a name is shown as it is.
pub fn names_are_text(browser: &mut Browser) -> Outcome {
    let title = "</script><!-- \u{2028} '\"`${x}\\ &amp; <img src=x onerror=\"throw 1\">";
    let page = page(&square()?, title)?;
    browser.open(&page.path)?;
    assert_eq!(browser.text("document.querySelector('h1').textContent")?, title);
    assert_eq!(browser.number("document.querySelectorAll('script').length")?, 2.0);
    assert_eq!(browser.number("document.querySelectorAll('img').length")?, 0.0);
    let phase = browser.text("document.querySelector('#phase').textContent")?;
    assert!(phase.contains("</script><script>throw 1</script>"), "{phase}");
    let report = browser.text("document.querySelector('#report').textContent")?;
    assert!(report.contains("auto, rtol 1e-5"), "{report}");
    Ok(())
}

/// What makes a result doubtful stands above the picture.
pub fn warnings_are_shown(browser: &mut Browser) -> Outcome {
    let settings = Settings { method: Method::Rk, ..Settings::default() };
    let trajectory = beam_jump()?.simulate(&settings, &Sampling::every(0.01))?;
    let warnings = trajectory.report().warnings();
    assert!(!warnings.is_empty(), "the explicit method finds the beam stiff");
    let _page = shown(browser, &trajectory)?;
    let found = browser.text("document.querySelector('#warnings').innerText")?;
    assert_eq!(found.trim(), warnings.join("\n"));
    let _page =
        shown(browser, &beam_jump()?.simulate(&Settings::default(), &Sampling::every(0.01))?)?;
    assert_eq!(browser.evaluate("document.querySelector('#warnings').hidden")?, true);
    Ok(())
}

/// A cube on a ball, a string, a bar: they are drawn in colour, and the picture changes with time.
/// Bodies in space turn.
pub fn bodies_of_all_dimensions(browser: &mut Browser) -> Outcome {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
    let sampling = Sampling::every(0.01);
    let floor = Obstacle::half_plane([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]).stiffness(100.0);
    let ball = Obstacle::disc([0.05, 0.05, -0.01], 0.03).named("ball").stiffness(100.0);
    let block = Obstacle::box_between([0.2, 0.0, 0.0], [0.25, 0.1, 0.1]).named("block");
    let pill = Obstacle::capsule([-0.1, 0.0, 0.0], [-0.1, 0.1, 0.1], 0.02).named("pill");
    let solid = |cells, nodes| -> Result<Scene, pliant::Error> {
        let mesh =
            Mesh::cuboid([0.1, 0.1, 0.1], [nodes; 3], cells)?.translated(&[0.0, 0.0, 0.03])?;
        let scene = Scene::new(Body::new(mesh, soft).strain(Strain::Green).build()?);
        let scene = scene.gravity([0.0, 0.0, -9.8]).obstacle(floor.clone()).obstacle(ball.clone());
        let scene =
            scene.obstacle(block.clone().stiffness(1.0)).obstacle(pill.clone().stiffness(1.0));
        Ok(scene.phase(Phase::until(0.1)))
    };
    let string = Mesh::bar(0.2, 11)?.mapped(|x| [x[0], 0.0])?;
    let string = Body::new(string, soft).strain(Strain::Green).area(1e-4).build()?;
    let string = Scene::new(string).gravity([0.0, -9.8]).phase(Phase::until(0.1).hold([1]));
    let membrane = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Triangles6)?;
    let membrane = membrane.mapped(|x| [x[0], x[1], 0.0])?;
    let membrane = Body::new(membrane, soft).strain(Strain::Green).thickness(0.002).build()?;
    let membrane =
        Scene::new(membrane).gravity([0.0, 0.0, -9.8]).phase(Phase::until(0.1).hold("left"));

    let picture = "document.querySelector('#stage').toDataURL()";
    let scenes = [
        (beam_jump()?, false),
        (string, false),
        (membrane, true),
        (solid(SolidCells::Hexahedra, 3)?, true),
        (solid(SolidCells::Tetrahedra10, 2)?, true),
    ];
    for (number, (scene, in_space)) in scenes.into_iter().enumerate() {
        let page = page(&scene.simulate(&Settings::default(), &sampling)?, "")?;
        browser.open(&page.path)?;
        browser.press("End", false)?;
        let [coloured, _] = colours(browser, "#stage")?;
        assert!(coloured > 500, "scene {number}: {coloured} pixels");
        let end = browser.text(picture)?;
        for _ in 0..5 {
            browser.press("ArrowLeft", false)?;
        }
        assert_ne!(browser.text(picture)?, end, "scene {number}");
        if in_space {
            browser.press("End", false)?;
            let middle = browser.place("#stage", [0.5, 0.5])?;
            browser.drag(&[middle, [middle[0] + 60.0, middle[1] + 20.0]])?;
            let turned = browser.text(picture)?;
            assert_ne!(turned, end, "scene {number} turns by the mouse");
            browser.press("ArrowLeft", false)?;
            assert_ne!(browser.text(picture)?, turned, "scene {number} turns by the keyboard");
            assert_eq!(browser.number("Number(document.querySelector('#time').value)")?, 0.1);
        }
        let complaints = browser.complaints();
        assert!(complaints.is_empty(), "scene {number}: {complaints:?}");
    }
    Ok(())
}

/// A solid is seen from the front, the right and above: all nodes of its front, and of its back those of
/// the edges that it shares with the right side and the top.
pub fn the_near_side_of_a_solid_is_seen(browser: &mut Browser) -> Outcome {
    let mesh = Mesh::cuboid([0.1, 0.1, 0.1], [3, 3, 3], SolidCells::Hexahedra)?;
    let still = [0.0, 0.0, 0.0];
    let scene = Scene::new(Body::new(mesh, RUBBER).strain(Strain::Cauchy).build()?)
        .phase(Phase::until(0.01).move_nodes("front", still))
        .phase(Phase::until(0.02).move_nodes("back", still));
    let _page = shown(browser, &scene.simulate(&Settings::default(), &Sampling::every(0.01))?)?;
    assert_eq!(moved_dots(browser, "#stage")?.len(), 9);
    browser.press("End", false)?;
    assert_eq!(moved_dots(browser, "#stage")?.len(), 5);
    Ok(())
}

/// The page of a long run says that it is thinned.
pub fn long_runs_are_thinned(browser: &mut Browser) -> Outcome {
    let trajectory = beam_jump()?.simulate(&Settings::default(), &Sampling::every(5e-4))?;
    let _page = shown(browser, &trajectory)?;
    let facts = browser.text("document.querySelector('#facts').textContent")?;
    assert!(facts.contains("800 of 1,201"), "{facts}");
    Ok(())
}
