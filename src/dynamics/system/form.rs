//! The forms of the equations that integrators take.

use super::System;
use super::dae::DaeForm;
use super::second_order::SecondOrderForm;

/// The equations of a phase in the form that an integrator takes: as an ODE, or wrapped in a type that gives
/// them another form.
pub(crate) trait Form {
    fn system(&self) -> &System;

    fn system_mut(&mut self) -> &mut System;

    fn into_system(self) -> System;
}

impl Form for System {
    fn system(&self) -> &System {
        self
    }

    fn system_mut(&mut self) -> &mut System {
        self
    }

    fn into_system(self) -> System {
        self
    }
}

impl Form for DaeForm {
    fn system(&self) -> &System {
        &self.system
    }

    fn system_mut(&mut self) -> &mut System {
        &mut self.system
    }

    fn into_system(self) -> System {
        self.system
    }
}

impl Form for SecondOrderForm {
    fn system(&self) -> &System {
        &self.system
    }

    fn system_mut(&mut self) -> &mut System {
        &mut self.system
    }

    fn into_system(self) -> System {
        self.system
    }
}
