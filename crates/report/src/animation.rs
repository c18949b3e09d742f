//! A film as an animated image file: GIF, or APNG, which is smaller and preserves all colors.
//!
//! Each picture stores only the pixels that differ from the previous one. One index of the small
//! palette means "unchanged".

use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::ops::Range;

use gif::{DisposalMethod, Repeat};
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp};

use crate::{
    Film,
    raster::{rasterize, rgb},
};

/// Time (s) for which the last picture is held before the film repeats.
const REST: f64 = 1.5;

/// Palette index of an unchanged pixel.
const KEEP: u8 = 0;

/// Number of pictures painted at a time, which bounds the memory use.
const BLOCK: usize = 32;

/// A film as a palette and, for each picture, the pixels that differ from the previous picture.
pub struct Animation {
    palette: Vec<u8>,
    pictures: Vec<Picture>,
}

impl Animation {
    /// Renders a film with at most `largest` pixels on its longer side; returns `None` if the film has no frames.
    ///
    /// Each frame is shown for a whole number of hundredths of a second, as the GIF format requires. Few viewers show
    /// more than 50 frames per second.
    pub fn of(film: &Film, largest: u32) -> Option<Self> {
        let [width, height] = film.size();
        let scale = f64::from(largest.min(u32::from(u16::MAX))) / width.max(height);
        let mut palette = Palette::of(film, scale);
        let mut pictures: Vec<Picture> = Vec::new();
        let mut shown: Vec<u8> = Vec::new();
        let (start, end) = (film.time(0)?, film.time(film.len() - 1)?);
        let mut clock = 0;
        for from in (0..film.len()).step_by(BLOCK) {
            let block = painted(film, from..film.len().min(from + BLOCK), scale);
            for (at, (wide, pixels)) in (from..).zip(block) {
                let now = palette.indices(&pixels);
                let until = hundredths(film.time(at + 1).unwrap_or(end + REST) - start);
                let hold = until - clock;
                clock = until;
                match (pictures.last_mut(), change(&shown, &now, wide)) {
                    (Some(last), None) => last.hundredths += hold,
                    (_, change) => {
                        let picture = change.unwrap_or_else(|| Picture::whole(&now, wide));
                        pictures.push(Picture { hundredths: hold, ..picture });
                    }
                }
                shown = now;
            }
        }
        Some(Self { palette: palette.bytes(), pictures })
    }

    /// Encodes the film as a GIF that repeats and plays at the speed of the run.
    pub fn gif(&self) -> Vec<u8> {
        // Writing to memory cannot fail, and every picture has the size that it states.
        self.write_gif().expect("a film in memory")
    }

    fn write_gif(&self) -> Result<Vec<u8>, gif::EncodingError> {
        let mut file = Vec::new();
        // Neither side exceeds `largest`, which is limited to a u16.
        let size = |sides: [usize; 2]| sides.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
        let [wide, high] = size(self.pictures.first().map_or([1, 1], |picture| picture.size));
        let mut encoder = gif::Encoder::new(&mut file, wide, high, &self.palette)?;
        encoder.set_repeat(Repeat::Infinite)?;
        for picture in &self.pictures {
            let [left, top] = size(picture.corner);
            let [width, height] = size(picture.size);
            encoder.write_frame(&gif::Frame {
                delay: u16::try_from(picture.hundredths).unwrap_or(u16::MAX),
                dispose: DisposalMethod::Keep,
                transparent: Some(KEEP),
                left,
                top,
                width,
                height,
                buffer: picture.indices.as_slice().into(),
                ..gif::Frame::default()
            })?;
        }
        drop(encoder);
        Ok(file)
    }

    /// Encodes the film as an animated PNG that repeats and plays at the speed of the run; viewers
    /// without support for animation show the first picture.
    pub fn apng(&self) -> Vec<u8> {
        // Writing to memory cannot fail, and every picture has the size that it states.
        self.write_apng().expect("a film in memory")
    }

    fn write_apng(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        let [wide, high] = self.pictures.first().map_or([1, 1], |picture| picture.size).map(side);
        let mut encoder = png::Encoder::new(&mut file, wide, high);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(self.palette.as_slice());
        encoder.set_trns(vec![0_u8]);
        encoder.set_compression(Compression::High);
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_animated(side(self.pictures.len()), 0)?;
        let mut writer = encoder.write_header()?;
        for (at, picture) in self.pictures.iter().enumerate() {
            if at > 0 {
                let [width, height] = picture.size.map(side);
                let [left, top] = picture.corner.map(side);
                writer.reset_frame_position()?;
                writer.set_frame_dimension(width, height)?;
                writer.set_frame_position(left, top)?;
                writer.set_blend_op(BlendOp::Over)?;
                writer.set_dispose_op(DisposeOp::None)?;
            }
            writer.set_frame_delay(u16::try_from(picture.hundredths).unwrap_or(u16::MAX), 100)?;
            writer.write_image_data(&picture.indices)?;
        }
        writer.finish()?;
        Ok(file)
    }
}

/// Paints a range of pictures on all cores; returns the width and the RGB bytes of each picture.
fn painted(film: &Film, numbers: Range<usize>, scale: f64) -> Vec<(usize, Vec<u8>)> {
    let numbers: Vec<usize> = numbers.collect();
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let share = numbers.len().div_ceil(cores).max(1);
    let paint = |at: &usize| {
        let pixels = rasterize(&film.drawing(*at)?, scale);
        Some((usize::try_from(pixels.width()).ok()?, rgb(&pixels)))
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = numbers
            .chunks(share)
            .map(|part| scope.spawn(move || part.iter().filter_map(paint).collect::<Vec<_>>()))
            .collect();
        let joined = workers.into_iter().map(|worker| match worker.join() {
            Ok(pictures) => pictures,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        joined.flatten().collect()
    })
}

/// Converts a time (s) to hundredths of a second.
fn hundredths(time: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a film lasts minutes"
    )]
    let whole = (100.0 * time).round().max(0.0) as u32;
    whole
}

/// The rectangle of a picture that differs from the previous picture, and the time for which the
/// picture is shown.
struct Picture {
    corner: [usize; 2],
    size: [usize; 2],
    indices: Vec<u8>,
    hundredths: u32,
}

impl Picture {
    fn whole(indices: &[u8], wide: usize) -> Self {
        let size = [wide, indices.len() / wide.max(1)];
        Self { corner: [0; 2], size, indices: indices.to_vec(), hundredths: 0 }
    }
}

/// Returns the smallest rectangle that contains all changes from one picture to the next; `None` if there are no
/// changes, or if the pictures differ in size.
fn change(before: &[u8], now: &[u8], wide: usize) -> Option<Picture> {
    if before.len() != now.len() {
        return None;
    }
    let changed = |at: &usize| before[*at] != now[*at];
    let (mut left, mut right) = (usize::MAX, 0);
    let (mut top, mut bottom) = (usize::MAX, 0);
    for at in (0..now.len()).filter(changed) {
        let (row, column) = (at / wide, at % wide);
        (left, right) = (left.min(column), right.max(column));
        (top, bottom) = (top.min(row), bottom.max(row));
    }
    if left > right {
        return None;
    }
    let place = |row: usize| (left..=right).map(move |column| row * wide + column);
    let indices = (top..=bottom)
        .flat_map(place)
        .map(|at| if changed(&at) { now[at] } else { KEEP })
        .collect();
    let size = [right - left + 1, bottom - top + 1];
    Some(Picture { corner: [left, top], size, indices, hundredths: 0 })
}

/// The palette of a film; index 0 means "unchanged".
struct Palette {
    colors: Vec<[u8; 3]>,
    known: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// Builds the palette from a sample of the pictures.
    ///
    /// The pictures have a few flat colors, and blends of these colors at edges. The most frequent
    /// colors are kept exactly. Further colors are kept only if they differ visibly from those
    /// already kept, because fewer colors make a smaller file.
    fn of(film: &Film, scale: f64) -> Self {
        const SAMPLES: usize = 8;
        const MOST: usize = 64;
        const EXACT: usize = 16;
        const APART: u8 = 24;
        let mut counts: HashMap<[u8; 3], u32> = HashMap::new();
        let step = film.len().div_ceil(SAMPLES).max(1);
        for drawing in (0..film.len()).step_by(step).filter_map(|at| film.drawing(at)) {
            for color in rgb(&rasterize(&drawing, scale)).as_chunks().0 {
                *counts.entry(*color).or_default() += 1;
            }
        }
        let mut ranked: Vec<([u8; 3], u32)> = counts.into_iter().collect();
        ranked.sort_by_key(|(color, count)| (std::cmp::Reverse(*count), *color));
        let mut colors: Vec<[u8; 3]> = vec![[255; 3]];
        for (color, _) in ranked {
            let far = |known: &[u8; 3]| (0..3).any(|at| known[at].abs_diff(color[at]) > APART);
            if colors.len() < MOST && (colors.len() <= EXACT || colors[1..].iter().all(far)) {
                colors.push(color);
            }
        }
        Self { colors, known: HashMap::new() }
    }

    /// Returns the palette index of each pixel, or that of the nearest color if the color of the
    /// pixel is not in the palette.
    fn indices(&mut self, pixels: &[u8]) -> Vec<u8> {
        let mut last = None;
        let index = |color: &[u8; 3]| match last {
            // Neighboring pixels mostly have the same color.
            Some((same, index)) if same == *color => index,
            _ => {
                let index = self.index(*color);
                last = Some((*color, index));
                index
            }
        };
        pixels.as_chunks().0.iter().map(index).collect()
    }

    fn index(&mut self, color: [u8; 3]) -> u8 {
        let colors = &self.colors;
        *self.known.entry(color).or_insert_with(|| {
            let distance = |known: &[u8; 3]| -> u32 {
                (0..3).map(|at| u32::from(known[at].abs_diff(color[at])).pow(2)).sum()
            };
            let nearest = (1..colors.len()).min_by_key(|at| distance(&colors[*at]));
            nearest.and_then(|at| u8::try_from(at).ok()).unwrap_or(KEEP)
        })
    }

    fn bytes(&self) -> Vec<u8> {
        self.colors.as_flattened().to_vec()
    }
}
