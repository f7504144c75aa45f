//! Panels on a page, which is written as SVG or PNG.

use std::io;
use std::path::Path;

use svg::Document;
use svg::node::element::Group;

use super::{LEGEND, MARGIN, Panel, Theme, rectangle, text};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
#[cfg(feature = "png")]
use crate::io::output::png::png;
use crate::io::output::{FONT, write_file};

/// Room for a title (px).
const TITLE: f64 = 40.0;
/// Room for the name of a vertical axis, and between its labels and the field (px).
const SIDE: f64 = 38.0;
/// Room below a field, without and with an axis along its floor (px).
const BELOW: [f64; 2] = [18.0, 52.0];

/// Panels side by side and one below the other.
#[derive(Debug)]
pub(crate) struct Figure {
    /// Title and a line below it; without them no space is reserved.
    pub(crate) title: String,
    pub(crate) about: String,
    pub(crate) panels: Vec<Panel>,
    /// Panels side by side.
    pub(crate) columns: usize,
    /// Width of a panel with its labels, and height of its field (px).
    pub(crate) size: [f64; 2],
    /// Whether legends are on the right of their fields, not above.
    pub(crate) is_legend_beside: bool,
    pub(crate) theme: Theme,
}

impl Figure {
    /// Panels of some width and height of their fields (px), one below the other.
    pub(crate) fn new(title: impl Into<String>, panels: Vec<Panel>, size: [f64; 2]) -> Self {
        Self {
            title: title.into(),
            about: String::new(),
            panels,
            columns: 1,
            size,
            is_legend_beside: false,
            theme: Theme::PRINT,
        }
    }

    pub(crate) fn draw(&self) -> Document {
        let left = SIDE + self.panels.iter().map(|panel| panel.axes[1].width()).fold(0.0, f64::max);
        let mut y = 6.0;
        let mut drawn = Group::new();
        if !self.title.is_empty() {
            y = TITLE;
            let title = text(&self.title, [MARGIN, 27.0]).set("font-size", 16);
            drawn = drawn.add(title.set("font-weight", 600));
        }
        if !self.about.is_empty() {
            y += LEGEND;
            drawn = drawn.add(text(&self.about, [MARGIN, 45.0]).set("fill", self.theme.muted));
        }
        for row in self.panels.chunks(self.columns) {
            let mut bottom = y;
            for (at, panel) in row.iter().enumerate() {
                let start = at as f64 * self.size[0];
                let right = start + self.size[0] - panel.beside(self.is_legend_beside);
                let (places, below) = match self.is_legend_beside {
                    true => panel.legend([right + MARGIN; 2], y + 12.0),
                    false => panel.legend([start + left, right], y + 12.0),
                };
                let top = if self.is_legend_beside { y } else { below } + panel.above;
                let edges = [start + left, top, right, top + self.size[1]];
                drawn = drawn.add(panel.draw(start, edges, &places, &self.theme));
                let has_floor = !panel.names[0].is_empty();
                bottom = bottom.max(edges[3] + BELOW[usize::from(has_floor)]).max(below);
            }
            y = bottom;
        }
        let across = self.columns.min(self.panels.len()).max(1);
        let [width, height] = [self.size[0] * across as f64, y];
        Document::new()
            .set("width", width)
            .set("height", height)
            .set("viewBox", (0, 0, width, height))
            .set("font-family", FONT)
            .set("font-size", 12)
            .set("fill", self.theme.ink)
            .add(rectangle([0.0; 2], [width, height]).set("fill", self.theme.paper))
            .add(drawn)
    }

    /// Writes the picture to an SVG file, or, with the feature `png`, a PNG file.
    ///
    /// # Errors
    /// [`Error::Input`] for another ending of `path`; [`Error::Output`] if the file cannot be written, or this machine has
    /// no fonts for a PNG file.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Error> {
        let drawing = self.draw().to_string();
        let picture = match path.extension().and_then(|ending| ending.to_str()) {
            Some("svg") => Ok(drawing.into_bytes()),
            #[cfg(feature = "png")]
            Some("png") => png(&drawing).map_err(io::Error::other),
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
}
