//! A film: a scene as numbered pictures of equal size and scale.

use std::sync::Arc;

use crate::{
    Depth, DepthPoses, Frames, Scene, Tint,
    drawing::{Anchor, Drawing},
    number, raster,
    strip::{View, define_bodies, picture},
};

/// A scene as pictures at equal time steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    scene: Arc<Scene>,
    frames: Vec<usize>,
    view: View,
}

const MOST: [f64; 2] = [900.0, 560.0];
const HEADING: f64 = 26.0;

impl Film {
    /// Creates a film whose pictures are `1/rate` (s) apart, from the first frame to the last.
    ///
    /// Each picture shows the frame nearest to its time. If the rate exceeds the rate of the
    /// frames, or is not positive, every frame is shown once.
    pub fn of_run(scene: Arc<Scene>, rate: f64) -> Self {
        let frames = sampled(&scene, rate);
        let view = View::of(&scene, &frames, MOST, true);
        Self { scene, frames, view }
    }

    /// Returns the number of pictures.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// `true` if the film has no pictures.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Returns the time (s) of the picture with index `at`; `None` after the last picture.
    pub fn time(&self, at: usize) -> Option<f64> {
        self.scene.frames.times.get(*self.frames.get(at)?).copied()
    }

    /// Returns the width and height (px) of every picture, rounded up to even numbers.
    pub(crate) fn size(&self) -> [f64; 2] {
        [self.view.width, self.view.height + HEADING].map(|side| 2.0 * (0.5 * side).ceil())
    }

    /// Returns the picture with index `at` as a PNG with a resolution of `dpi` dots per inch; `None` after the last
    /// picture.
    ///
    /// At multiples of 96 dpi both sides are even numbers of pixels, as video encoders require.
    pub fn png(&self, at: usize, dpi: f64) -> Option<Vec<u8>> {
        self.drawing(at).map(|drawing| raster::png(&drawing, dpi))
    }

    /// Returns the picture with index `at` as a standalone SVG document; `None` after the last picture.
    pub fn svg(&self, at: usize) -> Option<String> {
        self.drawing(at).map(|drawing| drawing.standalone())
    }

    pub(crate) fn drawing(&self, at: usize) -> Option<Drawing> {
        let frame = *self.frames.get(at)?;
        let heading = format!("t = {} s", number::fixed(self.time(at)?, 2));
        let mut drawing = Drawing::new(self.size()[0], self.size()[1], &heading);
        drawing.push(define_bodies(&self.scene, "film", &self.view, &self.frames));
        drawing.text("label strong", [1.0, 16.0], Anchor::Start, &heading);
        drawing.nest([0.0, HEADING], picture(&self.scene, "film", Some(frame), &self.view));
        Some(drawing)
    }
}

impl Scene {
    /// Returns the scene reduced to the frames between two times (s), with all events.
    #[must_use]
    pub fn between(&self, from: f64, to: f64) -> Self {
        let times = &self.frames.times;
        let inside = |at: &usize| (from..=to).contains(&times[*at]);
        self.only(&(0..self.frames.len()).filter(inside).collect::<Vec<_>>())
    }

    /// Returns the scene reduced to the frames that [`Film::of_run`] selects for this rate (1/s), with all events.
    #[must_use]
    pub fn thinned(&self, rate: f64) -> Self {
        self.only(&sampled(self, rate))
    }

    /// Returns the scene reduced to the frames with the given indices.
    fn only(&self, kept: &[usize]) -> Self {
        let frames = &self.frames;
        let frames = Frames {
            times: kept.iter().map(|at| frames.times[*at]).collect(),
            poses: kept.iter().map(|at| frames.poses[*at].clone()).collect(),
            forces: kept.iter().filter_map(|at| frames.forces.get(*at).cloned()).collect(),
        };
        let tint = self.tint.as_ref().map(|tint| Tint {
            values: kept.iter().filter_map(|at| tint.values.get(*at).cloned()).collect(),
            ..tint.clone()
        });
        let mut depth = self.depth.clone();
        if let Some(Depth { poses: DepthPoses::Free(poses), forces, .. }) = &mut depth {
            *poses = kept.iter().filter_map(|at| poses.get(*at).cloned()).collect();
            *forces = kept.iter().filter_map(|at| forces.get(*at).cloned()).collect();
        }
        Self { frames, tint, depth, ..self.clone() }
    }
}

/// Returns the indices of the frames nearest to times that are `1/rate` (s) apart, each index at most once. If `rate`
/// is not positive, returns the indices of all frames.
pub(crate) fn sampled(scene: &Scene, rate: f64) -> Vec<usize> {
    sampled_times(&scene.frames.times[..scene.frames.len()], rate)
}

/// Returns the same indices as [`sampled`], but for frames at the given times (s).
pub(crate) fn sampled_times(times: &[f64], rate: f64) -> Vec<usize> {
    let mut frames = Vec::new();
    let mut due = f64::NEG_INFINITY;
    for (frame, &time) in times.iter().enumerate() {
        // The later of two frames is nearer after the midpoint between them.
        let next = times.get(frame + 1).copied().unwrap_or(f64::INFINITY);
        if due == f64::NEG_INFINITY || 0.5 * (time + next) > due {
            frames.push(frame);
            let from = if due == f64::NEG_INFINITY { time } else { due };
            due = if rate > 0.0 { (from + 1.0 / rate).max(time) } else { time };
        }
    }
    frames
}
