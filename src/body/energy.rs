//! The strain energy of all elements, computed for as many cells at once as their forces are.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use super::elements::{ElementsOf, gradient};
use super::regions::Regions;
use crate::lane::{Lane, SIDE_BY_SIDE};
use crate::material::{Deformation, ElasticLaw, with_law};

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Strain energy (J), added up in the order of cells, whatever the machine computes at once.
    pub(super) fn strain_energy(&self, regions: &Regions, u: &[f64]) -> f64 {
        let u = u.as_chunks::<D>().0;
        let all = 0..self.nodes.len();
        regions.runs(&all).fold(0.0, |sum, (cells, laws)| {
            with_law!(&laws.elastic, law => {
                let pass = Pass { elements: self, cells, u, law, sum };
                if const { Self::CAN_LOCK } && self.mean_dilatation {
                    Arch::new().dispatch(MeanPass(pass))
                } else {
                    Arch::new().dispatch(pass)
                }
            })
        })
    }
}

/// The energy of a run of cells of one law, compiled for each kind of machine.
pub(super) struct Pass<'a, L, const N: usize, const M: usize, const D: usize, const Q: usize> {
    pub(super) elements: &'a ElementsOf<N, M, D, Q>,
    pub(super) cells: Range<usize>,
    pub(super) u: &'a [[f64; D]],
    pub(super) law: &'a L,
    /// That of the cells before.
    pub(super) sum: f64,
}

impl<L: ElasticLaw, const N: usize, const M: usize, const D: usize, const Q: usize> WithSimd
    for Pass<'_, L, N, M, D, Q>
{
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let law = self.law;
        self.add_up(simd, |points| {
            let mut energy = Lane::splat(simd, 0.0);
            for (volume, at) in points {
                energy += *volume * law.energy(&law.point(L::twice_strain(at)));
            }
            energy
        })
    }
}

/// The same with the mean dilatation of each cell.
struct MeanPass<'a, L, const N: usize, const M: usize, const D: usize, const Q: usize>(
    Pass<'a, L, N, M, D, Q>,
);

impl<L: ElasticLaw, const N: usize, const M: usize, const D: usize, const Q: usize> WithSimd
    for MeanPass<'_, L, N, M, D, Q>
{
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let law = self.0.law;
        self.0.add_up(simd, |points| {
            let zero = Lane::splat(simd, 0.0);
            let (mut energy, mut swelling, mut whole) = (zero, zero, zero);
            for (volume, at) in points {
                let point = law.point(L::twice_strain(at));
                energy += *volume * law.energy_of_shape(&point);
                swelling += *volume * law.dilatation(&point);
                whole += *volume;
            }
            let [of_volume, ..] = law.of_volume(swelling / whole);
            energy + of_volume * whole
        })
    }
}

impl<L, const N: usize, const M: usize, const D: usize, const Q: usize> Pass<'_, L, N, M, D, Q> {
    /// The sum with what `of_cells` makes of the points of as many cells as a register holds.
    #[inline(always)]
    fn add_up<S: Simd>(
        self,
        simd: S,
        of_cells: impl Fn(&[(Lane<S>, Deformation<Lane<S>, M, D>); Q]) -> Lane<S>,
    ) -> f64 {
        let Self { elements, cells, u, mut sum, .. } = self;
        let abreast = elements.abreast();
        for register in cells.start / S::F64_LANES..cells.end.div_ceil(S::F64_LANES) {
            let start = register * S::F64_LANES;
            let (block, part) = (start / SIDE_BY_SIDE, start % SIDE_BY_SIDE / S::F64_LANES);
            let x = elements.gather(simd, start, u);
            let energies = of_cells(&abreast[block].each_ref().map(|point| {
                let point = point.lane(simd, part);
                let h = gradient(1, &x, &point.gradients);
                (point.volume, Deformation::new(point.frame, h))
            }));
            let mut numbers = [0.0; SIDE_BY_SIDE];
            energies.store(&mut numbers, 0);
            for cell in cells.start.max(start)..cells.end.min(start + S::F64_LANES) {
                sum += numbers[cell - start];
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use crate::body::Body;
    use crate::body::tests::noise;
    use crate::material::{Material, Strain};
    use crate::mesh::{Cells, Mesh, SolidCells};
    use crate::samples::SQUARE_MATERIAL;

    /// Against the energy densities of the cells, each computed by itself, on meshes that fill no whole number of registers
    /// and change the material within one.
    #[test]
    fn energies_of_cells_add_up() {
        let meshes = [
            Mesh::bar(1.0, 20),
            Mesh::rectangle([1.0, 0.5], [8, 4], Cells::Triangles),
            Mesh::rectangle([1.0, 0.5], [8, 4], Cells::Rectangles),
            Mesh::rectangle([1.0, 0.5], [6, 4], Cells::Triangles6),
            Mesh::cuboid([1.0, 0.5, 0.5], [4, 3, 4], SolidCells::Tetrahedra),
            Mesh::cuboid([1.0, 0.5, 0.5], [4, 3, 4], SolidCells::Hexahedra),
        ];
        for mesh in meshes {
            let mesh = mesh.unwrap();
            let stiff = Material { young: 3e6, ..SQUARE_MATERIAL };
            let kind = mesh.kind();
            for strain in [Strain::Cauchy, Strain::Green] {
                let body = Body::new(mesh.clone(), SQUARE_MATERIAL).strain(strain);
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
                let energy = body.elements.energy(&body.regions, &u);
                assert!((energy / expected - 1.0).abs() < 1e-13, "{kind:?}: {energy}, {expected}");
            }
        }
    }
}
