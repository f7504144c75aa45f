//! Sign changes of a function of one variable, between two points where it is known.

/// Which changes of sign of an event function count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Both.
    #[default]
    Either,
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
}

impl Direction {
    /// Whether a root counts where the function rises (`slope` above 0), falls (below 0) or touches zero (0).
    pub(crate) fn counts(self, slope: f64) -> bool {
        match self {
            Self::Either => true,
            Self::Rising => slope >= 0.0,
            Self::Falling => slope <= 0.0,
        }
    }
}

/// A time and the value of the function there: infinite where nothing but its sign is known, and then the
/// search is a bisection.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) t: f64,
    pub(crate) g: f64,
}

/// Whether a function changes its sign, or becomes 0, from a value `a` that is not 0 to `b`.
pub(crate) fn crosses(a: f64, b: f64) -> bool {
    a != 0.0 && (b == 0.0 || (a < 0.0) != (b < 0.0))
}

/// Encloses the root between `near`, where g is not 0, and `far`, where it has crossed zero, by two points no
/// farther apart than `tolerance`, or than round-off if that is more.
pub(crate) fn bracket<E>(
    mut near: Point,
    mut far: Point,
    tolerance: f64,
    g: &mut impl FnMut(f64) -> Result<f64, E>,
) -> Result<(Point, Point), E> {
    let mut search = Illinois::new(tolerance);
    while let Some(t) = search.next(near, far) {
        let point = Point { t, g: g(t)? };
        *if crosses(near.g, point.g) { &mut far } else { &mut near } = point;
    }
    Ok((near, far))
}

/// Next trial point for a root between two points.
///
/// The Illinois algorithm, a secant method that keeps the root between its two points (M. Dowell, P. Jarratt,
/// BIT 11 (1971) 168-174), until it is [`BEHIND`] evaluations behind bisection, as at a jump; bisection from
/// then on.
pub(crate) struct Illinois {
    tolerance: f64,
    /// The last answer, and whether the one before has become the far point.
    asked: Option<f64>,
    far_moved: Option<bool>,
    /// Of the near value in the secant: the value of one point is halved where the other moves twice in a row.
    weight: f64,
    /// The largest distance from which a secant is tried, halved with each evaluation.
    widest: f64,
}

/// No search takes more evaluations than bisection and these.
const BEHIND: i32 = 12;

impl Illinois {
    /// A search until the points are no farther apart than `tolerance`, or than round-off.
    pub(crate) fn new(tolerance: f64) -> Self {
        let (asked, far_moved) = (None, None);
        Self { tolerance, asked, far_moved, weight: 1.0, widest: f64::INFINITY }
    }

    /// The time to look at next, or `None` at the end; one of the points is that at the last answer.
    pub(crate) fn next(&mut self, near: Point, far: Point) -> Option<f64> {
        let (width, latest) = (far.t - near.t, f64::max(near.t.abs(), far.t.abs()));
        let (distance, tolerance) = (width.abs(), self.tolerance.max(2.0 * f64::EPSILON * latest));
        if distance <= tolerance {
            return None;
        }
        let far_moved = self.asked.map(|t| t == far.t);
        self.weight = match far_moved {
            Some(true) if far_moved == self.far_moved => 0.5 * self.weight,
            Some(false) if far_moved == self.far_moved => 2.0 * self.weight,
            _ => 1.0,
        };
        self.far_moved = far_moved;
        self.widest = 0.5 * self.widest.min(2.0_f64.powi(BEHIND) * distance);
        let near_g = self.weight * near.g;
        let secant = near_g / (near_g - far.g);
        let is_known = near.g.is_finite() && far.g.is_finite();
        let part = if distance > self.widest || !is_known || secant.is_nan() {
            0.5
        } else {
            // a point at an end would tell nothing new
            let edge = 0.5 * tolerance / distance;
            secant.max(edge).min(1.0 - edge)
        };
        self.asked = Some(near.t + part * width);
        self.asked
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The points that enclose the root of g between times `a` and `b`, and how often g was evaluated.
    fn enclosed([a, b]: [f64; 2], tolerance: f64, g: impl Fn(f64) -> f64) -> ([Point; 2], usize) {
        let (mut count, [a, b]) = (0, [a, b].map(|t| Point { t, g: g(t) }));
        let mut counted = |t: f64| {
            count += 1;
            Ok::<_, ()>(g(t))
        };
        let (near, far) = bracket(a, b, tolerance, &mut counted).unwrap();
        assert!(crosses(near.g, far.g), "{near:?} {far:?}");
        ([near, far], count)
    }

    /// Both points lie within the tolerance of the root, or within round-off if asked for, in either direction
    /// of time. Secants without weights would be behind bisection: exp is convex over five of its lengths.
    #[test]
    fn a_root_is_enclosed_to_the_tolerance() {
        let root = std::f64::consts::LN_2;
        for (ends, most) in [([0.0, 5.0], 16), ([5.0, 0.0], 16), ([0.693, 0.694], 5)] {
            for (tolerance, off) in [(1e-14, 1e-14), (0.0, 1e-15)] {
                let (points, count) = enclosed(ends, tolerance, |t| t.exp() - 2.0);
                assert!(points.iter().all(|at| (at.t - root).abs() < off), "{points:?}");
                assert!(count <= most, "{count}");
            }
        }
    }

    /// A function that jumps across 0 is 0 nowhere: bisection ends at the jump, after 53 evaluations where
    /// nothing but signs is known, and no more than 12 more where values mislead.
    #[test]
    fn a_jump_is_enclosed_too() {
        for (below, above, most) in [(-1.0, 1e6, 65), (f64::NEG_INFINITY, f64::INFINITY, 53)] {
            let step = |t: f64| if t < 0.3 { below } else { above };
            let ([near, far], count) = enclosed([0.0, 1.0], 0.0, step);
            assert!(near.t < 0.3 && far.t >= 0.3 && far.t - near.t < 1e-15, "{near:?} {far:?}");
            assert!(count <= most, "{count}");
        }
    }
}
