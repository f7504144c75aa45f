//! The same scene without one of its terms.

use std::fmt;
use std::sync::Arc;

use super::Scene;
use super::phase::ContactWith;
use crate::base::input::InputError;
use crate::scene::forces::Obstacle;

/// Something that a scene may be modelled without.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Term {
    /// The acceleration of gravity.
    Gravity,
    /// The viscosity of all materials.
    Viscosity,
    /// Friction and tangential damping of all obstacles.
    Friction,
    /// The obstacle with this name.
    Obstacle(String),
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gravity => f.write_str("gravity"),
            Self::Viscosity => f.write_str("viscosity"),
            Self::Friction => f.write_str("friction"),
            Self::Obstacle(name) => write!(f, "obstacle \"{name}\""),
        }
    }
}

impl Scene {
    /// Terms of this scene that a simplified model may omit.
    pub fn terms(&self) -> Vec<Term> {
        let has_gravity = self.phases.iter().filter_map(|phase| self.gravity_in(phase));
        // by gravity a fluid knows where it is deep
        let is_needed = self.fluids.iter().any(|fluid| fluid.surface().is_some());
        let has_gravity = has_gravity.flatten().any(|g| *g != 0.0) && !is_needed;
        let is_viscous = self.body.materials().any(|material| material.viscosity > 0.0);
        let rubs =
            |obstacle: &Obstacle| obstacle.has_friction() || obstacle.has_tangential_damping();
        let rubs = self.obstacles.iter().any(rubs);
        let all =
            [(has_gravity, Term::Gravity), (is_viscous, Term::Viscosity), (rubs, Term::Friction)];
        let own = all.into_iter().filter(|(is_there, _)| *is_there).map(|(_, term)| term);
        let obstacle = |obstacle: &Obstacle| Term::Obstacle(obstacle.name().to_owned());
        own.chain(self.obstacles.iter().map(obstacle)).collect()
    }

    /// The same scene without a term.
    ///
    /// # Errors
    /// An obstacle that it does not have.
    pub fn without(&self, term: &Term) -> Result<Self, InputError> {
        let mut scene = self.clone();
        match term {
            Term::Gravity => {
                scene.gravity = None;
                scene.phases.iter_mut().for_each(|phase| phase.gravity = None);
            }
            Term::Viscosity => {
                let body = self.body.to_builder().without_viscosity().build()?;
                scene.body = Arc::new(body);
            }
            Term::Friction => {
                let redirected = scene.phases.iter_mut().flat_map(|phase| &mut phase.redirected);
                for obstacle in scene.obstacles.iter_mut().chain(redirected) {
                    *obstacle = obstacle.clone().without_friction();
                }
            }
            Term::Obstacle(name) => {
                scene.obstacles.remove(self.obstacle_number(name, "obstacle")?);
                for phase in &mut scene.phases {
                    phase.redirected.retain(|obstacle| obstacle.name() != name);
                    if let ContactWith::These(names) = &mut phase.contact {
                        names.retain(|other| other != name);
                    }
                }
            }
        }
        Ok(scene)
    }
}
