//! `pliant advise`

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pliant::Fraction;
use pliant::study::{Adviser, Quantity};

use crate::failure::{Failure, print};
use crate::scene::SceneArguments;
use crate::settings::{SettingsArguments, ended};

/// Find out what model of a scene is enough
///
/// Runs the scene with the other measure of strain, with finer and quadratic cells, with lumped inertia, without gravity,
/// viscosity, friction or an obstacle, by several methods and tolerances, and tells what is enough for a quantity to be
/// right, what each step up would change, and what it costs.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// What has to be right: motion, a sensor or node set and a component such as tip.y, com.x, rotation; with :end,
    /// :max, :min, :frequency or :damping that alone
    #[arg(long, value_name = "QUANTITY", default_value = "motion")]
    quantity: String,
    /// How right: 1% or 0.01
    #[arg(long, value_name = "PART", default_value = "1%")]
    within: Fraction,
    /// Time that all runs may take together (s)
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    budget: f64,
    /// End the scene at this time (s)
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    /// Show no progress
    #[arg(long, short)]
    quiet: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, settings, quantity, within, budget, until, quiet } = arguments;
    let mut file = scene.read()?;
    settings.apply(&mut file.settings)?;
    file.scene = ended(file.scene, *until)?;
    let quantity = Quantity::named(quantity, &file.scene, &file.output.sensors)?;
    let adviser = Adviser::new(&file.scene, within.0)
        .settings(file.settings.clone())
        .quantity(quantity)
        .budget(*budget);
    let interrupted = Arc::new(AtomicBool::new(false));
    let asked = interrupted.clone();
    ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed))
        .map_err(|error| Failure::failed(format!("cannot watch for Ctrl-C: {error}")))?;
    let bar = bar(*quiet);
    let advice = adviser.run(&mut |what| {
        bar.set_message(what.to_owned());
        match interrupted.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    bar.finish_and_clear();
    print(advice?)
}

/// What is being tried, on a terminal only.
fn bar(quiet: bool) -> ProgressBar {
    let target = match quiet {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr(),
    };
    let bar = ProgressBar::with_draw_target(None, target);
    let style = ProgressStyle::with_template("{elapsed}, {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar
}
