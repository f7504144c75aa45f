//! `pliant methods`

use clap::Args;
use pliant::Method;

use crate::failure::{Failure, print};

/// List the integration methods and what each is for
#[derive(Args)]
pub struct Arguments {}

pub fn run(_: &Arguments) -> Result<(), Failure> {
    let width = Method::ALL.iter().map(|method| method.name().len()).max().unwrap_or(0);
    Method::ALL.iter().try_for_each(|method| {
        let default = if *method == Method::default() { " [default]" } else { "" };
        print(format_args!("{method:width$}  {}{default}", method.purpose()))
    })
}
