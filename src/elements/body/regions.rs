//! Regions: parts of a body with another material.

use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use crate::base::input::InputError;
use crate::elements::basis::Finer;
use crate::elements::material::{
    Elastic, Hooke, Hookean, Lame, Material, ObjectiveViscosity, Plane, Relaxing, Strain, Substance,
};
use crate::elements::mesh::Mesh;

/// Cells, by the name of a group, by number or by a box around their centroids.
///
/// Strings convert into it: `body.region("skin", stiff)`.
#[derive(Debug, Clone, PartialEq)]
pub enum CellSelection {
    /// A named group of cells of the mesh ([`Mesh::cell_groups`]).
    Group(String),
    /// Cell numbers, counted from 1 in the order of the mesh.
    Numbers(Vec<usize>),
    /// All cells whose centroid lies in the closed box between `min` and `max` (m).
    Box {
        /// Lower corner.
        min: Vec<f64>,
        /// Upper corner.
        max: Vec<f64>,
    },
}

impl fmt::Display for CellSelection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Group(name) => write!(f, "\"{name}\""),
            Self::Numbers(numbers) => write!(f, "cells {numbers:?}"),
            Self::Box { min, max } => write!(f, "box [{min:?}, {max:?}]"),
        }
    }
}

impl From<&str> for CellSelection {
    fn from(name: &str) -> Self {
        Self::Group(name.into())
    }
}

impl CellSelection {
    /// All cells whose centroid lies in the closed box between `min` and `max` (m).
    pub fn inside(min: impl Into<Vec<f64>>, max: impl Into<Vec<f64>>) -> Self {
        Self::Box { min: min.into(), max: max.into() }
    }

    /// The same cells on the mesh `finer` than `mesh`, by number if they were given by it.
    ///
    /// # Errors
    /// As [`cells`](Self::cells).
    pub(crate) fn on(&self, mesh: &Mesh, finer: &Finer) -> Result<Self, InputError> {
        let Self::Numbers(_) = self else { return Ok(self.clone()) };
        let children = finer.children_of(&self.cells(mesh)?);
        Ok(Self::Numbers(children.iter().map(|cell| cell + 1).collect()))
    }

    /// The cells of a selection, or all without one, counted from 0.
    pub(crate) fn cells_or_all(
        selection: Option<&Self>,
        mesh: &Mesh,
    ) -> Result<Vec<usize>, InputError> {
        match selection {
            Some(selection) => selection.cells(mesh),
            None => Ok((0..mesh.cell_count()).collect()),
        }
    }

    /// The cells, counted from 0.
    pub(crate) fn cells(&self, mesh: &Mesh) -> Result<Vec<usize>, InputError> {
        let cells = match self {
            Self::Group(name) => mesh.cell_groups().get(name).cloned().ok_or_else(|| {
                let known: Vec<&str> = mesh.cell_groups().keys().map(String::as_str).collect();
                let help = match known.is_empty() {
                    true => "the mesh has no groups of cells".into(),
                    false => format!("the mesh has the groups {}", known.join(", ")),
                };
                InputError::new("group of cells", format!("\"{name}\""), help)
            })?,
            Self::Numbers(numbers) => {
                let count = mesh.cell_count();
                if let Some(number) = numbers.iter().find(|n| !(1..=count).contains(*n)) {
                    let help = format!("the mesh has the cells 1 to {count}");
                    return Err(InputError::new("cell of a region", number, help));
                }
                numbers.iter().map(|number| number - 1).collect()
            }
            Self::Box { min, max } => {
                let d = mesh.dimension();
                for (name, corner) in [("region box min", min), ("region box max", max)] {
                    if corner.len() != d || corner.iter().any(|x| x.is_nan()) {
                        let help = format!("it needs {d} numbers (m)");
                        return Err(InputError::new(name, format!("{corner:?}"), help));
                    }
                }
                let inside = |cell: &[usize]| {
                    (0..d).all(|i| {
                        let sum: f64 = cell.iter().map(|&node| mesh.position(node)[i]).sum();
                        (min[i]..=max[i]).contains(&(sum / cell.len() as f64))
                    })
                };
                let cells = mesh.cells().enumerate().filter(|(_, cell)| inside(cell));
                cells.map(|(number, _)| number).collect::<Vec<usize>>()
            }
        };
        if cells.is_empty() {
            let help = "it contains no cell of the mesh";
            return Err(InputError::new("region", self, help));
        }
        Ok(cells)
    }
}

/// Material data of a region for its elements: density (kg/m^3), rate of mass damping (1/s), laws and branches.
#[derive(Debug, Clone)]
pub(super) struct Laws {
    pub(super) density: f64,
    pub(super) mass_damping: f64,
    pub(super) elastic: Elastic,
    /// The elastic law linearized at zero strain.
    pub(super) hooke: Hooke,
    /// Hooke's law with viscous moduli: the damping matrix B.
    pub(super) viscous: Hooke,
    /// Law of objective viscosity.
    pub(super) objective: ObjectiveViscosity,
    pub(super) branches: Vec<Relaxing>,
    /// Elastic law of a rigid piece where constraints on its edges do not keep its shape; the laws above have no stiffness then.
    pub(super) of_rigid: Option<Elastic>,
}

impl Laws {
    /// The law of the damping matrix B.
    pub(super) fn natural_viscosity(&self) -> Elastic {
        Elastic::Linear(Hookean(self.viscous))
    }
}

/// Which substance each cell is made of.
#[derive(Debug, Clone)]
pub(super) struct Regions {
    /// The material of the body, then those of its regions.
    pub(super) materials: Vec<Material>,
    laws: Vec<Laws>,
    /// Index of each cell's substance; empty if all cells have the first.
    of_cell: Vec<u16>,
}

impl Regions {
    /// `base` everywhere but in `regions`, of which the last one that contains a cell counts.
    pub(super) fn new(
        mesh: &Mesh,
        strain: Strain,
        plane: Plane,
        base: &Substance,
        regions: &[(CellSelection, Substance)],
    ) -> Result<Self, InputError> {
        let laws = |substance: &Substance| -> Result<Laws, InputError> {
            substance.validate()?;
            let Substance { material, law, mass_damping, branches, fibres, is_rigid, .. } =
                substance;
            if *is_rigid && !(branches.is_empty() && fibres.is_empty()) {
                let help = "a rigid material has no branches and no fibres: remove them";
                return Err(InputError::new("material.rigid", true, help));
            }
            if *is_rigid && strain == Strain::Cauchy {
                let help = "rigid pieces turn, which Cauchy strain takes for a strain: measure strain by Green's";
                return Err(InputError::new("material.rigid", true, help));
            }
            if let (Some(law), Strain::Cauchy) = (law, strain) {
                let help = "Cauchy strain is linear elasticity and takes no other law: leave one of the two out";
                return Err(InputError::new("material.law", format!("{law:?}"), help));
            }
            if strain == Strain::Cauchy && !fibres.is_empty() {
                let help =
                    "fibres take tension alone, which is not linear: measure strain by Green's";
                return Err(InputError::new("number of families of fibres", fibres.len(), help));
            }
            let dimension = mesh.kind().dimension();
            let hooke = |lame: Lame| Hooke::new(lame, dimension, plane);
            let elastic = Elastic::new(strain, *law, material.elastic(), dimension, plane);
            let [lame, viscous] = match is_rigid {
                true => [Lame { lambda: 0.0, mu: 0.0 }; 2],
                false => [material.elastic(), material.viscous()],
            };
            let objective = match is_rigid {
                true => ObjectiveViscosity::zero(dimension, plane),
                false => ObjectiveViscosity::new(&elastic, material, dimension, plane),
            };
            Ok(Laws {
                density: material.density,
                mass_damping: *mass_damping,
                elastic: match is_rigid {
                    true => Elastic::new(strain, None, lame, dimension, plane),
                    false => elastic,
                },
                hooke: hooke(lame),
                viscous: hooke(viscous),
                objective,
                branches: branches
                    .iter()
                    .map(|branch| Relaxing::new(branch, material, &elastic, dimension, plane))
                    .collect(),
                of_rigid: is_rigid.then_some(elastic),
            })
        };
        let mut all =
            Self { materials: vec![base.material], laws: vec![laws(base)?], of_cell: Vec::new() };
        if regions.len() >= usize::from(u16::MAX) {
            return Err(InputError::new("number of regions", regions.len(), "65,534 are the most"));
        }
        for (number, (cells, substance)) in (1_u16..).zip(regions) {
            all.materials.push(substance.material);
            all.laws.push(laws(substance)?);
            all.of_cell.resize(mesh.cell_count(), 0);
            cells.cells(mesh)?.into_iter().for_each(|cell| all.of_cell[cell] = number);
        }
        if !regions.is_empty() {
            let used: BTreeSet<u16> = all.of_cell.iter().copied().collect();
            all.materials = used.iter().map(|&number| all.materials[usize::from(number)]).collect();
        }
        Ok(all)
    }

    /// Sets this density (kg/m^3) for all laws and materials, of a body without regions.
    pub(super) fn set_density(&mut self, density: f64) {
        self.laws.iter_mut().for_each(|laws| laws.density = density);
        self.materials.iter_mut().for_each(|material| material.density = density);
    }

    /// The substance of a cell.
    pub(super) fn of(&self, cell: usize) -> &Laws {
        &self.laws[self.of_cell.get(cell).map_or(0, |&index| usize::from(index))]
    }

    /// The cells of each substance, of `count` in all.
    pub(super) fn by_substance(&self, count: usize) -> Vec<Vec<usize>> {
        let mut cells = vec![Vec::new(); self.laws.len()];
        for cell in 0..count {
            let number = self.of_cell.get(cell).map_or(0, |&index| usize::from(index));
            cells[number].push(cell);
        }
        cells
    }

    /// `cells`, divided into runs of one substance.
    pub(super) fn runs(&self, cells: &Range<usize>) -> impl Iterator<Item = (Range<usize>, &Laws)> {
        let Range { mut start, end } = *cells;
        std::iter::from_fn(move || {
            let run = match self.of_cell.get(start..end) {
                None => start..end,
                Some(indices) => {
                    let same = indices.iter().take_while(|index| **index == indices[0]);
                    start..start + same.count()
                }
            };
            start = run.end;
            (!run.is_empty()).then(|| (run.clone(), self.of(run.start)))
        })
    }

    /// Whether any of them is rigid, or any is not.
    pub(super) fn are_any(&self, rigid: bool) -> bool {
        self.laws.iter().any(|laws| laws.of_rigid.is_some() == rigid)
    }

    /// The same with the stiffness of the rigid pieces alone.
    pub(super) fn of_rigid(&self, dimension: usize, plane: Plane) -> Self {
        let zero = Lame { lambda: 0.0, mu: 0.0 };
        let none = Elastic::new(Strain::Green, None, zero, dimension, plane);
        let viscous = Hooke::new(zero, dimension, plane);
        let objective = ObjectiveViscosity::zero(dimension, plane);
        let of_rigid = |laws: &Laws| {
            let elastic = laws.of_rigid.unwrap_or(none);
            Laws { elastic, viscous, objective, ..laws.clone() }
        };
        Self { laws: self.laws.iter().map(of_rigid).collect(), ..self.clone() }
    }

    /// The same of `count` cells with the elasticity of those `inside` alone, and with that of the others and all viscosity.
    pub(super) fn parted(
        &self,
        count: usize,
        dimension: usize,
        plane: Plane,
        inside: impl Fn(usize) -> bool,
    ) -> [Self; 2] {
        let zero = Lame { lambda: 0.0, mu: 0.0 };
        let elastic = Elastic::new(Strain::Green, None, zero, dimension, plane);
        let viscous = Hooke::new(zero, dimension, plane);
        let none = ObjectiveViscosity::zero(dimension, plane);
        let laws = |change: &dyn Fn(&Laws) -> Laws| {
            let changed: Vec<Laws> = self.laws.iter().map(change).collect();
            self.laws.iter().cloned().chain(changed).collect()
        };
        let of_cell = |is_changed: &dyn Fn(usize) -> bool| {
            let own = |cell| self.of_cell.get(cell).copied().unwrap_or(0);
            let behind = self.laws.len() as u16;
            let index = |cell| own(cell) + if is_changed(cell) { behind } else { 0 };
            (0..count).map(index).collect()
        };
        let part = |laws, of_cell| Self { materials: self.materials.clone(), laws, of_cell };
        // those inside keep their viscosity in the second part
        let mut grows =
            part(laws(&|laws| Laws { elastic, ..laws.clone() }), of_cell(&|cell| !inside(cell)));
        grows.laws.iter_mut().for_each(|laws| (laws.viscous, laws.objective) = (viscous, none));
        let of_growing = |laws: &Laws| {
            let objective = laws.objective.of_growing(dimension);
            Laws { elastic, objective, ..laws.clone() }
        };
        let rest = part(laws(&of_growing), of_cell(&inside));
        [grows, rest]
    }

    /// The same of some `cells` alone, in their order.
    pub(super) fn sampled(&self, cells: &[usize]) -> Self {
        let picked = |cell: &usize| self.of_cell.get(*cell).copied();
        Self { of_cell: cells.iter().filter_map(picked).collect(), ..self.clone() }
    }

    /// Whether any of them is viscous.
    pub(super) fn are_viscous(&self) -> bool {
        self.laws.iter().any(|laws| !laws.viscous.is_zero())
    }

    /// The branches of all of them.
    pub(super) fn branches(&self) -> impl Iterator<Item = &Relaxing> {
        self.laws.iter().flat_map(|laws| &laws.branches)
    }

    /// Whether any of them has mass damping.
    pub(super) fn have_mass_damping(&self) -> bool {
        self.laws.iter().any(|laws| laws.mass_damping > 0.0)
    }
}
