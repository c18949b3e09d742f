//! Median and largest response of two horizontal components over all directions.

use crate::direction::Direction;
use crate::error::MotionError;
use crate::math::{self, PI};
use crate::response::{Step, check_oscillator};

/// Number of directions in half a turn.
pub(crate) const DIRECTIONS: usize = 180;

/// Smallest, median and largest peak over all horizontal directions, one degree apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotatedPeak {
    /// Median over all directions (`RotD50`).
    pub median: f64,
    /// Largest peak (`RotD100`).
    pub largest: f64,
    /// Smallest peak (`RotD00`).
    pub smallest: f64,
    /// Direction of the largest peak (degrees from the first component toward the second, 0 to
    /// 179).
    pub angle: f64,
    /// Directions of the two middle peaks (degrees, as in `angle`). The median is the mean of these
    /// two peaks.
    pub median_angles: [f64; 2],
}

impl RotatedPeak {
    /// Returns the azimuth of the largest peak (degrees clockwise from north, 0 to below 180), if
    /// the azimuths of both components are known.
    ///
    /// ```
    /// use barrelstack_motion::{Direction, rotated_peak};
    /// // A motion to the north-west and to the south-east, by components N and E.
    /// let peak = rotated_peak(&[1.0, -1.0], &[-1.0, 1.0]);
    /// let (north, east) = (Direction::parse("N"), Direction::parse("E"));
    /// assert_eq!(peak.azimuth(&north, &east), Some(135.0));
    /// assert_eq!(peak.azimuth(&north, &Direction::parse("H2")), None);
    /// ```
    pub fn azimuth(&self, first: &Direction, second: &Direction) -> Option<f64> {
        let (first, second) = (first.azimuth?, second.azimuth?);
        // The rotation from the first component toward the second is clockwise if the second lies
        // to the right.
        let clockwise = math::sin((second - first).to_radians()) > 0.0;
        let turned = if clockwise { first + self.angle } else { first - self.angle };
        Some(turned.rem_euclid(180.0))
    }
}

/// Returns the peaks over all directions of any pair of series: accelerations, velocities,
/// displacements or responses (Boore 2010, BSSA 100:1830-1835).
pub fn rotated_peak(first: &[f64], second: &[f64]) -> RotatedPeak {
    let hull = hull(first, second);
    let mut peaks = [0.0_f64; DIRECTIONS];
    for (degree, peak) in peaks.iter_mut().enumerate() {
        let (s, c) = math::sin_cos(PI * degree as f64 / DIRECTIONS as f64);
        for (x, y) in &hull {
            *peak = peak.max((x * c + y * s).abs());
        }
    }
    let angle = (0..DIRECTIONS).fold(0, |best, k| if peaks[k] > peaks[best] { k } else { best });
    let largest = peaks[angle];
    let mut order: Vec<usize> = (0..DIRECTIONS).collect();
    order.sort_by(|a, b| peaks[*a].total_cmp(&peaks[*b]));
    let middle = [order[DIRECTIONS / 2 - 1], order[DIRECTIONS / 2]];
    RotatedPeak {
        median: 0.5 * (peaks[middle[0]] + peaks[middle[1]]),
        largest,
        smallest: peaks[order[0]],
        angle: angle as f64,
        median_angles: middle.map(|degree| degree as f64),
    }
}

/// Returns the corners of the convex hull of the points (`first`, `second`). In every direction,
/// the peak is at one of these corners.
fn hull(first: &[f64], second: &[f64]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = first.iter().copied().zip(second.iter().copied()).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turn = |o: (f64, f64), a: (f64, f64), b: (f64, f64)| {
        (a.0 - o.0) * (b.1 - o.1) - (a.1 - o.1) * (b.0 - o.0)
    };
    let mut corners: Vec<(f64, f64)> = Vec::new();
    let half = |points: &mut dyn Iterator<Item = (f64, f64)>, corners: &mut Vec<(f64, f64)>| {
        let start = corners.len();
        for point in points {
            while corners.len() >= start + 2
                && turn(corners[corners.len() - 2], corners[corners.len() - 1], point) <= 0.0
            {
                corners.pop();
            }
            corners.push(point);
        }
    };
    half(&mut points.iter().copied(), &mut corners);
    half(&mut points.iter().rev().copied(), &mut corners);
    corners
}

/// Returns, for each period (s), the smallest, median and largest peak pseudo-acceleration (m/s²) of two
/// horizontal components over all directions.
///
/// The longer component is cut to the length of the shorter one.
///
/// # Errors
/// The same as for [`crate::response()`].
pub fn rotated_spectrum(
    time_step: f64,
    first: &[f64],
    second: &[f64],
    periods: &[f64],
    damping: f64,
) -> Result<Vec<RotatedPeak>, MotionError> {
    MotionError::require_positive("time step (s)", time_step)?;
    let n = first.len().min(second.len());
    let (first, second) = (&first[..n], &second[..n]);
    periods
        .iter()
        .map(|&period| {
            check_oscillator(period, damping)?;
            if period == 0.0 {
                return Ok(rotated_peak(first, second));
            }
            let step = Step::new(period, damping, time_step);
            let w = 2.0 * PI / period;
            let history = |a: &[f64]| -> Vec<f64> {
                let (mut u, mut v) = (0.0, 0.0);
                a.windows(2)
                    .map(|pair| {
                        (u, v) = step.advance(u, v, -pair[0], -pair[1]);
                        w * w * u
                    })
                    .collect()
            };
            Ok(rotated_peak(&history(first), &history(second)))
        })
        .collect()
}
