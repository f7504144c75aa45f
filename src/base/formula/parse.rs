//! Parser of formulas: the grammar, and syntax errors.

use super::{Choice, DEEPEST, FUNCTIONS, Formula, Operator, Step};
use crate::base::input::unknown;

impl Formula {
    /// # Errors
    /// The syntax error in the text, and its position.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut parser = Parser { text, at: 0, depth: 0, steps: Vec::new() };
        parser.sum()?;
        if parser.peek().is_some() {
            return Err(parser.problem("expected an operator (+ - * / ^) or the end"));
        }
        let formula = Self { text: text.to_owned(), steps: parser.steps };
        let mut waiting = 0_usize;
        for step in &formula.steps {
            match step {
                Step::Number(_) | Step::Time => waiting += 1,
                Step::Operator(_) => waiting -= 1,
                Step::Function(function) if matches!(function.rule, Choice(_)) => waiting -= 1,
                Step::Negative | Step::Function(_) => {}
            }
            if waiting > DEEPEST {
                return Err(format!("more than {DEEPEST} numbers wait for each other: divide it"));
            }
        }
        Ok(formula)
    }
}

/// Reads by recursive descent.
struct Parser<'a> {
    text: &'a str,
    /// Number of bytes read so far.
    at: usize,
    /// Number of open parentheses, and of signs and powers whose operand is not complete.
    depth: usize,
    steps: Vec<Step>,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// The next character that is not a space.
    fn peek(&mut self) -> Option<char> {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
        self.rest().chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn problem(&mut self, help: &str) -> String {
        let column = self.text[..self.at].chars().count() + 1;
        match self.peek() {
            Some(found) => format!("{help}, found '{found}' at character {column}"),
            None => format!("{help}, found the end"),
        }
    }

    /// Goes one level down.
    fn nested(&mut self, read: impl FnOnce(&mut Self) -> Result<(), String>) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("it is nested more than {DEEPEST} deep: divide it"));
        }
        read(self)?;
        self.depth -= 1;
        Ok(())
    }

    /// term + term - ...
    fn sum(&mut self) -> Result<(), String> {
        self.row(&[('+', Operator::Add), ('-', Operator::Subtract)], Self::product)
    }

    /// factor * factor / ...
    fn product(&mut self) -> Result<(), String> {
        self.row(&[('*', Operator::Multiply), ('/', Operator::Divide)], Self::signed)
    }

    fn row(
        &mut self,
        operators: &[(char, Operator)],
        part: fn(&mut Self) -> Result<(), String>,
    ) -> Result<(), String> {
        part(self)?;
        while let Some((_, operator)) = operators.iter().find(|(sign, _)| self.take(*sign)) {
            part(self)?;
            self.steps.push(Step::Operator(*operator));
        }
        Ok(())
    }

    /// -power, +power or a power: a power binds tighter than a sign before it.
    fn signed(&mut self) -> Result<(), String> {
        if self.take('-') {
            self.nested(Self::signed)?;
            self.steps.push(Step::Negative);
            return Ok(());
        }
        if self.take('+') {
            return self.nested(Self::signed);
        }
        self.value()?;
        if self.take('^') {
            // right-associative
            self.nested(Self::signed)?;
            self.steps.push(Step::Operator(Operator::Power));
        }
        Ok(())
    }

    /// A number, a name, a function or an expression in parentheses.
    fn value(&mut self) -> Result<(), String> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                self.nested(Self::sum)?;
                self.close()
            }
            Some(digit) if digit.is_ascii_digit() || digit == '.' => self.number(),
            Some(letter) if letter.is_alphabetic() => self.word(),
            _ => Err(self.problem("expected a number, t, pi, e, a function or (")),
        }
    }

    fn close(&mut self) -> Result<(), String> {
        match self.take(')') {
            true => Ok(()),
            false => Err(self.problem("expected )")),
        }
    }

    fn number(&mut self) -> Result<(), String> {
        let bytes = self.rest().as_bytes();
        let digits =
            |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let mut end = digits(0);
        if bytes.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits((end + 1 + sign).min(bytes.len()));
            if exponent > 0 {
                end += 1 + sign + exponent;
            }
        }
        let number = self.rest()[..end].parse::<f64>().ok().filter(|number| number.is_finite());
        let number = number.ok_or_else(|| self.problem("expected a finite number"))?;
        self.at += end;
        self.steps.push(Step::Number(number));
        Ok(())
    }

    fn word(&mut self) -> Result<(), String> {
        let rest = self.rest();
        let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let word = &rest[..length];
        let constant = match word {
            "t" => Some(Step::Time),
            "pi" => Some(Step::Number(std::f64::consts::PI)),
            "e" => Some(Step::Number(std::f64::consts::E)),
            _ => None,
        };
        if let Some(step) = constant {
            self.at += length;
            self.steps.push(step);
            return Ok(());
        }
        let Some(function) = FUNCTIONS.iter().find(|function| function.name == word) else {
            let known: Vec<&str> =
                ["t", "pi", "e"].into_iter().chain(FUNCTIONS.iter().map(|f| f.name)).collect();
            return Err(format!("unknown word \"{word}\"; {}", unknown(word, &known)));
        };
        self.at += length;
        if !self.take('(') {
            return Err(self.problem(&format!("expected ( after {word}")));
        }
        self.nested(|parser| {
            parser.sum()?;
            if matches!(function.rule, Choice(_)) {
                if !parser.take(',') {
                    return Err(
                        parser.problem(&format!("expected a comma: {word} takes two numbers"))
                    );
                }
                parser.sum()?;
            }
            Ok(())
        })?;
        self.close()?;
        self.steps.push(Step::Function(function));
        Ok(())
    }
}
