//! Several bodies as one.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use super::assembled::{Body, Joined};
use super::elements::{Offset, too_many};
use crate::base::input::{InputError, find};
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::elements::material::Strain;
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
    /// The body by itself.
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
        Ok(Self {
            mesh,
            continua,
            joined: joined.into(),
            inertia,
            stiffness,
            damping,
            mass_damping,
        })
    }

    /// The bodies that were joined, or the body itself.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let single = self.joined.is_empty().then(|| self.whole());
        single.into_iter().chain(self.joined.iter().map(Joined::part))
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

    /// How strain is measured in a cell (counted from 0 among those of all).
    pub(crate) fn strain_of(&self, cell: usize) -> Strain {
        let number = self.continua.partition_point(|continuum| continuum.cells.end <= cell);
        self.continua[number].strain
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

    /// Whether it is one body by itself.
    pub(crate) fn is_single(&self) -> bool {
        self.joined.is_empty()
    }

    /// Refuses several bodies, which `what` cannot be had of.
    pub(crate) fn single(&self, what: &str) -> Result<(), InputError> {
        if self.is_single() {
            return Ok(());
        }
        let help = format!("{what} can be had of one body by itself only");
        Err(InputError::new("number of bodies", self.joined.len(), help))
    }

    fn into_parts(self) -> Vec<Self> {
        match self.joined.is_empty() {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::body::tests::noise;
    use crate::elements::body::{BodyBuilder, Dilatation, Inertia};
    use crate::elements::force::{Force, NodalForces};
    use crate::elements::material::{Law, Substance};
    use crate::elements::mesh::{Cells, SolidCells};
    use crate::studies::samples::SQUARE_MATERIAL;

    fn square(cells: Cells, material: impl Into<Substance>) -> BodyBuilder {
        let mesh = Mesh::rectangle([0.3, 0.2], [5, 4], cells).unwrap();
        Body::new(mesh, material).thickness(0.02)
    }

    /// Bodies of other cells, laws, strains and kinds of damping.
    fn in_a_plane() -> [Body; 4] {
        let linear = Substance::from(SQUARE_MATERIAL);
        let rubber = Substance::from(SQUARE_MATERIAL).law(Law::NeoHookean).maxwell(0.7, 0.2);
        let damped = Substance { mass_damping: 3.0, ..SQUARE_MATERIAL.into() };
        let string = Mesh::bar(0.5, 6).unwrap().mapped(|x| [x[0], 1.0]).unwrap();
        [
            square(Cells::Triangles, linear).strain(Strain::Cauchy).named("linear").build(),
            square(Cells::Rectangles9, rubber)
                .dilatation(Dilatation::Linear)
                .region(crate::CellSelection::Numbers(vec![2, 3]), SQUARE_MATERIAL)
                .named("rubber")
                .build(),
            square(Cells::Triangles6, damped).inertia(Inertia::Lumped).build(),
            Body::new(string, SQUARE_MATERIAL.maxwell(1.0, 0.1)).area(1e-4).build(),
        ]
        .map(Result::unwrap)
    }

    /// All forces, with the stiffness and damping, of everything that a body has.
    fn all(body: &Body, u: &[f64], v: &[f64]) -> (Vec<f64>, [BlockMatrix; 2], f64) {
        let mut forces = NodalForces::zeros(body.dofs());
        let mut stiffness = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
        let (mut damping, mut energy) = (stiffness.clone(), 0.0);
        if let Some(elastic) = body.elastic() {
            elastic.add_forces(0.0, u, v, &mut forces).unwrap();
            elastic.add_tangents(0.0, u, v, &mut stiffness, &mut damping);
            energy += elastic.potential(0.0, u);
        }
        if let Some(constant) = body.constant_stiffness() {
            constant.add_product(-1.0, u, &mut forces.conservative);
            stiffness.values.iter_mut().zip(&constant.values).for_each(|(sum, k)| *sum += k);
        }
        if let Some(constant) = body.constant_damping() {
            constant.add_product(-1.0, v, &mut forces.dissipative);
            damping.values.iter_mut().zip(&constant.values).for_each(|(sum, b)| *sum += b);
        }
        let mut rates = Vec::new();
        if let Some(branches) = body.branches() {
            let mut internal = vec![0.0; branches.unknowns()];
            let half: Vec<f64> = u.iter().map(|u| 0.5 * u).collect();
            branches.relax(&half, &mut internal);
            rates = internal.clone();
            branches.add_forces(u, &internal, &mut forces.conservative, &mut rates);
            branches.add_tangents(0.01, u, &internal, &mut stiffness);
            energy += branches.energy(u, &internal);
        }
        let forces = [forces.conservative.to_vec(), forces.dissipative.to_vec(), rates].concat();
        (forces, [stiffness, damping], energy)
    }

    /// What several bodies have together is what each has by itself, to the last bit (energies: to the round-off of
    /// a sum): forces, tangents, masses, fields.
    fn are_those_of_each(bodies: &[Body]) {
        let joined = Body::join(bodies.to_vec()).unwrap();
        let (u, v) = (noise(joined.dofs(), 1e-3, 1.0), noise(joined.dofs(), 0.1, 2.0));
        let parts: Vec<Part> = joined.parts().collect();
        assert_eq!(parts.len(), bodies.len());
        let own: Vec<_> = parts.iter().map(|p| all(p.body, &u[p.dofs()], &v[p.dofs()])).collect();
        let (forces, [stiffness, damping], energy) = all(&joined, &u, &v);
        let dofs: Vec<usize> = bodies.iter().map(Body::dofs).collect();
        let [mut at, mut rates] = [[0, joined.dofs()], [2 * joined.dofs(), 0]];
        for ((of_body, ..), dofs) in own.iter().zip(dofs) {
            for (k, own) in of_body[..2 * dofs].chunks(dofs).enumerate() {
                assert_eq!(&forces[at[k]..][..dofs], own);
                at[k] += dofs;
            }
            let own = &of_body[2 * dofs..];
            assert_eq!(&forces[rates[0]..][..own.len()], own);
            rates[0] += own.len();
        }
        rates[1] = forces.len();
        assert_eq!(rates[0], rates[1]);
        assert!(forces.iter().filter(|force| **force != 0.0).count() > joined.dofs());
        let both = |k: usize| own.iter().flat_map(move |(_, tangents, _)| &tangents[k].values);
        assert!(both(0).eq(&stiffness.values) && both(1).eq(&damping.values));
        let sum: f64 = own.iter().map(|(.., energy)| energy).sum();
        assert!((sum - energy).abs() < 1e-14 * sum && sum > 0.0, "{sum} {energy}");
        let masses: Vec<f64> = bodies.iter().flat_map(Body::nodal_masses).collect();
        assert_eq!(joined.nodal_masses(), masses);
        let fields: Vec<_> = parts.iter().flat_map(|p| p.body.cell_fields(&u[p.dofs()])).collect();
        assert_eq!(joined.cell_fields(&u), fields);
        let fields: Vec<_> = parts.iter().flat_map(|p| p.body.nodal_fields(&u[p.dofs()])).collect();
        assert_eq!(joined.nodal_fields(&u), fields);
        let faces: usize = parts.iter().map(|p| p.body.mesh().boundary_faces().len()).sum();
        assert_eq!(joined.mesh().boundary_faces().len(), faces);
        let again = joined.to_builder().build().unwrap();
        assert_eq!(all(&again, &u, &v).0, forces);
    }

    #[test]
    fn bodies_are_together_what_each_is() {
        are_those_of_each(&in_a_plane());
        let block = |cells| {
            let mesh = Mesh::cuboid([0.3, 0.2, 0.1], [4, 3, 3], cells).unwrap();
            Body::new(mesh, SQUARE_MATERIAL)
        };
        let [solid, linear] = [
            block(SolidCells::Hexahedra).dilatation(Dilatation::Mean),
            block(SolidCells::Tetrahedra).strain(Strain::Cauchy),
        ];
        are_those_of_each(&[solid.build().unwrap(), linear.build().unwrap()]);
        // linear forces cell by cell, as all bodies are of triangles
        let plane = || square(Cells::Triangles, SQUARE_MATERIAL).strain(Strain::Cauchy);
        let both = [plane().build().unwrap(), plane().thickness(0.1).build().unwrap()];
        let joined = Body::join(both).unwrap();
        let (u, v) = (noise(joined.dofs(), 1e-3, 1.0), noise(joined.dofs(), 0.1, 2.0));
        let mut forces = NodalForces::zeros(joined.dofs());
        joined.linear_by_cells().unwrap().add_forces(&u, &v, &mut forces).unwrap();
        let (by_matrix, ..) = all(&joined, &u, &v);
        let by_cells = [forces.conservative.to_vec(), forces.dissipative.to_vec()].concat();
        let largest = by_matrix.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        for (a, b) in by_cells.iter().zip(&by_matrix) {
            assert!((a - b).abs() < 1e-13 * largest, "{a} {b}");
        }
    }

    #[test]
    fn selections_know_the_bodies() {
        let joined = Body::join(in_a_plane()).unwrap();
        let mesh = joined.mesh();
        let first = in_a_plane()[0].mesh().node_count();
        let bottom = in_a_plane()[1].mesh().sets()["bottom"].clone();
        let moved: Vec<usize> = bottom.iter().map(|node| first + node).collect();
        assert_eq!(mesh.select(&"rubber/bottom".into()).unwrap(), moved);
        assert_eq!(mesh.select(&"linear".into()).unwrap(), (0..first).collect::<Vec<_>>());
        assert_eq!(mesh.cell_groups()["body 4"].len(), 5);
        assert_eq!(joined.part_of(first).name, "rubber");
        assert_eq!(joined.part_of(first - 1).name, "linear");
        let point = joined.shares_at(&[0.45, 1.0]).unwrap();
        assert!(point.iter().all(|(node, _)| joined.part_of(*node).name == "body 4"));
    }

    #[test]
    fn what_cannot_be_joined_is_named() {
        let plane =
            |name: &str| square(Cells::Triangles, SQUARE_MATERIAL).named(name).build().unwrap();
        let solid = Mesh::cuboid([1.0; 3], [2; 3], SolidCells::Tetrahedra).unwrap();
        let solid = Body::new(solid, SQUARE_MATERIAL).build().unwrap();
        for (bodies, told) in [
            (vec![], "number of bodies = 0"),
            (vec![plane("a"), plane("a")], "name of a body = \"a\" cannot be used: it is taken"),
            (vec![plane("a"), plane("b/c")], "name of a body = \"b/c\""),
            (vec![plane("all"), plane("b")], "name of a body = \"all\""),
            (
                vec![plane("a"), solid],
                "dimension of body \"body 2\" = 3 cannot be used: that of body \"a\" is 2",
            ),
        ] {
            let error = Body::join(bodies).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
    }
}
