//! Measured data: the motion of markers, in the axes of the beam.

use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, Vector3};

use super::Outcome;

/// A place, or how far something has come (m).
pub type Place = Vector3<f64>;

/// Where the markers were meant to be on the straight beam (m): x along it, 0 at the free end, y across, z up, both 0 to 0.03
/// on the beam. The first three move with the free end, the others sit on the clamp.
pub const MARKERS: [[f64; 3]; 6] = [
    [0.0, 0.015, 0.036],
    [0.0, -0.006, 0.024],
    [0.0, 0.036, 0.006],
    [-0.094, -0.010, -0.001],
    [-0.094, 0.040, 0.0275],
    [-0.094, 0.040, 0.000],
];

/// Until when (s) the beam rests on a hand or a thread in all trials.
const RESTING: f64 = 0.4;
/// A frame in which the markers of the free end have come that far (m) in the mean is the first of the fall.
const FALLEN: f64 = 4e-4;

/// A trial.
pub struct Trial {
    /// Times of the frames (s).
    pub times: Vec<f64>,
    /// How far each marker of the free end has come since the rest, frame by frame.
    pub moved: Vec<[Place; 3]>,
    /// The time of the first frame in which it falls (s).
    pub falls: f64,
}

impl Trial {
    /// Reads a table of times (s) and places (micrometres) of the six markers.
    pub fn read(path: &Path) -> Outcome<Self> {
        let text = fs::read_to_string(path)?;
        let numbers = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>();
        let rows = text.lines().skip(1).map(numbers).collect::<Result<Vec<_>, _>>()?;
        let place = |row: &[f64], marker: usize| {
            1e-6 * Vector3::from_column_slice(&row[1 + 3 * marker..4 + 3 * marker])
        };
        let resting = rows.iter().take_while(|row| row[0] < RESTING);
        let rest: [Place; 6] = std::array::from_fn(|marker| {
            let sum = resting.clone().map(|row| place(row, marker)).sum::<Place>();
            sum / resting.clone().count() as f64
        });
        let axes = axes(&rest);
        let moved: Vec<[Place; 3]> = rows
            .iter()
            .map(|row| std::array::from_fn(|marker| axes * (place(row, marker) - rest[marker])))
            .collect();
        let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let falls = times.iter().zip(&moved).find(|(_, moved)| height(moved) < -FALLEN);
        let falls = *falls.ok_or("nothing falls")?.0;
        Ok(Self { times, moved, falls })
    }
}

/// How far three markers have come up in the mean (m).
pub fn height(moved: &[Place; 3]) -> f64 {
    moved.iter().map(|place| place.z).sum::<f64>() / 3.0
}

/// The rotation to the axes of the beam: that which brings all markers, as they are at rest, nearest to where they were meant
/// to be.
fn axes(rest: &[Place; 6]) -> Matrix3<f64> {
    let meant = MARKERS.map(Vector3::from);
    let middle = |places: &[Place; 6]| places.iter().sum::<Place>() / 6.0;
    let (of_rest, of_meant) = (middle(rest), middle(&meant));
    let pairs = meant.iter().zip(rest);
    let products: Matrix3<f64> =
        pairs.map(|(meant, rest)| (meant - of_meant) * (rest - of_rest).transpose()).sum();
    let svd = products.svd(true, true);
    let (u, v_t) = (svd.u.unwrap_or_default(), svd.v_t.unwrap_or_default());
    let handed = (u * v_t).determinant().signum();
    u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handed)) * v_t
}
