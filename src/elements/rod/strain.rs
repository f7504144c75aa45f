//! Strains of an element of a rod and the forces that do work along them.
//!
//! A node has a position x and two directors d_1, d_2, the axes of its cross section. With the polar decomposition of the directors,
//! (d_1 d_2) = (r_1 r_2) U and r_3 = r_1 x r_2, its frame is the rotation R = (r_1 r_2 r_3). Between two nodes at the distance l (undeformed)
//! the strains are those of the one helix that joins both frames, which is exact where strains are constant:
//!
//! ```text
//! phi = log(R_1^T R_2),   kappa = phi / l,   gamma = T(phi)^-1 Rm^T (x_2 - x_1) / l,
//! ```
//!
//! with the frame Rm = R_1 exp(phi / 2) in the middle and T(phi) = int exp(s phi) ds over s from -1/2 to 1/2. kappa are the curvatures about
//! r_1, r_2 and the twist, gamma the two shears and the stretch (Simo and Reissner; Sonneville, Cardona, Bruls, CMAME 268 (2014) 451-474).
//! They do not change as the element moves as a rigid body, and depend on no path.
//!
//! A rotation is at most a half turn between the nodes of one element. All formulas hold for `f64`, and for dual numbers, of which tangents
//! are made.

use num_dual::DualNum;

/// A number: `f64`, or one with its derivatives.
pub(super) trait Number: DualNum<Primitive = f64> + Copy {}
impl<T: DualNum<Primitive = f64> + Copy> Number for T {}

/// A vector in space.
pub(super) type Vector<T> = [T; 3];

/// A node: its position (m) and its directors, or their velocities, or the forces along them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Section<T> {
    pub(super) x: Vector<T>,
    pub(super) d: [Vector<T>; 2],
}

impl<T: Number> Section<T> {
    pub(super) fn zero() -> Self {
        let zero = [T::from(0.0); 3];
        Self { x: zero, d: [zero; 2] }
    }
}

/// The strains of an element, or the stresses along them: shears and stretch, curvatures and twist.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strains<T> {
    pub(super) gamma: Vector<T>,
    pub(super) kappa: Vector<T>,
}

pub(super) fn dot<T: Number>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn plus<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus<T: Number>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times<T: Number>(a: Vector<T>, by: T) -> Vector<T> {
    a.map(|a| a * by)
}

/// The frame of a node, column by column, and its stretch U with the inverse: U_11, U_12, U_22.
pub(super) struct Frame<T> {
    r: [Vector<T>; 3],
    stretch: [T; 3],
    inverse: [T; 3],
}

impl<T: Number> Frame<T> {
    pub(super) fn of(d: [Vector<T>; 2]) -> Self {
        let [g11, g12, g22] = [dot(d[0], d[0]), dot(d[0], d[1]), dot(d[1], d[1])];
        let root = (g11 * g22 - g12 * g12).sqrt();
        let trace = (g11 + g22 + root + root).sqrt();
        let stretch = [(g11 + root) / trace, g12 / trace, (g22 + root) / trace];
        let inverse = [stretch[2] / root, -stretch[1] / root, stretch[0] / root];
        let first = plus(times(d[0], inverse[0]), times(d[1], inverse[1]));
        let second = plus(times(d[0], inverse[1]), times(d[1], inverse[2]));
        Self { r: [first, second, cross(first, second)], stretch, inverse }
    }

    /// R a
    pub(super) fn to_space(&self, a: Vector<T>) -> Vector<T> {
        let [first, second, third] = &self.r;
        plus(plus(times(*first, a[0]), times(*second, a[1])), times(*third, a[2]))
    }

    /// R^T a
    pub(super) fn to_frame(&self, a: Vector<T>) -> Vector<T> {
        self.r.map(|r| dot(r, a))
    }

    /// The angular velocity, in the frame, as the directors have the velocities `d`.
    pub(super) fn spin(&self, d: [Vector<T>; 2]) -> Vector<T> {
        let [first, second, third] = self.r;
        let [a, b, c] = self.inverse;
        let (out, other) = (dot(third, d[0]), dot(third, d[1]));
        let about = dot(second, d[0]) - dot(first, d[1]);
        [out * b + other * c, -(out * a + other * b), about / (self.stretch[0] + self.stretch[2])]
    }

    /// The forces along the directors that do the work of a moment `m`, in the frame.
    pub(super) fn forces(&self, m: Vector<T>) -> [Vector<T>; 2] {
        let [first, second, third] = self.r;
        let [a, b, c] = self.inverse;
        let twist = m[2] / (self.stretch[0] + self.stretch[2]);
        [
            plus(times(third, m[0] * b - m[1] * a), times(second, twist)),
            minus(times(third, m[0] * c - m[1] * b), times(first, twist)),
        ]
    }
}

/// Functions of the angle theta = |phi|, with a = theta / 2: they are series where it is small.
struct Angle<T> {
    phi: Vector<T>,
    /// sin a / a, (1 - cos a) / a^2, (a - sin a) / a^3
    along: [T; 3],
    /// (1 - a cot a) / theta^2
    bent: T,
    /// a / sin a and (1 - a / sin a) / theta^2, with their derivatives by theta^2
    chord: [T; 2],
    slack: [T; 2],
}

/// Angles whose square is below this have series, of which the next term is round-off.
const SMALL: f64 = 1e-2;

/// The sum of c_k x^k.
fn series<T: Number>(x: T, c: [f64; 5]) -> T {
    c.into_iter().rev().fold(T::from(0.0), |sum, c| sum * x + c)
}

impl<T: Number> Angle<T> {
    /// That of the unit quaternion (`real`, `imaginary`) of a rotation, whose real part is above 0.
    fn of(real: T, imaginary: Vector<T>) -> Self {
        let sine2 = dot(imaginary, imaginary);
        if sine2.re() < SMALL / 4.0 {
            // 2 asin(s) / s
            let c = [2.0, 1.0 / 3.0, 3.0 / 20.0, 5.0 / 56.0, 35.0 / 576.0];
            let phi = times(imaginary, series(sine2, c) + sine2.powi(5) * (63.0 / 1408.0));
            let x = dot(phi, phi);
            return Self {
                phi,
                along: [
                    series(
                        x,
                        [1.0, -1.0 / 24.0, 1.0 / 1920.0, -1.0 / 322_560.0, 1.0 / 92_897_280.0],
                    ),
                    series(x, [0.5, -1.0 / 96.0, 1.0 / 11_520.0, -1.0 / 2_580_480.0, 0.0]),
                    series(x, [1.0 / 6.0, -1.0 / 480.0, 1.0 / 80_640.0, -1.0 / 23_224_320.0, 0.0]),
                ],
                bent: series(
                    x,
                    [
                        1.0 / 12.0,
                        1.0 / 720.0,
                        1.0 / 30_240.0,
                        1.0 / 1_209_600.0,
                        1.0 / 47_900_160.0,
                    ],
                ),
                chord: [
                    series(
                        x,
                        [1.0, 1.0 / 24.0, 7.0 / 5760.0, 31.0 / 967_680.0, 127.0 / 154_828_800.0],
                    ),
                    series(
                        x,
                        [1.0 / 24.0, 7.0 / 2880.0, 31.0 / 322_560.0, 127.0 / 38_707_200.0, 0.0],
                    ),
                ],
                slack: [
                    -series(
                        x,
                        [1.0 / 24.0, 7.0 / 5760.0, 31.0 / 967_680.0, 127.0 / 154_828_800.0, 0.0],
                    ),
                    -series(x, [7.0 / 5760.0, 31.0 / 483_840.0, 127.0 / 51_609_600.0, 0.0, 0.0]),
                ],
            };
        }
        let sine = sine2.sqrt();
        let a = sine.atan2(real);
        let (a2, x) = (a * a, a * a * 4.0);
        let chord = a / sine;
        let bent = (-(a * real / sine) + 1.0) / x;
        // d(a / sin a) / da = (1 - a cot a) / sin a, and d(theta^2) = 8 a da
        let slope = (-(a * real / sine) + 1.0) / sine / (a * 8.0);
        let slack = (-chord + 1.0) / x;
        Self {
            phi: times(imaginary, chord + chord),
            along: [sine / a, (-real + 1.0) / a2, (a - sine) / (a2 * a)],
            bent,
            chord: [chord, slope],
            slack: [slack, -(slope + slack) / x],
        }
    }

    /// phi x (phi x v)
    fn twice(&self, v: Vector<T>) -> Vector<T> {
        cross(self.phi, cross(self.phi, v))
    }

    /// J(sign phi)^-1 v, with the left Jacobian J of the rotation.
    fn inverse_left(&self, v: Vector<T>, sign: f64) -> Vector<T> {
        let turned = times(cross(self.phi, v), T::from(-0.5 * sign));
        plus(plus(v, turned), times(self.twice(v), self.bent))
    }

    /// J(sign phi / 2) v
    fn left_of_half(&self, v: Vector<T>, sign: f64) -> Vector<T> {
        let [even, odd, rest] = self.along;
        let half = times(self.phi, T::from(0.5));
        let turned = times(cross(half, v), odd * sign);
        plus(plus(times(v, even), turned), times(half, rest * dot(half, v)))
    }
}

/// An element in a state.
pub(super) struct Deformed<T> {
    length: f64,
    ends: [Frame<T>; 2],
    middle: Frame<T>,
    /// From the middle to the first node.
    angle: Angle<T>,
    /// Rm^T (x_2 - x_1) / l
    y: Vector<T>,
}

impl<T: Number> Deformed<T> {
    /// The element of an undeformed `length` (m) between two nodes.
    pub(super) fn new(length: f64, nodes: [Section<T>; 2]) -> Self {
        let ends = nodes.map(|node| Frame::of(node.d));
        let [first, second] = &ends;
        let turned = second.r.map(|r| first.to_frame(r));
        let trace = turned[0][0] + turned[1][1] + turned[2][2];
        let real = (trace + 1.0).sqrt() * 0.5;
        let scale = (real * 4.0).recip();
        let imaginary = [
            (turned[1][2] - turned[2][1]) * scale,
            (turned[2][0] - turned[0][2]) * scale,
            (turned[0][1] - turned[1][0]) * scale,
        ];
        // the quaternion of half of the angle
        let norm = ((real + 1.0) * 2.0).sqrt().recip();
        let half = ((real + 1.0) * norm, times(imaginary, norm));
        let to_middle = |v: Vector<T>| {
            let once = cross(half.1, v);
            plus(plus(v, times(once, half.0 + half.0)), times(cross(half.1, once), T::from(2.0)))
        };
        let unit = |i: usize| std::array::from_fn(|k| T::from(f64::from(u8::from(i == k))));
        let middle = [0, 1, 2].map(|i| first.to_space(to_middle(unit(i))));
        let one = || [T::from(1.0), T::from(0.0), T::from(1.0)];
        let middle = Frame { r: middle, stretch: one(), inverse: one() };
        let span = times(minus(nodes[1].x, nodes[0].x), T::from(1.0 / length));
        let y = middle.to_frame(span);
        Self { length, angle: Angle::of(real, imaginary), ends, middle, y }
    }

    /// Whether both sections are whole, and less than half a turn apart.
    pub(super) fn is_within_half_a_turn(&self) -> bool {
        self.y.iter().all(|y| y.re().is_finite())
    }

    /// Its strains.
    pub(super) fn strains(&self) -> Strains<T> {
        let Angle { phi, chord, slack, .. } = &self.angle;
        let gamma = plus(times(self.y, chord[0]), times(*phi, slack[0] * dot(*phi, self.y)));
        Strains { gamma, kappa: times(*phi, T::from(1.0 / self.length)) }
    }

    /// The rates of the strains (1/s), as the nodes have these velocities.
    pub(super) fn rates(&self, nodes: [Section<T>; 2]) -> Strains<T> {
        let [first, second] = [0, 1].map(|end| self.ends[end].spin(nodes[end].d));
        let angle = &self.angle;
        let (phi, y) = (angle.phi, self.y);
        let rate = minus(angle.inverse_left(second, -1.0), angle.inverse_left(first, 1.0));
        // in the frame in the middle
        let turned = self.middle.to_frame(self.ends[0].to_space(first));
        let spin = plus(turned, times(angle.left_of_half(rate, -1.0), T::from(0.5)));
        let span = times(minus(nodes[1].x, nodes[0].x), T::from(1.0 / self.length));
        let dy = plus(self.middle.to_frame(span), cross(y, spin));
        let [[chord, chord_slope], [slack, slack_slope]] = [angle.chord, angle.slack];
        let (along, growth) = (dot(phi, y), dot(phi, rate) * 2.0);
        let change = dot(rate, y) + dot(phi, dy);
        let by_phi = plus(times(rate, slack * along), times(phi, slack * change));
        let by_angle = plus(times(y, chord_slope), times(phi, slack_slope * along));
        let gamma = plus(plus(times(dy, chord), by_phi), times(by_angle, growth));
        Strains { gamma, kappa: times(rate, T::from(1.0 / self.length)) }
    }

    /// The forces on the nodes that do the work of the `stresses` (N, N m) along the strains, times its length: for each node that along
    /// x (N) and those along its directors (N m).
    pub(super) fn forces(&self, stresses: Strains<T>) -> [Section<T>; 2] {
        let Strains { gamma: n, kappa: m } = stresses;
        let angle = &self.angle;
        let (phi, y) = (angle.phi, self.y);
        let [[chord, chord_slope], [slack, slack_slope]] = [angle.chord, angle.slack];
        let (stress, along) = (dot(phi, n), dot(phi, y));
        let force = plus(times(n, chord), times(phi, slack * stress));
        let moment = times(cross(force, y), T::from(self.length));
        let by_phi = times(plus(times(n, along), times(y, stress)), slack);
        let by_angle = (chord_slope * dot(n, y) + slack_slope * stress * along) * 2.0;
        let by_phi = times(plus(by_phi, times(phi, by_angle)), T::from(self.length));
        let by_middle = times(angle.left_of_half(moment, 1.0), T::from(0.5));
        let total = plus(plus(m, by_phi), by_middle);
        let on_second = angle.inverse_left(total, 1.0);
        let turned = self.ends[0].to_frame(self.middle.to_space(moment));
        let on_first = minus(turned, angle.inverse_left(total, -1.0));
        let x = self.middle.to_space(force);
        let zero = [T::from(0.0); 3];
        [
            Section { x: minus(zero, x), d: self.ends[0].forces(on_first) },
            Section { x, d: self.ends[1].forces(on_second) },
        ]
    }
}
