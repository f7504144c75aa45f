//! Shared by the tests of whole scenes.

use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Body, Cells, Equilibrium, Mesh, Method, Sampling, Scene, Settings, Strain, Trajectory,
};

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

pub fn settings(method: Method, rtol: f64) -> Settings {
    Settings { method, rtol, ..Settings::default() }
}

/// The square of Hirai's examples in a plane without a floor, with Cauchy strain.
pub fn square() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    Scene::new(
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap(),
    )
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

/// Largest difference between two sets of displacements, relative to the largest of them.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    a.iter().zip(b).fold(0.0_f64, |apart, (a, b)| apart.max((a - b).abs())) / largest
}

/// Root mean square distance between the last positions of two runs (m).
pub fn distance(a: &Trajectory, b: &Trajectory) -> f64 {
    let squares = a.last().u.iter().zip(&b.last().u).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / a.body().mesh().node_count() as f64).sqrt()
}

/// The readings of a sensor, by its number.
pub fn column(motion: &Trajectory, number: usize) -> Vec<f64> {
    motion.samples().iter().map(|sample| sample.sensors[number]).collect()
}

/// Part of the energies that are there by which their balance is off.
pub fn imbalance(motion: &Trajectory) -> f64 {
    motion.report().energy_error / motion.report().energy_scale
}

/// Curvature (1/m) of the middle half of a strip that lay along x from the origin on, of a length and a height.
pub fn curvature(equilibrium: &Equilibrium, [length, height]: [f64; 2]) -> f64 {
    let motion = equilibrium.trajectory();
    let (mesh, u) = (motion.body().mesh(), &motion.last().u);
    let at = |x: f64, y: f64| {
        let near = |node: &usize| {
            let place = mesh.position(*node);
            (place[0] - x).hypot(place[1] - y) < 1e-9
        };
        let node = (0..mesh.node_count()).find(near).unwrap();
        [0, 1].map(|i| mesh.position(node)[i] + u[2 * node + i])
    };
    let turned = |x: f64| {
        let ([x0, y0], [x1, y1]) = (at(x, 0.0), at(x, height));
        (x0 - x1).atan2(y1 - y0)
    };
    (turned(0.75 * length) - turned(0.25 * length)) / (0.5 * length)
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
