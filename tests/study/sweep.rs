//! Sweeps in programs: points, ids, rows, two processes at the same study.

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use pliant::Error;
use pliant::scene_file::StudyFile;
use pliant::sweep::{PointRun, Results, Row, RowVerdict, Runner, Store, Sweep, Watch};
use tempfile::TempDir;

const SCENE: &str = r#"
[body]
mesh = { kind = "bar", length = 0.1, nodes = 2 }
area = 2.0e-4
strain = "cauchy"
material = { density = 1000.0, young = 5.0e4, poisson = 0.0, viscosity = 0.0 }
[initial]
velocity = [0.1]
[[phase]]
until = 0.2
hold = [{ nodes = "left" }]
"#;

/// A directory with the scene, and a study of it.
fn study(text: &str) -> (TempDir, Sweep) {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("scene.toml"), SCENE).unwrap();
    let sweep = of(&place, text);
    (place, sweep)
}

fn of(place: &TempDir, text: &str) -> Sweep {
    let head = "scene = \"scene.toml\"\nquantities = [\"right.x:max\", \"right.x:frequency\"]\n";
    let file = StudyFile::parse(&(head.to_owned() + text), &place.path().join("study.toml"));
    Sweep::new(file.unwrap(), false).unwrap()
}

fn key(name: &str, values: &str) -> String {
    format!("[[key]]\nname = \"{name}\"\n{values}\n")
}

fn numbers(sweep: &Sweep, at: usize) -> Vec<f64> {
    sweep.plan().points().map(|point| point.values[at].number().unwrap()).collect()
}

const YOUNG: &str = "body.material.young";

#[test]
fn grids_have_all_combinations() {
    let text = key(YOUNG, "from = 1e4\nto = 1e6\ncount = 5\nscale = \"logarithmic\"")
        + &key("body.area", "from = 1\nto = 2\nstep = 0.25")
        + &key("solver.method", "values = [\"rk\", \"cvode-bdf\"]");
    let (_place, sweep) = study(&text);
    assert_eq!(sweep.plan().len(), 5 * 5 * 2);
    let all: Vec<Vec<String>> = sweep.plan().points().map(|point| point.set()).collect();
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), 50);
    assert_eq!(
        all[0],
        [format!("{YOUNG}=10000.0"), "body.area=1.0".into(), "solver.method=\"rk\"".into()]
    );
    assert_eq!(all[49][2], "solver.method=\"cvode-bdf\"");
    // ratios are the root of ten; steps are a quarter
    let mut values = numbers(&sweep, 0);
    values.dedup();
    let expected = [1e4, 1e4 * 10_f64.sqrt(), 1e5, 1e5 * 10_f64.sqrt(), 1e6];
    for (value, expected) in values.iter().zip(expected) {
        assert!((value / expected - 1.0).abs() < 1e-11, "{value} {expected}");
    }
    let areas: BTreeSet<String> = all.iter().map(|set| set[1].clone()).collect();
    let expected = [1.0, 1.25, 1.5, 1.75, 2.0].map(|area| format!("body.area={area:?}"));
    assert_eq!(areas, expected.into());
    // whole numbers stay whole, as keys that count need
    let (_place, sweep) = study(&key("body.mesh.nodes", "from = 3\nto = 9\nstep = 2"));
    let all: Vec<_> = sweep.plan().points().flat_map(|point| point.set()).collect();
    assert_eq!(all, [3, 5, 7, 9].map(|nodes| format!("body.mesh.nodes={nodes}")));
}

/// The values alone make an id: not their order, not how they are written, not what else is in the study.
#[test]
fn ids_are_of_values_alone() {
    let (place, sweep) =
        study(&(key(YOUNG, "values = [1e5, 2e5]") + &key("body.area", "values = [0.5]")));
    let ids: Vec<String> = sweep.plan().points().map(|point| point.id).collect();
    let other = of(
        &place,
        &(key("body.area", "values = [0.50]") + &key(YOUNG, "values = [300000, 200000, 1.0e5]")),
    );
    let others: Vec<String> = other.plan().points().map(|point| point.id).collect();
    assert_eq!(ids, [others[2].clone(), others[1].clone()]);
    let ranged = of(
        &place,
        &(key(YOUNG, "from = 1e5\nto = 3e5\nstep = 1e5") + &key("body.area", "values = [0.5]")),
    );
    assert_eq!(ranged.plan().point(1).id, ids[1]);
    fs::write(place.path().join("points.csv"), "body.area, body.material.young\n5e-1, 200_000\n")
        .unwrap();
    let listed = of(&place, "table = \"points.csv\"\n");
    assert_eq!(listed.plan().point(0).id, ids[1]);
    // a hash that is the same on all machines
    assert!(ids.iter().all(|id| id.len() == 16) && ids[0] != ids[1]);
    assert_eq!(sweep.plan().point(0).id, ids[0]);
}

#[test]
fn samples_fill_their_ranges() {
    let ranges = key(YOUNG, "from = 1e4\nto = 1e6\nscale = \"logarithmic\"")
        + &key("body.area", "from = 1.0\nto = 3.0");
    let (place, cube) =
        study(&(ranges.clone() + "[sample]\nkind = \"latin-hypercube\"\ncount = 64\nseed = 2"));
    assert_eq!(cube.plan().len(), 64);
    let parts = |values: Vec<f64>, part: &dyn Fn(f64) -> f64| -> Vec<usize> {
        let mut parts: Vec<usize> = values.into_iter().map(|x| (64.0 * part(x)) as usize).collect();
        parts.sort_unstable();
        parts
    };
    // one in each of 64 parts of either range
    assert!((0..64).eq(parts(numbers(&cube, 0), &|x| (x / 1e4).log10() / 2.0)));
    assert!((0..64).eq(parts(numbers(&cube, 1), &|x| (x - 1.0) / 2.0)));
    let sobol = of(&place, &(ranges.clone() + "[sample]\nkind = \"sobol\"\ncount = 4"));
    // axes in the order of the names: 0, 1/2, 3/4, 1/4 and 0, 1/2, 1/4, 3/4
    assert_eq!(numbers(&sobol, 1), [1.0, 2.0, 2.5, 1.5]);
    let young = [1e4, 1e5, 1e4 * 10_f64.sqrt(), 1e5 * 10_f64.sqrt()];
    for (value, expected) in numbers(&sobol, 0).iter().zip(young) {
        assert!((value / expected - 1.0).abs() < 1e-11, "{value} {expected}");
    }
    // more points leave those that are there
    let more = of(&place, &(ranges + "[sample]\nkind = \"sobol\"\ncount = 10"));
    assert!((0..4).all(|number| more.plan().point(number) == sobol.plan().point(number)));
}

/// Counts how often points are run.
#[derive(Default)]
struct Count(AtomicUsize);

impl Watch for Count {
    fn ran(&self, _: &PointRun) -> Result<(), Error> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }

    fn has(&self, _: &Row) {}
}

fn without_times(results: Results) -> Vec<Row> {
    let without = |row: Row| Row { cost: Default::default(), ..row };
    results.rows.into_iter().map(without).collect()
}

/// Two at once, each with the directory open for itself, run each point once, and find what one alone finds.
///
/// A bar of one cell, held at one end, is an oscillator of the stiffness E A/L and the mass rho A L/3 (consistent inertia).
#[test]
fn two_at_one_study_run_each_point_once() {
    let (place, sweep) = study(&key(YOUNG, "from = 2e4\nto = 8e4\ncount = 24"));
    let all: Vec<usize> = (0..24).collect();
    let run = |directory: &Path| {
        let store = Store::new(directory, &sweep).unwrap();
        let count = Count::default();
        let done = Runner::new(&sweep, &store).cores(2).run(&all, |_| false, &count).unwrap();
        assert!(done);
        count.0.into_inner()
    };
    let shared = place.path().join("shared");
    let ran: usize = thread::scope(|scope| {
        let both = [0, 1].map(|_| scope.spawn(|| run(&shared)));
        both.map(|one| one.join().unwrap()).iter().sum()
    });
    assert_eq!(ran, 24);
    assert_eq!(run(&shared), 0);
    let alone = place.path().join("alone");
    run(&alone);
    let rows = |directory: &Path| {
        let results = Results::gather(&sweep, &Store::new(directory, &sweep).unwrap());
        assert_eq!(results.missing, 0);
        without_times(results)
    };
    assert_eq!(rows(&shared), rows(&alone));
    for (row, young) in rows(&alone).iter().zip(numbers(&sweep, 0)) {
        assert_eq!(row.verdict, RowVerdict::Fine, "{row:?}");
        let rate = (3.0 * young / 1000.0).sqrt() / 0.1;
        let found = row.number("right.x:frequency").unwrap();
        let expected = rate / (2.0 * std::f64::consts::PI);
        // parabolas through a hundred points of a period or more, and the tolerance of the integration, 1e-4 by default
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
        // what the held end had of the momentum, rho A L v/6, goes to the other one
        let swing = row.number("right.x:max").unwrap() - 0.1;
        assert!((swing * rate / 0.15 - 1.0).abs() < 1e-3, "{swing}");
    }
}

/// A row that was half written, by who knows whom, counts as none.
#[test]
fn broken_rows_are_none() {
    let (place, sweep) = study(&key(YOUNG, "values = [1e5]"));
    let store = Store::new(place.path().join("out"), &sweep).unwrap();
    store.create().unwrap();
    let point = sweep.plan().point(0);
    let run = sweep.run(&point, &mut |_| ControlFlow::Continue(())).unwrap();
    store.write(&run.row).unwrap();
    assert_eq!(store.row(&point.id), Some(run.row));
    let path = place.path().join("out/rows").join(format!("{}.json", point.id));
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    assert_eq!(store.row(&point.id), None);
    // a run that is stopped has no row
    assert!(sweep.run(&point, &mut |_| ControlFlow::Break(())).is_none());
}

/// Each row has a mark in each panel, and the pictures are XML.
#[test]
fn pictures_have_all_rows() {
    let one = key(YOUNG, "values = [1e5, 2e5, 4e5]");
    let two = one.clone() + &key("body.area", "values = [1.0, 2.0]");
    let three = two.clone() + &key("solver.method", "values = [\"rk\", \"cvode-bdf\"]");
    for (text, panels) in [(one, 2), (two, 2), (three, 1)] {
        let (place, sweep) = study(&text);
        let store = Store::new(place.path().join("out"), &sweep).unwrap();
        let all: Vec<usize> = (0..sweep.plan().len()).collect();
        let units = sweep.check().unwrap();
        assert_eq!(units, ["m", "Hz"]);
        Runner::new(&sweep, &store).run(&all, |_| false, &Count::default()).unwrap();
        let results = Results::gather(&sweep, &store);
        let path = place.path().join("plot.svg");
        results.write_plot(&sweep, &units, &path).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let drawing = roxmltree::Document::parse(&text).unwrap();
        let marks = drawing.descendants().filter(|node| node.attribute("data-row").is_some());
        assert_eq!(marks.count(), panels * all.len());
        let page = place.path().join("sweep.html");
        results.write_page(&sweep, &store, &units, &page).unwrap();
        let page = fs::read_to_string(page).unwrap();
        assert!(page.contains(&sweep.plan().point(0).id) && !page.contains("/*"), "{page}");
    }
}
