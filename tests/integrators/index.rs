//! DAEs of an index that IDA cannot take, and those that it can.

use std::fmt::Debug;

use pliant::{
    ode::{Dae, Failure, with_mass},
    samples::{Pendulum, Robertson},
    sundials::{
        Cause, Error, Ida, IdaOptions, InitialCondition, Integrator, Jacobian, LinearSolver,
        MassForm,
    },
};

const G: f64 = Pendulum::GRAVITY;

/// The pendulum with its constraint on positions (index 3), velocities (2) or accelerations (1).
fn pendulum(index: u32) -> impl Dae {
    move |_t: f64, s: &[f64], sp: &[f64], r: &mut [f64]| {
        let &[x, y, vx, vy, tension] = s else { unreachable!("five unknowns") };
        r[..4].copy_from_slice(&[
            sp[0] - vx,
            sp[1] - vy,
            sp[2] + tension * x,
            sp[3] + tension * y + G,
        ]);
        r[4] = match index {
            3 => x * x + y * y - 1.0,
            2 => x * vx + y * vy,
            _ => vx * vx + vy * vy - G * y - tension * (x * x + y * y),
        };
        Ok(())
    }
}

fn cause<T: Debug>(result: Result<T, Error>) -> Cause {
    match result {
        Err(Error::Integration(error)) => {
            println!("{error}");
            error.cause
        }
        other => panic!("{other:?} is not an integration error"),
    }
}

fn ida<S: Dae>(system: S, y0: &[f64], yp0: &[f64]) -> Ida<S> {
    Ida::new(system, 0.0, y0, yp0, &IdaOptions::new(1e-6, 1e-8)).unwrap()
}

#[test]
fn a_pendulum_is_accepted_by_its_accelerations_alone() {
    // somewhere on its way, and where it starts
    let y = [0.6, -0.8, 0.8, 0.6, 1.0 + 0.8 * G];
    for (index, y0) in [(3, y), (2, y), (1, y), (3, Pendulum::DAE_Y0), (2, Pendulum::DAE_Y0)] {
        let mut solver = ida(pendulum(index), &y0, &Pendulum::DAE_YP0);
        match index {
            1 => solver.check_index().unwrap(),
            _ => assert_eq!(cause(solver.check_index()), Cause::HigherIndex { unknown: 4 }),
        }
    }
    let mut solver = ida(Pendulum, &Pendulum::DAE_Y0, &Pendulum::DAE_YP0);
    solver.check_index().unwrap();
    solver.solve_to(1.0).unwrap();
    solver.check_index().unwrap();
}

/// The same in units of its own for each unknown and each equation.
#[test]
fn units_do_not_matter() {
    let units = [1e3, 1e-4, 1e5, 1e-2, 1e-6];
    for index in [1, 2, 3] {
        let mut inner = pendulum(index);
        let system = move |t: f64, s: &[f64], sp: &[f64], r: &mut [f64]| {
            let scaled =
                |v: &[f64]| -> Vec<f64> { v.iter().zip(units).map(|(v, u)| v * u).collect() };
            inner.residual(t, &scaled(s), &scaled(sp), r)?;
            r.iter_mut().zip(units).for_each(|(r, unit)| *r *= unit * unit);
            Ok(())
        };
        let y = [0.6, -0.8, 0.8, 0.6, 1.0 + 0.8 * G];
        let y0: Vec<f64> = y.iter().zip(units).map(|(y, unit)| y / unit).collect();
        let mut solver = ida(system, &y0, &[0.0; 5]);
        match index {
            1 => solver.check_index().unwrap(),
            _ => assert_eq!(cause(solver.check_index()), Cause::HigherIndex { unknown: 4 }),
        }
    }
}

/// The car axis, a test problem of index 3: a car on two springs, one on a bumpy road, with two rods.
fn car_axis(t: f64, s: &[f64], sp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
    let &[xl, yl, xr, yr, _, _, _, _, l1, l2] = s else { unreachable!("ten unknowns") };
    let (mass, rest) = (10.0 * 1e-4 / 2.0, 0.5);
    let road = 0.1 * (std::f64::consts::PI / 5.0 * t).sin();
    let level = (1.0 - road * road).sqrt();
    let (left, right) = (xl.hypot(yl), (xr - level).hypot(yr - road));
    let forces = [
        (rest - left) * xl / left + l1 * level + 2.0 * l2 * (xl - xr),
        (rest - left) * yl / left + l1 * road + 2.0 * l2 * (yl - yr) - mass,
        (rest - right) * (xr - level) / right - 2.0 * l2 * (xl - xr),
        (rest - right) * (yr - road) / right - 2.0 * l2 * (yl - yr) - mass,
    ];
    for i in 0..4 {
        r[i] = sp[i] - s[4 + i];
        r[4 + i] = mass * sp[4 + i] - forces[i];
    }
    r[8] = level * xl + road * yl;
    r[9] = (xl - xr).powi(2) + (yl - yr).powi(2) - 1.0;
    Ok(())
}

#[test]
fn failures_name_the_index() {
    // off the circle, or moving away from it: no tension helps
    let options = IdaOptions::new(1e-6, 1e-8).differential(Pendulum::DIFFERENTIAL);
    let higher = Cause::HigherIndex { unknown: 4 };
    for (index, y0) in [(3, [1.1, 0.0, 0.0, 0.0, 0.0]), (2, [1.0, 0.0, 0.1, 0.0, 0.0])] {
        let mut solver = Ida::new(pendulum(index), 0.0, &y0, &[0.0; 5], &options).unwrap();
        let unfound = solver.consistent_start(InitialCondition::Algebraic, 1.0);
        assert_eq!(cause(unfound), higher);
        assert_eq!(cause(solver.solve_to(1.0)), higher);
    }
    // from a consistent state the first steps fail
    let start = (&Pendulum::DAE_Y0, &Pendulum::DAE_YP0);
    assert_eq!(cause(ida(pendulum(3), start.0, start.1).solve_to(1.0)), higher);
    // who leaves algebraic unknowns out of the error test knows the index
    let knowing = options.suppress_algebraic(true);
    let mut solver = Ida::new(pendulum(3), 0.0, start.0, &[0.0; 5], &knowing).unwrap();
    assert_eq!(cause(solver.solve_to(100.0)), Cause::InconsistentStart);

    let y0 = [0.0, 0.5, 1.0, 0.5, -0.5, 0.0, -0.5, 0.0, 0.0, 0.0];
    let yp0 = [-0.5, 0.0, -0.5, 0.0, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0];
    let mut solver = ida(car_axis, &y0, &yp0);
    let Cause::HigherIndex { unknown: 8 | 9 } = cause(solver.check_index()) else { panic!() };
    assert!(matches!(cause(solver.solve_to(3.0)), Cause::HigherIndex { unknown: 8 | 9 }));
}

/// y1' + y2' = -y1: a constraint has to be one on another combination than their sum.
#[test]
fn couplings_of_derivatives_count() {
    let coupled = |sign: f64| {
        move |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
            r.copy_from_slice(&[yp[0] + yp[1] + y[0], y[0] + sign * y[1] - 1.0]);
            Ok(())
        }
    };
    ida(coupled(-1.0), &[1.0, 0.0], &[-0.5; 2]).check_index().unwrap();
    let sum = cause(ida(coupled(1.0), &[1.0, 0.0], &[0.0; 2]).check_index());
    assert!(matches!(sum, Cause::HigherIndex { .. }), "{sum:?}");
}

#[test]
fn what_is_of_index_one_is_accepted() {
    let mut solver = ida(Robertson::new(), &Robertson::Y0, &Robertson::YP0);
    solver.check_index().unwrap();
    let decay = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + y[0];
        Ok(())
    };
    ida(decay, &[0.0], &[0.0]).check_index().unwrap();
    // a capacitor of a millionth between two nodes, with resistors to the source and to earth
    let circuit = |t: f64, u: &[f64], f: &mut [f64]| {
        f.copy_from_slice(&[(t.sin() - u[0]) / 50.0, -u[1] / 200.0]);
        Ok(())
    };
    let mass = faer::Mat::from_fn(2, 2, |i, j| if i == j { 1e-6 } else { -1e-6 });
    let dense = LinearSolver::Dense(Jacobian::DifferenceQuotients);
    let form = MassForm::new(with_mass(circuit, mass), 2, &dense).unwrap();
    ida(form, &[0.0; 2], &[0.8; 2]).check_index().unwrap();
}

#[test]
fn equations_that_determine_nothing_have_no_index() {
    let twice = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.fill(yp[0] + y[0] + 0.3 * y[1] - 1.0);
        Ok(())
    };
    assert_eq!(cause(ida(twice, &[0.7, 1.0], &[0.0; 2]).check_index()), Cause::LinearSolver);
    let nothing = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[yp[0] + y[0], 0.0]);
        Ok(())
    };
    assert_eq!(cause(ida(nothing, &[0.7, 1.0], &[0.0; 2]).check_index()), Cause::LinearSolver);

    let edge = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + (y[0] - 1.0).sqrt();
        Ok(())
    };
    let rejected = cause(ida(edge, &[1.0], &[0.0]).check_index());
    assert!(matches!(rejected, Cause::Rejected { .. }), "{rejected:?}");
    let many = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.iter_mut().zip(y.iter().zip(yp)).for_each(|(r, (y, yp))| *r = y + yp);
        Ok(())
    };
    let refused = ida(many, &[0.0; 1001], &[0.0; 1001]).check_index();
    assert!(matches!(refused, Err(Error::Input(error)) if error.input == "number of unknowns"));
}
