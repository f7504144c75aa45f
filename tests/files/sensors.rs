//! `[[sensor]]`: every kind as in the API, and mistakes with their lines.

use std::path::Path;

use pliant::simulate::{Component, Reading, Spot};
use pliant::{Error, SceneFile, Selection};

const SCENE: &str = r#"
[body]
mesh = { kind = "rectangle", size = [0.1, 0.1], nodes = [3, 3], cells = "rectangles" }
material = { density = 1000.0, young = 1e5, poisson = 0.4, viscosity = 40.0 }
thickness = 0.01
[[spring]]
name = "tendon"
ends = [1, 9]
[[lag]]
actuators = "tendon"
capacity = 1.0
loss = 1.0
per_kelvin = -1e-3
[[chamber]]
name = "inside"
nodes = [1, 3, 9, 7]
[[obstacle]]
name = "floor"
kind = "half-plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
stiffness = 1e3
[[gas]]
chamber = "inside"
[[orifice]]
name = "leak"
from = "inside"
to = "atmosphere"
conductance = 1e-12
[[chamber]]
name = "bag"
nodes = [1, 2, 5, 4]
[[liquid]]
chamber = "bag"
[[chamber]]
name = "cup"
nodes = [5, 6, 9, 8]
[[liquid]]
chamber = "cup"
fill = 0.5
surface = true
[[pipe]]
name = "tube"
from = "cup"
to = "atmosphere"
length = 0.1
area = 1e-7
[[phase]]
until = 0.01
gravity = [0.0, -1e-6]
hold = [{ nodes = "left" }]
flow = [{ chamber = "bag", rate = 1e-9 }]
"#;

fn parse(sensors: &str) -> Result<SceneFile, Error> {
    SceneFile::parse(&format!("{SCENE}{sensors}"), Path::new("scene.toml"))
}

#[test]
fn every_kind_reads_what_the_api_reads() -> Result<(), Error> {
    let corner = Selection::Box { min: vec![0.0, 0.0], max: vec![0.04, 0.04] };
    let cases = [
        (r#"kind = "position", nodes = "right""#, Reading::position("right")),
        (
            r#"kind = "displacement", nodes = { box = [[0.0, 0.0], [0.04, 0.04]] }, component = "norm""#,
            Reading::displacement(corner).component(Component::Norm),
        ),
        (r#"kind = "velocity", nodes = [2, 3]"#, Reading::velocity([2, 3])),
        (
            r#"kind = "constraint-force", nodes = "left", component = "y""#,
            Reading::constraint_force("left").component(Component::Y),
        ),
        (r#"kind = "contact-force", obstacle = "floor""#, Reading::contact_force("floor")),
        (
            r#"kind = "contact-force", obstacle = "floor", nodes = [1, 2]"#,
            Reading::contact_force_on("floor", [1, 2]),
        ),
        (r#"kind = "contact-area", obstacle = "floor""#, Reading::contact_area("floor")),
        (
            r#"kind = "contact-pressure", obstacle = "floor", nodes = [1, 2]"#,
            Reading::contact_pressure("floor").on([1, 2]),
        ),
        (r#"kind = "spring-pull", spring = "tendon""#, Reading::spring_pull("tendon")),
        (r#"kind = "spring-length", spring = "tendon""#, Reading::spring_length("tendon")),
        (r#"kind = "temperature", actuator = "tendon""#, Reading::temperature("tendon")),
        (r#"kind = "pressure", chamber = "inside""#, Reading::pressure("inside")),
        (r#"kind = "absolute-pressure", chamber = "inside""#, Reading::absolute_pressure("inside")),
        (r#"kind = "gas-amount", chamber = "inside""#, Reading::gas_amount("inside")),
        (r#"kind = "gas-flow", orifice = "leak""#, Reading::gas_flow("leak")),
        (r#"kind = "liquid-volume", chamber = "bag""#, Reading::liquid_volume("bag")),
        (r#"kind = "liquid-flow", chamber = "bag""#, Reading::liquid_flow("bag")),
        (r#"kind = "liquid-level", chamber = "cup""#, Reading::liquid_level("cup")),
        (r#"kind = "pipe-flow", pipe = "tube""#, Reading::pipe_flow("tube")),
        (r#"kind = "volume", chamber = "inside""#, Reading::chamber_volume("inside")),
        (
            r#"kind = "stress", nodes = 5, component = "von-mises""#,
            Reading::stress([5]).component(Component::VonMises),
        ),
        (r#"kind = "stress", point = [0.01, 0.02]"#, Reading::stress_at([0.01, 0.02])),
        (r#"kind = "strain", nodes = "all""#, Reading::strain("all")),
        (r#"kind = "strain", point = [0.01, 0.02]"#, Reading::strain_at([0.01, 0.02])),
        (r#"kind = "distance", from = 1, to = "top""#, Reading::distance([1], "top")),
        (
            r#"kind = "angle", from = [1, 2], to = [1, 3], unit = "deg""#,
            Reading::angle([[1], [2]], [[1], [3]]).in_degrees(),
        ),
        (r#"kind = "rotation", unit = "rad""#, Reading::rotation()),
        (r#"kind = "rotation", unit = "deg""#, Reading::rotation().in_degrees()),
        (r#"kind = "rotation", nodes = "top""#, Reading::rotation().on("top")),
        (r#"kind = "angular-velocity""#, Reading::angular_velocity()),
        (
            r#"kind = "angular-acceleration", nodes = "top""#,
            Reading::angular_acceleration().on("top"),
        ),
        (r#"kind = "accelerometer", nodes = "top""#, Reading::accelerometer().on("top")),
        (r#"kind = "gyroscope""#, Reading::gyroscope()),
        (r#"kind = "acceleration", nodes = [8, 9]"#, Reading::acceleration([8, 9])),
        (
            r#"kind = "velocity", inside = [0.01, 0.02]"#,
            Reading::velocity(Spot::inside([0.01, 0.02])),
        ),
        (
            r#"kind = "position", marker = { nodes = "top", at = [0.1, 0.2] }, component = "y""#,
            Reading::position(Spot::marker("top", [0.1, 0.2])).component(Component::Y),
        ),
        (
            r#"kind = "angle", from = [1, 3], to = ["left", 5]"#,
            Reading::angle([Selection::from([1]), [3].into()], ["left".into(), [5].into()]),
        ),
    ];
    let inline =
        |(k, (keys, _)): (usize, &(&str, Reading))| format!("{{ name = \"s{k}\", {keys} }}");
    let tables: Vec<String> = cases.iter().enumerate().map(inline).collect();
    let file = SceneFile::parse(
        &format!("sensor = [{}]\n{SCENE}", tables.join(", ")),
        Path::new("scene.toml"),
    )?;
    assert_eq!(file.output.sensors.len(), cases.len());
    for (k, ((_, expected), (name, reading))) in cases.iter().zip(&file.output.sensors).enumerate()
    {
        assert_eq!((name, reading), (&format!("s{k}"), expected));
    }
    let motion = file.scene.simulate(&file.settings, &file.output.sampling())?;
    // vectors of two and tensors of four components
    let columns = [
        2, 1, 2, 1, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 4, 4, 4, 1, 1, 1, 1, 1, 1,
        1, 2, 1, 2, 2, 1, 1,
    ];
    assert_eq!(motion.sensors().len(), columns.iter().sum::<usize>());
    assert!(motion.last().sensors.iter().all(|number| number.is_finite()));
    assert!(parse("")?.output.sensors.is_empty());
    Ok(())
}

#[test]
fn mistakes_are_on_their_lines() {
    let first = SCENE.lines().count() + 1;
    for (keys, line, part) in [
        ("kind = \"positon\"\nnodes = 1", 2, "did you mean \"position\"?"),
        ("kind = \"position\"", 0, "sensor.nodes: missing"),
        ("kind = \"position\"\nnodes = \"rigth\"", 3, "did you mean \"right\"?"),
        ("kind = \"position\"\nobstacle = \"floor\"", 3, "has no such key"),
        (
            "kind = \"position\"\nnodes = 1\ncomponent = \"z\"",
            4,
            "the quantity has the components \"x\", \"y\"",
        ),
        ("kind = \"position\"\nnodes = 1\ncomponent = \"nrom\"", 4, "did you mean \"norm\"?"),
        ("kind = \"contact-force\"\nobstacle = \"flor\"", 3, "did you mean \"floor\"?"),
        ("kind = \"spring-pull\"\nspring = \"tendn\"", 3, "did you mean \"tendon\"?"),
        ("kind = \"volume\"\nchamber = \"outside\"", 3, "the chambers \"inside\""),
        ("kind = \"gas-flow\"\norifice = \"leek\"", 3, "did you mean \"leak\"?"),
        ("kind = \"velocity\"\nnodes = 1\ninside = [0.0, 0.0]", 0, "found several of them"),
        ("kind = \"velocity\"\nmarker = { nodes = 1, at = [0.0, 0.0] }", 0, "in one position"),
        ("kind = \"velocity\"\nmarker = { nodes = \"top\" }", 3, "sensor.marker.at: missing"),
        ("kind = \"stress\"", 0, "expected either nodes or point"),
        ("kind = \"stress\"\nnodes = 1\npoint = [0.0, 0.0]", 0, "found both"),
        ("kind = \"stress\"\npoint = [0.0, 0.2]", 3, "outside the body"),
        ("kind = \"stress\"\npoint = [0.0]", 3, "2 numbers"),
        ("kind = \"angle\"\nfrom = [1]\nto = [1, 2]", 3, "2 ends"),
        ("kind = \"angle\"\nfrom = [1, 1]\nto = [1, 2]", 0, "it has no direction"),
    ] {
        let message =
            parse(&format!("[[sensor]]\nname = \"it\"\n{keys}\n")).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
        // the line of the key, or that of the table
        let expected = first + if line == 0 { 0 } else { line };
        assert!(message.starts_with(&format!("scene.toml:{expected}:")), "{expected}: {message}");
    }
    let nameless = parse("[[sensor]]\nkind = \"position\"\nnodes = 1\n").unwrap_err().to_string();
    assert!(nameless.contains("sensor.name: missing"), "{nameless}");
    let one = "[[sensor]]\nname = \"it\"\nkind = \"pressure\"\nchamber = \"inside\"\n";
    let twice = parse(&one.repeat(2)).unwrap_err().to_string();
    assert!(twice.contains("two sensors have it"), "{twice}");
}
