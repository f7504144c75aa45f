//! Contact of bodies with each other and with themselves: points of one surface against the facets of another, and edges
//! against edges in space.
//!
//! The energy is an integral over both surfaces. At a quadrature point x of a surface, which stands for the area a,
//!
//! ```text
//! p a sum_i w_i phi(d_i(x))
//! ```
//!
//! with the part p that the points of its surface have, the distances d_i from the facets (segments in the plane, triangles
//! in space), edges and corners of the other surface, and the [law](law::NormalLaw) phi, 0 from
//! the contact distance on. The weights are those of inclusion and
//! exclusion: 1 for a facet, 1 less the number of its facets for an edge, and what makes the sum 1 for a corner. Where
//! the surface is flat or convex all terms but that of the nearest point cancel, so that a point which slides over an
//! edge is pushed as by a smooth surface (M. Li, Z. Ferguson, T. Schneider et al., *Convergent incremental potential
//! contact*, arXiv 2307.15908 (2023)). Forces are continuous, and have an energy and exact tangents ([`pair`]).
//!
//! Edges that cross edges between these points have an energy of their own ([`edge_pairs`]). Rods are tubes ([`tubes`]).
//!
//! The points of each surface have half of the energy where meshes are alike, so that no decision on sides or facets is needed.
//! Those of a coarse surface, which stand for more than lies over them and would press on single nodes, have less: where its
//! facets are r > 2 times as large, 1/(1 + (r/2)^4). Flat parts of a rigid surface count as 8 times as large opposite a body that yields, which then
//! bears an even pressure evenly; points at edges of such a body bear on the mean of the areas seen along the normals of the faces around them.
//! Facets are as curved as their shape functions make them (`elements/basis/nearest.rs`: Newton's method for
//! the nearest place within the face, else that of its edges and corners), so that points and the places
//! opposite them load nodes alike. Damping and friction act pair by pair, with exact derivatives. Distances
//! have no sign: a thin sheet is felt from both sides, and what has got through would be pushed on, hence the
//! barrier k (D - d)^3/(3 d), which grows as 1/d. Its curvature begins with 0, so that no event has to be
//! located. Quadrature points are the nodes and points between them (Simpson's rule on both halves of an
//! edge; a rule of degree 3 on triangles, with the middles of sides and faces): Gauss points leave corners
//! that stick out between them. In the plane no surfaces cross without a node that crosses a facet; in space
//! edges can. Reasons and alternatives are in `docs/decisions/0007-contact-by-an-energy.md`.

mod action;
mod crossing;
mod edge_pairs;
mod force;
mod hull;
mod law;
mod near;
mod nodal;
mod pair;
mod passing;
mod site;
mod spec;
mod surfaces;
#[cfg(test)]
mod tests;
mod told;
mod tubes;
mod window;

pub(crate) use force::TouchForce;
pub(crate) use site::{TouchSite, way};
pub use spec::Touch;
pub use told::TouchDistance;
