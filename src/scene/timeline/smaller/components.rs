//! Components of a scene with names of their own in its half: each is its own mirror image or that of another one.
//!
//! Of two images one is left. A line in the plane of symmetry has half of its forces. Cells and faces keep those on this side, and a
//! chamber is closed by the plane, in which the force of that wall is held; what flows into it does so through half of an orifice or
//! pipe (`passages.rs`).

use std::iter;

use super::super::{Input, Phase, Quantity, Scene, Target};
use super::same::{SAME, Same, times};
use crate::base::input::InputError;
use crate::elements::body::CellSelection;
use crate::elements::mesh::Selection;
use crate::scene::forces::{ComponentMap, Drive, Placed};

/// The quantities that phases set of a component, and whether its half has its share of them.
pub(super) type Inputs = &'static [(Quantity, bool)];

/// A component with its place and its image's.
type InPlace<'a> = (&'a str, Placed, Inputs);

/// A component of a scene, and what its half has of it.
pub(super) struct Component<'a> {
    pub(super) name: &'a str,
    /// Its mirror image: itself or another one.
    pub(super) image: &'a str,
    /// Share of it that the half has; none of what is on the other side.
    pub(super) share: Option<f64>,
    pub(super) inputs: Inputs,
}

/// All of them, by kinds, as the scene has them.
pub(super) struct Components<'a> {
    actuators: Vec<Component<'a>>,
    chambers: Vec<Component<'a>>,
    fluids: Vec<Component<'a>>,
    orifices: Vec<Component<'a>>,
    pipes: Vec<Component<'a>>,
}

impl<'a> Components<'a> {
    fn all(&self) -> impl Iterator<Item = &Component<'a>> {
        let kinds = [&self.actuators, &self.chambers, &self.fluids, &self.orifices, &self.pipes];
        kinds.into_iter().flatten()
    }
}

impl<'s> Same<'s> {
    /// The components of the scene in its half.
    ///
    /// # Errors
    /// Those without a mirror image, or that phases drive otherwise; lines that cross the plane.
    pub(super) fn components(&self) -> Result<Components<'s>, InputError> {
        let (scene, body) = (self.scene, &self.scene.body);
        let actuators = scene.actuators.iter().map(|own| {
            let inputs: Inputs = match own.kind().drive {
                Drive::Force => &[(Quantity::Actuation, true)],
                _ => &[(Quantity::Actuation, false)],
            };
            Ok((own.name(), own.placed(body, self.map)?, inputs))
        });
        let chambers = scene.chambers.iter().map(|own| {
            let inputs: Inputs = &[(Quantity::Pressure, false), (Quantity::Flow, true)];
            Ok((own.name(), own.placed(body.mesh(), self.map)?, inputs))
        });
        let times: Vec<f64> = self.phase_starts().flat_map(|(phase, t)| times(phase, t)).collect();
        let fluids = scene.fluids.iter().map(|own| {
            let inputs: Inputs = &[];
            Ok((own.name(), own.placed(body.mesh(), self.map, &times)?, inputs))
        });
        let chambers = self.images(chambers.collect::<Result<_, _>>()?)?;
        let orifices = scene.orifices.iter().map(|own| (own.name(), &own.ends, own.likeness()));
        let pipes = scene.pipes.iter().map(|own| (own.name(), own.ends(), own.likeness()));
        let all = Components {
            actuators: self.images(actuators.collect::<Result<_, _>>()?)?,
            fluids: self.images(fluids.collect::<Result<_, _>>()?)?,
            orifices: self.passages(
                &chambers,
                ("orifice", &[(Quantity::Opening, false)]),
                orifices.collect(),
            )?,
            pipes: self.passages(&chambers, ("pipe", &[]), pipes.collect())?,
            chambers,
        };
        self.check_driven(&all)?;
        Ok(all)
    }

    /// Components of one kind that are `placed`.
    fn images(&self, placed: Vec<InPlace<'s>>) -> Result<Vec<Component<'s>>, InputError> {
        let component = |own: &InPlace<'s>| {
            let (image, share) = self.image(own, &placed)?;
            Ok(Component { name: own.0, image, share, inputs: own.2 })
        };
        placed.iter().map(component).collect()
    }

    /// The mirror image of a component among `all`, and the share of it that the half has.
    fn image(
        &self,
        own: &InPlace<'s>,
        all: &[InPlace<'s>],
    ) -> Result<(&'s str, Option<f64>), InputError> {
        let (at, tolerance) = (self.map.ends[0], SAME * self.scene.body.size());
        let content = |name: &str| {
            let liquid = self.scene.liquids.iter().find(|liquid| liquid.chamber() == name);
            let liquid = liquid.map(|liquid| liquid.likeness());
            format!("{:?}", (self.scene.lag_of(name), self.scene.gas_of(name), liquid))
        };
        // of several in one place each is its own
        let mut candidates = iter::once(own).chain(all);
        let (name, placed, _) = own;
        let is_image = |(other, at, _): &&InPlace| {
            let numbers = placed.at[1].iter().zip(&at.at[0]);
            placed.likeness == at.likeness
                && content(name) == content(other)
                && placed.at[1].len() == at.at[0].len()
                && numbers.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)
        };
        let told = format!("\"{name}\"");
        let image = candidates.find(is_image);
        let image = image.ok_or_else(|| self.refused("component", &told))?.0;
        let beside = placed.along.iter().filter(|x| (*x - at).abs() > tolerance);
        let sides: Vec<bool> = beside.map(|x| self.map.is_kept(*x)).collect();
        let share = match (image == *name, placed.is_line) {
            (true, false) => Some(0.5),
            (true, true) if sides.is_empty() && self.scene.lag_of(name).is_none() => Some(0.5),
            (false, _) if sides.iter().all(|side| *side) => Some(1.0),
            (false, _) if !sides.contains(&true) => None,
            _ => {
                let help = "it crosses the plane of symmetry, or lags in it: leave the scene whole";
                return Err(InputError::new("component", told, help));
            }
        };
        Ok((image, share))
    }

    /// Checks that phases drive components as their images.
    fn check_driven(&self, components: &Components) -> Result<(), InputError> {
        for (phase, start) in self.phase_starts() {
            for Component { name, image, inputs, .. } in components.all() {
                for (quantity, _) in *inputs {
                    let at = |name: &str, t: f64| -> f64 {
                        phase.signals_of(*quantity, name).map(|signal| signal.at(t)).sum()
                    };
                    if times(phase, start).iter().any(|&t| at(name, t) != at(image, t)) {
                        let input = quantity.of(&Target::one(*name));
                        let input = format!("{input} in phase \"{}\"", phase.name);
                        return Err(self.refused(input, format!("not that of \"{image}\"")));
                    }
                }
            }
        }
        Ok(())
    }

    /// The inputs of the components that the half has.
    pub(super) fn driven(&self, phase: &Phase, components: &Components) -> Vec<Input> {
        let mut inputs = Vec::new();
        for Component { name, share, inputs: own, .. } in components.all() {
            let Some(share) = share else { continue };
            for (quantity, is_shared) in *own {
                for signal in phase.signals_of(*quantity, name) {
                    let signal = match *is_shared && *share != 1.0 {
                        true => signal.clone().times(*share),
                        false => signal.clone(),
                    };
                    inputs.push(Input::new(*quantity, Target::one(*name), signal));
                }
            }
        }
        inputs
    }

    /// The nodes of a selection in the smaller scene; names and boxes are the same there.
    pub(super) fn selected(&self, selection: &Selection) -> Result<Selection, InputError> {
        match selection {
            Selection::Numbers(_) => {
                let nodes = self.scene.body.mesh().select(selection)?.into_iter();
                Ok(Selection::of_nodes(nodes.filter_map(|node| self.map.numbers[node])))
            }
            selection => Ok(selection.clone()),
        }
    }

    /// The cells of a selection in the smaller scene, by their numbers.
    pub(super) fn selected_cells(
        &self,
        cells: &CellSelection,
    ) -> Result<CellSelection, InputError> {
        let cells = cells.cells(self.scene.body.mesh())?.into_iter();
        let own = cells.filter_map(|cell| Some(self.map.cells[cell]? + 1));
        Ok(CellSelection::Numbers(own.collect()))
    }

    /// Leaves the components of the half in its `scene`.
    pub(super) fn keep(&self, own: &Components, scene: &mut Scene) -> Result<(), InputError> {
        let (whole, dimension) = (self.scene, self.scene.body.dimension());
        let nodes = |selection: &Selection| self.selected(selection);
        let cells = |cells: &CellSelection| self.selected_cells(cells);
        scene.lags.retain(|(name, _)| {
            own.actuators.iter().any(|own| own.name == name && own.share.is_some())
        });
        let map = |share| ComponentMap { nodes: &nodes, cells: &cells, share };
        scene.actuators =
            kept(&whole.actuators, &own.actuators, |of, (share, _)| of.mapped(&map(share)))?;
        scene.chambers = kept(&whole.chambers, &own.chambers, |of, (_, is_own)| {
            let chamber = of.clone().with_nodes(nodes)?;
            if is_own { chamber.closed_by_plane(dimension) } else { Ok(chamber) }
        })?;
        let has = |chamber: &str| scene.chambers.iter().any(|own| own.name() == chamber);
        scene.gases.retain(|gas| has(&gas.chamber));
        scene.liquids.retain(|liquid| has(liquid.chamber()));
        scene.fluids = kept(&whole.fluids, &own.fluids, |of, _| of.with_nodes(nodes))?;
        scene.orifices =
            kept(&whole.orifices, &own.orifices, |of, (share, _)| Ok(of.clone().times(share)))?;
        scene.pipes = kept(&whole.pipes, &own.pipes, |of, (share, _)| Ok(of.clone().times(share)))?;
        Ok(())
    }
}

/// Those of `all` that a half has, as `make` makes them of their share, and of whether they are their own images.
fn kept<T>(
    all: &[T],
    own: &[Component],
    make: impl Fn(&T, (f64, bool)) -> Result<T, InputError>,
) -> Result<Vec<T>, InputError> {
    let kept = all
        .iter()
        .zip(own)
        .filter_map(|(whole, own)| Some(make(whole, (own.share?, own.name == own.image))));
    kept.collect()
}
