//! Stiff DAEs over spans that are many decades longer than their fastest motion: from y' = 0, against closed forms, CVODE and
//! published numbers.

use pliant::{
    ode::{Failure, Ode, with_mass},
    solve::{Method, Options, Output, Problem, solve},
    sundials::{Error, Ida, IdaOptions, InitialCondition, Integrator},
};

const SPANS: [f64; 4] = [1.0, 100.0, 1e8, 1e15];

/// y' = -1e6 (y - cos t), and with the cosine as an algebraic unknown.
fn pulled(t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
    let aim = if y.len() == 1 { t.cos() } else { y[1] };
    r[0] = yp[0] + 1e6 * (y[0] - aim);
    if y.len() == 2 {
        r[1] = y[1] - t.cos();
    }
    Ok(())
}

#[test]
fn the_scale_of_a_start_is_that_of_the_problem() {
    for span in SPANS {
        for y0 in [0.0, 1.0, -3.0] {
            for unknowns in [1, 2] {
                let (y, differential) = ([y0, 0.3], [true, false]);
                let options = IdaOptions::new(1e-6, 1e-9).differential(&differential[..unknowns]);
                let start = (&y[..unknowns], &[0.0; 2][..unknowns]);
                let mut ida = Ida::new(pulled, 0.0, start.0, start.1, &options).unwrap();
                ida.consistent_start(InitialCondition::Algebraic, span).unwrap();
                let slope = 1e6 * (1.0 - y0);
                println!("{span:e} {y0} {unknowns}: {:?}", ida.yp());
                // C is content with a third of a hundredth of the tolerance, 3e-9, after 1e-6 s: 3e-3
                assert!((ida.yp()[0] - slope).abs() <= 3e-3 + 1e-8 * slope.abs());
                if unknowns == 2 {
                    assert!((ida.y()[1] - 1.0).abs() < 1e-9);
                }
                // the first step, too, is told by the problem
                while ida.t() < f64::min(span, 3.0) {
                    ida.step(span).unwrap();
                }
                // it lags behind by 1e-6 sin t; errors of some of the tolerance
                let expected = ida.t().cos();
                assert!(
                    (ida.y()[0] - expected).abs() < 2e-5,
                    "{span:e} {y0}: {}",
                    ida.y()[0] - expected
                );
            }
        }
    }
}

/// The sum of Robertson's concentrations in place of the last equation, M = diag(1, 1, 0), y' unknown; what is left of the
/// first at 1e11 s is that of the Test Set for IVP Solvers (release 2.4, chapter II-10).
#[test]
fn robertson_with_a_mass_matrix_goes_as_far_as_one_likes() {
    let reactions = || {
        let rates = |_t: f64, y: &[f64], f: &mut [f64]| {
            f[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
            f[1] = -f[0] - 3e7 * y[1] * y[1];
            f[2] = y[0] + y[1] + y[2] - 1.0;
            Ok(())
        };
        Problem::ode(with_mass(rates, [1.0, 1.0, 0.0]), [1.0, 0.0, 0.0])
    };
    let options = Options::new(1e-8, [1e-14, 1e-18, 1e-14].as_slice()).output(Output::End);
    for (end, expected) in
        [(1e8, [2.083e-5, 8.33e-11]), (1e11, [0.2083340149701255e-7, 0.8333360770334713e-13])]
    {
        let solution = solve(reactions(), Method::Ida, (0.0, end), &options).unwrap();
        let off: Vec<f64> =
            expected.iter().zip(solution.last()).map(|(e, y)| (y / e - 1.0).abs()).collect();
        println!(
            "{end:e}: {:?}, off by {off:?}, {} steps",
            solution.last(),
            solution.statistics().steps
        );
        // the first pair is known to as many digits
        assert!(off.iter().all(|off| *off < 1e-3), "{end:e}: {off:?}");
    }
    solve(reactions(), Method::Ida, (0.0, 1e15), &options).unwrap();
}

/// E5 of the Test Set: rates from 8e-10 to 1e7, concentrations that start at zero. CVODE, which starts by itself, is what
/// IDA is held against.
#[test]
fn e5_with_a_mass_matrix_starts_over_any_span() {
    struct Pyrolysis;
    impl Ode for Pyrolysis {
        fn rhs(&mut self, _t: f64, y: &[f64], f: &mut [f64]) -> Result<(), Failure> {
            let [a, b, c, m] =
                [7.89e-10 * y[0], 1.1e7 * y[0] * y[2], 1.13e9 * y[1] * y[2], 1.13e3 * y[3]];
            f.copy_from_slice(&[-a - b, a - c, a - b - c + m, b - m]);
            Ok(())
        }
    }
    let start = [1.76e-3, 0.0, 0.0, 0.0];
    let options = Options::new(1e-8, 1e-24).output(Output::End);
    for end in [1.0, 1e3, 1e5, 1e7] {
        let form = Problem::ode(with_mass(Pyrolysis, [1.0; 4]), start);
        let ida = solve(form, Method::Ida, (0.0, end), &options).unwrap();
        let cvode =
            solve(Problem::ode(Pyrolysis, start), Method::Bdf, (0.0, end), &options).unwrap();
        for (ida, cvode) in ida.last().iter().zip(cvode.last()) {
            println!("{end:e}: {ida:e} {cvode:e}");
            // a hundred tolerances, over hundreds of steps of both
            assert!((ida / cvode - 1.0).abs() < 1e-5, "{end:e}: {ida:e} for {cvode:e}");
        }
    }
    let form = Problem::ode(with_mass(Pyrolysis, [1.0; 4]), start);
    solve(form, Method::Ida, (0.0, 1e13), &options).unwrap();
}

#[test]
fn a_start_that_is_not_found_says_what_was_tried() {
    // no real number has the square -1
    let system = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] - y[1];
        r[1] = y[1] * y[1] + 1.0;
        Ok(())
    };
    let options = IdaOptions::new(1e-6, 1e-8).differential([true, false]);
    let mut ida = Ida::new(system, 0.0, &[0.0, 0.5], &[0.0, 0.0], &options).unwrap();
    let error = ida.consistent_start(InitialCondition::Algebraic, 1.0).unwrap_err();
    assert!(matches!(error, Error::Integration(_)));
    let text = error.to_string();
    println!("{text}");
    assert!(text.contains("no start was found by steps from 1e-3 to 1e-37: try one"), "{text}");
}
