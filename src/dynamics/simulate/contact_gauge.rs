//! How quantities of a contact are read: its force, the area in touch, the largest pressure.

use super::reading::ContactSource;
use super::view::View;
use crate::base::input::InputError;
use crate::dynamics::trajectory::Sample;
use crate::elements::mesh::Selection;
use crate::integrators::ode::Failure;
use crate::scene::forces::{Contact, NodalContact, TouchForce, Tributary};
use crate::scene::timeline::{Phase, Scene};

/// Reads a contact on some nodes.
pub(super) struct ContactGauge {
    acting: Acting,
    nodes: Vec<usize>,
    /// Which nodes these are, unless all are.
    is_read: Option<Vec<bool>>,
    tributary: Tributary,
}

/// Source of a contact.
enum Acting {
    Obstacle(Box<ActingObstacle>),
    Touch(Box<TouchForce>),
}

/// The contact with an obstacle, and how often each phase of the scene names it.
struct ActingObstacle {
    name: String,
    contact: Contact,
    times: Vec<usize>,
}

impl ContactGauge {
    /// Of what acts on some nodes; by default on all, by a touch on those of a body.
    ///
    /// # Errors
    /// Names and nodes that the scene does not have; a touch of which nothing says on what it acts.
    pub(super) fn new(
        scene: &Scene,
        by: &ContactSource,
        nodes: Option<&Selection>,
        of_body: Option<&str>,
    ) -> Result<Self, InputError> {
        let body = scene.body();
        let acting = match by {
            ContactSource::Obstacle(name) => {
                Acting::Obstacle(Box::new(ActingObstacle::new(scene, name)?))
            }
            ContactSource::Touch(name) => {
                Acting::Touch(Box::new(scene.touch_force(name, "touch")?))
            }
        };
        let count = body.mesh().node_count();
        let nodes: Vec<usize> = match (nodes, of_body, by) {
            (Some(nodes), ..) => body.mesh().select(nodes)?,
            (None, Some(name), _) => body.part_named(name, "body")?.nodes.collect(),
            (None, None, ContactSource::Obstacle(_)) => (0..count).collect(),
            (None, None, ContactSource::Touch(_)) => {
                let help =
                    "a touch acts on both sides: name the body or the nodes on which it is read";
                return Err(InputError::new("body", "missing", help));
            }
        };
        let mut is_read = vec![false; count];
        nodes.iter().for_each(|&node| is_read[node] = true);
        let is_read = is_read.contains(&false).then_some(is_read);
        let tributary = Tributary::new(body, &scene.planes_of_symmetry()?);
        Ok(Self { acting, nodes, is_read, tributary })
    }

    /// Force (N) on the nodes together; NaN where it is undefined.
    pub(super) fn force(&self, view: &View, sample: &Sample) -> [f64; 3] {
        self.acting.force(view, sample, self.is_read.as_deref()).unwrap_or([f64::NAN; 3])
    }

    /// Area (m^2) in touch at the nodes.
    pub(super) fn area(&self, view: &View, sample: &Sample) -> f64 {
        self.over_nodes(view, sample, |nodal| nodal.map(NodalContact::area).sum())
    }

    /// The largest pressure (Pa) at the nodes.
    pub(super) fn pressure(&self, view: &View, sample: &Sample) -> f64 {
        self.over_nodes(view, sample, |nodal| nodal.map(NodalContact::pressure).fold(0.0, f64::max))
    }

    fn over_nodes(
        &self,
        view: &View,
        sample: &Sample,
        number: fn(&mut dyn Iterator<Item = &NodalContact>) -> f64,
    ) -> f64 {
        let nodal = self.acting.nodal(view, sample, &self.tributary);
        nodal.map_or(f64::NAN, |nodal| number(&mut self.nodes.iter().map(|&node| &nodal[node])))
    }
}

impl Acting {
    /// Force (N) on the nodes that `is_read` names; `None` where it is undefined.
    fn force(&self, view: &View, sample: &Sample, is_read: Option<&[bool]>) -> Option<[f64; 3]> {
        let (t, u, v) = (sample.time, view.displacements(), view.velocities());
        match self {
            Self::Touch(_) if !view.phase.has_touch => Some([0.0; 3]),
            Self::Touch(touch) => Some(touch.force(u, v, is_read)),
            Self::Obstacle(obstacle) => {
                let mut total = [0.0; 3];
                obstacle.each(view, sample, |contact| {
                    let force = contact.force(t, u, v, is_read)?;
                    total.iter_mut().zip(force).for_each(|(total, force)| *total += force);
                    Ok(())
                })?;
                Some(total)
            }
        }
    }

    /// Contact quantities of all nodes; `None` where they are undefined.
    fn nodal(
        &self,
        view: &View,
        sample: &Sample,
        tributary: &Tributary,
    ) -> Option<Vec<NodalContact>> {
        let (t, at) = (sample.time, [view.displacements(), view.velocities()]);
        let mut nodal = vec![NodalContact::default(); tributary.node_count()];
        match self {
            Self::Touch(_) if !view.phase.has_touch => {}
            Self::Touch(touch) => touch.add_nodal(at, tributary, &mut nodal).ok()?,
            Self::Obstacle(obstacle) => obstacle
                .each(view, sample, |contact| contact.add_nodal(t, at, tributary, &mut nodal))?,
        }
        tributary.even_out(&mut nodal);
        Some(nodal)
    }
}

impl ActingObstacle {
    fn new(scene: &Scene, name: &str) -> Result<Self, InputError> {
        let number = scene.obstacle_number(name, "obstacle")?;
        let contact = Contact::new(scene.body(), &scene.obstacles()[number])?;
        let acts = |phase: &Phase| {
            let acting = phase.contacts(scene.obstacles())?;
            Ok(acting.iter().filter(|acting| acting.name() == name).count())
        };
        let times = scene.phases().iter().map(acts).collect::<Result<_, InputError>>()?;
        Ok(Self { name: name.to_owned(), contact, times })
    }

    /// Passes the contact to `see` as it acts at a sample: that of the scene, unless commands have changed the phase.
    /// `None` where that fails.
    fn each(
        &self,
        view: &View,
        sample: &Sample,
        mut see: impl FnMut(&Contact) -> Result<(), Failure>,
    ) -> Option<()> {
        if let (None, Some(&times)) = (&sample.commanded.0, self.times.get(sample.phase)) {
            return (0..times).try_for_each(|_| see(&self.contact).ok());
        }
        let acting = view.phase.contacts(view.scene.obstacles()).ok()?;
        acting
            .into_iter()
            .filter(|obstacle| obstacle.name() == self.name)
            .try_for_each(|obstacle| see(&Contact::new(view.body(), obstacle).ok()?).ok())
    }
}
