//! Twenty-node serendipity hexahedron on the unit cube: corners as in the eight-node one, then the middles of
//! the edges in the order of VTK.
//!
//! The quadrature is that of 14 points and degree 5 (B. M. Irons, Int. J. Numer. Meth. Engng. 3 (1971)
//! 293-294). Gauss's rule with 8 points leaves a single cell 6 zero-energy modes, and a clamped row of cells,
//! one cell thick, one mode for each cell: it does not suit meshes that are not known beforehand. With 14
//! points no cell, row or block has such a mode; only terms of the highest degree and curved edges are not
//! integrated exactly, as in tetrahedra of 10 nodes.

use super::ReferenceCell;
use super::quadrilateral8::{serendipity, serendipity_derivatives};
use super::segment3::Segment3;

/// Points and weights of the rule of degree 5 with 14 points (Irons 1971): six on the lines from the middle
/// to the faces, eight on those to the corners, at distances sqrt(19/30)/2 and sqrt(19/33)/2 along the axes.
const FACE: f64 = 0.397_911_212_877_110_7;
const FACE_WEIGHT: f64 = 40.0 / 361.0;
const CORNER: f64 = 0.379_393_455_319_664_07;
const CORNER_WEIGHT: f64 = 121.0 / 2888.0;

const fn face([x, y, z]: [f64; 3]) -> ([f64; 3], f64) {
    ([0.5 + FACE * x, 0.5 + FACE * y, 0.5 + FACE * z], FACE_WEIGHT)
}

const fn corner([x, y, z]: [f64; 3]) -> ([f64; 3], f64) {
    ([0.5 + CORNER * x, 0.5 + CORNER * y, 0.5 + CORNER * z], CORNER_WEIGHT)
}

/// Gauss's rule with three points along each axis.
pub(super) const CUBE: [([f64; 3], f64); 27] = {
    let line = Segment3::MASS_RULE;
    let mut rule = [([0.0; 3], 0.0); 27];
    let mut k = 0;
    while k < 27 {
        let (([x], p), ([y], q), ([z], r)) = (line[k % 3], line[k / 3 % 3], line[k / 9]);
        rule[k] = ([x, y, z], p * q * r);
        k += 1;
    }
    rule
};

pub(crate) struct Hexahedron20;

impl ReferenceCell<20, 3> for Hexahedron20 {
    const NODES: [[f64; 3]; 20] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
        [0.5, 0.0, 0.0],
        [1.0, 0.5, 0.0],
        [0.5, 1.0, 0.0],
        [0.0, 0.5, 0.0],
        [0.5, 0.0, 1.0],
        [1.0, 0.5, 1.0],
        [0.5, 1.0, 1.0],
        [0.0, 0.5, 1.0],
        [0.0, 0.0, 0.5],
        [1.0, 0.0, 0.5],
        [1.0, 1.0, 0.5],
        [0.0, 1.0, 0.5],
    ];
    /// The stiffness has full rank. With Gauss's rule of two points along each axis (8 points, cheaper) it
    /// does not: at these points the strain of u = (x (3 y^2 - 1), -y (3 x^2 - 1), 0) f(z), in coordinates
    /// from -1 to 1, is 0, for any f at the ends of the cell. A row of cells, one thick, would have such
    /// a zero-energy mode in each plane between two of them, even where its end is clamped.
    const STIFFNESS_RULE: &'static [([f64; 3], f64)] = &[
        face([-1.0, 0.0, 0.0]),
        face([1.0, 0.0, 0.0]),
        face([0.0, -1.0, 0.0]),
        face([0.0, 1.0, 0.0]),
        face([0.0, 0.0, -1.0]),
        face([0.0, 0.0, 1.0]),
        corner([-1.0, -1.0, -1.0]),
        corner([1.0, -1.0, -1.0]),
        corner([-1.0, 1.0, -1.0]),
        corner([1.0, 1.0, -1.0]),
        corner([-1.0, -1.0, 1.0]),
        corner([1.0, -1.0, 1.0]),
        corner([-1.0, 1.0, 1.0]),
        corner([1.0, 1.0, 1.0]),
    ];
    /// Exact for the inertia of a cuboid.
    const MASS_RULE: &'static [([f64; 3], f64)] = &CUBE;

    fn values(x: [f64; 3]) -> [f64; 20] {
        serendipity(Self::NODES, x)
    }

    fn derivatives(x: [f64; 3]) -> [[f64; 3]; 20] {
        serendipity_derivatives(Self::NODES, x)
    }
}
