#[path = "scenes/joint_couplings.rs"]
mod joint_couplings;
#[path = "scenes/rod_loads.rs"]
mod rod_loads;
#[path = "scenes/rod_touch.rs"]
mod rod_touch;
#[path = "scenes/rods.rs"]
mod rods;
