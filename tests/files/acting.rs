//! Gravity, the magnetic field and the remanence of magnets in snapshots.

use std::error::Error;
use std::fs;

use pliant::output::Snapshots;
use pliant::{
    Body, Cells, Magnet, MagneticField, Material, Mesh, Phase, Sampling, Scene, Settings,
};
use roxmltree::{Document, Node};

type Outcome = Result<(), Box<dyn Error>>;

/// From the ends of arrows in the data of a path: each starts with its line, and then its head starts with the tip (px, to the right and upward).
fn arrows(path: &Node) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let data = path.attribute("d").ok_or("no data")?;
    let mut points = Vec::new();
    for start in data.split('M').skip(1) {
        let start = start.split('l').next().ok_or("no start")?;
        let numbers = start.replace('-', " -");
        let numbers =
            numbers.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        points.push(<[f64; 2]>::try_from(numbers).map_err(|numbers| format!("{numbers:?}"))?);
    }
    Ok(points
        .as_chunks::<2>()
        .0
        .iter()
        .map(|[from, to]| [to[0] - from[0], from[1] - to[1]])
        .collect())
}

/// A magnet starts turned by a right angle in a field that grows from nothing: its arrows are turned, that of gravity is the longest there may be, and that
/// of the field is not there, half as long, and as long.
#[test]
fn snapshots_show_what_acts() -> Outcome {
    let mesh = Mesh::rectangle([0.03, 0.02], [7, 5], Cells::Rectangles)?;
    let soft = Material { density: 1000.0, young: 1e4, poisson: 0.3, viscosity: 1.0 };
    let scene = Scene::new(Body::new(mesh, soft).thickness(0.01).build()?)
        .magnet(Magnet::new([0.1, 0.05]))
        .gravity([-6.0, -8.0])
        .initial_displacement(|x| vec![-x[1] - x[0], x[0] - x[1]])
        .phase(Phase::until(2e-6).magnetic_field(MagneticField::with(|t| [0.0, 3e3 * t])));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::every(1e-6))?;
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("snapshots.svg");
    Snapshots::at([0.0, 1e-6, 2e-6]).write(&trajectory, &path)?;
    let text = fs::read_to_string(&path)?;
    let document = Document::parse(&text)?;
    let of_class = |node: &Node, class: &str| -> Result<Vec<Vec<[f64; 2]>>, Box<dyn Error>> {
        let within = |path: &Node| {
            let group = path.parent().and_then(|group| group.attribute("class"));
            path.has_tag_name("path") && group == Some(class)
        };
        node.descendants().filter(within).map(|path| arrows(&path)).collect()
    };
    let panels = document.descendants().filter(|node| node.attribute("class") == Some("panel"));
    let panels: Vec<Node> = panels.collect();
    assert_eq!(panels.len(), 3);
    // ends are written to hundredths of a pixel
    let is = |found: [f64; 2], expected: [f64; 2]| {
        assert!(
            (found[0] - expected[0]).hypot(found[1] - expected[1]) < 0.02,
            "{found:?} {expected:?}"
        );
    };
    for (panel, part) in panels.iter().zip([0.0, 0.5, 1.0]) {
        let gravity = of_class(panel, "g")?;
        assert_eq!(gravity.len(), 1);
        is(gravity[0][0], [-0.6 * 18.0, -0.8 * 18.0]);
        let field = of_class(panel, "B")?;
        assert_eq!(field.len(), usize::from(part > 0.0));
        field.iter().for_each(|arrow| is(arrow[0], [0.0, part * 18.0]));
        let remanence = of_class(panel, "remanence")?;
        assert_eq!(remanence[0].len(), 12);
        for [dx, dy] in &remanence[0] {
            // turned, of [2, 1] it is [-1, 2]
            assert!(dx.hypot(*dy) > 5.0 && (2.0 * dx + dy).abs() < 0.05 && dy > dx, "{dx} {dy}");
        }
    }
    let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
    for label in ["gravity", "magnetic field", "remanence", "g", "B"] {
        assert!(texts.iter().any(|text| text.trim() == label), "{label} in {texts:?}");
    }
    Ok(())
}
