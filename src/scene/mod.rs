//! Scenes: a body, what surrounds it, what happens when, and how that is integrated.
//!
//! [`timeline`] has [`Scene`] and its [`Phase`]s, [`constraint`] what is held and moved, `forces` gravity,
//! loads, contact, springs and chambers, `devices` what is defined in one place, `settings` method and tolerances.

pub mod constraint;
pub(crate) mod devices;
pub(crate) mod forces;
pub(crate) mod reduced_model;
pub(crate) mod settings;
pub mod timeline;

pub use reduced_model::ReducedModel;
pub use timeline::{
    BodyState, Device, DeviceGauge, DeviceInput, DeviceMultipliers, DeviceOutput, DeviceRow,
    DeviceSignals, DeviceSite, DeviceState, DeviceValue, InputLimit, Phase, Scene, SceneState,
    Smaller, Term,
};
