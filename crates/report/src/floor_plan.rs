//! A floor plan: labeled regions viewed from above, over a grid of cells that are shaded by values from 0 to 1.

use std::fmt::Write as _;

use crate::{
    Characters, Language, Point, csv_field,
    drawing::{Anchor, Drawing, Item, Room, text_width},
    number,
};

/// A floor plan.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorPlan {
    /// Width and depth (m) of the floor, whose near left corner is the origin.
    pub size: [f64; 2],
    /// Regions, drawn in this order.
    pub regions: Vec<Region>,
    /// Values for the cells of the floor, drawn as shading under the regions.
    pub heat: Option<Heat>,
    /// Points with their names.
    pub marks: Vec<(Point, String)>,
}

/// A convex region of a floor plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Corners (m), in order around the region, in either direction.
    pub outline: Vec<Point>,
    /// Kind, which determines color and pattern.
    pub kind: RegionKind,
    /// Name, drawn in the region if it fits.
    pub label: String,
}

/// A value from 0 to 1 for each square cell of a floor, such as the fraction of runs in which an object covers the
/// cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat {
    /// Side (m) of a cell. The near left corner of the first cell is at the origin.
    pub cell: f64,
    /// Number of cells in a row, along x.
    pub columns: usize,
    /// Values of the cells, from 0 to 1, row by row from the near edge of the floor.
    pub shares: Vec<f64>,
    /// Name of the shaded quantity in the legend.
    pub label: String,
}

macro_rules! kinds {
    ($($(#[doc = $help:literal])+ $kind:ident $class:literal $letter:literal $word:literal;)*) => {
        /// The kind of a region.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum RegionKind {
            $($(#[doc = $help])+ $kind),*
        }

        impl RegionKind {
            const ALL: &[Self] = &[$(Self::$kind),*];

            fn class(self) -> &'static str {
                match self { $(Self::$kind => concat!("plan ", $class)),* }
            }

            /// Character that fills the region in a terminal that is limited to ASCII characters.
            fn letter(self) -> char {
                match self { $(Self::$kind => $letter),* }
            }

            /// Word for the legend; empty for a kind that is not listed.
            fn word(self) -> &'static str {
                match self { $(Self::$kind => $word),* }
            }
        }
    };
}

kinds! {
    /// A zone that must be kept clear.
    Zone "zone" '.' "aisle";
    /// An opening in the edge of the floor.
    Door "door" 'D' "door";
    /// A solid obstacle, such as a wall or a column.
    Solid "solid" 'X' "wall or column";
    /// An object that stands.
    Stands "stands" '#' "stack";
    /// An object that falls by itself.
    Falls "falls" 'F' "falls by itself";
    /// An object that is knocked over.
    Knocked "knocked" 'K' "is knocked over";
    /// An object that lies on the floor from the start.
    Down "floor" 'O' "had fallen before";
    /// An object in the wrong place.
    Wrong "wrong" '!' "wrongly placed";
}

/// Largest width and height (px) of the floor.
const MOST: [f64; 2] = [740.0, 760.0];
/// Width (px) of the floor on a phone.
const PHONE: f64 = 338.0;
/// Margin (px) around the floor.
const MARGIN: f64 = 10.0;
/// Height (px) of a line of the legend.
const LINE: f64 = 22.0;
/// Number of shades.
const SHADES: usize = 5;
const SHADE: [&str; SHADES] =
    ["plan heat1", "plan heat2", "plan heat3", "plan heat4", "plan heat5"];
/// Maximum number of columns of a plan in a terminal, without the border.
const COLUMNS: f64 = 100.0;

impl FloorPlan {
    pub(crate) fn draw(&self, id: &str, title: &str, room: Room, language: Language) -> Drawing {
        let [length, depth] = self.size.map(|side| side.max(1e-3));
        let scale = (room.of(MOST[0], PHONE) / length).min(MOST[1] / depth);
        let width = room.of(MOST[0], PHONE) + 2.0 * MARGIN;
        let legend = self.legend(width - 2.0 * MARGIN, language);
        let floor = depth * scale;
        let height = floor + 2.0 * MARGIN + LINE * (legend.len() as f64 + 1.0);
        let mut drawing = Drawing::new(width, height, title);
        let left = 0.5 * (width - length * scale);
        let at = |[x, y]: Point| [left + x * scale, MARGIN + floor - y * scale];
        let size = [length * scale, floor];
        drawing.rect("plan floor", at([0.0, depth]), size);
        let mut items = Drawing::new(width, height, "");
        let flat = |kind: RegionKind| matches!(kind, RegionKind::Zone | RegionKind::Door);
        for region in self.regions.iter().filter(|region| flat(region.kind)) {
            draw(&mut items, region, &at);
        }
        self.shades(&mut items, &at, scale);
        for region in self.regions.iter().filter(|region| !flat(region.kind)) {
            draw(&mut items, region, &at);
        }
        for region in &self.regions {
            label(&mut items, region, &at);
        }
        for (point, name) in &self.marks {
            let [x, y] = at(*point);
            items.push(Item::Circle { class: "plan people".into(), center: [x, y], radius: 4.0 });
            let (shift, anchor) =
                if x > 0.8 * width { (-8.0, Anchor::End) } else { (8.0, Anchor::Start) };
            items.text("label strong halo", [x + shift, y + 4.0], anchor, name);
        }
        let lower = [left - MARGIN, 0.0];
        let size = [size[0] + 2.0 * MARGIN, size[1] + 2.0 * MARGIN];
        drawing.push(Item::Clip { id: format!("{id}-floor"), lower, size, items: items.items });
        let mut y = floor + 2.0 * MARGIN + 14.0;
        scale_bar(&mut drawing, [MARGIN, y - 4.0], length, scale);
        for line in &legend {
            y += LINE;
            let mut x = MARGIN;
            for (classes, word) in line {
                for class in classes {
                    drawing.rect(class, [x, y - 10.0], [14.0, 12.0]);
                    x += 15.0;
                }
                drawing.text("label", [x + 4.0, y], Anchor::Start, word);
                x += entry(classes, word) - 15.0 * classes.len() as f64;
            }
        }
        drawing
    }

    /// Draws the cells whose values are not zero, each in the shade of its value.
    fn shades(&self, drawing: &mut Drawing, at: &dyn Fn(Point) -> [f64; 2], scale: f64) {
        let Some(heat) = self.heat.as_ref().filter(|heat| heat.columns > 0) else { return };
        let side = heat.cell * scale;
        for (row, cells) in heat.shares.chunks(heat.columns).enumerate() {
            let mut column = 0;
            while column < cells.len() {
                let Some(shade) = shade(cells[column]) else {
                    column += 1;
                    continue;
                };
                // Neighbors of the same shade are one rectangle.
                let many = cells[column..].iter().take_while(|v| self::shade(**v) == Some(shade));
                let many = many.count();
                let corner = at([column as f64 * heat.cell, (row + 1) as f64 * heat.cell]);
                drawing.rect(SHADE[shade], corner, [many as f64 * side, side]);
                column += many;
            }
        }
    }

    /// Returns the entries of the legend, each with its CSS classes and its text, wrapped into lines of at most `width`
    /// (px).
    fn legend(&self, width: f64, language: Language) -> Vec<Vec<(Vec<&'static str>, String)>> {
        let present = |kind: &&RegionKind| self.regions.iter().any(|region| region.kind == **kind);
        let mut entries: Vec<_> = RegionKind::ALL
            .iter()
            .filter(present)
            .map(|kind| (vec![kind.class()], language.fixed(kind.word()).to_owned()))
            .collect();
        if let Some(heat) = &self.heat {
            let steps = language.fixed("up to 20, 40, 60, 80, 100 %");
            let words = format!("{}: {steps}", heat.label);
            entries.push((SHADE.to_vec(), words));
        }
        let wide = |(classes, word): &(Vec<&str>, String)| entry(classes, word);
        wrapped(entries, width, wide)
    }

    pub(crate) fn to_csv(&self) -> String {
        let mut out = String::from("kind,name,x (m),y (m),share\n");
        let mut row = |kind: &str, name: &str, [x, y]: Point, share: Option<f64>| {
            let [x, y] = [x, y].map(number::csv_number);
            let share = share.map_or(String::new(), number::csv_number);
            // Writing to a String cannot fail.
            let _ = writeln!(out, "{kind},{},{x},{y},{share}", csv_field(name));
        };
        for region in &self.regions {
            for corner in &region.outline {
                row(region.kind.word(), &region.label, *corner, None);
            }
        }
        for (point, name) in &self.marks {
            row("mark", name, *point, None);
        }
        if let Some(heat) = &self.heat {
            for (at, share) in heat.shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
                let (column, line) = (at % heat.columns.max(1), at / heat.columns.max(1));
                let middle = [column, line].map(|cell| (cell as f64 + 0.5) * heat.cell);
                row("cell", "", middle, Some(*share));
            }
        }
        out
    }

    /// Returns the plan as lines of characters with a legend, at most 102 columns wide.
    pub fn lines(&self, characters: Characters) -> Vec<String> {
        let [length, depth] = self.size.map(|side| side.max(1e-3));
        // A character is about twice as high as it is wide.
        let cell = (length / COLUMNS).max(depth / (2.0 * 40.0)).max(0.05);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
        let cells = |side: f64, cell: f64| ((side / cell).ceil() as usize).clamp(1, 200);
        let (columns, rows) = (cells(length, cell), cells(depth, 2.0 * cell));
        let mut grid = vec![vec![' '; columns]; rows];
        for region in &self.regions {
            for (row, line) in grid.iter_mut().enumerate() {
                for (column, letter) in line.iter_mut().enumerate() {
                    let middle = [(column as f64 + 0.5) * cell, (row as f64 + 0.5) * 2.0 * cell];
                    if region.holds(middle) {
                        *letter = region.kind.character(characters);
                    }
                }
            }
        }
        for (point, _) in &self.marks {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
            let [column, row] =
                [point[0] / cell, point[1] / (2.0 * cell)].map(|at| at.max(0.0) as usize);
            if let Some(letter) = grid.get_mut(row).and_then(|line| line.get_mut(column)) {
                *letter = '@';
            }
        }
        let edge = match characters {
            Characters::Unicode => ["┌", "─", "┐", "│", "└", "┘"],
            Characters::Ascii => ["+", "-", "+", "|", "+", "+"],
        };
        let bar = edge[1].repeat(columns);
        let mut lines = vec![format!("{}{bar}{}", edge[0], edge[2])];
        for line in grid.iter().rev() {
            lines.push(format!("{}{}{}", edge[3], line.iter().collect::<String>(), edge[3]));
        }
        lines.push(format!("{}{bar}{}", edge[4], edge[5]));
        let mut legend: Vec<String> = RegionKind::ALL
            .iter()
            .filter(|kind| self.regions.iter().any(|region| region.kind == **kind))
            .map(|kind| format!("{} {}", kind.character(characters), kind.word()))
            .collect();
        if !self.marks.is_empty() {
            legend.push("@ place of people".to_owned());
        }
        legend.push(format!("one character is {} m wide", number::significant(cell, 2)));
        let wide = |entry: &String| entry.chars().count() as f64 + 2.0;
        // A line of the legend may be as wide as the plan with its two edges. `wide` counts a space after the last
        // entry, which is not written.
        let mut legend = wrapped(legend, COLUMNS + 2.0 + 1.0, wide).into_iter().peekable();
        while let Some(line) = legend.next() {
            let comma = if legend.peek().is_some() { "," } else { "" };
            lines.push(line.join(", ") + comma);
        }
        lines
    }
}

impl RegionKind {
    /// Returns the character that fills the region in a terminal.
    fn character(self, characters: Characters) -> char {
        match (characters, self) {
            (Characters::Unicode, Self::Stands) => '▒',
            (Characters::Unicode, Self::Solid) => '█',
            _ => self.letter(),
        }
    }
}

impl Region {
    /// Creates a rectangle from two opposite corners (m).
    pub fn rectangle(a: Point, b: Point, kind: RegionKind, label: impl Into<String>) -> Self {
        let outline = vec![a, [b[0], a[1]], b, [a[0], b[1]]];
        Self { outline, kind, label: label.into() }
    }

    /// `true` if a point lies in the region.
    fn holds(&self, [x, y]: Point) -> bool {
        let side =
            |(a, b): (&Point, &Point)| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
        let edges = self.outline.iter().zip(self.outline.iter().cycle().skip(1));
        let (mut left, mut right) = (false, false);
        for turn in edges.map(side) {
            left |= turn > 0.0;
            right |= turn < 0.0;
        }
        !(left && right) && self.outline.len() > 2
    }
}

/// Returns the index of the shade for a value from 0 to 1; `None` for 0.
fn shade(share: f64) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded")]
    let step = (share * SHADES as f64).ceil().clamp(0.0, SHADES as f64) as usize;
    step.checked_sub(1)
}

/// Breaks entries into lines that are no wider than `width`, unless a single entry is wider. `wide` returns the width
/// of an entry.
fn wrapped<T>(entries: Vec<T>, width: f64, wide: impl Fn(&T) -> f64) -> Vec<Vec<T>> {
    let (mut lines, mut used) = (Vec::new(), f64::INFINITY);
    for entry in entries {
        used += wide(&entry);
        match lines.last_mut() {
            Some(line) if used <= width => Vec::push(line, entry),
            _ => {
                used = wide(&entry);
                lines.push(vec![entry]);
            }
        }
    }
    lines
}

/// Returns the width (px) of an entry of the legend.
fn entry(classes: &[&str], word: &str) -> f64 {
    15.0 * classes.len() as f64 + 4.0 + text_width(word, 12.0) + 14.0
}

fn draw(drawing: &mut Drawing, region: &Region, at: &dyn Fn(Point) -> [f64; 2]) {
    let corners = region.outline.iter().map(|corner| at(*corner)).collect();
    drawing.path(region.kind.class(), "", vec![corners], true);
}

/// Draws the name of a region in its middle if the region is wide enough.
fn label(drawing: &mut Drawing, region: &Region, at: &dyn Fn(Point) -> [f64; 2]) {
    let corners: Vec<[f64; 2]> = region.outline.iter().map(|corner| at(*corner)).collect();
    let span = |axis: usize| {
        let least = corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
        [least, corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max)]
    };
    let [[left, right], [top, bottom]] = [span(0), span(1)];
    let wide = text_width(&region.label, 11.0);
    let middle = [0.5 * (left + right), 0.5 * (top + bottom) + 4.0];
    let class = if region.kind == RegionKind::Zone { "note halo" } else { "note dark" };
    if wide < right - left && bottom - top > 11.0 {
        drawing.text(class, middle, Anchor::Middle, &region.label);
    } else if wide < bottom - top && right - left > 11.0 {
        let middle = [middle[0] + 4.0, middle[1] - 4.0];
        drawing.turned_text(class, middle, Anchor::Middle, -90.0, &region.label);
    }
}

/// Draws a scale bar with its left end at `[x, y]` (px) and a label. The bar represents a round length of at most a
/// quarter of `length` (m), but at least 0.5 m. `scale` is in px/m.
fn scale_bar(drawing: &mut Drawing, [x, y]: [f64; 2], length: f64, scale: f64) {
    let bar = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0].into_iter().rfind(|bar| *bar <= 0.25 * length);
    let bar = bar.unwrap_or(0.5);
    drawing.line("axis", [x, y], [x + bar * scale, y]);
    for end in [x, x + bar * scale] {
        drawing.line("axis", [end, y - 4.0], [end, y + 4.0]);
    }
    let text = format!("{} m", number::significant(bar, 1));
    drawing.text("label", [x + bar * scale + 8.0, y + 4.0], Anchor::Start, &text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Figure;

    fn plan() -> FloorPlan {
        let stack = |at: f64, kind| Region::rectangle([at, 1.0], [at + 1.0, 2.0], kind, "1-1");
        FloorPlan {
            size: [8.0, 4.0],
            regions: vec![
                Region::rectangle([0.0, 2.5], [8.0, 3.5], RegionKind::Zone, "main"),
                stack(1.0, RegionKind::Stands),
                stack(3.0, RegionKind::Falls),
            ],
            heat: Some(Heat {
                cell: 1.0,
                columns: 8,
                shares: (0..32).map(|at| f64::from(at) / 31.0).collect(),
                label: "share".into(),
            }),
            marks: vec![([7.5, 3.0], "desk".into())],
        }
    }

    #[test]
    fn a_plan_shows_every_region_mark_and_shade() {
        let svg = Figure::new("floor", "The floor.", plan()).to_svg();
        for text in ["plan zone", "plan falls", "plan heat5", "desk", "falls by itself", "1-1"] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(!svg.contains("plan knocked") && !svg.contains("is knocked over"));
        let csv = Figure::new("floor", "The floor.", plan()).to_csv();
        // The header, four corners for each of three regions, one mark, and all cells but the first.
        assert_eq!(csv.lines().count(), 1 + 12 + 1 + 31);
    }

    #[test]
    fn a_terminal_shows_the_same_plan() {
        let lines = plan().lines(Characters::Ascii);
        let whole = lines.join("\n");
        assert!(lines.iter().all(|line| line.is_ascii() && line.len() <= 102), "{whole}");
        for letter in ['#', 'F', '.', '@'] {
            assert!(whole.contains(letter), "{whole}");
        }
        // With all kinds, the legend needs more than one line.
        let all = RegionKind::ALL.iter().enumerate().map(|(at, kind)| {
            Region::rectangle([at as f64, 0.0], [at as f64 + 0.9, 1.0], *kind, "")
        });
        let full = FloorPlan { regions: all.collect(), ..plan() };
        for characters in [Characters::Ascii, Characters::Unicode] {
            let lines = full.lines(characters);
            let wide = |line: &String| line.chars().count() <= 102;
            assert!(lines.iter().all(wide), "{}", lines.join("\n"));
            for kind in RegionKind::ALL {
                let entry = format!("{} {}", kind.character(characters), kind.word());
                assert!(lines.iter().any(|line| line.contains(&entry)), "{entry}");
            }
        }
        // The far side is above: the zone is in the upper half.
        let first = |letter: char| lines.iter().position(|line| line.contains(letter));
        assert!(first('.') < first('#'), "{whole}");
    }

    #[test]
    fn shares_fall_into_five_shades() {
        let shades = [0.0, 0.01, 0.2, 0.21, 1.0, f64::NAN].map(shade);
        assert_eq!(shades, [None, Some(0), Some(0), Some(1), Some(4), None]);
    }
}
