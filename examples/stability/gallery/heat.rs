//! Heat maps: a table whose cells are coloured by their values.

use svg::Document;
use svg::node::element::{Rectangle, Text};

/// One cell.
pub struct Cell {
    /// A positive number that gives its colour, on a logarithmic scale.
    pub value: f64,
    /// Text of the field, in two lines.
    pub lines: [String; 2],
    /// Whether it gets a red frame.
    pub is_bad: bool,
}

/// Left and top of the cells, width and height of one (px).
const LEFT: f64 = 110.0;
const TOP: f64 = 52.0;
const WIDTH: f64 = 128.0;
const HEIGHT: f64 = 44.0;

/// Draws `cells`, row by row, and the names of columns and rows beside them.
pub fn heat_map(
    title: &str,
    [x, y]: [&str; 2],
    columns: &[String],
    rows: &[String],
    cells: &[Vec<Cell>],
) -> String {
    let [across, down] = [WIDTH * columns.len() as f64, HEIGHT * rows.len() as f64];
    let size = (LEFT + across + 20.0, TOP + down + 52.0);
    let values = || cells.iter().flatten().map(|cell| cell.value.log10());
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    let mut page = Document::new()
        .set("width", size.0)
        .set("height", size.1)
        .set("viewBox", (0, 0, size.0, size.1))
        .set("font-family", "Helvetica Neue, Helvetica, Arial, sans-serif")
        .set("font-size", 12)
        .set("fill", "#222222")
        .add(Rectangle::new().set("width", size.0).set("height", size.1).set("fill", "#ffffff"))
        .add(
            Text::new(title)
                .set("x", 20)
                .set("y", 28)
                .set("font-size", 15)
                .set("font-weight", "bold"),
        );
    for (j, line) in cells.iter().enumerate() {
        for (i, cell) in line.iter().enumerate() {
            let [left, top] = [LEFT + WIDTH * i as f64, TOP + HEIGHT * j as f64];
            let part = (cell.value.log10() - low) / (high - low).max(1e-9);
            // from pale to a blue on which black is still read
            let mix = |from: f64, to: f64| (from + part * (to - from)) as u8;
            let [r, g, b] = [mix(247.0, 66.0), mix(251.0, 146.0), mix(255.0, 198.0)];
            let mut square = Rectangle::new()
                .set("x", left + 2.0)
                .set("y", top + 2.0)
                .set("width", WIDTH - 4.0)
                .set("height", HEIGHT - 4.0)
                .set("fill", format!("rgb({r},{g},{b})"));
            if cell.is_bad {
                square = square.set("stroke", "#c81e1e").set("stroke-width", 3);
            }
            let [middle, centre] = [left + WIDTH / 2.0, top + HEIGHT / 2.0];
            page = page
                .add(square)
                .add(centred(&cell.lines[0], middle, centre - 8.0).set("font-size", 13))
                .add(centred(&cell.lines[1], middle, centre + 10.0).set("font-size", 11));
        }
    }
    for (i, name) in columns.iter().enumerate() {
        page = page.add(centred(name, LEFT + WIDTH * (i as f64 + 0.5), TOP + down + 14.0));
    }
    for (j, name) in rows.iter().enumerate() {
        page = page.add(centred(name, LEFT - 34.0, TOP + HEIGHT * (j as f64 + 0.5)));
    }
    let middle = TOP + down / 2.0;
    let upright = format!("rotate(-90 20 {middle})");
    page.add(centred(x, LEFT + across / 2.0, TOP + down + 36.0).set("font-size", 13))
        .add(centred(y, 20.0, middle).set("font-size", 13).set("transform", upright))
        .to_string()
}

/// A text around the point (x, y).
fn centred(content: &str, x: f64, y: f64) -> Text {
    let text = Text::new(content).set("x", x).set("y", y);
    text.set("text-anchor", "middle").set("dominant-baseline", "central")
}
