//! `[[rod]]`.

use super::keys::{Key, Kind, TableKeys, ValueType};
use super::material::{MATERIAL, substance};
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::elements::body::{Body, BodyBuilder, Inertia};
use crate::elements::rod::{Rod, RodSection, SectionNumbers};

pub(super) const ROD: TableKeys = TableKeys::new(
    "[[rod]]",
    "A slender body as a chain of cross sections, which stay plane and keep their shape: geometrically exact in stretch, shear, bending and twist. It \
     has the node sets `start` and `end` (nodes of its axis), `axis`, `start-section` and `end-section`, and `side-1` and `side-2` (nodes on its surface, \
     at the axes d_1 and d_2 of its sections), with its name before them: `arm/end`. Rods come after the bodies of the file.",
    &[
        Key::new("name", ValueType::Text, "its name").required(),
        Key::new("path", ValueType::List(&ValueType::Vector), "the points of its axis, where it is free of stress")
            .in_unit("m")
            .note("A polygon, whose sides share the elements by their lengths; it is a ring if it ends at its first point.")
            .required(),
        Key::new("elements", ValueType::Count, "the number of its elements").default("20"),
        Key::new("section", ValueType::Table(&SECTION), "its cross section").required(),
        Key::new("normal", ValueType::Array(&ValueType::Number, 3), "the direction across the path, at its first point, of the axis d_1 of its section")
            .in_unit("1")
            .note("From there on the axes are carried along without twist. In the plane d_1 lies in the plane.")
            .default("the axis of space, z before y before x, that is most across the path"),
        Key::new("inertia", ValueType::Word(|| INERTIA.map(|(word, _)| word).into()), "how inertia is shared out")
            .default("consistent"),
        Key::new("material", ValueType::Table(&MATERIAL), "the material, with a linear law").required(),
    ],
    "[[rod]]\n\
     name = \"arm\"\n\
     path = [[0.0, 0.2], [0.3, 0.2]] # three coordinates in space\n\
     elements = 20\n\
     section = { kind = \"circle\", radius = 0.006, end_radius = 0.004 }\n\
     material = { density = 1100.0, young = 5.0e5, poisson = 0.49, viscosity = 500.0 }",
);

const INERTIA: [(&str, Inertia); 2] =
    [("consistent", Inertia::Consistent), ("lumped", Inertia::Lumped)];

const PAIR: ValueType = ValueType::Array(&ValueType::Number, 2);

pub(super) const SECTION: TableKeys = TableKeys::new(
    "section",
    "The cross section of a rod. Keys that begin with `end_` are those at its end, to which it tapers.",
    &[],
    "[[rod]]\n\
     name = \"blade\"\n\
     path = [[0.0, 0.2], [0.3, 0.2]]\n\
     section = { kind = \"rectangle\", size = [0.002, 0.02] }\n\
     material = { density = 7800.0, young = 2.0e11, poisson = 0.3, viscosity = 0.0 }",
)
.kinds(&[
    Kind {
        word: "circle",
        about: "a circle",
        keys: &[
            Key::number("radius", "the radius", "m").required(),
            Key::number("end_radius", "the radius at the end", "m").default("`radius`"),
        ],
    },
    Kind {
        word: "ring",
        about: "a tube",
        keys: &[
            Key::number("radius", "the outer radius", "m").required(),
            Key::number("inner", "the inner radius", "m").required(),
            Key::number("end_radius", "the outer radius at the end", "m").default("`radius`"),
            Key::number("end_inner", "the inner radius at the end", "m").default("`inner`"),
        ],
    },
    Kind {
        word: "ellipse",
        about: "an ellipse",
        keys: &[
            Key::new("radii", PAIR, "the half axes along d_1 and d_2").in_unit("m").required(),
            Key::new("end_radii", PAIR, "those at the end").in_unit("m").default("`radii`"),
        ],
    },
    Kind {
        word: "rectangle",
        about: "a rectangle",
        keys: &[
            Key::new("size", PAIR, "the sides along d_1 and d_2").in_unit("m").required(),
            Key::new("end_size", PAIR, "those at the end").in_unit("m").default("`size`"),
        ],
    },
    Kind {
        word: "numbers",
        about: "any section, by its area and moments, with its centroid and centre of shear on the axis",
        keys: &[
            Key::number("area", "the area", "m^2").required(),
            Key::new("bending", PAIR, "the second moments of the area about d_1 and d_2").in_unit("m^4").required(),
            Key::number("torsion", "Saint-Venant's constant of torsion", "m^4").required(),
            Key::new("shear", PAIR, "the shear areas along d_1 and d_2").in_unit("m^2").default("5/6 of the area"),
            Key::new("reach", PAIR, "the reach along d_1 and d_2").in_unit("m").default("the radius of a circle of that area"),
        ],
    },
]);

/// The number of elements where none is given.
const USUAL: usize = 20;

/// The rods that `value` describes.
pub(super) fn rods(value: &Value) -> Result<Vec<Body>, Error> {
    value.tables(&ROD)?.iter().map(rod).collect()
}

fn rod(table: &Table) -> Result<Body, Error> {
    let name = table.required("name", Value::string)?;
    let points = table.required("path", |value| value.list_of("points", Value::numbers))?;
    let elements = table.optional("elements", Value::count)?.unwrap_or(USUAL);
    let [section, end] = table.required("section", |value| section(&value.table(&SECTION)?))?;
    let mut rod = Rod::new(points, elements, section);
    if end != section {
        rod = rod.end(end);
    }
    rod = table.added(rod, "normal", Value::array, Rod::normal)?;
    let material = table.required("material", |value| substance(value, None))?;
    let body = Body::rod(rod, material).map_err(|error| table.blame(error))?.named(name);
    let body = table.added(body, "inertia", |value| value.word(&INERTIA), BodyBuilder::inertia)?;
    body.build().map_err(|error| table.blame(error))
}

/// The sections at the start and at the end.
fn section(table: &Table) -> Result<[RodSection; 2], Error> {
    let number = |key: &str, base| or_base(table, key, base, Value::number);
    let pair = |key: &str, base| or_base(table, key, base, Value::array);
    Ok(match table.kind() {
        "circle" => {
            let radius = number("radius", None)?;
            let end = number("end_radius", Some(radius))?;
            [radius, end].map(|radius| RodSection::Circle { radius })
        }
        "ring" => {
            let [radius, inner] = [number("radius", None)?, number("inner", None)?];
            let ends = [number("end_radius", Some(radius))?, number("end_inner", Some(inner))?];
            [[radius, inner], ends].map(|[radius, inner]| RodSection::Ring { radius, inner })
        }
        "ellipse" => {
            let radii = pair("radii", None)?;
            [radii, pair("end_radii", Some(radii))?].map(|radii| RodSection::Ellipse { radii })
        }
        "rectangle" => {
            let size = pair("size", None)?;
            [size, pair("end_size", Some(size))?].map(|size| RodSection::Rectangle { size })
        }
        _ => {
            let area = number("area", None)?;
            let radius = (area / std::f64::consts::PI).sqrt();
            let numbers = SectionNumbers {
                area,
                shear: pair("shear", Some([5.0 / 6.0 * area; 2]))?,
                bending: pair("bending", None)?,
                torsion: number("torsion", None)?,
                reach: pair("reach", Some([radius; 2]))?,
            };
            [RodSection::Numbers(numbers); 2]
        }
    })
}

/// The value of `key` as `read` reads it, or else the `base`; it is required without one.
fn or_base<'a, T>(
    table: &Table<'a>,
    key: &str,
    base: Option<T>,
    read: impl FnOnce(&Value<'a>) -> Result<T, Error>,
) -> Result<T, Error> {
    match base {
        Some(base) => Ok(table.optional(key, read)?.unwrap_or(base)),
        None => table.required(key, read),
    }
}
