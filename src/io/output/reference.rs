//! The reference page of results.

use std::fmt::Write;

use super::columns::{Along, COLUMNS};
use super::report::{OfRun, OfStatics};

/// All columns of `trajectory.csv` and all keys of `report.json` in Markdown, with units and meanings: the
/// end of `docs/reference.md`.
pub fn reference() -> String {
    let mut page = String::from("### Columns of `trajectory.csv`\n\n");
    let columns = COLUMNS.iter().map(|kind| {
        let name = match kind.along {
            Along::Axes => format!("`{0}_x`, ...", kind.name),
            Along::None | Along::Rotations | Along::Sensor | Along::Verified => {
                format!("`{}`", kind.name)
            }
        };
        (name, kind.unit, kind.meaning)
    });
    table(&mut page, "column", columns);
    for (command, keys) in [("run", OfRun::keys()), ("static", OfStatics::keys())] {
        page += &format!("\n### Keys of `report.json` of `pliant {command}`\n\n");
        let keys =
            keys.into_iter().map(|(name, unit, meaning)| (format!("`{name}`"), unit, meaning));
        table(&mut page, "key", keys);
    }
    page
}

fn table<'a>(
    page: &mut String,
    what: &str,
    rows: impl Iterator<Item = (String, &'a str, &'a str)>,
) {
    // writing to a text cannot fail
    let _ = writeln!(page, "| {what} | unit | meaning |\n| --- | --- | --- |");
    for (name, unit, meaning) in rows {
        let _ = writeln!(page, "| {name} | {unit} | {meaning} |");
    }
}
