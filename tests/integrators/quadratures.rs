//! Integrals beside the run, against closed forms.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pliant::{
    ode::{Dae, Failure, Ode},
    sundials::{Callback, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions, Integrator, Reached},
};

/// y' = -y, z with z = y as an algebraic unknown of the DAE, and the integrals of y and of y^2.
#[derive(Default)]
struct Decay {
    /// The integrands beyond t = 0.5.
    trouble: Option<fn() -> Result<(), Failure>>,
}

impl Ode for Decay {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -y[0];
        Ok(())
    }

    fn root_count(&self) -> usize {
        1
    }

    fn roots(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        g[0] = y[0] - 0.75;
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        if let Some(trouble) = self.trouble.filter(|_| t > 0.5) {
            trouble()?;
        }
        qdot.copy_from_slice(&[y[0], y[0] * y[0]]);
        Ok(())
    }
}

impl Dae for Decay {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        r.copy_from_slice(&[yp[0] + y[1], y[1] - y[0]]);
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    /// The same integrals, by the derivative and by the algebraic unknown.
    fn quadratures(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        qdot.copy_from_slice(&[-yp[0], y[1] * y[1]]);
        Ok(())
    }
}

/// The integrals of e^-t and e^-2t from 0 to t.
fn exact(t: f64) -> [f64; 2] {
    [1.0 - (-t).exp(), (1.0 - (-2.0 * t).exp()) / 2.0]
}

fn error(q: &[f64], t: f64) -> f64 {
    q.iter().zip(exact(t)).map(|(q, exact)| (q - exact).abs()).fold(0.0, f64::max)
}

#[test]
fn integrals_at_outputs_at_roots_and_between() {
    for options in [
        CvodeOptions::new(1e-8, 1e-10),
        CvodeOptions::new(1e-8, 1e-10).quadrature_tolerances(1e-8, [1e-10, 1e-10]),
    ] {
        let mut solver = Cvode::new(Decay::default(), 0.0, &[1.0], &options).unwrap();
        assert_eq!(solver.quadratures(), [0.0; 2]);
        assert_eq!(solver.solve_to(2.0).unwrap(), Reached::Root);
        let root = solver.t();
        println!("{:e} at the root", error(solver.quadratures(), root));
        // Local errors of 1e-8 add up to some thirty times as much.
        assert!(error(solver.quadratures(), root) < 1e-6);
        solver.solve_to(2.0).unwrap();
        println!("{:e} at the end", error(solver.quadratures(), 2.0));
        assert!(error(solver.quadratures(), 2.0) < 1e-6);

        let (start, end) = solver.last_step();
        let (middle, mut q) = ((start + end) / 2.0, [0.0; 2]);
        solver.interpolate_quadratures(middle, 0, &mut q).unwrap();
        assert!(error(&q, middle) < 1e-6);
        solver.interpolate_quadratures(middle, 1, &mut q).unwrap();
        let slopes = [(-middle).exp(), (-2.0 * middle).exp()];
        // The derivative of the polynomial loses a digit or two.
        assert!(q.iter().zip(slopes).all(|(q, slope)| (q - slope).abs() < 1e-5), "{q:?}");

        // A new start counts from zero.
        solver.reinit(0.0, &[1.0]).unwrap();
        assert_eq!(solver.quadratures(), [0.0; 2]);
        solver.interpolate_quadratures(0.0, 0, &mut q).unwrap();
        assert_eq!(q, [0.0; 2]);
        solver.solve_to(2.0).unwrap();
        assert!(error(solver.quadratures(), solver.t()) < 1e-6);
        assert!(solver.statistics().quadrature_evaluations > 0);
    }
}

#[test]
fn integrals_of_a_dae_know_its_derivatives() {
    let options = IdaOptions::new(1e-8, 1e-10).quadrature_tolerances(1e-8, 1e-10);
    let mut solver = Ida::new(Decay::default(), 0.0, &[1.0, 1.0], &[-1.0, -1.0], &options).unwrap();
    solver.solve_to(2.0).unwrap();
    println!("{:e}", error(solver.quadratures(), 2.0));
    assert!(error(solver.quadratures(), 2.0) < 1e-6);
    let mut q = [0.0; 2];
    let (start, _) = solver.last_step();
    solver.interpolate_quadratures(start, 0, &mut q).unwrap();
    assert!(error(&q, start) < 1e-6);
    solver.reinit_with(0.0, &[1.0, 1.0], &[-1.0, -1.0]).unwrap();
    assert_eq!(solver.quadratures(), [0.0; 2]);
    solver.solve_to(1.0).unwrap();
    assert!(error(solver.quadratures(), 1.0) < 1e-6);
}

/// An integrand that the solution does not show: a pulse, whose integral is sqrt(pi)/20.
#[test]
fn error_control_finds_what_the_unknowns_do_not_show() {
    struct Pulse;
    impl Ode for Pulse {
        fn rhs(&mut self, _t: f64, _y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = 1e-3;
            Ok(())
        }

        fn quadrature_count(&self) -> usize {
            1
        }

        fn quadratures(&mut self, t: f64, _y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
            qdot[0] = (-(20.0 * (t - 1.0)).powi(2)).exp();
            Ok(())
        }
    }
    let run = |options: CvodeOptions| {
        let mut solver = Cvode::new(Pulse, 0.0, &[0.0], &options.max_step(0.2)).unwrap();
        solver.solve_to(2.0).unwrap();
        let exact = std::f64::consts::PI.sqrt() / 20.0;
        (solver.quadratures()[0] - exact).abs()
    };
    let options = CvodeOptions::new(1e-6, 1e-9);
    let own = run(options.clone().quadrature_tolerances(1e-6, 1e-9));
    let (without, with) = (run(options.clone().quadrature_error_control(false)), run(options));
    println!("{without:e} {with:e}");
    assert_eq!(own, with, "those of the unknowns, by default");
    assert!(without > 1e-3 && with < 1e-5);
}

/// Steps and digits are those of the run without integrals, unless these take part in the error control.
#[test]
fn integrals_do_not_change_the_run() {
    let options = CvodeOptions::new(1e-6, 1e-9);
    let uncontrolled = options.clone().quadrature_error_control(false);
    let mut with = Cvode::new(Decay::default(), 0.0, &[1.0], &uncontrolled).unwrap();
    let plain = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let mut without = Cvode::new(plain, 0.0, &[1.0], &options).unwrap();
    assert_eq!(with.solve_to(5.0).unwrap(), Reached::Root);
    with.solve_to(5.0).unwrap();
    without.solve_to(5.0).unwrap();
    assert_eq!(with.y(), without.y());
    assert_eq!(with.statistics().steps, without.statistics().steps);
    assert!(without.quadratures().is_empty());
    without.interpolate_quadratures(5.0, 0, &mut []).unwrap();
}

#[test]
fn troubles_of_integrands_are_told() {
    let run = |trouble: fn() -> Result<(), Failure>| {
        let system = Decay { trouble: Some(trouble) };
        let mut solver = Cvode::new(system, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9)).unwrap();
        solver.solve_to(0.4).unwrap();
        (solver.solve_to(2.0), solver)
    };
    let cause = |result| match result {
        Err(Error::Integration(error)) => error.cause,
        other => panic!("{other:?}"),
    };
    let (result, solver) = run(|| Err(Failure::Fatal("no".into())));
    assert_eq!(cause(result), Cause::Fatal(Callback::Quadratures));
    // What is left belongs to the time that was reached.
    assert!(solver.t() > 0.3 && error(solver.quadratures(), solver.t()) < 1e-5);
    let (result, _) = run(|| Err(Failure::Recoverable("not here".into())));
    assert!(
        matches!(cause(result), Cause::Rejected { callback: Callback::Quadratures, t, .. } if t > 0.5)
    );
    let caught = catch_unwind(AssertUnwindSafe(|| run(|| panic!("sabotage"))));
    assert_eq!(*caught.map(drop).unwrap_err().downcast_ref::<&str>().unwrap(), "sabotage");
}

#[test]
fn unusable_input_is_named() {
    let refused = |options: CvodeOptions| match Cvode::new(Decay::default(), 0.0, &[1.0], &options)
    {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let options = CvodeOptions::new(1e-6, 1e-9);
    assert!(refused(options.clone().quadrature_tolerances(-1e-6, 1e-9)).contains("rtol"));
    assert!(refused(options.clone().quadrature_tolerances(1e-6, 0.0)).contains("atol"));
    assert!(refused(options.clone().quadrature_tolerances(1e-6, [1e-9; 3])).contains("2"));
    let plain = |_t: f64, _y: &[f64], _ydot: &mut [f64]| Ok(());
    let options = options.quadrature_tolerances(1e-6, 1e-9);
    assert!(Cvode::new(plain, 0.0, &[1.0], &options).is_err());
    let mut solver =
        Cvode::new(Decay::default(), 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9)).unwrap();
    assert!(solver.interpolate_quadratures(0.0, 0, &mut [0.0]).is_err());
    assert!(solver.interpolate_quadratures(1.0, 0, &mut [0.0; 2]).is_err());
    assert!(solver.interpolate_quadratures(0.0, 1, &mut [0.0; 2]).is_err());
}
