//! Numbers and vectors that may change with time: actuation forces, pressures, loads.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::time_table::TimeTable;
use crate::base::formula::Formula;
use crate::base::input::{InputError, finite};
use crate::integrators::ode::Failure;

/// A number, constant or changing with time (s): a pressure (Pa), the force of an actuator (N).
///
/// A number converts into a constant one.
#[derive(Clone)]
pub struct Signal(pub(crate) SignalKind);

/// Kind of a [`Signal`], with its data.
#[derive(Clone)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum SignalKind {
    Constant(f64),
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    Function {
        function: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
        breaks: Vec<f64>,
    },
    #[cfg_attr(feature = "checkpoint", serde(rename = "table"))]
    TimeTable(TimeTable),
    Formula(Arc<Formula>),
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    Shared(SharedValue),
    /// An unknown of a run and its rate, as they are at the time for which forces are evaluated.
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    State(SharedValue),
}

/// Numbers that stay until a command sets others, even while forces read them.
#[derive(Clone)]
pub(crate) struct SharedValue(Arc<[AtomicU64]>);

impl SharedValue {
    pub(crate) fn new(values: &[f64]) -> Self {
        Self(values.iter().map(|value| AtomicU64::new(value.to_bits())).collect())
    }

    /// Sets them.
    pub(crate) fn set(&self, values: &[f64]) {
        self.0
            .iter()
            .zip(values)
            .for_each(|(x, value)| x.store(value.to_bits(), Ordering::Relaxed));
    }

    /// Their number.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn get(&self) -> Vec<f64> {
        (0..self.0.len()).map(|number| self.at(number)).collect()
    }

    fn at(&self, number: usize) -> f64 {
        f64::from_bits(self.0[number].load(Ordering::Relaxed))
    }
}

impl Signal {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self(SignalKind::Constant(value))
    }

    /// A function of time (s), smooth except at its [breaks](Self::with_breaks).
    ///
    /// It is evaluated at times ahead, up to the end of the phase, so that steps do not pass over pulses: those that last longer than
    /// about a hundred-thousandth of the time between two breaks are found. Shorter ones need breaks.
    pub fn function(f: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self(SignalKind::Function { function: Arc::new(f), breaks: Vec::new() })
    }

    /// An unknown of a run: `state` and its rate.
    pub(crate) fn of_state(state: SharedValue) -> Self {
        Self(SignalKind::State(state))
    }

    /// The same signal, times a `factor`.
    pub(crate) fn times(self, factor: f64) -> Self {
        match self.value() {
            _ if factor == 1.0 => self,
            Some(value) => Self::constant(factor * value),
            None => match &self.0 {
                SignalKind::Formula(formula) => {
                    Self(SignalKind::Formula(Arc::new(formula.times(factor))))
                }
                SignalKind::TimeTable(table) => Self(SignalKind::TimeTable(table.times(factor))),
                _ => {
                    let breaks = self.breaks().to_vec();
                    Self::function(move |t| factor * self.at(t)).with_breaks(breaks)
                }
            },
        }
    }

    /// A formula of time `t` (s): `"2000 * sin(2*pi*3*t)"`.
    ///
    /// It consists of numbers, `t`, `pi`, `e`, `+ - * / ^`, parentheses and the functions `sin`, `cos`,
    /// `tan`, `asin`, `acos`, `atan`, `sinh`, `cosh`, `tanh`, `exp`, `ln`, `log10`, `sqrt`, `abs`, `min`,
    /// `max` (of two numbers) and `step` (0 below 0, else 1). Powers come before signs: `-t^2` is -(t^2).
    /// Steps end at its kinks and jumps, and never skip a pulse in between.
    ///
    /// # Errors
    /// A text that is not a formula, with the position of the mistake.
    pub fn formula(text: &str) -> Result<Self, InputError> {
        let formula = Formula::parse(text);
        let formula = formula.map_err(|problem| InputError::new("formula", text, problem))?;
        Ok(Self(SignalKind::Formula(Arc::new(formula))))
    }

    /// A signal with the `values` at the `times` (s, ascending). In between it is interpolated linearly;
    /// before and after it is constant.
    pub fn table(times: impl Into<Vec<f64>>, values: impl Into<Vec<f64>>) -> Self {
        let values = values.into().into_iter().map(|value| vec![value]).collect();
        Self(SignalKind::TimeTable(TimeTable::new(times.into(), values)))
    }

    /// The same table repeated with the `period` (s), up to the time `until` (s). Between its last time and the first
    /// one of the next repetition it is interpolated linearly, too.
    ///
    /// # Errors
    /// A signal that is not a table; a table that is invalid, longer than the period, or as long as it with different
    /// values at its ends; a period that is not above 0; more than a million repetitions.
    pub fn repeated(mut self, period: f64, until: f64) -> Result<Self, InputError> {
        match &mut self.0 {
            SignalKind::TimeTable(table) => table.repeat(period, until)?,
            _ => return Err(not_repeated(period)),
        }
        Ok(self)
    }

    /// A straight line from the value `from` at time `start` (s) to the value `to`, which it keeps,
    /// `duration` (s) later.
    pub fn ramp(from: f64, to: f64, start: f64, duration: f64) -> Self {
        Self::table([start, start + duration], [from, to])
    }

    /// The same function, with the times (s, ascending) at which it has a kink or a jump: steps end there.
    pub fn with_breaks(mut self, times: impl Into<Vec<f64>>) -> Self {
        if let SignalKind::Function { breaks, .. } = &mut self.0 {
            *breaks = times.into();
        }
        self
    }

    /// The straight line through 0 at t = 0 and the value of this signal at time `end` (s), and on beyond it.
    pub(crate) fn rising(&self, end: f64) -> Self {
        let whole = self.at(end);
        Self::function(move |t| t / end * whole)
    }

    /// The value at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        match &self.0 {
            SignalKind::Constant(value) => *value,
            SignalKind::Function { function, .. } => function(t),
            SignalKind::TimeTable(table) => table.at(t, 0),
            SignalKind::Formula(formula) => formula.at(t).0[0],
            SignalKind::Shared(live) | SignalKind::State(live) => live.at(0),
        }
    }

    /// Its rate at time `t` (s); of a function by the difference of two values.
    pub(crate) fn rate(&self, t: f64) -> f64 {
        match &self.0 {
            SignalKind::Constant(_) | SignalKind::Shared(_) => 0.0,
            SignalKind::Function { function, .. } => {
                let apart = f64::EPSILON.cbrt() * t.abs().max(1e-3);
                (function(t + apart) - function(t - apart)) / (2.0 * apart)
            }
            SignalKind::TimeTable(table) => table.rate(t, 0),
            SignalKind::Formula(formula) => formula.at(t).0[1],
            SignalKind::State(state) => state.at(1),
        }
    }

    /// Its rate up to time `t` (s); at a kink of a table that of the line before it, where a step ends.
    pub(crate) fn rate_before(&self, t: f64) -> f64 {
        match &self.0 {
            SignalKind::TimeTable(table) => table.rate_before(t, 0),
            _ => self.rate(t),
        }
    }

    /// The value of a constant.
    pub(crate) fn value(&self) -> Option<f64> {
        match &self.0 {
            SignalKind::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// The least value of a constant or a table.
    pub(crate) fn least(&self) -> Option<f64> {
        match &self.0 {
            SignalKind::TimeTable(table) => table.values.iter().flatten().copied().reduce(f64::min),
            _ => self.value(),
        }
    }

    /// The number that a command can set, if it is one.
    pub(crate) fn live(&self) -> Option<&SharedValue> {
        match &self.0 {
            SignalKind::Shared(live) => Some(live),
            _ => None,
        }
    }

    /// The same signal; a constant becomes a number that a command can set.
    pub(crate) fn settable(self) -> Self {
        self.value().map_or(self, |value| Self(SignalKind::Shared(SharedValue::new(&[value]))))
    }

    /// The same signal; a number that a command can set becomes a constant.
    pub(crate) fn snapshot(&self) -> Self {
        self.live().map_or_else(|| self.clone(), |live| Self::constant(live.at(0)))
    }

    /// Times (s) at which the signal changes its law.
    pub(crate) fn breaks(&self) -> &[f64] {
        match &self.0 {
            SignalKind::Constant(_) | SignalKind::Formula(_) => &[],
            SignalKind::Shared(_) | SignalKind::State(_) => &[],
            SignalKind::Function { breaks, .. } => breaks,
            SignalKind::TimeTable(table) => &table.times,
        }
    }

    /// Checks what can be known beforehand.
    pub(crate) fn validate(&self, input: &str) -> Result<(), InputError> {
        match &self.0 {
            SignalKind::Constant(value) => finite(input, &[*value]),
            SignalKind::Function { breaks, .. } => finite(&format!("breaks of {input}"), breaks),
            SignalKind::TimeTable(table) => table.validate(input, 1),
            SignalKind::Formula(_) => Ok(()),
            SignalKind::Shared(live) | SignalKind::State(live) => finite(input, &[live.at(0)]),
        }
    }
}

impl From<f64> for Signal {
    fn from(value: f64) -> Self {
        Self::constant(value)
    }
}

impl fmt::Debug for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            SignalKind::Constant(value) => write!(f, "{value}"),
            SignalKind::Function { .. } => f.write_str("function of time"),
            SignalKind::TimeTable(table) => table.fmt(f),
            SignalKind::Formula(formula) => formula.fmt(f),
            SignalKind::Shared(live) | SignalKind::State(live) => write!(f, "{}", live.at(0)),
        }
    }
}

/// Error: a `period` (s) given for a signal that is not a table.
fn not_repeated(period: f64) -> InputError {
    let help = "only tables have a period: formulas and functions can repeat by themselves";
    InputError::new("period", format!("{period} s"), help)
}

/// The sum of `signals` at time `t`.
pub(super) fn sum(signals: &[Signal], t: f64) -> f64 {
    signals.iter().map(|signal| signal.at(t)).sum()
}

/// Returns a `value` that a function of time gave, if it is finite.
pub(crate) fn finite_at(t: f64, what: fmt::Arguments<'_>, value: f64) -> Result<f64, Failure> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Failure::Fatal(
        format!("{what} is {value} at t = {t} s: it must be a finite number").into(),
    ))
}

/// Writes the vector at a time (s).
type WriteVector = dyn Fn(f64, &mut [f64]) + Send + Sync;

/// A vector that changes with time (s), with one component per dimension.
#[derive(Clone)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum VectorSignal {
    Constant(Vec<f64>),
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    Function {
        dimension: usize,
        write: Arc<WriteVector>,
    },
    #[cfg_attr(feature = "checkpoint", serde(rename = "table"))]
    TimeTable(TimeTable),
    /// One per component.
    Formulas(Arc<[Formula]>),
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    Shared(SharedValue),
}

impl VectorSignal {
    pub(crate) fn function<const D: usize>(
        f: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        let write = move |t: f64, vector: &mut [f64]| vector.copy_from_slice(&f(t));
        Self::Function { dimension: D, write: Arc::new(write) }
    }

    /// The same table over and over, each time `period` (s) later, up to the time `until` (s).
    pub(crate) fn repeated(mut self, period: f64, until: f64) -> Result<Self, InputError> {
        match &mut self {
            Self::TimeTable(table) => table.repeat(period, until)?,
            _ => return Err(not_repeated(period)),
        }
        Ok(self)
    }

    /// Writes it at time `t`.
    pub(crate) fn at(&self, t: f64, vector: &mut [f64]) {
        match self {
            Self::Constant(constant) => {
                vector.iter_mut().zip(constant).for_each(|(x, constant)| *x = *constant);
            }
            Self::Function { write, .. } => write(t, vector),
            Self::TimeTable(table) => {
                vector.iter_mut().enumerate().for_each(|(i, x)| *x = table.at(t, i));
            }
            Self::Formulas(formulas) => {
                vector.iter_mut().zip(&**formulas).for_each(|(x, formula)| *x = formula.at(t).0[0]);
            }
            Self::Shared(live) => vector.iter_mut().enumerate().for_each(|(i, x)| *x = live.at(i)),
        }
    }

    /// The numbers that a command can set, if it consists of such.
    pub(crate) fn live(&self) -> Option<&SharedValue> {
        match self {
            Self::Shared(live) => Some(live),
            _ => None,
        }
    }

    /// The same vector; a constant becomes numbers that a command can set.
    pub(crate) fn settable(self) -> Self {
        match self {
            Self::Constant(values) => Self::Shared(SharedValue::new(&values)),
            other => other,
        }
    }

    /// The same vector; numbers that a command can set become constants.
    pub(crate) fn snapshot(&self) -> Self {
        self.live().map_or_else(|| self.clone(), |live| Self::Constant(live.get()))
    }

    /// The same vector, times a `factor`.
    pub(crate) fn times(&self, factor: f64) -> Self {
        let scaled = |values: &[f64]| values.iter().map(|x| factor * x).collect::<Vec<f64>>();
        match self {
            Self::Constant(values) => Self::Constant(scaled(values)),
            Self::TimeTable(table) => Self::TimeTable(table.times(factor)),
            Self::Formulas(formulas) if factor != 1.0 => {
                Self::Formulas(formulas.iter().map(|formula| formula.times(factor)).collect())
            }
            _ if factor == 1.0 => self.clone(),
            varying => {
                let (varying, dimension) = (varying.clone(), varying.dimension());
                let write = move |t: f64, vector: &mut [f64]| {
                    varying.at(t, vector);
                    vector.iter_mut().for_each(|x| *x *= factor);
                };
                Self::Function { dimension, write: Arc::new(write) }
            }
        }
    }

    /// Some of its components.
    pub(crate) fn part(&self, components: [usize; 2]) -> Self {
        let chosen = |values: &[f64]| components.map(|i| values[i]).to_vec();
        match self {
            Self::Constant(values) => Self::Constant(chosen(values)),
            Self::TimeTable(TimeTable { times, values }) => {
                let values = values.iter().map(|values| chosen(values)).collect();
                Self::TimeTable(TimeTable::new(times.clone(), values))
            }
            Self::Formulas(formulas) => {
                Self::Formulas(components.map(|i| formulas[i].clone()).into())
            }
            varying => {
                let (varying, dimension) = (varying.clone(), varying.dimension());
                let write = move |t: f64, vector: &mut [f64]| {
                    let mut all = [0.0; 3];
                    varying.at(t, &mut all[..dimension]);
                    vector.iter_mut().zip(components).for_each(|(x, i)| *x = all[i]);
                };
                Self::Function { dimension: components.len(), write: Arc::new(write) }
            }
        }
    }

    /// Its number of components.
    fn dimension(&self) -> usize {
        match self {
            Self::Constant(values) => values.len(),
            Self::Function { dimension, .. } => *dimension,
            Self::TimeTable(table) => table.values.first().map_or(0, Vec::len),
            Self::Formulas(formulas) => formulas.len(),
            Self::Shared(live) => live.0.len(),
        }
    }

    /// Times (s) at which the vector changes its law.
    pub(crate) fn breaks(&self) -> &[f64] {
        match self {
            Self::Constant(_) | Self::Function { .. } | Self::Formulas(_) | Self::Shared(_) => &[],
            Self::TimeTable(table) => &table.times,
        }
    }

    /// Checks what can be known beforehand.
    pub(crate) fn validate(
        &self,
        input: &str,
        needed: usize,
        unit: &str,
    ) -> Result<(), InputError> {
        let numbers = |values: &[f64]| {
            if values.len() != needed {
                let help = format!("it needs {needed} component(s) ({unit})");
                return Err(InputError::new(input, format!("{values:?}"), help));
            }
            finite(input, values)
        };
        match self {
            Self::Constant(values) => numbers(values),
            Self::Function { dimension, .. } if *dimension != needed => Err(InputError::new(
                format!("number of components of {input}"),
                dimension,
                format!("it must give {needed} component(s) ({unit})"),
            )),
            Self::Function { .. } => Ok(()),
            Self::TimeTable(table) => table.validate(input, needed),
            Self::Formulas(formulas) if formulas.len() == needed => Ok(()),
            Self::Formulas(formulas) => {
                let help = format!("it needs {needed} component(s) ({unit})");
                Err(InputError::new(input, format!("{formulas:?}"), help))
            }
            Self::Shared(live) => numbers(&live.get()),
        }
    }
}

impl fmt::Debug for VectorSignal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(values) => write!(f, "{values:?}"),
            Self::Function { .. } => f.write_str("function of time"),
            Self::TimeTable(table) => table.fmt(f),
            Self::Formulas(formulas) => formulas.fmt(f),
            Self::Shared(live) => write!(f, "{:?}", live.get()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_run_along_straight_lines() {
        let table = TimeTable::new(
            vec![0.5, 1.0, 3.0],
            vec![vec![2.0, 0.0], vec![-1.0, 4.0], vec![0.0, 5.0]],
        );
        table.validate("f", 2).unwrap();
        let expected = |t: f64| match t {
            t if t <= 0.5 => [2.0, 0.0],
            t if t <= 1.0 => [2.0 - 6.0 * (t - 0.5), 8.0 * (t - 0.5)],
            t if t <= 3.0 => [-1.0 + 0.5 * (t - 1.0), 4.0 + 0.5 * (t - 1.0)],
            _ => [0.0, 5.0],
        };
        let signal = VectorSignal::TimeTable(table);
        for k in 0..=35 {
            let (t, mut found) = (0.1 * f64::from(k), [f64::NAN; 2]);
            signal.at(t, &mut found);
            for (found, expected) in found.into_iter().zip(expected(t)) {
                assert!((found - expected).abs() < 1e-14, "{t}: {found} {expected}");
            }
        }
        assert_eq!(signal.breaks(), [0.5, 1.0, 3.0]);
        let ramp = Signal::ramp(0.0, -1.0, 0.0, 0.1);
        assert_eq!([-1.0, 0.0, 0.025, 0.1, 2.0].map(|t| ramp.at(t)), [0.0, 0.0, -0.25, -1.0, -1.0]);
    }
}
