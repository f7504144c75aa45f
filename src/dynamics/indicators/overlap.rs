//! Passage of a body through itself, or of its pieces through each other.
//!
//! A point within a cell that has no node in common with its own has a second position in the undeformed
//! body. Points are sorted into a grid (`base/grid.rs`), and the map of the cells is inverted for those in
//! their boxes. The depth of that position below the boundary is sought from cell to cell (`skin.rs`), so
//! that the boundary of another part does not count, however near it is.

use super::size::cell_sizes;
use super::skin::{Skin, points};
use crate::base::grid::Grid;
use crate::base::input::{InputError, four_digits};
use crate::base::vector::{difference, norm};
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::elements::basis::{closest, shares_in};
use crate::elements::body::{Body, Part};
use crate::elements::mesh::CellKind;
use crate::scene::forces::{SurfacePoint, Touch, natural, pieces};
use crate::scene::timeline::Scene;

/// Largest depth of a point of the boundary within a cell of another part of the body, relative to the size of
/// the cell: faces that slide along each other, as those of a slit do, are no smoother than that where cells
/// turn by 20 degrees.
const MOST_OF_CELL: f64 = 0.05;

/// A point of the boundary within a cell that is not its own.
#[derive(Clone, Copy)]
struct Entry {
    /// Its number among the points, and that of the cell.
    point: usize,
    cell: usize,
    depth: f64,
    limit: f64,
}

impl Entry {
    fn part(&self) -> f64 {
        self.depth / self.limit
    }

    fn is_beyond(&self) -> bool {
        self.depth > self.limit
    }
}

/// Workspace for checking successive shapes of a body.
struct Overlaps<'a> {
    body: &'a Body,
    skin: Skin<'a>,
    points: Vec<SurfacePoint>,
    cells: Vec<(CellKind, &'a [usize])>,
    /// Largest depth allowed for a point within each cell (m).
    limits: Vec<f64>,
    /// Bodies that joints join, which may lie within each other.
    joined: Vec<[usize; 2]>,
}

impl<'a> Overlaps<'a> {
    /// Only where a body fills its space; others have no inside.
    fn new(scene: &'a Scene) -> Option<Self> {
        let body = scene.body();
        let fills_space = |part: Part| part.body.mesh().kind().dimension() == body.dimension();
        body.parts().any(fills_space).then(|| Self {
            body,
            skin: Skin::new(body),
            points: points(body, 1),
            cells: body.mesh().cells_with_kinds().collect(),
            limits: cell_sizes(body).into_iter().map(|size| MOST_OF_CELL * size).collect(),
            // the scene was checked before
            joined: scene.jointed_bodies().unwrap_or_default(),
        })
    }

    /// All points within cells that share no node with theirs, under the displacements `u` (m).
    fn entries(&mut self, u: &[f64]) -> Vec<Entry> {
        self.entries_but(u, Self::is_near)
    }

    /// All points of the undeformed shape within cells that are not theirs. (As a body deforms, edges of neighbours that are
    /// curved may overlap a little.)
    fn drawn_entries(&mut self) -> Vec<Entry> {
        let u = vec![0.0; self.body.dofs()];
        self.entries_but(&u, |overlaps, point, cell| {
            overlaps.points[point].nodes().all(|(node, _)| cell.contains(&node))
        })
    }

    /// All points within cells, but those that `is_own` has, under the displacements `u` (m).
    fn entries_but(
        &mut self,
        u: &[f64],
        is_own: impl Fn(&Self, usize, &[usize]) -> bool,
    ) -> Vec<Entry> {
        let (mesh, d) = (self.body.mesh(), self.body.dimension());
        let now: Vec<f64> = mesh.positions().iter().zip(u).map(|(x, u)| x + u).collect();
        if now.iter().any(|x| !x.is_finite()) {
            return Vec::new();
        }
        let places: Vec<[f64; 3]> = self.points.iter().map(|point| point.at(&now, d)).collect();
        let grid = Grid::new(&places);
        let mut met = Vec::new();
        for (number, (kind, cell)) in self.cells.iter().enumerate() {
            if kind.dimension() != d {
                continue;
            }
            let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
            corners.iter_mut().for_each(|corner| corner[d..].fill(0.0));
            for &node in *cell {
                for (axis, x) in now[node * d..][..d].iter().enumerate() {
                    corners[0][axis] = corners[0][axis].min(*x);
                    corners[1][axis] = corners[1][axis].max(*x);
                }
            }
            grid.each_within(&corners, |point| {
                if !is_own(self, point, cell)
                    && !self.are_joined(point, cell)
                    && let Some(shares) = shares_in((*kind, d), &now, cell, &places[point][..d])
                {
                    met.push((point, number, shares));
                }
            });
        }
        if met.is_empty() {
            return Vec::new();
        }
        // cells turned inside out overlap their neighbours, and are reported as inverted
        let inverted = self.body.inverted_cells(u);
        let mut is_redirected = vec![false; mesh.node_count()];
        inverted
            .iter()
            .flat_map(|&cell| self.cells[cell].1)
            .for_each(|&node| is_redirected[node] = true);
        met.retain(|(point, cell, _)| {
            let is_redirected = self.points[*point].nodes().any(|(node, _)| is_redirected[node]);
            !is_redirected && !inverted.contains(cell)
        });
        let entry = |(point, cell, shares): (usize, usize, Vec<(usize, f64)>)| {
            // the boundary nearest to a point in a neighbour is its own
            let depth = match self.is_near(point, self.cells[cell].1) {
                true => self.depth_in_cell(cell, &places[point]),
                false => self.skin.depth(&shares, &now),
            };
            Entry { point, cell, depth, limit: self.limits[cell] }
        };
        met.into_iter().map(entry).collect()
    }

    /// The distance (m) of a point in a cell from its undeformed faces, assumed flat between their nodes.
    fn depth_in_cell(&self, cell: usize, x: &[f64; 3]) -> f64 {
        let (mesh, (kind, nodes)) = (self.body.mesh(), self.cells[cell]);
        let faces = kind.faces().iter().map(|face| face.iter().map(|&k| nodes[k]).collect());
        let away = |face: Vec<usize>| {
            let corners = |piece: &[usize]| -> Vec<[f64; 3]> {
                piece.iter().map(|&k| natural(mesh, face[k])).collect()
            };
            let of_piece = |(piece, _): (&[usize], f64)| {
                let corners = corners(piece);
                let shares = closest(&corners, x);
                let there = |i: usize| corners.iter().zip(shares).map(|(c, s)| s * c[i]).sum();
                norm(&difference(&std::array::from_fn(there), x))
            };
            pieces(mesh.face_kind(&face)).map(of_piece).fold(f64::INFINITY, f64::min)
        };
        faces.map(away).fold(f64::INFINITY, f64::min)
    }

    /// Whether a cell has a node of a point, or shares a node with a cell that has one.
    fn is_near(&self, point: usize, cell: &[usize]) -> bool {
        let pattern = self.body.inertia().pattern();
        let mut nodes = self.points[point].nodes().map(|(node, _)| node);
        nodes.any(|node| cell.iter().any(|&other| pattern.find(node, other).is_some()))
    }

    /// Whether joints join the bodies of a point and of a cell.
    fn are_joined(&self, point: usize, cell: &[usize]) -> bool {
        if self.joined.is_empty() {
            return false;
        }
        let number = |node: usize| self.body.parts().position(|part| part.nodes.contains(&node));
        let own = self.points[point].nodes().next().and_then(|(node, _)| number(node));
        let pair = own.zip(number(cell[0]));
        pair.is_some_and(|(a, b)| self.joined.contains(&[a, b]) || self.joined.contains(&[b, a]))
    }

    /// The depth of a point, the cell that it is in, counted from 1, and the limit.
    fn names(&self, entry: &Entry) -> String {
        let cell: Vec<usize> = self.cells[entry.cell].1.iter().map(|node| node + 1).collect();
        let limit = four_digits(entry.limit);
        format!(
            "{} m within cell {} (nodes {cell:?}; limit: {limit} m, a twentieth of the cell)",
            four_digits(entry.depth),
            entry.cell + 1
        )
    }

    /// Names of the penetrating body or piece and of the penetrated one.
    fn who(&self, entry: &Entry) -> [String; 2] {
        let pieces = self.body.inertia().pattern().pieces();
        let nodes = self.nodes(entry);
        let [part, other] = self.bodies(entry);
        let named = |part: &Part| match self.body.is_single() {
            true => "the body".to_owned(),
            false => format!("body \"{}\"", part.name),
        };
        let [own, whole] = nodes.map(|node| pieces[node]);
        match (part.nodes == other.nodes, own == whole) {
            (false, _) => [named(&part), named(&other)],
            (true, true) => [named(&part), "itself".into()],
            (true, false) => [format!("a piece of {}", named(&part)), "another one".into()],
        }
    }

    /// The bodies of a point and of the cell that it is in.
    fn bodies(&self, entry: &Entry) -> [Part<'a>; 2] {
        self.nodes(entry).map(|node| self.body.part_of(node))
    }

    /// A node of the point, and one of the cell.
    fn nodes(&self, entry: &Entry) -> [usize; 2] {
        [self.node(entry), self.cells[entry.cell].1[0]]
    }

    fn node(&self, entry: &Entry) -> usize {
        let shares = self.points[entry.point].nodes();
        shares.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(node, _)| node)
    }

    /// The entry that is deepest relative to its limit.
    fn deepest(entries: &[Entry]) -> Option<Entry> {
        entries.iter().max_by(|a, b| a.part().total_cmp(&b.part())).copied()
    }

    /// Depth and limit of the deepest entry; 0 and the least limit if there is none.
    fn numbers(&self, deepest: Option<&Entry>) -> [f64; 2] {
        let least = || self.limits.iter().copied().fold(f64::INFINITY, f64::min);
        deepest.map_or_else(|| [0.0, least()], |entry| [entry.depth, entry.limit])
    }
}

/// A mesh that overlaps itself in its undeformed shape.
pub(super) fn drawn(scene: &Scene) -> Option<Indicator> {
    let mut overlaps = Overlaps::new(scene)?;
    let entries = overlaps.drawn_entries();
    let deepest = Overlaps::deepest(&entries);
    let [depth, limit] = overlaps.numbers(deepest.as_ref());
    let within = || {
        format!(
            "the mesh does not overlap itself (deepest: {} m; limit: {} m)",
            four_digits(depth),
            four_digits(limit)
        )
    };
    let beyond = || {
        let Some(deepest) = &deepest else { return within() };
        format!(
            "the mesh overlaps itself as it is drawn: {}, the deepest of them node {} with {}. There is twice the mass and \
             stiffness there: draw its parts side by side, and merge nodes in the same place where they are to hold together",
            count(&entries),
            overlaps.node(deepest) + 1,
            overlaps.names(deepest)
        )
    };
    Some(Indicator::trusted("drawn-overlap", (depth, "m"), [0.0, limit], within, beyond))
}

fn count(entries: &[Entry]) -> String {
    let mut points: Vec<usize> =
        entries.iter().filter(|entry| entry.is_beyond()).map(|entry| entry.point).collect();
    points.sort_unstable();
    points.dedup();
    format!("{} place(s) of its boundary lie within other cells", points.len())
}

/// Checks that nothing that touches begins within something else.
///
/// # Errors
/// Bodies that overlap at the start, or a body that overlaps itself.
pub(crate) fn check_start(scene: &Scene) -> Result<(), InputError> {
    if scene.touches().is_empty() {
        return Ok(());
    }
    let Some(mut overlaps) = Overlaps::new(scene) else { return Ok(()) };
    let mut entries = overlaps.entries(scene.initial_displacements());
    entries.retain(|entry| {
        let nodes = [overlaps.node(entry), overlaps.cells[entry.cell].1[0]];
        let names = nodes.map(|node| scene.body().part_of(node).name);
        scene.touches().iter().any(|touch| touch.is_between(names))
    });
    let deepest = Overlaps::deepest(&entries).filter(Entry::is_beyond);
    let Some(deepest) = &deepest else { return Ok(()) };
    let [one, other] = overlaps.who(deepest);
    Err(InputError::new(
        "start of what touches",
        format!(
            "{one} within {other}: node {} with {}",
            overlaps.node(deepest) + 1,
            overlaps.names(deepest)
        ),
        "surfaces push each other apart from outside: move the bodies apart, or leave out the touch",
    ))
}

/// A body that passes through itself, or pieces of it that pass through each other, at any of the `samples`. Points that lie in
/// other cells already in the undeformed shape do not count.
pub(super) fn overlap(scene: &Scene, samples: &[&Sample]) -> Option<Indicator> {
    let mut overlaps = Overlaps::new(scene)?;
    let mut is_drawn = vec![false; overlaps.points.len()];
    for entry in overlaps.drawn_entries() {
        is_drawn[entry.point] |= entry.is_beyond();
    }
    let (mut first, mut most) = (None, None::<(Entry, &Sample, Vec<Entry>)>);
    for sample in samples {
        let mut entries = overlaps.entries(&sample.u);
        entries.retain(|entry| !is_drawn[entry.point]);
        let Some(deepest) = Overlaps::deepest(&entries) else { continue };
        if deepest.is_beyond() {
            first.get_or_insert(sample.time);
        }
        if most.as_ref().is_none_or(|(most, ..)| most.part() < deepest.part()) {
            most = Some((deepest, sample, entries));
        }
    }
    let [depth, limit] = overlaps.numbers(most.as_ref().map(|(entry, ..)| entry));
    let within = || {
        format!(
            "the body does not pass through itself (deepest: {} m; limit: {} m)",
            four_digits(depth),
            four_digits(limit)
        )
    };
    let beyond = || {
        let (Some((deepest, sample, entries)), Some(first)) = (&most, first) else {
            return within();
        };
        let (node, at) = (overlaps.node(deepest), four_digits(sample.time));
        let [one, other] = overlaps.who(deepest);
        let names = overlaps.bodies(deepest).map(|part| part.name);
        let between = scene.touches().iter().filter(|touch| touch.is_between(names));
        let help = match between.map(Touch::is_barrier).max() {
            None => {
                "Nothing keeps them apart, so the motion is wrong from there on: let them touch ([[touch]]), load them less, or end the \
                      scene before"
            }
            Some(false) => {
                "The springs between them are too soft: raise the stiffness_density, or take a barrier"
            }
            Some(true) => {
                "Kept apart are points of their surfaces, which are straight (in space, flat) between nodes: take finer cells, or a \
                     larger distance"
            }
        };
        let since = if first == sample.time {
            String::new()
        } else {
            format!(" from t = {} s on", four_digits(first))
        };
        format!(
            "{one} passes through {other}{since}: at t = {at} s {}, the deepest of them node {} with {}. {help}",
            count(entries),
            node + 1,
            overlaps.names(deepest)
        )
    };
    Some(Indicator::trusted("overlap", (depth, "m"), [0.0, limit], within, beyond))
}
