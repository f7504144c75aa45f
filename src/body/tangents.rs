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
    Block, Blocks, Deformation, DilatationalLaw, Elastic, ElasticLaw, ObjectiveViscosity,
    ViscousLaw, with_curved_law, with_law,
};
use crate::sparse::{BlockMatrix, Rows};
use crate::tensor::{Matrix, Real, product, times};

#[cfg(test)]
mod tests;

/// Elements as matrices.
pub(super) trait Tangents {
    /// Adds the tangents at rest of the law that `law` tells: sum w (lambda g_a g_b^T + mu ((g_a . g_b) I + g_b g_a^T)).
    fn add_stiffness(
        &self,
        regions: &Regions,
        law: &dyn Fn(&Laws) -> Elastic,
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
        law: &dyn Fn(&Laws) -> Elastic,
        stiffness: &mut BlockMatrix,
    ) {
        let mut rows = stiffness.rows_mut::<D>();
        for cell in 0..self.nodes.len() {
            with_law!(law(regions.of(cell)), law => self.add_at_rest(cell, &law, &mut rows));
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
                    with_curved_law!(laws.elastic, law => {
                        if const { Self::CAN_LOCK } && self.mean_dilatation {
                            self.add_to(&mut stiffness, cells.clone(), [u], MeanSlope(&law));
                        } else {
                            self.add_to(&mut stiffness, cells.clone(), [u], ElasticSlope(&law));
                        }
                    });
                }
                if terms.viscous {
                    let law = &laws.viscous;
                    if const { Self::CAN_LOCK } && self.mean_dilatation {
                        self.add_to(&mut damping, cells.clone(), [u], MeanRateSlope(law));
                        self.add_to(&mut stiffness, cells, [u, v], MeanViscousSlope(law));
                    } else {
                        self.add_to(&mut damping, cells.clone(), [u], RateSlope(law));
                        self.add_to(&mut stiffness, cells, [u, v], ViscousSlope(law));
                    }
                }
            }
        };
        self.shares.each(stiffness.rows_mut(), damping.rows_mut(), &add);
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Adds the tangent at rest of one cell.
    fn add_at_rest(&self, cell: usize, law: &impl DilatationalLaw, rows: &mut Rows<'_, D>) {
        let entries = &self.entries[cell];
        let (mut swelling, mut volume) = ([[0.0; D]; N], 0.0);
        for point in self.points(cell) {
            let rest = Deformation::new(point.frame, [[0.0; D]; M]);
            if self.mean_dilatation {
                let tangent = law.tangent_under(&rest, 0.0, &point.gradients, point.volume);
                add_blocks(entries, rows, &tangent);
                let by_nodes = law.swelling_by_nodes(&rest, &point.gradients, point.volume);
                add(&mut swelling, &by_nodes);
                volume += point.volume;
            } else {
                add_blocks(entries, rows, &law.tangent(&rest, &point.gradients, point.volume));
            }
        }
        if self.mean_dilatation {
            let [.., stiff] = law.of_volume(0.0);
            add_blocks(
                entries,
                rows,
                &OfMean { force: swelling, motion: swelling, share: stiff / volume },
            );
        }
    }

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

    /// Whether what resists a change of volume takes the mean of that over the cell.
    const IS_MEAN: bool = false;

    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        fields: &[Matrix<T, D, M>; K],
        gradients: &[[T; M]; N],
        volume: T,
        pull: T,
    ) -> impl Blocks<T, D>;

    /// The dilatation of a point, how forces follow what pulls there, and how the dilatation follows the nodes, times its `volume`.
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        _at: &Deformation<T, M, D>,
        _fields: &[Matrix<T, D, M>; K],
        _gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        (volume, [[volume; D]; N], [[volume; D]; N])
    }

    /// What pulls at all points of a cell of this mean dilatation, and its derivative by that.
    fn of_mean<T: Real>(&self, dilatation: T) -> [T; 2] {
        [dilatation; 2]
    }
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
        _pull: T,
    ) -> impl Blocks<T, D> {
        self.0.tangent(at, gradients, volume)
    }
}

/// With the mean dilatation of each cell.
struct MeanSlope<'l, L>(&'l L);

impl<L: DilatationalLaw> Slope<1> for MeanSlope<'_, L> {
    const IS_SYMMETRIC: bool = true;
    const IS_MEAN: bool = true;

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
        pull: T,
    ) -> impl Blocks<T, D> {
        self.0.tangent_under(at, pull, gradients, volume)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let by_nodes = self.0.swelling_by_nodes(at, gradients, volume);
        (self.0.dilatation(at) * volume, by_nodes, by_nodes)
    }

    #[inline(always)]
    fn of_mean<T: Real>(&self, dilatation: T) -> [T; 2] {
        let [_, pull, stiff] = self.0.of_volume(dilatation);
        [pull, stiff]
    }
}

/// What a change of the mean dilatation adds: `share` times the product of how forces follow it and how it follows the nodes.
struct OfMean<T, const N: usize, const D: usize> {
    force: [[T; D]; N],
    motion: [[T; D]; N],
    share: T,
}

impl<T: Real, const N: usize, const D: usize> Blocks<T, D> for OfMean<T, N, D> {
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let mut block = [[self.share; D]; D];
        for i in 0..D {
            for k in 0..D {
                block[i][k] = self.force[a][i] * self.motion[b][k] * self.share;
            }
        }
        block
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
        _pull: T,
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
        _pull: T,
    ) -> impl Blocks<T, D> {
        self.0.tangent(at, rate, gradients, volume)
    }
}

/// Both with the mean rate of dilatation of each cell.
struct MeanRateSlope<'l>(&'l ObjectiveViscosity);
struct MeanViscousSlope<'l>(&'l ObjectiveViscosity);

impl Slope<1> for MeanRateSlope<'_> {
    const IS_SYMMETRIC: bool = true;
    const IS_MEAN: bool = true;

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
        _pull: T,
    ) -> impl Blocks<T, D> {
        self.0.rate_tangent_of_shear(at, gradients, volume)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let force = times(product(&at.gradient(), gradients), volume);
        (volume, force, force)
    }

    #[inline(always)]
    fn of_mean<T: Real>(&self, rate: T) -> [T; 2] {
        self.0.of_volume(rate)
    }
}

impl Slope<2> for MeanViscousSlope<'_> {
    const IS_SYMMETRIC: bool = false;
    const IS_MEAN: bool = true;

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
        gradients: &[[T; M]; N],
        volume: T,
        pull: T,
    ) -> impl Blocks<T, D> {
        self.0.tangent_under(at, rate, pull, gradients, volume)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
        gradients: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let force = times(product(&at.gradient(), gradients), volume);
        let motion = times(product(rate, gradients), volume);
        (self.0.rate_of_dilatation(at, rate) * volume, force, motion)
    }

    #[inline(always)]
    fn of_mean<T: Real>(&self, rate: T) -> [T; 2] {
        self.0.of_volume(rate)
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
            let nothing = [[zero; D]; N];
            let mut of_mean = OfMean { force: nothing, motion: nothing, share: zero };
            let mut pull = zero;
            if P::IS_MEAN {
                let (mut sum, mut volume) = (zero, zero);
                for q in 0..Q {
                    let point = abreast[block][q].lane(simd, part);
                    let mut gradients = [[[zero; D]; M]; K];
                    for k in 0..K {
                        gradients[k] = gradient(1, &x[k], &point.gradients);
                    }
                    let at = Deformation::new(point.frame, gradients[0]);
                    let (of_point, force, motion) =
                        slope.swelling(&at, &gradients, &point.gradients, point.volume);
                    sum += of_point;
                    volume += point.volume;
                    for a in 1..N {
                        for i in 0..D {
                            of_mean.force[a][i] += force[a][i];
                            of_mean.motion[a][i] += motion[a][i];
                        }
                    }
                }
                let [mean_pull, stiff] = slope.of_mean(sum / volume);
                (pull, of_mean.share) = (mean_pull, stiff / volume);
            }
            for q in 0..Q {
                let point = abreast[block][q].lane(simd, part);
                let mut gradients = [[[zero; D]; M]; K];
                for k in 0..K {
                    gradients[k] = gradient(1, &x[k], &point.gradients);
                }
                let at = Deformation::new(point.frame, gradients[0]);
                let blocks = slope.blocks(&at, &gradients, &point.gradients, point.volume, pull);
                for a in 1..N {
                    for b in if P::IS_SYMMETRIC { a } else { 1 }..N {
                        sum_up(simd, q == 0, &blocks.block(a, b), &mut sums[a][b]);
                    }
                }
            }
            if P::IS_MEAN {
                for a in 1..N {
                    for b in if P::IS_SYMMETRIC { a } else { 1 }..N {
                        sum_up(simd, false, &of_mean.block(a, b), &mut sums[a][b]);
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

/// Adds the blocks of all pairs of nodes of a cell to a matrix.
fn add_blocks<const N: usize, const D: usize>(
    entries: &[[u32; N]; N],
    rows: &mut Rows<'_, D>,
    blocks: &impl Blocks<f64, D>,
) {
    for (a, b) in pairs::<N>() {
        if let Some(sum) = rows.block_mut(entries[a][b]) {
            add(sum, &blocks.block(a, b));
        }
    }
}

fn add<const R: usize, const C: usize>(sum: &mut Matrix<f64, R, C>, part: &Matrix<f64, R, C>) {
    for (sum, part) in sum.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
        *sum += part;
    }
}
