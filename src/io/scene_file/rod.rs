//! `[[rod]]`.

use super::keys::{Key, Kind, TableKeys, ValueType};
use super::material::{MATERIAL, substance};
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::elements::body::{Body, BodyBuilder, Inertia};
use crate::elements::rod::{Rod, RodPath, RodSection, SectionNumbers};

pub(super) const ROD: TableKeys = TableKeys::new(
    "[[rod]]",
    "A slender body as a chain of cross sections, which stay plane and keep their shape: geometrically exact in stretch, shear, bending and twist. It \
     has the node sets `start` and `end` (nodes of its axis), `axis`, `start-section` and `end-section`, and `side-1` and `side-2` (nodes on its surface, \
     at the axes d_1 and d_2 of its sections), with its name before them: `arm/end`. Rods come after the bodies of the file.",
    &[
        Key::new("name", ValueType::Text, "its name").required(),
        Key::new("path", PATH, "its axis, where it is free of stress: a list of points (m), or an arc or a helix")
            .note("Points make a polygon, whose sides share the elements by their lengths; it is a ring if it ends at its first point.")
            .required(),
        Key::new("natural", PATH, "the path along which it is free of stress, without twist")
            .note("On its own path it is then bent by stress, as a ring is that was bent from a straight rod.")
            .default("`path`, with its twist"),
        Key::new("elements", ValueType::Count, "the number of its elements").default("20"),
        Key::new("section", ValueType::Table(&SECTION), "its cross section").required(),
        Key::new("normal", ValueType::Array(&ValueType::Number, 3), "the direction across the path, at its first point, of the axis d_1 of its section")
            .in_unit("1")
            .note("From there on the axes are carried along without twist on a polygon, with the screw on a helix. In the plane d_1 lies in the plane.")
            .default("the axis of space, z before y before x, that is most across the path"),
        Key::number("twist", "the angle by which its sections turn about the path from the start to the end, besides how the path carries them", "rad")
            .default("0"),
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

const PATH: ValueType =
    ValueType::Either(&[ValueType::List(&ValueType::Vector), ValueType::Table(&CURVE)]);

pub(super) const CURVE: TableKeys = TableKeys::new(
    "path",
    "The axis of a rod, as a curve.",
    &[
        Key::new("start", ValueType::Vector, "its first point").in_unit("m").required(),
        Key::new(
            "center",
            ValueType::Vector,
            "a point of the axis about which it turns, in the plane the center",
        )
        .in_unit("m")
        .required(),
        Key::new(
            "axis",
            ValueType::Array(&ValueType::Number, 3),
            "the direction of that axis, in space",
        )
        .in_unit("1")
        .default("[0, 0, 1]"),
    ],
    "[[rod]]\n\
     name = \"arch\"\n\
     path = { kind = \"arc\", start = [0.1, 0.0], center = [0.0, 0.0], angle = 3.0 }\n\
     section = { kind = \"circle\", radius = 0.005 }\n\
     material = { density = 1100.0, young = 5.0e5, poisson = 0.49, viscosity = 500.0 }",
)
.kinds(&[
    Kind {
        word: "arc",
        about: "part of a circle; a ring if it is the whole",
        keys: &[Key::number(
            "angle",
            "the angle by which it turns, right-handed about the axis",
            "rad",
        )
        .required()],
    },
    Kind {
        word: "helix",
        about: "a helix, in space",
        keys: &[
            Key::number("pitch", "the advance along the axis per turn", "m").required(),
            Key::number(
                "turns",
                "the number of its turns; negative for the opposite sense about the axis",
                "1",
            )
            .required(),
        ],
    },
]);

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

/// The rods that `value` describes, in a space of `dimension` (default: that of their paths).
pub(super) fn rods(value: &Value, dimension: Option<&Value>) -> Result<Vec<Body>, Error> {
    let rods = value.tables(&ROD)?.iter().map(rod).collect::<Result<Vec<Body>, _>>()?;
    if let Some(dimension) = dimension
        && let wanted = dimension.count()?
        && let Some(other) = rods.iter().find(|rod| rod.dimension() != wanted)
    {
        let (name, own) = (other.name().unwrap_or_default(), other.dimension());
        return Err(
            dimension.unexpected(format!("{own}, as points of the path of rod \"{name}\" have"))
        );
    }
    Ok(rods)
}

fn rod(table: &Table) -> Result<Body, Error> {
    let name = table.required("name", Value::string)?;
    let path = table.required("path", path_of)?;
    let elements = table.optional("elements", Value::count)?.unwrap_or(USUAL);
    let [section, end] = table.required("section", |value| section(&value.table(&SECTION)?))?;
    let mut rod = Rod::new(path, elements, section);
    if end != section {
        rod = rod.end(end);
    }
    rod = table.added(rod, "normal", Value::array, Rod::normal)?;
    rod = table.added(rod, "twist", Value::number, Rod::twist)?;
    rod = table.added(rod, "natural", path_of, Rod::natural)?;
    let material = table.required("material", |value| substance(value, None))?;
    let body = Body::rod(rod, material).map_err(|error| table.blame(error))?.named(name);
    let body = table.added(body, "inertia", |value| value.word(&INERTIA), BodyBuilder::inertia)?;
    body.build().map_err(|error| table.blame(error))
}

/// A list of points, or a curve.
fn path_of(value: &Value) -> Result<RodPath, Error> {
    if value.entries().is_none() {
        return value.list_of("points", Value::numbers).map(RodPath::from);
    }
    let table = &value.table(&CURVE)?;
    let [start, center] = ["start", "center"].map(|key| table.required(key, Value::numbers));
    let (start, center) = (start?, center?);
    let curve = match table.kind() {
        "arc" => RodPath::arc(start, center, table.required("angle", Value::number)?),
        _ => {
            let three = |key, point: Vec<f64>| {
                let count = point.len();
                let error = |_| {
                    table.error(format!("{key} of a helix needs 3 coordinates; it has {count}"))
                };
                point.try_into().map_err(error)
            };
            let [pitch, turns] = ["pitch", "turns"].map(|key| table.required(key, Value::number));
            RodPath::helix(three("start", start)?, three("center", center)?, pitch?, turns?)
        }
    };
    table.added(curve, "axis", Value::array, RodPath::about)
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
