//! The laws that a material may have, with all data of each except its formulas in one row: word and constants in
//! scene files, reference and lists, how it is made from its constants, and how near it is to rubber.

use super::own::{OwnEnergy, StrainEnergy};
use crate::base::input::{InputError, finite};

/// The elastic law of a [`Material`](crate::Material) at large strains: [`information`](Self::information) has the facts of each.
///
/// Each law has the material's Young's modulus and Poisson's ratio at small strains; its other parameters are
/// ratios, without unit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Law {
    /// Hooke's law for Green's strain. It softens under compression: a bar pressed to 58 % of its length
    /// (1/sqrt 3) collapses.
    StVenantKirchhoff,
    /// W = c1 (I1 - 3) + U, with I1 of J^(-2/3) C and U = (kappa/4) (J^2 - 1 - 2 ln J); c1 = mu/2. Rubber at
    /// strains up to a half.
    NeoHookean,
    /// W = c1 (I1 - 3) + c2 (I2 - 3) + U, with 2 (c1 + c2) = mu.
    MooneyRivlin {
        /// c2 / (c1 + c2), 0 to 1.
        second: f64,
    },
    /// W = c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3 + U, with 2 c1 = mu: rubber that stiffens.
    Yeoh {
        /// c2 / c1
        second: f64,
        /// c3 / c1
        third: f64,
    },
    /// W = sum of mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) over three terms, + U, with the
    /// principal stretches l without the change of volume, J^(-1/3) times those of F: rubber over its whole
    /// range. The sum of mu_p alpha_p is 2 mu.
    Ogden {
        /// alpha_p (1), not 0
        exponents: [f64; 3],
        /// mu_p alpha_p / (2 mu) (1): none is below 0, and they add up to 1. A share of 0 leaves a term out.
        shares: [f64; 3],
    },
    /// W = mu |U - I|^2 + (lambda/2) tr(U - I)^2 with the stretch U of each point, U^2 = F^T F: Hooke's law
    /// in a frame that rotates with the point, for large rotations and small strains. Unlike St.
    /// Venant-Kirchhoff material it stays stiff under compression.
    Corotated,
    /// W = an energy that the program [defines](StrainEnergy), of the stretches without the change of volume, + U: see [`Law::own`].
    Own(OwnEnergy),
}

/// A law with the shear modulus (Pa) that follows from its constants, or why there is none.
pub(crate) type LawOfConstants = Result<(Law, Option<f64>), String>;

/// Facts of a [`Law`].
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct LawInformation {
    /// Its name, the word in scene files.
    pub name: &'static str,
    /// Its strain energy and its purpose, in words.
    pub about: &'static str,
    /// Its constants in scene files; none where Young's modulus and Poisson's ratio are its constants.
    pub constants: &'static [LawConstant],
    /// The law of these values of its constants, with the shear modulus (Pa) that follows; else why there is none.
    pub(crate) of_constants: fn(&[Vec<f64>]) -> LawOfConstants,
    /// Whether it is one of rubber.
    pub is_rubber: bool,
    /// Relative difference of its stress from that of rubber, in multiples of the strain.
    pub(crate) error_of_strain: f64,
    /// The same in words, for warnings.
    pub(crate) error: &'static str,
}

/// A constant of a law in scene files.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct LawConstant {
    /// Its key.
    pub name: &'static str,
    /// Its meaning, in words.
    pub meaning: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Whether it is a list, one number for each term.
    pub is_list: bool,
}

impl LawConstant {
    const fn pascals(name: &'static str, meaning: &'static str) -> Self {
        Self { name, meaning, unit: "Pa", is_list: false }
    }
}

/// The laws of scene files.
pub(crate) const LAWS: [&LawInformation; 6] =
    [&ST_VENANT_KIRCHHOFF, &NEO_HOOKEAN, &MOONEY_RIVLIN, &YEOH, &OGDEN, &COROTATED];

const ST_VENANT_KIRCHHOFF: LawInformation = LawInformation {
    name: "st-venant-kirchhoff",
    about: "Hooke's law for Green's strain: for small strains and any rotation; it softens under compression, and collapses",
    constants: &[],
    of_constants: |_| Ok((Law::StVenantKirchhoff, None)),
    is_rubber: false,
    error_of_strain: 2.5,
    error: "St. Venant and Kirchhoff's law is off by some 2.5 times that",
};

const NEO_HOOKEAN: LawInformation = LawInformation {
    name: "neo-hookean",
    about: "W = c1 (I1 - 3) + U, c1 = mu/2: rubber and silicone up to a strain of a half",
    constants: &[],
    of_constants: |_| Ok((Law::NeoHookean, None)),
    ..RUBBER
};

const MOONEY_RIVLIN: LawInformation = LawInformation {
    name: "mooney-rivlin",
    about: "W = c1 (I1 - 3) + c2 (I2 - 3) + U: rubber up to a strain of one; mu = 2 (c1 + c2)",
    constants: &[C1, LawConstant::pascals("c2", "the constant of I2")],
    of_constants: |constants| {
        let (c1, c2) = (number(constants, 0), number(constants, 1));
        let sum = positive("c1 + c2", c1 + c2)?;
        Ok((Law::MooneyRivlin { second: c2 / sum }, Some(2.0 * sum)))
    },
    ..RUBBER
};

const YEOH: LawInformation = LawInformation {
    name: "yeoh",
    about: "W = c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3 + U: rubber that stiffens before it tears; mu = 2 c1",
    constants: &[
        C1,
        LawConstant::pascals("c2", "the constant of (I1 - 3)^2"),
        LawConstant::pascals("c3", "the constant of (I1 - 3)^3"),
    ],
    of_constants: |constants| {
        let c1 = positive("c1", number(constants, 0))?;
        let [second, third] = [1, 2].map(|place| number(constants, place) / c1);
        Ok((Law::Yeoh { second, third }, Some(2.0 * c1)))
    },
    ..RUBBER
};

const OGDEN: LawInformation = LawInformation {
    name: "ogden",
    about: "W = sum of mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) + U, with the principal stretches l of J^(-2/3) C: rubber over its \
            whole range; 2 mu = sum of mu_p alpha_p",
    constants: &[
        LawConstant {
            name: "moduli",
            meaning: "mu_p of one to three terms",
            unit: "Pa",
            is_list: true,
        },
        LawConstant {
            name: "exponents",
            meaning: "alpha_p of the same terms",
            unit: "1",
            is_list: true,
        },
    ],
    of_constants: |constants| {
        let of = |place: usize| constants.get(place).map_or(&[][..], Vec::as_slice);
        let (moduli, given) = (of(0), of(1));
        if moduli.len() != given.len() || !(1..=3).contains(&moduli.len()) {
            return Err(format!(
                "{} `moduli` and {} `exponents`: give one of each for one to three terms",
                moduli.len(),
                given.len()
            ));
        }
        let (mut products, mut exponents) = ([0.0; 3], [1.0; 3]);
        exponents[..given.len()].copy_from_slice(given);
        for (k, modulus) in moduli.iter().enumerate() {
            products[k] = modulus * exponents[k];
        }
        let twice = positive("the sum of moduli times exponents", products.iter().sum())?;
        let shares = products.map(|product| product / twice);
        Ok((Law::Ogden { exponents, shares }, Some(twice / 2.0)))
    },
    ..RUBBER
};

const COROTATED: LawInformation = LawInformation {
    name: "corotated",
    about: "W = mu |U - I|^2 + (lambda/2) tr(U - I)^2 with the stretch U of each point: Hooke's law in a frame that turns along, for \
            large rotations and small strains; it does not collapse under compression",
    constants: &[],
    of_constants: |_| Ok((Law::Corotated, None)),
    is_rubber: false,
    error_of_strain: 1.0,
    error: "Hooke's law of the stretches is off by about as much",
};

/// The row of energies of programs, and facts that laws of rubber share: they follow rubber up to about twice the length, where
/// it begins to stiffen as its chains of molecules are stretched out.
const RUBBER: LawInformation = LawInformation {
    name: "own",
    about: "W = an energy of the program + U",
    constants: &[],
    of_constants: |_| Err("an energy of a program has no table in scene files".into()),
    is_rubber: true,
    error_of_strain: 0.25,
    error: "rubber stiffens at such strains as only constants that are fitted to it tell",
};

const C1: LawConstant = LawConstant::pascals("c1", "the constant of I1");

/// The constant at `place`, which is one number.
fn number(constants: &[Vec<f64>], place: usize) -> f64 {
    constants.get(place).and_then(|values| values.first()).copied().unwrap_or(f64::NAN)
}

fn positive(name: &str, value: f64) -> Result<f64, String> {
    match value > 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(format!("{name} = {value:e} Pa: it has to be above 0")),
    }
}

impl Law {
    /// The law of an energy of one's own: of a `static`, or a value that `Box::leak` keeps, as laws are copied to all places that need them.
    pub const fn own(energy: &'static impl StrainEnergy) -> Self {
        Self::Own(OwnEnergy::new(energy))
    }

    /// The facts of the law, its row.
    pub fn information(self) -> &'static LawInformation {
        match self {
            Self::StVenantKirchhoff => &ST_VENANT_KIRCHHOFF,
            Self::NeoHookean => &NEO_HOOKEAN,
            Self::MooneyRivlin { .. } => &MOONEY_RIVLIN,
            Self::Yeoh { .. } => &YEOH,
            Self::Ogden { .. } => &OGDEN,
            Self::Corotated => &COROTATED,
            Self::Own(_) => &RUBBER,
        }
    }

    /// Its name, as in scene files.
    pub fn name(self) -> &'static str {
        self.information().name
    }

    pub(crate) fn validate(self) -> Result<(), InputError> {
        match self {
            Self::StVenantKirchhoff | Self::NeoHookean | Self::Corotated | Self::Own(_) => Ok(()),
            Self::MooneyRivlin { second } => match (0.0..=1.0).contains(&second) {
                true => Ok(()),
                false => {
                    let help = "c2 / (c1 + c2) lies between 0 and 1: neither c1 nor c2 is below 0, and their sum is above";
                    Err(InputError::new("law.second", second, help))
                }
            },
            Self::Ogden { exponents, shares } => {
                finite("law.exponents", &exponents)?;
                if let Some(share) = shares.iter().find(|share| !(0.0..=1.0).contains(*share)) {
                    let help = "a share mu_p alpha_p / (2 mu) lies between 0 and 1: below 0 its term would pull back where rubber is stretched";
                    return Err(InputError::new("law.shares", share, help));
                }
                let sum: f64 = shares.iter().sum();
                if (sum - 1.0).abs() > 1e-9 {
                    let help = format!(
                        "the shares mu_p alpha_p / (2 mu) of all terms add up to 1, and these to {sum}"
                    );
                    return Err(InputError::new("law.shares", format!("{shares:?}"), help));
                }
                let is_flat = |(exponent, share): (&f64, &f64)| *exponent == 0.0 && *share > 0.0;
                match exponents.iter().zip(&shares).any(is_flat) {
                    true => {
                        let help =
                            "an exponent of 0 has no energy: leave the term out by a share of 0";
                        Err(InputError::new("law.exponents", format!("{exponents:?}"), help))
                    }
                    false => Ok(()),
                }
            }
            Self::Yeoh { second, third } => {
                finite("law.second", &[second])?;
                // dW/dI1 = c1 (1 + 2 second x + 3 third x^2), above 0 for all x = I1 - 3 >= 0
                let grows = third >= 0.0 && (second >= 0.0 || second * second < 3.0 * third);
                match grows {
                    true => finite("law.third", &[third]),
                    false => {
                        let help = format!(
                            "with c2 / c1 = {second} stress falls with strain somewhere: c3 / c1 has to be 0 or above, and above (c2 / c1)^2 / 3 if c2 is below 0"
                        );
                        Err(InputError::new("law.third", third, help))
                    }
                }
            }
        }
    }
}
