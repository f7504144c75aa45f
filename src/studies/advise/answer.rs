//! The advice in words.

use std::fmt;

use super::advice::{Advice, Candidate};
use super::choice::Choice;
use super::smaller_model::SmallerModel;
use crate::base::input::{four_digits, percent, short};
use crate::dynamics::report::Verdict;
use crate::elements::body::Strain;
use crate::studies::work_precision::look::Look;
use crate::studies::work_precision::time_text;

impl Advice {
    /// Findings, reason by reason.
    pub fn reasons(&self) -> Vec<String> {
        let mut reasons = Vec::new();
        let rich = self.truth.as_ref().map(|truth| &truth.choice);
        for (alpha, change) in &self.alphas {
            let change = self.change(*change);
            reasons.push(format!("alpha = {alpha:e} 1/s: ten times as much {change}"));
        }
        if let (Some(law), Some(rich)) = (self.law, rich) {
            let other = match rich.strain {
                Strain::Green => "Cauchy strain in place of Green strain",
                Strain::Cauchy => "Green strain in place of Cauchy strain",
            };
            reasons.push(format!("{other} {}", self.change(law)));
        }
        if self.law.is_none() && rich.is_some_and(|rich| rich.strain == Strain::Cauchy) {
            reasons.push("the effect of Green strain is unknown: it gave no motion".into());
        }
        for candidate in &self.candidates {
            let is_mesh = |rich: &Choice| {
                let same = &candidate.choice;
                (same.strain, same.is_rigid) == (rich.strain, rich.is_rigid)
                    && same.inertia == rich.inertia
                    && same.without == rich.without
                    && same.settings == rich.settings
                    && !same.is_static
            };
            if let (Some(error), true) = (candidate.error, rich.is_some_and(is_mesh)) {
                let mesh = candidate.choice.mesh();
                let (unknowns, time) = (candidate.unknowns, time_text(candidate.seconds));
                let differs = if self.mesh.is_some() { "away" } else { "off" };
                reasons.push(match error {
                    0.0 => format!("{mesh}: {unknowns} unknowns; the reference"),
                    _ => {
                        let off = self.off(error, differs);
                        format!("{mesh}: {unknowns} unknowns, {off}, {time}")
                    }
                });
            }
        }
        for (term, error) in &self.terms {
            reasons.push(match error.is_nan() {
                true => format!("without {term} there is no {} to compare", self.quantity),
                false => format!("without {term} it changes by {}", percent(*error)),
            });
        }
        if let Some(error) = self.inertia {
            reasons.push(format!("lumped inertia {}", self.change(error)));
        }
        if let Some(together) = self.together {
            let what = "all negligible terms together, as found on the mesh as written, on the finest mesh,";
            reasons.push(format!("{what} {}", self.change(together)));
        }
        if let Some(estimate) = &self.mesh_estimate {
            let apart =
                self.candidates.iter().find(|candidate| candidate.choice.is_mesh_as_written());
            let paired = apart.and_then(|candidate| {
                let mesh = candidate.parts?.mesh - self.resolution;
                (!mesh.is_nan()).then(|| percent(mesh))
            });
            let told = match estimate.is_reliable() {
                true => {
                    format!("is {} off at rest by", percent(estimate.correction.abs() / self.scale))
                }
                false => "has an error at rest that is not reliably estimated by".into(),
            };
            reasons.push(format!(
                "the mesh as written {told} adjoint-weighted residuals{}",
                paired.map_or_else(String::new, |paired| format!(" (by paired runs: {paired})"))
            ));
        }
        reasons.extend(self.smaller.iter().map(ToString::to_string));
        reasons.extend(self.reduced.iter().map(ToString::to_string));
        reasons
    }

    /// A relative change in words; it is NaN where the quantity does not exist, as a frequency without
    /// swings.
    fn change(&self, change: f64) -> String {
        match change.is_nan() {
            true => format!("leaves no {} to compare", self.quantity),
            false => format!("changes it by {}", percent(change)),
        }
    }

    /// A relative error in words, `differs` after it.
    fn off(&self, error: f64, differs: &str) -> String {
        match error.is_nan() {
            true => format!("no {} to compare", self.quantity),
            false => format!("{} {differs}", percent(error)),
        }
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, accuracy, scale, unit, .. } = self;
        write!(f, "{quantity} to {}", percent(*accuracy))?;
        match scale.is_nan() {
            true => writeln!(f)?,
            false => writeln!(f, ", which is {} {unit}", short(accuracy * scale))?,
        }
        if let Some(until) = self.known_until {
            writeln!(
                f,
                "It is predictable until t = {} s only: small errors grow there, as after impacts. All that follows concerns \
                 the motion until t = {} s; later, rely on energies and means.",
                four_digits(until),
                four_digits(self.end)
            )?;
        }
        let run = |candidate: &Candidate| match (candidate.error, &candidate.failure) {
            (_, Some(failure)) => format!("{}: {failure}", candidate.choice),
            (Some(error), None) => {
                let time = time_text(candidate.seconds);
                let off = match candidate.parts {
                    Some(parts) => format!("{} off at most ({parts})", percent(parts.sum())),
                    None => self.off(error, "off"),
                };
                format!("{}: {off} in {time}", candidate.choice)
            }
            (None, None) => format!("{}: {}", candidate.choice, time_text(candidate.seconds)),
        };
        match &self.enough {
            Some(enough) if self.mesh.is_some() => {
                let besides = "No candidate is enough: no mesh is. On this one, apart from the error of the mesh:";
                writeln!(f, "\n{besides} {}", run(enough))?;
            }
            Some(enough) if self.resolution.is_nan() => {
                writeln!(f, "\nEnough on this mesh: {}", run(enough))?;
            }
            Some(enough) => writeln!(f, "\nEnough:      {}", run(enough))?,
            None => writeln!(f, "\nNo candidate is enough.")?,
        }
        let smaller = self.smaller_enough();
        if let Some((smaller, error)) =
            smaller.and_then(|model| Some((model, self.error_of(model)?)))
        {
            let SmallerModel { kind, seconds, .. } = smaller;
            let (off, time) = (percent(error), time_text(*seconds));
            writeln!(
                f,
                "Smaller:     {kind}, with the same settings: {off} off at most in {time}"
            )?;
        }
        writeln!(f, "As written:  {}", run(&self.written))?;
        match self.mesh {
            Some(apart) => writeln!(
                f,
                "This mesh is too coarse: the finest that was tried differs from it by {}, and may be too coarse as well. \
                 Allow more time (--budget); with loads on single nodes and sharp corners meshes may not converge.",
                percent(apart)
            )?,
            None if self.resolution.is_nan() => {
                let lacks = match self.written.parts.is_some_and(|parts| !parts.mesh.is_nan()) {
                    true => "The error of the mesh was estimated at rest",
                    false => "The error of the mesh is not known",
                };
                writeln!(f, "{lacks}: no finer one gave a motion to compare with.")?;
            }
            None => {
                let resolution = percent(self.resolution);
                let rate = "by the rate of the last three meshes";
                let told = if self.has_rate { rate } else { "if halving cells halves the error" };
                writeln!(
                    f,
                    "The reference may itself be off by {resolution}, {told}; this is counted as a part of the mesh."
                )?;
            }
        }
        writeln!(f)?;
        for reason in self.reasons() {
            writeln!(f, "- {reason}")?;
        }
        let looked = self.look.iter().flat_map(Look::indicators);
        for indicator in looked.filter(|indicator| indicator.verdict != Verdict::Fine) {
            let less = match indicator.verdict {
                Verdict::MoreThanNeeded => "less would do: ",
                _ => "",
            };
            writeln!(f, "- {less}{}", indicator.text)?;
        }
        let written = ("as written", &self.written);
        let others = [("the sufficient model", &self.enough), ("the reference", &self.truth)];
        let others = others.iter().filter_map(|(name, run)| Some((*name, run.as_ref()?)));
        let mut told: Vec<&str> = Vec::new();
        for (name, candidate) in others.chain([written]) {
            for warning in &candidate.warnings {
                if !told.contains(&&warning[..]) {
                    writeln!(f, "- warning of {name}: {warning}")?;
                    told.push(warning);
                }
            }
        }
        for failed in self.candidates.iter().filter(|candidate| candidate.failure.is_some()) {
            writeln!(f, "- failed: {}", run(failed))?;
        }
        for what in &self.not_tried {
            writeln!(f, "- not tried: {what}")?;
        }
        if self.is_cut_short {
            writeln!(f, "- cut short: allow more time (--budget)")?;
        }
        write!(f, "\n{} runs in {}", self.runs, time_text(self.seconds))?;
        match self.known {
            0 => Ok(()),
            known => write!(f, ", and {known} from an earlier search"),
        }
    }
}
