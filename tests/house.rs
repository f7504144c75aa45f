//! `docs/architecture.md` agrees with the sources: no layer imports one that is not below it, no files
//! import each other in a circle, and its recipes name all files that an addition touches.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

#[path = "house/package.rs"]
mod package;
#[path = "house/pages.rs"]
mod pages;

/// A module: one file, by its path within `src`.
struct Module {
    file: String,
    /// Names that it makes its own by `pub use`, and the paths behind them.
    exports: BTreeMap<String, Vec<String>>,
    /// Paths that it imports or spells out.
    imports: Vec<Vec<String>>,
}

/// Modules by their paths, as in `crate::mesh::cell`.
type House = BTreeMap<Vec<String>, Module>;

fn house() -> House {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut house = House::new();
    for path in rust_files(&root) {
        let file = path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned();
        let mut names: Vec<String> =
            file.trim_end_matches(".rs").split('/').map(Into::into).collect();
        if names.iter().any(|name| name == "tests") {
            continue;
        }
        if names.last().is_some_and(|name| ["mod", "lib", "main"].contains(&name.as_str())) {
            names.pop();
        }
        let module = [vec!["crate".to_owned()], names].concat();
        house.insert(module.clone(), read(&module, file, &fs::read_to_string(path).unwrap()));
    }
    house
}

fn rust_files(directory: &Path) -> Vec<PathBuf> {
    files(directory, &["rs"])
}

/// Files in a directory and in those within it, by the ends of their names.
fn files(directory: &Path, ends: &[&str]) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let (folders, mut found): (Vec<PathBuf>, Vec<PathBuf>) =
        entries.partition(|path| path.is_dir());
    found.retain(|file| file.extension().is_some_and(|end| ends.iter().any(|known| end == *known)));
    found.extend(folders.iter().flat_map(|folder| files(folder, ends)));
    found
}

/// Reads the paths in the text of a module.
fn read(module: &[String], file: String, text: &str) -> Module {
    let words = words(&code(text));
    let mut found = Module { file, exports: BTreeMap::new(), imports: Vec::new() };
    let mut spoken = BTreeSet::new();
    let mut at = 0;
    while at < words.len() {
        let is_path = words.get(at + 1).is_some_and(|word| word == "::");
        if words[at] == "use" {
            let end = at + words[at..].iter().position(|word| word == ";").unwrap();
            // after `pub` or `pub(crate)`
            let is_export = at > 0 && ["pub", ")"].contains(&words[at - 1].as_str());
            for (path, name) in tree(&words[at + 1..end], &[]) {
                let path = absolute(module, path);
                match is_export {
                    true => _ = found.exports.insert(name, path),
                    false => found.imports.push(path),
                }
            }
            at = end;
        } else if is_path && ["crate", "super", "pliant"].contains(&words[at].as_str()) {
            let signs = words[at..].iter().skip(1).step_by(2);
            let length = signs.take_while(|sign| *sign == "::").count();
            let path: Vec<String> =
                words[at..].iter().step_by(2).take(length + 1).cloned().collect();
            found.imports.push(absolute(module, path));
            at += 2 * length;
        } else {
            spoken.insert(words[at].as_str());
        }
        at += 1;
    }
    // what is exported and used here is imported, too
    let used = found.exports.iter().filter(|(name, _)| spoken.contains(name.as_str()));
    let used: Vec<_> = used.map(|(_, path)| path.clone()).collect();
    found.imports.extend(used);
    found
}

/// The text without comments, texts in quotes and the module of tests at its end.
fn code(text: &str) -> String {
    let mut text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let mut code = String::new();
    while let Some(at) = text.find(['"', '\'', '/']) {
        code.push_str(&text[..at]);
        let rest = &text[at + 1..];
        let length = match text.as_bytes()[at] {
            b'/' if rest.starts_with('/') => rest.find('\n'),
            b'"' if code.ends_with("r#") => rest.find("\"#").map(|end| end + 1),
            b'"' => closing(rest, '"'),
            // a character, no lifetime
            b'\'' if rest.starts_with('\\') || rest.chars().nth(1) == Some('\'') => {
                closing(rest, '\'')
            }
            _ => Some(0),
        };
        text = &rest[length.unwrap_or(rest.len())..];
    }
    code + text
}

/// Length of a text in quotes, with that at its end.
fn closing(text: &str, quote: char) -> Option<usize> {
    let mut escaped = false;
    let end = text.find(|c| {
        let ends = c == quote && !escaped;
        escaped = c == '\\' && !escaped;
        ends
    });
    end.map(|end| end + 1)
}

/// Names and signs; `::` is one of them.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut last = ' ';
    for c in text.chars() {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        match words.last_mut() {
            Some(word) if is_name(c) && is_name(last) => word.push(c),
            Some(word) if c == ':' && last == ':' && word == ":" => word.push(c),
            _ if c.is_whitespace() => {}
            _ => words.push(c.into()),
        }
        last = c;
    }
    words
}

/// The paths in the tree of a `use`, with the names that they get.
fn tree(words: &[String], before: &[String]) -> Vec<(Vec<String>, String)> {
    let mut path = before.to_vec();
    let mut at = 0;
    while at < words.len() && words[at] != "{" && words[at] != "as" {
        if words[at] != "::" {
            path.push(words[at].clone());
        }
        at += 1;
    }
    match words.get(at).map(String::as_str) {
        Some("{") => {
            let (mut depth, mut start, mut found) = (0, at + 1, Vec::new());
            for (place, word) in words.iter().enumerate().skip(at) {
                match word.as_str() {
                    "{" => depth += 1,
                    "}" => depth -= 1,
                    _ => {}
                }
                let ends = (word == "," && depth == 1) || depth == 0;
                if ends && start < place {
                    found.extend(tree(&words[start..place], &path));
                }
                if ends {
                    start = place + 1;
                }
            }
            found
        }
        Some(_) => vec![(path, words[at + 1].clone())],
        None => {
            if path.last().is_some_and(|name| name == "self") {
                path.pop();
            }
            let name = path.last().unwrap().clone();
            vec![(path, name)]
        }
    }
}

/// A path from the root of its crate, if it is known where it starts, or else as it stands.
fn absolute(module: &[String], path: Vec<String>) -> Vec<String> {
    let up = path.iter().take_while(|name| *name == "super").count();
    match path[0].as_str() {
        "crate" => [&module[..1], &path[1..]].concat(),
        "pliant" => [&["crate".to_owned()], &path[1..]].concat(),
        "self" => [module, &path[1..]].concat(),
        "super" => [&module[..module.len() - up], &path[up..]].concat(),
        // a child of this module, or another crate
        _ => [module, &path[..]].concat(),
    }
}

/// The module that `path` leads to, and whether that is more than the module that it starts from.
fn target<'a>(house: &'a House, path: &[String]) -> Option<&'a Module> {
    let depth = (1..=path.len()).rev().find(|&depth| house.contains_key(&path[..depth]))?;
    let module = &house[&path[..depth]];
    match path.get(depth).and_then(|name| module.exports.get(name)) {
        // a macro is exported under the path of its own module
        Some(behind) if behind[..] != path[..=depth] => {
            target(house, &[&behind[..], &path[depth + 1..]].concat())
        }
        _ => Some(module),
    }
}

/// Which files each file imports.
fn arrows(house: &House) -> BTreeMap<&str, BTreeSet<&str>> {
    let from = |module: &Module| {
        let targets = module.imports.iter().filter_map(|path| target(house, path));
        targets.map(|target| target.file.as_str()).filter(|file| *file != module.file).collect()
    };
    house.values().map(|module| (module.file.as_str(), from(module))).collect()
}

/// Modules of layers in the table of `docs/architecture.md`, each with the number of its row: "| `layer/module`, ... | ...".
fn rows() -> BTreeMap<String, usize> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/architecture.md");
    let text = fs::read_to_string(path).unwrap();
    let first_cells = text.lines().filter_map(|line| line.strip_prefix("| `")?.split('|').next());
    let mut rows = BTreeMap::new();
    for (row, parts) in first_cells.enumerate() {
        let parts = parts.split(['`', ',', ' ']).filter(|part| part.contains('/'));
        rows.extend(parts.map(|part| (part.to_owned(), row)));
    }
    rows
}

/// The module of a layer that a file belongs to: `elements/mesh` of `elements/mesh/cell.rs`; none for the lists of modules, such
/// as `elements/mod.rs`.
fn part(file: &str) -> Option<String> {
    let mut names = file.trim_end_matches(".rs").split('/');
    let (room, part) = (names.next()?, names.next()?);
    (part != "mod").then(|| format!("{room}/{part}"))
}

#[test]
fn each_part_of_a_room_has_a_row_and_knows_rows_above_it_alone() {
    let (house, rows) = (house(), rows());
    let parts: BTreeSet<String> = house.values().filter_map(|module| part(&module.file)).collect();
    let listed: BTreeSet<String> = rows.keys().cloned().collect();
    let without: Vec<_> = parts.difference(&listed).collect();
    assert!(without.is_empty(), "no row in docs/architecture.md for {without:?}");
    let gone: Vec<_> = listed.difference(&parts).collect();
    assert!(gone.is_empty(), "docs/architecture.md lists {gone:?}, which src/ has not");
    let mut wrong = Vec::new();
    for (from, targets) in arrows(&house) {
        let Some(own) = part(from) else { continue };
        for to in targets {
            let other = part(to);
            let knows_it = |other: &String| *other == own || rows[other] < rows[&own];
            if !other.as_ref().is_some_and(knows_it) {
                wrong.push(format!("src/{from} imports src/{to}"));
            }
        }
    }
    assert!(wrong.is_empty(), "a part may know those above it alone:\n{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let house = house();
    let arrows = arrows(&house);
    assert!(arrows.len() > 100 && arrows.values().map(BTreeSet::len).sum::<usize>() > 300);
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|file| (*file, reach(&arrows, file))).collect();
    let mut circles = BTreeSet::new();
    for file in arrows.keys() {
        let circle: BTreeSet<&str> =
            reached[file].iter().copied().filter(|other| reached[other].contains(file)).collect();
        circles.insert(circle);
    }
    let mut lines = Vec::new();
    for circle in circles.iter().filter(|circle| !circle.is_empty()) {
        lines.push(format!("a circle of {} files:", circle.len()));
        for file in circle {
            let inside: Vec<&str> = arrows[file].intersection(circle).copied().collect();
            lines.push(format!("  src/{file} imports {}", inside.join(", ")));
        }
    }
    assert!(lines.is_empty(), "files import each other:\n{}", lines.join("\n"));
}

/// The files that `file` imports, and what these import, and so on.
fn reach<'a>(arrows: &BTreeMap<&'a str, BTreeSet<&'a str>>, file: &'a str) -> BTreeSet<&'a str> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![file]);
    while let Some(file) = open.pop() {
        open.extend(arrows[file].iter().filter(|to| reached.insert(**to)).copied());
    }
    reached
}

/// What integrators call of a system and its output: `ode/call.rs` clears that.
const CALLS: [&str; 14] = [
    "rhs",
    "explicit_rhs",
    "newton_rhs",
    "jacobian_times",
    "roots",
    "quadratures",
    "sensitivity_rhs",
    "adjoint_rhs",
    "adjoint_parameters",
    "residual",
    "sensitivity_residual",
    "forces",
    "accelerations",
    "powers",
];

/// Modules of layers that call systems of others.
const CALLERS: [&str; 8] = [
    "integrators/common",
    "integrators/sundials",
    "integrators/rk",
    "integrators/rosenbrock",
    "integrators/central_difference",
    "integrators/solve",
    "integrators/ode/check.rs",
    "studies/work_precision",
];

/// A method of a system stands behind a dot, or behind the name of its type; an argument tells it from what a solver
/// gives, such as `quadratures()`.
#[test]
fn integrators_call_systems_by_functions_that_clear_the_output() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut around, mut through) = (Vec::new(), 0);
    for path in rust_files(&root) {
        let file = path.strip_prefix(&root).unwrap().to_str().unwrap();
        if !CALLERS.iter().any(|part| file.starts_with(part)) || file.contains("tests") {
            continue;
        }
        let words = words(&code(&fs::read_to_string(&path).unwrap()));
        for at in 2..words.len().saturating_sub(2) {
            let [owner, dot, name, open, argument] =
                [-2, -1, 0, 1, 2].map(|step| words[at.wrapping_add_signed(step)].as_str());
            if !CALLS.contains(&name) {
                continue;
            }
            let is_method = dot == "." && open == "(" && argument != ")";
            let is_path =
                dot == "::" && ["S", "Self", "Ode", "Dae", "SecondOrder"].contains(&owner);
            through += usize::from(dot == "::" && owner == "call");
            if is_method || is_path {
                around.push(format!("src/{file}: {owner}{dot}{name}"));
            }
        }
    }
    assert!(through > 40, "{through}: does this test still see the calls?");
    assert!(around.is_empty(), "not by ode/call.rs, so with any output:\n{}", around.join("\n"));
}
