//! Shared by the tests of whole scenes.

use pliant::{Method, Sampling, Scene, Settings, Trajectory};

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

/// The methods on forms of the equations that know alpha.
pub fn methods_with_alpha() -> impl Iterator<Item = Method> {
    Method::ALL.into_iter().filter(|&method| method != Method::IdaIndexTwo)
}

/// Runs `scene` and samples it at `times`.
pub fn run(scene: &Scene, settings: &Settings, times: &[f64]) -> Trajectory {
    scene.simulate(settings, &Sampling::at(times)).unwrap()
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

/// What a motion's error may be after many steps, each with an error of `rtol`: two to three times the
/// worst that was measured over the jumping beam, the pressed and the jumping square. In units of rtol that
/// was 250 (`rk`) and 200 (Adams), where steps meet contact at rtol 1e-9, 78 (BDF), 71 (`auto`), 31
/// (ARKODE) and 28 (IDA). With order 2 steps shrink as rtol^(1/3) and their number makes it rtol^(2/3), 4.4
/// times that.
pub fn global_error(method: Method, rtol: f64) -> f64 {
    match method {
        Method::CentralDifference => 10.0 * rtol.powf(2.0 / 3.0),
        Method::Rk | Method::CvodeAdams => 500.0 * rtol,
        Method::CvodeBdf | Method::Auto => 200.0 * rtol,
        _ => 80.0 * rtol,
    }
}

/// A tolerance and its hundredth between which errors fall. At 1e-5 it is stability that bounds the steps
/// of central differences, and their errors are smaller than asked for.
pub fn tolerances(method: Method) -> [f64; 2] {
    match method {
        Method::CentralDifference => [1e-6, 1e-8],
        _ => [1e-5, 1e-7],
    }
}
