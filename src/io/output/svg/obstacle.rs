//! Obstacles in the plane of the drawing: half-planes and outlines.

use std::f64::consts::{PI, TAU};

use super::projection::{Point, drawn};
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::forces::{Shape, ShapeKind, corners};

/// Chords of a full circle.
const CHORDS: usize = 96;

/// An obstacle in the plane of the drawing.
pub(super) enum Outline {
    /// A point of the surface and the outward normal.
    HalfPlane([Point; 2]),
    /// A convex polygon, the obstacle inside.
    Solid(Vec<Point>),
    /// A convex polygon, the obstacle outside.
    Cavity(Vec<Point>),
}

/// The obstacles at a sample; none in space, and none that is given by a function.
pub(super) fn outlines(trajectory: &Trajectory, sample: &Sample) -> Vec<Outline> {
    let mut outlines = Vec::new();
    for obstacle in trajectory.scene().obstacles() {
        let dimension = trajectory.body().dimension();
        let moving = trajectory.phase_of(sample).map_or(obstacle, |phase| phase.moving(obstacle));
        let offset = moving.displacement(sample.time);
        add(obstacle.shape(), drawn(&offset[..dimension]), dimension, &mut outlines);
    }
    outlines
}

fn add(shape: &Shape, offset: Point, dimension: usize, outlines: &mut Vec<Outline>) {
    let at = |x: &[f64]| shifted(drawn(x), offset);
    match (shape.kind(), dimension) {
        (ShapeKind::Union(parts), _) => {
            parts.iter().for_each(|part| add(part, offset, dimension, outlines));
        }
        (ShapeKind::HalfPlane { point, normal }, 1 | 2) => {
            let normal = drawn(normal);
            let length = normal[0].hypot(normal[1]);
            outlines.push(Outline::HalfPlane([at(point), normal.map(|x| x / length)]));
        }
        (ShapeKind::Ball { centre, radius, cavity }, 2) => {
            let circle = arc(at(centre), *radius, 0.0, CHORDS, TAU);
            outlines.push(if *cavity { Outline::Cavity(circle) } else { Outline::Solid(circle) });
        }
        (ShapeKind::Box { min, max, turned }, 2) => {
            let corners = corners(min, max, turned.as_ref());
            outlines.push(Outline::Solid([0, 1, 3, 2].map(|k| at(&corners[k])).to_vec()));
        }
        (ShapeKind::Capsule { from, to, radius }, 2) => {
            let (from, to) = (at(from), at(to));
            let across = (to[1] - from[1]).atan2(to[0] - from[0]) - PI / 2.0;
            let mut around = arc(to, *radius, across, CHORDS / 2 + 1, PI);
            around.extend(arc(from, *radius, across + PI, CHORDS / 2 + 1, PI));
            outlines.push(Outline::Solid(around));
        }
        _ => {}
    }
}

fn shifted(x: Point, offset: Point) -> Point {
    [x[0] + offset[0], x[1] + offset[1]]
}

/// `count` points on a circle, counter-clockwise from the angle `start` in steps of a chord.
fn arc(centre: Point, radius: f64, start: f64, count: usize, turn: f64) -> Vec<Point> {
    let chords = (turn / TAU * CHORDS as f64).round();
    let at = |k: usize| {
        let angle = start + turn * k as f64 / chords;
        shifted(centre, [radius * angle.cos(), radius * angle.sin()])
    };
    (0..count).map(at).collect()
}

impl Outline {
    /// The points that a picture around `centre` of the given `size` (m) should include: of a
    /// half-plane the nearest one, of other obstacles all, if they are neither large nor far away.
    pub(super) fn near(&self, centre: Point, size: f64) -> Vec<Point> {
        match self {
            Self::HalfPlane([point, normal]) => {
                let distance: f64 = (0..2).map(|i| (centre[i] - point[i]) * normal[i]).sum();
                let nearest = [0, 1].map(|i| centre[i] - distance * normal[i]);
                if distance.abs() < size { vec![nearest] } else { Vec::new() }
            }
            Self::Solid(points) | Self::Cavity(points) => {
                let is_near = |x: &Point| (x[0] - centre[0]).hypot(x[1] - centre[1]) < size;
                if points.iter().all(is_near) { points.clone() } else { Vec::new() }
            }
        }
    }
}
