//! The pressures of liquids at the ends of a step.

/// Pressures (Pa) of liquids at the ends of the last step, and room to interpolate them.
#[derive(Default)]
pub(crate) struct Ends {
    /// Tolerances (kg) of the amounts; none without liquids that fill their chambers.
    pub(super) tolerances: Vec<f64>,
    pub(super) times: [f64; 2],
    pub(super) pressures: [Vec<f64>; 2],
    pub(super) gradient: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) demands: Vec<f64>,
    pub(super) multipliers: Vec<f64>,
}
