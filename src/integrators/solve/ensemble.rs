//! Many problems on all cores.

use std::{
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering::Relaxed},
    },
    thread,
};

use super::{
    error::Error, method::Method, options::Options, problem::Problem, solution::Solution,
    solver::solve,
};

/// Solves `count` problems on all cores: `problem(k)` makes the one of number k, on the thread that solves
/// it.
///
/// Each has its own result, whatever happens to the others; results are in the order of the numbers. A member
/// is computed by one thread from beginning to end, so results do not depend on the number of threads.
///
/// ```
/// use pliant::solve::{Method, Options, Output, Problem, ensemble};
///
/// let rates = [0.5, 1.0, 2.0, 4.0];
/// let decay = |k: usize| {
///     let rate = rates[k];
///     Problem::ode(move |_t: f64, y: &[f64], ydot: &mut [f64]| {
///         ydot[0] = -rate * y[0];
///         Ok(())
///     }, [1.0])
/// };
/// let options = Options::new(1e-8, 1e-10).output(Output::End);
/// for (k, solution) in ensemble(rates.len(), decay, Method::Bdf, (0.0, 1.0), &options).into_iter().enumerate() {
///     assert!((solution?.last()[0] - (-rates[k]).exp()).abs() < 1e-6);
/// }
/// # Ok::<(), pliant::solve::Error>(())
/// ```
///
/// # Panics
/// A panic of a member passes through, after the others have ended; if several panic, that of the lowest
/// number.
pub fn ensemble<'a, F>(
    count: usize,
    problem: F,
    method: Method,
    span: (f64, f64),
    options: &Options,
) -> Vec<Result<Solution, Error>>
where
    F: Fn(usize) -> Problem<'a> + Sync,
{
    let threads = thread::available_parallelism().map_or(1, usize::from).min(count);
    let next = AtomicUsize::new(0);
    let results: Vec<Mutex<Option<_>>> = (0..count).map(|_| Mutex::new(None)).collect();
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Relaxed);
                    let Some(place) = results.get(k) else { break };
                    // caught, as a thread that panics would lose the message; nothing of the member is used
                    // again
                    let solution =
                        catch_unwind(AssertUnwindSafe(|| solve(problem(k), method, span, options)));
                    if let Ok(mut place) = place.lock() {
                        *place = Some(solution);
                    }
                }
            });
        }
    });
    let outcomes = results.into_iter().filter_map(|place| place.into_inner().ok().flatten());
    outcomes.map(|outcome| outcome.unwrap_or_else(|panic| resume_unwind(panic))).collect()
}
