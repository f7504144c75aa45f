//! One panel: the body at one time.

use std::collections::{BTreeMap, BTreeSet};

use svg::node::element::{Group, Path};

use super::acting::ActingAt;
use super::layout::{BAR_WIDTH, Layout, View};
use super::mark::{Data, Mark, text};
use super::obstacle::Outline;
use super::projection::{Point, depths, drawn, positions};
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::mesh::{CellKind, Mesh};
use crate::elements::rod::Tube;
use crate::io::output::INK;
use crate::scene::forces::LinePoint;

/// The edges of cells and the cells of the first body, of the second, and so on; then over again.
const PAINTS: [Paint; 6] = [
    Paint { edge: "#35618f", fill: "#a9cbe8" },
    Paint { edge: "#9a5b1e", fill: "#f0c896" },
    Paint { edge: "#3f7a4a", fill: "#b5dcb4" },
    Paint { edge: "#7a4b8c", fill: "#d9c1e3" },
    Paint { edge: "#8c4646", fill: "#e8b8b2" },
    Paint { edge: "#5f6670", fill: "#c9cfd6" },
];
/// Thickness of the hatched band along the surface of a half-plane (px).
const BAND: f64 = 14.0;
/// Half the length of a needle (px).
const POLE: f64 = 8.0;

/// The colours of a body.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Paint {
    edge: &'static str,
    fill: &'static str,
}

impl Paint {
    fn of_body(number: usize) -> Self {
        PAINTS[number % PAINTS.len()]
    }
}

pub(super) struct Panel<'a> {
    pub(super) number: usize,
    pub(super) caption: &'a str,
    pub(super) trajectory: &'a Trajectory,
    pub(super) sample: &'a Sample,
    pub(super) view: &'a View,
    pub(super) layout: &'a Layout,
    pub(super) marks: &'a BTreeMap<usize, Mark>,
    pub(super) acting: ActingAt,
}

impl Panel<'_> {
    pub(super) fn draw(&self) -> Group {
        let [x, y] = self.layout.origin(self.number);
        let mut panel = Group::new()
            .set("class", "panel")
            .set("transform", format!("translate({x:.2} {y:.2})"));
        for outline in &self.view.obstacles[self.number] {
            panel = panel.add(self.obstacle(outline));
        }
        let points = positions(self.trajectory, self.sample);
        let points: Vec<Point> =
            points.iter().map(|&x| self.layout.place(self.number, x)).collect();
        let body = self.trajectory.body();
        let (mut faces, mut hidden) = (Vec::new(), BTreeSet::new());
        for (part, paint) in body.parts().zip((0..).map(Paint::of_body)) {
            let (mesh, points) = (part.body.mesh(), &points[part.nodes.clone()]);
            if let Some(tube) = part.body.tube() {
                let drawn =
                    tube_faces(&tube, points, &|| depths(part.body, &self.sample.u[part.dofs()]));
                match mesh.dimension() {
                    2 => panel = panel.add(areas(drawn, paint)),
                    _ => faces.extend(drawn.into_iter().map(|(depth, face)| (depth, face, paint))),
                }
                continue;
            }
            match (mesh.kind(), mesh.dimension()) {
                (CellKind::Segment, 1) => panel = panel.add(self.bar(mesh, points, paint)),
                (CellKind::Segment, _) => panel = panel.add(string(mesh, points, paint)),
                (_, 2) => panel = panel.add(cells(mesh, points, paint)),
                _ => {
                    let depths = depths(part.body, &self.sample.u[part.dofs()]);
                    faces.extend(surface(mesh, points, &depths, paint));
                    hidden.extend(behind(mesh, points).map(|node| part.nodes.start + node));
                }
            }
        }
        if !faces.is_empty() {
            panel = panel.add(surfaces(faces, line_width(body.mesh(), &points)));
        }
        let lines = &self.view.lines[self.number];
        if !lines.is_empty() {
            let mut data = Data::default();
            lines.iter().for_each(|line| data.polyline(&self.placed(line), false));
            let path = Path::new().set("class", "lines").set("d", data.0).set("fill", "none");
            panel = panel.add(path.set("stroke", "#0072b2").set("stroke-width", 1.5));
        }
        let lines = self.trajectory.scene().actuator_lines().unwrap_or_default();
        if !lines.is_empty() {
            panel = panel.add(self.actuators(lines, &points));
        }
        for (&node, mark) in self.marks.iter().filter(|(node, _)| !hidden.contains(*node)) {
            panel = panel.add(mark.draw(points[node][0], points[node][1]));
        }
        for needle in &self.view.needles[self.number] {
            panel = panel.add(self.needle(*needle));
        }
        if let Some(arrows) = self.acting.on_body(self.layout, self.number) {
            panel = panel.add(arrows);
        }
        let [right, y] = self.layout.caption(self.number);
        let caption =
            text(self.caption, (right - self.acting.room()) / 2.0, y).set("text-anchor", "middle");
        let panel = panel.add(caption.set("fill", INK));
        self.acting.beside_caption(right, y).into_iter().fold(panel, Group::add)
    }

    /// An obstacle: a half-plane as a hatched band along its surface, others by their outline.
    fn obstacle(&self, outline: &Outline) -> Group {
        let (view, top) = (self.view, self.layout.top(self.number));
        let mut group = Group::new().set("class", "obstacle");
        let (inside, surface) = match outline {
            Outline::HalfPlane(plane) => {
                let band = view.band(top, *plane, self.layout.metres(BAND));
                let [point, normal] = plane;
                let on_surface = |x: &&Point| {
                    let distance: f64 = (0..2).map(|i| (x[i] - point[i]) * normal[i]).sum();
                    distance.abs() < 1e-9 * view.width()
                };
                let surface = band.iter().filter(on_surface).copied().collect();
                (band, vec![surface])
            }
            Outline::Solid(points) => (view.clip(points, top), self.edges(points)),
            Outline::Cavity(points) => (Vec::new(), self.edges(points)),
        };
        let mut hatched = Data::default();
        hatched.polyline(&self.placed(&inside), true);
        let mut line = Data::default();
        for part in surface.iter().filter(|part| part.len() > 1) {
            line.polyline(&self.placed(part), false);
        }
        for (data, fill, stroke) in [(hatched, "url(#hatch)", "none"), (line, "none", "#555555")] {
            if data.0.len() > 1 {
                let path = Path::new().set("d", data.0).set("fill", fill);
                group = group.add(path.set("stroke", stroke).set("stroke-width", 1.5));
            }
        }
        group
    }

    /// The edges of a polygon, as far as they are in the view.
    fn edges(&self, polygon: &[Point]) -> Vec<Vec<Point>> {
        let ends = polygon.iter().zip(polygon.iter().cycle().skip(1));
        let top = self.layout.top(self.number);
        ends.map(|(&p, &q)| self.view.clip(&[p, q], top)).collect()
    }

    fn placed(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|&x| self.layout.place(self.number, x)).collect()
    }

    /// A needle of a device within the view: a bar along it, with a north pole and a south pole, or a dot without direction.
    fn needle(&self, [place, along]: [Point; 2]) -> Group {
        let mut group = Group::new().set("class", "needle");
        if self.view.clip(&[place, place], self.layout.top(self.number)).is_empty() {
            return group;
        }
        let [x, y] = self.layout.place(self.number, place);
        let size = along[0].hypot(along[1]);
        let poles = [(POLE, "#d55e00"), (-POLE, "#0072b2")];
        for (end, colour) in poles.into_iter().filter(|_| size > 0.0) {
            let mut data = Data::default();
            let [dx, dy] = along.map(|part| end * part / size);
            data.polyline(&[[x, y], [x + dx, y - dy]], false);
            let path = Path::new().set("d", data.0).set("fill", "none");
            group = group.add(path.set("stroke", colour).set("stroke-width", 5));
        }
        group.add(Mark::Held.draw(x, y).set("r", 2.0))
    }

    /// The lines of actuators.
    fn actuators(&self, lines: Vec<(usize, Vec<LinePoint>)>, points: &[Point]) -> Path {
        let mesh = self.trajectory.body().mesh();
        let mut data = Data::default();
        for (_, line) in lines {
            let place = |joint: LinePoint| match &joint.shares[..] {
                [] => self.layout.place(self.number, drawn(&joint.at[..mesh.dimension()])),
                shares => shares.iter().fold([0.0; 2], |sum, &(node, share)| {
                    [0, 1].map(|i| sum[i] + share * points[node][i])
                }),
            };
            data.polyline(&line.into_iter().map(place).collect::<Vec<_>>(), false);
        }
        let path = Path::new().set("class", "springs").set("d", data.0).set("fill", "none");
        path.set("stroke", "#8a5a2b").set("stroke-width", 1.2)
    }

    /// A one-dimensional body, drawn with a visible width, its nodes as lines across.
    fn bar(&self, mesh: &Mesh, points: &[Point], paint: Paint) -> Group {
        let half = self.layout.pixels(BAR_WIDTH * mesh.size()) / 2.0;
        let mut data = Data::default();
        for cell in mesh.cells() {
            let [[x, p], [_, q]] = [points[cell[0]], points[cell[1]]];
            data.polyline(&[[x - half, p], [x + half, p], [x + half, q], [x - half, q]], true);
        }
        Group::new().add(body("cells", data, paint.edge, 1.2).set("fill", paint.fill))
    }
}

/// A one-dimensional body in a plane or in space.
fn string(mesh: &Mesh, points: &[Point], paint: Paint) -> Group {
    let mut data = Data::default();
    for cell in mesh.cells() {
        data.polyline(&[points[cell[0]], points[cell[1]]], false);
    }
    let path = body("cells", data, paint.edge, 1.8);
    Group::new().add(path.set("fill", "none").set("stroke-linecap", "round"))
}

/// A body that fills an area of the plane: its cells, and its outline stronger.
fn cells(mesh: &Mesh, points: &[Point], paint: Paint) -> Group {
    let mut data = Data::default();
    for cell in mesh.cells() {
        let around = around(cell).map(|node| points[node]);
        data.polyline(&around.collect::<Vec<_>>(), true);
    }
    let mut outline = Data::default();
    for face in mesh.boundary_faces() {
        let along: Vec<Point> = through_middle(&face).map(|node| points[node]).collect();
        outline.polyline(&along, false);
    }
    let fine = line_width(mesh, points);
    let outline = body("outline", outline, paint.edge, 1.5);
    Group::new()
        .add(
            body("cells", data, paint.edge, fine).set("fill", paint.fill).set("fill-opacity", 0.75),
        )
        .add(outline.set("fill", "none").set("stroke-linecap", "round"))
}

/// The faces of a body in space with their depths. Of a solid only the faces that look at the viewer are drawn.
fn surface(
    mesh: &Mesh,
    points: &[Point],
    depths: &[f64],
    paint: Paint,
) -> Vec<(f64, Vec<Point>, Paint)> {
    let solid = mesh.has_inside();
    let mut faces = Vec::new();
    for face in mesh.boundary_faces() {
        let around: Vec<Point> = around(&face).map(|node| points[node]).collect();
        if !solid || looks_at_viewer(&around) {
            let depth: f64 = face.iter().map(|&node| depths[node]).sum();
            faces.push((depth / face.len() as f64, around, paint));
        }
    }
    faces
}

/// The faces of a rod that look at the viewer, with their depths; in the plane its areas.
fn tube_faces(
    tube: &Tube,
    points: &[Point],
    depths: &dyn Fn() -> Vec<f64>,
) -> Vec<(f64, Vec<Point>)> {
    let place = |point: &usize| {
        tube.points[*point]
            .iter()
            .fold([0.0; 2], |sum, &(node, share)| [0, 1].map(|i| sum[i] + share * points[node][i]))
    };
    let is_solid = tube.faces.iter().any(|(_, face)| face.len() > 4);
    let depths = if is_solid { depths() } else { vec![0.0; points.len()] };
    let faces = tube.faces.iter().map(|(_, face)| {
        let of_node = |&(node, share): &(usize, f64)| share * depths[node];
        let depth: f64 = face.iter().flat_map(|point| &tube.points[*point]).map(of_node).sum();
        (depth / face.len() as f64, face.iter().map(place).collect::<Vec<Point>>())
    });
    faces.filter(|(_, around)| !is_solid || looks_at_viewer(around)).collect()
}

/// A rod in the plane.
fn areas(faces: Vec<(f64, Vec<Point>)>, paint: Paint) -> Group {
    let mut data = Data::default();
    faces.iter().for_each(|(_, around)| data.polyline(around, true));
    Group::new().add(body("cells", data, paint.edge, 0.5).set("fill", paint.fill))
}

/// The nodes on the boundary of a solid that are on no face that looks at the viewer.
fn behind(mesh: &Mesh, points: &[Point]) -> impl Iterator<Item = usize> + use<> {
    let (mut behind, mut seen) = (BTreeSet::new(), BTreeSet::new());
    for face in mesh.boundary_faces() {
        let polygon: Vec<Point> = around(&face).map(|node| points[node]).collect();
        let is_seen = !mesh.has_inside() || looks_at_viewer(&polygon);
        if is_seen { &mut seen } else { &mut behind }.extend(face.iter().copied());
    }
    behind.into_iter().filter(move |node| !seen.contains(node))
}

/// The faces of all bodies in space, drawn from far to near.
fn surfaces(mut faces: Vec<(f64, Vec<Point>, Paint)>, line_width: f64) -> Group {
    faces.sort_by(|(a, ..), (b, ..)| b.total_cmp(a));
    let first = PAINTS[0];
    let mut group = Group::new()
        .set("class", "cells")
        .set("fill", first.fill)
        .set("stroke", first.edge)
        .set("stroke-width", format!("{line_width:.2}"))
        .set("stroke-linejoin", "round");
    for (_, around, paint) in faces {
        let mut data = Data::default();
        data.polyline(&around, true);
        let mut path = Path::new().set("d", data.0);
        if paint != first {
            path = path.set("fill", paint.fill).set("stroke", paint.edge);
        }
        group = group.add(path);
    }
    group
}

/// Whether a polygon runs counter-clockwise on the page, whose second axis points down.
fn looks_at_viewer(polygon: &[Point]) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum::<f64>() < 0.0
}

/// The nodes of a face of a solid, or of a two-dimensional cell, in the order in which they stand around it:
/// each corner, then the mid node of the edge that begins there, if it has more than corners.
pub(in crate::io::output) fn around(face: &[usize]) -> impl Iterator<Item = usize> {
    let (corners, middles) = match face.len() > 4 {
        true => face.split_at(face.len() / 2),
        false => (face, &face[..0]),
    };
    let middles = middles.iter().map(Some).chain(std::iter::repeat(None));
    corners
        .iter()
        .zip(middles)
        .flat_map(|(corner, middle)| [Some(corner), middle])
        .flatten()
        .copied()
}

/// The nodes of an edge from end to end: through the mid node, where there is one.
pub(in crate::io::output) fn through_middle(edge: &[usize]) -> impl Iterator<Item = usize> {
    edge.first().into_iter().chain(edge.get(2)).chain(edge.get(1)).copied()
}

/// Finer lines for finer meshes.
fn line_width(mesh: &Mesh, points: &[Point]) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in points {
        low = [low[0].min(point[0]), low[1].min(point[1])];
        high = [high[0].max(point[0]), high[1].max(point[1])];
    }
    let area = (high[0] - low[0]) * (high[1] - low[1]);
    (0.05 * (area / mesh.cell_count() as f64).sqrt()).clamp(0.15, 0.8)
}

fn body(class: &str, data: Data, edge: &str, stroke_width: f64) -> Path {
    Path::new()
        .set("class", class)
        .set("d", data.0)
        .set("stroke", edge)
        .set("stroke-width", format!("{stroke_width:.2}"))
        .set("stroke-linejoin", "round")
}
