//! Runs that go on with another number of unknowns: an example of SUNDIALS that refines its mesh, cells that divide.

use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering::Relaxed},
};

use pliant::{
    ode::{Failure, Ode, dae_with_parameters, with_parameters},
    solve::{Event, Method, Options, Problem, Reason, Run, solve},
    sundials::{ButcherTable, Jacobian, LinearSolver, Sensitivities},
};
use std::ops::ControlFlow;

use crate::support::{methods, tight};

/// The heat equation of `ark_heat1D_adapt`, an example of SUNDIALS, on a mesh.
#[derive(Clone)]
struct Heat {
    mesh: Vec<f64>,
}

impl Heat {
    /// The mesh with intervals halved beside points with a second difference above 3e-3, and the linear interpolant there.
    fn refined(&self, y: &[f64]) -> (Self, Vec<f64>) {
        let n = y.len();
        let bends =
            |i: usize| (1..n - 1).contains(&i) && (y[i - 1] - 2.0 * y[i] + y[i + 1]).abs() > 3e-3;
        let (mut mesh, mut values) = (vec![self.mesh[0]], vec![y[0]]);
        for i in 0..n - 1 {
            if bends(i) || bends(i + 1) {
                mesh.push(0.5 * (self.mesh[i] + self.mesh[i + 1]));
                values.push(0.5 * (y[i] + y[i + 1]));
            }
            mesh.push(self.mesh[i + 1]);
            values.push(y[i + 1]);
        }
        (Self { mesh }, values)
    }
}

impl Ode for Heat {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let bump = |height: f64, sharpness: f64, centre: f64, x: f64| {
            height * (-sharpness * (x - centre).powi(2)).exp()
        };
        for i in 1..y.len() - 1 {
            let x = self.mesh[i];
            let (left, right) = (x - self.mesh[i - 1], self.mesh[i + 1] - x);
            let slopes = (y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left;
            ydot[i] = 0.5 * 2.0 * slopes / (left + right) + bump(2.0, 200.0, 0.25, x)
                - bump(1.0, 400.0, 0.7, x)
                + bump(1.0, 500.0, 0.4, x)
                - bump(2.0, 600.0, 0.55, x);
        }
        Ok(())
    }
}

fn band() -> LinearSolver {
    LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::DifferenceQuotients }
}

fn rms(y: &[f64]) -> f64 {
    (y.iter().map(|y| y * y).sum::<f64>() / y.len() as f64).sqrt()
}

/// `ark_heat1D_adapt` refines its mesh after each step, from 21 to 60 points, and ends with a root mean square of 3.275701308e-2 after 146 steps, by
/// the method of order 4 that SUNDIALS takes.
#[test]
fn a_mesh_is_refined_as_in_the_example_of_sundials() {
    let table: ButcherTable = "SDIRK_5_3_4".parse().unwrap();
    let options = Options::new(1e-3, 1e-10).linear_solver(band());
    let mut heat = Heat { mesh: (0..21).map(|i| f64::from(i) / 20.0).collect() };
    let problem = Problem::ode(heat.clone(), vec![0.0; 21]);
    let mut run = Run::new(problem, Method::RungeKutta(table), (0.0, 1.0), &options).unwrap();
    while run.advance().unwrap().is_some() {
        if run.end().is_some() {
            break;
        }
        let (refined, values) = heat.refined(run.y());
        run.resize(Problem::ode(refined.clone(), values), &options).unwrap();
        heat = refined;
    }
    let (steps, points) = (run.statistics().steps, run.y().len());
    println!("{steps} steps, {points} points, {:.9e}", rms(run.y()));
    // which intervals are halved depends on the states that steps end with, and the mean on the mesh
    assert!((57..=66).contains(&points) && steps < 146);
    assert!((rms(run.y()) / 3.275_701_308e-2 - 1.0).abs() < 2e-2);
    // from the start on the mesh of the end, at tight tolerances
    let n = heat.mesh.len();
    let fine = Options::new(1e-9, 1e-12).linear_solver(band());
    let exact = solve(Problem::ode(heat, vec![0.0; n]), Method::Bdf, (0.0, 1.0), &fine).unwrap();
    let error = exact.last().iter().zip(run.y()).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs()));
    println!("error {error:e}");
    assert!(error < 3e-6);
}

fn growth(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot.iter_mut().zip(y).for_each(|(ydot, y)| *ydot = *y);
    Ok(())
}

fn halves(y: &[f64]) -> Vec<f64> {
    [y, y].concat().iter().map(|size| 0.5 * size).collect()
}

/// The total of cells that grow and divide does not know of it, by any method. Costs, limits, observers and counts of events go on.
#[test]
fn cells_divide() {
    let all = methods().into_iter().chain([Method::Rosenbrock, Method::Auto]);
    for method in all {
        let seen = Arc::new(AtomicUsize::new(0));
        let counter = seen.clone();
        let problem = Problem::ode(growth, [1.0])
            .event(Event::new(|_t, y| y.iter().sum::<f64>() - 1.5).once())
            .event(Event::new(|_t, y| y[0] - 0.9).falling())
            .event(Event::every(0.25))
            .observed_by(move |_| {
                counter.fetch_add(1, Relaxed);
                ControlFlow::Continue(())
            });
        let mut run = Run::new(problem, method, (0.0, 3.0), &tight()).unwrap();
        let (mut met, mut steps) = (Vec::new(), 0);
        for generation in 1..=4 {
            met.extend(run.advance_to(0.5 * f64::from(generation)).unwrap());
            let next = Problem::ode(growth, halves(run.y()))
                .event(Event::new(|_t, y| y.iter().sum::<f64>() - 1.5).once())
                .event(Event::new(|_t, y| y[0] - 0.9).falling())
                .event(Event::every(0.25));
            run.resize(next, &tight()).unwrap();
            assert!(run.statistics().steps > steps);
            steps = run.statistics().steps;
        }
        met.extend(run.advance_to(3.0).unwrap());
        assert_eq!(run.y().len(), 16);
        let error = run.y().iter().sum::<f64>() / 3.0_f64.exp() - 1.0;
        assert!(error.abs() < 1e-7, "{method:?}: {error:e}");
        let times = |event| met.iter().filter(move |met| met.event == event).map(|met| met.t);
        let one: Vec<f64> = times(0).collect();
        assert!(one.len() == 1 && (one[0] - 1.5_f64.ln()).abs() < 1e-7, "{method:?} {one:?}");
        // a cell falls below 0.9 where it divides, which is no event
        assert_eq!(times(1).count(), 0, "{method:?}");
        assert_eq!(
            times(2).collect::<Vec<_>>(),
            (1..=12).map(|k| 0.25 * f64::from(k)).collect::<Vec<_>>()
        );
        assert!(seen.load(Relaxed) as u64 >= steps, "{method:?}");
    }
}

/// One-step methods go on with the step that they had: another number of unknowns after each step costs half as many steps more at most, as the
/// control of the step begins anew; a first step that is estimated each time, many times as many.
#[test]
fn one_step_methods_keep_their_step() {
    let orbit = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        for (ydot, y) in ydot.chunks_mut(2).zip(y.chunks(2)) {
            ydot.copy_from_slice(&[y[1], -y[0]]);
        }
        Ok(())
    };
    let options = Options::new(1e-6, 1e-9);
    let implicit = Method::RungeKutta(ButcherTable::implicit(4).unwrap());
    for method in [Method::DormandPrince, Method::Rosenbrock, implicit] {
        let start = || Problem::ode(orbit, [0.0, 1.0]);
        let mut one = Run::new(start(), method, (0.0, 20.0), &options).unwrap();
        let mut other = Run::new(start(), method, (0.0, 20.0), &options).unwrap();
        while one.advance().unwrap().is_some() {}
        let mut count = 1;
        while other.advance().unwrap().is_some() {
            if other.end().is_none() {
                count = 3 - count;
                let y = other.y()[..2].repeat(count);
                other.resize(Problem::ode(orbit, y), &options).unwrap();
            }
        }
        let [one, other] = [one, other].map(|run| run.statistics().steps as f64);
        println!("{method:?}: {one} steps, resized {other}");
        assert!(other < 1.5 * one);
    }
}

/// Sensitivities of cells that divide, and of their integrals: y = e^(p t), with half of it and twice as many from t = 1 on.
#[test]
fn sensitivities_go_on() {
    let cells = || {
        with_parameters(
            |_t, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                ydot.iter_mut().zip(y).for_each(|(ydot, y)| *ydot = p[0] * y);
                Ok(())
            },
            [0.5],
        )
    };
    let options = tight().sensitivities(Sensitivities::of([0]));
    let mut run =
        Run::new(Problem::ode(cells(), [1.0]), Method::Bdf, (0.0, 2.0), &options).unwrap();
    run.advance_to(1.0).unwrap();
    let missing = run.resize(Problem::ode(cells(), [1.0; 2]), &options).unwrap_err();
    assert!(missing.to_string().contains("initial_sensitivities"));
    let s = [0.5 * run.sensitivities()[(0, 0)]; 2];
    let next = Problem::ode(cells(), halves(run.y())).initial_sensitivities(s);
    run.resize(next, &options).unwrap();
    run.advance_to(2.0).unwrap();
    for k in 0..2 {
        assert!((run.sensitivities()[(k, 0)] - 1.0_f64.exp()).abs() < 1e-7);
    }
}

/// A DAE whose algebraic unknown is the total: it is corrected in the new problem.
#[test]
fn a_dae_is_resized() {
    let cells = |n: usize| {
        let equations = move |_t: f64, y: &[f64], yp: &[f64], _p: &[f64], r: &mut [f64]| {
            (0..n).for_each(|k| r[k] = yp[k] - y[k]);
            r[n] = y[n] - y[..n].iter().sum::<f64>();
            Ok(())
        };
        let mut differential = vec![true; n];
        differential.push(false);
        let y = vec![1.0 / n as f64; n + 1];
        (dae_with_parameters(equations, []), y, differential)
    };
    let (equations, y, differential) = cells(1);
    let problem = Problem::dae(equations, y, [0.0; 2]).differential(differential);
    let mut run = Run::new(problem, Method::Auto, (0.0, 1.0), &tight()).unwrap();
    run.advance_to(0.5).unwrap();
    let (equations, mut y, differential) = cells(3);
    y[..3].fill(run.y()[0] / 3.0);
    let next = Problem::dae(equations, y, [0.0; 4]).differential(differential);
    run.resize(next, &tight()).unwrap();
    assert!((run.y()[3] - 0.5_f64.exp()).abs() < 1e-7);
    run.advance_to(1.0).unwrap();
    assert!((run.y()[3] - 1.0_f64.exp()).abs() < 1e-7);
}

#[test]
fn refusals_leave_the_run_as_it_was() {
    let options = Options::new(1e-8, 1e-10).max_steps(30);
    let problem = Problem::ode(growth, [1.0]).event(Event::every(1.0));
    let mut run = Run::new(problem, Method::DormandPrince, (0.0, 50.0), &options).unwrap();
    run.advance_to(0.5).unwrap();
    let fewer = run.resize(Problem::ode(growth, [1.0; 2]), &options).unwrap_err();
    assert!(fewer.to_string().contains("number of events"));
    let infinite = Problem::ode(growth, [f64::NAN; 2]).event(Event::every(1.0));
    assert!(run.resize(infinite, &options).is_err());
    assert_eq!((run.t(), run.y().len()), (0.5, 1));
    // the limit counts all steps
    let next = Problem::ode(growth, halves(run.y())).event(Event::every(1.0));
    run.resize(next, &options).unwrap();
    let stopped = loop {
        match run.advance() {
            Ok(Some(_)) => {}
            other => break other.map(|_| ()),
        }
    };
    assert!(matches!(stopped, Err(Reason::Steps(30))), "{stopped:?}");
    assert_eq!(run.statistics().steps, 30);
    let mut ended =
        Run::new(Problem::ode(growth, [1.0]), Method::Bdf, (0.0, 1.0), &tight()).unwrap();
    while ended.advance().unwrap().is_some() {}
    assert!(ended.resize(Problem::ode(growth, [1.0; 2]), &options).is_err());
}
