//! Site of a channel: station, sensor and coordinates.

use crate::join::names_differ;

/// Site of one channel, as stated in its file; unstated fields are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Site {
    /// Station name, as stated in the file.
    pub station: String,
    /// Sensor at the station: a SEED location code, or a word such as `borehole`.
    pub sensor: String,
    /// Latitude (degrees, positive north).
    pub latitude: Option<f64>,
    /// Longitude (degrees, positive east).
    pub longitude: Option<f64>,
    /// Elevation above sea level (m).
    pub elevation: Option<f64>,
    /// Time-averaged shear-wave velocity of the upper 30 m (m/s).
    pub vs30: Option<f64>,
}

impl Site {
    /// Sets latitude and longitude (degrees), if both are valid. Zeros from a header that was never
    /// filled in are ignored.
    pub(crate) fn at(mut self, position: Option<(f64, f64)>) -> Self {
        let possible = |(north, east): &(f64, f64)| {
            north.abs() <= 90.0 && east.abs() <= 360.0 && (*north != 0.0 || *east != 0.0)
        };
        if let Some((north, east)) = position.filter(possible) {
            self.latitude = Some(north);
            self.longitude = Some(if east > 180.0 { east - 360.0 } else { east });
        }
        self
    }

    /// Compares the sites of two channels. Returns the first difference in station, sensor or
    /// coordinates; `None` if the sites agree as far as they are stated.
    pub fn differs(&self, other: &Self) -> Option<String> {
        let words =
            [("station", &self.station, &other.station), ("sensor", &self.sensor, &other.sensor)];
        for (what, one, two) in words {
            if names_differ(one, two) {
                return Some(format!("{what} \"{one}\" and {what} \"{two}\""));
            }
        }
        // The published coordinates of one station differ by less than a kilometer, which is 0.01
        // degrees.
        let apart = |one: Option<f64>, two: Option<f64>| {
            one.zip(two).is_some_and(|(one, two)| (one - two).abs() > 0.01)
        };
        let place = |site: &Self| {
            let degree = |value: Option<f64>| value.map_or("?".to_owned(), |v| v.to_string());
            format!("{}° N, {}° E", degree(site.latitude), degree(site.longitude))
        };
        (apart(self.latitude, other.latitude) || apart(self.longitude, other.longitude))
            .then(|| format!("{} and {}", place(self), place(other)))
    }
}

/// Parses latitude and longitude (degrees) from a string such as `35.525N, 117.365W`,
/// `37.73 N 47.80 E` or `34 25 09N, 118 25 34W`.
pub(crate) fn position(text: &str) -> Option<(f64, f64)> {
    let upper = text.to_ascii_uppercase();
    let part = |letters: [char; 2]| {
        upper.match_indices(letters).find_map(|(at, letter)| {
            let angle = angle_before(&upper[..at])?;
            Some(if letter.starts_with(letters[1]) { -angle } else { angle })
        })
    };
    Some((part(['N', 'S'])?, part(['E', 'W'])?))
}

/// Parses an angle at the end of a string, given in degrees, or in degrees, minutes and seconds.
fn angle_before(text: &str) -> Option<f64> {
    let text = text.trim_end();
    let number = |c: char| c.is_ascii_digit() || c == '.' || c == ' ';
    let start = text.rfind(|c: char| !number(c)).map_or(0, |at| at + 1);
    // An unrelated number to the left, such as the number of the station, is separated by two
    // blanks.
    let last = text.get(start..)?.rsplit("  ").next()?;
    let parts: Vec<f64> =
        last.split_whitespace().map(|part| part.parse().ok()).collect::<Option<_>>()?;
    match *parts.as_slice() {
        [degrees] => Some(degrees),
        [degrees, minutes, seconds] if minutes < 60.0 && seconds < 60.0 => {
            Some(degrees + minutes / 60.0 + seconds / 3600.0)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_found_as_headers_write_them() {
        let near = |text: &str, north: f64, east: f64| {
            let (n, e) = position(text).unwrap_or_else(|| panic!("{text}"));
            assert!((n - north).abs() < 1e-3 && (e - east).abs() < 1e-3, "{text}: {n} {e}");
        };
        near("Station Id. CCC     35.525N, 117.365W    Q330    s/n 4114", 35.525, -117.365);
        near("STATION USC# 0057   34 25 09N, 118 25 34W", 34.4192, -118.4261);
        near("Site WTMC      42 37 10S  173 03 13E     Cusp file:", -42.6194, 173.0536);
        near("Avin   Station   37.734 N 47.801 E   Altitude 2026m", 37.734, 47.801);
        near("37.87470N-27.59223E", 37.8747, 27.592_23);
        near("Station No. 1   40.941S, 174.0E", -40.941, 174.0);
        assert_eq!(position("no numbers here"), None);
        let zero = Site::default().at(position("0.000N    0.000E"));
        assert_eq!(zero, Site::default());
    }

    #[test]
    fn other_stations_sensors_and_places_are_distinguished() {
        let site = |station: &str, sensor: &str| Site {
            station: station.to_owned(),
            sensor: sensor.to_owned(),
            ..Site::default()
        };
        assert_eq!(site("A", "").differs(&site("a", "00")), None);
        assert!(site("A", "").differs(&site("B", "")).unwrap().contains("station \"B\""));
        assert!(site("A", "surface").differs(&site("A", "borehole")).is_some());
        let here = Site::default().at(Some((35.0, 139.0)));
        assert_eq!(here.differs(&Site::default().at(Some((35.005, 139.0)))), None);
        assert!(here.differs(&Site::default().at(Some((35.5, 139.0)))).is_some());
    }
}
