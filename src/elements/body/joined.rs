//! Several bodies as one.
//!
//! Nodes and cells of one body come after those of the other, node sets have the names of their bodies before
//! their own, and M, K and B are blocks on the diagonal. Forces, constraints, sensors, samples and
//! checkpoints know nodes of any body; only code that depends on the contents of a body asks for its parts. All
//! numbers are to the last bit those of each body alone, as the sums at a node are the same. Finer meshes and
//! advice are for single bodies: new nodes of the first would come between, and nodes of the second could not
//! keep their numbers.

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use super::assembled::{Body, Joined};
use super::continuum::Continuum;
use super::elements::too_many;
use super::nodal_masses::NodalMasses;
use super::offset::Offset;
use super::recipe::Recipe;
use super::rigid::RigidPieces;
use crate::base::input::{InputError, find};
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::elements::material::{Material, Strain};
use crate::elements::mesh::Mesh;

impl Joined {
    fn part(&self) -> Part<'_> {
        let Self { name, body, nodes, cells } = self;
        Part { name, body, nodes: nodes.clone(), cells: cells.clone() }
    }
}

/// One of the bodies that are joined, or a single one.
#[derive(Debug, Clone)]
pub struct Part<'a> {
    /// Its name; empty for a single body that has none.
    pub name: &'a str,
    /// The single body.
    pub body: &'a Body,
    /// Numbers of its nodes among those of all (from 0).
    pub nodes: Range<usize>,
    /// Numbers of its cells among those of all (from 0).
    pub cells: Range<usize>,
}

impl Part<'_> {
    /// Its part of vectors of all bodies, such as displacements: places of numbers, `dimension` per node.
    pub fn dofs(&self) -> Range<usize> {
        let d = self.body.dimension();
        d * self.nodes.start..d * self.nodes.end
    }
}

impl Body {
    /// Several bodies as one, for a scene of all of them.
    ///
    /// Bodies are [named](super::BodyBuilder::named), or are `body 1`, `body 2` and so on. The nodes of a body
    /// are a node set with its name, and its own sets and groups of cells have that name before theirs. Numbers
    /// of nodes and cells go through the bodies in their order.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// let square = |name, x: f64| {
    ///     let mesh = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Triangles)?.translated(&[x, 0.0])?;
    ///     Body::new(mesh, rubber).thickness(0.01).named(name).build()
    /// };
    /// let both = Body::join([square("left", 0.0)?, square("right", 0.2)?])?;
    /// assert!((both.mass() - 0.2).abs() < 1e-12); // kg
    /// assert_eq!(both.mesh().sets()["right/bottom"], [16, 17, 18, 19]);
    /// let u = vec![0.0; both.dofs()];
    /// let centres: Vec<f64> =
    ///     both.parts().map(|part| part.body.centre_of_mass(&u[part.dofs()])[0]).collect();
    /// assert!((centres[1] - 0.25).abs() < 1e-12);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// No bodies, bodies in spaces of different dimensions, names that are not different or hold a `/`.
    pub fn join(bodies: impl IntoIterator<Item = Self>) -> Result<Self, InputError> {
        let mut bodies: Vec<Self> = bodies.into_iter().flat_map(Self::into_parts).collect();
        let Some(first) = bodies.first() else {
            return Err(InputError::new("number of bodies", 0, "give one at least"));
        };
        let dimension = first.dimension();
        if bodies.len() == 1 {
            return Ok(bodies.remove(0));
        }
        let names = names(&bodies)?;
        let other = |(_, body): &(&String, &Self)| body.dimension() != dimension;
        if let Some((name, body)) = names.iter().zip(&bodies).find(other) {
            let help = format!("that of body \"{}\" is {dimension}: all share one space", names[0]);
            let input = format!("dimension of body \"{name}\"");
            return Err(InputError::new(input, body.dimension(), help));
        }
        let turned: Vec<bool> = bodies.iter().map(Self::is_axisymmetric).collect();
        if let Some(other) = turned.iter().position(|own| *own != turned[0]) {
            let words = |turned: bool| if turned { "axisymmetric" } else { "not axisymmetric" };
            let help = format!("body \"{}\" is {}: all are, or none", names[0], words(turned[0]));
            let input = format!("plane of body \"{}\"", names[other]);
            return Err(InputError::new(input, words(turned[other]), help));
        }
        let mesh =
            Mesh::join(names.iter().map(|name| &name[..]).zip(bodies.iter().map(Self::mesh)));
        let inertia = NodeMatrix::join(bodies.iter().map(Self::inertia));
        let pattern = inertia.pattern().clone();
        if u32::try_from(pattern.entries()).is_err() {
            return Err(too_many(&pattern));
        }
        let (mut continua, mut joined) = (Vec::new(), Vec::new());
        let (mut node, mut cell, mut entry) = (0, 0, 0);
        for (name, body) in names.into_iter().zip(bodies) {
            let offset = Offset { node, entry, count: mesh.node_count() };
            continua.extend(body.continua.iter().map(|own| own.among_others(offset, cell)));
            let nodes = node..node + body.mesh.node_count();
            let cells = cell..cell + body.mesh.cell_count();
            (node, cell, entry) = (nodes.end, cells.end, entry + body.inertia.pattern().entries());
            joined.push(Joined { name, body, nodes, cells });
        }
        let block = |matrix: fn(&Self) -> &BlockMatrix| {
            let all = joined.iter().map(|part| Ok(matrix(&part.body)));
            Arc::new(BlockMatrix::join(&pattern, dimension, all))
        };
        let (stiffness, damping) = (block(Self::stiffness), block(Self::damping));
        let has_mass_damping = joined.iter().any(|part| part.body.mass_damping.is_some());
        let mass_damping = has_mass_damping.then(|| {
            let none = |part: &Joined| Arc::new(NodeMatrix::diagonal(part.nodes.len()));
            let own = |part: &Joined| part.body.mass_damping().unwrap_or_else(|| none(part));
            let all: Vec<Arc<NodeMatrix>> = joined.iter().map(own).collect();
            Arc::new(NodeMatrix::join(all.iter().map(|own| &**own)))
        });
        let inertia = Arc::new(inertia);
        let body = Self {
            masses: Arc::new(NodalMasses::new(&inertia, &mesh)),
            mesh,
            continua,
            joined: joined.into(),
            inertia,
            stiffness,
            damping,
            mass_damping,
            rigid: None,
        };
        Ok(Self { rigid: RigidPieces::of(&body.mesh, &body.rigid_cells()).map(Arc::new), ..body })
    }

    /// The bodies that were joined, or the body itself.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let single = self.is_single().then(|| self.whole());
        single.into_iter().chain(self.joined.iter().map(Joined::part))
    }

    /// The meshes of the parts, with their point masses.
    pub(crate) fn meshes(&self) -> Vec<&Mesh> {
        match self.is_single() {
            true => vec![&self.mesh],
            false => self.joined.iter().map(|part| &part.body.mesh).collect(),
        }
    }

    /// The options of a single body but for its name, materials and point masses, as a text.
    pub(crate) fn likeness(&self) -> String {
        let recipe = (*self.continua[0].recipe).clone();
        let material = Material::rigid(0.0);
        let (name, regions, points) = (None, Vec::new(), Vec::new());
        format!("{:?}", Recipe { name, material, regions, points, ..recipe })
    }

    /// Numbers of the point masses, which no cell has.
    pub(crate) fn point_nodes(&self) -> Vec<usize> {
        let points = |part: Part| {
            let count = part.body.continua[0].recipe.points.len();
            part.nodes.end - count..part.nodes.end
        };
        self.parts().flat_map(points).collect()
    }

    /// The body with a name; `input` is where that was given.
    pub(crate) fn part_named(&self, name: &str, input: &str) -> Result<Part<'_>, InputError> {
        let parts: Vec<Part> = self.parts().collect();
        let number = find(name, parts.iter().map(|part| part.name), input, "bodies")?;
        Ok(parts[number].clone())
    }

    /// The body of a node (counted from 0 among those of all).
    pub(crate) fn part_of(&self, node: usize) -> Part<'_> {
        let number = self.continua.partition_point(|continuum| continuum.nodes.end <= node);
        match self.joined.get(number) {
            Some(joined) => joined.part(),
            None => self.whole(),
        }
    }

    /// A body as the only part.
    pub(crate) fn whole(&self) -> Part<'_> {
        Part {
            name: self.name().unwrap_or_default(),
            body: self,
            nodes: 0..self.mesh.node_count(),
            cells: 0..self.mesh.cell_count(),
        }
    }

    /// The cells of a body to which a cell belongs (counted from 0 among those of all).
    pub(super) fn continuum_of(&self, cell: usize) -> &Continuum {
        &self.continua[self.continua.partition_point(|continuum| continuum.cells.end <= cell)]
    }

    /// Strain measure of a cell (counted from 0 among those of all).
    pub(crate) fn strain_of(&self, cell: usize) -> Strain {
        self.continuum_of(cell).strain
    }

    /// The names of its kinds of cells.
    pub(crate) fn cell_names(&self) -> String {
        let mut names: Vec<&str> = self.continua.iter().map(|own| own.kind.name()).collect();
        names.sort_unstable();
        names.dedup();
        names.join(", ")
    }

    /// The largest size of a body (m): the length of the diagonal of the box around it.
    pub(crate) fn size(&self) -> f64 {
        self.parts().map(|part| part.body.mesh.size()).fold(0.0, f64::max)
    }

    /// The largest Young's modulus of a body (Pa), apart from its regions.
    pub(crate) fn largest_young(&self) -> f64 {
        self.continua.iter().map(|own| own.material.young).fold(0.0, f64::max)
    }

    /// The largest speed of waves in a body (m/s), apart from its regions.
    pub(crate) fn largest_wave_speed(&self) -> f64 {
        self.continua.iter().map(|own| own.material.wave_speed()).fold(0.0, f64::max)
    }

    /// Whether it is a single body.
    pub(crate) fn is_single(&self) -> bool {
        self.joined.is_empty()
    }

    /// Rejects several bodies, for which `what` is not available.
    pub(crate) fn single(&self, what: &str) -> Result<(), InputError> {
        if self.is_single() {
            return Ok(());
        }
        let help = format!("{what} needs a single body");
        Err(InputError::new("number of bodies", self.joined.len(), help))
    }

    fn into_parts(self) -> Vec<Self> {
        match self.is_single() {
            true => vec![self],
            false => self.joined.iter().map(|part| part.body.clone()).collect(),
        }
    }
}

/// The names of bodies, which are to be different.
fn names(bodies: &[Body]) -> Result<Vec<String>, InputError> {
    let mut seen = BTreeSet::new();
    let mut names = Vec::with_capacity(bodies.len());
    for (number, body) in (1..).zip(bodies) {
        let name = body.name().map_or_else(|| format!("body {number}"), str::to_owned);
        let help = match &name[..] {
            "all" | "boundary" => Some("these nodes are those of all bodies: name it otherwise"),
            name if name.is_empty() || name.contains('/') => {
                Some("node sets are named \"body/set\": give it a name without a \"/\"")
            }
            name if !seen.insert(name.to_owned()) => Some("it is taken: name it otherwise"),
            _ => None,
        };
        if let Some(help) = help {
            return Err(InputError::new("name of a body", format!("\"{name}\""), help));
        }
        names.push(name);
    }
    Ok(names)
}
