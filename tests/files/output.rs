//! Files written by a run, read back by readers that are not ours.

use std::error::Error;
use std::fs;
use std::path::Path;

use pliant::output::{Chart, GrowingTable, Snapshots, write_csv, write_energies, write_vtk};
use pliant::{
    Body, CellField, Cells, Material, Mesh, NodalContact, NodalField, Obstacle, Phase, Sampling,
    Scene, Settings, Shape, SolidCells, Strain, Trajectory,
};

use crate::vtu::{Array, arrays};

type Outcome = Result<(), Box<dyn Error>>;

/// A square that is pressed and then let go over a floor.
fn square() -> Result<Trajectory, pliant::Error> {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    let press = Phase::until(0.02).named("press <down>");
    Scene::new(Body::new(mesh, rubber).strain(Strain::Cauchy).thickness(0.01).build()?)
        .gravity([0.0, -9.8])
        .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 2.0]).stiffness(100.0))
        .phase(press.hold("bottom").move_nodes([14, 15], [0.0, -0.16]))
        .phase(Phase::until(0.03).named("free"))
        .simulate(&Settings::default(), &Sampling::every(0.01))
}

fn bar() -> Result<Trajectory, pliant::Error> {
    let soft = Material { density: 1000.0, young: 5e4, poisson: 0.0, viscosity: 200.0 };
    Scene::new(Body::new(Mesh::bar(0.1, 6)?, soft).strain(Strain::Cauchy).area(2e-4).build()?)
        .obstacle(Obstacle::half_plane([0.0], [1.0]).stiffness(2000.0))
        .phase(Phase::until(0.01).hold("left").load("right", [-2.0]).without_contact())
        .simulate(&Settings::default(), &Sampling::every(0.005))
}

fn block() -> Result<Trajectory, pliant::Error> {
    let mesh = Mesh::cuboid([0.1, 0.1, 0.1], [2, 2, 2], SolidCells::Hexahedra)?;
    let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
    Scene::new(Body::new(mesh, soft).strain(Strain::Cauchy).build()?)
        .phase(Phase::until(0.01).hold("bottom").move_nodes("top", [0.3, -0.2, 0.1]))
        .simulate(&Settings::default(), &Sampling::phase_ends())
}

type Table = (Vec<String>, Vec<Vec<f64>>);

fn table(path: &Path) -> Result<Table, Box<dyn Error>> {
    let mut reader = csv::Reader::from_path(path)?;
    let names = reader.headers()?.iter().map(str::to_owned).collect();
    let rows = reader.deserialize().collect::<Result<_, _>>()?;
    Ok((names, rows))
}

#[test]
fn a_table_holds_the_samples_to_the_last_bit() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("new/trajectory.csv");
    let square = square()?;
    write_csv(&square, &path, Some(&[14, 2].into()))?;
    let (names, rows) = table(&path)?;
    let expected = "t com_x com_y momentum_x momentum_y angular_momentum kinetic strain gravity \
                    contact springs constraint_drift u14_x u14_y u2_x u2_y dissipated supplied \
                    reaction_bottom_x reaction_bottom_y reaction_14_15_x reaction_14_15_y";
    assert_eq!(names.join(" "), expected);
    assert_eq!(rows.len(), 4);
    for (row, sample) in rows.iter().zip(square.samples()) {
        let energy = &sample.energy;
        let mut values = vec![sample.time];
        values.extend(square.centre_of_mass(sample));
        values.extend(square.momentum(sample));
        values.extend(square.angular_momentum(sample));
        values.extend([energy.kinetic, energy.strain, energy.gravity, energy.contact, 0.0]);
        values.push(sample.constraint_drift);
        values.extend([sample.u[26], sample.u[27], sample.u[2], sample.u[3]]);
        values.extend([energy.dissipated, energy.supplied]);
        values.extend(square.constraint_force(sample, "bottom")?);
        values.extend(square.constraint_force(sample, [14, 15])?);
        assert_eq!(*row, values);
    }
    assert!(rows[2][7] > 0.0 && rows[2][13] < -0.003, "the square was pressed: {:?}", rows[2]);
    assert!(rows[2][21] < -0.1 && rows[3][21] == 0.0, "the probe presses, then lets go");
    // while it is pressed, and while it is free
    let drift: Vec<f64> = square.samples().iter().map(|sample| sample.constraint_drift).collect();
    assert!(drift[1] > 0.0 && drift[1] <= square.report().constraint_drift && drift[3] == 0.0);
    Ok(())
}

/// A killed run has left rows behind its last checkpoint, the last one cut off: the run that goes on from there
/// leaves the very table of a run that was not killed.
#[test]
fn a_table_is_cut_where_a_run_goes_on() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("trajectory.csv");
    let square = square()?;
    write_csv(&square, &path, None)?;
    let whole = fs::read_to_string(&path)?;
    let times: Vec<f64> = square.samples().iter().map(|sample| sample.time).collect();
    for began in [times[0], times[1], 0.5 * (times[1] + times[2]), times[3]] {
        fs::write(&path, format!("{whole}0.0,0.1"))?;
        let table = GrowingTable::new(&square, &path, None)?;
        table.going_on(&square, began)?.catch_up(&square)?;
        assert_eq!(fs::read_to_string(&path)?, whole, "{began}");
    }
    Ok(())
}

#[test]
fn energies_have_a_table_of_their_own() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("energies.csv");
    let square = square()?;
    write_energies(&square, &path)?;
    let (names, rows) = table(&path)?;
    let expected = "t kinetic strain gravity contact springs dissipated supplied balance";
    assert_eq!(names.join(" "), expected);
    for (row, sample) in rows.iter().zip(square.samples()) {
        assert_eq!(row[0], sample.time);
        let balance = row[1..7].iter().sum::<f64>() - row[7];
        assert!((balance - row[8]).abs() < 1e-14, "{row:?}"); // round-off of about 1 J
    }
    assert!(rows[2][7] > 0.0 && rows[2][6] > 0.0, "pressing it costs work: {:?}", rows[2]);
    Ok(())
}

#[test]
fn tables_in_one_and_three_dimensions() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("bar.csv");
    write_csv(&bar()?, &path, None)?;
    let (names, rows) = table(&path)?;
    let expected = "t com_x momentum_x kinetic strain gravity contact springs constraint_drift \
                    dissipated supplied reaction_left_x";
    assert_eq!(names.join(" "), expected);
    assert_eq!(rows.len(), 3);

    write_csv(&block()?, &path, Some(&[8].into()))?;
    let expected = "t com_x com_y com_z momentum_x momentum_y momentum_z angular_momentum_x \
                    angular_momentum_y angular_momentum_z kinetic strain gravity contact springs \
                    constraint_drift u8_x u8_y u8_z dissipated supplied reaction_bottom_x \
                    reaction_bottom_y reaction_bottom_z reaction_top_x reaction_top_y \
                    reaction_top_z";
    let (names, rows) = table(&path)?;
    assert_eq!(names.join(" "), expected);
    assert_eq!(rows[0].len(), names.len());
    Ok(())
}

/// The text of an SVG file, checked to be well-formed, and a count of its elements of a class.
fn picture(path: &Path, class: &str) -> Result<(String, usize), Box<dyn Error>> {
    let text = fs::read_to_string(path)?;
    let document = roxmltree::Document::parse(&text)?;
    let of_class = |node: &roxmltree::Node| node.attribute("class") == Some(class);
    let count = document.descendants().filter(of_class).count();
    Ok((text, count))
}

#[test]
fn snapshots_have_a_panel_per_time_and_all_cells() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("snapshots.svg");
    let times = [0.0, 0.0101, 0.02, 0.03, 0.03];
    Snapshots::at(times).title("A & B").mark([16]).write(&square()?, &path)?;
    let (text, panels) = picture(&path, "panel")?;
    assert_eq!(panels, 5);
    let document = roxmltree::Document::parse(&text)?;
    let cells = document.descendants().filter(|node| node.attribute("class") == Some("cells"));
    for path in cells {
        let data = path.attribute("d").ok_or("a path has data")?;
        assert_eq!(data.matches('z').count(), 18, "one closed line per cell: {data}");
    }
    let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
    for label in [
        "A & B",
        "t = 0 s, press <down>",
        "t = 0.01 s, press <down>",
        "t = 0.03 s, free",
        "held",
        "moved",
    ] {
        assert!(texts.iter().any(|text| text.trim() == label), "{label} in {texts:?}");
    }
    assert_eq!(picture(&path, "obstacle")?.1, 5);
    Ok(())
}

/// Obstacles of all kinds that a plane has are drawn, those in motion where they are at the time.
#[test]
fn snapshots_show_obstacles() -> Outcome {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    let named = |name: &str, shape: Shape| Obstacle::new(shape).named(name).stiffness(1.0);
    let pair = [Shape::disc([0.0, -0.1], 0.05), Shape::capsule([0.1, -0.1], [0.2, -0.1], 0.05)];
    let scene = Scene::new(Body::new(mesh, rubber).strain(Strain::Cauchy).thickness(0.01).build()?)
        .obstacle(named("floor", Shape::half_plane([0.0, -0.2], [0.0, 1.0])))
        .obstacle(named("bowl", Shape::cavity([0.15, 0.15], 0.3)))
        .obstacle(named("step", Shape::box_between([0.4, 0.0], [0.45, 0.1])).velocity([1.0, 0.0]))
        .obstacle(named("pair", Shape::union(pair)))
        .obstacle(Obstacle::custom(|_, _| 1.0).named("own").stiffness(1.0))
        .phase(Phase::until(0.1));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("obstacles.svg");
    Snapshots::at([0.0, 0.1]).write(&trajectory, &path)?;
    let (text, obstacles) = picture(&path, "obstacle")?;
    // five outlines in each of two panels; the function of one's own has none
    assert_eq!(obstacles, 10);
    let document = roxmltree::Document::parse(&text)?;
    let group = |k: usize| {
        let all = document.descendants().filter(|node| node.attribute("class") == Some("obstacle"));
        let paths = all.clone().nth(k)?.children().filter_map(|node| node.attribute("d"));
        Some(paths.collect::<Vec<_>>())
    };
    assert_eq!(group(0), group(5), "the floor stays");
    assert_eq!(group(1).map(|paths| paths.len()), Some(1), "a cavity is not hatched");
    assert_ne!(group(2), group(7), "the step moves");
    Ok(())
}

/// A ball that comes down from above is drawn as a whole in each row, though the body ends far below.
#[test]
fn rows_are_as_high_as_what_moves_in_them() -> Outcome {
    let mesh = Mesh::rectangle([0.3, 0.1], [4, 2], Cells::Triangles)?;
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    let ball = Obstacle::new(Shape::disc([0.15, 0.25], 0.05)).named("ball").stiffness(1.0);
    let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
        .obstacle(ball.velocity([0.3, -1.0]))
        .phase(Phase::until(0.09).hold("bottom"));
    let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.03))?;
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("ball.svg");
    for columns in [1, 2] {
        let times = [0.0, 0.03, 0.06, 0.09];
        Snapshots::at(times).columns(columns).write(&trajectory, &path)?;
        let (text, obstacles) = picture(&path, "obstacle")?;
        assert_eq!(obstacles, times.len());
        let document = roxmltree::Document::parse(&text)?;
        let groups =
            document.descendants().filter(|node| node.attribute("class") == Some("obstacle"));
        for group in groups {
            let outline = group.children().filter_map(|node| node.attribute("d")).next_back();
            // 96 chords, none of them cut away
            let chords = outline.map(|d| d.matches('M').count());
            assert_eq!(chords, Some(96), "{columns} columns: {outline:?}");
        }
    }
    Ok(())
}

#[test]
fn snapshots_of_a_bar() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("bar.svg");
    Snapshots::at([0.0, 0.01]).columns(1).write(&bar()?, &path)?;
    assert_eq!(picture(&path, "panel")?.1, 2);
    assert_eq!(picture(&path, "cells")?.1, 2);
    Ok(())
}

#[test]
fn a_chart_names_its_series() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("chart.svg");
    let line = |slope: f64| (0..50).map(move |k| (0.1 * k as f64, slope * k as f64));
    let chart = Chart::new("Rise < 1").axes("time (s)", "height (m)");
    chart.clone().series("slow", line(1e-3)).series("fast", line(2e-3)).write(&path)?;
    let text = fs::read_to_string(&path)?;
    let document = roxmltree::Document::parse(&text)?;
    let texts: Vec<&str> = document.descendants().filter_map(|n| n.text()).map(str::trim).collect();
    for label in ["Rise < 1", "time (s)", "height (m)", "slow", "fast"] {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
    let points = |n: roxmltree::Node| n.attribute("d").map(|d| d.matches(['M', 'L']).count());
    assert_eq!(document.descendants().filter_map(points).filter(|&count| count == 50).count(), 2);
    let flat = chart.clone().series("flat", [(0.0, 0.0), (1.0, 0.0)]);
    flat.write(directory.path().join("flat.svg"))?;
    let text = fs::read_to_string(directory.path().join("flat.svg"))?;
    let document = roxmltree::Document::parse(&text)?;
    // Mx1 y1Lx2 y2 of the line, above that of the legend: halfway between the top (68 of 440) and the bottom (388)
    let line = document.descendants().filter_map(|n| n.attribute("d")).nth_back(1);
    let line = line.ok_or("a flat line is drawn too")?.replace(['M', 'L'], " ");
    let numbers: Vec<f64> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    assert!((numbers[1] - 228.0).abs() < 0.1 && numbers[3] == numbers[1], "{line}");
    for bad in [chart.clone(), chart.series("bad", [(0.0, f64::NAN)])] {
        let refused = bad.write(&path).unwrap_err();
        assert!(matches!(refused, pliant::Error::Input(_)), "{refused}");
    }
    Ok(())
}

/// Each line of reference has dashes of its own, in the field and in the legend.
#[test]
fn lines_of_reference_differ_in_their_dashes() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("chart.svg");
    let chart = Chart::new("Levels").series("measured", [(0.0, 0.0), (1.0, 1.0)]);
    let chart = chart.reference("wanted", [(0.0, 0.5), (1.0, 0.5)]);
    chart.reference("all unknowns", [(0.5, 0.0), (0.5, 1.0)]).write(&path)?;
    let text = fs::read_to_string(&path)?;
    let document = roxmltree::Document::parse(&text)?;
    let dashes = document.descendants().filter_map(|node| node.attribute("stroke-dasharray"));
    let dashes: Vec<&str> = dashes.filter(|dashes| *dashes != "none").collect();
    let [first, first_name, second, second_name] = *dashes else { return Err(text.into()) };
    assert!(first == first_name && second == second_name && first != second, "{dashes:?}");
    Ok(())
}

/// Along logarithmic axes equal factors are equal distances, and powers of ten are labelled: of many
/// every second.
#[test]
fn a_logarithmic_chart_spaces_decades_equally() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("chart.svg");
    let chart = Chart::new("Powers").axes("x", "y").logarithmic(true, true);
    let powers = |points: &[i32]| points.iter().map(|k| 10_f64.powi(*k)).collect::<Vec<_>>();
    let xs = powers(&[-2, -1, 0, 1]);
    let points = xs.iter().copied().zip(powers(&[6, 3, 0, -3]));
    chart.clone().marked("measured", points).reference("expected", [(1.0, 1.0)]).write(&path)?;
    let text = fs::read_to_string(&path)?;
    let document = roxmltree::Document::parse(&text)?;
    let texts: Vec<&str> = document.descendants().filter_map(|n| n.text()).map(str::trim).collect();
    for label in ["measured", "expected", "10⁻²", "10⁻¹", "1", "10¹", "10⁶", "10⁴"] {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
    let dots = document.descendants().filter(|n| n.has_tag_name("circle"));
    let places: Vec<[f64; 2]> = dots
        .map(|dot| ["cx", "cy"].map(|name| dot.attribute(name).unwrap_or("").parse().unwrap()))
        .collect();
    // the last two are that of the legend, and the one point of what is expected
    for axis in 0..2 {
        let gaps: Vec<f64> = places[..4].windows(2).map(|w| w[1][axis] - w[0][axis]).collect();
        // places are written in hundredths of pixels
        assert!(gaps.iter().all(|gap| (gap - gaps[0]).abs() <= 0.02 && *gap > 60.0), "{gaps:?}");
    }
    let refused = chart.series("bad", [(1.0, 0.0)]).write(&path).unwrap_err();
    assert!(refused.to_string().contains("must be positive"), "{refused}");
    Ok(())
}

#[test]
fn vtk_files_hold_mesh_motion_and_forces() -> Outcome {
    let directory = tempfile::tempdir()?;
    for (name, trajectory, kind) in
        [("square", square()?, 5.0), ("bar", bar()?, 3.0), ("block", block()?, 12.0)]
    {
        write_vtk(&trajectory, directory.path(), name)?;
        let (mut held, mut touched) = (false, false);
        let mesh = trajectory.body().mesh();
        let spatial = |x: &[f64]| -> Vec<f64> {
            let nodes = x.chunks(mesh.dimension());
            nodes.flat_map(|x| [0, 1, 2].map(|i| x.get(i).copied().unwrap_or(0.0))).collect()
        };
        for (number, sample) in trajectory.samples().iter().enumerate() {
            let path = directory.path().join(format!("{name}_{number:04}.vtu"));
            let points = Array::new("Points", 3, spatial(mesh.positions()));
            assert_eq!(arrays(&path, "Points"), [points]);
            let nodes = mesh.cells().flatten().map(|&node| node as f64).collect();
            let corners = mesh.kind().nodes();
            let ends = (1..=mesh.cell_count()).map(|k| (k * corners) as f64).collect();
            let cells = [
                Array::new("connectivity", 1, nodes),
                Array::new("offsets", 1, ends),
                Array::new("types", 1, vec![kind; mesh.cell_count()]),
            ];
            assert_eq!(arrays(&path, "Cells"), cells);
            let contact = trajectory.contact_forces(sample)?;
            let constraint = trajectory.constraint_forces(sample)?;
            touched |= contact.iter().any(|force| *force != 0.0);
            held |= constraint.iter().any(|force| *force != 0.0);
            let six = |t: [[f64; 3]; 3]| [t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[0][2]];
            let nodal = trajectory.body().nodal_fields(&sample.u);
            let stress = nodal.iter().flat_map(|field| six(field.stress)).collect();
            let von_mises = nodal.iter().map(NodalField::von_mises).collect();
            let contacts = trajectory.nodal_contacts(sample)?;
            let pressure = contacts.iter().map(NodalContact::pressure).collect();
            let status = contacts.iter().map(|nodal| nodal.status().number().into()).collect();
            let of_points = [
                Array::new("displacement", 3, spatial(&sample.u)),
                Array::new("velocity", 3, spatial(&sample.v)),
                Array::new("contact_force", 3, spatial(&contact)),
                Array::new("constraint_force", 3, spatial(&constraint)),
                Array::new("stress", 6, stress),
                Array::new("von_mises", 1, von_mises),
                Array::new("contact_pressure", 1, pressure),
                Array::new("contact_status", 1, status),
            ];
            assert_eq!(arrays(&path, "PointData"), of_points);
            let cells = trajectory.body().cell_fields(&sample.u);
            let tensors = |tensor: fn(&CellField) -> [[f64; 3]; 3]| {
                cells.iter().flat_map(|cell| six(tensor(cell))).collect()
            };
            let scalars = |scalar: fn(&CellField) -> f64| cells.iter().map(scalar).collect();
            let pressure = |f: &CellField| -(0..3).map(|i| f.stress[i][i]).sum::<f64>() / 3.0;
            let strain = trajectory.body().strain();
            let stretch = |k| cells.iter().map(|cell| cell.stretches(strain)[k]).collect();
            let of_cells = [
                Array::new("strain", 6, tensors(|cell| cell.strain)),
                Array::new("stress", 6, tensors(|cell| cell.stress)),
                Array::new("von_mises", 1, scalars(CellField::von_mises)),
                Array::new("strain_energy_density", 1, scalars(|cell| cell.energy_density)),
                Array::new("pressure", 1, scalars(pressure)),
                Array::new("largest_stretch", 1, stretch(0)),
                Array::new("least_stretch", 1, stretch(2)),
            ];
            assert_eq!(arrays(&path, "CellData"), of_cells);
        }
        assert!(held && touched == (name == "square"), "{name}");
        let text = fs::read_to_string(directory.path().join(format!("{name}.pvd")))?;
        let collection = roxmltree::Document::parse(&text)?;
        let entries = collection.descendants().filter(|node| node.has_tag_name("DataSet"));
        let mut times = Vec::new();
        for entry in entries {
            times.push(entry.attribute("timestep").ok_or("no time")?.parse::<f64>()?);
            let file = entry.attribute("file").ok_or("no file")?;
            assert!(directory.path().join(file).is_file(), "{file}");
        }
        let samples = trajectory.samples().iter().map(|sample| sample.time);
        assert_eq!(times, samples.collect::<Vec<_>>());
    }
    Ok(())
}

#[test]
fn what_cannot_be_written_is_named_and_leaves_nothing() -> Outcome {
    let directory = tempfile::tempdir()?;
    let occupied = directory.path().join("occupied");
    fs::write(&occupied, "a file where a directory should be")?;
    let trajectory = bar()?;
    let path = occupied.join("trajectory.csv");
    let refused = write_csv(&trajectory, &path, None).unwrap_err();
    assert!(matches!(&refused, pliant::Error::Output { path: named, .. } if *named == path));
    assert!(refused.to_string().contains("occupied/trajectory.csv"), "{refused}");
    // a directory in the place of the file: the content is complete but cannot take its place
    let taken = directory.path().join("taken.csv");
    fs::create_dir(&taken)?;
    assert!(write_csv(&trajectory, &taken, None).is_err());
    assert_eq!(fs::read_dir(directory.path())?.count(), 2, "no file is left behind");

    let refusals = [
        write_csv(&trajectory, directory.path().join("a.csv"), Some(&[7].into())),
        Snapshots::at([]).write(&trajectory, directory.path().join("b.svg")),
        Snapshots::at([f64::NAN]).write(&trajectory, directory.path().join("c.svg")),
        Snapshots::at([0.0]).columns(0).write(&trajectory, directory.path().join("d.svg")),
        Snapshots::at([0.0]).mark("top").write(&trajectory, directory.path().join("e.svg")),
        write_vtk(&trajectory, directory.path(), "../f"),
    ];
    for refused in refusals {
        assert!(matches!(refused, Err(pliant::Error::Input(_))), "{refused:?}");
    }
    assert_eq!(fs::read_dir(directory.path())?.count(), 2, "nothing was written");
    Ok(())
}
