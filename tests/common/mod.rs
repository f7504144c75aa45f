//! What the tests of whole scenes share.
#![allow(dead_code)] // each test binary uses its part

use pliant::{Sampling, Scene, Solver, Trajectory};

/// A table of reference values with named columns.
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads `tests/data/<name>`; lines that begin with # are comments.
    pub fn read(name: &str) -> Self {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).unwrap();
        let names = reader.headers().unwrap().iter().map(String::from).collect();
        let rows = reader.deserialize().collect::<Result<_, _>>().unwrap();
        Self { names, rows }
    }

    /// The rows in which column `name` has the value `value`.
    pub fn filter(mut self, name: &str, value: f64) -> Self {
        let column = self.column(name);
        self.rows.retain(|row| row[column] == value);
        assert!(!self.rows.is_empty(), "no row with {name} = {value}");
        self
    }

    /// One column.
    pub fn get(&self, name: &str) -> Vec<f64> {
        let column = self.column(name);
        self.rows.iter().map(|row| row[column]).collect()
    }

    fn column(&self, name: &str) -> usize {
        self.names.iter().position(|other| other == name).unwrap()
    }
}

/// Runs `scene` and samples it at `times`.
pub fn run(scene: &Scene, solver: &Solver, times: &[f64]) -> Trajectory {
    scene.simulate(solver, &Sampling::at(times)).unwrap()
}

/// Largest distance between the displacements of two trajectories sampled at the same times,
/// relative to the largest displacement.
pub fn difference(a: &Trajectory, b: &Trajectory) -> f64 {
    assert_eq!(a.samples().len(), b.samples().len());
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (a, b) in a.samples().iter().zip(b.samples()) {
        assert_eq!(a.time, b.time);
        for (a, b) in a.u.iter().zip(&b.u) {
            worst = worst.max((a - b).abs());
            largest = largest.max(b.abs());
        }
    }
    worst / largest
}
