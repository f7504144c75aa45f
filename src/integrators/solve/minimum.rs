//! The minimum of |g|, g a function of one variable, between two points where it is known.

use crate::base::root::{Point, crosses};

/// The point between `a` and `b` where |g| is smallest.
///
/// The search ends early as soon as g crosses zero and, unless it has to be `thorough`, if the parabola
/// through the first points stays far from zero.
///
/// Golden section, for a |g| with one minimum there.
pub(super) fn minimum<E>(
    a: Point,
    b: Point,
    thorough: bool,
    g: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<Point, E> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (a.t, b.t);
    let place = |part: f64, low: f64, high: f64| low + part * (high - low);
    let mut left = place(1.0 - GOLDEN, low, high);
    let mut right = place(GOLDEN, low, high);
    let mut at_left = Point { t: left, g: g(left)? };
    let mut at_right = Point { t: right, g: g(right)? };
    let lower = |a: Point, b: Point| if a.g.abs() < b.g.abs() { a } else { b };
    let is_far = |from: f64| from.abs() > 0.5 * at_left.g.abs().min(at_right.g.abs());
    if !thorough && !crosses(a.g, at_left.g) && !crosses(a.g, at_right.g) {
        let lowest = lowest_of_parabola([a, at_left, at_right]);
        if !crosses(a.g, lowest) && is_far(lowest) {
            return Ok(lower(at_left, at_right));
        }
    }
    // 0.618^36 of the interval: 3e-8, the square root of rounding, to which a minimum can be located
    for _ in 0..36 {
        for point in [at_left, at_right] {
            if crosses(a.g, point.g) {
                return Ok(point);
            }
        }
        if at_left.g.abs() < at_right.g.abs() {
            (high, right, at_right) = (right, left, at_left);
            left = place(1.0 - GOLDEN, low, high);
            at_left = Point { t: left, g: g(left)? };
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = place(GOLDEN, low, high);
            at_right = Point { t: right, g: g(right)? };
        }
    }
    Ok(lower(at_left, at_right))
}

/// The value at the vertex of the parabola through three points; that of the last one if they lie on a line.
fn lowest_of_parabola([a, b, c]: [Point; 3]) -> f64 {
    let slope = |p: Point, q: Point| (q.g - p.g) / (q.t - p.t);
    let curvature = (slope(b, c) - slope(a, b)) / (c.t - a.t);
    let tangent = slope(b, c) + curvature * (c.t - b.t);
    if curvature == 0.0 { c.g } else { c.g - 0.25 * tangent * tangent / curvature }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(t: f64, g: impl Fn(f64) -> f64) -> Point {
        Point { t, g: g(t) }
    }

    /// (t - 0.4)^2 + c has its minimum at 0.4, which a search finds to the square root of rounding; it ends
    /// early below zero, and where c is far from zero.
    #[test]
    fn a_minimum_is_found_as_far_as_it_matters() {
        let search = |c: f64, thorough: bool| {
            let g = |t: f64| (t - 0.4) * (t - 0.4) + c;
            let mut count = 0;
            let mut counted = |t: f64| {
                count += 1;
                Ok::<_, ()>(g(t))
            };
            let lowest = minimum(point(0.0, g), point(1.0, g), thorough, &mut counted).unwrap();
            (lowest, count)
        };
        let (lowest, _) = search(1e-9, true);
        assert!((lowest.t - 0.4).abs() < 1e-7 && lowest.g < 1.001e-9, "{lowest:?}");
        let (lowest, count) = search(-1e-3, false);
        assert!(lowest.g < 0.0 && count < 10, "{lowest:?} {count}");
        let (_, count) = search(1.0, false);
        assert_eq!(count, 2);
    }
}
