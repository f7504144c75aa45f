//! Tasks of a study: rows that are computed together by one process of an array.

use std::env;
use std::ops::Range;
use std::str::FromStr;

/// Which tasks are computed: one, several, or the one that an environment variable names.
#[derive(Clone, Debug, PartialEq)]
pub enum Tasks {
    /// From the first to the last.
    Numbers(usize, usize),
    /// The number is in this environment variable.
    Variable(String),
}

impl FromStr for Tasks {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(name) = text.strip_prefix("env:") {
            return Ok(Self::Variable(name.into()));
        }
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        match (first.trim().parse(), last.trim().parse()) {
            (Ok(first), Ok(last)) if first <= last => Ok(Self::Numbers(first, last)),
            _ => Err("write a number from 0, as 3, a range, as 0-9, or env:HQ_TASK_ID".into()),
        }
    }
}

impl Tasks {
    /// The numbers of the rows, in batches of `batch`, of a study with `all` of them.
    pub fn rows(&self, batch: usize, all: usize) -> Result<Range<usize>, String> {
        let [first, last] = match self {
            Self::Numbers(first, last) => [*first, *last],
            Self::Variable(name) => {
                let text = env::var(name)
                    .map_err(|_| format!("there is no environment variable {name}"))?;
                let number = text.trim().parse();
                [number.map_err(|_| format!("{name} = {text} is no number of a task"))?; 2]
            }
        };
        let start = first.saturating_mul(batch);
        if start >= all {
            let tasks = all.div_ceil(batch);
            return Err(format!(
                "there is no task {first}: the study has {tasks}, from 0, of {batch} rows each"
            ));
        }
        Ok(start..last.saturating_add(1).saturating_mul(batch).min(all))
    }
}

/// Tasks as an array job names them: 0-3,7.
pub fn array(tasks: &[usize]) -> String {
    let mut spans: Vec<[usize; 2]> = Vec::new();
    for &task in tasks {
        match spans.last_mut() {
            Some([_, last]) if *last + 1 == task => *last = task,
            _ => spans.push([task; 2]),
        }
    }
    let text = |[first, last]: &[usize; 2]| match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    };
    spans.iter().map(text).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::{Tasks, array};

    #[test]
    fn tasks_are_ranges_of_rows() {
        let rows = |text: &str| text.parse::<Tasks>().unwrap().rows(4, 10);
        assert_eq!(rows("0"), Ok(0..4));
        assert_eq!(rows("1-2"), Ok(4..10));
        assert!(rows("3").unwrap_err().contains("the study has 3"));
        assert!(rows("env:NO_SUCH_TASK").unwrap_err().contains("NO_SUCH_TASK"));
        for bad in ["", "x", "3-1", "-1"] {
            assert!(bad.parse::<Tasks>().is_err(), "{bad}");
        }
    }

    #[test]
    fn arrays_are_spans() {
        assert_eq!(array(&[0, 1, 2, 3, 7, 9, 10]), "0-3,7,9-10");
        assert_eq!(array(&[]), "");
    }
}
