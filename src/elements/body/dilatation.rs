//! Where a body resists a change of its volume.

use crate::base::input::InputError;
use crate::elements::material::Plane;
use crate::elements::mesh::CellKind;

/// Where a body resists a change of its volume.
///
/// A nearly incompressible body (rubber, Poisson's ratio above 0.45) has to keep its volume wherever that is
/// evaluated. At each point of a cell these are more conditions than its nodes can meet: the cell locks, and
/// bends too little. In the mean over the cell it is one condition per cell. ("Mean dilatation", B-bar of
/// linear elasticity, Q1-P0: J. C. Nagtegaal, D. M. Parks, J. R. Rice, Computer Methods in Applied Mechanics
/// and Engineering 4 (1974) 153-177; J. C. Simo, R. L. Taylor, K. S. Pister, ibid. 51 (1985) 177-208.) The
/// law's energy U of the volume is taken at the mean of its measure: of J with the laws of rubber, of
/// tr(U - I) with the corotated law, of tr E with linear elasticity, St. Venant-Kirchhoff material and
/// Maxwell branches. Energy is conserved, and tangents are symmetric, as without it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dilatation {
    /// At each point of a cell.
    #[default]
    AtPoints,
    /// In the mean over each cell: for quadrilaterals and hexahedra, and for quadratic triangles, tetrahedra
    /// and hexahedra.
    Mean,
}

impl Dilatation {
    /// Whether it is the mean, in cells of this kind.
    ///
    /// # Errors
    /// Cells with one point, for which it would be the same, and bodies that are free to change their
    /// thickness.
    pub(super) fn is_mean(
        self,
        kind: CellKind,
        dimension: usize,
        plane: Plane,
    ) -> Result<bool, InputError> {
        let help = match kind {
            _ if self == Self::AtPoints => return Ok(false),
            CellKind::Triangle | CellKind::Tetrahedron => {
                "linear triangles and tetrahedra have one point each: nothing changes for them. Take quadratic ones, \
                 quadrilaterals or hexahedra"
            }
            _ if kind.dimension() < dimension.max(2) => {
                "membranes and strings are free to change their thickness and do not lock: leave it out"
            }
            _ if kind.dimension() == 2 && plane == Plane::Stress => {
                "bodies in plane stress are free to change their thickness and do not lock: leave it out"
            }
            _ => return Ok(true),
        };
        Err(InputError::new("dilatation", "mean", help))
    }
}

#[cfg(test)]
mod tests;
