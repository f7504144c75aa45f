//! Where a pair of edges acts: all of it where they cross, nothing of it at their ends and where they are parallel.

/// A function F of the places xi on two edges, from 0 to 1, and of c = |a x b|^2 (m^4) of their vectors a and b:
///
/// ```text
/// F = A W(xi_0) W(xi_1) m(c/e),   W(s) = m(4 s), W(1 - s) = W(s),   m(t) = t^2 (3 - 2 t) up to t = 1, then 1
/// ```
///
/// W and its slope are 0 at the ends, where the nearest places leave the edges: forces are continuous there. Where edges
/// become parallel at a distance d, their nearest places run along them by d/sqrt(c) for each angle that they turn, and
/// the factor m, which falls as c^2, keeps the forces continuous. That of Li et al. (*Incremental potential contact*,
/// 2020), which falls as c, is for distances between whole edges, whose slopes stay finite.
pub(super) struct Window {
    /// F (m^2)
    pub(super) value: f64,
    /// Its first and second derivatives by xi_0, xi_1 and c.
    pub(super) slopes: [f64; 3],
    pub(super) bends: [[f64; 3]; 3],
}

impl Window {
    /// For the `places` xi, and `crossed` = c/e with `unit` = e (m^4); the area A (m^2).
    pub(super) fn new(places: [f64; 2], [crossed, unit]: [f64; 2], area: f64) -> Self {
        let [p, q] = places.map(along);
        let m = ramp(crossed, unit);
        // derivatives of these orders by xi_0, xi_1, c
        let of = |[i, j, k]: [usize; 3]| area * p[i] * q[j] * m[k];
        let order = |a: usize| std::array::from_fn(|axis| usize::from(axis == a));
        let both = |a: usize, b: usize| {
            std::array::from_fn(|axis| usize::from(axis == a) + usize::from(axis == b))
        };
        Self {
            value: of([0; 3]),
            slopes: std::array::from_fn(|a| of(order(a))),
            bends: std::array::from_fn(|a| std::array::from_fn(|b| of(both(a, b)))),
        }
    }
}

/// The part of an edge at each end along which W grows.
const RAMP: f64 = 0.25;

/// W(s), W'(s) and W''(s).
fn along(s: f64) -> [f64; 3] {
    let [value, slope, bend] = ramp(s.min(1.0 - s) / RAMP, RAMP);
    [value, if s < 0.5 { slope } else { -slope }, bend]
}

/// m(t) and its derivatives by t `unit`.
fn ramp(t: f64, unit: f64) -> [f64; 3] {
    if t >= 1.0 {
        return [1.0, 0.0, 0.0];
    }
    [t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) / unit, 6.0 * (1.0 - 2.0 * t) / (unit * unit)]
}
