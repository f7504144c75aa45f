//! The pressures of liquids at the ends of steps.

/// Pressures (Pa) of liquids at the ends of the last three steps, and buffers to interpolate them.
#[derive(Default)]
pub(crate) struct Ends {
    /// Tolerances (kg) of the amounts; none without liquids that fill their chambers.
    pub(super) tolerances: Vec<f64>,
    pub(super) times: [f64; 4],
    pub(super) pressures: [Vec<f64>; 4],
    pub(super) gradient: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) demands: Vec<f64>,
    pub(super) multipliers: Vec<f64>,
}

impl Ends {
    /// The pressure (Pa) of liquid `number` at time `t` (s) within the last step: a parabola, bent as little as by the ends of the last two steps and
    /// by those of the two before them, and not at all where these bend to different sides, as next to a jump.
    pub(super) fn pressure(&self, number: usize, t: f64) -> f64 {
        let (times, at) = (self.times, |k: usize| self.pressures[k][number]);
        let slope = |k: usize| (at(k + 1) - at(k)) / (times[k + 1] - times[k]);
        let bend = |k: usize| (slope(k + 1) - slope(k)) / (times[k + 2] - times[k]);
        let bends = [bend(0), bend(1)];
        // without three steps, or after a return to an earlier time, there is no bend
        let is_known = times.is_sorted_by(|a, b| a < b) && bends[0] * bends[1] > 0.0;
        let bend = if bends[0].abs() < bends[1].abs() { bends[0] } else { bends[1] };
        let straight = at(2) + (t - times[2]) * slope(2);
        straight + if is_known { bend * (t - times[2]) * (t - times[3]) } else { 0.0 }
    }
}
