//! Measured data: the motion of the markers of the tip.

use std::fs;
use std::path::Path;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use pliant::fit::{Unknown, least_squares};

use super::Outcome;

type Place = Vector3<f64>;

/// Unit vectors in the axes of a capture: along the arm from base to tip, and the way in which the tip bends.
const AXES: [(char, [f64; 3], [f64; 3]); 3] = [
    ('a', [0.999, 0.029, 0.016], [0.027, -0.997, 0.07]),
    ('b', [0.979, 0.008, 0.203], [-0.204, 0.066, 0.977]),
    ('c', [0.997, -0.070, 0.011], [-0.071, -0.996, 0.057]),
];

/// Series, pressure (mbar) and the time (s) at which the air is let in.
const TRIALS: [(char, u32, f64); 11] = [
    ('a', 100, 0.60),
    ('a', 200, 0.80),
    ('a', 300, 1.56),
    ('a', 400, 0.52),
    ('b', 100, 0.10),
    ('b', 200, 0.07),
    ('b', 300, 0.08),
    ('b', 400, 0.08),
    ('c', 200, 1.27),
    ('c', 300, 2.85),
    ('c', 400, 1.76),
];

/// When (s, after the air is let in) the tip is looked at: later it creeps, earlier it swings.
const LOOKED_AT: [f64; 2] = [0.9, 1.1];
/// From when on (s) it rings rather than follows the rising pressure.
const RINGS: f64 = 0.18;
/// The last frame before which nothing moves (s, before the air is let in).
const STILL: f64 = 0.045;

/// A trial.
pub struct Trial {
    pub series: char,
    /// mbar.
    pub pressure: f64,
    /// How far (m) the middle of the tip has come in the plane of bending, and its turn (rad).
    pub lateral: f64,
    pub turn: f64,
    /// Frequency (Hz) and damping ratio.
    pub ringing: [f64; 2],
}

/// Reads all trials of a directory.
pub fn read_all(directory: &Path) -> Outcome<Vec<Trial>> {
    TRIALS.iter().map(|trial| read(directory, trial)).collect()
}

fn read(directory: &Path, &(series, pressure, onset): &(char, u32, f64)) -> Outcome<Trial> {
    let text = fs::read_to_string(directory.join(format!("{series}-{pressure}.csv")))?;
    let numbers = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>();
    let rows = text.lines().skip(1).map(numbers).collect::<Result<Vec<_>, _>>()?;
    let markers = |row: &[f64]| -> Vec<Place> {
        row[1..].chunks_exact(3).map(|at| 1e-5 * Vector3::from_column_slice(at)).collect()
    };
    let mean = |from: f64, until: f64| -> Vec<Place> {
        let frames = rows.iter().filter(|row| (from..=until).contains(&row[0]));
        let frames: Vec<Vec<Place>> = frames.map(|row| markers(row)).collect();
        let sum = |marker: usize| frames.iter().map(|frame| frame[marker]).sum::<Place>();
        (0..frames[0].len()).map(|marker| sum(marker) / frames.len() as f64).collect()
    };
    let (_, along, across) = AXES.iter().find(|axes| axes.0 == series).ok_or("no such series")?;
    let (along, across) = (Place::from(*along), Place::from(*across));
    let across = (across - along * across.dot(&along) / along.norm_squared()).normalize();
    let rest = mean(f64::MIN, onset - STILL);
    let later = mean(onset + LOOKED_AT[0], onset + LOOKED_AT[1]);
    let lateral = |now: &[Place]| (middle(now) - middle(&rest)).dot(&across);
    let ringing = rows.iter().filter(|row| row[0] > onset + RINGS);
    let ringing = ringing.map(|row| (row[0] - onset - RINGS, lateral(&markers(row))));
    Ok(Trial {
        series,
        pressure: f64::from(pressure),
        lateral: lateral(&later),
        turn: rotation(&rest, &later).angle(),
        ringing: swing(&ringing.collect::<Vec<_>>())?,
    })
}

/// The middle of the tip by its markers: three of `a` and `b`, of which the third is farther from the axis than the middle of the others,
/// or the four of `c`.
fn middle(markers: &[Place]) -> Place {
    match markers {
        [a, b, c] => {
            let between = 0.5 * (a + b);
            between - (c - between) * (9.645 / 18.555)
        }
        _ => markers.iter().sum::<Place>() / markers.len() as f64,
    }
}

/// The rotation that brings `from` nearest to `to`.
fn rotation(from: &[Place], to: &[Place]) -> nalgebra::Rotation3<f64> {
    let mean = |places: &[Place]| places.iter().sum::<Place>() / places.len() as f64;
    let (of_from, of_to) = (mean(from), mean(to));
    let pairs = from.iter().zip(to);
    let products: Matrix3<f64> =
        pairs.map(|(from, to)| (to - of_to) * (from - of_from).transpose()).sum();
    let svd = products.svd(true, true);
    let (u, v_t) = (svd.u.unwrap_or_default(), svd.v_t.unwrap_or_default());
    let handed = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v_t).determinant().signum()));
    nalgebra::Rotation3::from_matrix_unchecked(u * handed * v_t)
}

/// Frequency (Hz) and damping ratio of what is left of a motion without a constant and a slow exponential.
fn swing(motion: &[(f64, f64)]) -> Outcome<[f64; 2]> {
    let residuals = |at: &[f64]| {
        let (omega, ratio, slow) = (std::f64::consts::TAU * at[0], at[1], at[2]);
        let damped = omega * (1.0 - ratio * ratio).sqrt();
        let rows = motion.iter().flat_map(|(time, _)| {
            let swing = (-ratio * omega * time).exp();
            let (sine, cosine) = (damped * time).sin_cos();
            [1.0, (-slow * time).exp(), swing * cosine, swing * sine]
        });
        let matrix = DMatrix::from_row_iterator(motion.len(), 4, rows);
        let seen = DVector::from_iterator(motion.len(), motion.iter().map(|(_, x)| *x));
        let best = matrix.clone().svd(true, true).solve(&seen, 1e-12).unwrap_or(DVector::zeros(4));
        Ok(vec![(matrix * best - seen).iter().copied().collect()])
    };
    let unknowns = [
        Unknown::new("frequency", 6.5, 10.0),
        Unknown::new("damping", 0.02, 0.2),
        Unknown::new("rate", 0.3, 10.0),
    ];
    let fitted = least_squares(&unknowns, 1e-10, &residuals, &mut |_, _| {})?;
    Ok([fitted.unknowns[0].value, fitted.unknowns[1].value])
}
