//! Cross sections of rods.

use std::f64::consts::PI;

use crate::base::input::{InputError, not_negative, positive};

/// The cross section of a rod. Its axes are the directors d_1 and d_2 of the rod; in the plane d_1 lies in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RodSection {
    /// A circle.
    Circle {
        /// Its radius (m).
        radius: f64,
    },
    /// A tube.
    Ring {
        /// Its outer radius (m).
        radius: f64,
        /// Its inner radius (m).
        inner: f64,
    },
    /// An ellipse.
    Ellipse {
        /// Its half axes along d_1 and d_2 (m).
        radii: [f64; 2],
    },
    /// A rectangle.
    Rectangle {
        /// Its sides along d_1 and d_2 (m).
        size: [f64; 2],
    },
    /// Any section, by numbers.
    Numbers(SectionNumbers),
}

/// Points around a round section: a polygon of so many sides lies within 2 % of its radius.
pub(super) const AROUND: usize = 16;

/// Area and moments of a cross section, whose centroid and centre of shear are on the axis of the rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionNumbers {
    /// Area (m^2).
    pub area: f64,
    /// Shear areas along d_1 and d_2 (m^2): the area times the factor of shear.
    pub shear: [f64; 2],
    /// Second moments of the area about d_1 and d_2 (m^4), principal axes.
    pub bending: [f64; 2],
    /// Saint-Venant's constant of torsion (m^4).
    pub torsion: f64,
    /// Reach of the section along d_1 and d_2 (m), where it touches others.
    pub reach: [f64; 2],
}

impl SectionNumbers {
    /// All numbers, each by itself.
    fn numbers(&self) -> [f64; 8] {
        let Self { area, shear, bending, torsion, reach } = *self;
        [area, shear[0], shear[1], bending[0], bending[1], torsion, reach[0], reach[1]]
    }

    /// The mean along an element, of which the numbers at both ends and in the middle are given (Simpson's rule).
    pub(super) fn mean(along: [Self; 3]) -> Self {
        let mut sum = [0.0; 8];
        for (weight, part) in [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0].into_iter().zip(along) {
            sum.iter_mut().zip(part.numbers()).for_each(|(sum, own)| *sum += weight * own);
        }
        let [area, s1, s2, b1, b2, torsion, r1, r2] = sum;
        Self { area, shear: [s1, s2], bending: [b1, b2], torsion, reach: [r1, r2] }
    }
}

impl RodSection {
    /// Its numbers, in a material with Poisson's ratio `poisson`, on which the factors of shear depend (Cowper, J. Appl. Mech. 33 (1966)
    /// 335-340).
    pub fn numbers(&self, poisson: f64) -> SectionNumbers {
        let nu = poisson;
        match *self {
            Self::Circle { radius } => Self::Ring { radius, inner: 0.0 }.numbers(poisson),
            Self::Ring { radius, inner } => {
                let area = PI * (radius * radius - inner * inner);
                let moment = PI / 4.0 * (radius.powi(4) - inner.powi(4));
                let (n, m) = (1.0 + nu, inner / radius);
                let (one, m2) = ((1.0 + m * m).powi(2), m * m);
                let factor = 6.0 * n * one / ((7.0 + 6.0 * nu) * one + (20.0 + 12.0 * nu) * m2);
                SectionNumbers {
                    area,
                    shear: [factor * area; 2],
                    bending: [moment; 2],
                    torsion: 2.0 * moment,
                    reach: [radius; 2],
                }
            }
            Self::Ellipse { radii: [a, b] } => {
                let area = PI * a * b;
                // with a along the force, b across it
                let factor = |a: f64, b: f64| {
                    let (a2, b2) = (a * a, b * b);
                    let top = 12.0 * (1.0 + nu) * a2 * (3.0 * a2 + b2);
                    let mixed = (40.0 + 37.0 * nu) * a2 * a2;
                    top / (mixed + (16.0 + 10.0 * nu) * a2 * b2 + nu * b2 * b2)
                };
                SectionNumbers {
                    area,
                    shear: [factor(a, b) * area, factor(b, a) * area],
                    bending: [area * b * b / 4.0, area * a * a / 4.0],
                    torsion: PI * (a * b).powi(3) / (a * a + b * b),
                    reach: [a, b],
                }
            }
            Self::Rectangle { size: [a, b] } => {
                let area = a * b;
                let factor = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
                SectionNumbers {
                    area,
                    shear: [factor * area; 2],
                    bending: [a * b.powi(3) / 12.0, b * a.powi(3) / 12.0],
                    torsion: torsion_of_rectangle(a.max(b), a.min(b)),
                    reach: [a / 2.0, b / 2.0],
                }
            }
            Self::Numbers(numbers) => numbers,
        }
    }

    /// Places around it, in reaches along d_1 and d_2; in the plane, its two sides.
    pub(super) fn outline(&self, dimension: usize) -> Vec<[f64; 2]> {
        match (dimension, self) {
            (2, _) => vec![[1.0, 0.0], [-1.0, 0.0]],
            (_, Self::Rectangle { .. }) => {
                let sides = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
                let middle = |k: usize| [0, 1].map(|i| 0.5 * (sides[k][i] + sides[(k + 1) % 4][i]));
                (0..4).flat_map(|k| [sides[k], middle(k)]).collect()
            }
            _ => {
                let angle = |k: usize| 2.0 * PI * k as f64 / AROUND as f64;
                (0..AROUND).map(|k| [angle(k).cos(), angle(k).sin()]).collect()
            }
        }
    }

    /// Checks its numbers.
    ///
    /// # Errors
    /// A size that is not above 0, a tube without a wall.
    pub(super) fn validate(&self, input: &str) -> Result<(), InputError> {
        let check = |key: &str, value: f64, unit: &str| {
            positive(&format!("{input}{key}"), value, unit).map(drop)
        };
        match *self {
            Self::Circle { radius } => check("radius", radius, "m"),
            Self::Ring { radius, inner } => {
                check("radius", radius, "m")?;
                not_negative(&format!("{input}inner"), inner, "m")?;
                if inner >= radius {
                    let help = format!("it must be below the radius of {radius} m");
                    return Err(InputError::new(format!("{input}inner"), inner, help));
                }
                Ok(())
            }
            Self::Ellipse { radii } => radii.iter().try_for_each(|r| check("radii", *r, "m")),
            Self::Rectangle { size } => size.iter().try_for_each(|s| check("size", *s, "m")),
            Self::Numbers(numbers) => {
                let SectionNumbers { area, shear, bending, torsion, reach } = numbers;
                check("area", area, "m^2")?;
                shear.iter().try_for_each(|s| check("shear", *s, "m^2"))?;
                bending.iter().try_for_each(|b| check("bending", *b, "m^4"))?;
                check("torsion", torsion, "m^4")?;
                reach.iter().try_for_each(|r| check("reach", *r, "m"))
            }
        }
    }

    /// The section that lies at the `share` of the way from this one to `end`, of the same kind.
    ///
    /// # Errors
    /// Sections of different kinds.
    pub(super) fn towards(&self, end: &Self, share: f64) -> Result<Self, InputError> {
        let mix = |a: f64, b: f64| a + share * (b - a);
        let both = |a: [f64; 2], b: [f64; 2]| [mix(a[0], b[0]), mix(a[1], b[1])];
        match (*self, *end) {
            (Self::Circle { radius: a }, Self::Circle { radius: b }) => {
                Ok(Self::Circle { radius: mix(a, b) })
            }
            (Self::Ring { radius: a, inner: c }, Self::Ring { radius: b, inner: d }) => {
                Ok(Self::Ring { radius: mix(a, b), inner: mix(c, d) })
            }
            (Self::Ellipse { radii: a }, Self::Ellipse { radii: b }) => {
                Ok(Self::Ellipse { radii: both(a, b) })
            }
            (Self::Rectangle { size: a }, Self::Rectangle { size: b }) => {
                Ok(Self::Rectangle { size: both(a, b) })
            }
            (own, end) => {
                let help =
                    "a rod tapers to a section of the same kind, and not one of given numbers";
                Err(InputError::new(
                    "end of the rod's section",
                    format!("{end:?} after {own:?}"),
                    help,
                ))
            }
        }
    }
}

/// The constant of torsion (m^4) of a rectangle with sides `a` >= `b` (Timoshenko and Goodier, section 109).
fn torsion_of_rectangle(a: f64, b: f64) -> f64 {
    let terms = (0..8).map(|k| {
        let n = f64::from(2 * k + 1);
        (n * PI * a / (2.0 * b)).tanh() / n.powi(5)
    });
    a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * b / a * terms.sum::<f64>())
}
