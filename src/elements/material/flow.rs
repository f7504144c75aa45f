//! Flow rule of the internal strain of a branch with a yield stress.
//!
//! With the spring's stress S, its von Mises stress q and its shearing part Pi S, G' = f Pi S / (2 mu tau),
//! f = max(0, 1 - Y/q), is the gradient of <q - Y>^2 / (6 mu tau) by S. So S : G' >= 0, and the stiffness in
//! a step of gamma, C P = (C^-1 + gamma dG'/dS)^-1 with C = dS/dE, is symmetric. It is isotropic but for the
//! direction of the flow, and has a closed form: for a strain of n dimensions, its spherical part being its
//! sphere,
//!
//! ```text
//! Pi = I on deviators, (3 - n)/3 on spheres;   q^2 = (3/2) S : Pi S
//! C  = 2 mu on deviators, n lambda + 2 mu on spheres
//! 2 mu tau dG'/dS = f Pi + (3 Y / 2 q^3) (Pi S) (Pi S)^T
//! ```
//!
//! n is 3 where the cell fills space, and in plane strain, where G has a component across the plane. Where
//! there is no stress across a cell, n is the cell's dimension: Pi S is the part along the cell of Pi S in
//! three dimensions, and the strain across follows.
//!
//! P is evaluated at the state of the last matrix, as K is. The rate has a kink where flow begins and nowhere
//! else, which step size control passes.

use super::hooke::{Hooke, Plane};

/// Components of a symmetric tensor of cells of `dimension`.
pub(crate) const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

/// A strain by its components, as [`axes`](super::response::axes) counts them; 0 where cells have none. In
/// the plane the component across comes after the others.
pub(crate) type Components = [f64; components(3)];

/// Whether a component is on the diagonal, in cells of dimension `M`.
const fn is_normal<const M: usize>(component: usize) -> bool {
    component < M || M == 2 && component == 3
}

pub(crate) fn trace<const M: usize>(strain: &Components) -> f64 {
    let sum = strain[..M].iter().sum::<f64>();
    if M == 2 { sum + strain[3] } else { sum }
}

/// A : B
fn dot<const M: usize>(a: &Components, b: &Components) -> f64 {
    let times = |v: usize| if is_normal::<M>(v) { 1.0 } else { 2.0 };
    (0..a.len()).map(|v| times(v) * a[v] * b[v]).sum()
}

/// Effect of a change X of the strain on E - G in a step: P X = `part` (X + `swelling` times its
/// sphere - `drop` times `back` (`along` : X)).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) part: f64,
    pub(crate) swelling: f64,
    pub(crate) drop: f64,
    pub(crate) along: Components,
    back: Components,
    /// n
    axes: f64,
}

impl Step {
    /// The same `part` of all strains.
    pub(crate) fn of_all(part: f64) -> Self {
        let none = Components::default();
        Self { part, swelling: 0.0, drop: 0.0, along: none, back: none, axes: 3.0 }
    }

    /// P X over `part`.
    pub(crate) fn passed<const M: usize>(&self, strain: &Components) -> Components {
        let taken = self.drop * dot::<M>(&self.along, strain);
        let mut passed = sphered::<M>(strain, self.axes, 1.0 + self.swelling, 1.0);
        passed.iter_mut().zip(self.back).for_each(|(x, back)| *x -= taken * back);
        passed
    }

    /// The lambda that acts like a `modulus` on spheres: `modulus` / n.
    pub(crate) fn of_mean(&self, modulus: f64) -> f64 {
        modulus / self.axes
    }
}

/// The strain with its sphere and its deviator times these factors, in `axes` dimensions.
fn sphered<const M: usize>(
    strain: &Components,
    axes: f64,
    sphere: f64,
    deviator: f64,
) -> Components {
    let mean = (sphere - deviator) * trace::<M>(strain) / axes;
    std::array::from_fn(|v| {
        let is_in = v < M || is_normal::<M>(v) && axes == 3.0;
        deviator * strain[v] + if is_in { mean } else { 0.0 }
    })
}

/// A branch with a yield stress.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flowing {
    /// Y (Pa)
    yield_stress: f64,
    /// 2 mu (Pa)
    shear: f64,
    /// (n lambda + 2 mu) / 2 mu
    bulk: f64,
    /// n
    axes: f64,
    /// Pi on spheres.
    share: f64,
}

/// The direction and the von Mises stress of a flow.
struct Flow {
    /// Pi S / 2 mu
    along: Components,
    /// q (Pa)
    mises: f64,
}

impl Flowing {
    /// With a yield stress (Pa) above 0.
    pub(super) fn new(hooke: &Hooke, dimension: usize, yield_stress: f64) -> Self {
        let fills = dimension == 3 || hooke.across == Plane::Strain;
        let axes = if fills { 3.0 } else { dimension as f64 };
        let shear = 2.0 * hooke.lame.mu;
        let bulk = 1.0 + axes * hooke.lame.lambda / shear;
        Self { yield_stress, shear, bulk, axes, share: (3.0 - axes) / 3.0 }
    }

    /// Whether G has a component across cells of `dimension`.
    pub(super) fn strains_across(&self, dimension: usize) -> bool {
        dimension == 2 && self.axes == 3.0
    }

    fn flow<const M: usize>(&self, apart: &Components) -> Flow {
        let along = sphered::<M>(apart, self.axes, self.share * self.bulk, 1.0);
        let stress = sphered::<M>(apart, self.axes, self.bulk, 1.0);
        let square = 1.5 * dot::<M>(&along, &stress);
        Flow { along, mises: self.shear * square.max(0.0).sqrt() }
    }

    /// tau G'
    pub(super) fn towards<const M: usize>(&self, apart: &Components) -> Components {
        let Flow { along, mises } = self.flow::<M>(apart);
        match mises > self.yield_stress {
            true => along.map(|along| (1.0 - self.yield_stress / mises) * along),
            false => Components::default(),
        }
    }

    /// tau S : G' (J/m^3)
    pub(super) fn loss<const M: usize>(&self, apart: &Components) -> f64 {
        let Flow { mises, .. } = self.flow::<M>(apart);
        (mises - self.yield_stress).max(0.0) * mises / (1.5 * self.shear)
    }

    /// The change of tau S : G' with a small change of E - G: (2 - Y/q) C Pi S : `change` / (2 mu).
    pub(super) fn loss_change<const M: usize>(
        &self,
        apart: &Components,
        change: &Components,
    ) -> f64 {
        let Flow { along, mises } = self.flow::<M>(apart);
        if mises <= self.yield_stress {
            return 0.0;
        }
        let pull = sphered::<M>(&along, self.axes, self.bulk, 1.0);
        (2.0 - self.yield_stress / mises) * self.shear * dot::<M>(&pull, change)
    }

    /// The step of the parameter gamma/tau = `gamma`.
    pub(super) fn step<const M: usize>(&self, gamma: f64, apart: &Components) -> Step {
        let Flow { along, mises } = self.flow::<M>(apart);
        if mises <= self.yield_stress {
            return Step { axes: self.axes, ..Step::of_all(1.0) };
        }
        let rate = gamma * (1.0 - self.yield_stress / mises);
        let deviator = 1.0 / (1.0 + rate);
        let sphere = 1.0 / (1.0 + rate * self.share * self.bulk);
        let turned = sphered::<M>(&along, self.axes, self.bulk * sphere, deviator);
        let back = sphered::<M>(&along, self.axes, sphere, deviator);
        let turning = 1.5 * gamma * self.yield_stress * self.shear.powi(2) / mises.powi(3);
        let drop = turning / (1.0 + turning * dot::<M>(&along, &turned)) / deviator;
        let swelling = sphere / deviator - 1.0;
        Step { part: deviator, swelling, drop, along: turned, back, axes: self.axes }
    }
}
