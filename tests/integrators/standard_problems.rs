//! Standard problems against trusted digits and closed forms: how the error follows the tolerance.

use pliant::{
    ode::{Ode, with_mass},
    rk::{self, DormandPrince},
    samples::{
        Brusselator, CarAxis, DampedOscillator, HeatedSquare, Hires, Oregonator, Pendulum,
        Pollution, Reference, Robertson, TransistorAmplifier, VanDerPol,
    },
    sundials::{
        Arkode, ArkodeOptions, Cvode, CvodeOptions, Ida, IdaOptions, Integrator, Jacobian, Krylov,
        KrylovMethod, LinearSolver, MassForm, Preconditioner, Side,
    },
};

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);
const QUOTIENTS: LinearSolver = LinearSolver::Dense(Jacobian::DifferenceQuotients);

const RTOLS: [f64; 3] = [1e-4, 1e-6, 1e-8];

/// Errors in multiples of the tolerance are at most `bound`, and fall over all tolerances by at least two of the
/// four decades of the tolerance. (Errors at single tolerances may be smaller by chance.)
fn check(name: &str, bound: f64, mut error: impl FnMut(f64) -> f64) {
    let errors = RTOLS.map(&mut error);
    let multiples = [0, 1, 2].map(|k| errors[k] / RTOLS[k]);
    println!("{name}: {multiples:.2?} times rtol");
    assert!(multiples.iter().all(|multiple| *multiple < bound), "{name}: {multiples:.1?} rtol");
    assert!(errors[2] < 1e-2 * errors[0], "{name}: {errors:?}");
}

fn end(mut solver: impl Integrator, t: f64) -> Vec<f64> {
    solver.solve_to(t).unwrap();
    solver.y().to_vec()
}

/// An ODE by all methods; bounds are of CVODE, ARKODE and IDA. Absolute tolerances are the relative one times the end state.
fn check_ode<S: Ode + Clone>(
    name: &str,
    system: &S,
    y0: &[f64],
    Reference { t, y, .. }: Reference,
    bounds: [f64; 3],
) {
    let atol = |rtol: f64| y.iter().map(|y| rtol * y.abs()).collect::<Vec<_>>();
    let error = |found: Vec<f64>| {
        found.iter().zip(y).map(|(found, y)| (found / y - 1.0).abs()).fold(0.0, f64::max)
    };
    for newton in [DENSE, QUOTIENTS] {
        check(&format!("{name}, CVODE"), bounds[0], |rtol| {
            let options = CvodeOptions::new(rtol, atol(rtol)).newton(newton.clone());
            error(end(Cvode::new(system.clone(), 0.0, y0, &options).unwrap(), t))
        });
        check(&format!("{name}, ARKODE"), bounds[1], |rtol| {
            let options = ArkodeOptions::new(rtol, atol(rtol)).newton(newton.clone());
            error(end(Arkode::new(system.clone(), 0.0, y0, &options).unwrap(), t))
        });
    }
    let mut slope = vec![0.0; y0.len()];
    system.clone().rhs(0.0, y0, &mut slope).unwrap();
    check(&format!("{name}, IDA"), bounds[2], |rtol| {
        let system = with_mass(system.clone(), vec![1.0; y0.len()]);
        let system = MassForm::new(system, y0.len(), &DENSE).unwrap();
        let options = IdaOptions::new(rtol, atol(rtol)).newton(DENSE);
        error(end(Ida::new(system, 0.0, y0, &slope, &options).unwrap(), t))
    });
}

#[test]
fn hires() {
    check_ode("HIRES", &Hires::new(), &Hires::Y0, Hires::REFERENCE, [300.0, 400.0, 80.0]);
}

#[test]
fn robertson() {
    check_ode("ROBER", &Robertson::new(), &Robertson::Y0, Robertson::REFERENCE, [25.0, 7.0, 9.0]);
}

#[test]
fn van_der_pol() {
    check_ode(
        "VDPOL",
        &VanDerPol::new(),
        &VanDerPol::Y0,
        VanDerPol::REFERENCE,
        [100.0, 100.0, 35.0],
    );
}

#[test]
fn oregonator() {
    check_ode(
        "OREGO",
        &Oregonator::new(),
        &Oregonator::Y0,
        Oregonator::REFERENCE,
        [3200.0, 150.0, 2000.0],
    );
}

#[test]
fn pollution() {
    check_ode("POLLU", &Pollution::new(), &Pollution::Y0, Pollution::REFERENCE, [20.0, 60.0, 15.0]);
}

#[test]
fn brusselator() {
    let system = Brusselator::new(20);
    let y0 = system.y0();
    check_ode("BRUSS", &system, &y0, Brusselator::REFERENCE_20, [25.0, 35.0, 18.0]);
}

/// Of order 3: at higher ones IDA falls into steps of order 1 now and then that fail every other time, for the rest of the run
/// (at 1e-8 it fails 69 315 times in 81 683 steps of up to order 5, 660 times in 19 866 of up to order 3).
#[test]
fn transistor_amplifier() {
    let Reference { t, y, .. } = TransistorAmplifier::REFERENCE;
    let (y0, slope) = (TransistorAmplifier::Y0, TransistorAmplifier::YP0);
    for newton in [DENSE, QUOTIENTS] {
        check("TRANSAMP, IDA", 80.0, |rtol| {
            let system = MassForm::new(TransistorAmplifier, 8, &newton).unwrap();
            let atol: Vec<f64> = y.iter().map(|y| rtol * y.abs()).collect();
            let options = IdaOptions::new(rtol, atol).newton(newton.clone()).max_order(3);
            let found = end(Ida::new(system, 0.0, &y0, &slope, &options).unwrap(), t);
            TransistorAmplifier::REFERENCE.error(&found)
        });
    }
}

/// The Runge-Kutta method, with `error` of the end state.
fn check_explicit<S: Ode + Clone>(
    name: &str,
    bound: f64,
    system: &S,
    y0: &[f64],
    t: f64,
    atol: impl Fn(f64) -> Vec<f64>,
    error: impl Fn(&[f64]) -> f64,
) {
    check(&format!("{name}, Dormand-Prince"), bound, |rtol| {
        let options = rk::Options::new(rtol, atol(rtol));
        error(&end(DormandPrince::new(system.clone(), 0.0, y0, &options).unwrap(), t))
    });
}

#[test]
fn by_runge_kutta() {
    let largest = |found: &[f64], exact: &[f64]| {
        found.iter().zip(exact).fold(0.0_f64, |error, (y, exact)| error.max((y - exact).abs()))
    };
    let even = |n| move |rtol| vec![rtol; n];

    let (y0, t) = (Pendulum::Y0, Pendulum::PERIOD);
    check_explicit("pendulum", 45.0, &Pendulum, &y0, t, even(4), |y| largest(y, &y0));

    let (oscillator, t) = (DampedOscillator { damping: 0.1 }, 20.0);
    let exact = oscillator.state(t);
    check_explicit("oscillator", 5.0, &oscillator, &DampedOscillator::Y0, t, even(2), |y| {
        largest(y, &exact)
    });

    // stiff: stability limits the steps
    let Reference { t, y, .. } = Hires::REFERENCE;
    let atol = |rtol: f64| y.iter().map(|y| rtol * y.abs()).collect();
    check_explicit("HIRES", 2.5, &Hires::new(), &Hires::Y0, t, atol, |y| Hires::REFERENCE.error(y));
}

fn car_axis(alpha: f64, rtol: f64) -> Ida<CarAxis> {
    let atol: Vec<f64> = CarAxis::REFERENCE.y.iter().map(|y| rtol * y.abs()).collect();
    let options = IdaOptions::new(rtol, atol).differential(CarAxis::DIFFERENTIAL);
    Ida::new(CarAxis { alpha }, 0.0, &CarAxis::Y0, &CarAxis::YP0, &options).unwrap()
}

/// Whatever alpha is: the exact solution does not depend on it.
#[test]
fn the_car_axis() {
    for alpha in [1.0, 10.0] {
        check(&format!("CARAXIS, IDA, alpha {alpha}"), 650.0, |rtol| {
            CarAxis::REFERENCE.error(&end(car_axis(alpha, rtol), CarAxis::REFERENCE.t))
        });
    }
}

/// Until t = 3 and from t = 27 until 30.
#[test]
fn the_constraints_of_the_car_axis_drift_without_alpha_alone() {
    let drifts = [0.0, 10.0].map(|alpha| {
        let mut solver = car_axis(alpha, 1e-7);
        let mut largest = |times: std::ops::Range<i32>| {
            times.fold(0.0_f64, |largest, tenths| {
                let t = 0.1 * f64::from(tenths + 1);
                solver.solve_to(t).unwrap();
                CarAxis::constraints(t, solver.y()).iter().fold(largest, |a, g| a.max(g.abs()))
            })
        };
        (largest(0..30), largest(270..300))
    });
    println!("{drifts:?}");
    let [without, with] = drifts;
    assert!(without.1 > 5.0 * without.0, "{drifts:?}");
    assert!(with.0 < 5e-8 && with.1 < 5e-8, "{drifts:?}");
}

/// 10^4 unknowns, by KLU and by GMRES with an incomplete factorization, against the closed form of the same discrete
/// equations.
#[test]
fn heated_square() {
    let system = HeatedSquare::new(100);
    let (y0, exact) = (system.exact(0.0), system.exact(0.1));
    let (pattern, jacobian) = (system.pattern(), Jacobian::Supplied);
    let ilu = Preconditioner::Ilu { pattern: pattern.clone(), jacobian };
    let gmres = Krylov::new(KrylovMethod::Gmres { dimension: 20, restarts: 2 });
    for newton in [
        LinearSolver::Klu { pattern: pattern.clone(), jacobian },
        LinearSolver::Krylov(gmres.preconditioner(Side::Left, ilu)),
    ] {
        for (rtol, bound) in [(1e-4, 45.0), (1e-6, 20.0)] {
            let options = CvodeOptions::new(rtol, rtol * 0.05).newton(newton.clone());
            let y = end(Cvode::new(system.clone(), 0.0, &y0, &options).unwrap(), 0.1);
            let errors = y.iter().zip(&exact).map(|(y, exact)| (y / exact - 1.0).abs());
            let multiple = errors.fold(0.0, f64::max) / rtol;
            println!("heat: {multiple:.2}");
            assert!(multiple < bound, "{multiple}");
        }
    }
}
