//! Twenty-seven-node hexahedron on the unit cube, triquadratic: the nodes of the twenty-node one, then the middles of the
//! faces and of the cell in the order of VTK.

use super::ReferenceCell;
use super::hexahedron20::{CUBE, Hexahedron20};
use super::quadrilateral9::{biquadratic, biquadratic_derivatives};

pub(crate) struct Hexahedron27;

impl ReferenceCell<27, 3> for Hexahedron27 {
    const NODES: [[f64; 3]; 27] = {
        let mut nodes = [[0.5; 3]; 27];
        let mut a = 0;
        while a < 20 {
            nodes[a] = Hexahedron20::NODES[a];
            a += 1;
        }
        nodes[20][0] = 0.0;
        nodes[21][0] = 1.0;
        nodes[22][1] = 0.0;
        nodes[23][1] = 1.0;
        nodes[24][2] = 0.0;
        nodes[25][2] = 1.0;
        nodes
    };
    /// Gauss's rule with three points along each axis: exact for the stiffness of a cuboid. With the 14 points of the
    /// twenty-node cell there are three motions without energy.
    const STIFFNESS_RULE: &'static [([f64; 3], f64)] = &CUBE;
    const MASS_RULE: &'static [([f64; 3], f64)] = &CUBE;

    fn values(x: [f64; 3]) -> [f64; 27] {
        biquadratic(Self::NODES, x)
    }

    fn derivatives(x: [f64; 3]) -> [[f64; 3]; 27] {
        biquadratic_derivatives(Self::NODES, x)
    }
}
