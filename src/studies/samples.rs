//! Test problems with trusted answers, each defined once for tests, benchmarks and examples.
//!
//! Errors are relative to the reference, component by component: [`Reference::error`].

#[cfg(feature = "bodies")]
mod actuated;
mod equations;
mod oscillator;
#[cfg(feature = "bodies")]
mod rubber;
#[cfg(feature = "bodies")]
mod scenes;
#[cfg(feature = "bodies")]
mod statics;

#[cfg(feature = "bodies")]
pub use actuated::{
    MEMBRANE_MATERIAL, bending_actuator, membrane, membrane_arch, report_8, ring_jump,
    ring_springs, spring_ring,
};
pub use equations::{
    Brusselator, CarAxis, HeatedSquare, Hires, Oregonator, Pendulum, Pollution, Reference,
    Robertson, TransistorAmplifier, VanDerPol,
};
pub use oscillator::DampedOscillator;
#[cfg(feature = "bodies")]
pub use rubber::{LoadedCantilever, TumblingBlock, TwistingColumn};
#[cfg(feature = "bodies")]
pub use scenes::{
    BEAM_MATERIAL, BENT_BEAM_MATERIAL, BeamJump, ClampedBeam, FLAG_MATERIAL, RingRoll,
    SQUARE_MATERIAL, SquareJump, beam_bend, beam_jump, clamped_beam, pushed_nodes, square_jump,
    square_press,
};
#[cfg(feature = "bodies")]
pub use statics::{beam_static, static_square};
