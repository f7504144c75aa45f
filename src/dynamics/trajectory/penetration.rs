//! Largest depth of the surface of a body in an obstacle, at the end of any step.

/// A depth that a point of the surface may have within an obstacle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthLimit {
    /// m
    pub(crate) depth: f64,
    /// Its source.
    pub(crate) reason: &'static str,
}

impl DepthLimit {
    /// The smaller one.
    pub(crate) fn or(self, other: Self) -> Self {
        if other.depth < self.depth { other } else { self }
    }
}

/// The deepest point relative to its limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deepest {
    /// m
    pub(crate) depth: f64,
    pub(crate) limit: DepthLimit,
    /// When (s), if that is known.
    pub(crate) time: Option<f64>,
    /// Its node, or the first and the last one of the edge or face that it lies on, counted from 0.
    pub(crate) nodes: [usize; 2],
}

impl Deepest {
    /// The depth over its limit.
    pub(crate) fn part(&self) -> f64 {
        self.depth / self.limit.depth
    }

    /// Replaces it by another one that is deeper relative to its limit; returns whether it did.
    pub(crate) fn replace(of: &mut Option<Self>, by: Self) -> bool {
        let is_deeper = by.depth > 0.0 && of.is_none_or(|own| by.part() > own.part());
        if is_deeper {
            *of = Some(by);
        }
        is_deeper
    }
}

/// The depths of a surface in one obstacle, over all steps.
#[derive(Debug, Clone)]
pub(crate) struct Penetration {
    /// Name of the obstacle.
    pub(crate) obstacle: String,
    /// Half the least thickness of the obstacle where it was met (m): infinite for a half-plane or a cavity.
    pub(crate) half_thickness: f64,
    /// The deepest node.
    pub(crate) at_nodes: Option<Deepest>,
    /// The deepest point between nodes.
    pub(crate) between: Option<Deepest>,
    /// Times a point of the surface passed the middle of the obstacle.
    pub(crate) passages: usize,
    /// When that happened first (s), and to a point of which nodes, counted from 0.
    pub(crate) first_passage: Option<(f64, [usize; 2])>,
    /// Estimated factor by which a stiffness would have to be larger to keep all nodes within their limits.
    pub(crate) stiffer: f64,
}

impl Penetration {
    pub(crate) fn none(obstacle: &str) -> Self {
        Self {
            obstacle: obstacle.to_owned(),
            half_thickness: f64::INFINITY,
            at_nodes: None,
            between: None,
            passages: 0,
            first_passage: None,
            stiffer: 1.0,
        }
    }
}
