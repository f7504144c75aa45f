//! Quantities that colours can represent.

use serde_json::{Value, json};

use super::geometry::Geometry;
use super::pack;
use crate::elements::body::{Body, CellField, Strain};
use crate::scene::forces::{ContactStatus, NodalContact};
use crate::scene::timeline::Scene;

/// Part of the values of cells that the scale of colours covers.
const PERCENTILE: f64 = 0.99;

/// A quantity of the faces that are drawn.
pub(super) struct Quantity {
    name: &'static str,
    unit: &'static str,
    /// Whether its scale of colours is symmetric about 0, instead of beginning at 0.
    signed: bool,
    of: Of,
}

/// Its source.
enum Of {
    /// The cell of a face and its measure of strain.
    Cell(fn(&CellField, Strain) -> f64),
    /// As that, for Green's strain.
    Stretch(fn(&CellField, Strain) -> f64),
    /// Contact at the nodes of a face, of which the largest value counts.
    Contact(fn(&NodalContact) -> f64),
    /// The same with what sticks, whose scale has all numbers that there are.
    ContactStatus,
}

/// The fields from which values are taken; none of contact where no quantity needs them.
pub(super) struct Fields<'a> {
    pub(super) body: &'a Body,
    pub(super) cells: Vec<CellField>,
    pub(super) contacts: Vec<NodalContact>,
}

static QUANTITIES: [Quantity; 7] = [
    Quantity {
        name: "Von Mises stress",
        unit: "Pa",
        signed: false,
        of: Of::Cell(|field, _| field.von_mises()),
    },
    Quantity {
        name: "Strain energy density",
        unit: "J/m\u{b3}",
        signed: false,
        of: Of::Cell(|field, _| field.energy_density),
    },
    Quantity {
        name: "Pressure",
        unit: "Pa",
        signed: true,
        of: Of::Cell(|field, _| field.pressure()),
    },
    Quantity {
        name: "Largest stretch, above 1",
        unit: "1",
        signed: false,
        of: Of::Stretch(|field, strain| (field.stretches(strain)[0] - 1.0).max(0.0)),
    },
    Quantity {
        name: "Least stretch, below 1",
        unit: "1",
        signed: false,
        of: Of::Stretch(|field, strain| (1.0 - field.stretches(strain)[2]).max(0.0)),
    },
    Quantity {
        name: "Contact pressure",
        unit: "Pa",
        signed: false,
        of: Of::Contact(NodalContact::pressure),
    },
    Quantity {
        name: "Contact, 1 sticks, 2 slides",
        unit: "1",
        signed: false,
        of: Of::ContactStatus,
    },
];

impl Quantity {
    /// Those that are shown of a scene: stretches unless all strains are Cauchy's, contact if there can be any.
    pub(super) fn of(scene: &Scene) -> Vec<&'static Self> {
        let has_stretches = scene.body().parts().any(|part| part.body.strain() != Strain::Cauchy);
        let has_contact = Self::has_contact(scene);
        let is_shown = |quantity: &&Self| match quantity.of {
            Of::Cell(_) => true,
            Of::Stretch(_) => has_stretches,
            Of::Contact(_) | Of::ContactStatus => has_contact,
        };
        QUANTITIES.iter().filter(is_shown).collect()
    }

    /// Whether quantities of contact are among those of a scene.
    pub(super) fn has_contact(scene: &Scene) -> bool {
        !scene.obstacles().is_empty() || !scene.touches().is_empty()
    }

    /// Whether it needs the fields of contact.
    #[cfg(feature = "play")]
    pub(super) fn is_of_contact(&self) -> bool {
        matches!(self.of, Of::Contact(_) | Of::ContactStatus)
    }

    /// Its values in the drawn faces.
    pub(super) fn values<'a>(
        &'a self,
        fields: &'a Fields,
        geometry: &'a Geometry,
    ) -> impl Iterator<Item = f32> + 'a {
        let largest = |face: usize, value: fn(&NodalContact) -> f64| {
            let nodes = geometry.nodes_of(face);
            nodes.map(|node| value(&fields.contacts[node])).fold(0.0, f64::max)
        };
        let value = move |face: usize| match self.of {
            Of::Cell(value) | Of::Stretch(value) => {
                let cell = geometry.cells[face];
                value(&fields.cells[cell], fields.body.strain_of(cell))
            }
            Of::Contact(value) => largest(face, value),
            Of::ContactStatus => largest(face, |nodal| nodal.status().number().into()),
        };
        (0..geometry.cells.len()).map(move |face| value(face) as f32)
    }

    /// Metadata of the quantity for a page: name, unit and whether it is signed.
    pub(super) fn to_json(&self) -> Value {
        json!({ "name": self.name, "unit": self.unit, "signed": self.signed })
    }

    /// `values` for a page, the end of their scale, and the largest absolute value.
    pub(super) fn packed(&self, values: &[f32]) -> (Value, f64, f64) {
        let (mut scale, peak) = match self.of {
            // most faces never touch anything
            Of::Contact(_) => scale(values.iter().copied().filter(|value| *value != 0.0)),
            _ => scale(values.iter().copied()),
        };
        if let Of::ContactStatus = self.of {
            scale = ContactStatus::Sliding.number().into();
        }
        let from = if self.signed { -scale } else { 0.0 };
        (pack::values(values, [from, scale]), scale, peak)
    }
}

/// The end of the scale for the absolute values of `values`, a round number, and the largest of them.
fn scale(values: impl Iterator<Item = f32>) -> (f64, f64) {
    let mut values: Vec<f32> = values.map(f32::abs).collect();
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
    use crate::scene::forces::Obstacle;
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
            let scene = Scene::new(both);
            assert_eq!(Quantity::of(&scene).len(), count, "{strains:?}");
            let floor = Obstacle::half_plane([0.0, -1.0], [0.0, 1.0]).stiffness(1.0);
            assert_eq!(Quantity::of(&scene.obstacle(floor)).len(), count + 2, "{strains:?}");
        }
    }
}
