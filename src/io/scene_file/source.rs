//! The text of a scene file, and errors that point into it.

use std::cell::RefCell;
use std::fmt::Display;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::dynamics::error::Error;

/// The text of a scene file and where it comes from.
pub(super) struct SourceText<'a> {
    pub(super) path: &'a Path,
    /// Followed by the overrides of its values, one in each line.
    pub(super) text: &'a str,
    /// Length of the file itself.
    pub(super) own: usize,
    /// What `pliant check` says about it.
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
