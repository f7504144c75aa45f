//! Nodal contact quantities of a scene.

use super::Scene;
use crate::base::input::InputError;
use crate::integrators::ode::Failure;
use crate::scene::forces::{Contact, NodalContact, TouchForce, Tributary};

/// Reads what contact does at the nodes: what does not change from sample to sample.
pub(crate) struct ContactReader {
    pub(crate) touches: Vec<TouchForce>,
    tributary: Tributary,
}

impl ContactReader {
    pub(crate) fn new(scene: &Scene) -> Result<Self, InputError> {
        let (touches, tributary) = (scene.touch_forces()?, Tributary::new(scene.body()));
        Ok(Self { touches, tributary })
    }

    /// Contact quantities of each node at time `t` (s), by the `contacts` with obstacles and by all touches, at the
    /// displacements and velocities `[u, v]` (m, m/s).
    ///
    /// # Errors
    /// A user's distance function that is undefined; surfaces that lie on each other.
    pub(crate) fn read(
        &self,
        contacts: &[Contact],
        t: f64,
        [u, v]: [&[f64]; 2],
    ) -> Result<Vec<NodalContact>, Failure> {
        let mut nodal = vec![NodalContact::default(); self.tributary.node_count()];
        for contact in contacts {
            contact.add_nodal(t, [u, v], &self.tributary, &mut nodal)?;
        }
        for touch in &self.touches {
            touch.add_nodal([u, v], &self.tributary, &mut nodal)?;
        }
        self.tributary.even_out(&mut nodal);
        Ok(nodal)
    }
}
