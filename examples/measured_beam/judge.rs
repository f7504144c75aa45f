//! Fits, and how near a model comes to the trials.

use std::f64::consts::PI;

use pliant::Error;
use pliant::fit::{Fitted, Unknown, least_squares};

use super::Outcome;
use super::beam::{Hung, Matter, Model, RTOL, Release};
use super::capture::{Place, Trial, height};

/// How long (s) after the release fits look.
const FITTED: f64 = 0.8;
/// From how long (s) before the release on.
const BEFORE: f64 = 0.1;
/// Until when (s) after the release swings are counted, and from which size on (m).
const SWINGS: f64 = 1.3;
const LEAST_SWING: f64 = 4e-4;
/// Frames that make up the rest at the end.
const LATE: usize = 60;

/// What damps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    Viscosity,
    Drag,
    Both,
}

/// How near a model comes to a trial.
#[derive(Clone, Copy)]
pub struct Nearness {
    /// Root mean square distance of the markers (m): in the first second, and in all of the trial.
    pub distance: [f64; 2],
    pub swing: Swing,
    /// How far the markers have sunk at last (m).
    pub sag: f64,
}

/// How far markers have sunk in the end (m).
pub fn sag(moved: &[[Place; 3]]) -> f64 {
    -moved[moved.len() - LATE..].iter().map(height).sum::<f64>() / LATE as f64
}

/// Frequency (Hz) and damping ratio.
#[derive(Clone, Copy)]
pub struct Swing {
    pub frequency: f64,
    pub damping: f64,
}

/// The frames of a trial from shortly before the fall until so long (s) after it.
fn frames(trial: &Trial, until: f64) -> std::ops::Range<usize> {
    let at = |time: f64| trial.times.partition_point(|frame| *frame < time);
    at(trial.falls - BEFORE)..at(trial.falls + until)
}

/// How far each marker of the model is from where it was measured, frame by frame.
fn misses(
    model: &Model,
    matter: &Matter,
    hung: Hung,
    release: &Release,
    trial: &Trial,
    until: f64,
) -> Outcome<Vec<Place>> {
    let frames = frames(trial, until);
    let moved = model.moved(matter, hung, release, &trial.times[frames.clone()])?;
    let pairs = moved.iter().flatten().zip(trial.moved[frames].iter().flatten());
    Ok(pairs.map(|(model, measured)| model - measured).collect())
}

/// The same as residuals.
fn residuals(misses: Outcome<Vec<Place>>) -> Result<Vec<f64>, Error> {
    let misses = misses.map_err(|error| match error.downcast::<Error>() {
        Ok(error) => *error,
        Err(other) => panic!("{other}"),
    })?;
    Ok(misses.iter().flat_map(|miss| [miss.x, miss.y, miss.z]).collect())
}

/// The release of a trial as two unknowns: its time, within two frames, and the height from which.
fn release(trial: &Trial) -> [Unknown; 2] {
    let time = Unknown::new("time", trial.falls - 0.02, trial.falls + 0.01);
    [time, Unknown::new("lift", -0.003, 0.003)]
}

/// Fits the material to the trials under its own weight.
pub fn own_weight(
    model: &Model,
    damping: Damping,
    trials: &[Trial; 2],
) -> Outcome<(Matter, [Release; 2])> {
    let mut unknowns: Vec<Unknown> = trials.iter().flat_map(release).collect();
    unknowns.extend(material(damping));
    let own = |at: &[f64]| {
        let [time, lift, time_b, lift_b, young, ..] = *at else { panic!("five unknowns and more") };
        let (viscosity, drag) = match damping {
            Damping::Viscosity => (at[5], 0.0),
            Damping::Drag => (0.0, at[5]),
            Damping::Both => (at[5], at[6]),
        };
        let releases = [Release { time, lift }, Release { time: time_b, lift: lift_b }];
        (Matter { young, viscosity, drag }, releases)
    };
    let fitted = least_squares(
        &unknowns,
        RTOL,
        &|at| {
            let (matter, releases) = own(at);
            let mut all = Vec::new();
            for (release, trial) in releases.iter().zip(trials) {
                let misses = misses(model, &matter, Hung::Nothing, release, trial, FITTED);
                all.extend(residuals(misses)?);
            }
            Ok(all)
        },
        &mut |_, _| {},
    )?;
    Ok(own(&values(&fitted)))
}

/// Fits the material to all trials, those of the loaded beam with a mass that moves with its edge.
pub fn all_trials(
    model: &Model,
    own: &[Trial; 2],
    loaded: &[Trial; 2],
) -> Outcome<(Matter, [Release; 2])> {
    let trials = || {
        own.iter()
            .map(|trial| (Hung::Nothing, trial))
            .chain(loaded.iter().map(|trial| (Hung::Mass, trial)))
    };
    let mut unknowns = material(Damping::Both);
    unknowns.extend(trials().flat_map(|(_, trial)| release(trial)));
    let matter = |at: &[f64]| Matter { young: at[0], viscosity: at[1], drag: at[2] };
    let fitted = least_squares(
        &unknowns,
        RTOL,
        &|at| {
            let releases = at[3..].chunks_exact(2).map(|at| Release { time: at[0], lift: at[1] });
            let mut all = Vec::new();
            for ((hung, trial), release) in trials().zip(releases) {
                all.extend(residuals(misses(model, &matter(at), hung, &release, trial, FITTED))?);
            }
            Ok(all)
        },
        &mut |_, _| {},
    )?;
    let found = values(&fitted);
    let own = [3, 5].map(|at| Release { time: found[at], lift: found[at + 1] });
    Ok((matter(&found), own))
}

/// The unknowns of the material.
fn material(damping: Damping) -> Vec<Unknown> {
    let mut unknowns = vec![Unknown::new("young", 1.5e5, 4e5)];
    if damping != Damping::Drag {
        unknowns.push(Unknown::new("viscosity", 20.0, 2000.0));
    }
    if damping != Damping::Viscosity {
        unknowns.push(Unknown::new("drag", 0.0, 8.0));
    }
    unknowns
}

/// How a trial under a load was let go; all else is known.
pub fn let_go(model: &Model, matter: &Matter, hung: Hung, trial: &Trial) -> Outcome<Release> {
    let fitted = least_squares(
        &release(trial),
        RTOL,
        &|at| {
            let release = Release { time: at[0], lift: at[1] };
            residuals(misses(model, matter, hung, &release, trial, FITTED))
        },
        &mut |_, _| {},
    )?;
    Ok(Release { time: fitted.unknowns[0].value, lift: fitted.unknowns[1].value })
}

/// The thread that the mass of a trial hangs on.
pub fn thread(model: &Model, matter: &Matter, trial: &Trial) -> Outcome<Hung> {
    let mut unknowns = release(trial).to_vec();
    unknowns.push(Unknown::new("stiffness", 20.0, 2000.0));
    unknowns.push(Unknown::new("damping", 1.0, 30.0));
    let fitted = least_squares(
        &unknowns,
        RTOL,
        &|at| {
            let release = Release { time: at[0], lift: at[1] };
            let hung = Hung::Thread(at[2], at[3]);
            residuals(misses(model, matter, hung, &release, trial, FITTED))
        },
        &mut |_, _| {},
    )?;
    let values = values(&fitted);
    Ok(Hung::Thread(values[2], values[3]))
}

fn values(fitted: &Fitted) -> Vec<f64> {
    fitted.unknowns.iter().map(|found| found.value).collect()
}

/// How near the model comes to a trial.
pub fn nearness(
    model: &Model,
    matter: &Matter,
    hung: Hung,
    release: &Release,
    trial: &Trial,
) -> Outcome<Nearness> {
    let distance = |until: f64| -> Outcome<f64> {
        let misses = misses(model, matter, hung, release, trial, until)?;
        let squares = misses.iter().map(|miss| miss.norm_squared()).sum::<f64>();
        Ok((squares / misses.len() as f64).sqrt())
    };
    let distance = [distance(1.0)?, distance(f64::INFINITY)?];
    let moved = model.moved(matter, hung, release, &trial.times)?;
    let swing = Swing::of(&trial.times, &moved, trial.falls);
    Ok(Nearness { distance, swing, sag: sag(&moved) })
}

impl Swing {
    /// Of markers which move so at `times` (s), from the turn after `start` (s) on.
    pub fn of(times: &[f64], moved: &[[Place; 3]], start: f64) -> Self {
        let heights: Vec<f64> = moved.iter().map(height).collect();
        let level = -sag(moved);
        let mut turns: Vec<(f64, f64)> = Vec::new();
        for k in 1..heights.len() - 1 {
            let [a, b, c] = [heights[k - 1], heights[k], heights[k + 1]];
            let is_turn = (b - a) * (c - b) <= 0.0 && a != b;
            if is_turn && times[k] > start && times[k] < start + SWINGS {
                // the top of the parabola through three frames
                let part = 0.5 * (a - c) / (a - 2.0 * b + c);
                let time = times[k] + part * (times[k + 1] - times[k]);
                turns.push((time, (b - 0.25 * (a - c) * part - level).abs()));
            }
        }
        // the first one is still that of the release
        let turns: Vec<_> =
            turns.into_iter().skip(1).take_while(|turn| turn.1 > LEAST_SWING).collect();
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| {
            turns.iter().map(of).sum::<f64>() / turns.len() as f64
        };
        let (middle, size) = (mean(&|turn| turn.0), mean(&|turn| turn.1.ln()));
        let slope = mean(&|turn| (turn.0 - middle) * (turn.1.ln() - size))
            / mean(&|turn| (turn.0 - middle).powi(2));
        let lasting = turns.last().map_or(0.0, |last| last.0 - turns[0].0);
        let frequency = (turns.len() as f64 - 1.0) / (2.0 * lasting);
        let decay = -slope / (2.0 * PI * frequency);
        Self { frequency, damping: decay / decay.hypot(1.0) }
    }
}
