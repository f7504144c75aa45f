//! Elastic and viscous forces along shapes, exactly: where the law is that of Saint Venant and Kirchhoff, Green's strain is
//! a quadratic function of the coordinates z of shapes psi_k, and the energy a quadratic form of the strain (J. Barbič,
//! D. James, ACM Trans. Graph. 24 (2005) 982-990).
//!
//! With F_0 = I + du_0/dX and H_k = dpsi_k/dX, the strain is a sum of modes b_a that do not change, and so are forces:
//!
//! ```text
//! E = E_0 + sum_k z_k sym(F_0^T H_k) + sum_kl z_k z_l sym(H_k^T H_l) / 2 = sum_a w_a(z) b_a
//! G_ab = int b_a : C b_b dV,   f_k = -dw/dz_k . (G w + G_v w')
//! ```
//!
//! with C of the elastic law in G, and that of the viscous one in G_v. The amplitudes w are 1, z_k, and for each pair z_k z_l,
//! or half of the square.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use super::elements::{ElementsOf, gradient};
use super::forces::{Terms, relative};
use super::regions::Regions;
use crate::base::simd::{Formula, add_multiple, each};
use crate::base::tensor::{Matrix, Real, dot};
use crate::elements::force::{GeneralizedForce, NodalForces};
use crate::elements::material::{Deformation, Elastic, Lame};
use crate::integrators::ode::Failure;

/// G and G_v of elements: the modes of their strains, and what these store and dissipate.
pub(super) trait StrainProducts {
    /// Whether the strain energy is a quadratic form of Green's strain.
    fn has_strain_modes(&self, regions: &Regions, terms: Terms) -> bool;

    /// Multiplications that the forces of all cells take, about.
    fn work(&self) -> usize;

    /// Adds G and G_v along `shapes` from displacements `origin` (m), as far as there are such terms.
    fn add_products(
        &self,
        regions: &Regions,
        terms: Terms,
        origin: &[f64],
        shapes: &[&[f64]],
        products: &mut [Option<Mat<f64>>; 2],
    );
}

/// The elastic and viscous forces along shapes.
pub(super) struct StrainModes {
    shapes: usize,
    /// G (J) and G_v (J s).
    products: [Option<Mat<f64>>; 2],
    /// w and w'
    amplitudes: [Vec<f64>; 2],
    /// G w and G_v w'
    stresses: [Vec<f64>; 2],
    /// Derivatives of these by each coordinate.
    changes: Vec<f64>,
}

/// Number of modes along so many shapes.
pub(super) fn modes(shapes: usize) -> usize {
    1 + shapes + shapes * (shapes + 1) / 2
}

/// The mode of a pair of shapes.
fn pair(shapes: usize, k: usize, l: usize) -> usize {
    let (low, high) = (k.min(l), k.max(l));
    1 + shapes + high * (high + 1) / 2 + low
}

/// Rows of strains that are multiplied at once.
const ROWS: usize = 1024;

/// Components of the strains of all modes at some points, a row for each, that G and G_v are made of.
struct Strains<'a> {
    rows: Mat<f64>,
    /// Of each row, for G and G_v.
    weights: [Vec<f64>; 2],
    weighted: Mat<f64>,
    products: &'a mut [Option<Mat<f64>>; 2],
}

impl<'a> Strains<'a> {
    fn new(modes: usize, products: &'a mut [Option<Mat<f64>>; 2]) -> Self {
        let rows = || Mat::zeros(ROWS, modes);
        Self { rows: rows(), weights: Default::default(), weighted: rows(), products }
    }

    /// The next row, with its weights. It is to be set for all modes.
    fn row(&mut self, weights: [f64; 2]) -> usize {
        if self.weights[0].len() == ROWS {
            self.multiply();
        }
        self.weights.iter_mut().zip(weights).for_each(|(all, weight)| all.push(weight));
        self.weights[0].len() - 1
    }

    /// Adds the rows to G and G_v.
    fn multiply(&mut self) {
        let Self { rows, weights, weighted, products } = self;
        for (weights, product) in weights.iter_mut().zip(&mut **products) {
            let count = weights.len();
            if let Some(product) = product {
                for column in 0..rows.ncols() {
                    for (row, weight) in weights.iter().enumerate() {
                        weighted[(row, column)] = weight * rows[(row, column)];
                    }
                }
                let [rows, weighted] = [&*rows, &*weighted].map(|own| own.subrows(0, count));
                matmul(product, Accum::Add, rows.transpose(), weighted, 1.0, Par::Seq);
            }
            weights.clear();
        }
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> StrainProducts
    for ElementsOf<N, M, D, Q>
{
    fn has_strain_modes(&self, regions: &Regions, terms: Terms) -> bool {
        let is_quadratic = |law: &Elastic| matches!(law, Elastic::StVenantKirchhoff(_));
        let all = 0..self.nodes.len();
        !self.is_projected()
            && (!terms.elastic || regions.runs(&all).all(|(_, laws)| is_quadratic(&laws.elastic)))
    }

    fn work(&self) -> usize {
        self.nodes.len() * Q * N * M * D * LOOPS
    }

    fn add_products(
        &self,
        regions: &Regions,
        terms: Terms,
        origin: &[f64],
        shapes: &[&[f64]],
        products: &mut [Option<Mat<f64>>; 2],
    ) {
        let fields: Vec<&[[f64; D]]> =
            [origin].iter().chain(shapes).map(|field| field.as_chunks().0).collect();
        let mut gradients = vec![[[0.0; D]; M]; fields.len()];
        let mut strains = vec![[[0.0; M]; M]; modes(shapes.len())];
        let mut all = Strains::new(strains.len(), products);
        let all_cells = 0..self.nodes.len();
        for (cells, laws) in regions.runs(&all_cells) {
            let none = Lame { lambda: 0.0, mu: 0.0 };
            let moduli = [
                if terms.elastic { laws.hooke.lame } else { none },
                if terms.viscous { laws.viscous.0.lame } else { none },
            ];
            for cell in cells {
                for point in self.points(cell) {
                    for (own, field) in gradients.iter_mut().zip(&fields) {
                        *own = gradient(1, &relative(&self.nodes[cell], field), &point.gradients);
                    }
                    set_strains(point.frame, &gradients, &mut strains);
                    // lambda tr(A) tr(B) + 2 mu A : B
                    let row = all.row(moduli.map(|lame| point.volume * lame.lambda));
                    for (mode, strain) in strains.iter().enumerate() {
                        all.rows[(row, mode)] = (0..M).map(|j| strain[j][j]).sum();
                    }
                    for (j, k) in (0..M).flat_map(|j| (0..=j).map(move |k| (j, k))) {
                        let times = if k == j { 2.0 } else { 4.0 };
                        let row = all.row(moduli.map(|lame| point.volume * times * lame.mu));
                        for (mode, strain) in strains.iter().enumerate() {
                            all.rows[(row, mode)] = strain[j][k];
                        }
                    }
                }
            }
        }
        all.multiply();
    }
}

/// Multiplications for each component of a gradient: twice for H, and for P.
const LOOPS: usize = 3;

/// The strains of all modes from the gradients of u_0 and of the shapes.
fn set_strains<const M: usize, const D: usize>(
    frame: Matrix<f64, D, M>,
    gradients: &[Matrix<f64, D, M>],
    strains: &mut [[[f64; M]; M]],
) {
    let at = Deformation::new(frame, gradients[0]);
    let (start, shapes) = (at.gradient(), &gradients[1..]);
    let sym = |a: &Matrix<f64, D, M>, b: &Matrix<f64, D, M>| {
        let entry = |j: usize, k: usize| 0.5 * (dot(&a[j], &b[k]) + dot(&a[k], &b[j]));
        std::array::from_fn(|j| std::array::from_fn(|k| entry(j, k)))
    };
    strains[0] = at.twice_green().map(|column| column.map(|twice| 0.5 * twice));
    for (k, shape) in shapes.iter().enumerate() {
        strains[1 + k] = sym(&start, shape);
        for (l, other) in shapes[..=k].iter().enumerate() {
            strains[pair(shapes.len(), k, l)] = sym(shape, other);
        }
    }
}

impl StrainModes {
    /// Those with G and G_v along so many shapes.
    pub(super) fn new(shapes: usize, products: [Option<Mat<f64>>; 2]) -> Self {
        let modes = modes(shapes);
        let none = || [vec![0.0; modes], vec![0.0; modes]];
        let changes = vec![0.0; modes * shapes];
        Self { shapes, products, amplitudes: none(), stresses: none(), changes }
    }

    /// Sets w, w', G w and G_v w'.
    fn evaluate(&mut self, [z, rates]: [&[f64]; 2]) {
        let Self { shapes, amplitudes: [w, speeds], .. } = self;
        w[0] = 1.0;
        w[1..=*shapes].copy_from_slice(z);
        speeds[1..=*shapes].copy_from_slice(rates);
        for k in 0..*shapes {
            for l in 0..=k {
                let at = pair(*shapes, k, l);
                let half = if k == l { 0.5 } else { 1.0 };
                w[at] = half * z[k] * z[l];
                speeds[at] = half * (rates[k] * z[l] + z[k] * rates[l]);
            }
        }
        for ((product, amplitudes), stresses) in
            self.products.iter().zip(&self.amplitudes).zip(&mut self.stresses)
        {
            let Some(product) = product else { continue };
            // symmetric: its columns are its rows
            for (mode, stress) in stresses.iter_mut().enumerate() {
                [*stress] = each(Product, [product.col_as_slice(mode), amplitudes], []);
            }
        }
    }

    /// Derivatives of G w by each coordinate, dw/dz_m being that of z_m itself times `single`, and of its pairs with z.
    fn change(&mut self, number: usize, single: f64, z: &[f64]) {
        let Some(product) = &self.products[number] else { return };
        for (m, change) in self.changes.chunks_exact_mut(modes(self.shapes)).enumerate() {
            change.fill(0.0);
            let singles = std::iter::once((1 + m, single));
            let pairs = z.iter().enumerate().map(|(l, z)| (pair(self.shapes, m, l), *z));
            for (mode, factor) in singles.chain(pairs).filter(|(_, factor)| *factor != 0.0) {
                add_multiple(factor, product.col_as_slice(mode), change);
            }
        }
    }

    /// Adds dw/dz_k . change_m to a matrix, row by row.
    fn add_changes(&self, z: &[f64], matrix: &mut [f64]) {
        let s = self.shapes;
        for (m, change) in self.changes.chunks_exact(modes(s)).enumerate() {
            for k in 0..s {
                matrix[k * s + m] += along(change, s, k, z);
            }
        }
    }
}

/// dw/dz_k . x
fn along(x: &[f64], shapes: usize, k: usize, z: &[f64]) -> f64 {
    let of_pairs = z.iter().enumerate().map(|(l, z)| z * x[pair(shapes, k, l)]);
    x[1 + k] + of_pairs.sum::<f64>()
}

impl GeneralizedForce for StrainModes {
    fn add_forces(
        &mut self,
        _t: f64,
        z: [&[f64]; 2],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.evaluate(z);
        let Self { shapes, products, stresses, .. } = self;
        let [of_shapes, _] = z;
        let parts = [&mut forces.conservative, &mut forces.dissipative];
        for ((product, stress), part) in products.iter().zip(stresses).zip(parts) {
            if product.is_some() {
                for (k, force) in part.iter_mut().enumerate() {
                    *force -= along(stress, *shapes, k, of_shapes);
                }
            }
        }
        Ok(())
    }

    fn add_tangents(
        &mut self,
        _t: f64,
        z: [&[f64]; 2],
        stiffness: &mut [f64],
        damping: &mut [f64],
    ) {
        self.evaluate(z);
        let [z, rates] = z;
        let s = self.shapes;
        for k in 0..s {
            for l in 0..s {
                let of_pair = |stress: &Vec<f64>| stress[pair(s, k, l)];
                stiffness[k * s + l] += self.stresses.iter().map(of_pair).sum::<f64>();
            }
        }
        if self.products[0].is_some() {
            self.change(0, 1.0, z);
            self.add_changes(z, stiffness);
        }
        if self.products[1].is_some() {
            self.change(1, 0.0, rates);
            self.add_changes(z, stiffness);
            self.change(1, 1.0, z);
            self.add_changes(z, damping);
        }
    }
}

/// x . y
struct Product;

impl Formula<2, 0, 1> for Product {
    #[inline(always)]
    fn at<T: Real>(&self, [x, y]: [T; 2], _: [T; 0]) -> ([T; 0], [T; 1]) {
        ([], [x * y])
    }
}

#[cfg(test)]
mod tests;
