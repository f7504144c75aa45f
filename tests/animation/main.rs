//! `animation.html` in a real browser, used by mouse and keyboard; compared with the trajectory.
//!
//! Needs Debian's package `chromium`. The start of a browser takes as long as many of the cases: they
//! share two, one after the other.

mod acting;
mod advice;
mod beside;
// its other users need what these tests do not
#[allow(dead_code)]
mod browser;
mod data;
mod page;
mod saving;
mod sensors;
mod showing;
mod using;

use std::error::Error;

use browser::Browser;

type Outcome = Result<(), Box<dyn Error>>;
/// Its name, and what is tried.
type Case = (&'static str, fn(&mut Browser) -> Outcome);

/// Size of the window (px).
const DESKTOP: [u32; 2] = [1100, 900];

/// Has each case tried in a browser, in which nothing must complain, and no page may ask for anything but
/// itself.
fn in_browser(cases: &[Case]) -> Outcome {
    let mut browser = Browser::start()?;
    for (name, case) in cases {
        println!("{name}");
        browser.resize(DESKTOP, false)?;
        browser.prefer("light")?;
        case(&mut browser).map_err(|error| format!("{name}: {error}"))?;
        let complaints = browser.complaints();
        assert!(complaints.is_empty(), "{name}: {complaints:?}");
        assert_eq!(browser.requests(), browser.opened(), "{name}");
    }
    Ok(())
}

#[test]
fn it_is_used() -> Outcome {
    in_browser(&[
        ("it plays and pauses", using::it_plays_and_pauses),
        ("picture and energies follow", using::picture_and_energies_follow_the_slider),
        ("colours", using::the_colours_are_those_of_the_chosen_quantity),
        ("keyboard", using::all_of_it_works_by_keyboard),
        ("sensors", sensors::sensors_have_charts),
        ("saving", saving::the_frame_is_saved),
        ("arrows", saving::arrows_are_offered),
    ])
}

#[test]
fn motions_stand_side_by_side() -> Outcome {
    in_browser(&[
        ("two in the plane", beside::two_are_played_by_one_clock),
        ("same colours", beside::colours_mean_the_same),
        ("in space", beside::bodies_in_space_are_as_large_and_turn_together),
        ("plane and space", beside::a_plane_and_a_space_have_one_scale),
        ("saving both", beside::all_of_them_are_saved),
        ("advice", advice::advice_is_read_and_both_motions_play),
        ("phone", beside::they_stand_one_below_the_other_on_a_phone),
    ])
}

#[test]
fn it_is_looked_at() -> Outcome {
    in_browser(&[
        ("phone and dark", showing::it_fits_a_phone_and_the_dark),
        ("names", showing::names_are_text),
        ("warnings", showing::warnings_are_shown),
        ("what acts", acting::what_acts_is_seen),
        ("bodies", showing::bodies_of_all_dimensions),
        ("near side", showing::the_near_side_of_a_solid_is_seen),
        ("long runs", showing::long_runs_are_thinned),
    ])
}
