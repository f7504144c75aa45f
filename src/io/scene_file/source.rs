//! The text of a scene file, and errors that point into it.

use std::cell::RefCell;
use std::fmt::Display;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::base::input::read_at_most;
use crate::dynamics::error::Error;

/// Bytes that a scene file may have.
const MOST_BYTES: u64 = 16 << 20;

/// The text of a scene file and where it comes from.
pub(super) struct SourceText<'a> {
    pub(super) path: &'a Path,
    /// Followed by the overrides of its values, one in each line.
    pub(super) text: &'a str,
    /// Length of the file itself.
    pub(super) own: usize,
    /// Notes of `pliant check` about the text.
    pub(super) notes: RefCell<Vec<String>>,
}

impl SourceText<'_> {
    /// An error about the part `at` of the text, the value of `key` (empty: of none).
    pub(super) fn error(&self, at: &Range<usize>, key: &str, message: impl Display) -> Error {
        let (key, message) = (key.to_owned(), message.to_string());
        let line = self.line(at.start);
        match at.start.checked_sub(self.own + 1) {
            None => Error::SceneFile { path: self.path.into(), line, key, message },
            Some(_) => {
                let line = line - self.line(self.own);
                Error::SceneFile { path: "--set".into(), line, key, message }
            }
        }
    }

    /// Adds a note, unless it is there already.
    pub(super) fn note(&self, note: String) {
        let mut notes = self.notes.borrow_mut();
        if !notes.contains(&note) {
            notes.push(note);
        }
    }

    /// The path of a `file` that is named relative to this one.
    pub(super) fn beside(&self, file: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }

    /// Number of the line that holds a byte of the text, from 1.
    pub(super) fn line(&self, byte: usize) -> usize {
        let before = &self.text.as_bytes()[..byte.min(self.text.len())];
        1 + before.iter().filter(|&&byte| byte == b'\n').count()
    }
}

/// The text of the file at `path`.
///
/// # Errors
/// [`Error::Read`].
pub(crate) fn text_of(path: &Path) -> Result<String, Error> {
    let text = read_at_most(path, MOST_BYTES).and_then(|bytes| {
        String::from_utf8(bytes)
            .map_err(|error| io::Error::other(format!("it is no UTF-8 text: {error}")))
    });
    text.map_err(|source| Error::Read { path: path.into(), source })
}

/// The error that a text is not TOML.
pub(super) fn no_toml(source: &SourceText, error: &toml::de::Error) -> Error {
    let at = error.span().unwrap_or(0..0);
    let line = source.line(at.start);
    let written = source.text.lines().nth(line - 1).unwrap_or_default().trim();
    source.error(&at, "", format!("this is not TOML ({}): {written}", error.message()))
}
