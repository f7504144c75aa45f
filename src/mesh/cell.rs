//! Shapes of cells.

/// Shape of a cell, with the order of its nodes. It is that of VTK; Gmsh swaps the last two nodes
/// of [`CellKind::Tetrahedron10`] and agrees otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CellKind {
    /// Two nodes.
    Segment,
    /// Three nodes, counter-clockwise.
    Triangle,
    /// Six nodes: the corners counter-clockwise, then the middles of the edges 1-2, 2-3, 3-1.
    Triangle6,
    /// Four nodes, counter-clockwise.
    Quadrilateral,
    /// Four nodes: the first three counter-clockwise as seen from the fourth.
    Tetrahedron,
    /// Ten nodes: the corners as in [`CellKind::Tetrahedron`], then the middles of the edges 1-2,
    /// 2-3, 3-1, 1-4, 2-4, 3-4.
    Tetrahedron10,
    /// Eight nodes: four around one face, counter-clockwise as seen from the opposite one, then
    /// the four across from them.
    Hexahedron,
}

impl CellKind {
    /// Nodes of one cell.
    pub fn nodes(self) -> usize {
        match self {
            Self::Segment => 2,
            Self::Triangle => 3,
            Self::Triangle6 => 6,
            Self::Quadrilateral | Self::Tetrahedron => 4,
            Self::Tetrahedron10 => 10,
            Self::Hexahedron => 8,
        }
    }

    /// Whether edges have mid nodes.
    pub(crate) fn is_quadratic(self) -> bool {
        matches!(self, Self::Triangle6 | Self::Tetrahedron10)
    }

    /// Dimension of the cell itself: 1 for a segment, 2 for triangles and quadrilaterals, 3 for
    /// tetrahedra and hexahedra.
    pub fn dimension(self) -> usize {
        match self {
            Self::Segment => 1,
            Self::Triangle | Self::Triangle6 | Self::Quadrilateral => 2,
            Self::Tetrahedron | Self::Tetrahedron10 | Self::Hexahedron => 3,
        }
    }

    /// The faces of the cell as local node numbers (from 0): its ends in 1D, its edges in 2D.
    /// Corners come first and run in positive order as seen from outside (in 2D: with the cell to
    /// their left); the mid nodes of a quadratic cell follow, in the order of the edges of the
    /// face.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Segment => &[&[0], &[1]],
            Self::Triangle => &[&[0, 1], &[1, 2], &[2, 0]],
            Self::Triangle6 => &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
            Self::Quadrilateral => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Self::Tetrahedron => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
            Self::Tetrahedron10 => &[
                &[0, 2, 1, 6, 5, 4],
                &[0, 1, 3, 4, 8, 7],
                &[1, 2, 3, 5, 9, 8],
                &[0, 3, 2, 7, 9, 6],
            ],
            Self::Hexahedron => &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
        }
    }

    /// The edges of the cell as local node numbers (from 0): two corners, and the mid node between
    /// them if the cell is quadratic. In 2D edges and faces are the same.
    pub fn edges(self) -> &'static [&'static [usize]] {
        match self {
            Self::Segment => &[&[0, 1]],
            Self::Triangle | Self::Triangle6 | Self::Quadrilateral => self.faces(),
            Self::Tetrahedron => &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]],
            Self::Tetrahedron10 => {
                &[&[0, 1, 4], &[1, 2, 5], &[2, 0, 6], &[0, 3, 7], &[1, 3, 8], &[2, 3, 9]]
            }
            Self::Hexahedron => &[
                &[0, 1],
                &[1, 2],
                &[2, 3],
                &[3, 0],
                &[4, 5],
                &[5, 6],
                &[6, 7],
                &[7, 4],
                &[0, 4],
                &[1, 5],
                &[2, 6],
                &[3, 7],
            ],
        }
    }

    /// The nodes of the cell in the order of one that is turned over: local numbers (from 0).
    pub(super) fn turned_over(self) -> &'static [usize] {
        match self {
            Self::Segment => &[1, 0],
            Self::Triangle => &[0, 2, 1],
            Self::Triangle6 => &[0, 2, 1, 5, 4, 3],
            Self::Quadrilateral => &[0, 3, 2, 1],
            Self::Tetrahedron => &[0, 2, 1, 3],
            Self::Tetrahedron10 => &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8],
            Self::Hexahedron => &[0, 3, 2, 1, 4, 7, 6, 5],
        }
    }
}
