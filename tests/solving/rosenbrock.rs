//! Rosenbrock methods by one call: with events, breaks and interpolation, and with matrices of every form.

use pliant::{
    ode::{BandMut, Failure, Ode, with_mass},
    solve::{Error, Event, Method, Options, Output, Problem, Solution, solve},
    sundials::{Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern, Sensitivities, Sign},
};

use crate::support::{G, fall, oscillator, sine, tight};

/// sin t, at the ends of steps and between them, where the cubic is as good as the steps; both orders.
#[test]
fn a_sine_is_followed() {
    for order in [3, 4] {
        let options = Options::new(1e-8, 1e-10).max_order(order).max_step(0.05);
        let solution = solve(sine(), Method::Rosenbrock, (0.0, 10.0), &options).unwrap();
        assert!((solution.last()[0] - 10f64.sin()).abs() < 1e-6, "{order}");
        assert_eq!(solution.statistics().last_order, order);
        for k in 0..100 {
            let t = 0.0999 * f64::from(k);
            let error = (solution.at(t).unwrap()[0] - t.sin()).abs();
            // the dense output of order 2 leaves h^3 / 24 of the cubic term, half of it in the middle
            assert!(error < if order == 4 { 1e-6 } else { 1e-5 }, "{order} {t}: {error:e}");
        }
        let options = options.output(Output::Times(vec![1.0, 2.5, 7.0]));
        let solution = solve(sine(), Method::Rosenbrock, (0.0, 10.0), &options).unwrap();
        for (k, t) in [(1, 1.0), (2, 2.5), (3, 7.0_f64)] {
            assert!((solution.y(k)[0] - t.sin()).abs() < 1e-5);
        }
    }
}

/// A ball dropped from 1 m that keeps 0.8 of its speed: the third impact is at t1 (1 + 2 * 0.8 + 2 * 0.64) with t1 = sqrt(2/g).
#[test]
fn a_ball_bounces() {
    let impact = Event::new(|_, y: &[f64]| y[0])
        .falling()
        .action(|jump| jump.y[1] *= -0.8)
        .terminal_after(3);
    let problem = Problem::ode(fall, [1.0, 0.0]).event(impact);
    let solution = solve(problem, Method::Rosenbrock, (0.0, 10.0), &tight()).unwrap();
    let exact = (2.0 / G).sqrt() * (1.0 + 2.0 * 0.8 + 2.0 * 0.64);
    assert_eq!(solution.events().len(), 3);
    assert!((solution.t().last().unwrap() - exact).abs() < 1e-9);
}

/// The state doubled at 2 pi k: sin t becomes 2^k sin t.
#[test]
fn breaks_are_met() {
    let period = 2.0 * std::f64::consts::PI;
    let mut problem = Problem::ode(oscillator, [0.0, 1.0]);
    for k in 1..=3 {
        problem = problem.break_with(f64::from(k) * period, |jump| jump.y[1] *= 2.0);
    }
    let options = Options::new(1e-9, 1e-11);
    let solution = solve(problem, Method::Rosenbrock, (0.0, 4.0 * period), &options).unwrap();
    assert!((solution.last()[1] - 8.0).abs() < 1e-5 && solution.last()[0].abs() < 1e-5);
}

/// The Medical Akzo Nobel problem (test set for IVP solvers, "MEDAKZO"): penetration of antibodies into a tissue, two unknowns for each of
/// `n` points.
#[derive(Clone, Copy)]
struct Akzo {
    n: usize,
}

impl Akzo {
    const REACTION: f64 = 100.0;

    fn y0(self) -> Vec<f64> {
        (0..2 * self.n).map(|i| (i % 2) as f64).collect()
    }

    /// Weights of the neighbours and of the point itself.
    fn weights(self, j: usize) -> [f64; 3] {
        let (c, d) = (4.0, 1.0 / self.n as f64);
        let z = (j + 1) as f64 * d - 1.0;
        let (drift, spread) = (2.0 * z.powi(3) / (c * c), z.powi(4) / (c * c));
        let (half, square) = (drift / (2.0 * d), spread / (d * d));
        [square - half, -2.0 * square, square + half]
    }

    fn each(self, y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        for j in 0..self.n {
            let (u, v, [left, middle, right]) = (2 * j, 2 * j + 1, self.weights(j));
            let last = if j + 1 == self.n { right } else { 0.0 };
            put(u, u, middle + last - Self::REACTION * y[v]);
            put(u, v, -Self::REACTION * y[u]);
            put(v, u, -Self::REACTION * y[v]);
            put(v, v, -Self::REACTION * y[u]);
            if j > 0 {
                put(u, u - 2, left);
            }
            if j + 1 < self.n {
                put(u, u + 2, right);
            }
        }
    }

    fn pattern(self) -> Pattern {
        let mut places = Vec::new();
        self.each(&self.y0(), |i, j, _| places.push((i, j)));
        Pattern::from_entries(2 * self.n, places).unwrap()
    }
}

impl Ode for Akzo {
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        let outside = if t < 5.0 { 2.0 } else { 0.0 };
        for j in 0..self.n {
            let (u, v, [left, middle, right]) = (2 * j, 2 * j + 1, self.weights(j));
            let before = if j == 0 { outside } else { y[u - 2] };
            let after = y[if j + 1 == self.n { u } else { u + 2 }];
            let reaction = Self::REACTION * y[u] * y[v];
            f[u] = left * before + middle * y[u] + right * after - reaction;
            f[v] = -reaction;
        }
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _f: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.each(y, |i, j, value| jacobian[(i, j)] = value);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _f: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let pattern = self.pattern();
        self.each(y, |i, j, value| values[pattern.position(i, j).unwrap()] = value);
        Ok(())
    }
}

fn akzo(n: usize, method: Method, solver: LinearSolver, rtol: f64) -> Solution {
    let system = Akzo { n };
    let options = Options::new(rtol, rtol).linear_solver(solver).output(Output::End);
    let problem = Problem::ode(system, system.y0()).breaks([5.0]);
    solve(problem, method, (0.0, 20.0), &options).unwrap()
}

fn apart(a: &Solution, b: &Solution) -> f64 {
    a.last().iter().zip(b.last()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// 400 unknowns, with a sparse and a band matrix, by entries and by quotients, against BDF with KLU at a much smaller tolerance. The
/// matrices are the same, so that the runs are, to the rounding of quotients.
#[test]
fn four_hundred_unknowns_by_sparse_and_band_matrices() {
    let pattern = Akzo { n: 200 }.pattern();
    let klu = |jacobian| LinearSolver::Klu { pattern: pattern.clone(), jacobian };
    let band = |jacobian| LinearSolver::Band { lower: 2, upper: 2, jacobian };
    let (quotients, supplied) = (Jacobian::DifferenceQuotients, Jacobian::Supplied);
    let exact = akzo(200, Method::Bdf, klu(quotients), 1e-9);
    let mut steps = Vec::new();
    for solver in [klu(quotients), klu(supplied), band(quotients), band(supplied)] {
        let start = std::time::Instant::now();
        let solution = akzo(200, Method::Rosenbrock, solver.clone(), 1e-5);
        let (error, s) = (apart(&solution, &exact), solution.statistics());
        println!(
            "{error:.1e}, {} steps, {} + {} evaluations, {} factorizations, {:?}",
            s.steps,
            s.evaluations,
            s.difference_quotient_evaluations,
            s.linear_setups,
            start.elapsed()
        );
        assert!(error < 1e-4, "{solver:?}: {error:e}");
        steps.push(s.steps);
        // a colour for each column of a block and its neighbours, once a step, and df/dt
        assert!(s.difference_quotient_evaluations <= 8 * s.jacobian_evaluations + s.steps + 20);
    }
    assert!(steps.iter().all(|n| n.abs_diff(steps[0]) <= steps[0] / 10), "{steps:?}");
    let start = std::time::Instant::now();
    let bdf = akzo(200, Method::Bdf, klu(quotients), 1e-5);
    println!(
        "BDF: {:.1e}, {} steps, {:?}",
        apart(&bdf, &exact),
        bdf.statistics().steps,
        start.elapsed()
    );
}

/// The same by a dense matrix, of 40 unknowns.
#[test]
fn dense_and_sparse_matrices_give_the_same() {
    let (quotients, pattern) = (Jacobian::DifferenceQuotients, Akzo { n: 20 }.pattern());
    let dense = akzo(20, Method::Rosenbrock, LinearSolver::Dense(quotients), 1e-6);
    let klu = LinearSolver::Klu { pattern, jacobian: quotients };
    let sparse = akzo(20, Method::Rosenbrock, klu, 1e-6);
    assert!(apart(&dense, &sparse) < 1e-7, "{:e}", apart(&dense, &sparse));
}

#[test]
fn what_it_does_not_have_is_refused() {
    let refused = |options: Options, problem: Problem<'_>, span| match solve(
        problem,
        Method::Rosenbrock,
        span,
        &options,
    ) {
        Err(Error::Input(error)) => error.input,
        other => panic!("{other:?}"),
    };
    let options = || Options::new(1e-6, 1e-9);
    let span = (0.0, 1.0);
    assert_eq!(refused(options().max_order(5), sine(), span), "order");
    assert_eq!(refused(options().min_step(1e-9), sine(), span), "min_step");
    let signs = options().sign_constraints([Sign::NonNegative, Sign::Free]);
    assert_eq!(refused(signs, sine(), span), "sign_constraints");
    assert_eq!(refused(options().project(), sine(), span), "project");
    let sensitivities = options().sensitivities(Sensitivities::of([0]));
    assert_eq!(refused(sensitivities, sine(), span), "sensitivities");
    assert_eq!(refused(options(), sine(), (1.0, 0.0)), "stop time");
    let massive = Problem::ode(with_mass(oscillator, [1.0, 2.0]), [0.0, 1.0]);
    assert_eq!(refused(options(), massive, span), "mass matrix");
    let krylov = Krylov::new(KrylovMethod::BiCgStab { iterations: 5 });
    let krylov = options().linear_solver(LinearSolver::Krylov(krylov));
    assert_eq!(refused(krylov, sine(), span), "linear solver");
    let pattern = Pattern::from_entries(3, []).unwrap();
    let jacobian = Jacobian::DifferenceQuotients;
    let klu = options().linear_solver(LinearSolver::Klu { pattern, jacobian });
    assert_eq!(refused(klu, sine(), span), "dimension of the sparsity pattern");
}
