//! The forms of the equations in all unknowns that integrators take.

use super::System;
use super::dae::DaeForm;
use super::phase_system::PhaseSystem;
use super::second_order::SecondOrderForm;

/// The equations of a phase in the form that an integrator takes: as an ODE, or wrapped in a type that gives
/// them another form.
pub(crate) trait Form: PhaseSystem {
    fn into_system(self) -> System;
}

impl PhaseSystem for System {
    fn full(&self) -> &System {
        self
    }

    fn full_mut(&mut self) -> &mut System {
        self
    }
}

impl Form for System {
    fn into_system(self) -> System {
        self
    }
}

impl PhaseSystem for DaeForm {
    fn full(&self) -> &System {
        &self.system
    }

    fn full_mut(&mut self) -> &mut System {
        &mut self.system
    }
}

impl Form for DaeForm {
    fn into_system(self) -> System {
        self.system
    }
}

impl PhaseSystem for SecondOrderForm {
    fn full(&self) -> &System {
        &self.system
    }

    fn full_mut(&mut self) -> &mut System {
        &mut self.system
    }
}

impl Form for SecondOrderForm {
    fn into_system(self) -> System {
        self.system
    }
}
