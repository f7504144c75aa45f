//! The motion as a page for a web browser.
//!
//! All computing is done in Rust: `data.rs` has the motion as JSON, and the page is one HTML file with style
//! and script; the script decodes, interpolates and draws. It is plain JavaScript in one module scope, its
//! files concatenated. Code of one motion is within a function (`picture`), called for each: its data
//! (`motion`), drawing in the plane and in space (`plane`, `space`, chosen by `stage`), forces of obstacles
//! (`contacts`), and gravity, fields and remanences (`acting`). Shared by all motions are numbers and colours
//! (`decode`, `moment`, `format`, `paint`, `colour`), the visible part of space (`view`), charts (`chart`,
//! `sensors`), `arrow`, `arrows`, frames as files (`saving`; `vectors` replaces a canvas and stores the
//! drawing as SVG), and time (`controls`, `player`). `motions` combines several: those with the same number
//! of axes in the box around all of them, a metre with as many pixels in each picture as in the one with the
//! least space, and colour scales to the largest end. Data of a motion are thus independent of others, and
//! existing pages can be joined.
//!
//! A policy in the page forbids it any request. Text of users reaches the page as JSON with `<` escaped and
//! is set as text, never as HTML. HTML above the motions (`Above`), as that of the advice, is written by Rust
//! with text of users escaped and inserted last, so that no text can be mistaken for a placeholder.
//! `tests/animation/` drives pages in a headless Chromium over the pipes of its DevTools protocol by a small
//! module of its own: crates for it bring the whole protocol, generated, or need a WebDriver server.

mod acting;
mod colours;
mod contacts;
mod data;
mod geometry;
mod lines;
#[cfg(feature = "play")]
mod live;
mod pack;

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

#[cfg(feature = "play")]
pub(crate) use self::live::Picture;
use super::write_file;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;

/// The page, its style and its script; `/*...*/` marks the place of the others.
const PAGE: &str = include_str!("page/page.html");
/// HTML of the player, in place of `<!--motions-->`, if there are any motions.
const MOTIONS: &str = include_str!("page/motions.html");
/// The body and its colours, in place of `<!--picture-->`: the page of a live motion has the same.
const PICTURE: &str = include_str!("page/picture.html");
const STYLE: &str = concat!(include_str!("page/base.css"), include_str!("page/page.css"));
/// Colours, letters and cards of all pages.
#[cfg(feature = "sweep")]
pub(crate) const BASE_STYLE: &str = include_str!("page/base.css");
const SCRIPT: &str = concat!(
    include_str!("page/decode.js"),
    include_str!("page/moment.js"),
    include_str!("page/format.js"),
    include_str!("page/paint.js"),
    include_str!("page/view.js"),
    include_str!("page/colour.js"),
    include_str!("page/chart.js"),
    include_str!("page/sensors.js"),
    include_str!("page/arrow.js"),
    include_str!("page/arrows.js"),
    include_str!("page/vectors.js"),
    include_str!("page/controls.js"),
    include_str!("page/picture.js"),
    include_str!("page/motions.js"),
    include_str!("page/saving.js"),
    include_str!("page/player.js"),
);
/// Script of each single motion, in place of `/*picture*/` in the script.
const OF_EACH: &str = concat!(
    include_str!("page/motion.js"),
    include_str!("page/plane.js"),
    include_str!("page/space.js"),
    include_str!("page/stage.js"),
    include_str!("page/contacts.js"),
    include_str!("page/needles.js"),
    include_str!("page/acting.js"),
    include_str!("page/lines.js"),
);
/// HTML before and after the data of a page.
const DATA: [&str; 2] = ["<script type=\"application/json\" id=\"data\">", "</script>"];

/// Writes the motion as one HTML file that a web browser plays, without a network.
///
/// It shows the body coloured by stress, strain energy density, stretch, contact pressure or what sticks, obstacles, springs (coloured while an
/// actuator pulls or pushes), point masses, held and moved nodes, devices, gravity, the magnetic field and remanences as arrows, forces of obstacles
/// likewise; below it the
/// energies and what sensors have read over time, and how the motion was computed, with the warnings of the
/// report. The shown frame can be saved as PNG or SVG. `title` is its heading. Obstacles that are given by a
/// function are not drawn.
///
/// Between samples the page interpolates linearly. Of long runs it holds a part of the samples, evenly spread
/// over their order: a few hundred at most, for a file of about 2 MB at most unless the mesh is very fine.
/// The page says so. Positions are kept to 1/65535 of the extent of the motion, values of cells to 1/255 of
/// their scale; the scale ends at the 99th percentile of all cells and times.
///
/// # Errors
/// [`Error::Output`] if the file cannot be written; [`Error::Input`] if a user's own distance function is not
/// defined where the body was, so that the forces of its obstacle are not known.
///
/// ```
/// use pliant::output::write_animation;
/// # use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
/// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// # let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
/// #     .phase(Phase::until(0.01).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("animation.html");
/// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.001))?;
/// write_animation(&trajectory, &path, "A square is pressed")?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn write_animation(
    trajectory: &Trajectory,
    path: impl AsRef<Path>,
    title: &str,
) -> Result<(), Error> {
    write_animations(&[("", trajectory)], path, title)
}

/// As [`write_animation`], with several motions side by side, each with its name.
///
/// One clock plays them, in the same part of space, on one scale, and with the same colours for the same
/// values. Charts have the lines of all of them. Scenes, meshes, methods and times may be different; a motion
/// that has ended keeps its last state.
///
/// # Errors
/// Those of [`write_animation`]; [`Error::Input`] without any motion.
///
/// ```
/// use pliant::output::write_animations;
/// # use pliant::{Method, Sampling, Settings, samples::beam_jump};
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("methods.html");
/// let scene = beam_jump()?;
/// let run = |method| {
///     scene.simulate(&Settings { method, ..Settings::default() }, &Sampling::every(0.01))
/// };
/// let (bdf, rk) = (run(Method::CvodeBdf)?, run(Method::Rk)?);
/// write_animations(&[("BDF", &bdf), ("Runge-Kutta", &rk)], &path, "A beam jumps twice")?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn write_animations(
    motions: &[(&str, &Trajectory)],
    path: impl AsRef<Path>,
    title: &str,
) -> Result<(), Error> {
    let motions = motions.iter().map(|(name, trajectory)| data::gather(trajectory, name));
    write_page(motions.collect::<Result<_, _>>()?, path.as_ref(), title)
}

/// As [`write_animations`], with the motions of pages that have been written before, by name and file:
/// nothing is computed again.
///
/// # Errors
/// [`Error::Read`] for a file that cannot be read; [`Error::Input`] without any file, and for one that holds
/// no motion, several, or one of another version of pliant; [`Error::Output`] if the page cannot be written.
///
/// ```
/// use pliant::output::{join_animations, write_animation};
/// # use pliant::{Sampling, Settings, samples::beam_jump};
/// # let directory = tempfile::tempdir().unwrap();
/// # let [one, both] = ["one.html", "both.html"].map(|name| directory.path().join(name));
/// # let trajectory = beam_jump()?.simulate(&Settings::default(), &Sampling::every(0.01))?;
/// write_animation(&trajectory, &one, "A beam jumps")?;
/// join_animations(&[("one", &one), ("the same", &one)], &both, "Twice the same")?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn join_animations<P: AsRef<Path>>(
    pages: &[(&str, P)],
    path: impl AsRef<Path>,
    title: &str,
) -> Result<(), Error> {
    let motions = pages.iter().map(|(name, page)| {
        let mut motion = read_motion(page.as_ref())?;
        motion["name"] = (*name).into();
        Ok(motion)
    });
    write_page(motions.collect::<Result<_, Error>>()?, path.as_ref(), title)
}

fn write_page(motions: Vec<Value>, path: &Path, title: &str) -> Result<(), Error> {
    if motions.is_empty() {
        let help = "name at least one motion to be shown";
        return Err(InputError::new("motions", "none", help).into());
    }
    let page = page(&Above::default(), motions, title);
    write_file(path, |file| file.write_all(page.as_bytes()))
}

/// Content of a page above its motions: HTML, in which text of users is [`escaped`], and its style.
#[derive(Debug, Default)]
pub(crate) struct Above<'a> {
    pub(crate) html: &'a str,
    pub(crate) style: &'a str,
}

/// As [`write_animations`], below other content; without motions only that content.
///
/// # Errors
/// Those of [`write_animation`].
#[cfg(feature = "study")]
pub(crate) fn write_below(
    above: &Above,
    motions: &[(&str, &Trajectory)],
    path: &Path,
    title: &str,
) -> Result<(), Error> {
    let motions = motions.iter().map(|(name, trajectory)| data::gather(trajectory, name));
    let page = page(above, motions.collect::<Result<_, _>>()?, title);
    write_file(path, |file| file.write_all(page.as_bytes()))
}

fn page(above: &Above, motions: Vec<Value>, title: &str) -> String {
    let parts = if motions.is_empty() { "" } else { MOTIONS };
    let data = json!({ "version": env!("CARGO_PKG_VERSION"), "title": title, "motions": motions });
    let script = SCRIPT.replace("/*picture*/", OF_EACH);
    let style = [STYLE, above.style].concat();
    let page = filled(&PAGE.replace("<!--motions-->", parts), &style, &script, &data);
    // free text is inserted last: no marker begins in escaped text, nor in data
    page.replace("<!--title-->", &escaped(title)).replace("<!--above-->", above.html)
}

/// Text escaped for HTML, within elements and attributes.
pub(crate) fn escaped(text: &str) -> String {
    let named = [('&', "&amp;"), ('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")];
    named.iter().fold(text.to_owned(), |text, (sign, name)| text.replace(*sign, name))
}

/// The motion of the page in the file at `path`.
fn read_motion(path: &Path) -> Result<Value, Error> {
    let text = fs::read_to_string(path)
        .map_err(|source| Error::Read { path: path.to_path_buf(), source })?;
    let [before, after] = DATA;
    let data = text.split_once(before).and_then(|(_, rest)| rest.split_once(after));
    let data = data.and_then(|(data, _)| serde_json::from_str::<Value>(data).ok());
    let refuse = |help| Err(InputError::new("animation", path.display(), help).into());
    let Some(mut data) = data else {
        return refuse("it is no animation of pliant: format html of a run writes one".to_string());
    };
    let (version, present) = (&data["version"], env!("CARGO_PKG_VERSION"));
    if version != present {
        let version = version.as_str().unwrap_or("another one");
        return refuse(format!(
            "it was written by version {version}, and this is {present}: run the scene again"
        ));
    }
    match data["motions"].as_array_mut().map(Vec::as_mut_slice) {
        Some([motion]) => Ok(motion.take()),
        motions => refuse(format!(
            "it shows {} motions: name the pages of single ones",
            motions.map_or(0, |motions| motions.len())
        )),
    }
}

/// A page with its style, its script and its data.
fn filled(page: &str, style: &str, script: &str, data: &Value) -> String {
    // within a string of JSON this is the same character, but it cannot begin a tag of HTML
    let data = data.to_string().replace('<', "\\u003c");
    let page = page
        .replace("<!--picture-->", PICTURE)
        .replace("/*style*/", style)
        .replace("/*script*/", script);
    page.replace("/*data*/", &data)
}
