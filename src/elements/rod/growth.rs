//! Growth of rods: strains in which elements are free of stress change with time.
//!
//! With natural strains that have changed by Delta = e D, of a strain e and a direction D, the energy is l (eps - eps_0 - Delta) . K (eps - eps_0 - Delta)/2. What
//! this adds to the [elasticity](super::elements) is linear in the strains eps:
//!
//! ```text
//! l K Delta . (Delta/2 - (eps - eps_0)),   with the power -l K Delta' . (eps - eps_0 - Delta)
//! ```

use std::sync::Arc;

use super::elements::{Dual, RodElement, RodElements, add_row, own};
use super::strain::{Deformed, Number, Section, Strains};
use crate::base::sparse::BlockMatrix;

/// Some elements of a rod, which grow.
pub(crate) struct RodGrowth {
    rod: Arc<RodElements>,
    /// Numbers of elements, and D of each: of shears and stretch, and of curvatures and twist (1/m).
    elements: Vec<(usize, [f64; 6])>,
}

impl RodGrowth {
    /// These elements of a rod, which bend and twist by these natural curvatures and this twist (1/m) per strain, or get longer by the strain.
    pub(crate) fn new(rod: Arc<RodElements>, numbers: &[usize], bends: Option<[f64; 3]>) -> Self {
        let direction = |number: usize| match bends {
            Some([first, second, twist]) => [0.0, 0.0, 0.0, first, second, twist],
            None => {
                let [a, b, c] = rod.elements[number].natural.gamma;
                [a, b, c, 0.0, 0.0, 0.0]
            }
        };
        let elements = numbers.iter().map(|&number| (number, direction(number))).collect();
        Self { rod, elements }
    }

    /// K D, with l its forces along the strains.
    fn stress(element: &RodElement, direction: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|k| element.stiffness[k] * direction[k])
    }

    /// K D . (eps - eps_0), and K D . D, of each element at displacements `u` (m), times its length (J).
    fn each_product(&self, u: &[f64], mut see: impl FnMut(f64, f64)) {
        for (number, direction) in &self.elements {
            let element = &self.rod.elements[*number];
            let stress = Self::stress(element, direction);
            let at = self.rod.state(element, u, true);
            let strains = Deformed::new(element.length, at).strains();
            let (mut by_strain, mut by_growth) = (0.0, 0.0);
            for k in 0..6 {
                let [strain, natural] = [&strains, &element.natural]
                    .map(|of| if k < 3 { of.gamma[k] } else { of.kappa[k - 3] });
                by_strain += stress[k] * (strain - natural);
                by_growth += stress[k] * direction[k];
            }
            see(element.length * by_strain, element.length * by_growth);
        }
    }

    /// Energy (J) that growth by a strain adds at displacements `u` (m).
    pub(crate) fn energy(&self, strain: f64, u: &[f64]) -> f64 {
        let mut energy = 0.0;
        self.each_product(u, |by_strain, by_growth| {
            energy += strain * (0.5 * strain * by_growth - by_strain);
        });
        energy
    }

    /// Power (W) that growth supplies as the strain changes by `rate` (1/s).
    pub(crate) fn power(&self, [strain, rate]: [f64; 2], u: &[f64]) -> f64 {
        let mut power = 0.0;
        self.each_product(u, |by_strain, by_growth| {
            power -= rate * (by_strain - strain * by_growth)
        });
        power
    }

    /// The forces on the ends of an element, with the sign of those that the nodes exert.
    fn acting<T: Number>(
        element: &RodElement,
        stress: [f64; 6],
        at: &[Section<T>; 2],
    ) -> [Section<T>; 2] {
        let [a, b, c, d, e, f] = stress.map(T::from);
        Deformed::new(element.length, *at).forces(Strains { gamma: [a, b, c], kappa: [d, e, f] })
    }

    /// Adds the forces (N) of a strain at displacements `u` (m).
    pub(crate) fn add_forces(&self, strain: f64, u: &[f64], forces: &mut [f64]) {
        let d = self.rod.dimension;
        for (number, direction) in &self.elements {
            let element = &self.rod.elements[*number];
            let stress = Self::stress(element, direction).map(|stress| strain * stress);
            let on = Self::acting(element, stress, &self.rod.state(element, u, true));
            for (end, on) in element.ends.iter().zip(on) {
                end.scatter(d, &on, |v, i, force| forces[end.nodes[v] * d + i] += force);
            }
        }
    }

    /// Adds -df/du.
    pub(crate) fn add_tangents(&self, strain: f64, u: &[f64], stiffness: &mut BlockMatrix) {
        let d = self.rod.dimension;
        for (number, direction) in &self.elements {
            let element = &self.rod.elements[*number];
            let stress = Self::stress(element, direction).map(|stress| strain * stress);
            let at: [Section<Dual>; 2] = self.rod.dual_state(element, u);
            let on = Self::acting(element, stress, &at);
            for (end, on) in element.ends.iter().zip(on) {
                end.scatter(d, &on, |v, i, force| {
                    let row = end.nodes[v];
                    add_row(stiffness, &element.ends, d, row, i, |end, w, j| {
                        -force.eps.0.map_or(0.0, |slopes| slopes[own(d, [end, w, j])])
                    });
                });
            }
        }
    }
}
