//! Whether equations have a mass matrix.

/// The mass matrix M of an [`Ode`](super::Ode) M y' = f(t, y).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassKind {
    /// None: y' = f(t, y).
    Identity,
    /// The same at all times.
    Constant,
    /// M(t)
    TimeDependent,
}
