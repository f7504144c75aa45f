//! A field with two axes, its contents and its legends.

use svg::node::element::{Group, Text};

use super::{
    Axis, CHARACTER, LEGEND, MARGIN, Point, SWATCH, Series, Theme, rectangle, stroke, text,
};

/// Width of the scale of colours, margin beside its labels (px), and its parts.
const SCALE: [f64; 2] = [14.0, 22.0];
const PARTS: usize = 60;
/// Colours from the least to the largest value, ever lighter: also a grey picture shows them.
const RAMP: [[f64; 3]; 6] = [
    [38.0, 20.0, 84.0],
    [52.0, 74.0, 140.0],
    [36.0, 126.0, 142.0],
    [58.0, 174.0, 118.0],
    [160.0, 212.0, 70.0],
    [250.0, 232.0, 74.0],
];

/// A field with an axis along its floor and one along its left side.
#[derive(Debug, Clone, Default)]
pub(crate) struct Panel {
    pub(crate) axes: [Axis; 2],
    /// Names beside the axes; without one the floor has no labels.
    pub(crate) names: [String; 2],
    pub(crate) series: Vec<Series>,
    pub(crate) notes: Vec<Note>,
    /// More upright axes, and where they cross the floor; then the field has no outline.
    pub(crate) uprights: Vec<(f64, Axis)>,
    /// A scale of colours on the right, with its heading.
    pub(crate) scale: Option<(Axis, String)>,
    /// Room for notes above the field (px).
    pub(crate) above: f64,
}

/// A text at a point of a field, shifted from there (px); `anchor` is which part of it is there: start, middle or end.
#[derive(Debug, Clone)]
pub(crate) struct Note {
    pub(crate) text: String,
    pub(crate) at: (f64, f64),
    pub(crate) shift: Point,
    pub(crate) anchor: &'static str,
}

impl Panel {
    fn named(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|series| !series.name.is_empty())
    }

    /// Room on the right of the field, for a legend of one name below the other or for a scale of colours (px).
    pub(super) fn beside(&self, has_legend: bool) -> f64 {
        let longest = self.named().map(|series| series.name.chars().count()).max();
        let legend =
            longest.filter(|_| has_legend).map(|longest| 36.0 + CHARACTER * longest as f64);
        let scale = self.scale.as_ref().map(|(scale, _)| scale.width() + SCALE[0] + SCALE[1]);
        MARGIN + legend.or(scale).unwrap_or(0.0)
    }

    /// Where a legend from `start` to `end` has each name, in as many lines as it takes, and where it ends (px).
    pub(super) fn legend(&self, [start, end]: [f64; 2], mut y: f64) -> (Vec<Point>, f64) {
        let mut x = start;
        let places: Vec<Point> = self
            .named()
            .map(|series| {
                let width = SWATCH + CHARACTER * series.name.chars().count() as f64 + 16.0;
                if x > start && x + width > end + 16.0 {
                    (x, y) = (start, y + LEGEND);
                }
                x += width;
                [x - width, y]
            })
            .collect();
        let below = places.last().map_or(y - 12.0, |place| place[1] + 16.0);
        (places, below)
    }

    /// The panel from `start` on, with its field between `edges`: left, top, right and bottom (px).
    pub(super) fn draw(
        &self,
        start: f64,
        edges: [f64; 4],
        legend: &[Point],
        theme: &Theme,
    ) -> Group {
        let [left, top, right, bottom] = edges;
        let [x_axis, y_axis] = &self.axes;
        let x = |value: f64| left + x_axis.place(value) * (right - left);
        let y = |place: f64| bottom - place * (bottom - top);
        let place = |&(along, up): &(f64, f64)| match along.is_finite() && up.is_finite() {
            true => [x(along), y(y_axis.place(up))],
            false => [f64::NAN; 2],
        };
        let mut panel = Group::new().set("class", "panel");
        for (value, label) in &x_axis.ticks {
            let colour = theme.grid[usize::from(label.is_empty())];
            panel = panel.add(stroke([x(*value), top], [x(*value), bottom], colour));
        }
        for (value, label) in &y_axis.ticks {
            let (y, colour) = (y(y_axis.place(*value)), theme.grid[usize::from(label.is_empty())]);
            panel = panel.add(stroke([left, y], [right, y], colour));
        }
        let mut floor = Group::new().set("text-anchor", "middle");
        let labelled = |tick: &&(f64, String)| !(tick.1.is_empty() || self.names[0].is_empty());
        for (value, label) in x_axis.ticks.iter().filter(labelled) {
            floor = floor.add(stroke([x(*value), bottom], [x(*value), bottom + 4.0], theme.ink));
            floor = floor.add(text(label, [x(*value), bottom + 17.0]));
        }
        floor = floor.add(text(&self.names[0], [0.5 * (left + right), bottom + 37.0]));
        let turned =
            format!("translate({:.0} {:.0}) rotate(-90)", start + 16.0, 0.5 * (top + bottom));
        panel = panel.add(floor.add(text(&self.names[1], [0.0; 2]).set("transform", turned)));

        let mut legend = legend.iter();
        for series in &self.series {
            let points: Vec<Point> = series.points.iter().map(place).collect();
            panel = panel.add(series.draw(series.group(), &points, &points, theme));
            if !series.name.is_empty()
                && let Some(&[x, y]) = legend.next()
            {
                let end = x + SWATCH - 8.0;
                let line = match series.is_area {
                    true => vec![[x, y - 5.0], [end, y - 5.0], [end, y + 5.0], [x, y + 5.0]],
                    false => vec![[x, y], [end, y]],
                };
                let swatch = series.draw(Group::new(), &line, &[[0.5 * (x + end), y]], theme);
                panel = panel.add(swatch).add(text(&series.name, [x + SWATCH, y + 4.0]));
            }
        }

        if self.uprights.is_empty() {
            let outline = rectangle([left, top], [right, bottom]).set("class", "field");
            panel = panel.add(outline.set("fill", "none").set("stroke", theme.ink));
        }
        panel = panel.add(upright(y_axis, [left, top, bottom], theme));
        for (value, axis) in &self.uprights {
            let x = x(*value);
            panel = panel.add(stroke([x, top], [x, bottom], theme.muted));
            panel = panel.add(upright(axis, [x, top, bottom], theme));
        }
        if let Some((scale, label)) = &self.scale {
            let from = right + scale.width() + SCALE[1];
            let to = from + SCALE[0];
            let label = text(label, [to, top - 12.0]).set("text-anchor", "end");
            panel = panel.add(label.set("font-weight", 600));
            for part in 0..PARTS {
                let [low, high] = [part, part + 1].map(|part| part as f64 / PARTS as f64);
                // a little more than a part, so that no line is seen between them
                let part = rectangle([from, y(high)], [to, y(low) + 0.4]);
                panel = panel.add(part.set("fill", shade(0.5 * (low + high))));
            }
            panel = panel.add(upright(scale, [from, top, bottom], theme));
        }
        self.notes.iter().fold(panel, |panel, Note { text: note, at, shift, anchor }| {
            let [x, y] = place(at);
            panel.add(over(note, [x + shift[0], y + shift[1]], theme).set("text-anchor", *anchor))
        })
    }
}

/// Ticks and labels on the left of an upright axis at some x, between its top and bottom (px).
fn upright(axis: &Axis, [x, top, bottom]: [f64; 3], theme: &Theme) -> Group {
    let labelled = axis.ticks.iter().filter(|tick| !tick.1.is_empty());
    labelled.fold(Group::new().set("text-anchor", "end"), |group, (value, label)| {
        let y = bottom - axis.place(*value) * (bottom - top);
        let tick = stroke([x - 4.0, y], [x, y], theme.ink);
        group.add(tick).add(over(label, [x - 8.0, y + 4.0], theme))
    })
}

/// A text that can be read over lines.
fn over(content: &str, place: Point, theme: &Theme) -> Text {
    let text = text(content, place).set("paint-order", "stroke").set("stroke", theme.paper);
    text.set("stroke-width", 3).set("stroke-linejoin", "round")
}

/// The colour of a place from 0 to 1.
pub(crate) fn shade(place: f64) -> String {
    let last = RAMP.len() - 1;
    let x = if place.is_finite() { place.clamp(0.0, 1.0) * last as f64 } else { 0.0 };
    let at = (x as usize).min(last - 1);
    let mix = |k: usize| (RAMP[at][k] + (x - at as f64) * (RAMP[at + 1][k] - RAMP[at][k])) as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}
