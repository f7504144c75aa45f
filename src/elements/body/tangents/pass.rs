//! The loop over the tangents of cells, as many at once as the machine can.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::tangent::{OfVolume, TangentTerm};
use crate::base::lane::{Lane, Packed, SIDE_BY_SIDE};
use crate::base::sparse::Rows;
use crate::base::tensor::Real;
use crate::elements::body::elements::{ElementsOf, gradients};
use crate::elements::body::projection::{COEFFICIENTS, Projected};
use crate::elements::material::{Block, Blocks, Deformation};

/// The tangents of a run of cells of one law, compiled for each instruction set.
pub(super) struct Pass<
    'a,
    'r,
    P,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
    const K: usize,
> {
    pub(super) elements: &'a ElementsOf<N, M, D, Q>,
    pub(super) rows: &'a mut Rows<'r, D>,
    pub(super) cells: Range<usize>,
    pub(super) fields: [&'a [f64]; K],
    pub(super) slope: P,
}

/// The tangents of several cells. Blocks of symmetric ones below the diagonal are omitted.
type OfCells<const N: usize, const D: usize> = [[Block<Packed, D>; N]; N];

impl<
    P: TangentTerm<K>,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
    const K: usize,
> WithSimd for Pass<'_, '_, P, N, M, D, Q, K>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { elements, rows, cells, fields, slope } = self;
        let abreast = elements.abreast();
        let zero = Lane::splat(simd, 0.0);
        let mut sums = [[[[Packed([0.0; SIDE_BY_SIDE]); D]; D]; N]; N];
        for register in cells.start / S::F64_LANES..cells.end.div_ceil(S::F64_LANES) {
            let start = register * S::F64_LANES;
            let (block, part) = (start / SIDE_BY_SIDE, start % SIDE_BY_SIDE / S::F64_LANES);
            let mut x = [[[zero; D]; N]; K];
            for k in 0..K {
                x[k] = elements.gather(simd, start, fields[k]);
            }
            let mut of_volume = None;
            if const { ElementsOf::<N, M, D, Q>::CAN_LOCK } && slope.is_projected() {
                let begins = (simd, block, part);
                of_volume = Some(of_projected(elements, &slope, &x, begins));
            }
            for q in 0..Q {
                let mut pull = None;
                if let Some((projected, _)) = &of_volume {
                    let modes = elements.modes_of_lane(simd, block, part, q);
                    pull = Some(projected.at(modes.as_ref()));
                }
                let point = abreast[block][q].lane(simd, part);
                let fields = gradients(1, &x, &point.gradients);
                let at = Deformation::new(point.frame, fields[0]);
                let blocks = slope.blocks(&at, &fields, pull, &point.gradients, point.volume);
                for a in 1..N {
                    for b in if P::IS_SYMMETRIC { a } else { 1 }..N {
                        sum_up(simd, q == 0, &blocks.block(a, b), &mut sums[a][b]);
                    }
                }
            }
            if let Some((_, changes)) = &of_volume {
                for change in &changes[..elements.coefficients()] {
                    for a in 1..N {
                        for b in if P::IS_SYMMETRIC { a } else { 1 }..N {
                            sum_up(simd, false, &change.block(a, b), &mut sums[a][b]);
                        }
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

/// The `pull` of a projected dilatation, and the tangent terms of its coefficients for several cells.
#[inline(always)]
#[allow(clippy::type_complexity)]
fn of_projected<
    P: TangentTerm<K>,
    S: Simd,
    const N: usize,
    const M: usize,
    const D: usize,
    const Q: usize,
    const K: usize,
>(
    elements: &ElementsOf<N, M, D, Q>,
    slope: &P,
    x: &[[[Lane<S>; D]; N]; K],
    (simd, block, part): (S, usize, usize),
) -> (Projected<Lane<S>, M>, [OfVolume<Lane<S>, N, D>; COEFFICIENTS]) {
    let points = &elements.abreast()[block];
    let zero = Lane::splat(simd, 0.0);
    let nothing = [[zero; D]; N];
    let mut changes = [OfVolume { force: nothing, motion: nothing, share: zero }; COEFFICIENTS];
    let (mut sum, mut volume) = (Projected::new(zero), zero);
    for q in 0..Q {
        let point = points[q].lane(simd, part);
        let fields = gradients(1, x, &point.gradients);
        let at = Deformation::new(point.frame, fields[0]);
        let (of_point, force, motion) =
            slope.swelling(&at, &fields, &point.gradients, point.volume);
        let modes = elements.modes_of_lane(simd, block, part, q);
        sum.add(of_point, modes.as_ref());
        volume += point.volume;
        for a in 1..N {
            for i in 0..D {
                changes[0].force[a][i] += force[a][i];
                changes[0].motion[a][i] += motion[a][i];
            }
        }
        let Some(modes) = modes else { continue };
        for k in 0..M {
            for a in 1..N {
                for i in 0..D {
                    changes[k + 1].force[a][i] += force[a][i] * modes[k];
                    changes[k + 1].motion[a][i] += motion[a][i] * modes[k];
                }
            }
        }
    }
    let dilatation = sum.over(volume);
    if !elements.is_linear() {
        let [pull, stiff] = slope.of_volume(dilatation.mean);
        changes[0].share = stiff / volume;
        return (Projected::new(pull), changes);
    }
    let mut of_volume = Projected::new(zero);
    // int U'' p_k p_l dV
    let mut stiff = [[zero; COEFFICIENTS]; COEFFICIENTS];
    for q in 0..Q {
        let Some(modes) = elements.modes_of_lane(simd, block, part, q) else { continue };
        let [pull, by_volume] = slope.of_volume(dilatation.at(Some(&modes)));
        let of_point = Lane::load(simd, &points[q].volume.0, part);
        of_volume.add(pull * of_point, Some(&modes));
        let weight = by_volume * of_point;
        let mut values = [zero.constant(1.0); COEFFICIENTS];
        values[1..=M].copy_from_slice(&modes);
        for k in 0..M + 1 {
            for l in 0..M + 1 {
                stiff[k][l] += weight * values[k] * values[l];
            }
        }
    }
    let motions = changes;
    for k in 0..M + 1 {
        changes[k].motion = nothing;
        changes[k].share = zero.constant(1.0) / (volume * volume);
        for l in 0..M + 1 {
            for b in 1..N {
                for i in 0..D {
                    changes[k].motion[b][i] += motions[l].motion[b][i] * stiff[k][l];
                }
            }
        }
    }
    (of_volume.over(volume), changes)
}

/// Adds a block of several cells to their sum, or begins with it.
#[inline(always)]
fn sum_up<S: Simd, const D: usize>(
    simd: S,
    is_first: bool,
    block: &Block<Lane<S>, D>,
    sum: &mut Block<Packed, D>,
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
