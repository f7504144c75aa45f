//! Nodal forces of cells with a remanence in the field of a dipole, evaluated at the strain points of the cells.
//!
//! With the deformed position x = sum N_a x_a of a point and its moment m = w F b / mu_0 = sum p_a x_a, p_a = w (g_a . b) / mu_0, the energy is
//! -sum m . B(x), with the gradient G = dB/dx (symmetric) and the second gradient H, so that
//!
//! ```text
//! f_a = sum p_a B + N_a G m,    df_a/dx_b = sum (p_a N_b + N_a p_b) G + N_a N_b H m
//! ```
//!
//! Tangents are exact and symmetric; a scene without dipoles has no such points. As the p_a of a cell add up
//! to 0, the N_a to 1, and the energy depends on distances and angles alone, forces and moment on the nodes
//! balance those of their field on the dipole to round-off. On n points along a cell of the length h (n the
//! M-th root of their number in M dimensions) a dipole nearer than 2 h/n to a point is an error;
//! `docs/notes/elements.md` has the errors of the rule there. Work counts as supplied: a dipole at rest
//! supplies what the energy of the magnets falls by, one that moves and comes back what was dissipated.

use std::f64::consts::PI;

use super::elements::{ElementsOf, pairs};
use super::magnets::{VACUUM, direction};
use crate::base::sparse::BlockMatrix;
use crate::base::tensor::dot;
use crate::elements::mesh::Mesh;

/// A magnetic dipole at one time, with one component per dimension and then 0: in the plane both vectors lie in it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointDipole {
    /// A m^2
    pub(crate) moment: [f64; 3],
    /// m
    pub(crate) position: [f64; 3],
}

/// The field of a dipole at a point: B (T) and G (T/m).
struct FieldAt<const D: usize> {
    field: [f64; D],
    gradient: [[f64; D]; D],
}

impl PointDipole {
    /// Whether it has no field.
    pub(crate) fn is_off(&self) -> bool {
        self.moment == [0.0; 3]
    }

    /// From the dipole to `x`, and its moment.
    fn seen<const D: usize>(&self, x: &[f64; D]) -> [[f64; D]; 2] {
        [std::array::from_fn(|i| x[i] - self.position[i]), std::array::from_fn(|i| self.moment[i])]
    }

    fn at<const D: usize>(&self, x: &[f64; D]) -> FieldAt<D> {
        let [r, m] = self.seen(x);
        let (square, along) = (dot(&r, &r), dot(&m, &r));
        // mu_0/(4 pi r^5)
        let factor = VACUUM / (4.0 * PI * square * square * square.sqrt());
        let field = std::array::from_fn(|i| factor * (3.0 * along * r[i] - square * m[i]));
        let gradient = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let trace = if i == j { along } else { 0.0 };
                let mixed = m[i] * r[j] + r[i] * m[j] + trace;
                factor * (3.0 * mixed - 15.0 * along / square * r[i] * r[j])
            })
        });
        FieldAt { field, gradient }
    }

    /// H b at `x` (T m/m^2 for a moment in A m^2, N/m): the derivative of G along `b`.
    fn second<const D: usize>(&self, x: &[f64; D], b: &[f64; D]) -> [[f64; D]; D] {
        let [r, m] = self.seen(x);
        let (square, along) = (dot(&r, &r), dot(&m, &r));
        let (of_m, of_r) = (dot(&m, b), dot(&r, b));
        let factor = 3.0 * VACUUM / (4.0 * PI * square * square * square.sqrt());
        let far = 5.0 / square;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let one = |x: f64| if i == j { x } else { 0.0 };
                let near = m[i] * b[j] + b[i] * m[j] + one(of_m);
                let mixed = (m[i] * r[j] + r[i] * m[j] + one(along)) * of_r
                    + of_m * r[i] * r[j]
                    + along * (b[i] * r[j] + r[i] * b[j]);
                factor * (near - far * mixed + 7.0 * far / square * along * of_r * r[i] * r[j])
            })
        })
    }
}

/// A dipole that the cells do not resolve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TooNear {
    /// The number of the cell, from 0.
    pub(crate) cell: usize,
    /// Its distance (m) from a point of the cell, and the least that there may be.
    pub(crate) distances: [f64; 2],
}

/// Magnetized cells of any kind.
pub(crate) trait MagnetizedPoints: Send + Sync {
    /// Adds the forces on the nodes under the displacements `u` (m).
    ///
    /// # Errors
    /// A dipole nearer than the cells resolve.
    fn add_forces(
        &self,
        dipole: &PointDipole,
        u: &[f64],
        forces: &mut [f64],
    ) -> Result<(), TooNear>;

    /// Adds -df/du.
    fn add_tangents(&self, dipole: &PointDipole, u: &[f64], stiffness: &mut BlockMatrix);

    /// Adds the force (N) on all of them.
    fn add_force(&self, dipole: &PointDipole, u: &[f64], force: &mut [f64; 3]);

    /// Their energy in the field (J).
    #[cfg(test)]
    fn energy(&self, dipole: &PointDipole, u: &[f64]) -> f64;
}

/// Magnetized cells of `N` nodes and `Q` points in a space of dimension `D`.
pub(super) struct Magnetized<const N: usize, const D: usize, const Q: usize> {
    pub(super) cells: Vec<MagnetizedCell<N, D, Q>>,
    /// Shape functions at the points.
    pub(super) values: [[f64; N]; Q],
}

pub(super) struct MagnetizedCell<const N: usize, const D: usize, const Q: usize> {
    /// Its number in the whole body.
    pub(super) number: usize,
    pub(super) nodes: [usize; N],
    /// The entries of the pairs of its nodes in the pattern of the body.
    pub(super) entries: [[u32; N]; N],
    pub(super) points: [MagnetizedPoint<N, D>; Q],
    /// The least distance (m) of a dipole from a point.
    pub(super) reach: f64,
}

pub(super) struct MagnetizedPoint<const N: usize, const D: usize> {
    /// p_a (A m)
    pub(super) poles: [f64; N],
    /// Undeformed place (m) and moment (A m^2).
    pub(super) place: [f64; D],
    pub(super) moment: [f64; D],
}

impl<const N: usize, const D: usize, const Q: usize> Magnetized<N, D, Q> {
    /// The points of a cell with their shape functions, places (m) and moments (A m^2) under the displacements `u` (m).
    fn points<'a>(
        &'a self,
        cell: &'a MagnetizedCell<N, D, Q>,
        u: &[f64],
    ) -> impl Iterator<Item = (&'a MagnetizedPoint<N, D>, &'a [f64; N], [f64; D], [f64; D])> {
        let u: [[f64; D]; N] =
            std::array::from_fn(|a| std::array::from_fn(|i| u[cell.nodes[a] * D + i]));
        cell.points.iter().zip(&self.values).map(move |(point, values)| {
            let (mut place, mut moment) = (point.place, point.moment);
            for (a, u) in u.iter().enumerate() {
                for i in 0..D {
                    place[i] += values[a] * u[i];
                    moment[i] += point.poles[a] * u[i];
                }
            }
            (point, values, place, moment)
        })
    }
}

/// The product of a symmetric matrix and a vector.
fn product<const D: usize>(matrix: &[[f64; D]; D], x: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| dot(&matrix[i], x))
}

impl<const N: usize, const D: usize, const Q: usize> MagnetizedPoints for Magnetized<N, D, Q> {
    fn add_forces(
        &self,
        dipole: &PointDipole,
        u: &[f64],
        forces: &mut [f64],
    ) -> Result<(), TooNear> {
        for cell in &self.cells {
            for (point, values, place, moment) in self.points(cell, u) {
                let [r, _] = dipole.seen(&place);
                let distance = dot(&r, &r).sqrt();
                if distance < cell.reach {
                    return Err(TooNear { cell: cell.number, distances: [distance, cell.reach] });
                }
                let FieldAt { field, gradient } = dipole.at(&place);
                let pull = product(&gradient, &moment);
                for (a, &node) in cell.nodes.iter().enumerate() {
                    for i in 0..D {
                        forces[node * D + i] += point.poles[a] * field[i] + values[a] * pull[i];
                    }
                }
            }
        }
        Ok(())
    }

    fn add_tangents(&self, dipole: &PointDipole, u: &[f64], stiffness: &mut BlockMatrix) {
        let mut rows = stiffness.rows_mut::<D>();
        for cell in &self.cells {
            for (point, values, place, moment) in self.points(cell, u) {
                let (gradient, second) =
                    (dipole.at(&place).gradient, dipole.second(&place, &moment));
                for (a, b) in pairs::<N>() {
                    let Some(block) = rows.block_mut(cell.entries[a][b]) else { continue };
                    let mixed = point.poles[a] * values[b] + values[a] * point.poles[b];
                    let both = values[a] * values[b];
                    for i in 0..D {
                        for j in 0..D {
                            block[i][j] -= mixed * gradient[i][j] + both * second[i][j];
                        }
                    }
                }
            }
        }
    }

    fn add_force(&self, dipole: &PointDipole, u: &[f64], force: &mut [f64; 3]) {
        for cell in &self.cells {
            for (_, _, place, moment) in self.points(cell, u) {
                let pull = product(&dipole.at(&place).gradient, &moment);
                force.iter_mut().zip(pull).for_each(|(force, pull)| *force += pull);
            }
        }
    }

    #[cfg(test)]
    fn energy(&self, dipole: &PointDipole, u: &[f64]) -> f64 {
        let cells = self.cells.iter().flat_map(|cell| self.points(cell, u));
        cells.map(|(.., place, moment)| -dot(&moment, &dipole.at(&place).field)).sum()
    }
}

/// Elements of which some can be magnetized.
pub(super) trait MagnetizableElements {
    /// Some `cells` with a `remanence` (T) on nodes of `mesh`; their numbers in it begin at `first`.
    fn magnetized_points(
        &self,
        mesh: &Mesh,
        first: usize,
        cells: &[usize],
        remanence: &[f64],
    ) -> Box<dyn MagnetizedPoints>;
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> MagnetizableElements
    for ElementsOf<N, M, D, Q>
{
    fn magnetized_points(
        &self,
        mesh: &Mesh,
        first: usize,
        cells: &[usize],
        remanence: &[f64],
    ) -> Box<dyn MagnetizedPoints> {
        let positions = mesh.positions().as_chunks::<D>().0;
        let mut magnetized = Vec::with_capacity(cells.len());
        for &cell in cells {
            let nodes = self.nodes[cell];
            let natural = nodes.map(|node| positions[node]);
            let apart = |(a, b): (usize, usize)| {
                let edge: [f64; D] = std::array::from_fn(|i| natural[a][i] - natural[b][i]);
                dot(&edge, &edge).sqrt()
            };
            let size = pairs::<N>().map(apart).fold(0.0, f64::max);
            let sum = |weights: &[f64; N]| -> [f64; D] {
                std::array::from_fn(|i| (0..N).map(|a| weights[a] * natural[a][i]).sum())
            };
            let mut own = self.points(cell).map(|point| {
                let own = direction(&point, remanence);
                point.gradients.map(|gradient| point.volume * dot(&gradient, &own) / VACUUM)
            });
            let points: [MagnetizedPoint<N, D>; Q] = std::array::from_fn(|q| {
                // there are as many points as values
                let poles = own.next().unwrap_or([0.0; N]);
                MagnetizedPoint { place: sum(&self.values[q]), moment: sum(&poles), poles }
            });
            // a cell is as long as so many points side by side, and each represents the field around it
            let points_along = (Q as f64).powf(1.0 / M as f64);
            magnetized.push(MagnetizedCell {
                number: first + cell,
                nodes,
                entries: self.entries[cell],
                points,
                reach: 2.0 * size / points_along,
            });
        }
        Box::new(Magnetized { cells: magnetized, values: self.values })
    }
}
