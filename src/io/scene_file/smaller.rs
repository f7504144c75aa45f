//! Smaller models by which a scene is run: `half` and `plane` of `[solver]`.

use super::contents::OutputRequest;
use super::keys::{Key, ValueType};
use super::table::Table;
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Reading;
use crate::elements::mesh::Selection;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{Scene, Smaller};

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

const AXES: [(&str, Option<Axis>); 4] =
    [("x", Some(Axis::X)), ("y", Some(Axis::Y)), ("z", Some(Axis::Z)), ("", None)];

/// A smaller model, what is written of it, and how it is smaller.
type Shrunk = (Scene, OutputRequest, Smaller);

type Shrink = fn(&Scene, &OutputRequest, Axis) -> Result<Shrunk, InputError>;

/// The scene by the smaller models that the table `solver` names, with what is written of it.
pub(super) fn smaller(
    mut scene: Scene,
    mut output: OutputRequest,
    solver: &Table<'_>,
) -> Result<(Scene, OutputRequest, Vec<Smaller>), Error> {
    let mut all = Vec::new();
    let steps: [(&str, Shrink); 2] = [("half", half), ("plane", plane)];
    for (key, shrink) in steps {
        let Some(value) = solver.get(key) else { continue };
        if let Some(axis) = value.word(&AXES)? {
            let shrunk = shrink(&scene, &output, axis).map_err(|error| value.error(error))?;
            let (own, written, how) = shrunk;
            (scene, output) = (own, written);
            all.push(how);
        }
    }
    Ok((scene, output, all))
}

/// The half that has what is read, that below the cut if both have it.
fn half(scene: &Scene, output: &OutputRequest, axis: Axis) -> Result<Shrunk, InputError> {
    let of_side = |is_upper| {
        let half = scene.half(axis, is_upper)?;
        let kept = |nodes: &[usize]| {
            Selection::of_nodes(nodes.iter().filter_map(|node| half.nodes.binary_search(node).ok()))
        };
        let written = mapped(scene, output, &kept, &|reading| reading.in_half(scene, &half))?;
        let kind = Smaller::Half { axis, at: half.at };
        Ok((half.scene, written, kind))
    };
    of_side(false).or_else(|below| of_side(true).map_err(|above| both(below, above)))
}

/// Why neither half is run.
fn both(below: InputError, above: InputError) -> InputError {
    if below.to_string() == above.to_string() {
        return below;
    }
    let help = format!("{}; of the half above the cut: {above}", below.help);
    InputError::new(below.input, below.value, help)
}

fn plane(scene: &Scene, output: &OutputRequest, axis: Axis) -> Result<Shrunk, InputError> {
    let section = scene.section(axis)?;
    let places = |nodes: &[usize]| {
        Selection::of_nodes(distinct(nodes.iter().map(|&node| section.prism.columns[node])))
    };
    let written = mapped(scene, output, &places, &|reading| reading.in_plane(scene, &section))?;
    let kind = section.kind();
    Ok((section.scene, written, kind))
}

/// Output request for a simplified model of a scene, by its maps of nodes (from 0) and readings.
fn mapped(
    scene: &Scene,
    output: &OutputRequest,
    nodes: &dyn Fn(&[usize]) -> Selection,
    read: &dyn Fn(&Reading) -> Result<Reading, InputError>,
) -> Result<OutputRequest, InputError> {
    let mut output = output.clone();
    for (name, reading) in &mut output.sensors {
        let own = read(reading).map_err(|error| {
            InputError::new(
                format!("{} of sensor \"{name}\"", error.input),
                error.value,
                error.help,
            )
        })?;
        *reading = own;
    }
    if let Some(track) = &mut output.track {
        let own = nodes(&scene.body().mesh().select(track)?);
        if own == Selection::of_nodes([]) {
            let help = "it is all on the side that is left out: name nodes on one side, where the sensors are";
            return Err(InputError::new("output.track", &*track, help));
        }
        *track = own;
    }
    Ok(output)
}
