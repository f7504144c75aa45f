//! A quantity over the one key that varies.

use svg::node::element::Group;

use super::scale::Variable;
use super::{FAILED, GREY, PALE, Plot, field};
use crate::io::output::{COLOURS, Field, dots, stroke};

impl Plot<'_> {
    pub(super) fn over_one(&self, quantity: &Variable) -> Group {
        let Some(key) = self.keys.first() else { return Group::new() };
        let field = Field {
            edges: field(),
            x: key.axis(0.04),
            y: quantity.axis(0.06),
            colours: [GREY, PALE, PALE],
        };
        let mut points: Vec<(f64, f64)> =
            key.values.iter().copied().zip(quantity.values.iter().copied()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut panel = Group::new().add(field.grid()).add(field.outline());
        if key.words.is_empty() {
            panel = panel.add(field.line(points.into_iter()).draw(COLOURS[0], 1.4, 0.0, "none"));
        }
        for (at, row) in self.rows.iter().enumerate() {
            let (x, y) = (key.values[at], quantity.values[at]);
            let mark = self.mark(*row);
            panel = panel.add(match y.is_finite() {
                true => dots(mark, [field.place(x, y)], 3.2, COLOURS[0]),
                // a failed run stands on the floor
                false => {
                    let [x, _] = field.place(x, 0.0);
                    let bottom = field.edges[3];
                    mark.add(stroke([x, bottom - 9.0], [x, bottom], FAILED).set("stroke-width", 4))
                }
            });
        }
        let (along, up) = (key.label(&field.x), quantity.label(&field.y));
        panel.add(field.floor(&along)).add(field.side(&up, 58.0))
    }
}
