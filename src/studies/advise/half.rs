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
        self.run_across("half of it, cut across", found, |search, scene, axis, exact| {
            // of a mesh without a plane of symmetry there is nothing to tell
            scene.body().mesh().mirror(axis.index())?;
            Some(search.halved(scene, axis, exact))
        })
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
