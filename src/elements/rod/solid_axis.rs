//! The axis of a slender solid, and the rod that stands for it.

use nalgebra::Vector3;

use super::cut_section::{AreaMoments, CutSection};
use super::nodes::across;
use super::places::shares_between;
use super::{Rod, RodSection, SectionNumbers};
use crate::base::input::{InputError, four_digits, percent};
use crate::base::vector::padded;
use crate::elements::mesh::{Cut, Mesh};

/// A solid is slender from this ratio of its length to its width on.
pub(crate) const SLENDER: f64 = 3.0;
/// Parts of the length at which it is cut.
const CUTS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// By how much the numbers of the cuts may differ (relative): of lengths, and of areas.
const SAME_LENGTH: f64 = 0.01;
const SAME_AREA: f64 = 0.02;
/// How far the centre of shear may be from the centroid, in reaches of the section.
const SAME_CENTRE: f64 = 0.02;
/// Distances below this part of the length are round-off.
const ROUND_OFF: f64 = 1e-9;

/// The straight axis of a solid whose cross section is the same all along, with the nodes of the rod that stands for it.
#[derive(Debug, Clone)]
pub(crate) struct SolidAxis {
    dimension: usize,
    /// Its first point (m), the centroid of the section there.
    start: Vector3<f64>,
    /// Unit vectors along it and along the principal axes of its section.
    axes: [Vector3<f64>; 3],
    /// Length (m).
    length: f64,
    numbers: SectionNumbers,
    elements: usize,
}

impl SolidAxis {
    /// That of a mesh through `centre` (m) along `direction`, the longest axis of its `volume` (m^3), for a rod of so many `elements`;
    /// `thickness` (m) is that of cells in the plane. Cuts, whose edges are straight, count as large as the volume says.
    ///
    /// # Errors
    /// A solid that is not slender, whose cross section changes along the axis or has its centre of shear beside it.
    pub(crate) fn new(
        mesh: &Mesh,
        [centre, direction]: [&[f64]; 2],
        [volume, thickness]: [f64; 2],
        elements: usize,
    ) -> Result<Self, InputError> {
        let (dimension, centre) = (mesh.dimension(), Vector3::from(padded(centre)));
        let mut along = Vector3::from(padded(direction)).normalize();
        if along[along.iamax()] < 0.0 {
            along = -along;
        }
        let across = match dimension {
            2 => Vector3::new(-along.y, along.x, 0.0),
            _ => across(&along, None)?,
        };
        let numbers = RodSection::Rectangle { size: [1.0; 2] }.numbers(0.0);
        let axes = [along, across, along.cross(&across)];
        let mut own = Self { dimension, start: centre, axes, length: 0.0, numbers, elements };
        let mut places: Vec<f64> =
            (0..mesh.node_count()).map(|node| own.local(mesh.position(node))[0]).collect();
        places.sort_by(f64::total_cmp);
        let [first, last] = [places[0], places[places.len() - 1]];
        own.length = last - first;
        let cuts = CUTS.map(|part| {
            let at = between(&places, first + part * own.length, ROUND_OFF * own.length);
            mesh.cut(at, |x| own.local(x))
        });
        let moments = cuts.each_ref().map(|cut| match dimension {
            2 => of_segments(cut),
            _ => CutSection::new(cut.clone()).moments(),
        });
        let middle = moments[CUTS.len() / 2];
        check_prism(&moments, &middle)?;
        own.start += own.axes[0] * first;
        for (axis, centroid) in own.axes[1..].iter().zip(middle.centroid) {
            own.start += axis * centroid;
        }
        own.numbers = match dimension {
            2 => {
                let height = volume / thickness / own.length;
                check_height(height, &middle)?;
                RodSection::Rectangle { size: [height, thickness] }.numbers(0.0)
            }
            _ => {
                let cut = &cuts[CUTS.len() / 2];
                let scale = (volume / own.length / middle.area).sqrt();
                let section = CutSection::new(cut.clone()).scaled(scale);
                own.take_section(&section)?
            }
        };
        let width =
            own.numbers.reach[..dimension - 1].iter().fold(0.0, |a, b| 2.0 * b.max(a / 2.0));
        if own.length < SLENDER * width {
            let value = format!("{} times its width", four_digits(own.length / width));
            let help = format!("a rod stands for what is {SLENDER} times as long as wide at least");
            return Err(InputError::new("length of the solid along its axis", value, help));
        }
        Ok(own)
    }

    /// Numbers of the section, along whose principal axes those across turn.
    fn take_section(&mut self, section: &CutSection) -> Result<SectionNumbers, InputError> {
        let moments = section.moments();
        let (numbers, shear_centre) = section.numbers(&moments);
        let beside = shear_centre.iter().zip(numbers.reach).map(|(x, reach)| (x / reach).abs());
        let beside = beside.fold(0.0, f64::max);
        if beside > SAME_CENTRE {
            let value = format!("{} of its reach from the centroid", percent(beside));
            let help = "a rod has both in one place, so that it does not twist under its weight: leave it a solid";
            return Err(InputError::new("centre of shear of the cross section", value, help));
        }
        let (sine, cosine) = moments.principal_angle().sin_cos();
        let [along, a, b] = self.axes;
        self.axes = [along, a * cosine + b * sine, b * cosine - a * sine];
        Ok(numbers)
    }

    /// The rod along it, with these numbers of its section.
    pub(crate) fn rod(&self, numbers: SectionNumbers) -> Rod {
        let end = self.start + self.axes[0] * self.length;
        let points = [self.start, end].map(|x| x.iter().copied().take(self.dimension).collect());
        let section = RodSection::Numbers(numbers);
        Rod::new(Vec::<Vec<f64>>::from(points), self.elements, section).normal(self.axes[1].into())
    }

    /// Numbers of its section.
    pub(crate) fn numbers(&self) -> SectionNumbers {
        self.numbers
    }

    /// The distance of an undeformed position along it, and its two coordinates across (m).
    fn local(&self, x: &[f64]) -> [f64; 3] {
        let from = Vector3::from(padded(x)) - self.start;
        self.axes.map(|axis| axis.dot(&from))
    }

    /// The number (from 0) of the cross section of the rod in which an undeformed position is, if one is there.
    pub(crate) fn section_at(&self, x: &[f64]) -> Option<usize> {
        let place = self.local(x)[0] / self.length * self.elements as f64;
        let is_there = (place - place.round()).abs() <= ROUND_OFF * self.elements as f64;
        is_there.then(|| place.round().max(0.0) as usize)
    }

    /// Whether an undeformed position is on the axis.
    pub(crate) fn is_on_axis(&self, x: &[f64]) -> bool {
        let [_, a, b] = self.local(x);
        a.hypot(b) <= ROUND_OFF * self.length
    }

    /// Nodes (from 0) of a cross section of the rod, that on the axis first.
    pub(crate) fn nodes(&self, section: usize) -> Vec<usize> {
        (0..self.dimension).map(|v| section + v * (self.elements + 1)).collect()
    }

    /// Nodes (from 0) of the rod, each with its share in the motion of the point that is undeformed at `x` (m): linear between two
    /// cross sections, each of which stays plane.
    pub(crate) fn shares(&self, x: &[f64]) -> Vec<(usize, f64)> {
        let [along, a, b] = self.local(x);
        let place = (along / self.length).clamp(0.0, 1.0) * self.elements as f64;
        let first = (place as usize).min(self.elements - 1);
        let arms = [a / self.numbers.reach[0], b / self.numbers.reach[1]];
        let nodes = |section: usize| {
            let own = self.nodes(section);
            std::array::from_fn(|v| own.get(v).copied().unwrap_or(section))
        };
        let sections = [first, first + 1].map(|section| (nodes(section), arms));
        shares_between(sections, place - first as f64, self.dimension)
    }
}

/// The place next to `at` in the middle between two of the `places`, which ascend.
fn between(places: &[f64], at: f64, round_off: f64) -> f64 {
    let gaps = places.windows(2).filter(|pair| pair[1] - pair[0] > round_off);
    let middles = gaps.map(|pair| 0.5 * (pair[0] + pair[1]));
    let nearest = middles.min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()));
    nearest.unwrap_or(at)
}

/// Length, centroid and second moment of the segments of a cut in the plane.
fn of_segments(cut: &Cut) -> AreaMoments {
    let ends = |segment: &Vec<usize>| [0, 1].map(|k| cut.points[segment[k % segment.len()]][0]);
    let [mut length, mut first, mut second] = [0.0; 3];
    for [a, b] in cut.polygons.iter().map(ends) {
        let own = (b - a).abs();
        length += own;
        first += own * 0.5 * (a + b);
        second += own / 3.0 * (a * a + a * b + b * b);
    }
    let centroid = first / length;
    let second = second - length * centroid * centroid;
    AreaMoments { area: length, centroid: [centroid, 0.0], second: [second, 0.0, 0.0] }
}

/// # Errors
/// A cut in the plane that is not all of this height (m).
fn check_height(height: f64, cut: &AreaMoments) -> Result<(), InputError> {
    let is_whole = (12.0 * cut.second[0] / height.powi(3) - 1.0).abs() <= 3.0 * SAME_AREA;
    if is_whole {
        return Ok(());
    }
    let help =
        "a rod in the plane stands for a solid without gaps across its axis: leave it a solid";
    Err(InputError::new("cross section of the solid", "with a gap", help))
}

/// # Errors
/// Cuts that differ from one another.
fn check_prism(cuts: &[AreaMoments], middle: &AreaMoments) -> Result<(), InputError> {
    let refused = |input: &str, value: String| {
        let help = "a rod stands for a solid that has one and the same cross section all along a straight axis: leave it a solid";
        Err(InputError::new(input, value, help))
    };
    let [xx, yy, _] = middle.second;
    let size = (xx.max(yy) / middle.area).sqrt();
    for cut in cuts {
        let beside = cut.centroid.iter().zip(middle.centroid).map(|(a, b)| (a - b).abs());
        if beside.fold(0.0, f64::max) > SAME_LENGTH * size {
            return refused("axis of the solid", "not straight".into());
        }
        let is_same = (cut.area / middle.area - 1.0).abs() <= SAME_AREA;
        if !is_same {
            let [own, middle] = [cut.area, middle.area].map(four_digits);
            let value = format!("{own} in one place and {middle} in the middle");
            return refused("size of the cross section of the solid", value);
        }
        let is_other = |(a, b): (&f64, f64)| (a - b).abs() > 2.0 * SAME_AREA * xx.max(yy);
        if cut.second.iter().zip(middle.second).any(is_other) {
            return refused(
                "cross section of the solid",
                "of another shape than in the middle".into(),
            );
        }
    }
    Ok(())
}
