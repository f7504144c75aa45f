//! The data of a page, against the trajectory.

use std::error::Error;
use std::fs;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use pliant::samples::{beam_jump, square_jump};
use pliant::{CellField, Sample, Sampling, Settings};
use serde_json::Value;

use super::Outcome;
use super::page::*;

/// The data that a page holds.
fn data(page: &Page) -> Result<Value, Box<dyn Error>> {
    let text = fs::read_to_string(&page.path)?;
    let (_, data) = text.split_once("id=\"data\">").ok_or("no data")?;
    Ok(serde_json::from_str(data.split_once("</script>").ok_or("no end")?.0)?)
}

fn decoded(base64: &Value) -> Result<Vec<u8>, Box<dyn Error>> {
    Ok(STANDARD.decode(base64.as_str().ok_or("no text")?)?)
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
    let quantities: [fn(&CellField) -> f64; 2] = [CellField::von_mises, |f| f.energy_density];
    for (quantity, value) in data["quantities"].as_array().ok_or("no list")?.iter().zip(quantities)
    {
        let scale = quantity["scale"].as_f64().ok_or("no scale")?;
        let bytes = decoded(&quantity["values"])?;
        assert_eq!(bytes.len(), fields.len());
        let above = fields.iter().filter(|field| value(field) > scale).count();
        assert!(100 * above <= fields.len(), "{above} of {} beyond {scale}", fields.len());
        for (&byte, field) in bytes.iter().zip(&fields) {
            let (found, expected) = (f64::from(byte) / 255.0, (value(field) / scale).min(1.0));
            assert!((found - expected).abs() < 0.501 / 255.0, "{found} is not {expected}");
        }
        // in single precision
        let peak = fields.iter().map(value).fold(0.0, f64::max);
        let told = quantity["peak"].as_f64().ok_or("no peak")?;
        assert!((told / peak - 1.0).abs() < 1e-6, "{told} is not {peak}");
    }
    Ok(())
}

/// Long runs are thinned evenly, to their first and last sample.
#[test]
fn files_stay_small() -> Outcome {
    let scene = square_jump(10)?;
    let jump = page(&scene.simulate(&Settings::default(), &Sampling::every(0.005))?, "")?;
    let size = fs::metadata(&jump.path)?.len();
    assert!(size < 500_000, "{size} bytes for 301 samples of 100 nodes");
    assert_eq!(data(&jump)?["times"].as_array().map(Vec::len), Some(301));

    let long = beam_jump()?.simulate(&Settings::default(), &Sampling::every(5e-4))?;
    let times: Vec<f64> = serde_json::from_value(data(&page(&long, "")?)?["times"].take())?;
    assert_eq!((times.len(), times[0], times[799]), (800, 0.0, 0.6));
    let widest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    // each or every second of 1201 samples
    assert!(widest < 2.01 * 5e-4, "{widest} s");
    Ok(())
}
