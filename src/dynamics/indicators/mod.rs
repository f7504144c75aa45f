//! Indicators: numbers measured on a scene and on its motion, each with the limit beyond which the result is
//! doubtful, and the remedy. They are evaluated before a run or after it, never during it, except for depths in
//! obstacles, which [`penetration`] follows from step to step.
//!
//! | indicator | limit |
//! | --- | --- |
//! | [`units`]: size and mass of the body, speed of waves in it | 10 m, 10 t, 0.1 to 10,000 m/s |
//! | [`units`]: density, modulus (of rubber) | 5 to 25,000 kg/m^3, 2e12 Pa (1e8 Pa) |
//! | [`units`]: thickness over size; strain of a column under its own weight | 20; 100 % |
//! | [`units`]: remanence of magnets, magnetic field, limits of inputs of devices | 2 T, 10 T, 1e4 A m^2 |
//! | [`gas`]: least absolute pressure; orifices relative to their chambers | 5e4 Pa; a face of a cube as large |
//! | [`mesh`]: Poisson's ratio of linear cells | 0.45 |
//! | [`mesh`]: separate pieces | one piece |
//! | [`arched`]: cells of curved walls of one layer, relative to sqrt(R t) | 1 |
//! | [`rods`]: reach of a rod's section over the radius of curvature in an element | 1 |
//! | [`rods`]: length of a rod over its width | at least 3 |
//! | [`faceted`]: error of the facets of a mesh from a file that approximate curves | 2 % |
//! | [`conformity`]: hanging nodes, and separate nodes in the same position | none |
//! | [`overlap`]: depth of overlaps of the body with itself, at the start and in motion | a twentieth of a cell |
//! | [`strain`]: rotation of cells under Cauchy strain | 10 degrees |
//! | [`strain`]: inverted cells under Cauchy strain | none |
//! | [`coarse`]: excess stiffness of linear cells at their strains | 1.25 times; quadrilaterals and hexahedra 1.1 times |
//! | [`early`]: tables that end before their phase, and act as a step | none |
//! | [`pressed`]: energy of bodies that begin within the distance of their touch | 3 times that of bodies that lie on each other |
//! | [`touch`]: depth of nodes inside obstacles, at the start and later | half a cell, 2 % of the body; half of the thickness of the body, a quarter of that of the obstacle |
//! | [`touch`]: points that passed the middle of an obstacle | none |
//! | [`touch`]: depth of the surface between nodes inside obstacles | as nodes |
//! | [`touch`]: friction of bodies or obstacles in statics, where it does not act | none |
//! | [`touch`]: obstacles that act and are never touched | none |
//! | [`creep`]: creep of surfaces that stick by friction | 1 % of the distance that nodes travel |
//! | [`start`]: unknowns that the scene or its initial state lacks | none |
//! | [`chamber`]: the least volume of a chamber | 0 |
//! | [`pace`]: absolute tolerance of displacements | 1 % of the distance that nodes travel, or 10 `rtol` |
//! | [`pace`]: drift of constraints after the starts of phases | 0.1 % of the distance that nodes travel |
//! | [`pace`]: distance of the beginnings of paths from their nodes | 1 % of the distance that nodes travel |
//! | [`reduced`]: estimated error of a run by a reduced model | twice the requested error |
//! | [`reduced`]: distance outside the training range of the model | 5 % of the range |
//!
//! These are measured at the end of each run, and before it if they need no motion. Others take longer, or do
//! not cause a warning by themselves: [`Trajectory::indicators`], `pliant check --look`. (+) means that a
//! simpler model suffices below the limit.
//!
//! | indicator | limit |
//! | --- | --- |
//! | [`deformed`]: largest strain, by which the stress of a law differs from rubber's | 10 % (Green), 25 % (Cauchy) |
//! | [`deformed`]: error of Cauchy strain in place of Green's (+) | 1 % of the strains |
//! | [`deformed`]: rotation of cells relative to the body; [`shape`]: slenderness | |
//! | [`shape`]: layers of cells across a slender body that bends | 4 of simplices, 2 of others, 1 quadratic |
//! | [`waves`]: cells in a wavelength of the motion | 6 linear, 3 quadratic |
//! | [`points`]: single nodes that are loaded or held so much that the mesh matters | none |
//! | [`pace`]: largest drift of constraints | 0.1 % of the distance that nodes travel |
//! | [`felt`]: depth in obstacles | 10 % of the distance that nodes travel |
//! | [`felt`]: forces of friction (+) | 1 % of the normal forces |
//! | [`pace`]: kinetic energy (+) | 1 % of the stored energy |
//! | [`pace`]: damping of the lowest vibration, and ratio of the fastest motion of the mesh to it | |
//! | [`symmetry`]: deviation from a plane motion (+) | 1 % |
//! | [`symmetry`]: deviation from the mirror images (+) | 0.1 % |
//!
//! They are evaluated at 200 samples at most, fewer on large meshes, so that they have no influence on
//! steps and results. An obstacle counts as never touched only if the body was farther from it at all samples
//! than it can have come nearer in between, by its largest speed and gravity. Rotations and wavelengths are
//! relative to the motion of the body as a whole: the rotation by Kabsch, the spin by the angular momentum.
//! The texts of indicators in doubt are the warnings.

mod arched;
mod bending;
mod chamber;
mod coarse;
mod conformity;
mod creep;
mod deformed;
mod each;
mod early;
mod faceted;
mod felt;
mod flat_face;
mod gas;
mod mesh;
pub(crate) mod overlap;
mod pace;
mod penetration;
mod points;
mod pressed;
mod reduced;
mod rigid;
mod rods;
mod shape;
mod size;
mod skin;
mod start;
mod strain;
mod symmetry;
mod touch;
mod units;
mod waves;

use deformed::Deformed;
use each::{each_body, named};
pub(crate) use penetration::Follower;
pub(crate) use reduced::reduced;
use shape::Extent;

use crate::dynamics::report::{Indicator, warnings};
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::body::Part;
use crate::scene::timeline::Scene;

impl Scene {
    /// Warnings: reasons to doubt any motion of this scene, as far as known before a run.
    ///
    /// Examples are a body too large, too heavy or too fast to be soft (its mesh may be in millimetres), cells that
    /// lock, pieces that nothing joins, a mesh that overlaps itself, and obstacles that the body begins inside. Each
    /// warning names the measured value, its limit, and the remedy.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Scene};
    ///
    /// let mesh = Mesh::rectangle([300.0, 300.0], [4, 4], Cells::Triangles)?; // mm?
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };
    /// let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?);
    /// assert!(scene.warnings()[0].contains("is the mesh in mm?"));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn warnings(&self) -> Vec<String> {
        warnings(&self.indicators())
    }

    /// Indicators that can be measured before a run, with limits.
    ///
    /// They cover the size, mass and wave speed of the body, its cells, its pieces and the obstacles that it begins
    /// inside. Indicators beyond their limits are the [`warnings`](Self::warnings).
    pub fn indicators(&self) -> Vec<Indicator> {
        let body = self.body();
        let of_body = |part: Part| {
            let measured = units::units(self, part.body).into_iter();
            let measured = measured.chain(mesh::locking(part.body));
            let facets = faceted::faceted(part.body).into_iter().collect();
            let measured = measured.chain(units::as_meant(self, facets));
            let measured = measured.chain(arched::arched(part.body));
            let measured = measured.chain(rods::kinked(part.body));
            let measured = measured.chain(rods::stubby(part.body));
            named(part.name, body, measured.chain(conformity::conformity(part.body)))
        };
        let each = body.parts().flat_map(of_body);
        each.chain(units::of_scene(self))
            .chain(gas::gas(self))
            .chain(mesh::pieces(self))
            .chain(overlap::drawn(self))
            .chain(touch::begun_inside(self))
            .chain(pressed::pressed(self))
            .chain(early::tables(self))
            .chain(start::lacking(self))
            .collect()
    }
}

impl Trajectory {
    /// Indicators of how far the motion can be trusted, and of how simple a model would do.
    ///
    /// They are those [measured](crate::Report::indicators) at the end of the run, and others that take
    /// longer to measure, on the same samples. An indicator with a limit is listed whether or not its value
    /// is beyond the limit.
    ///
    /// ```
    /// use pliant::{Sampling, Settings, samples};
    ///
    /// let motion = samples::square_jump(4)?.simulate(&Settings::default(), &Sampling::every(0.01))?;
    /// for indicator in motion.indicators() {
    ///     println!("{indicator}"); // fine, doubtful or more-than-needed, and why
    /// }
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn indicators(&self) -> Vec<Indicator> {
        let (body, samples) = (self.body(), looked_at(self));
        let inertia = pace::inertia(&samples);
        let is_static = inertia.as_ref().is_some_and(Indicator::is_beyond);
        let mut all = self.report().indicators.clone();
        all.extend(each_body(self, &samples, |body, samples| {
            let deformed = Deformed::of(body, samples);
            let extent = Extent::of(body);
            let mut own = deformed.indicators(body, extent.as_ref());
            own.extend(
                extent
                    .iter()
                    .flat_map(|extent| extent.indicators(body, deformed.own_turn, deformed.strain)),
            );
            own.extend(waves::resolution(body, samples, is_static));
            own
        }));
        all.extend(points::single(self, &samples));
        all.extend(felt::depth(self, &samples, &touch::meetings(self, &samples)));
        all.extend(felt::friction(self, &samples));
        all.extend(pace::drift(self, &samples));
        all.extend(inertia);
        all.extend(pace::vibrations(self.scene()));
        all.extend(symmetry::plane(body, &samples));
        all.extend(symmetry::mirrors(body, &samples));
        all
    }
}

/// Indicators of how far a motion, or the part of it that was computed, can be trusted.
pub(crate) fn of_motion(trajectory: &Trajectory) -> Vec<Indicator> {
    let samples = looked_at(trajectory);
    let scene = trajectory.scene();
    let is_whole = samples[0].time <= 0.0 && trajectory.last().time >= scene.end();
    let meetings = touch::meetings(trajectory, &samples);
    let missed = || touch::missed(&meetings, touch::Reach::between(scene, &samples));
    let measured = scene.indicators().into_iter().chain(of_cells(trajectory, &samples));
    let measured = measured.chain(touch::depths(trajectory.scene(), &meetings));
    let measured = measured.chain(touch::passages(trajectory));
    let measured = measured.chain(touch::between_nodes(trajectory));
    let measured = measured.chain(crept(trajectory));
    let measured = measured.chain(chamber::volumes(scene, trajectory.samples()));
    let measured = measured.chain(overlaps(trajectory));
    let measured = measured.chain(pace::tolerance(trajectory, &samples));
    let measured = measured.chain(pace::lasting_drift(trajectory, &samples));
    let measured = measured.chain(pace::leaps(trajectory, &samples));
    let measured = measured.chain(trajectory.report().reduced.iter().flat_map(reduced));
    measured.chain(is_whole.then(missed).into_iter().flatten()).collect()
}

/// Indicators of the reliability of an equilibrium, or of the last one before a failure.
pub(crate) fn of_equilibrium(trajectory: &Trajectory, is_found: bool) -> Vec<Indicator> {
    let samples = [trajectory.last()];
    let meetings = touch::meetings(trajectory, &samples);
    let measured = trajectory.scene().indicators().into_iter();
    let measured = measured.chain(of_cells(trajectory, &samples));
    let measured = measured.chain(touch::depths(trajectory.scene(), &meetings));
    let measured = measured.chain(overlaps(trajectory));
    let measured = measured.chain(touch::slippery(trajectory));
    let measured = measured.chain(chamber::volumes(trajectory.scene(), trajectory.samples()));
    measured
        .chain(is_found.then(|| touch::missed(&meetings, touch::Reach::NONE)).into_iter().flatten())
        .collect()
}

/// Defect of a scene that ends its run early, whatever the integrator reports: an obstacle that the body begins inside.
pub(crate) fn doom(indicators: &[Indicator]) -> Option<&str> {
    let is_doom = |told: &&Indicator| told.name == touch::START_DEPTH && told.is_doubtful();
    indicators.iter().find(is_doom).map(|told| told.text.as_str())
}

/// The largest angle (rad) by which a cell of a body turns.
#[cfg(feature = "scene-file")]
pub(crate) fn largest_turn(trajectory: &Trajectory, part: &Part) -> f64 {
    let samples = looked_at(trajectory).into_iter();
    strain::largest_turn(part.body, samples.map(|sample| &sample.u[part.dofs()]))
}

/// Creep of surfaces in sticking friction.
fn crept(trajectory: &Trajectory) -> Vec<Indicator> {
    creep::creep(
        trajectory,
        &spread(trajectory, MOST_SAMPLES_FOR_OVERLAPS, MOST_CELLS_FOR_OVERLAPS),
    )
}

/// Whether the body passes through itself.
fn overlaps(trajectory: &Trajectory) -> Option<Indicator> {
    let samples = spread(trajectory, MOST_SAMPLES_FOR_OVERLAPS, MOST_CELLS_FOR_OVERLAPS);
    overlap::overlap(trajectory.scene(), &samples)
}

/// Deformations that cells cannot represent.
fn of_cells(trajectory: &Trajectory, samples: &[&Sample]) -> Vec<Indicator> {
    each_body(trajectory, samples, |body, samples| {
        let measured = [
            strain::turning(body, samples),
            strain::inversion(body, samples),
            coarse::coarse(body, trajectory.report().energy_scale, samples),
        ];
        measured.into_iter().flatten().collect()
    })
}

/// Largest numbers of samples, and of cells in all of them, that are evaluated; few samples always are.
const MOST_SAMPLES: usize = 200;
const MOST_CELLS: usize = 50_000;
const FEW_SAMPLES: usize = 10;
/// The same for overlaps and creep, which come and go and cost less to find.
const MOST_SAMPLES_FOR_OVERLAPS: usize = 1000;
const MOST_CELLS_FOR_OVERLAPS: usize = 2_000_000;

/// Samples of a motion that most indicators use.
fn looked_at(trajectory: &Trajectory) -> Vec<&Sample> {
    spread(trajectory, MOST_SAMPLES, MOST_CELLS)
}

/// At most so many samples of a motion, with so many cells in all of them: evenly spread, including the first
/// and the last.
fn spread(trajectory: &Trajectory, most_samples: usize, most_cells: usize) -> Vec<&Sample> {
    let samples = trajectory.samples();
    let most = most_cells / trajectory.body().mesh().cell_count();
    let count = most.clamp(FEW_SAMPLES, most_samples).min(samples.len());
    let last = samples.len() - 1; // there is one at least: see `Trajectory::new`
    (0..count).map(|k| &samples[k * last / (count - 1).max(1)]).collect()
}
