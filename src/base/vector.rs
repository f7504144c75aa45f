//! Products and norms of vectors.

/// Largest absolute value of a component; 0 if there are none.
pub(crate) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

/// The absolute value of a number, or 1 for zero: the scale of its changes.
pub(crate) fn size_or_one(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.abs() }
}

/// a . b, summed up in interleaved parts, for speed.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// Length of a vector.
pub(crate) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// A vector of up to three components, those beyond its own 0.
#[cfg(feature = "bodies")]
pub(crate) fn padded(x: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}

/// a - b
pub(crate) fn difference(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// a x b
pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The numbers of the two axes of space other than this one.
pub(crate) fn axes_across(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// Numbers in ascending order, each once.
#[cfg(feature = "bodies")]
pub(crate) fn distinct(numbers: impl IntoIterator<Item = usize>) -> Vec<usize> {
    let mut all: Vec<usize> = numbers.into_iter().collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Pseudorandom numbers between -1 and 1, the same in all runs.
pub(crate) fn noise(length: usize, seed: usize) -> Vec<f64> {
    let number =
        |i: usize| (12.9898 * (i + 1 + 7919 * seed) as f64).sin().mul_add(43.758, 0.3).sin();
    (0..length).map(number).collect()
}
