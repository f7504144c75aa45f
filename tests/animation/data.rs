//! The data of a page, against the trajectory.

use std::error::Error;
use std::fs;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use pliant::samples::{beam_jump, square_jump};
use pliant::{
    Body, CellField, Cells, Mesh, NodalContact, Obstacle, Phase, Sample, Sampling, Scene, Settings,
    Spring, Strain, Touch,
};
use serde_json::Value;

use super::Outcome;
use super::page::*;

/// The data that a page holds of its motion.
pub fn data(page: &Page) -> Result<Value, Box<dyn Error>> {
    let text = fs::read_to_string(&page.path)?;
    let (_, data) = text.split_once("id=\"data\">").ok_or("no data")?;
    let data: Value = serde_json::from_str(data.split_once("</script>").ok_or("no end")?.0)?;
    Ok(data["motions"][0].clone())
}

pub fn decoded(base64: &Value) -> Result<Vec<u8>, Box<dyn Error>> {
    Ok(STANDARD.decode(base64.as_str().ok_or("no text")?)?)
}

/// A spring to a point of space ends at a place after those of the nodes, which stays where the point is, in the view.
#[test]
fn an_anchored_spring_ends_at_its_point() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    let body = Body::new(mesh, pliant::samples::SQUARE_MATERIAL).thickness(0.01).build()?;
    let scene = Scene::new(body)
        .spring(Spring::anchored([9], [0.3, 0.2]).stiffness(20.0))
        .spring(Spring::between([1], [9]).stiffness(1.0))
        .phase(Phase::until(0.02).hold("left").actuate(["spring 1"], -0.5));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
    let data = data(&page(&trajectory, "")?)?;
    assert_eq!(data["body"]["nodes"], 9);
    assert_eq!(data["springs"][0]["ends"][1], 9);
    assert!(data["springs"][1]["ends"][1].as_u64() < Some(9));
    let ranges: [[f64; 2]; 2] = serde_json::from_value(data["motion"]["ranges"].clone())?;
    let numbers = decoded(&data["motion"]["numbers"])?;
    let numbers = numbers.as_chunks::<2>().0.iter().map(|&bytes| u16::from_le_bytes(bytes));
    let numbers: Vec<u16> = numbers.collect();
    assert_eq!(numbers.len(), 3 * 10 * 2);
    for frame in numbers.chunks(20) {
        for (axis, expected) in [0.3, 0.2].into_iter().enumerate() {
            let step = (ranges[axis][1] - ranges[axis][0]) / 65535.0;
            let found = ranges[axis][0] + step * f64::from(frame[18 + axis]);
            assert!((found - expected).abs() <= 0.5001 * step, "{found} {expected}");
        }
    }
    let [low, high]: [[f64; 2]; 2] = serde_json::from_value(data["view"].clone())?;
    assert!((0..2).all(|i| low[i] < [0.3, 0.2][i] && [0.3, 0.2][i] < high[i]), "{low:?} {high:?}");
    Ok(())
}

/// Positions are those of the samples to half a step of 1/65535 of their range, values of cells to
/// half a step of 1/255 of their scale, below which are 99 of 100 of them.
#[test]
fn the_data_are_those_of_the_samples() -> Outcome {
    let trajectory = square()?;
    let data = data(&page(&trajectory, "")?)?;
    let (body, samples) = (trajectory.body(), trajectory.samples());
    let ranges: [[f64; 2]; 2] = serde_json::from_value(data["motion"]["ranges"].clone())?;
    let numbers = decoded(&data["motion"]["numbers"])?;
    let numbers = numbers.as_chunks::<2>().0.iter().map(|&bytes| u16::from_le_bytes(bytes));
    let natural = body.mesh().positions();
    let exact = samples.iter().flat_map(|s| natural.iter().zip(&s.u).map(|(x, u)| x + u));
    let exact: Vec<f64> = exact.collect();
    // every node is in some cell or at the end of the spring, in the order in which cells name them
    let faces: Vec<Vec<usize>> = serde_json::from_value(data["body"]["faces"].clone())?;
    let mut node_of = [16; 17];
    for (face, cell) in faces.iter().zip(body.mesh().cells()) {
        face.iter().zip(cell).for_each(|(&place, &node)| node_of[place] = node);
    }
    let numbers: Vec<u16> = numbers.collect();
    assert_eq!(numbers.len(), exact.len());
    for (k, &number) in numbers.iter().enumerate() {
        let (sample, place, axis) = (k / 34, k % 34 / 2, k % 2);
        let step = (ranges[axis][1] - ranges[axis][0]) / 65535.0;
        let found = ranges[axis][0] + step * f64::from(number);
        let expected = exact[34 * sample + 2 * node_of[place] + axis];
        assert!((found - expected).abs() <= 0.5001 * step, "{found} is not {expected}");
    }

    let values = |sample: &Sample| body.cell_fields(&sample.u);
    let fields: Vec<_> = samples.iter().flat_map(values).collect();
    let strain = body.strain();
    let quantities: [fn(&CellField, Strain) -> f64; 5] = [
        |f, _| f.von_mises(),
        |f, _| f.energy_density,
        |f, _| -(f.stress[0][0] + f.stress[1][1] + f.stress[2][2]) / 3.0,
        |f, strain| (f.stretches(strain)[0] - 1.0).max(0.0),
        |f, strain| (1.0 - f.stretches(strain)[2]).max(0.0),
    ];
    let told = data["quantities"].as_array().ok_or("no list")?;
    // Cauchy's strain knows nothing of stretches
    let shown = if strain == Strain::Cauchy { 3 } else { 5 };
    assert_eq!(told.len(), shown + 2);
    for (quantity, value) in told[..shown].iter().zip(quantities) {
        let value = |field: &CellField| value(field, strain);
        let signed = quantity["name"] == "Pressure";
        assert_eq!(quantity["signed"], signed);
        let scale = quantity["scale"].as_f64().ok_or("no scale")?;
        let bytes = decoded(&quantity["values"])?;
        assert_eq!(bytes.len(), fields.len());
        let above = fields.iter().filter(|field| value(field).abs() > scale).count();
        assert!(100 * above <= fields.len(), "{above} of {} beyond {scale}", fields.len());
        for (&byte, field) in bytes.iter().zip(&fields) {
            let part = (value(field) / scale).clamp(-1.0, 1.0);
            let expected = if signed { 0.5 + 0.5 * part } else { part };
            let found = f64::from(byte) / 255.0;
            assert!((found - expected).abs() < 0.501 / 255.0, "{found} is not {expected}");
        }
        // in single precision
        let peak = fields.iter().map(|field| value(field).abs()).fold(0.0, f64::max);
        let told = quantity["peak"].as_f64().ok_or("no peak")?;
        assert!((told / peak - 1.0).abs() < 1e-6, "{told} is not {peak}");
    }
    Ok(())
}

/// A face that is not in touch has no contact pressure, and others have the largest of their nodes; so has what
/// sticks.
#[test]
fn colours_of_contact_are_those_of_the_nodes() -> Outcome {
    type Number = fn(&NodalContact) -> f64;
    let trajectory = square()?;
    let data = data(&page(&trajectory, "")?)?;
    let told = data["quantities"].as_array().ok_or("no list")?;
    let of_contact: [(&str, Number); 2] = [
        ("Contact pressure", NodalContact::pressure),
        ("Contact, 1 sticks, 2 slides", |nodal| nodal.status().number().into()),
    ];
    for (name, value) in of_contact {
        let quantity = told.iter().find(|quantity| quantity["name"] == name).ok_or(name)?;
        let (scale, bytes) =
            (quantity["scale"].as_f64().ok_or(name)?, decoded(&quantity["values"])?);
        let mut bytes = bytes.into_iter();
        let mut touched = 0;
        for sample in trajectory.samples() {
            let nodal = trajectory.nodal_contacts(sample)?;
            for cell in trajectory.body().mesh().cells() {
                let largest = cell.iter().map(|&node| value(&nodal[node])).fold(0.0, f64::max);
                let found = f64::from(bytes.next().ok_or("too few")?) / 255.0;
                let expected = (largest / scale).min(1.0);
                assert!((found - expected).abs() < 0.501 / 255.0, "{name}: {found} {expected}");
                touched += usize::from(largest > 0.0);
            }
        }
        assert!(touched > 10 && bytes.next().is_none(), "{name}: {touched} faces in touch");
    }
    Ok(())
}

/// The resultants of the obstacles add up to the contact forces of the samples, and act at nodes that they push.
#[test]
fn arrows_are_the_forces_of_obstacles() -> Outcome {
    let trajectory = square()?;
    let data = data(&page(&trajectory, "")?)?;
    let contacts = data["contacts"].as_array().ok_or("no list")?;
    let singles = |value: &Value| -> Result<Vec<f64>, Box<dyn Error>> {
        let bytes = decoded(value)?;
        Ok(bytes.as_chunks::<4>().0.iter().map(|&b| f64::from(f32::from_le_bytes(b))).collect())
    };
    let mut largest = 0.0_f64;
    for (k, sample) in trajectory.samples().iter().enumerate() {
        let forces = trajectory.contact_forces(sample)?;
        let mut sum = [0.0; 2];
        for contact in contacts {
            let (force, at) = (singles(&contact["forces"])?, singles(&contact["at"])?);
            sum = [0, 1].map(|axis| sum[axis] + force[2 * k + axis]);
            // floor and walls push at the outside of the square, which is 0.3 m wide
            assert!(at[2 * k].abs() < 1.0 && at[2 * k + 1].abs() < 1.0);
        }
        for (axis, found) in sum.into_iter().enumerate() {
            let expected: f64 = forces.iter().skip(axis).step_by(2).sum();
            // 24 bits
            assert!((found - expected).abs() <= 1e-6 * expected.abs() + 1e-9, "{found} {expected}");
            largest = largest.max(expected.abs());
        }
    }
    assert!(largest > 1.0, "{largest} N");
    Ok(())
}

/// What commands have changed is drawn as it was: a plate that stops, nodes that are held later, a spring that
/// pulls.
#[test]
fn a_driven_motion_is_drawn_as_it_was() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01).build()?;
    let plate = Obstacle::half_plane([0.0, -0.02], [0.0, 1.0]).stiffness(1e3).named("plate");
    let mut square = Scene::new(body)
        .spring(Spring::between([1], [9]).named("tendon"))
        .obstacle(plate.velocity([0.0, 0.1]))
        .phase(Phase::until(0.4).named("free"))
        .start(&Settings::default())?;
    square.record(&Sampling::every(0.05))?;
    square.advance_to(0.1)?;
    square.move_obstacle("plate", [0.0, 0.0])?;
    square.actuate("tendon", -0.5)?;
    square.advance_to(0.2)?;
    square.actuate("tendon", 0.0)?;
    square.hold("left")?;
    square.advance_to(0.4)?;
    let data = data(&page(&square.into_trajectory(), "")?)?;

    let courses = data["obstacles"][0]["courses"].as_array().ok_or("no courses")?;
    let number = |value: &Value| value.as_f64().ok_or("no number");
    for (time, height) in [(0.0, -0.02), (0.05, -0.015), (0.1, -0.01), (0.3, -0.01), (0.4, -0.01)] {
        let since = |course: &&Value| course["since"].as_f64().is_some_and(|since| since <= time);
        let course = courses.iter().rfind(since).ok_or("no course")?;
        let found = number(&course["start"][1])? + time * number(&course["velocity"][1])? - 0.02;
        assert!((found - height).abs() < 1e-12, "{found} m at {time} s");
    }
    let phases = data["phases"].as_array().ok_or("no phases")?;
    let held = phases.iter().map(|phase| phase["held"].as_array().map_or(0, Vec::len));
    assert_eq!(held.collect::<Vec<_>>(), [0, 3]);
    let forces = decoded(&data["springs"][0]["forces"])?;
    let forces = forces.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
    // the sample at the time of a command is taken before it
    assert_eq!(forces.collect::<Vec<_>>(), [0.0, 0.0, 0.0, -0.5, -0.5, 0.0, 0.0, 0.0, 0.0]);
    Ok(())
}

/// The cubics of an obstacle's path, by the points and velocities that the page is given: with velocity 0 at all
/// three points each half is s^2 (3 - 2 s) of the way.
#[test]
fn an_obstacle_on_a_path_is_drawn_on_it() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?;
    let body = Body::new(mesh, RUBBER).thickness(0.01).build()?;
    let disc = Obstacle::disc([0.3, 0.0], 0.01).stiffness(1e3);
    let disc = disc.path([0.1, 0.2, 0.3], [[0.0, 0.0], [0.0, 0.5], [0.0, 0.0]]);
    let scene = Scene::new(body).obstacle(disc).phase(Phase::until(0.4));
    let motion = scene.simulate(&Settings::default(), &Sampling::every(0.1))?;
    let data = data(&page(&motion, "")?)?;
    let course = &data["obstacles"][0]["courses"][0];
    assert_eq!(course["start"], serde_json::json!([0.0, 0.0]));
    let path = &course["path"];
    assert_eq!(path["times"], serde_json::json!([0.1, 0.2, 0.3]));
    assert_eq!(path["displacements"], serde_json::json!([[0.0, 0.0], [0.0, 0.5], [0.0, 0.0]]));
    for velocity in path["velocities"].as_array().ok_or("no velocities")? {
        let velocity = velocity[1].as_f64().ok_or("no number")?;
        assert!(velocity.abs() < 1e-12, "{velocity}");
    }
    Ok(())
}

/// Resultants and centres of pressure of the floor: the sum of the nodal forces, and where their moment about the origin
/// puts them, for on a level floor without friction all point upward.
#[test]
fn arrows_start_at_the_centre_of_pressure() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Triangles)?;
    let body = Body::new(mesh, RUBBER).strain(Strain::Green).thickness(0.01).build()?;
    let floor = |name: &str, height: f64| {
        Obstacle::half_plane([0.0, height], [0.0, 1.0]).stiffness(200.0).damping(1.0).named(name)
    };
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .initial_velocity(|_| vec![0.3, 0.0])
        .obstacle(floor("far", -1.0))
        .obstacle(floor("floor", -0.002))
        .phase(Phase::until(0.1));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
    let data = data(&page(&trajectory, "")?)?;
    let contacts = data["contacts"].as_array().ok_or("no list")?;
    assert_eq!(contacts.len(), 1, "what touches alone");
    let numbers = |key: &str| -> Result<Vec<f64>, Box<dyn Error>> {
        let bytes = decoded(&contacts[0][key])?;
        Ok(bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b).into()).collect())
    };
    let (at, forces) = (numbers("at")?, numbers("forces")?);
    let natural = trajectory.body().mesh().positions();
    let mut touching = 0;
    for (k, sample) in trajectory.samples().iter().enumerate() {
        let nodal = trajectory.contact_forces(sample)?;
        let [fx, fy] = [0, 1].map(|axis| nodal.iter().skip(axis).step_by(2).sum::<f64>());
        let near =
            |found: f64, expected: f64| (found - expected).abs() < 1e-6 * (1.0 + expected.abs());
        assert!(near(forces[2 * k], fx) && near(forces[2 * k + 1], fy), "at {} s", sample.time);
        if fy > 0.0 {
            touching += 1;
            let moment: f64 = (0..15)
                .map(|node| (natural[2 * node] + sample.u[2 * node]) * nodal[2 * node + 1])
                .sum();
            assert!(near(at[2 * k], moment / fy), "{} is not {}", at[2 * k], moment / fy);
        }
    }
    assert!(touching > 3, "{touching} samples");
    Ok(())
}

/// What a body exerts on itself cancels, up to round-off that is no arrow.
#[test]
fn what_touches_itself_has_no_arrow() -> Outcome {
    let piece =
        |x: f64| Mesh::rectangle([0.02, 0.02], [3, 3], Cells::Triangles)?.translated(&[x, 0.0]);
    let pieces = [piece(0.0)?, piece(0.021)?];
    let positions = pieces.iter().flat_map(|piece| piece.positions().iter().copied()).collect();
    let cells =
        [0, 9].into_iter().flat_map(|k| pieces[0].cells().flatten().map(move |node| node + k));
    let mesh = Mesh::new(2, positions, pieces[0].kind(), cells.collect())?;
    let scene = Scene::new(Body::new(mesh, RUBBER).thickness(0.01).build()?)
        .touch(Touch::all().distance(2e-4))
        .initial_velocity(|x| vec![if x[0] < 0.0205 { 0.5 } else { -0.5 }, 0.0])
        .phase(Phase::until(4e-3));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::every(2e-4))?;
    let mut most = 0.0_f64;
    for sample in trajectory.samples() {
        most = trajectory.contact_forces(sample)?.into_iter().fold(most, f64::max);
    }
    assert!(most > 0.01, "{most} N");
    let data = data(&page(&trajectory, "")?)?;
    assert_eq!(data["contacts"].as_array().ok_or("no list")?.len(), 0);
    Ok(())
}

/// Forces of contacts take room, too: with those of two hundred floors, 3.2 kB a frame, fewer frames are kept.
#[test]
fn contacts_are_counted() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Rectangles)?;
    let body = Body::new(mesh, pliant::samples::SQUARE_MATERIAL).thickness(0.01).build()?;
    let floor =
        |k| Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(1.0).named(format!("{k}"));
    let scene = Scene::new(body).gravity([0.0, -9.8]).phase(Phase::until(0.01));
    let scene = (0..200).fold(scene, |scene, k| scene.obstacle(floor(k)));
    let long = scene.simulate(&Settings::default(), &Sampling::every(1.25e-5))?;
    let page = page(&long, "")?;
    let frames = data(&page)?["times"].as_array().map_or(0, Vec::len);
    // 1.4 MB of numbers at most
    assert!((420..440).contains(&frames), "{frames}");
    assert!(fs::metadata(&page.path)?.len() < 2_100_000);
    Ok(())
}

/// An obstacle that follows a formula is drawn along cubics as near to it as a thousandth of the body.
#[test]
fn paths_by_formulas_are_drawn() -> Outcome {
    let scene = r#"
        [body]
        mesh = { kind = "rectangle", size = [0.1, 0.1], nodes = [2, 2], cells = "rectangles" }
        thickness = 0.01
        material = { density = 1e3, young = 1e5, poisson = 0.3, viscosity = 100.0 }
        [[obstacle]]
        kind = "disc"
        centre = [0.0, -0.5]
        radius = 0.1
        stiffness = 1.0
        path = { displacement = ["0.02*t", "0.1*sin(20*t)"] }
        [[phase]]
        until = 1.0
    "#;
    let scene = pliant::SceneFile::parse(scene, std::path::Path::new("drawn.toml"))?.scene;
    let data = data(&page(&scene.simulate(&Settings::default(), &Sampling::every(0.1))?, "")?)?;
    let courses = data["obstacles"][0]["courses"].as_array().ok_or("no courses")?;
    assert_eq!(courses.len(), 1);
    let path = &courses[0]["path"];
    let times: Vec<f64> = serde_json::from_value(path["times"].clone())?;
    let vectors = |key: &str| serde_json::from_value::<Vec<[f64; 2]>>(path[key].clone());
    let (x, v) = (vectors("displacements")?, vectors("velocities")?);
    assert_eq!((times[0], times[times.len() - 1]), (0.0, 1.0));
    for (k, pair) in times.windows(2).enumerate() {
        let span = pair[1] - pair[0];
        let middle = 0.5 * (x[k][1] + x[k + 1][1]) + 0.125 * span * (v[k][1] - v[k + 1][1]);
        let exact = 0.1 * (20.0 * (pair[0] + 0.5 * span)).sin();
        assert!((middle - exact).abs() < 1.5e-4, "{middle} {exact}");
        assert!((x[k][0] - 0.02 * pair[0]).abs() < 1e-15 && v[k][0] == 0.02);
    }
    Ok(())
}

/// Long runs are thinned evenly, to their first and last sample.
#[test]
fn files_stay_small() -> Outcome {
    let scene = square_jump(10)?;
    let jump = page(&scene.simulate(&Settings::default(), &Sampling::every(0.005))?, "")?;
    let size = fs::metadata(&jump.path)?.len();
    assert!(size < 650_000, "{size} bytes for 301 samples of 100 nodes");
    assert_eq!(data(&jump)?["times"].as_array().map(Vec::len), Some(301));

    let long = beam_jump()?.simulate(&Settings::default(), &Sampling::every(5e-4))?;
    let times: Vec<f64> = serde_json::from_value(data(&page(&long, "")?)?["times"].take())?;
    assert_eq!((times.len(), times[0], times[799]), (800, 0.0, 0.6));
    let widest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    // each or every second of 1201 samples
    assert!(widest < 2.01 * 5e-4, "{widest} s");
    Ok(())
}
