//! Treatment of volumetric strain: pointwise, mean or projected.
//!
//! With a mean dilatation, G_a = sum w dg/dF g_a and the cell volume V, forces and tangents are
//!
//! ```text
//! f_a = -sum w (P_rest + U'(mean g) dg/dF) g_a,    K_ab = ... + (U''/V) G_a G_b^T
//! ```
//!
//! Viscosity of Hooke's form does the same with the rate of tr E, as it would lock, too; fluids with tr(d).
//! The stress of fields has the projected dilatation. Reasons for these projections and the alternatives are
//! in `docs/decisions/0011-projected-dilatation.md`, errors and inf-sup values in `docs/notes/elements.md`.

use crate::base::input::InputError;
use crate::elements::material::Plane;
use crate::elements::mesh::CellKind;

/// Treatment of volumetric strain in a body, against locking.
///
/// A nearly incompressible body (rubber, Poisson's ratio above 0.45) has to keep its volume wherever that is
/// evaluated. At each point of a cell these are more conditions than its nodes can meet: the cell locks, and
/// bends too little. Projected onto few functions of the cell they are few: one for the mean, one and one more for each
/// axis of space for linear functions. The law's energy U of the volume is evaluated at the projection of its measure: of J
/// with the laws of rubber, of tr(U - I) with the corotated law, of tr E with linear elasticity, St. Venant-Kirchhoff
/// material and Maxwell branches. Energy is conserved, and tangents are symmetric, as without it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dilatation {
    /// At each point of a cell.
    #[default]
    AtPoints,
    /// In the mean over each cell ("mean dilatation", B-bar of linear elasticity, Q1-P0: J. C. Nagtegaal, D. M. Parks,
    /// J. R. Rice, Computer Methods in Applied Mechanics and Engineering 4 (1974) 153-177; J. C. Simo, R. L. Taylor,
    /// K. S. Pister, ibid. 51 (1985) 177-208): for quadrilaterals and hexahedra, and for quadratic triangles and
    /// tetrahedra.
    Mean,
    /// Projected onto linear functions of the undeformed position in each cell (Q2/P-1, with a discontinuous linear
    /// pressure; D. Boffi, L. Gastaldi, Mathematical Models and Methods in Applied Sciences 12 (2002) 1589-1603): for
    /// quadratic hexahedra and quadrilaterals, and for triangles and tetrahedra with bubbles ([`Mesh::with_bubbles`](crate::Mesh::with_bubbles);
    /// M. Crouzeix, P.-A. Raviart, RAIRO 7 (1973) R3, 33-75). Hexahedra of 20 nodes have more pressures than their faces can control: displacements
    /// are better than with the mean, pressures are not reliable.
    Linear,
}

impl Dilatation {
    /// Name: `points`, `mean`, `linear`.
    pub fn name(self) -> &'static str {
        match self {
            Self::AtPoints => "points",
            Self::Mean => "mean",
            Self::Linear => "linear",
        }
    }

    /// Whether cells change their volume freely by their thickness.
    pub(super) fn is_free(kind: CellKind, dimension: usize, plane: Plane) -> bool {
        kind.dimension() < dimension.max(2) || kind.dimension() == 2 && plane == Plane::Stress
    }

    /// # Errors
    /// Cells that cannot have it, or for which it would be the same, and bodies that are free to change their thickness.
    pub(super) fn check(
        self,
        kind: CellKind,
        dimension: usize,
        plane: Plane,
    ) -> Result<(), InputError> {
        let help = match kind {
            _ if self == Self::AtPoints => return Ok(()),
            _ if Self::is_free(kind, dimension, plane) => {
                "membranes, strings and bodies in plane stress are free to change their thickness and do not lock: leave it out"
            }
            CellKind::Triangle | CellKind::Tetrahedron => {
                "linear triangles and tetrahedra have one point each: nothing changes for them. Take quadratic ones, \
                 quadrilaterals or hexahedra"
            }
            _ if self == Self::Mean => return Ok(()),
            CellKind::Triangle7
            | CellKind::Tetrahedron15
            | CellKind::Quadrilateral9
            | CellKind::Hexahedron20
            | CellKind::Hexahedron27 => return Ok(()),
            CellKind::Triangle6 | CellKind::Tetrahedron10 => {
                "triangles and tetrahedra without bubbles lock with a linear dilatation, too: give them bubbles \
                 (`bubbles = true`, Mesh::with_bubbles), or take \"mean\""
            }
            _ => {
                "linear cells lock with a linear dilatation, too: take \"mean\", or quadratic cells"
            }
        };
        Err(InputError::new("dilatation", self.name(), help))
    }
}

#[cfg(test)]
mod tests;
