//! Values that take the place of those in the file, as `body.material.young=2e5`.

#[cfg(any(feature = "fit", feature = "sweep"))]
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::set_value::quoted;
#[cfg(feature = "gradient")]
use super::set_value::{SetValue, canonical};
use crate::base::input::{InputError, unknown};
use crate::dynamics::error::Error;

/// A scene, given as tables and lists of JSON, as the text of a scene file.
///
/// # Errors
/// A `scene` that is not a table, or values that TOML does not have, such as `null`.
pub fn toml_of(scene: &serde_json::Value) -> Result<String, Error> {
    toml::to_string(scene).map_err(|error| not_of_toml("scene", scene, &error))
}

/// The override that gives `key`, as in `phase.free.until`, this value, for
/// [`SceneFile::read_with`](super::SceneFile::read_with).
///
/// # Errors
/// As [`toml_of`].
pub fn override_of(key: &str, value: &serde_json::Value) -> Result<String, Error> {
    let toml = toml::Value::try_from(value).map_err(|error| not_of_toml(key, value, &error))?;
    Ok(format!("{key}={toml}"))
}

fn not_of_toml(key: &str, value: &serde_json::Value, error: &toml::ser::Error) -> Error {
    let beginning: String = value.to_string().chars().take(60).collect();
    InputError::new(key, beginning, error.to_string()).into()
}

/// The message of an error of the scene, without the place where it was found if that is an override.
#[cfg(any(feature = "fit", feature = "sweep"))]
pub(crate) fn problem(error: Error) -> String {
    match error {
        Error::SceneFile { path, key, message, .. } if path == Path::new("--set") => match &key[..]
        {
            "" => message,
            key => format!("{key}: {message}"),
        },
        Error::Input(InputError { input, value, help }) if input == "--set" => {
            format!("{value}: {help}")
        }
        error => error.to_string(),
    }
}

/// The text of an override as TOML: `KEY=VALUE`, in which a text needs no quotes.
pub(super) fn as_toml(text: &str) -> Result<String, Error> {
    let help = "write KEY=VALUE, as in body.material.young=2e5 or phase.2.until=1.5";
    let bad = || Error::from(InputError::new("--set", text, help));
    let (key, value) = text.split_once('=').ok_or_else(bad)?;
    let candidates = [format!("{key} = {value}"), format!("{key} = {}", quoted(value.trim()))];
    let is_one = |toml: &String| DeTable::parse(toml).is_ok_and(|table| table.get_ref().len() == 1);
    candidates.into_iter().find(is_one).ok_or_else(bad)
}

/// Puts the values of `over` in the places of those in `table`. In a list of tables a key is the name of one,
/// or its number (from 1). A single table counts as a list of one if the key requires a list, and the number of the only table in a list
/// may be left out.
pub(super) fn merge<'a>(
    table: &mut DeTable<'a>,
    over: DeTable<'a>,
    text: &str,
) -> Result<(), Error> {
    for (key, value) in over {
        let (is_whole, span) = (is_whole(&value, text), value.span());
        match (table.get_mut(key.get_ref().as_ref()), value.into_inner()) {
            (Some(old), DeValue::Table(new))
                if !is_whole && new.keys().all(|key| is_name_of(old, key.get_ref())) =>
            {
                new.into_iter().try_for_each(|(_, value)| put(old, value, text))?;
            }
            (Some(old), DeValue::Table(new)) if !is_whole => match old.get_mut() {
                DeValue::Table(old) => merge(old, new, text)?,
                DeValue::Array(list) => match only(list, &new, text) {
                    Some(old) => merge(old, new, text)?,
                    None => merge_list(key.get_ref(), list, new, text)?,
                },
                _ => *old = Spanned::new(span, DeValue::Table(new)),
            },
            (Some(old), value) => *old = Spanned::new(span, value),
            (None, value) => _ = table.insert(key, Spanned::new(span, value)),
        }
    }
    Ok(())
}

/// Puts a value in the place of another one, or in it if both are tables and it is not in braces.
fn put<'a>(
    old: &mut Spanned<DeValue<'a>>,
    value: Spanned<DeValue<'a>>,
    text: &str,
) -> Result<(), Error> {
    let (is_whole, span) = (is_whole(&value, text), value.span());
    match (old.get_mut(), value.into_inner()) {
        (DeValue::Table(old), DeValue::Table(new)) if !is_whole => merge(old, new, text)?,
        (_, value) => *old = Spanned::new(span, value),
    }
    Ok(())
}

/// Whether a key names a single table, as it would in a list of one: by its name or the number 1.
pub(super) fn is_name_of(value: &Spanned<DeValue>, key: &str) -> bool {
    let is_new = value.get_ref().as_table().is_some_and(|table| !table.contains_key(key));
    is_new && (key == "1" || name_of(value) == Some(key))
}

/// Whether a key is one in the only table of a list, whose number is left out: one that the table has, or, for what is no key
/// in a further table, any that is no number.
pub(super) fn is_key_of_only(list: &[Spanned<DeValue>], key: &str, is_last: bool) -> bool {
    let [only] = list else { return false };
    let table = only.get_ref().as_table().filter(|_| element(list, key).is_none());
    table.is_some_and(|table| table.contains_key(key) || (is_last && key.parse::<usize>().is_err()))
}

/// The only table of a list, if all keys of `over` are in it.
fn only<'l, 'a>(
    list: &'l mut [Spanned<DeValue<'a>>],
    over: &DeTable,
    text: &str,
) -> Option<&'l mut DeTable<'a>> {
    let mut entries = over.iter();
    let is_last =
        |value: &Spanned<DeValue>| value.get_ref().as_table().is_none() || is_whole(value, text);
    let are_its = entries.all(|(key, value)| is_key_of_only(list, key.get_ref(), is_last(value)));
    match list {
        [only] if are_its => match only.get_mut() {
            DeValue::Table(table) => Some(table),
            _ => None,
        },
        _ => None,
    }
}

/// Whether a value takes the place of all that was there, as tables in braces do.
pub(super) fn is_whole(value: &Spanned<DeValue>, text: &str) -> bool {
    text.get(value.span()).is_none_or(|written| written.starts_with('{'))
}

/// The place of the table in a list that has the name `key`, or else this number (from 1).
pub(super) fn element(list: &[Spanned<DeValue>], key: &str) -> Option<usize> {
    let by_name = list.iter().position(|value| name_of(value) == Some(key));
    let by_number = || key.parse::<usize>().ok()?.checked_sub(1);
    by_name.or_else(by_number).filter(|at| *at < list.len())
}

/// The place that a key has in a file, whatever way it is written: of elements of lists, which have names or numbers, the number,
/// and of a single table neither.
#[cfg(any(feature = "fit", feature = "sweep"))]
pub(super) fn place(document: &DeTable, key: &str) -> Vec<String> {
    let mut here = Some(document);
    let mut list: Option<&[Spanned<DeValue>]> = None;
    let mut place = Vec::new();
    let words: Vec<&str> =
        key.split('.').map(|word| word.trim().trim_matches(['"', '\''])).collect();
    let mut single: Option<&Spanned<DeValue>> = None;
    for (depth, &word) in words.iter().enumerate() {
        if single.is_some_and(|table| is_name_of(table, word)) {
            single = None;
            continue;
        }
        if let Some(of) = list.filter(|of| is_key_of_only(of, word, depth + 1 == words.len())) {
            place.push("1".to_owned());
            (here, list) = (of[0].get_ref().as_table(), None);
        }
        let at = list.and_then(|list| element(list, word));
        let value = match (at, list, here) {
            (Some(at), Some(list), _) => list.get(at),
            (_, None, Some(table)) => table.get(word),
            _ => None,
        };
        place.push(at.map_or_else(|| word.to_owned(), |at| (at + 1).to_string()));
        single = value.filter(|_| at.is_none());
        (here, list) = match value.map(Spanned::get_ref) {
            Some(DeValue::Table(table)) => (Some(table), None),
            Some(DeValue::Array(items)) => (None, Some(&items[..])),
            _ => (None, None),
        };
    }
    place
}

/// The value that a key has in the `text` of a scene file with other values for some keys.
///
/// # Errors
/// An override that is no key and value, or that has no place.
#[cfg(feature = "gradient")]
pub(super) fn value_of(
    text: &str,
    overrides: &[String],
    key: &str,
    no_toml: impl Fn(toml::de::Error) -> Error,
) -> Result<Option<SetValue>, Error> {
    let overrides = overrides.iter().map(|text| as_toml(text)).collect::<Result<Vec<_>, _>>()?;
    let mut document = DeTable::parse(text).map_err(&no_toml)?.into_inner();
    for over in &overrides {
        merge(&mut document, DeTable::parse(over).map_err(&no_toml)?.into_inner(), over)?;
    }
    let words = place(&document, key);
    let mut here = DeValue::Table(document);
    for word in words {
        let next = match here {
            DeValue::Table(mut table) => table.remove(&word[..]),
            DeValue::Array(list) => {
                let at = word.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
                at.and_then(|at| list.into_iter().nth(at))
            }
            _ => None,
        };
        let Some(next) = next else { return Ok(None) };
        here = next.into_inner();
    }
    Ok(Some(SetValue::of(&here, &canonical(&here))))
}

pub(super) fn name_of<'t>(value: &'t Spanned<DeValue>) -> Option<&'t str> {
    value.get_ref().as_table()?.get("name")?.get_ref().as_str()
}

fn merge_list<'a>(
    of: &str,
    list: &mut [Spanned<DeValue<'a>>],
    over: DeTable<'a>,
    text: &str,
) -> Result<(), Error> {
    let mut known: Vec<String> = (1..=list.len()).map(|number| number.to_string()).collect();
    known.extend(list.iter().filter_map(name_of).map(String::from));
    for (key, value) in over {
        let key = key.get_ref();
        let missing = || {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            InputError::new("--set", format!("{of}.{key}"), unknown(key, &known))
        };
        let at = element(list, key);
        let element = at.and_then(|at| list.get_mut(at)).ok_or_else(missing)?;
        put(element, value, text)?;
    }
    Ok(())
}
