//! The work-precision chart: error over time, both logarithmic.

use std::collections::BTreeMap;
use std::path::Path;

use svg::Document;
use svg::node::element::{Circle, Group, Path as Outline, Polyline};

use super::frame::Frame;
use super::{Findings, LineFindings};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::io::output::{COLOURS, DASHES, INK, Point, page, rectangle, round, text, write_figure};

/// Left, top, right and bottom of the field in which lines are drawn (px).
const FIELD: [f64; 4] = [84.0, 64.0, 684.0, 500.0];
/// Width and height of the page (px).
const PAGE: [f64; 2] = [980.0, 560.0];
/// Families that have the same colour in all charts, by their place here; others take the colours that are
/// left.
const FAMILIES: [&str; 8] =
    ["cvode-bdf", "cvode-adams", "rk", "ida", "arkode", "central-difference", "auto", "rosenbrock"];
const GRID: &str = "#dddddd";
const FAINT_GRID: &str = "#f1f1f1";

impl Findings {
    /// Draws error over time, both logarithmic, one line per line of the study, to an SVG or PNG
    /// file.
    ///
    /// # Errors
    /// [`Error::Input`] for another ending of `path`, and if no run succeeded; [`Error::Output`] if
    /// the file cannot be written.
    pub fn write_chart(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write_figure(&Chart::of(self)?.draw(), path.as_ref())
    }
}

/// Findings on a page.
struct Chart<'a> {
    findings: &'a Findings,
    frame: Frame,
}

/// Style of a line: colour, dashes and marker.
struct Style {
    colour: &'static str,
    dashes: &'static str,
    marker: usize,
}

impl<'a> Chart<'a> {
    /// # Errors
    /// [`Error::Input`] if no run succeeded.
    fn of(findings: &'a Findings) -> Result<Self, Error> {
        let points: Vec<_> =
            findings.lines().iter().flat_map(LineFindings::points).flatten().collect();
        if points.is_empty() {
            let help = "a chart needs one at least: its notes say why they failed";
            return Err(InputError::new("number of successful runs", 0, help).into());
        }
        let (times, errors) =
            (points.iter().map(|point| point.1), points.iter().map(|point| point.0));
        Ok(Self { findings, frame: Frame::new(FIELD, [INK, GRID, FAINT_GRID], times, errors) })
    }

    fn draw(&self) -> Document {
        let time = match self.findings.is_processor_time() {
            true => "processor time of the solution",
            false => "time of the solution",
        };
        let styles = styles(self.findings.lines());
        let lines = || self.findings.lines().iter().zip(&styles);
        let mut document = page(PAGE)
            .add(
                text(self.findings.title(), [20.0, 30.0])
                    .set("font-size", 17)
                    .set("font-weight", "bold"),
            )
            .add(self.unresolved())
            .add(self.frame.axes(time))
            .add(self.unresolved_label());
        for (line, style) in lines() {
            document = document.add(self.line(line, style));
        }
        let apart = ((PAGE[1] - 84.0) / self.findings.lines().len() as f64).min(34.0);
        lines().enumerate().fold(document, |document, (number, (line, style))| {
            document.add(key(line, style, 76.0 + apart * number as f64))
        })
    }

    /// A band over the errors that the reference itself may have.
    fn unresolved(&self) -> Group {
        let [left, top, right, bottom] = FIELD;
        let [_, level] = self.frame.place(10.0 * self.findings.resolution(), 1.0);
        if level >= bottom - 1.0 {
            return Group::new();
        }
        let level = level.max(top);
        let band = rectangle([left, level], [right, bottom]).set("fill", "#eeeeee");
        Group::new().add(band)
    }

    /// Label of the unresolved band, where there is room for it.
    fn unresolved_label(&self) -> Group {
        let [_, _, right, bottom] = FIELD;
        let [_, level] = self.frame.place(10.0 * self.findings.resolution(), 1.0);
        if level > bottom - 18.0 {
            return Group::new();
        }
        let label = "not sure: near what the reference resolves";
        Group::new().add(
            text(label, [right - 6.0, bottom - 6.0])
                .set("text-anchor", "end")
                .set("fill", "#666666")
                .set("font-size", 11)
                .set("stroke", "#eeeeee")
                .set("stroke-width", 4)
                .set("paint-order", "stroke"),
        )
    }

    fn line(&self, line: &LineFindings, style: &Style) -> Group {
        let mut group = Group::new();
        let points: Vec<_> = line
            .points()
            .map(|point| point.map(|(error, time)| self.frame.place(error, time)))
            .collect();
        // a run that failed interrupts the line
        for stretch in points.split(Option::is_none).filter(|stretch| !stretch.is_empty()) {
            let stretch: Vec<Point> = stretch.iter().copied().flatten().collect();
            group = group.add(style.polyline(&stretch));
        }
        for (row, point) in line.rows.iter().zip(points) {
            if let Some(point) = point {
                group = group.add(style.marker(point, row.is_resolved()));
            }
        }
        group
    }
}

impl Style {
    fn polyline(&self, points: &[Point]) -> Polyline {
        let points: Vec<_> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        Polyline::new()
            .set("points", points.join(" "))
            .set("fill", "none")
            .set("stroke", self.colour)
            .set("stroke-width", 1.8)
            .set("stroke-linejoin", "round")
            .set("stroke-dasharray", self.dashes)
    }

    /// A marker, hollow for an error that is not sure.
    fn marker(&self, [x, y]: Point, is_sure: bool) -> Group {
        let group = Group::new()
            .set("fill", if is_sure { self.colour } else { "white" })
            .set("stroke", self.colour)
            .set("stroke-width", 1.5);
        let shape = match self.marker {
            0 => {
                let circle = Circle::new().set("cx", round(x)).set("cy", round(y));
                return group.add(circle.set("r", 3.6));
            }
            1 => "m-3.3 -3.3 h6.6 v6.6 h-6.6 z",
            2 => "m0 -4.8 l4.8 4.8 l-4.8 4.8 l-4.8 -4.8 z",
            3 => "m0 -4.6 l4.6 7.6 h-9.2 z",
            _ => "m0 4.6 l4.6 -7.6 h-9.2 z",
        };
        group.add(Outline::new().set("d", format!("M{x:.2} {y:.2} {shape}")))
    }
}

/// Colours by family; strokes within a family; markers by line, for eyes that see no colours.
fn styles(lines: &[LineFindings]) -> Vec<Style> {
    let colours = colours(lines.iter().map(|line| line.family.as_str()));
    let mut members = BTreeMap::<&str, usize>::new();
    let styles = lines.iter().enumerate().map(|(number, line)| {
        let member = members.entry(&line.family).or_default();
        *member += 1;
        Style {
            colour: COLOURS[colours[line.family.as_str()] % COLOURS.len()],
            dashes: DASHES[(*member - 1) % DASHES.len()],
            marker: number % 5,
        }
    });
    styles.collect()
}

/// The number of the colour of each family: its own, or the first that no other has.
fn colours<'a>(families: impl Iterator<Item = &'a str> + Clone) -> BTreeMap<&'a str, usize> {
    let own = |family: &str| FAMILIES.iter().position(|known| *known == family);
    let mut colours: BTreeMap<_, _> =
        families.clone().filter_map(|family| Some((family, own(family)?))).collect();
    for family in families {
        let is_free = |colour: &usize| !colours.values().any(|taken| taken == colour);
        let free = (0..).find(is_free).unwrap_or_default();
        colours.entry(family).or_insert(free);
    }
    colours
}

/// Name of a line, with its stroke, next to the field.
fn key(line: &LineFindings, style: &Style, y: f64) -> Group {
    let left = FIELD[2] + 20.0;
    let group = Group::new()
        .add(style.polyline(&[[left, y], [left + 34.0, y]]))
        .add(style.marker([left + 17.0, y], true))
        .add(text(&line.name, [left + 42.0, y + 4.0]));
    let failed = line.rows.iter().filter(|row| row.failure.is_some()).count();
    match failed {
        0 => group,
        _ => group.add(
            text(format!("{failed} of {} runs failed", line.rows.len()), [left + 42.0, y + 18.0])
                .set("fill", "#777777")
                .set("font-size", 11),
        ),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::scene::settings::Method;

    /// As long as there are colours, no two families share one, whichever comes first, and methods keep
    /// theirs.
    #[test]
    fn families_have_colours_of_their_own() {
        let is_family = |method: &Method| !matches!(method, Method::IdaKlu | Method::IdaIndexTwo);
        let methods: Vec<_> = Method::ALL.into_iter().filter(is_family).map(Method::name).collect();
        for families in [methods.clone(), vec!["own", "rosenbrock", "other", "rk", "cvode-bdf"]] {
            let colours = colours(families.iter().copied());
            let distinct: BTreeSet<_> = colours.values().map(|&number| COLOURS[number]).collect();
            assert_eq!(distinct.len(), families.len(), "{colours:?}");
            for family in families.iter().filter(|family| methods.contains(family)) {
                assert_eq!(FAMILIES[colours[family]], *family);
            }
        }
    }
}
