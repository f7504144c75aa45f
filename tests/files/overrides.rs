//! Values that take the place of those in a scene file (`--set`), against files that have them in their text.

use std::fs;
use std::path::Path;

use pliant::{Error, SceneFile};

const RICH: &str = include_str!("../data/rich.toml");

fn read(text: &str, overrides: &[&str]) -> Result<SceneFile, Error> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("rich.toml");
    fs::write(&path, text).unwrap();
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    SceneFile::read_with(path, &overrides)
}

/// All that a file says.
fn contents(file: &SceneFile) -> String {
    let body = file.scene.body();
    format!("{file:?} {:?} {:?} {:?}", body.material(), body.mesh(), body.stiffness())
}

/// Each with what stands in the text, and what has to stand there instead for the same scene.
const CASES: [(&str, &str, &str); 15] = [
    ("solver.rtol=1e-3", "rtol = 1e-5", "rtol = 1e-3"),
    ("body.material.young = 2e6", "young = 1.0e6", "young = 2.0e6"),
    // a text with and without quotes
    ("title=A = B", "A bit of everything", "A = B"),
    ("title=\"none\"", "A bit of everything", "none"),
    ("solver.method=rk", "cvode-bdf", "rk"),
    // elements of lists by name and by number, in each other
    ("spring.A1.stiffness=30", "stiffness = 20.0", "stiffness = 30.0"),
    ("phase.push.contact=true", "contact = false", "contact = true"),
    ("phase.1.contact=true", "contact = false", "contact = true"),
    ("phase.2.until=1.5", "until = 1.0", "until = 1.5"),
    ("phase.push.load.1.total=[2.0, 0.0]", "total = [1.0, 0.0]", "total = [2.0, 0.0]"),
    // keys and tables that the file has not
    ("phase.2.gravity=[0.0, 0.0]", "until = 1.0\n", "until = 1.0\ngravity = [0.0, 0.0]\n"),
    ("initial.velocity=[1.0, 0.0]", "[output]", "[initial]\nvelocity = [1.0, 0.0]\n[output]"),
    // whole tables
    ("phase.2={ until = 2.0 }", "until = 1.0\ncontact = [\"floor\"]", "until = 2.0"),
    (
        "body.material={ density = 1e3, young = 1e6, poisson = 0.3, viscosity = 0 }",
        "poisson = 0.48, viscosity = 40.0",
        "poisson = 0.3, viscosity = 0.0",
    ),
    (
        "output={ step = 0.01 }",
        "track = { box = [[0.0, 0.2], [0.3, 0.3]] }\nformats = [\"csv\", \"vtk\"]",
        "",
    ),
];

/// Written into the text they mean the same; tables under headings have no place of their own.
#[cfg(feature = "play")]
#[test]
fn overrides_are_written_into_the_text() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("rich.toml");
    fs::write(&path, RICH).unwrap();
    let mut refused = Vec::new();
    for (over, ..) in CASES {
        let over = [over.to_owned()];
        match SceneFile::text_with(&path, &over) {
            Ok(text) => {
                let written = SceneFile::parse(&text, &path).unwrap();
                let read = SceneFile::read_with(&path, &over).unwrap();
                assert_eq!(contents(&written), contents(&read), "{over:?}");
                // all else stays as it was
                let kept = RICH.lines().filter(|line| text.lines().any(|other| other == *line));
                assert!(kept.count() + 1 >= RICH.lines().count(), "{text}");
            }
            Err(error) => refused.push(error.to_string()),
        }
    }
    assert_eq!(refused.len(), 2, "{refused:?}");
    assert!(refused.iter().all(|error| error.contains("the scene file has no place for it")));
}

#[test]
fn overrides_are_as_if_written_in_the_file() {
    let plain = contents(&read(RICH, &[]).unwrap());
    let (mut text, mut all) = (RICH.to_owned(), Vec::new());
    for (over, old, new) in CASES {
        assert!(RICH.contains(old), "{old}");
        let expected = read(&RICH.replacen(old, new, 1), &[]).unwrap();
        let found = contents(&read(RICH, &[over]).unwrap());
        assert!(found == contents(&expected) && found != plain, "{over}");
        // all those together that leave each other alone
        if text.contains(old) && !over.contains('{') {
            text = text.replacen(old, new, 1);
            all.push(over);
        }
    }
    assert!(all.len() > 8);
    assert!(contents(&read(RICH, &all).unwrap()) == contents(&read(&text, &[]).unwrap()));
    // of two for one key the last one counts
    let twice = read(RICH, &["solver.rtol=1e-2", "solver.rtol=1e-3"]).unwrap();
    assert_eq!(twice.settings.rtol, 1e-3);
}

/// A key that may hold one table or several is reached with and without the number, whichever of the two stands in the file.
#[test]
fn a_single_table_is_a_list_of_one() {
    let with = |phase: &str| {
        format!(
            "[body]\nmesh = {{ kind = \"ring\", inner = 0.04, outer = 0.05, nodes = [8, 2], cells = \"triangles\" }}\n\
             thickness = 0.01\nmaterial = {{ density = 1e3, young = 1e6, poisson = 0.4, viscosity = 0.0 }}\n\
             [[chamber]]\nname = \"air\"\nnodes = \"inner\"\n{phase}"
        )
    };
    let single = with(
        "[phase]\nname = \"blow\"\nuntil = 1.0\npressure = { chamber = \"air\", value = 1.0 }\n",
    );
    let listed = with(
        "[[phase]]\nname = \"blow\"\nuntil = 1.0\n[[phase.pressure]]\nchamber = \"air\"\nvalue = 1.0\n",
    );
    for text in [&single, &listed] {
        let expected = contents(&read(&text.replace("value = 1.0", "value = 7.0"), &[]).unwrap());
        assert!(contents(&read(text, &[]).unwrap()) != expected);
        for key in [
            "phase.blow.pressure.value",
            "phase.blow.pressure.1.value",
            "phase.1.pressure.1.value",
            "phase.pressure.value",
        ] {
            let found = read(text, &[&format!("{key}=7.0")]).unwrap();
            assert!(contents(&found) == expected, "{key}");
            #[cfg(feature = "play")]
            {
                let written = SceneFile::written_with(text, &[format!("{key}=7.0")]).unwrap();
                assert_eq!(written, text.replace("value = 1.0", "value = 7.0"), "{key}");
            }
        }
        for (over, expected) in [
            ("phase.blow.pressure.2.value=7.0", "pressure"),
            ("phase.blwo.until=7.0", "phase.blwo"),
            ("phase.blow.pressure.valeu=7.0", "valeu"),
        ] {
            let error = read(text, &[over]).unwrap_err().to_string();
            assert!(error.contains(expected), "{over}: {error}");
        }
    }
}

#[test]
fn mistakes_in_overrides_are_named() {
    let cases: [(&[&str], &str); 9] = [
        (&["solver.rtol"], "--set = solver.rtol cannot be used: write KEY=VALUE, as in"),
        (&["=1"], "--set = =1 cannot be used: write KEY=VALUE, as in"),
        (&["phase.pull.until=1.5"], "--set = phase.pull cannot be used: "),
        (&["phase.0.until=1.5"], "--set = phase.0 cannot be used: "),
        (&["phase.3.until=1.5"], "--set = phase.3 cannot be used: "),
        (&["solver.rtoll=1e-3"], "--set:1: solver.rtoll: unknown key"),
        (&["title=right", "solver.rtol=-1"], "--set:2: solver.rtol: "),
        (&["solver.rtol=fine"], "--set:1: solver.rtol: expected "),
        (&["output={ stepp = 0.1 }"], "--set:1: output.stepp: unknown key"),
    ];
    for (overrides, expected) in cases {
        let error = read(RICH, overrides).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{overrides:?}: {error}");
    }
    // a mistake of the file is still one of the file
    let wrong = RICH.replace("rtol", "rtoll");
    let error = read(&wrong, &["title=right"]).unwrap_err();
    let Error::SceneFile { path, line, .. } = &error else { panic!("{error:?}") };
    let at = wrong.lines().position(|line| line.contains("rtoll"));
    assert_eq!((path.file_name(), Some(line - 1)), (Some(Path::new("rich.toml").as_os_str()), at));
}
