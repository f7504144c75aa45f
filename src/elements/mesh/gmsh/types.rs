//! Types of elements in files of Gmsh.

/// One type: its number in the files, and its properties.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ElementType {
    pub(super) number: u8,
    pub(super) dimension: usize,
    /// Number of nodes.
    pub(super) nodes: usize,
    shape: &'static str,
}

/// Number, dimension, nodes and shape of the types; those of an order above 4 are omitted.
const TYPES: &[(u8, usize, usize, &str)] = &[
    (1, 1, 2, "lines"),
    (2, 2, 3, "triangles"),
    (3, 2, 4, "quadrilaterals"),
    (4, 3, 4, "tetrahedra"),
    (5, 3, 8, "hexahedra"),
    (6, 3, 6, "prisms"),
    (7, 3, 5, "pyramids"),
    (8, 1, 3, "lines"),
    (9, 2, 6, "triangles"),
    (10, 2, 9, "quadrilaterals"),
    (11, 3, 10, "tetrahedra"),
    (12, 3, 27, "hexahedra"),
    (13, 3, 18, "prisms"),
    (14, 3, 14, "pyramids"),
    (15, 0, 1, "points"),
    (16, 2, 8, "quadrilaterals"),
    (17, 3, 20, "hexahedra"),
    (18, 3, 15, "prisms"),
    (19, 3, 13, "pyramids"),
    (20, 2, 9, "triangles"),
    (21, 2, 10, "triangles"),
    (22, 2, 12, "triangles"),
    (23, 2, 15, "triangles"),
    (24, 2, 15, "triangles"),
    (25, 2, 21, "triangles"),
    (26, 1, 4, "lines"),
    (27, 1, 5, "lines"),
    (28, 1, 6, "lines"),
    (29, 3, 20, "tetrahedra"),
    (30, 3, 35, "tetrahedra"),
    (31, 3, 56, "tetrahedra"),
    (36, 2, 16, "quadrilaterals"),
    (37, 2, 25, "quadrilaterals"),
    (90, 3, 40, "prisms"),
    (91, 3, 75, "prisms"),
    (92, 3, 64, "hexahedra"),
    (93, 3, 125, "hexahedra"),
];

impl ElementType {
    /// The type of a number.
    pub(super) fn of(number: i32) -> Option<Self> {
        let known = TYPES.iter().find(|row| i32::from(row.0) == number);
        known.map(|&(number, dimension, nodes, shape)| Self { number, dimension, nodes, shape })
    }

    /// The entity on which such elements lie.
    pub(super) fn entity(self) -> &'static str {
        ["point", "curve", "surface", "volume"][self.dimension]
    }

    /// Several of them, in words.
    pub(super) fn words(self) -> String {
        format!("{} of {} node(s)", self.shape, self.nodes)
    }
}
