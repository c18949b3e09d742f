//! Directions of components, and their parsing from channel names.

/// Orientation of a component relative to the ground plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// In the horizontal plane.
    Horizontal,
    /// Perpendicular to the ground plane. Readers reverse channels that are positive downward, so that positive values
    /// point upward.
    Vertical,
}

/// Direction of a component, as far as known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Direction {
    /// Azimuth of the positive direction, degrees clockwise from north, 0 to below 360.
    pub azimuth: Option<f64>,
    /// Horizontal or vertical, if known.
    pub orientation: Option<Orientation>,
    /// `true` if the name states that the positive direction is down.
    pub downward: bool,
}

impl Direction {
    /// Returns a horizontal direction with a known azimuth (degrees clockwise from north).
    pub fn horizontal(azimuth: f64) -> Self {
        Self { azimuth: Some(azimuth.rem_euclid(360.0)), ..Self::some_horizontal() }
    }

    /// Returns a horizontal direction with an unknown azimuth.
    pub fn some_horizontal() -> Self {
        Self { azimuth: None, orientation: Some(Orientation::Horizontal), downward: false }
    }

    /// Returns the vertical direction, positive upward.
    pub fn up() -> Self {
        Self { azimuth: None, orientation: Some(Orientation::Vertical), downward: false }
    }

    fn down() -> Self {
        Self { downward: true, ..Self::up() }
    }

    /// Parses a direction from a name such as `360`, `90 Deg`, `N28W`, `E-W`, `UP`, `HNZ` or `L`.
    ///
    /// Returns the default, an unknown direction, if the name contains no direction.
    ///
    /// ```
    /// use barrelstack_motion::{Direction, Orientation};
    /// assert_eq!(Direction::parse("S62W").azimuth, Some(242.0));
    /// assert_eq!(Direction::parse("up").orientation, Some(Orientation::Vertical));
    /// ```
    pub fn parse(name: &str) -> Self {
        let mut upper = name.trim().to_ascii_uppercase();
        for word in ["DEGREES", "DEG.", "DEG", "COMPONENT", "COMP"] {
            upper = upper.replace(word, "");
        }
        let text = upper.trim();
        match text {
            "UP" | "V;+" | "U" | "+U" | "V" | "VERT" | "VERT." | "VERTICAL" | "Z" | "UD"
            | "U-D" | "+V" | "VRT" | "VER" => return Self::up(),
            "DOWN" | "DN" | "DWN" | "DU" | "D-U" | "-U" | "V;-" => return Self::down(),
            "N" | "NS" | "N-S" | "NORTH" => return Self::horizontal(0.0),
            "E" | "EW" | "E-W" | "EAST" => return Self::horizontal(90.0),
            "S" | "SN" | "S-N" | "SOUTH" => return Self::horizontal(180.0),
            "W" | "WE" | "W-E" | "WEST" => return Self::horizontal(270.0),
            "L" | "T" | "LONG" | "LONGITUDINAL" | "TRAN" | "TRANS" | "TRANSVERSE" | "H1" | "H2"
            | "X" | "Y" | "LN" | "TR" => return Self::some_horizontal(),
            _ => {}
        }
        if let Ok(azimuth) = text.parse::<f64>() {
            return if (0.0..=360.0).contains(&azimuth) {
                Self::horizontal(azimuth)
            } else {
                Self::default()
            };
        }
        bearing(text).or_else(|| seed_channel(text)).unwrap_or_default()
    }

    /// Parses a direction from a name, or else from the direction code in headers of CSMIP and
    /// COSMOS. The code is an azimuth from 1 to 360, or 400 to 600 for a vertical direction, or 700
    /// and more for a horizontal direction relative to a structure.
    pub(crate) fn of_name_or_code(name: &str, code: Option<f64>) -> Self {
        let stated = Self::parse(name);
        if stated != Self::default() {
            return stated;
        }
        match code {
            Some(azimuth) if (1.0..=360.0).contains(&azimuth) => Self::horizontal(azimuth),
            Some(400.0 | 401.0 | 500.0) => Self::up(),
            Some(402.0 | 600.0) => Self::down(),
            Some(700.0 | 701.0 | 800.0 | 801.0 | 1100.0 | 1200.0) => Self::some_horizontal(),
            _ => stated,
        }
    }
}

/// Parses a quadrant bearing such as `N28W`.
fn bearing(text: &str) -> Option<Direction> {
    let south = match text.chars().next()? {
        'N' => false,
        'S' => true,
        _ => return None,
    };
    // West is `O` in Spanish.
    let west = match text.chars().last()? {
        'E' => false,
        'W' | 'O' => true,
        _ => return None,
    };
    let angle: f64 = text.get(1..text.len() - 1)?.trim().parse().ok()?;
    if !(0.0..=90.0).contains(&angle) {
        return None;
    }
    Some(Direction::horizontal(match (south, west) {
        (false, false) => angle,
        (false, true) => 360.0 - angle,
        (true, false) => 180.0 - angle,
        (true, true) => 180.0 + angle,
    }))
}

/// Parses a three-letter channel code, such as `HNE`, whose last letter is the direction.
fn seed_channel(text: &str) -> Option<Direction> {
    let [band, instrument, direction] = text.as_bytes() else { return None };
    if !band.is_ascii_uppercase() || !matches!(instrument, b'N' | b'L' | b'G' | b'H') {
        return None;
    }
    match direction {
        b'N' => Some(Direction::horizontal(0.0)),
        b'E' => Some(Direction::horizontal(90.0)),
        b'Z' => Some(Direction::up()),
        b'1' | b'2' => Some(Direction::some_horizontal()),
        _ => None,
    }
}
