//! The tangents of all elements, and the constant matrices, which are tangents at rest.
//!
//! Tangents are computed as forces are: compiled for each kind of machine, several cells at once, in an order of
//! additions that is the same on all machines. Those of a cell are summed up over its points, and added to the matrix once.
//! The gradients of a cell add up to 0, and so do the rows and columns of its tangent: the blocks of its first node
//! balance the others. Of a symmetric tangent half of the blocks are computed.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use super::elements::{ElementsOf, gradient, pairs};
use super::forces::Terms;
use super::regions::{Laws, Regions};
use crate::lane::{Abreast, Lane, SIDE_BY_SIDE};
use crate::material::{
    Block, Blocks, Deformation, ElasticLaw, Hooke, Linear, ViscousLaw, with_law,
};
use crate::sparse::{BlockMatrix, Rows};
use crate::tensor::{Matrix, Real};

#[cfg(test)]
mod tests;

/// Elements as matrices.
pub(super) trait Tangents {
    /// Adds sum w (lambda g_a g_b^T + mu ((g_a . g_b) I + g_b g_a^T)), `hooke` telling the constants.
    fn add_stiffness(
        &self,
        regions: &Regions,
        hooke: &dyn Fn(&Laws) -> Hooke,
        stiffness: &mut BlockMatrix,
    );

    /// Adds -df/du and -df/dv of the forces of `terms`.
    fn add_tangents(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    );
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Tangents
    for ElementsOf<N, M, D, Q>
{
    fn add_stiffness(
        &self,
        regions: &Regions,
        hooke: &dyn Fn(&Laws) -> Hooke,
        stiffness: &mut BlockMatrix,
    ) {
        let mut stiffness = stiffness.rows_mut::<D>();
        for (cell, entries) in self.entries.iter().enumerate() {
            let law = Linear(hooke(regions.of(cell)));
            for point in self.points(cell) {
                let rest = Deformation::new(point.frame, [[0.0; D]; M]);
                let tangent = law.tangent(&rest, &point.gradients, point.volume);
                for (a, b) in pairs::<N>() {
                    if let Some(sum) = stiffness.block_mut(entries[a][b]) {
                        add(sum, &tangent.block(a, b));
                    }
                }
            }
        }
    }

    fn add_tangents(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let (u, v) = (u.as_chunks::<D>().0, v.as_chunks::<D>().0);
        let add = |share: usize, mut stiffness: Rows<'_, D>, mut damping: Rows<'_, D>| {
            for (cells, laws) in self.shares.cells[share].iter().flat_map(|run| regions.runs(run)) {
                if terms.elastic {
                    with_law!(laws.elastic, law => {
                        self.add_to(&mut stiffness, cells.clone(), [u], ElasticSlope(&law));
                    });
                }
                if terms.viscous {
                    let law = &laws.viscous;
                    self.add_to(&mut damping, cells.clone(), [u], RateSlope(law));
                    self.add_to(&mut stiffness, cells, [u, v], ViscousSlope(law));
                }
            }
        };
        self.shares.each(stiffness.rows_mut(), damping.rows_mut(), &add);
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Adds the tangents of `cells`, cell after cell, to the rows of a matrix, by the `fields` that `slope` asks for.
    fn add_to<const K: usize>(
        &self,
        rows: &mut Rows<'_, D>,
        cells: Range<usize>,
        fields: [&[[f64; D]]; K],
        slope: impl Slope<K>,
    ) {
        Arch::new().dispatch(Pass { elements: self, rows, cells, fields, slope });
    }
}

/// A tangent at a point, by the gradients of `K` fields: of displacements and, if K is 2, of velocities.
trait Slope<const K: usize> {
    /// Whether the block of nodes b and a is that of a and b, transposed.
    const IS_SYMMETRIC: bool;

    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        fields: &[Matrix<T, D, M>; K],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D>;
}

struct ElasticSlope<'l, L>(&'l L);

impl<L: ElasticLaw> Slope<1> for ElasticSlope<'_, L> {
    const IS_SYMMETRIC: bool = true;

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.0.tangent(at, gradients, volume)
    }
}

/// That of viscous stress by the rate.
struct RateSlope<'l, L>(&'l L);

impl<L: ViscousLaw> Slope<1> for RateSlope<'_, L> {
    const IS_SYMMETRIC: bool = true;

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.0.rate_tangent(at, gradients, volume)
    }
}

/// That of viscous stress by the deformation.
struct ViscousSlope<'l, L>(&'l L);

impl<L: ViscousLaw> Slope<2> for ViscousSlope<'_, L> {
    const IS_SYMMETRIC: bool = false;

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.0.tangent(at, rate, gradients, volume)
    }
}

/// The tangents of a run of cells of one law, compiled for each kind of machine.
struct Pass<
    'a,
    'r,
    P,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
    const K: usize,
> {
    elements: &'a ElementsOf<N, M, D, Q>,
    rows: &'a mut Rows<'r, D>,
    cells: Range<usize>,
    fields: [&'a [[f64; D]]; K],
    slope: P,
}

/// The tangents of several cells. Of symmetric ones blocks below the diagonal are left out.
type OfCells<const N: usize, const D: usize> = [[Block<Abreast, D>; N]; N];

impl<P: Slope<K>, const N: usize, const M: usize, const D: usize, const Q: usize, const K: usize>
    WithSimd for Pass<'_, '_, P, N, M, D, Q, K>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { elements, rows, cells, fields, slope } = self;
        let abreast = elements.abreast();
        let zero = Lane::splat(simd, 0.0);
        let mut sums = [[[[Abreast([0.0; SIDE_BY_SIDE]); D]; D]; N]; N];
        for register in cells.start / S::F64_LANES..cells.end.div_ceil(S::F64_LANES) {
            let start = register * S::F64_LANES;
            let (block, part) = (start / SIDE_BY_SIDE, start % SIDE_BY_SIDE / S::F64_LANES);
            let mut x = [[[zero; D]; N]; K];
            for k in 0..K {
                x[k] = elements.gather(simd, start, fields[k]);
            }
            for q in 0..Q {
                let point = abreast[block][q].lane(simd, part);
                let mut gradients = [[[zero; D]; M]; K];
                for k in 0..K {
                    gradients[k] = gradient(1, &x[k], &point.gradients);
                }
                let at = Deformation::new(point.frame, gradients[0]);
                let blocks = slope.blocks(&at, &gradients, &point.gradients, point.volume);
                for a in 1..N {
                    for b in if P::IS_SYMMETRIC { a } else { 1 }..N {
                        sum_up(simd, q == 0, &blocks.block(a, b), &mut sums[a][b]);
                    }
                }
            }
            balance::<S, N, D>(simd, P::IS_SYMMETRIC, &mut sums);
            for cell in cells.start.max(start)..cells.end.min(start + S::F64_LANES) {
                let entries = &elements.entries[cell];
                scatter(entries, P::IS_SYMMETRIC, &sums, cell - start, rows);
            }
        }
    }
}

/// Adds a block of several cells to their sum, or begins with it.
#[inline(always)]
fn sum_up<S: Simd, const D: usize>(
    simd: S,
    is_first: bool,
    block: &Block<Lane<S>, D>,
    sum: &mut Block<Abreast, D>,
) {
    for i in 0..D {
        for k in 0..D {
            let sum = &mut sum[i][k].0;
            let total = match is_first {
                true => block[i][k],
                false => Lane::load(simd, sum, 0) + block[i][k],
            };
            total.store(sum, 0);
        }
    }
}

/// Completes the tangents by the blocks of the first node, which balance all others.
#[inline(always)]
fn balance<S: Simd, const N: usize, const D: usize>(
    simd: S,
    is_symmetric: bool,
    sums: &mut OfCells<N, D>,
) {
    let zero = Lane::splat(simd, 0.0);
    for i in 0..D {
        for k in 0..D {
            let mut of_first = zero;
            for b in 1..N {
                let mut of_column = zero;
                let mut of_row = zero;
                for a in 1..N {
                    of_column += match is_symmetric && a > b {
                        true => Lane::load(simd, &sums[b][a][k][i].0, 0),
                        false => Lane::load(simd, &sums[a][b][i][k].0, 0),
                    };
                    if !is_symmetric {
                        of_row += Lane::load(simd, &sums[b][a][i][k].0, 0);
                    }
                }
                (zero - of_column).store(&mut sums[0][b][i][k].0, 0);
                if !is_symmetric {
                    (zero - of_row).store(&mut sums[b][0][i][k].0, 0);
                }
                of_first += of_column;
            }
            // symmetric to the last bit
            let of_first = match is_symmetric && k < i {
                true => Lane::load(simd, &sums[0][0][k][i].0, 0),
                false => of_first,
            };
            of_first.store(&mut sums[0][0][i][k].0, 0);
        }
    }
}

/// Adds the tangent of one of several cells to the rows of a matrix.
#[inline(always)]
fn scatter<const N: usize, const D: usize>(
    entries: &[[u32; N]; N],
    is_symmetric: bool,
    sums: &OfCells<N, D>,
    lane: usize,
    rows: &mut Rows<'_, D>,
) {
    for a in 0..N {
        for b in 0..N {
            let Some(sum) = rows.block_mut(entries[a][b]) else { continue };
            for i in 0..D {
                for k in 0..D {
                    sum[i][k] += match is_symmetric && a > b {
                        true => sums[b][a][k][i].0[lane],
                        false => sums[a][b][i][k].0[lane],
                    };
                }
            }
        }
    }
}

fn add<const D: usize>(sum: &mut Block<f64, D>, block: &Block<f64, D>) {
    for i in 0..D {
        for k in 0..D {
            sum[i][k] += block[i][k];
        }
    }
}
