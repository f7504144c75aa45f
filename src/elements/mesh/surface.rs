//! Closed surfaces of triangles, which a rigid solid lies within.
//!
//! A closed surface is a mesh of triangles in space, as a membrane is, with the mark that it has an inside
//! (`Mesh::has_inside`), which distinguishes bodies from membranes where that matters: pressure on one side,
//! shadows, pictures. Moments are sums over tetrahedra between the triangles and a point (divergence
//! theorem). Its thickness is V/A, so that the volumes of the cells add up to V; a membrane of it keeps the
//! shape in equilibria, as a strain that changes no length in three different planes is none.

mod file;
mod mend;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::{CellKind, Mesh};
use crate::base::input::InputError;

/// The height of a triangle over its longest side, and the volume over the cube of the size, below which they are round-off.
const FLAT: f64 = 1e-12;

/// Volume (m^3), centre (m) and second moments about it, int (x - c)(x - c)^T dV (m^5), of a solid.
pub(crate) struct Enclosed {
    pub(crate) volume: f64,
    pub(crate) centre: Vector3<f64>,
    pub(crate) second: Matrix3<f64>,
}

impl Mesh {
    /// The triangles of a mesh in space as the surface of a solid: a [rigid](crate::Material::rigid) body may have such a mesh instead
    /// of cells that fill it.
    ///
    /// The solid moves, touches and is drawn by its triangles; its mass and its moments of inertia are those of the enclosed volume.
    /// Triangles are turned over until all of them run counter-clockwise as seen from outside.
    ///
    /// ```
    /// use pliant::{Body, Material, Mesh, mesh::CellKind};
    ///
    /// let corners = vec![0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1];
    /// let faces = vec![0, 1, 2, 0, 1, 3, 1, 2, 3, 2, 0, 3];
    /// let surface = Mesh::new(3, corners, CellKind::Triangle, faces)?.closed()?;
    /// let body = Body::new(surface, Material::rigid(6000.0)).build()?;
    /// assert!((body.mass() - 1.0).abs() < 1e-12); // kg
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Cells that are no triangles in space; a triangle without an area; an edge with one triangle, where the surface is open,
    /// or with more than two; triangles that enclose no volume; several surfaces apart.
    pub fn closed(mut self) -> Result<Self, InputError> {
        if (self.kind(), self.dimension) != (CellKind::Triangle, 3) {
            let value =
                format!("{} in a space of dimension {}", self.kind().name(), self.dimension);
            let help = "the surface of a solid is made of triangles of 3 nodes in space";
            return Err(InputError::new("cells of a surface", value, help));
        }
        for (number, cell) in (1..).zip(self.cells()) {
            let [a, b, c] = self.corners(cell);
            let sides = [b - a, c - b, a - c].map(|side| side.norm());
            let longest = sides.into_iter().fold(0.0, f64::max);
            if (b - a).cross(&(c - a)).norm() <= FLAT * longest * longest {
                let help = "its corners are on a line, so that it has no area: leave it out, and join the triangles beside it";
                let input = format!("triangle {number} of a surface");
                return Err(InputError::new(input, told(&[a, b, c]), help));
            }
        }
        self.orient()?;
        self.blocks[0].is_surface = true;
        let volume = self.enclosed().volume;
        if volume < 0.0 {
            let triangles = self.blocks[0].connectivity.chunks_exact_mut(3);
            triangles.for_each(|triangle| triangle.swap(1, 2));
        }
        if volume.abs() <= FLAT * self.size().powi(3) {
            let help = "the surface of a solid has one: are its two sides the same?";
            return Err(InputError::new("volume of a surface", format!("{volume:e}"), help));
        }
        Ok(self)
    }

    /// Whether its triangles are the closed surface of a solid.
    pub(crate) fn is_surface(&self) -> bool {
        self.blocks.iter().any(|block| block.is_surface)
    }

    /// Whether its boundary has an inside: it fills its space or is the surface of a solid, and is no string or membrane.
    pub(crate) fn has_inside(&self) -> bool {
        let has =
            |block: &super::Block| block.is_surface || block.kind.dimension() == self.dimension;
        self.blocks.iter().all(has)
    }

    /// Volume and moments inside a closed surface, by the divergence theorem: the sum over tetrahedra between its triangles and a
    /// point, with negative volume for inverted ones.
    pub(crate) fn enclosed(&self) -> Enclosed {
        let count = self.node_count() as f64;
        let nodes = self.positions.as_chunks::<3>().0.iter();
        let origin = nodes.fold(Vector3::zeros(), |sum, x| sum + Vector3::from(*x) / count);
        let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for cell in self.cells() {
            let [a, b, c] = self.corners(cell).map(|corner| corner - origin);
            let part = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            let squares = [a, b, c, sum].map(|x| x * x.transpose());
            volume += part;
            first += part / 4.0 * sum;
            second += part / 20.0 * squares.iter().sum::<Matrix3<f64>>();
        }
        let centre = first / volume;
        Enclosed {
            volume,
            centre: origin + centre,
            second: second - volume * centre * centre.transpose(),
        }
    }

    /// The area (m^2) of the triangles in space.
    pub(crate) fn area(&self) -> f64 {
        let area = |cell: &[usize]| {
            let [a, b, c] = self.corners(cell);
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        self.cells().map(area).sum()
    }

    /// The corners (m) of a triangle in space.
    fn corners(&self, cell: &[usize]) -> [Vector3<f64>; 3] {
        [0, 1, 2].map(|local| Vector3::from_column_slice(self.position(cell[local])))
    }

    /// Turns triangles over that do not run as the first one does.
    fn orient(&mut self) -> Result<(), InputError> {
        // the triangles at each edge, by its ends in ascending order
        let mut edges: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (number, cell) in self.cells().enumerate() {
            for ends in sides(cell) {
                edges.entry([ends[0].min(ends[1]), ends[0].max(ends[1])]).or_default().push(number);
            }
        }
        for (ends, triangles) in &edges {
            let help = match triangles.len() {
                2 => continue,
                1 => {
                    "the surface is open there: close the hole, or join points that are meant to be one, where it was drawn"
                }
                _ => {
                    "two triangles meet at an edge of a solid: leave walls within it out, or make a body of each solid"
                }
            };
            let ends = ends.map(|node| Vector3::from_column_slice(self.position(node)));
            let input = format!("triangles at the edge {}", told(&ends));
            return Err(InputError::new(input, triangles.len(), help));
        }
        let triangles = self.blocks[0].connectivity.as_chunks_mut::<3>().0;
        let mut is_seen = vec![false; triangles.len()];
        is_seen[0] = true;
        let mut next = vec![0];
        while let Some(number) = next.pop() {
            let triangle = triangles[number];
            for [from, to] in sides(&triangle) {
                let both = &edges[&[from.min(to), from.max(to)]];
                let other = if both[0] == number { both[1] } else { both[0] };
                let runs_alike = sides(&triangles[other]).contains(&[from, to]);
                match (is_seen[other], runs_alike) {
                    (true, true) => {
                        let help = "inside and outside are the same there, as on a Klein bottle: no solid has it";
                        return Err(InputError::new("surface", "one-sided", help));
                    }
                    (true, false) => continue,
                    (false, true) => triangles[other].swap(1, 2),
                    (false, false) => {}
                }
                is_seen[other] = true;
                next.push(other);
            }
        }
        match is_seen.iter().filter(|is_seen| !**is_seen).count() {
            0 => Ok(()),
            apart => {
                let help = "make a body of each solid; a solid with a hole inside needs mass and inertia by numbers and its outer \
                            surface alone, or a mesh of cells";
                let input = "triangles apart from the surface of the first one";
                Err(InputError::new(input, apart, help))
            }
        }
    }
}

/// The sides of a triangle, from node to node.
fn sides(triangle: &[usize]) -> [[usize; 2]; 3] {
    [[0, 1], [1, 2], [2, 0]].map(|[from, to]| [triangle[from], triangle[to]])
}

/// Points, for messages.
fn told(points: &[Vector3<f64>]) -> String {
    let point = |x: &Vector3<f64>| format!("({}, {}, {})", x[0], x[1], x[2]);
    points.iter().map(point).collect::<Vec<_>>().join(" - ")
}
