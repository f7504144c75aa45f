//! Chambers: pressure within walls of nodes, a closed polygon or a closed surface.
//!
//! The force is p dV/du with the symmetric Hessian of V; its work is supplied energy, as p may change with
//! time. V is a sum over the walls, so a chamber may have several parts. Walls that are part of the boundary
//! need no order and no sign, as faces of the body know their outer side.

mod circles;
mod depth;
mod enclosure;
mod force;
mod generalized;
mod sides;
#[cfg(test)]
mod tests;
mod walls;

use std::fmt;

use circles::Circles;
use enclosure::{Polygon, Surface};

use super::actuator::Placed;
use super::signal::Signal;
use crate::base::input::{InputError, positive};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::distinct;
use crate::elements::body::Body;
use crate::elements::mesh::{Face, Mesh, NodeMap, Selection};

/// A chamber filled with a gas of given pressure p (Pa), which pushes its walls apart, unless it has [gas](crate::Gas) or a
/// [liquid](crate::Liquid) with a pressure of its own.
///
/// The force on its nodes is p h dS/du in the plane, with the area S within its walls and the thickness h,
/// and p dV/du in space and in a body of revolution, with the enclosed volume V. Walls with mid nodes are curved according to the shape
/// functions. Phases set the pressure ([`Phase::pressure`](crate::Phase::pressure)); without it a chamber
/// exerts no force.
///
/// Walls have no contact with each other. A run ends with an error where a chamber under pressure encloses a
/// volume below 0; without pressure, that is a warning.
#[derive(Clone)]
pub struct Chamber {
    name: String,
    walls: Walls,
    is_closed_by_line: bool,
    is_closed_by_lid: bool,
    thickness: Option<f64>,
    burst: Option<f64>,
}

#[derive(Debug, Clone)]
enum Walls {
    Nodes(Selection),
    Triangles(Vec<[usize; 3]>),
}

/// As it was before chambers could burst, where this one cannot: checkpoints tell scenes apart by it.
impl fmt::Debug for Chamber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = f.debug_struct("Chamber");
        parts.field("name", &self.name).field("walls", &self.walls);
        parts.field("is_closed_by_line", &self.is_closed_by_line);
        parts.field("is_closed_by_lid", &self.is_closed_by_lid);
        parts.field("thickness", &self.thickness);
        self.burst.iter().for_each(|burst| {
            parts.field("burst", burst);
        });
        parts.finish()
    }
}

impl Chamber {
    /// A chamber within walls of `nodes`.
    ///
    /// A named set or a box stands for part of the boundary of the body: the faces all of whose nodes belong
    /// to it. The chamber lies on the side of these faces that is opposite to the body.
    /// - In the plane they form closed loops, cavities with the same pressure; one of them may be open if it is
    ///   [closed by a line](Self::closed_by_line).
    /// - In a body of revolution walls that end on the axis are closed there.
    /// - In space they form closed surfaces.
    ///
    /// Numbers in the plane form a closed polygon, in their order around it, in either direction; it need not
    /// lie on the boundary. Where it runs along edges of cells with mid nodes, it is curved. Pressure
    /// enlarges its area; if that is 0 (a flat membrane), the chamber lies on the side of the boundary that
    /// is opposite to the body. In space numbers mean the same as a named set.
    pub fn within(name: impl Into<String>, nodes: impl Into<Selection>) -> Self {
        Self::new(name.into(), Walls::Nodes(nodes.into()))
    }

    /// The same chamber with the selection of its wall nodes replaced by `change`; triangles stay.
    pub(crate) fn with_nodes(
        mut self,
        change: impl FnOnce(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Self, InputError> {
        if let Walls::Nodes(nodes) = &mut self.walls {
            *nodes = change(nodes)?;
        }
        Ok(self)
    }

    /// Where it is, and where its mirror image is.
    ///
    /// # Errors
    /// Walls that were given by triangles, whose image is not known; nodes that do not exist.
    pub(crate) fn placed(&self, mesh: &Mesh, map: &NodeMap) -> Result<Placed, InputError> {
        let Walls::Nodes(walls) = &self.walls else {
            let help = "half of a chamber within triangles is not known: give its nodes, or leave the scene whole";
            return Err(InputError::new(self.input("walls"), "triangles", help));
        };
        let nodes = mesh.select(walls)?;
        let numbers = |nodes: Vec<usize>| nodes.into_iter().map(|node| node as f64).collect();
        let own = distinct(nodes.iter().copied());
        let (name, walls) = (String::new(), Walls::Triangles(Vec::new()));
        Ok(Placed {
            likeness: format!("{:?}", Self { name, walls, ..self.clone() }),
            at: [own, map.images_of(&nodes).unwrap_or_default()].map(numbers),
            along: nodes.iter().map(|&node| mesh.position(node)[map.axis]).collect(),
            is_line: false,
        })
    }

    /// The part of it on one side of a plane of symmetry, which closes it, in space of a `dimension`.
    ///
    /// # Errors
    /// One that is open but for a line or lids.
    pub(crate) fn closed_by_plane(self, dimension: usize) -> Result<Self, InputError> {
        match dimension {
            _ if self.is_closed_by_line || self.is_closed_by_lid => {
                let help = "the plane of symmetry would cut the line or lid that closes it: leave the scene whole";
                Err(InputError::new(self.input("walls"), "open", help))
            }
            3 => Ok(self.closed_by_lid()),
            _ => Ok(self.closed_by_line()),
        }
    }

    /// A chamber in space, enclosed by `triangles` of nodes (numbers from 1): a closed surface, all
    /// triangles counter-clockwise as seen from outside, or all clockwise.
    pub fn surface(
        name: impl Into<String>,
        triangles: impl IntoIterator<Item = [usize; 3]>,
    ) -> Self {
        Self::new(name.into(), Walls::Triangles(triangles.into_iter().collect()))
    }

    fn new(name: String, walls: Walls) -> Self {
        Self {
            name,
            walls,
            is_closed_by_line: false,
            is_closed_by_lid: false,
            thickness: None,
            burst: None,
        }
    }

    /// Closes walls in the plane that have one gap by the straight line between their ends.
    ///
    /// Each end takes half of the force of the pressure on that line (if it is held, this has no effect). In a body of revolution whose walls
    /// have one end off the axis, a flat disc closes them, whose pressure force acts on the circle at that end. Without this a gap is an error.
    pub fn closed_by_line(mut self) -> Self {
        self.is_closed_by_line = true;
        self
    }

    /// Closes walls in space that are open by a lid on each of their rims.
    ///
    /// A lid runs from the mean of the rim's nodes to its edges: it is flat if the rim is. The force of the pressure on it
    /// acts on the nodes of the rim. Without this a rim is an error.
    pub fn closed_by_lid(mut self) -> Self {
        self.is_closed_by_lid = true;
        self
    }

    /// Thickness h (m) of a chamber in the plane. Default: that of the body.
    pub fn thickness(mut self, thickness: f64) -> Self {
        self.thickness = Some(thickness);
        self
    }

    /// Pressure (Pa, above that outside) at which it bursts: the first step that ends above it ends the run, with an error that states the time
    /// and the pressure. Default: it never bursts. An equilibrium is not checked.
    ///
    /// ```
    /// use pliant::{Body, Cells, Chamber, Material, Mesh, Phase, Sampling, Scene, Settings, Signal};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 100.0 };
    /// let ring = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles)?;
    /// let scene = Scene::new(Body::new(ring, rubber).thickness(0.01).build()?)
    ///     .chamber(Chamber::within("air", "inner").burst(30e3))
    ///     .phase(Phase::until(1.0).pressure("air", Signal::ramp(0.0, 40e3, 0.0, 1.0)));
    /// let end = scene.simulate(&Settings::default(), &Sampling::every(0.1)).unwrap_err();
    /// assert!(end.to_string().contains("chamber \"air\" bursts at t = 0.7"), "{end}");
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn burst(mut self, pressure: f64) -> Self {
        self.burst = Some(pressure);
        self
    }

    /// Name of the chamber.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The force of the chamber in a phase with `pressure` (Pa) in it.
    ///
    /// # Errors
    /// Walls in one dimension, triangles other than in space; nodes that do not exist, form no chain or
    /// enclose nothing, a gap that no line closes, a surface with holes, a missing thickness.
    pub(crate) fn force(
        &self,
        body: &Body,
        pressure: Vec<Signal>,
    ) -> Result<ChamberForce, InputError> {
        if self.is_closed_by_line && body.dimension() != 2 {
            let help = "a line closes walls in the plane only: in space say closed_by_lid, or give a closed surface";
            return Err(InputError::new(self.input("closed_by_line"), true, help));
        }
        if self.is_closed_by_lid && body.dimension() != 3 {
            let help = "a lid closes walls in space only: in the plane say closed_by_line";
            return Err(InputError::new(self.input("closed_by_lid"), true, help));
        }
        let burst = self.burst.map(|burst| positive(&self.input("burst"), burst, "Pa"));
        let burst = burst.transpose()?;
        let geometry = match (&self.walls, body.dimension()) {
            (Walls::Nodes(nodes), 2) if body.is_axisymmetric() => self.circles(body, nodes)?,
            (Walls::Nodes(nodes), 2) => self.polygon(body, nodes)?,
            (Walls::Nodes(nodes), 3) => {
                let surface = Surface::new(
                    body.mesh(),
                    self.faces(body.mesh(), nodes, walls::Shape::Curved)?,
                );
                // faces are oriented as seen from outside the body, and so from inside the chamber
                let sign = match self.fill_space(body, nodes)? {
                    true => -1.0,
                    false => self.surface_sign(body, &surface)?,
                };
                Geometry::Surface(surface, sign)
            }
            (Walls::Triangles(triangles), 3) => {
                let surface = Surface::new(body.mesh(), self.triangles(body.mesh(), triangles)?);
                let sign = self.surface_sign(body, &surface)?;
                Geometry::Surface(surface, sign)
            }
            (walls, dimension) => {
                let help = match walls {
                    Walls::Nodes(_) => "nodes enclose a chamber in 2 or 3 dimensions only",
                    Walls::Triangles(_) => "a surface encloses a chamber in 3 dimensions only",
                };
                return Err(InputError::new(self.input("in dimension"), dimension, help));
            }
        };
        let mut force =
            ChamberForce { name: self.name.clone(), geometry, pressure, has_room: false, burst };
        let natural = force.volume(&vec![0.0; body.dofs()]);
        force.has_room = orientation(natural, body) == Some(1.0);
        Ok(force)
    }

    /// Checks that closed walls on the boundary of a body that fills its space do not run around the body:
    /// the chamber lies on the side of them that is opposite to the body.
    pub(crate) fn check_side(&self, body: &Body, force: &ChamberForce) -> Result<(), InputError> {
        let Walls::Nodes(nodes @ (Selection::Set(_) | Selection::Box { .. })) = &self.walls else {
            return Ok(());
        };
        let is_closed = !self.is_closed_by_line && !self.is_closed_by_lid;
        if !is_closed || !self.fill_space(body, nodes)? {
            return Ok(());
        }
        match sides::around_the_body(force, body) {
            Some((node, volume)) => Err(InputError::new(
                self.input("nodes"),
                format!("{nodes:?}"),
                format!(
                    "the walls with node {} run around the body, so that the chamber would be all that is outside of it \
                     ({volume:.1e} m^3), and pressure in it would shrink the body: name the walls of a room inside; for a \
                     pressure on the outside, use pressure_on of a phase",
                    node + 1
                ),
            )),
            None => Ok(()),
        }
    }

    fn polygon(&self, body: &Body, selection: &Selection) -> Result<Geometry, InputError> {
        let mesh = body.mesh();
        let edges = self.edges(body, selection)?;
        let polygon = Polygon::new(mesh, walls::edge_parts(&edges, walls::Shape::Curved));
        let area = polygon.measure(&vec![0.0; body.dofs()]);
        let sign = self.sense(body, selection, &edges, area)?;
        let sign = sign.ok_or_else(|| self.encloses_nothing("area (m^2)", area))?;
        let height = self.height(body, selection)?;
        Ok(Geometry::Polygon(polygon, sign * height))
    }

    fn circles(&self, body: &Body, selection: &Selection) -> Result<Geometry, InputError> {
        if let Some(thickness) = self.thickness {
            let help = "a chamber of a body of revolution goes all around: leave it out";
            return Err(InputError::new(self.input("thickness"), thickness, help));
        }
        let edges = self.edges(body, selection)?;
        let circles = Circles::new(body, edges.clone());
        let circles =
            circles.map_err(|help| InputError::new(self.input("nodes"), selection, help))?;
        let volume = circles.measure(&vec![0.0; body.dofs()]);
        let sign = self.sense(body, selection, &edges, volume)?;
        let sign = sign.ok_or_else(|| self.encloses_nothing("volume (m^3)", volume))?;
        Ok(Geometry::Circles(circles, sign))
    }

    /// 1 or -1, so that pressure in the chamber pushes these `edges`, which enclose an area or volume with a sign, off the body, or else
    /// enlarges that.
    fn sense(
        &self,
        body: &Body,
        selection: &Selection,
        edges: &[Face],
        enclosed: f64,
    ) -> Result<Option<f64>, InputError> {
        let by_measure = orientation(enclosed, body);
        let by_boundary = || walls::against_boundary(body.mesh(), edges);
        Ok(match selection {
            // the cells of a string have no sides
            Selection::Set(_) | Selection::Box { .. } if self.fill_space(body, selection)? => {
                by_boundary()
            }
            _ => by_measure.or_else(by_boundary),
        })
    }

    /// 1 or -1, so that pressure enlarges the volume.
    fn surface_sign(&self, body: &Body, surface: &Surface) -> Result<f64, InputError> {
        let volume = surface.measure(&vec![0.0; body.dofs()]);
        orientation(volume, body).ok_or_else(|| self.encloses_nothing("volume (m^3)", volume))
    }

    fn input(&self, key: &str) -> String {
        format!("chamber \"{}\" {key}", self.name)
    }

    /// Whether the cells at its walls fill the plane or space.
    fn fill_space(&self, body: &Body, walls: &Selection) -> Result<bool, InputError> {
        let nodes = body.mesh().select(walls)?;
        let fills = |node: &usize| body.part_of(*node).body.mesh().has_inside();
        Ok(nodes.iter().all(fills))
    }

    fn height(&self, body: &Body, walls: &Selection) -> Result<f64, InputError> {
        match (self.thickness, self.fill_space(body, walls)?) {
            (Some(thickness), _) => positive(&self.input("thickness"), thickness, "m"),
            (None, true) => Ok(body.part_of(body.mesh().select(walls)?[0]).body.section()),
            (None, false) => {
                let help = "the body has no thickness of its own: give that of the chamber (m)";
                Err(InputError::new(self.input("thickness"), "(missing)", help))
            }
        }
    }

    fn encloses_nothing(&self, measure: &str, enclosed: f64) -> InputError {
        let help = "its walls enclose nothing: give its nodes in their order around";
        InputError::new(self.input(measure), format!("{enclosed:.1e}"), help)
    }
}

/// 1 or -1, so that pressure enlarges the area or volume `enclosed`, which is signed; `None` if it is 0 up to
/// round-off.
fn orientation(enclosed: f64, body: &Body) -> Option<f64> {
    let degree = if body.is_axisymmetric() { 3 } else { body.dimension() };
    let least = 1e-9 * body.size().powi(degree as i32);
    (enclosed.abs() > least).then(|| enclosed.signum())
}

/// Cause of a negative volume, and its remedy, for messages.
pub(crate) const TURNED: &str = "its walls have passed through each other, which they do not feel. Let them touch ([[touch]]), \
                                 draw less out of it, or make its walls stiffer";

/// The force of one chamber.
pub(crate) struct ChamberForce {
    name: String,
    geometry: Geometry,
    pressure: Vec<Signal>,
    /// Whether its walls enclose a volume in the undeformed shape, and are not flat.
    has_room: bool,
    /// Pressure (Pa) at which it bursts.
    burst: Option<f64>,
}

impl ChamberForce {
    /// The volume that its walls enclose under the displacements `u` (m^3).
    pub(crate) fn volume(&self, u: &[f64]) -> f64 {
        match &self.geometry {
            Geometry::Polygon(polygon, factor) => factor * polygon.measure(u),
            Geometry::Surface(surface, factor) => factor * surface.measure(u),
            Geometry::Circles(circles, sign) => sign * circles.measure(u),
        }
    }

    /// Whether its walls enclose a volume in the undeformed shape, and are not flat.
    pub(crate) fn has_room(&self) -> bool {
        self.has_room
    }

    /// Adds `factor` times the second derivative of the volume by `u` (m).
    pub(crate) fn add_hessian(&self, factor: f64, u: &[f64], matrix: &mut BlockMatrix) {
        match &self.geometry {
            Geometry::Polygon(polygon, sign) => polygon.add_hessian(factor * sign, matrix),
            Geometry::Surface(surface, sign) => surface.add_hessian(factor * sign, u, matrix),
            Geometry::Circles(circles, sign) => circles.add_hessian(factor * sign, u, matrix),
        }
    }

    /// The name of the chamber.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Adds `factor` times the derivative of the volume by `u` (m^2).
    pub(crate) fn add_gradient(&self, factor: f64, u: &[f64], gradient: &mut [f64]) {
        match &self.geometry {
            Geometry::Polygon(polygon, sign) => polygon.add_gradient(factor * sign, u, gradient),
            Geometry::Surface(surface, sign) => surface.add_gradient(factor * sign, u, gradient),
            Geometry::Circles(circles, sign) => circles.add_gradient(factor * sign, u, gradient),
        }
    }
}

/// Boundary of a chamber, and the factor by which p times the gradient of its area or volume becomes the force: +-h in
/// the plane, +-1 in space and in a body of revolution.
enum Geometry {
    Polygon(Polygon, f64),
    Surface(Surface, f64),
    Circles(Circles, f64),
}
