//! Examples of SUNDIALS 6.4.1, rewritten for pliant, against the figures of their `.out` files: a table in Markdown. Ends with
//! code 1 if a figure differs in the digits that are printed there.

mod brusselator;
mod kpr;
mod one_way;
mod robertson;
mod second_order;

use std::process::ExitCode;

/// A figure of an example: what SUNDIALS prints, and what pliant computes.
pub struct Figure {
    example: &'static str,
    name: &'static str,
    printed: String,
    found: String,
}

/// The figures of all examples.
#[derive(Default)]
pub struct Figures(Vec<Figure>);

impl Figures {
    /// A count.
    fn count(&mut self, example: &'static str, name: &'static str, printed: u64, found: u64) {
        let (printed, found) = (printed.to_string(), found.to_string());
        self.0.push(Figure { example, name, printed, found });
    }

    /// A number with so many digits after the point of its mantissa, `printed` as `%e` has it.
    fn number(
        &mut self,
        example: &'static str,
        name: &'static str,
        printed: f64,
        digits: usize,
        found: f64,
    ) {
        let text = |x: f64| format!("{x:.digits$e}");
        self.0.push(Figure { example, name, printed: text(printed), found: text(found) });
    }
}

fn main() -> ExitCode {
    let mut figures = Figures::default();
    let outcome = robertson::cvodes(&mut figures)
        .and_then(|()| robertson::idas(&mut figures))
        .and_then(|()| second_order::of_ode(&mut figures))
        .and_then(|()| second_order::of_dae(&mut figures))
        .and_then(|()| one_way::coupling(&mut figures))
        .and_then(|()| kpr::all(&mut figures))
        .and_then(|()| brusselator::imex(&mut figures));
    if let Err(error) = outcome {
        eprintln!("{error}");
        return ExitCode::FAILURE;
    }
    println!("Linked: {}.\n", pliant::sundials::description());
    println!("| example | figure | SUNDIALS prints | pliant | |\n| --- | --- | --- | --- | --- |");
    let mut all_same = true;
    for Figure { example, name, printed, found } in &figures.0 {
        let same = printed == found;
        all_same &= same;
        let mark = if same { "same" } else { "**differs**" };
        println!("| `{example}` | {name} | {printed} | {found} | {mark} |");
    }
    if all_same { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
