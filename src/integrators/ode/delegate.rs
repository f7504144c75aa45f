//! Systems within other ones.

/// Implements groups of methods of [`Ode`](super::Ode) or [`Dae`](super::Dae) by those of the system in a
/// field of `self`. `Failure`, `MatMut` and, with masses, `MassKind` are those of the caller.
///
/// The declarations are those of the traits, but without `self`, which is shared where there are no
/// arguments, and without the result `Result<(), Failure>`.
macro_rules! delegate {
    ($trait:ident in $($field:tt).+: $($group:ident),+) => {
        delegate!(@groups $trait [$($field).+] $($group)+);
    };
    (@groups $trait:ident $field:tt $($group:ident)+) => {
        $(delegate!(@$trait $group $field);)+
    };

    (@Ode equations $field:tt) => {
        delegate! { @methods $field
            fn rhs(t: f64, y: &[f64], ydot: &mut [f64]);
            fn supplied_jacobian() -> Option<$crate::integrators::ode::Storage<'_>>;
            fn dense_jacobian(t: f64, y: &[f64], ydot: &[f64], jacobian: MatMut<'_, f64>);
            fn banded_jacobian(t: f64, y: &[f64], ydot: &[f64], jacobian: BandMut<'_>);
            fn sparse_jacobian(t: f64, y: &[f64], ydot: &[f64], values: &mut [f64]);
            fn jacobian_times(t: f64, y: &[f64], ydot: &[f64], v: &[f64], jv: &mut [f64]);
        }
    };
    (@Ode companions $field:tt) => {
        delegate! { @methods $field
            fn project(t: f64, y: &[f64], correction: &mut [f64], error: &mut [f64]);
            fn root_count() -> usize;
            fn roots(t: f64, y: &[f64], g: &mut [f64]);
            fn quadrature_count() -> usize;
            fn quadratures(t: f64, y: &[f64], qdot: &mut [f64]);
            fn parameters() -> &[f64];
            fn set_parameters(values: &[f64]) -> ();
        }
    };
    (@Ode explicit_part $field:tt) => {
        delegate! { @methods $field
            fn is_split() -> bool;
            fn explicit_rhs(t: f64, y: &[f64], ydot: &mut [f64]);
        }
    };
    (@Ode mass $field:tt) => {
        delegate! { @methods $field
            fn mass_kind() -> MassKind;
            fn dense_mass(t: f64, mass: MatMut<'_, f64>);
            fn banded_mass(t: f64, mass: BandMut<'_>);
            fn sparse_mass(t: f64, values: &mut [f64]);
        }
    };
    (@Ode own_solvers $field:tt) => {
        delegate! { @methods $field
            fn newton_setup(
                t: f64, y: &[f64], ydot: &[f64], gamma: f64, reuse: bool
            ) -> Result<bool, Failure>;
            fn newton_solve(gamma: f64, r: &mut [f64]);
            fn newton_rhs(t: f64, y: &[f64], ydot: &mut [f64]);
            fn integrals() -> usize;
        }
    };
    (@Ode own_derivatives $field:tt) => {
        delegate! { @methods $field
            fn sensitivity_rhs(
                t: f64, y: &[f64], ydot: &[f64], parameter: usize, s: &[f64], sdot: &mut [f64]
            );
            fn adjoint_rhs(t: f64, y: &[f64], lambda: &[f64], out: &mut [f64]);
            fn adjoint_parameters(t: f64, y: &[f64], lambda: &[f64], out: &mut [f64]);
        }
    };

    (@Dae equations $field:tt) => {
        delegate! { @methods $field
            fn residual(t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]);
            fn supplied_jacobian() -> Option<$crate::integrators::ode::Storage<'_>>;
            fn dense_jacobian(t: f64, cj: f64, y: &[f64], yp: &[f64], jacobian: MatMut<'_, f64>);
            fn banded_jacobian(t: f64, cj: f64, y: &[f64], yp: &[f64], jacobian: BandMut<'_>);
            fn sparse_jacobian(t: f64, cj: f64, y: &[f64], yp: &[f64], values: &mut [f64]);
            fn jacobian_times(
                t: f64, cj: f64, y: &[f64], yp: &[f64], v: &[f64], jv: &mut [f64]
            );
        }
    };
    (@Dae companions $field:tt) => {
        delegate! { @methods $field
            fn root_count() -> usize;
            fn roots(t: f64, y: &[f64], yp: &[f64], g: &mut [f64]);
            fn quadrature_count() -> usize;
            fn quadratures(t: f64, y: &[f64], yp: &[f64], qdot: &mut [f64]);
            fn parameters() -> &[f64];
            fn set_parameters(values: &[f64]) -> ();
        }
    };
    (@Dae own_solvers $field:tt) => {
        delegate! { @methods $field
            fn newton_setup(t: f64, cj: f64, y: &[f64], yp: &[f64]);
            fn newton_solve(r: &mut [f64]);
        }
    };
    (@Dae own_derivatives $field:tt) => {
        delegate! { @methods $field
            fn sensitivity_residual(
                t: f64, y: &[f64], yp: &[f64], parameter: usize, s: &[f64], sp: &[f64],
                residual: &mut [f64]
            );
            fn adjoint_residual(
                t: f64, y: &[f64], yp: &[f64], lambda: &[f64], mu: &[f64], out: &mut [f64]
            );
            fn adjoint_parameters(t: f64, y: &[f64], yp: &[f64], lambda: &[f64], out: &mut [f64]);
        }
    };

    (@methods $field:tt $(fn $name:ident $arguments:tt $(-> $result:ty)?;)+) => {
        $(delegate!(@method $field $name $arguments $($result)?);)+
    };
    (@method $field:tt $name:ident ($($arguments:tt)+)) => {
        delegate!(@method $field $name ($($arguments)+) Result<(), Failure>);
    };
    (@method [$($field:tt)+] $name:ident () $result:ty) => {
        fn $name(&self) -> $result {
            self.$($field)+.$name()
        }
    };
    (@method [$($field:tt)+] $name:ident ($($argument:ident: $type:ty),+) $result:ty) => {
        fn $name(&mut self, $($argument: $type),+) -> $result {
            self.$($field)+.$name($($argument),+)
        }
    };
}
pub(crate) use delegate;
