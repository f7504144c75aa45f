//! `pliant laws`

use clap::Args;
use pliant::scene_file;

use super::failure::{Failure, print};

/// List the material laws, what each is for, and its constants
#[derive(Args)]
pub struct Arguments {}

pub fn run(_: &Arguments) -> Result<(), Failure> {
    let width = scene_file::laws().map(|(word, ..)| word.len()).max().unwrap_or(0);
    scene_file::laws().try_for_each(|(word, about, constants)| {
        print(format_args!("{word:width$}  {about}"))?;
        constants.iter().try_for_each(|constant| print(format_args!("{:width$}    {constant}", "")))
    })?;
    print(
        "\nI1 and I2 are invariants of J^(-2/3) C; U = (kappa/4) (J^2 - 1 - 2 ln J) resists a change of volume. Young's modulus and Poisson's ratio\n\
         are those at small strains: where a law has no constants in its list, they make it; else its constants make them.\n\
         In a scene file: law = { kind = \"neo-hookean\" } of a material; without it st-venant-kirchhoff, with strain = \"cauchy\" linear elasticity.\n\
         Fibres, Maxwell branches and damping stand beside any law: `pliant reference`.",
    )
}
