//! Meshes from Gmsh.

mod file;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use file::{Block, Contents};
use mshio::ElementType;
use nalgebra::{Matrix3, Vector3};

use super::{CellKind, Mesh};
use crate::base::input::{InputError, read_at_most};

/// Bytes that a file may have: those of some ten million nodes.
const MOST_BYTES: u64 = 2 << 30;

impl Mesh {
    /// Reads a mesh from a file of Gmsh: format MSH 4.1, text or binary.
    ///
    /// Coordinates are taken as metres; for a drawing in millimetres, give Gmsh `Mesh.ScalingFactor = 0.001`.
    ///
    /// - **Cells** are the elements of the highest dimension, in the order of the file. All must be of one
    ///   kind: lines of 2 nodes, triangles of 3 or 6, quadrilaterals of 4 or 9, tetrahedra of 4 or 10, hexahedra
    ///   of 8, 20 (`Mesh.SecondOrderIncomplete = 1`) or 27. If physical groups exist, Gmsh saves only the
    ///   elements in them.
    /// - **Nodes** keep the order of the file; those that belong to no cell (points of the geometry, centres
    ///   of circles) are left out, and the others are numbered without gaps. A file without such nodes whose
    ///   tags ascend from 1, as Gmsh writes them after meshing, keeps its tags as node numbers.
    /// - **Node sets** are the physical groups of all dimensions: all nodes of cells on their
    ///   points, curves, surfaces or volumes, ascending. Groups of the same name become one; a group
    ///   without a name is called by its tag, as in `curve 7`; one without nodes of cells is left out.
    /// - **Cell groups** are the physical groups of the cells' own dimension: regions, for
    ///   [`CellSelection::Group`](crate::CellSelection::Group).
    /// - **Space** has as many dimensions as the body needs: a surface with z = 0 lies in the plane
    ///   and a line with y = z = 0 on an axis (but for round-off, 1e-10 of the size); otherwise they
    ///   are a membrane or a string in space.
    /// - **Orientation**: if all cells of an entity run the wrong way round (clockwise in the plane), because
    ///   the surface was drawn so, they are turned over.
    ///
    /// Periodicity and data of views are ignored. Nodes with parametric coordinates (`Mesh.SaveParametric`)
    /// cannot be read.
    ///
    /// # Errors
    /// A file that cannot be read, is empty, broken, partitioned or of another version, element types that do
    /// not exist here, cells of several kinds, a physical group that is called `all` or `boundary` but has
    /// other nodes.
    pub fn read_gmsh(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        let file = read_at_most(path, MOST_BYTES);
        let file = file.map_err(|error| format!("it cannot be read: {error}"));
        file.and_then(Contents::read)
            .and_then(|contents| build(&contents))
            .map(|mesh| Self { file: Some(path.into()), ..mesh })
            .map_err(|problem| InputError::new("mesh file", path.display(), problem))
    }
}

fn build(contents: &Contents) -> Result<Mesh, String> {
    let kind = only_kind(&contents.blocks)?;
    let is_body = |block: &&Block| cell_kind(block.kind) == Some(kind);
    let body: Vec<&Block> = contents.blocks.iter().filter(is_body).collect();

    // nodes of cells are numbered in the order of the file
    let mut numbers = vec![None; contents.nodes.len()];
    for &place in body.iter().flat_map(|block| block.elements.iter().flatten()) {
        numbers[place] = Some(0);
    }
    for (number, kept) in numbers.iter_mut().flatten().enumerate() {
        *kept = number;
    }
    let kept = |(place, position): (usize, &[f64; 3])| numbers[place].map(|_| *position);
    let positions: Vec<[f64; 3]> = contents.nodes.iter().enumerate().filter_map(kept).collect();
    let dimension = space(kind, &positions);

    let (mut connectivity, mut cell_groups) = (Vec::new(), BTreeMap::new());
    for block in body {
        let first = connectivity.len() / kind.nodes();
        let order = kind.gmsh().map(|(_, order)| order).unwrap_or_default();
        let number = |element: &Vec<usize>| {
            order.iter().filter_map(|&local| numbers[element[local]]).collect()
        };
        let mut cells: Vec<Vec<usize>> = block.elements.iter().map(number).collect();
        let turned = |cell: &Vec<usize>| signed_measure(kind, cell, &positions) < 0.0;
        if dimension == kind.dimension() && cells.iter().all(turned) {
            cells
                .iter_mut()
                .for_each(|cell| *cell = kind.turned_over().iter().map(|&k| cell[k]).collect());
        }
        connectivity.extend(cells.concat());
        for name in &block.groups {
            let group: &mut Vec<usize> = cell_groups.entry(name.clone()).or_default();
            group.extend(first..first + block.elements.len());
        }
    }
    let coordinates = positions.iter().flat_map(|position| &position[..dimension]).copied();
    let mut mesh = Mesh::new(dimension, coordinates.collect(), kind, connectivity)
        .map_err(|error| format!("it cannot be read: {error}"))?;
    mesh.cell_groups = cell_groups;
    for (name, nodes) in node_sets(&contents.blocks, &numbers) {
        if mesh.sets.get(name).is_some_and(|own| *own != nodes) {
            let problem = "has the name of a set that every mesh has, but other nodes: rename it";
            return Err(format!("its physical group \"{name}\" {problem}"));
        }
        mesh.sets.insert(name.into(), nodes);
    }
    Ok(mesh)
}

/// The nodes of each physical group, ascending.
fn node_sets<'a>(
    blocks: &'a [Block],
    numbers: &[Option<usize>],
) -> impl Iterator<Item = (&'a str, Vec<usize>)> {
    let mut sets: BTreeMap<&str, BTreeSet<usize>> = BTreeMap::new();
    for block in blocks {
        for name in &block.groups {
            let nodes = block.elements.iter().flatten().filter_map(|&place| numbers[place]);
            sets.entry(name).or_default().extend(nodes);
        }
    }
    let sets = sets.into_iter().filter(|(_, nodes)| !nodes.is_empty());
    sets.map(|(name, nodes)| (name, nodes.into_iter().collect()))
}

/// The kind of all elements of the highest dimension.
fn only_kind(blocks: &[Block]) -> Result<CellKind, String> {
    let highest = blocks.iter().map(|block| block.dimension).max();
    let mut counts: Vec<(ElementType, usize)> = Vec::new();
    for block in blocks.iter().filter(|block| Some(block.dimension) == highest) {
        match counts.iter_mut().find(|(kind, _)| *kind == block.kind) {
            Some((_, count)) => *count += block.elements.len(),
            None => counts.push((block.kind, block.elements.len())),
        }
    }
    let words = |&(kind, count): &(ElementType, usize)| format!("{count} {}", words(kind));
    match &*counts {
        [] => Err("it has no elements".into()),
        [only] => cell_kind(only.0).ok_or_else(|| {
            let known = CellKind::ALL.iter().filter(|kind| kind.gmsh().is_some());
            let known: Vec<&str> = known.map(|kind| kind.name()).collect();
            let help = "(in Gmsh: Mesh.ElementOrder; Mesh.SecondOrderIncomplete = 1 for hexahedra of 20 nodes, 0 for 27, and for quadrilaterals of 9)";
            format!("it has {}: cells may be {} {help}", words(only), known.join(", "))
        }),
        several => {
            let help = "all cells must be of one kind: mesh it so (in Gmsh: without Recombine; or \
                        with Mesh.RecombineAll = 1 and Mesh.SubdivisionAlgorithm = 1 for \
                        quadrilaterals alone, 2 for hexahedra alone), or put one kind only into \
                        physical groups";
            let counts: Vec<String> = several.iter().map(words).collect();
            Err(format!("it has {}: {help}", counts.join(" and ")))
        }
    }
}

fn cell_kind(kind: ElementType) -> Option<CellKind> {
    CellKind::ALL
        .iter()
        .copied()
        .find(|cell| cell.gmsh().is_some_and(|(number, _)| number == kind as u8))
}

/// A type of elements in words.
fn words(kind: ElementType) -> String {
    let code = format!("{kind:?}");
    let shape = match code.get(..3) {
        Some("Pnt") => "points",
        Some("Lin") => "lines",
        Some("Tri") => "triangles",
        Some("Qua") => "quadrilaterals",
        Some("Tet") => "tetrahedra",
        Some("Hex") => "hexahedra",
        Some("Pri") => "prisms",
        Some("Pyr") => "pyramids",
        _ => "elements",
    };
    match kind.nodes() {
        Ok(nodes) => format!("{shape} of {nodes} node(s)"),
        Err(()) => format!("{shape} of type {code}"),
    }
}

/// Dimension of the space that a body of `kind` needs.
fn space(kind: CellKind, positions: &[[f64; 3]]) -> usize {
    let largest = |axis: usize| positions.iter().map(|x| x[axis].abs()).fold(0.0, f64::max);
    let round_off = 1e-10 * (0..3).map(largest).fold(0.0, f64::max);
    let last = (0..3).rev().find(|&axis| largest(axis) > round_off);
    last.map_or(1, |axis| axis + 1).max(kind.dimension())
}

/// Length, area or volume that the edges at the first corner span, below 0 if the cell runs the
/// wrong way round; for cells that fill space.
fn signed_measure(kind: CellKind, cell: &[usize], positions: &[[f64; 3]]) -> f64 {
    let corner = |local: usize| Vector3::from(positions[cell[local]]);
    let mut edges = Matrix3::identity();
    for (axis, &neighbour) in kind.neighbours().iter().enumerate() {
        edges.set_column(axis, &(corner(neighbour) - corner(0)));
    }
    edges.determinant()
}
