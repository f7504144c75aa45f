//! What a scene file says, beside the scene that was made of it.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// What a scene file says happens in the scene, by its keys. The same for all scenes in their Debug text, as the scene has it all itself.
#[derive(Clone, Default)]
pub(super) struct WrittenKeys(pub(super) Arc<BTreeMap<String, String>>);

impl fmt::Debug for WrittenKeys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("WrittenKeys")
    }
}
