//! Files that pages and docs of modules name exist, and the recipes of `docs/architecture.md` are complete.

use std::fs;
use std::path::Path;

use super::{files, rust_files};

/// Files that the pages and the docs of modules name exist: `mesh/cell.rs` is one whose path ends so.
#[test]
fn files_named_by_pages_and_module_docs_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let sources = rust_files(&root.join("src"));
    let folders = ["docs/decisions", "docs/notes"].map(|folder| files(&root.join(folder), &["md"]));
    let pages = folders.into_iter().flatten().chain([root.join("docs/architecture.md")]);
    let (mut count, mut gone) = (0, Vec::new());
    for path in pages.chain(sources.iter().cloned()) {
        let text = fs::read_to_string(&path).unwrap();
        let docs = text.lines().map_while(|line| line.strip_prefix("//!"));
        let docs = docs.collect::<Vec<_>>().join("\n");
        let text = if path.extension().is_some_and(|end| end == "rs") { docs } else { text };
        for name in text.split('`').skip(1).step_by(2) {
            if name.contains(' ') || !(name.ends_with(".rs") || name.ends_with(".md")) {
                continue;
            }
            count += 1;
            if !root.join(name).exists() && !sources.iter().any(|file| file.ends_with(name)) {
                gone.push(format!("{} names {name}", path.display()));
            }
        }
    }
    assert!(count > 150, "{count}: does this test still see the names?");
    assert!(gone.is_empty(), "files that do not exist:\n{}", gone.join("\n"));
}

/// A recipe of `docs/architecture.md`: the files that an addition touches, by an example.
struct Recipe {
    /// The word of the example, as [`plain`] has it.
    word: String,
    /// Files, each with the anchor that it contains.
    files: Vec<(String, String)>,
}

/// A text without the differences between `pipe-flow`, `pipe_flow` and `PipeFlow`.
fn plain(text: &str) -> String {
    text.to_lowercase().replace(['-', '_'], "")
}

/// The recipes, each with "Word: `...`" and rows "| step | `anchor` | `file`, `file`, ... |".
fn recipes() -> Vec<Recipe> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/architecture.md");
    let page = fs::read_to_string(path).unwrap();
    let (_, chapter) = page.split_once("\n## Seven recipes\n").unwrap();
    let recipe = |section: &str| {
        let (_, word) = section.split_once("Word: `").unwrap();
        let rows = section.lines().filter(|line| line.starts_with("| ") && line.contains('`'));
        let files = rows.flat_map(|row| {
            let mut quoted = row.split('`').skip(1).step_by(2).map(str::to_owned);
            let anchor = quoted.next().unwrap();
            quoted.map(move |file| (file, anchor.clone()))
        });
        Recipe { word: plain(word.split('`').next().unwrap()), files: files.collect() }
    };
    chapter.split("\n### ").skip(1).map(recipe).collect()
}

#[test]
fn recipes_name_files_that_have_their_anchors() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let recipes = recipes();
    assert_eq!(recipes.len(), 7);
    let mut wrong = Vec::new();
    for (file, anchor) in recipes.iter().flat_map(|recipe| &recipe.files) {
        match fs::read_to_string(root.join(file)) {
            Ok(text) if plain(&text).contains(&plain(anchor)) => {}
            Ok(_) => wrong.push(format!("{file} does not have \"{anchor}\"")),
            Err(_) => wrong.push(format!("{file} does not exist")),
        }
    }
    assert!(wrong.is_empty(), "recipes of docs/architecture.md:\n{}", wrong.join("\n"));
}

/// Tests, lines of comments and what is generated do not count.
#[test]
fn recipes_have_all_files_in_which_their_words_stand() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let recipes = recipes();
    let folders = ["src", "python/src", "python/pliant"];
    let mut missing = Vec::new();
    for path in folders.iter().flat_map(|folder| files(&root.join(folder), &["rs", "js", "py"])) {
        let file = path.strip_prefix(root).unwrap().to_str().unwrap();
        let is_generated = file == "python/pliant/words.py";
        if is_generated || file.trim_end_matches(".rs").split('/').any(|name| name == "tests") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
        let code = plain(&[file].into_iter().chain(lines).collect::<Vec<_>>().join("\n"));
        for Recipe { word, files } in &recipes {
            if code.contains(word) && files.iter().all(|(other, _)| other != file) {
                missing.push(format!("{file} has \"{word}\""));
            }
        }
    }
    assert!(missing.is_empty(), "no row in docs/architecture.md:\n{}", missing.join("\n"));
}
