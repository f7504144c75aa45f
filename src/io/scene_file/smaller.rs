//! Smaller models by which a scene is run: `half`, `plane` and `rod` of `[solver]`.

use super::contents::OutputRequest;
use super::keys::{Key, ValueType};
use super::table::Table;
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::dynamics::error::Error;
use crate::elements::mesh::{NodeMap, Selection};
use crate::elements::rod::SolidAxis;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{Scene, Shrink, Smaller};

pub(super) const HALF: Key = Key::new(
    "half",
    ValueType::Word(|| AXES.map(|(word, _)| word).into()),
    "the axis across which the scene is cut at its middle: half of it is run",
)
.note(
    "The scene has to be symmetric. Sensors read what they would read of the whole; forces and energies are those of the half. Of both halves \
     it is that below the cut, unless sensors are on the other side. `\"\"` is the whole.",
)
.default("the whole");
pub(super) const PLANE: Key = Key::new(
    "plane",
    ValueType::Word(|| AXES.map(|(word, _)| word).into()),
    "the axis of space across which a section of the scene is run in a plane",
)
.note(
    "The scene has to be the same all along it. It is in plane strain where both ends are held along the axis, and else in plane stress. \
     `\"\"` is all of space.",
)
.default("all of space");

pub(super) const ROD: Key = Key::new(
    "rod",
    ValueType::Count,
    "the number of elements of a rod that is run in place of a slender solid",
)
.note(
    "The solid has the same cross section all along a straight axis. Held nodes and sensors are in whole cross sections between elements, as at its \
     ends. `0` is the solid.",
)
.default("the solid");

const AXES: [(&str, Option<Axis>); 4] =
    [("x", Some(Axis::X)), ("y", Some(Axis::Y)), ("z", Some(Axis::Z)), ("", None)];

/// The scene by the smaller models that the table `solver` names, with its output.
pub(super) fn smaller(
    mut scene: Scene,
    mut output: OutputRequest,
    solver: &Table<'_>,
) -> Result<(Scene, OutputRequest, Vec<Smaller>), Error> {
    let mut all = Vec::new();
    for (key, shrink) in [("half", Shrink::Half), ("plane", Shrink::Section)] {
        let Some(value) = solver.get(key) else { continue };
        let Some(axis) = value.word(&AXES)? else { continue };
        let made = scene.smaller((shrink, axis), |smaller| mapped(&scene, &output, &smaller.map));
        let (smaller, written) = made.map_err(|error| value.error(error))?;
        (scene, output) = (smaller.scene, written);
        all.push(smaller.kind);
    }
    if let Some(value) = solver.get("rod")
        && let elements = value.count()?
        && elements > 0
    {
        let made = scene.rod_scene(elements).and_then(|rod| {
            let written = of_rod(&scene, &output, &rod.axis)?;
            Ok((rod, written))
        });
        let (rod, written) = made.map_err(|error| value.error(error))?;
        (scene, output) = (rod.scene, written);
        all.push(rod.kind);
    }
    Ok((scene, output, all))
}

/// Output request for the rod that stands for a solid.
fn of_rod(
    solid: &Scene,
    output: &OutputRequest,
    axis: &SolidAxis,
) -> Result<OutputRequest, InputError> {
    let mut output = output.clone();
    for (name, reading) in &mut output.sensors {
        *reading = reading.of_rod(solid, axis).map_err(|error| of_sensor(name, error))?;
    }
    if let Some(track) = &mut output.track {
        let sections = solid.sections_of(track, axis, false, || "output.track".into())?;
        *track = Selection::of_nodes(sections.into_iter().map(|section| axis.nodes(section)[0]));
    }
    Ok(output)
}

/// An error of the reading of a sensor.
fn of_sensor(name: &str, error: InputError) -> InputError {
    InputError { input: format!("{} of sensor \"{name}\"", error.input), ..error }
}

/// Output request for a smaller model of a scene.
fn mapped(
    scene: &Scene,
    output: &OutputRequest,
    map: &NodeMap,
) -> Result<OutputRequest, InputError> {
    let mut output = output.clone();
    for (name, reading) in &mut output.sensors {
        *reading = reading.by_map(scene, map).map_err(|error| of_sensor(name, error))?;
    }
    if let Some(track) = &mut output.track {
        let nodes = scene.body().mesh().select(track)?;
        let own = distinct(nodes.iter().filter_map(|&node| map.numbers[node]));
        if own.is_empty() {
            let help = "it is all on the side that is left out: name nodes on one side, where the sensors are";
            return Err(InputError::new("output.track", &*track, help));
        }
        *track = Selection::of_nodes(own);
    }
    Ok(output)
}
