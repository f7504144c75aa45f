//! The tables and keys that a scene file may have: reading, the reference page and the JSON Schema all use
//! them.

use std::fmt;

/// The word by which a file leaves a choice to `pliant`.
pub(super) const AUTO: &str = "auto";

/// A table of a scene file.
#[derive(Debug)]
pub(super) struct TableKeys {
    /// Name, as in `[body]` or `hold`.
    pub(super) name: &'static str,
    /// Description of the table and the common meaning of its keys: sentences in Markdown.
    pub(super) about: &'static str,
    pub(super) keys: &'static [Key],
    /// The words of the key `kind`, if there is one.
    pub(super) kinds: &'static [Kind],
    /// Groups of keys of which exactly one has to be there.
    pub(super) one_of: &'static [&'static [&'static str]],
    /// A piece of a scene file.
    pub(super) example: &'static str,
}

/// A word of the key `kind`, with the keys that come with it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    pub(super) word: &'static str,
    pub(super) about: &'static str,
    pub(super) keys: &'static [Key],
}

/// A key of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct Key {
    pub(super) name: &'static str,
    pub(super) holds: ValueType,
    pub(super) meaning: Meaning,
    /// More to know, a sentence in Markdown; often empty.
    pub(super) note: &'static str,
    pub(super) default: Default,
    /// The new name, if this is an old name of a key, which is still read.
    pub(super) renamed_to: Option<&'static str>,
}

/// Meaning of a value, with its unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meaning {
    pub(super) text: &'static str,
    /// Empty for values that are not numbers.
    pub(super) unit: &'static str,
}

/// Default of an omitted key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Default {
    /// It must not be left out.
    Required,
    /// As the words say.
    Words(&'static str),
}

/// Type of the value of a key.
#[derive(Debug, Clone, Copy)]
pub(super) enum ValueType {
    Number,
    /// A whole number, 0 or above.
    Count,
    Flag,
    Text,
    /// One of some words.
    Word(fn() -> Vec<&'static str>),
    /// A list of so many of them.
    Array(&'static Self, usize),
    List(&'static Self),
    /// One alone, or a list.
    OneOrMore(&'static Self),
    Either(&'static [Self]),
    /// One number per dimension of space.
    Vector,
    /// Numbers along the axes of the table.
    Along,
    /// A number or a formula of time.
    Changing,
    /// One of them per dimension of space.
    ChangingVector,
    Nodes,
    Corners,
    Axes,
    Table(&'static TableKeys),
    /// One alone, or a list.
    Tables(&'static TableKeys),
}

impl TableKeys {
    /// A table with these keys.
    pub(super) const fn new(
        name: &'static str,
        about: &'static str,
        keys: &'static [Key],
        example: &'static str,
    ) -> Self {
        Self { name, about, keys, kinds: &[], one_of: &[], example }
    }

    /// With a key `kind`.
    pub(super) const fn kinds(self, kinds: &'static [Kind]) -> Self {
        Self { kinds, ..self }
    }

    /// With groups of keys of which exactly one has to be there.
    pub(super) const fn one_of(self, groups: &'static [&'static [&'static str]]) -> Self {
        Self { one_of: groups, ..self }
    }

    /// The unit of what stands at a place, as `material.young`, with or without numbers of elements of lists; empty where there is
    /// none, and where it depends on other keys.
    #[cfg(any(feature = "fit", feature = "sweep"))]
    pub(super) fn unit(&self, place: &[String]) -> &'static str {
        let mut units = Vec::new();
        self.add_units(place, &mut units);
        match *units {
            [first, ref others @ ..] if others.iter().all(|unit| *unit == first) => first,
            _ => "",
        }
    }

    #[cfg(any(feature = "fit", feature = "sweep"))]
    fn add_units(&self, place: &[String], units: &mut Vec<&'static str>) {
        let is_number = |word: &&String| word.parse::<usize>().is_ok();
        let Some((name, rest)) = place.split_first() else { return };
        let rest = &rest[rest.iter().take_while(is_number).count()..];
        for key in self.all().filter(|key| key.name == name) {
            match rest {
                [] => units.push(key.meaning.unit),
                _ => key.holds.each_table(&mut |table| table.add_units(rest, units)),
            }
        }
    }

    /// The keys of all kinds and its own.
    pub(super) fn all(&self) -> impl Iterator<Item = &'static Key> {
        self.kinds.iter().flat_map(|kind| kind.keys).chain(self.keys)
    }
}

#[cfg(any(feature = "fit", feature = "sweep"))]
impl ValueType {
    /// The tables that may stand there.
    fn each_table(&self, see: &mut dyn FnMut(&'static TableKeys)) {
        match self {
            Self::Table(table) | Self::Tables(table) => see(table),
            Self::Array(inner, _) | Self::List(inner) | Self::OneOrMore(inner) => {
                inner.each_table(see);
            }
            Self::Either(all) => all.iter().for_each(|one| one.each_table(see)),
            _ => {}
        }
    }
}

impl Key {
    /// A key that may be left out.
    pub(super) const fn new(name: &'static str, holds: ValueType, meaning: &'static str) -> Self {
        let meaning = Meaning { text: meaning, unit: "" };
        Self { name, holds, meaning, note: "", default: Default::Words("none"), renamed_to: None }
    }

    /// A key of a number that may be left out. Unit "1": it has none.
    pub(super) const fn number(
        name: &'static str,
        meaning: &'static str,
        unit: &'static str,
    ) -> Self {
        Self::new(name, ValueType::Number, meaning).in_unit(unit)
    }

    /// A key of a vector that has to be there.
    pub(super) const fn vector(
        name: &'static str,
        meaning: &'static str,
        unit: &'static str,
    ) -> Self {
        Self::new(name, ValueType::Vector, meaning).in_unit(unit).required()
    }

    pub(super) const fn in_unit(mut self, unit: &'static str) -> Self {
        self.meaning.unit = unit;
        self
    }

    pub(super) const fn note(mut self, note: &'static str) -> Self {
        self.note = note;
        self
    }

    pub(super) const fn required(mut self) -> Self {
        self.default = Default::Required;
        self
    }

    pub(super) const fn default(mut self, words: &'static str) -> Self {
        self.default = Default::Words(words);
        self
    }

    /// An old name of the key with this `name`.
    pub(super) const fn renamed_to(mut self, name: &'static str) -> Self {
        self.renamed_to = Some(name);
        self
    }
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.unit {
            "" => f.write_str(self.text),
            "1" => write!(f, "{} (no unit)", self.text),
            unit => write!(f, "{} ({unit})", self.text),
        }
    }
}

/// Times of a table.
pub(super) const TIMES: Key =
    Key::new("times", ValueType::List(&ValueType::Number), "times in ascending order").in_unit("s");
/// Its period.
pub(super) const PERIOD: Key = Key::new(
    "period",
    ValueType::Number,
    "the time after which the table is repeated, up to the end of the phase",
)
.in_unit("s")
.note("From its last time a line leads to the first value, a period after the first time.")
.default("once");
