//! The work-precision chart: error over time, both logarithmic.

use std::collections::BTreeMap;
use std::path::Path;

use super::frame::{WORST, axes, below};
use super::{Findings, LineFindings};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::io::output::{COLOURS, DASHES, Figure, Mark, Panel, Series, Theme};
use crate::scene::settings::Method;

/// Width of the page, and height of the field (px).
const SIZE: [f64; 2] = [980.0, 436.0];
/// Marks of lines, for eyes that see no colours.
const SHAPES: [&str; 5] = [
    "",
    "m-3.8 -3.8 h7.6 v7.6 h-7.6 z",
    "m0 -5.4 l5.4 5.4 l-5.4 5.4 l-5.4 -5.4 z",
    "m0 -5.4 l5.2 8.8 h-10.4 z",
    "m0 5.4 l5.2 -8.8 h-10.4 z",
];

impl Findings {
    /// Draws error over time, both logarithmic, one line per line of the study, to an SVG or PNG
    /// file.
    ///
    /// # Errors
    /// [`Error::Input`] for another ending of `path`, and if no run succeeded; [`Error::Output`] if
    /// the file cannot be written.
    pub fn write_chart(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        self.figure()?.write(path.as_ref())
    }

    /// # Errors
    /// [`Error::Input`] if no run succeeded.
    fn figure(&self) -> Result<Figure, InputError> {
        let points: Vec<_> = self.lines().iter().flat_map(LineFindings::points).flatten().collect();
        if points.is_empty() {
            let help = "a chart needs one at least: its notes say why they failed";
            return Err(InputError::new("number of successful runs", 0, help));
        }
        let axes = axes(points.iter().map(|point| point.1), points.iter().map(|point| point.0));
        let unresolved = below(10.0 * self.resolution(), &axes);
        let mut series = Vec::new();
        if unresolved[1] != unresolved[0] {
            let name = "not sure: near what the reference resolves".into();
            let band = Series::area(Theme::PRINT.muted, 0.15, unresolved);
            series.push(Series { name, ..band });
        }
        let colours = colours(self.lines().iter().map(|line| line.family.as_str()));
        let mut members = BTreeMap::<&str, usize>::new();
        for (number, line) in self.lines().iter().enumerate() {
            let member = members.entry(&line.family).or_default();
            let dashes = DASHES[*member % DASHES.len()];
            *member += 1;
            let colour = COLOURS[colours[line.family.as_str()] % COLOURS.len()];
            let mark = Mark { shape: SHAPES[number % SHAPES.len()], radius: 4.2, is_hollow: false };
            let failed = line.rows.iter().filter(|row| row.failure.is_some()).count();
            let name = match failed {
                0 => line.name.clone(),
                _ => format!("{} ({failed} of {} runs failed)", line.name, line.rows.len()),
            };
            // a run that failed interrupts the line
            let points = line.points().map(|point| match point {
                Some((error, time)) => (time, error.min(WORST)),
                None => (f64::NAN, f64::NAN),
            });
            let points: Vec<(f64, f64)> = points.collect();
            let unsure = line.rows.iter().zip(&points).filter(|(row, _)| !row.is_resolved());
            let unsure: Vec<(f64, f64)> = unsure.map(|(_, point)| *point).collect();
            series.push(Series { name, dashes, mark: Some(mark), ..Series::line(colour, points) });
            series.push(Series::marks(colour, Mark { is_hollow: true, ..mark }, unsure));
        }
        let time = match self.is_processor_time() {
            true => "processor time of the solution",
            false => "time of the solution",
        };
        let names = [time, "relative error"].map(String::from);
        let panel = Panel { axes, names, series, ..Panel::default() };
        let figure = Figure::new(self.title(), vec![panel], SIZE);
        Ok(Figure { is_legend_beside: true, ..figure })
    }
}

/// The number of the colour of each family: that of the method, or the first that no other has.
fn colours<'a>(families: impl Iterator<Item = &'a str> + Clone) -> BTreeMap<&'a str, usize> {
    let own = |family: &str| Some(family.parse::<Method>().ok()?.information().colour);
    let mut colours: BTreeMap<_, _> =
        families.clone().filter_map(|family| Some((family, own(family)?))).collect();
    for family in families {
        let is_free = |colour: &usize| !colours.values().any(|taken| taken == colour);
        let free = (0..).find(is_free).unwrap_or_default();
        colours.entry(family).or_insert(free);
    }
    colours
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// As long as there are colours, no two families share one, whichever comes first, and methods keep
    /// theirs.
    #[test]
    fn families_have_colours_of_their_own() {
        let is_family = |method: &Method| method.family() == *method;
        let methods: Vec<_> = Method::ALL.into_iter().filter(is_family).map(Method::name).collect();
        for families in [methods.clone(), vec!["own", "rosenbrock", "other", "rk", "cvode-bdf"]] {
            let colours = colours(families.iter().copied());
            let distinct: BTreeSet<_> = colours.values().map(|&number| COLOURS[number]).collect();
            assert_eq!(distinct.len(), families.len(), "{colours:?}");
            for family in families.iter().filter(|family| methods.contains(family)) {
                assert_eq!(
                    Ok(colours[family]),
                    family.parse().map(|own: Method| own.information().colour)
                );
            }
        }
    }
}
