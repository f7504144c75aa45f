//! The surface of a rod: points around its cross sections, where it touches and as it is drawn.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::elements::{RodElement, RodElements};
use super::end::End;
use super::section::AROUND;

/// A point that moves with a cross section: nodes with their shares.
pub(crate) type RodPoint = Vec<(usize, f64)>;

/// The surface of a rod as it is drawn.
pub(crate) struct Tube {
    pub(crate) points: Vec<RodPoint>,
    /// The element of each face, and its points, counter-clockwise as seen from outside; in the plane the area of each element.
    pub(crate) faces: Vec<(usize, Vec<usize>)>,
}

/// An element of a round rod, as a straight piece of a tube.
pub(crate) struct TubePiece {
    /// The nodes of the axis at its ends, and their [`Spokes`].
    pub(crate) ends: [(usize, Spokes); 2],
    /// The radii there (m).
    pub(crate) radii: [f64; 2],
    /// Undeformed length, and the width of the tube as it is seen from aside (m).
    pub(crate) length: f64,
    pub(crate) width: f64,
}

/// The directors of a cross section: their nodes, as many as there are, and their arms (m).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spokes {
    pub(crate) count: usize,
    pub(crate) nodes: [usize; 2],
    pub(crate) arms: [f64; 2],
}

/// An element that is bent.
pub(crate) struct Bend {
    /// Its number (from 0), the angle (rad) between its ends, its length and how far its section reaches (m).
    pub(crate) element: usize,
    pub(crate) angle: f64,
    pub(crate) length: f64,
    pub(crate) reach: f64,
}

impl RodElements {
    /// Its pieces as a tube; `None` if its sections are not round. In the plane every section is two sides.
    pub(crate) fn tube_pieces(&self) -> Option<Vec<TubePiece>> {
        let is_plane = self.dimension == 2;
        let is_round = |end: &End| (end.arms[0] - end.arms[1]).abs() <= 1e-9 * end.arms[0];
        let piece = |element: &RodElement| {
            let RodElement { ends, length, .. } = element;
            let has_corners = self.outline.len() != AROUND;
            if !is_plane && (has_corners || !ends.iter().all(is_round)) {
                return None;
            }
            let across = usize::from(is_plane);
            Some(TubePiece {
                ends: ends.map(|end| (end.nodes[0], self.spokes_of(&end))),
                radii: ends.map(|end| end.arms[0]),
                length: *length,
                width: ends[0].arms[across] + ends[1].arms[across],
            })
        };
        self.elements.iter().map(piece).collect()
    }

    fn spokes_of(&self, End { nodes: [_, first, second], arms, .. }: &End) -> Spokes {
        Spokes { count: self.dimension - 1, nodes: [*first, *second], arms: *arms }
    }

    /// The nodes of the axis at the ends of element `number`, with their directors.
    pub(crate) fn spokes(&self, number: usize) -> [(usize, Spokes); 2] {
        self.elements[number].ends.map(|end| (end.nodes[0], self.spokes_of(&end)))
    }

    /// The element whose section reaches farthest beside the radius of its curvature, undeformed.
    pub(crate) fn sharpest_bend(&self) -> Option<Bend> {
        let bend = |(element, own): (usize, &RodElement)| {
            let along = |end: &End| {
                let [first, second] = end.undeformed.d.map(Vector3::from);
                first.cross(&second)
            };
            let arms = own.ends.iter().flat_map(|end| &end.arms[..self.dimension - 1]);
            let reach = arms.fold(0.0, |most: f64, arm| most.max(*arm));
            let angle = along(&own.ends[0]).angle(&along(&own.ends[1]));
            Bend { element, angle, length: own.length, reach }
        };
        let sharp = |bend: &Bend| bend.angle / bend.length * bend.reach;
        let all = self.elements.iter().enumerate().map(bend);
        all.max_by(|a, b| sharp(a).total_cmp(&sharp(b)))
    }

    /// Its length (m), and the largest width of a section (m): twice its reach, or twice its radius of gyration if that is more.
    pub(crate) fn extent(&self) -> [f64; 2] {
        let width = |element: &RodElement| {
            let [area, moments @ ..] = element.mass;
            let is_plane = self.dimension == 2;
            // in the plane it bends about d_2
            let moments = if is_plane { &moments[1..] } else { &moments[..] };
            let gyration = moments.iter().map(|moment| (moment / area).sqrt());
            let reaches = element.ends.iter().flat_map(|end| &end.arms[..self.dimension - 1]);
            2.0 * reaches.copied().chain(gyration).fold(0.0, f64::max)
        };
        let length = self.elements.iter().map(|element| element.length).sum();
        [length, self.elements.iter().map(width).fold(0.0, f64::max)]
    }

    /// The mass of element `number` (kg).
    pub(crate) fn mass(&self, number: usize) -> f64 {
        self.elements[number].mass[0] * self.elements[number].length
    }

    /// Points around its cross sections and between these, in the middle of elements, and the area (m^2) for which each stands.
    pub(crate) fn around(&self) -> impl Iterator<Item = (RodPoint, f64)> {
        let mut lengths: BTreeMap<usize, (End, f64)> = BTreeMap::new();
        for RodElement { ends, length, .. } in &self.elements {
            for end in ends {
                lengths.entry(end.nodes[0]).or_insert((*end, 0.0)).1 += 0.25 * length;
            }
        }
        let at_sections = lengths.into_values().flat_map(move |(end, length)| {
            self.widths([end, end]).map(move |(k, width)| (self.point(&end, k), width * length))
        });
        let between = self.elements.iter().flat_map(move |RodElement { ends, length, .. }| {
            self.widths(*ends).map(move |(k, width)| {
                let both = ends.iter().flat_map(|end| self.point(end, k));
                let halved = both.map(|(node, share)| (node, 0.5 * share)).collect();
                (halved, width * 0.5 * length)
            })
        });
        at_sections.chain(between)
    }

    /// The points around a section in the middle of two, and the width (m) of the surface for which each stands.
    fn widths(&self, ends: [End; 2]) -> impl Iterator<Item = (usize, f64)> {
        let arms = [0, 1].map(|k| 0.5 * (ends[0].arms[k] + ends[1].arms[k]));
        let count = self.outline.len();
        let side = move |k: usize| {
            let [from, to] = [self.outline[k % count], self.outline[(k + 1) % count]];
            (arms[0] * (to[0] - from[0])).hypot(arms[1] * (to[1] - from[1]))
        };
        (0..count).map(move |k| match self.dimension {
            // in the plane the section reaches along d_2 to both sides
            2 => (k, 2.0 * arms[1]),
            _ => (k, 0.5 * (side(k + count - 1) + side(k))),
        })
    }

    /// Its surface with its ends.
    pub(crate) fn tube(&self) -> Tube {
        let count = self.outline.len();
        let (mut points, mut rings) = (Vec::new(), BTreeMap::new());
        let mut ring = |end: &End| {
            *rings.entry(end.nodes[0]).or_insert_with(|| {
                points.extend((0..count).map(|k| self.point(end, k)));
                points.len() - count
            })
        };
        let mut faces = Vec::new();
        for (number, RodElement { ends, .. }) in self.elements.iter().enumerate() {
            let [first, second] = [ring(&ends[0]), ring(&ends[1])];
            match self.dimension {
                2 => faces.push((number, vec![first + 1, second + 1, second, first])),
                _ => faces.extend((0..count).map(|k| {
                    let next = (k + 1) % count;
                    (number, vec![first + k, first + next, second + next, second + k])
                })),
            }
        }
        if let (3, [first, .., last]) = (self.dimension, &self.elements[..])
            && first.ends[0].nodes[0] != last.ends[1].nodes[0]
        {
            let [start, end] = [ring(&first.ends[0]), ring(&last.ends[1])];
            faces.push((0, (0..count).rev().map(|k| start + k).collect()));
            faces.push((self.elements.len() - 1, (0..count).map(|k| end + k).collect()));
        }
        Tube { points, faces }
    }

    /// Point `k` around a cross section.
    fn point(&self, end: &End, k: usize) -> RodPoint {
        let along = &self.outline[k % self.outline.len()][..self.dimension - 1];
        let centre = (end.nodes[0], 1.0 - along.iter().sum::<f64>());
        let directors = end.nodes[1..].iter().copied().zip(along.iter().copied());
        std::iter::once(centre).chain(directors).collect()
    }
}
