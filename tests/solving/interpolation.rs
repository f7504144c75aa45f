//! Solutions between the steps.

use pliant::{
    integrate::Integrator,
    rk,
    samples::Hires,
    solve::{Method, Options, Output, Problem, Run, solve},
    sundials::{Cvode, CvodeOptions},
};

use crate::support::{methods, oscillator, sine, tight};

/// sin t anywhere in the span, to the accuracy of the interpolants: that of the steps for multistep methods, less for Runge-Kutta methods.
#[test]
fn any_time_of_the_span_is_known() {
    for method in methods() {
        let solution = solve(sine(), method, (0.0, 20.0), &tight()).unwrap();
        let mut worst: f64 = 0.0;
        for k in 0..=1000 {
            let t = 0.02 * f64::from(k);
            let y = solution.at(t).unwrap();
            worst = worst.max((y[0] - t.sin()).abs()).max((y[1] - t.cos()).abs());
        }
        let tolerance = match method {
            Method::RungeKutta(_) => 2e-6,
            _ => 2e-8,
        };
        println!("{method:?} {worst:e}");
        assert!(worst < tolerance, "{method:?}: {worst:e}");
    }
}

/// The polynomial that is kept is the integrator's own: equal to what it gives while it stands there, to rounding.
#[test]
fn what_is_kept_is_the_interpolant_of_the_integrator() {
    let options = CvodeOptions::new(1e-8, 1e-10);
    let mut cvode = Cvode::new(oscillator, 0.0, &[0.0, 1.0], &options).unwrap();
    let mut explicit =
        rk::DormandPrince::new(oscillator, 0.0, &[0.0, 1.0], &rk::Options::new(1e-8, 1e-10))
            .unwrap();
    let kept = |method| solve(sine(), method, (0.0, 20.0), &Options::new(1e-8, 1e-10)).unwrap();
    compare(&mut cvode, &kept(Method::Bdf));
    compare(&mut explicit, &kept(Method::DormandPrince));
}

fn compare(integrator: &mut impl Integrator, solution: &pliant::solve::Solution) {
    integrator.set_stop_time(Some(20.0)).unwrap();
    let mut y = [0.0; 2];
    for k in 1..solution.t().len() {
        integrator.step(20.0).unwrap();
        let (start, end) = (solution.t()[k - 1], solution.t()[k]);
        assert_eq!(integrator.t(), end);
        for part in [0.0, 0.1, 0.37, 0.5, 0.9, 0.99] {
            let t = start + part * (end - start);
            integrator.interpolate(t, 0, &mut y).unwrap();
            let kept = solution.at(t).unwrap();
            // the start of a step is the end of the one before
            let tolerance = if part == 0.0 { 1e-7 } else { 1e-14 };
            for i in 0..2 {
                assert!((kept[i] - y[i]).abs() < tolerance, "{t} {} {}", kept[i], y[i]);
            }
        }
    }
}

/// Output times do not change the steps: states there are those of the whole solution, to rounding, and work is the same.
#[test]
fn output_times_do_not_change_the_steps() {
    for method in methods() {
        let whole = solve(sine(), method, (0.0, 20.0), &tight()).unwrap();
        let times: Vec<f64> = (0..=40).map(|k| 0.5 * f64::from(k)).collect();
        let at = tight().output(Output::Times(times.clone()));
        let sampled = solve(sine(), method, (0.0, 20.0), &at).unwrap();
        assert_eq!(sampled.t(), times, "{method:?}");
        assert_eq!(sampled.statistics().steps, whole.statistics().steps);
        for (k, t) in times.iter().enumerate() {
            let y = whole.at(*t).unwrap();
            assert!((sampled.y(k)[0] - y[0]).abs() < 1e-13, "{method:?} {t}");
        }
        let end = solve(sine(), method, (0.0, 20.0), &tight().output(Output::End)).unwrap();
        assert_eq!(end.t(), [0.0, 20.0]);
        assert_eq!(end.last(), whole.last());
        assert!(end.at(3.0).is_err());
    }
}

/// A run in the hands of the caller takes the same steps, and can be read within each.
#[test]
fn a_run_gives_its_steps_one_by_one() {
    let problem = || Problem::ode(Hires::new(), Hires::Y0);
    let span = (0.0, Hires::REFERENCE.t);
    let whole = solve(problem(), Method::Bdf, span, &tight()).unwrap();
    let mut run = Run::new(problem(), Method::Bdf, span, &tight()).unwrap();
    let (mut k, mut middle) = (0, vec![0.0; 8]);
    while let Some(step) = run.advance().unwrap() {
        k += 1;
        assert_eq!((step.t, step.y), (whole.t()[k], whole.y(k)));
        let t = 0.5 * (step.t_old + step.t);
        run.interpolate(t, &mut middle).unwrap();
        let kept = whole.at(t).unwrap();
        assert!(kept.iter().zip(&middle).all(|(a, b)| (a - b).abs() < 1e-14));
    }
    assert_eq!(k + 1, whole.t().len());
    assert!(Hires::REFERENCE.error(whole.last()) < 1e-7);
}

/// Backward in time, and its solution is read in any order.
#[test]
fn time_may_go_backward() {
    for method in [Method::Bdf, Method::Adams] {
        let solution = solve(sine(), method, (0.0, -5.0), &tight()).unwrap();
        for t in [-0.01, -2.0, -4.99] {
            assert!((solution.at(t).unwrap()[0] - f64::sin(t)).abs() < 1e-8, "{method:?}");
        }
        assert!(solution.at(0.1).is_err() && solution.at(-5.1).is_err());
    }
}
