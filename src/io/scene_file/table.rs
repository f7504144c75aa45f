//! Tables of a scene file, and the keys of errors.
//!
//! Each table is read straight into the builder that it describes, so words, defaults and checks are those of
//! the API. Parsing keeps the position of every key (`toml::de::DeTable`; a serde derive would lose it inside
//! tables whose keys depend on `kind`, and knows no units). Overrides are parsed as if they followed the text
//! of the file and merged into its tables, so that their errors have a position, too. After each table the scene
//! so far is validated, and an error is put on the line of the key that it names.

use std::fmt::Display;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::absent::stand_in;
use super::keys::{Key, Kind, Meaning, TableKeys};
use super::source::SourceText;
use super::value::Value;
use crate::base::input::{InputError, list, unknown};
use crate::dynamics::error::Error;

/// The key of the kind of a table.
const KIND: &str = "kind";

/// A table whose keys are all known, with exactly one of its groups of keys, if it has any.
pub(super) struct Table<'a> {
    source: &'a SourceText<'a>,
    /// Its key, with those of the tables around it; empty for the whole file.
    key: String,
    at: Range<usize>,
    entries: &'a DeTable<'a>,
    keys: &'static TableKeys,
    kind: Option<&'static Kind>,
}

impl<'a> Table<'a> {
    /// # Errors
    /// A key that is none of `keys`; groups of keys of which not exactly one is there.
    pub(super) fn new(
        source: &'a SourceText<'a>,
        key: String,
        at: Range<usize>,
        entries: &'a DeTable<'a>,
        keys: &'static TableKeys,
    ) -> Result<Self, Error> {
        let mut table = Self { source, key, at, entries, keys, kind: None };
        if let Some(key) = table.first_beside(&table.names(keys.all())) {
            let name = key.get_ref();
            let known = table.names(keys.all().filter(|key| key.renamed_to.is_none()));
            let message = match stand_in(name).filter(|_| table.key.is_empty()) {
                Some(stand_in) => format!("scene files have no such table: {stand_in}"),
                None => format!("unknown key; {}", unknown(name, &known)),
            };
            return Err(source.error(&key.span(), &table.full(key.get_ref()), message));
        }
        if !keys.kinds.is_empty() {
            let words: Vec<_> = keys.kinds.iter().map(|kind| (kind.word, kind)).collect();
            let kind = table.required(KIND, |value| value.word(&words))?;
            let all = || kind.keys.iter().chain(keys.keys);
            if let Some(key) = table.first_beside(&table.names(all())) {
                let known = table.names(all().filter(|key| key.renamed_to.is_none()));
                let (word, known) = (kind.word, list(&known));
                let message = format!("kind = \"{word}\" has no such key; it has {known}");
                return Err(source.error(&key.span(), &table.full(key.get_ref()), message));
            }
            table.kind = Some(kind);
        }
        table.check_groups()?;
        table.note_old_names()?;
        Ok(table)
    }

    /// The word that stands for the key `kind`.
    /// Its name, as `hold`.
    pub(super) fn name(&self) -> &'static str {
        self.keys.name
    }

    pub(super) fn kind(&self) -> &'static str {
        self.kind.map_or("", |kind| kind.word)
    }

    /// Path of the file.
    #[cfg(feature = "sweep")]
    pub(super) fn path(&self) -> &'a std::path::Path {
        self.source.path
    }

    fn names(&self, keys: impl Iterator<Item = &'static Key>) -> Vec<&'static str> {
        let mut names = if self.keys.kinds.is_empty() { Vec::new() } else { vec![KIND] };
        for key in keys {
            if !names.contains(&key.name) {
                names.push(key.name);
            }
        }
        names
    }

    /// The first key in the file that is none of the `known` ones.
    fn first_beside(&self, known: &[&str]) -> Option<&'a Spanned<DeString<'a>>> {
        let strange = self.entries.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        strange.min_by_key(|key| key.span().start)
    }

    fn check_groups(&self) -> Result<(), Error> {
        let groups = self.keys.one_of;
        let there = |key: &&&str| self.entries.contains_key(**key);
        let mut found: Vec<&str> = Vec::new();
        for key in groups.concat().iter().filter(there) {
            if !found.contains(key) {
                found.push(key);
            }
        }
        let are_found = |group: &&[&str]| {
            group.len() == found.len() && group.iter().all(|key| found.contains(key))
        };
        if groups.is_empty() || groups.iter().any(are_found) {
            return Ok(());
        }
        let told = |key: &&str| format!("{key}: {}", self.meaning(key));
        let told = |group: &&[&str]| group.iter().map(told).collect::<Vec<_>>().join(", and ");
        let groups: Vec<String> = groups.iter().map(told).collect();
        let expected = format!("expected either {}", groups.join("; or "));
        Err(match found[..] {
            [] => self.missing(self.keys.one_of[0][0], expected),
            _ => self.error(format!("{expected}; found {}", found.join(" and "))),
        })
    }

    fn note_old_names(&self) -> Result<(), Error> {
        for key in self.keys.all() {
            let (Some(now), Some(value)) = (key.renamed_to, self.entries.get(key.name)) else {
                continue;
            };
            let old = key.name;
            if self.entries.contains_key(now) {
                return Err(self.error(format!("{old} is the old name of {now}: give that alone")));
            }
            let (line, full) = (self.source.line(value.span().start), self.full(old));
            self.source.note(format!(
                "line {line}: {full} is read as {now}, its name now: {}",
                key.meaning.text
            ));
        }
        Ok(())
    }

    /// Meaning of the key `name`.
    fn meaning(&self, name: &str) -> Meaning {
        if name == KIND {
            return Meaning { text: "the kind", unit: "" };
        }
        let mut of_kind = self.kind.iter().flat_map(|kind| kind.keys);
        let key = of_kind.find(|key| key.name == name);
        let key = key.or_else(|| self.keys.keys.iter().find(|key| key.name == name));
        debug_assert!(key.is_some(), "{} has no key {name}", self.keys.name);
        key.map_or(Meaning { text: "", unit: "" }, |key| key.meaning)
    }

    /// The value of `key`, or of its old name, if it is there.
    pub(super) fn get(&self, name: &str) -> Option<Value<'a>> {
        let meaning = self.meaning(name);
        let mut old =
            self.keys.all().filter(|key| key.renamed_to == Some(name)).map(|key| key.name);
        let value = self.entry(name).or_else(|| old.find_map(|old| self.entry(old)))?;
        Some(Value { meaning, ..value })
    }

    fn entry(&self, key: &str) -> Option<Value<'a>> {
        let value = self.entries.get(key)?;
        let (key, at) = (self.full(key), value.span());
        let meaning = Meaning { text: "", unit: "" };
        Some(Value { source: self.source, key, meaning, at, value: value.get_ref() })
    }

    /// The value of `key` as `read` reads it, if it is there.
    pub(super) fn optional<T>(
        &self,
        key: &str,
        read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
    ) -> Result<Option<T>, Error> {
        self.get(key).map(|value| read(&value)).transpose()
    }

    /// The value of `key` as `read` reads it.
    pub(super) fn required<T>(
        &self,
        key: &str,
        read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.optional(key, read)?
            .ok_or_else(|| self.missing(key, format!("expected {}", self.meaning(key))))
    }

    /// Result of `add` for `whole` and the value of `key` as `read` reads it; `whole` alone if the key is missing.
    pub(super) fn added<W, T>(
        &self,
        whole: W,
        key: &str,
        read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
        add: impl FnOnce(W, T) -> W,
    ) -> Result<W, Error> {
        Ok(match self.optional(key, read)? {
            Some(value) => add(whole, value),
            None => whole,
        })
    }

    /// Whether `key` is there and true.
    pub(super) fn flag(&self, key: &str) -> Result<bool, Error> {
        Ok(self.optional(key, Value::flag)?.unwrap_or(false))
    }

    /// The tables with these `keys` that `key` lists; none if it is not there.
    pub(super) fn tables(&self, key: &str, keys: &'static TableKeys) -> Result<Vec<Self>, Error> {
        Ok(self.optional(key, |value| value.tables(keys))?.unwrap_or_default())
    }

    /// The error that `key` is missing.
    pub(super) fn missing(&self, key: &str, help: impl Display) -> Error {
        self.source.error(&self.at, &self.full(key), format!("missing; {help}"))
    }

    /// An error about the whole table.
    pub(super) fn error(&self, message: impl Display) -> Error {
        self.source.error(&self.at, &self.key, message)
    }

    fn full(&self, key: &str) -> String {
        if self.key.is_empty() { key.into() } else { format!("{}.{key}", self.key) }
    }

    /// Gives an error about what was made of this table the line of the key that it is about, if that is
    /// known, or else the line of the table. An error that has a line already stays as it is.
    pub(super) fn blame(&self, error: impl Into<Error>) -> Error {
        let error = error.into();
        let (input, value, help) = match &error {
            Error::Input(InputError { input, value, help }) => (input, value, help),
            Error::SceneFile { .. } => return error,
            _ => return self.error(error),
        };
        if value == "(missing)" {
            return self.missing(input.rsplit(' ').next().unwrap_or(input), help);
        }
        match self.culprit(input) {
            None => self.error(&error),
            Some(found) if is_name_of(input, &found.key) => {
                found.error(format!("{} cannot be used: {help}", found.found()))
            }
            Some(found) => found.error(&error),
        }
    }

    /// The value, in this table or one inside of it, whose key is the last word of `input` that is a key.
    fn culprit(&self, input: &str) -> Option<Value<'a>> {
        let mut words = input.split(|c: char| !c.is_alphanumeric() && c != '_').rev();
        let found = words.find_map(|word| self.entry(word))?;
        let Some(entries) = found.entries() else { return Some(found) };
        let Value { source, key, at, .. } = found.clone();
        Table { source, key, at, entries, ..*self }.culprit(input).or(Some(found))
    }
}

impl<'a> Value<'a> {
    /// A table with these `keys`.
    pub(super) fn table(&self, keys: &'static TableKeys) -> Result<Table<'a>, Error> {
        let DeValue::Table(entries) = self.value else {
            // the word alone, where it is one of several keys
            let kind = self.value.as_str().and_then(|word| {
                keys.kinds.iter().find(|kind| kind.word == word).map(|kind| kind.word)
            });
            return Err(match kind {
                Some(word) => self.unexpected(format!("a table: {{ kind = \"{word}\" }}")),
                None => self.unexpected("a table"),
            });
        };
        Table::new(self.source, self.key.clone(), self.at.clone(), entries, keys)
    }

    /// Tables with these `keys`: a list of them, or one alone.
    pub(super) fn tables(&self, keys: &'static TableKeys) -> Result<Vec<Table<'a>>, Error> {
        self.one_or_more()?.iter().map(|value| value.table(keys)).collect()
    }
}

/// Whether `input`, as in `material.young` or `obstacle "floor" stiffness`, is the value of `key` and
/// not a part of it or something that follows from it.
fn is_name_of(input: &str, key: &str) -> bool {
    let key = key.rsplit('.').next().unwrap_or(key);
    let owner = input.strip_suffix(key);
    owner.is_some_and(|owner| owner.is_empty() || owner.ends_with('.') || owner.ends_with("\" "))
}
