//! The force of a fluid on faces.
//!
//! Over a closed surface the pressure p = W d by the depth d has the potential
//!
//! ```text
//! U = int p dV = int (W/2) d^2 (e . n) dA,   e the direction of gravity,
//! ```
//!
//! which is integrated at the quadrature points of the faces. The nodal forces are -dU/du of that sum. So they have a potential to
//! round-off, also where the surface of the fluid crosses a face; their sum has no part across e; and it is
//! the weight of the fluid in the place of the body wherever the rule integrates d n exactly, as it does on faces that are below the surface.
//! On faces that are not closed, they are those of p at the quadrature points.

use super::rods::RodDrag;
use super::traction::{Depth, Drag, Matrix};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{cross, dot};
use crate::elements::force::{Capabilities, Force, NodalForces, Reservoir, Tangents};
use crate::integrators::ode::Failure;
use crate::scene::forces::followed::{Followed, FollowedFaces, add_block, cross_with};
use crate::scene::forces::signal::{VectorSignal, finite_at};

/// The force of a fluid.
pub(crate) struct FluidForce {
    /// Source of its velocity.
    pub(super) input: String,
    pub(super) faces: FollowedFaces,
    pub(super) rods: Vec<RodDrag>,
    pub(super) drag: Option<Drag>,
    pub(super) depth: Option<Depth>,
    /// Whether the faces are a closed surface.
    pub(super) is_closed: bool,
    pub(super) velocity: Option<VectorSignal>,
    /// Mass (kg) that moves along with pairs of nodes.
    pub(super) carried: Vec<([usize; 2], f64)>,
}

impl FluidForce {
    /// The velocity of the fluid at time `t`.
    fn current(&self, t: f64) -> [f64; 3] {
        let mut current = [0.0; 3];
        if let Some(velocity) = &self.velocity {
            velocity.at(t, &mut current[..self.faces.dimension]);
        }
        current
    }

    /// Each force (N) on a node, by what it does to the energy. Returns the power (W) by which a current carries bodies along.
    fn each(
        &self,
        current: [f64; 3],
        u: &[f64],
        v: &[f64],
        mut see: impl FnMut(Kind, usize, [f64; 3]),
    ) -> f64 {
        let d = self.faces.dimension;
        let mut power = 0.0;
        for rod in &self.rods {
            power += rod.each(&current, [u, v], d, |node, force| see(Kind::Drag, node, force));
        }
        self.faces.each_point(u, |at| {
            let facing = at.facing();
            let nodes = || at.nodes.iter().copied().zip(at.point.values);
            if let Some(drag) = &self.drag {
                let traction = drag.traction(&relative(at, v, &current, d), &facing);
                let force = traction.map(|x| at.point.weight * x);
                nodes().for_each(|(node, share)| see(Kind::Drag, node, force.map(|x| share * x)));
                power += dot(&force, &current);
            }
            if let Some(open) = self.open() {
                let pressure = at.point.weight * open.weight * open.at(&at.place());
                let force = facing.map(|n| -pressure * n);
                nodes().for_each(|(node, share)| see(Kind::Open, node, force.map(|x| share * x)));
            }
            if let Some(closed) = self.closed() {
                let depth = closed.at(&at.place());
                let factor = -at.point.weight * closed.weight * depth;
                let up = factor * dot(&closed.down, &facing);
                for ((node, share), c) in nodes().zip(at.turning()) {
                    let turned = cross(&closed.down, &c);
                    let component =
                        |i: usize| up * share * closed.down[i] + 0.5 * factor * depth * turned[i];
                    see(Kind::Closed, node, std::array::from_fn(component));
                }
            }
        });
        power
    }

    /// The sum of its forces (N), on all nodes or those that `is_read` names.
    pub(crate) fn on(&self, t: f64, u: &[f64], v: &[f64], is_read: Option<&[bool]>) -> [f64; 3] {
        self.in_current(self.current(t), u, v, is_read)
    }

    /// That sum in a current of this velocity (m/s).
    pub(crate) fn in_current(
        &self,
        current: [f64; 3],
        u: &[f64],
        v: &[f64],
        is_read: Option<&[bool]>,
    ) -> [f64; 3] {
        let mut sum = [0.0; 3];
        self.each(current, u, v, |_, node, force| {
            if is_read.is_none_or(|is_read| is_read[node]) {
                sum.iter_mut().zip(force).for_each(|(sum, force)| *sum += force);
            }
        });
        sum
    }

    /// The potential of the pressure, if that is where it is integrated.
    fn closed(&self) -> Option<&Depth> {
        self.depth.as_ref().filter(|_| self.is_closed)
    }

    /// The pressure at points, if it is integrated there.
    fn open(&self) -> Option<&Depth> {
        self.depth.as_ref().filter(|_| !self.is_closed)
    }
}

/// Kind of a fluid force, by its effect on the energy.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// Pressure on a closed surface, which has a potential.
    Closed,
    /// Drag, which becomes heat.
    Drag,
    /// Pressure on other faces, which is a load.
    Open,
}

/// The velocity (m/s) of a point, where nodes have the velocities `v`, less that of the fluid.
fn relative(at: &Followed, v: &[f64], current: &[f64; 3], dimension: usize) -> [f64; 3] {
    let mut velocity = current.map(|w| -w);
    for (node, share) in at.nodes.iter().zip(at.point.values) {
        let of_node = &v[node * dimension..][..dimension];
        velocity.iter_mut().zip(of_node).for_each(|(w, v)| *w += share * v);
    }
    velocity
}

impl Force for FluidForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        for w in self.current(t) {
            finite_at(t, format_args!("{}", self.input), w)?;
        }
        let d = self.faces.dimension;
        let power = self.each(self.current(t), u, v, |kind, node, force| {
            let of_kind = match kind {
                Kind::Closed => &mut forces.conservative,
                Kind::Drag => &mut forces.dissipative,
                Kind::Open => &mut forces.applied,
            };
            let own = of_kind[node * d..][..d].iter_mut();
            own.zip(force).for_each(|(own, force)| *own += force);
        });
        // heat is counted by the velocity relative to the fluid; the current supplies the rest
        forces.carried_heat += power;
        forces.carried_power += power;
        Ok(())
    }

    /// With T the traction times the area, c_b of [`turning`](Followed::turning): -df_a/du_b is
    /// -N_a (dT/d(n J) [c_b x] + N_b dT/dx), -df_a/dv_b is -N_a N_b dT/dw, and where the point is below the surface
    /// the second derivative of U adds W times [`bending`](Followed::bending).
    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let (d, current) = (self.faces.dimension, self.current(t));
        for rod in &self.rods {
            rod.each_tangent(&current, [u, v], d, |pair, [by_u, by_velocity]| {
                add_block(stiffness, pair, 1.0, &by_u);
                add_block(damping, pair, 1.0, &by_velocity);
            });
        }
        self.faces.each_point(u, |at| {
            let facing = at.facing();
            let [mut by_facing, mut by_velocity, mut by_place] = [[[0.0; 3]; 3]; 3];
            if let Some(drag) = &self.drag {
                [by_facing, by_velocity] = drag.derivatives(&relative(at, v, &current, d), &facing);
            }
            let depth = self.depth.as_ref().map_or(0.0, |depth| depth.at(&at.place()));
            if let Some(Depth { weight, down, .. }) = self.open().filter(|_| depth > 0.0) {
                for i in 0..3 {
                    by_facing[i][i] += weight * depth;
                    (0..3).for_each(|j| by_place[i][j] = weight * facing[i] * down[j]);
                }
            }
            let closed = self.closed().filter(|_| depth > 0.0);
            for (b, (column, c)) in at.nodes.iter().zip(at.turning()).enumerate() {
                let turned = product(&by_facing, &cross_with(c));
                let share = at.point.values[b];
                let by_u: Matrix = std::array::from_fn(|i| {
                    std::array::from_fn(|j| turned[i][j] + share * by_place[i][j])
                });
                for (a, (row, from)) in at.nodes.iter().zip(at.turning()).enumerate() {
                    let (pair, factor) = ([*row, *column], at.point.weight * at.point.values[a]);
                    add_block(stiffness, pair, factor, &by_u);
                    add_block(damping, pair, factor * share, &by_velocity);
                    if let Some(closed) = closed {
                        let hessian = at.bending(&closed.down, depth, &facing, [(a, from), (b, c)]);
                        add_block(stiffness, pair, at.point.weight * closed.weight, &hessian);
                    }
                }
            }
        });
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let Some(closed) = self.closed() else { return 0.0 };
        let mut potential = 0.0;
        self.faces.each_point(u, |at| {
            let depth = closed.at(&at.place());
            let under = 0.5 * closed.weight * depth * depth * dot(&closed.down, &at.facing());
            potential += at.point.weight * under;
        });
        potential
    }

    fn reservoir(&self) -> Reservoir {
        match self.closed() {
            Some(_) => Reservoir::Gravity,
            None => Reservoir::None,
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { carried: &self.carried, ..Capabilities::default() }
    }
}

/// A B
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
