//! What mistakes in scene files get: file, line, key, what was expected, the nearest known word.

use std::path::Path;

use pliant::{Error, SceneFile};

const RICH: &str = include_str!("../data/rich.toml");

fn message(text: &str) -> String {
    match SceneFile::parse(text, Path::new("rich.toml")) {
        Ok(_) => "accepted".into(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn mistakes_are_named() {
    let mut count = 0;
    for block in include_str!("../data/mistakes.txt").split("\n\n").skip(1) {
        let lines: Vec<String> = block.lines().map(|line| line.replace("\\n", "\n")).collect();
        let [right, wrong, expected] = &lines[..] else { panic!("three lines each: {block}") };
        assert!(RICH.contains(right), "{right}");
        let wrong = if wrong == "-" { "" } else { wrong };
        let found = message(&RICH.replacen(right, wrong, 1));
        match expected.strip_suffix("...") {
            None => assert_eq!(&found, expected, "{wrong}"),
            Some(start) => assert!(found.starts_with(start), "{wrong}: {found}"),
        }
        count += 1;
    }
    assert!(count > 80, "{count}");
}

/// Whatever stands in place of a value, nothing panics, and errors name a line of the file.
#[test]
fn no_value_is_trusted() {
    let junk = [
        "",
        "x",
        "\"x\"",
        "0",
        "-1",
        "1.5",
        "nan",
        "inf",
        "1e400",
        "99999999999999999999",
        "true",
        "1979-05-27",
        "[]",
        "[[]]",
        "[0]",
        "[1, 1]",
        "[[0, 0], [0, 0]]",
        "[true]",
        "{}",
        "{ box = 1 }",
        "{ nodes = 1 }",
        "{ nodes = \"all\" }",
        "{ kind = \"gmsh\" }",
    ];
    let files = [RICH, include_str!("../data/solid.toml"), include_str!("../data/string.toml")];
    for file in files {
        for (number, line) in file.lines().enumerate() {
            let Some((key, _)) = line.split_once('=') else { continue };
            for junk in junk {
                let mut lines: Vec<&str> = file.lines().collect();
                let line = format!("{key}= {junk}");
                lines[number] = &line;
                let text = lines.join("\n");
                if let Err(error) = SceneFile::parse(&text, Path::new("junk.toml")) {
                    let Error::SceneFile { line, .. } = &error else { panic!("{text}\n{error:?}") };
                    assert!((1..=lines.len()).contains(line), "{error}");
                }
            }
        }
    }
}

/// What a default could not supply is asked for by its key.
#[test]
fn a_chamber_beside_a_string_needs_a_thickness() {
    let text = include_str!("../data/string.toml").replace("thickness = 0.01\n", "");
    let expected = "rich.toml:9: chamber.thickness: missing; the body has no thickness of its own: \
                    give that of the chamber (m)";
    assert_eq!(message(&text), expected);
}

/// All ways to write numbers in TOML.
#[test]
fn numbers() {
    let with = |young: &str| {
        let text = RICH.replacen("1.0e6", young, 1);
        SceneFile::parse(&text, Path::new("rich.toml")).unwrap().scene.body().material().young
    };
    for young in ["1000000", "1e6", "1E+6", "+1_000_000.0", "0xF4240", "1_0_00e3"] {
        assert_eq!(with(young), 1e6, "{young}");
    }
}

#[test]
fn files_that_cannot_be_read() {
    let error = SceneFile::read("nowhere/scene.toml").unwrap_err();
    assert!(matches!(error, Error::Read { .. }));
    let message = error.to_string();
    assert!(message.starts_with("cannot read nowhere/scene.toml: No such file"), "{message}");
}

/// Parts of a union have lines and keys of their own.
#[test]
fn parts_of_unions() {
    for (parts, expected) in [
        ("[]", "rich.toml:33: obstacle.parts: ..."),
        (
            "[{ kind = \"disc\", centre = [0.0, 0.0], radius = 1.0 },\n{ kind = \"disc\", centre = [0.0, 0.0], radius = -1.0 }]",
            "rich.toml:34: obstacle.parts.radius: -1.0 cannot be used: ...",
        ),
        (
            "[{ kind = \"disc\", centre = [0.0, 0.0] }]",
            "rich.toml:33: obstacle.parts.radius: missing; expected the radius (m)",
        ),
        (
            "[{ kind = \"union\", parts = [] }]",
            "rich.toml:33: obstacle.parts.parts: unknown key; ...",
        ),
        ("[{ kind = \"cone\" }]", "rich.toml:33: obstacle.parts.kind: \"cone\" is unknown; ..."),
        ("3", "rich.toml:33: obstacle.parts: expected the shapes: a table; found 3"),
    ] {
        let (plain, union) = (
            "kind = \"half-plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n",
            format!("kind = \"union\"\nparts = {parts}\n"),
        );
        assert!(RICH.contains(plain));
        let found = message(&RICH.replacen(plain, &union, 1));
        match expected.strip_suffix("...") {
            None => assert_eq!(found, expected, "{parts}"),
            Some(start) => assert!(found.starts_with(start), "{parts}: {found}"),
        }
    }
}

/// A word in place of a table with that `kind` is answered by the table.
#[test]
fn a_word_in_place_of_a_table_is_answered_by_the_table() {
    let right = "viscosity = 10.0, ";
    let text = |law: &str| {
        format!(
            "[body]\nmesh = {{ kind = \"rectangle\", size = [0.1, 0.1], nodes = [2, 2], cells = \"rectangles\" }}\n\
             thickness = 0.01\nmaterial = {{ density = 1000.0, young = 1e5, poisson = 0.3, {right}{law} }}\n\
             [[phase]]\nuntil = 1.0\n[output]\nstep = 0.1\n"
        )
    };
    assert_eq!(message(&text("law = { kind = \"neo-hookean\" }")), "accepted");
    let found = message(&text("law = \"neo-hookean\""));
    assert!(
        found.contains("body.material.law") && found.contains("{ kind = \"neo-hookean\" }"),
        "{found}"
    );
    let found = message(&text("law = \"neo-hookian\""));
    assert!(found.contains("a table; found") && !found.contains("kind ="), "{found}");
}
