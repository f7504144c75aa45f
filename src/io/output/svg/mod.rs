//! Pictures of the deformed body.

mod acting;
mod layout;
mod mark;
mod obstacle;
mod panel;
mod projection;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use acting::{Acting, sign};
pub(super) use layout::{BAR_WIDTH, View};
use layout::{Layout, scale_bar};
use mark::{Mark, text};
use panel::Panel;
pub(super) use panel::{around, through_middle};
pub(super) use projection::{displaced, drawn, positions};
use svg::Document;
use svg::node::element::{Definitions, Group, Line, Path as Outline, Pattern};

use super::{FONT, INK, write_file};
use crate::base::input::{InputError, finite};
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::mesh::Selection;
use crate::io::output::role::Role;

/// Snapshots of a motion: one panel per chosen time, all on the same scale, each with the deformed
/// mesh, the obstacles, and the nodes that the phase holds or moves. Arrows beside its caption are gravity and the uniform part of the
/// magnetic field at that time, as long as they are strong beside the largest of the run; those on magnets are their remanence, in some cells of each.
///
/// A one-dimensional body is drawn upright, its axis upward, with a visible width. A body in space
/// is seen obliquely, from the front, the right and above, with z upward and without obstacles.
///
/// ```
/// use pliant::output::Snapshots;
/// # use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
/// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// # let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
/// #     .phase(Phase::until(0.01).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("snapshots.svg");
/// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
/// Snapshots::at([0.0, 0.01]).title("A square is pressed").write(&trajectory, &path)?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshots {
    times: Vec<f64>,
    title: String,
    columns: Option<usize>,
    marked: Option<Selection>,
}

impl Snapshots {
    /// One panel for each of `times` (s): the sample nearest to it, labelled with its own time.
    pub fn at(times: impl Into<Vec<f64>>) -> Self {
        Self { times: times.into(), title: String::new(), columns: None, marked: None }
    }

    /// Title above the panels. Default: none.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Panels side by side. Default: as many as make a page wider than high.
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = Some(columns);
        self
    }

    /// Nodes to be marked by rings in all panels. Default: none.
    pub fn mark(mut self, nodes: impl Into<Selection>) -> Self {
        self.marked = Some(nodes.into());
        self
    }

    /// Draws `trajectory` to an SVG file.
    ///
    /// # Errors
    /// [`Error::Input`] for no times, a time that is not finite, 0 columns or marked nodes that do
    /// not exist, before anything is written; [`Error::Output`] if the file cannot be written.
    pub fn write(&self, trajectory: &Trajectory, path: impl AsRef<Path>) -> Result<(), Error> {
        let document = self.draw(trajectory)?;
        write_file(path.as_ref(), |file| svg::write(file, &document))
    }

    fn draw(&self, trajectory: &Trajectory) -> Result<Document, Error> {
        self.validate()?;
        let samples = self.times.iter().map(|&time| nearest(trajectory, time));
        let samples: Vec<&Sample> = samples.collect();
        let view = View::of(trajectory, &samples);
        let captions = captions(trajectory, &samples);
        let longest = captions.iter().map(|caption| caption.chars().count()).max().unwrap_or(0);
        let acting = Acting::of(trajectory)?;
        let titled = !self.title.is_empty();
        let mut layout = Layout::new(&view, self.columns, titled, (longest, acting.room()));
        let marks = samples.iter().map(|sample| self.marks(trajectory, sample));
        let marks: Vec<BTreeMap<usize, Mark>> = marks.collect::<Result<_, _>>()?;
        let kinds: BTreeSet<Mark> = marks.iter().flat_map(BTreeMap::values).copied().collect();
        let key = key(&view, &mut layout, kinds, &acting.meanings());

        let mut page = page(&layout);
        if !self.title.is_empty() {
            let title = text(&self.title, layout.margin(), 26.0).set("font-size", 17);
            page = page.add(title.set("font-weight", 600).set("fill", INK));
        }
        let panels = samples.into_iter().zip(&captions).zip(&marks).enumerate();
        for (number, ((sample, caption), marks)) in panels {
            let (view, layout, acting) = (&view, &layout, acting.at(trajectory, sample)?);
            let panel = Panel { number, caption, trajectory, sample, view, layout, marks, acting };
            page = page.add(panel.draw());
        }
        Ok(page.add(key))
    }

    fn validate(&self) -> Result<(), Error> {
        if self.times.is_empty() {
            let help = "name one time at least";
            return Err(InputError::new("snapshot times", "[]", help).into());
        }
        finite("the snapshot times", &self.times)?;
        match self.columns {
            Some(0) => {
                Err(InputError::new("snapshot columns", 0, "draw one column at least").into())
            }
            _ => Ok(()),
        }
    }

    /// The nodes to be marked in one panel. A node that is held along one axis and moved along another counts
    /// as moved.
    fn marks(
        &self,
        trajectory: &Trajectory,
        sample: &Sample,
    ) -> Result<BTreeMap<usize, Mark>, Error> {
        let scene = trajectory.scene();
        let mut marks = BTreeMap::new();
        if let Some(selection) = &self.marked {
            let nodes = scene.body().mesh().select(selection)?;
            marks.extend(nodes.into_iter().map(|node| (node, Mark::Ring)));
        }
        let mut constrained = scene.constrained_nodes(trajectory.phase_of(sample)?)?;
        constrained.sort_by_key(|&(_, role)| role);
        marks.extend(constrained.into_iter().map(|(node, role)| match role {
            Role::Held => (node, Mark::Held),
            Role::Moved => (node, Mark::Moved),
        }));
        Ok(marks)
    }
}

fn nearest(trajectory: &Trajectory, time: f64) -> &Sample {
    let distance = |sample: &&Sample| (sample.time - time).abs();
    let nearest = |a: &&Sample, b: &&Sample| distance(a).total_cmp(&distance(b));
    trajectory.samples().iter().min_by(nearest).unwrap_or_else(|| trajectory.last())
}

/// Time and phase of each sample.
fn captions(trajectory: &Trajectory, samples: &[&Sample]) -> Vec<String> {
    let decimals = decimals(samples);
    let phases = trajectory.scene().phases();
    let caption = |s: &&Sample| {
        let time = format!("{:.decimals$}", s.time);
        let time = time.trim_end_matches('0').trim_end_matches('.');
        format!("t = {time} s, {}", phases[s.phase].name())
    };
    samples.iter().map(caption).collect()
}

/// Decimals that keep the times of all samples apart: 2 at least.
fn decimals(samples: &[&Sample]) -> usize {
    let end = samples.iter().map(|sample| sample.time).fold(0.0, f64::max);
    let enough = |decimals: &usize| {
        let scale = 10f64.powi(*decimals as i32);
        samples.iter().all(|s| ((s.time * scale).round() / scale - s.time).abs() <= 1e-6 * end)
    };
    (2..6).find(enough).unwrap_or(6)
}

fn page(layout: &Layout) -> Document {
    let [width, height] = layout.size();
    let hatch = Pattern::new()
        .set("id", "hatch")
        .set("width", 6)
        .set("height", 6)
        .set("patternUnits", "userSpaceOnUse")
        .set("patternTransform", "rotate(45)")
        .add(Line::new().set("y2", 6).set("stroke", "#8a8a8a").set("stroke-width", 1.6));
    Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", width)
        .set("height", height)
        .set("font-family", FONT)
        .set("font-size", 13)
        .add(Definitions::new().add(hatch))
        .add(Outline::new().set("d", format!("M0 0H{width}V{height}H0z")).set("fill", "white"))
}

/// Scale bar and what marks and arrows mean, below the panels; the page becomes wide enough for it.
fn key(
    view: &View,
    layout: &mut Layout,
    marks: BTreeSet<Mark>,
    arrows: &[(&'static str, &'static str)],
) -> Group {
    let (length, label) = scale_bar(view.width());
    let (x, y, width) = (layout.margin(), layout.key_line(), layout.pixels(length));
    let bar = format!("M{x:.2} {:.2}v6m0 -3h{width:.2}m0 -3v6", y - 8.0);
    let bar = Outline::new().set("d", bar).set("fill", "none").set("stroke", INK);
    let mut key = Group::new().set("fill", INK).set("class", "key").add(bar);
    key = key.add(text(&label, x + width + 8.0, y));
    let wide = |name: &str| 7.8 * name.len() as f64;
    let of_marks: f64 = marks.iter().map(|mark| wide(mark.name()) + 26.0).sum();
    let of_arrows: f64 = arrows.iter().map(|(_, name)| wide(name) + 40.0).sum();
    layout.widen(2.0 * x + width + 8.0 + wide(&label) + of_marks + of_arrows);
    let mut right = layout.size()[0] as f64 - layout.margin();
    for (colour, name) in arrows.iter().rev() {
        right -= wide(name);
        key = key.add(text(name, right, y));
        right -= 24.0;
        key = key.add(sign(right, y, colour));
        right -= 16.0;
    }
    for mark in marks.into_iter().rev() {
        right -= wide(mark.name());
        key = key.add(text(mark.name(), right, y));
        right -= 10.0;
        key = key.add(mark.draw(right, y - 4.5));
        right -= 16.0;
    }
    key
}
