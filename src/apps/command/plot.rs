//! `pliant plot`

use std::path::PathBuf;

use clap::Args;
use pliant::output::{Plot, Table};

use super::failure::{Failure, print};

/// Draw sensors and energies over time from the results of a run
///
/// Writes plot.svg beside the trajectory.csv that it reads, with a panel for each unit; units of sensors and the ends of
/// phases are those of report.json.
#[derive(Args)]
pub struct Arguments {
    /// Directory of the results
    #[arg(value_name = "OUT")]
    directory: PathBuf,
    /// Columns of trajectory.csv to draw instead of sensors and energies: com_y,kinetic
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    columns: Option<Vec<String>>,
    /// Title [default: the title of the scene]
    #[arg(long, default_value = "", hide_default_value = true)]
    title: String,
    /// Write plot.png instead
    #[arg(long)]
    png: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { directory, columns, title, png } = arguments;
    let table = Table::read(directory)?;
    let mut plot = Plot::new().title(title);
    if let Some(columns) = columns {
        plot = plot.columns(columns);
    }
    let path = directory.join(if *png { "plot.png" } else { "plot.svg" });
    plot.write_table(&table, &path)?;
    print(format_args!("written to {}", path.display()))
}
