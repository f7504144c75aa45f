//! Runge-Kutta methods by coefficients of the user.

use std::{ffi::c_void, fmt, ptr};

use super::butcher_table::ButcherTable;
use crate::base::input::InputError;
use crate::integrators::{common::Error, sundials::ffi};

/// A Butcher tableau: stages z_i = y + h sum_j a_ij f(t + c_i h, z_j) of a step y + h sum_i b_i f(t + c_i h, z_i),
/// where the c_i are the sums of the rows of a.
///
/// It is explicit if all a_ij with j >= i are zero, and diagonally implicit if those with j > i are. Its order is
/// checked by the conditions for orders up to 6 (`ARKodeButcherTable_CheckOrder`).
///
/// ```
/// use pliant::sundials::{ArkodeOptions, Tableau};
///
/// // the method of Heun, with Euler's for the error estimate
/// let heun = Tableau::new(2, [&[][..], &[1.0]], [0.5, 0.5]).embedded(1, [1.0, 0.0]);
/// let options = ArkodeOptions::new(1e-6, 1e-9).tableau(heun);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Tableau {
    order: u32,
    /// Rows as they were given.
    a: Vec<Vec<f64>>,
    b: Vec<f64>,
    /// Order and coefficients of the method that estimates the error.
    embedded: Option<(u32, Vec<f64>)>,
}

impl Tableau {
    /// Of this order, with the rows of a, in which zeros at the end may be omitted, and the weights b.
    ///
    /// Coefficients that cannot be used are an error of the solver's `new`.
    pub fn new<R: AsRef<[f64]>>(
        order: u32,
        a: impl IntoIterator<Item = R>,
        b: impl Into<Vec<f64>>,
    ) -> Self {
        let a = a.into_iter().map(|row| row.as_ref().to_vec()).collect();
        Self { order, a, b: b.into(), embedded: None }
    }

    /// The weights of the method that estimates the error, and its order. Without them steps are of a
    /// [fixed size](super::ArkodeOptions::fixed_step).
    pub fn embedded(mut self, order: u32, weights: impl Into<Vec<f64>>) -> Self {
        self.embedded = Some((order, weights.into()));
        self
    }

    fn is_implicit(&self) -> bool {
        self.a.iter().enumerate().any(|(i, row)| row.get(i).is_some_and(|a| *a != 0.0))
    }

    /// Checks shape and numbers, and that there is an error estimate if one is `needed`.
    fn check_form(&self, needed: bool) -> Result<(), InputError> {
        let stages = self.b.len();
        let refused = |value: String, help: String| Err(InputError::new("tableau", value, help));
        if stages == 0 || self.a.len() != stages {
            let value = format!("{} rows of a, {stages} weights b", self.a.len());
            return refused(value, "there is a row and a weight for each stage".into());
        }
        for (i, row) in self.a.iter().enumerate() {
            if row.iter().skip(i + 1).any(|a| *a != 0.0) || row.len() > stages {
                let help = "stages follow from those before and from themselves: entries behind the diagonal are zero";
                return refused(format!("row {i} of a: {row:?}"), help.into());
            }
        }
        let estimate = self.embedded.as_ref().map(|(_, weights)| weights);
        if let Some(weights) = estimate.filter(|weights| weights.len() != stages) {
            let help = format!("there are {stages} stages");
            return refused(format!("{} embedded weights", weights.len()), help);
        }
        let mut numbers = self.a.iter().chain([&self.b]).chain(estimate).flatten();
        if let Some(number) = numbers.find(|number| !number.is_finite()) {
            return refused(number.to_string(), "coefficients are finite".into());
        }
        if needed && estimate.is_none() {
            let help = "steps by tolerances need an error estimate: give embedded weights, or a fixed step";
            return refused("without embedded weights".into(), help.into());
        }
        Ok(())
    }

    /// Checks that its orders are those of its coefficients.
    fn check_order(&self) -> Result<(), InputError> {
        let table = self.table();
        let mut orders = [0; 2];
        let [order, embedded] = &mut orders;
        // SAFETY: the table is alive, the result pointers are valid, and nothing is printed.
        unsafe { ffi::ARKodeButcherTable_CheckOrder(table.0, order, embedded, ptr::null_mut()) };
        self.compare(orders)
    }

    /// The same for a pair, where conditions couple both.
    fn check_pair(&self, explicit: &Self) -> Result<(), InputError> {
        self.check_order()?;
        explicit.check_order()?;
        let (implicit, table) = (self.table(), explicit.table());
        let mut orders = [0; 2];
        let [order, embedded] = &mut orders;
        // SAFETY: as above.
        unsafe {
            let (e, i) = (table.0, implicit.0);
            ffi::ARKodeButcherTable_CheckARKOrder(e, i, order, embedded, ptr::null_mut())
        };
        self.compare(orders)
    }

    /// Rejects orders above those that C has found, by its conditions up to order 6.
    fn compare(&self, found: [i32; 2]) -> Result<(), InputError> {
        let embedded = self.embedded.as_ref().map_or(0, |(order, _)| *order);
        let wrong = |(declared, found): (u32, i32)| i64::from(declared).min(6) > i64::from(found);
        if self.order > 0 && ![self.order, embedded].into_iter().zip(found).any(wrong) {
            return Ok(());
        }
        let help =
            format!("the coefficients have the orders {} and {} (embedded)", found[0], found[1]);
        Err(InputError::new(
            "orders of the tableau",
            format!("{} and {embedded}", self.order),
            help,
        ))
    }

    /// The same for C, after `check_form`.
    fn table(&self) -> Table {
        let stages = self.b.len();
        let mut a = vec![0.0; stages * stages];
        for (row, out) in self.a.iter().zip(a.chunks_exact_mut(stages)) {
            out[..row.len()].copy_from_slice(row);
        }
        let mut c: Vec<f64> = self.a.iter().map(|row| row.iter().sum()).collect();
        let mut b = self.b.clone();
        let (p, mut d) = self.embedded.clone().unwrap_or_default();
        let d = if d.is_empty() { ptr::null_mut() } else { d.as_mut_ptr() };
        let (q, p, n) = (self.order as i32, p as i32, stages as i32);
        let (a, b, c) = (a.as_mut_ptr(), b.as_mut_ptr(), c.as_mut_ptr());
        // SAFETY: the arrays are as long as C expects; it copies them.
        Table(unsafe { ffi::ARKodeButcherTable_Create(n, q, p, c, a, b, d) })
    }
}

/// Owns a table of C.
struct Table(ffi::ARKodeButcherTable);

impl Drop for Table {
    fn drop(&mut self) {
        // SAFETY: made by ARKodeButcherTable_Create and freed once; null is allowed.
        unsafe { ffi::ARKodeButcherTable_Free(self.0) };
    }
}

/// The method of an ARKODE solver.
#[derive(Clone, Debug)]
pub(super) enum Scheme {
    Known(ButcherTable),
    Own(Tableau),
    /// The implicit and the explicit one.
    OwnPair(Tableau, Tableau),
}

impl Scheme {
    pub(super) fn order(&self) -> u32 {
        match self {
            Self::Known(table) => table.order(),
            Self::Own(tableau) | Self::OwnPair(tableau, _) => tableau.order,
        }
    }

    pub(super) fn is_implicit(&self) -> bool {
        match self {
            Self::Known(table) => table.is_implicit(),
            Self::Own(tableau) | Self::OwnPair(tableau, _) => tableau.is_implicit(),
        }
    }

    pub(super) fn is_imex(&self) -> bool {
        match self {
            Self::Known(table) => table.is_imex(),
            Self::Own(_) => false,
            Self::OwnPair(..) => true,
        }
    }

    /// Refuses tableaux that cannot be used; `adapts`: for steps that the tolerances control.
    pub(super) fn check(&self, adapts: bool) -> Result<(), InputError> {
        match self {
            Self::Known(_) => Ok(()),
            Self::Own(tableau) => {
                tableau.check_form(adapts)?;
                tableau.check_order()
            }
            Self::OwnPair(implicit, explicit) => {
                implicit.check_form(adapts)?;
                explicit.check_form(adapts)?;
                let [i, e] = [implicit, explicit].map(|tableau| {
                    let embedded = tableau.embedded.as_ref().map(|(order, _)| *order);
                    (tableau.b.len(), tableau.order, embedded)
                });
                if i != e || !implicit.is_implicit() || explicit.is_implicit() {
                    let help = "a pair is an implicit and an explicit tableau of the same stages and orders";
                    return Err(InputError::new("tableaux", "a pair", help));
                }
                implicit.check_pair(explicit)
            }
        }
    }

    /// Sets it in an ARKODE memory, and hands names of functions with their codes to `accept`.
    ///
    /// # Safety
    /// The memory is one of ARKStep and alive.
    pub(super) unsafe fn set(
        &self,
        memory: *mut c_void,
        mut accept: impl FnMut(&'static str, i32) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (tableau, explicit) = match self {
            Self::Known(table) => {
                let (implicit, explicit) = table.ids();
                let (implicit, explicit) = (implicit.as_ptr(), explicit.as_ptr());
                // SAFETY: the caller vouches for the memory; the names are C strings that are read once.
                let code = unsafe { ffi::ARKStepSetTableName(memory, implicit, explicit) };
                return accept("ARKStepSetTableName", code);
            }
            Self::Own(tableau) => (tableau, None),
            Self::OwnPair(implicit, explicit) => (implicit, Some(explicit.table())),
        };
        let (own, none) = (tableau.table(), ptr::null_mut());
        let (implicit, explicit) = match explicit {
            Some(ref explicit) => (own.0, explicit.0),
            None if tableau.is_implicit() => (own.0, none),
            None => (none, own.0),
        };
        let embedded = tableau.embedded.as_ref().map_or(0, |(order, _)| *order as i32);
        let order = tableau.order as i32;
        // SAFETY: the caller vouches for the memory; C copies the tables, which are alive.
        let code = unsafe { ffi::ARKStepSetTables(memory, order, embedded, implicit, explicit) };
        accept("ARKStepSetTables", code)
    }
}

impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Known(table) => table.fmt(f),
            Self::Own(tableau) => write!(f, "a tableau of order {}", tableau.order),
            Self::OwnPair(tableau, _) => write!(f, "a pair of tableaux of order {}", tableau.order),
        }
    }
}
