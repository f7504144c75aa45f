//! The nodes that a phase holds or moves, to be marked in pictures.

use crate::base::input::InputError;
use crate::scene::constraint::{Constrained, Constraint, Motion};
use crate::scene::timeline::{Phase, Scene};

/// Role of a node under a constraint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Role {
    Held,
    Moved,
}

impl Scene {
    /// The nodes that a phase constrains, with their constraint.
    pub(crate) fn constrained_nodes(
        &self,
        phase: &Phase,
    ) -> Result<Vec<(usize, Role)>, InputError> {
        let mut nodes = Vec::new();
        for Constraint { what, how } in &phase.constraints {
            let role = match how {
                Motion::Hold | Motion::Together => Role::Held,
                Motion::Velocity(_)
                | Motion::Path(_)
                | Motion::Spline(_)
                | Motion::Formula(_)
                | Motion::Turn(_) => Role::Moved,
            };
            let selected = match what {
                Constrained::Nodes(selection, _) | Constrained::Along(selection, _) => {
                    self.body().mesh().select(selection)?
                }
                Constrained::Row(terms) => terms.iter().map(|(number, ..)| number - 1).collect(),
            };
            nodes.extend(selected.into_iter().map(|node| (node, role)));
        }
        Ok(nodes)
    }
}
