//! Formulas over long vectors, for as many components at once as a register of the machine holds.
//!
//! The loop is compiled for each kind of machine (`pulp`). On all of them a sum is made of [`SIDE_BY_SIDE`]
//! interleaved partial sums, so that results are the same to the last bit. A call costs some nanoseconds more
//! than a plain loop.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use pulp::{Simd, WithSimd};

use crate::base::lane::{Lane, SIDE_BY_SIDE};
use crate::base::tensor::Real;

/// Runs a loop with the widest registers that this machine has.
///
/// It is compiled for each kind of machine; by a compiler that is told of AVX2 (`-C target-cpu=x86-64-v3` or `native`), and not asked for
/// kernels for AVX-512, for that one alone.
pub(crate) fn at_once<O: WithSimd>(work: O) -> O::Output {
    #[cfg(any(
        feature = "avx512",
        not(all(target_feature = "avx2", target_feature = "bmi2", target_feature = "fma"))
    ))]
    return pulp::Arch::new().dispatch(work);
    #[cfg(all(
        not(feature = "avx512"),
        target_feature = "avx2",
        target_feature = "bmi2",
        target_feature = "fma"
    ))]
    match pulp::x86::V3::try_new() {
        Some(simd) => Simd::vectorize(simd, work),
        None => unreachable!("what is compiled for AVX2 runs where it is"),
    }
}

/// A formula for each component by itself: it gives new numbers of `O` vectors, and terms of `P` sums.
pub(crate) trait Formula<const I: usize, const O: usize, const P: usize> {
    /// The new numbers and the terms, from the numbers of `I` other vectors and the `old` ones. It has to be
    /// inlined.
    fn at<T: Real>(&self, x: [T; I], old: [T; O]) -> ([T; O], [T; P]);
}

/// Applies `formula` to the vectors `from` and writes the vectors `to`, all of one length. Returns the sums.
pub(crate) fn each<const I: usize, const O: usize, const P: usize>(
    formula: impl Formula<I, O, P>,
    from: [&[f64]; I],
    to: [&mut [f64]; O],
) -> [f64; P] {
    at_once(Pass::new(formula, from, to))
}

/// y += x
pub(crate) fn add(x: &[f64], y: &mut [f64]) {
    each(Sum, [x], [y]);
}

struct Sum;

impl Formula<1, 1, 0> for Sum {
    #[inline(always)]
    fn at<T: Real>(&self, [x]: [T; 1], [y]: [T; 1]) -> ([T; 1], [T; 0]) {
        ([y + x], [])
    }
}

/// y += factor x
pub(crate) fn add_multiple(factor: f64, x: &[f64], y: &mut [f64]) {
    each(Multiple(factor), [x], [y]);
}

struct Multiple(f64);

impl Formula<1, 1, 0> for Multiple {
    #[inline(always)]
    fn at<T: Real>(&self, [x]: [T; 1], [y]: [T; 1]) -> ([T; 1], [T; 0]) {
        ([y + x * self.0], [])
    }
}

type Chunks = [[f64; SIDE_BY_SIDE]];

/// The loop over vectors: whole chunks, and the components left over.
struct Pass<'a, F, const I: usize, const O: usize, const P: usize> {
    formula: F,
    from: [(&'a Chunks, &'a [f64]); I],
    to: [(&'a mut Chunks, &'a mut [f64]); O],
}

impl<'a, F, const I: usize, const O: usize, const P: usize> Pass<'a, F, I, O, P> {
    fn new(formula: F, from: [&'a [f64]; I], to: [&'a mut [f64]; O]) -> Self {
        let (from, to) = (from.map(<[f64]>::as_chunks), to.map(<[f64]>::as_chunks_mut));
        Self { formula, from, to }
    }
}

impl<F: Formula<I, O, P>, const I: usize, const O: usize, const P: usize> WithSimd
    for Pass<'_, F, I, O, P>
{
    type Output = [f64; P];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; P] {
        let Self { formula, from, to } = self;
        let zero = Lane::splat(simd, 0.0);
        // one register of partial sums for each part of a chunk, of which there are `SIDE_BY_SIDE` at most
        let mut parts = [[zero; SIDE_BY_SIDE]; P];
        let lengths = from.iter().map(|x| x.0.len()).chain(to.iter().map(|y| y.0.len()));
        for chunk in 0..lengths.min().unwrap_or(0) {
            for part in 0..SIDE_BY_SIDE / S::F64_LANES {
                let (mut x, mut old) = ([zero; I], [zero; O]);
                for i in 0..I {
                    x[i] = Lane::load(simd, &from[i].0[chunk], part);
                }
                for o in 0..O {
                    old[o] = Lane::load(simd, &to[o].0[chunk], part);
                }
                let (new, terms) = formula.at(x, old);
                for o in 0..O {
                    new[o].store(&mut to[o].0[chunk], part);
                }
                for p in 0..P {
                    parts[p][part] += terms[p];
                }
            }
        }
        let mut rest = [0.0; P];
        let lengths = from.iter().map(|x| x.1.len()).chain(to.iter().map(|y| y.1.len()));
        for k in 0..lengths.min().unwrap_or(0) {
            let (mut x, mut old) = ([0.0; I], [0.0; O]);
            for i in 0..I {
                x[i] = from[i].1[k];
            }
            for o in 0..O {
                old[o] = to[o].1[k];
            }
            let (new, terms) = formula.at(x, old);
            for o in 0..O {
                to[o].1[k] = new[o];
            }
            for p in 0..P {
                rest[p] += terms[p];
            }
        }
        let mut sums = rest;
        for p in 0..P {
            let mut numbers = [0.0; SIDE_BY_SIDE];
            for part in 0..SIDE_BY_SIDE / S::F64_LANES {
                parts[p][part].store(&mut numbers, part);
            }
            sums[p] += numbers.iter().sum::<f64>();
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;
    use crate::base::vector::noise;

    /// y = a x + y, with the sums of x y and of x.
    struct Line(f64);

    impl Formula<1, 1, 2> for Line {
        #[inline(always)]
        fn at<T: Real>(&self, [x]: [T; 1], [y]: [T; 1]) -> ([T; 1], [T; 2]) {
            ([x * self.0 + y], [x * y, x])
        }
    }

    #[test]
    fn every_component_is_met_once() {
        for length in 0..40 {
            let (x, before) = (noise(length, 1), noise(length, 2));
            let [mut y, mut narrow] = [before.clone(), before.clone()];
            let sums = each(Line(0.7), [&x], [&mut y]);
            let narrow_sums = Pass::new(Line(0.7), [&x], [&mut narrow]).with_simd(Scalar);
            assert_eq!((&y, sums), (&narrow, narrow_sums), "on another machine");
            let mut expected = [0.0; 2];
            for k in 0..length {
                assert_eq!(y[k], x[k] * 0.7 + before[k], "{k} of {length}");
                expected[0] += x[k] * before[k];
                expected[1] += x[k];
            }
            for (sum, expected) in sums.into_iter().zip(expected) {
                // the same sum of at most 40 numbers below 1, in another order
                assert!((sum - expected).abs() <= 40.0 * f64::EPSILON, "{sum}, {expected}");
            }
        }
    }
}
