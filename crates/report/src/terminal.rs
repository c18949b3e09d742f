//! Scenes and histories as lines of characters, for a terminal.

use crate::{
    Polyline, Role, Scene,
    scene::{Extent, Point, place, window},
};

/// Character set of a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Characters {
    /// Braille patterns for pictures, and block characters of eight heights for histories.
    #[default]
    Unicode,
    /// ASCII characters only.
    Ascii,
}

/// Maximum number of columns and rows of a picture.
const MOST: [usize; 2] = [72, 16];
/// Number of dots in a cell, horizontally and vertically.
const CELL: [usize; 2] = [2, 4];

/// Draws the outlines of a scene at a frame in at most 72 columns and 16 rows; empty if there is
/// nothing to draw.
///
/// Lines have no trailing blanks, and the first line is not empty.
pub fn terminal_picture(scene: &Scene, frame: usize, characters: Characters) -> Vec<String> {
    if scene.frames.poses.get(frame).is_none() || scene.bodies.is_empty() {
        return Vec::new();
    }
    let mut dots = Dots::of(window(scene, &[frame]));
    for (at, body) in scene.bodies.iter().enumerate() {
        let Some(pose) = scene.frames.pose(frame, at) else { continue };
        for Polyline { points, closed } in &body.outlines {
            let mut points: Vec<Point> = points.iter().map(|p| place(pose, *p)).collect();
            if *closed && body.role != Role::Ground {
                points.extend(points.first().copied());
            }
            points.windows(2).for_each(|ends| dots.line(ends[0], ends[1]));
        }
    }
    dots.write(characters)
}

/// A raster of dots that covers a window of the scene.
struct Dots {
    extent: Extent,
    /// Dots per meter in both directions.
    scale: f64,
    columns: usize,
    rows: usize,
    set: Vec<bool>,
}

impl Dots {
    fn of(extent: Extent) -> Self {
        let most = [(MOST[0] * CELL[0]) as f64, (MOST[1] * CELL[1]) as f64];
        // One dot is lost at the edge, because dots lie on both ends of the window.
        let scale = ((most[0] - 1.0) / extent.width().max(1e-6))
            .min((most[1] - 1.0) / extent.height().max(1e-6));
        let cells = |length: f64, dots: usize, most: usize| {
            let dots = dots as f64;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
            let cells = ((length * scale + 1.0) / dots).ceil().clamp(1.0, most as f64) as usize;
            cells
        };
        let columns = CELL[0] * cells(extent.width(), CELL[0], MOST[0]);
        let rows = CELL[1] * cells(extent.height(), CELL[1], MOST[1]);
        Self { extent, scale, columns, rows, set: vec![false; columns * rows] }
    }

    /// Sets the dots along the part of a line inside the window.
    fn line(&mut self, from: Point, to: Point) {
        let Some([from, to]) = clipped(&self.extent, from, to) else { return };
        let at = |point: Point| {
            let lower = self.extent.lower;
            [(point[0] - lower[0]) * self.scale, (point[1] - lower[1]) * self.scale]
        };
        let (from, to) = (at(from), at(to));
        let longer = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let steps = longer.ceil().max(1.0) as usize;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let [x, z] = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside")]
            let (column, up) = (x.round() as usize, z.round() as usize);
            if column < self.columns && up < self.rows {
                let row = self.rows - 1 - up;
                self.set[row * self.columns + column] = true;
            }
        }
    }

    fn write(&self, characters: Characters) -> Vec<String> {
        let cell = |row: usize, column: usize| {
            let dot = |x: usize, y: usize| self.set[(row + y) * self.columns + column + x];
            match characters {
                Characters::Unicode => braille(dot),
                Characters::Ascii => ascii(dot),
            }
        };
        let line = |row: usize| {
            let cells = (0..self.columns).step_by(CELL[0]).map(|column| cell(row, column));
            cells.collect::<String>().trim_end().to_owned()
        };
        // After a collapse, the empty space above is omitted.
        (0..self.rows).step_by(CELL[1]).map(line).skip_while(String::is_empty).collect()
    }
}

/// Clips a line to a window (Liang and Barsky); `None` if nothing is inside.
fn clipped(extent: &Extent, from: Point, to: Point) -> Option<[Point; 2]> {
    let mut part = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        let run = to[axis] - from[axis];
        let edges = [extent.lower[axis] - from[axis], extent.upper[axis] - from[axis]];
        if run == 0.0 {
            if edges[0] > 0.0 || edges[1] < 0.0 {
                return None;
            }
        } else {
            let shares = edges.map(|edge| edge / run);
            part[0] = part[0].max(shares[0].min(shares[1]));
            part[1] = part[1].min(shares[0].max(shares[1]));
        }
    }
    let at = |share: f64| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
    (part[0] <= part[1]).then(|| part.map(at))
}

/// Returns the character of a cell of eight dots; a space if no dot is set.
fn braille(dot: impl Fn(usize, usize) -> bool) -> char {
    // Dot numbers of the Unicode standard.
    const BITS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];
    let mut code = 0;
    for (x, column) in BITS.iter().enumerate() {
        for (y, bit) in column.iter().enumerate() {
            code |= if dot(x, y) { *bit } else { 0 };
        }
    }
    if code == 0 { ' ' } else { char::from_u32(0x2800 + code).unwrap_or(' ') }
}

/// Returns an ASCII character that resembles the dots of a cell; a space if no dot is set.
fn ascii(dot: impl Fn(usize, usize) -> bool) -> char {
    let count = |rows: [usize; 2]| {
        let dots = rows.iter().flat_map(|y| [dot(0, *y), dot(1, *y)]);
        dots.filter(|set| *set).count()
    };
    match (count([0, 1]), count([2, 3])) {
        (0, 0) => ' ',
        (_, 0) => '\'',
        (0, _) => '.',
        (upper, lower) if upper + lower > 4 => '#',
        _ => ':',
    }
}

/// Draws a history as `columns` characters, each showing the largest value of its interval as a
/// share of `highest`.
///
/// Values that are not finite count as zero; if there are no values, the result is empty.
pub fn sparkline(values: &[f64], highest: f64, columns: usize, characters: Characters) -> String {
    let marks: [char; 8] = match characters {
        Characters::Unicode => ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'],
        Characters::Ascii => ['_', '.', ':', '-', '=', '+', '*', '#'],
    };
    let columns = columns.min(values.len());
    let mark = |column: usize| {
        let stretch =
            &values[column * values.len() / columns..(column + 1) * values.len() / columns];
        let largest = stretch.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
        let share = if highest > 0.0 { (largest / highest).clamp(0.0, 1.0) } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 7")]
        let level = (share * 7.0).round() as usize;
        marks[level]
    };
    (0..columns).map(mark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frames, SceneBody};

    fn scene(poses: Vec<[f64; 3]>) -> Scene {
        let line = Polyline::open(vec![[-100.0, 0.0], [100.0, 0.0]]);
        let mut bodies = vec![SceneBody::new("ground", Role::Ground, vec![line])];
        bodies.extend((1..poses.len()).map(|k| SceneBody::barrel(format!("B{k}"), 0.33)));
        let frames = Frames { times: vec![0.0], poses: vec![poses], forces: vec![] };
        Scene { bodies, frames, ..Scene::default() }
    }

    #[test]
    fn a_barrel_on_the_ground_is_round() {
        let lines =
            terminal_picture(&scene(vec![[0.0; 3], [0.0, 0.33, 0.0]]), 0, Characters::Unicode);
        assert_eq!(lines.len(), 16);
        assert!(lines.iter().all(|line| line.chars().count() <= 72));
        // Mirroring changes the characters, but not their number on either side.
        let widths: Vec<usize> = lines.iter().map(|line| line.trim().chars().count()).collect();
        let widest = *widths[..15].iter().max().unwrap();
        assert!((28..=33).contains(&widest), "{lines:#?}"); // measured 31
        assert!(lines[15].chars().count() > widest, "the ground goes on");
    }

    #[test]
    fn what_lies_far_away_leaves_the_picture_alone() {
        let near = terminal_picture(&scene(vec![[0.0; 3], [0.0, 0.33, 0.0]]), 0, Characters::Ascii);
        let mut far = scene(vec![[0.0; 3], [0.0, 0.33, 0.0]]);
        far.frames.poses.push(vec![[0.0; 3], [0.0, 0.33, 0.0]]);
        assert_eq!(terminal_picture(&far, 0, Characters::Ascii), near);
        assert!(near.concat().is_ascii());
        assert!(terminal_picture(&far, 7, Characters::Ascii).is_empty());
        assert!(terminal_picture(&Scene::default(), 0, Characters::Ascii).is_empty());
    }

    #[test]
    fn a_sparkline_keeps_every_peak() {
        let mut values = vec![0.0; 1000];
        values[613] = 2.0;
        let line = sparkline(&values, 2.0, 20, Characters::Unicode);
        assert_eq!(line, "▁▁▁▁▁▁▁▁▁▁▁▁█▁▁▁▁▁▁▁");
        assert_eq!(sparkline(&[0.0, 1.0, f64::NAN], 2.0, 20, Characters::Ascii), "_=_");
        assert_eq!(sparkline(&[], 2.0, 20, Characters::Ascii), "");
        assert_eq!(sparkline(&[1.0], 0.0, 20, Characters::Ascii), "_");
    }
}
