//! The page of the adviser, of advice with numbers that are known.

use std::fs;
use std::ops::ControlFlow;

use pliant::samples::beam_jump;
use pliant::study::{Advice, Candidate, Choice};
use pliant::{Inertia, Sampling, Scene, Settings, Strain};
use serde_json::Value;

type Outcome = Result<(), Box<dyn std::error::Error>>;

const HOSTILE: &str = "<script>alert(\"1\")</script><!--motions-->/*data*/";

fn candidate(rtol: f64, seconds: f64, error: Option<f64>) -> Candidate {
    let choice = Choice {
        strain: Strain::Cauchy,
        richer: None,
        halved: 0,
        halved_in: Vec::new(),
        inertia: Inertia::Consistent,
        is_rigid: false,
        without: Vec::new(),
        is_static: false,
        settings: Settings { rtol, ..Settings::default() },
    };
    let set = vec![format!("solver.rtol={rtol:e}")];
    let warnings = vec![HOSTILE.into()];
    Candidate { choice, set, error, parts: None, seconds, unknowns: 14, failure: None, warnings }
}

/// Six candidates: one that is enough, one that is slower and worse, one that all are compared with, and a failure.
fn advice() -> Advice {
    let written = candidate(1e-3, 0.01, Some(0.1));
    let enough = candidate(1e-5, 0.1, Some(0.005));
    let truth = candidate(1e-9, 10.0, Some(0.0));
    let failed = Candidate { failure: Some(HOSTILE.into()), ..candidate(1e-2, f64::NAN, None) };
    let others = [candidate(1e-1, 1e-3, Some(0.5)), candidate(1e-6, 1.0, Some(0.02)), failed];
    let candidates = [&[written.clone(), enough.clone(), truth.clone()][..], &others].concat();
    Advice {
        quantity: HOSTILE.into(),
        accuracy: 0.01,
        scale: 0.2,
        unit: "m".into(),
        written,
        enough: Some(enough),
        truth: Some(truth),
        resolution: 0.001,
        has_rate: true,
        mesh: None,
        alphas: Vec::new(),
        law: None,
        inertia: None,
        terms: Vec::new(),
        together: None,
        candidates,
        known_until: None,
        end: 0.6,
        mesh_estimate: None,
        smaller: Vec::new(),
        reduced: None,
        look: None,
        not_tried: vec![HOSTILE.into()],
        is_cut_short: false,
        runs: 6,
        seconds: 12.0,
        known: 0,
    }
}

/// The text of the page, with motions unless they are given up at once.
fn page(
    advice: &Advice,
    scene: &Scene,
    goes_on: bool,
) -> Result<String, Box<dyn std::error::Error>> {
    let directory = tempfile::tempdir()?;
    let path = directory.path().join("advice.html");
    let mut observer = |_: &str| match goes_on {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    };
    advice.write_page(scene, &Sampling::every(0.1), &path, HOSTILE, &mut observer)?;
    Ok(fs::read_to_string(path)?)
}

/// The part of a text from one mark to another.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Option<&'a str> {
    let begin = text.find(from)?;
    let end = text[begin..].find(to)?;
    Some(&text[begin..begin + end + to.len()])
}

/// Places of points follow from the axes: logarithmic, six hundredths of the decades more at both ends. The least error that is told apart is
/// a thousandth of the accuracy.
#[test]
fn points_stand_where_error_and_time_are() -> Outcome {
    let page = page(&advice(), &beam_jump()?, false)?;
    let chart = between(&page, "<svg", "</svg>").ok_or("no chart")?;
    let chart = roxmltree::Document::parse(chart)?;
    let number = |node: roxmltree::Node, name: &str| {
        node.attribute(name).and_then(|text| text.parse::<f64>().ok()).unwrap_or(f64::NAN)
    };
    let of_class = |class: &'static str| {
        chart.descendants().filter(move |node| node.attribute("class") == Some(class))
    };
    let field = of_class("field").next().ok_or("no field")?;
    let [left, top] = ["x", "y"].map(|name| number(field, name));
    let [right, bottom] = [left + number(field, "width"), top + number(field, "height")];
    assert!(right - left > 400.0 && bottom - top > 300.0);
    let place = |error: f64, seconds: f64| {
        let (lowest, highest) = (1e-5_f64.log10(), 0.5_f64.log10());
        let more = 0.06 * (highest - lowest);
        let part = (error.log10() - lowest + more) / (highest - lowest + 2.0 * more);
        let x = left + (seconds.log10() + 3.24) / 4.48 * (right - left);
        [x, bottom - part * (bottom - top)]
    };
    let points: Vec<_> = of_class("mark").collect();
    // all but the failure
    assert_eq!(points.len(), 5);
    let named = |rtol: &str| {
        let title = |node: &roxmltree::Node| {
            node.descendants().any(|n| n.text().is_some_and(|text| text.contains(rtol)))
        };
        points.iter().copied().find(title).ok_or(rtol.to_owned())
    };
    let known =
        [("1e-1", 0.5, 1e-3), ("1e-3", 0.1, 0.01), ("1e-5", 0.005, 0.1), ("1e-6", 0.02, 1.0)];
    for (rtol, error, seconds) in known {
        let [x, y] = place(error, seconds);
        let circle = named(rtol)?.descendants().find(|node| node.has_tag_name("circle"));
        let circle = circle.ok_or("no circle")?;
        // places are written to a hundredth of a pixel
        let apart = (number(circle, "cx") - x).abs().max((number(circle, "cy") - y).abs());
        assert!(apart < 0.006, "{rtol}: {apart}");
    }
    // without an error of its own, at the least one, and not on the edge of the field
    let truth = named("1e-9")?.descendants().find_map(|node| node.attribute("d"));
    let least = place(1e-5, 10.0)[1];
    assert!(bottom - least > 8.0);
    assert!(truth.is_some_and(|d| d.contains(&format!(" {least:.2} "))), "{truth:?}");
    assert!(chart.descendants().filter_map(|n| n.text()).any(|t| t.trim() == "0.001 % or less"));

    // places are written to a hundredth of a pixel
    let near = |a: f64, b: f64| (a - b).abs() < 0.006;
    let corners = |node: roxmltree::Node| -> Vec<[f64; 2]> {
        let data = node.descendants().find_map(|node| node.attribute("d")).unwrap_or_default();
        let corners = data.split(['M', 'L', 'Z']).filter(|corner| !corner.is_empty());
        let number = |text: &str| text.parse().unwrap_or(f64::NAN);
        corners
            .map(|corner| corner.split_once(' ').map_or([f64::NAN; 2], |(x, y)| [x, y].map(number)))
            .collect()
    };
    let band = corners(of_class("band").next().ok_or("no band")?);
    assert!(band.iter().any(|[_, y]| near(*y, place(0.001, 1.0)[1])), "{band:?}");
    let [asked, front] = [0, 1].map(|at| of_class("series").nth(at).map(corners));
    let asked = asked.ok_or("no line")?;
    assert!(asked.len() == 2 && asked.iter().all(|[_, y]| near(*y, place(0.01, 1.0)[1])));
    let front = front.ok_or("no front")?;
    let expected = [&known[0], &known[1], &known[2]].map(|(_, error, time)| place(*error, *time));
    assert_eq!(front.len(), expected.len());
    for ([x, y], [along, up]) in front.into_iter().zip(expected) {
        assert!(near(x, along) && near(y, up), "{x} {y} {along} {up}");
    }
    let texts = chart.descendants().filter_map(|node| node.text().map(str::trim));
    let texts: Vec<&str> = texts.collect();
    for name in ["asked: 1 %", "known to 0.1 %", "as written", "enough"] {
        assert!(texts.contains(&name), "{name}: {texts:?}");
    }
    Ok(())
}

/// The table has all candidates, the fastest first, with the marks of the chart.
#[test]
fn the_table_has_all_candidates() -> Outcome {
    let page = page(&advice(), &beam_jump()?, false)?;
    let table = between(&page, "<table", "</table>").ok_or("no table")?;
    let table = roxmltree::Document::parse(table)?;
    let rows = table.descendants().filter(|node| node.has_tag_name("tr")).skip(1);
    let cells = |row: roxmltree::Node| -> Vec<String> {
        let cells = row.children().filter(|node| node.is_element());
        let text = |cell: roxmltree::Node| {
            cell.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect::<String>()
        };
        cells.map(|cell| text(cell).trim().to_owned()).collect()
    };
    let rows: Vec<Vec<String>> = rows.map(cells).collect();
    let failed = format!("failed: {HOSTILE}");
    let expected = [
        ["1e-1", "50 %", "1.00 ms", "14", "front"],
        ["1e-3", "10 %", "10.0 ms", "14", "as written front"],
        ["1e-5", "0.5 %", "100 ms", "14", "enough front"],
        ["1e-6", "2 %", "1.00 s", "14", ""],
        ["1e-9", "", "10.0 s", "14", "the reference"],
        ["1e-2", "", "", "", &failed],
    ];
    assert_eq!(rows.len(), expected.len());
    for (row, expected) in rows.iter().zip(expected) {
        assert!(row[0].ends_with(&format!("rtol {}", expected[0])), "{row:?}");
        assert_eq!(row[1..], expected[1..]);
    }
    Ok(())
}

/// A page whose runs are given up has no script at all, says why, and has text of users as text.
#[test]
fn it_stands_without_motions() -> Outcome {
    let advice = advice();
    let page = page(&advice, &beam_jump()?, false)?;
    assert!(!page.contains("<script") && !page.contains("<canvas"), "{page}");
    assert!(page.contains("No motion is shown") && page.contains("As written: given up after"));
    assert!(page.contains("default-src 'none'"));
    let text = "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;&lt;!--motions--&gt;/*data*/";
    // title, heading, quantity, warning, failure in words and in the table, and what was not tried
    assert_eq!(page.matches(text).count(), 7, "{page}");
    // all that the terminal says, line by line
    for line in advice.to_string().lines() {
        let line = line.trim_start_matches("- ").rsplit(": ").next().unwrap_or_default().trim();
        let line = line.replace(HOSTILE, text);
        assert!(page.contains(&line), "{line}");
    }
    assert!(page.contains("solver.rtol=1e-5"));
    // nothing to set, and no list of that
    let enough = Candidate { set: Vec::new(), ..candidate(1e-5, 0.1, Some(0.005)) };
    let as_it_is = Advice { enough: Some(enough), ..advice.clone() };
    let as_it_is = self::page(&as_it_is, &beam_jump()?, false)?;
    assert!(as_it_is.contains("nothing has to be set") && !as_it_is.contains("<pre></pre>"));

    // without errors there is no chart
    let strip = |candidate: &Candidate| Candidate { error: None, ..candidate.clone() };
    let bare = Advice {
        candidates: advice.candidates.iter().map(strip).collect(),
        written: strip(&advice.written),
        enough: None,
        truth: None,
        resolution: f64::NAN,
        ..advice
    };
    let page = self::page(&bare, &beam_jump()?, false)?;
    assert!(!page.contains("id=\"pareto\"") && page.contains("<table>"));
    Ok(())
}

/// Both motions are those of the choices; where what was written is enough there is one.
#[test]
fn motions_of_both_are_shown() -> Outcome {
    let scene = beam_jump()?.ended_at(0.3);
    let names = |advice: &Advice| -> Result<Vec<(String, f64)>, Box<dyn std::error::Error>> {
        let page = page(advice, &scene, true)?;
        assert_eq!(page.matches("<ul>\n</ul>").count(), 0);
        let data = between(&page, "id=\"data\">", "</script>").ok_or("no data")?;
        let data = data.trim_start_matches("id=\"data\">").trim_end_matches("</script>");
        let data: Value = serde_json::from_str(data)?;
        assert_eq!(data["title"], HOSTILE);
        let motions = data["motions"].as_array().ok_or("no motions")?;
        let told = |motion: &Value| {
            let name = motion["name"].as_str().unwrap_or_default().to_owned();
            let rtol = motion["run"]["rtol"].as_str().and_then(|text| text.parse().ok());
            (name, rtol.unwrap_or(f64::NAN))
        };
        Ok(motions.iter().map(told).collect())
    };
    let both = advice();
    let [written, enough] = [("As written".to_owned(), 1e-3), ("Enough".to_owned(), 1e-5)];
    assert_eq!(names(&both)?, [written.clone(), enough]);
    let same = Advice { enough: Some(both.written.clone()), ..both.clone() };
    assert_eq!(names(&same)?, [("As written, which is enough".to_owned(), 1e-3)]);
    let failed = both.candidates.last().cloned();
    let one = Advice { enough: failed, ..both };
    assert_eq!(names(&one)?, [written]);
    Ok(())
}
