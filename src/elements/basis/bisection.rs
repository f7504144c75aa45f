//! Local refinement of cells: longest-edge bisection.
//!
//! Edges of the given cells are marked, and with any edge of a cell its longest one, so that triangles keep half of their
//! least angle however often they are divided (M. C. Rivara, Int. J. Numer. Meth. Engng. 20 (1984) 745-756). A cell is then
//! cut at its marked edges, longest first. Cells that share a face cut it alike, so that no node hangs on an edge.

use std::collections::BTreeSet;

use super::finer::{Finer, Point, linear, mean, nodes};
use crate::base::input::InputError;
use crate::elements::mesh::{CellKind, Mesh};

/// An edge by the numbers of its ends, ascending.
type Edge = [usize; 2];

/// The middle of an edge by its ends, local numbers of corners, ascending; a corner has itself twice.
type Vertex = [usize; 2];

impl Mesh {
    /// The same mesh with these cells (counted from 0) divided at the middles of their edges, and cells around them as far as
    /// it takes to keep edges in common.
    ///
    /// Triangles keep half of their least angle, however often it is done. Nodes keep their numbers, and new ones follow, as in
    /// [`halved`](Self::halved).
    ///
    /// ```
    /// use pliant::{Cells, Mesh};
    ///
    /// let mut mesh = Mesh::rectangle([0.2, 0.1], [5, 3], Cells::Triangles6)?;
    /// for _ in 0..4 {
    ///     // towards the lower left corner
    ///     mesh = mesh.halved_in(&mesh.cells_at([1])?)?;
    /// }
    /// assert_eq!(mesh.cell_count(), 64);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Cells that do not exist; quadrilaterals, hexahedra and segments (a grid of those is graded); cells with bubbles, which they
    /// get afterwards ([`with_bubbles`](Self::with_bubbles)).
    pub fn halved_in(&self, cells: &[usize]) -> Result<Self, InputError> {
        self.bisected(cells).map(|finer| finer.mesh)
    }

    /// See [`halved_in`](Self::halved_in).
    pub(crate) fn bisected(&self, cells: &[usize]) -> Result<Finer, InputError> {
        let kind = self.kind();
        if !can_be_bisected(kind) {
            let help = "triangles and tetrahedra are divided in some places only; divide all cells (`halved`), or make a grid that is \
                        graded";
            return Err(InputError::new("cells", kind.name(), help));
        }
        if !kind.middles().is_empty() {
            let help =
                "divide them before they get bubbles: the nodes of these would belong to no cell";
            return Err(InputError::new("cells", kind.name(), help));
        }
        if let Some(cell) = cells.iter().find(|cell| **cell >= self.cell_count()) {
            let help = format!("the mesh has the cells 1 to {}", self.cell_count());
            return Err(InputError::new("cell to be divided", cell + 1, help));
        }
        let marks = Marks::of(self, cells);
        let corners = nodes(linear(kind));
        let simplex: Vec<Vertex> = (0..corners.len()).map(|corner| [corner; 2]).collect();
        let point = |vertex: &Vertex| mean(&corners, vertex);
        Ok(Finer::new(self, kind, |number| {
            let mut children = Vec::new();
            marks.divide(marks.cells[number], simplex.clone(), &mut children);
            let points = |child: &Vec<Vertex>| child.iter().map(point).collect::<Vec<Point>>();
            children.iter().map(points).collect()
        }))
    }
}

/// Whether cells of this kind can be divided in some places only.
pub(crate) fn can_be_bisected(kind: CellKind) -> bool {
    [CellKind::Triangle, CellKind::Tetrahedron].contains(&linear(kind))
}

/// The cells of the largest contributions (absolute values), which make this `part` of all, ascending (W. Dörfler, SIAM J. Numer.
/// Anal. 33 (1996) 1106-1124).
pub(crate) fn worst_cells(contributions: &[f64], part: f64) -> Vec<usize> {
    let size = |cell: &usize| contributions[*cell].abs();
    let mut order: Vec<usize> = (0..contributions.len()).collect();
    order.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let mut left = part * order.iter().map(size).sum::<f64>();
    let is_needed = |cell: &usize| {
        let is_needed = left > 0.0;
        left -= size(cell);
        is_needed
    };
    let mut worst: Vec<usize> = order.into_iter().take_while(is_needed).collect();
    worst.sort_unstable();
    worst
}

/// The edges that get a node in their middle.
struct Marks<'a> {
    mesh: &'a Mesh,
    /// The corners of each cell.
    cells: Vec<&'a [usize]>,
    edges: BTreeSet<Edge>,
}

impl<'a> Marks<'a> {
    /// All edges of `cells`, and the longest one of each cell that has a marked edge.
    fn of(mesh: &'a Mesh, cells: &[usize]) -> Self {
        let corners = mesh.cells().map(|cell| &cell[..=mesh.kind().dimension()]);
        let mut marks = Self { mesh, cells: corners.collect(), edges: BTreeSet::new() };
        for &cell in cells {
            marks.edges.extend(edges_of(marks.cells[cell]));
        }
        loop {
            let before = marks.edges.len();
            for cell in 0..mesh.cell_count() {
                let edges = edges_of(marks.cells[cell]);
                if edges.iter().any(|edge| marks.edges.contains(edge)) {
                    marks.edges.extend(marks.longest(edges.into_iter()));
                }
            }
            if marks.edges.len() == before {
                return marks;
            }
        }
    }

    /// The longest edge; of edges of the same length that with the greater numbers, so that all cells around agree.
    fn longest(&self, edges: impl Iterator<Item = Edge>) -> Option<Edge> {
        let length = |[a, b]: Edge| -> f64 {
            let ends = self.mesh.position(a).iter().zip(self.mesh.position(b));
            ends.map(|(a, b)| (a - b).powi(2)).sum()
        };
        edges.max_by(|&a, &b| length(a).total_cmp(&length(b)).then(a.cmp(&b)))
    }

    /// Cuts a `simplex` within a `cell`, given by its corners, at its longest marked edge, and both halves in turn.
    fn divide(&self, cell: &[usize], simplex: Vec<Vertex>, children: &mut Vec<Vec<Vertex>>) {
        let corners = simplex.iter().filter(|[a, b]| a == b).map(|&[a, _]| cell[a]);
        let edges = edges_of(&corners.collect::<Vec<_>>()).into_iter();
        let Some(cut) = self.longest(edges.filter(|edge| self.edges.contains(edge))) else {
            children.push(simplex);
            return;
        };
        let local = |number: usize| cell.iter().position(|&node| node == number).unwrap_or(0);
        let middle = edge(local(cut[0]), local(cut[1]));
        for end in middle {
            let mut half = simplex.clone();
            half.iter_mut()
                .filter(|vertex| **vertex == [end; 2])
                .for_each(|vertex| *vertex = middle);
            self.divide(cell, half, children);
        }
    }
}

fn edges_of(corners: &[usize]) -> Vec<Edge> {
    let pairs = (0..corners.len()).flat_map(|a| (0..a).map(move |b| [a, b]));
    pairs.map(|[a, b]| edge(corners[a], corners[b])).collect()
}

fn edge(a: usize, b: usize) -> Edge {
    [a.min(b), a.max(b)]
}
