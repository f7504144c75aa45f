//! Numbers and choices out of bytes; when they are used up, zeros.

/// Numbers that a careless or hostile caller may hand in.
const NASTY: [f64; 16] = [
    0.0,
    -0.0,
    -1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    1e-300,
    1e300,
    -1e-8,
    1e16,
    f64::EPSILON,
    -1e9,
];

pub struct Bytes<'a> {
    rest: &'a [u8],
    /// Something was asked for that may give any answer: loose tolerances, steps without control.
    pub is_loose: bool,
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, is_loose: false }
    }

    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.rest.split_first() else { return 0 };
        self.rest = rest;
        *first
    }

    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// True once in `times`; not when the bytes are used up.
    pub fn is(&mut self, times: usize) -> bool {
        self.below(times) == times - 1
    }

    pub fn one_of<'b, T>(&mut self, choices: &'b [T]) -> &'b T {
        &choices[self.below(choices.len())]
    }

    /// A number of ordinary size, now and then another one.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            byte @ 0..=7 => NASTY[2 * usize::from(byte)],
            byte => (f64::from(byte) - 128.0) / 32.0,
        }
    }

    /// A positive power of ten from 1e-12 to 1e3, now and then any number.
    pub fn scale(&mut self) -> f64 {
        match self.byte() {
            byte @ 0..=3 => NASTY[4 * usize::from(byte)],
            byte => 10_f64.powi(i32::from(byte % 16) - 12),
        }
    }

    /// A time, mostly small.
    pub fn time(&mut self) -> f64 {
        match self.byte() {
            byte @ 0..=3 => NASTY[2 * usize::from(byte) + 1],
            byte @ 8..=23 => 10_f64.powi(i32::from(byte) - 14),
            byte => (f64::from(byte) - 64.0) / 64.0,
        }
    }
}
