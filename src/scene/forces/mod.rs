//! Forces on a body from outside: one file per kind of force.

mod actuator;
mod basin;
mod chamber;
mod chamber_fluid;
mod contact;
mod faces;
mod fixed_amount;
mod fluid;
mod followed;
mod friction;
mod gas;
mod gravity;
mod growth;
mod lag;
mod liquid;
mod load;
mod magnet;
mod moment;
mod muscle;
mod nodal;
mod obstacle;
mod passage;
mod pipe;
mod pressure;
mod section_wrench;
mod shape;
mod signal;
mod signals;
mod spring;
mod stuck;
mod surface;
#[cfg(test)]
mod tests;
mod time_table;
mod touch;
mod travel;
mod turned;
mod wrench;
mod wrench_kind;

pub(crate) use actuator::{
    Actuator, ActuatorGauge, ActuatorKind, ActuatorState, ComponentMap, Drive, LinePoint, Placed,
};
pub use chamber::Chamber;
pub(crate) use chamber::{ChamberForce, TURNED};
pub(crate) use chamber_fluid::ChamberFluid;
pub(crate) use contact::Contact;
pub(crate) use faces::{areas, shares};
pub(crate) use fixed_amount::FixedAmount;
pub use fluid::Fluid;
pub(crate) use fluid::FluidForce;
pub(crate) use gas::{ATMOSPHERE, AmountFlow, End, GasInChamber, OrificeFlow, Supply};
pub use gas::{Gas, Orifice};
pub(crate) use gravity::Gravity;
pub use growth::Growth;
pub use lag::Lag;
pub(crate) use lag::Lagging;
pub use liquid::Liquid;
pub(crate) use liquid::{LiquidInChamber, Weight};
pub(crate) use load::{Load, VaryingLoad};
pub(crate) use magnet::Gradient;
pub use magnet::{Magnet, MagneticField};
pub use muscle::Muscle;
pub(crate) use nodal::Tributary;
pub use nodal::{ContactStatus, NodalContact};
pub use obstacle::Obstacle;
pub use pipe::Pipe;
pub(crate) use pipe::{Mouth, PipeFlow};
pub(crate) use pressure::FacePressure;
#[cfg(feature = "output")]
pub(crate) use shape::Kind as ShapeKind;
pub use shape::Shape;
pub use signal::Signal;
pub(crate) use signal::{SharedValue, SignalKind, VectorSignal, finite_at};
pub use signals::Signals;
pub use spring::{Guide, Spring};
pub(crate) use stuck::Stuck;
pub(crate) use surface::{
    SurfacePoint, boundary_nodes, edge_points, face_centre, natural, pieces, thickness, weighted,
};
pub(crate) use time_table::TimeTable;
pub use touch::{Touch, TouchDistance};
pub(crate) use touch::{TouchForce, TouchSite, way};
#[cfg(feature = "output")]
pub(crate) use turned::corners;
pub(crate) use wrench::WrenchForce;
pub(crate) use wrench_kind::WrenchKind;

/// The kinds of actuators, in the order in which a scene has them, and so adds their forces.
pub(crate) const ACTUATORS: [&ActuatorKind; 5] =
    [&spring::SPRING, &spring::CABLE, &spring::WINCH, &muscle::MUSCLE, &growth::GROWTH];
