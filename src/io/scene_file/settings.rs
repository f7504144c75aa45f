//! `[solver]`, `[statics]` and `[output]`.

use super::contents::{AccuracyRequest, Format, OutputRequest, StaticsRequest};
use super::keys::{Key, TableKeys, ValueType};
use super::selection::selection;
use super::smaller::{HALF, PLANE, ROD};
use super::value::Value;
use crate::base::input::{find, positive};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::statics::Statics;
use crate::scene::ReducedModel;
use crate::scene::settings::{Settings, SettingsOption, SettingsValue as Kind};
use crate::scene::timeline::{Phase, Scene};

pub(super) const SOLVER: TableKeys = TableKeys::new(
    "[solver]",
    "How the equations of motion are integrated.",
    &OPTIONS,
    "[solver]\nmethod = \"cvode-bdf\"\nrtol = 1e-6\nalpha = 1e4",
);

const OPTIONS: [Key; SettingsOption::ALL.len() + 6] = {
    let mut keys = [QUANTITY; SettingsOption::ALL.len() + 6];
    keys[0] = ACCURACY;
    keys[SettingsOption::ALL.len() + 2] = REDUCED;
    keys[SettingsOption::ALL.len() + 3] = HALF;
    keys[SettingsOption::ALL.len() + 4] = PLANE;
    keys[SettingsOption::ALL.len() + 5] = ROD;
    let mut number = 0;
    while number < SettingsOption::ALL.len() {
        keys[number + 1] = key(&SettingsOption::ALL[number]);
        number += 1;
    }
    keys
};

const ACCURACY: Key = Key::new(
    "accuracy",
    ValueType::Either(&[ValueType::Number, ValueType::Text]),
    "how accurate the motion has to be, as `\"1%\"` or `0.01`",
)
.note(
    "The scene is run with a tighter and tighter `rtol`, until two runs agree to that: see `pliant run --help`. Not beside \
     `rtol`.",
)
.default("one run by `rtol`");
const QUANTITY: Key = Key::new("quantity", ValueType::Text, "the quantity to which `accuracy` applies")
    .note(QUANTITIES)
    .default("the whole motion");
const REDUCED: Key = Key::new(
    "reduced",
    ValueType::Text,
    "the reduced model by which it is run: a file of `pliant reduce`, relative to the scene file",
)
.note("`\"\"` is all unknowns. Statics always uses all of them.")
.default("all unknowns");
const QUANTITIES: &str = "`motion`; a sensor or a set of nodes, with a component where need be, as `tip.y`; `com`, `rotation`; \
     behind a colon the part that counts, where all times do not: `end`, `max`, `min`, `frequency`, `damping`.";

const fn key(option: &SettingsOption) -> Key {
    let holds = match option.value {
        Kind::Number(_) => ValueType::Number,
        Kind::Count(_) => ValueType::Count,
        Kind::Flag(_) => ValueType::Flag,
        Kind::Word(words, _) => ValueType::Word(words),
    };
    Key::new(option.key, holds, option.meaning).in_unit(option.unit).default(option.default)
}

pub(super) const STATICS: TableKeys = TableKeys::new(
    "[statics]",
    "How `pliant static` seeks an equilibrium: that under the constraints, loads, obstacles and springs of a phase at its end. \
     What earlier phases have moved and this one holds stays there. Friction does not act.",
    &[
        Key::new("phase", ValueType::Text, "the name of the phase").default("the first one"),
        Key::new("load_steps", ValueType::Count, "steps in which constraints and loads are brought on")
            .note("With more than one, the results have the equilibrium of each, with its `load factor`.")
            .default("1"),
        Key::new("arc_steps", ValueType::Count, "most steps by arc length")
            .note(
                "With them the load rises and falls as the path of equilibria has it, through snap-through and \
                 snap-back, until all of it acts. The first step is that of one of the `load_steps`, and none is longer.",
            )
            .default("0: the load is given"),
        Key::number("rtol", "the largest force left over, relative to the largest force", "1")
            .default("1e-10"),
        Key::new("max_iterations", ValueType::Count, "Newton iterations of one load step")
            .default("100"),
        Key::number("min_load_step", "the smallest load step, as a part of the whole load", "1")
            .default("1e-3"),
    ],
    "[statics]\nphase = \"phase 1\"\nload_steps = 20",
);

pub(super) const OUTPUT: TableKeys = TableKeys::new(
    "[output]",
    "What `pliant run` writes.",
    &[
        Key::number("step", "the time between samples", "s").default("the ends of the phases only"),
        Key::new("times", ValueType::List(&ValueType::Number), "times of samples, in any order, in place of a step")
            .in_unit("s")
            .note("The start and the ends of the phases are sampled in addition."),
        Key::new("track", ValueType::Nodes, "nodes whose displacements the table lists"),
        Key::new(
            "formats",
            ValueType::OneOrMore(&ValueType::Word(|| Format::ALL.map(Format::name).into())),
            "files that are written: a table, files for ParaView, snapshots, an animation, a plot of sensors and energies \
             as a drawing or as pixels",
        )
        .default("csv, which is always written"),
    ],
    "[output]\nstep = 0.01\ntrack = \"right\"\nformats = [\"csv\", \"svg\", \"html\"]",
);

pub(super) fn solver(value: &Value) -> Result<Settings, Error> {
    let table = value.table(&SOLVER)?;
    let mut settings = Settings::default();
    for option in SettingsOption::ALL {
        let Some(value) = table.get(option.key) else { continue };
        match option.value {
            Kind::Number(set) => set(&mut settings, value.number()?),
            Kind::Count(set) => set(&mut settings, value.count()?),
            Kind::Flag(set) => set(&mut settings, value.flag()?),
            Kind::Word(words, set) => {
                let words: Vec<_> = words().into_iter().map(|word| (word, word)).collect();
                set(&mut settings, value.word(&words)?).map_err(|error| table.blame(error))?;
            }
        }
    }
    settings.validate().map_err(|error| table.blame(error))?;
    Ok(settings)
}

/// How accurate the motion has to be, and in what.
pub(super) fn accuracy(value: &Value) -> Result<AccuracyRequest, Error> {
    let table = value.table(&SOLVER)?;
    let within = table.optional("accuracy", Value::fraction)?;
    let quantity = table.optional("quantity", Value::string)?.map(String::from);
    if within.is_some() && table.get("rtol").is_some() {
        return Err(table.error("accuracy finds rtol by itself: leave one of them out"));
    }
    Ok(AccuracyRequest { within, quantity })
}

/// The scene by its reduced model, if it names one.
pub(super) fn reduced(scene: Scene, value: &Value) -> Result<Scene, Error> {
    match value.table(&SOLVER)?.get("reduced") {
        Some(file) if !file.string()?.is_empty() => {
            let model = ReducedModel::read(file.source.beside(file.string()?), &scene);
            let model = model.map_err(|error| file.error(error))?;
            scene.reduced(model).map_err(|error| file.error(error))
        }
        _ => Ok(scene),
    }
}

pub(super) fn statics(value: &Value, scene: &Scene) -> Result<StaticsRequest, Error> {
    let table = value.table(&STATICS)?;
    let phase = table.optional("phase", Value::string)?;
    if let Some(phase) = &phase {
        let names = scene.phases().iter().map(Phase::name);
        find(phase, names, "phase", "phases").map_err(|error| table.blame(error))?;
    }
    let count = |key| table.optional(key, Value::count);
    let number = |key| table.optional(key, Value::number);
    let default = Statics::default();
    let options = Statics {
        rtol: number("rtol")?.unwrap_or(default.rtol),
        max_iterations: count("max_iterations")?.unwrap_or(default.max_iterations),
        load_steps: count("load_steps")?.unwrap_or(default.load_steps),
        arc_steps: count("arc_steps")?.unwrap_or(default.arc_steps),
        min_load_step: number("min_load_step")?.unwrap_or(default.min_load_step),
    };
    options.validate().map_err(|error| table.blame(error))?;
    Ok(StaticsRequest { phase: phase.map(Into::into), options })
}

pub(super) fn output(value: &Value, scene: &Scene) -> Result<OutputRequest, Error> {
    let table = value.table(&OUTPUT)?;
    let step = table.optional("step", Value::number)?;
    if let Some(step) = step {
        positive("step", step, "s").map_err(|error| table.blame(error))?;
    }
    let times = table.optional("times", |value| {
        let times = value.numbers()?;
        if step.is_some() {
            return Err(value.error("samples are taken at times or by step: give one of them"));
        }
        Sampling::at(&*times).check(scene).map_err(|error| value.error(error))?;
        Ok(times)
    })?;
    let track = table.optional("track", |value| selection(value, scene.body().mesh()))?;
    let formats = table.optional("formats", |value| {
        let known = Format::ALL.map(|format| (format.name(), format));
        value.one_or_more()?.iter().map(|format| format.word(&known)).collect()
    })?;
    let formats = formats.unwrap_or_else(|| vec![Format::Csv]);
    Ok(OutputRequest { step, times, track, sensors: Vec::new(), formats })
}
