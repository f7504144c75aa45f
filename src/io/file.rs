//! Files that are either complete or absent, and files that name their kind.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

#[cfg(feature = "checkpoint")]
use serde::{Deserialize, de::DeserializeOwned};

#[cfg(feature = "checkpoint")]
use crate::base::input::{InputError, read_if_at_most};
use crate::dynamics::error::Error;

/// Writes `content` to a file next to `path`, which replaces `path` when it is complete and on the disk.
///
/// # Errors
/// [`Error::Output`] with `path`.
pub(crate) fn write_file(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    replace(path, content).map_err(|source| Error::Output { path: path.into(), source })
}

fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(directory)?;
    // readable for all, as the user's mask allows: temporary files are private otherwise
    let mut builder = tempfile::Builder::new();
    let mut file = builder.permissions(Permissions::from_mode(0o666)).tempfile_in(directory)?;
    let mut buffer = BufWriter::new(file.as_file_mut());
    content(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    // after a loss of power there is the old file or the new one, not a new one without content
    file.as_file().sync_all()?;
    file.persist(path)?;
    // the directory is synced, too, so that the new name is on the disk, where the file system supports that
    match File::open(directory)?.sync_all() {
        Err(error) if error.kind() != io::ErrorKind::InvalidInput => Err(error),
        _ => Ok(()),
    }
}

/// A kind of JSON files, each of which begins with its kind and its format.
#[cfg(feature = "checkpoint")]
pub(crate) struct Kind {
    /// Name of the kind as a file states it, the format that this version writes, and the oldest one that it reads.
    pub(crate) what: &'static str,
    pub(crate) format: u32,
    pub(crate) oldest: u32,
    /// The input that names such a file, in errors.
    pub(crate) input: &'static str,
    /// Hint in errors: the input to name in place of a file of another kind.
    pub(crate) help: &'static str,
    /// The most bytes that a file may have.
    pub(crate) most_bytes: u64,
}

/// Header of a file: its type and format number, readable in every format.
#[cfg(feature = "checkpoint")]
#[derive(Deserialize)]
struct Head {
    what: String,
    format: u32,
}

#[cfg(feature = "checkpoint")]
impl Kind {
    /// The record in the file at `path`.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no file that can be read; another kind of file or format, a damaged file.
    pub(crate) fn read<T: DeserializeOwned>(&self, path: &Path) -> Result<T, Error> {
        let unread = |source| Error::Read { path: path.into(), source };
        // opening a pipe may block for ever
        if !fs::metadata(path).map_err(unread)?.is_file() {
            return Err(self.refuse(path, "it is no regular file: name one"));
        }
        let Some(text) = read_if_at_most(path, self.most_bytes).map_err(unread)? else {
            return Err(self.refuse(path, format!("it has more than {} bytes", self.most_bytes)));
        };
        self.parse(&text).map_err(|help| self.refuse(path, help))
    }

    /// The error that the file at `path` cannot be used.
    pub(crate) fn refuse(&self, path: &Path, help: impl Into<String>) -> Error {
        InputError::new(self.input, path.display(), help).into()
    }

    fn parse<T: DeserializeOwned>(&self, text: &[u8]) -> Result<T, String> {
        let Self { what, format, oldest, help, .. } = self;
        let none = || format!("it does not say \"{what}\": name {help}");
        let damaged = |error| format!("it is damaged or cut off ({error}): recreate it");
        let head: Head = serde_json::from_slice(text).map_err(|error| match error.is_data() {
            true => none(),
            false => damaged(error),
        })?;
        if head.what != *what {
            return Err(none());
        }
        if !(*oldest..=*format).contains(&head.format) {
            let known = match oldest == format {
                true => format!("format {format}"),
                false => format!("formats {oldest} to {format}"),
            };
            return Err(format!("it has format {}, this version reads {known}", head.format));
        }
        serde_json::from_slice(text).map_err(damaged)
    }
}
