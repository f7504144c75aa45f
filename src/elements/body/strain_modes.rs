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
use super::regions::{Laws, Regions};
use crate::base::simd::{Formula, add_multiple, each};
use crate::base::tensor::{Matrix, Real, dot};
use crate::elements::force::{GeneralizedForce, NodalForces};
use crate::elements::material::{Deformation, Elastic, Lame, ObjectiveViscosity};
use crate::integrators::ode::Failure;

/// G and G_v of elements: the modes of their strains, with their stored and dissipated energies.
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

/// Fraction of the multiplications for all cells that those for the modes of their strains may need: what a sample of the cells
/// would take.
const OF_CELLS: usize = 8;

/// Whether so many sets of modes along so many shapes are that much less than the `work` for all cells.
pub(super) fn pay(shapes: usize, sets: usize, work: usize) -> bool {
    let of_modes = sets.saturating_mul(modes(shapes).saturating_pow(2));
    OF_CELLS.saturating_mul(of_modes) <= work
}

/// The mode of a pair of shapes.
pub(super) fn pair(shapes: usize, k: usize, l: usize) -> usize {
    let (low, high) = (k.min(l), k.max(l));
    1 + shapes + high * (high + 1) / 2 + low
}

/// Rows of strains that are multiplied at once.
const ROWS: usize = 1024;

/// Components of the strains of all modes at some points, a row for each, that symmetric matrices such as G are made of: sums of
/// the products of two entries of a row.
pub(super) struct Strains<const P: usize> {
    rows: Mat<f64>,
    /// Of each row, for each matrix.
    weights: [Vec<f64>; P],
    weighted: Mat<f64>,
    products: [Option<Mat<f64>>; P],
}

impl<const P: usize> Strains<P> {
    /// None yet of so many modes, to be added to matrices, as far as there are any.
    pub(super) fn new(modes: usize, products: [Option<Mat<f64>>; P]) -> Self {
        let rows = || Mat::zeros(ROWS, modes);
        let weights = std::array::from_fn(|_| Vec::new());
        Self { rows: rows(), weights, weighted: rows(), products }
    }

    /// Adds a row, with its weights.
    pub(super) fn push(&mut self, weights: [f64; P], row: impl Iterator<Item = f64>) {
        let number = self.weights[0].len();
        self.weights.iter_mut().zip(weights).for_each(|(all, weight)| all.push(weight));
        row.enumerate().for_each(|(mode, entry)| self.rows[(number, mode)] = entry);
        if number + 1 == ROWS {
            self.multiply();
        }
    }

    /// Adds the rows to the matrices.
    fn multiply(&mut self) {
        let Self { rows, weights, weighted, products } = self;
        for (weights, product) in weights.iter_mut().zip(products) {
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

    /// The matrices.
    pub(super) fn done(mut self) -> [Option<Mat<f64>>; P] {
        self.multiply();
        self.products
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> StrainProducts
    for ElementsOf<N, M, D, Q>
{
    fn has_strain_modes(&self, regions: &Regions, terms: Terms) -> bool {
        let are_quadratic = |laws: &Laws| {
            (!terms.elastic || matches!(laws.elastic, Elastic::StVenantKirchhoff(_)))
                && (!terms.viscous || matches!(laws.objective, ObjectiveViscosity::Hookean(_)))
        };
        let all = 0..self.nodes.len();
        !self.is_projected()
            && self.revolved.is_none()
            && regions.runs(&all).all(|(_, laws)| are_quadratic(laws))
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
        let mut all = Strains::new(strains.len(), products.each_mut().map(Option::take));
        let all_cells = 0..self.nodes.len();
        for (cells, laws) in regions.runs(&all_cells) {
            let none = Lame { lambda: 0.0, mu: 0.0 };
            let moduli = [
                if terms.elastic { laws.hooke.lame } else { none },
                if terms.viscous { laws.viscous.lame } else { none },
            ];
            for cell in cells {
                for point in self.points(cell) {
                    for (own, field) in gradients.iter_mut().zip(&fields) {
                        *own = gradient(1, &relative(&self.nodes[cell], field), &point.gradients);
                    }
                    set_strains(point.frame, &gradients, &mut strains);
                    // lambda tr(A) tr(B) + 2 mu A : B
                    let trace = |strain: &[[f64; M]; M]| (0..M).map(|j| strain[j][j]).sum();
                    let weights = moduli.map(|lame| point.volume * lame.lambda);
                    all.push(weights, strains.iter().map(trace));
                    for (j, k) in (0..M).flat_map(|j| (0..=j).map(move |k| (j, k))) {
                        let times = if k == j { 2.0 } else { 4.0 };
                        let weights = moduli.map(|lame| point.volume * times * lame.mu);
                        all.push(weights, strains.iter().map(|strain| strain[j][k]));
                    }
                }
            }
        }
        *products = all.done();
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
        let [w, speeds] = &mut self.amplitudes;
        w[0] = 1.0;
        set_amplitudes(z, w);
        set_amplitude_changes(z, rates, speeds);
        for ((product, amplitudes), stresses) in
            self.products.iter().zip(&self.amplitudes).zip(&mut self.stresses)
        {
            let Some(product) = product else { continue };
            multiply(product, amplitudes, stresses);
        }
    }

    /// Sets the [changes](set_changes) of G w.
    fn change(&mut self, number: usize, single: f64, z: &[f64]) {
        if let Some(product) = &self.products[number] {
            set_changes(product, single, z, &mut self.changes);
        }
    }
}

/// Sets the amplitudes w at z of the shapes and, as far as there are any, of their pairs.
pub(super) fn set_amplitudes(z: &[f64], w: &mut [f64]) {
    w[1..=z.len()].copy_from_slice(z);
    for (k, l) in pairs(z.len(), w.len()) {
        let half = if k == l { 0.5 } else { 1.0 };
        w[pair(z.len(), k, l)] = half * z[k] * z[l];
    }
}

/// Sets the `changes` of these amplitudes for a change `x` of z.
pub(super) fn set_amplitude_changes(z: &[f64], x: &[f64], changes: &mut [f64]) {
    changes[1..=z.len()].copy_from_slice(x);
    for (k, l) in pairs(z.len(), changes.len()) {
        let half = if k == l { 0.5 } else { 1.0 };
        changes[pair(z.len(), k, l)] = half * (x[k] * z[l] + z[k] * x[l]);
    }
}

/// The pairs of so many shapes, if they have any of so many modes.
fn pairs(shapes: usize, modes: usize) -> impl Iterator<Item = (usize, usize)> {
    let have_pairs = modes > 1 + shapes;
    let shapes = if have_pairs { shapes } else { 0 };
    (0..shapes).flat_map(|k| (0..=k).map(move |l| (k, l)))
}

/// Sets the derivatives of A w by each coordinate, dw/dz_m being that of z_m itself times `single`, and of its pairs with z as far as
/// there are any.
pub(super) fn set_changes(a: &Mat<f64>, single: f64, z: &[f64], changes: &mut [f64]) {
    let modes = a.nrows();
    for (m, change) in changes.chunks_exact_mut(modes).enumerate() {
        change.fill(0.0);
        let singles = std::iter::once((1 + m, single));
        let pairs = z.iter().enumerate().map(|(l, factor)| (pair(z.len(), m, l), *factor));
        let all = singles.chain(pairs.filter(|(mode, _)| *mode < modes));
        for (mode, factor) in all.filter(|(_, factor)| *factor != 0.0) {
            add_multiple(factor, a.col_as_slice(mode), change);
        }
    }
}

/// Adds dw/dz_k . change_m, for all changes of so many modes, to a matrix, row by row.
pub(super) fn add_changes(changes: &[f64], modes: usize, z: &[f64], matrix: &mut [f64]) {
    let s = z.len();
    for (m, change) in changes.chunks_exact(modes).enumerate() {
        for k in 0..s {
            matrix[k * s + m] += along(change, k, z);
        }
    }
}

/// dw/dz_k . x
pub(super) fn along(x: &[f64], k: usize, z: &[f64]) -> f64 {
    let s = z.len();
    if x.len() == 1 + s {
        return x[1 + k];
    }
    let of_pairs = z.iter().enumerate().map(|(l, z)| z * x[pair(s, k, l)]);
    x[1 + k] + of_pairs.sum::<f64>()
}

/// y = A x for a symmetric A.
pub(super) fn multiply(a: &Mat<f64>, x: &[f64], y: &mut [f64]) {
    // its columns are its rows
    y.iter_mut().enumerate().for_each(|(k, y)| *y = inner(a.col_as_slice(k), x));
}

/// x . y
pub(super) fn inner(x: &[f64], y: &[f64]) -> f64 {
    let [product] = each(Product, [x, y], []);
    product
}

impl GeneralizedForce for StrainModes {
    fn add_forces(
        &mut self,
        _t: f64,
        z: [&[f64]; 2],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.evaluate(z);
        let Self { products, stresses, .. } = self;
        let [of_shapes, _] = z;
        let parts = [&mut forces.conservative, &mut forces.dissipative];
        for ((product, stress), part) in products.iter().zip(stresses).zip(parts) {
            if product.is_some() {
                for (k, force) in part.iter_mut().enumerate() {
                    *force -= along(stress, k, of_shapes);
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
            add_changes(&self.changes, modes(s), z, stiffness);
        }
        if self.products[1].is_some() {
            self.change(1, 0.0, rates);
            add_changes(&self.changes, modes(s), z, stiffness);
            self.change(1, 1.0, z);
            add_changes(&self.changes, modes(s), z, damping);
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
