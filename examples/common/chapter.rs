//! A chapter of a page that several programs write, each one of its own.

use std::path::Path;
use std::{fs, io};

/// Writes `text`, which begins with a heading (`# ...`), in place of the chapter of that heading on the page at `path`, or at its
/// end if there is none.
///
/// # Errors
/// A page that cannot be written.
pub fn write(path: &Path, text: &str) -> io::Result<()> {
    let page = fs::read_to_string(path).unwrap_or_default();
    let heading = text.lines().next().unwrap_or_default();
    let mut chapters: Vec<&str> = Vec::new();
    let mut rest = page.as_str();
    while let Some(at) = rest.find("\n# ") {
        let (chapter, others) = rest.split_at(at + 1);
        chapters.push(chapter);
        rest = others;
    }
    chapters.extend(Some(rest).filter(|rest| !rest.is_empty()));
    let own = chapters.iter().position(|chapter| chapter.lines().next() == Some(heading));
    match own {
        Some(own) => chapters[own] = text,
        None => chapters.push(text),
    }
    let chapters: Vec<&str> = chapters.iter().map(|chapter| chapter.trim_end()).collect();
    fs::write(path, chapters.join("\n\n") + "\n")
}
