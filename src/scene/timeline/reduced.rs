//! Scenes by a reduced model.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Scene;
#[cfg(feature = "scene-file")]
use super::written::WrittenKeys;
use crate::base::input::InputError;
use crate::scene::constraint::PhaseStart;
use crate::scene::reduced_model::ReducedModel;

impl Scene {
    /// The same scene with what its file says happens in it, value by value, by their keys.
    #[cfg(feature = "scene-file")]
    pub(crate) fn written_with(mut self, keys: BTreeMap<String, String>) -> Self {
        self.written = WrittenKeys(Arc::new(keys));
        self
    }

    /// The keys of its file that say what happens in it, with their values; none without a file.
    pub(crate) fn written_keys(&self) -> &BTreeMap<String, String> {
        &self.written.0
    }

    /// The same scene by a reduced model of it, which all its runs then use; equilibria are those of all unknowns.
    ///
    /// # Errors
    /// A model of another scene.
    pub fn reduced(mut self, model: ReducedModel) -> Result<Self, InputError> {
        let help = "it is one of another scene or mesh: reduce this one";
        let own = [self.body.dofs(), self.body.mesh().cell_count()];
        if own != [model.dofs, model.cell_count] {
            let value = format!("for {} unknowns and {} cells", model.dofs, model.cell_count);
            return Err(InputError::new("reduced model", value, help));
        }
        for phase in &self.phases {
            if !model.phases.iter().any(|reduced| reduced.name == phase.name) {
                let value = format!("without a phase \"{}\"", phase.name);
                return Err(InputError::new("reduced model", value, help));
            }
        }
        self.reduced = Some(Arc::new(model));
        Ok(self)
    }

    /// The scene with all its unknowns.
    pub fn unreduced(mut self) -> Self {
        self.reduced = None;
        self
    }

    /// The reduced model by which it is run, if there is one.
    pub fn reduced_model(&self) -> Option<&ReducedModel> {
        self.reduced.as_deref()
    }

    /// The same, shared.
    pub(crate) fn shared_reduced_model(&self) -> Option<&Arc<ReducedModel>> {
        self.reduced.as_ref()
    }

    /// Properties on which a reduced model of this scene depends: the name of each, and bytes that are equal where the
    /// property is. Loads are not among them, as a reduced model is learned over a range of these.
    ///
    /// # Errors
    /// Constraints that cannot be used.
    pub(crate) fn reduced_parts(&self) -> Result<Vec<(String, Vec<u8>)>, InputError> {
        self.body.refuse_around("reduced model", "learned")?;
        let (body, mesh) = (&self.body, self.body.mesh());
        let bytes =
            |numbers: &[f64]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
        let cells: Vec<&[usize]> = mesh.cells().collect();
        let matrices =
            [body.inertia().values(), body.stiffness().values(), body.damping().values()];
        let said = format!("{body:?}").into_bytes();
        // what grows in a phase is not among what is sampled there
        let mut growing = Vec::new();
        for phase in &self.phases {
            let cells = self.growing_cells(phase)?;
            if !cells.is_empty() {
                growing.extend(format!("{} {cells:?}", phase.name).into_bytes());
            }
        }
        let mut parts = vec![
            ("positions of the nodes".to_owned(), bytes(mesh.positions())),
            ("cells".to_owned(), format!("{:?} {cells:?}", mesh.kind()).into_bytes()),
            ("materials".to_owned(), [bytes(&matrices.concat()), said, growing].concat()),
        ];
        let rest = vec![0.0; body.dofs()];
        for phase in &self.phases {
            // where a phase begins, and so what its rows say, depends on the run; which terms they have does not
            let rows = self.rows(phase, &PhaseStart { time: 0.0, u: &rest })?;
            let terms: Vec<_> = rows.iter().map(|row| &row.terms).collect();
            let name = format!("nodes that phase \"{}\" holds and moves", phase.name);
            parts.push((name, format!("{terms:?}").into_bytes()));
        }
        Ok(parts)
    }
}
