//! A problem solved by one call.

use super::{
    error::{Error, Reason, Stopped},
    method::Method,
    options::{Options, Output},
    problem::Problem,
    run::Run,
    solution::{End, SavedPoint, Solution},
};

/// Integrates `problem` by `method` over `span`, from its start to its end, which may lie before it.
///
/// Times may be those of a clock, such as the seconds since 1970. The span is the difference of its two numbers, with a spacing of 2.4e-7 s
/// there, which is also the resolution of the time in the equations; steps may be finer, as they are counted from the start.
///
/// # Errors
/// [`Error::Input`] if something cannot be used: then nothing was computed; [`Error::Stopped`] if the end was
/// not reached, with the reason and the solution so far.
///
/// # Panics
/// A panic of the equations, the events or the actions passes through.
pub fn solve(
    problem: Problem<'_>,
    method: Method,
    span: (f64, f64),
    options: &Options,
) -> Result<Solution, Error> {
    let start = problem.y.clone();
    let dense = options.output == Output::Steps;
    let mut run = match Run::new(problem, method, span, options) {
        Ok(run) => run,
        Err(Reason::Input(error)) => return Err(Error::Input(error)),
        Err(reason) => {
            let solution =
                Solution::new(span.0, SavedPoint { y: &start, s: &[], q: &[], sq: &[] }, dense);
            return Err(Error::Stopped(Box::new(Stopped { reason, solution })));
        }
    };
    let mut solution = Solution::new(run.t(), run.row(), dense);
    let outcome = integrate(&mut run, &mut solution, &options.output);
    solution.statistics = run.statistics();
    solution.saved = run.save();
    solution.methods = run.methods().to_vec();
    solution.notice = run.notice();
    solution.end = run.end().unwrap_or(End::Early);
    match outcome {
        Ok(()) => Ok(solution),
        Err(reason) => {
            solution.end = End::Early;
            Err(Error::Stopped(Box::new(Stopped { reason, solution })))
        }
    }
}

/// Integrates `run` to its end and stores the requested `output`.
fn integrate(run: &mut Run<'_>, solution: &mut Solution, output: &Output) -> Result<(), Reason> {
    let mut times = match output {
        Output::Times(times) => times.as_slice(),
        Output::Steps | Output::End => &[],
    };
    // the start is there already
    while let [first, rest @ ..] = times
        && *first == run.t()
    {
        times = rest;
    }
    let sign = run.direction();
    let mut y = run.y().to_vec();
    loop {
        let outcome = run.advance();
        let (t, jumped) = match outcome {
            Ok(Some(step)) => {
                solution.events.extend_from_slice(step.events);
                (step.t, step.before.map(|before| y.copy_from_slice(before)).is_some())
            }
            Ok(None) => return Ok(()),
            Err(reason) => {
                // where it stopped, if that is not there already
                if *output != Output::Steps && solution.t().last() != Some(&run.t()) {
                    solution.push_jump(run.t(), run.row());
                }
                return Err(reason);
            }
        };
        if *output == Output::Steps {
            if !jumped {
                y.copy_from_slice(run.y());
            }
            let degree = run.interpolant_degree();
            let [s, sq] = run.sensitivities_before().map(<[f64]>::to_vec);
            let q = run.quadratures().to_vec();
            let row = SavedPoint { y: &y, s: &s, q: &q, sq: &sq };
            solution.push(t, row, degree, |at, out| run.interpolate(at, out))?;
            if jumped {
                solution.push_jump(t, run.row());
            }
            continue;
        }
        while let [first, rest @ ..] = times
            && (first - t) * sign <= 0.0
        {
            if *first == t {
                solution.push_jump(*first, run.row());
            } else {
                run.interpolate(*first, &mut y)?;
                let ([s, sq], q) = (run.sensitivities_at(*first)?, run.quadratures_at(*first)?);
                solution.push_jump(*first, SavedPoint { y: &y, s: &s, q: &q, sq: &sq });
            }
            times = rest;
        }
        if run.end().is_some() && solution.t().last() != Some(&t) {
            solution.push_jump(t, run.row());
        }
    }
}
