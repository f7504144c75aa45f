//! The point of a segment or triangle that is nearest to another one.

use crate::base::vector::{difference, dot, norm};

/// Barycentric coordinates, by the `corners` of a point, segment or triangle, of its point that is nearest to
/// `x`.
pub(crate) fn closest(corners: &[[f64; 3]], x: &[f64; 3]) -> [f64; 3] {
    match corners {
        [_] => [1.0, 0.0, 0.0],
        [a, b] => {
            let along = difference(b, a);
            let part = dot(&difference(x, a), &along) / dot(&along, &along);
            let part = part.clamp(0.0, 1.0);
            [1.0 - part, part, 0.0]
        }
        [a, b, c, ..] => {
            let (ab, ac, ax) = (difference(b, a), difference(c, a), difference(x, a));
            let [bb, bc, cc] = [dot(&ab, &ab), dot(&ab, &ac), dot(&ac, &ac)];
            let [bx, cx] = [dot(&ab, &ax), dot(&ac, &ax)];
            let whole = bb * cc - bc * bc;
            let [of_b, of_c] = [(cc * bx - bc * cx) / whole, (bb * cx - bc * bx) / whole];
            if of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0 {
                return [1.0 - of_b - of_c, of_b, of_c];
            }
            // outside the triangle: the nearest point is on one of its edges
            let on = [[0, 1], [1, 2], [2, 0]].map(|[from, to]| {
                let part = closest(&[corners[from], corners[to]], x);
                let mut shares = [0.0; 3];
                (shares[from], shares[to]) = (part[0], part[1]);
                shares
            });
            let away = |shares: &[f64; 3]| {
                let there = |i: usize| (0..3).map(|k| shares[k] * corners[k][i]).sum();
                distance(&std::array::from_fn(there), x)
            };
            on.into_iter().min_by(|p, q| away(p).total_cmp(&away(q))).unwrap_or([1.0, 0.0, 0.0])
        }
        [] => [0.0; 3],
    }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    norm(&difference(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::noise;

    /// No point of a fine lattice on it is nearer.
    #[test]
    fn the_nearest_point_of_a_triangle() {
        let corners = [[0.0, 0.1, 0.0], [1.0, 0.0, 0.3], [0.2, 0.9, -0.2]];
        let at = |shares: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| (0..3).map(|k| shares[k] * corners[k][i]).sum())
        };
        const N: usize = 60;
        for x in noise(150, 3).chunks_exact(3) {
            let x: [f64; 3] = std::array::from_fn(|i| 1.5 * x[i]);
            let found = distance(&at(closest(&corners, &x)), &x);
            let lattice = (0..=N).flat_map(|i| (0..=N - i).map(move |j| [i, j, N - i - j]));
            let away = lattice.map(|parts| distance(&at(parts.map(|p| p as f64 / N as f64)), &x));
            let least = away.fold(f64::INFINITY, f64::min);
            // an edge of the lattice is 1/60 of 1.1
            assert!(found <= least + 1e-12 && least < found + 0.02, "{found} {least}");
        }
    }
}
