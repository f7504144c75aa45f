//! Systems that add something to another one.

/// Implements the methods of [`Ode`](super::Ode) by those of the field `system`, but for what a wrapper adds.
macro_rules! delegate_to_system {
    () => {
        fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            self.system.rhs(t, y, ydot)
        }

        fn dense_jacobian(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            jacobian: MatMut<'_, f64>,
        ) -> Result<(), Failure> {
            self.system.dense_jacobian(t, y, ydot, jacobian)
        }

        fn banded_jacobian(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            jacobian: BandMut<'_>,
        ) -> Result<(), Failure> {
            self.system.banded_jacobian(t, y, ydot, jacobian)
        }

        fn sparse_jacobian(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            values: &mut [f64],
        ) -> Result<(), Failure> {
            self.system.sparse_jacobian(t, y, ydot, values)
        }

        fn project(
            &mut self,
            t: f64,
            y: &[f64],
            correction: &mut [f64],
            error: &mut [f64],
        ) -> Result<(), Failure> {
            self.system.project(t, y, correction, error)
        }

        fn root_count(&self) -> usize {
            self.system.root_count()
        }

        fn roots(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
            self.system.roots(t, y, g)
        }

        fn parameters(&self) -> &[f64] {
            self.system.parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.system.set_parameters(values);
        }
    };
}
pub(super) use delegate_to_system;
