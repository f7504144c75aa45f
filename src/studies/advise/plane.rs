//! A rung of the ladder: a plane section of a scene that is uniform along an axis.

use super::found::Found;
use super::search::{Search, Solved, Stop};
use super::smaller_run::Shrunk;
use crate::base::input::InputError;
use crate::elements::mesh::Prism;
use crate::scene::timeline::Scene;

impl Search<'_> {
    /// Runs the fastest accurate candidate as a plane section, if the scene is uniform along an axis. The change of the quantity is the
    /// error of plane strain or plane stress.
    pub(super) fn plane(&mut self, found: &mut Found) -> Result<(), Stop> {
        self.run_across("in a plane across", found, |search, scene, axis, exact| {
            // of a mesh that is no prism there is nothing to tell
            let prism = scene.body().mesh().prism(axis.index()).ok()?;
            Some(search.section(scene, prism, exact))
        })
    }

    fn section(&self, scene: &Scene, prism: Prism, exact: &Solved) -> Result<Shrunk, InputError> {
        let section = scene.section_of(prism)?;
        let quantity = self.request.quantity.in_plane(scene, &section)?;
        let points = section.prism.columns[..self.nodes].to_vec();
        let nodes = points.iter().max().map_or(0, |last| last + 1);
        let (kind, full) = (section.kind(), exact.seen.along(section.prism.axes()));
        Ok(Shrunk { kind, scene: section.scene, quantity, nodes, points: Some(points), full })
    }
}
