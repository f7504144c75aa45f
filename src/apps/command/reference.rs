//! `pliant reference`

use std::fmt::Write;

use clap::{Arg, Args, Command};
use pliant::{Method, MethodInformation, SceneReader, output, scene_file};

use super::failure::{Failure, print};
use super::methods;

/// Print the reference of scene files, flags and results: docs/reference.md
#[derive(Args)]
pub struct Arguments {}

pub fn run(_: &Arguments, command: Command, reader: &SceneReader) -> Result<(), Failure> {
    print(page(command, reader).trim_end())
}

const HEAD: &str = "\
# Reference

All that `pliant` reads and writes. This page is made by `pliant reference > docs/reference.md`; a test keeps it true.
[scene-files.md](scene-files.md) teaches scene files by examples.

## Scene files

";

const METHODS: &str = "\
## Integration methods

`method` of `[solver]`. DAEs have the forces of constraints among their unknowns. `auto` takes a method where the last column
says so, and the report says why.

| method | in full | `max_order` | equations | for | `auto` takes it where |
| --- | --- | --- | --- | --- | --- |
";

const STUDIES: &str = "\
## Study files

`pliant sweep` reads them. They are TOML, too. [sweeps.md](sweeps.md) teaches them by examples.
";

const RESULTS: &str = "
## Exit codes

| code | meaning |
| --- | --- |
| 0 | done; warnings do not change it |
| 1 | a computation failed or was interrupted, a result could not be written: what was computed is kept, and `report.json` says where and why |
| 2 | bad input: nothing was computed or written |
| 130 | ended by Ctrl-C, SIGTERM or SIGHUP before there was anything to keep |

## Files

All stand in `--out`, by default `out/` and the name of the scene file (`static`: with `-static`). A run takes the results of an earlier one there away.

| file | what is in it |
| --- | --- |
| `trajectory.csv` | one row per sample; it grows while the scene runs |
| `report.json` | how it was computed, warnings, and why it ended |
| `state.json` | the last state, or the equilibrium: `[initial]` of another scene may name it as `from` |
| `snapshots.svg` | pictures (format `svg`) |
| `animation.html` | an animation for the web browser, in one file (format `html`; `pliant beside` puts several side by side) |
| `plot.svg`, `plot.png` | sensors and energies over time (formats `plot`, `png`; not of `static`; `pliant plot` draws them later) |
| `body.pvd`, `body_0000.vtu`, ... | for ParaView (format `vtk`) |

Those of `pliant sweep`, by default in `out/` and the name of the study file with `-sweep`:

| file | what is in it |
| --- | --- |
| `table.csv` | a row for each run: `id`, the keys, the quantities, `verdict` (`fine`, `doubtful`, `failed`), `warnings` (names, with spaces between), `failure`, `difference` (of the last two runs, with an accuracy), `reached` (s), `steps`, `wall_seconds`, `processor_seconds` |
| `rows/<id>.json` | one row, written as a whole by whoever has computed it |
| `plot.svg`, `sweep.html` | quantities over one key, as a map over two, parallel coordinates of more; on the page a click shows the run |
| `runs/<id>/` | the whole output of a run that `--keep` has chosen |
| `study.json` | which study it is |
| `claims/<id>` | locked while the row is computed |
| `slurm.sh`, `tasks/` | the script of an array job, and what tasks have said |

Those of `pliant reduce`, by default beside the scene file:

| file | what is in it |
| --- | --- |
| `NAME.reduced` | the model (JSON): shapes, cells with their weights, errors, and hashes of what identifies the scene |
| `NAME-reduced.json` | what was tried: `unknowns`, `cells`, `error`, `told` (the error that runs told), `seconds` of each; the same of the `full` model; `is_estimate`: whether no run of all unknowns was made (`--modes`) |
| `NAME-reduced.svg`, `NAME-reduced.png` | error over time of all models that were tried |
";

/// The page.
fn page(command: Command, reader: &SceneReader) -> String {
    let [scenes, studies] = [reader.reference(), scene_file::study_reference()];
    let methods = methods_table();
    let mut page =
        format!("{HEAD}{scenes}\n{methods}\n{STUDIES}{studies}\n## Commands and flags\n");
    for command in command.get_subcommands() {
        // writing to a text cannot fail
        let _ = section(&mut page, command);
    }
    format!("{page}{RESULTS}\n{}", output::reference())
}

/// The integration methods, one row for each.
fn methods_table() -> String {
    let row = |method: Method| {
        let MethodInformation { name, long_name, purpose, form, automatic, .. } =
            method.information();
        let (form, orders) = match method {
            Method::Auto => ("that of the choice", "that of the choice".into()),
            _ => (form.name(), methods::orders(method)),
        };
        format!("| `{name}` | {long_name} | {orders} | {form} | {purpose} | {automatic} |\n")
    };
    let rows: String = Method::ALL.into_iter().map(row).collect();
    format!("{METHODS}{rows}")
}

fn section(page: &mut String, command: &Command) -> std::fmt::Result {
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    writeln!(page, "\n### `pliant {}`\n\n{about}.\n", command.get_name())?;
    let arguments: Vec<&Arg> = command.get_arguments().collect();
    if arguments.is_empty() {
        return Ok(());
    }
    writeln!(page, "| argument | meaning |\n| --- | --- |")?;
    arguments.into_iter().try_for_each(|argument| {
        let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
        let (help, written) = (help.replace('\n', " "), written(argument));
        writeln!(page, "| `{written}` | {help} |", written = written.replace('|', "\\|"))
    })
}

/// An argument as it is written.
fn written(argument: &Arg) -> String {
    let values: Vec<&str> =
        argument.get_value_names().unwrap_or_default().iter().map(|name| name.as_str()).collect();
    let takes = argument.get_action().takes_values();
    let values = if takes { values.join(" ") } else { String::new() };
    match argument.get_long() {
        Some(long) => format!("--{long} {values}").trim_end().into(),
        None => values,
    }
}
