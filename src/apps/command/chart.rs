//! `pliant chart`

use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pliant::ContactEvents;
use pliant::studies::work_precision::{Scenes, Stage, Study, all_methods};
use pliant::{Method, SceneFile, Settings};

use super::failure::{Failure, print};
use super::files::Directory;
use super::scene::SceneArguments;
use super::settings::ended;

/// Chart speed against accuracy on a scene, method by method and tolerance by tolerance
///
/// Errors are those of node positions, relative to the motion, against a reference that two
/// methods agree on. Writes chart.svg, chart.png, chart.md (the fastest for each accuracy, and what to know
/// before trusting it) and chart.csv (all runs). Runs that chart.csv has already are not run again,
/// so that a command that was interrupted can be given again. --set counts for the variants, too. Of the file's table [solver] only
/// alpha and contact_events count.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// Integration methods [default: all, some of them with several orders]
    #[arg(long, value_delimiter = ',')]
    methods: Vec<Method>,
    /// Highest orders of the methods [default: each method's own]
    #[arg(long, value_delimiter = ',', value_name = "ORDERS")]
    max_order: Vec<u32>,
    /// Relative tolerances, from rough to fine
    #[arg(long, value_delimiter = ',', default_value = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7,1e-8")]
    rtol: Vec<f64>,
    /// Rates at which errors of constraints decay (1/s); the reference has the first [default: that
    /// of the file]
    #[arg(long, value_delimiter = ',')]
    alpha: Vec<f64>,
    /// How contact events are met: step-over, locate or both [default: as the file has it]
    #[arg(long, value_delimiter = ',', value_name = "WAYS")]
    contact_events: Vec<ContactEvents>,
    /// Other scene files, to be compared with the motion of the first: another strain, other cells
    #[arg(long, value_delimiter = ',', value_name = "FILES")]
    variants: Vec<PathBuf>,
    /// End the scenes at this time (s)
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    /// How often each run is repeated to be timed
    #[arg(long, value_name = "COUNT", default_value_t = 3)]
    repetitions: usize,
    /// Processor time that any run may take (s)
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0)]
    limit: f64,
    /// Chart processor times, which a busy machine disturbs less than wall-clock times
    #[arg(long)]
    processor_time: bool,
    /// Directory for the results [default: out/ and the name of the scene file, with -chart]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Show no progress, and print nothing but the results
    #[arg(long, short)]
    quiet: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let file = arguments.scene.read()?;
    let stem = stem(&arguments.scene.path);
    let title = arguments.scene.title(if file.title.is_empty() { &stem } else { &file.title });
    let path = arguments.out.clone().unwrap_or(Path::new("out").join(format!("{stem}-chart")));
    let mut directory = Directory::new(path.clone())?;

    let mut scenes = problem(arguments, &title, &file)?;
    let bar = bar(arguments.quiet);
    let findings = Study::new(&mut scenes)
        .repetitions(arguments.repetitions)
        .limit(arguments.limit)
        .keep(path.join("chart.csv"))
        .run(&mut |Stage { done, all, what }| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
            bar.set_message(what.to_owned());
        });
    bar.finish_and_clear();
    let findings = match arguments.processor_time {
        true => findings?.by_processor_time(),
        false => findings?,
    };

    directory.write("chart.csv", |_| Ok(()))?;
    directory.write("chart.md", |path| findings.write_table(path))?;
    print(format_args!("{title}\n\n{}\n", findings.fastest()))?;
    findings.notes().iter().try_for_each(print)?;
    if findings.rows().all(|row| row.failure.is_some()) {
        return Err(Failure::failed("no run succeeded: there is nothing to chart"));
    }
    directory.write("chart.svg", |path| findings.write_chart(path))?;
    directory.write("chart.png", |path| findings.write_chart(path))?;
    if !arguments.quiet {
        directory.tell()?;
    }
    Ok(())
}

/// The scene with all requested settings, then the variants.
fn problem(arguments: &Arguments, title: &str, file: &SceneFile) -> Result<Scenes, Failure> {
    let lines = lines(arguments, &file.settings);
    let mut scenes = Scenes::new(title, ended(file.scene.clone(), arguments.until)?)
        .alpha(arguments.alpha.first().copied().unwrap_or(file.settings.alpha))
        .tolerances(arguments.rtol.clone());
    for (name, settings) in &lines {
        scenes = scenes.line(name, settings.clone());
    }
    for path in &arguments.variants {
        let (variant, stem) = (arguments.scene.read_too(path)?, stem(path));
        for (name, settings) in &lines {
            let scene = ended(variant.scene.clone(), arguments.until)?;
            scenes = scenes.variant(format!("{stem}: {name}"), scene, settings.clone());
        }
    }
    Ok(scenes)
}

/// Name and settings of all lines: methods, alpha and contact events combined.
fn lines(arguments: &Arguments, file: &Settings) -> Vec<(String, Settings)> {
    let Arguments { methods, max_order, alpha, contact_events, .. } = arguments;
    let mut lines = match methods[..] {
        [] => all_methods(),
        _ => {
            let settings = |&method: &Method| Settings { method, ..Settings::default() };
            methods.iter().map(|method| (method.to_string(), settings(method))).collect()
        }
    };
    if !max_order.is_empty() {
        lines = combined(lines, max_order, |settings, order| {
            settings.max_order = Some(order);
            format!("order {order}")
        });
    }
    lines = combined(lines, or(alpha, &file.alpha), |settings, alpha| {
        settings.alpha = alpha;
        format!("alpha {alpha:e}")
    });
    combined(lines, or(contact_events, &file.contact_events), |settings, events| {
        settings.contact_events = events;
        events.to_string()
    })
}

/// `values`, or `default` if there is none.
fn or<'a, T>(values: &'a [T], default: &'a T) -> &'a [T] {
    if values.is_empty() { std::slice::from_ref(default) } else { values }
}

/// Each of `lines` with each of `values`, named after the value if there are several.
fn combined<T: Copy>(
    lines: Vec<(String, Settings)>,
    values: &[T],
    set: impl Fn(&mut Settings, T) -> String,
) -> Vec<(String, Settings)> {
    let with = |(name, settings): &(String, Settings), value: T| {
        let mut settings = settings.clone();
        let said = set(&mut settings, value);
        match values {
            [_] => (name.clone(), settings),
            _ => (format!("{name}, {said}"), settings),
        }
    };
    lines.iter().flat_map(|settings| values.iter().map(|value| with(settings, *value))).collect()
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The progress bar: drawn only on a terminal, and not if `quiet`.
fn bar(quiet: bool) -> ProgressBar {
    let target = match quiet {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr(),
    };
    let bar = ProgressBar::with_draw_target(Some(1), target);
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len}, {elapsed}: {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
