//! The page: text, tables and pictures, one after the other.

use std::fmt::{Display, Write};
use std::fs;
use std::path::PathBuf;

use pliant::output::Chart;

use super::Outcome;

/// A page in Markdown and the directory of its pictures, which stands beside it.
pub struct Page {
    text: String,
    directory: PathBuf,
}

impl Page {
    /// An empty page with pictures in `directory`.
    pub fn new(directory: impl Into<PathBuf>) -> Self {
        Self { text: String::new(), directory: directory.into() }
    }

    /// Adds a paragraph, heading or block.
    pub fn say(&mut self, paragraph: impl Display) {
        let _ = write!(self.text, "{paragraph}\n\n");
    }

    /// Adds a table.
    pub fn table<const N: usize>(&mut self, head: [&str; N], rows: &[[String; N]]) {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        self.text += &line(&head.map(String::from));
        self.text += &line(&[const { String::new() }; N].map(|_| "---".into()));
        for row in rows {
            self.text += &line(row);
        }
        self.text += "\n";
    }

    /// Draws a chart and shows it.
    pub fn chart(&mut self, name: &str, caption: &str, chart: &Chart) -> Outcome<()> {
        chart.write(self.directory.join(format!("{name}.svg")))?;
        self.show(name, caption);
        Ok(())
    }

    /// Writes a picture and shows it.
    pub fn picture(&mut self, name: &str, caption: &str, svg: &str) -> Outcome<()> {
        fs::create_dir_all(&self.directory)?;
        fs::write(self.directory.join(format!("{name}.svg")), svg)?;
        self.show(name, caption);
        Ok(())
    }

    fn show(&mut self, name: &str, caption: &str) {
        let directory = self.directory.file_name().unwrap_or_default().to_string_lossy();
        self.say(format!("![{caption}]({directory}/{name}.svg)"));
    }

    /// The text so far.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// A number in few characters: 0.0123, 4.56e-7, 12,345.
pub fn few(x: f64) -> String {
    let size = x.abs();
    match size {
        _ if !x.is_finite() => format!("{x}"),
        0.0 => "0".into(),
        1e3..1e7 => grouped(x.round() as i64),
        100.0..1e3 => format!("{x:.0}"),
        10.0..100.0 => format!("{x:.1}"),
        1.0..10.0 => format!("{x:.2}"),
        1e-3..1.0 => format!("{x:.0$}", 1 + size.log10().floor().abs() as usize),
        _ => format!("{x:.1e}"),
    }
}

/// A count with its thousands apart.
pub fn count(n: usize) -> String {
    grouped(n as i64)
}

fn grouped(n: i64) -> String {
    let digits = n.abs().to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    if n < 0 { format!("-{text}") } else { text }
}

/// A part of one as a percentage.
pub fn percent(x: f64) -> String {
    format!("{} %", few(100.0 * x))
}
