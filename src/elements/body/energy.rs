//! The strain energy of all elements, computed for as many cells at once as their forces are.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::elements::{ElementsOf, gradient};
use super::projection::Projected;
use super::regions::Regions;
use super::revolved::Revolved;
use crate::base::lane::{Lane, SIDE_BY_SIDE};
use crate::base::simd::at_once;
use crate::elements::material::{CellLaw, Deformation, Elastic};

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Strain energy (J), added up in the order of cells, however many the machine computes at once.
    pub(super) fn strain_energy(&self, regions: &Regions, u: &[f64]) -> f64 {
        if let Some(revolved) = &self.revolved {
            return revolved.strain_energy(regions, u);
        }
        let all = 0..self.nodes.len();
        regions.runs(&all).fold(0.0, |sum, (cells, laws)| match &laws.elastic {
            Elastic::Linear(law) => self.add_energy(cells, law, u, sum),
            Elastic::StVenantKirchhoff(law) => self.add_energy(cells, law, u, sum),
            Elastic::ByPoint(law) => self.add_energy(cells, law, u, sum),
        })
    }

    /// The energy of cells of one law, added to a `sum`.
    pub(super) fn add_energy(
        &self,
        cells: Range<usize>,
        law: &impl CellLaw,
        u: &[f64],
        sum: f64,
    ) -> f64 {
        at_once(Pass { elements: self, cells, u, law, sum })
    }
}

/// The energy of a run of cells of one law, compiled for each instruction set.
struct Pass<'a, L, const N: usize, const M: usize, const D: usize, const Q: usize> {
    elements: &'a ElementsOf<N, M, D, Q>,
    cells: Range<usize>,
    u: &'a [f64],
    law: &'a L,
    /// The energy of the cells before.
    sum: f64,
}

impl<L: CellLaw, const N: usize, const M: usize, const D: usize, const Q: usize> WithSimd
    for Pass<'_, L, N, M, D, Q>
{
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { elements, cells, u, law, mut sum } = self;
        let is_projected = const { ElementsOf::<N, M, D, Q>::CAN_LOCK } && elements.is_projected();
        let abreast = elements.abreast();
        let zero = Lane::splat(simd, 0.0);
        for register in cells.start / S::F64_LANES..cells.end.div_ceil(S::F64_LANES) {
            let start = register * S::F64_LANES;
            let (block, part) = (start / SIDE_BY_SIDE, start % SIDE_BY_SIDE / S::F64_LANES);
            let x = elements.gather(simd, start, u);
            let (mut energy, mut dilatation, mut whole) = (zero, Projected::new(zero), zero);
            for q in 0..Q {
                let point = abreast[block][q].lane(simd, part);
                let at = Deformation::new(point.frame, gradient(1, &x, &point.gradients));
                if is_projected {
                    let [of_shape, of_point] = law.shape_and_volume(&at);
                    energy += point.volume * of_shape;
                    let modes = elements.modes_of_lane(simd, block, part, q);
                    dilatation.add(point.volume * of_point, modes.as_ref());
                    whole += point.volume;
                } else {
                    energy += point.volume * law.energy_at(&at);
                }
            }
            if is_projected {
                let dilatation = dilatation.over(whole);
                if !elements.is_linear() {
                    let [of_mean, ..] = law.of_projected(dilatation.mean);
                    energy += of_mean * whole;
                } else {
                    for q in 0..Q {
                        let modes = elements.modes_of_lane(simd, block, part, q);
                        let [of_volume, ..] = law.of_projected(dilatation.at(modes.as_ref()));
                        energy += of_volume * Lane::load(simd, &abreast[block][q].volume.0, part);
                    }
                }
            }
            let mut numbers = [0.0; SIDE_BY_SIDE];
            energy.store(&mut numbers, 0);
            for cell in cells.start.max(start)..cells.end.min(start + S::F64_LANES) {
                sum += numbers[cell - start];
            }
        }
        sum
    }
}

impl Revolved {
    /// Strain energy (J).
    fn strain_energy(&self, regions: &Regions, u: &[f64]) -> f64 {
        regions.runs(&(0..self.count())).fold(0.0, |sum, (cells, laws)| match &laws.elastic {
            Elastic::Linear(law) => self.add_energy(cells, law, u, sum),
            Elastic::StVenantKirchhoff(law) => self.add_energy(cells, law, u, sum),
            Elastic::ByPoint(law) => self.add_energy(cells, law, u, sum),
        })
    }

    /// The energy of cells of one law, added to a `sum`.
    fn add_energy(&self, cells: Range<usize>, law: &impl CellLaw, u: &[f64], mut sum: f64) -> f64 {
        for cell in cells {
            let at = |point| self.deformed(cell, point, u);
            let dilatation = self
                .is_projected
                .then(|| self.projected(cell, |point| law.dilatation_at(&at(point))));
            for point in self.points_of(cell) {
                let density = match &dilatation {
                    None => law.energy_at(&at(point)),
                    Some(dilatation) => {
                        let [of_shape, _] = law.shape_and_volume(&at(point));
                        let [of_volume, ..] = law.of_projected(dilatation.at(self.modes_at(point)));
                        of_shape + of_volume
                    }
                };
                sum += self.volumes[point] * density;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use crate::elements::body::tests::noise;
    use crate::elements::body::{Body, Dilatation};
    use crate::elements::material::{Material, Strain};
    use crate::elements::mesh::{CellKind, Cells, Mesh, SolidCells};
    use crate::studies::samples::SQUARE_MATERIAL;

    /// Against the energy densities of the cells, each computed by itself, on meshes that fill no whole
    /// number of registers and change the material within one.
    #[test]
    fn energies_of_cells_add_up() {
        let meshes = [
            Mesh::bar(1.0, 20),
            Mesh::rectangle([1.0, 0.5], [8, 4], Cells::Triangles),
            Mesh::rectangle([1.0, 0.5], [8, 4], Cells::Rectangles),
            Mesh::rectangle([1.0, 0.5], [6, 4], Cells::Triangles6),
            Mesh::rectangle([1.0, 0.5], [6, 4], Cells::Triangles6)
                .and_then(|mesh| mesh.with_bubbles()),
            Mesh::rectangle([1.0, 0.5], [6, 4], Cells::Rectangles9),
            Mesh::cuboid([1.0, 0.5, 0.5], [4, 3, 4], SolidCells::Tetrahedra),
            Mesh::cuboid([1.0, 0.5, 0.5], [2, 3, 2], SolidCells::Tetrahedra10)
                .and_then(|mesh| mesh.with_bubbles()),
            Mesh::cuboid([1.0, 0.5, 0.5], [4, 3, 4], SolidCells::Hexahedra),
            Mesh::cuboid([1.0, 0.5, 0.5], [4, 3, 4], SolidCells::Hexahedra20),
            Mesh::cuboid([1.0, 0.5, 0.5], [4, 3, 4], SolidCells::Hexahedra27),
        ];
        for mesh in meshes {
            let mesh = mesh.unwrap();
            let stiff = Material { young: 3e6, ..SQUARE_MATERIAL };
            let kind = mesh.kind();
            let linear = matches!(
                kind,
                CellKind::Triangle7
                    | CellKind::Tetrahedron15
                    | CellKind::Quadrilateral9
                    | CellKind::Hexahedron20
                    | CellKind::Hexahedron27
            );
            let others = if linear { &[Dilatation::Mean, Dilatation::Linear][..] } else { &[] };
            let dilatations = [Dilatation::AtPoints].iter().chain(others);
            let strains = [Strain::Cauchy, Strain::Green];
            for (dilatation, strain) in dilatations.flat_map(|at| strains.map(|by| (*at, by))) {
                let body = Body::new(mesh.clone(), SQUARE_MATERIAL).strain(strain);
                let body = body.dilatation(dilatation);
                let body = match kind.dimension() {
                    1 => body.area(1e-4),
                    2 => body.thickness(0.01),
                    _ => body,
                };
                let cells = crate::CellSelection::Numbers((5..=11).collect());
                let body = body.region(cells, stiff).build().unwrap();
                let u = noise(body.dofs(), 1e-2, 1.0);
                let volumes = body.cell_volumes();
                let fields = body.cell_fields(&u);
                let expected: f64 =
                    fields.iter().zip(volumes).map(|(cell, v)| cell.energy_density * v).sum();
                let energy = body.continua[0].elements.energy(&body.continua[0].regions, &u);
                let off = energy / expected - 1.0;
                assert!(off.abs() < 1e-13, "{kind:?}, {dilatation:?}: {energy}, {expected}");
            }
        }
    }
}
