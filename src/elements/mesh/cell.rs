//! Kinds of cells: one row of a table each.

/// Properties of a cell type. Local numbers of nodes count from 0.
struct Shape {
    /// The word for them in files.
    word: &'static str,
    /// Several of them, in words.
    name: &'static str,
    dimension: usize,
    nodes: usize,
    /// Whether edges have mid nodes.
    quadratic: bool,
    /// Whether its dimension must be that of space; cells of other types also form strings and membranes.
    fills_space: bool,
    faces: &'static [&'static [usize]],
    /// Empty in two dimensions, where edges and faces are the same.
    edges: &'static [&'static [usize]],
    /// For each node in the middle of a face or of the cell corners of that, of which it is the mean: two opposite ones, or all of a
    /// simplex; such nodes come last.
    middles: &'static [&'static [usize]],
    /// The nodes in the order of a cell that is turned over.
    turned_over: &'static [usize],
    /// The corners at the other ends of the edges from the first one; these edges form a right-handed system.
    neighbours: &'static [usize],
    /// The number of its type in Gmsh, and the nodes of Gmsh's cell in the order of ours; none if Gmsh has no such type.
    gmsh: Option<(u8, &'static [usize])>,
}

/// Shape of a face of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaceKind {
    Point,
    Segment,
    /// With a mid node.
    Segment3,
    Triangle,
    /// With mid nodes.
    Triangle6,
    /// With mid nodes and one in the middle.
    Triangle7,
    Quadrilateral,
    /// With mid nodes.
    Quadrilateral8,
    /// With mid nodes and one in the middle.
    Quadrilateral9,
}

impl FaceKind {
    /// The shape of a face of so many nodes on the boundary of a body in a space of this dimension.
    pub(super) fn of(dimension: usize, nodes: usize) -> Self {
        match (dimension, nodes) {
            (_, 1) => Self::Point,
            (_, 2) => Self::Segment,
            (2, _) => Self::Segment3,
            (_, 3) => Self::Triangle,
            (_, 4) => Self::Quadrilateral,
            (_, 6) => Self::Triangle6,
            (_, 7) => Self::Triangle7,
            (_, 8) => Self::Quadrilateral8,
            _ => Self::Quadrilateral9,
        }
    }

    /// The shape of a face of so many nodes on the rim of a membrane in space, or at the end of a string.
    pub(crate) fn of_rim(nodes: usize) -> Self {
        Self::of(2, nodes)
    }

    /// Dimension of the face itself.
    pub(crate) fn dimension(self) -> usize {
        match self {
            Self::Point => 0,
            Self::Segment | Self::Segment3 => 1,
            Self::Triangle
            | Self::Triangle6
            | Self::Triangle7
            | Self::Quadrilateral
            | Self::Quadrilateral8
            | Self::Quadrilateral9 => 2,
        }
    }

    /// Number of its corner nodes, which come first.
    pub(crate) fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Segment | Self::Segment3 => 2,
            Self::Triangle | Self::Triangle6 | Self::Triangle7 => 3,
            Self::Quadrilateral | Self::Quadrilateral8 | Self::Quadrilateral9 => 4,
        }
    }

    /// The edges of a triangle or quadrilateral by local nodes: both ends, and the mid node if there is one.
    pub(crate) fn edges(self) -> &'static [&'static [usize]] {
        match self {
            Self::Point | Self::Segment | Self::Segment3 => &[],
            Self::Triangle => &[&[0, 1], &[1, 2], &[2, 0]],
            Self::Triangle6 | Self::Triangle7 => &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
            Self::Quadrilateral => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Self::Quadrilateral8 | Self::Quadrilateral9 => {
                &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]]
            }
        }
    }
}

/// Makes the enum of the kinds from their documentation and their shapes.
macro_rules! cell_kinds {
    ($($(#[$doc:meta])* $kind:ident => $shape:expr,)*) => {
        /// Shape of a cell, with the order of its nodes. It is that of VTK.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum CellKind {
            $($(#[$doc])* $kind,)*
        }

        impl CellKind {
            /// All kinds.
            pub(crate) const ALL: &[Self] = &[$(Self::$kind),*];

            const fn shape(self) -> &'static Shape {
                match self {
                    $(Self::$kind => { const SHAPE: &Shape = &$shape; SHAPE })*
                }
            }
        }
    };
}

/// The edges of hexahedra with mid nodes.
const HEXAHEDRON_EDGES: &[&[usize]] = &[
    &[0, 1, 8],
    &[1, 2, 9],
    &[2, 3, 10],
    &[3, 0, 11],
    &[4, 5, 12],
    &[5, 6, 13],
    &[6, 7, 14],
    &[7, 4, 15],
    &[0, 4, 16],
    &[1, 5, 17],
    &[2, 6, 18],
    &[3, 7, 19],
];

cell_kinds! {
    /// Two nodes.
    Segment => Shape {
        word: "segments",
        name: "segments",
        dimension: 1,
        nodes: 2,
        quadratic: false,
        fills_space: false,
        faces: &[&[0], &[1]],
        edges: &[&[0, 1]],
        middles: &[],
        turned_over: &[1, 0],
        neighbours: &[1],
        gmsh: Some((1, &[0, 1])),
    },
    /// Three nodes, counter-clockwise.
    Triangle => Shape {
        word: "triangles",
        name: "triangles",
        dimension: 2,
        nodes: 3,
        quadratic: false,
        fills_space: false,
        faces: &[&[0, 1], &[1, 2], &[2, 0]],
        edges: &[],
        middles: &[],
        turned_over: &[0, 2, 1],
        neighbours: &[1, 2],
        gmsh: Some((2, &[0, 1, 2])),
    },
    /// Six nodes: the corners counter-clockwise, then the middles of the edges 1-2, 2-3, 3-1.
    Triangle6 => Shape {
        word: "triangles6",
        name: "triangles of 6 nodes",
        dimension: 2,
        nodes: 6,
        quadratic: true,
        fills_space: false,
        faces: &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
        edges: &[],
        middles: &[],
        turned_over: &[0, 2, 1, 5, 4, 3],
        neighbours: &[1, 2],
        gmsh: Some((9, &[0, 1, 2, 3, 4, 5])),
    },
    /// Seven nodes: those of [`CellKind::Triangle6`], then the middle. A bubble, which is 0 on all edges, belongs to it.
    Triangle7 => Shape {
        word: "triangles7",
        name: "triangles of 7 nodes",
        dimension: 2,
        nodes: 7,
        quadratic: true,
        fills_space: true,
        faces: &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
        edges: &[],
        middles: &[&[0, 1, 2]],
        turned_over: &[0, 2, 1, 5, 4, 3, 6],
        neighbours: &[1, 2],
        gmsh: None,
    },
    /// Four nodes, counter-clockwise.
    Quadrilateral => Shape {
        word: "quadrilaterals",
        name: "quadrilaterals",
        dimension: 2,
        nodes: 4,
        quadratic: false,
        fills_space: false,
        faces: &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        edges: &[],
        middles: &[],
        turned_over: &[0, 3, 2, 1],
        neighbours: &[1, 3],
        gmsh: Some((3, &[0, 1, 2, 3])),
    },
    /// Nine nodes: the corners counter-clockwise, the middles of the edges 1-2, 2-3, 3-4, 4-1, the middle.
    Quadrilateral9 => Shape {
        word: "quadrilaterals9",
        name: "quadrilaterals of 9 nodes",
        dimension: 2,
        nodes: 9,
        quadratic: true,
        fills_space: true,
        faces: &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]],
        edges: &[],
        middles: &[&[0, 2]],
        turned_over: &[0, 3, 2, 1, 7, 6, 5, 4, 8],
        neighbours: &[1, 3],
        gmsh: Some((10, &[0, 1, 2, 3, 4, 5, 6, 7, 8])),
    },
    /// Four nodes: the first three counter-clockwise as seen from the fourth.
    Tetrahedron => Shape {
        word: "tetrahedra",
        name: "tetrahedra",
        dimension: 3,
        nodes: 4,
        quadratic: false,
        fills_space: true,
        faces: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
        edges: &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]],
        middles: &[],
        turned_over: &[0, 2, 1, 3],
        neighbours: &[1, 2, 3],
        gmsh: Some((4, &[0, 1, 2, 3])),
    },
    /// Ten nodes: the corners as in [`CellKind::Tetrahedron`], then the middles of the edges 1-2,
    /// 2-3, 3-1, 1-4, 2-4, 3-4.
    Tetrahedron10 => Shape {
        word: "tetrahedra10",
        name: "tetrahedra of 10 nodes",
        dimension: 3,
        nodes: 10,
        quadratic: true,
        fills_space: true,
        faces: &[
            &[0, 2, 1, 6, 5, 4],
            &[0, 1, 3, 4, 8, 7],
            &[1, 2, 3, 5, 9, 8],
            &[0, 3, 2, 7, 9, 6],
        ],
        edges: &[&[0, 1, 4], &[1, 2, 5], &[2, 0, 6], &[0, 3, 7], &[1, 3, 8], &[2, 3, 9]],
        middles: &[],
        turned_over: &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8],
        neighbours: &[1, 2, 3],
        gmsh: Some((11, &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8])),
    },
    /// Fifteen nodes: those of [`CellKind::Tetrahedron10`], then the middles of the faces 1-2-3, 1-2-4, 2-3-4, 1-3-4 and of
    /// the cell. Bubbles, which are 0 on all edges, belong to these.
    Tetrahedron15 => Shape {
        word: "tetrahedra15",
        name: "tetrahedra of 15 nodes",
        dimension: 3,
        nodes: 15,
        quadratic: true,
        fills_space: true,
        faces: &[
            &[0, 2, 1, 6, 5, 4, 10],
            &[0, 1, 3, 4, 8, 7, 11],
            &[1, 2, 3, 5, 9, 8, 12],
            &[0, 3, 2, 7, 9, 6, 13],
        ],
        edges: &[&[0, 1, 4], &[1, 2, 5], &[2, 0, 6], &[0, 3, 7], &[1, 3, 8], &[2, 3, 9]],
        middles: &[&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[0, 2, 3], &[0, 1, 2, 3]],
        turned_over: &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8, 10, 13, 12, 11, 14],
        neighbours: &[1, 2, 3],
        gmsh: None,
    },
    /// Eight nodes: four around one face, counter-clockwise as seen from the opposite one, then
    /// the four across from them.
    Hexahedron => Shape {
        word: "hexahedra",
        name: "hexahedra",
        dimension: 3,
        nodes: 8,
        quadratic: false,
        fills_space: true,
        faces: &[
            &[0, 3, 2, 1],
            &[4, 5, 6, 7],
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[3, 0, 4, 7],
        ],
        edges: &[
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
        middles: &[],
        turned_over: &[0, 3, 2, 1, 4, 7, 6, 5],
        neighbours: &[1, 3, 4],
        gmsh: Some((5, &[0, 1, 2, 3, 4, 5, 6, 7])),
    },
    /// Twenty nodes: the corners as in [`CellKind::Hexahedron`], then the middles of the edges 1-2, 2-3, 3-4,
    /// 4-1, 5-6, 6-7, 7-8, 8-5, 1-5, 2-6, 3-7, 4-8.
    Hexahedron20 => Shape {
        word: "hexahedra20",
        name: "hexahedra of 20 nodes",
        dimension: 3,
        nodes: 20,
        quadratic: true,
        fills_space: true,
        faces: &[
            &[0, 3, 2, 1, 11, 10, 9, 8],
            &[4, 5, 6, 7, 12, 13, 14, 15],
            &[0, 1, 5, 4, 8, 17, 12, 16],
            &[1, 2, 6, 5, 9, 18, 13, 17],
            &[2, 3, 7, 6, 10, 19, 14, 18],
            &[3, 0, 4, 7, 11, 16, 15, 19],
        ],
        edges: HEXAHEDRON_EDGES,
        middles: &[],
        turned_over: &[0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17],
        neighbours: &[1, 3, 4],
        gmsh: Some((17, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15])),
    },
    /// Twenty-seven nodes: those of [`CellKind::Hexahedron20`], then the middles of the faces 1-4-8-5, 2-3-7-6, 1-2-6-5,
    /// 4-3-7-8, 1-2-3-4, 5-6-7-8, and of the cell.
    Hexahedron27 => Shape {
        word: "hexahedra27",
        name: "hexahedra of 27 nodes",
        dimension: 3,
        nodes: 27,
        quadratic: true,
        fills_space: true,
        faces: &[
            &[0, 3, 2, 1, 11, 10, 9, 8, 24],
            &[4, 5, 6, 7, 12, 13, 14, 15, 25],
            &[0, 1, 5, 4, 8, 17, 12, 16, 22],
            &[1, 2, 6, 5, 9, 18, 13, 17, 21],
            &[2, 3, 7, 6, 10, 19, 14, 18, 23],
            &[3, 0, 4, 7, 11, 16, 15, 19, 20],
        ],
        edges: HEXAHEDRON_EDGES,
        middles: &[&[0, 7], &[1, 6], &[0, 5], &[3, 6], &[0, 2], &[4, 6], &[0, 6]],
        turned_over: &[0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 22, 23, 20, 21, 24, 25, 26],
        neighbours: &[1, 3, 4],
        gmsh: Some((12, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26])),
    },
}

impl CellKind {
    /// The word for cells of this kind in files and for other programs: `triangles6`, for one.
    pub fn word(self) -> &'static str {
        self.shape().word
    }

    /// Several of them, in words.
    pub(crate) fn name(self) -> &'static str {
        self.shape().name
    }

    /// Nodes of one cell.
    pub fn nodes(self) -> usize {
        self.shape().nodes
    }

    /// Whether edges have mid nodes.
    pub(crate) fn is_quadratic(self) -> bool {
        self.shape().quadratic
    }

    /// Dimension of the cell itself: 1 for a segment, 2 for triangles and quadrilaterals, 3 for
    /// tetrahedra and hexahedra.
    pub fn dimension(self) -> usize {
        self.shape().dimension
    }

    /// The faces of the cell as local node numbers (from 0): its ends in 1D, its edges in 2D.
    ///
    /// Corners come first and run in positive order as seen from outside (in 2D: with the cell to their
    /// left); the mid nodes of a quadratic cell follow, in the order of the edges of the face, and its middle if a
    /// node is there.
    pub fn faces(self) -> &'static [&'static [usize]] {
        self.shape().faces
    }

    /// Whether its dimension must be that of space; cells of other types also form strings and membranes.
    pub(crate) fn fills_space(self) -> bool {
        self.shape().fills_space
    }

    /// The edges of the cell as local node numbers (from 0): two corners, and the mid node between
    /// them if the cell is quadratic. In 2D edges and faces are the same.
    pub fn edges(self) -> &'static [&'static [usize]] {
        match self.dimension() {
            2 => self.faces(),
            _ => self.shape().edges,
        }
    }

    /// For each node in the middle of a face or of the cell corners of which it is the mean, as local numbers (from 0); such
    /// nodes come last.
    pub(crate) fn middles(self) -> &'static [&'static [usize]] {
        self.shape().middles
    }

    /// The nodes of the cell in the order of one that is turned over: local numbers (from 0).
    pub(super) fn turned_over(self) -> &'static [usize] {
        self.shape().turned_over
    }

    /// The corners next to the first one, in the order of the axes: local numbers (from 0).
    pub(super) fn neighbours(self) -> &'static [usize] {
        self.shape().neighbours
    }

    /// The number of Gmsh's type of element, and the nodes of it in the order of this crate; none if Gmsh has no such type.
    pub(super) fn gmsh(self) -> Option<(u8, &'static [usize])> {
        self.shape().gmsh
    }
}
