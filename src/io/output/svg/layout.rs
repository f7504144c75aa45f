//! Positions of panels on the page, and the part of space in each.

use super::obstacle::{Outline, outlines};
use super::projection::{Point, drawn, positions};
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::forces::LinePoint;
use crate::scene::timeline::Scene;

/// Width that a page aims at, its least width, and the limits of a panel (px).
const PAGE_WIDTH: f64 = 900.0;
const PAGE_LEAST: f64 = 420.0;
const PANEL_WIDTH: [f64; 2] = [110.0, 400.0];
const MARGIN: f64 = 20.0;
const GAP: f64 = 16.0;
const CAPTION: f64 = 28.0;
const TITLE: f64 = 34.0;
const KEY: f64 = 34.0;
/// Mean width of a character of the captions (px).
const CHARACTER: f64 = 6.8;
/// Width of a one-dimensional body as drawn, as a fraction of its length.
pub(in crate::io::output) const BAR_WIDTH: f64 = 0.12;

/// The part of space that each panel shows (m), its second axis upward.
pub(in crate::io::output) struct View {
    low: Point,
    high: Point,
    /// Upper edge of the contents of each panel; a row of panels is only as high as its highest panel.
    tops: Vec<f64>,
    /// The obstacles of each panel.
    pub(super) obstacles: Vec<Vec<Outline>>,
    /// Places and directions of the needles of devices in each panel.
    pub(super) needles: Vec<Vec<[Point; 2]>>,
    /// Surfaces of liquids and devices in each panel.
    pub(super) lines: Vec<Vec<[Point; 2]>>,
}

impl View {
    /// All that `samples` show of the body, and the obstacles and needles that are near.
    pub(in crate::io::output) fn of(trajectory: &Trajectory, samples: &[&Sample]) -> Self {
        let mut view = Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
            tops: Vec::new(),
            obstacles: samples.iter().map(|sample| outlines(trajectory, sample)).collect(),
            needles: samples.iter().map(|sample| needles(trajectory, sample)).collect(),
            lines: samples.iter().map(|sample| lines(trajectory, sample)).collect(),
        };
        for sample in samples {
            let points = positions(trajectory, sample);
            view.tops.push(points.iter().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max));
            points.into_iter().for_each(|point| view.include(point));
        }
        anchors(trajectory.scene()).into_iter().for_each(|x| view.include(drawn(&x)));
        if trajectory.body().dimension() == 1 {
            let half = 2.0 * BAR_WIDTH * trajectory.body().mesh().size();
            view.include([-half, view.low[1]]);
            view.include([half, view.low[1]]);
        }
        let size = view.width().hypot(view.height());
        let centre = [0, 1].map(|i| (view.low[i] + view.high[i]) / 2.0);
        let near = |outlines: &Vec<Outline>| -> Vec<Point> {
            outlines.iter().flat_map(|outline| outline.near(centre, size)).collect()
        };
        let is_near = |x: &Point| (x[0] - centre[0]).hypot(x[1] - centre[1]) < 2.0 * size;
        let places =
            |needles: &Vec<[Point; 2]>| needles.iter().map(|[x, _]| *x).filter(is_near).collect();
        let mut near: Vec<Vec<Point>> = view.obstacles.iter().map(near).collect();
        for (near, needles) in near.iter_mut().zip(&view.needles) {
            let places: Vec<Point> = places(needles);
            near.extend(places);
        }
        for (number, points) in near.into_iter().enumerate() {
            for point in points {
                view.include(point);
                view.tops[number] = view.tops[number].max(point[1]);
            }
        }
        let pad = 0.06 * view.width().max(view.height());
        view.low.iter_mut().for_each(|x| *x -= pad);
        view.high.iter_mut().chain(&mut view.tops).for_each(|x| *x += pad);
        view
    }

    fn include(&mut self, point: Point) {
        for (i, x) in point.into_iter().enumerate() {
            self.low[i] = self.low[i].min(x);
            self.high[i] = self.high[i].max(x);
        }
    }

    /// Lower left and upper right corner.
    pub(in crate::io::output) fn corners(&self) -> [Point; 2] {
        [self.low, self.high]
    }

    pub(super) fn width(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    fn height(&self) -> f64 {
        self.high[1] - self.low[1]
    }

    /// The part of a convex polygon (or a line, of two points) within the view below `top`.
    pub(super) fn clip(&self, polygon: &[Point], top: f64) -> Vec<Point> {
        let ([left, bottom], right) = (self.low, self.high[0]);
        let above = clip(polygon, |x| x[1] - bottom);
        let below = clip(&above, |x| top - x[1]);
        clip(&clip(&below, |x| x[0] - left), |x| right - x[0])
    }

    /// The part of the view below `top` that is inside a half-plane, less than `depth` from its
    /// surface.
    pub(super) fn band(&self, top: f64, [point, normal]: [Point; 2], depth: f64) -> Vec<Point> {
        let distance = |x: &Point| (0..2).map(|i| (x[i] - point[i]) * normal[i]).sum::<f64>();
        let ([left, bottom], right) = (self.low, self.high[0]);
        let corners = vec![[left, bottom], [right, bottom], [right, top], [left, top]];
        let inside = clip(&corners, |x| -distance(x));
        clip(&inside, |x| distance(x) + depth)
    }
}

/// Lines along which surfaces of liquids meet walls at a sample (m), and those of devices.
fn lines(trajectory: &Trajectory, sample: &Sample) -> Vec<[Point; 2]> {
    let Ok(phase) = trajectory.phase_of(sample) else { return Vec::new() };
    let (scene, Sample { time, u, v, amounts, .. }) = (trajectory.scene(), sample);
    let mut lines = scene.waterlines(phase, u, amounts);
    lines.extend(scene.device_lines(phase, *time, [u, v]));
    pairs(trajectory, lines)
}

/// Places of the needles of devices at a sample (m), and their directions.
fn needles(trajectory: &Trajectory, sample: &Sample) -> Vec<[Point; 2]> {
    let Ok(phase) = trajectory.phase_of(sample) else { return Vec::new() };
    let motion = [&sample.u[..], &sample.v];
    pairs(trajectory, trajectory.scene().device_needles(phase, sample.time, motion))
}

/// Pairs of points or vectors of space as they are drawn.
fn pairs(trajectory: &Trajectory, pairs: Vec<[[f64; 3]; 2]>) -> Vec<[Point; 2]> {
    let d = trajectory.body().dimension();
    pairs.into_iter().map(|pair| pair.map(|x| drawn(&x[..d]))).collect()
}

/// The points of space (m) that actuators are joined to, dimension coordinates each.
fn anchors(scene: &Scene) -> Vec<Vec<f64>> {
    let mesh = scene.body().mesh();
    let joints = scene.actuators().iter().filter_map(|actuator| actuator.line(scene.body()).ok());
    let point =
        |joint: LinePoint| joint.shares.is_empty().then(|| joint.at[..mesh.dimension()].to_vec());
    joints.flatten().filter_map(point).collect()
}

/// The part of a convex polygon where `level`, a linear function, is not negative.
fn clip(polygon: &[Point], level: impl Fn(&Point) -> f64) -> Vec<Point> {
    let mut clipped = Vec::new();
    for (k, p) in polygon.iter().enumerate() {
        let q = &polygon[(k + 1) % polygon.len()];
        let (at_p, at_q) = (level(p), level(q));
        if at_p >= 0.0 {
            clipped.push(*p);
        }
        if (at_p < 0.0) != (at_q < 0.0) {
            let along = at_p / (at_p - at_q);
            clipped.push([0, 1].map(|i| p[i] + along * (q[i] - p[i])));
        }
    }
    clipped
}

/// Positions of all parts of the page.
pub(super) struct Layout {
    columns: usize,
    /// Least width of the page (px).
    least: f64,
    /// Width of a panel (px).
    width: f64,
    rows: Vec<PanelRow>,
    /// Pixels per metre.
    scale: f64,
    /// Left edge of the contents of the panels (m).
    left: f64,
}

/// A row of panels, as high as its contents.
struct PanelRow {
    /// Upper and lower edge on the page (px), without the captions.
    edges: [f64; 2],
    /// Upper edge of the contents of its panels (m).
    top: f64,
}

impl Layout {
    /// Panels with space for a caption of so many characters and `beside` it (px).
    pub(super) fn new(
        view: &View,
        columns: Option<usize>,
        titled: bool,
        (caption, beside): (usize, f64),
    ) -> Self {
        let panels = view.tops.len();
        let captioned = CHARACTER * caption as f64 + beside;
        let narrowest = PANEL_WIDTH[0].max(captioned).min(PANEL_WIDTH[1]);
        let with_columns = |columns: usize| {
            let fitting = (PAGE_WIDTH - 2.0 * MARGIN + GAP) / columns as f64 - GAP;
            let width = fitting.clamp(narrowest, PANEL_WIDTH[1]);
            let scale = width / view.width();
            let mut y = if titled { MARGIN + TITLE } else { MARGIN };
            let rows = view.tops.chunks(columns).map(|tops| {
                let top = tops.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
                let edges = [y, y + (top - view.low[1]) * scale];
                y = edges[1] + CAPTION + GAP;
                PanelRow { edges, top }
            });
            let (least, rows) = (PAGE_LEAST, rows.collect());
            Self { columns, least, width, rows, scale, left: view.low[0] }
        };
        // prefer a page wider than high, and rows as full as possible
        let penalty = |layout: &Self| {
            let [width, height] = layout.size().map(f64::from);
            let places = layout.columns * layout.rows.len();
            let empty = (places - panels) as f64 / layout.columns as f64;
            (height / width / 0.7).ln().abs() + 1.5 * empty
        };
        if let Some(columns) = columns {
            return with_columns(columns.min(panels));
        }
        let mut best = with_columns(1);
        for columns in 2..=panels.min(8) {
            let other = with_columns(columns);
            if penalty(&other) < penalty(&best) {
                best = other;
            }
        }
        best
    }

    pub(super) fn margin(&self) -> f64 {
        MARGIN
    }

    /// Width and height of the page, whole pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        let width = 2.0 * MARGIN + self.columns as f64 * (self.width + GAP) - GAP;
        [width.max(self.least).ceil() as u32, (self.key_line() + MARGIN).ceil() as u32]
    }

    /// Makes the page as wide as `least` (px) at least.
    pub(super) fn widen(&mut self, least: f64) {
        self.least = self.least.max(least);
    }

    /// Baseline of the key below the panels.
    pub(super) fn key_line(&self) -> f64 {
        self.rows.last().map_or(MARGIN, |row| row.edges[1]) + CAPTION + KEY
    }

    fn row(&self, panel: usize) -> &PanelRow {
        &self.rows[panel / self.columns]
    }

    /// Upper left corner of a panel.
    pub(super) fn origin(&self, panel: usize) -> Point {
        let x = MARGIN + (panel % self.columns) as f64 * (self.width + GAP);
        [x, self.row(panel).edges[0]]
    }

    /// Right end and baseline of the caption, from the corner of the panel.
    pub(super) fn caption(&self, panel: usize) -> Point {
        let [top, bottom] = self.row(panel).edges;
        [self.width, bottom - top + 19.0]
    }

    /// Upper edge of the contents of a panel (m).
    pub(super) fn top(&self, panel: usize) -> f64 {
        self.row(panel).top
    }

    /// A point of space, from the corner of the panel.
    pub(super) fn place(&self, panel: usize, point: Point) -> Point {
        [(point[0] - self.left) * self.scale, (self.row(panel).top - point[1]) * self.scale]
    }

    /// A length (m) on the page.
    pub(super) fn pixels(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// A length on the page (px) in space.
    pub(super) fn metres(&self, pixels: f64) -> f64 {
        pixels / self.scale
    }
}

/// A round length (m) of a fifth to a half of `width`, and its label.
pub(super) fn scale_bar(width: f64) -> (f64, String) {
    let power = (width / 2.0).log10().floor() as i32;
    let unit = 10f64.powi(power);
    let factor = [5.0, 2.0, 1.0].into_iter().find(|factor| factor * unit <= width / 2.0);
    let length = factor.unwrap_or(1.0) * unit;
    let (scale, name) = match power {
        ..=-5 => (1e6, "µm"),
        -4..=-3 => (1e3, "mm"),
        -2..=-1 => (1e2, "cm"),
        0..=2 => (1.0, "m"),
        3.. => (1e-3, "km"),
    };
    (length, format!("{} {name}", (length * scale).round()))
}
