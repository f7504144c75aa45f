//! Files that are read as a whole.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The contents of the file at `path`, if it has at most `most` bytes: some files, such as `/dev/zero`, never
/// end.
pub(crate) fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let too_long = || io::Error::other(format!("it has more than {} MiB", most >> 20));
    read_if_at_most(path, most)?.ok_or_else(too_long)
}

/// As [`read_at_most`], but `None` for a longer file.
pub(crate) fn read_if_at_most(path: &Path, most: u64) -> io::Result<Option<Vec<u8>>> {
    let mut contents = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut contents)?;
    Ok(Some(contents).filter(|contents| contents.len() as u64 <= most))
}
