//! Keys of a scene file, beside the scene that was made of it.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Values by the keys of a scene file that say what happens in the scene. The same for all scenes in their Debug text, as the scene has it all itself.
#[derive(Clone, Default)]
pub(super) struct WrittenKeys(pub(super) Arc<BTreeMap<String, String>>);

impl fmt::Debug for WrittenKeys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("WrittenKeys")
    }
}
