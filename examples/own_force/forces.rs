//! A magnet and a wind: forces that are not of the crate, by its public API only.

use pliant::Body;
use pliant::force::{Force, NodalForces, Reservoir, Tangents};
use pliant::ode::Failure;
use pliant::sparse::BlockMatrix;

/// A magnet at a point attracts what is magnetic in a body of the plane. With the distance r of a node and its share m
/// of the mass, the potential is
///
/// U = - strength m / (r^2 + size^2)^(3/2)
///
/// as that of a dipole, rounded off within the `size` of the magnet.
pub struct Magnet {
    /// Where it is (m).
    place: [f64; 2],
    /// J m^3 / kg
    strength: f64,
    /// m
    size: f64,
    /// Where the nodes are in the undeformed shape (m).
    natural: Vec<f64>,
    /// Mass of each node (kg).
    masses: Vec<f64>,
}

impl Magnet {
    /// A magnet of this `strength` (J m^3/kg) and `size` (m, above 0) at `place` (m).
    pub fn new(body: &Body, place: [f64; 2], strength: f64, size: f64) -> Self {
        let natural = body.mesh().positions().to_vec();
        Self { place, strength, size, natural, masses: body.nodal_masses() }
    }

    /// From the magnet to node `n` (m), and r^2 + size^2 (m^2).
    fn arm(&self, n: usize, u: &[f64]) -> ([f64; 2], f64) {
        let d = [0, 1].map(|i| self.natural[2 * n + i] + u[2 * n + i] - self.place[i]);
        (d, d[0] * d[0] + d[1] * d[1] + self.size * self.size)
    }
}

impl Force for Magnet {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        for (n, mass) in self.masses.iter().enumerate() {
            let (d, square) = self.arm(n, u);
            let pull = 3.0 * self.strength * mass / square.powf(2.5);
            (0..2).for_each(|i| forces.conservative[2 * n + i] -= pull * d[i]);
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        for (n, mass) in self.masses.iter().enumerate() {
            let (d, square) = self.arm(n, u);
            let pull = 3.0 * self.strength * mass / square.powf(2.5);
            let Some(block) = stiffness.block_mut(n, n) else { continue };
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let same = if i == j { 1.0 } else { 0.0 };
                block[2 * i + j] += pull * (same - 5.0 * d[i] * d[j] / square);
            }
        }
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let one = |(n, mass): (usize, &f64)| -self.strength * mass / self.arm(n, u).1.powf(1.5);
        self.masses.iter().enumerate().map(one).sum()
    }

    /// The nearest there is: `Energy::springs`.
    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }
}

/// A wind with a drag that grows with the square of the speed: each node feels
///
/// f = (drag/2) |w - v| (w - v)
///
/// where w is the velocity of the air. What it takes from the motion relative to the air becomes heat,
/// f.(w - v) >= 0; the air gives f.w.
pub struct Wind {
    /// Velocity of the air (m/s) at a time (s).
    velocity: fn(f64) -> [f64; 2],
    /// Density of the air times area times drag coefficient of each node (kg/m).
    drag: f64,
    nodes: Vec<usize>,
}

impl Wind {
    /// Air of this `velocity` that blows at `nodes`, counted from 0, with this `drag` (kg/m) each.
    pub fn new(nodes: Vec<usize>, drag: f64, velocity: fn(f64) -> [f64; 2]) -> Self {
        Self { velocity, drag, nodes }
    }

    /// w and w - v at node `n`, and its size (m/s).
    fn stream(&self, n: usize, t: f64, v: &[f64]) -> ([f64; 2], [f64; 2], f64) {
        let air = (self.velocity)(t);
        let past = [air[0] - v[2 * n], air[1] - v[2 * n + 1]];
        (air, past, past[0].hypot(past[1]))
    }
}

impl Force for Wind {
    fn add_forces(
        &self,
        t: f64,
        _u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        for &n in &self.nodes {
            let (air, past, speed) = self.stream(n, t, v);
            for i in 0..2 {
                let force = 0.5 * self.drag * speed * past[i];
                forces.dissipative[2 * n + i] += force;
                // the heat is force.(w - v), of which -force.v is counted with the dissipative forces
                forces.carried_heat += force * air[i];
                forces.carried_power += force * air[i];
            }
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        _u: &[f64],
        v: &[f64],
        _stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        for &n in &self.nodes {
            let (_, past, speed) = self.stream(n, t, v);
            let Some(block) = damping.block_mut(n, n).filter(|_| speed > 0.0) else { continue };
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let same = if i == j { speed } else { 0.0 };
                block[2 * i + j] += 0.5 * self.drag * (same + past[i] * past[j] / speed);
            }
        }
        Tangents::Added
    }
}
