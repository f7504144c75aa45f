//! States that are put onto the invariants of their equations after each step.

use pliant::{
    InputError,
    ode::{Failure, Ode},
    samples::Pendulum,
    sundials::{Callback, Cause, Cvode, CvodeOptions, Error, Integrator, Multistep, Statistics},
};

/// Largest drift of the length at the ends of steps in ten periods, error at the end, and statistics.
fn swing(options: &CvodeOptions) -> (f64, f64, Statistics) {
    let mut solver = Cvode::new(Pendulum, 0.0, &Pendulum::Y0, options).unwrap();
    let end = 10.0 * Pendulum::PERIOD;
    solver.set_stop_time(Some(end)).unwrap();
    let mut drift = 0.0_f64;
    while solver.t() < end {
        solver.step(end).unwrap();
        drift = drift.max((solver.y()[0].hypot(solver.y()[1]) - 1.0).abs());
    }
    let error = solver.y().iter().zip(Pendulum::Y0).map(|(y, y0)| (y - y0).abs());
    let error = error.fold(0.0, f64::max);
    let statistics = solver.statistics();
    println!("drift {drift:.1e}, error {error:.1e}, {} steps", statistics.steps);
    (drift, error, statistics)
}

#[test]
fn a_projected_pendulum_keeps_its_length_and_more_of_its_period() {
    for (rtol, bound) in [(1e-5, 0.1), (1e-7, 4e-3)] {
        let options = CvodeOptions::new(rtol, rtol);
        let (drift, error, free) = swing(&options);
        let (projected_drift, projected_error, projected) = swing(&options.project());
        // to rounding, where the free pendulum is off by many tolerances
        assert!(projected_drift < 1e-15 && drift > 100.0 * rtol);
        assert!(projected_error < bound && projected_error < 0.5 * error);
        assert!(projected.steps < free.steps);
    }
}

/// A decay whose projection does as it is told.
struct Told(fn(f64, &mut [f64]) -> Result<(), Failure>);

impl Ode for Told {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -y[0];
        Ok(())
    }

    fn project(
        &mut self,
        t: f64,
        _y: &[f64],
        correction: &mut [f64],
        _error: &mut [f64],
    ) -> Result<(), Failure> {
        assert_eq!(correction, [0.0]);
        self.0(t, correction)
    }
}

fn decay(project: fn(f64, &mut [f64]) -> Result<(), Failure>) -> Result<f64, Error> {
    let options = CvodeOptions::new(1e-6, 1e-9).project();
    let mut solver = Cvode::new(Told(project), 0.0, &[1.0], &options)?;
    solver.solve_to(1.0)?;
    Ok(solver.y()[0])
}

#[test]
fn projections_that_fail_are_named() {
    let cause = |result: Result<f64, Error>| match result {
        Err(Error::Integration(error)) => {
            println!("{error}");
            error.cause
        }
        other => panic!("{other:?} is not an integration error"),
    };
    let fatal = cause(decay(|_, _| Err(std::io::Error::other("no space").into())));
    assert_eq!(fatal, Cause::Fatal(Callback::Projection));
    let rejected = cause(decay(|_, _| Err(Failure::Recoverable("too far".into()))));
    assert!(matches!(rejected, Cause::Rejected { callback: Callback::Projection, .. }));
    let lost = cause(decay(|_, correction| {
        correction[0] = f64::NAN;
        Ok(())
    }));
    assert!(matches!(lost, Cause::NotFinite { callback: Callback::Projection, .. }));

    let nothing = decay(|_, _| Ok(())).unwrap();
    assert!((nothing - (-1f64).exp()).abs() < 2e-6);
    let options = CvodeOptions::new(1e-6, 1e-9).project();
    let without = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let mut solver = Cvode::new(without, 0.0, &[1.0], &options).unwrap();
    let Err(Error::Integration(error)) = solver.solve_to(1.0) else { panic!() };
    assert!(error.source.unwrap().to_string().contains("`project`"));
    let adams = options.method(Multistep::Adams);
    match Cvode::new(without, 0.0, &[1.0], &adams) {
        Err(Error::Input(InputError { input, .. })) => assert_eq!(input, "project"),
        other => panic!("{other:?} is not an input error"),
    }
}
