//! The scenes of the documentation are run, and say what the text says.

use std::path::Path;

use pliant::SceneFile;

const PAGE: &str = include_str!("../../docs/scene-files.md");

/// The blocks of the page in a language.
fn blocks(language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    PAGE.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn all_scenes_are_run() {
    let [first, second, third, sensors] = blocks("toml")[..] else { panic!("four blocks") };
    for text in [first.to_owned() + sensors, second.into(), third.into()] {
        let file = SceneFile::parse(&text, Path::new("scene.toml")).unwrap();
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
