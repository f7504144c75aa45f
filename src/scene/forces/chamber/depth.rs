//! How deep what is in a chamber lies, and how high it stands.

use super::walls::{Shape, edge_parts};
use super::{Chamber, ChamberForce, Geometry, Walls};
use crate::base::input::InputError;
use crate::elements::body::Body;
use crate::elements::mesh::{Face, FaceKind};
use crate::scene::forces::basin::Basin;
use crate::scene::forces::faces::LoadedFace;
use crate::scene::forces::followed::FollowedFaces;
use crate::scene::forces::moment::Moment;

impl Chamber {
    /// The integral of the depth along `down`, of length 1, over the chamber, whose force is `force`; depths are counted from the origin.
    ///
    /// # Errors
    /// A lid, which has no faces.
    pub(crate) fn moment(
        &self,
        body: &Body,
        force: &ChamberForce,
        down: [f64; 3],
    ) -> Result<Moment, InputError> {
        body.refuse_around(&self.input("liquid"), "with weight")?;
        if self.is_closed_by_lid {
            let help = "the weight of a liquid does not act on a lid: remove gravity, or close the chamber by walls of the body or by triangles";
            return Err(InputError::new(self.input("closed_by_lid"), true, help));
        }
        let mesh = body.mesh();
        let (factor, section) = match &force.geometry {
            Geometry::Polygon(_, factor) => (factor, Some(factor.abs())),
            Geometry::Surface(_, factor) | Geometry::Circles(_, factor) => (factor, None),
        };
        let faces = match (&self.walls, body.dimension()) {
            (Walls::Nodes(nodes), 2) => self.edges(body, nodes)?,
            (Walls::Nodes(nodes), _) => self.boundary(mesh, nodes)?,
            (Walls::Triangles(triangles), _) => {
                triangles.iter().map(|triangle| triangle.map(|node| node - 1).to_vec()).collect()
            }
        };
        let kind = |face: &Face| match (section, face.len()) {
            (Some(_), 2) => FaceKind::Segment,
            (Some(_), _) => FaceKind::Segment3,
            (None, _) => mesh.face_kind(face),
        };
        let faces =
            faces.into_iter().map(|nodes| LoadedFace { kind: kind(&nodes), nodes, section });
        let faces = FollowedFaces::new(mesh, faces.collect());
        let faces = faces.map_err(|help| InputError::new(self.input("walls"), "flat", help))?;
        Ok(Moment::new(faces, down, factor.signum()))
    }

    /// The walls, whose force is `force`, as what a liquid with a level surface stands in; `down`, of length 1, is where gravity leads.
    ///
    /// # Errors
    /// As [`force`](Self::force).
    pub(crate) fn basin(
        &self,
        body: &Body,
        force: &ChamberForce,
        down: [f64; 3],
    ) -> Result<Basin, InputError> {
        body.refuse_around(&self.input("liquid"), "with weight")?;
        let mesh = body.mesh();
        let (Geometry::Polygon(_, factor)
        | Geometry::Surface(_, factor)
        | Geometry::Circles(_, factor)) = force.geometry;
        Ok(match (&self.walls, body.dimension()) {
            (Walls::Nodes(nodes), 2) => {
                let edges = edge_parts(&self.edges(body, nodes)?, Shape::Straight);
                Basin::new(mesh, edges, factor, down)
            }
            (Walls::Nodes(nodes), _) => {
                Basin::new(mesh, self.faces(mesh, nodes, Shape::Straight)?, factor, down)
            }
            (Walls::Triangles(triangles), _) => {
                Basin::new(mesh, self.triangles(mesh, triangles)?, factor, down)
            }
        })
    }
}
