//! Values of a scene file, read with errors that name the expected kind.

use std::fmt::Display;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::keys::Meaning;
use super::set_value::number;
use super::source::SourceText;
use crate::base::formula::Formula;
use crate::base::input::{Fraction, InputError, list, unknown};
use crate::dynamics::error::Error;
use crate::scene::forces::{Signal, VectorSignal};

/// A value with all that an error about it needs.
#[derive(Clone)]
pub(super) struct Value<'a> {
    pub(super) source: &'a SourceText<'a>,
    /// Its key, with those of the tables around it.
    pub(super) key: String,
    pub(super) meaning: Meaning,
    pub(super) at: Range<usize>,
    pub(super) value: &'a DeValue<'a>,
}

impl<'a> Value<'a> {
    /// An error about this value.
    pub(super) fn error(&self, message: impl Display) -> Error {
        self.source.error(&self.at, &self.key, message)
    }

    /// This value is not of the `expected` kind.
    pub(super) fn unexpected(&self, expected: impl Display) -> Error {
        self.error(format!("expected {}: {expected}; found {}", self.meaning, self.found()))
    }

    /// The value as it is written, or its kind if that is long.
    pub(super) fn found(&self) -> String {
        let text = self.source.text.get(self.at.clone()).unwrap_or_default();
        match self.value {
            _ if (1..60).contains(&text.len()) && !text.contains('\n') => text.into(),
            DeValue::Array(list) => format!("a list of {}", list.len()),
            DeValue::Table(_) => "a table".into(),
            _ => "a long text".into(),
        }
    }

    /// The value as it is written.
    #[cfg(feature = "sweep")]
    pub(super) fn text(&self) -> &'a str {
        self.source.text.get(self.at.clone()).unwrap_or_default()
    }

    /// The line where it stands, from 1.
    #[cfg(feature = "sweep")]
    pub(super) fn line(&self) -> usize {
        self.source.line(self.at.start)
    }

    /// Whether it is written as a whole number.
    #[cfg(feature = "sweep")]
    pub(super) fn is_whole(&self) -> bool {
        matches!(self.value, DeValue::Integer(_))
    }

    /// A part of a whole, as a number or a text: 0.01, "1%".
    pub(super) fn fraction(&self) -> Result<Fraction, Error> {
        let fraction = match self.number() {
            Ok(number) => number.to_string().parse(),
            Err(_) => self.string()?.parse(),
        };
        fraction.map_err(|error: InputError| self.error(error.help))
    }

    /// A number, whole or not.
    pub(super) fn number(&self) -> Result<f64, Error> {
        number(self.value).ok_or_else(|| self.unexpected("a number"))
    }

    /// A finite number.
    pub(super) fn finite(&self) -> Result<f64, Error> {
        let number = self.number()?;
        if number.is_finite() { Ok(number) } else { Err(self.unexpected("a finite number")) }
    }

    /// A whole number, 0 or above.
    pub(super) fn count(&self) -> Result<usize, Error> {
        let count = match self.value {
            DeValue::Integer(integer) => {
                usize::from_str_radix(integer.as_str(), integer.radix()).ok()
            }
            _ => None,
        };
        count.ok_or_else(|| self.unexpected("a whole number, 0 or above"))
    }

    pub(super) fn flag(&self) -> Result<bool, Error> {
        match self.value {
            DeValue::Boolean(flag) => Ok(*flag),
            _ => Err(self.unexpected("true or false")),
        }
    }

    pub(super) fn string(&self) -> Result<&'a str, Error> {
        match self.value {
            DeValue::String(string) => Ok(string),
            _ => Err(self.unexpected("a text in quotes")),
        }
    }

    /// One of the `known` words, with its meaning.
    pub(super) fn word<T: Clone>(&self, known: &[(&str, T)]) -> Result<T, Error> {
        let words: Vec<&str> = known.iter().map(|(word, _)| *word).collect();
        let DeValue::String(string) = self.value else {
            return Err(self.unexpected(format!("one of {}", list(&words))));
        };
        let found = known.iter().find(|(word, _)| word == string);
        found.map(|(_, meant)| meant.clone()).ok_or_else(|| self.unknown(string, &words))
    }

    /// The `word` in this value is none of the `known` ones.
    pub(super) fn unknown(&self, word: &str, known: &[&str]) -> Error {
        self.error(format!("\"{word}\" is unknown; {}", unknown(word, known)))
    }

    /// The values of a list.
    pub(super) fn list(&self) -> Result<Vec<Value<'a>>, Error> {
        let DeValue::Array(list) = self.value else {
            return Err(self.unexpected("a list"));
        };
        let item = |item: &'a toml::Spanned<DeValue<'a>>| Value {
            at: item.span(),
            value: item.get_ref(),
            ..self.clone()
        };
        Ok(list.iter().map(item).collect())
    }

    /// A list, or one value alone.
    pub(super) fn one_or_more(&self) -> Result<Vec<Value<'a>>, Error> {
        match self.value {
            DeValue::Array(_) => self.list(),
            _ => Ok(vec![self.clone()]),
        }
    }

    /// A finite number, or a list of them.
    pub(super) fn one_or_more_numbers(&self) -> Result<Vec<f64>, Error> {
        self.one_or_more()?.iter().map(Value::finite).collect()
    }

    /// A list of finite numbers.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, Error> {
        self.list_of("finite numbers", Self::finite)
    }

    /// A list of values that `read` reads.
    pub(super) fn list_of<T>(
        &self,
        what: &str,
        read: impl FnMut(&Value<'a>) -> Result<T, Error>,
    ) -> Result<Vec<T>, Error> {
        let list = self.list().map_err(|_| self.unexpected(format!("a list of {what}")))?;
        list.iter().map(read).collect()
    }

    /// A list of so many numbers.
    pub(super) fn array<const N: usize>(&self) -> Result<[f64; N], Error> {
        let numbers = self.numbers()?;
        numbers.try_into().map_err(|_| self.unexpected(number_of(N, "number")))
    }

    /// A list of so many whole numbers, 0 or above.
    pub(super) fn counts<const N: usize>(&self) -> Result<[usize; N], Error> {
        let counts = self.list_of("whole numbers", Self::count)?;
        counts.try_into().map_err(|_| self.unexpected(number_of(N, "whole number")))
    }

    /// A list of finite numbers, one per dimension of space.
    pub(super) fn vector(&self, dimension: usize) -> Result<Vec<f64>, Error> {
        let expected = || format!("{}, one per dimension", number_of(dimension, "number"));
        let numbers = self.numbers()?;
        if numbers.len() == dimension { Ok(numbers) } else { Err(self.unexpected(expected())) }
    }

    /// A finite number, or a formula of time.
    pub(super) fn signal(&self) -> Result<Signal, Error> {
        match self.value {
            DeValue::String(text) => {
                Signal::formula(text).map_err(|error| self.no_formula(&error.help))
            }
            _ => Ok(self.changing(Self::finite)?.into()),
        }
    }

    /// A formula of time; a number alone is one, too.
    pub(super) fn formula(&self) -> Result<Formula, Error> {
        let text = match self.value {
            DeValue::String(text) => text.to_string(),
            _ => format!("{:?}", self.changing(Self::finite)?),
        };
        Formula::parse(&text).map_err(|problem| self.no_formula(&problem))
    }

    /// So many formulas of time, one `per` dimension or axis; one may stand alone.
    pub(super) fn formulas(&self, count: usize, per: &str) -> Result<Vec<Formula>, Error> {
        let formulas =
            self.one_or_more()?.iter().map(Self::formula).collect::<Result<Vec<_>, _>>()?;
        match formulas.len() == count {
            true => Ok(formulas),
            false => {
                let what = number_of(count, "component");
                Err(self.unexpected(format!("{what}, one per {per}")))
            }
        }
    }

    /// A vector, or formulas of its components.
    pub(super) fn vector_signal(&self, dimension: usize) -> Result<VectorSignal, Error> {
        // in the plane a moment is a number
        if dimension == 1 && matches!(self.value, DeValue::Float(_) | DeValue::Integer(_)) {
            return Ok(VectorSignal::Constant(vec![self.finite()?]));
        }
        let items = self.one_or_more()?;
        if !items.iter().any(|item| matches!(item.value, DeValue::String(_))) {
            return Ok(VectorSignal::Constant(self.vector(dimension)?));
        }
        Ok(VectorSignal::Formulas(self.formulas(dimension, "dimension")?.into()))
    }

    /// The number that `read` reads; anything else is an error.
    fn changing(&self, read: impl Fn(&Self) -> Result<f64, Error>) -> Result<f64, Error> {
        match self.value {
            DeValue::Float(_) | DeValue::Integer(_) => read(self),
            _ => Err(self.unexpected("a number, or a formula of time in quotes")),
        }
    }

    fn no_formula(&self, problem: &str) -> Error {
        self.error(format!("{} is no formula of time: {problem}", self.found()))
    }

    /// The entries, if the value is a table.
    pub(super) fn entries(&self) -> Option<&'a DeTable<'a>> {
        match self.value {
            DeValue::Table(entries) => Some(entries),
            _ => None,
        }
    }
}

/// As in "1 number", "2 numbers".
pub(super) fn number_of(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A name, which is one of those known.
///
/// # Errors
/// Any other one.
pub(super) fn named(value: &Value, known: &[&str]) -> Result<String, Error> {
    let name = value.string()?;
    match known.contains(&name) {
        true => Ok(name.into()),
        false => Err(value.unknown(name, known)),
    }
}
