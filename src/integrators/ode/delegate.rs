//! Systems within other ones.

/// Implements methods of [`Ode`](super::Ode) by those of the system in a field: all but what belongs to a
/// mass matrix, a split right-hand side, sensitivities, or linear solvers of the system's own.
macro_rules! delegate_ode {
    ($field:tt) => {
        fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            self.$field.rhs(t, y, ydot)
        }

        fn dense_jacobian(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            jacobian: MatMut<'_, f64>,
        ) -> Result<(), Failure> {
            self.$field.dense_jacobian(t, y, ydot, jacobian)
        }

        fn banded_jacobian(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            jacobian: BandMut<'_>,
        ) -> Result<(), Failure> {
            self.$field.banded_jacobian(t, y, ydot, jacobian)
        }

        fn sparse_jacobian(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            values: &mut [f64],
        ) -> Result<(), Failure> {
            self.$field.sparse_jacobian(t, y, ydot, values)
        }

        fn jacobian_times(
            &mut self,
            t: f64,
            y: &[f64],
            ydot: &[f64],
            v: &[f64],
            jv: &mut [f64],
        ) -> Result<(), Failure> {
            self.$field.jacobian_times(t, y, ydot, v, jv)
        }

        fn project(
            &mut self,
            t: f64,
            y: &[f64],
            correction: &mut [f64],
            error: &mut [f64],
        ) -> Result<(), Failure> {
            self.$field.project(t, y, correction, error)
        }

        fn root_count(&self) -> usize {
            self.$field.root_count()
        }

        fn roots(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
            self.$field.roots(t, y, g)
        }

        fn quadrature_count(&self) -> usize {
            self.$field.quadrature_count()
        }

        fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
            self.$field.quadratures(t, y, qdot)
        }

        fn parameters(&self) -> &[f64] {
            self.$field.parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.$field.set_parameters(values);
        }
    };
}
pub(super) use delegate_ode;
