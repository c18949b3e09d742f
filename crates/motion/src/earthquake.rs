//! The earthquake of a record, as stated in the header of its file.

use crate::math;
use crate::record::Record;
use crate::site::Site;

/// Mean radius of the Earth (km).
const EARTH: f64 = 6371.0;

/// Magnitude and location of an earthquake, as stated in a header. Unstated values are `None` or empty strings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Earthquake {
    /// Identifier in the agency's catalog.
    pub id: String,
    /// Magnitude; the moment magnitude if several are stated.
    pub magnitude: Option<f64>,
    /// Magnitude scale as written in the header, such as `Mw`; empty if not stated.
    pub scale: String,
    /// Latitude of the epicenter (degrees, positive north).
    pub latitude: Option<f64>,
    /// Longitude of the epicenter (degrees, positive east).
    pub longitude: Option<f64>,
    /// Focal depth (km).
    pub depth: Option<f64>,
    /// Epicentral distance stated in the header (km).
    pub epicentral_distance: Option<f64>,
}

impl Earthquake {
    /// Creates an earthquake from the first valid magnitude in a list of pairs of scale and magnitude. The values 0
    /// and −999 mean that a magnitude is unknown.
    pub(crate) fn of_magnitude<'a>(
        stated: impl IntoIterator<Item = (&'a str, Option<f64>)>,
    ) -> Self {
        let known = |(_, value): &(&str, Option<f64>)| value.is_some_and(|m| m > 0.0 && m < 10.0);
        let (scale, magnitude) = stated.into_iter().find(known).unwrap_or_default();
        // Single precision prints 5.8 as 5.8000002.
        let magnitude = magnitude.map(|magnitude| (1e4 * magnitude).round() / 1e4);
        Self { magnitude, scale: scale.to_owned(), ..Self::default() }
    }

    /// Adds the epicenter (latitude and longitude in degrees) and the depth (km), if they are
    /// valid.
    pub(crate) fn at(self, epicenter: Option<(f64, f64)>, depth: Option<f64>) -> Self {
        let Site { latitude, longitude, .. } = Site::default().at(epicenter);
        let depth = depth.filter(|depth| (0.0..1000.0).contains(depth));
        Self { latitude, longitude, depth, ..self }
    }
}

impl Record {
    /// Returns the epicentral distance (km) stated in the header. If it is not stated, returns the
    /// great-circle distance from the epicenter to the station, if both positions are stated.
    pub fn epicentral_distance(&self) -> Option<f64> {
        let quake = &self.earthquake;
        let stated =
            quake.epicentral_distance.filter(|distance| (0.0..20_100.0).contains(distance));
        let site = &self.channels.first()?.site;
        stated.or_else(|| {
            let from = (quake.latitude?, quake.longitude?);
            Some(great_circle(from, (site.latitude?, site.longitude?)))
        })
    }
}

/// Returns the great-circle distance (km) between two points given in degrees.
fn great_circle(from: (f64, f64), to: (f64, f64)) -> f64 {
    let radians = math::PI / 180.0;
    let half = |angle: f64| math::powi(math::sin(0.5 * radians * angle), 2);
    let [north, south] = [from.0, to.0].map(|latitude| math::cos(radians * latitude));
    let chord = half(to.0 - from.0) + north * south * half(to.1 - from.1);
    2.0 * EARTH * math::atan2(chord.sqrt(), (1.0 - chord).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_sphere() {
        // A quarter of the equator, a degree of a meridian, and the distance from Mineral to Reston,
        // for which the header of the record states 121.44 km (on an ellipsoid).
        assert!((great_circle((0.0, 0.0), (0.0, 90.0)) - 0.5 * math::PI * EARTH).abs() < 1e-6);
        assert!((great_circle((10.0, 5.0), (11.0, 5.0)) - 111.195).abs() < 1e-3);
        let reston = great_circle((37.963, -77.933), (38.9511, -77.3359));
        assert!((reston / 121.44 - 1.0).abs() < 3e-3, "{reston}"); // measured 1.5e-3
    }
}
