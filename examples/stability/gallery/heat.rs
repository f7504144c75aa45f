//! Heat maps: a table whose cells are coloured by their values.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Outcome;

/// One cell.
pub struct Cell {
    /// A positive number that gives its colour, on a logarithmic scale.
    pub value: f64,
    /// What stands in it.
    pub lines: [String; 2],
    /// Whether it gets a red frame.
    pub is_bad: bool,
}

/// Left and top of the cells, width and height of one (px).
const LEFT: i32 = 110;
const TOP: i32 = 52;
const WIDTH: i32 = 128;
const HEIGHT: i32 = 44;
const INK: RGBColor = RGBColor(34, 34, 34);
const RED: RGBColor = RGBColor(200, 30, 30);

/// Draws `cells`, row by row, and the names of columns and rows beside them.
pub fn heat_map(
    title: &str,
    [x, y]: [&str; 2],
    columns: &[String],
    rows: &[String],
    cells: &[Vec<Cell>],
) -> Outcome<String> {
    let size = [LEFT + WIDTH * columns.len() as i32 + 20, TOP + HEIGHT * rows.len() as i32 + 52];
    let values = || cells.iter().flatten().map(|cell| cell.value.log10());
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    let mut svg = String::new();
    {
        let size = (size[0] as u32, size[1] as u32);
        let page = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        page.fill(&WHITE)?;
        let font = |pixels: f64| ("Helvetica Neue, Helvetica, Arial, sans-serif", 1.24 * pixels);
        let centred = |pixels: f64| {
            font(pixels).into_font().color(&INK).pos(Pos::new(HPos::Center, VPos::Center))
        };
        let bold = font(15.0).into_font().style(FontStyle::Bold).color(&INK);
        page.draw_text(title, &bold, (20, 14))?;
        for (j, line) in cells.iter().enumerate() {
            for (i, cell) in line.iter().enumerate() {
                let (left, top) = (LEFT + WIDTH * i as i32, TOP + HEIGHT * j as i32);
                let corners = [(left + 2, top + 2), (left + WIDTH - 2, top + HEIGHT - 2)];
                let part = (cell.value.log10() - low) / (high - low).max(1e-9);
                // from pale to a blue on which black is still read
                let mix = |from: f64, to: f64| (from + part * (to - from)) as u8;
                let colour = RGBColor(mix(247.0, 66.0), mix(251.0, 146.0), mix(255.0, 198.0));
                page.draw(&Rectangle::new(corners, colour.filled()))?;
                if cell.is_bad {
                    page.draw(&Rectangle::new(corners, RED.stroke_width(3)))?;
                }
                let middle = (left + WIDTH / 2, top + HEIGHT / 2);
                page.draw_text(&cell.lines[0], &centred(13.0), (middle.0, middle.1 - 8))?;
                page.draw_text(&cell.lines[1], &centred(11.0), (middle.0, middle.1 + 10))?;
            }
        }
        for (i, name) in columns.iter().enumerate() {
            let middle = LEFT + WIDTH * i as i32 + WIDTH / 2;
            page.draw_text(name, &centred(12.0), (middle, TOP + HEIGHT * rows.len() as i32 + 14))?;
        }
        for (j, name) in rows.iter().enumerate() {
            page.draw_text(
                name,
                &centred(12.0),
                (LEFT - 34, TOP + HEIGHT * j as i32 + HEIGHT / 2),
            )?;
        }
        let middle = LEFT + WIDTH * columns.len() as i32 / 2;
        page.draw_text(x, &centred(13.0), (middle, TOP + HEIGHT * rows.len() as i32 + 36))?;
        let upright = centred(13.0).transform(FontTransform::Rotate270);
        page.draw_text(y, &upright, (20, TOP + HEIGHT * rows.len() as i32 / 2))?;
        page.present()?;
    }
    Ok(svg)
}
