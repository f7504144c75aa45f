//! The rows of a study as a page for a web browser: a click on a point shows its run.

use std::path::Path;

use serde_json::{Value, json};

use super::row::Row;
use super::run::Sweep;
use super::store::Store;
use super::table::Results;
use crate::dynamics::error::Error;
use crate::io::file::write_file;
use crate::io::output::{BASE_STYLE, escaped};

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

impl Results {
    /// Writes the rows as one HTML file next to the rows of `store`: the plot, and for the point on which one clicks
    /// its values and, if its whole output was kept, its animation, which stays in a file of its own.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn write_page(
        &self,
        sweep: &Sweep,
        store: &Store,
        units: &[&str],
        path: impl AsRef<Path>,
    ) -> Result<(), Error> {
        let figure = self.figure(sweep, units, true).draw().to_string();
        let rows: Vec<Value> = self.rows.iter().map(|row| of_row(sweep, store, row)).collect();
        let units: Vec<&str> =
            units.iter().map(|unit| if *unit == "1" { "" } else { unit }).collect();
        let data = json!({
            "keys": sweep.plan().keys(),
            "quantities": sweep.quantities().collect::<Vec<_>>(),
            "units": units,
            "rows": rows,
        });
        // within a string of JSON this is the same character, but it cannot begin a tag of HTML
        let data = data.to_string().replace('<', "\\u003c");
        let title = &sweep.file().title;
        let title = if title.is_empty() { "A study" } else { title };
        let style = [BASE_STYLE, STYLE].concat();
        let page = PAGE.replace("/*style*/", &style).replace("/*script*/", SCRIPT);
        let [before, after] = ["<!--plot-->", "/*data*/"];
        // free text is inserted last
        let page = page.replace("<!--title-->", &escaped(title));
        let parts = page.split_once(before).map(|(head, rest)| (head, rest.split_once(after)));
        let text = match parts {
            Some((head, Some((middle, end)))) => [head, &figure, middle, &data, end].concat(),
            _ => page,
        };
        write_file(path.as_ref(), |file| file.write_all(text.as_bytes()))
    }
}

fn of_row(sweep: &Sweep, store: &Store, row: &Row) -> Value {
    let keys = sweep.plan().keys().iter().map(|key| row.keys.get(key));
    let quantities = sweep.quantities().map(|name| row.quantities.get(name).copied().flatten());
    let animation = store.run_directory(&row.id).join("animation.html");
    let kept = animation.exists().then(|| format!("runs/{}/animation.html", row.id));
    json!({
        "id": row.id,
        "keys": keys.collect::<Vec<_>>(),
        "quantities": quantities.collect::<Vec<_>>(),
        "verdict": row.verdict,
        "warnings": row.warnings,
        "failure": row.failure,
        "seconds": row.cost.wall_seconds,
        "animation": kept,
    })
}
