//! A line through many points, reduced to the few that a picture needs.

use std::fmt::Write;

/// Points of a page (px), stretch by stretch between gaps.
///
/// Of the points in one column of pixels only the first, the lowest, the highest and the last are kept: the
/// picture looks the same.
#[derive(Debug, Default)]
pub(crate) struct Line {
    stretches: Vec<Vec<[f64; 2]>>,
    column: Option<Column>,
}

/// The points in one column of pixels, by their numbers.
#[derive(Debug)]
struct Column {
    x: i64,
    count: usize,
    first: (usize, [f64; 2]),
    lowest: (usize, [f64; 2]),
    highest: (usize, [f64; 2]),
    last: (usize, [f64; 2]),
}

impl Line {
    /// The line through `points`; what is not finite is a gap.
    pub(crate) fn through(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut line = Self { stretches: vec![Vec::new()], column: None };
        for point in points {
            match point.iter().all(|x| x.is_finite()) {
                true => line.add(point),
                false => line.interrupt(),
            }
        }
        line.interrupt();
        line.stretches.retain(|stretch| !stretch.is_empty());
        line
    }

    fn add(&mut self, point: [f64; 2]) {
        let x = point[0].floor() as i64;
        if let Some(column) = self.column.as_mut().filter(|column| column.x == x) {
            let this = (column.count, point);
            (column.count, column.last) = (column.count + 1, this);
            if point[1] < column.lowest.1[1] {
                column.lowest = this;
            }
            if point[1] > column.highest.1[1] {
                column.highest = this;
            }
            return;
        }
        self.finish_column();
        let this = (0, point);
        self.column =
            Some(Column { x, count: 1, first: this, lowest: this, highest: this, last: this });
    }

    fn finish_column(&mut self) {
        let Some(Column { first, lowest, highest, last, .. }) = self.column.take() else { return };
        let mut kept = [first, lowest, highest, last];
        kept.sort_by_key(|(number, _)| *number);
        let (mut before, stretch) = (None, self.stretches.last_mut());
        let Some(stretch) = stretch else { return };
        for (number, point) in kept {
            if before != Some(number) {
                stretch.push(point);
            }
            before = Some(number);
        }
    }

    fn interrupt(&mut self) {
        self.finish_column();
        self.stretches.push(Vec::new());
    }

    /// The data of the areas between this line and another with the same gaps.
    pub(crate) fn area_to(&self, other: &Self) -> String {
        let mut data = String::new();
        for (one, other) in self.stretches.iter().zip(&other.stretches) {
            for (k, [x, y]) in one.iter().chain(other.iter().rev()).enumerate() {
                // writing to a string does not fail
                let _ = write!(data, "{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' });
            }
            data.push('Z');
        }
        data
    }

    /// The data of a path through the stretches, and the points that stand alone.
    pub(super) fn drawn(&self) -> (String, Vec<[f64; 2]>) {
        let (mut data, mut alone) = (String::new(), Vec::new());
        for stretch in &self.stretches {
            if let [point] = stretch[..] {
                alone.push(point);
                continue;
            }
            for (k, [x, y]) in stretch.iter().enumerate() {
                // writing to a string does not fail
                let _ = write!(data, "{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' });
            }
        }
        (data, alone)
    }
}

#[cfg(test)]
mod tests {
    use super::Line;

    #[test]
    fn gaps_part_a_line_and_lone_points_are_dots() {
        let nan = f64::NAN;
        let points =
            [[0.0, 1.0], [5.0, 2.0], [9.0, nan], [12.0, 3.0], [nan, 1.0], [20.0, 4.0], [30.0, 5.0]];
        let (data, alone) = Line::through(points.into_iter()).drawn();
        assert_eq!(data, "M0.00 1.00L5.00 2.00M20.00 4.00L30.00 5.00");
        assert_eq!(alone, [[12.0, 3.0]]);
        let (data, alone) = Line::through([].into_iter()).drawn();
        assert!(data.is_empty() && alone.is_empty());
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
        let line = Line::through((0..count).map(point));
        let kept: Vec<[f64; 2]> = line.stretches.concat();
        assert!(kept.len() <= 4 * 200, "{}", kept.len());
        assert!(kept.contains(&point(77_777)) && kept.contains(&point(12_345)));
        assert!(kept.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        assert_eq!((kept[0], kept[kept.len() - 1]), (point(0), point(count - 1)));
    }
}
