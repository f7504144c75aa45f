//! Tables of a scene file, and which of their keys an error is about.

use std::fmt::Display;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::source::Source;
use super::value::Value;
use crate::error::Error;
use crate::input::{InputError, list, unknown};

/// A table all of whose keys are known.
pub(super) struct Table<'a> {
    source: &'a Source<'a>,
    /// Its key, with those of the tables around it; empty for the whole file.
    key: String,
    at: Range<usize>,
    entries: &'a DeTable<'a>,
}

impl<'a> Table<'a> {
    /// # Errors
    /// A key that is none of the `known` ones.
    pub(super) fn new(
        source: &'a Source<'a>,
        key: String,
        at: Range<usize>,
        entries: &'a DeTable<'a>,
        known: &[&str],
    ) -> Result<Self, Error> {
        let table = Self { source, key, at, entries };
        match table.first_beside(known) {
            None => Ok(table),
            Some(key) => {
                let message = format!("unknown key; {}", unknown(key.get_ref(), known));
                Err(source.error(&key.span(), &table.full(key.get_ref()), message))
            }
        }
    }

    /// The same table, if it has no keys but those of its `kind`.
    pub(super) fn restricted(self, known: &[&str], kind: &str) -> Result<Self, Error> {
        match self.first_beside(known) {
            None => Ok(self),
            Some(key) => {
                let message = format!("kind = \"{kind}\" has no such key; it has {}", list(known));
                Err(self.source.error(&key.span(), &self.full(key.get_ref()), message))
            }
        }
    }

    /// The first key in the file that is none of the `known` ones.
    fn first_beside(&self, known: &[&str]) -> Option<&'a Spanned<DeString<'a>>> {
        let strange = self.entries.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        strange.min_by_key(|key| key.span().start)
    }

    /// The value of `key`, if it is there. `meaning` says what it is, with its unit.
    pub(super) fn get(&self, key: &str, meaning: &'static str) -> Option<Value<'a>> {
        let value = self.entries.get(key)?;
        let (key, at) = (self.full(key), value.span());
        Some(Value { source: self.source, key, meaning, at, value: value.get_ref() })
    }

    /// The value of `key` as `read` reads it, if it is there.
    pub(super) fn optional<T>(
        &self,
        key: &str,
        meaning: &'static str,
        read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
    ) -> Result<Option<T>, Error> {
        self.get(key, meaning).map(|value| read(&value)).transpose()
    }

    /// The value of `key` as `read` reads it.
    pub(super) fn required<T>(
        &self,
        key: &str,
        meaning: &'static str,
        read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.optional(key, meaning, read)?
            .ok_or_else(|| self.missing(key, format!("expected {meaning}")))
    }

    /// `key` should be there.
    pub(super) fn missing(&self, key: &str, mend: impl Display) -> Error {
        self.source.error(&self.at, &self.full(key), format!("missing; {mend}"))
    }

    /// An error about the whole table.
    pub(super) fn error(&self, message: impl Display) -> Error {
        self.source.error(&self.at, &self.key, message)
    }

    fn full(&self, key: &str) -> String {
        if self.key.is_empty() { key.into() } else { format!("{}.{key}", self.key) }
    }

    /// Puts an error about what was made of this table on the line of the key it is about, if that
    /// is known, or else on that of the table. An error that has its line already stays as it is.
    pub(super) fn blame(&self, error: impl Into<Error>) -> Error {
        let error = error.into();
        let (input, value, mend) = match &error {
            Error::Input(InputError { input, value, mend }) => (input, value, mend),
            Error::SceneFile { .. } => return error,
            _ => return self.error(error),
        };
        if value == "(missing)" {
            return self.missing(input.rsplit(' ').next().unwrap_or(input), mend);
        }
        match self.culprit(input) {
            None => self.error(&error),
            Some(found) if is_name_of(input, &found.key) => {
                found.error(format!("{} cannot be used: {mend}", found.found()))
            }
            Some(found) => found.error(&error),
        }
    }

    /// The value, in this table or one inside of it, that the last possible word of `input` names.
    fn culprit(&self, input: &str) -> Option<Value<'a>> {
        let mut words = input.split(|c: char| !c.is_alphanumeric() && c != '_').rev();
        let found = words.find_map(|word| self.get(word, ""))?;
        let Some(entries) = found.entries() else { return Some(found) };
        let Value { source, key, at, .. } = found.clone();
        Table { source, key, at, entries }.culprit(input).or(Some(found))
    }
}

impl<'a> Value<'a> {
    /// A table with the keys `known`.
    pub(super) fn table(&self, known: &[&str]) -> Result<Table<'a>, Error> {
        let DeValue::Table(entries) = self.value else {
            return Err(self.unexpected("a table"));
        };
        Table::new(self.source, self.key.clone(), self.at.clone(), entries, known)
    }

    /// Tables with the keys `known`: a list of them, or one alone.
    pub(super) fn tables(&self, known: &[&str]) -> Result<Vec<Table<'a>>, Error> {
        self.one_or_more()?.iter().map(|value| value.table(known)).collect()
    }

    /// A table with a key `kind`, one of the words of `kinds`. Its other keys are those that come
    /// with the kind and the `common` ones.
    pub(super) fn table_of_kind<K: Copy>(
        &self,
        kinds: &[(&str, K, &[&str])],
        common: &[&str],
    ) -> Result<(K, Table<'a>), Error> {
        let mut all = [&["kind"], common].concat();
        for key in kinds.iter().flat_map(|(_, _, keys)| keys.iter()) {
            if !all.contains(key) {
                all.push(key);
            }
        }
        let words: Vec<(&str, usize)> = kinds.iter().map(|(word, ..)| *word).zip(0..).collect();
        let table = self.table(&all)?;
        let chosen = table.required("kind", "the kind", |value| value.word(&words))?;
        let (word, kind, keys) = kinds[chosen];
        let table = table.restricted(&[&["kind"], keys, common].concat(), word)?;
        Ok((kind, table))
    }
}

/// Whether `input`, as in `material.young` or `obstacle "floor" stiffness`, is the value of `key` and
/// not a part of it or something that follows from it.
fn is_name_of(input: &str, key: &str) -> bool {
    let key = key.rsplit('.').next().unwrap_or(key);
    let owner = input.strip_suffix(key);
    owner.is_some_and(|owner| owner.is_empty() || owner.ends_with('.') || owner.ends_with("\" "))
}
