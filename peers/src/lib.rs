//! The equations that pliant and its peers solve, for Rust and, through [`ffi`] and [`system_ffi`], for Python.

pub mod ffi;
pub mod motion;
pub mod scenes;
pub mod stage;
pub mod system_ffi;
pub mod systems;
