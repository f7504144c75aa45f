//! Motion that is prescribed.

use std::sync::Arc;

/// A prescribed displacement at one instant: b, b' and b''.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prescribed {
    /// Displacement from the undeformed position (m).
    pub displacement: f64,
    /// Its first derivative (m/s).
    pub velocity: f64,
    /// Its second derivative (m/s^2).
    pub acceleration: f64,
}

/// A prescribed displacement as a smooth function of time (s).
pub type Path = Arc<dyn Fn(f64) -> Prescribed + Send + Sync>;
