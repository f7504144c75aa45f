//! Roots and minima of a function of one variable, between two points where it is known.

/// A time and the value of the function there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) t: f64,
    pub(super) g: f64,
}

/// Whether a function changes its sign, or becomes 0, from a value `a` that is not 0 to `b`.
pub(super) fn crosses(a: f64, b: f64) -> bool {
    a != 0.0 && (b == 0.0 || (a < 0.0) != (b < 0.0))
}

/// Encloses the root between `near`, where g is not 0, and `far`, where it has crossed zero, by two points no
/// farther apart than `tolerance`.
///
/// The Illinois algorithm, a secant method that keeps the root between its two points (M. Dowell, P. Jarratt,
/// BIT 11 (1971) 168-174), with a bisection where three of its steps gain less than one, as at a jump.
pub(super) fn bracket<E>(
    mut near: Point,
    mut far: Point,
    tolerance: f64,
    g: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<(Point, Point), E> {
    // the values that the secant uses; that of one end is halved where the other end moves twice in a row
    let (mut near_g, mut far_g) = (near.g, far.g);
    let mut far_moved = None;
    let (mut count, mut goal) = (0, 0.5 * (far.t - near.t).abs());
    while (far.t - near.t).abs() > tolerance {
        let width = far.t - near.t;
        let edge = 0.5 * tolerance.copysign(width);
        let part = near_g / (near_g - far_g);
        let t = if count >= 3 {
            near.t + 0.5 * width
        } else {
            // a point at an end would tell nothing new
            let (low, high) = (edge / width, 1.0 - edge / width);
            near.t + part.max(low).min(high) * width
        };
        if t == near.t || t == far.t {
            break;
        }
        let point = Point { t, g: g(t)? };
        let far_moves = crosses(near.g, point.g);
        let again = if far_moved == Some(far_moves) { 0.5 } else { 1.0 };
        if far_moves {
            (far, far_g, near_g) = (point, point.g, again * near_g);
        } else {
            (near, near_g, far_g) = (point, point.g, again * far_g);
        }
        far_moved = Some(far_moves);
        count += 1;
        if (far.t - near.t).abs() <= goal {
            (count, goal) = (if count > 3 { 2 } else { 0 }, 0.5 * (far.t - near.t).abs());
        }
    }
    Ok((near, far))
}

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

    /// cos has its root at pi/2: both points of the bracket lie within the tolerance of it, in either
    /// direction of time.
    #[test]
    fn a_root_is_enclosed_to_the_tolerance() {
        let root = std::f64::consts::FRAC_PI_2;
        for (a, b) in [(0.0, 2.0), (2.0, 0.0), (1.570, 1.572)] {
            let mut count = 0;
            let mut g = |t: f64| -> Result<f64, ()> {
                count += 1;
                Ok(t.cos())
            };
            let (near, far) =
                bracket(point(a, f64::cos), point(b, f64::cos), 1e-14, &mut g).unwrap();
            assert!(
                (near.t - root).abs() < 2e-14 && (far.t - root).abs() < 2e-14,
                "{near:?} {far:?}"
            );
            assert!(crosses(near.g, far.g));
            assert!(count < 15, "{count}");
        }
    }

    /// A function that jumps across 0 is 0 nowhere: bisection ends at the jump.
    #[test]
    fn a_jump_is_enclosed_too() {
        let step = |t: f64| if t < 0.3 { -1.0 } else { 1e6 };
        let (near, far) =
            bracket(point(0.0, step), point(1.0, step), 1e-14, &mut |t| Ok::<_, ()>(step(t)))
                .unwrap();
        assert!(near.t < 0.3 && far.t >= 0.3 && far.t - near.t < 1e-14, "{near:?} {far:?}");
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
