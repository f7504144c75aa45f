//! Strain, stress and energy of the cells of a body of revolution, along the axes r, z and around.

use super::{CellField, OfVolume, PointField, Tensors, mean};
use crate::elements::body::regions::Regions;
use crate::elements::body::revolved::Revolved;
use crate::elements::material::{ElasticLaw, with_law};

impl Revolved {
    /// Strain, stress and energy density of each cell.
    pub(super) fn fields(&self, regions: &Regions, u: &[f64]) -> Vec<CellField> {
        let of_cell = |cell| with_law!(regions.of(cell).elastic, law => mean(self.point_fields(&law, cell, u)));
        (0..self.count()).map(of_cell).collect()
    }

    /// As [`Fields::each_node`](super::Fields::each_node).
    pub(super) fn each_node(
        &self,
        regions: &Regions,
        u: &[f64],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    ) {
        with_law!(regions.of(cell).elastic, law => {
            let points: Vec<_> = self.point_fields(&law, cell, u).collect();
            for (a, node) in self.nodes_of(cell).iter().enumerate() {
                let mut at_node = Tensors::default();
                let factors = &self.extrapolation[a * self.points..][..self.points];
                for ((_, point), factor) in points.iter().zip(factors) {
                    at_node.add(&point.tensors, *factor);
                }
                see(*node, a, &at_node);
            }
        });
    }

    /// The fields at the points of a cell, with their volumes.
    fn point_fields<'a, L: ElasticLaw>(
        &'a self,
        law: &'a L,
        cell: usize,
        u: &'a [f64],
    ) -> impl Iterator<Item = (f64, PointField)> + 'a {
        let dilatation =
            |point| law.dilatation(&law.point(L::twice_strain(&self.deformed(cell, point, u))));
        let dilatation = self.is_projected.then(|| self.projected(cell, dilatation));
        let at_point = move |point: usize| {
            let dilatation = dilatation.as_ref()?;
            Some(law.of_volume(dilatation.at(self.modes_at(point))))
        };
        let pull = self.projected(cell, |point| at_point(point).map_or(0.0, |[_, pull, _]| pull));
        self.points_of(cell).map(move |point| {
            let of_volume = at_point(point)
                .map(|[energy, ..]| OfVolume { pull: pull.at(self.modes_at(point)), energy });
            (self.volumes[point], PointField::new(law, &self.deformed(cell, point, u), of_volume))
        })
    }
}
