//! Points that fill the unit cube evenly: Latin hypercubes and Sobol's sequence.
//!
//! Points of Sobol's sequence are computed by their number and in double precision; crates for it iterate,
//! draw statistics libraries in, or have single precision, and the sequence is forty lines.

use std::hash::Hasher;

use siphasher::sip::SipHasher13;

/// For each point of a Latin hypercube the place along one axis: each of `count` equal parts of 0 to 1 has one.
///
/// It depends on the seed and on the name of the axis, not on the other axes.
pub(super) fn latin_hypercube(count: usize, seed: u64, axis: &str) -> Vec<f64> {
    let hash = |part: u64, number: u64| {
        let mut hasher = SipHasher13::new_with_keys(seed, part);
        hasher.write(axis.as_bytes());
        hasher.write(&number.to_le_bytes());
        hasher.finish()
    };
    let mut parts: Vec<u64> = (0..count as u64).collect();
    parts.sort_by_cached_key(|part| (hash(0, *part), *part));
    let within = |part: u64| (hash(1, part) >> 11) as f64 / 2_f64.powi(53);
    parts.into_iter().map(|part| (part as f64 + within(part)) / count as f64).collect()
}

/// Degree, inner coefficients (as bits) and first direction numbers of the primitive polynomials of the axes after
/// the first one: the table `new-joe-kuo-6` of S. Joe and F. Y. Kuo, SIAM Journal on Scientific Computing 30
/// (2008) 2635-2654.
const POLYNOMIALS: [(usize, u64, &[u64]); 20] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// Most axes that a point of Sobol's sequence has.
pub(crate) const MOST_AXES: usize = POLYNOMIALS.len() + 1;

/// Binary digits of the places: those of a mantissa.
const DIGITS: usize = 52;

/// The place along an axis (from 0) of a point of Sobol's sequence (from 0), without those before it.
///
/// The points come in the order of the Gray code, as those of the authors of the table do. (Points of any number, and
/// in double precision: the crates that there are iterate, or have single precision.)
pub(crate) fn sobol(number: u64, axis: usize) -> f64 {
    let gray = number ^ (number >> 1);
    let directions = directions(axis);
    let digits = (0..DIGITS).filter(|digit| gray >> digit & 1 == 1);
    let place = digits.fold(0, |place, digit| place ^ directions[digit]);
    place as f64 / 2_f64.powi(DIGITS as i32)
}

/// Direction numbers of an axis, times 2^[`DIGITS`].
fn directions(axis: usize) -> [u64; DIGITS] {
    let Some((degree, inner, first)) = axis.checked_sub(1).map(|at| POLYNOMIALS[at]) else {
        return std::array::from_fn(|digit| 1 << (DIGITS - 1 - digit));
    };
    let mut directions = [0; DIGITS];
    for digit in 0..DIGITS {
        directions[digit] = match first.get(digit) {
            Some(start) => start << (DIGITS - 1 - digit),
            None => {
                let last = directions[digit - degree];
                let taken = (1..degree).filter(|k| inner >> (degree - 1 - k) & 1 == 1);
                taken.fold(last ^ (last >> degree), |sum, k| sum ^ directions[digit - k])
            }
        };
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first ten points in three dimensions, as the authors of the table print them.
    #[test]
    fn first_points_of_sobol_are_those_that_are_published() {
        let published = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
            [0.1875, 0.3125, 0.9375],
            [0.6875, 0.8125, 0.4375],
        ];
        for (number, point) in published.iter().enumerate() {
            assert_eq!([0, 1, 2].map(|axis| sobol(number as u64, axis)), *point, "{number}");
        }
    }

    /// On each axis the first 2^k points lie in one of 2^k equal parts each.
    #[test]
    fn each_axis_of_sobol_is_filled_evenly() {
        for axis in 0..MOST_AXES {
            let mut parts: Vec<u64> = (0..256).map(|k| (256.0 * sobol(k, axis)) as u64).collect();
            parts.sort_unstable();
            assert!((0..256).eq(parts), "{axis}");
        }
    }

    #[test]
    fn each_part_of_a_latin_hypercube_has_one_point() {
        let places = latin_hypercube(1000, 3, "young");
        let mut parts: Vec<usize> = places.iter().map(|x| (1000.0 * x) as usize).collect();
        assert!(!parts.is_sorted());
        parts.sort_unstable();
        assert!((0..1000).eq(parts));
        let other = |seed, axis| latin_hypercube(1000, seed, axis);
        assert_eq!(places, other(3, "young"));
        assert!(places != other(4, "young") && places != other(3, "density"));
        // two axes are not correlated: random points have 1/sqrt(1000)
        let product = |(a, b): (&f64, &f64)| (a - 0.5) * (b - 0.5);
        let covariance: f64 = places.iter().zip(&other(3, "density")).map(product).sum();
        assert!(covariance.abs() * 12.0 / 1000.0 < 0.1, "{covariance}");
    }
}
