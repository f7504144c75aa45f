//! `material`, of the body or of a region, and its `law`.

use super::keys::{Key, Kind, TableKeys, ValueType};
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::elements::material::{
    FibreDirection, Fibres, LAWS, Law, LawConstant, LawInformation, Material, MaxwellBranch,
    Moments, RigidMass, Substance,
};

pub(super) const MATERIAL: TableKeys = TableKeys::new(
    "material",
    "An isotropic viscoelastic material: Lamé's parameters follow from `young` and `poisson`, and those of \
     viscosity from `viscosity` and `poisson` in the same way.",
    &[
        Key::number("density", "the density", "kg/m^3").default(OF_BODY),
        Key::new("rigid", ValueType::Flag, "whether bodies or regions of this material are rigid")
            .note("The mesh then gives its shape and inertia, and it moves by 3 degrees of freedom (6 in space). Only `density` is needed, or `mass`; \
                  in equilibria `young`, by default 1e8 Pa, keeps its shape.")
            .default("false; in a region, as the body"),
        Key::number("mass", "the mass of a rigid body, in place of `density`", "kg")
            .note("Of a whole body that is one piece, without regions.")
            .default("that of `density`"),
        Key::new("centre", ValueType::Vector, "the undeformed position of the centre of mass of a rigid body")
            .in_unit("m")
            .note("Goes with `inertia`.")
            .default("that of a uniform density"),
        Key::new(
            "inertia",
            ValueType::Either(&[
                ValueType::Number,
                ValueType::Array(&ValueType::Number, 3),
                ValueType::Array(&ValueType::Array(&ValueType::Number, 3), 3),
            ]),
            "moments of inertia of a rigid body about its centre of mass",
        )
        .in_unit("kg m^2")
        .note("Goes with `mass`. In the plane one number; in space the three principal moments, where x, y and z are principal axes of the \
              undeformed body, or the symmetric matrix, with the products -int x y dm beside its diagonal.")
        .default("those of a uniform density"),
        Key::number("young", "Young's modulus at small strains", "Pa")
            .note("It follows from the constants of a law that has them.")
            .default(OF_BODY),
        Key::number("poisson", "Poisson's ratio at small strains, below 0.5", "1")
            .note("It follows from the law's `bulk`, if that is given.")
            .default(OF_BODY),
        Key::number("viscosity", "the viscous modulus", "Pa s")
            .note("Equilibria do not depend on it.")
            .default("0; in a region, that of the body"),
        Key::number("mass_damping", "damping in proportion to mass: force -a M v", "1/s")
            .note("As of air or water around: it brakes motions of the whole body, too. Vibrations of circular frequency omega are damped by \
                  the ratio a / (2 omega).")
            .default("0; in a region, that of the body"),
        Key::new("branch", ValueType::Tables(&BRANCH), "Maxwell branches, springs that relax")
            .default("none; in a region, those of the body"),
        Key::new("fibres", ValueType::Tables(&FIBRES), "families of fibres that stiffen it along their course")
            .default("none; in a region, those of the body"),
        Key::new("law", ValueType::Table(&LAW), "the law at large strains").default(
            "as `strain` says: linear elasticity with Cauchy's, St. Venant-Kirchhoff with Green's",
        ),
    ],
    "material = { density = 1000.0, young = 1.0e5, poisson = 0.48, viscosity = 40.0 }",
);
const OF_BODY: &str = "required; in a region, that of the body";

const BRANCH: TableKeys = TableKeys::new(
    "branch",
    "A spring and a damper in a row, beside the elasticity of the material: what is strained at once and kept so pulls by the spring, less and less, \
     as exp(-t / `time`). `young` is what is left when all has relaxed. For BDF, Adams, ARKODE and `rk`, and for equilibria. Energies and forces have its part, fields and sensors of \
     stress do not.",
    &[
        Key::number("share", "Young's modulus of the spring by that of the material", "1")
            .required(),
        Key::number("time", "the relaxation time", "s").required(),
        Key::number("yield_stress", "the von Mises stress below which nothing relaxes", "Pa")
            .note("Above it G' = (1 - `yield_stress` / q) dev(E - G) / `time`, q being the spring's: what shears relaxes down to it, a change of volume does not, and \
                  what has flowed stays, as in dough.")
            .default("0"),
    ],
    "material = { density = 1070.0, young = 2.0e5, poisson = 0.48, viscosity = 0.0, branch = [{ share = 0.2, time = 0.1 }] }",
);

const FIBRES: TableKeys = TableKeys::new(
    "fibres",
    "Fibres that run through the material and take tension: with their stretch l and E = (l^2 - 1)/2 they add the energy \
     (`young` / (8 k2)) (exp(4 k2 E^2) - 1) per natural volume where l > 1, k2 being `stiffening`. They lie along a vector, or around an axis: threads \
     wound around an actuator. For bodies with Green's strain; stresses in results are those of the material between them.",
    &[
        Key::number("young", "Young's modulus that they add along their course: of a fibre, times its share of the section", "Pa")
            .required(),
        Key::number("stiffening", "how fast they stiffen", "1").default("0"),
        ALONG,
        CENTRE,
        AXIS,
        PITCH,
    ],
    "material = { density = 1070.0, young = 2.0e5, poisson = 0.49, viscosity = 0.0, fibres = [{ along = [1.0, 0.2], young = 2.0e7 }] }",
)
.one_of(&[&["along"], &["centre"]]);

pub(super) const ALONG: Key =
    Key::new("along", ValueType::Vector, "a vector along them, of any length");
pub(super) const CENTRE: Key =
    Key::new("centre", ValueType::Vector, "a point of the axis that they run around").in_unit("m");
pub(super) const AXIS: Key =
    Key::new("axis", ValueType::Vector, "direction of the axis, of any length; none in the plane")
        .default("across the plane");
pub(super) const PITCH: Key = Key::number(
    "pitch",
    "angle by which they climb along the axis: 0 are rings, others helices",
    "rad",
)
.default("0");

pub(super) const LAW: TableKeys = TableKeys::new(
    "law",
    "The strain energy W per natural volume of a body with Green's strain. I1 and I2 are the invariants of J^(-2/3) C, J the \
     change of volume, and U = (kappa/4) (J^2 - 1 - 2 ln J) resists that. Bodies in plane strain, in plane stress, membranes and strings take the \
     same laws; where there is no stress across a cell, its thickness follows from that.",
    &[],
    "material = { density = 1070.0, poisson = 0.49, viscosity = 0.0, law = { kind = \"mooney-rivlin\", c1 = 4.0e4, c2 = 1.0e4 } }",
)
.kinds(&KINDS);
const BULK: Key = Key::number("bulk", "the bulk modulus kappa", "Pa").default("that of `poisson`");

/// The most constants of a law, with the bulk modulus.
const MOST: usize = 4;

/// The keys of each law, with those of the bulk modulus behind them.
static KEYS: [[Key; MOST]; LAWS.len()] = {
    let mut keys = [[BULK; MOST]; LAWS.len()];
    let mut law = 0;
    while law < LAWS.len() {
        let mut number = 0;
        while number < LAWS[law].constants.len() {
            keys[law][number] = key(&LAWS[law].constants[number]);
            number += 1;
        }
        law += 1;
    }
    keys
};

const KINDS: [Kind; LAWS.len()] = {
    let mut kinds = [Kind { word: "", about: "", keys: &[] }; LAWS.len()];
    let mut law = 0;
    while law < LAWS.len() {
        let LawInformation { name, about, constants, .. } = *LAWS[law];
        let count = if constants.is_empty() { 0 } else { constants.len() + 1 };
        kinds[law] = Kind { word: name, about, keys: KEYS[law].split_at(count).0 };
        law += 1;
    }
    kinds
};

const fn key(constant: &LawConstant) -> Key {
    let holds = match constant.is_list {
        true => ValueType::List(&ValueType::Number),
        false => ValueType::Number,
    };
    Key::new(constant.name, holds, constant.meaning).in_unit(constant.unit).required()
}

/// A law as a file has it, with the moduli (Pa) at small strains that follow from its constants.
struct Constants {
    law: Law,
    shear: Option<f64>,
    bulk: Option<f64>,
}

/// Material in the table `value`; keys that are missing are those of `base`, if there is one.
pub(super) fn substance(value: &Value, base: Option<&Substance>) -> Result<Substance, Error> {
    let table = value.table(&MATERIAL)?;
    let is_rigid = table.optional("rigid", Value::flag)?;
    let is_rigid = is_rigid.unwrap_or(base.is_some_and(|base| base.is_rigid));
    let of_body = base.map(|base| base.material.density);
    // a rigid piece takes nothing over from what is not rigid but its density, nor the other way round
    let stiff = is_rigid.then(|| Material::rigid(f64::NAN));
    let base = match base {
        Some(base) if base.is_rigid == is_rigid => Some(base),
        _ => stiff.as_ref(),
    };
    let number = |key: &str, base: Option<f64>| match base {
        Some(base) => Ok(table.optional(key, Value::number)?.unwrap_or(base)),
        None => table.required(key, Value::number),
    };
    let known = base.map(|base| base.material);
    let constants = table.optional("law", law)?;
    let (shear, bulk) = constants.as_ref().map_or((None, None), |law| (law.shear, law.bulk));
    for (key, modulus, by) in
        [("young", shear, "the constants of the law"), ("poisson", bulk, "the `bulk` of the law")]
    {
        if let (Some(value), Some(_)) = (table.get(key), modulus) {
            return Err(value.error(format!("it follows from {by}: leave one of them out")));
        }
    }
    let mass = rigid_mass(&table)?;
    let density = match (&mass, table.get("density")) {
        (Some(_), Some(value)) => {
            return Err(value.error("mass gives it: leave one of the two out"));
        }
        // the body knows its volume
        (Some(_), None) => 1.0,
        (None, None) if is_rigid && of_body.is_none() => {
            return Err(table.missing("density", "expected the density (kg/m^3), or mass"));
        }
        (None, _) => number("density", of_body)?,
    };
    let viscosity = number("viscosity", Some(known.map_or(0.0, |m| m.viscosity)))?;
    let material = match (shear, bulk) {
        (Some(shear), Some(bulk)) => Material::of_moduli(density, shear, bulk, viscosity),
        _ => {
            let poisson = number("poisson", known.map(|m| m.poisson))?;
            let young = match shear {
                Some(shear) => 2.0 * (1.0 + poisson) * shear,
                None => number("young", known.map(|m| m.young))?,
            };
            Material { density, young, poisson, viscosity }
        }
    };
    let law = constants.map(|law| law.law).or(base.and_then(|base| base.law));
    let mass_damping = table.optional("mass_damping", Value::number)?;
    let mass_damping = mass_damping.or(base.map(|base| base.mass_damping)).unwrap_or(0.0);
    let branches = table.optional("branch", |value| {
        let tables = value.tables(&BRANCH)?;
        let read = |table: &Table<'_>| {
            let number = |key| table.required(key, Value::number);
            let yield_stress = table.optional("yield_stress", Value::number)?.unwrap_or(0.0);
            let branch =
                MaxwellBranch { share: number("share")?, time: number("time")?, yield_stress };
            branch.validate().map_err(|error| table.blame(error))?;
            Ok(branch)
        };
        tables.iter().map(read).collect::<Result<Vec<_>, Error>>()
    })?;
    let branches = branches.or(base.map(|base| base.branches.clone())).unwrap_or_default();
    let families = table.optional("fibres", |value| {
        value.tables(&FIBRES)?.iter().map(fibres).collect::<Result<Vec<_>, Error>>()
    })?;
    let fibres = families.or(base.map(|base| base.fibres.clone())).unwrap_or_default();
    let substance = Substance { material, law, mass_damping, branches, fibres, is_rigid, mass };
    substance.validate().map_err(|error| table.blame(error))?;
    Ok(substance)
}

/// Mass and inertia by numbers, if they are given.
fn rigid_mass(table: &Table<'_>) -> Result<Option<RigidMass>, Error> {
    let Some(mass) = table.optional("mass", Value::number)? else {
        let other = ["centre", "inertia"].into_iter().find_map(|key| table.get(key));
        return other.map_or(Ok(None), |value| {
            Err(value.error("it goes with mass, in place of density: give mass, too"))
        });
    };
    let centre = table.optional("centre", Value::numbers)?;
    Ok(Some(RigidMass { mass, centre, moments: table.optional("inertia", moments)? }))
}

fn moments(value: &Value) -> Result<Moments, Error> {
    let help = "one number in the plane; in space three, or 3 rows of 3";
    Ok(match value.list() {
        Err(_) => Moments::Plane(value.number().map_err(|_| value.unexpected(help))?),
        Ok(rows) if rows.iter().all(|row| row.number().is_ok()) => {
            Moments::Principal(value.array()?)
        }
        Ok(rows) => {
            let rows = rows.iter().map(Value::array).collect::<Result<Vec<[f64; 3]>, Error>>()?;
            Moments::Matrix(rows.try_into().map_err(|_| value.unexpected(help))?)
        }
    })
}

fn law(value: &Value) -> Result<Constants, Error> {
    let table = value.table(&LAW)?;
    let row = LAWS.into_iter().find(|row| row.name == table.kind()).unwrap_or(LAWS[0]);
    let read = |constant: &LawConstant| match constant.is_list {
        true => table.required(constant.name, Value::numbers),
        false => Ok(vec![table.required(constant.name, Value::number)?]),
    };
    let constants = row.constants.iter().map(read).collect::<Result<Vec<_>, Error>>()?;
    let made = (row.of_constants)(&constants);
    let (law, shear) = made.map_err(|message| table.error(message))?;
    law.validate().map_err(|error| table.error(error))?;
    let bulk = match shear {
        Some(_) => table.optional("bulk", Value::number)?,
        None => None,
    };
    // so that Poisson's ratio is above -1
    if let Some(bulk) = bulk.filter(|bulk| !(*bulk > 0.0 && bulk.is_finite())) {
        return Err(table.error(format!("bulk = {bulk:e} Pa: it has to be above 0")));
    }
    Ok(Constants { law, shear, bulk })
}

/// Which way fibres run.
pub(super) fn course(table: &Table<'_>) -> Result<FibreDirection, Error> {
    Ok(match table.optional("along", Value::numbers)? {
        Some(direction) => FibreDirection::Along(direction),
        None => FibreDirection::Around {
            centre: table.required("centre", Value::numbers)?,
            axis: table.optional("axis", Value::numbers)?.unwrap_or_default(),
            pitch: table.optional("pitch", Value::number)?.unwrap_or(0.0),
        },
    })
}

fn fibres(table: &Table<'_>) -> Result<Fibres, Error> {
    let course = course(table)?;
    let young = table.required("young", Value::number)?;
    let stiffening = table.optional("stiffening", Value::number)?.unwrap_or(0.0);
    let fibres = Fibres { course, young, stiffening };
    fibres.validate().map_err(|error| table.blame(error))?;
    Ok(fibres)
}
