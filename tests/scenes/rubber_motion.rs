//! Benchmarks of rubber in large motion: published numbers, what is conserved, and what cells and methods agree on.

use pliant::samples::{LoadedCantilever, TumblingBlock, TwistingColumn};
use pliant::{Dilatation, Method, Sampling, Settings, SolidCells, Trajectory};

/// The number (from 0) of the node at this place (m).
fn node_at(motion: &Trajectory, place: [f64; 3]) -> usize {
    let mut nodes = motion.body().mesh().positions().chunks(3);
    let is_there = |x: &[f64]| x.iter().zip(place).all(|(x, at)| (x - at).abs() < 1e-9);
    nodes.position(is_there).unwrap()
}

fn length(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Its end comes to 2.80 m at 0.318 s and is back at 0.646 s, as published. Hexahedra of this mesh are 0.7 % short of that, and
/// 1.8 % early.
#[test]
fn a_loaded_cantilever_swings_as_published() {
    let (cells, dilatation) = (SolidCells::Hexahedra, Dilatation::Mean);
    let cantilever = LoadedCantilever { nodes: [3, 3, 21], cells, dilatation, until: 0.7 };
    let settings = Settings { rtol: 1e-4, ..Settings::default() };
    let motion = cantilever.scene().unwrap().simulate(&settings, &Sampling::every(1e-3)).unwrap();
    let node = node_at(&motion, [0.1, 0.1, 2.0]);
    let moved = motion.samples().iter().map(|s| (s.time, length(&s.u[3 * node..3 * node + 3])));
    let moved: Vec<(f64, f64)> = moved.collect();
    let (at, peak) = *moved.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let late = moved.iter().filter(|(time, _)| *time > 0.5);
    let (back, _) = *late.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    println!("{peak} m at {at} s, back at {back} s");
    assert!((peak / 2.80 - 1.0).abs() < 0.01, "{peak} m");
    let [early, earlier] = [1e3 * at / 318.0, 1e3 * back / 646.0].map(|part| (part - 1.0).abs());
    assert!(early < 0.025 && earlier < 0.025, "{at} {back}");
    assert!(motion.report().energy_error < 1e-4 * motion.report().energy_scale);
}

/// The angle (rad) by which an edge of the free end of a column has turned, at each sample.
fn turns(motion: &Trajectory) -> Vec<f64> {
    let edge = 3 * node_at(motion, [6.0, 0.5, 0.5]);
    let angle = |u: &[f64]| (0.5 + u[edge + 2]).atan2(0.5 + u[edge + 1]);
    let mut turn = angle(&motion.samples()[0].u);
    let start = turn;
    let follow = |sample: &pliant::Sample| {
        let apart = (angle(&sample.u) - turn) / std::f64::consts::TAU;
        turn += std::f64::consts::TAU * (apart - apart.round());
        turn - start
    };
    motion.samples().iter().map(follow).collect()
}

/// By two methods, and by kinds of cells that are all too coarse: nothing breaks down, and energy is kept.
#[test]
fn a_column_twists_and_comes_back() {
    for (poisson, until) in [(0.45, 0.05), (0.495, 0.2)] {
        let run = |cells, nodes, until, method, rtol| {
            let dilatation = Dilatation::Mean;
            let column = TwistingColumn { poisson, nodes, cells, dilatation, until };
            let settings = Settings { method, rtol, ..Settings::default() };
            let scene = column.scene().unwrap();
            let motion = scene.simulate(&settings, &Sampling::every(1e-3)).unwrap();
            for sample in motion.samples() {
                let ratios = motion.body().volume_ratios(&sample.u);
                let within = ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.3);
                assert!(within, "{cells:?} at {} s", sample.time);
            }
            let report = motion.report();
            let lost = report.energy_error / report.energy_scale;
            assert!(lost < 2e-4, "{cells:?} {method}: {lost:e}");
            turns(&motion)
        };
        let nodes = [9, 3, 3];
        let by_auto = run(SolidCells::Hexahedra20, nodes, until, Method::Auto, 1e-4);
        let by_bdf = run(SolidCells::Hexahedra20, nodes, 0.05, Method::CvodeBdf, 1e-5);
        let apart = by_auto.iter().zip(&by_bdf).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // the softer column with cells that cost less
        let (cells, nodes) = match poisson > 0.49 {
            true => (SolidCells::Tetrahedra10, nodes),
            false => (SolidCells::Hexahedra, [19, 3, 3]),
        };
        let other = run(cells, nodes, 0.05, Method::Auto, 1e-4);
        println!("{poisson}: methods {apart:e} rad, at 0.05 s {} {}", by_auto[50], other[50]);
        assert!(apart < 1e-3, "{apart:e}");
        assert!(by_auto.get(200).is_none_or(|turns| *turns < -0.5), "{:?}", by_auto.get(200));
        // 4.39 and 4.43 rad
        for turns in [&other, &by_auto] {
            assert!((turns[50] / 4.40 - 1.0).abs() < 0.03, "{}", turns[50]);
        }
    }
}

/// Momentum is never there, and angular momentum and energy stay what they are once the loads are gone.
#[test]
fn a_block_tumbles_and_keeps_its_momenta() {
    let settings = Settings { rtol: 1e-4, ..Settings::default() };
    let scene = TumblingBlock { until: 6.0, ..TumblingBlock::default() }.scene().unwrap();
    let motion = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
    let after: Vec<_> = motion.samples().iter().filter(|sample| sample.time >= 5.0).collect();
    let spin = motion.angular_momentum(after[0]);
    let energy = |sample: &pliant::Sample| sample.energy.kinetic + sample.energy.strain;
    let start = energy(after[0]);
    for sample in after {
        let momentum = length(&motion.momentum(sample));
        let now = motion.angular_momentum(sample);
        let drift = length(&[0, 1, 2].map(|i| now[i] - spin[i])) / length(&spin);
        let gained = energy(sample) / start - 1.0;
        // 11,700 kg at speeds of some m/s
        assert!(momentum < 1e-8, "{momentum} N s");
        assert!(drift < 5e-7 && gained.abs() < 3e-6, "{drift:e} {gained:e}");
    }
    let trusted = [35530.0, 20335.0, -25400.0];
    let off = length(&[0, 1, 2].map(|i| spin[i] - trusted[i])) / length(&trusted);
    assert!(off < 2e-3 && (start / 14115.0 - 1.0).abs() < 3e-3, "{spin:?} {start}");
}
