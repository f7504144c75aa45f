//! Chambers: pressure in a closed polygon of nodes, or in a closed surface of triangles.

mod walls;

use super::signal::{self, Signal, finite_at};
use super::{Force, NodalForces, Reservoir, cross, dot};
use crate::body::Body;
use crate::error::{Error, positive};
use crate::mesh::Selection;
use crate::ode::Failure;
use crate::sparse::BlockMatrix;

/// A chamber filled with a gas of given pressure p (Pa), which pushes its walls apart: the force on
/// its nodes is p h dS/du in the plane, with the area S of the polygon of its nodes and the
/// thickness h, and p dV/du in space, with the enclosed volume V. Phases set the pressure
/// ([`Phase::pressure`](crate::Phase::pressure)); without it a chamber does nothing.
#[derive(Debug, Clone)]
pub struct Chamber {
    name: String,
    walls: Walls,
    thickness: Option<f64>,
}

#[derive(Debug, Clone)]
enum Walls {
    Polygon(Selection),
    Surface(Vec<[usize; 3]>),
}

impl Chamber {
    /// A chamber in the plane, enclosed by the closed polygon of `nodes`. Numbers are taken in
    /// their order around, either way; the nodes of a named set or a box in their order along the
    /// boundary of the body. The polygon closes along the straight line from the last node to the
    /// first. If all of them lie on a line (a flat membrane), the chamber is on the other side of
    /// the boundary than the body.
    pub fn polygon(name: impl Into<String>, nodes: impl Into<Selection>) -> Self {
        Self { name: name.into(), walls: Walls::Polygon(nodes.into()), thickness: None }
    }

    /// A chamber in space, enclosed by `triangles` of nodes (numbers from 1): a closed surface, all
    /// triangles counter-clockwise as seen from outside, or all clockwise.
    pub fn surface(
        name: impl Into<String>,
        triangles: impl IntoIterator<Item = [usize; 3]>,
    ) -> Self {
        let walls = Walls::Surface(triangles.into_iter().collect());
        Self { name: name.into(), walls, thickness: None }
    }

    /// Thickness h (m) of a chamber in the plane. Default: that of the body.
    pub fn thickness(mut self, thickness: f64) -> Self {
        self.thickness = Some(thickness);
        self
    }

    /// Name of the chamber.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The force of the chamber in a phase with `pressure` (Pa) in it.
    ///
    /// # Errors
    /// A polygon outside the plane, a surface outside space; nodes that do not exist or enclose
    /// nothing, a surface with holes, a missing thickness.
    pub(crate) fn force(&self, body: &Body, pressure: Vec<Signal>) -> Result<ChamberForce, Error> {
        let geometry = match &self.walls {
            Walls::Polygon(nodes) => {
                self.check_dimension(body, 2, "a polygon")?;
                let (nodes, corners) = self.polygon_nodes(body.mesh(), nodes)?;
                let polygon = Polygon { nodes, corners };
                let area = polygon.area(&vec![0.0; body.dofs()]);
                let sign = orientation(area, body)
                    .or_else(|| walls::against_boundary(body.mesh(), polygon.pairs()))
                    .ok_or_else(|| self.encloses_nothing("area (m^2)", area))?;
                Geometry::Polygon(polygon, sign * self.height(body)?)
            }
            Walls::Surface(triangles) => {
                self.check_dimension(body, 3, "a surface")?;
                let (triangles, corners) = self.surface_nodes(body.mesh(), triangles)?;
                let surface = Surface { triangles, corners };
                let volume = surface.volume(&vec![0.0; body.dofs()]);
                let sign = orientation(volume, body)
                    .ok_or_else(|| self.encloses_nothing("volume (m^3)", volume))?;
                Geometry::Surface(surface, sign)
            }
        };
        Ok(ChamberForce { name: self.name.clone(), geometry, pressure })
    }

    fn input(&self, key: &str) -> String {
        format!("chamber \"{}\" {key}", self.name)
    }

    fn check_dimension(&self, body: &Body, needed: usize, what: &str) -> Result<(), Error> {
        if body.dimension() == needed {
            return Ok(());
        }
        let mend = format!("{what} encloses a chamber in {needed} dimensions only");
        Err(Error::input(self.input("in dimension"), body.dimension(), mend))
    }

    fn height(&self, body: &Body) -> Result<f64, Error> {
        match (self.thickness, body.mesh().kind().dimension()) {
            (Some(thickness), _) => positive(&self.input("thickness"), thickness, "m"),
            (None, 2) => Ok(body.section()),
            (None, _) => {
                let mend = "the body has no thickness of its own: give that of the chamber (m)";
                Err(Error::input(self.input("thickness"), "(missing)", mend))
            }
        }
    }

    fn encloses_nothing(&self, measure: &str, enclosed: f64) -> Error {
        let mend = "its walls enclose nothing: give its nodes in their order around";
        Error::input(self.input(measure), format!("{enclosed:.1e}"), mend)
    }
}

/// 1 or -1, so that pressure enlarges the area or volume `enclosed`, which is signed; `None` if it
/// is 0 but for round-off.
fn orientation(enclosed: f64, body: &Body) -> Option<f64> {
    let least = 1e-9 * body.mesh().size().powi(body.dimension() as i32);
    (enclosed.abs() > least).then(|| enclosed.signum())
}

/// The force of one chamber.
pub(crate) struct ChamberForce {
    name: String,
    geometry: Geometry,
    pressure: Vec<Signal>,
}

/// What encloses a chamber, with the factor from p times the gradient of its area or volume to
/// the force: +-h, or +-1.
enum Geometry {
    Polygon(Polygon, f64),
    Surface(Surface, f64),
}

struct Polygon {
    nodes: Vec<usize>,
    /// Natural positions.
    corners: Vec<[f64; 2]>,
}

impl Polygon {
    fn at(&self, u: &[f64], k: usize) -> [f64; 2] {
        let first = 2 * self.nodes[k];
        [self.corners[k][0] + u[first], self.corners[k][1] + u[first + 1]]
    }

    /// Signed area S = (1/2) sum (x_k y_{k+1} - x_{k+1} y_k).
    fn area(&self, u: &[f64]) -> f64 {
        let count = self.nodes.len();
        let pair = |k: usize| {
            let ([x, y], [next_x, next_y]) = (self.at(u, k), self.at(u, (k + 1) % count));
            0.5 * (x * next_y - next_x * y)
        };
        (0..count).map(pair).sum()
    }

    /// Adds `factor` dS/du.
    fn add_gradient(&self, factor: f64, u: &[f64], forces: &mut [f64]) {
        let count = self.nodes.len();
        for (k, node) in self.nodes.iter().enumerate() {
            let (before, after) =
                (self.at(u, (k + count - 1) % count), self.at(u, (k + 1) % count));
            forces[2 * node] += 0.5 * factor * (after[1] - before[1]);
            forces[2 * node + 1] += 0.5 * factor * (before[0] - after[0]);
        }
    }

    /// Adds `factor` d^2S/du^2, which does not depend on u.
    fn add_hessian(&self, factor: f64, matrix: &mut BlockMatrix) {
        let half = 0.5 * factor;
        for [node, next] in self.pairs() {
            for (row, column, sign) in [(node, next, 1.0), (next, node, -1.0)] {
                if let Some(block) = matrix.block_mut(row, column) {
                    block[1] += sign * half;
                    block[2] -= sign * half;
                }
            }
        }
    }

    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let count = self.nodes.len();
        (0..count).map(move |k| [self.nodes[k], self.nodes[(k + 1) % count]])
    }
}

struct Surface {
    triangles: Vec<[usize; 3]>,
    /// Natural positions of their corners.
    corners: Vec<[[f64; 3]; 3]>,
}

impl Surface {
    /// Triangles with the present positions of their corners.
    fn iter<'a>(&'a self, u: &'a [f64]) -> impl Iterator<Item = (&'a [usize; 3], [[f64; 3]; 3])> {
        self.triangles.iter().zip(&self.corners).map(|(nodes, corners)| {
            let at = |k: usize| std::array::from_fn(|i| corners[k][i] + u[3 * nodes[k] + i]);
            (nodes, std::array::from_fn(at))
        })
    }

    /// Signed volume V = (1/6) sum a . (b x c) over the triangles abc.
    fn volume(&self, u: &[f64]) -> f64 {
        self.iter(u).map(|(_, [a, b, c])| dot(&a, &cross(&b, &c)) / 6.0).sum()
    }

    /// Adds `factor` dV/du.
    fn add_gradient(&self, factor: f64, u: &[f64], forces: &mut [f64]) {
        for (nodes, x) in self.iter(u) {
            for k in 0..3 {
                let normal = cross(&x[(k + 1) % 3], &x[(k + 2) % 3]);
                for i in 0..3 {
                    forces[3 * nodes[k] + i] += factor / 6.0 * normal[i];
                }
            }
        }
    }

    /// Adds `factor` d^2V/du^2: for the edge from a to b of a triangle abc, the blocks
    /// -[c x]/6 and, transposed, [c x]/6.
    fn add_hessian(&self, factor: f64, u: &[f64], matrix: &mut BlockMatrix) {
        for (nodes, x) in self.iter(u) {
            for k in 0..3 {
                let (a, b) = (nodes[k], nodes[(k + 1) % 3]);
                let c = x[(k + 2) % 3].map(|c| factor / 6.0 * c);
                let times = [0.0, -c[2], c[1], c[2], 0.0, -c[0], -c[1], c[0], 0.0];
                for (row, column, sign) in [(a, b, -1.0), (b, a, 1.0)] {
                    if let Some(block) = matrix.block_mut(row, column) {
                        block.iter_mut().zip(&times).for_each(|(x, c)| *x += sign * c);
                    }
                }
            }
        }
    }
}

impl Force for ChamberForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let pressure = signal::sum(&self.pressure, t);
        finite_at(t, format_args!("the pressure in chamber \"{}\"", self.name), pressure)?;
        match &self.geometry {
            Geometry::Polygon(polygon, factor) => {
                polygon.add_gradient(factor * pressure, u, &mut forces.applied);
            }
            Geometry::Surface(surface, factor) => {
                surface.add_gradient(factor * pressure, u, &mut forces.applied);
            }
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) {
        let pressure = signal::sum(&self.pressure, t);
        match &self.geometry {
            Geometry::Polygon(polygon, factor) => {
                polygon.add_hessian(-factor * pressure, stiffness);
            }
            Geometry::Surface(surface, factor) => {
                surface.add_hessian(-factor * pressure, u, stiffness);
            }
        }
    }

    fn is_nonlinear(&self) -> bool {
        true
    }

    fn potential(&self, _t: f64, _u: &[f64]) -> f64 {
        0.0
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::None
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        match &self.geometry {
            Geometry::Polygon(polygon, _) => polygon.pairs().collect(),
            Geometry::Surface(surface, _) => {
                let edges = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]];
                surface.triangles.iter().flat_map(edges).collect()
            }
        }
    }
}
