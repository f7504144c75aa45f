//! Conditions on rows, as `com.y:max > 0.5 and verdict = fine`.

use std::fmt;
use std::str::FromStr;

use super::row::Row;
use super::run::Sweep;
use crate::base::input::{InputError, unknown};

/// A condition on rows: comparisons of quantities and keys with numbers, and of `verdict` and `warning` with words, all
/// of which have to hold.
///
/// ```
/// let condition: pliant::sweep::Condition = "com.y:max > 0.5 and warning != strain".parse()?;
/// assert!("com.y:max".parse::<pliant::sweep::Condition>().is_err());
/// # Ok::<(), pliant::InputError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Condition(Vec<Comparison>);

#[derive(Debug, Clone, PartialEq)]
struct Comparison {
    name: String,
    sign: Sign,
    word: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sign {
    Less,
    AtMost,
    More,
    AtLeast,
    Is,
    IsNot,
}

/// Longer signs before those that they begin with.
const SIGNS: [(&str, Sign); 7] = [
    ("<=", Sign::AtMost),
    (">=", Sign::AtLeast),
    ("!=", Sign::IsNot),
    ("==", Sign::Is),
    ("<", Sign::Less),
    (">", Sign::More),
    ("=", Sign::Is),
];
/// Names of a condition whose values are words instead of numbers.
const WORDS: [&str; 2] = ["verdict", "warning"];
const VERDICTS: [&str; 3] = ["fine", "doubtful", "failed"];

impl FromStr for Condition {
    type Err = InputError;

    fn from_str(text: &str) -> Result<Self, InputError> {
        if text.trim() == "all" {
            return Ok(Self(Vec::new()));
        }
        text.split(" and ").map(comparison).collect::<Result<_, _>>().map(Self)
    }
}

fn comparison(text: &str) -> Result<Comparison, InputError> {
    let bad = |help: String| InputError::new("condition", format!("\"{}\"", text.trim()), help);
    let help =
        || bad("write NAME SIGN VALUE, as com.y:max > 0.5 or verdict = doubtful, or all".into());
    let at = text.find(['<', '>', '=', '!']).ok_or_else(help)?;
    let (name, rest) = text.split_at(at);
    let (written, sign) = SIGNS.iter().find(|(sign, _)| rest.starts_with(sign)).ok_or_else(help)?;
    let (name, word) = (name.trim(), rest[written.len()..].trim());
    if name.is_empty() || word.is_empty() {
        return Err(help());
    }
    let is_word = WORDS.contains(&name);
    if is_word && ![Sign::Is, Sign::IsNot].contains(sign) {
        return Err(bad(format!("{name} is = or != a word")));
    }
    if name == "verdict" && !VERDICTS.contains(&word) {
        return Err(bad(unknown(word, &VERDICTS)));
    }
    if !is_word && ![Sign::Is, Sign::IsNot].contains(sign) && word.parse::<f64>().is_err() {
        return Err(bad(format!("{word} is no number")));
    }
    Ok(Comparison { name: name.into(), sign: *sign, word: word.into() })
}

impl fmt::Display for Condition {
    /// As it is read.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = |one: &Comparison| {
            SIGNS.iter().find(|(_, sign)| *sign == one.sign).map_or("", |it| it.0)
        };
        let told = |one: &Comparison| format!("{} {} {}", one.name, sign(one), one.word);
        match &self.0[..] {
            [] => f.write_str("all"),
            all => f.write_str(&all.iter().map(told).collect::<Vec<_>>().join(" and ")),
        }
    }
}

impl Condition {
    /// # Errors
    /// A name that the rows of a study do not have.
    pub fn check(&self, sweep: &Sweep) -> Result<(), InputError> {
        let known: Vec<&str> = sweep.quantities().collect();
        let keys = sweep.plan().keys().iter().map(String::as_str);
        let known: Vec<&str> = known.into_iter().chain(keys).chain(WORDS).collect();
        match self.0.iter().find(|one| !known.contains(&&one.name[..])) {
            Some(Comparison { name, .. }) => Err(InputError::new(
                "name in a condition",
                format!("\"{name}\""),
                unknown(name, &known),
            )),
            None => Ok(()),
        }
    }

    /// Whether it holds for a row. No number is less or more than one that is not there.
    pub fn holds(&self, row: &Row) -> bool {
        self.0.iter().all(|one| one.holds(row))
    }
}

impl Comparison {
    fn holds(&self, row: &Row) -> bool {
        let Self { name, sign, word } = self;
        let is = match &name[..] {
            "verdict" => row.verdict.name() == word,
            "warning" => row.warnings.contains(word),
            name => match (row.number(name), word.parse::<f64>()) {
                (Some(found), Ok(number)) => {
                    return match sign {
                        Sign::Less => found < number,
                        Sign::AtMost => found <= number,
                        Sign::More => found > number,
                        Sign::AtLeast => found >= number,
                        Sign::Is => found == number,
                        Sign::IsNot => found != number,
                    };
                }
                _ => row.keys.get(name).is_some_and(|value| value.trim_matches('"') == word),
            },
        };
        match sign {
            Sign::Is => is,
            Sign::IsNot => !is,
            _ => false,
        }
    }
}
