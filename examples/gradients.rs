//! Gradients at work: which modulus and which density let the tip of a clamped beam come down by 7 mm under a sudden load and swing at
//! 6 Hz, by Newton's method with the derivatives of both by both.
//!
//! `cargo run --release --example gradients`
//!
//! What to look for: three steps are enough, as the derivatives are those of the computed motion to eight digits; the estimated
//! errors are printed beside them. By differences of ordinary runs Newton's method would wander at the level of their tolerance.

use std::path::Path;

use pliant::gradient::{Gradient, Objective, SceneGradient};
use pliant::{Error, SceneReader};

const BEAM: &str = r#"
[body]
mesh = { kind = "rectangle", size = [0.1, 0.01], nodes = [9, 2], cells = "triangles6" }
thickness = 0.01
strain = "green"
material = { density = 1000.0, young = 1.0e6, poisson = 0.3, viscosity = 2000.0 }

[[phase]]
until = 1.5
hold = { nodes = "left" }
load = { nodes = "right", total = [0.0, -0.01] }

[[sensor]]
name = "tip"
kind = "displacement"
nodes = "right"
"#;

const KEYS: [&str; 2] = ["body.material.young", "body.material.density"];
/// Where the tip is at its lowest (m), and its frequency (Hz), that are wanted.
const WANTED: [f64; 2] = [-7e-3, 6.0];

fn gradient(of: &str, at: [f64; 2]) -> Result<Gradient, Error> {
    let set: Vec<String> = KEYS.iter().zip(at).map(|(key, x)| format!("{key}={x:?}")).collect();
    let (reader, path) = (SceneReader::default(), Path::new("beam.toml"));
    let of = Objective::Quantity(of.into());
    SceneGradient::of_text(&reader, BEAM, path, &set, of, &KEYS)?.value_and_gradient(&mut |_| {})
}

fn main() -> Result<(), Error> {
    let mut at = [1.0e6, 1000.0];
    for step in 1..=4 {
        let [lowest, swing] = [gradient("tip.y:min", at)?, gradient("tip.y:frequency", at)?];
        println!("step {step}, E = {:.5e} Pa, density = {:.3} kg/m^3", at[0], at[1]);
        println!("{lowest}\n{swing}\n");
        let rows = [&lowest, &swing].map(|of| [of.derivatives[0].value, of.derivatives[1].value]);
        let off = [WANTED[0] - lowest.value, WANTED[1] - swing.value];
        let determinant = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0];
        at[0] += (off[0] * rows[1][1] - off[1] * rows[0][1]) / determinant;
        at[1] += (off[1] * rows[0][0] - off[0] * rows[1][0]) / determinant;
    }
    Ok(())
}
