//! The page: what each ingredient of the model buys.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use pliant::output::Chart;
use pliant::{Law, SolidCells};

use super::Outcome;
use super::beam::{Hung, Matter, Model, Release};
use super::capture::{Trial, height};
use super::judge::{
    Damping, Nearness, Swing, all_trials, let_go, nearness, own_weight, sag, thread,
};

/// The model that the others differ from.
const MODEL: Model = Model {
    cells: SolidCells::Hexahedra20,
    nodes: [7, 2, 3],
    law: Law::StVenantKirchhoff,
    poisson: 0.48,
};

/// What a row of the table is judged with.
struct Row {
    name: &'static str,
    model: Model,
    matter: Matter,
    hung: Hung,
    own: [Nearness; 2],
    loaded: [Nearness; 2],
    /// That of the second trial under its own weight, and those under the load.
    own_release: Release,
    releases: [Release; 2],
}

/// The four trials.
pub struct Trials {
    pub own: [Trial; 2],
    pub loaded: [Trial; 2],
}

impl Trials {
    /// Judges a model of which everything but the releases under the load is known.
    fn row(
        &self,
        name: &'static str,
        model: Model,
        (matter, own): (Matter, [Release; 2]),
        hung: Hung,
    ) -> Outcome<Row> {
        let near = |hung: Hung, release: &Release, trial: &Trial| {
            nearness(&model, &matter, hung, release, trial)
        };
        let nothing = Hung::Nothing;
        let near_own =
            [near(nothing, &own[0], &self.own[0])?, near(nothing, &own[1], &self.own[1])?];
        let [a, b] = self.loaded.each_ref().map(|trial| let_go(&model, &matter, hung, trial));
        let releases = [a?, b?];
        let [a, b] = [0, 1].map(|k| near(hung, &releases[k], &self.loaded[k]));
        eprintln!("{name}: {matter:?}");
        Ok(Row {
            name,
            model,
            matter,
            hung,
            own: near_own,
            loaded: [a?, b?],
            own_release: own[1],
            releases,
        })
    }

    /// Fits the material to the beam under its own weight, and judges the model.
    fn fitted(
        &self,
        name: &'static str,
        model: Model,
        damping: Damping,
        hung: Hung,
    ) -> Outcome<Row> {
        self.row(name, model, own_weight(&model, damping, &self.own)?, hung)
    }
}

/// Writes `validation.md` and its pictures to a directory.
pub fn write(trials: &Trials, out: &Path) -> Outcome<()> {
    let alone = own_weight(&MODEL, Damping::Viscosity, &trials.own)?;
    let weight = trials.row("viscosity alone, 52 g as a force", MODEL, alone, Hung::Weight)?;
    let mass = trials.row("viscosity alone, 52 g as a mass", MODEL, alone, Hung::Mass)?;
    let found = own_weight(&MODEL, Damping::Both, &trials.own)?;
    let both = trials.row("**damping by mass and by stiffness**", MODEL, found, Hung::Mass)?;
    let hung = thread(&MODEL, &both.matter, &trials.loaded[0])?;
    let Hung::Thread(stiffness, damping) = hung else { return Err("no thread".into()) };
    let threaded = trials.row("the same, the mass on a damped spring", MODEL, found, hung)?;
    let four = all_trials(&MODEL, &trials.own, &trials.loaded)?;
    let four = trials.row("the same, fitted to all four trials", MODEL, four, Hung::Mass)?;
    let mut rows = vec![weight, mass, both, threaded, four];
    let others = [
        ("neo-Hookean", Model { law: Law::NeoHookean, ..MODEL }),
        ("nu = 0.45", Model { poisson: 0.45, ..MODEL }),
    ];
    for (name, model) in others {
        rows.push(trials.fitted(name, model, Damping::Both, Hung::Mass)?);
    }

    let pictures = out.join("validation");
    draw(trials, &rows, &pictures)?;
    let best = &rows[2];
    let mut page = String::new();
    let mm = |metres: f64| 1e3 * metres;
    write!(page, "{}", include_str!("before.md"))?;
    page += &table(trials, &rows)?;
    let off = |near: &[Nearness; 2]| near.map(|near| format!("{:.2}", mm(near.distance[1])));
    let ([own_a, own_b], [a, b]) = (off(&best.own), off(&best.loaded));
    let ([thread_a, thread_b], [four_a, four_b]) = (off(&rows[3].loaded), off(&rows[4].loaded));
    write!(
        page,
        "\nThe spring of the fourth row has {stiffness:.0} N/m and {damping:.1} N s/m, found on the first trial under the load.\n\n\
         ![The beam under its own weight](validation/own.svg)\n\n![The beam under 52 g](validation/load.svg)\n\n\
         ![What is left over](validation/left.svg)\n"
    )?;
    let numbers = [
        ("{own a}", own_a),
        ("{own b}", own_b),
        ("{a}", a),
        ("{b}", b),
        ("{thread a}", thread_a),
        ("{thread b}", thread_b),
        ("{four a}", four_a),
        ("{four b}", four_b),
        ("{four damping}", format!("{:.3}", rows[4].own[1].swing.damping)),
        ("{sag}", format!("{:.1}", mm(sag(&trials.loaded[1].moved)))),
        ("{model sag}", format!("{:.1}", mm(best.loaded[1].sag))),
    ];
    let after = include_str!("after.md").to_owned();
    page += &numbers.iter().fold(after, |text, (name, number)| text.replace(name, number));
    fs::write(out.join("validation.md"), page)?;
    Ok(())
}

/// Of all rows and of what was measured.
fn table(trials: &Trials, rows: &[Row]) -> Outcome<String> {
    let mut table = String::from(
        "| model | unknowns | E (kPa) | viscosity (Pa s) | rate (1/s) | own weight: off by (mm) | Hz | damping | 52 g: off by (mm) | Hz | damping | sag (mm) |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let swings = |trials: &[Trial; 2]| {
        let [a, b] =
            trials.each_ref().map(|trial| Swing::of(&trial.times, &trial.moved, trial.falls));
        (
            format!("{:.2}, {:.2}", a.frequency, b.frequency),
            format!("{:.3}, {:.3}", a.damping, b.damping),
        )
    };
    let (own, loaded) = (swings(&trials.own), swings(&trials.loaded));
    let [sag_a, sag_b] = trials.loaded.each_ref().map(|trial| 1e3 * sag(&trial.moved));
    writeln!(
        table,
        "| measured | | | | | | {} | {} | | {} | {} | {sag_a:.1}, {sag_b:.1} |",
        own.0, own.1, loaded.0, loaded.1
    )?;
    for Row { name, model, matter, own, loaded, .. } in rows {
        let off = |near: &[Nearness; 2]| {
            let [a, b] = near.map(|near| format!("{:.2}", 1e3 * near.distance[1]));
            format!("{a}, {b}")
        };
        let of = |near: &[Nearness; 2]| (near[1].swing.frequency, near[1].swing.damping);
        let (own_swing, swing) = (of(own), of(loaded));
        let [sag_a, sag_b] = loaded.map(|near| 1e3 * near.sag);
        writeln!(
            table,
            "| {name} | {} | {:.1} | {:.0} | {:.2} | {} | {:.2} | {:.3} | {} | {:.2} | {:.3} | {sag_a:.1}, {sag_b:.1} |",
            model.unknowns()?,
            1e-3 * matter.young,
            matter.viscosity,
            matter.drag,
            off(own),
            own_swing.0,
            own_swing.1,
            off(loaded),
            swing.0,
            swing.1,
        )?;
    }
    Ok(table)
}

/// How long (s) the pictures show.
const SHOWN: f64 = 1.6;

fn draw(trials: &Trials, rows: &[Row], pictures: &Path) -> Outcome<()> {
    let part = |trial: &Trial| {
        let at = |time: f64| trial.times.partition_point(|frame| *frame < time);
        at(trial.falls - 0.05)..at(trial.falls + SHOWN)
    };
    let measured = |trial: &Trial| -> Vec<(f64, f64)> {
        let part = part(trial);
        let heights = trial.moved[part.clone()].iter().map(|moved| 1e3 * height(moved));
        trial.times[part].iter().map(|time| time - trial.falls).zip(heights).collect()
    };
    let modelled =
        |row: &Row, hung: Hung, release: &Release, trial: &Trial| -> Outcome<Vec<(f64, f64)>> {
            let times = &trial.times[part(trial)];
            let moved = row.model.moved(&row.matter, hung, release, times)?;
            let heights = moved.iter().map(|moved| 1e3 * height(moved));
            Ok(times.iter().map(|time| time - trial.falls).zip(heights).collect())
        };
    let chart =
        |title: &str, what: &str| Chart::new(title).axes("time since the fall began (s)", what);
    let (own, loaded) = (&trials.own[1], &trials.loaded[1]);
    let (height_text, both) = ("height of the markers at the free end (mm)", &rows[2]);
    let release = both.own_release;
    let under_own = modelled(both, Hung::Nothing, &release, own)?;
    chart("Own weight: fitted", height_text)
        .series("model", under_own.clone())
        .reference("measured", measured(own))
        .write(pictures.join("own.svg"))?;
    let mut under_load = Vec::new();
    for row in [&rows[1], both, &rows[3]] {
        under_load.push(modelled(row, row.hung, &row.releases[1], loaded)?);
    }
    chart("52 g: predicted", height_text)
        .series("viscosity alone, as a mass", under_load[0].clone())
        .series("both kinds of damping, as a mass", under_load[1].clone())
        .series("both, on a damped spring", under_load[2].clone())
        .reference("measured", measured(loaded))
        .write(pictures.join("load.svg"))?;
    let left = |model: &[(f64, f64)], trial: &Trial| -> Vec<(f64, f64)> {
        model
            .iter()
            .zip(measured(trial))
            .map(|((time, model), (_, seen))| (*time, model - seen))
            .collect()
    };
    chart("What is left over", "model - measured (mm)")
        .series("own weight", left(&under_own, own))
        .series("52 g as a mass", left(&under_load[1], loaded))
        .series("52 g on a damped spring", left(&under_load[2], loaded))
        .write(pictures.join("left.svg"))?;
    Ok(())
}
