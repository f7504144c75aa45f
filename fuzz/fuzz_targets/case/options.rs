//! Options, sensible or not.

use std::time::Duration;

use pliant::{
    integrate::AbsoluteTolerance,
    rk,
    solve::{self, Output},
    sundials::{
        ArkodeOptions, ButcherTable, CvodeOptions, IdaOptions, Jacobian, Krylov, KrylovMethod,
        LinearSolver, Multistep, Pattern, Preconditioner, Sensitivities, Side, Sign,
    },
};

use super::bytes::Bytes;

/// Steps of one call at most.
pub const STEPS: u64 = 300;

/// Now and then another length than `n`.
fn length(bytes: &mut Bytes<'_>, n: usize) -> usize {
    if bytes.is(32) { bytes.below(9) } else { n }
}

fn rtol(bytes: &mut Bytes<'_>) -> f64 {
    10_f64.powi(-1 - bytes.below(12) as i32)
}

fn tolerances(bytes: &mut Bytes<'_>, n: usize) -> (f64, AbsoluteTolerance) {
    let rtol = if bytes.is(16) { bytes.scale() } else { rtol(bytes) };
    let atol = match bytes.is(4) {
        true => (0..length(bytes, n)).map(|_| bytes.scale()).collect(),
        false => vec![rtol * 1e-3],
    };
    bytes.is_loose |= rtol >= 0.1 || atol.iter().any(|atol| *atol > 0.1);
    let atol = if atol.len() == 1 { atol[0].into() } else { atol.into() };
    (rtol, atol)
}

fn jacobian(bytes: &mut Bytes<'_>) -> Jacobian {
    if bytes.is(2) { Jacobian::Supplied } else { Jacobian::DifferenceQuotients }
}

fn pattern(bytes: &mut Bytes<'_>, n: usize) -> Pattern {
    let n = length(bytes, n).max(1);
    match bytes.below(4) {
        // not even a diagonal
        0 => Pattern::from_entries(n, []).expect("no entry is wrong"),
        half => Pattern::band(n, (half - 1).min(n - 1), 0).expect("half is below n"),
    }
}

pub fn newton(bytes: &mut Bytes<'_>, n: usize) -> LinearSolver {
    match bytes.below(8) {
        0..=2 => LinearSolver::Dense(jacobian(bytes)),
        3 => {
            let [lower, upper] = [bytes.below(4), bytes.below(4)];
            LinearSolver::Band { lower, upper, jacobian: jacobian(bytes) }
        }
        4 | 5 => LinearSolver::Klu { pattern: pattern(bytes, n), jacobian: jacobian(bytes) },
        6 => LinearSolver::Custom,
        _ => {
            let method = match bytes.is(2) {
                true => KrylovMethod::Gmres {
                    dimension: bytes.below(8) as u32,
                    restarts: bytes.below(3) as u32,
                },
                false => KrylovMethod::BiCgStab { iterations: bytes.below(8) as u32 },
            };
            let mut krylov = Krylov::new(method).products(jacobian(bytes));
            if bytes.is(2) {
                let side = *bytes.one_of(&[Side::Left, Side::Right]);
                let preconditioner = match bytes.is(2) {
                    true => Preconditioner::Custom,
                    false => Preconditioner::Ilu {
                        pattern: pattern(bytes, n),
                        jacobian: jacobian(bytes),
                    },
                };
                krylov = krylov.preconditioner(side, preconditioner);
            }
            if bytes.is(4) {
                krylov = krylov.tolerance_factor(bytes.scale());
            }
            LinearSolver::Krylov(krylov)
        }
    }
}

fn signs(bytes: &mut Bytes<'_>, n: usize) -> Vec<Sign> {
    const ALL: [Sign; 5] =
        [Sign::Free, Sign::NonNegative, Sign::NonPositive, Sign::Positive, Sign::Negative];
    (0..length(bytes, n)).map(|_| *bytes.one_of(&ALL)).collect()
}

fn sensitivities(bytes: &mut Bytes<'_>) -> Sensitivities {
    let parameters: Vec<usize> = (0..1 + bytes.below(2)).map(|_| bytes.below(3)).collect();
    let sensitivities = Sensitivities::of(parameters).error_control(bytes.is(2));
    if bytes.is(2) { sensitivities.staggered() } else { sensitivities }
}

/// What all options of SUNDIALS have.
macro_rules! shared {
    ($options:ident, $bytes:ident, $n:ident) => {
        $options = $options.max_steps(1 + $bytes.below(STEPS as usize) as u32);
        if $bytes.is(8) {
            $options = $options.initial_step($bytes.scale());
        }
        if $bytes.is(8) {
            $options = $options.max_step($bytes.scale());
        }
        if $bytes.is(16) {
            $options = $options.min_step($bytes.scale());
        }
        if $bytes.is(16) {
            $options = $options.convergence_coefficient($bytes.scale());
            $bytes.is_loose = true;
        }
        if $bytes.is(8) {
            $options = $options.sign_constraints(signs($bytes, $n));
        }
    };
}

pub fn cvode(bytes: &mut Bytes<'_>, n: usize) -> CvodeOptions {
    let (rtol, atol) = tolerances(bytes, n);
    let mut options = CvodeOptions::new(rtol, atol);
    shared!(options, bytes, n);
    if bytes.is(4) {
        options = options.method(Multistep::Adams);
    }
    options = match bytes.below(6) {
        0 => options.fixed_point(bytes.below(5) as u32),
        _ => options.newton(newton(bytes, n)),
    };
    if bytes.is(4) {
        options = options.max_order(bytes.below(14) as u32);
    }
    if bytes.is(4) {
        options = options.stability_limit_detection(true);
    }
    if bytes.is(6) {
        options = options.project();
    }
    if bytes.is(6) {
        options = options.sensitivities(sensitivities(bytes));
    }
    options
}

pub fn arkode(bytes: &mut Bytes<'_>, n: usize) -> ArkodeOptions {
    let (rtol, atol) = tolerances(bytes, n);
    let mut options = ArkodeOptions::new(rtol, atol);
    shared!(options, bytes, n);
    options = match bytes.below(4) {
        0 => options,
        1 => options.table(*bytes.one_of(&ButcherTable::IMEX)),
        _ => options.table(*bytes.one_of(&ButcherTable::ALL)),
    };
    options = match bytes.below(6) {
        0 => options.fixed_point(bytes.below(5) as u32),
        _ => options.newton(newton(bytes, n)),
    };
    if bytes.is(8) {
        options = options.fixed_step(bytes.scale());
        bytes.is_loose = true;
    }
    if bytes.is(4) {
        options = options.max_iterations(bytes.below(9) as u32);
    }
    options
}

pub fn ida(bytes: &mut Bytes<'_>, n: usize) -> IdaOptions {
    let (rtol, atol) = tolerances(bytes, n);
    let mut options = IdaOptions::new(rtol, atol).newton(newton(bytes, n));
    shared!(options, bytes, n);
    if bytes.is(2) {
        let differential: Vec<bool> = (0..length(bytes, n)).map(|i| i + 1 < n).collect();
        let suppressed = bytes.is(2);
        bytes.is_loose |= suppressed;
        options = options.differential(differential).suppress_algebraic(suppressed);
    }
    if bytes.is(4) {
        options = options.max_order(bytes.below(8) as u32);
    }
    if bytes.is(6) {
        options = options.sensitivities(sensitivities(bytes));
    }
    options
}

pub fn rk(bytes: &mut Bytes<'_>, n: usize) -> rk::Options {
    let (rtol, atol) = tolerances(bytes, n);
    let mut options = rk::Options::new(rtol, atol);
    options = options.max_steps(1 + bytes.below(STEPS as usize) as u32);
    if bytes.is(8) {
        options = options.initial_step(bytes.scale());
    }
    if bytes.is(8) {
        options = options.max_step(bytes.scale());
    }
    options
}

pub fn solve(bytes: &mut Bytes<'_>, n: usize) -> solve::Options {
    let (rtol, atol) = tolerances(bytes, n);
    let mut options = solve::Options::new(rtol, atol).max_steps(1 + bytes.below(200) as u64);
    options = match bytes.below(4) {
        0 => options.output(Output::End),
        1 => options.output(Output::Times((0..bytes.below(5)).map(|_| bytes.time()).collect())),
        _ => options,
    };
    if bytes.is(2) {
        options = options.linear_solver(newton(bytes, n));
    }
    if bytes.is(8) {
        options = options.initial_step(bytes.scale());
    }
    if bytes.is(8) {
        options = options.max_step(bytes.scale());
    }
    if bytes.is(8) {
        options = options.min_step(bytes.scale());
    }
    if bytes.is(8) {
        options = options.max_order(bytes.below(14) as u32);
    }
    if bytes.is(8) {
        options = options.max_evaluations(bytes.below(256) as u64);
    }
    if bytes.is(16) {
        options = options.max_wall_time(Duration::from_micros(u64::from(bytes.byte())));
    }
    if bytes.is(6) {
        options = options.sensitivities(sensitivities(bytes));
    }
    options
}
