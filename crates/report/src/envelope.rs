//! Normal stress along the boundary of a body: the stress at rest, drawn over the largest dynamic stress.

use crate::{
    Language, Polyline, csv_field,
    drawing::{Anchor, Drawing, Room, Runs, text_width},
    number,
    scene::Extent,
    ticks::round_length,
    with_unit,
};

/// Stress along a boundary, drawn outward along the normals.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Envelope {
    /// Outline of the body (m).
    pub outline: Vec<Polyline>,
    /// Sample points in order along the boundary.
    pub samples: Vec<BoundarySample>,
    /// `true` if the boundary is closed.
    pub closed: bool,
    /// Stress at rest at each sample, never negative; NaN makes a gap.
    pub static_stress: Vec<f64>,
    /// Largest stress at each sample, during a time span that the caller chooses.
    pub dynamic_stress: Vec<f64>,
    /// Unit of both stresses, such as `kPa` or `kN/m`.
    pub unit: String,
    /// Ratio of dynamic to static stress, as defined by the caller; shown unless it is `None`.
    pub amplification: Option<f64>,
    /// Name and unit of the sample coordinate, such as `angle` and `rad`, for the CSV.
    pub coordinate: (String, String),
}

/// A sample point on a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundarySample {
    /// `x` coordinate (m).
    pub x: f64,
    /// `z` coordinate (m).
    pub z: f64,
    /// `x` component of the outward unit normal.
    pub nx: f64,
    /// `z` component of the outward unit normal.
    pub nz: f64,
    /// Coordinate along the boundary, for the CSV.
    pub coordinate: f64,
}

/// Width (px) on a page and on a phone.
const WIDTH: [f64; 2] = [520.0, 358.0];
const SIDE: f64 = 24.0;
const LEGEND: f64 = 62.0;
/// Drawn length of the largest stress, as a fraction of the larger side of the body.
const REACH: f64 = 0.38;

impl Envelope {
    fn count(&self) -> usize {
        self.samples.len().min(self.static_stress.len()).min(self.dynamic_stress.len())
    }

    pub(crate) fn draw(&self, title: &str, room: Room, language: Language) -> Drawing {
        let width = room.of(WIDTH[0], WIDTH[1]);
        let legend = room.of(LEGEND, 2.0 * LEGEND - 24.0);
        let mut extent = Extent::EMPTY;
        for point in self.outline.iter().flat_map(|line| &line.points) {
            extent.add(*point);
        }
        for sample in &self.samples {
            extent.add([sample.x, sample.z]);
        }
        if extent.is_empty() {
            extent = Extent { lower: [-0.5; 2], upper: [0.5; 2] };
        }
        let size = extent.width().max(extent.height()).max(1e-6);
        let peak = self.peak();
        // Drawn length (m) per unit of stress.
        let per_stress = if peak > 0.0 { REACH * size / peak } else { 0.0 };
        for at in 0..self.count() {
            for stress in [self.static_stress[at], self.dynamic_stress[at]] {
                extent.add(self.tip(at, stress, per_stress));
            }
        }
        let scale = ((width - 2.0 * SIDE) / extent.width().max(1e-6))
            .min(360.0 / extent.height().max(1e-6));
        let height = legend + extent.height() * scale + SIDE;
        let x0 = 0.5 * (width - extent.width() * scale) - extent.lower[0] * scale;
        let z0 = height - SIDE + extent.lower[1] * scale;
        let map = |p: [f64; 2]| [x0 + p[0] * scale, z0 - p[1] * scale];

        let mut drawing = Drawing::new(width, height, title);
        for line in &self.outline {
            let points = line.points.iter().map(|p| map(*p)).collect();
            let class = if line.closed { "outline" } else { "outline open" };
            drawing.path(class, "", vec![points], line.closed);
        }
        for (stresses, class) in
            [(&self.dynamic_stress, "dynamic"), (&self.static_stress, "static")]
        {
            let shapes: Runs = self
                .runs(stresses)
                .iter()
                .map(|run| {
                    let tips = run.iter().map(|&at| map(self.tip(at, stresses[at], per_stress)));
                    let feet = run.iter().rev().map(|&at| map(self.tip(at, 0.0, per_stress)));
                    tips.chain(feet).collect()
                })
                .collect();
            drawing.path(class, "", shapes, true);
        }
        self.legend(&mut drawing, (peak, per_stress * scale), room, language);
        drawing
    }

    fn peak(&self) -> f64 {
        let stresses = self.static_stress.iter().chain(&self.dynamic_stress);
        stresses.copied().filter(|v| v.is_finite()).fold(0.0, f64::max)
    }

    fn tip(&self, at: usize, stress: f64, per_stress: f64) -> [f64; 2] {
        let sample = &self.samples[at];
        let length = stress.max(0.0) * per_stress;
        [sample.x + sample.nx * length, sample.z + sample.nz * length]
    }

    /// Returns sequences of consecutive loaded samples, each with the adjacent unloaded samples, so
    /// that the drawn shape closes on the boundary. On a closed boundary, a sequence may extend
    /// across the first sample.
    fn runs(&self, stresses: &[f64]) -> Vec<Vec<usize>> {
        let count = self.count();
        let loaded = |at: usize| stresses[at] > 0.0;
        let usable = |at: usize| stresses[at].is_finite();
        let start = if self.closed { (0..count).find(|&at| !loaded(at)).unwrap_or(0) } else { 0 };
        let mut runs: Vec<Vec<usize>> = Vec::new();
        let mut run: Vec<usize> = Vec::new();
        let mut before = None;
        let steps = count + usize::from(self.closed && count > 0);
        for step in 0..steps {
            let at = (start + step) % count;
            if loaded(at) {
                if run.is_empty() {
                    run.extend(before.filter(|&b| usable(b)));
                }
                run.push(at);
            } else if !run.is_empty() {
                if usable(at) {
                    run.push(at);
                }
                runs.push(std::mem::take(&mut run));
            }
            before = Some(at);
        }
        if !run.is_empty() {
            runs.push(run);
        }
        runs
    }

    /// Draws the legend and the stress scale: side by side on a page, one below the other on a
    /// phone.
    fn legend(
        &self,
        drawing: &mut Drawing,
        (peak, per_stress): (f64, f64),
        room: Room,
        language: Language,
    ) {
        drawing.rect("dynamic", [SIDE, 8.5], [26.0, 10.0]);
        drawing.text(
            "label",
            [SIDE + 33.0, 18.0],
            Anchor::Start,
            language.fixed("largest until the first loss of a seat"),
        );
        drawing.rect("static", [SIDE, 28.5], [26.0, 10.0]);
        drawing.text("label", [SIDE + 33.0, 38.0], Anchor::Start, language.fixed("at rest"));
        let (edge, top, anchor) = match room {
            Room::Page => (WIDTH[0] - SIDE, 18.0, Anchor::End),
            Room::Phone => (SIDE, 58.0, Anchor::Start),
        };
        if let Some(ratio) = self.amplification {
            let text = language.text(&format!("amplification {}", number::significant(ratio, 2)));
            drawing.text("label strong", [edge, top], anchor, &text);
        }
        let bar = round_length(0.6 * peak);
        if bar > 0.0 {
            let text = format!("line load: {} {}", number::significant(bar, 1), self.unit);
            let text = language.text(&text);
            let (length, y) = (bar * per_stress, top + 16.0);
            let from = match room {
                Room::Page => edge - text_width(&text, 12.0) - 8.0 - length,
                Room::Phone => edge,
            };
            drawing.line("axis", [from, y], [from + length, y]);
            for x in [from, from + length] {
                drawing.line("axis", [x, y - 4.0], [x, y + 4.0]);
            }
            let at = match room {
                Room::Page => edge,
                Room::Phone => from + length + 8.0,
            };
            drawing.text("label", [at, y + 4.0], anchor, text.trim_end());
        } else {
            drawing.text("note", [edge, top + 20.0], anchor, language.fixed("no line load"));
        }
    }

    pub(crate) fn to_csv(&self) -> String {
        let unit = |name: &str, unit: &str| csv_field(&with_unit(name, unit));
        let name = if self.coordinate.0.is_empty() { "coordinate" } else { &self.coordinate.0 };
        let mut out = format!(
            "{},x (m),z (m),nx,nz,{},{}\n",
            unit(name, &self.coordinate.1),
            unit("static", &self.unit),
            unit("dynamic", &self.unit)
        );
        for at in 0..self.count() {
            let s = &self.samples[at];
            let cells = [
                s.coordinate,
                s.x,
                s.z,
                s.nx,
                s.nz,
                self.static_stress[at],
                self.dynamic_stress[at],
            ];
            out.push_str(&cells.map(number::csv_number).join(","));
            out.push('\n');
        }
        out
    }
}
