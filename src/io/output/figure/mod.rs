//! Charts as data: panels of series over two axes; laid out on a page, and written as SVG or PNG.

mod axis;
mod page;
mod panel;
mod series;

use svg::node::element::{Line, Rectangle, Text};

pub(crate) use axis::{Axis, power_text};
pub(crate) use page::Figure;
#[cfg(feature = "sweep")]
pub(crate) use panel::shade;
pub(crate) use panel::{Note, Panel};
pub(crate) use series::{Mark, Series};

use super::INK;

/// A point of a page (px).
type Point = [f64; 2];

/// Mean width of a character of 12 px.
pub(crate) const CHARACTER: f64 = 6.6;
/// Length of the line in a legend, with its margin, and the distance of its lines (px).
const SWATCH: f64 = 30.0;
const LEGEND: f64 = 19.0;
/// Left end of titles, and right margin of fields (px).
const MARGIN: f64 = 20.0;

/// Colours of all but the series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Theme {
    pub(crate) paper: &'static str,
    pub(crate) ink: &'static str,
    /// Colour of notes and of other axes.
    pub(crate) muted: &'static str,
    /// Lines with a label across a field, and those without.
    pub(crate) grid: [&'static str; 2],
}

impl Theme {
    pub(crate) const PRINT: Self =
        Self { paper: "#ffffff", ink: INK, muted: "#777777", grid: ["#dedede", "#f2f2f2"] };
}

fn text(content: impl Into<String>, [x, y]: Point) -> Text {
    Text::new(content.into()).set("x", round(x)).set("y", round(y))
}

fn stroke([x1, y1]: Point, [x2, y2]: Point, colour: &str) -> Line {
    let line = Line::new().set("x1", round(x1)).set("y1", round(y1));
    line.set("x2", round(x2)).set("y2", round(y2)).set("stroke", colour)
}

/// From the upper left corner to the lower right one.
fn rectangle([left, top]: Point, [right, bottom]: Point) -> Rectangle {
    let rectangle = Rectangle::new().set("x", round(left)).set("y", round(top));
    rectangle.set("width", round(right - left)).set("height", round(bottom - top))
}

fn round(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}
