//! Strains and rotations of cells, and their consequences for the material law.
//!
//! The rotation of a cell is the one nearest to its mean deformation gradient. St. Venant-Kirchhoff's stress
//! differs from that of incompressible neo-Hookean rubber by 2.5 times the strain, Hooke's by the strain.

use nalgebra::Matrix3;

use super::rigid::without_turn;
use super::shape::Extent;
use crate::base::input::{four_digits, percent};
use crate::dynamics::report::Indicator;
use crate::dynamics::trajectory::Sample;
use crate::elements::body::{Body, Strain};
use crate::elements::material::Law;

/// Largest relative difference of the stress of a law from that of rubber (incompressible and neo-Hookean, uniaxial).
const MOST_WRONG: f64 = 0.25;
/// Relative difference of the stress of Hooke's law for Cauchy's strain from that of rubber, in multiples of the strain.
const CAUCHY_LAW: f64 = 1.0;
/// Largest error of the strains with which Cauchy strain is still good enough.
const MOST_NONLINEAR: f64 = 0.01;
/// Strains below this are round-off.
const LEAST_STRAIN: f64 = 1e-9;

/// The largest deformations of cells.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Deformed {
    /// Change of a length over the length, along any axis.
    pub(super) strain: f64,
    /// When (s), and the number of the cell, counted from 0.
    at: (f64, usize),
    /// Angles (rad) of rotation: total, and relative to the body as a whole.
    turn: f64,
    pub(super) own_turn: f64,
}

impl Deformed {
    /// The largest in any of the `samples`.
    pub(super) fn of(body: &Body, samples: &[&Sample]) -> Self {
        let mut most = Self::default();
        let largest = |angles: Vec<f64>| angles.into_iter().fold(0.0, f64::max);
        for sample in samples {
            let own = without_turn(body, &sample.u);
            for (cell, field) in body.cell_fields(&own).iter().enumerate() {
                let strains = Matrix3::from(field.strain).symmetric_eigenvalues();
                let strain = strains.iter().map(|&strain| stretch(body, strain).abs());
                let strain = strain.fold(0.0, f64::max);
                if strain > most.strain {
                    (most.strain, most.at) = (strain, (sample.time, cell));
                }
            }
            most.turn = most.turn.max(largest(body.cell_rotations(&sample.u)));
            most.own_turn = most.own_turn.max(largest(body.cell_rotations(&own)));
        }
        most
    }

    /// The indicators, of a body of this `extent` if that is known.
    pub(super) fn indicators(&self, body: &Body, extent: Option<&Extent>) -> Vec<Indicator> {
        let strain = body.strain();
        let slenderness = extent.map(Extent::slenderness);
        let nonlinear =
            slenderness.filter(|_| strain == Strain::Green && self.strain > LEAST_STRAIN);
        // only bodies with Green's strain have fibres
        let has_fibres = body.substances().any(|of| !of.fibres.is_empty());
        let nonlinear = nonlinear.filter(|_| !has_fibres);
        let nonlinear = nonlinear.map(|slenderness| self.nonlinearity(body, slenderness));
        let turns = (body.mesh().kind().dimension() > 1).then(|| self.turns());
        [self.largest_strain(body)].into_iter().chain(turns).chain(nonlinear).collect()
    }

    fn turns(&self) -> Indicator {
        let [all, own] = [self.turn, self.own_turn].map(f64::to_degrees);
        let told =
            format!("cells turn by up to {all:.1} degrees, {own:.1} beside the body as a whole");
        Indicator::told("own-turn", own, "degrees", told)
    }

    fn largest_strain(&self, body: &Body) -> Indicator {
        let laws = body.substances().map(|of| of.law.unwrap_or(Law::StVenantKirchhoff));
        let rows = laws.map(Law::information);
        // of several the one that is farthest from rubber
        let worst = rows.max_by(|a, b| a.error_of_strain.total_cmp(&b.error_of_strain));
        let (factor, off, help) = match (body.strain(), worst) {
            (Strain::Green, Some(law)) if law.is_rubber => (
                law.error_of_strain,
                law.error,
                "fit the constants of its law to measurements at such strains",
            ),
            (Strain::Green, Some(law)) => (
                law.error_of_strain,
                law.error,
                "take a law of rubber (law = { kind = \"neo-hookean\" })",
            ),
            _ => (
                CAUCHY_LAW,
                "Hooke's law is off by about as much",
                "take strain = \"green\" and a law of rubber (law = { kind = \"neo-hookean\" })",
            ),
        };
        let Self { strain, at: (time, cell), .. } = *self;
        let limit = MOST_WRONG / factor;
        let said = format!(
            "cells are strained by up to {} % (limit: {})",
            four_digits(100.0 * strain),
            percent(limit)
        );
        let beyond = || {
            format!(
                "{said}, cell {} at t = {} s: {off} in its stress, compared with that of rubber; forces there are \
                 doubtful, shapes less so. Deform it less, or {help}",
                cell + 1,
                four_digits(time)
            )
        };
        Indicator::trusted("strain", (strain, "1"), [0.0, limit], || said.clone(), beyond)
    }

    /// The error that Cauchy strain would cause, relative to the strain: rotations count as strains, and
    /// terms of second order are lost, as are the transverse forces of axial strains in a slender body
    /// (buckling).
    fn nonlinearity(&self, body: &Body, slenderness: f64) -> Indicator {
        let Self { strain, turn, .. } = *self;
        let wrong =
            ((1.0 - turn.cos()) + 0.5 * strain.powi(2)) / strain + strain * slenderness.powi(2);
        let limit = percent(MOST_NONLINEAR);
        let by =
            if wrong < 1.0 { format!("some {}", percent(wrong)) } else { "more than 100 %".into() };
        let said = format!("Cauchy strain would be wrong by {by} of the strains (limit: {limit})");
        let without = match body.substances().any(|substance| substance.law.is_some()) {
            true => " without a law",
            false => "",
        };
        let enough = || format!("{said}: strain = \"cauchy\"{without} would do, and is faster");
        Indicator::needed("nonlinearity", (wrong, "1"), MOST_NONLINEAR, || said.clone(), enough)
    }
}

/// Relative change of length for a principal strain in the body's strain measure.
fn stretch(body: &Body, strain: f64) -> f64 {
    match body.strain() {
        Strain::Cauchy => strain,
        Strain::Green => (1.0 + 2.0 * strain).max(0.0).sqrt() - 1.0,
    }
}
