//! The derivative of a reading of an equilibrium, by the dual of its equations.
//!
//! With the rows A^T u = b, the forces f and the multipliers mu, an equilibrium has f(u) + A mu = 0. The dual solution
//! (`dynamics/system/at_rest/dual.rs`) of a reading J,
//!
//! ```text
//! K^T z - A nu = dJ/du,   A^T z = -dJ/dmu
//! ```
//!
//! makes J + z . (f + A mu) - nu . (b - A^T u) stationary in u and mu, so that its change with a number of the scene, in the same u and mu, is
//! that of J: one factorization for all numbers, and for each of them forces in one state.

use crate::base::vector::{dot, largest};
use crate::dynamics::equilibrium::Equilibrium;
use crate::dynamics::phase::Failed;
use crate::dynamics::simulate::{Linearized, Moved};
use crate::dynamics::system::{AtRest, ForceBalance};
use crate::dynamics::trajectory::Sample;
use crate::integrators::ode::Failure;
use crate::io::scene_file::SceneFile;
use crate::studies::work_precision::Quantity;

/// Error of the tangent, as a part of it, that its comparison with differences cannot tell from none, and the part of the body's size by which
/// displacements differ there.
const EXACT: f64 = 1e-5;
const BESIDE: f64 = 1e-5;

/// An equilibrium with the dual solution of a reading.
pub(super) struct Balanced {
    sample: Sample,
    z: Vec<f64>,
    nu: Vec<f64>,
}

impl Balanced {
    /// # Errors
    /// Reason for a missing dual solution.
    pub(super) fn new(found: &Equilibrium, quantity: &Quantity) -> Result<Self, Failed> {
        let (scene, sample) = (found.trajectory().scene(), found.sample().clone());
        if !found.removed.is_empty() {
            return Err("nothing holds the body".into());
        }
        let reading = quantity.of_equilibrium(scene).map_err(|_| {
            let kinds = "positions, displacements, distances, angles between lines, centres of mass, volumes of chambers and constraint forces";
            format!("equilibria are linearized for {kinds}")
        })?;
        let mut rest = scene.at_rest_in(sample.phase)?;
        let rows = rest.system().rows().to_vec();
        let here = Moved { scene, finer: None, rows: &rows, u: &sample.u };
        let Linearized { by_displacements, by_multipliers, .. } =
            reading.linearized(scene, &sample, &here)?;
        if !by_displacements.iter().chain(&by_multipliers).all(|x| x.is_finite()) {
            return Err("the reading has no derivative there".into());
        }
        let [z, nu] = rest
            .dual(&sample.u, [&by_displacements, &by_multipliers])
            .ok_or("the tangent at the equilibrium cannot be inverted")?;
        let off = tangent_error(&mut rest, &sample.u, &z, scene.body().size());
        match off.map_err(Failure::into_error)? {
            off if off <= EXACT => Ok(Self { sample, z, nu }),
            off => Err(format!("the tangent of its forces is off by {off:.0e} of it").into()),
        }
    }

    /// The function that is stationary, in this equilibrium, of a scene with another number.
    ///
    /// # Errors
    /// Another number of unknowns; a scene that cannot be in these displacements.
    pub(super) fn lagrangian(&self, file: &SceneFile, quantity: &Quantity) -> Result<f64, Failed> {
        let Self { sample, z, nu } = self;
        let scene = &file.scene;
        let mut rest = scene.at_rest_in(sample.phase)?;
        if rest.system().dofs() != z.len() || rest.system().rows().len() != nu.len() {
            return Err("the scenes have different unknowns".into());
        }
        let mut balance = ForceBalance::zeros(z.len());
        rest.evaluate(1.0, &sample.u, &mut balance).map_err(Failure::into_error)?;
        rest.system().add_rows(1.0, &sample.multipliers, &mut balance.total);
        let mut lacking = vec![0.0; nu.len()];
        rest.lacking(1.0, &sample.u, &mut lacking);
        let value = quantity.of_equilibrium(scene)?.at(scene, sample)?;
        Ok(value + dot(z, &balance.total) - dot(nu, &lacking))
    }
}

/// The error of the last tangent along `z` at the displacements `u` of a body of this `size`, as a part of it.
fn tangent_error(rest: &mut AtRest, u: &[f64], z: &[f64], size: f64) -> Result<f64, Failure> {
    let step = BESIDE * size / largest(z);
    if !step.is_finite() {
        return Ok(0.0);
    }
    let mut balance = ForceBalance::zeros(u.len());
    let mut resisted = |by: f64| -> Result<f64, Failure> {
        let moved: Vec<f64> = u.iter().zip(z).map(|(u, z)| u + by * z).collect();
        rest.evaluate(1.0, &moved, &mut balance)?;
        Ok(-dot(z, &balance.total))
    };
    let by_differences = (resisted(step)? - resisted(-step)?) / (2.0 * step);
    let mut product = vec![0.0; z.len()];
    rest.tangent().add_product(1.0, z, &mut product);
    let by_tangent = dot(z, &product);
    Ok((by_differences / by_tangent - 1.0).abs())
}
