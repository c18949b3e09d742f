//! Several plots in rows, as one figure.

use crate::{
    Plot,
    drawing::{Anchor, Drawing, Room, broken, text_width},
};

/// Height (px) of the title.
const TITLE: f64 = 26.0;
/// Gap (px) between plots.
const GAP: f64 = 10.0;

/// Plots in rows under a title; the plots of a row are aligned at the bottom.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Panels {
    /// Title.
    pub title: String,
    /// Further lines of text below the title.
    pub lines: Vec<String>,
    /// The rows from top to bottom.
    pub rows: Vec<Vec<Plot>>,
}

impl Panels {
    /// Draws the plots in their rows; on a phone, all plots are one below the other.
    pub(crate) fn draw(&self, id: &str, caption: &str, room: Room) -> Drawing {
        let drawn: Vec<Vec<Drawing>> = self
            .rows
            .iter()
            .enumerate()
            .map(|(row, plots)| {
                let one =
                    |(k, plot): (usize, &Plot)| plot.draw(&format!("{id}-{row}-{k}"), "", room);
                plots.iter().enumerate().map(one).collect()
            })
            .collect();
        let drawn = match room {
            Room::Page => drawn,
            Room::Phone => drawn.into_iter().flatten().map(|plot| vec![plot]).collect(),
        };
        let wide = |row: &Vec<Drawing>| {
            let gaps = GAP * row.len().saturating_sub(1) as f64;
            row.iter().map(|plot| plot.width).sum::<f64>() + gaps
        };
        let across = drawn.iter().map(wide).fold(0.0, f64::max);
        let lines: Vec<String> = match room {
            Room::Page => self.lines.clone(),
            Room::Phone => {
                self.lines.iter().flat_map(|line| broken(line, 11.0, across - 20.0)).collect()
            }
        };
        let words = lines.iter().map(|line| text_width(line, 11.0) + 20.0);
        let width = words.fold(across, f64::max);
        let head = TITLE + 16.0 * lines.len() as f64;
        let tall = |row: &Vec<Drawing>| row.iter().map(|plot| plot.height).fold(0.0, f64::max);
        let height = head + drawn.iter().map(|row| tall(row) + GAP).sum::<f64>();
        let mut drawing = Drawing::new(width, height, caption);
        drawing.text("label", [10.0, 18.0], Anchor::Start, &self.title);
        for (k, line) in lines.iter().enumerate() {
            drawing.text("note", [10.0, 34.0 + 16.0 * k as f64], Anchor::Start, line);
        }
        let mut top = head;
        for row in drawn {
            let height = tall(&row);
            let mut left = 0.0;
            for plot in row {
                // Aligned at the bottom, so that taller plots keep their axes level with the
                // others.
                let at = [left, top + height - plot.height];
                left += plot.width + GAP;
                drawing.nest(at, plot);
            }
            top += height + GAP;
        }
        drawing
    }

    pub(crate) fn to_csv(&self) -> String {
        let tables: Vec<String> = self.rows.iter().flatten().map(Plot::to_csv).collect();
        tables.join("\n")
    }
}
