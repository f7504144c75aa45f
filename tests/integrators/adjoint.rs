//! Adjoint gradients, against closed forms, forward sensitivities and differences.

use std::panic::{AssertUnwindSafe, catch_unwind};

use faer::MatMut;
use std::error::Error as _;

use pliant::{
    ode::{BandMut, Failure, Functional, Ode, Slopes},
    sundials::{
        Adjoint, AdjointOptions, Callback, Cause, Cvode, CvodeOptions, Error, Gradient, Integrator,
        Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern, Preconditioner, Sensitivities, Side,
    },
};

use crate::support::End;

/// Robertson's reactions with their three rates as parameters, and everything supplied.
struct Reactions {
    p: [f64; 3],
    pattern: Pattern,
    /// What the adjoint parameters do before t = 1.
    trouble: Option<fn() -> Result<(), Failure>>,
}

const START: [f64; 3] = [1.0, 0.0, 0.0];

impl Reactions {
    fn new() -> Self {
        let pattern = Pattern::from_entries(3, (0..3).flat_map(|i| [(i, 0), (i, 1), (i, 2)]));
        Self { p: [0.04, 1e4, 3e7], pattern: pattern.unwrap(), trouble: None }
    }

    fn entries(&self, y: &[f64]) -> [[f64; 3]; 3] {
        let [a, b, c] = self.p;
        [
            [-a, b * y[2], b * y[1]],
            [a, -b * y[2] - 2.0 * c * y[1], -b * y[1]],
            [0.0, 2.0 * c * y[1], 0.0],
        ]
    }
}

impl Ode for Reactions {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let [a, b, c] = self.p;
        ydot[0] = -a * y[0] + b * y[1] * y[2];
        ydot[2] = c * y[1] * y[1];
        ydot[1] = -ydot[0] - ydot[2];
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        (0..3).for_each(|i| (0..3).for_each(|j| jacobian[(i, j)] = entries[i][j]));
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        // The lower left corner is zero.
        let entries = self.entries(y);
        for (i, j) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 1), (2, 2)] {
            jacobian[(i, j)] = entries[i][j];
        }
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        (0..3).for_each(|j| (0..3).for_each(|i| values[3 * j + i] = entries[i][j]));
        Ok(())
    }

    fn adjoint_rhs(
        &mut self,
        _t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        (0..3).for_each(|j| out[j] = (0..3).map(|i| entries[i][j] * lambda[i]).sum());
        Ok(())
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if let Some(trouble) = self.trouble.filter(|_| t < 1.0) {
            trouble()?;
        }
        let first = lambda[1] - lambda[0];
        out.copy_from_slice(&[
            first * y[0],
            -first * y[1] * y[2],
            (lambda[2] - lambda[1]) * y[1] * y[1],
        ]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// y_0(T)^2 + 3 p_0 + integral of y_2 + p_0 y_0.
struct Mixed;

impl Functional for Mixed {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            (slopes.y[0], slopes.y[2], slopes.p[0]) = (p[0], 1.0, y[0]);
        }
        Ok(y[2] + p[0] * y[0])
    }

    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            (slopes.y[0], slopes.p[0]) = (2.0 * y[0], 3.0);
        }
        Ok(y[0] * y[0] + 3.0 * p[0])
    }
}

/// The same by forward sensitivities: the integral as a fourth unknown.
fn forward(t: f64) -> (f64, [f64; 3]) {
    struct Extended(Reactions);
    impl Ode for Extended {
        fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[3] = y[2] + self.0.p[0] * y[0];
            self.0.rhs(t, &y[..3], &mut ydot[..3])
        }

        fn parameters(&self) -> &[f64] {
            self.0.parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.0.set_parameters(values);
        }
    }
    let options = CvodeOptions::new(1e-9, [1e-12, 1e-16, 1e-12, 1e-10])
        .sensitivities(Sensitivities::of([0, 1, 2]));
    let start = [1.0, 0.0, 0.0, 0.0];
    let mut solver = Cvode::new(Extended(Reactions::new()), 0.0, &start, &options).unwrap();
    solver.solve_to(t).unwrap();
    let (y, s) = (solver.y(), solver.sensitivities());
    let slopes = [0, 1, 2].map(|j| 2.0 * y[0] * s[(0, j)] + s[(3, j)]);
    (y[0] * y[0] + 0.12 + y[3], [slopes[0] + 3.0, slopes[1], slopes[2]])
}

fn largest<const N: usize>(found: &[f64], exact: [f64; N]) -> f64 {
    assert_eq!(found.len(), N);
    found.iter().zip(exact).map(|(x, e)| (x / e - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn robertson_backward_and_forward_agree() {
    let (value, slopes) = forward(40.0);
    let supplied = LinearSolver::Dense(Jacobian::Supplied);
    let band = |jacobian| LinearSolver::Band { lower: 1, upper: 2, jacobian };
    let klu = |jacobian| LinearSolver::Klu { pattern: Reactions::new().pattern, jacobian };
    for solver in [
        supplied.clone(),
        LinearSolver::Dense(Jacobian::DifferenceQuotients),
        band(Jacobian::Supplied),
        band(Jacobian::DifferenceQuotients),
        klu(Jacobian::Supplied),
        klu(Jacobian::DifferenceQuotients),
    ] {
        let forward = CvodeOptions::new(1e-8, [1e-12, 1e-16, 1e-12]).newton(solver.clone());
        let options = AdjointOptions::new(1e-8, 1e-9);
        let mut own = vec![options.clone()];
        if matches!(solver, LinearSolver::Dense(Jacobian::Supplied)) {
            own.push(options.clone().supplied_rhs().supplied_parameters());
            own.push(options.clone().checkpoint_steps(20));
            own.push(options.gradient_tolerances(1e-8, [1e-8, 1e-14, 1e-17]));
        }
        for options in own {
            let mut adjoint =
                Adjoint::new(Reactions::new(), Mixed, 0.0, &START, &forward, &options).unwrap();
            let gradient = adjoint.gradient(40.0).unwrap();
            let errors =
                (largest(&[gradient.value], [value]), largest(&gradient.parameters, slopes));
            println!("{errors:?}");
            assert!(errors.0 < 5e-8 && errors.1 < 2e-6);
            assert_eq!(adjoint.system().p, Reactions::new().p, "put back to the last bit");
            // Again: the same run, the same digits.
            assert_eq!(adjoint.gradient(40.0).unwrap(), gradient);
        }
    }
}

/// Krylov methods back in time, by products of the system and an incomplete factorization, which has no fill to leave
/// out on this pattern: the gradients are those of the forward sensitivities, as with matrices.
#[test]
fn krylov_methods_solve_the_backward_run() {
    let (value, slopes) = forward(40.0);
    let pattern = || Reactions::new().pattern;
    let gmres = KrylovMethod::Gmres { dimension: 3, restarts: 0 };
    for jacobian in [Jacobian::Supplied, Jacobian::DifferenceQuotients] {
        let ilu = |side| (side, Preconditioner::Ilu { pattern: pattern(), jacobian });
        let [left, right] = [Side::Left, Side::Right].map(ilu);
        for (method, preconditioner) in [
            (gmres, None),
            (gmres, Some(left)),
            (KrylovMethod::BiCgStab { iterations: 10 }, Some(right.clone())),
            (KrylovMethod::Tfqmr { iterations: 10 }, Some(right.clone())),
            (KrylovMethod::Fgmres { dimension: 3, restarts: 0 }, Some(right)),
        ] {
            let krylov = Krylov::new(method).tolerance_factor(1e-3);
            let krylov = match preconditioner.clone() {
                Some((side, ilu)) => krylov.preconditioner(side, ilu),
                None => krylov,
            };
            let forward =
                CvodeOptions::new(1e-8, [1e-12, 1e-16, 1e-12]).newton(LinearSolver::Krylov(krylov));
            let options = AdjointOptions::new(1e-8, 1e-9).supplied_rhs();
            let mut adjoint =
                Adjoint::new(Reactions::new(), Mixed, 0.0, &START, &forward, &options).unwrap();
            let gradient = adjoint.gradient(40.0).unwrap();
            let errors =
                (largest(&[gradient.value], [value]), largest(&gradient.parameters, slopes));
            println!("{method:?} {}: {errors:?}", preconditioner.is_some());
            assert!(errors.0 < 5e-8 && errors.1 < 2e-6);
        }
    }
}

/// An oscillator x'' = -w^2 x: G = x(T), in w, x0 and v0, in both directions of time.
#[test]
fn an_oscillator_in_closed_form() {
    let system = pliant::ode::with_parameters(
        |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
            ydot.copy_from_slice(&[y[1], -p[0] * p[0] * y[0]]);
            Ok(())
        },
        [3.0],
    );
    let (forward, options) = (CvodeOptions::new(1e-9, 1e-11), AdjointOptions::new(1e-9, 1e-11));
    let mut adjoint = Adjoint::new(system, End, 0.0, &[1.0, 0.5], &forward, &options).unwrap();
    for (t, w) in [(2.0, 3.0), (0.7, 3.0), (-1.5, 3.0), (2.0, 2.0)] {
        adjoint.system_mut().set_parameters(&[w]);
        let gradient = adjoint.gradient(t).unwrap();
        let (sin, cos) = f64::sin_cos(w * t);
        let exact = Gradient {
            value: cos + 0.5 * sin / w,
            parameters: vec![-t * sin + 0.5 * (t * cos / w - sin / (w * w))],
            initial_state: vec![cos, sin / w],
        };
        let pairs =
            |g: &Gradient| [g.value, g.parameters[0], g.initial_state[0], g.initial_state[1]];
        let errors = pairs(&gradient).into_iter().zip(pairs(&exact)).map(|(g, e)| (g - e).abs());
        let error = errors.fold(0.0, f64::max);
        println!("{error:e}");
        assert!(error < 5e-8, "{gradient:?} {exact:?}");
    }
}

/// Lambda along the backward run is the slope of G by the state there: of x(T) for the oscillator, in closed form. The
/// gradient stays what it is.
#[test]
fn the_adjoint_along_the_way_in_closed_form() {
    let w = 3.0;
    let oscillator = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -w * w * y[0]]);
        Ok(())
    };
    let (forward, options) = (CvodeOptions::new(1e-9, 1e-11), AdjointOptions::new(1e-9, 1e-11));
    for (start, end) in [(0.0, 2.0), (2.0, 0.0), (1e9, 1e9 + 2.0)] {
        let made = Adjoint::new(oscillator, End, start, &[1.0, 0.5], &forward, &options);
        let mut adjoint = made.unwrap();
        let times: Vec<f64> = (0..=10).map(|k| end + (start - end) * f64::from(k) / 10.0).collect();
        let mut seen = Vec::new();
        let gradient = adjoint
            .gradient_along(end, &times, |t, lambda| {
                let (sin, cos) = f64::sin_cos(w * (end - t));
                let error = f64::max((lambda[0] - cos).abs(), (lambda[1] - sin / w).abs());
                // measured: 1.5e-8
                assert!(error < 5e-8, "{t}: {error:e}");
                seen.push(t);
            })
            .unwrap();
        assert_eq!(seen, times);
        let plain = adjoint.gradient(end).unwrap();
        let pairs = gradient.initial_state.iter().zip(&plain.initial_state);
        // another first target is another first step
        assert!(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 5e-8);
        for times in [vec![end, start, end], vec![f64::NAN], vec![2.0 * end - start]] {
            let error = adjoint.gradient_along(end, &times, |_, _| ()).unwrap_err().to_string();
            assert!(error.contains("time along"), "{error}");
        }
    }
}

/// The integral of |y|^2/2.
struct HalfSquare;

impl Functional for HalfSquare {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y.copy_from_slice(y);
        }
        Ok(0.5 * y.iter().map(|y| y * y).sum::<f64>())
    }
}

/// `cvsHessian_ASA_FSA` of SUNDIALS 6.4.1: the gradient and the Hessian that its `.out` prints with five digits.
#[test]
fn the_hessian_of_the_example_of_cvodes() {
    let rhs = |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[-p[0] * y[0] * y[0] - y[2], -y[1], -p[1] * p[1] * y[1] * y[2]]);
        Ok(())
    };
    let pattern = Pattern::from_entries(3, [(0, 0), (0, 2), (1, 1), (2, 1), (2, 2)]).unwrap();
    let jacobian = Jacobian::DifferenceQuotients;
    for solver in [
        LinearSolver::Dense(jacobian),
        LinearSolver::Band { lower: 1, upper: 2, jacobian },
        LinearSolver::Klu { pattern, jacobian },
    ] {
        let system = pliant::ode::with_parameters(rhs, [1.0, 2.0]);
        let forward = CvodeOptions::new(1e-8, 1e-8).newton(solver);
        let options = AdjointOptions::new(1e-8, 1e-8);
        let mut adjoint =
            Adjoint::new(system, HalfSquare, 0.0, &[1.0; 3], &forward, &options).unwrap();
        let columns = [[1.0, 0.0], [0.0, 1.0]].map(|v| adjoint.hessian_times(2.0, &v).unwrap());
        let printed = [(-1.2838e-1, [1.5628e-1, -7.8678e-2]), (1.8036e-2, [-7.8678e-2, 8.9814e-2])];
        for (column, (slope, second)) in columns.iter().zip(printed) {
            println!("{column:?}");
            let far = |found: f64, printed: f64| (found / printed - 1.0).abs();
            // half of the last digit that is printed; the second component of dG/dp is 1.8037e-2 forward
            assert!(far(column.value, slope) < 5e-5, "{} {slope}", column.value);
            let errors = column.parameters.iter().zip(second).map(|(h, p)| far(*h, p));
            assert!(errors.fold(0.0, f64::max) < 1e-5, "{:?} {second:?}", column.parameters);
        }
        assert_eq!(adjoint.system().parameters(), [1.0, 2.0], "put back to the last bit");
        // any direction, by its columns
        let mixed = adjoint.hessian_times(2.0, &[3.0, -0.5]).unwrap();
        for i in 0..2 {
            let sum = 3.0 * columns[0].parameters[i] - 0.5 * columns[1].parameters[i];
            assert!((mixed.parameters[i] - sum).abs() < 1e-6, "{} {sum}", mixed.parameters[i]);
        }
    }
}

/// x(T) of an oscillator x'' = -w^2 x, of w and the start: second derivatives in closed form, with everything supplied by the
/// system and with nothing.
#[test]
fn second_derivatives_of_an_oscillator_in_closed_form() {
    struct Oscillator([f64; 1]);
    impl Ode for Oscillator {
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot.copy_from_slice(&[y[1], -self.0[0] * self.0[0] * y[0]]);
            Ok(())
        }
        fn dense_jacobian(
            &mut self,
            _t: f64,
            _y: &[f64],
            _ydot: &[f64],
            mut jacobian: MatMut<'_, f64>,
        ) -> Result<(), Failure> {
            (jacobian[(0, 1)], jacobian[(1, 0)]) = (1.0, -self.0[0] * self.0[0]);
            Ok(())
        }
        fn adjoint_rhs(
            &mut self,
            _t: f64,
            _y: &[f64],
            lambda: &[f64],
            out: &mut [f64],
        ) -> Result<(), Failure> {
            out.copy_from_slice(&[-self.0[0] * self.0[0] * lambda[1], lambda[0]]);
            Ok(())
        }
        fn adjoint_parameters(
            &mut self,
            _t: f64,
            y: &[f64],
            lambda: &[f64],
            out: &mut [f64],
        ) -> Result<(), Failure> {
            out[0] = -2.0 * self.0[0] * y[0] * lambda[1];
            Ok(())
        }
        fn parameters(&self) -> &[f64] {
            &self.0
        }
        fn set_parameters(&mut self, values: &[f64]) {
            self.0.copy_from_slice(values);
        }
    }
    let back = || AdjointOptions::new(1e-8, 1e-10);
    let (w, t) = (3.0, 1.3);
    let (sin, cos) = f64::sin_cos(w * t);
    // x(T) = cos w T + sin w T/(2 w), from x0 = 1 and v0 = 1/2
    let exact = [
        -t * sin + 0.5 * (t * cos / w - sin / (w * w)),
        -t * t * cos + 0.5 * (-t * t * sin / w - 2.0 * t * cos / (w * w) + 2.0 * sin / (w * w * w)),
        -t * sin,
        t * cos / w - sin / (w * w),
    ];
    for (jacobian, options) in [
        (Jacobian::DifferenceQuotients, back()),
        (Jacobian::Supplied, back()),
        (Jacobian::Supplied, back().supplied_rhs().supplied_parameters()),
    ] {
        let forward = CvodeOptions::new(1e-8, 1e-10).newton(LinearSolver::Dense(jacobian));
        let made = Adjoint::new(Oscillator([w]), End, 0.0, &[1.0, 0.5], &forward, &options);
        let mut adjoint = made.unwrap();
        let found = adjoint.hessian_times(t, &[1.0]).unwrap();
        let found =
            [found.value, found.parameters[0], found.initial_state[0], found.initial_state[1]];
        let error = found.iter().zip(exact).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
        println!("{jacobian:?}: {error:e}");
        assert!(error < 5e-7, "{found:?} {exact:?}");
        for (direction, says) in
            [(vec![], "length"), (vec![0.0], "zero"), (vec![f64::NAN], "direction")]
        {
            let error = adjoint.hessian_times(t, &direction).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}

/// y' = y, which ends where the equations end: at t = 1.
#[test]
fn the_equations_are_not_asked_beyond_the_end() {
    let growth = |t: f64, y: &[f64], ydot: &mut [f64]| {
        if t > 1.0 {
            return Err(Failure::Fatal("there is nothing beyond".into()));
        }
        ydot[0] = y[0];
        Ok(())
    };
    let (forward, options) = (CvodeOptions::new(1e-6, 1e-8), AdjointOptions::new(1e-6, 1e-8));
    let mut adjoint = Adjoint::new(growth, End, 0.0, &[1.0], &forward, &options).unwrap();
    let slope = adjoint.gradient(1.0).unwrap().initial_state[0];
    assert!((slope - std::f64::consts::E).abs() < 1e-4, "{slope}");
}

#[test]
fn troubles_on_the_way_back_are_told() {
    let forward = CvodeOptions::new(1e-6, [1e-8, 1e-12, 1e-8]);
    let options = AdjointOptions::new(1e-6, 1e-8).supplied_parameters();
    let run = |trouble: fn() -> Result<(), Failure>| {
        let system = Reactions { trouble: Some(trouble), ..Reactions::new() };
        let mut adjoint = Adjoint::new(system, Mixed, 0.0, &START, &forward, &options).unwrap();
        let outcome = catch_unwind(AssertUnwindSafe(|| adjoint.gradient(10.0)));
        // It goes on working.
        adjoint.system_mut().trouble = None;
        adjoint.gradient(10.0).unwrap();
        outcome
    };
    let stopped = |outcome: std::thread::Result<Result<Gradient, Error>>| match outcome {
        Ok(Err(Error::Integration(error))) => {
            println!("{error}");
            *error
        }
        other => panic!("{other:?}"),
    };
    let error = stopped(run(|| Err(Failure::Fatal("no".into()))));
    assert_eq!(error.cause, Cause::Fatal(Callback::Adjoint));
    assert!(error.integrator.contains("back") && error.t < 2.0);
    let error = stopped(run(|| Err(Failure::Recoverable("not here".into()))));
    assert!(matches!(error.cause, Cause::Rejected { callback: Callback::Adjoint, .. }));
    let panic = run(|| panic!("sabotage")).unwrap_err();
    assert_eq!(*panic.downcast_ref::<&str>().unwrap(), "sabotage");
    // Forward, as ever.
    let few = CvodeOptions::new(1e-6, 1e-8).max_steps(10);
    let options = AdjointOptions::new(1e-6, 1e-8);
    let mut adjoint = Adjoint::new(Reactions::new(), Mixed, 0.0, &START, &few, &options).unwrap();
    let error = stopped(Ok(adjoint.gradient(10.0)));
    assert!(matches!(error.cause, Cause::TooManySteps { steps: 10, .. }), "{error}");
}

/// Transposed products that forget an entry: the gradient is refused, with the slope of lambda^T f and what differences say.
#[test]
fn wrong_products_are_found() {
    struct Forgetful(Reactions);
    impl Ode for Forgetful {
        fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            self.0.rhs(t, y, ydot)
        }

        fn adjoint_rhs(
            &mut self,
            t: f64,
            y: &[f64],
            lambda: &[f64],
            out: &mut [f64],
        ) -> Result<(), Failure> {
            self.0.adjoint_rhs(t, y, lambda, out)?;
            out[1] -= self.0.entries(y)[2][1] * lambda[2];
            Ok(())
        }

        fn parameters(&self) -> &[f64] {
            self.0.parameters()
        }
    }
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 3, restarts: 0 });
    let forward = CvodeOptions::new(1e-6, 1e-8).newton(LinearSolver::Krylov(krylov));
    let back = AdjointOptions::new(1e-6, 1e-8).supplied_rhs();
    let system = Forgetful(Reactions::new());
    let mut adjoint = Adjoint::new(system, Mixed, 0.0, &START, &forward, &back).unwrap();
    let error = adjoint.gradient(10.0).unwrap_err();
    let words = error.source().unwrap().to_string();
    assert!(words.contains("adjoint_rhs is wrong: its slope by y[1] is"), "{words}");
}

#[test]
fn unusable_input_is_named() {
    let forward = CvodeOptions::new(1e-6, 1e-8);
    let back = AdjointOptions::new(1e-6, 1e-8);
    let made = |forward: &CvodeOptions, back: &AdjointOptions| {
        Adjoint::new(Reactions::new(), Mixed, 0.0, &START, forward, back)
    };
    let refused = |forward: &CvodeOptions, back: &AdjointOptions| match made(forward, back) {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(refused(&forward.clone().newton(LinearSolver::Custom), &back).contains("entries"));
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 3, restarts: 0 });
    let plain = forward.clone().newton(LinearSolver::Krylov(krylov.clone()));
    assert!(refused(&plain, &back).contains("adjoint_rhs"));
    let own = krylov.preconditioner(Side::Left, Preconditioner::Custom);
    let own = forward.clone().newton(LinearSolver::Krylov(own));
    assert!(refused(&own, &back.clone().supplied_rhs()).contains("Ilu"));
    assert!(refused(&forward.clone().fixed_point(0), &back).contains("Newton"));
    assert!(refused(&forward.clone().project(), &back).contains("project"));
    let sensitivities = forward.clone().sensitivities(Sensitivities::of([0]));
    assert!(refused(&sensitivities, &back).contains("sensitivities"));
    assert!(refused(&forward, &back.clone().checkpoint_steps(0)).contains("checkpoint_steps"));
    assert!(refused(&forward, &AdjointOptions::new(2.0, 1e-8)).contains("rtol"));
    assert!(refused(&forward, &AdjointOptions::new(1e-6, [1e-8])).contains("atol"));
    assert!(refused(&forward, &back.clone().gradient_tolerances(1e-6, 0.0)).contains("atol"));
    let mut adjoint = made(&forward, &back).unwrap();
    assert!(adjoint.gradient(0.0).is_err() && adjoint.gradient(f64::NAN).is_err());
}
