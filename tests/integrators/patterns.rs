//! Sparsity patterns that are found by asking the equations.

use pliant::{
    InputError,
    ode::{Failure, Ode},
    samples::{Hires, Robertson, VanDerPol},
    sundials::{Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver, Pattern},
};

#[test]
fn samples_have_the_patterns_that_they_declare() {
    let mut hires = Hires::new();
    let declared = hires.pattern().clone();
    assert_eq!(Pattern::ode_by_nan(&mut hires, 0.0, &Hires::Y0).unwrap(), declared);
    let sampled = Pattern::ode_by_sampling(&mut hires, 0.0, &Hires::Y0, &[0.1; 8], 2).unwrap();
    assert_eq!(sampled, declared);

    let mut van_der_pol = VanDerPol::new();
    let declared = van_der_pol.pattern().clone();
    assert_eq!(Pattern::ode_by_nan(&mut van_der_pol, 0.0, &VanDerPol::Y0).unwrap(), declared);

    // the conservation that is the third equation of the DAE, and none of the ODE, fills the last row
    let mut robertson = Robertson::new();
    let (y, yp) = (&Robertson::Y0, &Robertson::YP0);
    let declared = robertson.pattern().clone();
    assert_eq!(Pattern::dae_by_nan(&mut robertson, 0.0, y, yp).unwrap(), declared);
    let spreads = (&[1e-2, 1e-4, 1e-2][..], &[1.0; 3][..]);
    let sampled = Pattern::dae_by_sampling(&mut robertson, 0.0, (y, yp), spreads, 1).unwrap();
    assert_eq!(sampled, declared);
    let ode = Pattern::ode_by_nan(&mut robertson, 0.0, y).unwrap();
    assert_eq!((ode.entry_count(), ode.position(2, 0)), (8, None));
}

/// y' alone in an equation is an entry, too, as is a term that is zero at the point.
#[test]
fn slopes_and_vanishing_terms_are_found() {
    let mut dae = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[yp[1] + y[0], y[1] * y[2], yp[2] - y[2]]);
        Ok(())
    };
    let expected = Pattern::from_entries(3, [(0, 1), (1, 2)]).unwrap();
    let zeros = [0.0; 3];
    assert_eq!(Pattern::dae_by_nan(&mut dae, 0.0, &zeros, &zeros).unwrap(), expected);
    let spreads = (&[1.0; 3][..], &[1.0; 3][..]);
    let sampled = Pattern::dae_by_sampling(&mut dae, 0.0, (&zeros, &zeros), spreads, 1).unwrap();
    assert_eq!(sampled, expected);
}

/// `f64::max` swallows NaN: the documented trap, which sampling finds, as it does both branches.
#[test]
fn sampling_finds_what_swallows_nan() {
    let mut contact = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        ydot[1] = -(y[0] - 1.0).max(0.0) + if y[2] > 0.5 { y[3] } else { 0.0 };
        ydot[2] = -y[2];
        ydot[3] = y[0].max(y[3]);
        Ok(())
    };
    let y = [1.0, 0.0, 0.5, 1.0];
    let trapped = Pattern::ode_by_nan(&mut contact, 0.0, &y).unwrap();
    assert_eq!(trapped, Pattern::from_entries(4, []).unwrap());
    let found = Pattern::ode_by_sampling(&mut contact, 0.0, &y, &[0.1; 4], 20).unwrap();
    let all = [(1, 0), (1, 2), (1, 3), (3, 0)];
    assert_eq!(found, Pattern::from_entries(4, all).unwrap());
    // a point that no switch is near to knows one branch alone
    let far = Pattern::ode_by_sampling(&mut contact, 0.0, &[0.5, 0.0, 0.1, 2.0], &[0.1; 4], 20);
    assert_eq!(far.unwrap(), Pattern::from_entries(4, []).unwrap());
}

#[test]
fn what_has_no_pattern_is_named() {
    type Rhs = fn(f64, &[f64], &mut [f64]) -> Result<(), Failure>;
    let root: Rhs = |_, y, ydot| {
        ydot.copy_from_slice(&[y[0], (y[1] - 1.0).sqrt()]);
        Ok(())
    };
    let refusing: Rhs = |_, y, ydot| {
        if y[0] <= 0.0 || y[0].is_nan() {
            return Err(Failure::Recoverable(format!("no pressure of {}", y[0])));
        }
        ydot.copy_from_slice(y);
        Ok(())
    };
    let named = |result: Result<Pattern, InputError>, words: [&str; 2]| {
        let error = result.unwrap_err().to_string();
        println!("{error}");
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let nan = |mut rhs: Rhs, y: [f64; 2]| Pattern::ode_by_nan(&mut rhs, 0.0, &y);
    named(nan(root, [0.0, 0.5]), ["component 1", "NaN"]);
    named(nan(root, [f64::NAN, 2.0]), ["y", "NaN"]);
    named(nan(refusing, [-1.0, 0.0]), ["at the point", "no pressure of -1"]);
    named(nan(refusing, [1.0, 0.0]), ["NaN for unknown 0", "sampling"]);
    let sampling = |mut rhs: Rhs, y: [f64; 2], spread: &[f64], points| {
        Pattern::ode_by_sampling(&mut rhs, 0.0, &y, spread, points)
    };
    named(sampling(refusing, [0.1, 0.0], &[1.0; 2], 20), ["no pressure of -", "smaller spread"]);
    named(sampling(root, [0.0, 1.5], &[1.0; 2], 20), ["component 1", "smaller spread"]);
    named(sampling(root, [0.0, 2.0], &[0.1], 1), ["length of spread", "2"]);
    named(sampling(root, [0.0, 2.0], &[0.1, 0.0], 1), ["spread", "positive"]);
    named(sampling(root, [0.0, 2.0], &[0.1; 2], 0), ["points", "1"]);
    assert!(sampling(refusing, [2.0, 0.0], &[1.0; 2], 3).is_ok());
}

/// From equations alone to a sparse run: nobody has written a pattern or a Jacobian.
#[test]
fn a_pattern_that_was_found_drives_klu() {
    let mut system = Hires::new();
    let pattern = Pattern::ode_by_nan(&mut system, 0.0, &Hires::Y0).unwrap();
    let klu = LinearSolver::Klu { pattern, jacobian: Jacobian::DifferenceQuotients };
    let options = CvodeOptions::new(1e-8, 1e-12).newton(klu);
    let equations = |t: f64, y: &[f64], ydot: &mut [f64]| system.rhs(t, y, ydot);
    let mut solver = Cvode::new(equations, 0.0, &Hires::Y0, &options).unwrap();
    solver.solve_to(Hires::REFERENCE.t).unwrap();
    let error = Hires::REFERENCE.error(solver.y());
    assert!(error < 2e-6, "{error}");
}
