//! Paths that begin away from where their nodes are.

use crate::scene::constraint::ConstraintRow;

/// Paths that begin away from their nodes as a phase begins.
#[derive(Debug, Clone)]
pub(crate) struct Leap {
    /// Name of the phase.
    pub(crate) phase: String,
    /// When it begins (s).
    pub(crate) time: f64,
    /// Number of nodes and axes with such a path, and the farthest of them, in words.
    pub(crate) count: usize,
    pub(crate) row: String,
    /// Position of that node, and beginning of the path (m), both relative to the undeformed position.
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl Leap {
    /// That of the `rows` of a phase which begins at `time` (s) with the displacements `u` (m), if it has paths. Those that are off by
    /// less than `least` (m) do not count.
    pub(crate) fn of(
        rows: &[ConstraintRow],
        phase: &str,
        time: f64,
        (u, dimension): (&[f64], usize),
        least: f64,
    ) -> Option<Self> {
        let along = rows.iter().filter(|row| row.is_placed());
        let ends = along.map(|row| {
            let from: f64 = row.terms.iter().map(|(dof, c)| c * u[*dof]).sum();
            (row, from, row.prescribed(time).displacement)
        });
        let off: Vec<_> = ends.filter(|(_, from, to)| (to - from).abs() > least).collect();
        let farthest = off.iter().max_by(|a, b| (a.2 - a.1).abs().total_cmp(&(b.2 - b.1).abs()));
        farthest.map(|&(row, from, to)| Self {
            phase: phase.to_owned(),
            time,
            count: off.len(),
            row: row.label(dimension),
            from,
            to,
        })
    }

    /// Distance (m) to the path.
    pub(crate) fn by(&self) -> f64 {
        (self.to - self.from).abs()
    }
}
