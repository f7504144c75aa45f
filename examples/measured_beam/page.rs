//! The page: what each ingredient of the model buys.

use std::fmt::Write;
use std::ops::Range;
use std::path::Path;

use pliant::fit::Fitted;
use pliant::output::Chart;
use pliant::{Dilatation, Law, SolidCells};

use super::beam::{Hung, Matter, Model, Release};
use super::capture::{Trial, height};
use super::judge::{
    Damping, Found, Nearness, Swing, all_trials, creep, let_go, nearness, own_weight, sag, thread,
};
use super::{Outcome, chapter};

/// The model that the others differ from.
const MODEL: Model = Model {
    cells: SolidCells::Hexahedra20,
    nodes: [7, 2, 3],
    law: Law::StVenantKirchhoff,
    poisson: 0.48,
    dilatation: Dilatation::AtPoints,
    rtol: 1e-4,
};
/// Tight tolerance: the effect of the Maxwell branches is small, and is lost in looser runs.
const FINE: Model = Model { rtol: 1e-5, ..MODEL };

/// Row of the table: model, material, fit, and distances from the measurement.
struct Row {
    name: &'static str,
    model: Model,
    matter: Matter,
    fitted: Fitted,
    hung: Hung,
    own: [Nearness; 2],
    loaded: [Nearness; 2],
    /// That of the second trial under its own weight, and those under the load.
    own_release: Release,
    releases: [Release; 2],
}

impl Row {
    /// Tells how far the work is, and what came of it.
    fn tell(&self) {
        let Fitted { unknowns, rms, residuals, independent, runs, failed, .. } = &self.fitted;
        eprintln!("{}: {runs} runs, {failed} failed", self.name);
        for found in unknowns {
            eprintln!("  {} = {:.4e} +- {:.1e}", found.unknown.name, found.value, found.confidence);
        }
        eprintln!("  {:.4e} m left over; {residuals} count as {independent:.0}", rms[1]);
        for Nearness { distance, sag, creep, .. } in self.own.iter().chain(&self.loaded) {
            eprintln!("  off by {:.2e} m, sag {sag:.4e}, creep {creep:.2e}", distance[1]);
        }
    }
}

/// The four trials.
pub struct Trials {
    pub own: [Trial; 2],
    pub loaded: [Trial; 2],
}

impl Trials {
    /// Judges a model of which everything but the releases under the load is known.
    fn row(&self, name: &'static str, model: Model, found: &Found, hung: Hung) -> Outcome<Row> {
        let Found { matter, releases: own, fitted } = found;
        let near = |hung: Hung, release: &Release, trial: &Trial| {
            nearness(&model, matter, hung, release, trial)
        };
        let nothing = Hung::Nothing;
        let near_own =
            [near(nothing, &own[0], &self.own[0])?, near(nothing, &own[1], &self.own[1])?];
        let [a, b] = self.loaded.each_ref().map(|trial| let_go(&model, matter, hung, trial));
        let releases = [a?, b?];
        let [a, b] = [0, 1].map(|k| near(hung, &releases[k], &self.loaded[k]));
        let row = Row {
            name,
            model,
            matter: *matter,
            fitted: fitted.clone(),
            hung,
            own: near_own,
            loaded: [a?, b?],
            own_release: own[1],
            releases,
        };
        row.tell();
        Ok(row)
    }

    /// Fits the material to the beam under its own weight, and judges the model.
    fn fitted(
        &self,
        name: &'static str,
        model: Model,
        damping: Damping,
        hung: Hung,
    ) -> Outcome<Row> {
        self.row(name, model, &own_weight(&model, damping, &self.own)?, hung)
    }
}

/// Writes `validation.md` and its pictures to a directory.
pub fn write(trials: &Trials, out: &Path) -> Outcome<()> {
    let alone = own_weight(&MODEL, Damping::Viscosity, &trials.own)?;
    let weight = trials.row("viscosity alone, 52 g as a force", MODEL, &alone, Hung::Weight)?;
    let mass = trials.row("viscosity alone, 52 g as a mass", MODEL, &alone, Hung::Mass)?;
    let found = own_weight(&MODEL, Damping::Both, &trials.own)?;
    let both = trials.row("**damping by mass and by stiffness**", MODEL, &found, Hung::Mass)?;
    let hung = thread(&MODEL, &both.matter, &trials.loaded[0])?;
    let Hung::Thread(stiffness, damping) = hung else { return Err("no thread".into()) };
    let threaded = trials.row("the same, the mass on a damped spring", MODEL, &found, hung)?;
    let four = all_trials(&MODEL, Damping::Both, &trials.own, &trials.loaded)?;
    let four = trials.row("the same, fitted to all four trials", MODEL, &four, Hung::Mass)?;
    let mut rows = vec![weight, mass, both, threaded, four];
    let branched = own_weight(&FINE, Damping::Branch, &trials.own)?;
    rows.push(trials.row("viscosity and one branch", FINE, &branched, Hung::Mass)?);
    rows.push(trials.row("the same, the mass on a damped spring", FINE, &branched, hung)?);
    let two = trials.fitted(
        "viscosity and branches of 0.3 s and 2 s",
        FINE,
        Damping::Branches,
        Hung::Mass,
    );
    let of_two = match two {
        Ok(row) => {
            rows.push(row);
            String::new()
        }
        Err(error) => format!("\nTwo branches could not be fitted to own weight: {error}.\n"),
    };
    let others = [
        ("neo-Hookean", Model { law: Law::NeoHookean, ..MODEL }),
        ("nu = 0.45", Model { poisson: 0.45, ..MODEL }),
        (
            "nu = 0.499, mean dilatation",
            Model { poisson: 0.499, dilatation: Dilatation::Mean, ..MODEL },
        ),
        ("a finer mesh", Model { nodes: [10, 2, 4], ..MODEL }),
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
    page += "\n";
    page += &intervals(&rows)?;
    page += &of_two;
    let off = |near: &[Nearness; 2]| near.map(|near| format!("{:.2}", mm(near.distance[1])));
    let ([own_a, own_b], [a, b]) = (off(&best.own), off(&best.loaded));
    let ([thread_a, thread_b], [four_a, four_b]) = (off(&rows[3].loaded), off(&rows[4].loaded));
    write!(
        page,
        "\nThe spring of the fourth row has {stiffness:.0} N/m and {damping:.1} N s/m, found on the first trial under the load.\n\n\
         ![The beam under its own weight](validation/own.svg)\n\n![The beam under 52 g](validation/load.svg)\n\n\
         ![Residuals](validation/left.svg)\n\n![Creep](validation/creep.svg)\n"
    )?;
    let branch = &rows[5];
    let [of_branch_a, of_branch_b] = off(&branch.loaded);
    let [on_spring_a, on_spring_b] = off(&rows[6].loaded);
    let [left_before, left_after] = [best, branch].map(|row| off(&row.own));
    let kilo = |row: &Row| format!("{:.1}", 1e-3 * row.matter.young);
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
        ("{young}", kilo(best)),
        ("{mean young}", kilo(&rows[rows.len() - 2])),
        ("{fine young}", kilo(&rows[rows.len() - 1])),
        ("{branch own}", left_after.join(" and ")),
        ("{plain own}", left_before.join(" and ")),
        ("{branch a}", of_branch_a),
        ("{branch b}", of_branch_b),
        ("{branch thread a}", on_spring_a),
        ("{branch thread b}", on_spring_b),
        ("{branch sag}", format!("{:.1}", mm(rows[6].loaded[1].sag))),
    ];
    let after = include_str!("after.md").to_owned();
    page += &numbers.iter().fold(after, |text, (name, number)| text.replace(name, number));
    Ok(chapter::write(&out.join("validation.md"), &page)?)
}

/// Of all rows and of what was measured.
fn table(trials: &Trials, rows: &[Row]) -> Outcome<String> {
    let mut table = String::from(
        "| model | unknowns | own weight: off by (mm) | Hz | damping | creep (mm) | 52 g: off by (mm) | Hz | damping | creep (mm) | sag (mm) |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
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
    let creeps = |trials: &[Trial; 2]| {
        let [a, b] =
            trials.each_ref().map(|trial| 1e3 * creep(&trial.times, &trial.moved, trial.falls));
        format!("{a:.2}, {b:.2}")
    };
    writeln!(
        table,
        "| measured | | | {} | {} | {} | | {} | {} | {} | {sag_a:.1}, {sag_b:.1} |",
        own.0,
        own.1,
        creeps(&trials.own),
        loaded.0,
        loaded.1,
        creeps(&trials.loaded)
    )?;
    for Row { name, model, own, loaded, .. } in rows {
        let off = |near: &[Nearness; 2]| {
            let [a, b] = near.map(|near| format!("{:.2}", 1e3 * near.distance[1]));
            format!("{a}, {b}")
        };
        let creeps = |near: &[Nearness; 2]| {
            let [a, b] = near.map(|near| format!("{:.2}", 1e3 * near.creep));
            format!("{a}, {b}")
        };
        let of = |near: &[Nearness; 2]| (near[1].swing.frequency, near[1].swing.damping);
        let (own_swing, swing) = (of(own), of(loaded));
        let [sag_a, sag_b] = loaded.map(|near| 1e3 * near.sag);
        writeln!(
            table,
            "| {name} | {} | {} | {:.2} | {:.3} | {} | {} | {:.2} | {:.3} | {} | {sag_a:.1}, {sag_b:.1} |",
            model.unknowns()?,
            off(own),
            own_swing.0,
            own_swing.1,
            creeps(own),
            off(loaded),
            swing.0,
            swing.1,
            creeps(loaded),
        )?;
    }
    Ok(table)
}

/// Confidence intervals of the fitted material parameters.
fn intervals(rows: &[Row]) -> Outcome<String> {
    let mut table = String::from(
        "| model | E (kPa) | viscosity (Pa s) | rate (1/s) | share of branches, and time (s) | residuals | count as | runs |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let mut last = f64::NAN;
    for Row { name, fitted, matter, .. } in rows {
        // a fit that is judged twice
        if matter.young == last {
            continue;
        }
        last = matter.young;
        let told = |name: &str, scale: f64, digits: usize| {
            let found = fitted.unknowns.iter().find(|found| found.unknown.name == name);
            found.map_or(String::new(), |found| {
                let [value, half] = [found.value, found.confidence].map(|x| scale * x);
                let end = if found.is_at_end() { " (end of its range)" } else { "" };
                format!("{value:.digits$} +- {half:.digits$}{end}")
            })
        };
        let of_branches = ["share 1", "share 2", "time"].map(|name| told(name, 1.0, 3));
        let branches = of_branches.into_iter().filter(|told| !told.is_empty());
        let branches = branches.collect::<Vec<_>>().join(", ");
        writeln!(
            table,
            "| {name} | {} | {} | {} | {} | {} | {:.0} | {} |",
            told("E", 1e-3, 1),
            told("viscosity", 1.0, 0),
            told("rate", 1.0, 2),
            branches,
            fitted.residuals,
            fitted.independent,
            fitted.runs,
        )?;
    }
    Ok(table)
}

/// From when until when (s) after the fall began the pictures show the swings, and how the beam sinks.
const SWINGING: [f64; 2] = [-0.05, 1.6];
const SINKING: [f64; 2] = [1.2, 4.3];

/// Heights (mm) over time (s) since the fall began.
type Heights = Vec<(f64, f64)>;

fn part(trial: &Trial, [from, until]: [f64; 2]) -> Range<usize> {
    let at = |time: f64| trial.times.partition_point(|frame| *frame < time);
    at(trial.falls + from)..at(trial.falls + until)
}

fn measured(trial: &Trial, shown: [f64; 2]) -> Heights {
    let part = part(trial, shown);
    let heights = trial.moved[part.clone()].iter().map(|moved| 1e3 * height(moved));
    trial.times[part].iter().map(|time| time - trial.falls).zip(heights).collect()
}

/// As a row has the second trial of a kind.
fn modelled(row: &Row, hung: Hung, trial: &Trial, shown: [f64; 2]) -> Outcome<Heights> {
    let release = match hung {
        Hung::Nothing => &row.own_release,
        _ => &row.releases[1],
    };
    let times = &trial.times[part(trial, shown)];
    let moved = row.model.moved(&row.matter, hung, release, times)?;
    let heights = moved.iter().map(|moved| 1e3 * height(moved));
    Ok(times.iter().map(|time| time - trial.falls).zip(heights).collect())
}

fn draw(trials: &Trials, rows: &[Row], pictures: &Path) -> Outcome<()> {
    let chart =
        |title: &str, what: &str| Chart::new(title).axes("time since the fall began (s)", what);
    let (own, loaded) = (&trials.own[1], &trials.loaded[1]);
    let height_text = "height of the markers at the free end (mm)";
    let (both, spring, branch) = (&rows[2], &rows[3], &rows[5]);
    let [of_own, of_load] = [(Hung::Nothing, own), (Hung::Mass, loaded)].map(
        |(hung, trial)| -> Outcome<[Heights; 2]> {
            Ok([modelled(both, hung, trial, SWINGING)?, modelled(branch, hung, trial, SWINGING)?])
        },
    );
    let ([plain, relaxing], [mass, relaxing_mass]) = (of_own?, of_load?);
    let on_spring = modelled(spring, spring.hung, loaded, SWINGING)?;
    chart("Own weight: fitted", height_text)
        .series("both kinds of damping", plain.clone())
        .series("viscosity and one branch", relaxing)
        .reference("measured", measured(own, SWINGING))
        .write(pictures.join("own.svg"))?;
    chart("52 g: predicted", height_text)
        .series("both kinds of damping, as a mass", mass.clone())
        .series("both, on a damped spring", on_spring.clone())
        .series("one branch, as a mass", relaxing_mass.clone())
        .reference("measured", measured(loaded, SWINGING))
        .write(pictures.join("load.svg"))?;
    let left = |model: Heights, trial: &Trial| -> Heights {
        let seen = measured(trial, SWINGING);
        model.iter().zip(seen).map(|((time, model), (_, seen))| (*time, model - seen)).collect()
    };
    chart("Residuals", "model - measured (mm)")
        .series("own weight", left(plain, own))
        .series("52 g as a mass", left(mass, loaded))
        .series("52 g on a damped spring", left(on_spring, loaded))
        .series("52 g as a mass, one branch", left(relaxing_mass, loaded))
        .write(pictures.join("left.svg"))?;
    chart("Own weight: how it sinks", height_text)
        .series("both kinds of damping", modelled(both, Hung::Nothing, own, SINKING)?)
        .series("viscosity and one branch", modelled(branch, Hung::Nothing, own, SINKING)?)
        .reference("measured", measured(own, SINKING))
        .write(pictures.join("creep.svg"))
        .map_err(Into::into)
}
