//! Marks of nodes, and texts.

use svg::node::element::{Circle, Text};

use crate::io::output::INK;

/// How a node is marked.
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
