//! The page.

use crate::trial::Trial;

const ABOUT: &str = "\
# Tests of the adviser

`pliant advise` recommends a sufficient model of a scene, with a bound of its error. Here its advice for the whole motion of
scenes is compared with an independent run: the richest model that it found, on cells half as
large as its finest, by ARKODE at a tenth of its tightest tolerance. Errors are root mean square distances of the nodes over 101 times,
relative to the root mean square displacement. Where Green strain gave the adviser no motion, Cauchy strain is the reference. All numbers are results of `cargo run --release --example advice`.
";

const COLUMNS: &str = "\
*Promised*: bound of the error, the sum of its parts as the adviser measured them, with the possible error of the adviser's own
finest mesh. *True*: against the independent run. *As written*: the error that it states for the scene file as written, and the true one. *Faster*: time of the scene as written over
that of the sufficient model. *Advice*: time of the advice, also relative to that of the independent run.

| scene | sufficient model | promised | true | as written, estimated | true | faster | advice | in such runs |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
";

/// The page on all `trials`, for an accuracy and a budget (s).
pub fn page(trials: &[Trial], within: f64, budget: f64) -> String {
    let mut page = ABOUT.to_owned();
    let count = |is: fn(&Trial) -> bool| trials.iter().filter(|trial| is(trial)).count();
    let judged = count(|trial| trial.is_right().is_some());
    let right = count(|trial| trial.is_right() == Some(true));
    let finer = count(Trial::is_against_finer);
    let cheap = count(|trial| trial.is_against_finer() && trial.cost() <= Some(3.0));
    page += &format!(
        "\nRequest: {} % within {budget} s. Of {} scenes {judged} got a sufficient model, and {right} of these are correct. \
         {finer} of them are compared with a run on a finer mesh, the others with one on their own; of those {finer} \
         the advice took at most three times that run for {cheap}.\n\n",
        100.0 * within,
        trials.len()
    );
    page += COLUMNS;
    trials.iter().for_each(|trial| page += &(trial.row() + "\n"));
    let unsure = trials.iter().filter_map(|trial| Some((&trial.name, trial.not_finer.as_ref()?)));
    let unsure: Vec<String> = unsure
        .map(|(name, why)| {
            let why = why.lines().next().unwrap_or_default();
            format!("- **{name}**: {why}\n")
        })
        .collect();
    if !unsure.is_empty() {
        page += "\nCompared on the adviser's own finest mesh, as there was no finer one:\n\n";
        unsure.iter().for_each(|line| page += line);
    }
    let silent = trials.iter().filter(|trial| trial.advice.enough.is_none());
    let silent: Vec<String> = silent
        .map(|trial| {
            let advice = trial.advice.to_string();
            let line = advice.lines().find(|line| line.starts_with("No candidate"));
            format!("- **{}**: {}\n", trial.name, line.unwrap_or("no motion to compare with"))
        })
        .collect();
    if !silent.is_empty() {
        page += "\nWithout a bound:\n\n";
        silent.iter().for_each(|line| page += line);
    }
    page
}

const SOFT: &str = "
## Thirty scenes of silicone

Fingers, chambers with sharp corners, blocks and pads, each with Poisson's ratio 0.45, 0.49 and 0.499, in a plane and in space: bending,
air, contact, friction. Each number is *promised / true*, as above. A promise *holds* if the true error is at most the
promised one; the comparison is with a mesh finer than all of the adviser's, or in brackets, if there was none within the time.
*On this mesh*: the adviser states that the error of the mesh is unknown, and gives no bound of it.
";

/// The section on scenes of silicone: each scene's trials, by accuracy.
pub fn soft(scenes: &[Vec<Trial>], budget: f64) -> String {
    let Some(first) = scenes.first() else { return String::new() };
    let mut page = SOFT.to_owned();
    page += &format!(
        "\nWithin {budget} s each:\n\n| requested | promises | hold | below the requested accuracy | promised over true, median | not known | advice, mean |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
    );
    for (number, accuracy) in first.iter().map(|trial| trial.advice.accuracy).enumerate() {
        let all: Vec<&Trial> = scenes.iter().map(|trials| &trials[number]).collect();
        let judged: Vec<(f64, f64)> = all
            .iter()
            .filter(|trial| trial.is_against_finer())
            .filter_map(|trial| Some((trial.promised()?, trial.enough?)))
            .collect();
        let hold = judged.iter().filter(|(promised, error)| error <= promised).count();
        let right = judged.iter().filter(|(_, error)| *error <= accuracy).count();
        let mut sharpness: Vec<f64> =
            judged.iter().map(|(promised, error)| promised / error).collect();
        sharpness.sort_by(f64::total_cmp);
        let median = sharpness.get(sharpness.len() / 2).copied().unwrap_or(f64::NAN);
        let unknown = all.iter().filter(|trial| trial.promised().is_none()).count();
        let seconds: f64 = all.iter().map(|trial| trial.advice.seconds).sum();
        page += &format!(
            "| {} % | {} | {hold} | {right} | {median:.1} | {unknown} | {:.1} s |\n",
            100.0 * accuracy,
            judged.len(),
            seconds / all.len() as f64
        );
    }
    page += "\n| scene |";
    for trial in first {
        page += &format!(" {} % |", 100.0 * trial.advice.accuracy);
    }
    page += &format!("\n| --- |{}\n", " --- |".repeat(first.len()));
    for trials in scenes {
        page += &format!("| {} |", trials[0].name);
        for trial in trials {
            let text = match (trial.promised(), trial.enough) {
                (Some(promised), Some(error)) => {
                    format!("{:.2} / {:.2} %", 100.0 * promised, 100.0 * error)
                }
                (None, _) if trial.advice.enough.is_some() => "on this mesh".into(),
                _ => "not known".into(),
            };
            let is_known = trial.promised().is_some() && trial.enough.is_some();
            let text = match is_known && !trial.is_against_finer() {
                true => format!("({text})"),
                false => text,
            };
            page += &format!(" {text} |");
        }
        page += "\n";
    }
    page
}
