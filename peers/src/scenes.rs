//! The scenes that are compared.

use pliant::samples::{ClampedBeam, SquareJump};
use pliant::{Inertia, InputError, Scene};

/// A scene, and what the peers have to know that a [`Scene`] does not tell.
pub struct Case {
    /// Name, as on the command line.
    pub name: &'static str,
    /// Title of the chart.
    pub title: &'static str,
    /// Position at rest (m) of the node whose error is given in mm.
    pub tip: [f64; 2],
    /// Stiffness of the floor per node (N/m); 0 where there is none.
    pub floor: f64,
    /// Viscosity (Pa s) of a beam.
    viscosity: f64,
    nodes: [usize; 2],
}

const SQUARE: usize = 10;
const TIP: [f64; 2] = [0.35, 0.01];

/// All of them.
pub const CASES: [Case; 4] = [
    Case {
        name: "beam-35x2",
        title: "Clamped beam, 35 x 2 cells, undamped",
        tip: TIP,
        floor: 0.0,
        viscosity: 0.0,
        nodes: [36, 3],
    },
    Case {
        name: "beam-70x4",
        title: "Clamped beam, 70 x 4 cells, undamped",
        tip: TIP,
        floor: 0.0,
        viscosity: 0.0,
        nodes: [71, 5],
    },
    Case {
        name: "beam-70x4-damped",
        title: "Clamped beam, 70 x 4 cells, damped",
        tip: TIP,
        floor: 0.0,
        viscosity: 4000.0,
        nodes: [71, 5],
    },
    Case {
        name: "square-jump",
        title: "Jumping square, 10 x 10 nodes",
        tip: [0.30, 0.30],
        floor: 400.0 / SQUARE as f64,
        viscosity: 0.0,
        nodes: [SQUARE, SQUARE],
    },
];

impl Case {
    /// The case of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Case> {
        CASES.iter().find(|case| case.name == name)
    }

    /// Whether the floor is what the case is about.
    #[must_use]
    pub fn has_floor(&self) -> bool {
        self.floor > 0.0
    }

    /// Its scene.
    ///
    /// # Errors
    /// None for the cases above.
    pub fn scene(&self, inertia: Inertia) -> Result<Scene, InputError> {
        let &Self { nodes, viscosity, .. } = self;
        match self.has_floor() {
            true => SquareJump { nodes: nodes[0], inertia, ..SquareJump::default() }.scene(),
            false => ClampedBeam { nodes, inertia, viscosity, ..ClampedBeam::default() }.scene(),
        }
    }
}
