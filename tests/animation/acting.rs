//! Gravity, the magnetic field and the remanence of magnets on a page.

use std::error::Error;

use pliant::{
    Body, Cells, Magnet, MagneticField, Material, Mesh, Phase, Sampling, Scene, Settings,
    Trajectory,
};
use serde_json::Value;

use super::Outcome;
use super::browser::Browser;
use super::data::{data, decoded};
use super::page::*;

/// The deformation gradient at the start, and the remanence (T).
const F: [[f64; 2]; 2] = [[0.9, -0.6], [0.5, 0.8]];
const REMANENCE: [f64; 2] = [0.08, 0.06];
/// When the first phase ends, and all (s).
const ENDS: [f64; 2] = [1e-6, 2e-6];
/// Size of the body (m), and of its cells.
const SIZE: [f64; 2] = [0.03, 0.02];
const CELL: f64 = 0.005;

/// A magnet that starts turned and stretched alike everywhere, in a field that grows from nothing and is off in the second phase, which has gravity of its own.
fn magnet() -> Result<Trajectory, pliant::Error> {
    let mesh = Mesh::rectangle(SIZE, [7, 5], Cells::Rectangles)?;
    let soft = Material { density: 1000.0, young: 1e4, poisson: 0.3, viscosity: 1.0 };
    let [[a, b], [c, d]] = F;
    let moved = move |x: &[f64]| vec![(a - 1.0) * x[0] + b * x[1], c * x[0] + (d - 1.0) * x[1]];
    let growing = MagneticField::with(|t| [0.0, 3e3 * t]);
    Scene::new(Body::new(mesh, soft).thickness(0.01).build()?)
        .magnet(Magnet::new(REMANENCE))
        .gravity([0.0, -9.8])
        .initial_displacement(moved)
        .phase(Phase::until(ENDS[0]).magnetic_field(growing))
        .phase(Phase::until(ENDS[1]).gravity([4.9, 0.0]))
        .simulate(&Settings::default(), &Sampling::phase_ends())
}

fn singles(value: &Value) -> Result<Vec<f64>, Box<dyn Error>> {
    let bytes = decoded(value)?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|&x| f32::from_le_bytes(x).into()).collect())
}

/// Gravity and the field are those of the phase and the time; arrows are at the deformed middles of cells, as far apart as their boxes of 7.5 mm, along F b.
#[test]
fn arrows_are_what_acts() -> Outcome {
    let data = data(&page(&magnet()?, "")?)?;
    let told = |k: usize| singles(&data["everywhere"][k]["along"]);
    assert_eq!(
        (&data["everywhere"][0]["name"], &data["everywhere"][1]["name"]),
        (&"g".into(), &"B".into())
    );
    let expected = [[0.0, -9.8, 0.0, -9.8, 4.9, 0.0], [0.0, 0.0, 0.0, 3e-3, 0.0, 0.0]];
    for (k, expected) in expected.into_iter().enumerate() {
        let found = told(k)?;
        assert_eq!(found.len(), 6);
        assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-6), "{found:?}");
    }

    let numbers = singles(&data["remanence"])?;
    // four by three
    assert_eq!(numbers.len(), 3 * 12 * 4);
    let [[a, b], [c, d]] = F;
    let apart = 0.75 * 7.5e-3;
    let strength = REMANENCE[0].hypot(REMANENCE[1]);
    let mut boxes = std::collections::BTreeSet::new();
    for arrow in numbers[..48].as_chunks::<4>().0 {
        let [x, y, dx, dy] = *arrow;
        let [bx, by] = REMANENCE.map(|b| b * apart / strength);
        let off = (dx - a * bx - b * by).hypot(dy - c * bx - d * by);
        assert!(off < 1e-6 * apart, "{off:e}");
        let natural = [d * x - b * y, a * y - c * x].map(|x| x / (a * d - b * c));
        for x in natural {
            let cells = x / CELL - 0.5;
            assert!((cells - cells.round()).abs() < 1e-5, "{natural:?}");
        }
        boxes.insert([(natural[0] / 7.5e-3) as i64, (natural[1] / (SIZE[1] / 3.0)) as i64]);
    }
    assert_eq!(boxes.len(), 12);
    Ok(())
}

/// A scene without any of it has no arrows.
#[test]
fn without_gravity_and_magnets_nothing_is_told() -> Outcome {
    let scene = Scene::new(pliant::samples::beam_jump()?.body().clone()).phase(Phase::until(1e-3));
    let data = data(&page(&scene.simulate(&Settings::default(), &Sampling::phase_ends())?, "")?)?;
    assert_eq!((&data["everywhere"], &data["remanence"]), (&serde_json::json!([]), &"".into()));
    Ok(())
}

/// Pixels of the colours of gravity and the field.
const SEEN: &str = "['gravity', 'field'].map((name) => {
    const [red, green, blue] = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`)
      .match(/[0-9a-f]{2}/g).map((part) => parseInt(part, 16));
    let count = 0;
    for (let k = 0; k < data.length; k += 4)
      if (data[k] === red && data[k + 1] === green && data[k + 2] === blue) count++;
    return count; })";

/// Both have an arrow while they act, and the key says so.
pub fn what_acts_is_seen(browser: &mut Browser) -> Outcome {
    let _page = shown(browser, &magnet()?)?;
    let key = browser.text("document.querySelector('.key').textContent")?;
    assert_eq!(key, "gravitymagnetic fieldremanence");
    let mut seen = Vec::new();
    for time in [0.0, ENDS[0], ENDS[1]] {
        browser.evaluate(&format!(
            "document.querySelector('#time').value = {time};
             document.querySelector('#time').dispatchEvent(new Event('input'))"
        ))?;
        let found = browser.evaluate(&format!(
            "(() => {{ const {{ data }} = ({PIXELS})('#stage'); return {SEEN}; }})()"
        ))?;
        seen.push(serde_json::from_value::<[usize; 2]>(found)?);
    }
    println!("{seen:?}");
    let [start, middle, end] = seen[..] else { return Err("three times".into()) };
    assert!(start[0] > 60 && start[1] == 0, "{start:?}");
    assert!(middle[0] == start[0] && middle[1] > 60, "{middle:?}");
    // half as strong, and the field is off
    assert!(end[0] < start[0] && end[0] > 20 && end[1] == 0, "{end:?}");
    Ok(())
}
