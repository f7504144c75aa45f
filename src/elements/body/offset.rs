//! Numbers of nodes and entries of a body among others.

/// Position of the nodes of a body among those of several.
#[derive(Debug, Clone, Copy)]
pub(super) struct Offset {
    /// The first node, and the entry in the pattern of all nodes at which its row begins.
    pub(super) node: usize,
    pub(super) entry: usize,
    /// Number of all nodes.
    pub(super) count: usize,
}
