//! A motion while it is computed, for pages that draw it with the scripts of the animation.

use serde_json::{Value, json};

use super::colours::{Fields, Quantity};
use super::geometry::Geometry;
use super::{STYLE, acting, data, filled, lines, pack};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::View;
use crate::dynamics::system::Energy;
use crate::elements::mesh::Mesh;
use crate::io::output::acting::Remanence;
use crate::io::output::svg::drawn;
use crate::scene::timeline::{ContactReader, Scene};

/// The scripts that such a page shares with the animation: how it decodes and draws.
const DRAWING: &str = concat!(
    include_str!("page/format.js"),
    include_str!("page/paint.js"),
    include_str!("page/view.js"),
    include_str!("page/colour.js"),
    include_str!("page/plane.js"),
    include_str!("page/space.js"),
    include_str!("page/needles.js"),
    include_str!("page/arrow.js"),
    include_str!("page/acting.js"),
    include_str!("page/lines.js"),
    include_str!("page/stage.js"),
    include_str!("page/chart.js"),
    include_str!("page/sensors.js"),
    include_str!("page/controls.js"),
);

/// Drawing of a scene.
pub(crate) struct Picture {
    geometry: Geometry,
    quantities: Vec<&'static Quantity>,
    contact: ContactReader,
    remanence: Remanence,
    /// Numbers of the actuators that are drawn.
    actuators: Vec<usize>,
}

impl Picture {
    /// Drawing of `scene`, and all data that do not change.
    ///
    /// # Errors
    /// Springs, constraints or contact of missing objects.
    pub(crate) fn new(scene: &Scene) -> Result<(Self, Value), Error> {
        let mesh = scene.body().mesh();
        let points = data::point_masses(mesh);
        let drawn = scene.actuator_lines()?;
        let all = drawn.iter().flat_map(|(_, line)| line);
        let geometry = Geometry::new(scene.body(), all, &points);
        let quantities = Quantity::of(scene);
        let told = quantities.iter().map(|quantity| quantity.to_json());
        let springs = drawn.iter().map(|line| data::line_to_json(scene, line, &geometry));
        let remanence = Remanence::of(scene)?;
        let start = [scene.initial_displacements(), &scene.initial_velocities()?];
        let fixed = json!({
            "axes": axes(mesh),
            "phases": data::phases(scene, &geometry)?,
            "body": geometry.to_json(),
            "quantities": told.collect::<Vec<_>>(),
            "energies": data::ENERGIES,
            "absent": absent(scene),
            "needles": pack::singles(lines::needles_at(scene, scene.first_phase()?, 0.0, start)),
            "everywhere": acting::names(scene),
            "arrows": remanence.count(),
            "obstacles": data::obstacles(scene),
            "springs": springs.collect::<Vec<_>>(),
            "points": geometry.places(&points),
        });
        let contact = ContactReader::new(scene)?;
        let actuators = drawn.into_iter().map(|(number, _)| number).collect();
        Ok((Self { geometry, quantities, contact, remanence, actuators }, fixed))
    }

    /// The page with its own `style`, and with its own scripts before and after those that draw.
    pub(crate) fn page(
        page: &str,
        style: &str,
        [before, after]: [&str; 2],
        data: &Value,
    ) -> String {
        let script = [include_str!("page/decode.js"), before, DRAWING, after].concat();
        filled(page, &[STYLE, style].concat(), &script, data)
    }

    /// The node (from 0) that is drawn at a place among the drawn ones.
    pub(crate) fn node(&self, place: usize) -> Option<usize> {
        self.geometry.nodes.get(place).copied()
    }

    /// Positions of the drawn nodes and anchors for displacements `u` (m).
    pub(crate) fn places(&self, mesh: &Mesh, u: &[f64]) -> Value {
        let d = mesh.dimension();
        let mut numbers = Vec::with_capacity(self.geometry.count() * axes(mesh));
        for &node in &self.geometry.nodes {
            let moved = mesh.position(node).iter().zip(&u[node * d..]).map(|(x, u)| x + u);
            let moved: Vec<f64> = moved.collect();
            match d {
                1 | 2 => numbers.extend(drawn(&moved)),
                _ => numbers.extend(moved),
            }
        }
        numbers.extend(self.geometry.anchors(d, u));
        pack::singles(numbers)
    }

    /// The ends of all lines along which surfaces of liquids meet walls (m), one after the other.
    pub(crate) fn lines(&self, view: &View) -> Value {
        view.with_states(|scene, phase, motion, amounts| {
            lines::at(scene, phase, view.time(), motion, amounts)
        })
    }

    /// Places (m) and directions of the needles of devices, one after the other.
    pub(crate) fn needles(&self, view: &View) -> Value {
        view.with_states(|scene, phase, motion, _| {
            pack::singles(lines::needles_at(scene, phase, view.time(), motion))
        })
    }

    /// The inputs of the actuators that are drawn.
    pub(crate) fn drives(&self, view: &View) -> Vec<f64> {
        view.with_states(|scene, phase, _, amounts| {
            let own = self.actuators.iter().map(|&number| &*scene.actuators()[number]);
            own.map(|own| scene.drive_at(own, phase, view.time(), amounts)[0]).collect()
        })
    }

    /// Gravity (m/s^2) and the magnetic field (T).
    pub(crate) fn everywhere(view: &View) -> Value {
        let t = view.time();
        json!(view.with_states(|scene, phase, _, _| acting::at(scene, phase, t)))
    }

    /// The middle of each arrow on magnets, and the arrow (m), one after the other.
    pub(crate) fn remanence(&self, view: &View) -> Value {
        pack::singles(acting::arrows_at(&self.remanence, view.body().mesh(), view.displacements()))
    }

    /// The values of a quantity in each face, and the end of their scale; `None` for a number that no quantity has, and
    /// where contact is undefined.
    pub(crate) fn colours(&self, view: &View, quantity: usize) -> Option<Value> {
        let shown = self.quantities.get(quantity)?;
        let contacts = match shown.is_of_contact() {
            true => view.nodal_contacts(&self.contact)?,
            false => Vec::new(),
        };
        let (body, cells) = (view.body(), view.cell_fields());
        let fields = Fields { body, cells, contacts };
        let values: Vec<f32> = shown.values(&fields, &self.geometry).collect();
        let (values, scale, _) = shown.packed(&values);
        Some(json!({ "quantity": quantity, "scale": scale, "values": values }))
    }

    /// Energies (J), in the order of their names.
    pub(crate) fn energies(energy: &Energy) -> [f64; 8] {
        data::energy_values(energy)
    }
}

/// The energies that a scene does not have, by name.
fn absent(scene: &Scene) -> Vec<&'static str> {
    let has = [
        ("gravity", scene.phases().iter().any(|phase| scene.gravity_in(phase).is_some())),
        ("contact", !scene.obstacles().is_empty() || !scene.touches().is_empty()),
        ("springs", scene.actuators().iter().any(|own| own.kind().list == "springs")),
    ];
    has.iter().filter(|(_, has)| !has).map(|(name, _)| *name).collect()
}

/// Coordinates of a drawn node: a body in one dimension is drawn in the plane.
fn axes(mesh: &Mesh) -> usize {
    mesh.dimension().max(2)
}
