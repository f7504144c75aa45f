//! The adviser's page.

use std::ops::ControlFlow;

use pliant::samples::clamped_beam;
use pliant::study::{Advice, Adviser, Candidate};
use pliant::{Error, Sampling, Scene};
use roxmltree::{Document, Node};

type Outcome = Result<(), Error>;

fn beam() -> Result<Scene, Error> {
    Ok(clamped_beam([6, 2], 100.0)?.ended_at(0.1))
}

fn advise(scene: &Scene) -> Result<Advice, Error> {
    Adviser::new(scene, 0.05).run(&mut |_| ControlFlow::Continue(()))
}

fn written(advice: &Advice, scene: &Scene, goes_on: ControlFlow<()>) -> Result<String, Error> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("advice.html");
    let sampling = Sampling::every(0.02);
    advice.write_page(scene, &sampling, &path, "<script>alert(1)</script>", &mut |_| goes_on)?;
    Ok(std::fs::read_to_string(path).unwrap())
}

/// Each candidate with an error is a point where its time and its error are, by two scales in decades that three points fix and
/// all others follow; names tell what they are.
#[test]
fn points_stand_where_the_numbers_are() -> Outcome {
    let scene = beam()?;
    let advice = advise(&scene)?;
    let page = written(&advice, &scene, ControlFlow::Continue(()))?;
    let start = page.find("<svg").unwrap();
    let end = start + page[start..].find("</svg>").unwrap() + "</svg>".len();
    let chart = Document::parse(&page[start..end]).unwrap();
    let is_group = |node: &Node| node.attribute("class") == Some("points");
    let points = chart.descendants().find(is_group).unwrap();
    let points: Vec<(String, Option<[f64; 2]>)> = points
        .children()
        .filter(Node::is_element)
        .map(|point| {
            let title = point.children().find(|node| node.has_tag_name("title")).unwrap();
            let circle = point.children().find(|node| node.has_tag_name("circle"));
            let place = circle.map(|circle| {
                ["cx", "cy"].map(|at| circle.attribute(at).unwrap().parse().unwrap())
            });
            (title.text().unwrap().to_owned(), place)
        })
        .collect();
    let measured: Vec<&Candidate> =
        advice.candidates.iter().filter(|candidate| candidate.error.is_some()).collect();
    assert_eq!(points.len(), measured.len());
    // errors of nearly 0 are drawn at the lower edge
    let mut seen = Vec::new();
    for candidate in &measured {
        let name = candidate.choice.to_string();
        let mut named = points.iter().filter(|(title, _)| title.starts_with(&format!("{name}: ")));
        let (Some((_, Some(place))), None) = (named.next(), named.next()) else { continue };
        if candidate.error.unwrap() > 1e-4 {
            seen.push((*place, [candidate.seconds, candidate.error.unwrap()].map(f64::log10)));
        }
    }
    assert!(seen.len() > 5, "{}", seen.len());
    for axis in 0..2 {
        let numbers = |k: usize| (seen[k].0[axis], seen[k].1[axis]);
        let far = |a: &usize, b: &usize| numbers(*a).1.total_cmp(&numbers(*b).1);
        let least = (0..seen.len()).min_by(far).unwrap();
        let most = (0..seen.len()).max_by(far).unwrap();
        let ((p, x), (q, y)) = (numbers(least), numbers(most));
        for k in 0..seen.len() {
            let (place, value) = numbers(k);
            let expected = p + (q - p) * (value - x) / (y - x);
            // hundredths of a pixel are written
            assert!((place - expected).abs() < 0.02, "{axis}: {place} {expected}");
        }
    }
    let roles = ["as written", "what all are compared with"];
    for role in roles {
        assert_eq!(points.iter().filter(|(title, _)| title.contains(role)).count(), 1, "{role}");
    }
    Ok(())
}

/// Text is text, whatever it is; a page whose motions were not run says so.
#[test]
fn a_page_without_motions() -> Outcome {
    let scene = beam()?;
    let advice = advise(&scene)?;
    let page = written(&advice, &scene, ControlFlow::Break(()))?;
    assert!(!page.contains("<script>alert") && page.contains("&lt;script&gt;alert"));
    assert!(page.contains("No motion is shown") && page.contains("given up after"));
    assert!(page.contains("default-src 'none'"));
    for reason in advice.reasons() {
        let escaped = reason.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        assert!(page.contains(&reason) || page.contains(&escaped), "{reason}");
    }
    Ok(())
}
