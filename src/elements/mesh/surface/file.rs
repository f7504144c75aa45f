//! Surfaces from files: STL, OBJ, and triangles of Gmsh.

use std::path::Path;

use super::mend::mended;
use crate::base::input::{InputError, read_at_most};
use crate::elements::mesh::Mesh;

/// Bytes that a file may have: those of some ten million triangles.
const MOST_BYTES: u64 = 1 << 30;

/// Bytes of a binary STL file before its triangles, and of each of them.
const STL_HEAD: usize = 84;
const STL_TRIANGLE: usize = 50;

/// Points, three of them for each triangle.
type Corners = Vec<[f64; 3]>;

impl Mesh {
    /// Reads the surface of a solid from a file: STL (`.stl`, text or binary), OBJ (`.obj`) or Gmsh (`.msh`, with triangles of 3
    /// nodes alone; see [`read_gmsh`](Self::read_gmsh)).
    ///
    /// Coordinates are in metres; scale a drawing in millimetres with [`mapped`](Self::mapped) by 0.001. Points of STL and OBJ
    /// files at the same place, but for round-off (5e-7 of the largest coordinate), are one node, in the order in which they come
    /// first. Triangles without an area are omitted, and triangles with corners of others on their sides are divided there; both
    /// are [notes](Self::notes). Of OBJ files the lines `v` and `f` are read; faces of more than three corners are divided into triangles
    /// around the first one. The surface is checked and turned outwards as by [`closed`](Self::closed).
    ///
    /// # Errors
    /// A file that cannot be read, of another format or broken; a surface that is not closed.
    pub fn read_surface(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
        let read: fn(&[u8]) -> Result<Corners, String> = match extension.as_deref() {
            Some(extension) if extension == "stl" => stl,
            Some(extension) if extension == "obj" => obj,
            #[cfg(feature = "gmsh")]
            Some(extension) if extension == "msh" => return Self::read_gmsh_in(path, 3)?.closed(),
            _ => {
                let help = "surfaces are read from files .stl, .obj and, of Gmsh, .msh";
                return Err(InputError::new("mesh file", path.display(), help));
            }
        };
        let file =
            read_at_most(path, MOST_BYTES).map_err(|error| format!("it cannot be read: {error}"));
        let corners = file.and_then(|file| read(&file));
        let mesh = corners.and_then(|corners| mended(&corners).map_err(|error| error.to_string()));
        mesh.and_then(|mesh| mesh.closed().map_err(|error| error.to_string()))
            .map(|mesh| Self { file: Some(path.into()), ..mesh })
            .map_err(|problem| InputError::new("mesh file", path.display(), problem))
    }
}

/// The corners in an STL file: its length says whether it is a binary one, as its first word may be "solid" in both. Binary files may
/// have bytes to spare at their end.
fn stl(file: &[u8]) -> Result<Corners, String> {
    if let Some(count) = file.get(STL_HEAD - 4..STL_HEAD).and_then(|count| count.try_into().ok()) {
        let count = u64::from(u32::from_le_bytes(count)) * STL_TRIANGLE as u64;
        let has_spare = std::str::from_utf8(file).is_err() && count > 0;
        let all = &file[STL_HEAD..];
        if all.len() as u64 == count || (has_spare && all.len() as u64 > count) {
            let triangles = &all[..count as usize];
            // a normal, three corners, two bytes of other use
            let corners = triangles.chunks_exact(STL_TRIANGLE).flat_map(|triangle| {
                let numbers = triangle[12..48].as_chunks::<4>().0.iter();
                let numbers: Vec<f64> =
                    numbers.map(|x| f64::from(f32::from_le_bytes(*x))).collect();
                numbers.as_chunks::<3>().0.to_vec()
            });
            return Ok(corners.collect());
        }
    }
    let text = text(file, "it is no STL file: neither of the length of a binary one nor text")?;
    let mut corners = Vec::new();
    for (line, words) in words(text) {
        match &*words[0].to_ascii_lowercase() {
            "vertex" => corners.push(point(line, &words[1..])?),
            "endloop" if corners.len() % 3 != 0 => {
                return Err(format!("line {line} ends a loop without three corners"));
            }
            _ => {}
        }
    }
    match corners.len() {
        0 => Err("it has no triangles".into()),
        count if count % 3 != 0 => Err("it ends within a triangle".into()),
        _ => Ok(corners),
    }
}

/// The corners of the faces in an OBJ file.
fn obj(file: &[u8]) -> Result<Corners, String> {
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    for (line, words) in words(text(file, "it is no OBJ file: no text")?) {
        match words[0] {
            "v" => points.push(point(line, &words[1..])?),
            "f" => {
                let corner = |word: &&str| -> Option<[f64; 3]> {
                    // "7/2/5": the point, its texture, its normal; below 0 counted from the last one back
                    let number: i64 = word.split('/').next()?.parse().ok()?;
                    let index = if number < 0 { points.len() as i64 + number } else { number - 1 };
                    points.get(usize::try_from(index).ok()?).copied()
                };
                let face: Option<Vec<[f64; 3]>> = words[1..].iter().map(corner).collect();
                let face = face.filter(|face| face.len() > 2);
                let face =
                    face.ok_or_else(|| format!("line {line} is no face between points before it"))?;
                for pair in face[1..].windows(2) {
                    corners.extend([face[0], pair[0], pair[1]]);
                }
            }
            _ => {}
        }
    }
    if corners.is_empty() { Err("it has no faces".into()) } else { Ok(corners) }
}

fn text<'a>(file: &'a [u8], problem: &str) -> Result<&'a str, String> {
    std::str::from_utf8(file).map_err(|_| problem.into())
}

/// The words of each line that has any, with its number from 1.
fn words(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    let lines = (1..).zip(text.lines());
    lines
        .map(|(line, text)| (line, text.split_whitespace().collect()))
        .filter(|(_, words): &(_, Vec<_>)| !words.is_empty())
}

/// The point at the beginning of `words`.
fn point(line: usize, words: &[&str]) -> Result<[f64; 3], String> {
    let number = |word: &&str| word.parse().ok().filter(|x: &f64| x.is_finite());
    let numbers: Option<Vec<f64>> = words.iter().take(3).map(number).collect();
    let point = numbers.and_then(|numbers| numbers.try_into().ok());
    point.ok_or_else(|| format!("line {line} has no three coordinates"))
}
