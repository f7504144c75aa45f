//! The advice as a page for a web browser.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

use super::advice::{Advice, Candidate};
use crate::base::input::percent;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::Trajectory;
use crate::io::output::{Above, escaped, write_below};
use crate::scene::timeline::Scene;
use crate::studies::work_precision::fastest::time_text;
use crate::studies::work_precision::timing::Budget;
use crate::studies::work_precision::truth::reason;

const STYLE: &str = include_str!("page/page.css");
/// Processor time that each of the motions may take.
const LONGEST: Duration = Duration::from_secs(20);
/// Beginnings of lines about one candidate in the text of the advice.
const NAMES: [&str; 3] = ["Enough", "Smaller", "As written"];

impl Advice {
    /// Writes the advice as one HTML file for a web browser, without a network.
    ///
    /// It has the text of the advice, the errors of all candidates over their times, a table of them, and the
    /// motions of the scene as it was `written` and of the sufficient model, side by side, which are run once more,
    /// with `sampling`. `title` is its heading.
    ///
    /// `observer` is called after each step with the name of the current run, and ends the run by
    /// [`ControlFlow::Break`]: then the page is without that motion, as it is if a run fails or takes more
    /// than 20 s of processor time, and says so.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written; others of
    /// [`write_animation`](crate::io::output::write_animation).
    pub fn write_page(
        &self,
        written: &Scene,
        sampling: &Sampling,
        path: impl AsRef<Path>,
        title: &str,
        observer: &mut dyn FnMut(&str) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let is_enough = |enough: &&Candidate| enough.choice == self.written.choice;
        let mut shown = match self.enough.as_ref().filter(is_enough) {
            Some(enough) => vec![("As written, which is enough", enough)],
            None => vec![("As written", &self.written)],
        };
        let other = self.enough.as_ref().filter(|enough| !is_enough(enough));
        shown.extend(other.map(|enough| ("Enough", enough)));
        let mut motions = Vec::new();
        let mut left_out = Vec::new();
        for (name, candidate) in shown {
            let what = format!("for the page: {name}");
            match motion(candidate, written, sampling, &mut || observer(&what)) {
                Ok(motion) => motions.push((name, motion)),
                Err(why) => left_out.push(format!("{name}: {why}")),
            }
        }
        let html = self.html(&motions, &left_out);
        let motions: Vec<(&str, &Trajectory)> =
            motions.iter().map(|(name, motion)| (*name, motion)).collect();
        write_below(&Above { html: &html, style: STYLE }, &motions, path.as_ref(), title)
    }

    fn html(&self, motions: &[(&str, Trajectory)], left_out: &[String]) -> String {
        let answer = paragraphs(&self.to_string());
        let sets = self.enough.as_ref().map_or_else(String::new, |_| {
            let lines = escaped(&self.set().join("\n"));
            match &lines[..] {
                "" => "<p>The scene file is enough as it is: nothing has to be set.</p>\n".into(),
                _ => format!(
                    "<h3>What is enough, as <code>--set</code> takes it:</h3>\n<pre>{lines}</pre>\n"
                ),
            }
        });
        // beneath the names of what is enough and of what was written
        let answer = answer.replacen("</dl>\n", &format!("</dl>\n{sets}"), 1);
        let chart = self.chart().map_or_else(String::new, |chart| {
            let head = "<section class=\"card\" aria-labelledby=\"pareto\">\n<h2 id=\"pareto\">Error and time</h2>";
            format!("{head}\n<div class=\"pareto\">{chart}</div>\n</section>\n")
        });
        let shown = match motions {
            [] => "No motion is shown.".to_owned(),
            [(name, _)] => format!("The motion below: {}.", name.to_lowercase()),
            _ => "The motions below: as written, and what is enough, by one clock, on one scale, in the same colours for the \
                  same values."
                .to_owned(),
        };
        let left_out: String =
            left_out.iter().map(|why| format!("<li>{}</li>\n", escaped(why))).collect();
        let left_out =
            if left_out.is_empty() { left_out } else { format!("<ul>\n{left_out}</ul>\n") };
        format!(
            "<div class=\"advice\">\n<section class=\"card\" aria-labelledby=\"needs\">\n\
             <h2 id=\"needs\">What it needs</h2>\n{answer}</section>\n{chart}</div>\n\
             <section class=\"card\" aria-labelledby=\"candidates\">\n\
             <h2 id=\"candidates\">All that was run, the fastest first</h2>\n{}</section>\n\
             <section class=\"shown\">\n<p>{shown}</p>\n{left_out}</section>",
            self.table()
        )
    }

    /// All candidates, from fast to slow, with failures at the end.
    fn table(&self) -> String {
        let mut candidates: Vec<&Candidate> = self.candidates.iter().collect();
        candidates.sort_by(|a, b| {
            let failed = a.failure.is_some().cmp(&b.failure.is_some());
            failed.then(a.seconds.total_cmp(&b.seconds))
        });
        let rows: String = candidates.into_iter().map(|candidate| self.row(candidate)).collect();
        format!(
            "<div class=\"table\"><table>\n<thead><tr><th scope=\"col\">Model</th><th scope=\"col\">Error</th>\
             <th scope=\"col\">Time</th><th scope=\"col\">Unknowns</th><th scope=\"col\"></th></tr></thead>\n\
             <tbody>\n{rows}</tbody>\n</table></div>\n"
        )
    }

    fn row(&self, candidate: &Candidate) -> String {
        let Candidate { choice, error, seconds, unknowns, failure, .. } = candidate;
        let mut notes = self.roles_of(candidate);
        let is_on_front = self.is_on_front(candidate);
        notes.extend(is_on_front.then_some("front"));
        let notes: String =
            notes.iter().map(|note| format!("<span class=\"part\">{note}</span> ")).collect();
        let class = match (failure, is_on_front) {
            (Some(_), _) => " class=\"failed\"",
            (None, true) => " class=\"front\"",
            (None, false) => "",
        };
        let error = error
            .filter(|error| error.is_finite() && !self.is_truth(candidate))
            .map_or_else(String::new, percent);
        let [time, unknowns] = match failure {
            Some(_) => Default::default(),
            None => [time_text(*seconds), unknowns.to_string()],
        };
        let failure = failure.as_deref().map_or_else(String::new, |why| format!("failed: {why}"));
        format!(
            "<tr{class}><th scope=\"row\">{}</th><td>{error}</td><td>{time}</td><td>{unknowns}</td>\
             <td>{notes}{}</td></tr>\n",
            escaped(&choice.to_string()),
            escaped(&failure)
        )
    }
}

/// Runs a candidate once more, or returns why there is nothing to be shown.
fn motion(
    candidate: &Candidate,
    written: &Scene,
    sampling: &Sampling,
    observer: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<Trajectory, String> {
    if let Some(failure) = &candidate.failure {
        return Err(failure.clone());
    }
    if candidate.choice.is_static {
        return Err("an equilibrium, without a motion".into());
    }
    let scene = candidate.choice.scene(written).map_err(|error| error.to_string())?;
    let mut budget = Budget::new(LONGEST);
    let run =
        scene.simulate_with(&candidate.choice.settings, sampling, |_| match budget.is_spent() {
            true => ControlFlow::Break(()),
            false => observer(),
        });
    run.map_err(|error| reason(error).to_string())
}

/// The words of the advice as HTML: empty lines part paragraphs, lines that begin with "- " are points of a
/// list, those about one candidate stand out, and those of failures are folded.
fn paragraphs(text: &str) -> String {
    let mut html = String::new();
    let mut open = Block::Text;
    for line in text.lines() {
        let named =
            line.split_once(':').filter(|(name, _)| NAMES.iter().any(|own| name.starts_with(own)));
        let (block, line) = match (line.strip_prefix("- "), named) {
            (Some(point), _) if point.starts_with("failed: ") => {
                (Block::Failures, format!("<li>{}</li>\n", escaped(point)))
            }
            (Some(point), _) => (Block::List, format!("<li>{}</li>\n", escaped(point))),
            (None, Some((name, rest))) => {
                let [name, rest] = [name, rest.trim()].map(escaped);
                (Block::Names, format!("<dt>{name}</dt><dd>{rest}</dd>\n"))
            }
            (None, None) if line.is_empty() => (Block::Text, String::new()),
            (None, None) => (Block::Text, format!("<p>{}</p>\n", escaped(line))),
        };
        if block != open {
            html = html + open.tags()[1] + block.tags()[0];
            open = block;
        }
        html += &line;
    }
    html + open.tags()[1]
}

/// Lines that belong together.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Block {
    Text,
    Names,
    List,
    Failures,
}

impl Block {
    /// HTML tags before and after its lines.
    fn tags(self) -> [&'static str; 2] {
        match self {
            Self::Text => ["", ""],
            Self::Names => ["<dl>\n", "</dl>\n"],
            Self::List => ["<ul>\n", "</ul>\n"],
            Self::Failures => {
                ["<details>\n<summary>Runs that failed</summary>\n<ul>\n", "</ul>\n</details>\n"]
            }
        }
    }
}
