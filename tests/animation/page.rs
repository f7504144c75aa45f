//! Animations to be tried, and what is read from them.

use std::error::Error;
use std::path::PathBuf;

use pliant::output::write_animation;
use pliant::{
    Body, Cells, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings, Shape, Spring, Strain,
    Trajectory,
};
use tempfile::TempDir;

use super::browser::Browser;

pub const RUBBER: Material =
    Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// Speed at which the square is pressed (m/s), and until when (s).
pub const PUSH: f64 = 0.5;
pub const PRESSED: f64 = 0.1;
pub const END: f64 = 0.16;

/// A square that is pressed and let go over obstacles of all kinds; a mass hangs on a spring, which
/// pulls and then pushes. All names are hostile to HTML.
pub fn square() -> Result<Trajectory, pliant::Error> {
    square_scene()?.simulate(&Settings::default(), &Sampling::every(0.01))
}

pub fn square_scene() -> Result<Scene, pliant::Error> {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01).point_mass(
        "bob",
        [0.5, 0.1],
        0.1,
    );
    let named = |name: &str, shape: Shape| Obstacle::new(shape).named(name).stiffness(1e3);
    let pair = [Shape::disc([0.0, -0.2], 0.03), Shape::capsule([0.1, -0.2], [0.2, -0.2], 0.03)];
    let press = Phase::until(PRESSED).named("</script><script>throw 1</script>");
    let scene = Scene::new(body.build()?)
        .gravity([0.0, -9.8])
        .spring(Spring::between([4], "bob").named("\"<b>\"").stiffness(50.0))
        .obstacle(named("floor", Shape::half_plane([0.0, 0.0], [0.0, 1.0])))
        .obstacle(named("bowl", Shape::cavity([0.2, 0.2], 0.9)))
        .obstacle(named("step", Shape::box_between([0.6, 0.0], [0.7, 0.1])).velocity([1.0, 0.0]))
        .obstacle(named("pair", Shape::union(pair)))
        .obstacle(Obstacle::custom(|_, _| 1.0).named("own").stiffness(1.0))
        .phase(press.hold("bottom").move_nodes([14, 15], [0.0, -PUSH]).actuate(["\"<b>\""], -1.0))
        .phase(Phase::until(END).named("free").actuate(["\"<b>\""], 1.0));
    Ok(scene)
}

/// An animation in a directory of its own, which goes with it.
pub struct Page {
    pub path: PathBuf,
    _directory: TempDir,
}

pub fn page(trajectory: &Trajectory, title: &str) -> Result<Page, Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("animation.html");
    write_animation(trajectory, &path, title)?;
    Ok(Page { path, _directory: directory })
}

/// Opens the page of `trajectory`, paused at the start.
pub fn shown(browser: &mut Browser, trajectory: &Trajectory) -> Result<Page, Box<dyn Error>> {
    let page = page(trajectory, "Title")?;
    browser.open(&page.path)?;
    Ok(page)
}

/// Time on the clock (s).
pub fn clock(browser: &mut Browser) -> Result<f64, Box<dyn Error>> {
    let text = browser.text("document.querySelector('#clock').textContent")?;
    Ok(text.trim_end_matches(" s").parse()?)
}

/// Copies the pixels of a canvas, so that its own way of drawing stays what it is.
pub const PIXELS: &str = "(selector) => {
    const canvas = document.querySelector(selector);
    const copy = new OffscreenCanvas(canvas.width, canvas.height);
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height);
}";

/// Pixels of a canvas that are coloured (its background, ink, grid and hatching are grey), as the
/// number of them and the number of different colours.
pub fn colours(browser: &mut Browser, canvas: &str) -> Result<[usize; 2], Box<dyn Error>> {
    let found = browser.evaluate(&format!(
        "(() => {{ const {{ data }} = ({PIXELS})({canvas:?});
           let count = 0; const different = new Set();
           for (let k = 0; k < data.length; k += 4) {{
             const rgb = [data[k], data[k + 1], data[k + 2]];
             if (Math.max(...rgb) - Math.min(...rgb) < 40) continue;
             count++; different.add(rgb.join());
           }}
           return [count, different.size]; }})()"
    ))?;
    Ok(serde_json::from_value(found)?)
}

/// Centres of the orange dots at the moved nodes in the picture (px), from left to right.
pub fn moved_dots(browser: &mut Browser, canvas: &str) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let found = browser.evaluate(&format!(
        "(() => {{ const {{ data, width }} = ({PIXELS})({canvas:?});
           const dots = [];
           for (let k = 0; k < data.length; k += 4) {{
             if (data[k] !== 213 || data[k + 1] !== 94 || data[k + 2] !== 0) continue;
             const [x, y] = [(k / 4) % width, Math.floor(k / 4 / width)];
             const dot = dots.find((dot) => Math.hypot(dot.x / dot.n - x, dot.y / dot.n - y) < 12);
             if (dot) {{ dot.x += x; dot.y += y; dot.n++; }} else dots.push({{ x, y, n: 1 }});
           }}
           return dots.map(({{ x, y, n }}) => [x / n, y / n]).sort((a, b) => a[0] - b[0]); }})()"
    ))?;
    Ok(serde_json::from_value(found)?)
}

/// Middle of the line in the chart of energies (px).
pub fn cursor(browser: &mut Browser) -> Result<f64, Box<dyn Error>> {
    browser.number(
        "(() => { const box = document.querySelector('#cursor').getBoundingClientRect();
           return box.left + box.width / 2; })()",
    )
}

/// An energy (J) as its button tells it, and half of its last digit; `motion` of those side by side.
pub fn energy(
    browser: &mut Browser,
    name: &str,
    motion: usize,
) -> Result<[f64; 2], Box<dyn Error>> {
    let text = browser.text(&format!(
        "[...document.querySelectorAll('#series button')].find((button) =>
           button.textContent.startsWith({name:?})).querySelectorAll('.value')[{motion}].textContent"
    ))?;
    let (number, unit) = text.split_once(' ').ok_or("no unit")?;
    let unit = match unit {
        "J" => 1.0,
        "mJ" => 1e-3,
        other => return Err(format!("unit {other}").into()),
    };
    let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let value: f64 = number.replace('\u{2212}', "-").parse()?;
    Ok([unit * value, 0.5 * unit * 10_f64.powi(-(decimals as i32))])
}
