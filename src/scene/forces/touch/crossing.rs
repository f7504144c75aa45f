//! Whether a point has passed through a facet, or an edge through an edge, between the ends of a step.
//!
//! Every node moves along the cubic with its positions and velocities at both ends, and so does the place of the point
//! relative to each node of the facet. The distance of the two changes by no more than the longest way of the point
//! relative to a node, times how much farther than its nodes a curved facet moves; that of two edges by no more than the
//! longest way of an end of one relative to an end of the other.
//!
//! The bound for a curved facet is Lebesgue's constant of the face. A passage is treated as that of an
//! obstacle: the step is taken again up to there.

use super::pair::Pair;
use super::surfaces::Feature;
use crate::base::vector::difference;
use crate::elements::basis::MOST_NODES;
use crate::scene::forces::passage::Path;

/// Halvings of a step after which the search ends.
const HALVINGS: u32 = 20;
/// Fraction of the limit that suffices as a lower bound of the distance: with 1, a path at the limit itself would be halved
/// to the last level.
const NEARLY: f64 = 0.9;

/// The ways of a point relative to the nodes of a facet, or of the two ends of an edge relative to those of another one: both
/// to its first end, then both to its second.
#[derive(Clone, Copy)]
pub(super) struct Ways<'a> {
    /// `None` of two edges.
    facet: Option<&'a Feature>,
    paths: [Path; MOST_NODES],
    count: usize,
    /// Ratio of the largest displacement of surfaces to that of nodes.
    reach: f64,
    /// By which the surfaces are nearer than these (m).
    radii: f64,
}

impl<'a> Ways<'a> {
    pub(super) fn to_facet(
        facet: &'a Feature,
        paths: [Path; MOST_NODES],
        reach: f64,
        radii: f64,
    ) -> Self {
        Self { facet: Some(facet), paths, count: facet.nodes().len(), reach, radii }
    }

    pub(super) fn of_edges(paths: [Path; 4], radii: f64) -> Self {
        let paths = std::array::from_fn(|k| paths[k.min(3)]);
        Self { facet: None, paths, count: 4, reach: 1.0, radii }
    }

    fn distance(&self, at: impl Fn(&Path) -> &[f64; 3]) -> f64 {
        let Some(facet) = self.facet else {
            let [a, b, c] = [0, 1, 2].map(|k| *at(&self.paths[k]));
            return Pair::edges_apart(&[a, b], &[[0.0; 3], difference(&a, &c)]) - self.radii;
        };
        let nodes: [[f64; 3]; MOST_NODES] = std::array::from_fn(|k| at(&self.paths[k]).map(|x| -x));
        let place = facet.nearest(&nodes, &[0.0; 3]);
        place.distance(&nodes, &[0.0; 3]) - self.radii
    }

    /// Whether the point stays farther than `distance` (m) from a curved facet, as the hull of its way tells.
    pub(super) fn stay_beyond(&self, distance: f64) -> bool {
        let nodes = |k: usize| self.paths.map(|path| path.controls()[k].map(|x| -x));
        let hull = self.facet.and_then(|facet| facet.hull_along(nodes));
        hull.is_some_and(|hull| hull.distance(&[0.0; 3]) > distance + self.radii)
    }

    /// The distances (m) at both ends.
    pub(super) fn ends(&self) -> [f64; 2] {
        [self.distance(Path::start), self.distance(Path::end)]
    }

    /// The first place found (from 0 up to `last`) at which the distance is below `limit` (m), which it is not at the ends.
    pub(super) fn meets(&self, limit: f64, last: f64) -> Option<f64> {
        self.search(self.ends(), [limit, last], [0.0, 1.0], 0)
    }

    fn search(
        &self,
        ends: [f64; 2],
        [limit, last]: [f64; 2],
        [from, to]: [f64; 2],
        halvings: u32,
    ) -> Option<f64> {
        let paths = self.paths[..self.count].iter();
        let longest = self.reach * paths.map(Path::length).fold(0.0, f64::max);
        if halvings == HALVINGS
            || from >= last
            || 0.5 * (ends[0] + ends[1] - longest) >= NEARLY * limit
        {
            return None;
        }
        let halves = self.paths.map(|path| path.halves());
        let [first, second] =
            [0, 1].map(|half| Self { paths: halves.map(|halves| halves[half]), ..*self });
        let (middle, there) = (0.5 * (from + to), second.distance(Path::start));
        let before = first.search([ends[0], there], [limit, last], [from, middle], halvings + 1);
        if before.is_some() || there < limit {
            return before.or(Some(middle));
        }
        second.search([there, ends[1]], [limit, last], [middle, to], halvings + 1)
    }
}
