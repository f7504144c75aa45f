//! Forces and moments on one cross section of a rod, which stay as they are or turn with it.

use nalgebra::{Const, SVector};
use num_dual::{DualSVec64, DualVec};

use super::elements::RodElements;
use super::end::End;
use super::strain::{Frame, Number, Section, Vector};
use crate::base::sparse::BlockMatrix;

/// Unknowns of a cross section in space.
const UNKNOWNS: usize = 9;

/// A cross section of a rod, by itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CrossSection {
    pub(super) end: End,
    pub(super) dimension: usize,
}

/// A force (N) and a moment (N m) on a cross section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SectionLoad {
    pub(crate) force: [f64; 3],
    pub(crate) moment: [f64; 3],
    /// Whether both turn with the section, and are given for the undeformed one.
    pub(crate) follows: bool,
}

impl RodElements {
    /// The cross section whose node on the axis has a number.
    pub(crate) fn section_at(&self, node: usize) -> Option<CrossSection> {
        let mut ends = self.elements.iter().flat_map(|element| element.ends);
        let end = ends.find(|end| end.nodes[0] == node)?;
        Some(CrossSection { end, dimension: self.dimension })
    }
}

impl CrossSection {
    /// Its nodes: that of the axis first.
    pub(crate) fn nodes(&self) -> &[usize] {
        &self.end.nodes[..self.dimension]
    }

    /// The load on its nodes: forces on the axis and along the directors.
    fn acting<T: Number>(&self, load: &SectionLoad, at: &Section<T>) -> Section<T> {
        let frame = Frame::of(at.d);
        let given = |vector: Vector<f64>| vector.map(T::from);
        let (mut force, mut moment) = (given(load.force), frame.to_frame(given(load.moment)));
        if load.follows {
            let natural = Frame::of(self.end.undeformed.d);
            force = frame.to_space(given(natural.to_frame(load.force)));
            moment = given(natural.to_frame(load.moment));
        }
        Section { x: force, d: frame.forces(moment) }
    }

    /// Adds the forces (N) of a load at displacements `u` (m).
    pub(crate) fn add_forces(&self, load: &SectionLoad, u: &[f64], forces: &mut [f64]) {
        let (d, nodes) = (self.dimension, self.end.nodes);
        let at = self.end.section(d, true, |v, i| u[nodes[v] * d + i]);
        let on = self.acting(load, &at);
        self.end.scatter(d, &on, |v, i, force| forces[nodes[v] * d + i] += force);
    }

    /// Adds -df/du of a load to `stiffness`.
    pub(crate) fn add_tangents(&self, load: &SectionLoad, u: &[f64], stiffness: &mut BlockMatrix) {
        let (d, nodes) = (self.dimension, self.end.nodes);
        let at = self.end.section(d, true, |v, i| {
            let mut slopes = SVector::<f64, UNKNOWNS>::zeros();
            slopes[v * d + i] = 1.0;
            let slopes = num_dual::Derivative::some(slopes);
            DualVec::new(u[nodes[v] * d + i], slopes) as DualSVec64<UNKNOWNS>
        });
        let on = self.acting(load, &at);
        self.end.scatter(d, &on, |v, i, force| {
            let slopes = force.eps.unwrap_generic(Const::<UNKNOWNS>, Const::<1>);
            for w in 0..d {
                let Some(block) = stiffness.block_mut(nodes[v], nodes[w]) else { continue };
                (0..d).for_each(|j| block[i * d + j] -= slopes[w * d + j]);
            }
        });
    }
}
