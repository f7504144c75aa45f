//! Numbers of any cross section, by finite elements over its triangles.
//!
//! Both problems are Saint-Venant's with Poisson's ratio 0, on one matrix K = int grad N_i.grad N_j dA. The
//! warping function w of torsion has the least
//!
//! ```text
//! J = min int |grad w + (-y, x)|^2 dA,   K w = -int grad N.(-y, x) dA
//! ```
//!
//! and the shear stress of a force along x is grad(phi)/I_yy with K phi = f = int N x dA, so that the shear area
//! is I_yy^2/(phi.f): 5/6 of a rectangle, 6/7 of a circle, half of a thin tube. Triangles are divided and the
//! last two results extrapolated by their order 2.

use std::collections::HashMap;

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{ColRef, Side};

use super::SectionNumbers;
use crate::base::vector::dot;
use crate::elements::mesh::Cut;

/// Triangles are divided, once at least, until there are so many.
const ENOUGH: usize = 1500;
/// A shift of the diagonal of K, relative to its largest entry: far below its eigenvalues but 0.
const SHIFT: f64 = 1e-12;

/// Triangles of a cross section.
#[derive(Debug, Clone)]
pub(crate) struct CutSection {
    points: Vec<[f64; 2]>,
    triangles: Vec<[usize; 3]>,
}

/// Area and moments of a cross section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AreaMoments {
    /// Area (m^2).
    pub(crate) area: f64,
    /// Its centroid (m).
    pub(crate) centroid: [f64; 2],
    /// int x^2, int y^2 and int x y dA about the centroid (m^4).
    pub(crate) second: [f64; 3],
}

impl AreaMoments {
    /// The angle (rad) from the x axis to the principal axis nearest to it.
    pub(crate) fn principal_angle(&self) -> f64 {
        let [xx, yy, xy] = self.second;
        // of a section without directions the angle is that of round-off
        if (2.0 * xy).hypot(xx - yy) <= 1e-6 * (xx + yy) {
            return 0.0;
        }
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        let quarter = std::f64::consts::FRAC_PI_2;
        angle - quarter * (angle / quarter).round()
    }
}

/// Results of both problems: constant of torsion, shear areas, centre of shear.
type Solution = [f64; 5];

impl CutSection {
    /// The polygons of a cut in triangles.
    pub(crate) fn new(cut: Cut) -> Self {
        let fan = |polygon: &Vec<usize>| {
            let pairs = polygon[1..].windows(2);
            pairs.map(|pair| [polygon[0], pair[0], pair[1]]).collect::<Vec<_>>()
        };
        Self { triangles: cut.polygons.iter().flat_map(fan).collect(), points: cut.points }
    }

    /// The section larger by a factor.
    pub(crate) fn scaled(mut self, factor: f64) -> Self {
        self.points.iter_mut().flatten().for_each(|x| *x *= factor);
        self
    }

    /// Its area and moments.
    pub(crate) fn moments(&self) -> AreaMoments {
        let (mut area, mut first, mut second) = (0.0, [0.0; 2], [0.0; 3]);
        for triangle in &self.triangles {
            let corners = triangle.map(|k| self.points[k]);
            let own = twice_area(&corners) / 2.0;
            let sum = [0, 1].map(|i| corners.iter().map(|x| x[i]).sum::<f64>());
            area += own;
            first.iter_mut().zip(sum).for_each(|(first, sum)| *first += own * sum / 3.0);
            for (moment, (i, j)) in second.iter_mut().zip([(0, 0), (1, 1), (0, 1)]) {
                let products: f64 = corners.iter().map(|x| x[i] * x[j]).sum();
                *moment += own / 12.0 * (products + sum[i] * sum[j]);
            }
        }
        let centroid = first.map(|first| first / area);
        let [x, y] = centroid;
        let about = [area * x * x, area * y * y, area * x * y];
        let second = [0, 1, 2].map(|k| second[k] - about[k]);
        AreaMoments { area, centroid, second }
    }

    /// Its numbers about principal axes through the centroid, and where its centre of shear is from there (m). `moments` are its own.
    pub(crate) fn numbers(&self, moments: &AreaMoments) -> (SectionNumbers, [f64; 2]) {
        let (sine, cosine) = moments.principal_angle().sin_cos();
        let turned = |x: &[f64; 2]| {
            let [a, b] = [x[0] - moments.centroid[0], x[1] - moments.centroid[1]];
            [cosine * a + sine * b, cosine * b - sine * a]
        };
        let mut section = Self {
            points: self.points.iter().map(turned).collect(),
            triangles: self.triangles.clone(),
        };
        let [xx, yy, _] = section.moments().second;
        let reach =
            [0, 1].map(|i| section.points.iter().fold(0.0_f64, |reach, x| reach.max(x[i].abs())));
        let mut coarse = section.solved([xx, yy]);
        let solution = loop {
            section = section.divided();
            let fine = section.solved([xx, yy]);
            if section.triangles.len() >= ENOUGH {
                break std::array::from_fn(|k| fine[k] + (fine[k] - coarse[k]) / 3.0);
            }
            coarse = fine;
        };
        let [torsion, shear_1, shear_2, centre_1, centre_2]: Solution = solution;
        let bending = [yy, xx];
        let numbers = SectionNumbers {
            area: moments.area,
            shear: [shear_1, shear_2],
            bending,
            torsion,
            reach,
        };
        (numbers, [centre_1, centre_2])
    }

    /// Each triangle in four.
    fn divided(&self) -> Self {
        let mut points = self.points.clone();
        let mut middles = HashMap::new();
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    points.push([0, 1].map(|i| 0.5 * (points[a][i] + points[b][i])));
                    points.len() - 1
                })
            });
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self { points, triangles }
    }

    /// Both problems on these triangles, about principal axes with the second moments `second` = int x^2, int y^2.
    fn solved(&self, second: [f64; 2]) -> Solution {
        let count = self.points.len();
        let mut entries = Vec::with_capacity(9 * self.triangles.len());
        let mut stiffest = 0.0_f64;
        let mut twist = vec![0.0; count];
        let mut linear = [vec![0.0; count], vec![0.0; count]];
        for triangle in &self.triangles {
            let corners = triangle.map(|k| self.points[k]);
            let double = twice_area(&corners);
            let gradient: [[f64; 2]; 3] = std::array::from_fn(|i| {
                let [next, last] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                [(next[1] - last[1]) / double, (last[0] - next[0]) / double]
            });
            let sum = [0, 1].map(|i| corners.iter().map(|x| x[i]).sum::<f64>());
            for (i, &row) in triangle.iter().enumerate() {
                for (j, &column) in triangle.iter().enumerate() {
                    let entry = 0.5 * double * dot(&gradient[i], &gradient[j]);
                    entries.push(Triplet::new(row, column, entry));
                    stiffest = stiffest.max(entry);
                }
                let turning = gradient[i][1] * sum[0] - gradient[i][0] * sum[1];
                twist[row] += 0.5 * double * turning / 3.0;
                for (axis, linear) in linear.iter_mut().enumerate() {
                    linear[row] += double / 24.0 * (corners[i][axis] + sum[axis]);
                }
            }
        }
        // a constant in each connected part is free, and drops out of all results
        entries.extend((0..count).map(|k| Triplet::new(k, k, SHIFT * stiffest)));
        let factor = SparseColMat::try_new_from_triplets(count, count, &entries)
            .ok()
            .and_then(|matrix| matrix.sp_cholesky(Side::Lower).ok());
        let Some(factor) = factor else { return [f64::NAN; 5] };
        let solve = |b: &[f64]| -> Vec<f64> {
            factor.solve(ColRef::from_slice(b)).iter().copied().collect()
        };
        let warping = solve(&twist);
        let torsion = second[0] + second[1] - dot(&warping, &twist);
        let shear =
            [0, 1].map(|axis| second[axis].powi(2) / dot(&solve(&linear[axis]), &linear[axis]));
        // Trefftz's centre, by the work of a force there in torsion
        let centre =
            [dot(&warping, &linear[1]) / second[1], -dot(&warping, &linear[0]) / second[0]];
        [torsion, shear[0], shear[1], centre[0], centre[1]]
    }
}

fn twice_area(corners: &[[f64; 2]; 3]) -> f64 {
    let [a, b, c] = corners;
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::base::vector::largest;
    use crate::elements::mesh::{Mesh, SolidCells};

    /// The section across x of a block with these sides along y and z.
    fn of_block(sides: [f64; 2], cells: SolidCells) -> CutSection {
        let mesh = Mesh::cuboid([1.0, sides[0], sides[1]], [3, 4, 4], cells).unwrap();
        CutSection::new(mesh.cut(0.3, |x| [x[0], x[1], x[2]]))
    }

    /// A regular polygon around the origin in rings of quadrilaterals between these radii; without a hole if the first is 0.
    fn polygon(count: usize, radii: &[f64]) -> CutSection {
        let at = |radius: &f64| {
            let radius = *radius;
            (0..count).map(move |k| {
                let (sine, cosine) = (2.0 * PI * k as f64 / count as f64).sin_cos();
                [radius * cosine, radius * sine]
            })
        };
        let is_solid = radii[0] == 0.0;
        let own = &radii[usize::from(is_solid)..];
        let quad = |k: usize| {
            let next = k / count * count + (k + 1) % count;
            vec![k, k + count, next + count, next]
        };
        let mut polygons: Vec<Vec<usize>> = (0..(own.len() - 1) * count).map(quad).collect();
        if is_solid {
            polygons.push((0..count).collect());
        }
        CutSection::new(Cut { points: own.iter().flat_map(at).collect(), polygons })
    }

    fn near(found: f64, expected: f64, part: f64) {
        assert!((found / expected - 1.0).abs() < part, "{found:e} {expected:e}");
    }

    #[test]
    fn rectangles_have_the_numbers_of_closed_forms() {
        for cells in [SolidCells::Hexahedra, SolidCells::Tetrahedra] {
            let section = of_block([0.02, 0.02], cells);
            let (numbers, centre) = section.numbers(&section.moments());
            // Timoshenko and Goodier: 0.1406 a^4 of a square, 0.2287 a b^3 of a rectangle with a = 2 b
            near(numbers.torsion, 0.140_577 * 0.02_f64.powi(4), 2e-4);
            near(numbers.area, 4e-4, 1e-12);
            near(numbers.bending[0], 0.02_f64.powi(4) / 12.0, 1e-12);
            near(numbers.shear[0], 5.0 / 6.0 * 4e-4, 2e-4);
            assert!(largest(&centre) < 1e-6 * 0.02, "{centre:?}");
            let section = of_block([0.04, 0.02], cells);
            let (numbers, _) = section.numbers(&section.moments());
            near(numbers.torsion, 0.228_68 * 0.04 * 0.02_f64.powi(3), 2e-4);
            near(numbers.bending[0], 0.04 * 0.02_f64.powi(3) / 12.0, 1e-12);
            near(numbers.bending[1], 0.02 * 0.04_f64.powi(3) / 12.0, 1e-12);
            near(numbers.reach[0], 0.02, 1e-12);
        }
    }

    #[test]
    fn circles_and_tubes_are_approached_by_polygons() {
        let (count, radius) = (96, 0.01_f64);
        // a polygon of 96 corners has 0.07 % less area, twice that of fourth powers of the radius
        let section = polygon(count, &[0.0, 0.25, 0.5, 0.75, 1.0].map(|part| part * radius));
        let (numbers, _) = section.numbers(&section.moments());
        near(numbers.torsion, 0.5 * PI * radius.powi(4), 2e-3);
        near(numbers.shear[0], 6.0 / 7.0 * PI * radius * radius, 2e-3);
        let section = polygon(count, &[0.9 * radius, radius]);
        let (numbers, _) = section.numbers(&section.moments());
        near(numbers.torsion, 0.5 * PI * (1.0 - 0.9_f64.powi(4)) * radius.powi(4), 3e-3);
        near(numbers.shear[1] / numbers.area, 0.5, 1e-2);
    }

    #[test]
    fn an_angle_has_its_centre_of_shear_at_its_corner() {
        // two legs of 20 x 1: their middle lines meet at the origin, through which all shear flows
        let block =
            |x: [f64; 2], y: [f64; 2]| [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
        let mut points = Vec::new();
        let mut polygons = Vec::new();
        let mut add = |corners: [[f64; 2]; 4]| {
            let numbers = corners.map(|corner: [f64; 2]| {
                points.iter().position(|known| *known == corner).unwrap_or_else(|| {
                    points.push(corner);
                    points.len() - 1
                })
            });
            polygons.push(numbers.to_vec());
        };
        add(block([-0.5, 0.5], [-0.5, 0.5]));
        for k in 0..20 {
            let [a, b] = [0.5 + f64::from(k), 1.5 + f64::from(k)];
            add(block([a, b], [-0.5, 0.5]));
            add(block([-0.5, 0.5], [a, b]));
        }
        let section = CutSection::new(Cut { points, polygons });
        let moments = section.moments();
        near(moments.principal_angle().abs(), PI / 4.0, 1e-9);
        let (numbers, [a, b]) = section.numbers(&moments);
        // two thin rectangles: b h^3/3 each, less their ends
        near(numbers.torsion, 2.0 * 20.25 / 3.0, 0.05);
        let (sine, cosine) = moments.principal_angle().sin_cos();
        let centre = [
            moments.centroid[0] + cosine * a - sine * b,
            moments.centroid[1] + sine * a + cosine * b,
        ];
        assert!(largest(&centre) < 0.5, "{centre:?}");
    }
}
