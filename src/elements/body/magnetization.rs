//! Magnetized cells of a body.

use super::assembled::Body;
use super::magnetized_points::MagnetizedPoints;
use super::magnets::Magnets;
use super::rod_magnets;
use crate::base::input::InputError;
use crate::base::sparse::NodeMatrix;

impl Body {
    /// A body without magnetization, to which [`magnetize`](Self::magnetize) adds.
    pub(crate) fn without_magnets(&self) -> Magnets {
        let poles = vec![0.0; self.mesh.node_count()];
        Magnets { poles, products: NodeMatrix::zeros(self.inertia.pattern()) }
    }

    /// Adds a `remanence` (T), one component per dimension, in some `cells`, counted from 0.
    ///
    /// # Errors
    /// Cells of a lower dimension than space's across which it has a part.
    pub(crate) fn magnetize(
        &self,
        cells: &[usize],
        remanence: &[f64],
        magnets: &mut Magnets,
    ) -> Result<(), InputError> {
        for own in &self.continua {
            let inside = cells.iter().filter(|cell| own.cells.contains(cell));
            let inside: Vec<usize> = inside.map(|cell| cell - own.cells.start).collect();
            match &own.rod {
                None => own.elements.add_magnets(&inside, remanence, magnets)?,
                Some(rod) => {
                    let strength = (remanence, own.material.density);
                    rod_magnets::add_magnets((rod, &inside), strength, &self.mesh, magnets);
                }
            }
        }
        Ok(())
    }

    /// Adds the points of some `cells`, counted from 0, with a `remanence` (T), one component per dimension, to `points`.
    pub(crate) fn add_magnetized_points(
        &self,
        cells: &[usize],
        remanence: &[f64],
        points: &mut Vec<Box<dyn MagnetizedPoints>>,
    ) {
        for own in &self.continua {
            let inside = cells.iter().filter(|cell| own.cells.contains(cell));
            let inside: Vec<usize> = inside.map(|cell| cell - own.cells.start).collect();
            if !inside.is_empty() {
                let first = own.cells.start;
                let elements = &own.elements;
                points.push(match &own.rod {
                    None => elements.magnetized_points(&self.mesh, first, &inside, remanence),
                    Some(rod) => {
                        let (of, strength) =
                            ((&**rod, &inside[..], first), (remanence, own.material.density));
                        rod_magnets::points(of, strength, &self.mesh, self.inertia.pattern())
                    }
                });
            }
        }
    }
}
