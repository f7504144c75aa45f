//! A rung of the ladder: half of a symmetric scene.

use super::found::Found;
use super::search::{Search, Solved, Stop};
use super::smaller_run::Shrunk;
use crate::base::input::InputError;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{Scene, Smaller};

impl Search<'_> {
    /// Runs half of the fastest motion that is right, if it is symmetric. Where it is not although the scene is, the change tells.
    pub(super) fn half(&mut self, found: &mut Found) -> Result<(), Stop> {
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        let Ok(scene) = best.choice.scene(&self.scene) else { return Ok(()) };
        let mesh = scene.body().mesh();
        if !scene.body().is_single() {
            return Ok(());
        }
        let mut refused = Vec::new();
        for &axis in Axis::all(mesh.dimension()) {
            // of a mesh without a plane of symmetry there is nothing to tell
            if mesh.mirror(axis.index()).is_none() {
                continue;
            }
            match self.halved(&scene, axis, &exact) {
                Ok(halved) => return self.run_smaller([best, exact], &halved, found),
                Err(error) => {
                    refused.push(format!("half of it, cut across {}: {error}", axis.word()));
                }
            }
        }
        found.not_tried.extend(refused);
        Ok(())
    }

    /// The half on the side on which the quantity is.
    fn halved(&self, scene: &Scene, axis: Axis, exact: &Solved) -> Result<Shrunk, InputError> {
        let of_side = |is_upper| {
            let half = scene.half(axis, is_upper)?;
            let quantity = self.request.quantity.in_half(scene, &half)?;
            let nodes = half.nodes.partition_point(|node| *node < self.nodes);
            let full = match quantity.is_motion() {
                true => exact.seen.of_points(&half.nodes[..nodes]),
                false => exact.seen.clone(),
            };
            let kind = Smaller::Half { axis, at: half.at };
            Ok(Shrunk { kind, scene: half.scene, quantity, nodes, points: None, full })
        };
        of_side(false).or_else(|error| of_side(true).map_err(|_: InputError| error))
    }
}
