//! Numbers and lines of a file of Gmsh, text or binary, one after the other.

use std::fmt::Display;
use std::str::FromStr;

/// The encoding of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Binary { is_big_endian: bool },
}

/// A place in a file. Every number is checked when it is read, so a count of things that the file does not hold
/// ends at the end of the file.
pub(super) struct Reader<'a> {
    file: &'a [u8],
    at: usize,
    encoding: Encoding,
    /// The section that is read, for messages.
    section: String,
}

impl<'a> Reader<'a> {
    pub(super) fn new(file: &'a [u8]) -> Self {
        Self { file, at: 0, encoding: Encoding::Text, section: "its format".into() }
    }

    /// Bytes of the whole file.
    pub(super) fn file_length(&self) -> usize {
        self.file.len()
    }

    pub(super) fn is_text(&self) -> bool {
        self.encoding == Encoding::Text
    }

    /// An error at the present place, or at the word before it.
    pub(super) fn broken(&self, problem: impl Display) -> String {
        let before = self.file[..self.at].trim_ascii_end();
        let place = match self.encoding {
            Encoding::Text => {
                format!("line {}", before.iter().filter(|&&byte| byte == b'\n').count() + 1)
            }
            Encoding::Binary { .. } => format!("byte {}", self.at),
        };
        format!("it is broken at {place}, in {}: {problem}; export it again", self.section)
    }

    /// The next line that is not empty, without white space around it; none at the end of the file.
    pub(super) fn line(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let rest = &self.file[self.at..];
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += length;
        Some(rest[..length].trim_ascii()).filter(|line| !line.is_empty())
    }

    fn skip_space(&mut self) {
        self.at +=
            self.file[self.at..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    /// Binary files have the number 1 after the line of the format.
    pub(super) fn find_byte_order(&mut self) -> Result<(), String> {
        self.skip_line_break();
        let is_big_endian = match self.bytes::<4>("the number 1")? {
            [1, 0, 0, 0] => false,
            [0, 0, 0, 1] => true,
            other => return Err(self.broken(format!("the bytes {other:?} are not the number 1"))),
        };
        self.encoding = Encoding::Binary { is_big_endian };
        Ok(())
    }

    /// Begins the section that the next line names; none at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<&'a [u8]>, String> {
        let Some(line) = self.line() else { return Ok(None) };
        let Some(name) = line.strip_prefix(b"$") else {
            let line = String::from_utf8_lossy(&line[..line.len().min(40)]);
            return Err(self.broken(format!("\"{line}\" begins no section")));
        };
        self.section = format!("its section {}", String::from_utf8_lossy(line));
        self.skip_line_break();
        Ok(Some(name))
    }

    /// The line break after a line: what follows it may be binary.
    fn skip_line_break(&mut self) {
        let rest = &self.file[self.at..];
        let length = rest.iter().position(|&byte| byte == b'\n').map_or(rest.len(), |at| at + 1);
        self.at += length;
    }

    /// The text of a section up to its end, at which the reader is then.
    pub(super) fn up_to_end(&mut self, name: &[u8]) -> Result<&'a [u8], String> {
        let end = [b"$End", name].concat();
        let rest = &self.file[self.at..];
        let length = rest.windows(end.len()).position(|window| window == end);
        let length = length.ok_or_else(|| self.broken("it has no end"))?;
        self.at += length;
        Ok(&rest[..length])
    }

    /// Ends the section `name`.
    pub(super) fn end(&mut self, name: &[u8]) -> Result<(), String> {
        let line = self.line().unwrap_or_default();
        if line.strip_prefix(b"$End") == Some(name) {
            self.section = format!("what follows {}", String::from_utf8_lossy(line));
            return Ok(());
        }
        let found = String::from_utf8_lossy(&line[..line.len().min(40)]);
        Err(self.broken(format!("its end is expected, and \"{found}\" found")))
    }

    /// The count at the beginning of a section of version 2, which is text in binary files, too.
    pub(super) fn count_line(&mut self) -> Result<usize, String> {
        let line = self.line().unwrap_or_default();
        self.skip_line_break();
        self.parsed(line, "count")
    }

    pub(super) fn point(&mut self) -> Result<[f64; 3], String> {
        Ok([self.real("x coordinate")?, self.real("y coordinate")?, self.real("z coordinate")?])
    }

    /// The next number, or the bytes of one.
    fn number<T: FromStr, const N: usize>(
        &mut self,
        what: &str,
        [from_little, from_big]: [fn([u8; N]) -> T; 2],
    ) -> Result<T, String> {
        match self.encoding {
            Encoding::Text => self.word(what),
            Encoding::Binary { is_big_endian: false } => self.bytes(what).map(from_little),
            Encoding::Binary { is_big_endian: true } => self.bytes(what).map(from_big),
        }
    }

    /// A whole number of four bytes.
    pub(super) fn int(&mut self, what: &str) -> Result<i32, String> {
        self.number(what, [i32::from_le_bytes, i32::from_be_bytes])
    }

    /// A count or a tag of eight bytes.
    pub(super) fn size(&mut self, what: &str) -> Result<u64, String> {
        self.number(what, [u64::from_le_bytes, u64::from_be_bytes])
    }

    pub(super) fn real(&mut self, what: &str) -> Result<f64, String> {
        self.number(what, [f64::from_le_bytes, f64::from_be_bytes])
    }

    fn bytes<const N: usize>(&mut self, what: &str) -> Result<[u8; N], String> {
        let bytes = self.file[self.at..].first_chunk::<N>();
        let bytes =
            *bytes.ok_or_else(|| self.broken(format!("the file ends before its {what}")))?;
        self.at += N;
        Ok(bytes)
    }

    fn word<T: FromStr>(&mut self, what: &str) -> Result<T, String> {
        self.skip_space();
        let rest = &self.file[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += length;
        self.parsed(&rest[..length], what)
    }

    fn parsed<T: FromStr>(&self, word: &[u8], what: &str) -> Result<T, String> {
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| match String::from_utf8_lossy(&word[..word.len().min(40)]) {
            word if word.is_empty() => self.broken(format!("the file ends before its {what}")),
            word => self.broken(format!("\"{word}\" is no {what}")),
        })
    }
}
