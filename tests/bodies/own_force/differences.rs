//! Forces that do not tell their tangents, against the same forces that do.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pliant::force::{Force, NodalForces, Reservoir, Tangents};
use pliant::ode::Failure;
use pliant::samples::SQUARE_MATERIAL;
use pliant::sparse::BlockMatrix;
use pliant::{
    Body, Cells, Mesh, Method, Phase, Report, Sampling, Scene, Settings, Statics, Strain,
};

use super::{Magnet, Wind, magnet};

/// Threads between pairs of nodes that pull with the cube of what they are stretched, and brake:
/// with d = u_b - u_a, the force on b is -k (d.d) d - c d'.
struct Threads {
    pairs: Vec<[usize; 2]>,
    /// Whether `couplings` names the pairs.
    named: bool,
    /// N/m^3
    k: f64,
    /// N s/m
    c: f64,
}

fn apart(x: &[f64], [a, b]: [usize; 2]) -> [f64; 2] {
    [0, 1].map(|i| x[2 * b + i] - x[2 * a + i])
}

impl Force for Threads {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        for &[a, b] in &self.pairs {
            let (d, rate) = (apart(u, [a, b]), apart(v, [a, b]));
            let square = d[0] * d[0] + d[1] * d[1];
            for i in 0..2 {
                forces.conservative[2 * b + i] -= self.k * square * d[i];
                forces.conservative[2 * a + i] += self.k * square * d[i];
                forces.dissipative[2 * b + i] -= self.c * rate[i];
                forces.dissipative[2 * a + i] += self.c * rate[i];
            }
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        for &[a, b] in &self.pairs {
            let d = apart(u, [a, b]);
            for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let same = if i == j { 1.0 } else { 0.0 };
                    let square = d[0] * d[0] + d[1] * d[1];
                    let k = self.k * (square * same + 2.0 * d[i] * d[j]);
                    stiffness.block_mut(row, column).unwrap()[2 * i + j] += sign * k;
                    damping.block_mut(row, column).unwrap()[2 * i + j] += sign * self.c * same;
                }
            }
        }
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let one = |&pair: &[usize; 2]| {
            let d = apart(u, pair);
            0.25 * self.k * (d[0] * d[0] + d[1] * d[1]).powi(2)
        };
        self.pairs.iter().map(one).sum()
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        if self.named { self.pairs.clone() } else { Vec::new() }
    }
}

/// How the tangents of a force are told.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Told {
    Exactly,
    ByDifferences,
    /// As if there were none.
    Wrongly,
}

/// The same force with other tangents.
struct With<F>(F, Told);

impl<F: Force> Force for With<F> {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.0.add_forces(t, u, v, forces)
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        match self.1 {
            Told::Exactly => self.0.add_tangents(t, u, v, stiffness, damping),
            Told::ByDifferences => Tangents::ByDifferences,
            Told::Wrongly => Tangents::Added,
        }
    }

    fn is_nonlinear(&self) -> bool {
        self.0.is_nonlinear()
    }

    fn potential(&self, t: f64, u: &[f64]) -> f64 {
        self.0.potential(t, u)
    }

    fn reservoir(&self) -> Reservoir {
        self.0.reservoir()
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        self.0.couplings()
    }
}

/// 5 x 4 nodes.
fn body() -> Body {
    let mesh = Mesh::rectangle([0.04, 0.03], [5, 4], Cells::Triangles).unwrap();
    Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap()
}

/// Threads across the body, and along its bottom between neighbours.
fn far() -> Threads {
    Threads { pairs: vec![[0, 19], [4, 15], [0, 9], [7, 16]], named: true, k: 3e7, c: 2.0 }
}

fn near() -> Threads {
    let pairs = vec![[0, 1], [1, 2], [2, 3], [3, 4], [0, 5]];
    Threads { pairs, named: false, ..far() }
}

/// Kt and D of a scene under one force, at some state.
fn tangents(force: impl Force + 'static) -> [Vec<f64>; 2] {
    let wave = |size: f64, phase: f64| {
        (0..40).map(|k| size * (0.7 * k as f64 + phase).sin()).collect::<Vec<f64>>()
    };
    let (u, v) = (wave(2e-3, 0.0), wave(1.0, 1.0));
    let scene = Scene::new(body()).force(force).phase(Phase::until(1.0));
    let mut equations = scene.equations(0, &[0.0; 40]).unwrap();
    equations.tangents(0.7, &u, &v).map(|matrix| matrix.values().to_vec())
}

#[test]
fn differences_are_the_tangents() {
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let check = |name: &str, [exact, found, none]: [[Vec<f64>; 2]; 3]| {
        for kind in 0..2 {
            let less = |a: &[Vec<f64>; 2], b: &[Vec<f64>; 2]| {
                a[kind].iter().zip(&b[kind]).map(|(a, b)| a - b).collect::<Vec<f64>>()
            };
            let (own, off) = (largest(&less(&exact, &none)), largest(&less(&found, &exact)));
            println!("{name} {kind}: off by {off:.1e} of {own:.1e}");
            // 1e-6 of round-off and of nonlinearity each, as the module has it; no difference at all where
            // the force does not depend on u or v
            assert!(off <= 3e-6 * own, "{name}: {off:e} of {own:e}");
        }
    };
    let told = [Told::Exactly, Told::ByDifferences, Told::Wrongly];
    let wind = || Wind::new(vec![0, 2, 3, 11], 0.2, |t| [3.0 * t, -1.0]);
    check("magnet", told.map(|told| tangents(With(magnet(&body()), told))));
    check("wind", told.map(|told| tangents(With(wind(), told))));
    check("far threads", told.map(|told| tangents(With(far(), told))));
    // pairs that nobody names: those of cells are tried as the others do not explain the force
    check("near threads", told.map(|told| tangents(With(near(), told))));
}

/// A rubber strip with stiff threads, in the wind beside a magnet.
fn strip(told: Told) -> Scene {
    let mesh = Mesh::rectangle([0.01, 0.05], [3, 11], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green).build().unwrap();
    let magnet = Magnet::new(&body, [0.02, 0.05], 5e-7, 0.005);
    let windward = body.mesh().select(&"left".into()).unwrap();
    let threads = Threads { pairs: vec![[3, 30], [5, 32], [9, 23]], named: true, k: 1e9, c: 0.5 };
    Scene::new(body)
        .force(With(magnet, told))
        .force(With(Wind::new(windward, 2e-3, |t| [8.0 * (20.0 * t).sin(), 0.0]), told))
        .force(With(threads, told))
        .phase(Phase::until(0.1).hold("bottom").named("gust"))
        .phase(Phase::until(0.15).hold("bottom").named("after"))
}

fn cost(report: &Report) -> [usize; 4] {
    [report.steps(), report.evaluations(), report.factorizations(), report.convergence_failures()]
}

#[test]
fn a_run_by_differences_is_the_run_by_tangents() {
    for method in [Method::CvodeBdf, Method::Arkode, Method::Ida] {
        let settings = Settings { method, rtol: 1e-5, ..Settings::default() };
        let run = |told| strip(told).simulate(&settings, &Sampling::every(0.01)).unwrap();
        let [exact, differences] = [Told::Exactly, Told::ByDifferences].map(run);
        let costs = [&exact, &differences].map(|run| cost(run.report()));
        println!("{method}: steps, evaluations, factorizations, failures {costs:?}");
        let wrongly = strip(Told::Wrongly).simulate(&settings, &Sampling::every(0.01));
        match &wrongly {
            Ok(run) => println!("    without tangents {:?}", cost(run.report())),
            Err(error) => println!("    without tangents: {error}"),
        }
        let report = differences.report();
        let each = report.difference_evaluations() as f64 / report.jacobian_evaluations() as f64;
        println!("    {each} evaluations per Jacobian");
        // the same numbers on the machine on which this was written; without tangents three to forty times as many
        for (exact, found) in costs[0].iter().zip(costs[1]).take(3) {
            let ratio = found as f64 / *exact as f64;
            assert!((0.99..1.01).contains(&ratio), "{method}: {costs:?}");
        }
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (exact, found) in exact.samples().iter().zip(differences.samples()) {
            for (exact, found) in exact.u.iter().zip(&found.u) {
                worst = worst.max((exact - found).abs());
                largest = largest.max(exact.abs());
            }
        }
        println!("    motions {worst:e} of {largest:e} m apart");
        // 2e-9 with ARKODE, the others less: errors of a Newton matrix vanish with the iterations
        assert!(worst < 1e-8 * largest, "{method}");
        assert_eq!(exact.report().difference_evaluations(), 0);
        let is_noted = |report: &Report| report.to_string().contains("by finite differences");
        assert!(is_noted(report) && !is_noted(exact.report()), "{report}");
    }
}

/// A force on nodes by themselves costs one evaluation where it is, one more for u and one for v, and two
/// for the axes of the one that it depends on.
#[test]
fn evaluations_are_counted() {
    let scene = |told| {
        let body = body();
        let magnet = magnet(&body);
        Scene::new(body).force(With(magnet, told)).phase(Phase::until(0.1).hold("left"))
    };
    let count = |told, method| {
        let settings = Settings { method, ..Settings::default() };
        let run = scene(told).simulate(&settings, &Sampling::phase_ends()).unwrap();
        (run.report().difference_evaluations(), run.report().jacobian_evaluations())
    };
    for method in [Method::CvodeBdf, Method::Arkode, Method::Ida] {
        let (differences, tangents) = count(Told::ByDifferences, method);
        println!("{method}: {differences} evaluations for {tangents} tangents");
        assert!(tangents > 0 && differences == 5 * tangents, "{differences} {tangents}");
        assert_eq!(count(Told::Exactly, method).0, 0);
    }
    assert_eq!(count(Told::ByDifferences, Method::Rk), (0, 0));
}

#[test]
fn statics_and_spectra_take_differences() {
    let found = |told| {
        let scene = strip(told);
        (scene.equilibrium(&Statics::default()).unwrap(), scene.spectrum().unwrap()[0])
    };
    let ((exact, spectrum), (differences, other)) =
        (found(Told::Exactly), found(Told::ByDifferences));
    println!("{exact}\n{differences}\n{spectrum:?}\n{other:?}");
    assert_eq!(exact.iterations, differences.iterations);
    assert!(exact.difference_evaluations == 0 && differences.difference_evaluations > 0);
    let apart = exact.displacements().iter().zip(differences.displacements());
    let apart = apart.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(apart < 1e-9, "{apart:e}");
    let ratio = spectrum.lowest_frequency.unwrap() / other.lowest_frequency.unwrap();
    assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
    assert!((spectrum.damping_rate / other.damping_rate - 1.0).abs() < 1e-5);
}

/// A pull on all nodes that has a meaning on one side of u = 0 alone, or at u = 0 alone.
struct Edge {
    is_point: bool,
}

impl Force for Edge {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        if u.iter().any(|&u| u > 0.0 || (self.is_point && u < 0.0)) {
            return Err(Failure::Recoverable("beyond the edge".into()));
        }
        forces.conservative.iter_mut().zip(u).for_each(|(f, u)| *f -= 3.0 * u);
        Ok(())
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        u.iter().map(|u| 1.5 * u * u).sum()
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }
}

#[test]
fn differences_look_to_the_side_where_the_force_is() {
    let tangent = |force: Option<Edge>| {
        let scene = Scene::new(body()).phase(Phase::until(1.0));
        let scene = force.into_iter().fold(scene, Scene::force);
        let mut equations = scene.equations(0, &[0.0; 40]).unwrap();
        equations.tangents(0.0, &[0.0; 40], &[0.0; 40])[0].to_dense()
    };
    let body = tangent(None);
    for (is_point, expected) in [(false, 3.0), (true, 0.0)] {
        let own = tangent(Some(Edge { is_point })) - &body;
        for (i, j) in (0..40).flat_map(|i| (0..40).map(move |j| (i, j))) {
            let expected = if i == j { expected } else { 0.0 };
            assert!(
                (own[(i, j)] - expected).abs() < 1e-9 * body[(0, 0)],
                "{} {expected}",
                own[(i, j)]
            );
        }
    }
}

/// A force that panics after some time.
struct Bomb;

impl Force for Bomb {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        assert!(t < 0.01, "a force that panics");
        forces.applied[0] += 1.0 - u[0];
        Ok(())
    }
}

#[test]
fn a_panic_reaches_the_caller() {
    for method in Method::ALL {
        let settings = Settings { method, ..Settings::default() };
        let scene = Scene::new(body()).force(Bomb).phase(Phase::until(1.0).hold("left"));
        let run = || scene.simulate(&settings, &Sampling::phase_ends());
        let panic = catch_unwind(AssertUnwindSafe(run)).expect_err("a panic");
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"a force that panics"), "{method}");
    }
}
