//! Nodal contact quantities of touching bodies.

use super::force::TouchForce;
use crate::base::vector::norm;
use crate::integrators::ode::Failure;
use crate::scene::forces::nodal::{NodalContact, Tributary};
use crate::scene::forces::stuck::Stuck;

impl TouchForce {
    /// Adds what the surfaces do at the nodes of both to `nodal`: the points of each surface have a part of the area in touch, and
    /// both surfaces have the same.
    ///
    /// # Errors
    /// Surfaces that lie on each other.
    pub(crate) fn add_nodal(
        &self,
        [u, v]: [&[f64]; 2],
        tributary: &Tributary,
        nodal: &mut [NodalContact],
    ) -> Result<(), Failure> {
        let mut is_passed = false;
        self.each(u, |pair, share| {
            is_passed |= self.is_passed(pair);
            let action = self.action(pair, share, v);
            if !action.presses {
                return;
            }
            let sticks = self.coulomb.is_some_and(|law| law.sticks(norm(&action.sliding)));
            let pressing = action.pressing();
            let shares = pair.nodes.into_iter().zip(pair.shares).take(pair.count);
            let of_point = &pair.nodes[..pair.of_point];
            let area = pair.around * tributary.facing_part(of_point, u, &pair.normal);
            for (m, (node, part)) in shares.enumerate() {
                let part = if m < pair.of_point { part } else { -part };
                nodal[node].add(part * pressing, part * area, !sticks);
            }
        });
        if is_passed { Err(self.passed()) } else { Ok(()) }
    }

    /// Passes to `see` the points that friction holds on the other surface.
    pub(crate) fn each_stuck(&self, [u, v]: [&[f64]; 2], mut see: impl FnMut(Stuck)) {
        let Some(law) = self.coulomb else { return };
        self.each(u, |pair, share| {
            let action = self.action(pair, share, v);
            if !(action.presses && action.pressing() > 0.0 && law.sticks(norm(&action.sliding))) {
                return;
            }
            let shares = pair.nodes.into_iter().zip(pair.shares).take(pair.count);
            let place = shares.clone().skip(pair.of_point).map(|(node, share)| (node, -share));
            see(Stuck {
                point: shares.take(pair.of_point).collect(),
                place: place.collect(),
                normal: pair.normal,
                pressing: action.pressing(),
                sticking_speed: law.sticking_speed,
            });
        });
    }
}
