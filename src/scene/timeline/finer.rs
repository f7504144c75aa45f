//! The same scene on a finer mesh, or with another body.

use std::ops::Range;
use std::sync::Arc;

use super::input::{LoadKind, Quantity, Target};
use super::{Phase, Scene};
use crate::base::input::{InputError, check_memory};
use crate::elements::basis::Finer;
use crate::elements::body::{Body, BodyBuilder, CellSelection, Part};
use crate::elements::mesh::{BYTES_PER_NODE, Mesh, Selection};
use crate::scene::constraint::Constrained;
use crate::scene::forces::{ComponentMap, Obstacle, Touch};

impl Scene {
    /// The same scene with its body built differently: of another material, with another measure of strain,
    /// with other inertia. Nodes and cells stay; a [reduced model](Self::reduced) does not.
    ///
    /// ```
    /// use pliant::{Inertia, Strain, samples};
    ///
    /// let lumped = samples::beam_jump()?.with_body(|body| body.inertia(Inertia::Lumped))?;
    /// lumped.validate()?;
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`BodyBuilder::build`]; another number of nodes.
    pub fn with_body(
        &self,
        change: impl FnOnce(BodyBuilder) -> BodyBuilder,
    ) -> Result<Self, InputError> {
        let body = change(self.body.to_builder()).build()?;
        if body.dofs() != self.body.dofs() {
            let help = format!(
                "the scene's body has {}: only the mesh may not be another",
                self.body.dofs()
            );
            return Err(InputError::new("displacement components of the body", body.dofs(), help));
        }
        // a reduced model is of the body as it was
        Ok(Self { body: Arc::new(body), reduced: None, ..self.clone() })
    }

    /// The same scene with each cell of the mesh divided at the middles of its edges: see [`Mesh::halved`].
    ///
    /// Node sets, and lists of nodes that are held or moved together, are extended by the new nodes between
    /// them. Forces on each node, springs and sensors stay at their nodes. Stiffness and
    /// damping of obstacles per node are divided by the factor by which the number of nodes on the boundary
    /// grows. A [reduced model](Self::reduced) is dropped. Each of several bodies gets a finer mesh, except rigid ones;
    /// node numbers are converted to those of the same nodes in the finer mesh.
    ///
    /// # Errors
    /// Point masses that are named by number, or in addition to several bodies; forces that are not of this crate, as their
    /// nodes are unknown.
    pub fn halved(&self) -> Result<Self, InputError> {
        Ok(self.on(|mesh, _| Ok(mesh.divided()))?.0)
    }

    /// The same scene with quadratic cells: see [`Mesh::quadratic`], and [`halved`](Self::halved) for the
    /// rest of the scene.
    ///
    /// # Errors
    /// As [`halved`](Self::halved); cells of a kind that has no quadratic one.
    pub fn quadratic(&self) -> Result<Self, InputError> {
        Ok(self.on(|mesh, _| mesh.elevated())?.0)
    }

    /// The same scene with these cells of the mesh (counted from 0) divided, and cells around them as far as necessary: see
    /// [`Mesh::halved_in`], [`Mesh::cells_at`], and [`halved`](Self::halved) for the rest of the scene. Obstacles whose stiffness is per
    /// node exert larger forces on finer parts of the boundary than on coarser ones: give it per area
    /// ([`Obstacle::stiffness_density`]).
    ///
    /// # Errors
    /// As [`halved`](Self::halved) and [`Mesh::halved_in`].
    pub fn halved_in(&self, cells: &[usize]) -> Result<Self, InputError> {
        let count = self.body.mesh().cell_count();
        if let Some(cell) = cells.iter().find(|cell| **cell >= count) {
            let help = format!("the mesh has the cells 1 to {count}");
            return Err(InputError::new("cell to be divided", cell + 1, help));
        }
        let bisected = |mesh: &Mesh, all: Range<usize>| {
            let own = cells.iter().filter(|cell| all.contains(cell)).map(|cell| cell - all.start);
            match own.collect::<Vec<_>>() {
                own if own.is_empty() => Ok(Finer::none(mesh)),
                own => mesh.bisected(&own),
            }
        };
        Ok(self.on(bisected)?.0)
    }

    /// The same scene with quadratic triangles or tetrahedra that have bubbles: see [`Mesh::with_bubbles`], and
    /// [`halved`](Self::halved) for the rest of the scene.
    ///
    /// # Errors
    /// As [`halved`](Self::halved); cells of other shapes, or that have bubbles already.
    pub fn with_bubbles(&self) -> Result<Self, InputError> {
        Ok(self.on(|mesh, _| mesh.bubbled())?.0)
    }

    /// The same scene on the next finer mesh, and how its nodes follow from the old ones. Its cells are
    /// quadratic, or halved if they were quadratic before or there are no quadratic ones of their kind.
    #[cfg(feature = "study")]
    pub(crate) fn enriched(&self) -> Result<(Self, Finer), InputError> {
        self.body.single("an estimate by a finer mesh")?;
        self.on(|mesh, _| mesh.elevated().or_else(|_| Ok(mesh.divided())))
    }

    fn on(
        &self,
        make: impl Fn(&Mesh, Range<usize>) -> Result<Finer, InputError>,
    ) -> Result<(Self, Finer), InputError> {
        if !self.forces.is_empty() {
            let help =
                "they refer to the nodes of this mesh only: build the scene on the finer mesh";
            return Err(InputError::new(
                "forces that are not of this crate",
                self.forces.len(),
                help,
            ));
        }
        let grown =
            |part: Part| part.body.mesh().node_count() << part.body.mesh().kind().dimension();
        let nodes: usize = self.body.parts().map(grown).sum();
        let help = "take coarser cells, or halve them less often";
        check_memory(
            "finer mesh",
            format!("{nodes} nodes or so"),
            BYTES_PER_NODE * nodes as f64,
            help,
        )?;
        let (builder, coarse, finer) = self.body.to_builder().finer(make)?;
        let body = builder.build()?;
        let change = Change { body: &self.body, coarse: &coarse, finer: &finer };
        let mut scene = self.clone().unreduced();
        scene.start = change.start(self, &body)?;
        let nodes = |nodes: &Selection| change.extended(nodes);
        let cells = |cells: &CellSelection| cells.on(&coarse, &finer);
        let map = ComponentMap { nodes: &|nodes| change.moved(nodes), cells: &cells, share: 1.0 };
        scene.chambers = each(&self.chambers, |own| own.clone().with_nodes(nodes))?;
        scene.fluids = each(&self.fluids, |own| own.with_nodes(nodes))?;
        scene.devices = each(&self.devices, |own| own.on_finer_mesh(&nodes))?;
        scene.actuators = each(&self.actuators, |own| own.mapped(&map))?;
        scene.magnets = each(&self.magnets, |own| own.with_cells(cells))?;
        scene.ties = each(&self.ties, |own| own.on(&body, nodes))?;
        let count = |mesh: &Mesh| mesh.boundary_nodes().len() as f64;
        let share = count(&coarse) / count(&finer.mesh);
        let shared = |obstacle: &Obstacle| obstacle.clone().shared_out(share);
        scene.obstacles = self.obstacles.iter().map(shared).collect();
        let as_here = |touch: &Touch| Ok(touch.clone().with_numbers_of(&self.force_of(touch)?));
        scene.touches = each(&self.touches, as_here)?;
        for phase in &mut scene.phases {
            change.phase(phase)?;
            phase.redirected = phase.redirected.iter().map(shared).collect();
        }
        scene.body = Arc::new(body);
        Ok((scene, finer))
    }
}

/// The components that `map` makes of others.
fn each<T>(all: &[T], map: impl Fn(&T) -> Result<T, InputError>) -> Result<Vec<T>, InputError> {
    all.iter().map(map).collect()
}

/// Carries selections of nodes over to a finer mesh.
struct Change<'a> {
    body: &'a Body,
    coarse: &'a Mesh,
    finer: &'a Finer,
}

impl Change<'_> {
    /// The new number of a node of the coarse mesh.
    ///
    /// # Errors
    /// A point mass.
    fn number(&self, number: usize) -> Result<usize, InputError> {
        if number > self.coarse.node_count() {
            let help =
                "it is a point mass, which has another number on a finer mesh: name it by its name";
            return Err(InputError::new("node", number, help));
        }
        // 0 is no node, which is told where it is asked for
        Ok(number.checked_sub(1).map_or(0, |node| self.finer.number(node) + 1))
    }

    /// The same nodes by their new numbers; names and boxes include new nodes without a change.
    fn moved(&self, nodes: &Selection) -> Result<Selection, InputError> {
        let Selection::Numbers(numbers) = nodes else { return Ok(nodes.clone()) };
        let moved = numbers.iter().map(|number| self.number(*number));
        Ok(moved.collect::<Result<Vec<_>, _>>()?.into())
    }

    /// Numbers with those of the new nodes between them; names and boxes include these without a change.
    fn extended(&self, nodes: &Selection) -> Result<Selection, InputError> {
        let moved = self.moved(nodes)?;
        let Selection::Numbers(numbers) = nodes else { return Ok(moved) };
        let nodes = self.body.mesh().select(nodes)?;
        if numbers.len() == 1 {
            return Ok(moved);
        }
        let extended = self.finer.extended(&nodes);
        Ok(Selection::of_nodes(extended))
    }

    /// The nodes of the coarse mesh, by number.
    fn same(&self, nodes: &Selection) -> Result<Selection, InputError> {
        self.moved(nodes)?;
        let nodes = self.body.mesh().select(nodes)?;
        if nodes.iter().any(|&node| node >= self.coarse.node_count()) {
            let help = "it holds point masses: give those by themselves";
            return Err(InputError::new(
                "nodes of a force on each",
                format!("{} nodes", nodes.len()),
                help,
            ));
        }
        Ok(nodes.iter().map(|node| self.finer.number(*node) + 1).collect::<Vec<_>>().into())
    }

    fn phase(&self, phase: &mut Phase) -> Result<(), InputError> {
        for constraint in &mut phase.constraints {
            match &mut constraint.what {
                Constrained::Nodes(nodes, _) | Constrained::Along(nodes, _) => {
                    *nodes = self.extended(nodes)?;
                }
                Constrained::Row(terms) => {
                    for (node, ..) in terms {
                        *node = self.number(*node)?;
                    }
                }
            }
        }
        for input in &mut phase.inputs {
            let Target::Nodes(nodes) = &mut input.target else { continue };
            let is_point = self.body.mesh().select(nodes)?.len() == 1;
            *nodes = match input.quantity {
                Quantity::Load(LoadKind::Each) if !is_point => self.same(nodes)?,
                _ => self.extended(nodes)?,
            };
        }
        Ok(())
    }

    /// The start, at all nodes of the finer mesh.
    fn start(&self, scene: &Scene, body: &Body) -> Result<super::start::Start, InputError> {
        scene.start.velocities(self.body)?;
        let mut start = scene.start.clone();
        start.refuse_branches("a finer mesh")?;
        // they have been checked above, for the coarse mesh
        if let Some(state) = &mut start.state {
            Arc::make_mut(state).bodies.clear();
        }
        for field in [&mut start.displacements, &mut start.velocities] {
            *field = self.finer.interpolated(field, body.dimension());
        }
        for (nodes, _) in &mut start.of_nodes {
            *nodes = self.extended(nodes)?;
        }
        Ok(start)
    }
}
