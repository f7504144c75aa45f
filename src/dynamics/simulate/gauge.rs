//! Functions that read the quantities of a scene: the names of a [`Reading`] are looked up once, before the run.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;

use super::contact_gauge::ContactGauge;
use super::output::Value;
use super::reading::{FieldPoint, Lever, OfContact, Reading, ReadingKind};
use super::rigid_fit::{RigidFit, Turning};
use super::spot::Motion;
use super::view::{View, mean};
use crate::base::input::{InputError, finite};
use crate::base::vector::{cross, dot, norm};
use crate::dynamics::trajectory::Sample;
use crate::elements::body::{Body, Branches, NodalField, Part};
use crate::elements::mesh::Selection;
use crate::scene::constraint::{ConstraintRow, PhaseStart};
use crate::scene::forces::FluidForce;
use crate::scene::timeline::{DeviceMultipliers, Scene};

/// Reads a quantity, or NaN where it is undefined.
pub(super) type Gauge = Box<dyn Fn(&View, &Sample) -> Value + Send + Sync>;

/// Reads an angle; in the plane without whole turns.
pub(super) type AngleGauge = Arc<dyn Fn(&View) -> f64 + Send + Sync>;

impl Reading {
    /// The function that reads it in `scene`.
    ///
    /// # Errors
    /// Nodes, obstacles, springs or chambers that the scene does not have; a point outside the body; lines without
    /// a length.
    pub(super) fn gauge(&self, scene: &Scene) -> Result<Gauge, InputError> {
        let select = |nodes: &Selection| scene.body().mesh().select(nodes);
        let d = scene.body().dimension();
        Ok(match &self.what {
            ReadingKind::Position(spot) => self.of_spot(scene, spot, Motion::Position)?,
            ReadingKind::Displacement(spot) => self.of_spot(scene, spot, Motion::Displacement)?,
            ReadingKind::Velocity(spot) => self.of_spot(scene, spot, Motion::Velocity)?,
            ReadingKind::Acceleration(spot) => self.of_spot(scene, spot, Motion::Acceleration)?,
            ReadingKind::ConstraintForce(nodes) => {
                let sum = constraint_sum(scene, select(nodes)?, move |_, dof| {
                    std::array::from_fn(|i| f64::from(i == dof % d))
                })?;
                Box::new(move |view, sample| Value::Vector(sum(view, sample)))
            }
            ReadingKind::ConstraintMoment(nodes, lever) => {
                scene.body().refuse_around("sensor", "moment of constraints")?;
                moment(scene, select(nodes)?, lever)?
            }
            ReadingKind::Contact(of, by, nodes) => {
                let of_body = self.body.as_deref();
                let contact = ContactGauge::new(scene, by, nodes.as_ref(), of_body)?;
                match of {
                    OfContact::Force => {
                        Box::new(move |view, at| Value::Vector(contact.force(view, at)))
                    }
                    OfContact::Area => {
                        Box::new(move |view, at| Value::Number(contact.area(view, at)))
                    }
                    OfContact::Pressure => {
                        Box::new(move |view, at| Value::Number(contact.pressure(view, at)))
                    }
                }
            }
            ReadingKind::Gap(touch) => {
                let touch = scene.touch_force(touch, "touch")?;
                Box::new(move |view, _| Value::Number(touch.gap(view.displacements())))
            }
            ReadingKind::Of(output, name) => {
                let (output, number) = (*output, output.find(scene, name)?);
                // the component is there
                Box::new(move |view, _| {
                    output.value(view, number).unwrap_or(Value::Number(f64::NAN))
                })
            }
            ReadingKind::OfDevice(output, name) => {
                let device = scene.device_number(name, "device")?;
                let number = scene.output_number(device, output.word)?;
                let rows = rows_of_device(scene, device)?;
                let (is_vector, is_angle) = (output.is_vector, output.is_angle());
                let unit = if is_angle { self.full_turn() / TAU } else { 1.0 };
                Box::new(move |view, sample| {
                    let rows = rows.as_ref().and_then(|rows| rows(view, sample));
                    let multipliers = rows
                        .as_ref()
                        .map(|rows| DeviceMultipliers { rows, all: &sample.multipliers });
                    let value = view.device_value(device, number, multipliers);
                    if is_vector { Value::Vector(value) } else { Value::Number(unit * value[0]) }
                })
            }
            ReadingKind::MagneticMoment => {
                if scene.magnets().is_empty() {
                    let help = "the scene has no magnets";
                    return Err(InputError::new("sensor", "magnetic moment", help));
                }
                Box::new(|view, _| Value::of_vector(&view.magnetic_moment()))
            }
            ReadingKind::FluidForce(fluid, nodes) => self.of_fluid(scene, fluid, nodes.as_ref())?,
            ReadingKind::Stress(place) => {
                field(scene, place, scene.body().branches(), |field| field.stress)?
            }
            ReadingKind::Strain(place) => field(scene, place, None, |field| field.strain)?,
            ReadingKind::Distance([from, to]) => {
                let (from, to) = (select(from)?, select(to)?);
                Box::new(move |view, _| Value::Number(norm(&between(view, [&from, &to]))))
            }
            ReadingKind::Rotation(nodes) if d == 3 => {
                let (fit, in_turn) = (self.fit(scene, nodes.as_ref())?, self.full_turn() / TAU);
                Box::new(move |view, _| {
                    Value::Vector(fit.rotation_vector(view).map(|angle| in_turn * angle))
                })
            }
            ReadingKind::AngularVelocity(nodes) => {
                turning(self.fit(scene, nodes.as_ref())?, d, |turning| turning.velocity)
            }
            ReadingKind::AngularAcceleration(nodes) => {
                turning(self.fit(scene, nodes.as_ref())?, d, |turning| turning.acceleration)
            }
            ReadingKind::Accelerometer(nodes) => self.accelerometer_gauge(scene, nodes.as_ref())?,
            ReadingKind::Gyroscope(nodes) => self.gyroscope_gauge(scene, nodes.as_ref())?,
            ReadingKind::Angle(_) | ReadingKind::Rotation(_) => {
                let angle = self.angle_gauge(scene)?;
                Box::new(move |view, _| Value::Number(angle(view)))
            }
            ReadingKind::CentreOfMass => self.of_part(scene, |part, view| {
                part.body.centre_of_mass(&view.displacements()[part.dofs()])
            })?,
            ReadingKind::Momentum => self.of_part(scene, |part, view| {
                let mean = part.body.mean_velocity(&view.velocities()[part.dofs()]);
                mean.into_iter().map(|v| part.body.mass() * v).collect()
            })?,
        })
    }

    /// The function that reads a vector of the body that was named, or of all.
    fn of_part(
        &self,
        scene: &Scene,
        read: fn(&Part, &View) -> Vec<f64>,
    ) -> Result<Gauge, InputError> {
        let first_node = self.first_node(scene)?;
        Ok(Box::new(move |view, _| Value::of_vector(&read(&part(view.body(), first_node), view))))
    }

    /// The function that reads the force of a fluid.
    fn of_fluid(
        &self,
        scene: &Scene,
        fluid: &str,
        nodes: Option<&Selection>,
    ) -> Result<Gauge, InputError> {
        let body = scene.body();
        let read: Option<Vec<usize>> = match (nodes, &self.body) {
            (Some(nodes), _) => Some(body.mesh().select(nodes)?),
            (None, Some(name)) => Some(body.part_named(name, "body")?.nodes.collect()),
            (None, None) => None,
        };
        let is_read = read.map(|nodes| {
            let mut is_read = vec![false; body.mesh().node_count()];
            nodes.into_iter().for_each(|node| is_read[node] = true);
            is_read
        });
        // no command changes gravity
        let forces = scene.phases().iter().map(|phase| scene.fluid_force(fluid, phase, "fluid"));
        let forces = forces.collect::<Result<Vec<_>, _>>()?;
        Ok(Box::new(move |view, sample| {
            let (u, v) = (view.displacements(), view.velocities());
            let on = |force: &FluidForce| force.on(sample.time, u, v, is_read.as_deref());
            Value::Vector(forces.get(sample.phase).map_or([f64::NAN; 3], on))
        }))
    }

    /// The first node of the body that was named.
    pub(super) fn first_node(&self, scene: &Scene) -> Result<Option<usize>, InputError> {
        let Some(name) = &self.body else { return Ok(None) };
        Ok(Some(scene.body().part_named(name, "body")?.nodes.start))
    }

    /// The function that reads an angle in `scene`, in its unit.
    ///
    /// # Errors
    /// As [`gauge`](Self::gauge).
    pub(super) fn angle_gauge(&self, scene: &Scene) -> Result<AngleGauge, InputError> {
        let d = scene.body().dimension();
        let in_turn = self.full_turn() / TAU;
        let on = match &self.what {
            ReadingKind::Rotation(on) => on.as_ref(),
            _ => None,
        };
        if let ReadingKind::Angle([from, to]) = &self.what {
            let lines = [line(scene, from)?, line(scene, to)?];
            return Ok(Arc::new(move |view| {
                let [a, b] = lines.each_ref().map(|[from, to]| between(view, [from, to]));
                let normal = cross(&a, &b);
                let across = if d == 2 { normal[2] } else { norm(&normal) };
                in_turn * across.atan2(dot(&a, &b))
            }));
        }
        if let ReadingKind::OfDevice(output, name) = &self.what {
            let device = scene.device_number(name, "device")?;
            let number = scene.output_number(device, output.word)?;
            return Ok(Arc::new(move |view| in_turn * view.device_value(device, number, None)[0]));
        }
        let fit = self.fit(scene, on)?;
        Ok(Arc::new(move |view| in_turn * fit.angle(view)))
    }

    /// The rigid motion of `nodes`, or else of the body that was named, or of all.
    pub(super) fn fit(
        &self,
        scene: &Scene,
        nodes: Option<&Selection>,
    ) -> Result<RigidFit, InputError> {
        scene.body().refuse_around("sensor", "rotation")?;
        let mesh = scene.body().mesh();
        match (nodes, &self.body) {
            (None, _) => RigidFit::of_part(mesh, &part(scene.body(), self.first_node(scene)?)),
            (Some(nodes), None) => RigidFit::of_nodes(mesh, mesh.select(nodes)?),
            (Some(nodes), Some(name)) => {
                let help = format!("{nodes} are read: leave one of them out");
                Err(InputError::new("body", format!("\"{name}\""), help))
            }
        }
    }
}

/// The function that reads a rate of a rotation: in the plane a number, in space a vector.
pub(super) fn turning(
    fit: RigidFit,
    dimension: usize,
    rate: fn(&Turning) -> Vector3<f64>,
) -> Gauge {
    Box::new(move |view, _| match rate(&fit.turning(view)) {
        rate if dimension == 2 => Value::Number(rate.z),
        rate => Value::Vector(rate.into()),
    })
}

/// The body with this first node, or all together.
pub(super) fn part(body: &Body, first_node: Option<usize>) -> Part<'_> {
    first_node.map_or_else(|| body.whole(), |node| body.part_of(node))
}

fn position(view: &View, nodes: &[usize]) -> [f64; 3] {
    let d = view.body().dimension();
    let natural = mean(nodes, view.body().mesh().positions(), d);
    let moved = mean(nodes, view.displacements(), d);
    std::array::from_fn(|i| natural[i] + moved[i])
}

/// From the middle of some nodes to that of others.
fn between(view: &View, [from, to]: [&[usize]; 2]) -> [f64; 3] {
    let (from, to) = (position(view, from), position(view, to));
    std::array::from_fn(|i| to[i] - from[i])
}

/// The ends of a line that has a direction in the undeformed shape.
fn line(scene: &Scene, ends: &[Selection; 2]) -> Result<[Vec<usize>; 2], InputError> {
    let mesh = scene.body().mesh();
    let [from, to] = [mesh.select(&ends[0])?, mesh.select(&ends[1])?];
    let [a, b] = [&from, &to].map(|nodes| mean(nodes, mesh.positions(), mesh.dimension()));
    let along: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
    if norm(&along) <= 1e-9 * mesh.size() {
        let value = format!("{} to {}", ends[0], ends[1]);
        let help = "its ends are in the same place, so that it has no direction";
        return Err(InputError::new("line of an angle", value, help));
    }
    Ok([from, to])
}

/// Strain or stress at a point, with that of the `branches`.
fn field(
    scene: &Scene,
    place: &FieldPoint,
    branches: Option<Branches>,
    tensor: fn(&NodalField) -> [[f64; 3]; 3],
) -> Result<Gauge, InputError> {
    let body = scene.body();
    let weights = match place {
        FieldPoint::Nodes(nodes) => {
            let nodes = body.mesh().select(nodes)?;
            nodes.iter().map(|&node| (node, 1.0 / nodes.len() as f64)).collect()
        }
        FieldPoint::Point(x) => body.shares_at(x)?,
    };
    let probe = body.probe(&weights);
    Ok(Box::new(move |view, sample| {
        let u = view.displacements();
        let mut field = view.body().probed(&probe, u, &view.grown());
        // in equilibria they are relaxed
        let has_strains = |own: &&Branches| sample.internal_strains.len() == own.unknowns();
        if let Some(branches) = branches.as_ref().filter(has_strains) {
            field = field.with_stress(&branches.probed(&probe, u, &sample.internal_strains));
        }
        Value::Tensor(tensor(&field))
    }))
}

/// Moment of the constraints on `nodes` (counted from 0).
fn moment(scene: &Scene, nodes: Vec<usize>, lever: &Lever) -> Result<Gauge, InputError> {
    let d = scene.body().dimension();
    let Lever { about, axis } = lever.clone();
    let vector = |input: &str, given: &[f64]| -> Result<[f64; 3], InputError> {
        finite(input, given)?;
        if given.len() != d {
            let help = format!("it needs {d} component(s)");
            return Err(InputError::new(input, format!("{given:?}"), help));
        }
        Ok(std::array::from_fn(|i| given.get(i).copied().unwrap_or(0.0)))
    };
    if d == 1 {
        let help = "nothing turns on a line: read the constraint force";
        return Err(InputError::new("moment in dimension", d, help));
    }
    let about = vector("point of a moment", &about)?;
    let axis = match axis {
        Some(axis) if d == 2 => {
            let help = "in the plane it is across: leave it out";
            return Err(InputError::new("axis of a moment", format!("{axis:?}"), help));
        }
        Some(axis) => {
            let along = vector("axis of a moment", &axis)?;
            if norm(&along) == 0.0 {
                let help = "it must have a direction";
                return Err(InputError::new("axis of a moment", format!("{axis:?}"), help));
            }
            Some(along.map(|x| x / norm(&along)))
        }
        None if d == 2 => Some([0.0, 0.0, 1.0]),
        None => None,
    };
    let sum = constraint_sum(scene, nodes, move |view, dof| {
        let x = position(view, &[dof / d]);
        let arm = std::array::from_fn(|i| x[i] - about[i]);
        cross(&arm, &std::array::from_fn(|i| f64::from(i == dof % d)))
    })?;
    Ok(Box::new(move |view, sample| {
        let moment = sum(view, sample);
        axis.map_or(Value::Vector(moment), |axis| Value::Number(dot(&axis, &moment)))
    }))
}

/// A constraint's row, the degree of freedom on which it acts, and its coefficient.
type Term = (usize, usize, f64);

/// Sums up vectors over constraint forces.
type Sum = Box<dyn Fn(&View, &Sample) -> [f64; 3] + Send + Sync>;

/// Sum of the constraint forces on the degrees of freedom of `nodes` (counted from 0), each times a vector.
fn constraint_sum(
    scene: &Scene,
    nodes: Vec<usize>,
    vector: impl Fn(&View, usize) -> [f64; 3] + Send + Sync + 'static,
) -> Result<Sum, InputError> {
    let d = scene.body().dimension();
    let mut is_read = vec![false; scene.body().mesh().node_count()];
    nodes.into_iter().for_each(|node| is_read[node] = true);
    let terms = move |rows: &[ConstraintRow]| -> Vec<Term> {
        let of_row = |(number, row): (usize, &ConstraintRow)| -> Vec<Term> {
            let read = row.terms.iter().filter(|(dof, _)| is_read[dof / d]);
            read.map(|&(dof, coefficient)| (number, dof, coefficient)).collect()
        };
        rows.iter().enumerate().flat_map(of_row).collect()
    };
    let in_force = of_rows_in_force(scene, terms)?;
    Ok(Box::new(move |view, sample| {
        let Some(acting) = in_force(view, sample) else { return [f64::NAN; 3] };
        let mut sum = [0.0; 3];
        for &(row, dof, coefficient) in &*acting {
            let force = coefficient * sample.multipliers.get(row).copied().unwrap_or(f64::NAN);
            let along = vector(view, dof);
            sum.iter_mut().zip(along).for_each(|(sum, along)| *sum += along * force);
        }
        sum
    }))
}

/// The function that finds the rows of a device among those in force, none of those that follow from others; none of a device without
/// rows.
fn rows_of_device(
    scene: &Scene,
    device: usize,
) -> Result<Option<OfRows<Vec<Option<usize>>>>, InputError> {
    let own = scene.terms_of_device(device)?;
    if own.is_empty() {
        return Ok(None);
    }
    let numbers = move |rows: &[ConstraintRow]| -> Vec<Option<usize>> {
        own.iter().map(|terms| rows.iter().position(|row| row.terms == *terms)).collect()
    };
    of_rows_in_force(scene, numbers).map(Some)
}

/// Finds something on the rows in force at a sample.
type OfRows<T> = Box<dyn Fn(&View, &Sample) -> Option<Arc<T>> + Send + Sync>;

/// The function that finds what `of_rows` makes of the rows in force at a sample, once for each phase of the scene.
fn of_rows_in_force<T: Send + Sync + 'static>(
    scene: &Scene,
    of_rows: impl Fn(&[ConstraintRow]) -> T + Send + Sync + 'static,
) -> Result<OfRows<T>, InputError> {
    // where rows start from affects what they prescribe, not which components they couple
    let rest = vec![0.0; scene.body().dofs()];
    let mut time = 0.0;
    let mut of_phases = Vec::new();
    for phase in scene.phases() {
        let rows = scene.rows(phase, &PhaseStart { time, u: &rest })?;
        of_phases.push(Arc::new(of_rows(&rows)));
        time = phase.end();
    }
    Ok(Box::new(move |view, sample| match &sample.commanded.0 {
        None => of_phases.get(sample.phase).cloned(),
        Some(phase) => {
            let start = PhaseStart { time: 0.0, u: &rest };
            let rows = view.scene.rows(phase, &start).ok()?;
            Some(Arc::new(of_rows(&rows)))
        }
    }))
}
