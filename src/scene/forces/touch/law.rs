//! Energy per area over the distance of two surfaces.

/// The law of the normal force between two surfaces.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalLaw {
    pub(super) kind: Kind,
    /// Stiffness k (N/m^3).
    pub(super) stiffness: f64,
    /// Damping c (N s/m^3) where the curvature of the energy is k.
    pub(super) damping: f64,
    /// The distance D (m) from which on nothing acts.
    pub(super) distance: f64,
}

/// The energy per area phi(d) below the distance D.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// k (D - d)^3/(3 d), which grows without bound and has a continuous curvature at D.
    Barrier,
    /// k (D - d)^2/2.
    Spring,
}

impl NormalLaw {
    /// phi (J/m^2) at a distance `d` (m) from 0 to D.
    pub(super) fn energy(&self, d: f64) -> f64 {
        let x = self.distance - d;
        match self.kind {
            Kind::Barrier => self.stiffness * x.powi(3) / (3.0 * d),
            Kind::Spring => 0.5 * self.stiffness * x * x,
        }
    }

    /// -phi' (Pa), which pushes the surfaces apart.
    pub(super) fn pressure(&self, d: f64) -> f64 {
        let x = self.distance - d;
        match self.kind {
            Kind::Barrier => self.stiffness * x * x * (3.0 * d + x) / (3.0 * d * d),
            Kind::Spring => self.stiffness * x,
        }
    }

    /// phi'' (N/m^3)
    pub(super) fn curvature(&self, d: f64) -> f64 {
        match self.kind {
            Kind::Barrier => 2.0 / 3.0 * self.stiffness * ((self.distance / d).powi(3) - 1.0),
            Kind::Spring => self.stiffness,
        }
    }

    /// phi''' (N/m^4)
    pub(super) fn third(&self, d: f64) -> f64 {
        match self.kind {
            Kind::Barrier => -2.0 * self.stiffness * (self.distance / d).powi(3) / d,
            Kind::Spring => 0.0,
        }
    }

    /// Time constant of damping (s): the coefficient of the distance rate in the damping pressure (N s/m^3), over
    /// phi''.
    pub(super) fn damping_time(&self) -> f64 {
        self.damping / self.stiffness
    }

    /// The curvature (N/m^3) at which explicit steps reckon with surfaces that do not touch yet.
    pub(super) fn reserve(&self) -> f64 {
        match self.kind {
            Kind::Barrier => self.curvature(0.5 * self.distance),
            Kind::Spring => self.stiffness,
        }
    }
}
