//! Structured grids, the frame of all generators in two and three dimensions.

use std::fmt;
use std::str::FromStr;

use crate::base::input::InputError;
use crate::elements::mesh::{CellKind, Mesh};

/// Division of a two-dimensional grid into cells.
///
/// Cells are numbered row by row of the grid; of two triangles per grid cell, first the lower ones
/// of the row, then the upper ones (in a ring: first the ones that begin with inner and outer node
/// of a station, then the others).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cells {
    /// Two triangles per grid cell. In a rectangle all diagonals run from upper left to lower
    /// right: lower triangle (1, 2, 5) and upper triangle (6, 5, 2) in a grid of 4 x 4 nodes. In a
    /// ring they run from the inner node of a station to the outer node of the next.
    Triangles,
    /// Two triangles per grid cell with diagonals that alternate like a checkerboard, so that no
    /// direction is preferred: grid cell (i, j) with i + j even is divided from lower left to upper
    /// right, the others from upper left to lower right. (Ring: i + j even from inner node of
    /// station j to the outer one of j + 1, i counting cells outward; stations must be even in
    /// number.) A pattern with an even number of grid cells along an axis is its own mirror image.
    Crossed,
    /// One four-node quadrilateral per grid cell.
    Rectangles,
    /// Quadratic triangles with the diagonals of [`Cells::Triangles`]. Corner nodes are numbered as
    /// there; the nodes in the middle of edges come after all of them, row by row of the grid with
    /// half the spacing.
    Triangles6,
    /// One nine-node quadrilateral per grid cell. Corner nodes are numbered as in [`Cells::Rectangles`]; the others come
    /// after all of them, row by row of the grid with half the spacing.
    Rectangles9,
}

impl Cells {
    /// All ways to divide a grid.
    pub const ALL: [Self; 5] =
        [Self::Triangles, Self::Crossed, Self::Rectangles, Self::Triangles6, Self::Rectangles9];

    /// Name: `triangles`, `crossed`, `rectangles`, `triangles6`, `rectangles9`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Crossed => "crossed",
            Self::Rectangles => "rectangles",
            Self::Triangles6 => "triangles6",
            Self::Rectangles9 => "rectangles9",
        }
    }

    /// The nodes that a grid of them has in addition to the corners.
    pub(super) fn mid_nodes(self) -> MidNodes {
        match self {
            Self::Triangles6 | Self::Rectangles9 => MidNodes::Everywhere,
            Self::Triangles | Self::Crossed | Self::Rectangles => MidNodes::None,
        }
    }
}

impl fmt::Display for Cells {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Cells {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|cells| cells.name() == name).ok_or_else(|| {
            let known = Self::ALL.map(Self::name).join(", ");
            InputError::new("cells", format!("\"{name}\""), format!("they are one of {known}"))
        })
    }
}

/// Corners of a grid cell, as steps along the two axes.
const A: [usize; 2] = [0, 0];
const B: [usize; 2] = [1, 0];
const C: [usize; 2] = [1, 1];
const D: [usize; 2] = [0, 1];

/// The cells that a grid cell is divided into, as corners of it.
type Division<const N: usize, const C: usize> = [[[usize; N]; C]];

/// One quadrilateral.
const WHOLE: [[[usize; 2]; 4]; 1] = [[A, B, C, D]];

/// Direction of a diagonal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Diagonal {
    /// From the upper left to the lower right corner.
    Falling,
    /// From the lower left to the upper right corner.
    Rising,
}

impl Diagonal {
    fn division(self) -> &'static Division<2, 3> {
        match self {
            Self::Falling => &[[A, B, D], [C, D, B]],
            Self::Rising => &[[A, B, C], [A, C, D]],
        }
    }
}

/// Which nodes a grid has in addition to the corners of its cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MidNodes {
    None,
    /// In the middles of its edges.
    OnEdges,
    /// There, and in the middles of its faces and cells, through which the edges of simplices run.
    Everywhere,
}

/// A grid of nodes along `N` axes. Places are counted in steps of half a grid cell if there are mid
/// nodes, in grid cells if not; the first axis runs fastest.
pub(super) struct Grid<const N: usize> {
    /// Grid cells along each axis.
    cells: [usize; N],
    /// The last axis closes upon itself.
    closed: bool,
    /// Steps per grid cell: 1, or 2 with nodes in the middle of edges.
    pub steps: usize,
    /// Number of the node at each place that has one.
    numbers: Vec<usize>,
    /// Place of each node.
    pub places: Vec<[usize; N]>,
}

impl<const N: usize> Grid<N> {
    pub(super) fn new(cells: [usize; N], closed: bool, mid_nodes: MidNodes) -> Self {
        let steps = if mid_nodes == MidNodes::None { 1 } else { 2 };
        let mut grid = Self { cells, closed, steps, numbers: Vec::new(), places: Vec::new() };
        let count = (0..N).map(|axis| grid.extent(axis)).product();
        // axes along which it is in the middle
        let middle = |place: &[usize; N]| place.iter().filter(|k| !k.is_multiple_of(steps)).count();
        let most = if mid_nodes == MidNodes::OnEdges { 1 } else { N };
        let (corners, middles): (Vec<_>, Vec<_>) = (0..count)
            .map(|index| grid.place(index))
            .filter(|place| middle(place) <= most)
            .partition(|place| middle(place) == 0);
        grid.places = [corners, middles].concat();
        grid.numbers = vec![usize::MAX; count];
        for (number, place) in grid.places.iter().enumerate() {
            let index = grid.index(place);
            grid.numbers[index] = number;
        }
        grid
    }

    /// Places along `axis`.
    fn extent(&self, axis: usize) -> usize {
        let open = usize::from(!self.closed || axis + 1 < N);
        self.steps * self.cells[axis] + open
    }

    fn place(&self, mut index: usize) -> [usize; N] {
        std::array::from_fn(|axis| {
            let along = index % self.extent(axis);
            index /= self.extent(axis);
            along
        })
    }

    fn index(&self, place: &[usize; N]) -> usize {
        (0..N)
            .rev()
            .fold(0, |index, axis| index * self.extent(axis) + place[axis] % self.extent(axis))
    }

    /// Divides each grid cell alike, or by its place; all divisions have the same number of
    /// cells. `kind` has the nodes of the division as corners.
    pub(super) fn divide<const CORNERS: usize>(
        &self,
        kind: CellKind,
        division: impl Fn([usize; N]) -> &'static Division<N, CORNERS>,
    ) -> Vec<usize> {
        let rows: usize = self.cells[1..].iter().product();
        let mut connectivity = Vec::with_capacity(rows * self.cells[0] * kind.nodes());
        for row in 0..rows {
            for part in 0..division([0; N]).len() {
                for column in 0..self.cells[0] {
                    let mut rest = row;
                    let cell = std::array::from_fn(|axis| {
                        if axis == 0 {
                            return column;
                        }
                        let along = rest % self.cells[axis];
                        rest /= self.cells[axis];
                        along
                    });
                    let corners = division(cell)[part]
                        .map(|corner| std::array::from_fn(|axis| cell[axis] + corner[axis]));
                    self.push_cell(kind, corners, &mut connectivity);
                }
            }
        }
        connectivity
    }

    /// Adds the nodes of a cell, `corners` counted in grid cells.
    fn push_cell<const CORNERS: usize>(
        &self,
        kind: CellKind,
        corners: [[usize; N]; CORNERS],
        connectivity: &mut Vec<usize>,
    ) {
        let number = |place: [usize; N]| self.numbers[self.index(&place)];
        connectivity.extend(corners.map(|corner| number(corner.map(|k| self.steps * k))));
        if self.steps == 2 {
            // twice the mean of two corners; no grid has nodes at thirds
            let middle = |ends: &[usize]| {
                let [a, b] = [corners[ends[0]], corners[ends[1]]];
                number(std::array::from_fn(|axis| a[axis] + b[axis]))
            };
            connectivity.extend(kind.edges().iter().map(|edge| middle(edge)));
            connectivity.extend(kind.middles().iter().map(|ends| middle(ends)));
        }
    }

    /// Gives the name of a side to the nodes with the least (or greatest) place along `axis`, in
    /// the order in which they stand there.
    pub(super) fn name_side(
        &self,
        mesh: Mesh,
        name: &str,
        axis: usize,
        greatest: bool,
    ) -> Result<Mesh, InputError> {
        let at = if greatest { self.steps * self.cells[axis] } else { 0 };
        let on_side = (0..self.numbers.len()).filter(|&index| self.place(index)[axis] == at);
        let numbers = on_side.map(|index| self.numbers[index]);
        let numbers = numbers.filter(|&number| number < self.places.len());
        mesh.name_nodes(name, numbers.map(|number| number + 1).collect::<Vec<_>>())
    }
}

impl Grid<2> {
    /// A mesh of `cells`, each node at `position` of its place.
    pub(super) fn mesh(
        &self,
        cells: Cells,
        triangles: Diagonal,
        position: impl Fn([usize; 2]) -> [f64; 2],
    ) -> Result<Mesh, InputError> {
        let (kind, connectivity) = match cells {
            Cells::Triangles => {
                (CellKind::Triangle, self.divide(CellKind::Triangle, |_| triangles.division()))
            }
            Cells::Crossed => {
                let alternating = |[i, j]: [usize; 2]| match (i + j) % 2 {
                    0 => Diagonal::Rising.division(),
                    _ => Diagonal::Falling.division(),
                };
                (CellKind::Triangle, self.divide(CellKind::Triangle, alternating))
            }
            Cells::Rectangles => {
                (CellKind::Quadrilateral, self.divide(CellKind::Quadrilateral, |_| &WHOLE))
            }
            Cells::Rectangles9 => {
                (CellKind::Quadrilateral9, self.divide(CellKind::Quadrilateral9, |_| &WHOLE))
            }
            Cells::Triangles6 => {
                (CellKind::Triangle6, self.divide(CellKind::Triangle6, |_| triangles.division()))
            }
        };
        let positions = self.places.iter().flat_map(|&place| position(place)).collect();
        Mesh::new(2, positions, kind, connectivity)
    }
}
