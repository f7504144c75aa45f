//! Magnets, magnetic fields and devices of a scene in its half.
//!
//! The energy of a magnet, -(F b) . B/mu_0, is that of its mirror image where both the remanence b and the field B are mirrored as
//! displacements are, or both with the other sign, as magnetic moments are: currents turn the other way round in a mirror. Either leaves
//! the motion symmetric: a field along the plane with remanences that point to it or away from it on both sides, or a field across the
//! plane with remanences that point across it in the same direction.

use std::sync::Arc;

use super::super::Device;
use super::same::{SAME, Same, times};
use crate::base::input::InputError;
use crate::base::vector::largest;
use crate::elements::mesh::Selection;
use crate::scene::forces::Magnet;

impl Same<'_> {
    /// The magnets of the half.
    ///
    /// # Errors
    /// Magnets or fields that are not symmetric.
    pub(super) fn magnets(&self) -> Result<Vec<Magnet>, InputError> {
        let scene = self.scene;
        if scene.magnets.is_empty() {
            return Ok(Vec::new());
        }
        self.check_magnets(1.0).or_else(|error| self.check_magnets(-1.0).map_err(|_| error))?;
        let mut kept = Vec::new();
        for (number, magnet) in (1..).zip(&scene.magnets) {
            let cells = magnet.cells_in(&scene.body, number)?;
            if cells.iter().any(|&cell| self.map.cells[cell].is_some()) {
                kept.push(magnet.with_cells(|cells| self.selected_cells(cells))?);
            }
        }
        Ok(kept)
    }

    /// Checks that remanences and fields are those of their images, which have this `sign` besides.
    fn check_magnets(&self, sign: f64) -> Result<(), InputError> {
        let (scene, d, axis) = (self.scene, self.scene.body.dimension(), self.map.axis);
        let image = |x: &[f64]| -> Vec<f64> {
            let factor = |i: usize| if i == axis { -sign } else { sign };
            x.iter().enumerate().map(|(i, x)| factor(i) * x).collect()
        };
        let are_same = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).all(|(x, y)| (x - y).abs() <= SAME * largest(a).max(largest(b)))
        };
        let mut remanences = vec![vec![0.0; d]; scene.body.mesh().cell_count()];
        for (number, magnet) in (1..).zip(&scene.magnets) {
            for cell in magnet.cells_in(&scene.body, number)? {
                remanences[cell].iter_mut().zip(magnet.remanence()).for_each(|(sum, b)| *sum += b);
            }
        }
        let is_even = |a: usize, b: usize| remanences[a] == remanences[b];
        for [cell, other] in self.cell_pairs(is_even, "several remanences")? {
            if !are_same(&image(&remanences[cell]), &remanences[other]) {
                return Err(self.refused("remanence of cell", (cell + 1).to_string()));
            }
        }
        let mirrored = |x: &[f64]| {
            let mut x = x.to_vec();
            x[axis] = 2.0 * self.map.ends[0] - x[axis];
            x
        };
        // a field with a uniform gradient is known by its values at so many points
        let point = |i: usize| {
            let mut x = vec![0.0; d];
            x.iter_mut().skip(i).take(1).for_each(|x| *x = scene.body.size());
            x
        };
        let points: Vec<Vec<f64>> = (0..=d).map(point).collect();
        for (phase, start) in self.phase_starts() {
            let Some(field) = phase.field() else { continue };
            let differs = |t: &f64| {
                let is_off =
                    |x: &Vec<f64>| !are_same(&image(&field.at(*t, x)), &field.at(*t, &mirrored(x)));
                points.iter().any(is_off)
            };
            if times(phase, start).iter().any(differs) {
                let value = format!("of phase \"{}\"", phase.name);
                return Err(self.refused("magnetic field", value));
            }
        }
        Ok(())
    }

    /// The devices of the half, which are their own mirror images.
    ///
    /// # Errors
    /// One whose nodes are not, whose input points across the plane, or that does not know its half.
    pub(super) fn devices(&self) -> Result<Vec<Arc<dyn Device>>, InputError> {
        let (scene, mesh) = (self.scene, self.scene.body.mesh());
        let (u, v) = (scene.initial_displacements(), scene.initial_velocities()?);
        let mut own = Vec::new();
        for device in &scene.devices {
            let refused = |value: String| {
                let input = format!("{} \"{}\"", device.kind(), device.name());
                self.refused(input, value)
            };
            let nodes = |selection: &Selection| {
                let mut nodes = mesh.select(selection)?;
                nodes.sort_unstable();
                match self.map.images_of(&nodes).is_some_and(|images| images == nodes) {
                    true => self.selected(selection),
                    false => Err(refused(format!("on {selection}"))),
                }
            };
            own.push(device.in_half(&nodes)?);
            for (phase, start) in self.phase_starts() {
                for (number, input) in device.inputs().iter().enumerate() {
                    let is_off = |t: &f64| {
                        let now = scene.device_state(&**device, phase, *t, [u, &v]).input(number);
                        input.is_vector && now[self.map.axis].abs() > SAME * largest(&now)
                    };
                    if times(phase, start).iter().any(is_off) {
                        let word = input.word;
                        return Err(refused(format!("its {word} in phase \"{}\"", phase.name)));
                    }
                }
            }
        }
        Ok(own)
    }
}
