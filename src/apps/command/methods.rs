//! `pliant methods`

use clap::Args;
use pliant::{Method, MethodInformation};

use super::failure::{Failure, print};

/// List the integration methods and what each is for
#[derive(Args)]
pub struct Arguments {}

pub fn run(_: &Arguments) -> Result<(), Failure> {
    let width = Method::ALL.iter().map(|method| method.name().len()).max().unwrap_or(0);
    Method::ALL.iter().try_for_each(|method| {
        let default = if *method == Method::default() { " [default]" } else { "" };
        let MethodInformation { purpose, long_name, .. } = method.information();
        print(format_args!(
            "{method:width$}  {purpose} ({long_name}, {}){default}",
            orders(*method)
        ))
    })
}

/// Orders of a method, with that by default.
pub fn orders(method: Method) -> String {
    let MethodInformation { orders: [lowest, highest], default_order, .. } = method.information();
    match default_order {
        _ if lowest == highest => format!("order {lowest}"),
        Some(order) if order != highest => {
            format!("order {lowest} to {highest}, by default {order}")
        }
        _ => format!("order {lowest} to {highest}"),
    }
}
