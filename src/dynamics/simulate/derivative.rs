//! Derivatives of readings of an equilibrium by displacements and constraint forces, on its own mesh or on a richer one.

use std::f64::consts::TAU;

use super::component::Component;
use super::output::Value;
use super::outputs::VOLUME;
use super::reading::{Reading, ReadingKind};
use super::spot::{At, Spot};
use super::view::{Gauges, View, mean};
use crate::base::input::InputError;
use crate::base::vector::{cross, dot, norm};
use crate::dynamics::trajectory::Sample;
use crate::elements::basis::Finer;
use crate::elements::mesh::Selection;
use crate::scene::constraint::ConstraintRow;
use crate::scene::timeline::Scene;

/// A reading of an equilibrium, at the same displacements on its own mesh or on a richer one, to first order.
pub(crate) struct Linearized {
    /// Its value there.
    pub(crate) value: f64,
    /// Its derivative by the displacements.
    pub(crate) by_displacements: Vec<f64>,
    /// Its derivative by the constraint forces, one per row. One of the two vanishes.
    pub(crate) by_multipliers: Vec<f64>,
}

/// An equilibrium on the mesh where its reading is linearized.
pub(crate) struct Moved<'a> {
    /// The scene there.
    pub(crate) scene: &'a Scene,
    /// The numbers of the nodes there; none on its own mesh.
    pub(crate) finer: Option<&'a Finer>,
    /// The rows of its constraints.
    pub(crate) rows: &'a [ConstraintRow],
    /// The displacements there.
    pub(crate) u: &'a [f64],
}

impl Moved<'_> {
    /// The number there of a node.
    fn number(&self, node: usize) -> usize {
        self.finer.map_or(node, |finer| finer.number(node))
    }
}

impl Reading {
    /// Its value at a `sample` of `scene`: the first component if it has several.
    ///
    /// # Errors
    /// A quantity that the scene does not have.
    pub(crate) fn at(&self, scene: &Scene, sample: &Sample) -> Result<f64, InputError> {
        let first = self.components(scene.body().dimension())?.first().copied();
        Ok(self.value_at(scene, sample)?.part(first.unwrap_or(Component::X)))
    }

    fn value_at(&self, scene: &Scene, sample: &Sample) -> Result<Value, InputError> {
        let gauge = self.gauge(scene)?;
        let gauges = Gauges::new(scene)?;
        let phase = &scene.phases()[sample.phase];
        Ok(gauge(&View::of_sample((scene, &gauges), phase, sample), sample))
    }

    /// Whether [`linearized`](Self::linearized) can compute its derivative.
    pub(crate) fn has_derivative(&self) -> bool {
        match &self.what {
            ReadingKind::Position(spot) | ReadingKind::Displacement(spot) => {
                !matches!(spot.0, At::Marker(..))
            }
            ReadingKind::CentreOfMass | ReadingKind::Distance(_) | ReadingKind::Angle(_) => true,
            ReadingKind::ConstraintForce(_) => true,
            ReadingKind::Of(output, _) => **output == VOLUME,
            _ => false,
        }
    }

    /// This reading of `sample`, an equilibrium of `scene`, where that was moved to. Its meaning is the same: nodes
    /// are the original ones; a centre of mass, a volume and the force on what is held are those of the body,
    /// whatever its nodes.
    ///
    /// Where it has no derivative (a length of 0), the derivative is NaN.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub(crate) fn linearized(
        &self,
        scene: &Scene,
        sample: &Sample,
        moved: &Moved,
    ) -> Result<Linearized, InputError> {
        let body = moved.scene.body();
        let (mesh, d) = (scene.body().mesh(), body.dimension());
        let mut linearized = Linearized {
            value: self.at(scene, sample)?,
            by_displacements: vec![0.0; moved.u.len()],
            by_multipliers: vec![0.0; moved.rows.len()],
        };
        let by_displacements = &mut linearized.by_displacements;
        // `along` times the mean displacement of nodes
        let mut add_mean = |nodes: &[usize], along: [f64; 3]| {
            for &node in nodes {
                let dofs = by_displacements[moved.number(node) * d..].iter_mut().take(d);
                dofs.zip(along).for_each(|(dof, along)| *dof += along / nodes.len() as f64);
            }
        };
        let select = |nodes: &Selection| mesh.select(nodes);
        let middle = |nodes: &[usize]| {
            let (x, u) = (mean(nodes, mesh.positions(), d), mean(nodes, &sample.u, d));
            std::array::from_fn(|i| x[i] + u[i])
        };
        let between = |[from, to]: [&[usize]; 2]| -> [f64; 3] {
            let (from, to): ([f64; 3], [f64; 3]) = (middle(from), middle(to));
            std::array::from_fn(|i| to[i] - from[i])
        };
        match &self.what {
            ReadingKind::Position(Spot(At::Inside(place)))
            | ReadingKind::Displacement(Spot(At::Inside(place))) => {
                let along = self.direction(scene, sample)?;
                for (node, share) in body.shares_at(place)? {
                    let dofs = linearized.by_displacements[node * d..].iter_mut().take(d);
                    dofs.zip(along).for_each(|(dof, along)| *dof += share * along);
                }
            }
            ReadingKind::Position(Spot(At::Nodes(nodes)))
            | ReadingKind::Displacement(Spot(At::Nodes(nodes))) => {
                add_mean(&self.counted(select(nodes)?), self.direction(scene, sample)?);
            }
            ReadingKind::Distance([from, to]) => {
                let (from, to) = (select(from)?, select(to)?);
                let along = between([&from, &to]);
                let along = along.map(|x| x / norm(&along));
                add_mean(&to, along);
                add_mean(&from, along.map(|x| -x));
            }
            ReadingKind::Angle(lines) => {
                let [one, other] = lines;
                let lines = [
                    [select(&one[0])?, select(&one[1])?],
                    [select(&other[0])?, select(&other[1])?],
                ];
                let [a, b] = lines.each_ref().map(|[from, to]| between([from, to]));
                let normal = if d == 2 { [0.0, 0.0, 1.0] } else { cross(&a, &b) };
                let normal = normal.map(|x| x / norm(&normal));
                // each end turns its line about the normal
                let in_turn = self.full_turn() / TAU;
                for (sign, line, [from, to]) in [(-in_turn, a, &lines[0]), (in_turn, b, &lines[1])]
                {
                    let along = cross(&normal, &line).map(|x| sign * x / dot(&line, &line));
                    add_mean(to, along);
                    add_mean(from, along.map(|x| -x));
                }
            }
            ReadingKind::CentreOfMass => {
                let (along, mass) = (self.direction(scene, sample)?, body.mass());
                let dofs = linearized.by_displacements.chunks_exact_mut(d);
                for (dofs, nodal) in dofs.zip(body.nodal_masses()) {
                    dofs.iter_mut().zip(along).for_each(|(dof, along)| *dof = along * nodal / mass);
                }
            }
            ReadingKind::Of(output, name) if **output == VOLUME => {
                let chamber = &moved.scene.chambers()[scene.chamber_number(name, "chamber")?];
                let chamber = chamber.force(body, Vec::new())?;
                linearized.value = chamber.volume(moved.u);
                chamber.add_gradient(1.0, moved.u, &mut linearized.by_displacements);
            }
            ReadingKind::ConstraintForce(nodes) => {
                let along = self.direction(scene, sample)?;
                let mut is_read = vec![false; body.mesh().node_count()];
                let (points, nodes): (Vec<usize>, Vec<usize>) =
                    select(nodes)?.into_iter().partition(|&node| moved.number(node) != node);
                let points = points.into_iter().map(|node| moved.number(node));
                let nodes = moved.finer.map_or(nodes.clone(), |finer| finer.extended(&nodes));
                let nodes = nodes.into_iter().chain(points);
                nodes.for_each(|node| is_read[node] = true);
                for (row, derivative) in moved.rows.iter().zip(&mut linearized.by_multipliers) {
                    let read = row.terms.iter().filter(|(dof, _)| is_read[dof / d]);
                    *derivative = read.map(|(dof, c)| c * along[dof % d]).sum();
                }
            }
            _ => debug_assert!(!self.has_derivative()),
        }
        Ok(linearized)
    }

    /// The direction along which a vector is read: the derivative of its component.
    fn direction(&self, scene: &Scene, sample: &Sample) -> Result<[f64; 3], InputError> {
        Ok(match (self.component, self.value_at(scene, sample)?) {
            (Some(Component::X), _) => [1.0, 0.0, 0.0],
            (Some(Component::Y), _) => [0.0, 1.0, 0.0],
            (Some(Component::Z), _) => [0.0, 0.0, 1.0],
            (Some(Component::Norm), Value::Vector(x)) => x.map(|component| component / norm(&x)),
            // a body on a line
            _ => [1.0, 0.0, 0.0],
        })
    }
}
