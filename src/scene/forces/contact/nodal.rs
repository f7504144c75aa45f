//! Nodal contact quantities of an obstacle.

use super::Contact;
use crate::base::vector::norm;
use crate::integrators::ode::Failure;
use crate::scene::forces::nodal::{NodalContact, Tributary};
use crate::scene::forces::stuck::Stuck;

impl Contact {
    /// Adds what the obstacle does at the nodes to `nodal`.
    ///
    /// # Errors
    /// A user's distance function that returns an invalid distance or gradient.
    pub(crate) fn add_nodal(
        &self,
        t: f64,
        [u, v]: [&[f64]; 2],
        tributary: &Tributary,
        nodal: &mut [NodalContact],
    ) -> Result<(), Failure> {
        for touch in self.touches(t, u, v) {
            self.check(t, &touch)?;
            if touch.is_cut_off {
                continue;
            }
            let pressing = -touch.point.law.pull(touch.nearest.distance, touch.rate);
            let sticks = touch.slip.as_ref().zip(self.coulomb);
            let sticks = sticks.is_some_and(|(slip, law)| law.sticks(norm(&slip.sliding)));
            for (node, share) in touch.point.on.nodes() {
                let area = match self.obstacle.is_per_area() {
                    true => share * touch.point.on.area,
                    false => tributary.facing(node, u, &touch.nearest.normal),
                };
                nodal[node].add(share * pressing, area, !sticks);
            }
        }
        Ok(())
    }

    /// Passes to `see` the points that friction holds.
    pub(crate) fn each_stuck(&self, t: f64, [u, v]: [&[f64]; 2], mut see: impl FnMut(Stuck)) {
        let Some(law) = self.coulomb else { return };
        for touch in self.touches(t, u, v) {
            let Some(slip) = touch.slip.filter(|slip| law.sticks(norm(&slip.sliding))) else {
                continue;
            };
            see(Stuck {
                point: touch.point.on.nodes().collect(),
                place: Vec::new(),
                normal: touch.nearest.normal,
                pressing: slip.pressing,
                sticking_speed: law.sticking_speed,
            });
        }
    }
}
