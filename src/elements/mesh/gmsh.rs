//! Meshes from Gmsh.
//!
//! Cells that run the wrong way round are turned over, and copies of an element for each of its physical
//! groups (version 2) become one cell of several groups; both are noted. Sections that are not needed are
//! skipped. Nothing is allocated by a count that a file states: lists grow as their numbers are read, so that
//! a wrong count ends at the end of the file.

mod file;
mod reader;
mod types;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use file::{Block, Contents};
use types::ElementType;

use super::shape::corner_measures;
use super::{CellKind, Mesh};
use crate::base::input::{InputError, four_digits, read_at_most};

/// Bytes that a file may have: those of some ten million nodes.
const MOST_BYTES: u64 = 2 << 30;
/// Coordinates along an axis in which a mesh does not extend are 0 but for this fraction of its size.
const ROUND_OFF: f64 = 1e-10;
/// Faces and lines extend across a plane by less than this fraction of their size where other programs have rounded them.
const ROUNDED: f64 = 1e-6;

impl Mesh {
    /// Reads a mesh from a file of Gmsh: format MSH 4.1 or 2.2 (which fTetWild and meshio write, too), text or binary.
    ///
    /// Coordinates are in metres; for a drawing in millimetres, give Gmsh `Mesh.ScalingFactor = 0.001`.
    ///
    /// - **Cells** are the elements of the highest dimension, in the order of the file. All must be of one
    ///   kind: lines of 2 nodes, triangles of 3 or 6, quadrilaterals of 4 or 9, tetrahedra of 4 or 10, hexahedra
    ///   of 8, 20 (`Mesh.SecondOrderIncomplete = 1`) or 27. If physical groups exist, Gmsh saves only the
    ///   elements in them.
    /// - **Nodes** keep the order of the file; those that belong to no cell (points of the geometry, centres
    ///   of circles) are omitted, and the others are numbered without gaps. A file without such nodes whose
    ///   tags ascend from 1, as Gmsh writes them after meshing, keeps its tags as node numbers.
    /// - **Node sets** are the physical groups of all dimensions: all nodes of cells on their
    ///   points, curves, surfaces or volumes, ascending. Groups of the same name become one; a group
    ///   without a name is called by its tag, as in `curve 7`; one without nodes of cells is omitted.
    /// - **Cell groups** are the physical groups of the cells' own dimension: regions, for
    ///   [`CellSelection::Group`](crate::CellSelection::Group).
    /// - **Space** has as many dimensions as the body needs: faces at the same z lie in the plane, and a line with y = z = 0 on
    ///   an axis. A z that is not 0 is ignored with a [note](Self::notes), and so is one that differs by less than 1e-6 of the size.
    ///   Lines are otherwise strings in the plane or in space; for faces in space see [`read_gmsh_in`](Self::read_gmsh_in).
    /// - **Orientation**: cells that run the wrong way round (clockwise in the plane) are turned over. Unless these are all cells of
    ///   their entity, because it was drawn so, a note says how many.
    ///
    /// Periodicity and data of views are ignored.
    ///
    /// # Errors
    /// A file that cannot be read, is empty, broken, partitioned or of another version, element types that do
    /// not exist here, cells of several kinds, faces alone that are not in a plane z = constant, a physical group that is
    /// called `all` or `boundary` but has other nodes.
    pub fn read_gmsh(path: impl AsRef<Path>) -> Result<Self, InputError> {
        Self::read_gmsh_as(path.as_ref(), None)
    }

    /// The same in a space of `dimension`: in 3 dimensions faces are a membrane, and keep their z.
    ///
    /// # Errors
    /// As of [`read_gmsh`](Self::read_gmsh); a mesh that extends along z, for 2 dimensions.
    pub fn read_gmsh_in(path: impl AsRef<Path>, dimension: usize) -> Result<Self, InputError> {
        Self::read_gmsh_as(path.as_ref(), Some(dimension))
    }

    fn read_gmsh_as(path: &Path, dimension: Option<usize>) -> Result<Self, InputError> {
        let file = read_at_most(path, MOST_BYTES);
        let file = file.map_err(|error| format!("it cannot be read: {error}"));
        file.and_then(|file| Contents::read(&file))
            .and_then(|contents| build(&contents, dimension))
            .map(|mesh| Self { file: Some(path.into()), ..mesh })
            .map_err(|problem| InputError::new("mesh file", path.display(), problem))
    }
}

fn build(contents: &Contents, dimension: Option<usize>) -> Result<Mesh, String> {
    let kind = only_kind(&contents.blocks)?;
    let is_body = |block: &&Block| cell_kind(block.kind) == Some(kind);
    let mut notes = Vec::new();
    let body: Vec<&Block> = contents.blocks.iter().filter(is_body).collect();

    // nodes of cells are numbered in the order of the file
    let mut numbers = vec![None; contents.nodes.len()];
    for &place in body.iter().flat_map(|block| &block.nodes) {
        numbers[place] = Some(0);
    }
    for (number, kept) in numbers.iter_mut().flatten().enumerate() {
        *kept = number;
    }
    let kept = |(place, position): (usize, &[f64; 3])| numbers[place].map(|_| *position);
    let positions: Vec<[f64; 3]> = contents.nodes.iter().enumerate().filter_map(kept).collect();
    let dimension = space(kind, &positions, dimension, &mut notes)?;

    let (mut connectivity, mut cell_groups) = (Vec::new(), BTreeMap::new());
    let mut turned_over = Vec::new();
    for block in body {
        let first = connectivity.len() / kind.nodes();
        let order = kind.gmsh().map(|(_, order)| order).unwrap_or_default();
        let number = |element: &[usize]| -> Vec<usize> {
            order.iter().filter_map(|&local| numbers[element[local]]).collect()
        };
        let mut cells: Vec<Vec<usize>> = block.elements().map(number).collect();
        if dimension == kind.dimension() {
            let measure = |cell: &[usize]| -> f64 {
                corner_measures(kind, cell, |node| positions[node]).iter().sum()
            };
            let turned: Vec<usize> =
                (0..cells.len()).filter(|&k| measure(&cells[k]) < 0.0).collect();
            for &k in &turned {
                let turn = |&local: &usize| cells[k][local];
                cells[k] = kind.turned_over().iter().map(turn).collect();
            }
            if turned.len() < cells.len() {
                turned_over.extend(turned.iter().map(|k| first + k + 1));
            }
        }
        connectivity.extend(cells.concat());
        for name in &block.groups {
            let group: &mut Vec<usize> = cell_groups.entry(name.clone()).or_default();
            group.extend(first..first + block.elements().len());
        }
    }
    let coordinates = positions.iter().flat_map(|position| &position[..dimension]).copied();
    let mut mesh = Mesh::new(dimension, coordinates.collect(), kind, connectivity)
        .map_err(|error| format!("it cannot be read: {error}"))?;
    mesh.cell_groups = cell_groups;
    if let [first, ..] = *turned_over {
        let (count, all) = (turned_over.len(), mesh.cell_count());
        notes.push(format!(
            "{count} of {all} cells run the other way round than those beside them, such as cell {first}, and are turned over"
        ));
    }
    mesh.notes = notes;
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
            let nodes = block.nodes.iter().filter_map(|&place| numbers[place]);
            sets.entry(name).or_default().extend(nodes);
        }
    }
    let sets = sets.into_iter().filter(|(_, nodes)| !nodes.is_empty());
    sets.map(|(name, nodes)| (name, nodes.into_iter().collect()))
}

/// The kind of all elements of the highest dimension.
fn only_kind(blocks: &[Block]) -> Result<CellKind, String> {
    let highest = blocks.iter().map(|block| block.kind.dimension).max();
    let mut counts: Vec<(ElementType, usize)> = Vec::new();
    for block in blocks.iter().filter(|block| Some(block.kind.dimension) == highest) {
        match counts.iter_mut().find(|(kind, _)| *kind == block.kind) {
            Some((_, count)) => *count += block.elements().len(),
            None => counts.push((block.kind, block.elements().len())),
        }
    }
    let words = |&(kind, count): &(ElementType, usize)| format!("{count} {}", kind.words());
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
        .find(|cell| cell.gmsh().is_some_and(|(number, _)| number == kind.number))
}

/// Dimension of the space of a body of `kind`: the one that is `wanted`, or the one that it needs. Notes report an omitted z.
fn space(
    kind: CellKind,
    positions: &[[f64; 3]],
    wanted: Option<usize>,
    notes: &mut Vec<String>,
) -> Result<usize, String> {
    if kind.dimension() == 3 || wanted == Some(3) {
        return Ok(3);
    }
    let bounds = [0, 1, 2].map(|axis| {
        let along = positions.iter().map(|x| x[axis]);
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    });
    let largest = |axis: usize| bounds[axis].map(f64::abs).into_iter().fold(0.0, f64::max);
    let round_off = ROUND_OFF * (0..3).map(largest).fold(0.0, f64::max);
    let size = bounds.map(|[low, high]| high - low).into_iter().fold(0.0, f64::max);
    let [low, high] = bounds[2];
    let [from, to] = [low, high].map(four_digits);
    if high - low > ROUNDED * size {
        let extends = format!("extends along z, from {from} to {to} m");
        let (cells, faces) = (kind.name(), kind.dimension() == 2);
        return match wanted {
            None if !faces => Ok(3),
            None => Err(format!(
                "it has {cells} alone, which are faces, and {extends}: for a membrane in space set the dimension of space to 3 (dimension = 3 in a \
                 scene file); for a solid mesh its volume, too (in Gmsh: a 3D mesh; tetrahedra or hexahedra); for a rigid solid of a closed \
                 surface take mesh = {{ kind = \"surface\" }}; for a body in the plane make z the same everywhere"
            )),
            Some(_) => Err(format!(
                "it {extends}, and space has two dimensions: make z the same everywhere, or set dimension = 3 for a membrane or a string in space"
            )),
        };
    }
    if largest(2) > round_off {
        let plane = if high - low > round_off {
            format!(
                "z from {from} to {to} m, which is round-off beside its size of {} m,",
                four_digits(size)
            )
        } else {
            format!("z = {from} m, the same everywhere,")
        };
        notes.push(format!(
            "{plane} is left out, as of a mesh in the plane (dimension = 3 keeps it)"
        ));
    }
    let needed = if largest(1) > round_off { 2 } else { 1 };
    Ok(needed.max(kind.dimension()))
}
