//! The scenes of the documentation are run, and say what the text says.

use std::path::Path;

use pliant::{Dilatation, SceneFile};

const PAGE: &str = concat!(
    include_str!("../../docs/scene-files.md"),
    include_str!("../../docs/scenes/bodies.md"),
    include_str!("../../docs/scenes/motion.md"),
    include_str!("../../docs/scenes/contact.md"),
    include_str!("../../docs/scenes/sensors.md"),
    include_str!("../../docs/scenes/meshes.md"),
    include_str!("../../docs/scenes/warnings.md"),
    include_str!("../../docs/scenes/accuracy.md"),
    include_str!("../../docs/scenes/long-runs.md"),
    include_str!("../../docs/scenes/cables.md"),
    include_str!("../../docs/scenes/gas-and-liquids.md"),
    include_str!("../../docs/scenes/muscles.md"),
    include_str!("../../docs/scenes/magnets.md"),
    include_str!("../../docs/scenes/growth.md"),
    include_str!("../../docs/scenes/fluids.md"),
    include_str!("../../docs/scenes/rods.md"),
    include_str!("../../docs/scenes/joints.md"),
);
const SILICONE: &str = include_str!("../../docs/silicone.md");

/// The blocks of the pages on scene files in a language.
fn blocks(language: &str) -> Vec<&'static str> {
    blocks_of(PAGE, language)
}

fn blocks_of(page: &'static str, language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

/// What a user writes for silicone is right at the first try: cells that keep their volume, and nothing to warn of.
#[test]
fn fingers_of_silicone_do_not_lock() {
    let scenes = blocks_of(SILICONE, "toml");
    assert_eq!(scenes.len(), 2);
    for text in scenes {
        let file = SceneFile::parse(text, Path::new("scene.toml")).unwrap();
        assert_eq!(file.scene.body().dilatation(), Dilatation::Linear);
        let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
        assert_eq!(motion.report().warnings(), Vec::<String>::new());
    }
}

#[test]
fn all_scenes_are_run() {
    let [
        first,
        second,
        third,
        fourth,
        sixth,
        fifth,
        sensors,
        seventh,
        eighth,
        ninth,
        led,
        tenth,
        curl,
        eleventh,
        gust,
        arm,
        hoop,
    ] = blocks("toml")[..]
    else {
        panic!("seventeen blocks")
    };
    assert_eq!([fourth, fifth, sixth, seventh], [GLUED_ARM, GRIPPER, WHEEL, FINGER]);
    assert_eq!([eighth, ninth, led, tenth, curl], [MUSCLES, MAGNETS, LED, GEL, CURL]);
    assert_eq!([eleventh, arm, hoop], [FOAM, ARM, HOOP]);
    let with_sensors = first.to_owned() + sensors;
    for text in [
        &with_sensors,
        second,
        third,
        fourth,
        fifth,
        sixth,
        seventh,
        eighth,
        ninth,
        led,
        tenth,
        curl,
        eleventh,
        gust,
        arm,
        hoop,
    ] {
        let file = SceneFile::parse(text, Path::new("scene.toml")).unwrap();
        let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
        assert_eq!(motion.last().time, file.scene.end());
        assert_eq!(motion.report().warnings(), Vec::<String>::new(), "{}", file.title);
    }
}

#[test]
fn a_misspelt_key_gets_the_message_of_the_page() {
    let text = blocks("toml")[1].replace("stiffness =", "stiffnes =");
    let message = SceneFile::parse(&text, Path::new("scene.toml")).unwrap_err().to_string();
    assert!(blocks("text").iter().any(|block| block.contains(&message)), "{message}");
}

const GLUED_ARM: &str = include_str!("../../scenes/glued-arm.toml");
const GRIPPER: &str = include_str!("../../scenes/gripper.toml");
const FINGER: &str = include_str!("../../scenes/tendon-finger.toml");
const WHEEL: &str = include_str!("../../scenes/wheel-over-stones.toml");
const MUSCLES: &str = include_str!("../../scenes/muscle-strip.toml");
const MAGNETS: &str = include_str!("../../scenes/magnetic-strip.toml");
const LED: &str = include_str!("../../scenes/led-strip.toml");
const GEL: &str = include_str!("../../scenes/swelling-strip.toml");
const CURL: &str = include_str!("../../scenes/curling-strip.toml");
const FOAM: &str = include_str!("../../scenes/float.toml");
const ARM: &str = include_str!("../../scenes/rod-arm.toml");
const HOOP: &str = include_str!("../../scenes/hoop.toml");
const CABLE: &str = include_str!("../../scenes/cable.toml");

/// A cable under the tension T at the distance e from the axis bends a beam as the moment T e does: to the angle T e L/(E I) at its end,
/// with T = 0.05 N, e = 1 cm, L = 10 cm, E = 0.1 MPa, I = 1 cm (2 cm)^3/12.
#[test]
fn a_cable_bends_a_beam_to_an_arc() {
    let file = SceneFile::parse(CABLE, Path::new("cable.toml")).unwrap();
    assert_eq!(file.scene.warnings(), Vec::<String>::new());
    let gentle = CABLE.replace("forces = [0.0, 0.5]", "forces = [0.0, 0.05]");
    let file = SceneFile::parse(&gentle, Path::new("cable.toml")).unwrap();
    let found = file.equilibrium().unwrap();
    let [turned, tension] = found.sample().sensors[..] else { panic!("two sensors") };
    let expected = (0.05_f64 * 0.01 * 0.1 / (1e5 * 0.01 * 0.02_f64.powi(3) / 12.0)).to_degrees();
    // ends that are no beam's, where the cable is fixed to a single node and the wall holds the width: 3.25 % were found
    assert!((turned / expected - 1.0).abs() < 0.04, "{turned} {expected}");
    assert!((tension - 0.05).abs() < 1e-15, "{tension}");
}

/// Who looks for what is not there is told so, and what stands in for it.
#[test]
fn tables_that_are_not_there_say_what_stands_in() {
    let scene = blocks("toml")[0];
    for (name, words) in [
        ("contact", &["[[touch]]", "[[obstacle]]"][..]),
        ("self_contact", &["with themselves is [[touch]]"]),
        ("bodies", &["[[body]]", "[[obstacle]]"]),
        ("rigid", &["rigid = true", "[[obstacle]]"]),
        ("tendon", &["[[cable]]", "a winch"]),
        ("hinge", &["is a [[joint]]", "hold_combination"]),
        ("pump", &["[[gas]]", "[[orifice]]", "[[chamber]]", "[[liquid]]"]),
        ("friction", &["friction_coefficient in [[obstacle]]"]),
    ] {
        let text = format!("{scene}\n[[{name}]]\nname = \"a\"\n");
        let line = text.lines().count() - 1;
        let message = SceneFile::parse(&text, Path::new("scene.toml")).unwrap_err().to_string();
        println!("{message}");
        assert!(message.starts_with(&format!("scene.toml:{line}: {name}: ")), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }
    let one_of_a_list = scene.replace("[body]", "[[body]]");
    assert!(SceneFile::parse(&one_of_a_list, Path::new("scene.toml")).is_ok());
    // a slip of the pen is none of them
    let text = format!("{scene}\n[[obstacel]]\nname = \"a\"\n");
    let message = SceneFile::parse(&text, Path::new("scene.toml")).unwrap_err().to_string();
    assert!(message.contains("did you mean \"obstacle\"?"), "{message}");
}
