//! `[[gas]]`, `[[supply]]` and `[[orifice]]`.

use super::keys::{Key, TableKeys, ValueType};
use super::surroundings::unique;
use super::value::Value;
use crate::base::input::{InputError, not_negative};
use crate::dynamics::error::Error;
use crate::scene::forces::{Gas, Orifice};
use crate::scene::timeline::{Phase, Scene};

pub(super) const GAS: TableKeys = TableKeys::new(
    "[[gas]]",
    "An amount of gas in a chamber, in place of a `pressure` of phases. Its absolute pressure is p_0 (V_0 m/(V m_0))^n, with the \
     volume V and the amount m; the walls are pressed by what it exceeds the `atmosphere` of the file by. The amount changes \
     by orifices alone.",
    &[
        Key::new("chamber", ValueType::Text, "the name of the chamber").required(),
        Key::number("pressure", "the absolute pressure p_0 in the undeformed shape", "Pa")
            .note("There it fills the volume V_0 with m_0 = p_0 V_0 1.185e-5 kg of air at 20 C.")
            .default("101325"),
        Key::number("exponent", "the exponent n", "1")
            .note("1 is isothermal, 1.4 adiabatic, and values in between are polytropic.")
            .default("1"),
    ],
    "[[gas]]\nchamber = \"inside\"\npressure = 1.2e5\nexponent = 1.4",
);

pub(super) const SUPPLY: TableKeys = TableKeys::new(
    "[[supply]]",
    "What orifices draw gas from, or a vacuum into which they let it.",
    &[
        Key::new("name", ValueType::Text, "the name of the supply").required(),
        Key::new("pressure", ValueType::Changing, "its absolute pressure")
            .in_unit("Pa")
            .note("A number, or a formula of `t`.")
            .required(),
    ],
    "[[supply]]\nname = \"pump\"\npressure = 2.0e5",
);

pub(super) const ORIFICE: TableKeys = TableKeys::new(
    "[[orifice]]",
    "An orifice, a valve or a leak, through which gas flows either way (ISO 6358-1): from the absolute pressure p_1 to the lower \
     p_2 q = C rho_0 p_1 sqrt(T_0/T_1) sqrt(1 - ((p_2/p_1 - b)/(1 - b))^2), without the last root if p_2/p_1 < b, and with a cubic in \
     place of it if p_2/p_1 > 0.999; rho_0 = 1.185 kg/m^3. With an `area` it is a nozzle without losses up to its narrowest section, \
     q = C_d A p_1/sqrt(R T_1) sqrt(7 (r^(2/1.4) - r^(2.4/1.4))), r = p_2/p_1 but not below 0.528. `open` in a phase says how far it is open; without it, wholly.",
    &[
        Key::new("name", ValueType::Text, "the name of the orifice").required(),
        Key::new("from", ValueType::Text, "one end: a supply, a chamber with gas, or `atmosphere`").required(),
        Key::new("to", ValueType::Text, "the other end, likewise").required(),
        Key::number("conductance", "the sonic conductance C", "m^3/(s Pa)")
            .note("1e-8 are 0.6 l/min for each bar; a short nozzle has some 2e-3 times its area in m^2."),
        Key::number("critical_ratio", "the critical ratio b of pressures, from 0 to below 1", "1").default("0.5"),
        Key::number("area", "the area A of a nozzle", "m^2"),
        Key::number("discharge", "its coefficient of discharge C_d, above 0 and up to 1", "1")
            .note("Some 0.95 of one that is round, 0.6 to 0.85 of a hole with sharp edges.")
            .default("1"),
    ],
    "[[orifice]]\nname = \"valve\"\nfrom = \"pump\"\nto = \"inside\"\nconductance = 1.0e-9",
)
.one_of(&[&["conductance"], &["area"]]);

/// The scene with the gas that `value` describes.
pub(super) fn add_gas(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&GAS)?;
    let mut gas = Gas::in_chamber(table.required("chamber", Value::string)?);
    gas = table.added(gas, "pressure", Value::number, Gas::pressure)?;
    gas = table.added(gas, "exponent", Value::number, Gas::exponent)?;
    let scene = scene.gas(gas);
    scene.filled().map_err(|error| table.blame(error))?;
    Ok(scene)
}

/// The scene with the supply that `value` describes.
pub(super) fn add_supply(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&SUPPLY)?;
    let name = table.required("name", Value::string)?;
    let pressure = table.required("pressure", |value| {
        let pressure = value.signal()?;
        let given = pressure.value().unwrap_or(0.0);
        not_negative("pressure", given, "Pa, absolute").map_err(|error| value.error(error))?;
        Ok(pressure)
    })?;
    unique(table, name, scene.places())?;
    Ok(scene.supply(name, pressure))
}

/// The scene with the orifice that `value` describes.
pub(super) fn add_orifice(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&ORIFICE)?;
    let text = |key: &str| table.required(key, Value::string);
    let (name, from, to) = (text("name")?, text("from")?, text("to")?);
    let (key, other) = match table.get("area") {
        Some(_) => ("critical_ratio", "a nozzle has a critical ratio of its own: leave it out"),
        None => (
            "discharge",
            "it is that of a nozzle: leave it out, or give an area in place of the conductance",
        ),
    };
    if let Some(value) = table.get(key) {
        return Err(value.error(other));
    }
    let mut orifice = match table.optional("area", Value::number)? {
        Some(area) => Orifice::nozzle(name, from, to, area),
        None => Orifice::new(name, from, to, table.required("conductance", Value::number)?),
    };
    orifice = table.added(orifice, "critical_ratio", Value::number, Orifice::critical_ratio)?;
    orifice = table.added(orifice, "discharge", Value::number, Orifice::discharge)?;
    unique(table, orifice.name(), scene.orifices().iter().map(Orifice::name))?;
    let scene = scene.orifice(orifice);
    let last = scene.orifices().len() - 1;
    scene.orifice_flow(last, &Phase::until(1.0)).map_err(|error| table.blame(error))?;
    Ok(scene)
}

/// The scene with the air around its chambers that `value` describes.
pub(super) fn add_atmosphere(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let pressure = value.number()?;
    let checked: Result<f64, InputError> = not_negative("atmosphere", pressure, "Pa, absolute");
    Ok(scene.atmosphere(checked.map_err(|error| value.error(error))?))
}
