//! Which bodies touch, and how.

use super::edge_pairs::Edges;
use super::force::TouchForce;
use super::law::{Kind, NormalLaw};
use super::near::{Near, NearPair};
use super::site::{Parts, TouchSite, way};
use super::surfaces::Surfaces;
use crate::base::input::{InputError, not_negative, positive};
use crate::elements::body::Body;
use crate::scene::forces::friction::Friction;

/// Contact of bodies with each other, or of a body with itself.
///
/// Surfaces closer than the [contact distance](Self::distance) D repel each other, with equal and opposite forces.
/// With the distance d between them the pressure is
///
/// ```text
/// barrier:  k (D - d)^2 (D + 2 d)/(3 d^2)       spring:  k (D - d)
/// ```
///
/// per area of the undeformed surfaces, acting at points of both. In space, edges that cross each other repel each other, too, with
/// the same law for D/2, also where no point is near. The barrier, which is the default, grows without bound as d goes to 0, so that
/// surfaces never pass through each other, and sets in smoothly. A step that would pass through a surface between its
/// ends is repeated in parts. The spring is softer: at pressures above k D surfaces pass through each other, which the overlap
/// [indicator](crate::Indicator) of a run reports.
///
/// Damping adds the pressure -c d' times the curvature of the energy over k, so that it sets in as smoothly; separating surfaces
/// do not stick to each other. Friction is that of [obstacles](crate::Obstacle#friction), with the sliding velocity
/// between the surfaces.
///
/// Rods touch as round tubes about their axes, with the radius of their section; in the plane this holds for every section.
///
/// ```
/// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings, Touch};
///
/// let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
/// let block = |name, x: f64| {
///     let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Triangles)?.translated(&[x, 0.0])?;
///     Body::new(mesh, soft).thickness(0.01).named(name).build()
/// };
/// let bodies = Body::join([block("left", 0.0)?, block("right", 0.12)?])?;
/// let scene = Scene::new(bodies)
///     .touch(Touch::all().distance(2e-3))
///     .initial_velocity(|x| vec![if x[0] < 0.11 { 0.5 } else { 0.0 }, 0.0])
///     .phase(Phase::until(0.2));
/// let motion = scene.simulate(&Settings::default(), &Sampling::every(0.1))?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Touch {
    name: String,
    bodies: Vec<String>,
    kind: Kind,
    stiffness: Option<f64>,
    distance: Option<f64>,
    damping: f64,
    friction: Friction,
}

/// How near bodies may begin, over D.
const LEAST: f64 = 1e-3;
/// The least D of bodies that are near each other undeformed, over that of others.
const NEAREST: f64 = 0.01;
/// How much farther than D pairs are looked for, at least, over the mean side of facets.
const MARGIN: f64 = 0.2;

impl Touch {
    /// All bodies of a scene touch each other, and each of them itself.
    pub fn all() -> Self {
        Self {
            name: "touch".into(),
            bodies: Vec::new(),
            kind: Kind::Barrier,
            stiffness: None,
            distance: None,
            damping: 0.0,
            friction: Friction::default(),
        }
    }

    /// The bodies with these names touch each other; a single one touches itself.
    pub fn between(bodies: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { bodies: bodies.into_iter().map(Into::into).collect(), ..Self::all() }
    }

    /// Its name (default: "touch"), for sensors and messages.
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The pressure grows in proportion to D - d, and surfaces may be pressed through each other.
    pub fn spring(mut self) -> Self {
        self.kind = Kind::Spring;
        self
    }

    /// Stiffness k (N/m^3), above 0. Default: a tenth of the least of Young's moduli over D; all of it for a
    /// [`spring`](Self::spring). Between rigid bodies k D is at most the larger of 40 times their weight over a quarter of their surface, and the value that
    /// stops their initial speeds within two thirds of D: a stiffer contact would move by less than a run resolves.
    pub fn stiffness_density(mut self, stiffness: f64) -> Self {
        self.stiffness = Some(stiffness);
        self
    }

    /// The distance D (m) beyond which there is no force, above 0: bodies come to rest at a fraction of it from each other.
    /// Default: a tenth of the mean edge of the surfaces and of the thickness (2 V/A) of the thinnest body; of bars in one dimension, a
    /// hundredth of their size. Undeformed bodies that are nearer than that to each other have their gap as D, down to a hundredth of
    /// it, so that there is no contact force at the start.
    pub fn distance(mut self, distance: f64) -> Self {
        self.distance = Some(distance);
        self
    }

    /// Damping c (N s/m^3) of the normal motion, 0 or above (default: 0).
    pub fn damping_density(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// Coefficient mu of Coulomb's friction, static and kinetic, 0 or above (default: no friction).
    pub fn friction_coefficient(self, coefficient: f64) -> Self {
        self.friction_coefficients(coefficient, coefficient)
    }

    /// Coefficients of Coulomb's friction: `at_rest` (mu_s, static) while it sticks, `sliding` (mu_k, kinetic), not
    /// above it, once it slides.
    pub fn friction_coefficients(mut self, at_rest: f64, sliding: f64) -> Self {
        self.friction.coefficients = Some([at_rest, sliding]);
        self
    }

    /// The sliding speed v0 (m/s) below which friction sticks, above 0; with friction coefficients only. Default: a
    /// thousandth of the size of the bodies per second, and of the differences of their initial velocities.
    pub fn sticking_speed(mut self, speed: f64) -> Self {
        self.friction.sticking_speed = Some(speed);
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// v0 (m/s), by default of a `way` (m) in a second; `None` without friction.
    pub(crate) fn sticks_below(&self, way: f64) -> Option<f64> {
        let coulomb = self.friction.coulomb(way).filter(|_| self.friction.acts());
        coulomb.map(|coulomb| coulomb.sticking_speed)
    }

    /// Whether the bodies with these names feel each other, or, if they are one, itself.
    pub(crate) fn is_between(&self, names: [&str; 2]) -> bool {
        let has = |name: &str| self.bodies.iter().any(|body| body == name);
        let itself = names[0] == names[1];
        self.bodies.is_empty()
            || names.iter().all(|name| has(name)) && (!itself || self.bodies.len() == 1)
    }

    /// Whether it is of the body with this name.
    pub(crate) fn is_of(&self, name: &str) -> bool {
        self.bodies.is_empty() || self.bodies.iter().any(|body| body == name)
    }

    /// Its properties but for its name and its bodies, as a text.
    pub(crate) fn likeness(&self) -> String {
        let (name, bodies) = (String::new(), Vec::new());
        format!("{:?}", Self { name, bodies, ..self.clone() })
    }

    /// Whether its distance is the default.
    pub(super) fn has_default_distance(&self) -> bool {
        self.distance.is_none()
    }

    /// Whether its pressure grows without bound.
    pub(crate) fn is_barrier(&self) -> bool {
        self.kind == Kind::Barrier
    }

    /// The same touch with the numbers that it has on `body` by default, for a body with a finer mesh.
    pub(crate) fn with_numbers_of(mut self, force: &TouchForce) -> Self {
        (self.distance, self.stiffness) = (Some(force.law.distance), Some(force.law.stiffness));
        self
    }

    /// Its forces on the bodies of a scene.
    ///
    /// # Errors
    /// Names that are not there, numbers that make no sense, bodies without a surface or that lie on each other.
    pub(crate) fn force(&self, site: &TouchSite<'_>) -> Result<TouchForce, InputError> {
        let parts = self.parts(site.body)?;
        let surfaces = Surfaces::new(site.body, &parts.numbers, parts.itself, site.planes)
            .map_err(|[value, help]| InputError::new(self.input("bodies"), value, help))?;
        let usual = site.usual_distance(&surfaces, &parts);
        let mut force =
            self.force_within(site, &parts, surfaces, self.distance.unwrap_or(usual))?;
        if self.distance.is_none()
            && let Some((gap, _)) = force.nearest(&vec![0.0; site.body.dofs()])
        {
            let nearer = gap.max(NEAREST * usual);
            force = self.force_within(site, &parts, force.surfaces, nearer)?;
        }
        self.check_start(site.body, &force, site.u)?;
        Ok(force)
    }

    /// The numbers of the bodies that touch.
    fn parts(&self, body: &Body) -> Result<Parts, InputError> {
        let parts: Vec<_> = body.parts().collect();
        let mut numbers = Vec::new();
        for name in &self.bodies {
            let nodes = body.part_named(name, &self.input("bodies"))?.nodes;
            numbers.extend(parts.iter().position(|part| part.nodes == nodes));
        }
        if self.bodies.is_empty() {
            numbers.extend(0..parts.len());
        }
        numbers.sort_unstable();
        numbers.dedup();
        let itself = self.bodies.is_empty() || numbers.len() == 1;
        Ok(Parts { numbers, itself })
    }

    /// The forces of `surfaces` that feel each other within a `distance` (m).
    fn force_within(
        &self,
        site: &TouchSite<'_>,
        parts: &Parts,
        mut surfaces: Surfaces,
        distance: f64,
    ) -> Result<TouchForce, InputError> {
        let input = |key: &str| self.input(key);
        let stiffness = self
            .stiffness
            .unwrap_or_else(|| site.usual_stiffness(&surfaces, parts, self.kind, distance));
        positive(&input("distance"), distance, "m")?;
        positive(&input("stiffness_density"), stiffness, "N/m^3")?;
        not_negative(&input("damping_density"), self.damping, "N s/m^3")?;
        self.friction.validate(&input)?;
        let law = NormalLaw { kind: self.kind, stiffness, damping: self.damping, distance };
        let mut edges = Edges::new(&surfaces, &law);
        surfaces.feel_all();
        if parts.itself || !site.glued.is_empty() {
            let rest = vec![0.0; site.body.dofs()];
            let near = Near::new(&surfaces, &edges, &rest, 2.0 * distance);
            let is_left_out = |near: &NearPair| {
                site.is_joined(surfaces.bodies(near.point, near.feature))
                    && surfaces.is_facet(near.feature)
                    && surfaces.apart(near.point, near.feature, &rest) <= 2.0 * distance
            };
            let pairs = near.pairs.into_iter().filter(is_left_out);
            let pairs: Vec<[usize; 2]> = pairs.map(|near| [near.point, near.feature]).collect();
            edges.leave_out(&surfaces, &near.edges, |bodies| site.is_joined(bodies));
            surfaces.leave_out(&pairs);
        }
        let coulomb = self.friction.coulomb(way(site.body, site.v));
        let margin = distance.max(MARGIN * surfaces.mean_side());
        Ok(TouchForce::new(self.name.clone(), (surfaces, edges), law, coulomb, margin, site.u))
    }

    fn input(&self, key: &str) -> String {
        format!("touch \"{}\" {key}", self.name)
    }

    fn check_start(&self, body: &Body, force: &TouchForce, u: &[f64]) -> Result<(), InputError> {
        let Some((apart, nodes)) = force.nearest(u) else { return Ok(()) };
        let least = LEAST * force.law.distance;
        if apart >= least {
            return Ok(());
        }
        let names = nodes.map(|node| body.part_of(node).name.to_owned());
        let help = format!(
            "surfaces that touch must begin at least {least:.1e} m apart (at node {} of \"{}\" and node {} of \"{}\"): move the bodies \
             apart, tie them, or leave them out of the touch",
            nodes[0] + 1,
            names[0],
            nodes[1] + 1,
            names[1]
        );
        Err(InputError::new(self.input("distance at the start"), format!("{apart:.1e} m"), help))
    }
}
