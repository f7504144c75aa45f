//! Bodies of a scene in its half: each is its own mirror image, or that of another one of which one is left.
//!
//! Ties keep the rows of the nodes on this side, so that nodes follow the same ones as in the whole. Touches keep the numbers that they
//! have in the whole; what would touch its mirror image through the plane is refused, but for a body that the plane cuts: of that the
//! half sees what lies on this side.

use std::sync::Arc;

use super::super::tie::Tie;
use super::same::{SAME, Same};
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::elements::body::Part;
use crate::elements::material::{FibreDirection, Fibres, Substance};
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Axis, Constrained, Constraint};
use crate::scene::forces::{Touch, way};

impl<'s> Same<'s> {
    /// Bodies have the options and materials of their images, and their mass does not come from numbers where the plane cuts them.
    pub(super) fn check_bodies(&self) -> Result<(), InputError> {
        let body = &self.scene.body;
        for part in body.parts() {
            let image = self.image_of_body(&part);
            let kinds = [&part, &image].map(|of| (of.body.mesh().kind(), of.cells.len()));
            if part.body.likeness() != image.body.likeness() || kinds[0] != kinds[1] {
                let input = format!("body \"{}\"", part.name);
                return Err(self.refused(input, format!("not made as \"{}\"", image.name)));
            }
            let is_cut = !self.map.is_section() && part.nodes == image.nodes;
            let has_mass = part.body.substances().any(|made_of| made_of.mass.is_some());
            if is_cut && (has_mass || part.body.mesh().is_surface()) {
                let help = "the plane of symmetry cuts it, and half of a mass that is given, or of what a closed surface bounds, is not known: give it cells and \
                            a density, or leave the scene whole";
                return Err(InputError::new("body", format!("\"{}\"", part.name), help));
            }
        }
        let made_of = body.substances_of_cells();
        let pairs = self.cell_pairs(|a, b| made_of[a] == made_of[b], "several materials")?;
        match pairs.iter().find(|[cell, image]| !self.are_images(made_of[*cell], made_of[*image])) {
            Some([cell, _]) => Err(self.refused("material of cell", (cell + 1).to_string())),
            None => Ok(()),
        }
    }

    /// Cells with their images: one of each body that is the same everywhere, as its image is, and all of others, which are of `several`.
    pub(super) fn cell_pairs(
        &self,
        is_same: impl Fn(usize, usize) -> bool,
        several: &str,
    ) -> Result<Vec<[usize; 2]>, InputError> {
        let mut pairs = Vec::new();
        for part in self.scene.body.parts() {
            let image = self.image_of_body(&part);
            let is_even = |of: &Part| of.cells.clone().all(|cell| is_same(cell, of.cells.start));
            if is_even(&part) && is_even(&image) {
                pairs.push([part.cells.start, image.cells.start]);
                continue;
            }
            let of_cells = part.cells.map(|cell| Some([cell, self.map.cell_images[cell]?]));
            let of_cells = of_cells.collect::<Option<Vec<_>>>();
            pairs.extend(of_cells.ok_or_else(|| self.refused("cells", format!("of {several}")))?);
        }
        Ok(pairs)
    }

    /// Whether a substance is the image of another one: fibres run in the mirrored directions.
    fn are_images(&self, own: &Substance, image: &Substance) -> bool {
        let without_fibres = |of: &Substance| Substance { fibres: Vec::new(), ..of.clone() };
        let count = |of: &Fibres, course: &FibreDirection, all: &[Fibres]| {
            let is_same = |other: &&Fibres| {
                let numbers = [course, &other.course].map(FibreDirection::numbers);
                let far = numbers[0].iter().zip(&numbers[1]).map(|(a, b)| (a - b).abs());
                (of.young, of.stiffening) == (other.young, other.stiffening)
                    && numbers[0].len() == numbers[1].len()
                    && far.fold(0.0, f64::max) <= SAME
            };
            all.iter().filter(is_same).count()
        };
        let has_image = |of: &Fibres| {
            let mirrored = of.course.mirrored(self.map.axis, self.map.ends[0]);
            count(of, &of.course, &own.fibres) == count(of, &mirrored, &image.fibres)
        };
        without_fibres(own) == without_fibres(image)
            && own.fibres.len() == image.fibres.len()
            && own.fibres.iter().all(has_image)
    }

    /// Point masses of halves have those of their images.
    pub(super) fn check_point_masses(&self) -> Result<(), InputError> {
        let (masses, points) = (self.scene.body.nodal_masses(), self.scene.body.point_nodes());
        let is_off = |node: &&usize| {
            let off = (masses[**node] - masses[self.map.images[**node]]).abs();
            !self.map.is_section() && off > SAME * masses[**node]
        };
        match points.iter().find(is_off) {
            Some(node) => Err(self.refused("point masses", format!("of node {}", node + 1))),
            None => Ok(()),
        }
    }

    /// The ties that the half has.
    ///
    /// # Errors
    /// One without a mirror image, or from one side to the other.
    pub(super) fn ties(&self) -> Result<Vec<Tie>, InputError> {
        let (scene, map) = (self.scene, self.map);
        let nodes_of = |tie: &Tie| Ok(distinct(scene.body.mesh().select(&tie.nodes)?));
        let mut kept = Vec::new();
        for tie in &scene.ties {
            let (nodes, to) = (nodes_of(tie)?, scene.body.part_named(&tie.to, "body of a tie")?);
            let (image, mut has_image) = (map.images_of(&nodes), false);
            for other in &scene.ties {
                has_image |= other.to == self.image_of_body(&to).name
                    && image.as_ref() == Some(&nodes_of(other)?);
            }
            let input = format!("tie to \"{}\"", tie.to);
            if !has_image {
                return Err(self.refused(input, tie.nodes.to_string()));
            }
            let own: Vec<usize> = nodes.iter().filter_map(|&node| map.numbers[node]).collect();
            if own.is_empty() {
                continue;
            }
            if self.side(&to) == Side::Other {
                let help =
                    "it glues bodies on both sides of the plane of symmetry: leave the scene whole";
                return Err(InputError::new(input, tie.nodes.to_string(), help));
            }
            let constraints = tie.constraints.as_ref().map_err(Clone::clone)?;
            let rows: Arc<[Constraint]> =
                constraints.iter().filter_map(|row| self.tied(row)).collect();
            let (nodes, to) = (Selection::of_nodes(own), tie.to.clone());
            kept.push(Tie { nodes, to, constraints: Ok(rows) });
        }
        Ok(kept)
    }

    /// The row of a tied node in the half: none of one on the other side, or across the plane in which the node stays.
    fn tied(&self, row: &Constraint) -> Option<Constraint> {
        let (map, across) = (self.map, Axis::all(3)[self.map.axis]);
        let Constrained::Row(terms) = &row.what else { return None };
        let &(node, axis, _) = terms.first()?;
        map.numbers[node - 1]?;
        if map.is_on_plane(node - 1) && axis == across {
            return None;
        }
        let own = terms.iter().map(|&(node, axis, share)| {
            let is_image = map.numbers[node - 1].is_none() && axis == across;
            (map.number(node - 1) + 1, axis, if is_image { -share } else { share })
        });
        Some(Constraint { what: Constrained::Row(own.collect()), how: row.how.clone() })
    }

    /// The touches that the half has.
    ///
    /// # Errors
    /// One without a mirror image, or of bodies on both sides of the plane.
    pub(super) fn touches(&self) -> Result<Vec<Touch>, InputError> {
        let (scene, body) = (self.scene, &self.scene.body);
        let (v, mut kept) = (scene.initial_velocities()?, Vec::new());
        for touch in &scene.touches {
            let told = format!("\"{}\"", touch.name());
            let is_image = |other: &&Touch| {
                let has_image = |part: Part| {
                    touch.is_of(part.name) == other.is_of(self.image_of_body(&part).name)
                };
                other.likeness() == touch.likeness() && body.parts().all(has_image)
            };
            if !scene.touches.iter().any(|other| is_image(&other)) {
                return Err(self.refused("touch", told));
            }
            let parts = body.parts().filter(|part| touch.is_of(part.name));
            let sides: Vec<Side> = parts.map(|part| self.side(&part)).collect();
            let [has_own, has_other] = [Side::Own, Side::Other].map(|side| sides.contains(&side));
            if has_own && has_other {
                let help = "bodies on both sides of the plane of symmetry would touch through it: let those on each side touch by a touch of its own \
                            (`bodies`), or leave the scene whole";
                return Err(InputError::new("touch", told, help));
            }
            if has_other {
                continue;
            }
            let own = touch.clone().with_numbers_of(&scene.force_of(touch)?);
            let speed = touch.sticks_below(way(body, &v));
            kept.push(speed.into_iter().fold(own, Touch::sticking_speed));
        }
        Ok(kept)
    }

    fn image_of_body(&self, part: &Part) -> Part<'s> {
        self.scene.body.part_of(self.map.images[part.nodes.start])
    }

    /// Position of a body.
    fn side(&self, part: &Part) -> Side {
        let is_cut = self.image_of_body(part).nodes == part.nodes;
        match self.map.numbers[part.nodes.start] {
            _ if is_cut => Side::Both,
            Some(_) => Side::Own,
            None => Side::Other,
        }
    }
}

/// The side of a plane of symmetry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// That of the half.
    Own,
    /// That which is left out.
    Other,
    /// The plane cuts the body.
    Both,
}
