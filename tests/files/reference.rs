//! The reference page and the JSON Schema of scene files.

use std::path::Path;

use pliant::scene_file::StudyFile;
use pliant::{SceneFile, SceneReader};
use serde_json::Value;

const PAGE: &str = include_str!("../../docs/reference.md");

/// A file of these parts, each of which may be replaced.
const PARTS: [(&str, &str); 14] = [
    ("top", "title = \"base\"\n"),
    ("[body]", "[body]\nthickness = 0.01\n"),
    ("[[spring]]", "[[spring]]\nname = \"down\"\nends = [1, 3]\n"),
    ("[[magnet]]", "[[magnet]]\nremanence = [0.1, 0.0]\n"),
    ("[[dipole]]", "[[dipole]]\nname = \"lead\"\nmoment = [0.0, 1.0]\nposition = [0.05, 0.3]\n"),
    ("[[wind]]", "[[wind]]\nname = \"gust\"\ndrag = 0.7\n"),
    ("[[chamber]]", "[[chamber]]\nname = \"inside\"\nnodes = [1, 2, 13, 12]\n"),
    ("[[gas]]", "[[gas]]\nchamber = \"inside\"\n"),
    ("[[supply]]", "[[supply]]\nname = \"pump\"\npressure = 2e5\n"),
    (
        "[[orifice]]",
        "[[orifice]]\nname = \"valve\"\nfrom = \"pump\"\nto = \"inside\"\nconductance = 1e-9\n",
    ),
    ("[[liquid]]", "[[liquid]]\nchamber = \"inside\"\n"),
    (
        "[[obstacle]]",
        "[[obstacle]]\nkind = \"disc\"\ncentre = [0.0, -1.0]\nradius = 0.1\nstiffness = 1e3\n",
    ),
    (
        "[[joint]]",
        "[[joint]]\nname = \"hip\"\nkind = \"revolute\"\nbetween = [\"world\", \"left\"]\nat = [0.0, 0.05]\nservo_stiffness = 2.0\n",
    ),
    ("[[phase]]", "[[phase]]\nuntil = 0.5\n"),
];
const MATERIAL: &str =
    "material = { density = 1000.0, young = 1.0e5, poisson = 0.4, viscosity = 40.0 }\n";
const MESHES: [&str; 2] = [
    "mesh = { kind = \"rectangle\", size = [0.1, 0.1], nodes = [11, 11], cells = \"crossed\" }\n",
    "mesh = { kind = \"ring\", inner = 0.04, outer = 0.05, nodes = [32, 3], cells = \"crossed\" }\n",
];

/// A scene file with an example of the page in its place.
fn with(example: &str, mesh: &str) -> String {
    let key = example.split([' ', '\n']).next().unwrap();
    let place = match key {
        "title" => "top",
        "mesh" | "material" => "[body]",
        "friction_coefficient" => "[[obstacle]]",
        header if header.starts_with('[') => header,
        _ => "[[phase]]",
    };
    let mut text = String::new();
    for (part, base) in PARTS {
        let is_whole = part == place && (key == place || key == "title");
        let is_needed = match part {
            "[[chamber]]" => {
                ["pressure", "[[gas]]", "[[orifice]]", "open", "[[liquid]]", "flow", "[[pipe]]"]
                    .contains(&key)
            }
            "[[gas]]" | "[[supply]]" => ["[[orifice]]", "open"].contains(&key),
            "[[orifice]]" => key == "open",
            "[[liquid]]" => ["flow", "[[pipe]]"].contains(&key),
            "[[spring]]" => key == "actuate",
            "[[magnet]]" => ["magnetic_field", "[[dipole]]", "drive"].contains(&key),
            "[[dipole]]" => key == "drive",
            "[[wind]]" => key == "steer",
            "[[joint]]" => key == "motor",
            _ => true,
        };
        text += if is_whole || !is_needed { "" } else { base };
        if part == "[body]" && !is_whole {
            text += if key == "mesh" { "" } else { mesh };
            text += if key == "material" { "" } else { MATERIAL };
        }
        if part == place {
            text += example;
        }
    }
    if !PARTS.iter().any(|(part, _)| *part == place) {
        text += example; // a table of its own
    }
    if key == "[[tie]]" {
        let beside = mesh.replace(" }", ", origin = [0.1, 0.0] }");
        let tip = format!("[[body]]\nname = \"tip\"\nthickness = 0.01\n{beside}{MATERIAL}");
        text = text.replace("[body]\n", &format!("{tip}[[body]]\nname = \"base\"\n"));
    }
    text
}

#[test]
fn examples_are_read() {
    let (scenes, studies) = PAGE.split_once("\n## Study files").unwrap();
    let blocks = |part: &'static str| -> Vec<&str> {
        part.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
    };
    let study = blocks(studies).concat();
    StudyFile::parse(&study, Path::new("example.toml")).unwrap();
    let blocks = blocks(scenes);
    assert!(blocks.len() > 15);
    for block in blocks {
        let read = |mesh: &&str| SceneFile::parse(&with(block, mesh), Path::new("example.toml"));
        let errors: Vec<_> = MESHES.iter().map(read).filter_map(Result::err).collect();
        assert!(errors.len() < MESHES.len(), "{block}: {errors:?}");
    }
}

/// Each table of the shipped scenes has its keys in the schema. (Values are checked by validators of
/// JSON Schema, of which there is none here.)
#[test]
fn the_schema_knows_the_scenes() {
    let schema = SceneReader::default().schema();
    let text = schema.to_string();
    for (at, _) in text.match_indices("#/definitions/") {
        let name = text[at + 14..].split('"').next().unwrap();
        assert!(schema["definitions"][name].is_object(), "{name}");
    }
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        let Ok(scene) = std::fs::read_to_string(&path) else { continue };
        let mut table = &schema["properties"];
        for line in scene.lines() {
            if line.starts_with('[') {
                let name = line.split_inclusive(']').collect::<String>();
                let name = name.split('#').next().unwrap().trim();
                // a list of bodies
                let name = if name == "[[body]]" { "[body]" } else { name };
                let definition = &schema["definitions"][name];
                assert!(definition.is_object(), "{path:?}: {name}");
                table = definition;
            } else if let Some((key, _)) = line.split_once(" = ")
                && !key.starts_with([' ', '#', '{'])
            {
                assert!(has(table, key), "{path:?}: {key}");
            }
        }
    }
}

/// What the schema says of keys that are left out, or are too many, is what reading does.
#[test]
fn the_schema_requires_what_reading_does() {
    let schema = SceneReader::default().schema();
    let mut missing = 0;
    for file in [include_str!("../data/rich.toml"), include_str!("../data/solid.toml")] {
        let lines: Vec<&str> = file.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            let Some((key, _)) = line.split_once(" = ") else { continue };
            let header = lines[..at].iter().rposition(|line| line.starts_with('['));
            let Some(header) = header else { continue };
            // regions need only a part of a material: the schema knows one table for both
            if lines[header] == "[body.material]" {
                continue;
            }
            let name = lines[header].trim_matches(['[', ']']);
            // tables within others go by their own names alone
            let inner = name.rsplit('.').next().unwrap();
            let of_name = |name| schema["definitions"].get(name);
            let table = of_name(lines[header]).or_else(|| of_name(inner)).unwrap();
            let own = lines[header + 1..].iter().take_while(|line| !line.starts_with('['));
            let tables = lines.iter().filter_map(|line| {
                Some((line.trim_matches(['[', ']']).strip_prefix(name)?.strip_prefix('.')?, ""))
            });
            let keys: Vec<(&str, &str)> =
                own.filter_map(|line| line.split_once(" = ")).chain(tables).collect();
            assert!(fits(table, &keys), "{name}");
            let rest: Vec<_> = keys.iter().copied().filter(|other| other.0 != key).collect();
            let mut text = lines.clone();
            text.remove(at);
            let read = SceneFile::parse(&text.join("\n"), Path::new("without.toml"));
            let told = read.err().map(|error| error.to_string()).unwrap_or_default();
            let is_missing =
                [": missing; expected", ": expected either"].iter().any(|part| told.contains(part));
            assert_eq!(fits(table, &rest), !is_missing, "{name} without {key}: {told}");
            missing += usize::from(is_missing);
            if key == "stiffness" && name == "obstacle" {
                assert!(!fits(table, &[&keys[..], &[("stiffness_density", "1e7")]].concat()));
            }
        }
    }
    assert!(missing > 20, "{missing}");
}

/// Whether a table with these keys and values is as a schema wants it, as far as required keys go.
fn fits(schema: &Value, keys: &[(&str, &str)]) -> bool {
    let has = |name: &Value| keys.iter().any(|(key, _)| name == key);
    let list = |name: &str| schema[name].as_array().into_iter().flatten();
    let kind = schema["properties"]["kind"]["const"].as_str();
    list("required").all(has)
        && kind.is_none_or(|kind| keys.contains(&("kind", &format!("\"{kind}\""))))
        && (schema["oneOf"].is_null() || list("oneOf").filter(|one| fits(one, keys)).count() == 1)
        && (schema["anyOf"].is_null() || list("anyOf").any(|one| fits(one, keys)))
        && (schema["not"].is_null() || !fits(&schema["not"], keys))
}

/// Whether a table of the schema, or the list of properties itself, has a key.
fn has(table: &Value, key: &str) -> bool {
    let kinds = table["oneOf"].as_array().into_iter().flatten();
    table[key].is_object()
        || table["properties"][key].is_object()
        || kinds.into_iter().any(|kind| kind["properties"][key].is_object())
}
