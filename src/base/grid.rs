//! Which of many points lie in a box.

/// Points, sorted into boxes of equal size, about as many boxes as points.
pub(crate) struct Grid<'a> {
    points: &'a [[f64; 3]],
    least: [f64; 3],
    step: f64,
    counts: [usize; 3],
    /// The points of box k are `sorted[starts[k]..starts[k + 1]]`.
    starts: Vec<usize>,
    sorted: Vec<usize>,
}

impl<'a> Grid<'a> {
    pub(crate) fn new(points: &'a [[f64; 3]]) -> Self {
        let along = |axis: usize| points.iter().map(move |point| point[axis]);
        let least = [0, 1, 2].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
        let most = [0, 1, 2].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
        let extent: [f64; 3] = std::array::from_fn(|axis| most[axis] - least[axis]);
        // an extent smaller than a box is not divided
        let mut axes = vec![0, 1, 2];
        let step = loop {
            let volume: f64 = axes.iter().map(|&axis| extent[axis]).product();
            let step = (volume / points.len() as f64).powf(1.0 / axes.len() as f64);
            let thin = axes.iter().position(|&axis| extent[axis] <= step);
            match thin.filter(|_| axes.len() > 1) {
                Some(at) => axes.remove(at),
                None => break step.max(f64::MIN_POSITIVE),
            };
        };
        let mut counts = [1; 3];
        axes.iter().for_each(|&axis| counts[axis] = (extent[axis] / step) as usize + 1);
        let boxes = counts.iter().product();
        let (starts, sorted) = (vec![0; boxes + 1], vec![0; points.len()]);
        let mut grid = Self { points, least, step, counts, starts, sorted };
        let places: Vec<usize> =
            points.iter().map(|point| grid.place(grid.numbers(point))).collect();
        places.iter().for_each(|place| grid.starts[place + 1] += 1);
        (0..boxes).for_each(|place| grid.starts[place + 1] += grid.starts[place]);
        let mut next = grid.starts.clone();
        for (point, place) in places.into_iter().enumerate() {
            grid.sorted[next[place]] = point;
            next[place] += 1;
        }
        grid
    }

    /// Numbers, axis by axis, of the box that a point lies in, or of the one nearest to it.
    fn numbers(&self, point: &[f64; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| {
            // negative numbers become 0
            let number = (point[axis] - self.least[axis]) / self.step;
            (number as usize).min(self.counts[axis] - 1)
        })
    }

    fn place(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] + j) * self.counts[0] + i
    }

    /// Calls `see` with each point between the corners `low` and `high`.
    pub(crate) fn each_within(&self, [low, high]: &[[f64; 3]; 2], mut see: impl FnMut(usize)) {
        let ([i, j, k], [to_i, to_j, to_k]) = (self.numbers(low), self.numbers(high));
        for k in k..=to_k {
            for j in j..=to_j {
                let boxes = [self.place([i, j, k]), self.place([to_i, j, k]) + 1];
                for &point in &self.sorted[self.starts[boxes[0]]..self.starts[boxes[1]]] {
                    let x = &self.points[point];
                    if (0..3).all(|axis| low[axis] <= x[axis] && x[axis] <= high[axis]) {
                        see(point);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::noise;

    /// Compared with a check of every point: points in a cube, in a plate, on a line and in one place.
    #[test]
    fn points_in_a_box_are_all_of_them() {
        for thin in [[1.0, 1.0, 1.0], [1.0, 1.0, 1e-9], [1.0, 0.0, 0.0], [0.0; 3]] {
            let numbers = noise(900, 1);
            let points: Vec<[f64; 3]> = numbers
                .chunks_exact(3)
                .map(|x| std::array::from_fn(|axis| thin[axis] * x[axis]))
                .collect();
            let grid = Grid::new(&points);
            let mut count = 0;
            for corner in noise(60, 2).chunks_exact(3) {
                let low: [f64; 3] = std::array::from_fn(|axis| thin[axis] * corner[axis]);
                let high: [f64; 3] = std::array::from_fn(|axis| low[axis] + 0.7 * thin[axis]);
                let is_within = |x: &[f64; 3]| (0..3).all(|i| low[i] <= x[i] && x[i] <= high[i]);
                let all: Vec<usize> =
                    (0..points.len()).filter(|&k| is_within(&points[k])).collect();
                let mut seen = Vec::new();
                grid.each_within(&[low, high], |point| seen.push(point));
                seen.sort_unstable();
                count += seen.len();
                assert_eq!(seen, all);
            }
            // at least 99 are found
            assert!(count > 90, "{count}");
        }
    }
}
