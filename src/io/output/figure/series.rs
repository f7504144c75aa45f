//! Lines, areas and marks in a field, and the few points of many that a picture needs.

use std::borrow::Cow;
use std::fmt::Write;

use svg::node::element::{Circle, Group, Path, Title};

use super::{Point, Theme, round};

/// Points joined by a line, around an area, or marked one by one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Series {
    /// Name in the legend; without one it has no line there.
    pub(crate) name: String,
    /// Values along both axes; a value that is not finite is a gap in a line.
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) colour: Cow<'static, str>,
    /// Width of the line (px); 0 draws none.
    pub(crate) width: f64,
    pub(crate) dashes: &'static str,
    /// Whether the points stand around an area, which is filled.
    pub(crate) is_area: bool,
    pub(crate) opacity: f64,
    pub(crate) mark: Option<Mark>,
    /// Number of the row that it shows (`data-row`), for scripts of a page.
    pub(crate) row: Option<usize>,
    /// Text that a browser shows when the pointer is on it.
    pub(crate) tip: Option<String>,
}

/// Sign at each point of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mark {
    /// Data of a closed path around the point; a circle if it is empty.
    pub(crate) shape: &'static str,
    /// Radius of a circle (px).
    pub(crate) radius: f64,
    pub(crate) is_hollow: bool,
}

impl Mark {
    pub(crate) const DOT: Self = Self { shape: "", radius: 3.0, is_hollow: false };
}

impl Series {
    pub(crate) fn line(
        colour: impl Into<Cow<'static, str>>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Self {
            name: String::new(),
            points: points.into_iter().collect(),
            colour: colour.into(),
            width: 1.8,
            dashes: "none",
            is_area: false,
            opacity: 1.0,
            mark: None,
            row: None,
            tip: None,
        }
    }

    pub(crate) fn marks(
        colour: impl Into<Cow<'static, str>>,
        mark: Mark,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Self { width: 0.0, mark: Some(mark), ..Self::line(colour, points) }
    }

    pub(crate) fn area(
        colour: impl Into<Cow<'static, str>>,
        opacity: f64,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        Self { width: 0.0, is_area: true, opacity, ..Self::line(colour, points) }
    }

    /// A group for the series, with its identifier for a page.
    pub(super) fn group(&self) -> Group {
        let class = match (&self.tip, self.is_area) {
            (Some(_), _) => "mark",
            (None, true) => "band",
            (None, false) => "series",
        };
        let group = Group::new().set("class", class);
        let group = match self.row {
            Some(row) => group.set("data-row", row),
            None => group,
        };
        match &self.tip {
            Some(tip) => group.add(Title::new(&tip[..])),
            None => group,
        }
    }

    /// A group with the line or area through some points of the page, and the mark at others.
    pub(super) fn draw(
        &self,
        mut group: Group,
        points: &[Point],
        marked: &[Point],
        theme: &Theme,
    ) -> Group {
        let (mut data, mut alone) = (String::new(), Vec::new());
        for stretch in thinned(points) {
            if let [point] = stretch[..] {
                alone.push(point);
                continue;
            }
            for (k, [x, y]) in stretch.into_iter().enumerate() {
                // writing to a string does not fail
                let _ = write!(data, "{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' });
            }
        }
        let path = Path::new().set("opacity", self.opacity);
        if self.is_area && !data.is_empty() {
            // no line is seen between areas that touch
            let edges = if self.opacity < 1.0 { "auto" } else { "crispEdges" };
            let path = path.set("d", data + "Z").set("fill", &self.colour[..]);
            group = group.add(path.set("shape-rendering", edges));
        } else if self.width > 0.0 && !data.is_empty() {
            let path = path.set("d", data).set("fill", "none").set("stroke", &self.colour[..]);
            let path = path.set("stroke-width", self.width).set("stroke-linejoin", "round");
            group = group.add(path.set("stroke-dasharray", self.dashes));
        }
        let (mark, marked) = match self.mark {
            Some(mark) => (mark, marked),
            None => (Mark { radius: 1.5 * self.width, ..Mark::DOT }, &alone[..]),
        };
        let [fill, edge] = match mark.is_hollow {
            true => [theme.paper, &self.colour],
            false => [&self.colour, theme.paper],
        };
        let width = if mark.is_hollow { 1.6 } else { 1.0 };
        let signs = Group::new().set("fill", fill).set("stroke", edge).set("stroke-width", width);
        let shown = marked.iter().filter(|[x, y]| x.is_finite() && y.is_finite());
        let signs = shown.fold(signs, |signs, [x, y]| match mark.shape {
            "" => {
                let circle = Circle::new().set("cx", round(*x)).set("cy", round(*y));
                signs.add(circle.set("r", mark.radius))
            }
            shape => signs.add(Path::new().set("d", format!("M{x:.2} {y:.2} {shape}"))),
        });
        if marked.is_empty() { group } else { group.add(signs) }
    }
}

/// The finite ones of many points, stretch by stretch between gaps. Of those in one column of pixels the first, the
/// lowest, the highest and the last are kept: the picture looks the same.
fn thinned(points: &[Point]) -> Vec<Vec<Point>> {
    let is_finite = |point: &Point| point.iter().all(|x| x.is_finite());
    let stretches = points.chunk_by(|a, b| is_finite(a) == is_finite(b));
    let stretches = stretches.filter(|stretch| is_finite(&stretch[0]));
    let thin = |stretch: &[Point]| {
        let columns = stretch.chunk_by(|a, b| a[0].floor() == b[0].floor());
        columns.flat_map(outermost).collect()
    };
    stretches.map(thin).collect()
}

/// The first, the lowest, the highest and the last of some points, in their order.
fn outermost(column: &[Point]) -> impl Iterator<Item = Point> {
    let by_height = |a: &usize, b: &usize| column[*a][1].total_cmp(&column[*b][1]);
    let lowest = (0..column.len()).min_by(by_height).unwrap_or(0);
    let highest = (0..column.len()).rev().max_by(by_height).unwrap_or(0);
    let mut kept = vec![0, lowest, highest, column.len() - 1];
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|number| column[number])
}

#[cfg(test)]
mod tests {
    use super::thinned;

    #[test]
    fn gaps_part_a_line() {
        let nan = f64::NAN;
        let points =
            [[0.0, 1.0], [5.0, 2.0], [9.0, nan], [12.0, 3.0], [nan, 1.0], [20.0, 4.0], [30.0, 5.0]];
        assert_eq!(thinned(&points), [&points[..2], &points[3..4], &points[5..]]);
        assert!(thinned(&[]).is_empty());
    }

    /// A hundred thousand points on 200 pixels: peaks of a single point are kept, and few points in all.
    #[test]
    fn peaks_survive() {
        let count = 100_000;
        let point = |k: usize| {
            let peak = if k == 77_777 {
                50.0
            } else if k == 12_345 {
                -60.0
            } else {
                0.0
            };
            [200.0 * k as f64 / count as f64, (k as f64).sin() + peak]
        };
        let points: Vec<_> = (0..count).map(point).collect();
        let kept = thinned(&points).concat();
        assert!(kept.len() <= 4 * 200, "{}", kept.len());
        assert!(kept.contains(&point(77_777)) && kept.contains(&point(12_345)));
        assert!(kept.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        assert_eq!((kept[0], kept[kept.len() - 1]), (point(0), point(count - 1)));
    }
}
