//! Nodal contact quantities of a scene.

use super::{Phase, Scene};
use crate::base::input::InputError;
use crate::integrators::ode::Failure;
use crate::scene::constraint::Constrained;
use crate::scene::forces::{Contact, NodalContact, TouchForce, Tributary};

/// Reads what contact does at the nodes: what does not change from sample to sample.
pub(crate) struct ContactReader {
    pub(crate) touches: Vec<TouchForce>,
    tributary: Tributary,
}

impl ContactReader {
    pub(crate) fn new(scene: &Scene) -> Result<Self, InputError> {
        let tributary = Tributary::new(scene.body(), &scene.planes_of_symmetry()?);
        Ok(Self { touches: scene.touch_forces()?, tributary })
    }

    /// Contact quantities of each node at time `t` (s) in a phase, by the `contacts` with obstacles and by touches, at the displacements and velocities `[u, v]` (m, m/s).
    ///
    /// # Errors
    /// A user's distance function that is undefined; surfaces that lie on each other.
    pub(crate) fn read(
        &self,
        (phase, contacts): (&Phase, &[Contact]),
        t: f64,
        [u, v]: [&[f64]; 2],
    ) -> Result<Vec<NodalContact>, Failure> {
        let mut nodal = vec![NodalContact::default(); self.tributary.node_count()];
        for contact in contacts {
            contact.add_nodal(t, [u, v], &self.tributary, &mut nodal)?;
        }
        for touch in self.touches.iter().filter(|_| phase.has_touch) {
            touch.add_nodal([u, v], &self.tributary, &mut nodal)?;
        }
        self.tributary.even_out(&mut nodal);
        Ok(nodal)
    }
}

impl Scene {
    /// The nodes (from 0, ascending) of each [plane of symmetry](super::Phase::symmetry) that all phases have: faces between them are
    /// inside of a whole of which the body is a half.
    ///
    /// # Errors
    /// Nodes that do not exist.
    pub(crate) fn planes_of_symmetry(&self) -> Result<Vec<Vec<usize>>, InputError> {
        let planes = |phase: usize| {
            let constraints = self.phases.get(phase).into_iter().flat_map(|it| &it.constraints);
            constraints.filter_map(|constraint| match &constraint.what {
                Constrained::Along(nodes, normal) => Some((nodes, normal)),
                _ => None,
            })
        };
        let mut all = Vec::new();
        for plane in planes(0) {
            if (1..self.phases.len()).all(|phase| planes(phase).any(|other| other == plane)) {
                let mut nodes = self.body.mesh().select(plane.0)?;
                nodes.sort_unstable();
                all.push(nodes);
            }
        }
        Ok(all)
    }
}
