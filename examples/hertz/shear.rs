//! The blocks of [`line`](super::line) drawn aside under friction, and the closed form of Cattaneo and Mindlin (Johnson,
//! *Contact Mechanics*, 1985, chapter 7).

use pliant::{Axis, Error, Phase, Sampling, Settings};

use super::line::{Hertz, Pressing, Surface, from_left_to_right, off};

/// Time of the motion (s), and the sticking speed (m/s): what creeps is a part of 0.1 um then.
const SLOW: f64 = 0.1;
const STICKING_SPEED: f64 = 2e-6;

/// Results of a slow motion.
pub struct Found {
    /// Tangential force over mu times the normal one.
    pub load: f64,
    /// Half the width of what sticks over that of the contact, by the second moments of shear stress and pressure, and by
    /// the closed form.
    pub sticking: [f64; 2],
    /// How far the mean shear stress on three nodes in a row is off at most, as a part of mu times the largest pressure.
    pub off: f64,
    pub steps: usize,
}

/// The upper block drawn aside by `way` (m), slowly, with the friction coefficient `mu`. The end is still in motion: else
/// friction would fade, as it depends on the sliding speed.
pub fn drawn(pressing: &Pressing, mu: f64, way: f64) -> Result<Found, Error> {
    let pressed = pressing.pressed()?;
    let phase = Phase::until(SLOW).hold_axes("upper/top", [Axis::Y]).move_axis(
        "upper/top",
        Axis::X,
        way / SLOW,
    );
    let touch = pressing.touch().friction_coefficient(mu).sticking_speed(STICKING_SPEED);
    let scene = pressing.scene(touch, phase)?;
    let scene = scene.starting_from(&pressed.trajectory().state(pressed.sample()));
    let settings = Settings {
        rtol: 1e-4,
        atol_position: Some(1e-9),
        atol_velocity: Some(1e-7),
        ..Settings::default()
    };
    let motion = scene.simulate(&settings, &Sampling::phase_ends())?;

    let surface = Surface::new(&motion, motion.last(), false)?;
    let forces = motion.contact_forces(motion.last())?;
    let nodes = from_left_to_right(motion.body().mesh(), "upper/bottom")?;
    let shears: Vec<f64> = nodes.iter().map(|&node| -forces[2 * node]).collect();
    let force: f64 = surface.presses.iter().sum();
    let load = shears.iter().sum::<f64>() / (mu * force);
    let hertz = Hertz::under(force);
    // the second moment of the shear stress is mu P (a^2 - c^4/a^2)/4
    let part = surface.moment(&shears) / (mu * surface.moment(&surface.presses));
    let exact = (1.0 - load).max(0.0).sqrt();
    let stress = |[from, to]: [f64; 2]| {
        let (a, c) = (hertz.half_width, exact * hertz.half_width);
        let of = |x: f64| Hertz::within(x, a) - exact * Hertz::within(x, c);
        mu * hertz.peak * (of(to) - of(from)) / (to - from)
    };
    let off = off(&surface.by_threes(&shears, hertz.half_width), stress) / (mu * hertz.peak);
    let sticking = [(1.0 - part).max(0.0).powf(0.25), exact];
    Ok(Found { load, sticking, off, steps: motion.report().steps() })
}
