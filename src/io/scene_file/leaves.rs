//! The values of a scene file one by one, by their keys, which identify a run among others of the same bodies.

use std::collections::BTreeMap;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::overrides::name_of;
use super::set_value::canonical;

/// Tables and keys that say what moves, how it is integrated and what is read, not what happens to it.
const NOT_WHAT_HAPPENS: [&str; 9] =
    ["title", "dimension", "unusual", "body", "point", "sensor", "solver", "statics", "output"];

/// Numbers and words of a scene by their keys, as `phase.push.load.total.2`. Elements of lists have their names or numbers,
/// but for the only one.
pub(super) fn leaves(entries: &DeTable) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let own = entries.iter().filter(|(key, _)| !NOT_WHAT_HAPPENS.contains(&&key.get_ref()[..]));
    own.for_each(|(key, value)| add(key.get_ref(), value, &mut found));
    found
}

fn add(key: &str, value: &Spanned<DeValue>, found: &mut BTreeMap<String, String>) {
    match value.get_ref() {
        DeValue::Table(table) => {
            for (own, value) in table {
                add(&format!("{key}.{}", own.get_ref()), value, found);
            }
        }
        DeValue::Array(list) => match &list[..] {
            [only] if only.get_ref().as_table().is_some() && name_of(only).is_none() => {
                add(key, only, found);
            }
            all => {
                for (number, item) in (1..).zip(all) {
                    let own = name_of(item).map_or_else(|| number.to_string(), str::to_owned);
                    add(&format!("{key}.{own}"), item, found);
                }
            }
        },
        other => _ = found.insert(key.to_owned(), canonical(other)),
    }
}
