//! Integrals along the solution (quadratures), by CVODES and IDAS.

use std::ffi::c_void;

use super::{
    auxiliary::Quadratures, ffi, functions::Named, options::QuadratureOptions, session::Session,
    vector::Vector,
};
use crate::base::input::InputError;
use crate::integrators::common::{AbsoluteTolerance, Error, Integrator, Tolerances, check_time};

/// What also computes integrals, as described at [`Solver`](super::Solver).
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
        let (Some(functions), Some(quadratures)) =
            (self.memory.functions.quadratures, &self.quadratures)
        else {
            return Ok(());
        };
        let ((name, get_dky), scratch) = (functions.get_dky, quadratures.scratch.raw());
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
    pub(super) unsafe fn set_quadratures<F>(
        &mut self,
        count: usize,
        (name, init): Named<unsafe extern "C" fn(*mut c_void, F, ffi::N_Vector) -> i32>,
        callback: F,
        (options, of_unknowns): (&QuadratureOptions, &Tolerances),
    ) -> Result<(), Error> {
        check_tolerances(count, options.tolerances.as_ref())?;
        let Some(functions) = self.memory.functions.quadratures.filter(|_| count > 0) else {
            return Ok(());
        };
        let zeros = vec![0.0; count];
        let values = Vector::from_slice(&zeros, &self.context)?;
        let scratch = Vector::from_slice(&zeros, &self.context)?;
        let memory = self.memory.raw;
        // SAFETY: the memory is alive and copies the vector; the caller vouches for the rest.
        let code = unsafe { init(memory, callback, values.raw()) };
        self.quadratures = Some(Quadratures { values, scratch });
        self.host.accept(name, code)?;
        if !options.error_control {
            return Ok(());
        }
        let Tolerances { rtol, atol } = match &options.tolerances {
            Some(tolerances) => tolerances.clone(),
            None => Tolerances::new(of_unknowns.rtol, of_unknowns.least_atol()),
        };
        let (name, code) = match atol {
            AbsoluteTolerance::Scalar(atol) => {
                let (name, set) = functions.scalar_tolerances;
                // SAFETY: the memory is alive.
                (name, unsafe { set(memory, rtol, atol) })
            }
            AbsoluteTolerance::Vector(atol) => {
                let atol = Vector::from_slice(&atol, &self.context)?;
                let (name, set) = functions.vector_tolerances;
                // SAFETY: the memory is alive and copies the vector, whose length was checked.
                (name, unsafe { set(memory, rtol, atol.raw()) })
            }
        };
        self.host.accept(name, code)?;
        // SAFETY: the value is a plain number.
        unsafe { self.set(functions.set_error_control, 1) }
    }

    /// Reads the integrals at the present time, after a step.
    pub(super) fn read_quadratures(&mut self) -> Result<(), Error> {
        let (Some(functions), Some(quadratures)) =
            (self.memory.functions.quadratures, &self.quadratures)
        else {
            return Ok(());
        };
        let ((name, get), mut t) = (functions.get, 0.0);
        // SAFETY: the memory is alive, and the result pointers are valid.
        let code = unsafe { get(self.memory.raw, &raw mut t, quadratures.values.raw()) };
        self.host.accept(name, code)
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
        let (Some(functions), Some(quadratures)) =
            (self.memory.functions.quadratures, &self.quadratures)
        else {
            return Ok(());
        };
        let values = quadratures.values.raw();
        // SAFETY: the memory is alive and copies the vector.
        unsafe { self.set(functions.reinit, values) }
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
