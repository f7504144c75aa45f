//! Numbers that change with time in a phase: loads, pressures, actuation, prescribed motion, paths of obstacles, fields.

use std::sync::Arc;

use super::input::InputSignal;
use super::{Phase, Scene};
use crate::base::formula::{Bounds, Formula};
use crate::scene::constraint::Motion;
use crate::scene::forces::{Obstacle, Signal, SignalKind, VectorSignal};

/// A number that changes with time (s).
#[derive(Clone)]
pub(crate) enum Varying {
    /// A term of a formula.
    Formula(Arc<Formula>),
    /// A function of a program.
    Function(Arc<dyn Fn(f64) -> f64 + Send + Sync>),
}

impl Varying {
    /// Its value at time `t` (s).
    pub(crate) fn at(&self, t: f64) -> f64 {
        match self {
            Self::Formula(formula) => formula.at(t).0[0],
            Self::Function(function) => function(t),
        }
    }

    /// Bounds on its values in a span of time; functions of programs have none.
    pub(crate) fn bounds(&self, span: [f64; 2]) -> Option<Bounds> {
        match self {
            Self::Formula(formula) => Some(formula.bounds(span)),
            Self::Function(_) => None,
        }
    }
}

/// Lists what changes with time; lines of tables and cubics of paths are left out, at whose ends steps end.
#[derive(Default)]
struct List(Vec<Varying>);

impl List {
    fn formula(&mut self, formula: &Formula) {
        self.0.extend(formula.terms().into_iter().map(|term| Varying::Formula(Arc::new(term))));
    }

    fn signal(&mut self, signal: &Signal) {
        match &signal.0 {
            SignalKind::Formula(formula) => self.formula(formula),
            SignalKind::Function { function, .. } => {
                self.0.push(Varying::Function(function.clone()));
            }
            SignalKind::Constant(_)
            | SignalKind::TimeTable(_)
            | SignalKind::Shared(_)
            | SignalKind::State(_) => {}
        }
    }

    fn vector(&mut self, vector: &VectorSignal) {
        match vector {
            VectorSignal::Formulas(formulas) => {
                formulas.iter().for_each(|formula| self.formula(formula));
            }
            VectorSignal::Function { dimension, write } => {
                let dimension = *dimension;
                for component in 0..dimension {
                    let write = write.clone();
                    self.0.push(Varying::Function(Arc::new(move |t| {
                        // as many as a vector in space has
                        let mut vector = [0.0; 3];
                        vector.get_mut(..dimension).map_or(f64::NAN, |vector| {
                            write(t, vector);
                            vector[component]
                        })
                    })));
                }
            }
            VectorSignal::Constant(_) | VectorSignal::TimeTable(_) | VectorSignal::Shared(_) => {}
        }
    }

    fn motion(&mut self, motion: &Motion) {
        match motion {
            Motion::Path(path) => {
                let path = path.clone();
                self.0.push(Varying::Function(Arc::new(move |t| path(t).displacement)));
            }
            Motion::Formula(formula) => self.formula(formula),
            Motion::Hold
            | Motion::Together
            | Motion::Velocity(_)
            | Motion::Spline(_)
            | Motion::Turn(_) => {}
        }
    }
}

impl Scene {
    /// The numbers that change with time in a phase otherwise than along lines and cubics between [breaks](Self::breaks_within).
    pub(crate) fn varying_in(&self, phase: &Phase) -> Vec<Varying> {
        let mut list = List::default();
        phase.constraints.iter().for_each(|constraint| list.motion(&constraint.how));
        let presets = self.presets_in(phase);
        phase.inputs.iter().chain(&presets).for_each(|input| match &input.signal {
            InputSignal::Number(signal) => list.signal(signal),
            InputSignal::Vector(vector) => list.vector(vector),
        });
        let acting = phase.contacts(&self.obstacles).unwrap_or_default();
        acting.into_iter().flat_map(Obstacle::formulas).for_each(|formula| list.formula(formula));
        self.supplies.iter().for_each(|supply| list.signal(&supply.pressure));
        self.fluids.iter().filter_map(|fluid| fluid.flow()).for_each(|v| list.vector(v));
        list.0
    }

    /// Times (s, ascending) within `phase` after `start` (s) at which what acts in it changes its law: those of tables and paths, kinks and
    /// jumps of formulas, and breaks of functions.
    pub(crate) fn breaks_within(&self, phase: &Phase, start: f64) -> Vec<f64> {
        let mut breaks = self.breaks_in(phase);
        for varying in self.varying_in(phase) {
            if let Varying::Formula(term) = varying {
                breaks.extend(term.kinks([start, phase.until]));
            }
        }
        // where the phase ends as well there is no step between
        let end = phase.until - 16.0 * f64::EPSILON * phase.until.abs();
        breaks.retain(|&time| start < time && time < end);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}
