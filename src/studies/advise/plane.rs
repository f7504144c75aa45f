//! A rung of the ladder: a section in a plane of what is the same all along an axis.

use super::found::Found;
use super::search::{Search, Solved, Stop};
use super::smaller_run::Shrunk;
use crate::base::input::InputError;
use crate::scene::constraint::Axis;
use crate::scene::timeline::Scene;

impl Search<'_> {
    /// Runs the fastest motion that is right in a plane, if it is the same all along an axis. How far the body is from plane strain or
    /// plane stress, the change tells.
    pub(super) fn plane(&mut self, found: &mut Found) -> Result<(), Stop> {
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        let Ok(scene) = best.choice.scene(&self.scene) else { return Ok(()) };
        let mut refused = Vec::new();
        if !scene.body().is_single() {
            return Ok(());
        }
        for &axis in Axis::all(scene.body().dimension()) {
            // of a mesh that is no prism there is nothing to tell
            if scene.body().mesh().prism(axis.index()).is_err() {
                continue;
            }
            match self.section(&scene, axis, &exact) {
                Ok(section) => return self.run_smaller([best, exact], &section, found),
                Err(error) => {
                    refused.push(format!("in a plane across {}: {error}", axis.word()));
                }
            }
        }
        found.not_tried.extend(refused);
        Ok(())
    }

    fn section(&self, scene: &Scene, axis: Axis, exact: &Solved) -> Result<Shrunk, InputError> {
        let section = scene.section(axis)?;
        let quantity = self.request.quantity.in_plane(scene, &section)?;
        let points = section.prism.columns[..self.nodes].to_vec();
        let nodes = points.iter().max().map_or(0, |last| last + 1);
        let (kind, full) = (section.kind(), exact.seen.along(section.prism.axes()));
        Ok(Shrunk { kind, scene: section.scene, quantity, nodes, points: Some(points), full })
    }
}
