//! The page of a plot: panels one below the other, over one axis of time.

use svg::Document;
use svg::node::element::{Circle, Group, Line as Stroke, Path, Rectangle, Text};

use super::axis::Axis;
use super::line::Line;
use super::table::{Column, Table};
use crate::io::output::columns::EXCHANGED;
use crate::io::output::{COLOURS, DASHES, FONT, INK};

/// Width of the page, and height of a panel (px).
const WIDTH: f64 = 720.0;
const PANEL: f64 = 170.0;
/// Room at the right end, between panels, for a line of a legend, for the title, for names of phases, and for
/// the axis of time (px).
const RIGHT: f64 = 18.0;
const GAP: f64 = 18.0;
const LEGEND: f64 = 19.0;
const TITLE: f64 = 34.0;
const PHASES: f64 = 18.0;
const TIME: f64 = 44.0;
/// Width of the names of axes, and mean width of a character of 12 px.
const LABEL: f64 = 26.0;
const CHARACTER: f64 = 6.6;
/// Approximate number of lines across a panel and along the axis of time.
const TICKS: [usize; 2] = [5, 8];
/// Length of the line that a legend shows, with its room (px).
const SWATCH: f64 = 30.0;
const GRID: &str = "#e4e4e4";
const GREY: &str = "#777777";

/// A table's columns, laid out.
pub(super) struct Page<'a> {
    title: &'a str,
    table: &'a Table,
    time: Axis,
    panels: Vec<Panel<'a>>,
    /// Left end of the panels (px).
    left: f64,
}

/// The columns of one unit.
struct Panel<'a> {
    columns: Vec<&'a Column>,
    /// Their differences from the run before, if these are known.
    differences: Vec<Option<&'a Column>>,
    axis: Axis,
    label: String,
    /// Upper edge of its field, and where the legend has each name (px).
    top: f64,
    legend: Vec<[f64; 2]>,
}

impl<'a> Page<'a> {
    pub(super) fn new(title: &'a str, table: &'a Table, columns: &[&'a Column]) -> Self {
        let time = Axis::new(table.times.iter().copied(), 0.0, TICKS[1], "s");
        let mut panels: Vec<Panel> = Vec::new();
        for &column in columns {
            let unit = &column.quantity.unit;
            let same = |panel: &&mut Panel| panel.columns[0].quantity.unit == *unit;
            let difference = table.difference(column);
            match panels.iter_mut().find(same) {
                Some(panel) => {
                    panel.columns.push(column);
                    panel.differences.push(difference);
                }
                None => panels.push(Panel::new(column, difference)),
            }
        }
        for panel in &mut panels {
            panel.find_range();
        }
        let label =
            |panel: &Panel| panel.axis.ticks.iter().map(|tick| tick.1.chars().count()).max();
        let widest = panels.iter().filter_map(label).max().unwrap_or(0);
        let left = LABEL + CHARACTER * widest as f64 + 12.0;
        let mut page = Self { title, table, time, panels, left };
        page.lay_out();
        page
    }

    /// Finds where panels and legends stand.
    fn lay_out(&mut self) {
        let mut y = if self.title.is_empty() { 8.0 } else { TITLE };
        let left = self.left;
        for (number, panel) in self.panels.iter_mut().enumerate() {
            if number > 0 {
                y += GAP;
            }
            if panel.columns.len() > 1 {
                panel.legend = places(&panel.columns, left, y + LEGEND / 2.0);
                let lowest = panel.legend.iter().map(|place| place[1]).fold(y, f64::max);
                y = lowest + LEGEND / 2.0 + 4.0;
            }
            if number == 0 && self.table.phases.len() > 1 {
                y += PHASES;
            }
            panel.top = y;
            y += PANEL;
        }
    }

    fn bottom(&self) -> f64 {
        self.panels.last().map_or(TITLE, |panel| panel.top + PANEL)
    }

    /// The page as SVG.
    pub(super) fn draw(&self) -> String {
        let height = self.bottom() + TIME;
        let mut page = Document::new()
            .set("width", WIDTH)
            .set("height", height)
            .set("viewBox", (0, 0, WIDTH, height))
            .set("font-family", FONT)
            .set("font-size", 12)
            .set("fill", INK)
            .add(Rectangle::new().set("width", WIDTH).set("height", height).set("fill", "#ffffff"));
        if !self.title.is_empty() {
            let title = text(self.title, self.left, 22.0).set("font-size", 15);
            page = page.add(title.set("font-weight", "bold"));
        }
        if self.panels.is_empty() {
            page =
                page.add(text("nothing to draw: no sensors, no energies", self.left, TITLE + 20.0));
            return page.to_string();
        }
        for panel in &self.panels {
            page = page.add(self.panel(panel));
        }
        page.add(self.times()).add(self.phases()).to_string()
    }

    fn x(&self, time: f64) -> f64 {
        self.left + self.time.place(time) * (WIDTH - RIGHT - self.left)
    }

    fn panel(&self, panel: &Panel) -> Group {
        let (top, floor, right) = (panel.top, panel.top + PANEL, WIDTH - RIGHT);
        let y = |value: f64| floor - panel.axis.place(value) * PANEL;
        let mut group = Group::new().set("class", "panel");
        for (value, label) in &panel.axis.ticks {
            let y = y(*value);
            group = group.add(stroke([self.left, y], [right, y], GRID));
            let label = text(label, self.left - 8.0, y + 4.0).set("text-anchor", "end");
            group = group.add(label);
        }
        for (time, _) in &self.time.ticks {
            group = group.add(stroke([self.x(*time), top], [self.x(*time), floor], GRID));
        }
        let middle = (top + floor) / 2.0;
        let label = text(&panel.label, 0.0, 0.0).set("text-anchor", "middle");
        group = group.add(label.set("transform", format!("translate(16 {middle:.1}) rotate(-90)")));
        let frame = Rectangle::new().set("x", self.left).set("y", top).set("height", PANEL);
        group =
            group.add(frame.set("width", right - self.left).set("fill", "none").set("stroke", INK));
        for (number, column) in panel.columns.iter().enumerate() {
            let line = |values: &mut dyn Iterator<Item = f64>| {
                let points = self.table.times.iter().zip(values);
                Line::through(points.map(|(t, value)| match value.is_finite() {
                    true => [self.x(*t), y(value)],
                    false => [f64::NAN; 2],
                }))
            };
            if let Some(difference) = panel.differences[number] {
                let edge = |sign: f64| {
                    let pairs = column.values.iter().zip(&difference.values);
                    line(&mut pairs.map(|(x, d)| x + sign * d))
                };
                group = group.add(band(&edge(1.0), &edge(-1.0), number));
            }
            let line = line(&mut column.values.iter().copied());
            group = group.add(series(&line, column, number));
            if let Some([x, y]) = panel.legend.get(number) {
                let swatch = Line::through([[*x, *y], [x + SWATCH - 8.0, *y]].into_iter());
                let name = text(&column.quantity.name, x + SWATCH, y + 4.0);
                group = group.add(series(&swatch, column, number)).add(name);
            }
        }
        group
    }

    /// The axis of time.
    fn times(&self) -> Group {
        let floor = self.bottom();
        let mut group = Group::new().set("class", "time").set("text-anchor", "middle");
        for (time, label) in &self.time.ticks {
            let x = self.x(*time);
            group = group.add(stroke([x, floor], [x, floor + 4.0], INK));
            group = group.add(text(label, x, floor + 17.0));
        }
        let middle = (self.left + WIDTH - RIGHT) / 2.0;
        group.add(text(&format!("time ({})", self.time.unit), middle, floor + 35.0))
    }

    /// The ends of the phases but the last, and their names where there is room.
    fn phases(&self) -> Group {
        let mut group = Group::new().set("class", "phases").set("fill", GREY);
        let phases = &self.table.phases;
        let (Some(first), true) = (self.panels.first(), phases.len() > 1) else { return group };
        let mut left = self.left;
        for (number, (name, end)) in phases.iter().enumerate() {
            let right = self.x(*end).clamp(left, WIDTH - RIGHT);
            if number + 1 < phases.len() {
                for (k, panel) in self.panels.iter().enumerate() {
                    let above = if k == 0 { PHASES - 4.0 } else { 0.0 };
                    let line = stroke([right, panel.top - above], [right, panel.top + PANEL], GREY);
                    group = group.add(line.set("stroke-dasharray", "3 3"));
                }
            }
            if CHARACTER * name.chars().count() as f64 + 8.0 < right - left {
                let middle = (left + right) / 2.0;
                let name = text(name, middle, first.top - 6.0).set("text-anchor", "middle");
                group = group.add(name.set("font-size", 11));
            }
            left = right;
        }
        group
    }
}

impl<'a> Panel<'a> {
    fn new(column: &'a Column, difference: Option<&'a Column>) -> Self {
        let axis = Axis::new([].into_iter(), 0.0, TICKS[0], "");
        let (columns, differences, label) = (vec![column], vec![difference], String::new());
        Self { columns, differences, axis, label, top: 0.0, legend: Vec::new() }
    }

    /// Finds the axis for all of its columns, and its name.
    fn find_range(&mut self) {
        let unit = &self.columns[0].quantity.unit;
        let bands = self.columns.iter().zip(&self.differences).flat_map(|(column, difference)| {
            let distances = difference.iter().flat_map(|difference| &difference.values);
            let pairs = column.values.iter().zip(distances);
            pairs.flat_map(|(x, distance)| [x - distance, x + distance])
        });
        let values = self.columns.iter().flat_map(|column| column.values.iter().copied());
        self.axis = Axis::new(values.chain(bands), 0.06, TICKS[0], unit);
        let stem = |column: &&Column| match (&column.quantity.unit[..], self.columns.len()) {
            ("J", 2..) => "energy".to_owned(),
            (_, 1) => column.quantity.name.clone(),
            _ => column.quantity.name.split('.').next().unwrap_or_default().to_owned(),
        };
        let name = stem(&self.columns[0]);
        let is_common = self.columns.iter().all(|column| stem(column) == name);
        let unit = &self.axis.unit;
        let fits =
            CHARACTER * ((name.chars().count() + unit.chars().count() + 3) as f64) < PANEL + 20.0;
        self.label = match (is_common && fits, &unit[..]) {
            (true, "" | "1") => name,
            (true, _) => format!("{name} ({unit})"),
            (false, _) => unit.clone(),
        };
    }
}

/// Where a legend has each name, in as many lines as it takes (px).
fn places(columns: &[&Column], start: f64, y: f64) -> Vec<[f64; 2]> {
    let (mut x, mut y) = (start, y);
    let places = columns.iter().map(|column| {
        let width = SWATCH + CHARACTER * column.quantity.name.chars().count() as f64 + 16.0;
        if x > start && x + width > WIDTH - RIGHT + 16.0 {
            (x, y) = (start, y + LEGEND);
        }
        x += width;
        [x - width, y]
    });
    places.collect()
}

/// The area between two lines in the colour of a number.
fn band(upper: &Line, lower: &Line, number: usize) -> Path {
    let colour = COLOURS[number % COLOURS.len()];
    let path = Path::new().set("class", "band").set("d", upper.area_to(lower));
    path.set("fill", colour).set("fill-opacity", 0.25).set("stroke", "none")
}

/// A line in the colour and stroke of its number. Dissipated and supplied energies are dashed: the energy
/// supplied often equals the energy stored.
fn series(line: &Line, column: &Column, number: usize) -> Group {
    let colour = COLOURS[number % COLOURS.len()];
    let is_exchanged = EXCHANGED.contains(&&column.quantity.name[..]);
    let dashes = DASHES[(number / COLOURS.len() + usize::from(is_exchanged)) % DASHES.len()];
    let (data, alone) = line.drawn();
    let path = Path::new()
        .set("d", data)
        .set("fill", "none")
        .set("stroke", colour)
        .set("stroke-width", 1.6)
        .set("stroke-linejoin", "round")
        .set("stroke-dasharray", dashes);
    let mut group = Group::new().set("class", "series").add(path);
    for [x, y] in alone {
        let dot = Circle::new().set("cx", format!("{x:.2}")).set("cy", format!("{y:.2}"));
        group = group.add(dot.set("r", 2.4).set("fill", colour));
    }
    group
}

fn text(content: &str, x: f64, y: f64) -> Text {
    Text::new(content).set("x", format!("{x:.1}")).set("y", format!("{y:.1}"))
}

fn stroke([x1, y1]: [f64; 2], [x2, y2]: [f64; 2], colour: &str) -> Stroke {
    let line = Stroke::new().set("x1", format!("{x1:.2}")).set("x2", format!("{x2:.2}"));
    let line = line.set("y1", format!("{y1:.2}")).set("y2", format!("{y2:.2}"));
    line.set("stroke", colour)
}
