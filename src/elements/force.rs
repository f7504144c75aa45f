//! Nodal forces, and the trait [`Force`] of their sources.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use crate::base::simd::add;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::dot;
use crate::integrators::ode::Failure;

/// Nodal forces (N), divided by their effect on the energy of the system.
#[derive(Debug, Clone)]
pub struct NodalForces {
    /// Forces with a potential: -dU/du.
    pub conservative: ForceVector,
    /// Forces that turn motion into heat: their power -f.v is dissipated.
    pub dissipative: ForceVector,
    /// Forces from outside: their power f.v is supplied.
    pub applied: ForceVector,
    /// Power (W) that obstacles in motion add to the heat: their own velocity times the
    /// dissipative forces on the body.
    pub carried_heat: f64,
    /// Power (W) that keeps obstacles in motion: their velocity times their forces on the body.
    pub carried_power: f64,
}

impl NodalForces {
    /// No forces on `dofs` degrees of freedom.
    pub fn zeros(dofs: usize) -> Self {
        let none = ForceVector { values: vec![0.0; dofs], is_zero: true };
        Self {
            conservative: none.clone(),
            dissipative: none.clone(),
            applied: none,
            carried_heat: 0.0,
            carried_power: 0.0,
        }
    }

    /// Sets all forces to 0.
    pub fn clear(&mut self) {
        self.conservative.clear();
        self.dissipative.clear();
        self.applied.clear();
        (self.carried_heat, self.carried_power) = (0.0, 0.0);
    }

    /// Writes the sum of all forces.
    pub(crate) fn add_up(&self, total: &mut [f64]) {
        total.copy_from_slice(&self.conservative);
        for part in [&self.dissipative, &self.applied] {
            if !part.is_zero {
                add(part, total);
            }
        }
    }

    /// Power that is dissipated and power that is supplied (W) at the velocities `v`.
    pub(crate) fn powers(&self, v: &[f64]) -> (f64, f64) {
        let (dissipated, supplied) = self.work(v);
        (dissipated + self.carried_heat, supplied + self.carried_power)
    }

    /// Energy that is dissipated and energy that is supplied (J) along the displacements `x`.
    pub(crate) fn work(&self, x: &[f64]) -> (f64, f64) {
        (-self.dissipative.work(x), self.applied.work(x))
    }
}

/// Nodal forces (N) of one kind: a slice that remembers whether anything was added, and costs nothing if not.
#[derive(Debug, Clone)]
pub struct ForceVector {
    values: Vec<f64>,
    /// Whether it has not been borrowed mutably since it was cleared.
    is_zero: bool,
}

impl ForceVector {
    /// Whether nothing was added.
    pub(crate) fn is_zero(&self) -> bool {
        self.is_zero
    }

    fn clear(&mut self) {
        if !self.is_zero {
            self.values.fill(0.0);
            self.is_zero = true;
        }
    }

    /// Work (J) along the displacements `x`.
    fn work(&self, x: &[f64]) -> f64 {
        if self.is_zero { 0.0 } else { dot(&self.values, x) }
    }
}

impl Deref for ForceVector {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}

impl DerefMut for ForceVector {
    fn deref_mut(&mut self) -> &mut [f64] {
        self.is_zero = false;
        &mut self.values
    }
}

/// Where the potential energy of a force is accounted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reservoir {
    /// Strain energy.
    Strain,
    /// Gravitational energy.
    Gravity,
    /// Energy stored in penalty springs at obstacles.
    Contact,
    /// Energy of springs, and of gas and liquids in chambers.
    Springs,
    /// None: the force has no potential.
    None,
}

/// A step that an integrator has taken: the states at both ends.
pub struct Step<'a> {
    /// Times (s).
    pub times: [f64; 2],
    /// Displacements (m).
    pub u: [&'a [f64]; 2],
    /// Velocities (m/s).
    pub v: [&'a [f64]; 2],
}

impl Step<'_> {
    /// A bound (m) on how far any node moves, if each component of a displacement follows the cubic that has
    /// its values and velocities at both ends.
    pub(crate) fn reach(&self, dimension: usize) -> f64 {
        let third = (self.times[1] - self.times[0]) / 3.0;
        let ([u0, u1], [v0, v1]) = (self.u, self.v);
        let largest = u0.iter().zip(u1).zip(v0.iter().zip(v1)).fold(
            0.0_f64,
            |largest, ((u0, u1), (v0, v1))| {
                let (first, last) = (third * v0, third * v1);
                largest.max(first.abs() + (u1 - u0 - first - last).abs() + last.abs())
            },
        );
        largest * (dimension as f64).sqrt()
    }
}

/// Where the tangents of a force come from, as [`Force::add_tangents`] returns it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangents {
    /// The force has added them.
    Added,
    /// Finite differences of [`Force::add_forces`] stand in for them.
    ByDifferences,
}

/// A force that depends on time t (s), displacements u (m) and velocities v (m/s) of the nodes.
///
/// [`Scene::force`](crate::Scene::force) adds one of any crate to a scene. It has to implement
/// [`add_forces`](Self::add_forces), and with a conservative part [`potential`](Self::potential) and
/// [`reservoir`](Self::reservoir); the rest is for forces that couple distant nodes, have kinks or should
/// cost less.
///
/// # What a force may rely on, and what it has to keep
///
/// - `u` and `v` have dimension components for each node of the body, node after node.
/// - Integrators evaluate the force at trial points: in any order, back and forth in time, off the motion,
///   more than once. The force is a function of (t, u, v) (and of held switches) alone, without a memory of
///   earlier calls. Values that are not finite are refused like [`Failure::Recoverable`].
/// - One simulation calls from one thread at a time, though not always the same. Clones of a scene and forks
///   of a simulation share their forces, so those that run on several threads call at the same time. They
///   share held switches, too, so a force with switches is for one simulation at a time.
/// - The conservative part is -dU/du of the [`potential`](Self::potential) U: [`NodalForces`] says which part
///   counts as heat and which as supplied. The energy balance of the report shows what a force does not
///   account for.
/// - [`hold_switches`](Self::hold_switches) is called with `None` at the start of a phase and after each
///   change of the integrator. If contact events are located, it is then called with the switches as they are
///   at that time, and again after each event.
/// - A panic passes through all integrators, those in C included, to the caller of
///   [`Scene::simulate`](crate::Scene::simulate). A [`Simulation`](crate::Simulation) turns it into an error,
///   and can continue from the step before.
pub trait Force: Send + Sync {
    /// Adds the force at (t, u, v).
    ///
    /// # Errors
    /// [`Failure::Recoverable`] where the force has no meaning (an inverted cell, a spring without
    /// length): the integrator retries with a smaller step, and reports the message if that does
    /// not help.
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure>;

    /// Checks a step after it was taken, to time `t`, from displacements `before` to `after`.
    ///
    /// # Errors
    /// A step that leapt over states in which the force has no meaning.
    fn check_step(&self, _t: f64, _before: &[f64], _after: &[f64]) -> Result<(), Failure> {
        Ok(())
    }

    /// Adds -df/du to `stiffness` and -df/dv to `damping`. They need not be symmetric: the Newton
    /// matrix takes their symmetric part.
    ///
    /// A force that leaves this out (and returns [`Tangents::ByDifferences`], without adding anything) gets
    /// finite differences of [`add_forces`](Self::add_forces). They cost one evaluation at the state itself
    /// and, for each of the two matrices: one if the force does not depend on u (or v); else one more than
    /// the dimension of space if it acts on each node by itself, and several times as many if it couples
    /// nodes. The report gives their number. A force whose [`is_nonlinear`](Self::is_nonlinear) is false has
    /// no tangents.
    fn add_tangents(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        _stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        Tangents::ByDifferences
    }

    /// Adds, node by node, bounds on how much -df/du (to `stiffness`, N/m) and -df/dv (to `damping`, N s/m)
    /// may suddenly grow: by points that do not touch yet, and by points that slide and may stick.
    fn add_reserves(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        _stiffness: &mut [f64],
        _damping: &mut [f64],
    ) {
    }

    /// Whether the force depends on u or v, so that the Newton matrix must follow it. For a force that
    /// changes with time alone, `false` saves the search for its tangents.
    fn is_nonlinear(&self) -> bool {
        true
    }

    /// Potential energy (J) of the conservative part.
    fn potential(&self, _t: f64, _u: &[f64]) -> f64 {
        0.0
    }

    /// Where that energy belongs.
    fn reservoir(&self) -> Reservoir {
        Reservoir::None
    }

    /// Velocity (m/s) at time `t` (s) of the source of the force, if it moves by itself: an obstacle.
    fn velocity(&self, _t: f64) -> Option<[f64; 3]> {
        None
    }

    /// Number of switches: functions whose change of sign is a kink or a jump of the force.
    fn switches(&self) -> usize {
        0
    }

    /// Writes the values of the switches: above 0 where a part of the force is off.
    fn switch_values(&self, _t: f64, _u: &[f64], _v: &[f64], _values: &mut [f64]) {}

    /// Keeps each switch on or off, whatever its value, so that the force is smooth; `None` lets all
    /// of them act by their values again.
    fn hold_switches(&self, _on: Option<&[bool]>) {}

    /// The name of the body or obstacle in frictional contact, and whether the points that press there slide, by the held
    /// switches: all (`Some(true)`), none (`Some(false)`) or some (`None`).
    ///
    /// `None` without held switches, contact or friction.
    fn slides(&self) -> Option<(&str, Option<bool>)> {
        None
    }

    /// A time (s) within a step at which a part of the force acts that the ends of the step do not
    /// show, as they lie before and behind an obstacle. Depths below `tolerance` (m) do not matter.
    ///
    /// `clearances` has a number for each switch: a bound (m) on how far the body can still move without a
    /// change of that switch. 0 is always right; the search updates it.
    fn passage(&self, _step: &Step, _tolerance: f64, _clearances: &mut [f64]) -> Option<f64> {
        None
    }

    /// Whether [`passage`](Self::passage) is to be asked after each step.
    fn can_be_passed(&self) -> bool {
        self.switches() > 0
    }

    /// Extra unknowns beside u and v on which this force depends, if any. The other functions then use their initial
    /// values.
    #[doc(hidden)]
    fn flow(&self) -> Option<&dyn Flow> {
        None
    }

    /// Mass (kg) of the surroundings that moves along with pairs of nodes that share a cell, the same in all phases: it is
    /// added to m of M = m (x) I.
    #[doc(hidden)]
    fn carried(&self) -> &[([usize; 2], f64)] {
        &[]
    }

    /// Whether it only keeps rigid pieces in their shape, as their edges do where they are constraints.
    #[doc(hidden)]
    fn keeps_rigid(&self) -> bool {
        false
    }

    /// Whether it is a sum over cells, of which a reduced model takes a [sample](Self::sample).
    #[doc(hidden)]
    fn is_by_cells(&self) -> bool {
        false
    }

    /// The same force by some of the cells, each with a weight, on a pattern that couples their nodes.
    #[doc(hidden)]
    fn sample(
        &self,
        _weights: &BTreeMap<usize, f64>,
        _pattern: &NodePattern,
    ) -> Option<Arc<dyn Force>> {
        None
    }

    /// Whether it has a [generalized](Self::generalized) form along so many shapes that is exact, and less work.
    #[doc(hidden)]
    fn is_exact_along(&self, _shapes: usize) -> bool {
        false
    }

    /// The same force along `shapes` (m) from displacements `origin` (m), if it [has](Self::is_exact_along) that form.
    #[doc(hidden)]
    fn generalized(
        &self,
        _origin: &[f64],
        _shapes: &[&[f64]],
    ) -> Option<Box<dyn GeneralizedForce>> {
        None
    }

    /// Nodes (counted from 0) that it depends on or acts on; any if it does not say.
    #[doc(hidden)]
    fn nodes(&self) -> Option<Vec<usize>> {
        None
    }

    /// Whether it depends on nothing, time included.
    #[doc(hidden)]
    fn is_steady(&self) -> bool {
        false
    }

    /// Pairs of nodes (counted from 0) that the force couples under the displacements `u` (m), or may soon, if it
    /// couples any there that `pattern` lacks; none otherwise. For a force between nodes that move past each other,
    /// whose [`couplings`](Self::couplings) would be too many: the Newton matrix gets room for these pairs before
    /// tangents are evaluated.
    fn couplings_near(&self, _u: &[f64], _pattern: &NodePattern) -> Vec<[usize; 2]> {
        Vec::new()
    }

    /// Pairs of nodes (counted from 0) that the force couples: u or v of one acts on the other. The tangents
    /// have entries for these pairs only, and for nodes that share a cell, which need not be named.
    ///
    /// Finite differences look for couplings of the named pairs alone first, which is cheap, and of
    /// nodes that share a cell if those do not explain how the force changes.
    fn couplings(&self) -> Vec<[usize; 2]> {
        Vec::new()
    }
}

impl fmt::Debug for dyn Force {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Force")
    }
}

/// The generalized force psi_k . f of a force f along shapes psi_k, under the displacements u_0 + sum z_k psi_k.
#[doc(hidden)]
pub trait GeneralizedForce: Send {
    /// Adds the force at time t (s), with a component for each shape, at [z, z'].
    ///
    /// # Errors
    /// As [`Force::add_forces`].
    fn add_forces(
        &mut self,
        t: f64,
        z: [&[f64]; 2],
        forces: &mut NodalForces,
    ) -> Result<(), Failure>;

    /// Adds its derivatives, as [`Force::add_tangents`], row by row.
    fn add_tangents(&mut self, t: f64, z: [&[f64]; 2], stiffness: &mut [f64], damping: &mut [f64]);
}

/// Extra unknowns of a force: masses of gas and liquid per chamber, actuator lag states, pipe flow rates.
///
/// Layout: masses m (kg) of chambers of volumes V(u) (m^3), with forces p(m, V) dV/du and rates q(t, m, V); then lag states a of
/// actuators, with forces f(u, v, a); then flow rates of pipes (m^3/s), without forces. All of them have rates.
#[doc(hidden)]
pub trait Flow: Send + Sync {
    /// Number of chambers and lag states: of all unknowns but pipe flow rates.
    fn reservoirs(&self) -> usize;

    /// Absolute tolerances of the unknowns, from those of strains (1) and velocities (m/s).
    fn tolerances(&self, strain: f64, velocity: f64) -> Vec<f64>;

    /// Initial values of the unknowns.
    fn start(&self) -> &[f64];

    /// Sets the lag states of actuators to those among the `amounts` at time `t`, before their forces are evaluated.
    fn set(&self, t: f64, amounts: &[f64]);

    /// Adds the forces `at` (u, m) and time `t`, and writes the rates of the unknowns (kg/s for masses); the second vector is a
    /// workspace of the same length. Returns the power (W) supplied by inflow.
    ///
    /// # Errors
    /// As [`Force::add_forces`].
    fn add_forces_of(
        &self,
        t: f64,
        at: [&[f64]; 2],
        forces: &mut NodalForces,
        rates: [&mut [f64]; 2],
    ) -> Result<f64, Failure>;

    /// Potential energy (J) of the amounts.
    fn potential_of(&self, u: &[f64], amounts: &[f64]) -> f64;

    /// Kinetic energy (J) of the fluid in pipes.
    fn kinetic_of(&self, unknowns: &[f64]) -> f64;

    /// Checks the state at the end `t` of a step.
    ///
    /// # Errors
    /// A state at which the run ends.
    fn check(&self, t: f64, u: &[f64], amounts: &[f64]) -> Result<(), Failure>;

    /// Whether a liquid fills its chamber, so that small errors of its volume are large errors of its pressure.
    fn is_stiff(&self) -> bool;

    /// Writes the gauge pressures (Pa) of chambers that a liquid fills, and NaN for all others.
    fn write_pressures(&self, u: &[f64], amounts: &[f64], pressures: &mut [f64]);

    /// The difference (m^3) from the volume of a chamber to the volume of its `content`, a mass (kg) at a gauge pressure (Pa), and the
    /// latter volume; writes dV/du (m^2). `None` unless a liquid fills the chamber.
    fn missing(
        &self,
        room: usize,
        u: &[f64],
        content: [f64; 2],
        gradient: &mut [f64],
    ) -> Option<[f64; 2]>;

    /// Adds -p d^2V/du^2 to `stiffness`, and writes all other derivatives, `at` (u, v, m).
    fn linearize(
        &self,
        t: f64,
        at: [&[f64]; 3],
        stiffness: &mut BlockMatrix,
        derivatives: &mut FlowDerivatives,
    );
}

/// Derivatives of a [`Flow`] at one state; matrices row by row.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct FlowDerivatives {
    /// dV/du (m^2), of one chamber after the other; df/da for lag states.
    pub gradients: Vec<f64>,
    /// -dp/dV (Pa/m^3) and dp/dm (Pa/kg) of each chamber; 0 and 1 for lag states.
    pub pressures: [Vec<f64>; 2],
    /// dq/dV (kg/s/m^3) and dq/dm (1/s), a row for each unknown.
    pub rates: [Vec<f64>; 2],
    /// Derivatives of the power that is supplied, by V (W/m^3) and by m (W/kg).
    pub power: [Vec<f64>; 2],
    /// Derivatives of the power that becomes heat, by m (W/kg).
    pub heat: Vec<f64>,
    /// Rates of the masses (kg/s), and a workspace of the same length.
    pub work: [Vec<f64>; 2],
    /// Workspaces for two evaluations of a force.
    pub trial: [NodalForces; 2],
}

impl FlowDerivatives {
    /// Zeros for these numbers of `rooms` (chambers and lag states) and unknowns; walls are among `dofs` displacement components.
    pub(crate) fn zeros([rooms, unknowns]: [usize; 2], dofs: usize) -> Self {
        let pair = |first: usize, second: usize| [vec![0.0; first], vec![0.0; second]];
        Self {
            gradients: vec![0.0; rooms * dofs],
            pressures: pair(rooms, rooms),
            rates: pair(unknowns * rooms, unknowns * unknowns),
            power: pair(rooms, unknowns),
            heat: vec![0.0; unknowns],
            work: pair(unknowns, unknowns),
            trial: [NodalForces::zeros(dofs), NodalForces::zeros(dofs)],
        }
    }
}

/// The forces that act in one phase.
pub(crate) type Forces = Vec<Arc<dyn Force>>;
