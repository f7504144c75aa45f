//! Common properties of the scenes of one reduced model.

use crate::base::input::InputError;
use crate::scene::timeline::Scene;

/// The part of `other` in which it differs from `one` so that no reduced model is of both, if there is one.
///
/// # Errors
/// Constraints that cannot be used.
pub(super) fn differing_part(one: &Scene, other: &Scene) -> Result<Option<String>, InputError> {
    if one.phases().len() != other.phases().len() {
        return Ok(Some("phases".into()));
    }
    let parts = one.reduced_parts()?;
    let others = other.reduced_parts()?;
    let differing = others.iter().find(|part| !parts.contains(part));
    Ok(differing.map(|(name, _)| name.clone()))
}
