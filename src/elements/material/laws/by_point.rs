//! Laws that the loops over cells call at each point: strain in, stress and elasticity out.
//!
//! The response of a law to a strain depends on the dimension of the cell alone, and not on its nodes and
//! points. So these formulas are compiled for each dimension and kind of register, and loops for each kind of
//! cell, but not for each pair of law and cell. (Hooke's laws are so short that a call would cost more than
//! they do; loops are compiled for each of them, and call one only in cells that grow by direction.)

use pulp::NullaryFnOnce;

use super::hookean::StVenantKirchhoff;
use super::rivlin::Rivlin;
use super::stretches::ByStretches;
use crate::base::tensor::{Matrix, Real};
use crate::elements::material::law::ElasticLaw;
use crate::elements::material::response::Response;

/// A law that is called as a function. All are of Green's strain.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ByPoint {
    Hooke(StVenantKirchhoff),
    Rivlin(Rivlin),
    Stretches(ByStretches),
}

/// Evaluates an expression with the law that a [`ByPoint`] holds.
macro_rules! with_called_law {
    ($called:expr, $law:ident => $expression:expr) => {
        match $called {
            ByPoint::Hooke($law) => $expression,
            ByPoint::Rivlin($law) => $expression,
            ByPoint::Stretches($law) => $expression,
        }
    };
}

/// A formula of a law at a point, as a function of twice the strain E and of the other arguments, compiled
/// separately.
macro_rules! formula {
    ($(#[$meta:meta])* $name:ident($($given:ident: $kind:ty),*) -> $made:ty, $law:ident, $point:ident => $formula:expr) => {
        $(#[$meta])*
        #[inline(always)]
        pub(crate) fn $name<T: Real, const M: usize>(
            &self,
            twice: &Matrix<T, M, M>,
            $($given: $kind),*
        ) -> $made {
            struct Formula<'a, T, const M: usize> {
                law: &'a ByPoint,
                twice: &'a Matrix<T, M, M>,
                $($given: $kind),*
            }
            impl<T: Real, const M: usize> NullaryFnOnce for Formula<'_, T, M> {
                type Output = $made;

                #[inline(always)]
                fn call(self) -> $made {
                    let Self { law, twice, $($given),* } = self;
                    with_called_law!(law, $law => {
                        let $point = $law.point(*twice);
                        $formula
                    })
                }
            }
            twice[0][0].apart(Formula { law: self, twice, $($given),* })
        }
    };
}

/// A `pull` is that of a projected dilatation, as in [`ElasticLaw`].
impl ByPoint {
    formula! {
        /// Second Piola stress S (Pa) times `weight`, and the domain of the law at a point that stretches a
        /// volume by `stretch`.
        stress(stretch: T, pull: Option<T>, weight: T) -> (Matrix<T, M, M>, T),
        law, point => (law.stress(&point, pull, weight), law.domain(stretch, &point))
    }

    formula! {
        /// S and dS/dE (Pa)
        response(pull: Option<T>) -> Response<T, M>, law, point => law.response(&point, pull)
    }

    formula! {
        /// g
        dilatation() -> T, law, point => law.dilatation(&point)
    }

    formula! {
        /// g and dg/dE
        swelling() -> (T, Matrix<T, M, M>),
        law, point => (law.dilatation(&point), law.swelling(&point))
    }

    formula! {
        /// W (J/m^3), with U at the point.
        energy() -> T, law, point => law.energy(&point)
    }

    formula! {
        /// W_shape (J/m^3) and g
        shape_and_volume() -> [T; 2],
        law, point => [law.energy_of_shape(&point), law.dilatation(&point)]
    }

    /// U (J/m^3), U' and U'' at g.
    #[inline(always)]
    pub(crate) fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3] {
        with_called_law!(self, law => law.of_volume(dilatation))
    }

    pub(crate) fn outside(&self, domain: f64) -> String {
        with_called_law!(self, law => law.outside(domain))
    }
}
