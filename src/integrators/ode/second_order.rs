//! Systems of second order, M u'' = f(t, u, u').

use super::failure::Failure;

/// M u'' = f(t, u, u') with n displacements u, velocities v = u', and M symmetric and positive definite.
///
/// [`forces`](Self::forces), [`accelerations`](Self::accelerations) and [`rates`](Self::rates) make a
/// system. [`integrals`](Self::integrals) and the two methods after it add integrals over time and a
/// check of the energy. The last six are for constrained systems, where part of the motion is known
/// beforehand, or bodies keep their shape.
pub trait SecondOrder {
    /// Writes the forces f(t, u, v) into `f` (zero on entry), without those of constraints.
    ///
    /// # Errors
    /// [`Failure::Recoverable`] where they cannot be evaluated: the step is repeated with a smaller size.
    fn forces(&mut self, t: f64, u: &[f64], v: &[f64], f: &mut [f64]) -> Result<(), Failure>;

    /// Writes the accelerations M^-1 f under the force of a kick into `a` (zero on entry); 0 in components
    /// that are [known](Self::prescribe).
    fn accelerations(&mut self, kick: &Kick<'_>, a: &mut [f64]);

    /// Upper bounds on how fast the stiffest motions near (t, u, v) are: they bound the step.
    fn rates(&mut self, t: f64, u: &[f64], v: &[f64]) -> Rates;

    /// Number of integrals over time that follow u and v in the state, such as the energy dissipated.
    fn integrals(&self) -> usize {
        0
    }

    /// Writes the time derivatives of the integrals at the forces last evaluated and the velocities `v` into
    /// `powers` (zero on entry).
    fn powers(&self, _v: &[f64], _powers: &mut [f64]) {}

    /// The energy balance of a state, to detect steps that create energy; `None` (the default) leaves that
    /// check out.
    fn balance(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        _integrals: &[f64],
    ) -> Option<EnergyBalance> {
        None
    }

    /// Called where an integration starts, at (t, u, v).
    ///
    /// # Errors
    /// If the constraints cannot be evaluated there.
    fn start(&mut self, _t: f64, _u: &[f64], _v: &[f64]) -> Result<(), Failure> {
        Ok(())
    }

    /// Sets the target rates of [`accelerations`](Self::accelerations) and [`lead`](Self::lead) to the mean
    /// rates of the known motion from `t` to `t + h`. Returns whether accelerations depend on them, as they
    /// do where constraints couple components.
    ///
    /// # Errors
    /// If the constraints cannot be evaluated.
    fn aim_at_mean_rates(&mut self, _t: f64, _h: f64) -> Result<bool, Failure> {
        Ok(false)
    }

    /// Whether there are constraints g(u) = 0 that are not linear. They act as in RATTLE: in the first half of a step so
    /// that they hold at the end of it, and in the second half so that the velocities keep them there.
    fn is_curved(&self) -> bool {
        false
    }

    /// Called after [`aim_at_mean_rates`](Self::aim_at_mean_rates) where the system [is curved](Self::is_curved): the
    /// next kick is the first half of a step of size `h` from the displacements `u`. The kick after
    /// [`prescribe`](Self::prescribe) is the second half, at the displacements given there.
    fn depart(&mut self, _h: f64, _u: &[f64]) {}

    /// Writes the components of `u` and `v` that are known at time `t`, and sets the target rates of
    /// [`accelerations`](Self::accelerations) and [`lead`](Self::lead) to those known for that time.
    ///
    /// # Errors
    /// If the constraints cannot be evaluated.
    fn prescribe(&mut self, _t: f64, _u: &mut [f64], _v: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }

    /// Sets known components of the velocities `after` a kick, which are v + duration a, to the target rates.
    /// Adds the contributions of constraint forces to the integrals to `work`.
    fn lead(&mut self, _kick: &Kick<'_>, _after: &mut [f64], _work: &mut [f64]) {}
}

/// Forces that change velocities for some time: half a step of
/// central differences.
#[derive(Debug, Clone, Copy)]
pub struct Kick<'a> {
    /// Its duration.
    pub duration: f64,
    /// The forces f.
    pub force: &'a [f64],
    /// Velocities v that it begins with.
    pub before: &'a [f64],
}

/// Upper bounds on how fast the stiffest motions are, at one state.
///
/// K and D are -df/du and -df/dv, or their symmetric parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// Highest angular frequency (rad/s): K x = frequency^2 M x.
    pub frequency: f64,
    /// Highest rate of decay (1/s): D x = decay M x.
    pub decay: f64,
}

/// The energy balance of a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyBalance {
    /// Kinetic + potential + dissipated - supplied energy: constant along an exact motion.
    pub energy: f64,
    /// Size of the energies in it, as the scale of errors.
    pub scale: f64,
}
