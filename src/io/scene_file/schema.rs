//! The JSON Schema of scene files, by which editors complete and check them.

use serde_json::{Map, Value, json};

use super::device::{DeviceKey, DeviceTable};
use super::keys::{Default, Key, TableKeys, ValueType};
use super::reference::tables;
use super::selection::BOX;
use super::top::TOP;

/// The JSON Schema (draft 7) of scene files, those of `devices` among their tables.
pub(super) fn schema(devices: &[DeviceTable]) -> Value {
    let mut root = object(&TOP);
    for table in devices {
        let definition = of_device(table);
        let list = json!({ "type": "array", "items": definition });
        root["properties"][table.word] = json!({ "anyOf": [definition, list] });
    }
    let inner = tables().into_iter().skip(1).map(|keys| (keys.name.into(), object(keys)));
    let mut definitions: Map<String, Value> = inner.collect();
    definitions.insert(BOX.name.into(), object(&BOX));
    for (name, definition) in shared() {
        definitions.insert(name.into(), definition);
    }
    root["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    root["title"] = json!("Scene file of pliant");
    root["definitions"] = definitions.into();
    root
}

/// The schema of a table of another crate, which alone knows the types of its values.
fn of_device(table: &DeviceTable) -> Value {
    let key = |key: &DeviceKey| {
        let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
        (key.name.into(), json!({ "description": format!("{}{unit}", key.meaning) }))
    };
    let properties: Map<String, Value> = table.keys.iter().map(key).collect();
    json!({
        "type": "object",
        "description": table.about,
        "additionalProperties": properties.is_empty(),
        "properties": properties,
    })
}

/// Kinds of values that many keys have.
fn shared() -> [(&'static str, Value); 7] {
    let number = json!({ "type": "number" });
    let whole = json!({ "type": "integer", "minimum": 1 });
    let numbers = |least: usize| json!({ "type": "array", "items": number, "minItems": least, "maxItems": 3 });
    let changing = json!({ "anyOf": [number, { "type": "string" }] });
    let axis = json!({ "enum": ["x", "y", "z"] });
    [
        ("a vector", numbers(1)),
        ("a number or a formula", changing.clone()),
        (
            "a vector or formulas",
            json!({ "type": "array", "items": changing, "minItems": 1, "maxItems": 3 }),
        ),
        ("numbers along axes", json!({ "anyOf": [number, numbers(1)] })),
        ("corners", json!({ "type": "array", "items": numbers(1), "minItems": 2, "maxItems": 2 })),
        (
            "nodes",
            json!({ "anyOf": [
                { "type": "string" },
                whole,
                { "type": "array", "items": whole },
                reference(BOX.name),
            ] }),
        ),
        ("axes", json!({ "anyOf": [axis, { "type": "array", "items": axis }] })),
    ]
}

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/definitions/{name}") })
}

/// The schema of a table.
fn object(table: &TableKeys) -> Value {
    let mut schema = match table.kinds {
        [] => closed(table.keys.iter()),
        kinds => {
            let kinds = kinds.iter().map(|kind| {
                let mut schema = closed(table.keys.iter().chain(kind.keys));
                schema["properties"]["kind"] =
                    json!({ "const": kind.word, "description": kind.about });
                if let Some(required) = schema["required"].as_array_mut() {
                    required.insert(0, "kind".into());
                }
                schema
            });
            json!({ "type": "object", "oneOf": kinds.collect::<Vec<_>>() })
        }
    };
    schema["description"] = json!(table.about);
    if !table.one_of.is_empty() {
        let groups = table.one_of.iter().map(|group| {
            let others = table.one_of.concat();
            let others = others.iter().filter(|key| !group.contains(key));
            let others: Vec<Value> = others.map(|key| json!({ "required": [key] })).collect();
            json!({ "required": group, "not": { "anyOf": others } })
        });
        schema["anyOf"] = groups.collect();
    }
    schema
}

/// A table that has no other keys than these.
fn closed(keys: impl Iterator<Item = &'static Key> + Clone) -> Value {
    let required = keys.clone().filter(|key| key.default == Default::Required);
    let required: Vec<&str> = required.map(|key| key.name).collect();
    let properties: Map<String, Value> =
        keys.map(|key| (key.name.into(), described(key))).collect();
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// The schema of a value with the words that an editor shows.
fn described(key: &Key) -> Value {
    let mut schema = value(&key.holds);
    let words = match (key.renamed_to, key.default) {
        (Some(now), _) => format!("Old name of {now}."),
        (None, Default::Required) => format!("{}. Required.", key.meaning),
        (None, Default::Words(words)) => format!("{}. Default: {words}.", key.meaning),
    };
    if schema.get("$ref").is_some() {
        schema = json!({ "allOf": [schema] }); // next to a reference all else is ignored
    }
    schema["description"] = [&words, key.note].join(" ").trim().into();
    schema
}

fn value(holds: &ValueType) -> Value {
    let one_or_more = |inner: Value| {
        let list = json!({ "type": "array", "items": inner });
        json!({ "anyOf": [inner, list] })
    };
    match holds {
        ValueType::Number => json!({ "type": "number" }),
        ValueType::Count => json!({ "type": "integer", "minimum": 0 }),
        ValueType::Flag => json!({ "type": "boolean" }),
        ValueType::Text => json!({ "type": "string" }),
        ValueType::Word(words) => json!({ "enum": words() }),
        ValueType::Array(inner, count) => json!({
            "type": "array", "items": value(inner), "minItems": count, "maxItems": count,
        }),
        ValueType::List(inner) => json!({ "type": "array", "items": value(inner) }),
        ValueType::OneOrMore(inner) => one_or_more(value(inner)),
        ValueType::Either(several) => {
            json!({ "anyOf": several.iter().map(value).collect::<Vec<_>>() })
        }
        ValueType::Vector => reference("a vector"),
        ValueType::Along => reference("numbers along axes"),
        ValueType::Changing => reference("a number or a formula"),
        ValueType::ChangingVector => reference("a vector or formulas"),
        ValueType::Nodes => reference("nodes"),
        ValueType::Corners => reference("corners"),
        ValueType::Axes => reference("axes"),
        ValueType::Table(keys) => reference(keys.name),
        ValueType::Tables(keys) => one_or_more(reference(keys.name)),
    }
}
