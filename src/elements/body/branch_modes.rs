//! Maxwell branches without a yield stress along shapes, exactly: the internal strain G follows the strain linearly, so that it
//! is a sum of the modes b_a of the strain (`strain_modes.rs`), whose amplitudes follow those of the strain.
//!
//! ```text
//! E = E_0 + sum_a w_a(z) b_a,   G = E_0 + sum_a g_a b_a,   g_a' = (w_a - g_a)/tau
//! ```
//!
//! The initial elastic strain of the branches, E_0 - G_0, is one more mode, with w = 0 and, at the start, g = -1. All branches of one
//! relaxation time tau have the same amplitudes; C is that of each. With H_ab = int b_a : C b_b dV and P = 1/(1 + gamma/tau)
//!
//! ```text
//! f_k = -dw/dz_k . H (w - g),   xg = P rg + (1 - P) W xz,   W_ak = dw_a/dz_k
//! K = d2w/dz2 . H (w - g) + P W^T H W
//! ```

use faer::Mat;

use super::branches::Site;
use super::elements::{ElementsOf, gradient};
use super::forces::relative;
use super::projection::COEFFICIENTS;
use super::regions::Regions;
use super::strain_modes::{
    Strains, add_changes, along, inner, modes, multiply, pair, set_amplitude_changes,
    set_amplitudes, set_changes,
};
use crate::base::simd::{add, add_multiple};
use crate::base::tensor::{Matrix, dot};
use crate::base::vector::largest;
use crate::elements::material::{Components, axes, components, trace};

/// Elements with branches, along shapes.
pub(super) trait BranchModal {
    /// Adds the modes of the branches along `shapes`, from displacements and internal strains `at` the start, of which the
    /// first has the number `first` among those of all bodies.
    fn add_branch_modes(
        &self,
        regions: &Regions,
        at: [&[f64]; 2],
        shapes: &[&[f64]],
        first: usize,
        found: &mut ModeSet,
    );
}

/// The modes of all branches, as they are found.
pub(super) struct ModeSet {
    modes: usize,
    groups: Vec<ModeGroup>,
}

/// Those of one relaxation time: the components of internal strains by their numbers, with E_0 and the modes of each.
struct ModeGroup {
    time: f64,
    products: Strains<1>,
    numbers: Vec<usize>,
    start: Vec<f64>,
    rows: Vec<f64>,
}

/// The branches along shapes.
pub(crate) struct BranchModes {
    shapes: usize,
    modes: usize,
    groups: Vec<Group>,
    /// w, and workspaces of the sizes of w and z.
    w: Vec<f64>,
    room: [Vec<f64>; 2],
    moved: Vec<f64>,
    /// Derivatives of H w by each coordinate.
    changes: Vec<f64>,
    /// z at the last evaluation, and where the tangents are from.
    at: [Vec<f64>; 2],
    /// d2w/dz2 . H (w - g) there, row by row.
    geometric: Vec<f64>,
}

/// Branches of one relaxation time.
struct Group {
    /// tau (s)
    time: f64,
    /// H (J)
    product: Mat<f64>,
    /// w - g, and H times it.
    apart: Vec<f64>,
    stress: Vec<f64>,
    /// W^T H W where the tangents are from, row by row.
    material: Vec<f64>,
    /// Numbers of the components of internal strains, E_0 there, and the modes there, one after the other; a workspace of that size.
    numbers: Vec<usize>,
    start: Vec<f64>,
    columns: Vec<f64>,
    strains: Vec<f64>,
}

impl ModeSet {
    /// None yet, along so many shapes; of linear strains each shape has one mode, and pairs of shapes have none.
    pub(super) fn new(shapes: usize, are_linear: bool) -> Self {
        let modes = if are_linear { 1 + shapes } else { modes(shapes) };
        Self { modes, groups: Vec::new() }
    }

    /// The group of a relaxation time.
    fn group(&mut self, time: f64) -> &mut ModeGroup {
        let known = self.groups.iter().position(|own| own.time == time);
        let number = known.unwrap_or_else(|| {
            let zeros = Mat::zeros(self.modes, self.modes);
            let products = Strains::new(self.modes, [Some(zeros)]);
            let [start, rows] = [Vec::new(), Vec::new()];
            self.groups.push(ModeGroup { time, products, numbers: Vec::new(), start, rows });
            self.groups.len() - 1
        });
        &mut self.groups[number]
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> BranchModal
    for ElementsOf<N, M, D, Q>
{
    fn add_branch_modes(
        &self,
        regions: &Regions,
        [origin, internal]: [&[f64]; 2],
        shapes: &[&[f64]],
        first: usize,
        found: &mut ModeSet,
    ) {
        let fields: Vec<&[[f64; D]]> = shapes.iter().map(|shape| shape.as_chunks().0).collect();
        let mut gradients = vec![[[0.0; D]; M]; shapes.len()];
        let mut strains = vec![Components::default(); found.modes];
        // int p tr(b_a) dV of the functions p of a projected dilatation
        let mut swelling = vec![[0.0; COEFFICIENTS]; found.modes];
        let (mut volume, mut points) = (0.0, 0);
        self.visit(regions, origin, &|_| [], &mut |site, []| {
            let Site { branch, point, at, cell, .. } = site;
            for (own, field) in gradients.iter_mut().zip(&fields) {
                *own = gradient(1, &relative(&self.nodes[*cell], field), &point.gradients);
            }
            strains[0] = site.apart(internal);
            for (k, shape) in gradients.iter().enumerate() {
                strains[1 + k] = at.change(shape);
                for (l, other) in gradients[..=k].iter().enumerate() {
                    let Some(strain) = strains.get_mut(pair(shapes.len(), k, l)) else { break };
                    *strain = match branch.is_quadratic() {
                        true => symmetric(shape, other),
                        false => Components::default(),
                    };
                }
            }
            let (weight, [lambda, mu]) = (point.volume, branch.moduli());
            let group = found.group(branch.time);
            let products = &mut group.products;
            for v in 0..branch.components() {
                let (j, k) = axes::<M>(v);
                let times = if k == j { 2.0 } else { 4.0 };
                products.push([weight * times * mu], strains.iter().map(|strain| strain[v]));
            }
            if self.is_projected() {
                let modes = self.modes_of(*cell, points);
                let values = std::iter::once(1.0).chain(modes.into_iter().flatten());
                for (c, value) in values.enumerate() {
                    for (sums, strain) in swelling.iter_mut().zip(&strains) {
                        sums[c] += weight * value * trace::<M>(strain);
                    }
                }
                (volume, points) = (volume + weight, points + 1);
                if points == Q {
                    for c in 0..self.coefficients() {
                        products.push([lambda / volume], swelling.iter().map(|sums| sums[c]));
                    }
                    swelling.fill([0.0; COEFFICIENTS]);
                    (volume, points) = (0.0, 0);
                }
            } else {
                products.push([weight * lambda], strains.iter().map(trace::<M>));
            }
            for (v, start) in at.strain().into_iter().take(branch.components()).enumerate() {
                group.numbers.push(first + site.first + v);
                group.start.push(start);
                group.rows.extend(strains.iter().map(|strain| strain[v]));
            }
        });
    }
}

/// sym(A^T B)
fn symmetric<const M: usize, const D: usize>(
    a: &Matrix<f64, D, M>,
    b: &Matrix<f64, D, M>,
) -> Components {
    let mut strain = Components::default();
    for (v, component) in strain[..components(M)].iter_mut().enumerate() {
        let (j, k) = axes::<M>(v);
        *component = 0.5 * (dot(&a[j], &b[k]) + dot(&a[k], &b[j]));
    }
    strain
}

impl BranchModes {
    /// Those that were found, along so many shapes.
    pub(super) fn new(shapes: usize, found: ModeSet) -> Self {
        let ModeSet { modes, groups } = found;
        let group = |ModeGroup { time, products, numbers, start, rows }: ModeGroup| {
            let [product] = products.done();
            let column = |mode: usize| rows.iter().skip(mode).step_by(modes).copied();
            Group {
                columns: (0..modes).flat_map(column).collect(),
                strains: vec![0.0; numbers.len()],
                numbers,
                start,
                time,
                product: product.unwrap_or_else(|| Mat::zeros(modes, modes)),
                apart: vec![0.0; modes],
                stress: vec![0.0; modes],
                material: vec![0.0; shapes * shapes],
            }
        };
        Self {
            shapes,
            modes,
            groups: groups.into_iter().map(group).collect(),
            w: vec![0.0; modes],
            room: [vec![0.0; modes], vec![0.0; modes]],
            moved: vec![0.0; shapes],
            changes: vec![0.0; modes * shapes],
            at: [vec![0.0; shapes], vec![0.0; shapes]],
            geometric: vec![0.0; shapes * shapes],
        }
    }

    /// Number of amplitudes g.
    pub(crate) fn unknowns(&self) -> usize {
        self.groups.len() * self.modes
    }

    /// Those at the start.
    pub(crate) fn start(&self) -> Vec<f64> {
        let of_group = |at: usize| if at == 0 { -1.0 } else { 0.0 };
        (0..self.unknowns()).map(|at| of_group(at % self.modes)).collect()
    }

    /// Absolute tolerances of the amplitudes, where that of strains is `strain`.
    pub(crate) fn tolerances(&self, strain: f64) -> Vec<f64> {
        // a mode that strains nothing does not matter
        let tolerance = |most: f64| if most > 0.0 { strain / most } else { 1.0 };
        let columns = self.groups.iter().flat_map(|group| group.columns.chunks(group.start.len()));
        columns.map(|column| tolerance(largest(column))).collect()
    }

    /// Writes the internal strains of all cells for the amplitudes `g`.
    pub(crate) fn lift(&mut self, g: &[f64], strains: &mut [f64]) {
        for (Group { numbers, start, columns, strains: own, .. }, g) in
            self.groups.iter_mut().zip(g.chunks_exact(self.modes))
        {
            own.copy_from_slice(start);
            for (g, column) in g.iter().zip(columns.chunks(start.len())) {
                add_multiple(*g, column, own);
            }
            numbers.iter().zip(own).for_each(|(&number, own)| strains[number] = *own);
        }
    }

    /// Adds the forces along the shapes at `z`, where the amplitudes are `g`, and writes the rates of these; returns the power (W)
    /// that is dissipated.
    pub(crate) fn add_forces(
        &mut self,
        z: &[f64],
        g: &[f64],
        forces: &mut [f64],
        rates: &mut [f64],
    ) -> f64 {
        self.at[0].copy_from_slice(z);
        set_amplitudes(z, &mut self.w);
        let (mut power, modes) = (0.0, self.modes);
        let own = g.chunks_exact(modes).zip(rates.chunks_exact_mut(modes));
        for (Group { time, product, apart, stress, .. }, (g, rates)) in
            self.groups.iter_mut().zip(own)
        {
            for (((apart, rate), w), g) in apart.iter_mut().zip(rates).zip(&self.w).zip(g) {
                *apart = w - g;
                *rate = *apart / *time;
            }
            multiply(product, apart, stress);
            power += inner(apart, stress) / *time;
            for (k, force) in forces.iter_mut().enumerate() {
                *force -= along(stress, k, z);
            }
        }
        power
    }

    /// Updates the tangents to where forces were evaluated last.
    pub(crate) fn update_tangents(&mut self) {
        let Self { shapes, modes, groups, changes, at: [z, place], geometric, .. } = self;
        let s = *shapes;
        place.copy_from_slice(z);
        geometric.fill(0.0);
        for Group { product, stress, material, .. } in groups {
            material.fill(0.0);
            set_changes(product, 1.0, z, changes);
            add_changes(changes, *modes, z, material);
            for k in 0..s {
                for l in 0..s {
                    geometric[k * s + l] += stress.get(pair(s, k, l)).copied().unwrap_or_default();
                }
            }
        }
    }

    /// Adds the stiffness in a step of the parameter `gamma` (s), row by row.
    pub(crate) fn add_stiffness(&self, gamma: f64, stiffness: &mut [f64]) {
        add(&self.geometric, stiffness);
        for Group { time, material, .. } in &self.groups {
            add_multiple(passed(gamma, *time), material, stiffness);
        }
    }

    /// Adds gamma times the generalized spring forces due to the `residuals` of the amplitudes in a step of that
    /// parameter.
    pub(crate) fn add_residuals(&mut self, gamma: f64, residuals: &[f64], right: &mut [f64]) {
        let Self { modes, groups, room: [stress, _], at: [_, z], .. } = self;
        for (Group { time, product, .. }, own) in groups.iter().zip(residuals.chunks_exact(*modes))
        {
            multiply(product, own, stress);
            let factor = gamma * passed(gamma, *time);
            for (k, right) in right.iter_mut().enumerate() {
                *right += factor * along(stress, k, z);
            }
        }
    }

    /// Turns the residuals `x` of the amplitudes into their changes, by those of the coordinates, `xz`. Returns the change of the
    /// power (W) that is dissipated.
    pub(crate) fn solve(&mut self, gamma: f64, xz: &[f64], x: &mut [f64]) -> f64 {
        let Self { modes, groups, w: changes, room: [apart, stress], at: [_, z], moved, .. } = self;
        // the others move as they have to
        moved[..xz.len()].copy_from_slice(xz);
        set_amplitude_changes(z, moved, changes);
        let mut power = 0.0;
        for (Group { time, product, stress: before, .. }, x) in
            groups.iter().zip(x.chunks_exact_mut(*modes))
        {
            let part = passed(gamma, *time);
            for ((x, change), apart) in x.iter_mut().zip(&*changes).zip(&mut *apart) {
                *x = part * *x + (1.0 - part) * change;
                *apart = change - *x;
            }
            multiply(product, apart, stress);
            power += (2.0 * inner(apart, before) + inner(apart, stress)) / *time;
        }
        power
    }
}

/// The part of a change of strain that passes to the spring in a step of the parameter `gamma`.
fn passed(gamma: f64, time: f64) -> f64 {
    1.0 / (1.0 + gamma / time)
}

#[cfg(test)]
mod tests;
