//! The Runge-Kutta methods that come with ARKODE.

use std::{ffi::CStr, fmt, str::FromStr};

use crate::base::input::InputError;

/// A Runge-Kutta method, by its table of coefficients: one of those that SUNDIALS comes with.
///
/// The name ends in three numbers: stages, order of the error estimate, order of the method. `SDIRK` methods
/// are singly diagonally implicit; `ESDIRK` and `KVAERNO` ones have a first stage that costs nothing; `L2SA`
/// ones are L-stable, of stage order 2 (the highest possible), and stiffly accurate: a step ends with the
/// last stage. `ARK` ones come in pairs of an implicit and an explicit table with the same stages:
/// [`imex`](Self::imex) takes both, for systems that are [split](crate::integrators::ode::Ode::is_split).
/// (Others are a [`Tableau`](super::Tableau).)
///
/// ```
/// use pliant::sundials::ButcherTable;
///
/// let table: ButcherTable = "ESDIRK436L2SA_6_3_4".parse()?;
/// assert_eq!((table.order(), table.is_implicit()), (4, true));
/// assert_eq!(ButcherTable::explicit(5)?.name(), "DORMAND_PRINCE_7_4_5");
/// # Ok::<(), pliant::InputError>(())
/// ```
///
/// User guide: "Using ARKODE", appendix "Butcher tables".
#[derive(Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(into = "String", try_from = "String"))]
pub struct ButcherTable {
    id: &'static CStr,
    order: u32,
    form: Form,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Implicit,
    Explicit,
    /// Both, by the name of the pair and the explicit table that goes with the implicit one.
    ImEx(&'static str, &'static CStr),
}

const fn dirk(id: &'static CStr, order: u32) -> ButcherTable {
    ButcherTable { id, order, form: Form::Implicit }
}

const fn erk(id: &'static CStr, order: u32) -> ButcherTable {
    ButcherTable { id, order, form: Form::Explicit }
}

const fn ark(
    name: &'static str,
    id: &'static CStr,
    explicit: &'static CStr,
    order: u32,
) -> ButcherTable {
    ButcherTable { id, order, form: Form::ImEx(name, explicit) }
}

impl ButcherTable {
    /// All single tables: diagonally implicit ones, then explicit ones.
    ///
    /// The one without an error estimate is omitted.
    pub const ALL: [Self; 37] = [
        dirk(c"ARKODE_SDIRK_2_1_2", 2),
        dirk(c"ARKODE_BILLINGTON_3_3_2", 2),
        dirk(c"ARKODE_TRBDF2_3_3_2", 2),
        dirk(c"ARKODE_KVAERNO_4_2_3", 3),
        dirk(c"ARKODE_ARK324L2SA_DIRK_4_2_3", 3),
        dirk(c"ARKODE_ESDIRK324L2SA_4_2_3", 3),
        dirk(c"ARKODE_ESDIRK325L2SA_5_2_3", 3),
        dirk(c"ARKODE_ESDIRK32I5L2SA_5_2_3", 3),
        dirk(c"ARKODE_CASH_5_2_4", 4),
        dirk(c"ARKODE_CASH_5_3_4", 4),
        dirk(c"ARKODE_SDIRK_5_3_4", 4),
        dirk(c"ARKODE_KVAERNO_5_3_4", 4),
        dirk(c"ARKODE_ARK436L2SA_DIRK_6_3_4", 4),
        dirk(c"ARKODE_ARK437L2SA_DIRK_7_3_4", 4),
        dirk(c"ARKODE_ESDIRK436L2SA_6_3_4", 4),
        dirk(c"ARKODE_ESDIRK43I6L2SA_6_3_4", 4),
        dirk(c"ARKODE_QESDIRK436L2SA_6_3_4", 4),
        dirk(c"ARKODE_ESDIRK437L2SA_7_3_4", 4),
        dirk(c"ARKODE_KVAERNO_7_4_5", 5),
        dirk(c"ARKODE_ARK548L2SA_DIRK_8_4_5", 5),
        dirk(c"ARKODE_ARK548L2SAb_DIRK_8_4_5", 5),
        dirk(c"ARKODE_ESDIRK547L2SA_7_4_5", 5),
        dirk(c"ARKODE_ESDIRK547L2SA2_7_4_5", 5),
        erk(c"ARKODE_HEUN_EULER_2_1_2", 2),
        erk(c"ARKODE_BOGACKI_SHAMPINE_4_2_3", 3),
        erk(c"ARKODE_ARK324L2SA_ERK_4_2_3", 3),
        erk(c"ARKODE_ZONNEVELD_5_3_4", 4),
        erk(c"ARKODE_ARK436L2SA_ERK_6_3_4", 4),
        erk(c"ARKODE_ARK437L2SA_ERK_7_3_4", 4),
        erk(c"ARKODE_SAYFY_ABURUB_6_3_4", 4),
        erk(c"ARKODE_CASH_KARP_6_4_5", 5),
        erk(c"ARKODE_FEHLBERG_6_4_5", 5),
        erk(c"ARKODE_DORMAND_PRINCE_7_4_5", 5),
        erk(c"ARKODE_ARK548L2SA_ERK_8_4_5", 5),
        erk(c"ARKODE_ARK548L2SAb_ERK_8_4_5", 5),
        erk(c"ARKODE_VERNER_8_5_6", 6),
        erk(c"ARKODE_FEHLBERG_13_7_8", 8),
    ];

    /// All pairs of an implicit and an explicit table.
    pub const IMEX: [Self; 5] = [
        ark("ARK324L2SA_4_2_3", c"ARKODE_ARK324L2SA_DIRK_4_2_3", c"ARKODE_ARK324L2SA_ERK_4_2_3", 3),
        ark("ARK436L2SA_6_3_4", c"ARKODE_ARK436L2SA_DIRK_6_3_4", c"ARKODE_ARK436L2SA_ERK_6_3_4", 4),
        ark("ARK437L2SA_7_3_4", c"ARKODE_ARK437L2SA_DIRK_7_3_4", c"ARKODE_ARK437L2SA_ERK_7_3_4", 4),
        ark("ARK548L2SA_8_4_5", c"ARKODE_ARK548L2SA_DIRK_8_4_5", c"ARKODE_ARK548L2SA_ERK_8_4_5", 5),
        ark(
            "ARK548L2SAb_8_4_5",
            c"ARKODE_ARK548L2SAb_DIRK_8_4_5",
            c"ARKODE_ARK548L2SAb_ERK_8_4_5",
            5,
        ),
    ];

    /// The diagonally implicit method to take for an order, 2 to 5.
    ///
    /// # Errors
    /// For another order.
    pub fn implicit(order: u32) -> Result<Self, InputError> {
        match order {
            2 => "TRBDF2_3_3_2".parse(),
            3 => "ESDIRK325L2SA_5_2_3".parse(),
            4 => Ok(Self::default()),
            5 => "ESDIRK547L2SA2_7_4_5".parse(),
            _ => Err(InputError::new("order", order, "implicit methods have orders 2 to 5")),
        }
    }

    /// The explicit method to take for an order: 2 to 6, or 8.
    ///
    /// # Errors
    /// For another order.
    pub fn explicit(order: u32) -> Result<Self, InputError> {
        match order {
            2 => "HEUN_EULER_2_1_2".parse(),
            3 => "BOGACKI_SHAMPINE_4_2_3".parse(),
            4 => "ZONNEVELD_5_3_4".parse(),
            5 => "DORMAND_PRINCE_7_4_5".parse(),
            6 => "VERNER_8_5_6".parse(),
            8 => "FEHLBERG_13_7_8".parse(),
            _ => Err(InputError::new("order", order, "explicit methods have orders 2 to 6, and 8")),
        }
    }

    /// The pair of an implicit and an explicit method (ImEx) to take for an order, 3 to 5.
    ///
    /// # Errors
    /// For another order.
    pub fn imex(order: u32) -> Result<Self, InputError> {
        match order {
            3 => "ARK324L2SA_4_2_3".parse(),
            4 => "ARK437L2SA_7_3_4".parse(),
            5 => "ARK548L2SAb_8_4_5".parse(),
            _ => Err(InputError::new("order", order, "ImEx methods have orders 3 to 5")),
        }
    }

    /// The name in the user guide, without the prefix `ARKODE_`; for a pair without `DIRK` and `ERK`.
    #[must_use]
    pub fn name(self) -> &'static str {
        if let Form::ImEx(name, _) = self.form {
            return name;
        }
        let id = self.id.to_str().unwrap_or_default();
        id.strip_prefix(PREFIX).unwrap_or(id)
    }

    /// Order of the method.
    #[must_use]
    pub fn order(self) -> u32 {
        self.order
    }

    /// Whether its stages are equations to be solved.
    #[must_use]
    pub fn is_implicit(self) -> bool {
        self.form != Form::Explicit
    }

    /// Whether it is a pair of an implicit and an explicit table.
    #[must_use]
    pub fn is_imex(self) -> bool {
        matches!(self.form, Form::ImEx(..))
    }

    /// The names of the implicit and the explicit table for ARKODE; one may be the name for no table.
    pub(super) fn ids(self) -> (&'static CStr, &'static CStr) {
        match self.form {
            Form::Implicit => (self.id, c"ARKODE_ERK_NONE"),
            Form::Explicit => (c"ARKODE_DIRK_NONE", self.id),
            Form::ImEx(_, explicit) => (self.id, explicit),
        }
    }
}

const PREFIX: &str = "ARKODE_";

impl Default for ButcherTable {
    /// The implicit method of order 4.
    fn default() -> Self {
        dirk(c"ARKODE_ARK437L2SA_DIRK_7_3_4", 4)
    }
}

impl FromStr for ButcherTable {
    type Err = InputError;

    /// Reads a name, with or without the prefix `ARKODE_`.
    fn from_str(name: &str) -> Result<Self, InputError> {
        let short = name.strip_prefix(PREFIX).unwrap_or(name);
        let mut known = Self::ALL.into_iter().chain(Self::IMEX);
        known.clone().find(|table| table.name() == short).ok_or_else(|| {
            let known = known.by_ref().map(Self::name).collect::<Vec<_>>().join(", ");
            InputError::new("table", format!("\"{name}\""), format!("it is one of {known}"))
        })
    }
}

#[cfg(feature = "serde")]
impl From<ButcherTable> for String {
    fn from(table: ButcherTable) -> Self {
        table.name().into()
    }
}

#[cfg(feature = "serde")]
impl TryFrom<String> for ButcherTable {
    type Error = InputError;

    fn try_from(name: String) -> Result<Self, InputError> {
        name.parse()
    }
}

impl fmt::Display for ButcherTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Debug for ButcherTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ButcherTable({self})")
    }
}
