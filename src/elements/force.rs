//! Nodal forces, and the trait [`Force`] of their sources.

mod flow;
mod nodal;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

pub use flow::{Flow, FlowDerivatives};
pub use nodal::{ForceVector, NodalForces, Reservoir, Step};

use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::integrators::ode::Failure;

/// Source of the tangents of a force, as [`Force::add_tangents`] returns it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangents {
    /// The force has added them.
    Added,
    /// Finite differences of [`Force::add_forces`] replace them.
    ByDifferences,
}

/// A force that depends on time t (s), displacements u (m) and velocities v (m/s) of the nodes.
///
/// [`Scene::force`](crate::Scene::force) adds one of any crate to a scene. It has to implement
/// [`add_forces`](Self::add_forces), and with a conservative part [`potential`](Self::potential) and
/// [`reservoir`](Self::reservoir). The rest is for forces that should cost less ([`add_tangents`](Self::add_tangents),
/// [`is_nonlinear`](Self::is_nonlinear)), couple distant nodes ([`couplings`](Self::couplings)), or have kinks, meet surfaces or
/// lose their meaning between two steps ([`capabilities`](Self::capabilities)).
///
/// # Guarantees and obligations
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

    /// Adds -df/du to `stiffness` and -df/dv to `damping`. They need not be symmetric: the Newton
    /// matrix takes their symmetric part.
    ///
    /// A force that omits this (and returns [`Tangents::ByDifferences`], without adding anything) gets
    /// finite differences of [`add_forces`](Self::add_forces). They cost one evaluation at the state itself
    /// and, for each of the two matrices: one if the force does not depend on u (or v); else one more than
    /// the dimension of space if it acts on each node separately, and several times as many if it couples
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

    /// Whether the force depends on u or v, so that the Newton matrix must follow it. For a force that
    /// changes with time alone, `false` saves the search for its tangents.
    fn is_nonlinear(&self) -> bool {
        true
    }

    /// Potential energy (J) of the conservative part.
    fn potential(&self, _t: f64, _u: &[f64]) -> f64 {
        0.0
    }

    /// The account of that energy.
    fn reservoir(&self) -> Reservoir {
        Reservoir::None
    }

    /// Nodes (counted from 0) that it depends on or acts on; any if it names none.
    #[doc(hidden)]
    fn nodes(&self) -> Option<Vec<usize>> {
        None
    }

    /// Pairs of nodes (counted from 0) that the force couples: u or v of one acts on the other. The tangents
    /// have entries for these pairs only, and for nodes that share a cell, which need not be named.
    ///
    /// Finite differences look for couplings of the named pairs alone first, which is cheap, and of
    /// nodes that share a cell if those do not explain the change of the force.
    fn couplings(&self) -> Vec<[usize; 2]> {
        Vec::new()
    }

    /// Optional [capabilities](Capabilities) of the force. Default: none.
    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities::default()
    }
}

impl fmt::Debug for dyn Force {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Force")
    }
}

/// Optional capabilities of a force, as [`Force::capabilities`] returns them: each is a trait that the force implements besides.
///
/// ```
/// use pliant::force::{Capabilities, StepCheck};
/// use pliant::ode::Failure;
///
/// /// A thread that tears.
/// struct Thread {
///     longest: f64,
/// }
///
/// impl StepCheck for Thread {
///     fn check_step(&self, t: f64, _before: &[f64], after: &[f64]) -> Result<(), Failure> {
///         let length = after[0];
///         let torn = || Failure::Fatal(format!("the thread of {length} m tears at {t} s").into());
///         if length < self.longest { Ok(()) } else { Err(torn()) }
///     }
/// }
///
/// // in `impl Force for Thread`: fn capabilities(&self) -> Capabilities<'_> { ... }
/// let thread = Thread { longest: 0.1 };
/// let capabilities = Capabilities { step_check: Some(&thread), ..Capabilities::default() };
/// assert!(capabilities.switches.is_none());
/// ```
#[derive(Default, Clone, Copy)]
pub struct Capabilities<'a> {
    /// For forces with kinks and jumps: runs that locate events hold them smooth in between.
    pub switches: Option<&'a dyn Switches>,
    /// For forces between surfaces: no step leaps over them.
    pub contact: Option<&'a dyn ContactForce>,
    /// For forces that can lose their meaning within a step: a spring that turns, a chamber that bursts.
    pub step_check: Option<&'a dyn StepCheck>,
    /// Extra unknowns beside u and v on which the force depends. Its other functions then use their initial values.
    #[doc(hidden)]
    pub flow: Option<&'a dyn Flow>,
    /// A sum over cells, of which a reduced model takes a sample.
    #[doc(hidden)]
    pub by_cells: Option<&'a dyn ByCells>,
    /// A generalized form along few shapes.
    #[doc(hidden)]
    pub along_shapes: Option<&'a dyn AlongShapes>,
    /// Mass (kg) of the surroundings that moves along with pairs of nodes that share a cell, the same in all phases: it is
    /// added to m of M = m (x) I.
    #[doc(hidden)]
    pub carried: &'a [([usize; 2], f64)],
    /// Whether it only keeps rigid pieces in their shape, as their edges do where they are constraints.
    #[doc(hidden)]
    pub keeps_rigid: bool,
    /// Whether it depends on nothing, time included.
    #[doc(hidden)]
    pub is_steady: bool,
}

/// Switches of a force: functions whose change of sign is a kink or a jump of it.
///
/// [`hold_switches`](Self::hold_switches) is called with `None` at the start of a phase and after each change of the integrator.
/// If contact events are located, it is then called with the switches as they are at that time, and again after each event.
pub trait Switches {
    /// Number of switches.
    fn switches(&self) -> usize;

    /// Writes the values of the switches: above 0 where a part of the force is off.
    fn switch_values(&self, t: f64, u: &[f64], v: &[f64], values: &mut [f64]);

    /// Keeps each switch on or off, independent of its value, so that the force is smooth; `None` lets all
    /// of them act by their values again.
    fn hold_switches(&self, on: Option<&[bool]>);

    /// The name of the body or obstacle in frictional contact, and whether the points that press there slide, by the held
    /// switches: all (`Some(true)`), none (`Some(false)`) or some (`None`).
    ///
    /// `None` without held switches, contact or friction.
    fn slides(&self) -> Option<(&str, Option<bool>)> {
        None
    }
}

/// A force between surfaces that meet: of the body and obstacles, or of bodies.
pub trait ContactForce {
    /// A time (s) within a step at which a part of the force acts that the ends of the step do not
    /// show, as they lie before and behind an obstacle. Depths below `tolerance` (m) do not matter.
    ///
    /// `clearances` has a number for each switch: a bound (m) on how far the body can still move without a
    /// change of that switch. 0 is always right; the search updates it.
    fn passage(&self, step: &Step, tolerance: f64, clearances: &mut [f64]) -> Option<f64>;

    /// Adds, node by node, bounds on how much -df/du (to `stiffness`, N/m) and -df/dv (to `damping`, N s/m)
    /// may suddenly grow: by points that do not touch yet, and by points that slide and may stick.
    fn add_reserves(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    );

    /// Velocity (m/s) at time `t` (s) of the source of the force, if its motion is prescribed: an obstacle.
    fn velocity(&self, _t: f64) -> Option<[f64; 3]> {
        None
    }

    /// Pairs of nodes (counted from 0) that the force couples under the displacements `u` (m), or may soon, if it
    /// couples any there that `pattern` lacks; none otherwise. For a force between nodes that move past each other,
    /// whose [`couplings`](Force::couplings) would be too many: the Newton matrix gets entries for these pairs before
    /// tangents are evaluated.
    fn couplings_near(&self, _u: &[f64], _pattern: &NodePattern) -> Vec<[usize; 2]> {
        Vec::new()
    }
}

/// A force that checks completed steps.
pub trait StepCheck {
    /// Checks a completed step, to time `t`, from displacements `before` to `after`.
    ///
    /// # Errors
    /// A step that leapt over states in which the force has no meaning.
    fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure>;
}

/// A force that is a sum over cells.
#[doc(hidden)]
pub trait ByCells {
    /// The same force by some of the cells, each with a weight, on a pattern that couples their nodes.
    fn sample(&self, weights: &BTreeMap<usize, f64>, pattern: &NodePattern) -> Arc<dyn Force>;
}

/// A force with a generalized form along shapes.
#[doc(hidden)]
pub trait AlongShapes {
    /// Whether the form is exact along so many shapes, and less work.
    fn is_exact_along(&self, shapes: usize) -> bool;

    /// The force along `shapes` (m) from displacements `origin` (m), if it [is exact](Self::is_exact_along) along them.
    fn generalized(&self, origin: &[f64], shapes: &[&[f64]]) -> Option<Box<dyn GeneralizedForce>>;
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

/// The forces that act in one phase.
pub(crate) type Forces = Vec<Arc<dyn Force>>;
