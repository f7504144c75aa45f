//! Overrides written into the text of a scene file; all else stays as it was written.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::overrides::{as_toml, element, is_key_of_only, is_name_of, is_whole, merge};
use super::set_value::quoted;
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// The `text` of a scene file with the value of an override, as `body.material.young=2e5`, in its place.
///
/// # Errors
/// No key and value; a text in which there is no place for it.
pub(super) fn written(text: &str, over: &str) -> Result<String, Error> {
    let toml = as_toml(over)?;
    // a table of dotted keys has no place of its own in the text: its new entry goes before all else
    let candidates = [changed(text, &toml), Some(format!("{toml}\n{text}"))];
    let mut new = candidates.into_iter().flatten().filter(|new| is_meant(new, text, &toml));
    new.next().ok_or_else(|| {
        let help = "the text of the scene file has no place for it: write it into the file";
        InputError::new("--set", over, help).into()
    })
}

/// Keys that name files.
const FILES: [&str; 3] = ["file", "from", "reduced"];

/// Overrides that give the files which the `text` of a scene at `path` names by their whole paths: it may be moved then.
///
/// # Errors
/// A text that is no TOML.
pub(super) fn whole_paths(text: &str, path: &Path) -> Result<Vec<String>, Error> {
    let document = DeTable::parse(text)
        .map_err(|error| InputError::new("scene file", path.display(), error.message()))?;
    let mut found = Vec::new();
    add_files(document.get_ref(), "", &mut |key, file| {
        let file = path.parent().unwrap_or(Path::new("")).join(file);
        // a text of that name which is no file is the name of something else, and a missing file an error of the reader
        if file.is_file()
            && let Ok(whole) = std::path::absolute(&file)
        {
            found.push(format!("{key}={}", quoted(&whole.to_string_lossy())));
        }
    });
    Ok(found)
}

fn add_files(table: &DeTable, before: &str, see: &mut dyn FnMut(&str, &str)) {
    for (name, value) in table {
        let key = format!("{before}{}", name.get_ref());
        match value.get_ref() {
            DeValue::String(file) if FILES.contains(&name.get_ref().as_ref()) => see(&key, file),
            DeValue::Table(inner) => add_files(inner, &format!("{key}."), see),
            DeValue::Array(list) => {
                let tables = list.iter().map(|item| item.get_ref().as_table());
                for (number, inner) in (1..).zip(tables) {
                    let Some(inner) = inner else { continue };
                    add_files(inner, &format!("{key}.{number}."), see);
                }
            }
            _ => {}
        }
    }
}

/// The `text` with the entry `toml`.
fn changed(text: &str, toml: &str) -> Option<String> {
    let (document, over) = (DeTable::parse(text).ok()?, DeTable::parse(toml).ok()?);
    let (path, value) = entry(over.get_ref(), toml)?;
    let mut found: Option<&Spanned<DeValue>> = None;
    for (depth, key) in path.iter().enumerate() {
        let next = match found.map(Spanned::get_ref) {
            None => document.get_ref().get(*key),
            Some(DeValue::Table(_)) if found.is_some_and(|table| is_name_of(table, key)) => found,
            Some(DeValue::Table(table)) => table.get(*key),
            Some(DeValue::Array(list)) if is_key_of_only(list, key, depth + 1 == path.len()) => {
                found = list.first();
                list.first()?.get_ref().as_table()?.get(*key)
            }
            Some(DeValue::Array(list)) => list.get(element(list, key)?),
            Some(_) => return None,
        };
        if next.is_none() {
            return inserted(text, found, &path[depth..], value);
        }
        found = next;
    }
    let place = found?.span();
    Some([text.get(..place.start)?, value, text.get(place.end..)?].concat())
}

/// The keys of an override, and its value as it is written.
fn entry<'t>(mut table: &'t DeTable, toml: &'t str) -> Option<(Vec<&'t str>, &'t str)> {
    let mut path = Vec::new();
    loop {
        let (key, value) = table.iter().next()?;
        path.push(key.get_ref().as_ref());
        match value.get_ref() {
            DeValue::Table(inner) if !is_whole(value, toml) => table = inner,
            _ => return Some((path, toml.get(value.span())?)),
        }
    }
}

/// The `text` with a new entry: in a `table` after its last number, text, list or table in braces; at the top level before all
/// else.
fn inserted(
    text: &str,
    table: Option<&Spanned<DeValue>>,
    path: &[&str],
    value: &str,
) -> Option<String> {
    let keys: Vec<String> =
        path.iter().map(|key| serde_json::Value::from(*key).to_string()).collect();
    let entry = format!("{} = {value}", keys.join("."));
    let Some(table) = table else { return Some(format!("{entry}\n{text}")) };
    let is_plain = |value: &&Spanned<DeValue>| match value.get_ref() {
        DeValue::Table(_) => is_whole(value, text),
        DeValue::Array(list) => list.iter().all(|value| value.get_ref().as_table().is_none()),
        _ => true,
    };
    let values = table.get_ref().as_table()?.values();
    let last = values.filter(is_plain).max_by_key(|value| value.span().start)?;
    let (place, entry) = insertion(text, last.span().end, &entry);
    Some([text.get(..place.start)?, &entry, text.get(place.end..)?].concat())
}

/// Puts `entry` after the value that ends at `at`: on a line of its own, or, within braces, on the same line.
pub(super) fn insertion(text: &str, at: usize, entry: &str) -> (Range<usize>, String) {
    let rest = text.get(at..).unwrap_or_default();
    let line = rest.lines().next().unwrap_or_default();
    match line.trim_start().starts_with([',', '}']) {
        true => (at..at, format!(", {entry}")),
        false => {
            let end = at + line.len();
            (end..end, format!("\n{entry}"))
        }
    }
}

/// Whether the text `new` has the meaning of `text` with `toml` merged into it.
fn is_meant(new: &str, text: &str, toml: &str) -> bool {
    let parse = |text| Some(DeTable::parse(text).ok()?.into_inner());
    let (Some(new), Some(mut old), Some(over)) = (parse(new), parse(text), parse(toml)) else {
        return false;
    };
    merge(&mut old, over, toml).is_ok() && are_same(&DeValue::Table(new), &DeValue::Table(old))
}

fn are_same(a: &DeValue, b: &DeValue) -> bool {
    match (a, b) {
        (DeValue::Table(a), DeValue::Table(b)) => {
            let is_in_b = |(key, a): (&Spanned<DeString>, &Spanned<DeValue>)| {
                b.get(key.get_ref().as_ref()).is_some_and(|b| are_same(a.get_ref(), b.get_ref()))
            };
            a.len() == b.len() && a.iter().all(is_in_b)
        }
        (DeValue::Array(a), DeValue::Array(b)) => {
            let mut pairs = a.iter().zip(b.iter());
            a.len() == b.len() && pairs.all(|(a, b)| are_same(a.get_ref(), b.get_ref()))
        }
        // values that contain no other values hold no positions in the text
        _ => format!("{a:?}") == format!("{b:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# a file\ntitle = \"a\" # short\n\n[body]\nmesh = { kind = \"bar\", nodes = 3 } # fine\n\
                        area = 1.0\n[body.material]\nyoung = 1e5 # Pa\n\n[[phase]]\nname = \"press\"\n\
                        until = 1.0 # s\nhold = [{ nodes = \"left\" }]\n\n[[phase]]\nuntil = 2.0";

    #[test]
    fn overrides_stand_in_their_places() {
        for (over, old, new) in [
            ("title=b c", "\"a\"", "\"b c\""),
            ("body.material.young=2e5", "1e5", "2e5"),
            ("body.mesh.nodes=4", "nodes = 3", "nodes = 4"),
            ("body.mesh={ kind = \"bar\" }", "{ kind = \"bar\", nodes = 3 }", "{ kind = \"bar\" }"),
            ("phase.press.until=3", "1.0 # s", "3 # s"),
            ("phase.2.until=3", "2.0", "3"),
            ("phase.1.hold.1.nodes=right", "\"left\"", "\"right\""),
            // the only table of a list, and a single one as the first of a list
            ("phase.press.hold.nodes=right", "\"left\"", "\"right\""),
            ("body.1.material.1.young=2e5", "1e5", "2e5"),
            ("body.1.area=2.0", "area = 1.0", "area = 2.0"),
            ("phase.press.hold.axes=x", "nodes = \"left\"", "nodes = \"left\", \"axes\" = \"x\""),
            // new keys
            ("body.mesh.length=2", "nodes = 3", "nodes = 3, \"length\" = 2"),
            ("body.material.poisson=0.3", "1e5 # Pa", "1e5 # Pa\n\"poisson\" = 0.3"),
            ("body.thickness=2", "area = 1.0", "area = 1.0\n\"thickness\" = 2"),
            ("phase.2.gravity=[0, 1]", "2.0", "2.0\n\"gravity\" = [0, 1]"),
            ("solver.rtol=1e-3", "# a file", "\"solver\".\"rtol\" = 1e-3\n# a file"),
        ] {
            assert_eq!(TEXT.matches(old).count(), 1, "{old}");
            assert_eq!(written(TEXT, over).unwrap(), TEXT.replace(old, new), "{over}");
        }
        // tables in braces alone
        let braces = "[body]\nmesh = { nodes = 3 }\nmaterial = { young = 1e5 } # Pa\n[[phase]]\n";
        let new = braces.replace("# Pa\n", "# Pa\n\"strain\" = \"cauchy\"\n");
        assert_eq!(written(braces, "body.strain=cauchy").unwrap(), new);
        for (text, over) in [
            (TEXT, "body={ area = 1.0 }"),
            (TEXT, "phase.3.until=1"),
            ("a.b = 1\n[[c]]\n[[c.d]]\ne = 1", "a={ b = 2 }"),
            ("a.b = 1\n[[c]]\n[[c.d]]\ne = 1", "c.1.f=2"),
            ("[a]\nb.c = 1", "a.b.d=2"),
            (TEXT, "title"),
        ] {
            let error = written(text, over).unwrap_err().to_string();
            assert!(error.starts_with("--set = ") && error.contains(over), "{error}");
        }
    }
}
