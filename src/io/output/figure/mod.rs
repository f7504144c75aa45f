//! Elements of all figures: a page, a field with two axes, lines, marks, a legend; written as SVG or PNG.

mod axis;
mod line;

use std::io;
use std::path::Path;

use svg::Document;
use svg::node::element::{Circle, Group, Line as Segment, Path as Outline, Rectangle, Text};

pub(crate) use axis::{Axis, power_text};
pub(crate) use line::Line;

use super::{FONT, INK, write_file};
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// A point of a page (px).
pub(crate) type Point = [f64; 2];

/// Mean width of a character of 12 px.
pub(crate) const CHARACTER: f64 = 6.6;
/// Length of the line that a legend shows, with its room, and the distance of its lines (px).
pub(crate) const SWATCH: f64 = 30.0;
pub(crate) const LEGEND: f64 = 19.0;

/// A part of a page with an axis along its floor and one along its left side.
#[derive(Debug)]
pub(crate) struct Field {
    /// Left, top, right and bottom (px).
    pub(crate) edges: [f64; 4],
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Colours of its outline, of lines with a label, and of those without.
    pub(crate) colours: [&'static str; 3],
}

impl Field {
    /// The point of two values.
    pub(crate) fn place(&self, x: f64, y: f64) -> Point {
        let [left, top, right, bottom] = self.edges;
        [left + self.x.place(x) * (right - left), bottom - self.y.place(y) * (bottom - top)]
    }

    /// The line through points given by their values; what is not finite is a gap.
    pub(crate) fn line(&self, points: impl Iterator<Item = (f64, f64)>) -> Line {
        Line::through(points.map(|(x, y)| match x.is_finite() && y.is_finite() {
            true => self.place(x, y),
            false => [f64::NAN; 2],
        }))
    }

    /// Lines across the field at the ticks of both axes, and the labels of the vertical one.
    pub(crate) fn grid(&self) -> Group {
        let [left, top, right, bottom] = self.edges;
        let colour = |label: &str| self.colours[if label.is_empty() { 2 } else { 1 }];
        let mut group = Group::new();
        for (value, label) in &self.x.ticks {
            let x = left + self.x.place(*value) * (right - left);
            group = group.add(stroke([x, top], [x, bottom], colour(label)));
        }
        for (value, label) in &self.y.ticks {
            let y = bottom - self.y.place(*value) * (bottom - top);
            group = group.add(stroke([left, y], [right, y], colour(label)));
            group = group.add(text(label, [left - 8.0, y + 4.0]).set("text-anchor", "end"));
        }
        group
    }

    /// Marks and labels of the horizontal axis, below the field, and its name.
    pub(crate) fn floor(&self, name: &str) -> Group {
        let [left, _, right, bottom] = self.edges;
        let mut group = Group::new().set("text-anchor", "middle");
        for (value, label) in self.x.ticks.iter().filter(|tick| !tick.1.is_empty()) {
            let x = left + self.x.place(*value) * (right - left);
            group = group.add(stroke([x, bottom], [x, bottom + 4.0], self.colours[0]));
            group = group.add(text(label, [x, bottom + 17.0]));
        }
        group.add(text(name, [0.5 * (left + right), bottom + 37.0]))
    }

    /// The name of the vertical axis, at a distance (px) from the field.
    pub(crate) fn side(&self, name: &str, distance: f64) -> Text {
        let [left, top, _, bottom] = self.edges;
        let [x, y] = [left - distance, 0.5 * (top + bottom)].map(round);
        let turned = format!("translate({x} {y}) rotate(-90)");
        text(name, [0.0; 2]).set("text-anchor", "middle").set("transform", turned)
    }

    pub(crate) fn outline(&self) -> Rectangle {
        let [left, top, right, bottom] = self.edges;
        rectangle([left, top], [right, bottom]).set("fill", "none").set("stroke", self.colours[0])
    }
}

impl Line {
    /// The line that a legend shows for a name at a place.
    pub(crate) fn swatch([x, y]: Point) -> Self {
        Self::through([[x, y], [x + SWATCH - 8.0, y]].into_iter())
    }

    /// The line in a colour, with the width of its stroke, the radius of points that stand alone (px), and dashes.
    pub(crate) fn draw(&self, colour: &str, width: f64, radius: f64, dashes: &str) -> Group {
        let (data, alone) = self.drawn();
        let path = Outline::new()
            .set("d", data)
            .set("fill", "none")
            .set("stroke", colour)
            .set("stroke-width", width)
            .set("stroke-linejoin", "round")
            .set("stroke-dasharray", dashes);
        dots(Group::new().add(path), alone, radius, colour)
    }
}

/// A group with dots at some points added to it.
pub(crate) fn dots(
    group: Group,
    points: impl IntoIterator<Item = Point>,
    radius: f64,
    colour: &str,
) -> Group {
    points.into_iter().fold(group, |group, [x, y]| {
        let dot = Circle::new().set("cx", round(x)).set("cy", round(y));
        group.add(dot.set("r", radius).set("fill", colour))
    })
}

/// A white page of a width and a height (px).
pub(crate) fn page([width, height]: [f64; 2]) -> Document {
    Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", (0, 0, width, height))
        .set("font-family", FONT)
        .set("font-size", 12)
        .set("fill", INK)
        .add(rectangle([0.0; 2], [width, height]).set("fill", "#ffffff"))
}

/// Where a legend from `start` to `end` has each name, in as many lines as it takes (px).
pub(crate) fn legend_places<'a>(
    names: impl Iterator<Item = &'a str>,
    [start, end]: [f64; 2],
    mut y: f64,
) -> Vec<Point> {
    let mut x = start;
    let places = names.map(|name| {
        let width = SWATCH + CHARACTER * name.chars().count() as f64 + 16.0;
        if x > start && x + width > end + 16.0 {
            (x, y) = (start, y + LEGEND);
        }
        x += width;
        [x - width, y]
    });
    places.collect()
}

pub(crate) fn text(content: impl Into<String>, [x, y]: Point) -> Text {
    Text::new(content.into()).set("x", round(x)).set("y", round(y))
}

pub(crate) fn stroke([x1, y1]: Point, [x2, y2]: Point, colour: &str) -> Segment {
    let line = Segment::new().set("x1", round(x1)).set("y1", round(y1));
    line.set("x2", round(x2)).set("y2", round(y2)).set("stroke", colour)
}

/// From the upper left corner to the lower right one.
pub(crate) fn rectangle([left, top]: Point, [right, bottom]: Point) -> Rectangle {
    let rectangle = Rectangle::new().set("x", round(left)).set("y", round(top));
    rectangle.set("width", round(right - left)).set("height", round(bottom - top))
}

pub(crate) fn round(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

/// Writes a figure to an SVG file, or, with the feature `png`, a PNG file.
///
/// # Errors
/// [`Error::Input`] for another ending of `path`; [`Error::Output`] if the file cannot be written, or this machine has
/// no fonts for a PNG file.
pub(crate) fn write_figure(figure: &Document, path: &Path) -> Result<(), Error> {
    let drawing = figure.to_string();
    let picture = match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg") => Ok(drawing.into_bytes()),
        #[cfg(feature = "png")]
        Some("png") => super::png::png(&drawing).map_err(io::Error::other),
        _ => {
            let known = if cfg!(feature = "png") { ".svg or .png" } else { ".svg" };
            let help = format!("its name must end in {known}");
            return Err(InputError::new("file of a chart", path.display(), help).into());
        }
    };
    let picture =
        picture.map_err(|source: io::Error| Error::Output { path: path.into(), source })?;
    write_file(path, |file| file.write_all(&picture))
}
