//! Springs, cables, muscles, growths and chambers of a scene in its half: each is its own mirror image or that of another one.
//!
//! Of two images one is left. A line in the plane of symmetry has half of its forces. Cells keep those on this side, and a
//! chamber is closed by the plane, in which the force of that wall is held.

use std::cmp::Ordering;
use std::iter;

use super::super::{Input, Phase, Quantity, Scene, Target};
use super::same::{SAME, Same, times};
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::elements::body::CellSelection;
use crate::elements::material::FibreDirection;
use crate::elements::mesh::Selection;
use crate::scene::forces::{Spring, SpringPoint};

/// A component in the half of a scene.
pub(super) struct Component {
    name: String,
    quantity: Quantity,
    /// Its mirror image: itself or another one.
    image: String,
    /// Share of it that the half has: half of a line in the plane; none of what is on the other side.
    share: Option<f64>,
}

/// A component of the whole scene, and where it is.
struct Placed<'a> {
    name: &'a str,
    quantity: Quantity,
    /// Its properties but for its name and where it is.
    likeness: String,
    /// Numbers that say where it is, and those of its mirror image.
    at: [Vec<f64>; 2],
    /// Places of its pieces on the axis (m).
    along: Vec<f64>,
    is_line: bool,
}

impl Same<'_> {
    /// The components of the scene in its half.
    ///
    /// # Errors
    /// Those without a mirror image, or that phases drive otherwise; lines that cross the plane.
    pub(super) fn components(&self) -> Result<Vec<Component>, InputError> {
        let (scene, placed) = (self.scene, self.placed()?);
        let (at, tolerance) = (self.map.ends[0], SAME * self.scene.body.size());
        let (d, kept) = (self.map.mesh.dimension(), self.map.mesh.positions());
        let is_upper = kept.iter().skip(self.map.axis).step_by(d).any(|x| *x > at + tolerance);
        let component = |own: &Placed| {
            let lag = |of: &Placed| format!("{:?}", scene.lag_of(of.name));
            let is_image = |other: &&Placed| {
                let numbers = own.at[1].iter().zip(&other.at[0]);
                own.likeness == other.likeness
                    && lag(own) == lag(other)
                    && own.at[1].len() == other.at[0].len()
                    && numbers.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)
            };
            let name = format!("\"{}\"", own.name);
            // of several in one place each is its own
            let image = iter::once(own).chain(&placed).find(is_image);
            let image = image.ok_or_else(|| self.refused("component", &name))?.name;
            let beside = own.along.iter().filter(|x| (*x - at).abs() > tolerance);
            let sides: Vec<bool> = beside.map(|x| (*x > at) == is_upper).collect();
            let share = match (image == own.name, own.is_line) {
                (true, false) => Some(1.0),
                (true, true) if sides.is_empty() && scene.lag_of(own.name).is_none() => Some(0.5),
                (false, _) if sides.iter().all(|side| *side) => Some(1.0),
                (false, _) if !sides.contains(&true) => None,
                _ => {
                    let help =
                        "it crosses the plane of symmetry, or lags in it: leave the scene whole";
                    return Err(InputError::new("component", name, help));
                }
            };
            let (name, quantity) = (own.name.into(), own.quantity);
            Ok(Component { name, quantity, image: image.into(), share })
        };
        let all = placed.iter().map(component).collect::<Result<Vec<_>, _>>()?;
        self.check_driven(&all)?;
        Ok(all)
    }

    fn placed(&self) -> Result<Vec<Placed<'_>>, InputError> {
        let (scene, map, mesh) = (self.scene, self.map, self.scene.body.mesh());
        let mut all = Vec::new();
        for spring in &scene.springs {
            let joints = spring.joints(mesh)?;
            let numbers = |is_image: bool| {
                let number = |joint: &SpringPoint| {
                    let mut x = joint.at;
                    if is_image {
                        x[map.axis] = 2.0 * map.ends[0] - x[map.axis];
                    }
                    x.rotate_left((map.axis + 1) % 3);
                    [x[0], x[1], x[2], f64::from(u8::from(joint.shares.is_empty()))]
                };
                let mut numbers: Vec<[f64; 4]> = joints.iter().map(number).collect();
                if !spring.is_cable() {
                    // either end may be the first one
                    numbers.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
                }
                numbers.concat()
            };
            all.push(Placed {
                name: spring.name(),
                quantity: Quantity::Actuation,
                likeness: spring.likeness(),
                at: [false, true].map(numbers),
                along: joints.iter().map(|joint| joint.at[map.axis]).collect(),
                is_line: true,
            });
        }
        let muscles = scene.muscles.iter().map(|muscle| {
            let (cells, course) = (muscle.cells(mesh), Some(muscle.course()));
            (muscle.name(), muscle.likeness(), cells, course)
        });
        let growths = scene.growths.iter().map(|growth| {
            (growth.name(), growth.likeness(), growth.cells(&scene.body), growth.course())
        });
        for (name, likeness, cells, course) in muscles.chain(growths) {
            let cells = cells?;
            let images = map.cell_images.as_ref();
            let images = images.ok_or_else(|| self.refused("cells", format!("of \"{name}\"")))?;
            let numbers = |cells: Vec<usize>, course: Option<FibreDirection>| {
                let cells = distinct(cells).into_iter().map(|cell| cell as f64);
                cells.chain(course.iter().flat_map(FibreDirection::numbers)).collect()
            };
            let of_images = cells.iter().map(|&cell| images[cell]).collect();
            let mirrored = course.map(|course| course.mirrored(map.axis, map.ends[0]));
            let x = |node: usize| mesh.position(node)[map.axis];
            let all_cells: Vec<&[usize]> = mesh.cells().collect();
            let nodes = cells.iter().flat_map(|&cell| all_cells[cell]);
            all.push(Placed {
                name,
                quantity: Quantity::Actuation,
                likeness,
                along: nodes.map(|&node| x(node)).collect(),
                at: [numbers(cells, course.cloned()), numbers(of_images, mirrored)],
                is_line: false,
            });
        }
        for chamber in &scene.chambers {
            let name = chamber.name();
            let walls = chamber.nodes();
            let walls = walls.ok_or_else(|| self.refused("triangles", format!("of \"{name}\"")))?;
            let nodes = mesh.select(walls)?;
            let numbers = |nodes: Vec<usize>| nodes.into_iter().map(|node| node as f64).collect();
            all.push(Placed {
                name,
                quantity: Quantity::Pressure,
                likeness: chamber.likeness(),
                along: nodes.iter().map(|&node| mesh.position(node)[map.axis]).collect(),
                at: [distinct(nodes.iter().copied()), map.images_of(&nodes).unwrap_or_default()]
                    .map(numbers),
                is_line: false,
            });
        }
        Ok(all)
    }

    /// Checks that phases drive components as their images.
    fn check_driven(&self, components: &[Component]) -> Result<(), InputError> {
        let mut start = 0.0;
        for phase in &self.scene.phases {
            for Component { name, quantity, image, .. } in components {
                let at = |name: &str, t: f64| -> f64 {
                    phase.signals_of(*quantity, name).map(|signal| signal.at(t)).sum()
                };
                if times(phase, start).iter().any(|&t| at(name, t) != at(image, t)) {
                    let input = quantity.of(&Target::one(name));
                    let input = format!("{input} in phase \"{}\"", phase.name);
                    return Err(self.refused(input, format!("not that of \"{image}\"")));
                }
            }
            start = phase.until;
        }
        Ok(())
    }

    /// The inputs of the components that the half has.
    pub(super) fn driven(&self, phase: &Phase, components: &[Component]) -> Vec<Input> {
        let mut inputs = Vec::new();
        for Component { name, quantity, share, .. } in components {
            let Some(share) = share else { continue };
            let is_winch = |spring: &Spring| spring.name() == name && spring.is_winch();
            // lengths that are drawn in are those of the whole
            let share = if self.scene.springs.iter().any(is_winch) { 1.0 } else { *share };
            for signal in phase.signals_of(*quantity, name) {
                let signal = match share == 1.0 {
                    true => signal.clone(),
                    false => signal.clone().times(share),
                };
                inputs.push(Input::new(*quantity, Target::one(name), signal));
            }
        }
        inputs
    }

    /// Leaves the components of the half in its `scene`.
    pub(super) fn keep(
        &self,
        components: &[Component],
        scene: &mut Scene,
    ) -> Result<(), InputError> {
        let (whole, map, mesh) = (self.scene, self.map, self.scene.body.mesh());
        let component = |quantity: Quantity, name: &str| {
            let mut own = components.iter().filter(|own| own.share.is_some());
            own.find(|own| own.quantity == quantity && own.name == name)
        };
        let share = |name: &str| component(Quantity::Actuation, name).and_then(|own| own.share);
        let nodes = |selection: &Selection| match selection {
            Selection::Numbers(_) => {
                let nodes = mesh.select(selection)?.into_iter();
                Ok(Selection::of_nodes(nodes.filter_map(|node| map.numbers[node])))
            }
            selection => Ok(selection.clone()),
        };
        let cells = |selection: &CellSelection| {
            let cells = selection.cells(mesh)?.into_iter();
            let own = cells.filter_map(|cell| Some(map.cells[cell]? + 1));
            Ok(CellSelection::Numbers(own.collect()))
        };
        let springs = whole.springs.iter().filter_map(|own| Some(own.share(share(own.name())?)));
        scene.springs = springs.map(|own| own.with_nodes(nodes)).collect::<Result<_, _>>()?;
        let muscles = whole.muscles.iter().filter(|own| share(own.name()).is_some());
        scene.muscles = muscles.map(|own| own.with_cells(cells)).collect::<Result<_, _>>()?;
        let growths = whole.growths.iter().filter(|own| share(own.name()).is_some());
        scene.growths = growths.map(|own| own.with_cells(cells)).collect::<Result<_, _>>()?;
        let chambers = whole.chambers.iter().filter_map(|own| {
            let Component { name, image, .. } = component(Quantity::Pressure, own.name())?;
            Some((own.clone().with_nodes(nodes), name == image))
        });
        let chambers = chambers.map(|(half, is_own_image)| match is_own_image {
            true => half?.closed_by_plane(mesh.dimension()),
            false => half,
        });
        scene.chambers = chambers.collect::<Result<_, InputError>>()?;
        scene.lags.retain(|(name, _)| share(name).is_some());
        Ok(())
    }
}
