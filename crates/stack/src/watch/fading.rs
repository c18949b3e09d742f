//! Decay of a ground motion: the time from which the rest of a motion is weaker than what a stack has just withstood.

/// Number of intervals for which the peaks of a ground motion are stored, per [`HOLD`](super::rest::HOLD).
const PER_HOLD: f64 = 50.0;

/// Largest ratio of the peaks of the rest of a motion to the peaks that a stack has withstood without being
/// [strained](super::STRAINED).
const FAINT: f64 = 0.25;

/// Largest number of samples of a motion.
const MOST_SAMPLES: f64 = 1e6;

/// Peaks of the acceleration and of the velocity of a ground motion, in intervals of equal length and after each of them.
#[derive(Clone, Debug)]
pub struct Fading {
    /// Length of an interval (s).
    interval: f64,
    /// For every interval, the largest acceleration (m/s²) and the largest velocity (m/s) within it.
    within: Vec<[f64; 2]>,
    /// For every interval, the largest acceleration (m/s²) and the largest velocity (m/s) after it.
    after: Vec<[f64; 2]>,
}

impl Fading {
    /// Samples a ground motion that ends at `end` (s) in steps of at most `step` (s).
    ///
    /// `strength` returns the magnitudes of the acceleration (m/s²) and of the velocity (m/s) at a time (s). A stack must
    /// not be strained for `hold` (s) before its run may end.
    pub fn new(end: f64, step: f64, hold: f64, strength: impl Fn(f64) -> [f64; 2]) -> Self {
        let interval = hold / PER_HOLD;
        let step = step.max(end / MOST_SAMPLES);
        let mut within = Vec::new();
        // The time of every sample is computed from its number, so that errors do not add up.
        let mut sample = 0_u32;
        let mut time = 0.0;
        while time < end {
            let mut peaks = [0.0; 2];
            let to = (within.len() + 1) as f64 * interval;
            while time < to && time < end {
                peaks = larger(peaks, strength(time));
                sample += 1;
                time = f64::from(sample) * step;
            }
            within.push(peaks);
        }
        let mut after = vec![[0.0; 2]; within.len()];
        for at in (1..within.len()).rev() {
            after[at - 1] = larger(after[at], within[at]);
        }
        Self { interval, within, after }
    }

    /// Returns the length (s) of an interval.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Returns the earliest time (s) after which the rest of the motion has at most [`FAINT`] times the peak acceleration,
    /// and at most [`FAINT`] times the peak velocity, of the motion between `since` (s) and this time.
    ///
    /// Returns infinity if there is no such time before the end of the motion.
    pub fn faint_from(&self, since: f64) -> f64 {
        let mut peaks = [0.0; 2];
        for (at, within) in self.within.iter().enumerate() {
            if at as f64 * self.interval < since {
                continue;
            }
            peaks = larger(peaks, *within);
            let [acceleration, velocity] = self.after[at];
            if acceleration <= FAINT * peaks[0] && velocity <= FAINT * peaks[1] {
                return (at + 1) as f64 * self.interval;
            }
        }
        f64::INFINITY
    }
}

/// Returns the larger of both values of each quantity.
fn larger(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the decay of a motion of 20 s whose acceleration and velocity are `peak(t)`.
    fn fading(peak: impl Fn(f64) -> f64) -> Fading {
        Fading::new(20.0, 0.01, 3.0, |time| [peak(time); 2])
    }

    #[test]
    fn a_motion_is_faint_once_its_rest_is_a_quarter_of_what_was_withstood() {
        // The peak is halved every 5 s: a quarter of it is left after 10 s.
        let steps = fading(|time| 8.0 / (time / 5.0).floor().exp2());
        assert!((steps.faint_from(0.0) - 10.0).abs() < 0.061, "{}", steps.faint_from(0.0));
        // Since 5.1 s only a peak of 4 was withstood, so the rest must not exceed 1.
        assert!((steps.faint_from(5.1) - 15.0).abs() < 0.061, "{}", steps.faint_from(5.1));
        // After the last peak of 1, nothing is left.
        assert!((steps.faint_from(16.0) - 20.0).abs() < 0.061, "{}", steps.faint_from(16.0));
        assert_eq!(steps.faint_from(20.5), f64::INFINITY);
    }

    #[test]
    fn a_motion_that_does_not_decay_is_never_faint_before_its_end() {
        let even = fading(|_| 1.0);
        assert!(even.faint_from(0.0) >= 20.0 - 0.061, "{}", even.faint_from(0.0));
        let growing = fading(|time| time);
        assert!(growing.faint_from(0.0) >= 20.0 - 0.061, "{}", growing.faint_from(0.0));
    }

    #[test]
    fn acceleration_and_velocity_must_both_decay() {
        let slow = Fading::new(20.0, 0.01, 3.0, |time| [if time < 5.0 { 9.0 } else { 1.0 }, 1.0]);
        assert!(slow.faint_from(0.0) >= 20.0 - 0.061, "{}", slow.faint_from(0.0));
    }
}
