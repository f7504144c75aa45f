//! Plots of sensors and energies: what is on the page, from motions and from what runs have left.

use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use pliant::output::{Plot, Table, write_csv, write_report};
use pliant::simulate::{Component, Reading};
use pliant::study::Verification;
use pliant::{Sampling, Settings, Statics, Trajectory, samples};

type Outcome = Result<(), Box<dyn Error>>;

fn square() -> Result<Trajectory, pliant::Error> {
    let sampling = Sampling::every(0.002)
        .read("top", Reading::position("top"))
        .read("speed", Reading::velocity("top").component(Component::Norm))
        .read("probe", Reading::constraint_force([14, 15]))
        .read("corner stress", Reading::stress([1]).component(Component::VonMises))
        .sensor("never", "m", |_, _| f64::NAN);
    samples::square_jump(4)?.simulate(&Settings::default(), &sampling)
}

/// Texts of a picture, and numbers of its elements of some classes.
fn look(path: &Path, classes: &[&str]) -> Result<(Vec<String>, Vec<usize>), Box<dyn Error>> {
    let text = fs::read_to_string(path)?;
    let document = roxmltree::Document::parse(&text)?;
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    let texts = texts.filter_map(|node| node.text().map(|text| text.trim().to_owned())).collect();
    let count = |class: &&str| {
        document.descendants().filter(|node| node.attribute("class") == Some(*class)).count()
    };
    Ok((texts, classes.iter().map(count).collect()))
}

fn has(texts: &[String], expected: &[&str]) {
    for text in expected {
        assert!(texts.iter().any(|found| found == text), "no {text} in {texts:?}");
    }
}

/// A panel for each unit, each series with its name, the phases and the axes with theirs.
#[test]
fn a_motion_has_a_panel_for_each_unit() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("plot.svg");
    Plot::new().title("A < B").write(&square()?, &path)?;
    let (texts, counts) = look(&path, &["panel", "series"])?;
    // m, m/s, N, Pa, J; three lengths, a speed, two forces, a stress, five energies without gravity and springs
    assert_eq!(counts[0], 5, "{texts:?}");
    has(&texts, &["A < B", "push", "hold", "free", "time (s)", "probe (kN)", "speed (m/s)"]);
    has(&texts, &["top.x", "top.y", "never", "energy (J)", "corner stress (kPa)"]);
    has(&texts, &["kinetic", "strain", "contact", "dissipated", "supplied"]);
    assert!(!texts.iter().any(|text| text == "gravity" || text == "springs"), "{texts:?}");
    Ok(())
}

/// The same picture from the files of a run as from its motion.
#[test]
fn what_a_run_has_left_gives_the_same_picture() -> Outcome {
    let directory = tempfile::tempdir()?;
    let file = |name: &str| directory.path().join(name);
    let square = square()?;
    write_csv(&square, file("trajectory.csv"), None)?;
    write_report(Ok(&square), file("report.json"))?;
    Plot::new().write(&square, file("a.svg"))?;
    Plot::new().write_table(&Table::read(directory.path())?, file("b.svg"))?;
    assert!(fs::read(file("a.svg"))? == fs::read(file("b.svg"))?);

    // killed in the middle of a row, without a report: units of sensors are not known
    let table = fs::read_to_string(file("trajectory.csv"))?;
    fs::write(file("trajectory.csv"), &table[..table.len() - 300])?;
    fs::remove_file(file("report.json"))?;
    Plot::new().write_table(&Table::read(directory.path())?, file("c.svg"))?;
    let (texts, counts) = look(&file("c.svg"), &["panel"])?;
    assert_eq!(counts, [2], "{texts:?}");
    has(&texts, &["top.x", "energy (J)"]);

    // columns by name, some of which nobody draws unasked
    let plot = Plot::new().columns(["com_y", "reaction_bottom_y", "kinetic"]);
    plot.write_table(&Table::read(directory.path())?, file("d.svg"))?;
    let (texts, counts) = look(&file("d.svg"), &["panel"])?;
    assert_eq!(counts, [3]);
    has(&texts, &["com_y (mm)", "reaction_bottom_y (kN)", "kinetic (J)"]);
    Ok(())
}

#[test]
fn what_cannot_be_plotted_is_named() -> Outcome {
    let directory = tempfile::tempdir()?;
    let file = |name: &str| directory.path().join(name);
    let square = square()?;
    let refused = |plot: Plot, name: &str| plot.write(&square, file(name)).unwrap_err().to_string();
    let message = refused(Plot::new().columns(["kinetc"]), "a.svg");
    assert!(message.contains("did you mean \"kinetic\"?"), "{message}");
    let message = refused(Plot::new(), "a.pdf");
    assert!(message.contains("must end in .svg or .png"), "{message}");
    let message = Table::read(directory.path()).unwrap_err().to_string();
    assert!(message.contains("trajectory.csv"), "{message}");
    for (table, part) in [
        ("x,y\n1,2\n", "its first column must be t"),
        ("t,kinetic\n0,1\n1,two\n2,3\n", "line 3 is no row of numbers"),
        ("t,kinetic\n0,1\n1\n2,3\n", "line 3 is no row of numbers"),
        ("", "its first column must be t"),
    ] {
        fs::write(file("trajectory.csv"), table)?;
        let message = Table::read(directory.path()).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
    Ok(())
}

/// One sample, no rows at all, numbers that are none or endless: there is a picture, without NaN in it.
#[test]
fn poor_tables_have_pictures() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("plot.svg");
    let still = samples::clamped_beam([11, 3], 0.0)?.equilibrium(&Statics::default())?;
    Plot::new().write(&still.trajectory().at_end(), &path)?;
    assert!(fs::read_to_string(&path)?.contains("<circle"), "one sample is a dot");
    for rows in [
        "",
        "0,1,2\n",
        "0,NaN,inf\n1,NaN,-inf\n",
        "0,1e308,-1e308\n1,-1e308,5e-324\n",
        "1,0,0\n1,0,0\n",
    ] {
        fs::write(directory.path().join("trajectory.csv"), format!("t,a,kinetic\n{rows}"))?;
        Plot::new().write_table(&Table::read(directory.path())?, &path)?;
        let picture = fs::read_to_string(&path)?;
        assert!(!picture.contains("NaN") && !picture.contains("inf"), "{rows}: {picture}");
        look(&path, &[])?;
    }
    Ok(())
}

/// What sensors differ by in two runs is a band around their lines, and no line of its own.
#[test]
fn verified_motions_have_bands() -> Outcome {
    let scene = samples::square_jump(4)?;
    let sampling = Sampling::every(0.01).read("top", Reading::position("top"));
    let verification = Verification::new(&scene, 0.01).sampling(sampling);
    let motion = verification.finish(|_| ControlFlow::Continue(()))?;
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("plot.svg");
    Plot::new().write(&motion, &path)?;
    let (texts, counts) = look(&path, &["band"])?;
    assert_eq!(counts, [2]);
    assert!(!texts.iter().any(|text| text.contains("difference")), "{texts:?}");
    Ok(())
}

/// A hundred thousand rows make a picture of a few hundred kB.
#[test]
fn long_tables_make_small_pictures() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("plot.svg");
    let row = |k: u32| format!("{:e},{:e}\n", 1e-5 * f64::from(k), (0.3 * f64::from(k)).sin());
    let rows: String = (0..100_000).map(row).collect();
    fs::write(directory.path().join("trajectory.csv"), format!("t,wave\n{rows}"))?;
    Plot::new().write_table(&Table::read(directory.path())?, &path)?;
    let size = fs::metadata(&path)?.len();
    assert!(size < 100_000, "{size} bytes");
    Ok(())
}

#[test]
fn pixels_show_what_the_drawing_says() -> Outcome {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("plot.png");
    Plot::new().write(&square()?, &path)?;
    let picture = fs::read(&path)?;
    assert_eq!(picture[1..4], *b"PNG");
    // width in the header, twice that of the drawing
    assert_eq!(picture[16..20], 1440_u32.to_be_bytes());
    Ok(())
}
