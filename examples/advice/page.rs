//! The page.

use crate::trial::Trial;

const ABOUT: &str = "\
# The adviser on trial

`pliant advise` says what model of a scene is enough, and how far off it is. Here it is asked about the whole motion of
scenes, and what it says is compared with a run that it knows nothing of: the richest model that it found, on cells half as
large as its finest, by ARKODE at a tenth of its tightest tolerance. Errors are root mean square distances of the nodes over 101 times,
relative to the root mean square displacement. Where Green strain gave the adviser no motion, all is said of Cauchy strain. All numbers are results of `cargo run --release --example advice`.
";

const COLUMNS: &str = "\
*Promised*: the most that it may be off by, the sum of the parts of its error as the adviser measured them, with what the adviser's own
finest mesh may be off by. *True*: against the run that it knows nothing of. *As written*: what it says of the scene file as it stands, and what is true. *Faster*: time of the scene as written over
that of what is enough. *Advice*: what the advice took, and how many times the run that it is compared with.

| scene | what is enough | promised | true | as written, told | true | faster | advice | in such runs |
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
        "\nAsked for {} % within {budget} s: of {} scenes {judged} were given a model that is enough, and {right} of these are right. \
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
        page += "\nCompared on the adviser's own finest mesh, and not on a finer one, as there was none:\n\n";
        unsure.iter().for_each(|line| page += line);
    }
    let silent = trials.iter().filter(|trial| trial.advice.enough.is_none());
    let silent: Vec<String> = silent
        .map(|trial| {
            let advice = trial.advice.to_string();
            let line = advice.lines().find(|line| line.starts_with("Nothing"));
            format!("- **{}**: {}\n", trial.name, line.unwrap_or("no motion to compare with"))
        })
        .collect();
    if !silent.is_empty() {
        page += "\nNothing was promised:\n\n";
        silent.iter().for_each(|line| page += line);
    }
    page
}

const SOFT: &str = "
## Thirty scenes of silicone

Fingers, rooms with sharp corners, blocks and pads, each with Poisson's ratio 0.45, 0.49 and 0.499, in a plane and in space: bending,
air, contact, friction. Each number is *promised / true*, as above. A promise *holds* if the true error is at most what was
promised; it is compared with a mesh finer than any that the adviser has seen, or stands in brackets: then there was none within the time.
*On this mesh*: the adviser says that it does not know what the mesh is off by, and promises nothing of it.
";

/// The section on scenes of silicone: each scene's trials, by accuracy.
pub fn soft(scenes: &[Vec<Trial>], budget: f64) -> String {
    let Some(first) = scenes.first() else { return String::new() };
    let mut page = SOFT.to_owned();
    page += &format!(
        "\nWithin {budget} s each:\n\n| asked for | promises | hold | below the accuracy asked for | promised over true, median | not known | advice, mean |\n\
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
