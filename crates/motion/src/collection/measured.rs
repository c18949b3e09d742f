//! Intensity measures of a record: of every component, of both horizontal components jointly, and of
//! the velocity pulse.

use crate::error::MotionError;
use crate::horizontals::Horizontals;
use crate::intensity::IntensityMeasure;
use crate::process::Processing;
use crate::pulse_class::{ClassifiedPulse, classify_component, classify_pair};
use crate::record::{Channel, Record};
use crate::response::response;
use crate::rotd::{RotatedPeak, rotated_spectrum};
use crate::sampled::Sampled;
use crate::select::processed;

/// Damping ratio of all response spectra.
const DAMPING: f64 = 0.05;
/// The measure FIV3, for an oscillator with a period of 1 s.
const FIV3: IntensityMeasure = IntensityMeasure::Fiv3 { period: 1.0 };

/// Intensity measures of one component, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredComponent {
    /// Name of the channel.
    pub name: String,
    /// Azimuth (degrees clockwise from north), if known.
    pub azimuth: Option<f64>,
    /// Peak acceleration (m/s²), velocity (m/s) and displacement (m).
    pub peaks: [f64; 3],
    /// Arias intensity (m/s).
    pub arias: f64,
    /// Cumulative absolute velocity (m/s).
    pub cav: f64,
    /// Significant duration from 5 to 95 % (s).
    pub duration: f64,
    /// FIV3 at 1 s (m/s).
    pub fiv3: f64,
    /// Classification of the velocity pulse by the method of Baker (2007); `None` for a vertical
    /// component, and for a motion that cannot be classified.
    pub pulse: Option<ClassifiedPulse>,
    /// Pseudo-accelerations (m/s²) at 5 % damping, one per period.
    pub spectrum: Vec<f64>,
}

/// Joint intensity measures of both horizontal components, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPair {
    /// `RotD50` of peak acceleration (m/s²) and velocity (m/s).
    pub peaks: [f64; 2],
    /// `RotD100` of peak acceleration (m/s²) and velocity (m/s).
    pub largest: [f64; 2],
    /// `RotD50` and `RotD100` of the pseudo-accelerations (m/s²) at 5 % damping, one per period.
    pub spectrum: Vec<RotatedPeak>,
    /// Classification of the velocity pulse by the method of Shahi and Baker (2014); `None` if the
    /// motion is shorter than the shortest pulse, or if the velocity of a component is zero.
    pub pulse: Option<ClassifiedPulse>,
}

/// Intensity measures of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The first two components that are not vertical, in file order; fewer if the record has fewer.
    pub horizontals: Vec<MeasuredComponent>,
    /// The first vertical component, if there is one.
    pub vertical: Option<MeasuredComponent>,
    /// Joint measures of both horizontal components, if they form a pair.
    pub pair: Option<MeasuredPair>,
    /// Reason why the horizontal components do not form a pair; `None` if they do.
    pub no_pair: Option<String>,
}

/// Processes a record and computes its intensity measures, with spectra at `periods` (s).
///
/// # Errors
/// If the record has no channel or a setting is out of range.
pub fn measure(
    record: &Record,
    processing: &Processing,
    periods: &[f64],
) -> Result<Measured, MotionError> {
    MotionError::require(!record.channels.is_empty(), "channels", "at least one", 0)?;
    let motion = |channel: &Channel| processed(channel, processing).map(|(motion, _)| motion);
    let flat: Vec<&Channel> = record.channels.iter().filter(|c| !c.is_vertical()).take(2).collect();
    let mut horizontals = Vec::new();
    for channel in &flat {
        horizontals.push(component(channel, &motion(channel)?, periods)?);
    }
    let vertical = record.channels.iter().find(|c| c.is_vertical());
    let vertical = vertical.map(|c| component(c, &motion(c)?, periods)).transpose()?;
    let (pair, no_pair) = match record.horizontal_pair() {
        Ok(_) => {
            let (first, second) = record.horizontals(processing)?;
            let mut pair = both(&first, &second, periods)?;
            // A motion with zero velocity has no pulse, but its other measures are valid.
            if let Ok((singles, together)) = classify_pair(&first, &second) {
                pair.pulse = Some(together);
                for (component, pulse) in horizontals.iter_mut().zip(singles) {
                    component.pulse = Some(pulse);
                }
            }
            (Some(pair), None)
        }
        Err(error) => {
            for (component, channel) in horizontals.iter_mut().zip(&flat) {
                component.pulse = classify_component(&motion(channel)?).ok();
            }
            (None, Some(error.to_string()))
        }
    };
    Ok(Measured { horizontals, vertical, pair, no_pair })
}

fn component(
    channel: &Channel,
    motion: &Sampled,
    periods: &[f64],
) -> Result<MeasuredComponent, MotionError> {
    let (step, a) = (motion.time_step(), motion.acceleration());
    let spectrum = periods
        .iter()
        .map(|t| response(step, a, *t, DAMPING).map(|peaks| peaks.pseudo_acceleration))
        .collect::<Result<_, _>>()?;
    Ok(MeasuredComponent {
        name: channel.name.clone(),
        azimuth: channel.direction.azimuth,
        peaks: [motion.pga(), motion.pgv(), motion.pgd_by_trapezoid()],
        arias: IntensityMeasure::Arias.of(motion)?,
        cav: IntensityMeasure::Cav.of(motion)?,
        duration: IntensityMeasure::D5_95.of(motion)?,
        fiv3: FIV3.of(motion)?,
        pulse: None,
        spectrum,
    })
}

fn both(first: &Sampled, second: &Sampled, periods: &[f64]) -> Result<MeasuredPair, MotionError> {
    let of = |horizontals: Horizontals| -> Result<[f64; 2], MotionError> {
        let of = |measure| horizontals.of(measure, first, second);
        Ok([of(IntensityMeasure::Pga)?, of(IntensityMeasure::Pgv)?])
    };
    Ok(MeasuredPair {
        peaks: of(Horizontals::RotD50)?,
        largest: of(Horizontals::RotD100)?,
        spectrum: rotated_spectrum(
            first.time_step(),
            first.acceleration(),
            second.acceleration(),
            periods,
            DAMPING,
        )?,
        pulse: None,
    })
}
