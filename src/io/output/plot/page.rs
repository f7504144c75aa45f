//! The page of a plot: panels one below the other, over one axis of time, or of the load factor.

use svg::Document;
use svg::node::element::{Group, Path};

use super::table::{Column, Table};
use crate::io::output::columns::EXCHANGED;
use crate::io::output::figure::{
    Axis, CHARACTER, Field, LEGEND, Line, SWATCH, legend_places, page, stroke, text,
};
use crate::io::output::{COLOURS, DASHES, INK};

/// Width of the page, and height of a panel (px).
const WIDTH: f64 = 720.0;
const PANEL: f64 = 170.0;
/// Room at the right end, between panels, for the title, for names of phases, and for the axis of time (px).
const RIGHT: f64 = 18.0;
const GAP: f64 = 18.0;
const TITLE: f64 = 34.0;
const PHASES: f64 = 18.0;
const TIME: f64 = 44.0;
/// Width of the names of axes (px).
const LABEL: f64 = 26.0;
/// Approximate number of lines across a panel and along the axis of time.
const TICKS: [usize; 2] = [5, 8];
const GRID: &str = "#e4e4e4";
const GREY: &str = "#777777";

/// A table's columns, laid out.
pub(super) struct Page<'a> {
    title: &'a str,
    table: &'a Table,
    panels: Vec<Panel<'a>>,
    /// Left end of the panels (px).
    left: f64,
}

/// The columns of one unit.
struct Panel<'a> {
    columns: Vec<&'a Column>,
    /// Their differences from the run before, if these are known.
    differences: Vec<Option<&'a Column>>,
    field: Field,
    label: String,
    /// Where the legend has each name (px).
    legend: Vec<[f64; 2]>,
}

impl<'a> Page<'a> {
    pub(super) fn new(title: &'a str, table: &'a Table, columns: &[&'a Column]) -> Self {
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
                None => panels.push(Panel::new(column, difference, table)),
            }
        }
        for panel in &mut panels {
            panel.find_range();
        }
        let label =
            |panel: &Panel| panel.field.y.ticks.iter().map(|tick| tick.1.chars().count()).max();
        let widest = panels.iter().filter_map(label).max().unwrap_or(0);
        let left = LABEL + CHARACTER * widest as f64 + 12.0;
        let mut page = Self { title, table, panels, left };
        page.lay_out();
        page
    }

    /// Finds where panels and legends stand.
    fn lay_out(&mut self) {
        let mut y = if self.title.is_empty() { 8.0 } else { TITLE };
        let (left, right) = (self.left, WIDTH - RIGHT);
        for (number, panel) in self.panels.iter_mut().enumerate() {
            if number > 0 {
                y += GAP;
            }
            if panel.columns.len() > 1 {
                let names = panel.columns.iter().map(|column| &column.quantity.name[..]);
                panel.legend = legend_places(names, [left, right], y + LEGEND / 2.0);
                let lowest = panel.legend.iter().map(|place| place[1]).fold(y, f64::max);
                y = lowest + LEGEND / 2.0 + 4.0;
            }
            if number == 0 && self.table.phases.len() > 1 {
                y += PHASES;
            }
            panel.field.edges = [left, y, right, y + PANEL];
            y += PANEL;
        }
    }

    /// The page as SVG.
    pub(super) fn draw(&self) -> Document {
        let bottom = self.panels.last().map_or(TITLE, |panel| panel.field.edges[3]);
        let mut drawing = page([WIDTH, bottom + TIME]);
        if !self.title.is_empty() {
            let title = text(self.title, [self.left, 22.0]).set("font-size", 15);
            drawing = drawing.add(title.set("font-weight", "bold"));
        }
        let Some(last) = self.panels.last() else {
            let nothing = "nothing to draw: no sensors, no energies";
            return drawing.add(text(nothing, [self.left, TITLE + 20.0]));
        };
        for panel in &self.panels {
            drawing = drawing.add(self.panel(panel));
        }
        let (_, name, _) = self.table.across();
        let time = match &last.field.x.unit[..] {
            "" | "1" => last.field.floor(name),
            unit => last.field.floor(&format!("{name} ({unit})")),
        };
        drawing.add(time.set("class", "time")).add(self.phases())
    }

    fn panel(&self, panel: &Panel) -> Group {
        let field = &panel.field;
        let name = field.side(&panel.label, self.left - 16.0);
        let mut group = field.grid().set("class", "panel").add(name).add(field.outline());
        for (number, column) in panel.columns.iter().enumerate() {
            let line = |values: &mut dyn Iterator<Item = f64>| {
                field.line(self.table.across().0.iter().copied().zip(values))
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
                let swatch = Line::swatch([*x, *y]);
                let name = text(&column.quantity.name, [x + SWATCH, y + 4.0]);
                group = group.add(series(&swatch, column, number)).add(name);
            }
        }
        group
    }

    /// The ends of the phases but the last, and their names where there is room.
    fn phases(&self) -> Group {
        let mut group = Group::new().set("class", "phases").set("fill", GREY);
        let phases = &self.table.phases;
        let (Some(first), true) = (self.panels.first(), phases.len() > 1) else { return group };
        let mut left = self.left;
        for (number, (name, end)) in phases.iter().enumerate() {
            let right = first.field.place(*end, 0.0)[0].clamp(left, WIDTH - RIGHT);
            if number + 1 < phases.len() {
                for (k, panel) in self.panels.iter().enumerate() {
                    let above = if k == 0 { PHASES - 4.0 } else { 0.0 };
                    let [_, top, _, bottom] = panel.field.edges;
                    let line = stroke([right, top - above], [right, bottom], GREY);
                    group = group.add(line.set("stroke-dasharray", "3 3"));
                }
            }
            if CHARACTER * name.chars().count() as f64 + 8.0 < right - left {
                let middle = (left + right) / 2.0;
                let name = text(name, [middle, first.field.edges[1] - 6.0]);
                group = group.add(name.set("text-anchor", "middle").set("font-size", 11));
            }
            left = right;
        }
        group
    }
}

impl<'a> Panel<'a> {
    fn new(column: &'a Column, difference: Option<&'a Column>, table: &Table) -> Self {
        let (across, _, unit) = table.across();
        let x = Axis::linear(across.iter().copied(), 0.0, TICKS[1], unit);
        let field = Field { edges: [0.0; 4], x, y: Axis::default(), colours: [INK, GRID, GRID] };
        let (columns, differences, label) = (vec![column], vec![difference], String::new());
        Self { columns, differences, field, label, legend: Vec::new() }
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
        self.field.y = Axis::linear(values.chain(bands), 0.06, TICKS[0], unit);
        let stem = |column: &&Column| match (&column.quantity.unit[..], self.columns.len()) {
            ("J", 2..) => "energy".to_owned(),
            (_, 1) => column.quantity.name.clone(),
            _ => column.quantity.name.split('.').next().unwrap_or_default().to_owned(),
        };
        let name = stem(&self.columns[0]);
        let is_common = self.columns.iter().all(|column| stem(column) == name);
        let unit = &self.field.y.unit;
        let fits =
            CHARACTER * ((name.chars().count() + unit.chars().count() + 3) as f64) < PANEL + 20.0;
        self.label = match (is_common && fits, &unit[..]) {
            (true, "" | "1") => name,
            (true, _) => format!("{name} ({unit})"),
            (false, _) => unit.clone(),
        };
    }
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
    line.draw(colour, 1.6, 2.4, dashes).set("class", "series")
}
