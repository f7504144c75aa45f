//! Excess stiffness of quadrilaterals and hexahedra in bending, which the jumps of their strains show in part.
//!
//! A beam along x of n layers of square cells bends by the curvature k about z (y across). Their shape functions have its strain
//! e_x = k y, and e_z = -b y in space, but e_y = -g y_m alone, with the middle y_m of the cell, and the shears k x and b z from the
//! middle of the cell. With squares of y in the units h^2/12 of the section, s = 1/n^2 within the cells and 1 - s of their middles,
//! its energy over k^2/2 is
//!
//! ```text
//! lambda ((1 - b - g)^2 (1 - s) + (1 - b)^2 s) + 2 mu (1 + b^2 + g^2 (1 - s)) + mu s (1 + b^2)
//! ```
//!
//! at its minimum over b and g, against E (or E of the plane) of a beam. In jumps between cells are (lambda + 2 mu) g^2 s of it and the
//! shears. Where nu is near 1/2 a change of volume is avoided by a g that is too small, which no jump shows.

use crate::elements::body::{Body, Dilatation};
use crate::elements::material::{Hooke, Lame, Material, Plane};
use crate::elements::mesh::CellKind;

/// The factor by which cells with this part of their energy in jumps make `body` too stiff in bending, of the material with the largest
/// Poisson's ratio; that of the jumps alone for other cells than quadrilaterals and hexahedra that resist a change of volume
/// at each point.
pub(super) fn stiffness(body: &Body, jumps: f64) -> f64 {
    // without jumps, the same displacements would need only the rest of the energy
    let by_jumps = 1.0 / (1.0 - jumps.min(0.99));
    let material = body.materials().max_by(|a, b| a.poisson.total_cmp(&b.poisson));
    let beam = material.and_then(|material| Beam::of(body, material));
    match beam {
        Some(beam) => by_jumps.max(beam.stiffness_at(jumps)),
        None => by_jumps,
    }
}

/// A beam of cells.
struct Beam {
    lambda: f64,
    mu: f64,
    /// Whether it is free to change its width.
    is_solid: bool,
}

impl Beam {
    fn of(body: &Body, material: &Material) -> Option<Self> {
        let is_solid = match body.mesh().kind() {
            CellKind::Hexahedron => true,
            CellKind::Quadrilateral => false,
            _ => return None,
        };
        if body.dilatation() != Dilatation::AtPoints {
            return None;
        }
        let plane = body.plane().unwrap_or(Plane::Strain); // of solids it does not matter
        let hooke = Hooke::new(material.elastic(), body.mesh().kind().dimension(), plane);
        let Lame { lambda, mu } = hooke.lame;
        lambda.is_finite().then_some(Self { lambda, mu, is_solid })
    }

    /// Its stiffness over that of a beam, and the part of its energy in jumps, with `s` = 1/n^2.
    fn bent(&self, s: f64) -> [f64; 2] {
        let Self { lambda, mu, is_solid } = *self;
        let between = 1.0 - s;
        let (b, g) = match is_solid {
            // d/db: (lambda + 2 mu + mu s) b + lambda (1 - s) g = lambda; d/dg: (lambda b + (lambda + 2 mu) g) (1 - s) = lambda (1 - s)
            true => {
                let of_b = lambda + 2.0 * mu + mu * s;
                let stiff = lambda + 2.0 * mu;
                let b = (lambda - lambda * lambda * between / stiff)
                    / (of_b - lambda * lambda * between / stiff);
                (b, lambda * (1.0 - b) / stiff)
            }
            false => (0.0, lambda / (lambda + 2.0 * mu)),
        };
        let shear = mu * s * (1.0 + b * b);
        let volume = (1.0 - b - g).powi(2) * between + (1.0 - b).powi(2) * s;
        let energy =
            lambda * volume + 2.0 * mu * (1.0 + b * b) + 2.0 * mu * g * g * between + shear;
        let beam = match is_solid {
            true => mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu),
            false => 4.0 * mu * (lambda + mu) / (lambda + 2.0 * mu),
        };
        [energy / beam, ((lambda + 2.0 * mu) * g * g * s + shear) / energy]
    }

    /// The stiffness with which this part of the energy is in jumps; that of a single layer where it never is.
    fn stiffness_at(&self, jumps: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            match self.bent(middle)[1] < jumps {
                true => low = middle,
                false => high = middle,
            }
        }
        self.bent(low)[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The minimum against the energy at other b and g, and a beam of many layers against E and E/(1 - nu^2).
    #[test]
    fn the_bent_beam_has_the_least_energy() {
        let (lambda, mu) = (3.1, 0.35);
        for (is_solid, beam) in [
            (true, mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu)),
            (false, 4.0 * mu * (lambda + mu) / (lambda + 2.0 * mu)),
        ] {
            let cells = Beam { lambda, mu, is_solid };
            for s in [1.0, 0.25, 1.0 / 9.0] {
                let energy = |b: f64, g: f64| {
                    lambda * ((1.0 - b - g).powi(2) * (1.0 - s) + (1.0 - b).powi(2) * s)
                        + 2.0 * mu * (1.0 + b * b + g * g * (1.0 - s))
                        + mu * s * (1.0 + b * b)
                };
                let lattice = (0..=400).flat_map(|i| (0..=400).map(move |j| (i, j)));
                let lattice = lattice.filter(|(i, _)| is_solid || *i == 0);
                let least = lattice.map(|(i, j)| energy(i as f64 / 400.0, j as f64 / 400.0));
                let least = least.fold(f64::INFINITY, f64::min) / beam;
                let found = cells.bent(s)[0];
                // the lattice misses the minimum by the square of its width
                assert!(
                    found <= least + 1e-14 && least < found * (1.0 + 2e-5),
                    "{s}: {found} {least}"
                );
            }
            assert!((cells.bent(1e-9)[0] - 1.0).abs() < 1e-8);
        }
    }
}
