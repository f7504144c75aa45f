//! The functional whose gradient is computed.

use super::failure::Failure;

/// The functional G = g(T, y(T), p) + integral of h(t, y, p) from the start to T, of a solution y and
/// the parameters p of its equations.
///
/// Slopes are compared with differences while they are used; wrong ones end the backward run.
pub trait Functional {
    /// h(t, y, p). If `slopes` are given, it also writes dh/dy and dh/dp (zero on entry). Default: 0.
    fn running(
        &mut self,
        _t: f64,
        _y: &[f64],
        _p: &[f64],
        _slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        Ok(0.0)
    }

    /// g(T, y, p). If `slopes` are given, it also writes dg/dy and dg/dp (zero on entry). Default: 0.
    fn terminal(
        &mut self,
        _t: f64,
        _y: &[f64],
        _p: &[f64],
        _slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        Ok(0.0)
    }
}

/// Derivatives of a number, to be filled; zero on entry.
#[derive(Debug)]
pub struct Slopes<'a> {
    /// With respect to the unknowns.
    pub y: &'a mut [f64],
    /// With respect to the parameters.
    pub p: &'a mut [f64],
}
