//! The motion as a page for a web browser.

mod contacts;
mod data;
mod geometry;
#[cfg(feature = "play")]
mod live;
mod pack;

use std::path::Path;

use serde_json::Value;

#[cfg(feature = "play")]
pub(crate) use self::live::Picture;
use super::write_file;
use crate::error::Error;
use crate::trajectory::Trajectory;

/// The page, its style and its script; `/*...*/` marks the place of the others.
const PAGE: &str = include_str!("page/page.html");
/// The body and its colours, in place of `<!--picture-->`: the page of a live motion has the same.
const PICTURE: &str = include_str!("page/picture.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = concat!(
    include_str!("page/decode.js"),
    include_str!("page/motion.js"),
    include_str!("page/format.js"),
    include_str!("page/paint.js"),
    include_str!("page/plane.js"),
    include_str!("page/space.js"),
    include_str!("page/stage.js"),
    include_str!("page/chart.js"),
    include_str!("page/sensors.js"),
    include_str!("page/contacts.js"),
    include_str!("page/vectors.js"),
    include_str!("page/controls.js"),
    include_str!("page/saving.js"),
    include_str!("page/player.js"),
);

/// Writes the motion as one HTML file that a web browser plays, without a network: the body
/// coloured by stress or strain energy density, obstacles, springs (coloured while an actuator
/// pulls or pushes), point masses, held and moved nodes, forces of obstacles as arrows; below it the energies and what
/// sensors have read over time, and how the motion was computed, with the warnings of the report. The shown frame can
/// be saved as PNG or SVG. `title` is its heading. Obstacles that are given by a function are not drawn.
///
/// Between samples the page interpolates linearly. Of long runs it holds a part of the samples,
/// evenly spread over their order: a few hundred at most, for a file of about 2 MB at most unless
/// the mesh is very fine. It says so. Positions are kept to 1/65535 of the extent of the motion,
/// values of cells to 1/255 of their scale; the scale ends at the 99th percentile of all cells and
/// times.
///
/// # Errors
/// [`Error::Output`] if the file cannot be written; [`Error::Input`] if a distance function of one's own has no meaning
/// any more where the body was, so that the forces of its obstacle are not known.
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
    let data = data::gather(trajectory, title)?;
    let page = filled(PAGE, STYLE, SCRIPT, &data);
    write_file(path.as_ref(), |file| file.write_all(page.as_bytes()))
}

/// A page with its style, its script and its data.
fn filled(page: &str, style: &str, script: &str, data: &Value) -> String {
    // within a string of JSON this is the same character, and no tag of HTML can begin
    let data = data.to_string().replace('<', "\\u003c");
    let page = page
        .replace("<!--picture-->", PICTURE)
        .replace("/*style*/", style)
        .replace("/*script*/", script);
    page.replace("/*data*/", &data)
}
