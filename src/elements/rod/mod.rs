//! Rods: slender bodies as a chain of cross sections, geometrically exact.
//!
//! Each cross section stays plane and keeps its shape; it moves and turns by any amount. A [`Rod`] is a path with a section along it, of which
//! [`Body::rod`](crate::Body::rod) makes a body. What it leaves out is what the section itself does: warping, ovalization, local buckling.

mod branches;
mod chain;
mod cut_section;
mod elements;
mod end;
mod growth;
mod nodes;
mod path;
mod places;
mod screw;
mod section;
mod solid_axis;
mod strain;
#[cfg(test)]
mod tests;
mod tube;
mod turning;

pub(crate) use elements::RodElements;
use elements::{RodBranch, RodElement};
use end::End;
pub(crate) use growth::RodGrowth;
use nodes::Nodes;
pub use path::RodPath;
pub use section::{RodSection, SectionNumbers};
pub(crate) use solid_axis::{SLENDER, SolidAxis};
use strain::{Deformed, Section};
pub(crate) use tube::{Bend, RodPoint, Spokes, Tube, TubePiece};
pub(crate) use turning::{CrossSection, SectionLoad};

use super::material::{Material, MaxwellBranch};
use super::mesh::{CellKind, Mesh};
use crate::base::input::{InputError, check_memory};

/// A rod: its path, the number of its elements, its cross section.
///
/// ```
/// use pliant::{Body, Material, Rod, RodSection};
///
/// let silicone = Material { density: 1100.0, young: 5e5, poisson: 0.49, viscosity: 500.0 };
/// let rod = Rod::new([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]], 20, RodSection::Circle { radius: 0.006 });
/// let arm = Body::rod(rod.end(RodSection::Circle { radius: 0.004 }), silicone)?.build()?;
/// let cone = std::f64::consts::PI * 0.3 / 3.0 * (36.0 + 24.0 + 16.0) * 1e-6; // m^3
/// assert!((arm.mass() / (1100.0 * cone) - 1.0).abs() < 1e-12);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Rod {
    path: RodPath,
    elements: usize,
    section: RodSection,
    end: Option<RodSection>,
    normal: Option<[f64; 3]>,
    twist: f64,
    natural: Option<RodPath>,
}

impl Rod {
    /// A rod along a [path](RodPath), such as a list of points (m; two coordinates each in the plane, three in space), of so many `elements`. It is free
    /// of stress there, bent as the path is.
    pub fn new(path: impl Into<RodPath>, elements: usize, section: RodSection) -> Self {
        let path = path.into();
        Self { path, elements, section, end: None, normal: None, twist: 0.0, natural: None }
    }

    /// The section at its end, of the same kind, to which it tapers.
    pub fn end(self, section: RodSection) -> Self {
        Self { end: Some(section), ..self }
    }

    /// The direction, across the path at its first point, of the axis d_1 of its section there; from there on the axes are carried along without
    /// twist on a polygon, with the screw on a helix. Default: the axis of space, z before y before x, that is most across the path. In the plane d_1
    /// lies in the plane.
    pub fn normal(self, direction: [f64; 3]) -> Self {
        Self { normal: Some(direction), ..self }
    }

    /// The angle (rad) by which its sections turn about the path from the start to the end, besides how the path carries them. Default: 0.
    pub fn twist(self, angle: f64) -> Self {
        Self { twist: angle, ..self }
    }

    /// The path along which it is free of stress, without twist, of as many elements. On its own path it is then bent and twisted by stress,
    /// as a ring that was bent from a straight rod is. Default: its path, with the twist.
    pub fn natural(self, path: impl Into<RodPath>) -> Self {
        Self { natural: Some(path.into()), ..self }
    }

    /// Dimension of its space, 2 or 3.
    pub(crate) fn dimension(&self) -> usize {
        self.path.dimension()
    }

    /// The mesh of its nodes: those on the axis, which its segments join, then those at the directors d_1, then at d_2; with the node sets
    /// `axis`, `start` and `end`, the first and the last node of the axis, `start-section` and `end-section`, and `side-1` and `side-2`, the nodes at
    /// d_1 and d_2, on the surface.
    ///
    /// # Errors
    /// See [`RodSection`] and the path.
    pub(crate) fn mesh(&self) -> Result<Mesh, InputError> {
        let (nodes, _, sections) = self.laid_out()?;
        let (dimension, count) = (self.dimension(), nodes.x.len());
        let mut positions = Vec::with_capacity(count * dimension * dimension);
        positions.extend(
            nodes.x.iter().flat_map(|x| x.iter().copied().take(dimension).collect::<Vec<_>>()),
        );
        for director in 0..dimension - 1 {
            for ((x, d), section) in nodes.x.iter().zip(&nodes.d).zip(&sections) {
                let place = x + d[director] * section.numbers(0.0).reach[director];
                positions.extend(place.iter().copied().take(dimension));
            }
        }
        let segments = (0..nodes.lengths.len()).flat_map(|k| [k, (k + 1) % count]).collect();
        let mut mesh = Mesh::new(dimension, positions, CellKind::Segment, segments)?;
        let of_section = |k: usize| (0..dimension).map(|v| k + v * count).collect::<Vec<_>>();
        mesh.set_nodes("axis", (0..count).collect());
        let directors = ["side-1", "side-2"].into_iter().zip(1..dimension);
        directors
            .for_each(|(name, v)| mesh.set_nodes(name, (v * count..(v + 1) * count).collect()));
        mesh.set_nodes("start", vec![0]);
        mesh.set_nodes("end", vec![count - 1]);
        mesh.set_nodes("start-section", of_section(0));
        mesh.set_nodes("end-section", of_section(count - 1));
        Ok(mesh)
    }

    /// The nodes, those of the path along which it is free of stress if that is another one, and the section at each node.
    fn laid_out(&self) -> Result<(Nodes, Option<Nodes>, Vec<RodSection>), InputError> {
        self.section.validate("section.")?;
        let bytes = self.elements as f64 * size_of::<RodElement>() as f64;
        check_memory("elements of the rod", self.elements.to_string(), bytes, "take fewer")?;
        let nodes = self.path.nodes(self.elements, self.normal)?;
        let nodes = nodes.twisted(self.twist, self.dimension())?;
        self.check_curvature(&nodes)?;
        let natural = self.natural.as_ref().map(|path| self.natural_nodes(path)).transpose();
        let natural = natural.map_err(|error| {
            let input = format!("{} (`natural`)", error.input);
            InputError { input, ..error }
        })?;
        let Some(end) = self.end else {
            let all = vec![self.section; nodes.x.len()];
            return Ok((nodes, natural, all));
        };
        end.validate("section.end_")?;
        let (along, length) = nodes.distances();
        let sections = along.iter().map(|s| self.section.towards(&end, s / length));
        Ok((nodes, natural, sections.collect::<Result<_, _>>()?))
    }

    /// The nodes of the path along which it is free of stress.
    fn natural_nodes(&self, path: &RodPath) -> Result<Nodes, InputError> {
        if path.dimension() != self.dimension() {
            let help = format!("those of its path have {}: give as many", self.dimension());
            let input = "coordinates of the rod's path";
            return Err(InputError::new(input, path.dimension(), help));
        }
        let nodes = path.nodes(self.elements, self.normal)?;
        self.check_curvature(&nodes)?;
        Ok(nodes)
    }

    /// # Errors
    /// A smooth path that turns by more than the section allows.
    fn check_curvature(&self, nodes: &Nodes) -> Result<(), InputError> {
        let reach = self.section.numbers(0.0).reach;
        if nodes.curvature * reach[0].max(reach[1]) < 1.0 {
            return Ok(());
        }
        let help = "the section would reach beyond the axis about which the path turns: make it thinner, or the path wider";
        let radius = format!("{:.3e} m", nodes.curvature.recip());
        Err(InputError::new("radius of curvature of the rod's path", radius, help))
    }

    /// Its elements of a material, with Maxwell branches.
    pub(crate) fn elements(
        &self,
        material: &Material,
        branches: &[MaxwellBranch],
    ) -> Result<RodElements, InputError> {
        let (nodes, natural, sections) = self.laid_out()?;
        let natural = natural.as_ref().unwrap_or(&nodes);
        let (dimension, count) = (self.dimension(), nodes.x.len());
        let arms: Vec<[f64; 2]> = sections.iter().map(|s| s.numbers(0.0).reach).collect();
        let end = |k: usize| End {
            nodes: std::array::from_fn(|v| if v < dimension { k + v * count } else { k }),
            arms: arms[k],
            undeformed: nodes.section(k),
        };
        let mut elements = Vec::with_capacity(nodes.lengths.len());
        for k in 0..nodes.lengths.len() {
            let next = (k + 1) % count;
            let ends = [end(k), end(next)];
            let free = [k, (k + 1) % natural.x.len()].map(|k| natural.section(k));
            let own = natural.lengths[k];
            let middle = sections[k].towards(&sections[next], 0.5).unwrap_or(sections[k]);
            let along = [sections[k], middle, sections[next]];
            let mean = SectionNumbers::mean(along.map(|section| section.numbers(material.poisson)));
            elements.push(element(ends, free, own, &mean, material));
        }
        let of_rod = |branch: &MaxwellBranch| RodBranch { share: branch.share, time: branch.time };
        Ok(RodElements {
            dimension,
            elements,
            branches: branches.iter().map(of_rod).collect(),
            outline: self.section.outline(dimension),
        })
    }

    /// The mean area of its section (m^2).
    pub(crate) fn mean_area(&self) -> f64 {
        let [first, last] =
            [self.section, self.end.unwrap_or(self.section)].map(|s| s.numbers(0.0).area);
        let middle = self.end.and_then(|end| self.section.towards(&end, 0.5).ok());
        (first + 4.0 * middle.map_or(first, |middle| middle.numbers(0.0).area) + last) / 6.0
    }
}

/// An element between two ends, of a length, free of stress where these are as `free`.
fn element(
    ends: [End; 2],
    free: [Section<f64>; 2],
    length: f64,
    section: &SectionNumbers,
    material: &Material,
) -> RodElement {
    let natural = Deformed::new(length, free).strains();
    let SectionNumbers { area, shear, bending, torsion, reach } = *section;
    let stiffness = |young: f64| {
        let shearing = young / (2.0 * (1.0 + material.poisson));
        [
            shearing * shear[0],
            shearing * shear[1],
            young * area,
            young * bending[0],
            young * bending[1],
            shearing * torsion,
        ]
    };
    // the time that a wave takes across the section
    let time = reach[0].max(reach[1]) * (material.density / material.young).sqrt();
    let in_plane = 0.5 * material.young * area * length;
    RodElement {
        ends,
        length,
        natural,
        stiffness: stiffness(material.young),
        viscosity: stiffness(material.viscosity),
        in_plane: [in_plane, in_plane * time],
        mass: [area, bending[0], bending[1]].map(|number| material.density * number),
    }
}
