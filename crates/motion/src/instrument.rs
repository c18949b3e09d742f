//! Instrument metadata (sensitivity, quantity, direction), from `StationXML` or from the caller.

use crate::direction::Direction;
use crate::error::MotionError;
use crate::record::Quantity;
use crate::site::Site;
use crate::units::MotionUnit;
use crate::utc::Utc;

/// Metadata of one channel of a station. An empty network, station or channel code matches any code.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Instrument {
    /// Network code.
    pub network: String,
    /// Station code.
    pub station: String,
    /// Location code. `None` matches any code; an empty code matches only an empty code.
    pub location: Option<String>,
    /// Channel code, such as `HNE`.
    pub channel: String,
    /// Start and end of the period for which the metadata are valid; `None` if unlimited.
    pub epoch: (Option<Utc>, Option<Utc>),
    /// Sensitivity in counts per SI unit of the measured quantity: m/s², m/s or m. Negative if
    /// positive counts mean motion opposite to [`Instrument::direction`].
    pub sensitivity: f64,
    /// Quantity measured by the instrument, if known.
    pub quantity: Option<Quantity>,
    /// Input unit of an instrument that does not measure motion, such as `Pa`. Such a channel is
    /// refused.
    pub other_unit: Option<String>,
    /// Direction of the instrument, if known.
    pub direction: Option<Direction>,
    /// Latitude (degrees), longitude (degrees) and elevation (m), if known.
    pub place: [Option<f64>; 3],
}

impl Instrument {
    /// Returns `true` if the metadata apply to the channel `seed` at the time `start`. If `start` is
    /// `None`, the epoch is not checked.
    pub(crate) fn describes(&self, seed: &SeedName, start: Option<Utc>) -> bool {
        let fits = |mine: &str, theirs: &str| mine.is_empty() || mine.eq_ignore_ascii_case(theirs);
        let (from, until) = self.epoch;
        fits(&self.network, &seed.network)
            && fits(&self.station, &seed.station)
            && self.location.as_ref().is_none_or(|code| *code == seed.location)
            && fits(&self.channel, &seed.channel)
            && start.is_none_or(|start| {
                from.is_none_or(|from| from <= start) && until.is_none_or(|until| start <= until)
            })
    }

    /// Fills in those coordinates of a site that are not stated in the waveform file.
    pub(crate) fn complete(&self, site: &mut Site) {
        let [latitude, longitude, elevation] = self.place;
        site.latitude = site.latitude.or(latitude);
        site.longitude = site.longitude.or(longitude);
        site.elevation = site.elevation.or(elevation);
    }
}

/// The SEED codes of a channel: network, station, location and channel.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SeedName {
    pub(crate) network: String,
    pub(crate) station: String,
    pub(crate) location: String,
    pub(crate) channel: String,
}

impl SeedName {
    /// Returns the quantity and the kind of instrument according to the second letter of the
    /// channel code; `None` for accelerations and unknown codes (SEED 2.4, appendix A).
    pub(crate) fn other_quantity(&self) -> Option<(Quantity, &'static str)> {
        let [_, instrument, _] = self.channel.as_bytes() else { return None };
        match instrument {
            b'H' => Some((Quantity::Velocity, "a high-gain seismometer")),
            b'L' => Some((Quantity::Velocity, "a low-gain seismometer")),
            b'P' => Some((Quantity::Velocity, "a geophone")),
            _ => None,
        }
    }
}

/// Largest deviation (degrees) of a dip from horizontal or vertical at which a sensor is still
/// treated as horizontal or vertical.
const LARGEST_TILT: f64 = 5.0;

/// Reads, from a `StationXML` file, the channels that state a sensitivity, in file order.
///
/// Sensitivities for g, gal, cm/s², mm/s², nm/s² and similar units are converted to counts per
/// m/s², and sensitivities for velocity and displacement to counts per m/s or m. The input unit of
/// any other channel, such as Pa, is stored in [`Instrument::other_unit`].
///
/// # Errors
/// If the text is not XML.
pub fn station_xml(text: &str) -> Result<Vec<Instrument>, MotionError> {
    let document = roxmltree::Document::parse(text).map_err(|error| {
        MotionError::parameter("StationXML", "an XML document", error.to_string())
    })?;
    Ok(document
        .descendants()
        .filter(|node| node.tag_name().name() == "Channel")
        .filter_map(channel_of_station_xml)
        .collect())
}

/// Reads one channel; returns `None` if the channel states no sensitivity.
fn channel_of_station_xml(channel: roxmltree::Node<'_, '_>) -> Option<Instrument> {
    let any =
        |name: &'static str| move |node: &roxmltree::Node<'_, '_>| node.tag_name().name() == name;
    let code = |level: &'static str, key: &str| {
        let node = channel.ancestors().find(|node| node.tag_name().name() == level)?;
        node.attribute(key).map(str::trim)
    };
    let text = |node: roxmltree::Node<'_, '_>, name: &'static str| {
        node.children().find(any(name)).and_then(|n| n.text()).map(|t| t.trim().to_owned())
    };
    let number = |name: &'static str| text(channel, name)?.parse::<f64>().ok();
    let block = channel.descendants().find(any("InstrumentSensitivity"))?;
    let stated = text(block, "Value")?.parse::<f64>().ok()?;
    let name = block.children().find(any("InputUnits")).and_then(|node| text(node, "Name"));
    let name = name.unwrap_or_default();
    let unit = MotionUnit::parse(&name);
    let sensitivity = stated / unit.map_or(1.0, |unit| unit.factor);
    if !(sensitivity.is_finite() && sensitivity != 0.0) {
        return None;
    }
    let direction = number("Dip").map(|dip| match dip {
        _ if (dip + 90.0).abs() <= LARGEST_TILT => Direction::up(),
        _ if (dip - 90.0).abs() <= LARGEST_TILT => Direction { downward: true, ..Direction::up() },
        _ if dip.abs() <= LARGEST_TILT => {
            number("Azimuth").map_or_else(Direction::some_horizontal, Direction::horizontal)
        }
        // An inclined sensor is neither horizontal nor vertical.
        _ => Direction::default(),
    });
    let date = |key: &str| code("Channel", key).and_then(|text| text.parse().ok());
    Some(Instrument {
        network: code("Network", "code").unwrap_or_default().to_owned(),
        station: code("Station", "code").unwrap_or_default().to_owned(),
        location: Some(code("Channel", "locationCode").unwrap_or_default().replace('-', "")),
        channel: code("Channel", "code").unwrap_or_default().to_owned(),
        epoch: (date("startDate"), date("endDate")),
        sensitivity,
        quantity: unit.map(|unit| unit.quantity),
        other_unit: unit.is_none().then_some(name),
        direction,
        place: [number("Latitude"), number("Longitude"), number("Elevation")],
    })
}

/// Differentiates a series by central differences of fourth order; near the ends, the order is
/// lower.
pub(crate) fn differentiated(values: &[f64], time_step: f64) -> Vec<f64> {
    let n = values.len();
    let slope = |a: usize, b: usize| (values[b] - values[a]) / ((b - a) as f64 * time_step);
    (0..n)
        .map(|k| match k {
            _ if n < 2 => 0.0,
            2.. if k + 2 < n => (4.0 * slope(k - 1, k + 1) - slope(k - 2, k + 2)) / 3.0,
            _ => slope(k.saturating_sub(1), (k + 1).min(n - 1)),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{cos, sin};

    #[test]
    fn a_wave_is_differentiated() {
        // With thirty samples per wave, the measured error is 1.3e-4 of the largest rate.
        let w = 2.0;
        let step = std::f64::consts::TAU / w / 30.0;
        let values: Vec<f64> = (0..200).map(|k| sin(w * step * f64::from(k))).collect();
        let rates = differentiated(&values, step);
        for (k, rate) in rates.iter().enumerate().skip(2).take(196) {
            let exact = w * cos(w * step * k as f64);
            assert!((rate - exact).abs() < 2e-4 * w, "{k}: {rate} {exact}");
        }
    }
}
