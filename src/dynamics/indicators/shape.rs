//! Slenderness of a body, and number of cells across its thickness.
//!
//! The slenderness is that of the box with the volume and the surface of the body, exact for boxes and nearly
//! so for rings.

use nalgebra::{Matrix3, Vector3};

use super::mesh::quadratic_cells;
use crate::base::input::short;
use crate::dynamics::report::Indicator;
use crate::elements::body::Body;
use crate::elements::mesh::{CellKind, Mesh};

/// Ratio from which a body counts as slender: beams and plates.
const SLENDER: f64 = 3.0;
/// A body bends if cells turn by more than this many times their strain.
const BENDS: f64 = 2.0;

/// The box with the volume and the surface of a body: exact for boxes, and nearly the length and thickness of thin
/// rings and arcs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    length: f64,
    thickness: f64,
}

impl Extent {
    /// That of a body of cells that fill the plane or space.
    pub(super) fn of(body: &Body) -> Option<Self> {
        let mesh = body.mesh();
        let dimension = mesh.kind().dimension();
        if dimension != mesh.dimension() || dimension < 2 {
            return None;
        }
        let faces = mesh.boundary_faces();
        let surface: f64 = faces.iter().map(|face| area(mesh, face)).sum();
        let volume = body.volume();
        // two lengths with this sum and this product
        let (longest, sum, product) = match dimension {
            2 => (0.0, surface / 2.0, volume / body.section()),
            _ => {
                let longest = longest(mesh);
                let product = volume / longest;
                (longest, (surface / 2.0 - product) / longest, product)
            }
        };
        let root = (0.25 * sum * sum - product).max(0.0).sqrt();
        let wide = 0.5 * sum + root;
        let thickness = product / wide;
        let length = longest.max(wide);
        (thickness > 0.0 && length.is_finite()).then_some(Self { length, thickness })
    }

    pub(super) fn slenderness(&self) -> f64 {
        self.length / self.thickness
    }

    /// The indicators, of a body whose cells turn by `turn` (rad) relative to it and are strained by
    /// `strain`.
    pub(super) fn indicators(&self, body: &Body, turn: f64, strain: f64) -> [Indicator; 2] {
        let Self { length, thickness } = self;
        let slenderness = self.slenderness();
        let told = format!(
            "the body is {} times as long as it is thick ({} m and {} m)",
            short(slenderness),
            short(*length),
            short(*thickness)
        );
        let slender = Indicator::told("slenderness", slenderness, "1", told);
        let count = layers(body.mesh());
        let bends = slenderness >= SLENDER && turn > BENDS * strain;
        let kind = body.mesh().kind();
        let wanted = match kind {
            CellKind::Quadrilateral | CellKind::Hexahedron => 2,
            kind if kind.is_quadratic() => 1,
            _ => 4,
        };
        let told = format!("{count} layer(s) of {} lie through the thickness", kind.name());
        if !bends {
            return [slender, Indicator::told("cells-through", count as f64, "", told)];
        }
        let told = format!("{told}, which bends (limit: {wanted})");
        let beyond = || match quadratic_cells(kind) {
            Some(help) => format!("{told}: it may be too stiff; take {help}, or more of them"),
            None => format!("{told}: it may be too stiff; take more of them"),
        };
        let limits = [f64::from(wanted), f64::INFINITY];
        let value = (count as f64, "");
        [slender, Indicator::trusted("cells-through", value, limits, || told.clone(), beyond)]
    }
}

/// Extent (m) of a body in space along the axis of its largest second moment.
fn longest(mesh: &Mesh) -> f64 {
    let corners =
        || mesh.cells().flatten().map(|&node| Vector3::from_row_slice(mesh.position(node)));
    let mean = corners().sum::<Vector3<f64>>() / corners().count() as f64;
    let moments: Matrix3<f64> = corners().map(|x| (x - mean) * (x - mean).transpose()).sum();
    let axes = moments.symmetric_eigen();
    let axis = axes.eigenvectors.column(axes.eigenvalues.imax()).into_owned();
    let along = || corners().map(|x| axis.dot(&x));
    along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
}

/// Area of a face (m^2), or length of an edge (m), computed from its corners as if it were flat.
fn area(mesh: &Mesh, face: &[usize]) -> f64 {
    let at = |k: usize| mesh.position(face[k]);
    let along = |a: usize, b: usize| {
        let (a, b) = (at(a), at(b));
        Vector3::from_fn(|i, _| b.get(i).unwrap_or(&0.0) - a.get(i).unwrap_or(&0.0))
    };
    match mesh.kind() {
        kind if kind.dimension() == 2 => along(0, 1).norm(),
        CellKind::Hexahedron | CellKind::Hexahedron20 | CellKind::Hexahedron27 => {
            0.5 * along(0, 2).cross(&along(1, 3)).norm()
        }
        _ => 0.5 * along(0, 1).cross(&along(0, 2)).norm(),
    }
}

/// Number of cells across the thickest section. The depth of a node is its distance from the boundary in
/// edges; a cell whose corners all have the largest depth lies in the middle between the two sides.
fn layers(mesh: &Mesh) -> usize {
    let kind = mesh.kind();
    let mut depths = vec![usize::MAX; mesh.node_count()];
    mesh.boundary_nodes().iter().for_each(|&node| depths[node] = 0);
    let mut deepest = 0;
    loop {
        let mut is_changed = false;
        for cell in mesh.cells() {
            for edge in kind.edges() {
                for (a, b) in [(edge[0], edge[1]), (edge[1], edge[0])] {
                    if depths[cell[a]] == deepest && depths[cell[b]] == usize::MAX {
                        depths[cell[b]] = deepest + 1;
                        is_changed = true;
                    }
                }
            }
        }
        if !is_changed {
            break;
        }
        deepest += 1;
    }
    let is_deepest = |cell: &[usize]| {
        kind.edges()
            .iter()
            .all(|edge| depths[cell[edge[0]]] == deepest && depths[cell[edge[1]]] == deepest)
    };
    2 * deepest + usize::from(mesh.cells().any(is_deepest))
}
