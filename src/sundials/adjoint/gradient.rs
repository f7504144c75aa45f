//! What an adjoint problem is solved for.

/// A functional G = g(T, y(T), p) + integral of h(t, y, p) and what it changes by.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// G.
    pub value: f64,
    /// dG/dp, for all parameters of the system.
    pub parameters: Vec<f64>,
    /// dG/dy0, by the initial state; where that depends on parameters, it adds (dy0/dp)^T dG/dy0 to dG/dp. Of a DAE, by
    /// the differential unknowns: algebraic ones follow from them, and have zeros.
    pub initial_state: Vec<f64>,
}
