//! Lags of actuators behind their commands: heat, muscle activation, first-order dynamics of motors.
//!
//! Their states stand behind the amounts in the same `Flow`. The forces stay where they are and read state
//! and rate as a signal, which `Flow::set` brings to the unknowns before each evaluation. In the Newton
//! system such a state is a reservoir whose walls resist nothing: its gradient is df/da, a difference
//! quotient, and no solve is spent on it. Absolute tolerances scale with full activation, Young's modulus for
//! other stresses, that modulus times volume over length for forces, and the length of winches.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::signal::{self, SharedValue, Signal, finite_at};
use crate::base::input::{InputError, finite, positive};
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::Hill;
use crate::integrators::ode::Failure;

/// A lag of an actuator: a state that follows the [actuation](crate::Phase::actuate) by phases, and drives the actuator in its place.
///
/// With the command s (a force, a tension, a length of a winch, a stress, a strain) the state a obeys a' = (s - a)/T, from 0 at the start of the scene. T is
/// constant ([`first_order`](Self::first_order)), one of two ([`rise_and_fall`](Self::rise_and_fall)), or that of muscles ([`activation`](Self::activation)). A
/// [heated](Self::heated) actuator is commanded by a power.
///
/// It is an unknown under error control, for all methods except `central-difference`; equilibria have its steady-state value.
///
/// ```
/// use pliant::simulate::Reading;
/// use pliant::{Axis, Body, Cells, Lag, Material, Mesh, Phase, Sampling, Scene, Settings, Spring};
///
/// // a coiled thread of nylon lifts 10 g by heat: 0.3 W, 0.2 J/K, 0.01 W/K, 0.02 N/K
/// let mesh = Mesh::rectangle([0.02, 0.02], [2, 2], Cells::Triangles)?;
/// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// let body = Body::new(mesh, rubber).thickness(0.01).point_mass("weight", [0.0, -0.1], 0.01);
/// let scene = Scene::new(body.build()?)
///     .gravity([0.0, -9.8])
///     .spring(Spring::between([1], "weight").named("coil").stiffness(20.0).damping(0.5))
///     .lag(Lag::heated(0.2, 0.01, -0.02), ["coil"])
///     .phase(Phase::until(5.0).hold([1, 2, 3, 4]).hold_axes("weight", [Axis::X]).actuate(["coil"], 0.3));
/// let sampling = Sampling::phase_ends().read("warmer", Reading::temperature("coil"));
/// let motion = scene.simulate(&Settings::default(), &sampling)?;
/// let warmer = 30.0 * (1.0 - (-5.0_f64 / 20.0).exp()); // K
/// assert!((motion.last().sensors[0] / warmer - 1.0).abs() < 1e-3);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Lag(LagLaw);

#[derive(Debug, Clone)]
enum LagLaw {
    Times { rise: f64, fall: f64 },
    Activation { rise: f64, fall: f64 },
    Heat { capacity: f64, loss: f64, per_kelvin: f64 },
}

impl Lag {
    /// A first-order lag with one time constant `time` (s): after a step of the command the difference falls to 1/e in that time.
    pub fn first_order(time: f64) -> Self {
        Self::rise_and_fall(time, time)
    }

    /// A first-order lag with a time (s) for commands above the state, and one for those below.
    pub fn rise_and_fall(rise: f64, fall: f64) -> Self {
        Self(LagLaw::Times { rise, fall })
    }

    /// The activation a of a muscle with [Hill's law](crate::Hill), by its excitation e, both from 0 to 1: its stress is a times the largest, and the command e times
    /// the largest.
    ///
    /// T is `rise` (0.5 + 1.5 a) where e > a, and `fall`/(0.5 + 1.5 a) where it is not (s): calcium is released faster than it is taken up again. 0.015 s and
    /// 0.05 s are usual (D. G. Thelen, Journal of Biomechanical Engineering 125 (2003) 70-77).
    pub fn activation(rise: f64, fall: f64) -> Self {
        Self(LagLaw::Activation { rise, fall })
    }

    /// An actuator driven by its temperature rise: a shape memory alloy, a coiled thread of nylon, a layer that expands.
    ///
    /// With the power P (W), which is the command, theta is the temperature rise above the surroundings, and
    /// `capacity` (J/K) theta' = P - `loss` (W/K) theta. The actuator is driven by `per_kelvin` theta: a force (N/K, negative where a spring contracts), a tension, a
    /// length of a winch (m/K), a stress (Pa/K), a strain (1/K). (M. C. Yip, G. Niemeyer, IEEE Transactions on Robotics 33 (2017) 689-699, for coiled threads.)
    pub fn heated(capacity: f64, loss: f64, per_kelvin: f64) -> Self {
        Self(LagLaw::Heat { capacity, loss, per_kelvin })
    }

    /// # Errors
    /// Times, a capacity or a loss that are not above 0; a number that is not finite, or a `per_kelvin` of 0.
    pub(crate) fn validate(&self, actuator: &str) -> Result<(), InputError> {
        let input = |key: &str| format!("lag of \"{actuator}\" {key}");
        match self.0 {
            LagLaw::Times { rise, fall } | LagLaw::Activation { rise, fall } => {
                positive(&input("rise"), rise, "s")?;
                positive(&input("fall"), fall, "s")?;
            }
            LagLaw::Heat { capacity, loss, per_kelvin } => {
                positive(&input("capacity"), capacity, "J/K")?;
                positive(&input("loss"), loss, "W/K")?;
                finite(&input("per_kelvin"), &[per_kelvin])?;
                if per_kelvin == 0.0 {
                    let help = "with 0 its warmth does nothing: give the force, stress or strain of a kelvin";
                    return Err(InputError::new(input("per_kelvin"), per_kelvin, help));
                }
            }
        }
        Ok(())
    }

    /// Whether it is the activation of a muscle, which needs Hill's law.
    pub(crate) fn is_activation(&self) -> bool {
        matches!(self.0, LagLaw::Activation { .. })
    }

    /// Steady-state input of the actuator under a command of 1.
    pub(crate) fn gain(&self) -> f64 {
        match self.0 {
            LagLaw::Times { .. } | LagLaw::Activation { .. } => 1.0,
            LagLaw::Heat { loss, per_kelvin, .. } => per_kelvin / loss,
        }
    }

    /// Actuation per kelvin of temperature rise, if the actuator is heated.
    pub(crate) fn per_kelvin(&self) -> Option<f64> {
        match self.0 {
            LagLaw::Heat { per_kelvin, .. } => Some(per_kelvin),
            _ => None,
        }
    }

    /// The power (W) that a kelvin gives away, where it is heated.
    #[cfg(feature = "play")]
    pub(crate) fn loss(&self) -> Option<f64> {
        match self.0 {
            LagLaw::Heat { loss, .. } => Some(loss),
            _ => None,
        }
    }

    /// a' under what `drives` it at last, the command times the [gain](Self::gain). `full` is the state of full activation.
    pub(crate) fn rate(&self, drives: f64, state: f64, full: f64) -> f64 {
        let apart = drives - state;
        let time = match self.0 {
            LagLaw::Times { rise, fall } => {
                if apart > 0.0 {
                    rise
                } else {
                    fall
                }
            }
            LagLaw::Activation { rise, fall } => {
                let slowing = 0.5 + 1.5 * (state / full).clamp(0.0, 1.0);
                if apart > 0.0 { rise * slowing } else { fall / slowing }
            }
            LagLaw::Heat { capacity, loss, .. } => capacity / loss,
        };
        apart / time
    }

    /// da'/da at that state.
    fn slope(&self, drives: f64, state: f64, full: f64) -> f64 {
        let change = f64::EPSILON.sqrt() * full;
        let rate = |state| self.rate(drives, state, full);
        (rate(state + change) - rate(state)) / change
    }
}

/// An actuator with a lag, in the equations of a phase.
pub(crate) struct Lagging {
    name: String,
    lag: Lag,
    hill: Option<Hill>,
    /// A size of its states by which tolerances and differences are chosen; that of full activation, where there is one.
    size: f64,
    /// The sum of these is the command times the gain.
    drives: Vec<Signal>,
    /// The state and its rate, which the force reads.
    state: SharedValue,
    force: Option<Arc<dyn Force>>,
}

impl Lagging {
    pub(crate) fn new(
        name: &str,
        lag: &Lag,
        hill: Option<&Hill>,
        size: f64,
        drives: Vec<Signal>,
    ) -> Self {
        let (name, lag, hill) = (name.to_owned(), lag.clone(), hill.cloned());
        Self { name, lag, hill, size, drives, state: SharedValue::new(&[0.0; 2]), force: None }
    }

    /// Signal that drives its force: the lag state.
    pub(crate) fn signal(&self) -> Signal {
        Signal::of_state(self.state.clone())
    }

    /// Gives it the force that [`signal`](Self::signal) drives.
    pub(crate) fn drive(&mut self, force: Arc<dyn Force>) {
        self.force = Some(force);
    }

    /// The force that it drives.
    pub(crate) fn force(&self) -> Option<&dyn Force> {
        self.force.as_deref()
    }

    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Brings the force to a `state`.
    pub(crate) fn set(&self, t: f64, state: f64) {
        let rate = self.lag.rate(signal::sum(&self.drives, t), state, self.size);
        // Hill's law ends at no and at full activation, which an unknown keeps to its tolerance
        let state = self.hill.as_ref().map_or(state, |hill| state.clamp(0.0, hill.largest));
        self.state.set(&[state, rate]);
    }

    /// a' in a `state`.
    ///
    /// # Errors
    /// A command that is not finite, or that Hill's law does not have.
    pub(crate) fn rate(&self, t: f64, state: f64) -> Result<f64, Failure> {
        let drives = signal::sum(&self.drives, t);
        finite_at(t, format_args!("the actuation of \"{}\"", self.name), drives)?;
        if let Some(hill) = &self.hill {
            hill.check_stress(drives).map_err(|error| {
                Failure::Fatal(format!("at t = {t} s muscle \"{}\" {error}", self.name).into())
            })?;
        }
        Ok(self.lag.rate(drives, state, self.size))
    }

    /// Writes the derivative of the force by the `state` to `gradient`, and returns da'/da and the derivative of the power that is supplied. `trial` is room for
    /// two evaluations. It is a difference quotient: most forces are linear in what drives them.
    pub(crate) fn linearize(
        &self,
        t: f64,
        [u, v]: [&[f64]; 2],
        state: f64,
        trial: &mut [NodalForces; 2],
        gradient: &mut [f64],
    ) -> [f64; 2] {
        let slope = self.lag.slope(signal::sum(&self.drives, t), state, self.size);
        let Some(force) = &self.force else { return [slope, 0.0] };
        let change = f64::EPSILON.sqrt() * state.abs().max(self.size);
        // away from the end of Hill's law
        let change = if self.hill.is_some() && state > 0.5 * self.size { -change } else { change };
        for (state, forces) in [state, state + change].into_iter().zip(&mut *trial) {
            self.set(t, state);
            forces.clear();
            // what is refused here was refused before
            let _ = force.add_forces(t, u, v, forces);
        }
        self.set(t, state);
        let [at, changed] = trial;
        let parts = [
            (&at.conservative, &changed.conservative),
            (&at.dissipative, &changed.dissipative),
            (&at.applied, &changed.applied),
        ];
        for (at, changed) in parts {
            if !changed.is_zero() {
                let each = gradient.iter_mut().zip(changed.iter().zip(at.iter()));
                each.for_each(|(x, (changed, at))| *x += (changed - at) / change);
            }
        }
        [slope, (changed.powers(v).1 - at.powers(v).1) / change]
    }
}
