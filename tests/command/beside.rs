//! `pliant beside`: the animations of finished runs in one page.

use std::fs;

use super::{Place, bar, says, stderr, stdout};

/// The data of the page have both runs, under the names of their directories or others; nothing else is touched. What
/// cannot be put together is told with what to do.
#[test]
fn animations_stand_side_by_side() {
    let place = Place::new();
    let scene = place.scene(&bar(0.2));
    for (out, young) in [("soft", "3e4"), ("stiff", "5e4")] {
        let young = format!("body.material.young={young}");
        let run = ["run", scene, "--formats", "html", "--set", &young, "--out", out, "--quiet"];
        assert_eq!(place.run(&run).status.code(), Some(0));
    }
    let before = place.files("soft");
    let output = place.run(&["beside", "soft", "stiff/animation.html"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    says(&stdout(&output), &["written to out/beside.html"]);
    let page = fs::read_to_string(place.path("out/beside.html")).unwrap();
    says(&page, &["\"name\":\"soft\"", "\"name\":\"stiff\""]);
    assert_eq!(place.files("soft"), before);

    let named = ["beside", "soft", "stiff", "--names", "30 kPa,50 kPa", "--out", "both.html"];
    assert_eq!(place.run(&named).status.code(), Some(0));
    let page = fs::read_to_string(place.path("both.html")).unwrap();
    says(&page, &["\"name\":\"30 kPa\"", "\"name\":\"50 kPa\""]);

    for (arguments, part) in [
        (&["beside", "soft"][..], "2 values required"),
        (&["beside", "soft", "nowhere"], "no nowhere: run its scene with --formats html"),
        (&["beside", "soft", "out"], "no out/animation.html"),
        (&["beside", "soft", "stiff", "--names", "one"], "1 names for 2 animations"),
        (&["beside", "soft", "both.html"], "it shows 2 motions"),
        (&["beside", "soft", "soft/report.json"], "no animation of pliant"),
    ] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        says(&stderr(&output), &[part]);
    }
}
