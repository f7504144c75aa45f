//! The energy of a change of volume of rubber, to all digits where the change is small.

/// U = (kappa/4) (J^2 - 1 - 2 ln J), U' and U'' by g = J - 1, `bulk` being kappa (Pa).
#[inline]
pub(super) fn swollen(bulk: f64, dilatation: f64) -> [f64; 3] {
    let swelling = dilatation * (dilatation + 2.0);
    let share = 1.0 / (dilatation + 1.0);
    let half = 0.5 * bulk;
    [0.5 * half * less_logarithm(swelling), swelling * share * half, (share * share + 1.0) * half]
}

/// x - ln(1 + x)
pub(super) fn less_logarithm(x: f64) -> f64 {
    // ln(1 + x) = 2 artanh z
    let z = x / (2.0 + x);
    if z.abs() > 0.1 {
        return x - x.ln_1p();
    }
    let square = z * z;
    let rest = (0..8).rev().fold(0.0, |sum, k| sum * square + 1.0 / f64::from(2 * k + 3));
    x * z - 2.0 * z * square * rest
}

/// exp(x) - 1 - x
pub(super) fn less_exponential(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x.exp_m1() - x;
    }
    // x^2/2 (1 + x/3 (1 + x/4 (...)))
    let rest = (3..=16).rev().fold(1.0, |rest, k| 1.0 + x / f64::from(k) * rest);
    0.5 * x * x * rest
}
