//! What the colours of cells can stand for.

use serde_json::{Value, json};

use super::pack;
use crate::elements::body::{Body, CellField, Strain};

/// Part of the values of cells that the scale of colours covers.
const PERCENTILE: f64 = 0.99;

/// A quantity of cells.
pub(super) struct Quantity {
    name: &'static str,
    unit: &'static str,
    /// Whether its scale of colours is symmetric about 0, instead of beginning at 0.
    signed: bool,
    /// How it is computed, with the cell's measure of strain.
    pub(super) value: fn(&CellField, Strain) -> f64,
}

/// The stretches, which are not shown where all strains are Cauchy's, come last.
static QUANTITIES: [Quantity; 5] = [
    Quantity {
        name: "Von Mises stress",
        unit: "Pa",
        signed: false,
        value: |field, _| field.von_mises(),
    },
    Quantity {
        name: "Strain energy density",
        unit: "J/m\u{b3}",
        signed: false,
        value: |field, _| field.energy_density,
    },
    Quantity { name: "Pressure", unit: "Pa", signed: true, value: |field, _| field.pressure() },
    Quantity {
        name: "Largest stretch, above 1",
        unit: "1",
        signed: false,
        value: |field, strain| (field.stretches(strain)[0] - 1.0).max(0.0),
    },
    Quantity {
        name: "Least stretch, below 1",
        unit: "1",
        signed: false,
        value: |field, strain| (1.0 - field.stretches(strain)[2]).max(0.0),
    },
];

impl Quantity {
    /// Those that are shown of a body, or of several.
    pub(super) fn of(body: &Body) -> &'static [Self] {
        match body.parts().all(|part| part.body.strain() == Strain::Cauchy) {
            true => &QUANTITIES[..3],
            false => &QUANTITIES,
        }
    }

    /// What a page has to know of it in addition to its values.
    pub(super) fn to_json(&self) -> Value {
        json!({ "name": self.name, "unit": self.unit, "signed": self.signed })
    }

    /// `values` for a page, the end of their scale, and the largest absolute value.
    pub(super) fn packed(&self, values: &[f32]) -> (Value, f64, f64) {
        let (scale, peak) = scale(values);
        let from = if self.signed { -scale } else { 0.0 };
        (pack::values(values, [from, scale]), scale, peak)
    }
}

/// The end of the scale for the absolute values of `values`, a round number, and the largest of them.
fn scale(values: &[f32]) -> (f64, f64) {
    let mut values: Vec<f32> = values.iter().map(|value| value.abs()).collect();
    let peak: f64 = values.iter().copied().fold(0.0, f32::max).into();
    let rank = (PERCENTILE * values.len() as f64) as usize;
    let robust = match values.get(rank) {
        Some(_) => f64::from(*values.select_nth_unstable_by(rank, f32::total_cmp).1),
        None => 0.0,
    };
    (round_up(if robust > 0.0 { robust } else { peak }), peak)
}

/// The next larger number with one digit, or two where one is too coarse.
fn round_up(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let unit = 10_f64.powf(x.log10().floor());
    let steps = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    // a number of the list times the unit, but for rounding
    let enough = |step: &f64| step * unit >= x * (1.0 - 1e-9);
    unit * steps.into_iter().find(enough).unwrap_or(10.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::{Cells, Mesh};
    use crate::studies::samples::SQUARE_MATERIAL;

    /// Stretches are shown if any of several bodies has Green's strain, whichever comes first.
    #[test]
    fn quantities_are_those_of_all_bodies() {
        let body = |strain: Strain| {
            let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Triangles).unwrap();
            Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(strain).build().unwrap()
        };
        let (cauchy, green) = (Strain::Cauchy, Strain::Green);
        for (strains, count) in
            [([cauchy, cauchy], 3), ([cauchy, green], 5), ([green, cauchy], 5), ([green, green], 5)]
        {
            let both = Body::join(strains.map(body)).unwrap();
            assert_eq!(Quantity::of(&both).len(), count, "{strains:?}");
        }
    }
}
