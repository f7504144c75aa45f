//! Fitting a model to two pressures of one series, and what comes of it at higher ones.

use pliant::Error;
use pliant::fit::{Fitted, Unknown, least_squares};

use super::Outcome;
use super::arm::{Bent, Matter, Model, Ringing};
use super::capture::Trial;

/// The pressures (mbar) that models are fitted to, and those they predict.
pub const FITTED: [f64; 2] = [100.0, 200.0];
pub const PREDICTED: [f64; 2] = [300.0, 400.0];
/// In which E (Pa) and the thickness (m) of the walls between the chambers are sought.
const RANGES: [[f64; 2]; 2] = [[1.5e5, 5e5], [3e-3, 9.5e-3]];
/// The series that they are fitted to.
const SERIES: char = 'a';

/// A model that was fitted.
pub struct Row {
    pub name: &'static str,
    pub model: Model,
    pub matter: Matter,
    pub fitted: Fitted,
    pub bent: Bent,
    pub ringing: Ringing,
    /// The frequency (Hz) at 200 mbar.
    pub inflated: Option<f64>,
}

/// A trial of a series.
pub fn trial(trials: &[Trial], series: char, pressure: f64) -> Option<&Trial> {
    trials.iter().find(|trial| trial.series == series && trial.pressure == pressure)
}

/// Fits the rubber and the walls between the chambers to how far and by how much the tip has come and turned.
pub fn fit(name: &'static str, model: Model, trials: &[Trial]) -> Outcome<Row> {
    let seen = FITTED.map(|pressure| trial(trials, SERIES, pressure));
    let [Some(low), Some(high)] = seen else { return Err("trials are missing".into()) };
    let matter = |at: &[f64]| Matter { young: at[0], web: at[1] };
    let residuals = |at: &[f64]| -> Result<Vec<Vec<f64>>, Error> {
        let bent = model.bent(&matter(at), high.pressure, 2)?;
        let states = [bent.at(low.pressure).copied(), bent.at(high.pressure).copied()];
        bent.found?;
        let off = states.into_iter().flatten().zip([low, high]).flat_map(|(state, trial)| {
            [state.tip.lateral / trial.lateral - 1.0, state.tip.turn / trial.turn - 1.0]
        });
        Ok(off.map(|off| vec![off]).collect())
    };
    let [young, web] = RANGES;
    let unknowns = [Unknown::new("E", young[0], young[1]), Unknown::new("web", web[0], web[1])];
    let fitted = least_squares(&unknowns, 1e-4, &residuals, &mut |runs, rms| {
        eprintln!("  {name}: run {runs}, {rms:.4}");
    })?;
    let matter = matter(&[fitted.unknowns[0].value, fitted.unknowns[1].value]);
    let bent = model.bent(&matter, PREDICTED[1], 8)?;
    let ringing = model.ringing(&matter)?;
    let inflated = model.bent(&matter, FITTED[1], 2)?.frequency();
    let row = Row { name, model, matter, fitted, bent, ringing, inflated };
    row.tell();
    Ok(row)
}

impl Row {
    fn tell(&self) {
        let Self { name, matter, fitted, bent, ringing, inflated, .. } = self;
        eprintln!(
            "{name}: E {:.1} kPa, web {:.2} mm, {:.4} left over, {} runs, {} failed; {:.2} Hz, {inflated:?} inflated, damping {:.4}",
            1e-3 * matter.young,
            1e3 * matter.web,
            fitted.rms[1],
            fitted.runs,
            fitted.failed,
            ringing.frequency,
            ringing.damping,
        );
        for state in &bent.states {
            eprintln!(
                "  {:.0} mbar: {:.2} {:.2} mm, {:.2} degrees, chamber {:.1} % higher, duct {:.1} % wider",
                state.pressure,
                1e3 * state.tip.lateral,
                1e3 * state.tip.axial,
                state.tip.turn.to_degrees(),
                100.0 * state.higher,
                100.0 * state.wider,
            );
        }
        if let Err(none) = &bent.found {
            eprintln!("  {none}");
        }
    }
}
