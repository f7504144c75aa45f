//! Error of a quantity of an equilibrium by the mesh: dual-weighted residuals.
//!
//! Displacements are transferred to quadratic cells (or halved ones), and the effect of their unbalanced
//! forces on the quantity follows from the dual solution: one factorization
//! (`dynamics/system/at_rest/dual.rs`, refined where K is not symmetric, as pressure on open faces makes it),
//! with the derivative of the reading (`dynamics/simulate/derivative.rs`). Loads on nodes and readings of
//! nodes stay on the original nodes. The number is also the first step of Newton's method; the dual solution
//! gives the cells that it comes from, a second residual after that step the remainder. The equilibrium on
//! the richer mesh is as accurate and takes 12 to 15 factorizations (`docs/notes/studies.md`).

use std::time::Instant;

use super::quantity::Quantity;
use crate::base::input::InputError;
use crate::base::vector::dot;
use crate::dynamics::equilibrium::{Equilibrium, MeshEstimate};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::{Linearized, Moved};
use crate::dynamics::system::ForceBalance;
use crate::elements::basis::Finer;
use crate::integrators::ode::Failure;
use crate::scene::timeline::Scene;

impl MeshEstimate {
    /// Estimates by how much a `quantity` of an equilibrium is off because its mesh is not finer.
    ///
    /// The method is that of dual-weighted residuals (R. Becker, R. Rannacher, *An optimal control approach
    /// to a posteriori error estimation in finite element methods*, Acta Numerica 10, 2001); it costs one
    /// linear problem on a richer mesh.
    ///
    /// The displacements u are interpolated by their shape functions to [quadratic cells](Scene::quadratic),
    /// or to the [halved mesh](Scene::halved) if the cells are quadratic already or have no quadratic kind.
    /// There forces f(u) are left unbalanced; their effect on the quantity J is given by the dual solution z,
    /// the derivative of J with respect to forces:
    ///
    /// ```text
    /// K^T z = dJ/du,   J(richer) - J = z . f(u) + O(|u(richer) - u|^2)
    /// ```
    ///
    /// with the tangent K at u; constraints, and quantities that are constraint forces, add their terms.
    /// Where meshes are nested and integrated exactly (Cauchy strain, but for distorted quadrilaterals and
    /// hexahedra) the part of z that the first mesh can represent is orthogonal to the unbalanced forces
    /// (Galerkin orthogonality), and `cells` add up to the correction.
    ///
    /// In all, z . f is the change of J by the first step of Newton's method on the richer mesh, by one
    /// factorization: in a linear problem this is the whole change, under Green's strain it takes the place
    /// of some 15 factorizations. The error of the richer mesh is not included: for clamped beams of
    /// linear triangles and tetrahedra the correction was 0.92 to 1 times the true error, for halved
    /// quadratic triangles 0.7 (the clamped corners are singular), for hexahedra 0.89 to 0.97. Displacements
    /// under forces on single nodes have no limit on finer meshes: the position of such a node is not a
    /// suitable quantity.
    ///
    /// Under Green's strain the remainder is large if a body bends far on a mesh that is much too stiff. Its
    /// leading part is `remainder`, and the estimate is [reliable](Self::is_reliable) if that is no larger
    /// than the correction: then the correction was 0.96 to 1.09 times the difference to the equilibrium on
    /// the richer mesh. Where the estimate was not reliable, on beams too stiff by 10 to 60 %, the correction
    /// was 1.07 to 1.42 times that difference; it was less than a tenth on a beam bent by half its length
    /// whose triangles also lock.
    ///
    /// All smooth forces are covered. Contact stays with the nodes that touch at u: what comes into contact
    /// on the richer mesh is not seen.
    ///
    /// | quantity | on the richer mesh |
    /// | --- | --- |
    /// | positions and displacements, distances, angles between lines | of the nodes that there were |
    /// | centre of mass, volume of a chamber | of all nodes |
    /// | force of constraints on nodes | on all nodes that are held in their place |
    ///
    /// ```
    /// use pliant::study::Quantity;
    /// use pliant::{Body, Cells, Material, Mesh, MeshEstimate, Phase, Scene, Statics, Strain};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 4.0 };
    /// let beam = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Cauchy).build()?;
    /// let scene = Scene::new(beam).phase(Phase::until(1.0).hold("left").load_total("right", [0.0, -0.1]));
    /// let found = scene.equilibrium(&Statics::default())?;
    /// let estimate = MeshEstimate::of(&found, &Quantity::named("right.y", &scene, &[])?)?;
    /// // such triangles are far too stiff: the beam sinks almost twice as far
    /// assert!(estimate.correction < 0.7 * estimate.change && estimate.is_reliable());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`check`](Self::check); a body that nothing holds; an equilibrium on the verge of stability, the
    /// tangent of which cannot be inverted.
    pub fn of(equilibrium: &Equilibrium, quantity: &Quantity) -> Result<Self, Error> {
        let clock = Instant::now();
        let trajectory = equilibrium.trajectory();
        let (scene, sample) = (trajectory.scene(), equilibrium.sample());
        let refused = |value: &str, help: &str| {
            let value = format!("\"{quantity}\" {value}");
            Error::from(InputError::new("quantity of a mesh estimate", value, help))
        };
        let reading = quantity.of_equilibrium(scene)?;
        if !equilibrium.removed.is_empty() {
            return Err(refused(
                "of a body that nothing holds",
                "hold it so that it cannot move as a whole",
            ));
        }
        let (richer, finer) = scene.enriched()?;
        let u = finer.interpolated(&sample.u, scene.body().dimension());
        let mut rest = richer.at_rest_in(sample.phase)?;
        let rows = rest.system().rows().to_vec();
        let mut balance = ForceBalance::zeros(u.len());
        rest.evaluate(1.0, &u, &mut balance).map_err(|failure| {
            let reason = match failure {
                Failure::Recoverable(reason) => reason,
                Failure::Fatal(error) => error.to_string(),
            };
            refused(&format!("on a richer mesh ({reason})"), "take a finer mesh from the start")
        })?;
        let moved = Moved { scene: &richer, finer: Some(&finer), rows: &rows, u: &u };
        let Linearized { value: there, by_displacements, by_multipliers } =
            reading.linearized(scene, sample, &moved)?;
        if !by_displacements.iter().chain(&by_multipliers).all(|x| x.is_finite()) {
            return Err(refused(
                "in a place where it has no derivative",
                "ask for another component",
            ));
        }
        let Some([z, nu]) = rest.dual(&u, [&by_displacements, &by_multipliers]) else {
            let help =
                "hold it so that it cannot move as a whole, load it less, or take a finer mesh";
            return Err(refused("with a tangent that cannot be inverted on a richer mesh", help));
        };
        let mut lacking = vec![0.0; rows.len()];
        rest.lacking(1.0, &u, &mut lacking);
        let weighted = |f: &[f64], lacking: &[f64]| dot(&z, f) - dot(&nu, lacking);
        let value = reading.at(scene, sample)?;
        // for constraint forces this is the whole force, not a change
        let is_force = by_multipliers.iter().any(|derivative| *derivative != 0.0);
        let correction =
            weighted(&balance.total, &lacking) - if is_force { value } else { value - there };
        let cells = contributions(&richer, &finer, &z, &balance.total);
        let (mut stepped, mut mu) = (u.clone(), nu.clone());
        let mut remainder = f64::INFINITY;
        if rest.solve_exactly([&balance.total, &lacking], &mut stepped, &mut mu) {
            stepped.iter_mut().zip(&u).for_each(|(x, u)| *x += u);
            rest.lacking(1.0, &stepped, &mut lacking);
            if rest.evaluate(1.0, &stepped, &mut balance).is_ok() {
                let known = if is_force { value + correction } else { 0.0 };
                remainder = weighted(&balance.total, &lacking) - known;
            }
        }
        let change = value - reading.at(scene, &trajectory.samples()[0])?;
        Ok(Self {
            quantity: quantity.to_string(),
            unit: quantity.unit().into(),
            value,
            change,
            correction,
            remainder,
            cells,
            unknowns: u.len(),
            seconds: clock.elapsed().as_secs_f64(),
        })
    }

    /// Checks that the error of a `quantity` can be estimated on equilibria of `scene`, before there is one.
    ///
    /// # Errors
    /// A quantity that is no single number, or none of the table above; a scene that cannot be on a finer
    /// mesh.
    pub fn check(scene: &Scene, quantity: &Quantity) -> Result<(), InputError> {
        quantity.of_equilibrium(scene)?;
        scene.enriched().map(|_| ())
    }
}

/// Contribution of the new nodes to z . f, cell by cell of the first mesh: their forces `f` times the part of
/// `z` that the first mesh does not have, in equal parts for the cells around a node.
fn contributions(richer: &Scene, finer: &Finer, z: &[f64], f: &[f64]) -> Vec<f64> {
    let d = richer.body().dimension();
    let old = finer.new_nodes().start;
    let mut coarse = z[..old * d].to_vec();
    coarse.extend_from_slice(&z[finer.new_nodes().end * d..]);
    let coarse = finer.interpolated(&coarse, d);
    let new_nodes_of = |children: &[&[usize]]| {
        let nodes = children.iter().flat_map(|child| child.iter().copied());
        let mut nodes: Vec<usize> = nodes.filter(|&node| node >= old).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let mesh = richer.body().mesh();
    let children: Vec<&[usize]> = mesh.cells().collect();
    let cells =
        (0..finer.old_cell_count()).map(|cell| new_nodes_of(&children[finer.children(cell)]));
    let cells: Vec<Vec<usize>> = cells.collect();
    let mut around = vec![0.0; mesh.node_count()];
    cells.iter().flatten().for_each(|&node| around[node] += 1.0);
    let of_node = |&node: &usize| {
        let dofs = node * d..(node + 1) * d;
        dofs.map(|dof| (z[dof] - coarse[dof]) * f[dof]).sum::<f64>() / around[node]
    };
    cells.iter().map(|nodes| nodes.iter().map(of_node).sum()).collect()
}
