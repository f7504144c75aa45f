//! The spring and the damper of a Maxwell branch at large strains, beside a law of rubber.
//!
//! With the metric C_v = I + 2 G of the shape in which the spring has no stress, and X = C_v^-1 C - I, which has the invariants of
//! 2 E_e, J^2 = det(I + X), r = J^(-2/3), theta = ln J (S. Reese, S. Govindjee, International Journal of Solids and Structures 35
//! (1998) 3455-3482; A. Kumar, O. Lopez-Pamies, Comptes Rendus Mécanique 344 (2016) 102-112):
//!
//! ```text
//! W = (mu/2) (r (tr X + 3) - 3) + (kappa/2) theta^2,   S = (mu r dev X + kappa theta I) C^-1
//! C_v' = C_v (f r dev X + (2/3) theta I) / tau,        f = 1
//! heat = (f q^2 / (3 mu) + kappa theta^2) / tau,       q^2 = (3/2) mu^2 r^2 tr(dev X dev X)
//! ```
//!
//! q is the von Mises stress of the Kirchhoff stress. With a yield stress Y, f = max(0, 1 - Y/q), and a change of volume does not
//! flow. At small strains this is Hooke's law for E - G, and G' = (E - G)/tau. Where there is no stress across a cell, X across
//! follows from that.
//!
//! A point's system of a step has 6 x 6 matrices in place of the factor P of the linear branch. Their part
//! that is not symmetric, of the size of the flow, is left to Newton's iterations.

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::invariants::above_rest;
use crate::elements::material::flow::{Components, components};
use crate::elements::material::response::{Elasticity, axes};

/// Spring and damper.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Maxwell {
    /// mu and kappa of the spring (Pa)
    pub(crate) shear: f64,
    pub(crate) bulk: f64,
    /// tau (s)
    pub(crate) time: f64,
    /// Y (Pa)
    pub(crate) yield_stress: f64,
    /// Whether there is no stress across the cell.
    pub(crate) is_free: bool,
}

/// A point, with the values that its formulas share.
pub(crate) struct Sprung {
    inverse: Matrix3<f64>,
    own: Matrix3<f64>,
    own_inverse: Matrix3<f64>,
    apart: Matrix3<f64>,
    /// Axes across a cell without stress there, and X there.
    free: f64,
    across: f64,
    swelling: f64,
    shrink: f64,
    /// theta
    dilatation: f64,
    /// r dev X
    sheared: Matrix3<f64>,
    mises: f64,
    flow: f64,
}

/// Derivatives of stress, of G' and of the heat (W/m^3), by components of E and of G; columns of those that a cell lacks are 0.
pub(crate) struct Slopes {
    stress: [Matrix6<f64>; 2],
    rate: [Matrix6<f64>; 2],
    heat: [Vector6<f64>; 2],
}

/// A step of the parameter gamma: the change x of G follows from that of E, and from the residual r of the equation of G, by
/// (1 - gamma dG'/dG) x = r + gamma (dG'/dE) dE.
pub(crate) struct Step {
    slopes: Slopes,
    gamma: f64,
    /// (1 - gamma dG'/dG)^-1
    solved: Matrix6<f64>,
}

/// A symmetric matrix from its components along the cell and the diagonal ones `across` it.
fn matrix<const M: usize>(of: &Components, factor: f64, across: [f64; 2]) -> Matrix3<f64> {
    let mut matrix = Matrix3::from_diagonal(&[0.0, across[0], across[1]].into());
    for (v, component) in of[..components(M)].iter().enumerate() {
        let (j, k) = axes::<M>(v);
        matrix[(j, k)] = factor * component;
        matrix[(k, j)] = matrix[(j, k)];
    }
    matrix
}

/// The components of a matrix, in `number`.
fn listed<const M: usize>(matrix: &Matrix3<f64>, number: usize) -> Components {
    let mut listed = Components::default();
    for (v, component) in listed[..number].iter_mut().enumerate() {
        let (j, k) = if M == 2 && v == 3 { (2, 2) } else { axes::<M>(v) };
        *component = 0.5 * (matrix[(j, k)] + matrix[(k, j)]);
    }
    listed
}

fn deviator(x: &Matrix3<f64>) -> Matrix3<f64> {
    x - Matrix3::identity() * (x.trace() / 3.0)
}

/// Its inverse; not a number where there is none.
fn inverse(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    matrix.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN))
}

impl Maxwell {
    /// Components of G in cells of `dimension`: in plane strain there is one across.
    pub(crate) fn components(&self, dimension: usize) -> usize {
        components(dimension) + usize::from(dimension == 2 && !self.is_free)
    }

    /// A point with the strain E and the internal strain G.
    pub(crate) fn at<const M: usize>(&self, strain: &Components, own: &Components) -> Sprung {
        let free = if self.is_free { (3 - M) as f64 } else { 0.0 };
        let unit = Matrix3::identity();
        let solid = |twice: f64| if M == 2 && !self.is_free { [0.0, twice] } else { [0.0; 2] };
        let own_metric = unit + matrix::<M>(own, 2.0, solid(2.0 * own[3]));
        let own_inverse = inverse(&own_metric);
        let mut difference = *strain;
        difference.iter_mut().zip(own).for_each(|(e, g)| *e -= g);
        let mut apart = own_inverse * matrix::<M>(&difference, 2.0, solid(-2.0 * own[3]));
        let mut metric = unit + matrix::<M>(strain, 2.0, [0.0; 2]);
        let across = if self.is_free { self.without_stress(&apart, free) } else { 0.0 };
        for axis in M..if self.is_free { 3 } else { M } {
            apart[(axis, axis)] = across;
            metric[(axis, axis)] = 1.0 + across;
        }
        let swelling = swelling(&apart);
        let shrink = (1.0 + swelling).cbrt().recip();
        let sheared = deviator(&apart) * shrink;
        let mises = self.shear * (1.5 * (sheared * sheared).trace()).max(0.0).sqrt();
        let flow = match self.yield_stress {
            0.0 => 1.0,
            own if mises > own => 1.0 - own / mises,
            _ => 0.0,
        };
        Sprung {
            inverse: inverse(&metric),
            own: own_metric,
            own_inverse,
            apart,
            free,
            across,
            swelling,
            shrink,
            dilatation: 0.5 * swelling.ln_1p(),
            sheared,
            mises,
            flow,
        }
    }

    /// X across a cell that is free to change its thickness, by Newton's method in ln(1 + X).
    fn without_stress(&self, along: &Matrix3<f64>, free: f64) -> f64 {
        /// Most iterations: more than strains of any size take.
        const MOST: usize = 100;
        let area = swelling(along).ln_1p();
        let mut z = -area / free;
        for _ in 0..MOST {
            let x = z.exp_m1();
            let theta = 0.5 * (area + free * z);
            let r = (-2.0 / 3.0 * theta).exp();
            let sheared = x - (along.trace() + free * x) / 3.0;
            let stress = self.shear * r * sheared + self.bulk * theta;
            let change = stress / self.by_across(r, sheared, x, free);
            z -= change.clamp(-1.0, 1.0);
            if change.abs() < 1e-15 {
                break;
            }
        }
        z.exp_m1()
    }

    /// The derivative of the stress across by ln(1 + X).
    fn by_across(&self, r: f64, sheared: f64, x: f64, free: f64) -> f64 {
        let third = free / 3.0;
        self.shear * r * ((1.0 + x) * (1.0 - third) - third * sheared) + 0.5 * self.bulk * free
    }

    /// Whether a change of volume flows.
    fn swells(&self) -> f64 {
        if self.yield_stress > 0.0 { 0.0 } else { 1.0 }
    }

    /// W (J/m^3)
    pub(crate) fn energy(&self, at: &Sprung) -> f64 {
        let [above, _] = above_rest(invariants(&at.apart), at.swelling, at.shrink);
        0.5 * (self.shear * above + self.bulk * at.dilatation * at.dilatation)
    }

    /// Second Piola stress S (Pa), by components along the cell.
    pub(crate) fn stress<const M: usize>(&self, at: &Sprung) -> Components {
        listed::<M>(&self.second(at), components(M))
    }

    /// The same across a cell, where that cannot change its thickness.
    pub(crate) fn stress_across<const M: usize>(&self, at: &Sprung) -> f64 {
        if M == 2 && !self.is_free { self.second(at)[(2, 2)] } else { 0.0 }
    }

    fn second(&self, at: &Sprung) -> Matrix3<f64> {
        let pull = self.bulk * at.dilatation;
        (at.sheared * self.shear + Matrix3::identity() * pull) * at.inverse
    }

    /// G' (1/s)
    pub(crate) fn rate<const M: usize>(&self, at: &Sprung) -> Components {
        let twice = at.own * self.towards(at) / self.time;
        listed::<M>(&(twice * 0.5), self.components(M))
    }

    /// tau C_v^-1 C_v'
    fn towards(&self, at: &Sprung) -> Matrix3<f64> {
        let swells = self.swells() * (2.0 / 3.0) * at.dilatation;
        at.sheared * at.flow + Matrix3::identity() * swells
    }

    /// The heat (W/m^3).
    pub(crate) fn heat(&self, at: &Sprung) -> f64 {
        let of_shear = at.flow * at.mises * at.mises / (3.0 * self.shear);
        (of_shear + self.swells() * self.bulk * at.dilatation * at.dilatation) / self.time
    }

    pub(crate) fn slopes<const M: usize>(&self, at: &Sprung) -> Slopes {
        let [stress, rate] = [[Matrix6::zeros(); 2]; 2];
        let mut slopes = Slopes { stress, rate, heat: [Vector6::zeros(); 2] };
        let second = self.second(at);
        let (along, all) = (components(M), self.components(M));
        for (kind, count) in [along, all].into_iter().enumerate() {
            for v in 0..count {
                let mut unit = Components::default();
                unit[v] = 1.0;
                let across = if M == 2 { 2.0 * unit[3] } else { 0.0 };
                if M == 2 {
                    unit[3] = 0.0;
                }
                let change = matrix::<M>(&unit, 2.0, [0.0, across]);
                let zero = Matrix3::zeros();
                let changes = if kind == 0 { [&change, &zero] } else { [&zero, &change] };
                let (by_sheared, by_theta) = self.changed(at, changes);
                let by_volume = self.bulk * by_theta;
                let [by_metric, by_own] = changes;
                let stress = (by_sheared * self.shear + Matrix3::identity() * by_volume)
                    * at.inverse
                    - second * by_metric * at.inverse;
                let by_square = 3.0 * self.shear.powi(2) * (at.sheared * by_sheared).trace();
                let by_mises = match at.flow > 0.0 && at.mises > 0.0 {
                    true => 0.5 * by_square / at.mises,
                    false => 0.0,
                };
                let by_flow = match self.yield_stress > 0.0 && at.flow > 0.0 {
                    true => self.yield_stress / (at.mises * at.mises) * by_mises,
                    false => 0.0,
                };
                let swells = self.swells() * (2.0 / 3.0) * by_theta;
                let towards =
                    at.sheared * by_flow + by_sheared * at.flow + Matrix3::identity() * swells;
                let rate = (by_own * self.towards(at) + at.own * towards) / (2.0 * self.time);
                let of_shear =
                    (by_flow * at.mises * at.mises + at.flow * by_square) / (3.0 * self.shear);
                let of_volume = 2.0 * self.swells() * at.dilatation * by_volume;
                let heat = (of_shear + of_volume) / self.time;
                slopes.stress[kind].set_column(v, &listed::<M>(&stress, along).into());
                slopes.rate[kind].set_column(v, &listed::<M>(&rate, all).into());
                slopes.heat[kind][v] = heat;
            }
        }
        slopes
    }

    /// The step of the parameter `gamma` (s).
    pub(crate) fn step<const M: usize>(&self, gamma: f64, at: &Sprung) -> Step {
        let slopes = self.slopes::<M>(at);
        let matrix = Matrix6::identity() - slopes.rate[1] * gamma;
        // a singular matrix has no step: NaN reports it to the integrator
        let solved = matrix.try_inverse().unwrap_or_else(|| Matrix6::repeat(f64::NAN));
        Step { slopes, gamma, solved }
    }

    /// The changes of r dev X and of theta with those of C and C_v.
    fn changed(&self, at: &Sprung, [metric, own]: [&Matrix3<f64>; 2]) -> (Matrix3<f64>, f64) {
        let mut apart = at.own_inverse * (metric - own * (Matrix3::identity() + at.apart));
        let mut theta = 0.5 * ((at.inverse * metric).trace() - (at.own_inverse * own).trace());
        if self.is_free {
            for axis in (3 - at.free as usize)..3 {
                apart[(axis, axis)] = 0.0;
            }
            let (r, x) = (at.shrink, at.across);
            let sheared = x - at.apart.trace() / 3.0;
            let stress = self.shear * r * (-2.0 / 3.0 * theta * sheared - apart.trace() / 3.0)
                + self.bulk * theta;
            // the change of ln(1 + X) across
            let across = -stress / self.by_across(r, sheared, x, at.free);
            theta += 0.5 * at.free * across;
            for axis in (3 - at.free as usize)..3 {
                apart[(axis, axis)] = (1.0 + x) * across;
            }
        }
        (deviator(&apart) * at.shrink - at.sheared * (2.0 / 3.0 * theta), theta)
    }
}

impl Step {
    /// The change of G where E changes by `strain` and the residual is `residual`.
    pub(crate) fn own(&self, strain: &Components, residual: &Components) -> Components {
        let [strain, residual] = [strain, residual].map(|x| Vector6::from(*x));
        (self.solved * (residual + self.slopes.rate[0] * strain * self.gamma)).into()
    }

    /// The change of the stress (Pa) with the residual.
    pub(crate) fn stress(&self, residual: &Components) -> Components {
        (self.slopes.stress[1] * (self.solved * Vector6::from(*residual))).into()
    }

    /// The change of the heat (W/m^3) with those of E and of G, to first order.
    pub(crate) fn heat(&self, strain: &Components, own: &Components) -> f64 {
        let [by_strain, by_own] = &self.slopes.heat;
        by_strain.dot(&Vector6::from(*strain)) + by_own.dot(&Vector6::from(*own))
    }

    /// dS/dE of the step (Pa), whose symmetric part is all of it where the flow is slow; the rest is left to the iterations.
    pub(crate) fn elasticity<const M: usize>(&self) -> Elasticity<f64> {
        let [by_strain, by_own] = &self.slopes.stress;
        let passed = by_own * (self.solved * self.slopes.rate[0]) * self.gamma;
        let all = by_strain + passed;
        let mut elasticity = Elasticity::default();
        let of = |v: usize, w: usize| all[(v, w)] / if w < M { 1.0 } else { 2.0 };
        for (v, row) in elasticity.iter_mut().enumerate().take(components(M)) {
            for (w, entry) in row.iter_mut().enumerate().take(components(M)) {
                *entry = 0.5 * (of(v, w) + of(w, v));
            }
        }
        elasticity
    }
}

/// Trace, sum of the principal minors and determinant.
fn invariants(x: &Matrix3<f64>) -> [f64; 3] {
    let minor = |j: usize, k: usize| x[(j, j)] * x[(k, k)] - x[(j, k)] * x[(k, j)];
    [x.trace(), minor(0, 1) + minor(0, 2) + minor(1, 2), x.determinant()]
}

/// det(I + X) - 1
fn swelling(x: &Matrix3<f64>) -> f64 {
    invariants(x).iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRAIN: Components = [0.31, -0.2, 0.12, 0.05, -0.11, 0.17];
    const OWN: Components = [0.12, -0.1, -0.04, 0.09, 0.03, -0.06];

    fn some() -> impl Iterator<Item = Maxwell> {
        let spring = |(yield_stress, is_free)| Maxwell {
            shear: 0.8,
            bulk: 7.0,
            time: 0.3,
            yield_stress,
            is_free,
        };
        [(0.0, false), (0.2, false), (0.0, true), (0.2, true)].into_iter().map(spring)
    }

    fn strained<const M: usize>(spring: &Maxwell) -> [Components; 2] {
        let (mut strain, mut own) = (Components::default(), Components::default());
        strain[..components(M)].copy_from_slice(&STRAIN[..components(M)]);
        own[..spring.components(M)].copy_from_slice(&OWN[..spring.components(M)]);
        [strain, own]
    }

    /// Stress is the derivative of the energy by E, the heat that by G times the flow, and above 0; all other derivatives are
    /// those by central differences of 1e-5, whose errors are 1e-9 of numbers of size 1 to 100.
    #[test]
    fn all_derivatives_are_those_of_differences() {
        fn check<const M: usize>(spring: &Maxwell) {
            let start = strained::<M>(spring);
            let h = 1e-5;
            let at = |[strain, own]: &[Components; 2]| spring.at::<M>(strain, own);
            let here = at(&start);
            let slopes = spring.slopes::<M>(&here);
            let (stress, rate) = (spring.stress::<M>(&here), spring.rate::<M>(&here));
            let mut heat = 0.0;
            for (kind, count) in [components(M), spring.components(M)].into_iter().enumerate() {
                for v in 0..count {
                    let [ahead, behind] = [h, -h].map(|by| {
                        let mut moved = start;
                        moved[kind][v] += by;
                        at(&moved)
                    });
                    let slope = |f: &dyn Fn(&Sprung) -> f64| (f(&ahead) - f(&behind)) / (2.0 * h);
                    let by_energy = slope(&|at| spring.energy(at));
                    let normal = v < M || M == 2 && v == 3;
                    let times = if normal { 1.0 } else { 2.0 };
                    if kind == 0 {
                        let apart = (by_energy - times * stress[v]).abs();
                        assert!(apart < 1e-7, "{M}: stress {v} is off by {apart:e}");
                    } else {
                        heat -= by_energy * rate[v];
                    }
                    let apart = (slope(&|at| spring.heat(at)) - slopes.heat[kind][v]).abs();
                    assert!(apart < 1e-6, "{M}: heat by {kind} {v} is off by {apart:e}");
                    for w in 0..spring.components(M) {
                        let own = slope(&|at| spring.stress::<M>(at)[w]);
                        let apart = (own - slopes.stress[kind][(w, v)]).abs();
                        assert!(apart < 1e-6, "{M}: stress {w} by {kind} {v}: {apart:e}");
                        let own = slope(&|at| spring.rate::<M>(at)[w]);
                        let apart = (own - slopes.rate[kind][(w, v)]).abs();
                        assert!(apart < 1e-6, "{M}: rate {w} by {kind} {v}: {apart:e}");
                    }
                }
            }
            let own = spring.heat(&here);
            assert!(own > 0.01 && (heat - own).abs() < 1e-7, "{M}: {heat} {own}");
        }
        for spring in some() {
            check::<2>(&spring);
            if spring.is_free {
                check::<1>(&spring);
            } else {
                check::<3>(&spring);
            }
        }
    }

    /// At strains of 1e-6 it is Hooke's law for E - G, and G' = (E - G)/tau, to terms of their size.
    #[test]
    fn small_strains_relax_linearly() {
        for spring in some().filter(|spring| spring.yield_stress == 0.0 && !spring.is_free) {
            let small = |of: Components| of.map(|x| 1e-6 * x);
            let at = spring.at::<3>(&small(STRAIN), &small(OWN));
            let (rate, lambda) = (spring.rate::<3>(&at), spring.bulk - 2.0 / 3.0 * spring.shear);
            let stress = spring.stress::<3>(&at);
            let apart: Components = std::array::from_fn(|v| 1e-6 * (STRAIN[v] - OWN[v]));
            let trace: f64 = apart[..3].iter().sum();
            for v in 0..6 {
                assert!((rate[v] * spring.time - apart[v]).abs() < 1e-12, "{v}: {}", rate[v]);
                let hooke =
                    2.0 * spring.shear * apart[v] + if v < 3 { lambda * trace } else { 0.0 };
                assert!((stress[v] - hooke).abs() < 2e-11, "{v}: {} {hooke}", stress[v]);
            }
        }
    }
}
