//! A soft tube wound with threads, under pressure: which way the threads run decides what it does. Rings let it grow longer and not
//! thicker; helices that climb steeply make it shorter (a McKibben muscle). In between lies the angle at which threads carry
//! the pressure alone, tan(pitch) = 1/sqrt 2, 35.3 degrees: a closed tube has twice the force around it that it has along it.
//!
//! `cargo run --release --example fibre_actuator`
//!
//! What to look for: the sign of the change of length turns between 35 and 36 degrees; without threads the tube would be blown up.

use std::f64::consts::{FRAC_PI_2, PI};

use pliant::{
    Axis, Body, Dilatation, Error, Fibres, Law, Material, Mesh, Phase, Scene, SolidCells, Statics,
};

/// Inner and outer radius, length (m), pressure (Pa).
const INNER: f64 = 0.010;
const OUTER: f64 = 0.011;
const LENGTH: f64 = 0.05;
const PRESSURE: f64 = 1e3;

fn main() -> Result<(), Error> {
    println!("pitch (degrees)   longer by (%)   thicker by (%)");
    let [longer, thicker] = grown(None)?;
    println!("{:>15}   {longer:13.2}   {thicker:14.2}", "no threads");
    for pitch in [0.0, 10.0, 20.0, 30.0, 35.0, 36.0, 40.0, 50.0, 60.0] {
        let [longer, thicker] = grown(Some(pitch))?;
        println!("{pitch:15.1}   {longer:13.2}   {thicker:14.2}");
    }
    Ok(())
}

/// By how much (%) a tube with threads of a pitch (degrees) grows in length and inner radius: a quarter of it, by symmetry.
fn grown(pitch: Option<f64>) -> Result<[f64; 2], Error> {
    let mesh = Mesh::cuboid([1.0, 1.0, LENGTH], [3, 7, 5], SolidCells::Hexahedra)?;
    let mesh = mesh.mapped(|x| {
        let (r, angle) = (INNER + (OUTER - INNER) * x[0], x[1] * FRAC_PI_2);
        [r * angle.cos(), r * angle.sin(), x[2]]
    })?;
    let silicone = Material { density: 1070.0, young: 1e5, poisson: 0.49, viscosity: 0.0 };
    let mut substance = silicone.law(Law::NeoHookean);
    for side in [-1.0, 1.0] {
        let Some(pitch) = pitch else { continue };
        let threads = Fibres::around([0.0; 3], [0.0, 0.0, 1.0], 2e7);
        substance = substance.fibres(threads.pitch(side * f64::to_radians(pitch)));
    }
    let body = Body::new(mesh, substance).dilatation(Dilatation::Mean).build()?;
    let phase = Phase::until(1.0)
        .hold_axes("front", [Axis::Y])
        .hold_axes("back", [Axis::X])
        .hold_axes("bottom", [Axis::Z])
        .pressure_on("left", PRESSURE)
        // the lid
        .load_total("top", [0.0, 0.0, PRESSURE * PI * INNER * INNER / 4.0]);
    let rest = Scene::new(body).phase(phase).equilibrium(&Statics::default())?;
    let (mesh, u) = (rest.trajectory().body().mesh(), rest.displacements());
    let is_inner =
        |node: &usize| mesh.position(*node)[1] == 0.0 && mesh.sets()["left"].contains(node);
    let top = mesh.sets()["top"].iter().copied().find(is_inner).unwrap_or(0);
    Ok([100.0 * u[3 * top + 2] / LENGTH, 100.0 * u[3 * top] / INNER])
}
