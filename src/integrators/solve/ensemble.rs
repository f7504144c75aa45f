//! Many problems on all cores.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering::Relaxed},
    },
    thread,
};

use super::error::Error;

/// The results of `count` members, computed on all cores: `member(k)` creates and solves the problem of number k, with the method, span and
/// options that it chooses, on the thread that runs it.
///
/// Each has its own result, independent of the others: one that panics has [`Error::Panicked`] with its message. Results are in the
/// order of the numbers. A member is computed by one thread from beginning to end, so results do not depend on the number of threads.
///
/// ```
/// use pliant::solve::{Method, Options, Output, Problem, ensemble, solve};
///
/// // each rate over three times its decay time, the fast ones at tighter tolerances
/// let rates = [0.5, 1.0, 2.0, 4.0];
/// let results = ensemble(rates.len(), |k| {
///     let rate = rates[k];
///     let decay = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
///         ydot[0] = -rate * y[0];
///         Ok(())
///     };
///     let options = Options::new(1e-8 / rate, 1e-10).output(Output::End);
///     solve(Problem::ode(decay, [1.0]), Method::Bdf, (0.0, 3.0 / rate), &options)
/// });
/// for solution in results {
///     assert!((solution?.last()[0] - (-3.0_f64).exp()).abs() < 1e-6);
/// }
/// # Ok::<(), pliant::solve::Error>(())
/// ```
pub fn ensemble<T, F>(count: usize, member: F) -> Vec<Result<T, Error>>
where
    T: Send,
    F: Fn(usize) -> Result<T, Error> + Sync,
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
                    // nothing of a member that panics is used again
                    let outcome = catch_unwind(AssertUnwindSafe(|| member(k)));
                    let result = outcome.unwrap_or_else(|panic| Err(panicked(panic.as_ref())));
                    if let Ok(mut place) = place.lock() {
                        *place = Some(result);
                    }
                }
            });
        }
    });
    results.into_iter().filter_map(|place| place.into_inner().ok().flatten()).collect()
}

/// The panic of a member as an error, with its message if that is a text.
fn panicked(panic: &(dyn Any + Send)) -> Error {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or(panic.downcast_ref::<&str>().copied());
    Error::Panicked(text.unwrap_or("with a value that is no text").into())
}
