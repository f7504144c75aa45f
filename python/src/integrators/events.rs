//! Events whose functions and actions are those of Python.

use numpy::{PyArray1, PyReadonlyArray1};
use pliant::solve::{Event, Jump};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::equations::{Raised, arguments};

/// An event: the dict from `pliant/events.py`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct AskedEvent {
    /// A function of (t, y); none for a clock.
    function: Option<Py<PyAny>>,
    /// -1, 0 or 1.
    direction: i32,
    /// The number of the event that ends the run (0: none does).
    last: u32,
    once: bool,
    touching: Option<f64>,
    samples: Option<u32>,
    /// The first time of a clock, or the time of one event.
    start: Option<f64>,
    period: Option<f64>,
    /// Functions of (t, y, y', p).
    action: Option<Py<PyAny>>,
    at_accumulation: Option<Py<PyAny>>,
}

/// Result of an action: y, y', p, the events that it arms (or disarms), and whether the run ends.
type Landed<'py> = (
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    Vec<(usize, bool)>,
    bool,
);

impl AskedEvent {
    /// The event; exceptions are kept in `raised`.
    pub fn event(self, raised: &Raised) -> PyResult<Event<'static>> {
        let mut event = match (self.function, self.period, self.start) {
            (Some(function), _, _) => rooted(function, raised.clone()),
            (None, Some(period), None) => Event::every(period),
            (None, Some(period), Some(start)) => Event::every(period).starting_at(start),
            (None, None, Some(t)) => Event::at(t),
            (None, None, None) => {
                return Err(PyValueError::new_err("an event needs a function, or times"));
            }
        };
        event = match self.direction {
            1.. => event.rising(),
            0 => event,
            _ => event.falling(),
        };
        if self.last > 0 {
            event = event.terminal_after(self.last);
        }
        if self.once {
            event = event.once();
        }
        event = self.touching.into_iter().fold(event, Event::touching);
        event = self.samples.into_iter().fold(event, Event::samples);
        if let Some(action) = self.action {
            let raised = raised.clone();
            event = event.action(move |jump| act(&action, jump, &raised));
        }
        if let Some(action) = self.at_accumulation {
            let raised = raised.clone();
            event = event.at_accumulation(move |jump| act(&action, jump, &raised));
        }
        Ok(event)
    }
}

/// An event at the roots of a function.
fn rooted(function: Py<PyAny>, raised: Raised) -> Event<'static> {
    Event::with_parameters(move |t, y, p| {
        let value = Python::attach(|py| {
            let returned = function.bind(py).call1(arguments(py, t, &[y], None, p)?)?;
            returned.call_method0("__float__")?.extract()
        });
        value.unwrap_or_else(|error: PyErr| {
            raised.keep(error);
            f64::NAN
        })
    })
}

/// Calls an action; an exception ends the run.
pub fn act(action: &Py<PyAny>, jump: &mut Jump<'_>, raised: &Raised) {
    let outcome = Python::attach(|py| {
        let [y, yp, p] = [&*jump.y, &*jump.yp, &*jump.p].map(|part| PyArray1::from_slice(py, part));
        let (y, yp, p, armed, ends): Landed<'_> =
            action.bind(py).call1((jump.t, y, yp, p))?.extract()?;
        for (part, array, name) in
            [(&mut *jump.y, y, "y"), (&mut *jump.yp, yp, "yp"), (&mut *jump.p, p, "p")]
        {
            let array = array.as_array();
            if array.len() != part.len() {
                let (had, needs) = (array.len(), part.len());
                let message =
                    format!("an action leaves {had} numbers in {name} where {needs} are needed");
                return Err(PyValueError::new_err(message));
            }
            part.iter_mut().zip(array).for_each(|(part, number)| *part = *number);
        }
        Ok((armed, ends))
    });
    match outcome {
        Ok((armed, ends)) => {
            for (event, on) in armed {
                if on { jump.arm(event) } else { jump.disarm(event) }
            }
            if ends {
                jump.end();
            }
        }
        Err(error) => {
            raised.keep(error);
            jump.end();
        }
    }
}
