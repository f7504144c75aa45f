//! Coefficients of Coulomb's friction.

use super::keys::{Key, TableKeys, ValueType};
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;

pub(super) const FRICTION_COEFFICIENT: Key = Key::new(
    "friction_coefficient",
    ValueType::Either(&[ValueType::Number, ValueType::Table(&COEFFICIENTS)]),
    "Coulomb's coefficient of friction, or both of them",
)
.in_unit("1")
.default("0");

const COEFFICIENTS: TableKeys = TableKeys::new(
    "friction_coefficient",
    "Two coefficients of friction.",
    &[
        Key::number("static", "the friction coefficient at rest", "1").required(),
        Key::number("kinetic", "the friction coefficient of what slides", "1").required(),
    ],
    "friction_coefficient = { static = 0.6, kinetic = 0.5 }",
);

/// The static and the kinetic coefficient of friction of `table`, if it has any.
pub(super) fn coefficients(table: &Table) -> Result<Option<[f64; 2]>, Error> {
    table.optional("friction_coefficient", |value| {
        if value.entries().is_none() {
            let mu = value.number();
            let mu = mu.map_err(|_| value.unexpected("a number or { static, kinetic }"))?;
            return Ok([mu, mu]);
        }
        let table = value.table(&COEFFICIENTS)?;
        let coefficient = |key| table.required(key, Value::number);
        Ok([coefficient("static")?, coefficient("kinetic")?])
    })
}
