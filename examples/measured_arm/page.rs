//! The chapter: what was measured, what models make of it, and which guesses matter.

use std::fmt::Write;
use std::path::Path;

use pliant::Dilatation;
use pliant::output::{Chart, Snapshots};

use super::arm::{Model, Reinforcement, State};
use super::capture::Trial;
use super::judge::{FITTED, PREDICTED, Row, fit, trial};
use super::section::{Division, SHAPE, Shape};
use super::{Outcome, chapter};

/// The model that the others differ from.
const MODEL: Model = Model {
    shape: SHAPE,
    reinforcement: Reinforcement::Ribs(1e7),
    poisson: 0.49,
    division: Division { chamber: 2, web: 1, height: 1, along: 6 },
    dilatation: Dilatation::Linear,
};

/// All pressures (mbar).
const PRESSURES: [f64; 4] = [FITTED[0], FITTED[1], PREDICTED[0], PREDICTED[1]];

/// Writes the chapter in `validation.md` and its pictures to a directory.
pub fn write(trials: &[Trial], out: &Path) -> Outcome<()> {
    let own = |name: &'static str, model: Model| fit(name, model, trials);
    let of_shape = |shape: Shape| Model { shape, ..MODEL };
    let rows = [
        own("**ribs across the chambers**", MODEL)?,
        own("softer ribs, 3 MPa", Model { reinforcement: Reinforcement::Ribs(3e6), ..MODEL })?,
        own("rings around the arm", Model { reinforcement: Reinforcement::Rings(1e7), ..MODEL })?,
        own("outer wall 2.5 mm", of_shape(Shape { outer_wall: 0.0025, ..SHAPE }))?,
        own("wall to the duct 2.8 mm", of_shape(Shape { inner_wall: 0.0028, ..SHAPE }))?,
        own("length 103 mm", of_shape(Shape { length: 0.103, ..SHAPE }))?,
        own("nu = 0.495", Model { poisson: 0.495, ..MODEL })?,
        own(
            "a finer mesh",
            Model { division: Division { chamber: 3, web: 2, height: 2, along: 8 }, ..MODEL },
        )?,
    ];
    draw(trials, &rows, &out.join("validation"))?;
    let mut page = include_str!("before.md").to_owned();
    page += &measured(trials, &rows)?;
    page += &fitted(trials, &rows)?;
    page += &between(&rows[0])?;
    page += "\n![The tip over the pressure](validation/arm.svg)\n\n";
    page += "![The half of the arm](validation/arm-bent.svg)\n\n";
    page += include_str!("after.md");
    Ok(chapter::write(&out.join("validation.md"), &page)?)
}

/// A part, as per cent more or less.
fn part(model: f64, seen: f64) -> String {
    format!("{:+.0} %", 100.0 * (model / seen - 1.0))
}

fn measured(trials: &[Trial], rows: &[Row]) -> Outcome<String> {
    let mut table = String::from(
        "\n| at 1 s | 100 mbar | 200 mbar | 300 mbar | 400 mbar |\n| --- | --- | --- | --- | --- |\n",
    );
    for series in ['a', 'b', 'c'] {
        let cells = PRESSURES.map(|pressure| {
            trial(trials, series, pressure).map_or(String::new(), |trial| {
                format!("{:.2} mm, {:.1}°", 1e3 * trial.lateral, trial.turn.to_degrees())
            })
        });
        writeln!(table, "| measured, `{series}` | {} |", cells.join(" | "))?;
    }
    let power = power(trials)?;
    let cells = PRESSURES.map(|pressure| {
        let seen = trial(trials, 'a', pressure).map_or(f64::NAN, |trial| trial.lateral);
        format!("{:.2} mm ({})", 1e3 * power(pressure), part(power(pressure), seen))
    });
    writeln!(table, "| power law through 100 and 200 mbar | {} |", cells.join(" | "))?;
    for row in rows {
        let cells = PRESSURES.map(|pressure| {
            let (state, seen) = (row.bent.at(pressure), trial(trials, 'a', pressure));
            state.zip(seen).map_or("no equilibrium".into(), |(State { tip, .. }, seen)| {
                format!(
                    "{:.2} mm ({}), {:.1}° ({})",
                    1e3 * tip.lateral,
                    part(tip.lateral, seen.lateral),
                    tip.turn.to_degrees(),
                    part(tip.turn, seen.turn)
                )
            })
        });
        writeln!(table, "| {} | {} |", row.name, cells.join(" | "))?;
    }
    Ok(table)
}

/// The power law of the lateral way through the two pressures that models are fitted to.
fn power(trials: &[Trial]) -> Outcome<impl Fn(f64) -> f64> {
    let seen = FITTED.map(|pressure| trial(trials, 'a', pressure));
    let [Some(low), Some(high)] = seen else { return Err("trials are missing".into()) };
    let (from, exponent) = (low.lateral, (high.lateral / low.lateral).log2());
    Ok(move |pressure: f64| from * (pressure / FITTED[0]).powf(exponent))
}

fn fitted(trials: &[Trial], rows: &[Row]) -> Outcome<String> {
    let mut table = String::from(
        "\n| model | E (kPa) | walls between chambers (mm) | residual | runs | Hz unloaded, at 200 and 400 mbar | damping unloaded | unknowns |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let span = |of: usize, pressures: &[f64], digits: usize| {
        let seen = trials.iter().filter(|trial| pressures.contains(&trial.pressure));
        let seen: Vec<f64> = seen.map(|trial| trial.ringing[of]).collect();
        let least = seen.iter().copied().fold(f64::INFINITY, f64::min);
        let most = seen.iter().copied().fold(0.0, f64::max);
        format!("{least:.digits$} to {most:.digits$}")
    };
    let [low, high] = FITTED.map(|pressure| span(0, &[pressure], 2));
    let (top, damping) = (span(0, &[PREDICTED[1]], 2), span(1, &PRESSURES, 3));
    writeln!(
        table,
        "| measured | | | | | {low} at 100 mbar, {high} at 200, {top} at 400 | {damping} | |"
    )?;
    for Row { name, model, matter, fitted, bent, ringing, inflated, .. } in rows {
        let told = |k: usize, scale: f64, digits: usize| {
            let found = &fitted.unknowns[k];
            let [value, half] = [found.value, found.confidence].map(|x| scale * x);
            let end = if found.is_at_end() { " (end of its range)" } else { "" };
            format!("{value:.digits$} +- {half:.digits$}{end}")
        };
        let hertz = |frequency: Option<f64>| {
            frequency.map_or("none".into(), |frequency| format!("{frequency:.2}"))
        };
        writeln!(
            table,
            "| {name} | {} | {} | {:.1} % | {} | {:.2}, {}, {} | {:.3} | {} |",
            told(0, 1e-3, 0),
            told(1, 1e3, 1),
            100.0 * fitted.rms[1],
            fitted.runs,
            ringing.frequency,
            hertz(*inflated),
            hertz(bent.frequency()),
            ringing.damping,
            model.size(matter)?.0,
        )?;
    }
    Ok(table)
}

/// Predictions of the first model at all pressures.
fn between(row: &Row) -> Outcome<String> {
    let mut table = String::from(
        "\n| the first model at (mbar) | lateral (mm) | axial (mm) | turn | chamber higher | duct wider |\n\
         | --- | --- | --- | --- | --- | --- |\n",
    );
    for State { pressure, tip, higher, wider } in &row.bent.states {
        let [lateral, axial] = [tip.lateral, tip.axial].map(|metres| 1e3 * metres);
        let [higher, wider] = [higher, wider].map(|part| 100.0 * part);
        let turn = tip.turn.to_degrees();
        writeln!(
            table,
            "| {pressure:.0} | {lateral:.2} | {axial:.2} | {turn:.1}° | {higher:.1} % | {wider:.1} % |"
        )?;
    }
    Ok(table)
}

fn draw(trials: &[Trial], rows: &[Row], pictures: &Path) -> Outcome<()> {
    let mm = |metres: f64| 1e3 * metres;
    let mut chart =
        Chart::new("One chamber inflated: the models are fitted to 100 and 200 mbar of series a")
            .axes("pressure (mbar)", "the tip has come aside (mm)");
    for series in ['a', 'b', 'c'] {
        let own = trials.iter().filter(|trial| trial.series == series);
        let points: Vec<_> = own.map(|trial| (trial.pressure, mm(trial.lateral))).collect();
        chart = chart.marked(format!("measured, {series}"), points);
    }
    for row in [&rows[0], &rows[2]] {
        let points = row.bent.states.iter().map(|state| (state.pressure, mm(state.tip.lateral)));
        let name = row.name.trim_matches('*');
        chart = chart.series(name, [(0.0, 0.0)].into_iter().chain(points));
    }
    let power = power(trials)?;
    let points = (0..=40).map(|k| 10.0 * f64::from(k)).map(|p| (p, mm(power(p))));
    chart.reference("power law", points).write(pictures.join("arm.svg"))?;
    let trajectory = match &rows[0].bent.found {
        Ok(found) => found.trajectory(),
        Err(none) => &none.trajectory,
    };
    let end = trajectory.last().time;
    Snapshots::at([0.0, 0.5 * end, end])
        .columns(3)
        .write(trajectory, pictures.join("arm-bent.svg"))?;
    Ok(())
}
