//! Stress around a body: self-weight shaded, the largest during shaking as a line.

use crate::{
    Polyline,
    drawing::{Anchor, Drawing, Runs, text_width},
    escape, number,
    scene::Extent,
    ticks::round_length,
};

/// Stress along a boundary, drawn outward along its normals.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Envelope {
    /// The body's drawing (m).
    pub outline: Vec<Polyline>,
    /// Places on the boundary in order along it.
    pub samples: Vec<BoundarySample>,
    /// The boundary returns to its start.
    pub closed: bool,
    /// Stress from self-weight at each sample, never negative; NaN makes a gap.
    pub static_stress: Vec<f64>,
    /// Largest stress during the run at each sample.
    pub dynamic_stress: Vec<f64>,
    /// Unit of both, such as `kPa` or `kN/m`.
    pub unit: String,
    /// Ratio of dynamic to static stress as the caller defines it; stated when given.
    pub amplification: Option<f64>,
    /// What the coordinate of the samples is, such as `angle`; with its unit for the CSV.
    pub coordinate: (String, String),
}

/// A place on a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundarySample {
    /// Where (m).
    pub x: f64,
    /// Where (m).
    pub z: f64,
    /// Unit normal, out of the body.
    pub nx: f64,
    /// Unit normal, out of the body.
    pub nz: f64,
    /// Coordinate along the boundary, for the CSV.
    pub coordinate: f64,
}

const WIDTH: f64 = 520.0;
const SIDE: f64 = 24.0;
const LEGEND: f64 = 58.0;
/// Longest stress over the larger side of the body.
const REACH: f64 = 0.38;

impl Envelope {
    fn count(&self) -> usize {
        self.samples.len().min(self.static_stress.len()).min(self.dynamic_stress.len())
    }

    pub(crate) fn draw(&self, title: &str) -> Drawing {
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
        // Length in meters of one unit of stress.
        let per_stress = if peak > 0.0 { REACH * size / peak } else { 0.0 };
        for at in 0..self.count() {
            for stress in [self.static_stress[at], self.dynamic_stress[at]] {
                extent.add(self.tip(at, stress, per_stress));
            }
        }
        let scale = ((WIDTH - 2.0 * SIDE) / extent.width().max(1e-6))
            .min(360.0 / extent.height().max(1e-6));
        let height = LEGEND + extent.height() * scale + SIDE;
        let x0 = 0.5 * (WIDTH - extent.width() * scale) - extent.lower[0] * scale;
        let z0 = height - SIDE + extent.lower[1] * scale;
        let map = |p: [f64; 2]| [x0 + p[0] * scale, z0 - p[1] * scale];

        let mut drawing = Drawing::new(WIDTH, height, title);
        for line in &self.outline {
            let points = line.points.iter().map(|p| map(*p)).collect();
            let class = if line.closed { "outline" } else { "outline open" };
            drawing.path(class, "", vec![points], line.closed);
        }
        for (stresses, class) in
            [(&self.static_stress, "static"), (&self.dynamic_stress, "dynamic")]
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
        self.legend(&mut drawing, peak, per_stress * scale);
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

    /// Stretches of samples under stress, each with the unloaded neighbors that end it, so that
    /// a stretch closes onto the boundary. On a closed boundary a stretch may pass the seam.
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

    fn legend(&self, drawing: &mut Drawing, peak: f64, per_stress: f64) {
        drawing.rect("static", [SIDE, 8.0], [26.0, 11.0]);
        drawing.text("label", [SIDE + 33.0, 18.0], Anchor::Start, "self-weight");
        drawing.path("dynamic", "", vec![vec![[SIDE, 34.0], [SIDE + 26.0, 34.0]]], false);
        drawing.text("label", [SIDE + 33.0, 38.0], Anchor::Start, "largest during shaking");
        let right = WIDTH - SIDE;
        if let Some(ratio) = self.amplification {
            let text = format!("amplification {}", number::significant(ratio, 2));
            drawing.text("label strong", [right, 18.0], Anchor::End, &text);
        }
        let bar = round_length(0.6 * peak);
        if bar > 0.0 {
            let text = format!("{} {}", number::significant(bar, 1), self.unit);
            let from = right - text_width(&text, 12.0) - 8.0 - bar * per_stress;
            let to = from + bar * per_stress;
            drawing.line("axis", [from, 34.0], [to, 34.0]);
            for x in [from, to] {
                drawing.line("axis", [x, 30.0], [x, 38.0]);
            }
            drawing.text("label", [right, 38.0], Anchor::End, text.trim_end());
        } else {
            drawing.text("note", [right, 38.0], Anchor::End, "no stress");
        }
    }

    pub(crate) fn to_csv(&self) -> String {
        let unit = |name: &str, unit: &str| {
            escape::csv(&if unit.is_empty() { name.into() } else { format!("{name} ({unit})") })
        };
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
