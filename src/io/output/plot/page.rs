//! The page of a plot: panels one below the other, over one axis of time, or of the load factor.

use super::table::{Column, Table};
use crate::io::output::columns::EXCHANGED;
use crate::io::output::figure::{Axis, CHARACTER, Figure, Note, Panel, Series, Theme};
use crate::io::output::{COLOURS, DASHES};

/// Width of the page, and height of the field of a panel (px).
const SIZE: [f64; 2] = [720.0, 170.0];
/// Approximate width of a field, and margin above it for names of phases (px).
const FIELD: f64 = 600.0;
const PHASES: f64 = 14.0;
/// Approximate number of lines across a panel and along the axis of time.
const LINES: [usize; 2] = [5, 8];

/// A panel for the columns of each unit.
pub(super) fn figure(title: &str, table: &Table, columns: &[&Column]) -> Figure {
    let (across, name, unit) = table.across();
    let x = Axis::linear(across.iter().copied(), 0.0, LINES[1], unit);
    let mut groups: Vec<Vec<&Column>> = Vec::new();
    for &column in columns {
        let same = |group: &&mut Vec<&Column>| group[0].quantity.unit == column.quantity.unit;
        match groups.iter_mut().find(same) {
            Some(group) => group.push(column),
            None => groups.push(vec![column]),
        }
    }
    let mut panels: Vec<Panel> = groups.iter().map(|group| panel(table, &x, group)).collect();
    add_phases(&mut panels, &table.phases);
    let mut about = String::new();
    match panels.last_mut() {
        Some(last) => last.names[0] = x.label(name),
        None => about += "nothing to draw: no sensors, no energies",
    }
    Figure { about, ..Figure::new(title, panels, SIZE) }
}

fn panel(table: &Table, x: &Axis, columns: &[&Column]) -> Panel {
    let mut series = Vec::new();
    for (number, column) in columns.iter().enumerate() {
        let colour = COLOURS[number % COLOURS.len()];
        let values = table.across().0.iter().copied().zip(column.values.iter().copied());
        if let Some(difference) = table.difference(column) {
            let edges = values.clone().zip(&difference.values).map(|((t, x), d)| (t, x - d, x + d));
            let edges: Vec<(f64, f64, f64)> = edges.collect();
            let stretches = edges.split(|(_, low, high)| !(low.is_finite() && high.is_finite()));
            series.extend(stretches.filter(|stretch| !stretch.is_empty()).map(|stretch| {
                let lower = stretch.iter().map(|edge| (edge.0, edge.1));
                let upper = stretch.iter().rev().map(|edge| (edge.0, edge.2));
                Series::area(colour, 0.25, lower.chain(upper))
            }));
        }
        // dissipated and supplied energies are dashed: the energy supplied often equals the energy stored
        let is_exchanged = EXCHANGED.contains(&&column.quantity.name[..]);
        let dashes = DASHES[(number / COLOURS.len() + usize::from(is_exchanged)) % DASHES.len()];
        let name = if columns.len() > 1 { column.quantity.name.clone() } else { String::new() };
        series.push(Series { name, dashes, width: 1.6, ..Series::line(colour, values) });
    }
    let values = series.iter().flat_map(|series| series.points.iter().map(|point| point.1));
    let y = Axis::linear(values, 0.06, LINES[0], &columns[0].quantity.unit);
    let stem = |column: &&Column| match (&column.quantity.unit[..], columns.len()) {
        ("J", 2..) => "energy".to_owned(),
        (_, 1) => column.quantity.name.clone(),
        _ => column.quantity.name.split('.').next().unwrap_or_default().to_owned(),
    };
    let label = y.label(&stem(&columns[0]));
    let is_common = columns.iter().all(|column| stem(column) == stem(&columns[0]));
    let fits = CHARACTER * (label.chars().count() as f64) < SIZE[1] + 20.0;
    let label = if is_common && fits { label } else { y.unit.clone() };
    let (axes, names) = ([x.clone(), y], [String::new(), label]);
    Panel { axes, names, series, ..Panel::default() }
}

/// The ends of the phases but the last, and above the first panel their names where there is space.
fn add_phases(panels: &mut [Panel], phases: &[(String, f64)]) {
    let Some(x) = panels.first().map(|panel| panel.axes[0].clone()) else { return };
    if phases.len() < 2 {
        return;
    }
    let [mut begin, last] = x.ends();
    panels[0].above += PHASES;
    for (number, (name, end)) in phases.iter().enumerate() {
        let end = end.clamp(begin, last);
        if number + 1 < phases.len() {
            for panel in &mut *panels {
                let ends = panel.axes[1].ends().map(|y| (end, y));
                let line = Series::line(Theme::PRINT.muted, ends);
                panel.series.push(Series { width: 1.0, dashes: "3 3", ..line });
            }
        }
        if CHARACTER * name.chars().count() as f64 + 8.0 < FIELD * (x.place(end) - x.place(begin)) {
            let (at, text) = ((0.5 * (begin + end), panels[0].axes[1].ends()[1]), name.clone());
            let shift = [0.0, -6.0];
            let note = Note { text, at, shift, anchor: "middle" };
            panels[0].notes.push(note);
        }
        begin = end;
    }
}
