//! Writes changed ends of phases, pressures, forces of actuators, loads, magnetic fields and inputs of devices into the text of a scene file; all
//! else remains unchanged.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::course::plural;
use super::set_value::quoted;
use super::written::insertion;
use crate::elements::mesh::Selection;
use crate::scene::forces::{Lag, Signal, SignalKind, VectorSignal};
use crate::scene::timeline::{Input, InputSignal, Phase, Quantity, Row, STEER, Scene, Target};

/// A phase whose signals differ from those in the file.
pub(crate) struct Rewritten {
    /// Its number, from 0.
    pub(crate) number: usize,
    /// Current state of the phase.
    pub(crate) phase: Phase,
    /// The keys that differ: `until`, of its lists `pressure`, `open`, `actuate`, `load`, `drive`, and `magnetic_field`.
    pub(crate) keys: BTreeSet<&'static str>,
}

/// Tables such as `[[phase.pressure]]` cannot be replaced in one place.
const ELSEWHERE: &str = "write the lists of each phase as pressure = [...], open = [...], actuate = [...], load = [...]";

/// The `text` of the file of a `scene` with other signals in the phases `changes`.
///
/// # Errors
/// A text in which there is no place for them.
pub(crate) fn rewritten(
    text: &str,
    scene: &Scene,
    changes: &[Rewritten],
) -> Result<String, String> {
    let document = DeTable::parse(text).map_err(|error| error.message().to_owned())?;
    let phases = document.get_ref().get("phase").ok_or("the file has no phases")?;
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    for Rewritten { number, phase, keys } in changes {
        let table = match phases.get_ref() {
            DeValue::Array(tables) => {
                tables.get(*number).and_then(|table| table.get_ref().as_table())
            }
            DeValue::Table(table) if *number == 0 => Some(table),
            _ => None,
        };
        let missing = || format!("the file has no phase {}", number + 1);
        let table = table.ok_or_else(missing)?;
        for &key in keys {
            if key == "until" {
                let until = table.get(key).ok_or_else(missing)?.span();
                edits.push((until, format!("{:?}", phase.until)));
                continue;
            }
            let list = inputs(phase, key, scene);
            let edit = match table.get(key) {
                Some(value) if text.get(value.span()).is_some_and(is_list) => (value.span(), list),
                Some(_) => return Err(ELSEWHERE.into()),
                None => {
                    let until = table.get("until").ok_or_else(missing)?.span();
                    insertion(text, until.end, &format!("{key} = {list}"))
                }
            };
            edits.push(edit);
        }
    }
    edits.sort_by_key(|(place, _)| place.start);
    let mut result = String::new();
    let mut at = 0;
    for (place, new) in edits {
        let kept = text.get(at..place.start).ok_or(ELSEWHERE)?;
        result.push_str(kept);
        result.push_str(&new);
        at = place.end;
    }
    Ok(result + text.get(at..).unwrap_or_default())
}

/// Whether this is a list of tables, or one table, as it stands behind a key.
fn is_list(text: &str) -> bool {
    let begins = |inner: &str| inner.trim_start().starts_with(['{', ']', '#']);
    let begins = text.starts_with('{') || text.strip_prefix('[').is_some_and(begins);
    begins && text.ends_with([']', '}'])
}

/// The value of a key of `phase`: the list of its inputs, or the table of its magnetic field.
fn inputs(phase: &Phase, key: &str, scene: &Scene) -> String {
    let dimension = scene.body().dimension();
    let own = phase.inputs.iter().filter(|input| input.quantity.row().keys[0] == key);
    let entries = own.map(|Input { quantity, target, signal }| {
        let Row { keys: [_, of], word, .. } = quantity.row();
        let (of, word) = match target {
            Target::Named(names) if *quantity == Quantity::Actuation => actuator(names, scene),
            // the word is that of the input, which stands beside its value
            _ if quantity.row().keys == STEER => (of, "value"),
            _ => (of, word),
        };
        let target = match target {
            Target::Named(names) if *quantity == Quantity::Actuation => {
                let names: Vec<String> = names.iter().map(|name| quoted(name)).collect();
                format!("{of} = [{}], ", names.join(", "))
            }
            Target::Named(names) => {
                let input = match quantity {
                    Quantity::Device(input) if input.keys == STEER => {
                        format!("input = {}, ", quoted(input.word))
                    }
                    _ => String::new(),
                };
                format!("{of} = {}, {input}", quoted(&names.join(", ")))
            }
            Target::Nodes(Selection::Set(name)) => format!("{of} = {}, ", quoted(name)),
            Target::Nodes(Selection::Numbers(numbers)) => format!("{of} = {numbers:?}, "),
            Target::Nodes(Selection::Box { min, max }) => {
                format!("{of} = {{ box = [{min:?}, {max:?}] }}, ")
            }
            Target::Everything => String::new(),
        };
        let value = match signal {
            InputSignal::Number(signal) => course(signal, word),
            InputSignal::Vector(vector) => vectors(vector, word, dimension),
        };
        format!("{target}{value}")
    });
    if key == Quantity::Field.row().keys[0] {
        let gradient = phase.gradient.as_ref().map_or_else(String::new, |gradient| {
            let (rows, centre) = gradient.rows();
            format!(", gradient = {rows:?}, centre = {centre:?}")
        });
        return entries.map(|field| format!("{{ {field}{gradient} }}")).collect();
    }
    let lines: String = entries.map(|entry| format!("    {{ {entry} }},\n")).collect();
    format!("[\n{lines}]")
}

/// The key of actuators with these names, and of the value for them.
fn actuator(names: &[String], scene: &Scene) -> (&'static str, &'static str) {
    let mut own = names.iter().filter_map(|name| scene.actuator_named(name));
    let heats = |lag: &Lag| lag.per_kelvin().is_some();
    match own.next() {
        Some(own) if scene.lag_of(own.name()).is_some_and(heats) => ("heated", "power"),
        Some(own) => (own.kind().list, own.kind().drive.word()),
        None => ("springs", "force"),
    }
}

/// A vector that may change with time, under the key `word`.
fn vectors(value: &VectorSignal, word: &str, dimension: usize) -> String {
    match value {
        VectorSignal::Constant(vector) => format!("{word} = {vector:?}"),
        VectorSignal::Formulas(formulas) => {
            let texts: Vec<String> =
                formulas.iter().map(|formula| quoted(formula.text())).collect();
            format!("{word} = [{}]", texts.join(", "))
        }
        vector => {
            let times = vector.breaks();
            let vectors = times.iter().map(|t| vector.components(*t, dimension));
            format!("times = {times:?}, {word}s = {:?}", vectors.collect::<Vec<_>>())
        }
    }
}

/// A number that may change with time, under the key `word`.
fn course(signal: &Signal, word: &str) -> String {
    if let SignalKind::Formula(formula) = &signal.0 {
        return format!("{word} = {}", quoted(formula.text()));
    }
    let times = signal.breaks();
    if times.is_empty() {
        return format!("{word} = {:?}", signal.at(0.0));
    }
    let values: Vec<f64> = times.iter().map(|t| signal.at(*t)).collect();
    format!("times = {times:?}, {} = {values:?}", plural(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::body::Body;
    use crate::elements::material::Plane;
    use crate::elements::mesh::{Cells, Mesh};
    use crate::scene::forces::{Growth, Magnet, MagneticField, Muscle, Signals};
    use crate::studies::samples::{SQUARE_MATERIAL, square_jump};

    #[test]
    fn nothing_else_changes() {
        let scene = square_jump(4).unwrap();
        let text = "title = \"a\"\n[[phase]] # one\nuntil = 1.0 # s\nhold = []\n\n[[phase]]\nuntil = 2.0\n\
                    pressure = { chamber = \"air\", value = 1 } # Pa\n";
        let change = |number, phase| Rewritten { number, phase, keys: ["pressure"].into() };
        let changes = [
            change(1, Phase::until(2.0).pressure_table("a\"b", [0.5, 1.5], [0.0, 2.0])),
            change(0, Phase::until(1.0).pressure("air", 3.0)),
        ];
        let expected = "title = \"a\"\n[[phase]] # one\nuntil = 1.0 # s\n\
                        pressure = [\n    { chamber = \"air\", value = 3.0 },\n]\n\
                        hold = []\n\n[[phase]]\nuntil = 2.0\npressure = [\n    \
                        { chamber = \"a\\\"b\", times = [0.5, 1.5], values = [0.0, 2.0] },\n] # Pa\n";
        assert_eq!(rewritten(text, &scene, &changes).unwrap(), expected);
        let inline = "phase = [{ until = 1.0, contact = false }]";
        let expected = "phase = [{ until = 1.0, pressure = [\n    { chamber = \"air\", value = 3.0 },\n], \
                        contact = false }]";
        assert_eq!(rewritten(inline, &scene, &changes[1..]).unwrap(), expected);
        let corners = Selection::Box { min: vec![0.0, 1e-9], max: vec![1.0, f64::INFINITY] };
        let loaded = Phase::until(1.0)
            .load("right", [1.0, 0.5])
            .load_total([3, 4], [0.0, -2.0])
            .load_table(corners, [0.0, 0.5], [[0.0, 0.0], [1.0, 0.25]]);
        let change = Rewritten { number: 0, phase: loaded, keys: ["load"].into() };
        let expected = "phase = [{ until = 1.0, load = [\n    { nodes = \"right\", force = [1.0, 0.5] },\n    \
                        { nodes = [3, 4], total = [0.0, -2.0] },\n    \
                        { nodes = { box = [[0.0, 1e-9], [1.0, inf]] }, times = [0.0, 0.5], \
                        forces = [[0.0, 0.0], [1.0, 0.25]] },\n], contact = false }]";
        assert_eq!(rewritten(inline, &scene, &[change]).unwrap(), expected);
        for nested in [
            "[[phase]]\nuntil = 1.0\n[[phase.pressure]]\nchamber = \"air\"\nvalue = 1.0\n",
            "[[phase]]\nuntil = 1.0\n[phase.pressure]\nchamber = \"air\"\nvalue = 1.0\n",
            "[[phase]]\nuntil = 1.0\npressure.chamber = \"air\"\npressure.value = 1.0\n",
        ] {
            let error = rewritten(nested, &scene, &changes[1..]).unwrap_err();
            assert!(error.contains("pressure = [...]"), "{error}");
        }
    }

    /// Muscles, growth, magnetic fields and dipoles are written by their own words, and a gradient stays.
    #[test]
    fn what_acts_within_the_material_is_written() {
        let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).plane(Plane::Stress);
        let scene = Scene::new(body.build().unwrap())
            .muscle(Muscle::along([1.0, 0.0]).named("m"))
            .growth(Growth::everywhere().named("g"))
            .magnet(Magnet::new([0.1, 0.0]));
        let field = MagneticField::table([0.0, 1.0], [[0.0, 0.0], [0.5, 1.0]]);
        let field = field.gradient([[1.0, 0.0], [0.0, -1.0]], [0.0, 0.5]);
        let phase = Phase::until(1.0)
            .actuate(["m"], 2e3)
            .actuate_table(["g"], [0.0, 1.0], [0.0, 0.25])
            .magnetic_field(field);
        let change = Rewritten { number: 0, phase, keys: ["actuate", "magnetic_field"].into() };
        let text = "[[phase]]\nuntil = 1.0\nmagnetic_field = { field = [0.0, 0.0] }\n";
        let expected = "[[phase]]\nuntil = 1.0\nactuate = [\n    { muscles = [\"m\"], stress = 2000.0 },\n    \
                        { growths = [\"g\"], times = [0.0, 1.0], strains = [0.0, 0.25] },\n]\n\
                        magnetic_field = { times = [0.0, 1.0], fields = [[0.0, 0.0], [0.5, 1.0]], \
                        gradient = [[1.0, 0.0], [0.0, -1.0]], centre = [0.0, 0.5] }\n";
        assert_eq!(rewritten(text, &scene, &[change]).unwrap(), expected);
        let path = Signals::table([0.0, 1.0], [[0.0, 0.5], [0.25, 0.5]]);
        let phase = Phase::until(1.0).dipole_position("a", path).dipole_moment("a", [0.0, 2.0]);
        let change = Rewritten { number: 0, phase, keys: ["drive"].into() };
        let expected = "[[phase]]\nuntil = 1.0\ndrive = [\n    { dipole = \"a\", times = [0.0, 1.0], positions = [[0.0, 0.5], [0.25, 0.5]] },\n    \
                        { dipole = \"a\", moment = [0.0, 2.0] },\n]\n";
        assert_eq!(rewritten("[[phase]]\nuntil = 1.0\n", &scene, &[change]).unwrap(), expected);
    }
}
