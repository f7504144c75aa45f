//! Forward sensitivities, against closed forms and runs of high precision.

use std::panic::{AssertUnwindSafe, catch_unwind};

use faer::{Mat, MatRef, mat};
use pliant::{
    ode::{Dae, Failure, Ode, with_parameters},
    sundials::{
        Callback, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions, InitialCondition, Integrator,
        Jacobian, LinearSolver, Multistep, Reached, Sensitivities, SensitivityMethod,
        SensitivitySource,
    },
};

const METHODS: [SensitivityMethod; 3] = [
    SensitivityMethod::Simultaneous,
    SensitivityMethod::Staggered,
    SensitivityMethod::StaggeredOneByOne,
];
const SOURCES: [SensitivitySource; 3] = [
    SensitivitySource::Supplied,
    SensitivitySource::CentralDifferences,
    SensitivitySource::ForwardDifferences,
];

/// x'' = -w^2 x from (1, 0), with a constant force a beside it: parameters [a, w], a root where x falls below 0.
struct Oscillator([f64; 2]);

impl Oscillator {
    const START: [f64; 2] = [1.0, 0.0];

    fn new() -> Self {
        Self([0.5, 3.0])
    }

    /// x = c + (1 - c) cos wt with c = a/w^2, and its derivatives: rows of unknowns, columns of [w, a].
    fn exact(t: f64) -> Mat<f64> {
        let [a, w] = Self::new().0;
        let (c, cw, ca) = (a / (w * w), -2.0 * a / w.powi(3), 1.0 / (w * w));
        let (sin, cos) = (w * t).sin_cos();
        mat![
            [cw - cw * cos - (1.0 - c) * t * sin, ca - ca * cos],
            [cw * w * sin - (1.0 - c) * (sin + w * t * cos), ca * w * sin],
        ]
    }
}

impl Ode for Oscillator {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let [a, w] = self.0;
        ydot.copy_from_slice(&[y[1], a - w * w * y[0]]);
        Ok(())
    }

    fn root_count(&self) -> usize {
        1
    }

    fn roots(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        g[0] = y[0];
        Ok(())
    }

    fn sensitivity_rhs(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        parameter: usize,
        s: &[f64],
        sdot: &mut [f64],
    ) -> Result<(), Failure> {
        let [_, w] = self.0;
        let by_parameter = [1.0, -2.0 * w * y[0]][parameter];
        sdot.copy_from_slice(&[s[1], -w * w * s[0] + by_parameter]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.0
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.0.copy_from_slice(values);
    }
}

fn distance(a: MatRef<'_, f64>, b: &Mat<f64>) -> f64 {
    (a - b).norm_max()
}

#[test]
fn an_oscillator_in_its_frequency_by_every_method() {
    for method in METHODS {
        for source in SOURCES {
            let sensitivities = Sensitivities::of([1, 0]).method(method).source(source);
            let options = CvodeOptions::new(1e-8, 1e-10).sensitivities(sensitivities);
            let mut solver =
                Cvode::new(Oscillator::new(), 0.0, &Oscillator::START, &options).unwrap();
            // Roots go on working: the first zero of x.
            assert_eq!(solver.solve_to(5.0).unwrap(), Reached::Root);
            let root = (-0.5f64 / 8.5).acos() / 3.0;
            assert!((solver.t() - root).abs() < 1e-6);
            let at_root = distance(solver.sensitivities(), &Oscillator::exact(solver.t()));
            while solver.solve_to(5.0).unwrap() == Reached::Root {}
            let error = distance(solver.sensitivities(), &Oscillator::exact(5.0));
            let (start, end) = solver.last_step();
            let (middle, mut out) = ((start + end) / 2.0, Mat::zeros(2, 2));
            solver.interpolate_sensitivities(middle, 0, out.as_mut()).unwrap();
            let between = distance(out.as_ref(), &Oscillator::exact(middle));
            println!("{method:?} {source:?}: {at_root:e} {error:e} {between:e}");
            // Sensitivities grow to 15; their local errors of 1e-8 add up over some hundred steps.
            assert!(at_root < 2e-7 && error < 6e-6 && between < 6e-6);
            assert!(solver.statistics().sensitivity_evaluations > 0);
            // Put back to the last bit.
            assert_eq!(solver.system().0, Oscillator::new().0);
        }
    }
}

#[test]
fn new_starts_and_given_initial_sensitivities() {
    let options = CvodeOptions::new(1e-8, 1e-10).sensitivities(Sensitivities::of([1, 0]));
    let mut solver = Cvode::new(Oscillator::new(), 0.0, &Oscillator::START, &options).unwrap();
    solver.solve_to(0.5).unwrap();
    let (y, s) = (solver.y().to_vec(), solver.sensitivities().to_owned());
    assert!(solver.set_sensitivities(s.as_ref()).is_err(), "steps were taken");
    // From the middle, with what was there: the same as in one go.
    solver.reinit(0.5, &y).unwrap();
    assert_eq!(solver.sensitivities().norm_max(), 0.0);
    solver.set_sensitivities(s.as_ref()).unwrap();
    let mut out = Mat::zeros(2, 2);
    solver.interpolate_sensitivities(0.5, 0, out.as_mut()).unwrap();
    assert_eq!(out, s);
    while solver.solve_to(2.0).unwrap() == Reached::Root {}
    let error = distance(solver.sensitivities(), &Oscillator::exact(2.0));
    println!("{error:e}");
    assert!(error < 5e-7);
    // Derivatives by the start, which the equations do not know: the columns of the flow cos, sin / w.
    solver.reinit(0.0, &Oscillator::START).unwrap();
    let mut start = Oscillator::exact(0.0);
    start[(0, 1)] = 1.0;
    solver.set_sensitivities(start.as_ref()).unwrap();
    while solver.solve_to(2.0).unwrap() == Reached::Root {}
    let mut exact = Oscillator::exact(2.0);
    exact[(0, 1)] += 6f64.cos();
    exact[(1, 1)] -= 3.0 * 6f64.sin();
    assert!(distance(solver.sensitivities(), &exact) < 1e-6);
}

/// Robertson's reactions with their three rates as parameters.
#[derive(Clone)]
struct Reactions([f64; 3]);

impl Reactions {
    const START: [f64; 3] = [1.0, 0.0, 0.0];

    fn new() -> Self {
        Self([0.04, 1e4, 3e7])
    }

    /// dy/dp at t = 40, by the Radau IIA method of order 9 with 40 digits, of the state and its
    /// variational equations; 60 and 120 steps agree in 11 digits.
    #[rustfmt::skip]
    fn trusted() -> Mat<f64> {
        mat![
            [-4.247_558_771_705_7, 1.373_080_797_344_63e-5, -2.288_355_088_905_67e-9],
            [4.591_196_249_246_7e-5, -2.357_192_113_855_8e-10, -1.138_059_509_354_75e-13],
            [4.247_512_859_743_3, -1.373_057_225_423_49e-5, 2.288_468_894_856_61e-9],
        ]
    }
}

impl Ode for Reactions {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let [a, b, c] = self.0;
        ydot[0] = -a * y[0] + b * y[1] * y[2];
        ydot[2] = c * y[1] * y[1];
        ydot[1] = -ydot[0] - ydot[2];
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.0
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.0.copy_from_slice(values);
    }
}

impl Dae for Reactions {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, r)?;
        r[0] -= yp[0];
        r[1] -= yp[1];
        r[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    }

    fn sensitivity_residual(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        parameter: usize,
        s: &[f64],
        sp: &[f64],
        r: &mut [f64],
    ) -> Result<(), Failure> {
        let [a, b, c] = self.0;
        let [da, db, dc] = [0, 1, 2].map(|place| f64::from(u8::from(place == parameter)));
        let first = -a * s[0] + b * (s[1] * y[2] + y[1] * s[2]) - da * y[0] + db * y[1] * y[2];
        let third = 2.0 * c * y[1] * s[1] + dc * y[1] * y[1];
        r.copy_from_slice(&[first - sp[0], -first - third - sp[1], s[0] + s[1] + s[2]]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.0
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.0.copy_from_slice(values);
    }
}

/// Largest relative error of an entry.
fn relative(s: MatRef<'_, f64>, exact: &Mat<f64>) -> f64 {
    let entries = (0..s.nrows()).flat_map(|i| (0..s.ncols()).map(move |j| (i, j)));
    entries.map(|e| (s[e] / exact[e] - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn robertson_in_its_rates_as_ode_and_as_dae() {
    for method in METHODS {
        let sensitivities = Sensitivities::of([0, 1, 2]).method(method);
        let options = CvodeOptions::new(1e-8, [1e-12, 1e-16, 1e-12]).sensitivities(sensitivities);
        let mut solver = Cvode::new(Reactions::new(), 0.0, &Reactions::START, &options).unwrap();
        solver.solve_to(40.0).unwrap();
        let error = relative(solver.sensitivities(), &Reactions::trusted());
        println!("ODE {method:?}: {error:e}, {} steps", solver.statistics().steps);
        assert!(error < 5e-7);
    }
    // Differences of the algebraic equation, a sum, have rounding errors of 1e-12: they need looser tolerances, and
    // forward differences are of no use.
    for (method, source) in [METHODS[0], METHODS[1]]
        .into_iter()
        .flat_map(|method| [SOURCES[0], SOURCES[1]].map(|source| (method, source)))
    {
        let sensitivities = Sensitivities::of([0, 1, 2]).method(method).source(source);
        let supplied = source == SensitivitySource::Supplied;
        let (rtol, bound) = if supplied { (1e-8, 5e-7) } else { (1e-6, 5e-5) };
        let options = IdaOptions::new(rtol, [rtol * 1e-4, rtol * 1e-8, rtol * 1e-4])
            .differential([true, true, false])
            .sensitivities(sensitivities);
        let mut solver =
            Ida::new(Reactions::new(), 0.0, &Reactions::START, &[0.0; 3], &options).unwrap();
        // Finds y' and s'.
        solver.consistent_start(InitialCondition::Algebraic, 40.0).unwrap();
        solver.solve_to(40.0).unwrap();
        let error = relative(solver.sensitivities(), &Reactions::trusted());
        println!("DAE {method:?} {source:?}: {error:e}, {} steps", solver.statistics().steps);
        assert!(error < bound);
        let mut out = Mat::zeros(3, 3);
        let (start, _) = solver.last_step();
        solver.interpolate_sensitivities(start, 0, out.as_mut()).unwrap();
        // The algebraic equation holds for them, too.
        for j in 0..3 {
            let sum: f64 = (0..3).map(|i| out[(i, j)]).sum();
            assert!(sum.abs() < 1e-9 + 1e-6 * out[(0, j)].abs());
        }
        // Again, from given s and s' = df/dp.
        solver.reinit_with(0.0, &Reactions::START, &[-0.04, 0.04, 0.0]).unwrap();
        let mut sp = Mat::zeros(3, 3);
        (sp[(0, 0)], sp[(1, 0)]) = (-1.0, 1.0);
        solver.set_sensitivities_with(Mat::zeros(3, 3).as_ref(), sp.as_ref()).unwrap();
        solver.solve_to(40.0).unwrap();
        let error = relative(solver.sensitivities(), &Reactions::trusted());
        println!("    again: {error:e}");
        assert!(error < bound);
    }
}

/// HIRES with its constant input as parameter 0 and the light-driven rate as parameter 1.
fn hires() -> impl Ode {
    with_parameters(
        |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
            let exchange = p[1] * y[5] * y[7];
            ydot[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + p[0];
            ydot[1] = 1.71 * y[0] - 8.75 * y[1];
            ydot[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
            ydot[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
            ydot[4] = -1.745 * y[4] + 0.43 * (y[5] + y[6]);
            ydot[5] = -exchange + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
            ydot[6] = exchange - 1.81 * y[6];
            ydot[7] = -ydot[6];
            Ok(())
        },
        [0.0007, 280.0],
    )
}

#[test]
fn hires_in_two_of_its_rates() {
    // At t = 50, by the Radau IIA method of order 7 with 40 digits, of the state and its variational equations; 30 and
    // 60 steps agree in 8 digits.
    #[rustfmt::skip]
    let trusted = mat![
            [1.187_360_667_633, -4.412_485_755_210e-8],
            [0.231_918_738_671, -8.606_380_279_575e-9],
            [0.112_533_525_463, -8.714_993_709_516e-9],
            [1.885_861_418_525, -7.606_152_949_617e-8],
            [9.111_102_285_817, -1.567_228_790_808e-6],
            [37.421_655_548_508, -6.617_253_737_298e-6],
            [0.003_142_546_234, 1.961_784_659_265e-7],
            [-0.003_142_546_234, -1.961_784_659_265e-7],
        ];
    for sensitivities in [
        Sensitivities::of([0, 1]),
        Sensitivities::of([0, 1]).staggered(),
        Sensitivities::of([0, 1]).error_control(false),
    ] {
        let options = CvodeOptions::new(1e-8, 1e-12).sensitivities(sensitivities);
        let mut solver = Cvode::new(hires(), 0.0, &pliant::samples::Hires::Y0, &options).unwrap();
        solver.solve_to(50.0).unwrap();
        let error = relative(solver.sensitivities(), &trusted);
        println!("{error:e}, {} steps", solver.statistics().steps);
        assert!(error < 5e-7);
    }
}

#[test]
fn other_solvers_and_tolerances() {
    let run = |options: CvodeOptions| {
        let mut solver = Cvode::new(Oscillator::new(), 0.0, &Oscillator::START, &options).unwrap();
        while solver.solve_to(2.0).unwrap() == Reached::Root {}
        let error = distance(solver.sensitivities(), &Oscillator::exact(2.0));
        println!("{error:e}, {} steps", solver.statistics().steps);
        (error, solver.statistics().steps)
    };
    let sensitivities = Sensitivities::of([1, 0]);
    let options = CvodeOptions::new(1e-8, 1e-10).sensitivities(sensitivities.clone());
    assert!(run(options.clone().method(Multistep::Adams)).0 < 1e-6);
    let band = LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::DifferenceQuotients };
    assert!(run(options.clone().newton(band)).0 < 1e-6);
    // A parameter that counts for little needs fewer digits of its sensitivity.
    let coarse = run(options.clone().sensitivities(sensitivities.clone().scales([1e-3, 1e-3])));
    let fine = run(options.sensitivities(sensitivities.scales([1e3, 1e3])));
    assert!(coarse.1 < fine.1 && coarse.0 > fine.0, "{coarse:?} {fine:?}");
}

/// Without error control the state goes as without sensitivities, staggered.
#[test]
fn sensitivities_outside_the_error_control_leave_the_run_alone() {
    let options = CvodeOptions::new(1e-6, 1e-9);
    let sensitivities = Sensitivities::of([0]).staggered().error_control(false);
    let run = |options: CvodeOptions| {
        let mut solver = Cvode::new(Reactions::new(), 0.0, &Reactions::START, &options).unwrap();
        solver.solve_to(4.0).unwrap();
        (solver.y().to_vec(), solver.statistics().steps, solver.sensitivities().ncols())
    };
    let (without, with) = (run(options.clone()), run(options.sensitivities(sensitivities)));
    assert_eq!((&without.0, without.1), (&with.0, with.1));
    assert_eq!((without.2, with.2), (0, 1));
}

/// Decay whose right-hand side fails beyond t = 0.5 with any but its own parameter.
struct Touchy {
    p: [f64; 1],
    trouble: fn() -> Result<(), Failure>,
}

impl Ode for Touchy {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -self.p[0] * y[0];
        if t > 0.5 && self.p[0] != 0.7 { (self.trouble)() } else { Ok(()) }
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

#[test]
fn troubles_are_told_and_parameters_are_put_back() {
    for method in METHODS {
        let start = |trouble| {
            let options =
                CvodeOptions::new(1e-6, 1e-9).sensitivities(Sensitivities::of([0]).method(method));
            let mut solver =
                Cvode::new(Touchy { p: [0.7], trouble }, 0.0, &[1.0], &options).unwrap();
            solver.solve_to(0.3).unwrap();
            solver
        };
        let cause = |result| match result {
            Err(Error::Integration(error)) => error.cause,
            other => panic!("{other:?}"),
        };
        let mut solver = start(|| Err(Failure::Fatal("no".into())));
        assert_eq!(cause(solver.solve_to(2.0)), Cause::Fatal(Callback::Sensitivities));
        assert_eq!(solver.system().p, [0.7]);
        let (t, s) = (solver.t(), solver.sensitivities()[(0, 0)]);
        assert!((s + t * (-0.7 * t).exp()).abs() < 1e-4, "belongs to the state");

        let mut solver = start(|| Err(Failure::Recoverable("not here".into())));
        let cause = cause(solver.solve_to(2.0));
        let callback = Callback::Sensitivities;
        assert!(
            matches!(&cause, Cause::Rejected { callback: c, t, .. } if *c == callback && *t > 0.5),
            "{cause:?}"
        );
        assert_eq!(solver.system().p, [0.7]);

        let mut solver = start(|| panic!("sabotage"));
        let panic = catch_unwind(AssertUnwindSafe(|| solver.solve_to(2.0))).unwrap_err();
        assert_eq!(*panic.downcast_ref::<&str>().unwrap(), "sabotage");
        assert_eq!(solver.system().p, [0.7]);
    }
}

#[test]
fn unusable_input_is_named() {
    let refused = |options: CvodeOptions| match Cvode::new(
        Reactions::new(),
        0.0,
        &Reactions::START,
        &options,
    ) {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let options = CvodeOptions::new(1e-6, 1e-9);
    let with = |sensitivities| options.clone().sensitivities(sensitivities);
    assert!(refused(with(Sensitivities::of([]))).contains("parameters of sensitivities"));
    assert!(refused(with(Sensitivities::of([3]))).contains("3 parameters"));
    assert!(refused(with(Sensitivities::of([0]).scales([1.0, 1.0]))).contains("scales"));
    assert!(refused(with(Sensitivities::of([0]).scales([-1.0]))).contains("-1"));
    let sensitivities = Sensitivities::of([0]);
    assert!(refused(with(sensitivities.clone()).fixed_point(2)).contains("Newton"));
    assert!(
        refused(with(sensitivities.clone()).newton(LinearSolver::Custom)).contains("newton_rhs")
    );
    let one_by_one = sensitivities.clone().method(SensitivityMethod::StaggeredOneByOne);
    let dae = IdaOptions::new(1e-6, 1e-9).sensitivities(one_by_one);
    assert!(Ida::new(Reactions::new(), 0.0, &[1.0, 0.0, 0.0], &[0.0; 3], &dae).is_err());

    // Differences can not see a parameter that does not change.
    struct Stubborn;
    impl Ode for Stubborn {
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = -y[0];
            Ok(())
        }

        fn parameters(&self) -> &[f64] {
            &[1.0]
        }
    }
    let error = Cvode::new(Stubborn, 0.0, &[1.0], &with(sensitivities.clone())).unwrap_err();
    assert!(error.to_string().contains("set_parameters"), "{error}");

    let mut solver =
        Cvode::new(Reactions::new(), 0.0, &Reactions::START, &with(sensitivities)).unwrap();
    let mut wrong = Mat::zeros(3, 2);
    assert!(solver.interpolate_sensitivities(0.0, 0, wrong.as_mut()).is_err());
    assert!(solver.set_sensitivities(wrong.as_ref()).is_err());
    wrong = Mat::from_fn(3, 1, |_, _| f64::NAN);
    assert!(solver.set_sensitivities(wrong.as_ref()).is_err());
}
