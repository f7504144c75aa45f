//! Marks of nodes, texts, and lines.

use std::fmt::Write;

use svg::node::element::{Circle, Text};

use super::projection::Point;
use crate::io::output::INK;

/// Mark of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Mark {
    /// By the user.
    Ring,
    /// Because the phase holds it.
    Held,
    /// Because the phase moves it.
    Moved,
}

impl Mark {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ring => "tracked",
            Self::Held => "held",
            Self::Moved => "moved",
        }
    }

    pub(super) fn draw(self, x: f64, y: f64) -> Circle {
        let dot = Circle::new().set("cx", format!("{x:.2}")).set("cy", format!("{y:.2}"));
        match self {
            Self::Ring => dot.set("r", 4.2).set("fill", "none").set("stroke", "#d55e00"),
            Self::Held => dot.set("r", 3.2).set("fill", INK),
            Self::Moved => dot.set("r", 3.8).set("fill", "#d55e00"),
        }
    }
}

/// A text that begins at a point of the page (px).
pub(super) fn text(content: &str, x: f64, y: f64) -> Text {
    Text::new(content).set("x", format!("{x:.2}")).set("y", format!("{y:.2}"))
}

/// The data of a path, in hundredths of a pixel and relative steps, for short files.
#[derive(Default)]
pub(super) struct Data(pub(super) String);

impl Data {
    pub(super) fn polyline(&mut self, points: &[Point], close: bool) {
        let mut pen: Option<[i64; 2]> = None;
        for point in points {
            let at = point.map(|x| (100.0 * x).round() as i64);
            match pen {
                None => self.step('M', at),
                Some([x, y]) => self.step('l', [at[0] - x, at[1] - y]),
            }
            pen = Some(at);
        }
        if close {
            self.0.push('z');
        }
    }

    fn step(&mut self, command: char, [x, y]: [i64; 2]) {
        self.0.push(command);
        self.hundredths(x);
        if y >= 0 {
            self.0.push(' ');
        }
        self.hundredths(y);
    }

    fn hundredths(&mut self, x: i64) {
        // writing to a string cannot fail
        let _ = write!(self.0, "{}", x as f64 / 100.0);
    }
}
