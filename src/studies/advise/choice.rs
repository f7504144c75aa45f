//! A model of a scene, and how it is integrated.

use std::fmt;

use crate::base::input::InputError;
use crate::elements::body::{Body, BodyBuilder, Dilatation, Inertia, Strain};
use crate::elements::material::Material;
use crate::elements::mesh::CellKind;
use crate::scene::settings::{ContactEvents, Settings};
use crate::scene::timeline::{Scene, Term};

/// Modelling choices for a scene: terms, measure of strain, mesh and integration.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Measure of strain.
    pub strain: Strain,
    /// Cells with more nodes; none as they were written.
    pub richer: Option<RicherCells>,
    /// Number of divisions of each cell: see [`Scene::halved`].
    pub halved: usize,
    /// Cells (from 0) that are divided after that, time after time: see [`Scene::halved_in`].
    pub halved_in: Vec<Vec<usize>>,
    /// Distribution of inertia to the nodes.
    pub inertia: Inertia,
    /// Whether all bodies are rigid: see [`Material::rigid`].
    pub is_rigid: bool,
    /// Omitted terms.
    pub without: Vec<Term>,
    /// Whether the equilibrium of the last phase, as `pliant static` finds it, replaces the end of the
    /// motion.
    pub is_static: bool,
    /// Its settings.
    pub settings: Settings,
}

impl Choice {
    /// The scene as it was written.
    pub(super) fn written(scene: &Scene, settings: &Settings) -> Self {
        let body = scene.body();
        Self {
            strain: body.strain(),
            richer: None,
            halved: 0,
            halved_in: Vec::new(),
            inertia: body.inertia_kind(),
            is_rigid: false,
            without: Vec::new(),
            is_static: false,
            settings: settings.clone(),
        }
    }

    /// The scene as it is modelled by this choice; `written` is the scene as it was written.
    ///
    /// # Errors
    /// A scene that cannot be on another mesh: see [`Scene::halved`].
    pub fn scene(&self, written: &Scene) -> Result<Scene, InputError> {
        let (strain, inertia) = (self.strain, self.inertia);
        let mut scene = match (written.body().strain(), written.body().inertia_kind()) {
            own if own == (strain, inertia) => written.clone(),
            _ => written.with_body(|body| body.strain(strain).inertia(inertia))?,
        };
        let RicherCells { bubbles, linear } = self.richer.unwrap_or_default();
        if self.richer.is_some() && !bubbles {
            scene = scene.quadratic()?;
        }
        for _ in 0..self.halved {
            scene = scene.halved()?;
        }
        for cells in &self.halved_in {
            scene = scene.halved_in(cells)?;
        }
        if bubbles {
            scene = scene.with_bubbles()?;
        }
        if linear {
            scene = scene.with_body(|body| body.dilatation(Dilatation::Linear))?;
        }
        if self.is_rigid {
            scene = scene.with_body(BodyBuilder::all_rigid)?;
        }
        self.without.iter().try_fold(scene, |scene, term| scene.without(term))
    }

    /// Whether both are the same model on the same mesh, however they are integrated.
    pub(super) fn is_model_of(&self, other: &Self) -> bool {
        let settings = other.settings.clone();
        let alpha = self.settings.alpha == other.settings.alpha;
        alpha && Self { settings, ..self.clone() } == *other
    }

    /// Whether it is a motion of bodies that are not all rigid: one that may have a smaller model.
    pub(super) fn is_of_soft_motion(&self) -> bool {
        !self.is_static && !self.is_rigid
    }

    /// Whether it is on the mesh as it was written.
    pub(super) fn is_mesh_as_written(&self) -> bool {
        (self.richer, self.halved) == (None, 0) && self.halved_in.is_empty()
    }

    /// Whether both are on the same mesh.
    pub(super) fn is_mesh_of(&self, other: &Self) -> bool {
        (self.richer, self.halved, &self.halved_in)
            == (other.richer, other.halved, &other.halved_in)
    }

    /// Overrides in a scene file for this choice, as `--set` takes them; the file makes the scene `written`
    /// with `settings`.
    pub(super) fn overrides(&self, written: &Scene, settings: &Settings) -> Vec<String> {
        let mut sets = Vec::new();
        let body = written.body();
        // the tables of several bodies have numbers
        let tables: Vec<String> = match body.is_single() {
            true => vec!["body".into()],
            false => (1..=body.parts().count()).map(|number| format!("body.{number}")).collect(),
        };
        if self.strain != body.strain() {
            let strain = match self.strain {
                Strain::Cauchy => "cauchy",
                Strain::Green => "green",
            };
            sets.extend(tables.iter().map(|table| format!("{table}.strain={strain}")));
        }
        if let Some(RicherCells { bubbles, linear }) = self.richer {
            let key = if bubbles { "bubbles" } else { "quadratic" };
            sets.push(format!("body.mesh.{key}=true"));
            if linear {
                sets.push("body.dilatation=linear".into());
            }
        }
        if self.halved > 0 {
            sets.push(format!("body.mesh.halved={}", self.halved));
        }
        if !self.halved_in.is_empty() {
            let places = self.halved_in.iter().map(|cells| {
                let numbers = cells.iter().map(|cell| (cell + 1).to_string());
                format!("{{ cells = [{}] }}", numbers.collect::<Vec<_>>().join(", "))
            });
            sets.push(format!("body.mesh.halved_in=[{}]", places.collect::<Vec<_>>().join(", ")));
        }
        if self.inertia != body.inertia_kind() {
            let inertia = match self.inertia {
                Inertia::Consistent => "consistent",
                Inertia::Lumped => "lumped",
            };
            sets.extend(tables.iter().map(|table| format!("{table}.inertia={inertia}")));
        }
        let numbers = |count: usize| (1..=count).map(|number| number.to_string());
        if self.is_rigid {
            for (table, part) in tables.iter().zip(body.parts()) {
                let regions = numbers(part.body.region_count());
                let own = regions.map(|k| format!("{table}.region.{k}"));
                let all = std::iter::once(table.clone()).chain(own);
                sets.extend(all.map(|part| format!("{part}.material.rigid=true")));
            }
        }
        for term in &self.without {
            match term {
                Term::Gravity => {
                    let zero = format!("gravity={:?}", vec![0.0; body.dimension()]);
                    let phases = numbers(written.phases().len()).zip(written.phases());
                    let own = phases.filter(|(_, phase)| phase.has_gravity());
                    sets.push(zero.clone());
                    sets.extend(own.map(|(number, _)| format!("phase.{number}.{zero}")));
                }
                Term::Viscosity => {
                    for (table, part) in tables.iter().zip(body.parts()) {
                        sets.push(format!("{table}.material.viscosity=0"));
                        let regions = numbers(part.body.region_count());
                        let own = |k| format!("{table}.region.{k}.material.viscosity=0");
                        sets.extend(regions.map(own));
                    }
                }
                Term::Friction => {
                    for (number, obstacle) in numbers(usize::MAX).zip(written.obstacles()) {
                        if obstacle.has_friction() {
                            sets.push(format!("obstacle.{number}.friction_coefficient=0"));
                        }
                        if obstacle.has_bristles() {
                            sets.push(format!("obstacle.{number}.backward.friction_coefficient=0"));
                        }
                        if obstacle.has_tangential_damping() {
                            sets.push(format!("obstacle.{number}.tangential_damping=0"));
                        }
                    }
                }
                Term::Obstacle(name) => {
                    for (number, phase) in numbers(usize::MAX).zip(written.phases()) {
                        let acting = phase.contacts(written.obstacles()).unwrap_or_default();
                        let rest = acting.iter().map(|obstacle| obstacle.name());
                        let rest: Vec<&str> = rest.filter(|other| other != name).collect();
                        sets.push(match rest.is_empty() {
                            true => format!("phase.{number}.contact=false"),
                            false => format!("phase.{number}.contact={rest:?}"),
                        });
                    }
                }
            }
        }
        if self.is_static {
            return sets;
        }
        sets.push(format!("solver.method={}", self.settings.method));
        sets.push(format!("solver.rtol={:e}", self.settings.rtol));
        let own = self.settings.tolerances(written);
        if settings.atol_position.is_some() && self.settings.atol_position.is_none() {
            sets.push(format!("solver.atol_position={:e}", own.position));
        }
        if settings.atol_velocity.is_some() && self.settings.atol_velocity.is_none() {
            sets.push(format!("solver.atol_velocity={:e}", own.velocity));
        }
        if self.settings.alpha != settings.alpha {
            sets.push(format!("solver.alpha={:e}", self.settings.alpha));
        }
        if self.settings.contact_events != settings.contact_events {
            sets.push(format!("solver.contact_events={}", self.settings.contact_events));
        }
        sets
    }

    /// The mesh in words: differences from the one as written.
    pub(super) fn mesh(&self) -> String {
        let richer = self.richer.map(|richer| richer.to_string());
        let halved = (self.halved > 0).then(|| format!("cells halved {}", times(self.halved)));
        let locally = (!self.halved_in.is_empty()).then(|| {
            let begin = if self.halved == 0 { "cells halved" } else { "then" };
            format!("{begin} {} where strains jump", times(self.halved_in.len()))
        });
        let all: Vec<String> = [richer, halved, locally].into_iter().flatten().collect();
        match all.is_empty() {
            true => "the mesh as written".into(),
            false => all.join(", "),
        }
    }
}

/// Enrichment of cells: mid nodes ([`Scene::quadratic`]) and, in nearly incompressible bodies, measures against locking.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RicherCells {
    /// Whether triangles and tetrahedra get bubbles, too: see [`Scene::with_bubbles`].
    pub bubbles: bool,
    /// Whether the dilatation becomes linear: see [`Dilatation::Linear`].
    pub linear: bool,
}

impl fmt::Display for RicherCells {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.bubbles { "quadratic cells with bubbles" } else { "quadratic cells" })
    }
}

impl RicherCells {
    /// Those of a body as it was written; `None` if its cells have them already, or there are none.
    pub(super) fn of(body: &Body) -> Option<Self> {
        let kind = body.mesh().kind();
        let linear = body.can_lock() && body.materials().any(Material::is_nearly_incompressible);
        match kind {
            CellKind::Triangle | CellKind::Quadrilateral | CellKind::Tetrahedron => {
                Some(Self { bubbles: linear, linear })
            }
            CellKind::Hexahedron => Some(Self { bubbles: false, linear }),
            _ => None,
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let strain = match self.strain {
            Strain::Cauchy => "Cauchy",
            Strain::Green => "Green",
        };
        match self.is_rigid {
            true => f.write_str("all rigid")?,
            false => write!(f, "{strain} strain")?,
        }
        if !self.is_mesh_as_written() {
            write!(f, ", {}", self.mesh())?;
        }
        if self.inertia == Inertia::Lumped {
            f.write_str(", lumped inertia")?;
        }
        for term in &self.without {
            write!(f, ", no {term}")?;
        }
        if self.is_static {
            return f.write_str(", in equilibrium (pliant static)");
        }
        let Settings { method, rtol, alpha, contact_events, .. } = self.settings;
        write!(f, ", {method} at rtol {rtol:.0e}")?;
        if alpha != Settings::default().alpha {
            write!(f, ", alpha {alpha:e}")?;
        }
        match contact_events {
            ContactEvents::Auto => Ok(()),
            ContactEvents::Locate => f.write_str(", contact events located"),
            ContactEvents::StepOver => f.write_str(", contact events stepped over"),
        }
    }
}

/// A number of times in words.
fn times(count: usize) -> String {
    match count {
        1 => "once".into(),
        2 => "twice".into(),
        count => format!("{count} times"),
    }
}
