//! Fits, and how near a model comes to the trials.

use std::f64::consts::PI;

use pliant::Error;
use pliant::fit::{Fitted, Unknown, least_squares};

use super::Outcome;
use super::beam::{Hung, Matter, Model, Release};
use super::capture::{Place, Trial, height};

/// How long (s) after the release fits look, and where there are branches, which take time.
const FITTED: f64 = 0.8;
const FITTED_LONG: f64 = 4.2;
/// From how long (s) before the release on.
const BEFORE: f64 = 0.1;
/// Until when (s) after the release swings are counted, and from which size on (m).
const SWINGS: f64 = 1.3;
const LEAST_SWING: f64 = 4e-4;
/// Between which times (s) after the release it hardly swings any more.
const SETTLED: [f64; 2] = [2.0, 2.5];
/// Frames that make up the rest at the end.
const LATE: usize = 60;

/// Times (s) of two branches of which only the shares are fitted.
const TIMES: [f64; 2] = [0.3, 2.0];

/// Damping model, with its fitted parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    Viscosity,
    Both,
    /// Viscosity and a Maxwell branch.
    Branch,
    /// Viscosity and Maxwell branches of the [`TIMES`].
    Branches,
}

impl Damping {
    /// How long (s) after the release the fit looks.
    fn fitted(self) -> f64 {
        match self {
            Self::Viscosity | Self::Both => FITTED,
            Self::Branch | Self::Branches => FITTED_LONG,
        }
    }

    /// The unknowns of the material.
    fn unknowns(self) -> Vec<Unknown> {
        let mut unknowns =
            vec![Unknown::new("E", 1.5e5, 4e5), Unknown::new("viscosity", 20.0, 2000.0)];
        match self {
            Self::Viscosity => {}
            Self::Both => unknowns.push(Unknown::new("rate", 0.0, 8.0)),
            Self::Branch => {
                unknowns.push(Unknown::new("share 1", 0.01, 0.3));
                unknowns.push(Unknown::new("time", 0.1, 4.0));
            }
            Self::Branches => {
                let share = |number| Unknown::new(format!("share {number}"), 0.0, 0.3);
                unknowns.extend([share(1), share(2)]);
            }
        }
        unknowns
    }

    /// The material of their values, and of no more.
    fn matter(self, at: &[f64]) -> Matter {
        let mut matter =
            Matter { young: at[0], viscosity: at[1], drag: 0.0, branches: [[0.0; 2]; 2] };
        match self {
            Self::Viscosity => {}
            Self::Both => matter.drag = at[2],
            Self::Branch => matter.branches[0] = [at[2], at[3]],
            Self::Branches => matter.branches = [[at[2], TIMES[0]], [at[3], TIMES[1]]],
        }
        matter
    }
}

/// How near a model comes to a trial.
#[derive(Clone, Copy)]
pub struct Nearness {
    /// Root mean square distance of the markers (m): in the first second, and in all of the trial.
    pub distance: [f64; 2],
    pub swing: Swing,
    /// How far the markers have sunk at last (m).
    pub sag: f64,
    /// How much of that came late (m): [`creep`].
    pub creep: f64,
}

/// How far markers have sunk in the end (m).
pub fn sag(moved: &[[Place; 3]]) -> f64 {
    -moved[moved.len() - LATE..].iter().map(height).sum::<f64>() / LATE as f64
}

/// How far (m) markers that fall at `falls` (s) sink from the time when they hardly swing any more to the end.
pub fn creep(times: &[f64], moved: &[[Place; 3]], falls: f64) -> f64 {
    let at = |time: f64| times.partition_point(|frame| *frame < time);
    let settled = &moved[at(falls + SETTLED[0])..at(falls + SETTLED[1])];
    sag(moved) + settled.iter().map(height).sum::<f64>() / settled.len() as f64
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

/// The same as residuals: a series for each marker and axis.
fn residuals(misses: Outcome<Vec<Place>>) -> Result<Vec<Vec<f64>>, Error> {
    let misses = misses.map_err(|error| match error.downcast::<Error>() {
        Ok(error) => *error,
        Err(other) => panic!("{other}"),
    })?;
    let series = |marker: usize, axis: usize| {
        misses.iter().skip(marker).step_by(3).map(|miss| miss[axis]).collect()
    };
    Ok((0..9).map(|number| series(number / 3, number % 3)).collect())
}

/// The release of a trial as two unknowns: its time, within two frames, and the height from which.
fn release(trial: &Trial) -> [Unknown; 2] {
    let time = Unknown::new("release", trial.falls - 0.02, trial.falls + 0.01);
    [time, Unknown::new("lift", -0.003, 0.003)]
}

/// A material that was fitted: with the releases of the trials under its own weight, and what the fit tells of each number.
pub struct Found {
    pub matter: Matter,
    pub releases: [Release; 2],
    pub fitted: Fitted,
}

/// Fits the material to the trials under its own weight.
pub fn own_weight(model: &Model, damping: Damping, trials: &[Trial; 2]) -> Outcome<Found> {
    fit(model, damping, &trials.each_ref().map(|trial| (Hung::Nothing, trial)))
}

/// Fits the material to all trials, those of the loaded beam with a mass that moves with its edge.
pub fn all_trials(
    model: &Model,
    damping: Damping,
    own: &[Trial; 2],
    loaded: &[Trial; 2],
) -> Outcome<Found> {
    let own = own.iter().map(|trial| (Hung::Nothing, trial));
    let trials: Vec<_> = own.chain(loaded.iter().map(|trial| (Hung::Mass, trial))).collect();
    fit(model, damping, &trials)
}

/// Fits the material and the releases of trials, the first two of which are those under its own weight.
fn fit(model: &Model, damping: Damping, trials: &[(Hung, &Trial)]) -> Outcome<Found> {
    let mut unknowns = damping.unknowns();
    let of_matter = unknowns.len();
    unknowns.extend(trials.iter().flat_map(|(_, trial)| release(trial)));
    let releases = |at: &[f64]| -> Vec<Release> {
        let pairs = at[of_matter..].as_chunks::<2>().0;
        pairs.iter().map(|&[time, lift]| Release { time, lift }).collect()
    };
    let fitted = least_squares(
        &unknowns,
        model.rtol,
        &|at| {
            let matter = damping.matter(&at[..of_matter]);
            let mut all = Vec::new();
            for ((hung, trial), release) in trials.iter().zip(releases(at)) {
                let misses = misses(model, &matter, *hung, &release, trial, damping.fitted());
                all.extend(residuals(misses)?);
            }
            Ok(all)
        },
        &mut |_, _| {},
    )?;
    let at = values(&fitted);
    let own = releases(&at);
    Ok(Found { matter: damping.matter(&at[..of_matter]), releases: [own[0], own[1]], fitted })
}

/// How a trial under a load was let go; all else is known.
pub fn let_go(model: &Model, matter: &Matter, hung: Hung, trial: &Trial) -> Outcome<Release> {
    let fitted = least_squares(
        &release(trial),
        model.rtol,
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
        model.rtol,
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
    let creep = creep(&trial.times, &moved, trial.falls);
    Ok(Nearness { distance, swing, sag: sag(&moved), creep })
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
