//! Kinks and jumps of a formula, and the terms of its sum.

use std::ops::Range;

use super::{Choice, Formula, Function, Kinked, Operator, Step};

/// Parts of a span that are looked at for the kinks of one function at most: enough for ten thousand of them.
const MOST_PARTS: usize = 1 << 20;

/// Times that are no farther apart than this, in parts of themselves, are one.
const APART: f64 = 4.0 * f64::EPSILON;

impl Formula {
    /// Whether it depends on time.
    pub(crate) fn varies(&self) -> bool {
        self.steps.iter().any(|step| matches!(step, Step::Time))
    }

    /// The same, times a `factor`.
    pub(crate) fn times(&self, factor: f64) -> Self {
        let mut steps = self.steps.clone();
        steps.extend([Step::Number(factor), Step::Operator(Operator::Multiply)]);
        Self { text: format!("({})*({factor:?})", self.text), steps }
    }

    /// Times (s) within a span at which a kink or a jump is passed: where the argument of `step` or `abs`, or the difference of those of
    /// `min` or `max`, changes its sign. From each of them on the value is that behind it.
    pub(crate) fn kinks(&self, span: [f64; 2]) -> Vec<f64> {
        let mut kinks = Vec::new();
        for (end, step) in self.steps.iter().enumerate() {
            let steps = match step {
                Step::Function(Function { rule: Kinked(_), .. }) => {
                    self.steps[self.operand(end)].to_vec()
                }
                Step::Function(Function { rule: Choice(_), .. }) => {
                    let second = self.operand(end);
                    let first = self.operand(second.start);
                    let mut steps = self.steps[first.start..second.end].to_vec();
                    steps.push(Step::Operator(Operator::Subtract));
                    steps
                }
                _ => continue,
            };
            let argument = Self { text: String::new(), steps };
            if argument.varies() {
                argument.sign_changes(span, &mut kinks);
            }
        }
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        kinks
    }

    /// The terms of which it is a sum; factors that do not depend on time are multiplied into them. Terms without time are omitted.
    pub(crate) fn terms(&self) -> Vec<Self> {
        let mut terms = Vec::new();
        let mut left: Vec<Range<usize>> = std::iter::once(0..self.steps.len()).collect();
        while let Some(range) = left.pop() {
            let Some(last) = range.end.checked_sub(1) else { continue };
            let is_constant =
                |range: &Range<usize>| !self.steps[range.clone()].iter().any(Step::is_time);
            match self.steps[last] {
                Step::Negative => left.push(self.operand(last)),
                Step::Operator(operator) => {
                    let second = self.operand(last);
                    let first = self.operand(second.start);
                    match operator {
                        Operator::Add | Operator::Subtract => left.extend([second, first]),
                        Operator::Multiply if is_constant(&first) => left.push(second),
                        Operator::Multiply | Operator::Divide if is_constant(&second) => {
                            left.push(first);
                        }
                        _ => terms.push(range),
                    }
                }
                _ => terms.push(range),
            }
        }
        let terms = terms.into_iter().map(|range| self.steps[range].to_vec());
        terms.map(|steps| Self { text: String::new(), steps }).filter(Self::varies).collect()
    }

    /// The steps that give the operand before the step `end`.
    fn operand(&self, end: usize) -> Range<usize> {
        let (mut start, mut needed) = (end, 1_usize);
        while needed > 0 && start > 0 {
            start -= 1;
            match &self.steps[start] {
                Step::Number(_) | Step::Time => needed -= 1,
                Step::Operator(_) => needed += 1,
                Step::Function(function) if matches!(function.rule, Choice(_)) => needed += 1,
                Step::Negative | Step::Function(_) => {}
            }
        }
        start..end
    }

    /// Adds the first times (s) at which its value has another sign than before; 0 is positive.
    ///
    /// Spans in which its bounds have one sign are left, others halved.
    fn sign_changes(&self, span: [f64; 2], changes: &mut Vec<f64>) {
        let is_positive = |t: f64| self.at(t).0[0] >= 0.0;
        let mut left = vec![span];
        for _ in 0..MOST_PARTS {
            let Some([mut start, mut end]) = left.pop() else { return };
            let [low, high] = self.bounds([start, end]);
            if low >= 0.0 || high < 0.0 || low.is_nan() {
                continue;
            }
            let middle = 0.5 * (start + end);
            if end - start > APART * start.abs().max(end.abs()) {
                left.extend([[middle, end], [start, middle]]);
                continue;
            }
            let before = is_positive(start);
            if is_positive(end) == before {
                continue;
            }
            while start.next_up() < end {
                let middle = (0.5 * (start + end)).max(start.next_up());
                match is_positive(middle) == before {
                    true => start = middle,
                    false => end = middle,
                }
            }
            changes.push(end);
        }
    }
}

impl Step {
    fn is_time(&self) -> bool {
        matches!(self, Self::Time)
    }
}
