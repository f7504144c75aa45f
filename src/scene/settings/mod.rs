//! Settings of the integration of a scene: method, tolerances, limits.

mod method;
mod options;
mod record;

pub use method::{ContactEvents, Method, MethodInformation, MotionForm};
pub use options::{SettingsOption, SettingsValue};
pub(crate) use record::Scales;
pub use record::{AbsoluteTolerances, Settings};
