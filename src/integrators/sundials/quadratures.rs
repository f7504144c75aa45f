//! Integrals along the solution (quadratures), by CVODES and IDAS.

use super::{
    auxiliary::Quadratures, ffi, functions::SetTwo, options::SolverOptions, session::Session,
    vector::Vector,
};
use crate::base::input::InputError;
use crate::integrators::common::{Error, Integrator, Tolerances, check_time};

/// An integrator that also computes integrals, as described at [`Solver`](super::Solver).
pub trait CarriesIntegrals: Integrator {
    fn quadratures(&self) -> &[f64];
    fn interpolate_quadratures(
        &mut self,
        t: f64,
        derivative: u32,
        out: &mut [f64],
    ) -> Result<(), Error>;
}

impl<K, S> CarriesIntegrals for Session<K, S> {
    fn quadratures(&self) -> &[f64] {
        self.quadratures.as_ref().map_or(&[], |quadratures| quadratures.values.as_slice())
    }

    fn interpolate_quadratures(
        &mut self,
        t: f64,
        derivative: u32,
        out: &mut [f64],
    ) -> Result<(), Error> {
        check_quadrature_length("length of out", out.len(), self.quadratures().len())?;
        check_time("t", t)?;
        if !self.has_step {
            self.check_start_only(t, derivative)?;
            out.copy_from_slice(self.quadratures());
            return Ok(());
        }
        let Some(quadratures) = &self.quadratures else { return Ok(()) };
        let ((name, get_dky), scratch) = (quadratures.functions.get_dky, quadratures.scratch.raw());
        // SAFETY: memory and vector are alive, and the vector has as many numbers as there are integrals.
        self.look_back(name, t, derivative, |memory, t, order| unsafe {
            get_dky(memory, t, order, scratch)
        })?;
        if let Some(quadratures) = &self.quadratures {
            out.copy_from_slice(quadratures.scratch.as_slice());
        }
        Ok(())
    }
}

impl<K, S> Session<K, S> {
    /// Registers `count` integrals by `init`, if there are any.
    ///
    /// # Safety
    /// `init` belongs to this integrator, and `callback` fits the host.
    pub(super) unsafe fn set_quadratures<F, O>(
        &mut self,
        count: usize,
        init: SetTwo<F, ffi::N_Vector>,
        callback: F,
        options: &SolverOptions<O>,
    ) -> Result<(), Error> {
        check_tolerances(count, options.quadrature_tolerances.as_ref())?;
        let Some(functions) = self.memory.functions.quadratures.filter(|_| count > 0) else {
            return Ok(());
        };
        let zeros = vec![0.0; count];
        let values = Vector::from_slice(&zeros, &self.context)?;
        let scratch = Vector::from_slice(&zeros, &self.context)?;
        let (memory, initial) = (self.memory.raw, values.raw());
        self.quadratures = Some(Quadratures { functions, values, scratch });
        // SAFETY: the memory is alive and copies the vector; the caller vouches for the rest.
        self.host.call(init, |init| unsafe { init(memory, callback, initial) })?;
        if !options.quadrature_error_control {
            return Ok(());
        }
        let tolerances = options.quadrature_tolerances.clone().unwrap_or_else(|| {
            Tolerances::new(options.tolerances.rtol, options.tolerances.least_atol())
        });
        // SAFETY: the length of a vector was checked; the other value is a plain number.
        unsafe {
            let set = (functions.scalar_tolerances, functions.vector_tolerances);
            self.set_tolerances(set, &tolerances)?;
            self.set(functions.set_error_control, 1)
        }
    }

    /// Reads the integrals at the present time, after a step.
    pub(super) fn read_quadratures(&mut self) -> Result<(), Error> {
        let Some(quadratures) = &self.quadratures else { return Ok(()) };
        let (memory, mut t) = (self.memory.raw, 0.0);
        // SAFETY: the memory is alive, and the result pointers are valid.
        self.host.call(quadratures.functions.get, |get| unsafe {
            get(memory, &raw mut t, quadratures.values.raw())
        })
    }

    /// Sets the integrals to zero, with a new start.
    pub(super) fn restart_quadratures(&mut self) -> Result<(), Error> {
        if let Some(quadratures) = &mut self.quadratures {
            quadratures.values.as_mut_slice().fill(0.0);
        }
        self.hand_over_quadratures()
    }

    /// Lets C start from the present integrals.
    pub(super) fn hand_over_quadratures(&mut self) -> Result<(), Error> {
        let Some(quadratures) = &self.quadratures else { return Ok(()) };
        let (reinit, values) = (quadratures.functions.reinit, quadratures.values.raw());
        // SAFETY: the memory is alive and copies the vector.
        unsafe { self.set(reinit, values) }
    }
}

fn check_tolerances(count: usize, tolerances: Option<&Tolerances>) -> Result<(), InputError> {
    let Some(tolerances) = tolerances else { return Ok(()) };
    if count == 0 {
        let help = "the system has no integrals: quadrature_count says how many";
        return Err(InputError::new("quadrature_tolerances", "given", help));
    }
    tolerances.check(&vec![0.0; count])
}

fn check_quadrature_length(input: &str, len: usize, count: usize) -> Result<(), InputError> {
    if len == count {
        return Ok(());
    }
    Err(InputError::new(input, len, format!("there are {count} integrals")))
}
