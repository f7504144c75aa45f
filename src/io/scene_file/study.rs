//! Study files: the varied keys of a scene, their values, and the stored results of each run.

use std::cell::RefCell;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use toml::de::DeTable;

use super::keys::{Key, Kind, TableKeys, ValueType};
use super::set_value::SetValue;
use super::source::{SourceText, no_toml, text_of};
use super::table::Table;
use super::value::Value;
use crate::base::input::{Fraction, InputError};
use crate::dynamics::error::Error;

/// Contents of a study file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StudyFile {
    /// Path of its file; empty for a study that a program has made.
    pub path: PathBuf,
    /// Title; empty without one.
    pub title: String,
    /// The scene file.
    pub scene: PathBuf,
    /// Values that all runs have, each as `body.material.young=2e5`.
    pub set: Vec<Written>,
    /// The quantities that are kept, each as `com.y:max`.
    pub quantities: Vec<Written>,
    /// Whether each point is an equilibrium, and not a run.
    pub is_static: bool,
    /// Required accuracy of each run.
    pub accuracy: Option<Fraction>,
    /// A table (CSV) each row of which is a point.
    pub table: Option<Written>,
    /// The keys that are varied.
    pub keys: Vec<VariedKey>,
    /// Filling of ranges without steps.
    pub sample: Option<SampleRequest>,
}

/// A text of a study, and the line where it stands (from 1; 0 if it was not read from a file).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Its line.
    pub line: usize,
}

/// A key of a scene that is varied.
#[derive(Debug, Clone, PartialEq)]
pub struct VariedKey {
    /// The key, as `obstacle.floor.stiffness`.
    pub name: Written,
    /// Its values.
    pub values: Varied,
}

/// The values of a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Varied {
    /// These values, each with its line.
    Values(Vec<(SetValue, usize)>),
    /// A range.
    Range {
        /// Its least and its largest value.
        ends: [f64; 2],
        /// Number of its values.
        spacing: Spacing,
        /// Whether steps are ratios.
        is_logarithmic: bool,
        /// Whether its ends and its step are written as whole numbers.
        is_whole: bool,
    },
}

/// Number of values of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// So many, with both ends.
    Count(usize),
    /// One at each multiple of a step from the least value on.
    Step(f64),
    /// As [`StudyFile::sample`] has it, together with other such ranges.
    Sampled,
}

/// Filling of ranges without steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleRequest {
    /// Which points.
    pub method: SampleMethod,
    /// Their number.
    pub count: usize,
    /// The seed of a Latin hypercube; how many points of Sobol's sequence are left out at its beginning.
    pub seed: u64,
    /// Its line.
    pub line: usize,
}

/// Points that fill ranges evenly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleMethod {
    /// Each range is cut into as many parts as there are points, and each part has one point.
    LatinHypercube,
    /// Sobol's sequence.
    Sobol,
}

const SAMPLE_COUNT: Key = Key::new("count", ValueType::Count, "the number of points").required();

const SAMPLE: TableKeys = TableKeys::new(
    "[sample]",
    "How the ranges that have neither `count` nor `step` are filled, all of them together.",
    &[SAMPLE_COUNT],
    "[sample]\nkind = \"latin-hypercube\"\ncount = 200",
)
.kinds(&[
    Kind {
        word: "latin-hypercube",
        about: "each range is cut into as many parts as there are points, and each part has one point",
        keys: &[Key::new("seed", ValueType::Count, "another seed, other points").default("0")],
    },
    Kind {
        word: "sobol",
        about: "Sobol's sequence: more points can be added later, and those that are there stay",
        keys: &[
            Key::new("skip", ValueType::Count, "how many points are left out at its beginning")
                .note("The first one has all keys at the ends `from`.")
                .default("0"),
        ],
    },
]);

const VALUE: ValueType = ValueType::Either(&[ValueType::Number, ValueType::Text, ValueType::Flag]);

const KEY: TableKeys = TableKeys::new(
    "[[key]]",
    "A key of the scene, and the values that it takes. Each of them is combined with all values of the other keys.",
    &[
        Key::new("name", ValueType::Text, "the key of the scene file, as `--set` takes it").required(),
        Key::new("values", ValueType::List(&VALUE), "a list of values"),
        Key::new("from", ValueType::Number, "the least value of a range"),
        Key::new("to", ValueType::Number, "the largest value of a range"),
        Key::new("count", ValueType::Count, "how many values the range has, with both ends"),
        Key::new("step", ValueType::Number, "the distance of the values of the range"),
        Key::new("scale", ValueType::Word(|| SCALES.map(|(word, _)| word).into()), "whether equal steps are differences or ratios")
            .default("`\"linear\"`"),
    ],
    "[[key]]\nname = \"obstacle.floor.stiffness\"\nfrom = 20.0\nto = 2000.0\ncount = 40\nscale = \"logarithmic\"",
)
.one_of(&[&["values"], &["from", "to"], &["from", "to", "count"], &["from", "to", "step"]]);

const SCALES: [(&str, bool); 2] = [("linear", false), ("logarithmic", true)];

/// The file.
pub(super) const STUDY: TableKeys = TableKeys::new(
    "The study file",
    "The keys before the first table. `pliant sweep` runs the scene, or finds its equilibrium, once for each combination of the values of all keys.",
    &[
        Key::new("title", ValueType::Text, "the title, for pictures and pages"),
        Key::new("scene", ValueType::Text, "the scene file, relative to this one").required(),
        Key::new(
            "set",
            ValueType::List(&ValueType::Text),
            "values that all runs have, as `--set` takes them",
        ),
        Key::new(
            "quantities",
            ValueType::List(&ValueType::Text),
            "quantities that are kept of each run: as `--quantity` of `run` takes them, each one number",
        )
        .note("As `\"com.y:max\"`; `:end`, `:max`, `:min`, `:mean`, `:frequency`, `:damping`.")
        .required(),
        Key::new("static", ValueType::Flag, "whether equilibria are sought, and nothing is run")
            .note(
                "As `pliant static` does, by `[statics]` of the scene. Quantities are those of the equilibrium: `\"tip.y\"`. Not beside \
                 `accuracy`.",
            )
            .default("false"),
        Key::new(
            "accuracy",
            ValueType::Either(&[ValueType::Text, ValueType::Number]),
            "how accurate each run has to be, as `--accuracy` of `run` takes it",
        )
        .note("In the quantity that `[solver]` of the scene names, or else the first one.")
        .default("that of the scene"),
        Key::new(
            "table",
            ValueType::Text,
            "a table (CSV) each row of which is a point; its heads are keys of the scene",
        )
        .note("Combined with the values of other keys, if there are any."),
        Key::new("key", ValueType::Tables(&KEY), "the keys that are varied"),
        Key::new("sample", ValueType::Table(&SAMPLE), "how ranges without steps are filled"),
    ],
    "title = \"How high the square jumps\"\nscene = \"square-jump.toml\"\nquantities = [\"com.y:max\"]",
);

impl StudyFile {
    /// Reads a study file.
    ///
    /// # Errors
    /// A file that cannot be read; [`Error::SceneFile`] with the line for anything that is wrong inside.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        Self::parse(&text_of(path)?, path)
    }

    /// As [`read`](Self::read), from the `text` of a file at `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        let source = SourceText { path, text, own: text.len(), notes: RefCell::default() };
        let document = DeTable::parse(text).map_err(|error| no_toml(&source, &error))?;
        let (at, entries) = (document.span(), document.into_inner());
        study(&Table::new(&source, String::new(), at, &entries, &STUDY)?)
    }

    /// An error about what stands in a line of this file, the value of `key`.
    pub(crate) fn error(&self, line: usize, key: &str, problem: impl Display) -> Error {
        match line {
            0 => InputError::new("study", key, problem.to_string()).into(),
            line => {
                let (key, message) = (key.into(), problem.to_string());
                Error::SceneFile { path: self.path.clone(), line, key, message }
            }
        }
    }
}

fn study(top: &Table) -> Result<StudyFile, Error> {
    let text = |key| top.optional(key, |value| written(value));
    let texts = |key| {
        let list = top.optional(key, |value| value.list_of("texts in quotes", written))?;
        Ok::<_, Error>(list.unwrap_or_default())
    };
    let scene = top.required("scene", |value| Ok(value.source.beside(value.string()?)))?;
    top.required("quantities", Value::list)?;
    let keys = top.tables("key", &KEY)?.iter().map(key).collect::<Result<_, _>>()?;
    Ok(StudyFile {
        path: top.path().into(),
        title: text("title")?.unwrap_or_default().text,
        scene,
        set: texts("set")?,
        quantities: texts("quantities")?,
        is_static: top.optional("static", Value::flag)?.unwrap_or(false),
        accuracy: top.optional("accuracy", Value::fraction)?,
        table: text("table")?,
        keys,
        sample: top.optional("sample", |value| sample(&value.table(&SAMPLE)?, value.line()))?,
    })
}

fn written(value: &Value) -> Result<Written, Error> {
    Ok(Written { text: value.string()?.into(), line: value.line() })
}

fn key(table: &Table) -> Result<VariedKey, Error> {
    let name = table.required("name", written)?;
    let scale = table.optional("scale", |value| value.word(&SCALES))?;
    let is_logarithmic = scale.unwrap_or(false);
    if let Some(values) = table.get("values") {
        if let Some(scale) = table.get("scale") {
            return Err(scale.error("a list has no scale: it belongs to from and to"));
        }
        let values = values.list()?;
        let one = |value: &Value| Ok((SetValue::of(value.value, value.text()), value.line()));
        let values = values.iter().map(one).collect::<Result<_, Error>>()?;
        return Ok(VariedKey { name, values: Varied::Values(values) });
    }
    let ends = [table.required("from", Value::finite)?, table.required("to", Value::finite)?];
    let step = table.optional("step", Value::finite)?;
    let spacing = match (table.optional("count", Value::count)?, step) {
        (Some(count), _) => Spacing::Count(count),
        (None, Some(step)) => Spacing::Step(step),
        (None, None) => Spacing::Sampled,
    };
    let mut written = ["from", "to", "step"].into_iter().filter_map(|key| table.get(key));
    let is_whole = written.all(|value| value.is_whole());
    Ok(VariedKey { name, values: Varied::Range { ends, spacing, is_logarithmic, is_whole } })
}

fn sample(table: &Table, line: usize) -> Result<SampleRequest, Error> {
    let (method, seed) = match table.kind() {
        "sobol" => (SampleMethod::Sobol, "skip"),
        _ => (SampleMethod::LatinHypercube, "seed"),
    };
    let seed = table.optional(seed, Value::count)?.unwrap_or(0) as u64;
    Ok(SampleRequest { method, count: table.required("count", Value::count)?, seed, line })
}
