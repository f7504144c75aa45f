//! Sensitivities during an integration.

use std::ptr;

use faer::{MatMut, MatRef};

use super::{
    options::{Sensitivities, SensitivityMethod},
    rhs::{Access, SensitivityRhs},
};
use crate::integrators::{
    common::{Error, Integrator, Tolerances, check_finite, check_time},
    sundials::{
        auxiliary::{Sensitivity, Vectors},
        ffi,
        quadratures::CarriesIntegrals,
        session::Session,
        vector::Vector,
    },
};

/// An integrator that also computes sensitivities, as described at [`Solver`](crate::integrators::sundials::Solver).
pub trait CarriesSensitivities: CarriesIntegrals {
    fn sensitivities(&self) -> MatRef<'_, f64>;
    fn interpolate_sensitivities(
        &mut self,
        t: f64,
        derivative: u32,
        out: MatMut<'_, f64>,
    ) -> Result<(), Error>;
    fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error>;
    fn quadrature_sensitivities(&self) -> MatRef<'_, f64>;
    fn interpolate_quadrature_sensitivities(
        &mut self,
        t: f64,
        derivative: u32,
        out: MatMut<'_, f64>,
    ) -> Result<(), Error>;
    fn set_parameter_directions(&mut self, directions: &[f64]) -> Result<(), Error>;
}

impl<K, S> CarriesSensitivities for Session<K, S> {
    fn sensitivities(&self) -> MatRef<'_, f64> {
        let values = self.sensitivities.as_ref().map_or(&[][..], |s| &s.values);
        let n = self.y().len();
        MatRef::from_column_major_slice(values, n, values.len() / n)
    }

    fn interpolate_sensitivities(
        &mut self,
        t: f64,
        derivative: u32,
        mut out: MatMut<'_, f64>,
    ) -> Result<(), Error> {
        self.check_shape("shape of out", out.nrows(), out.ncols())?;
        check_time("t", t)?;
        if !self.has_step {
            self.check_start_only(t, derivative)?;
            out.copy_from(self.sensitivities());
            return Ok(());
        }
        let Some(sensitivities) = &self.sensitivities else { return Ok(()) };
        let ((name, get_dky), scratch) =
            (sensitivities.functions.get_dky, sensitivities.scratch.raw());
        for j in 0..out.ncols() {
            // SAFETY: memory and vector are alive, and there is such a sensitivity.
            self.look_back(name, t, derivative, |memory, t, order| unsafe {
                get_dky(memory, t, order, j as i32, scratch)
            })?;
            if let Some(sensitivities) = &self.sensitivities {
                for (i, s) in sensitivities.scratch.as_slice().iter().enumerate() {
                    out[(i, j)] = *s;
                }
            }
        }
        Ok(())
    }

    fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error> {
        self.start_sensitivities(s, None)
    }

    fn quadrature_sensitivities(&self) -> MatRef<'_, f64> {
        self.integral_sensitivities()
    }

    fn interpolate_quadrature_sensitivities(
        &mut self,
        t: f64,
        derivative: u32,
        out: MatMut<'_, f64>,
    ) -> Result<(), Error> {
        self.interpolate_integrals(t, derivative, out)
    }

    fn set_parameter_directions(&mut self, directions: &[f64]) -> Result<(), Error> {
        match &mut self.host.get_mut().sensitivity {
            Some(rhs) => Ok(rhs.set_directions(directions)?),
            None => Ok(()),
        }
    }
}

impl<K, S> Session<K, S> {
    pub(in crate::integrators::sundials) fn start_sensitivities(
        &mut self,
        s: MatRef<'_, f64>,
        sp: Option<MatRef<'_, f64>>,
    ) -> Result<(), Error> {
        if self.has_step {
            let help = "sensitivities are set before the first step, or after reinit";
            return Err(Error::input("steps taken", self.statistics().steps, help));
        }
        self.check_shape("shape of s", s.nrows(), s.ncols())?;
        let s = columns(s);
        check_finite("s", &s)?;
        let sp = sp.map(columns);
        check_finite("sp", sp.as_deref().unwrap_or_default())?;
        let Some(sensitivities) = &mut self.sensitivities else { return Ok(()) };
        sensitivities.values.copy_from_slice(&s);
        if let Some(vectors) = &mut sensitivities.sp {
            match &sp {
                Some(sp) => vectors.set(sp),
                None => vectors.fill(0.0),
            }
        }
        self.hand_over_sensitivities()
    }

    pub(in crate::integrators::sundials) fn check_shape(
        &self,
        input: &str,
        rows: usize,
        columns: usize,
    ) -> Result<(), Error> {
        let wanted = (self.y().len(), self.sensitivities().ncols());
        if (rows, columns) == wanted {
            return Ok(());
        }
        let help = format!("there are {} unknowns and {} sensitivities", wanted.0, wanted.1);
        Err(Error::input(input, format!("{rows} x {columns}"), help))
    }
}

impl<K, S> Session<K, S> {
    /// Registers sensitivities by `init`, which gets their number, C's number of the method, and zeros for s
    /// and, for a DAE, s'.
    ///
    /// # Safety
    /// `init` belongs to this integrator, and hands it a callback that fits the host.
    pub(in crate::integrators::sundials) unsafe fn set_up_sensitivities(
        &mut self,
        options: &Sensitivities,
        tolerances: &Tolerances,
        access: &Access<S>,
        (name, init): (
            &'static str,
            impl FnOnce(i32, i32, *mut ffi::N_Vector, *mut ffi::N_Vector) -> i32,
        ),
    ) -> Result<(), Error> {
        let Some(functions) = self.memory.functions.sensitivities else { return Ok(()) };
        let (n, integrals) = (self.y().len(), self.quadratures().len());
        let system = &mut self.host.get_mut().system;
        let rhs = SensitivityRhs::new(options, tolerances, [n, integrals], system, access)?;
        let mut scales = rhs.scales().to_vec();
        let count = scales.len();
        let Ok(c_count) = i32::try_from(count) else {
            return Err(Error::input("number of sensitivities", count, "it is at most 2^31 - 1"));
        };
        self.host.get_mut().sensitivity = Some(Box::new(rhs));
        let method = match options.method {
            SensitivityMethod::Simultaneous => ffi::CV_SIMULTANEOUS,
            SensitivityMethod::Staggered => ffi::CV_STAGGERED,
            SensitivityMethod::StaggeredOneByOne => ffi::CV_STAGGERED1,
        };
        let zeros = || Vectors::zeros(n, count, &self.context);
        let sensitivities = Sensitivity {
            functions,
            s: zeros()?,
            sp: self.yp.is_some().then(zeros).transpose()?,
            scratch: Vector::from_slice(&vec![0.0; n], &self.context)?,
            values: vec![0.0; n * count],
            method,
            integrals: None,
        };
        let sensitivities = self.sensitivities.insert(sensitivities);
        let [s, sp] = sensitivities.raw();
        self.host.accept(name, init(c_count, method, s, sp))?;
        let (memory, scales) = (self.memory.raw, scales.as_mut_ptr());
        // SAFETY: the memory is alive; it copies the scales, and needs no parameters for our callbacks; the
        // other value is a plain number.
        unsafe {
            self.host.call(functions.set_parameters, |set| {
                set(memory, ptr::null_mut(), scales, ptr::null_mut())
            })?;
            self.host.call(functions.set_tolerances, |set| set(memory))?;
            self.set(functions.set_error_control, i32::from(options.error_control))
        }
    }

    /// Reads the sensitivities at the present time, after a step.
    pub(in crate::integrators::sundials) fn read_sensitivities(&mut self) -> Result<(), Error> {
        let Some(sensitivities) = &mut self.sensitivities else { return Ok(()) };
        let ((name, get), mut t) = (sensitivities.functions.get, 0.0);
        // SAFETY: the memory is alive, and the result pointers are valid.
        let code = unsafe { get(self.memory.raw, &raw mut t, sensitivities.s.raw()) };
        sensitivities.s.copy_to(&mut sensitivities.values);
        self.host.accept(name, code)?;
        self.read_integral_sensitivities()
    }

    /// Sets the sensitivities to zero, with a new start.
    pub(in crate::integrators::sundials) fn restart_sensitivities(&mut self) -> Result<(), Error> {
        let Some(sensitivities) = &mut self.sensitivities else { return Ok(()) };
        sensitivities.values.fill(0.0);
        if let Some(sp) = &mut sensitivities.sp {
            sp.fill(0.0);
        }
        if let Some(integrals) = &mut sensitivities.integrals {
            integrals.values.fill(0.0);
        }
        self.hand_over_sensitivities()
    }

    /// Lets C start from the present sensitivities.
    pub(in crate::integrators::sundials) fn hand_over_sensitivities(
        &mut self,
    ) -> Result<(), Error> {
        let Some(sensitivities) = &mut self.sensitivities else { return Ok(()) };
        sensitivities.s.set(&sensitivities.values);
        let [s, sp] = sensitivities.raw();
        let (name, reinit) = sensitivities.functions.reinit;
        // SAFETY: the memory is alive and copies the vectors, of which there are as many as at first.
        let code = unsafe { reinit(self.memory.raw, sensitivities.method, s, sp) };
        self.host.accept(name, code)?;
        self.hand_over_integral_sensitivities()
    }
}

/// The numbers of a matrix, column after column.
fn columns(matrix: MatRef<'_, f64>) -> Vec<f64> {
    (0..matrix.ncols()).flat_map(|j| (0..matrix.nrows()).map(move |i| matrix[(i, j)])).collect()
}
