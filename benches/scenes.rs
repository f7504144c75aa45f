//! Whole scenes, method by method and mesh by mesh. Compare rows within one run only.

use divan::Bencher;
use pliant::samples::{beam_jump, square_jump};
use pliant::{Method, Sampling, Settings};

fn main() {
    divan::main();
}

/// Figs 4.5 and 4.6 on each method, at rtol 1e-6: 4 x 4 and 10 x 10 nodes.
#[divan::bench(args = Method::ALL, consts = [4, 10], sample_count = 10)]
fn square_jump_by_method<const NODES: usize>(bencher: Bencher, method: &Method) {
    let scene = square_jump(NODES).unwrap();
    let settings = Settings { method: *method, rtol: 1e-6, ..Settings::default() };
    bencher.bench(|| scene.simulate(&settings, &Sampling::phase_ends()).unwrap().report().steps());
}

/// The same by CVODE's BDF, mesh by mesh: `nodes` x `nodes`.
#[divan::bench(args = [4, 7, 10, 19, 37], sample_count = 3)]
fn square_jump_by_mesh(bencher: Bencher, nodes: usize) {
    let scene = square_jump(nodes).unwrap();
    let settings = Settings { rtol: 1e-4, ..Settings::default() };
    bencher.bench(|| scene.simulate(&settings, &Sampling::phase_ends()).unwrap().report().steps());
}

/// Fig. 4.1 by CVODE's BDF, tolerance by tolerance.
#[divan::bench(args = [1e-4, 1e-6, 1e-8], sample_count = 30)]
fn beam_jump_by_rtol(bencher: Bencher, rtol: f64) {
    let scene = beam_jump().unwrap();
    let settings = Settings { rtol, ..Settings::default() };
    bencher.bench(|| scene.simulate(&settings, &Sampling::phase_ends()).unwrap().report().steps());
}
