//! Convex polygons in the plan of a room, and free paths among them.

use std::collections::VecDeque;

use barrelstack_dynamics::math;

/// A point in the plan (m).
pub type Point = [f64; 2];

/// A convex polygon, counterclockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Convex(Vec<Point>);

fn cross(o: Point, a: Point, b: Point) -> f64 {
    (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
}

impl Convex {
    /// Returns the convex hull of points (Andrew 1979).
    pub fn hull(mut points: Vec<Point>) -> Self {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        points.dedup();
        if points.len() < 3 {
            return Self(points);
        }
        let mut hull: Vec<Point> = Vec::new();
        let turn = |points: &mut dyn Iterator<Item = Point>, hull: &mut Vec<Point>| {
            let first = hull.len();
            for point in points {
                while hull.len() >= first + 2
                    && cross(hull[hull.len() - 2], hull[hull.len() - 1], point) <= 0.0
                {
                    hull.pop();
                }
                hull.push(point);
            }
            // The last point of each half of the hull is also the first point of the other half.
            hull.pop();
        };
        turn(&mut points.iter().copied(), &mut hull);
        turn(&mut points.iter().rev().copied(), &mut hull);
        Self(hull)
    }

    /// Returns the axis-aligned rectangle with two given opposite corners.
    pub fn rectangle(a: Point, b: Point) -> Self {
        Self::hull(vec![a, [b[0], a[1]], b, [a[0], b[1]]])
    }

    /// Returns the corners.
    pub fn corners(&self) -> &[Point] {
        &self.0
    }

    /// Returns the smallest and largest coordinates.
    pub fn bounds(&self) -> [Point; 2] {
        let each = |start: f64, fold: fn(f64, f64) -> f64| {
            [0, 1].map(|axis| self.0.iter().map(|p| p[axis]).fold(start, fold))
        };
        [each(f64::INFINITY, f64::min), each(f64::NEG_INFINITY, f64::max)]
    }

    fn edges(&self) -> impl Iterator<Item = (Point, Point)> + '_ {
        self.0.iter().copied().zip(self.0.iter().copied().cycle().skip(1))
    }

    /// Returns the signed distance (m) of a point from the polygon. It is negative inside, where its magnitude is the
    /// distance to the nearest edge.
    pub fn distance(&self, point: Point) -> f64 {
        let mut inside = f64::NEG_INFINITY;
        let mut nearest = f64::INFINITY;
        for (a, b) in self.edges() {
            let edge = [b[0] - a[0], b[1] - a[1]];
            let length = (edge[0] * edge[0] + edge[1] * edge[1]).sqrt();
            if length == 0.0 {
                continue;
            }
            inside = inside.max(-cross(a, b, point) / length);
            let along =
                ((point[0] - a[0]) * edge[0] + (point[1] - a[1]) * edge[1]) / (length * length);
            let along = along.clamp(0.0, 1.0);
            let off = [point[0] - a[0] - along * edge[0], point[1] - a[1] - along * edge[1]];
            nearest = nearest.min((off[0] * off[0] + off[1] * off[1]).sqrt());
        }
        if inside <= 0.0 { inside } else { nearest }
    }

    /// Returns the clear distance (m) to another polygon. It is negative if the polygons overlap; its magnitude is then
    /// the length of the shortest shift that separates them.
    pub fn apart(&self, other: &Self) -> f64 {
        let mut separation = f64::NEG_INFINITY;
        for (one, two) in [(self, other), (other, self)] {
            for (a, b) in one.edges() {
                let length = ((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])).sqrt();
                if length > 0.0 {
                    let least = two.0.iter().map(|p| -cross(a, b, *p) / length);
                    separation = separation.max(least.fold(f64::INFINITY, f64::min));
                }
            }
        }
        if separation <= 0.0 {
            return separation;
        }
        let corners = |of: &Self, to: &Self| {
            of.0.iter().map(|p| to.distance(*p)).fold(f64::INFINITY, f64::min)
        };
        corners(self, other).min(corners(other, self))
    }

    /// Returns the polygon turned counterclockwise by an angle (rad) about the origin, and then moved.
    #[must_use]
    pub fn placed(&self, at: Point, azimuth: f64) -> Self {
        let (sin, cos) = math::sin_cos(azimuth);
        let turn = |[x, y]: &Point| [at[0] + cos * x - sin * y, at[1] + sin * x + cos * y];
        Self(self.0.iter().map(turn).collect())
    }
}

/// Width (m) that a person needs to pass.
pub const PASSAGE: f64 = 0.6;

/// Largest number of cells of a grid.
const MOST_CELLS: f64 = 4e6;

/// A grid of free and taken cells over a rectangle.
#[derive(Clone, Debug)]
pub struct Grid {
    lower: Point,
    /// Side (m) of a cell.
    pub cell: f64,
    /// Number of cells along x.
    pub columns: usize,
    /// Number of cells along y.
    pub rows: usize,
    taken: Vec<bool>,
}

impl Grid {
    /// Creates a grid of free cells with a side of `cell` (m), or larger cells if there would be too many.
    pub fn new(lower: Point, upper: Point, cell: f64) -> Self {
        let [length, width] = [0, 1].map(|axis| (upper[axis] - lower[axis]).max(0.0));
        let cell = cell.max((length * width / MOST_CELLS).sqrt());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let [columns, rows] =
            [length, width].map(|side| ((side / cell - 1e-9).ceil() as usize).max(1));
        Self { lower, cell, columns, rows, taken: vec![false; columns * rows] }
    }

    /// Returns the center of a cell by its index.
    pub fn middle(&self, at: usize) -> Point {
        let [column, row] = [at % self.columns, at / self.columns];
        [
            self.lower[0] + (column as f64 + 0.5) * self.cell,
            self.lower[1] + (row as f64 + 0.5) * self.cell,
        ]
    }

    /// Marks as taken all cells whose center is less than `distance` (m) away from a polygon.
    pub fn take(&mut self, polygon: &Convex, distance: f64) {
        let [lower, upper] = polygon.bounds();
        if polygon.corners().len() < 3 {
            return;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let cell = |value: f64, axis: usize, most: usize| {
            ((value - self.lower[axis]) / self.cell).clamp(0.0, most as f64) as usize
        };
        let columns = cell(lower[0] - distance, 0, self.columns)
            ..(cell(upper[0] + distance, 0, self.columns) + 1).min(self.columns);
        let rows = cell(lower[1] - distance, 1, self.rows)
            ..(cell(upper[1] + distance, 1, self.rows) + 1).min(self.rows);
        for row in rows {
            for column in columns.clone() {
                let at = row * self.columns + column;
                if !self.taken[at] && polygon.distance(self.middle(at)) < distance {
                    self.taken[at] = true;
                }
            }
        }
    }

    /// Marks as taken all cells whose center satisfies a condition.
    pub fn take_where(&mut self, is_taken: impl Fn(Point) -> bool) {
        for at in 0..self.taken.len() {
            self.taken[at] |= is_taken(self.middle(at));
        }
    }

    /// Returns the share of cells that are taken.
    pub fn share(&self) -> f64 {
        self.taken.iter().filter(|taken| **taken).count() as f64 / self.taken.len() as f64
    }

    /// Returns for each cell whether it is taken, row by row.
    pub fn cells(&self) -> &[bool] {
        &self.taken
    }

    /// `true` if a path of free cells leads from a cell that satisfies `starts` to a cell that satisfies `ends`.
    pub fn leads(&self, starts: impl Fn(Point) -> bool, ends: impl Fn(Point) -> bool) -> bool {
        let mut visited = self.taken.clone();
        let mut queue = VecDeque::new();
        for (at, visited) in visited.iter_mut().enumerate() {
            if !*visited && starts(self.middle(at)) {
                *visited = true;
                queue.push_back(at);
            }
        }
        while let Some(at) = queue.pop_front() {
            if ends(self.middle(at)) {
                return true;
            }
            let (column, row) = (at % self.columns, at / self.columns);
            let near = [
                (column > 0).then(|| at - 1),
                (column + 1 < self.columns).then(|| at + 1),
                (row > 0).then(|| at - self.columns),
                (row + 1 < self.rows).then(|| at + self.columns),
            ];
            for next in near.into_iter().flatten() {
                if !visited[next] {
                    visited[next] = true;
                    queue.push_back(next);
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_and_distances_are_those_of_the_plane() {
        let square = Convex::hull(vec![[0.0, 0.0], [1.0, 1.0], [0.5, 0.5], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(square.corners(), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(
            [[0.5, 0.5], [2.0, 0.5], [4.0, 5.0]].map(|p| square.distance(p)),
            [-0.5, 1.0, 5.0]
        );
        let beside = Convex::rectangle([1.3, 0.2], [2.0, 0.8]);
        assert!((square.apart(&beside) - 0.3).abs() < 1e-12);
        let over = Convex::rectangle([0.9, 0.2], [2.0, 0.8]);
        assert!((square.apart(&over) + 0.1).abs() < 1e-12);
        // In the first case, two corners are closest; in the second, an edge and a corner of a square turned by 45°.
        let corner = Convex::rectangle([4.0, 5.0], [6.0, 6.0]);
        assert_eq!(square.apart(&corner), 5.0);
        let turned = Convex::rectangle([-0.5, -0.5], [0.5, 0.5])
            .placed([2.0, 0.5], std::f64::consts::FRAC_PI_4);
        assert!((square.apart(&turned) - (1.0 - 0.5_f64.sqrt())).abs() < 1e-12);
    }

    #[test]
    fn a_path_needs_its_width() {
        let blocked = |gap: f64| {
            let mut grid = Grid::new([0.0, 0.0], [6.0, 2.0], 0.05);
            grid.take(&Convex::rectangle([2.0, 0.0], [3.0, 2.0 - gap]), 0.5 * PASSAGE);
            grid.take_where(|[_, y]| !(0.5 * PASSAGE..=2.0 - 0.5 * PASSAGE).contains(&y));
            !grid.leads(|[x, _]| x < 0.1, |[x, _]| x > 5.9)
        };
        assert!(blocked(0.5) && blocked(0.59) && !blocked(0.7) && !blocked(1.2));
    }

    #[test]
    fn a_share_of_cells_is_the_share_of_the_area() {
        let mut grid = Grid::new([1.0, 1.0], [3.0, 2.0], 0.05);
        grid.take(&Convex::rectangle([0.0, 0.0], [2.0, 1.5]), 0.0);
        assert!((grid.share() - 0.25).abs() < 1e-12, "{}", grid.share());
        assert_eq!((grid.columns, grid.rows), (40, 20));
    }
}
