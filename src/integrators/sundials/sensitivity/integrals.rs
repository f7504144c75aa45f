//! Sensitivities of integrals during an integration.

use faer::{MatMut, MatRef};

use super::options::Sensitivities;
use crate::integrators::{
    common::{Error, check_time},
    sundials::{
        auxiliary::{IntegralSensitivity, Vectors},
        ffi,
        functions::{QuadratureSensitivityFunctions, SetTwo},
        options::SolverOptions,
        quadratures::CarriesIntegrals,
        session::Session,
        vector::Vector,
    },
};

impl<K, S> Session<K, S> {
    /// Registers the sensitivities of integrals by `init`, if they are wanted.
    ///
    /// # Safety
    /// The functions belong to this integrator, and `callback` fits the host.
    pub(in crate::integrators::sundials) unsafe fn set_up_integral_sensitivities<F, O>(
        &mut self,
        sensitivities: &Sensitivities,
        options: &SolverOptions<O>,
        functions: &'static QuadratureSensitivityFunctions,
        (init, callback): (SetTwo<F, *mut ffi::N_Vector>, F),
    ) -> Result<(), Error> {
        let (integrals, columns) = (self.quadratures().len(), sensitivities.parameters.len());
        if !sensitivities.integrals {
            return Ok(());
        }
        if integrals == 0 {
            let help = "the system has no integrals: quadrature_count says how many";
            return Err(Error::input("sensitivities of integrals", "wanted", help));
        }
        let (s, zeros) = (Vectors::zeros(integrals, columns, &self.context)?, vec![0.0; integrals]);
        let scratch = Vector::from_slice(&zeros, &self.context)?;
        let values = vec![0.0; integrals * columns];
        let Some(sensitivity) = &mut self.sensitivities else { return Ok(()) };
        let integrals = IntegralSensitivity { functions, s, scratch, values };
        let (memory, s) = (self.memory.raw, sensitivity.integrals.insert(integrals).s.raw());
        // SAFETY: the memory is alive and copies the vectors, of which there are as many as sensitivities; the caller
        // vouches for the rest.
        self.host.call(init, |init| unsafe { init(memory, callback, s) })?;
        if sensitivities.error_control && options.quadrature_error_control {
            // SAFETY: the memory is alive; the value is a plain number.
            unsafe {
                self.host.call(functions.set_tolerances, |set| set(memory))?;
                self.set(functions.set_error_control, 1)?;
            }
        }
        Ok(())
    }

    pub(super) fn integral_sensitivities(&self) -> MatRef<'_, f64> {
        let integrals = self.sensitivities.as_ref().and_then(|s| s.integrals.as_ref());
        let values = integrals.map_or(&[][..], |integrals| &integrals.values);
        let rows = self.quadratures().len();
        MatRef::from_column_major_slice(values, rows, values.len() / rows.max(1))
    }

    pub(super) fn interpolate_integrals(
        &mut self,
        t: f64,
        derivative: u32,
        mut out: MatMut<'_, f64>,
    ) -> Result<(), Error> {
        let present = self.integral_sensitivities();
        let wanted = (present.nrows(), present.ncols());
        if (out.nrows(), out.ncols()) != wanted {
            let help =
                format!("there are {} integrals and {} sensitivities of them", wanted.0, wanted.1);
            let shape = format!("{} x {}", out.nrows(), out.ncols());
            return Err(Error::input("shape of out", shape, help));
        }
        check_time("t", t)?;
        if !self.has_step {
            self.check_start_only(t, derivative)?;
            out.copy_from(self.integral_sensitivities());
            return Ok(());
        }
        for j in 0..wanted.1 {
            let Some(integrals) = self.integrals_mut() else { return Ok(()) };
            let ((name, get_dky), scratch) = (integrals.functions.get_dky, integrals.scratch.raw());
            // SAFETY: memory and vector are alive, and there is such a sensitivity.
            self.look_back(name, t, derivative, |memory, t, order| unsafe {
                get_dky(memory, t, order, j as i32, scratch)
            })?;
            let Some(integrals) = self.integrals_mut() else { return Ok(()) };
            for (i, s) in integrals.scratch.as_slice().iter().enumerate() {
                out[(i, j)] = *s;
            }
        }
        Ok(())
    }

    fn integrals_mut(&mut self) -> Option<&mut IntegralSensitivity> {
        self.sensitivities.as_mut()?.integrals.as_mut()
    }

    /// Reads them at the present time, after a step.
    pub(super) fn read_integral_sensitivities(&mut self) -> Result<(), Error> {
        let (memory, mut t) = (self.memory.raw, 0.0);
        let Some(integrals) = self.integrals_mut() else { return Ok(()) };
        let (name, get) = integrals.functions.get;
        // SAFETY: the memory is alive, and the result pointers are valid.
        let code = unsafe { get(memory, &raw mut t, integrals.s.raw()) };
        integrals.s.copy_to(&mut integrals.values);
        self.host.accept(name, code)
    }

    /// Lets C start from the present ones, or from zero.
    pub(super) fn hand_over_integral_sensitivities(&mut self) -> Result<(), Error> {
        let memory = self.memory.raw;
        let Some(integrals) = self.integrals_mut() else { return Ok(()) };
        integrals.s.set(&integrals.values);
        let (name, reinit) = integrals.functions.reinit;
        // SAFETY: the memory is alive and copies the vectors, of which there are as many as at first.
        let code = unsafe { reinit(memory, integrals.s.raw()) };
        self.host.accept(name, code)
    }
}
