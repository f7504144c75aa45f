//! A node of a rod on the nodes of the mesh.

use super::strain::{Number, Section, Vector};

/// One node of an element.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    /// The nodes of the mesh at its centre and at its directors; in the plane, where d_2 is normal to it, the last is the centre.
    pub(super) nodes: [usize; 3],
    /// Lengths of the arms from the centre to these (m).
    pub(super) arms: [f64; 2],
    /// Undeformed position (m) and directors.
    pub(super) undeformed: Section<f64>,
}

impl End {
    /// Its section, where node `v` of it, component `i`, has moved by `moved(v, i)`, from the undeformed one or from 0.
    pub(super) fn section<T: Number>(
        &self,
        dimension: usize,
        undeformed: bool,
        moved: impl Fn(usize, usize) -> T,
    ) -> Section<T> {
        let zero = [T::from(0.0); 3];
        let from = |vector: Vector<f64>| if undeformed { vector.map(T::from) } else { zero };
        let mut section = Section { x: from(self.undeformed.x), d: self.undeformed.d.map(from) };
        for i in 0..dimension {
            let x = moved(0, i);
            section.x[i] += x;
            for director in 0..dimension - 1 {
                section.d[director][i] +=
                    (moved(director + 1, i) - x) * self.arms[director].recip();
            }
        }
        section
    }

    /// Calls `add` with the forces on its nodes that do the work of those on a section: node `v` of it, component `i`.
    pub(super) fn scatter<T: Number>(
        &self,
        dimension: usize,
        on: &Section<T>,
        mut add: impl FnMut(usize, usize, T),
    ) {
        for i in 0..dimension {
            let mut centre = on.x[i];
            for director in 0..dimension - 1 {
                let force = on.d[director][i] * self.arms[director].recip();
                centre -= force;
                add(director + 1, i, force);
            }
            add(0, i, centre);
        }
    }
}
