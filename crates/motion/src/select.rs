//! Selects components of a record and converts them to a ground motion.

use std::fmt;
use std::str::FromStr;

use crate::direction::Direction;
use crate::error::MotionError;
use crate::ground_motion::GroundMotion;
use crate::history::History;
use crate::join::require_step;
use crate::math;
use crate::process::Processing;
use crate::record::{Channel, Record, Stage};
use crate::sampled::Sampled;

/// Largest cosine of the angle between two horizontal components that are treated as perpendicular. The
/// limit corresponds to a deviation of about five degrees.
const OBLIQUE: f64 = 0.09;

/// Identifies one component of a record.
///
/// The text form is `h1`, `h2`, `vertical`, `az:90`, `#3` (third channel), or the name of a
/// channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Component {
    /// The first channel in the file that is not vertical.
    Horizontal1,
    /// The second channel in the file that is not vertical.
    Horizontal2,
    /// The first vertical channel.
    Vertical,
    /// A channel by its position, counted from 1.
    Number(usize),
    /// A channel by its name, ignoring case.
    Name(String),
    /// The motion along an azimuth (degrees clockwise from north); if no channel has this azimuth,
    /// the motion is computed from two horizontal components.
    Azimuth(f64),
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Horizontal1 => f.write_str("h1"),
            Self::Horizontal2 => f.write_str("h2"),
            Self::Vertical => f.write_str("vertical"),
            Self::Number(number) => write!(f, "#{number}"),
            Self::Name(name) => f.write_str(name),
            Self::Azimuth(azimuth) => write!(f, "az:{azimuth}"),
        }
    }
}

impl FromStr for Component {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        let text = text.trim();
        let lower = text.to_ascii_lowercase();
        let refuse = |expected: &str| {
            Err(MotionError::parameter("component", expected, format!("\"{text}\"")))
        };
        Ok(match lower.as_str() {
            "" => return refuse("h1, h2, vertical, az:<degrees>, #<number> or a channel name"),
            "h1" | "horizontal 1" | "horizontal-1" | "horizontal1" => Self::Horizontal1,
            "h2" | "horizontal 2" | "horizontal-2" | "horizontal2" => Self::Horizontal2,
            "vertical" => Self::Vertical,
            _ => {
                if let Some(degrees) = lower.strip_prefix("az:") {
                    match degrees.trim().parse::<f64>() {
                        Ok(azimuth) if azimuth.is_finite() => Self::Azimuth(azimuth),
                        _ => return refuse("az: followed by degrees, such as az:90"),
                    }
                } else if let Some(number) = lower.strip_prefix('#') {
                    match number.parse() {
                        Ok(number) if number > 0 => Self::Number(number),
                        _ => return refuse("# followed by a channel number from 1"),
                    }
                } else {
                    Self::Name(text.to_owned())
                }
            }
        })
    }
}

impl Record {
    /// Returns the channel identified by `component`. For an azimuth that no channel has, a new
    /// channel is computed from two horizontal components.
    ///
    /// # Errors
    /// If there is no such channel, or the motion along the azimuth cannot be derived.
    pub fn component(&self, component: &Component) -> Result<Channel, MotionError> {
        let missing = || MotionError::NoChannel {
            file: self.file.clone(),
            wanted: component.to_string(),
            available: self.channel_names(),
        };
        let horizontal = |skip: usize| {
            self.channels.iter().filter(|channel| !channel.is_vertical()).nth(skip).cloned()
        };
        match component {
            Component::Horizontal1 => horizontal(0),
            Component::Horizontal2 => horizontal(1),
            Component::Vertical => self.channels.iter().find(|c| c.is_vertical()).cloned(),
            Component::Number(number) => self.channels.get(number.wrapping_sub(1)).cloned(),
            Component::Name(name) => self
                .channels
                .iter()
                .find(|channel| channel.name.trim().eq_ignore_ascii_case(name.trim()))
                .cloned(),
            Component::Azimuth(azimuth) => return self.along(*azimuth),
        }
        .ok_or_else(missing)
    }

    fn channel_names(&self) -> String {
        let names: Vec<String> =
            self.channels.iter().map(|channel| format!("\"{}\"", channel.name)).collect();
        names.join(", ")
    }

    /// Returns the motion along an azimuth, from a channel with this azimuth or from two
    /// horizontal components.
    fn along(&self, azimuth: f64) -> Result<Channel, MotionError> {
        let known: Vec<(&Channel, f64)> = self
            .channels
            .iter()
            .filter_map(|channel| channel.direction.azimuth.map(|known| (channel, known)))
            .collect();
        let off = |known: f64| (azimuth - known).rem_euclid(360.0);
        if let Some((channel, _)) = known.iter().find(|(_, known)| off(*known) == 0.0) {
            return Ok((*channel).clone());
        }
        for (k, (first, first_azimuth)) in known.iter().enumerate() {
            for (second, second_azimuth) in &known[k + 1..] {
                let apart = (second_azimuth - first_azimuth).to_radians();
                if math::sin(apart).abs() > 0.5 {
                    self.require_one_site(first, second)?;
                    return rotate((first, *first_azimuth), (second, *second_azimuth), azimuth);
                }
            }
        }
        Err(MotionError::NoChannel {
            file: self.file.clone(),
            wanted: format!("along azimuth {azimuth} and no two horizontals of known azimuth"),
            available: self.channel_names(),
        })
    }

    /// Converts a horizontal and optionally a vertical component to a ground motion, with the given
    /// processing.
    ///
    /// The longer component is cut to the length of the shorter one. With [`Processing::none`], the
    /// ground motion starts at the first sample of the record.
    ///
    /// # Errors
    /// If a component is missing, the time steps differ, or a setting is out of range.
    pub fn ground_motion(
        &self,
        horizontal: &Component,
        vertical: Option<&Component>,
        processing: &Processing,
    ) -> Result<GroundMotion, MotionError> {
        let mut first = self.component(horizontal)?;
        let mut second = vertical.map(|component| self.component(component)).transpose()?;
        let mut provenance = vec![format!(
            "{}: format {}, stage {}, {}",
            self.file,
            self.format,
            self.stage,
            if self.station.is_empty() { "station not stated" } else { &self.station }
        )];
        provenance.extend(self.notes.iter().cloned());
        provenance.extend(self.warnings.iter().map(|warning| format!("warning: {warning}")));
        if let Some(second) = &mut second {
            self.require_one_site(&first, second)?;
            cut_to_shorter(&mut first, second, &mut provenance)?;
        }
        if self.stage == Stage::Raw && processing.is_none() {
            provenance.push(
                "warning: a raw record used without processing; its velocity and displacement \
                 drift"
                    .to_owned(),
            );
        }
        let horizontal = history(&first, "horizontal", processing, &mut provenance)?;
        let vertical = second
            .map(|channel| history(&channel, "vertical", processing, &mut provenance))
            .transpose()?;
        let name = format!("{} {}", crate::format::file_stem(&self.file), first.name);
        let vertical = vertical.map(History::Sampled);
        let motion = GroundMotion::new(name, History::Sampled(horizontal), vertical);
        Ok(GroundMotion { provenance, ..motion })
    }

    fn require_one_site(&self, one: &Channel, other: &Channel) -> Result<(), MotionError> {
        match one.site.differs(&other.site) {
            Some(what) if !self.mixed => Err(MotionError::mismatch(
                format!(
                    "channels {} and {} of {} come from {what}",
                    one.name, other.name, self.file
                ),
                "choose channels of the same sensor",
            )),
            _ => Ok(()),
        }
    }

    /// Returns the two horizontal channels from which measures over all directions, such as `RotD50`,
    /// are computed: the first two channels that are not vertical.
    ///
    /// # Errors
    /// If there are fewer than two, their directions are unknown or not perpendicular, or they
    /// belong to different stations or sensors.
    pub fn horizontal_pair(&self) -> Result<(&Channel, &Channel), MotionError> {
        let mut flat = self.channels.iter().filter(|channel| !channel.is_vertical());
        let (Some(one), Some(two)) = (flat.next(), flat.next()) else {
            let what = format!(
                "measures over directions need two horizontal components, and {} has {}",
                self.file,
                self.channel_names()
            );
            return Err(MotionError::mismatch(what, "give the files of both components"));
        };
        for channel in [one, two] {
            if channel.direction.orientation.is_none() {
                let (file, name) = (&self.file, &channel.name);
                return Err(MotionError::mismatch(
                    format!("{file} does not state whether channel \"{name}\" is horizontal"),
                    "name the channels after their directions, such as N and E",
                ));
            }
        }
        self.require_one_site(one, two)?;
        require_step(one, two, "choose channels with the same time step")?;
        if let (Some(a), Some(b)) = (one.direction.azimuth, two.direction.azimuth)
            && math::cos((b - a).to_radians()).abs() > OBLIQUE
        {
            let what = format!(
                "channels {} and {} of {} point to {a}° and {b}°, which are not perpendicular",
                one.name, two.name, self.file
            );
            let remedy = "choose two components along perpendicular azimuths";
            return Err(MotionError::mismatch(what, remedy));
        }
        Ok((one, two))
    }

    /// Returns the channels of [`Record::horizontal_pair`], processed and cut to the same length.
    ///
    /// # Errors
    /// The same as for [`Record::horizontal_pair`], and if the time steps differ or a setting is
    /// out of range.
    pub fn horizontals(&self, processing: &Processing) -> Result<(Sampled, Sampled), MotionError> {
        let (first, second) = self.horizontal_pair()?;
        let (mut first, mut second) = (first.clone(), second.clone());
        let mut notes = Vec::new();
        cut_to_shorter(&mut first, &mut second, &mut notes)?;
        let mut series = |channel: &Channel| history(channel, "horizontal", processing, &mut notes);
        Ok((series(&first)?, series(&second)?))
    }

    /// Returns the ground motion of the first horizontal component and, if there is one, the vertical
    /// component, with the default processing for the record's stage.
    ///
    /// # Errors
    /// The same as for [`Record::ground_motion`].
    pub fn default_motion(&self) -> Result<GroundMotion, MotionError> {
        let vertical = self.channels.iter().any(Channel::is_vertical);
        self.ground_motion(
            &Component::Horizontal1,
            vertical.then_some(&Component::Vertical),
            &Processing::for_stage(self.stage),
        )
    }
}

fn history(
    channel: &Channel,
    role: &str,
    processing: &Processing,
    provenance: &mut Vec<String>,
) -> Result<Sampled, MotionError> {
    let (motion, steps) = processed(channel, processing)?;
    provenance.extend(steps.iter().map(|step| format!("{role} ({}): {step}", channel.name)));
    Ok(motion)
}

/// Returns the processed channel and a description of the processing steps.
pub(crate) fn processed(
    channel: &Channel,
    processing: &Processing,
) -> Result<(Sampled, Vec<String>), MotionError> {
    let done =
        processing.apply(channel.time_step, &channel.acceleration, channel.initial_velocity)?;
    let (a, v) = (done.acceleration, done.initial_velocity);
    Ok((Sampled::with_initial_velocity(channel.time_step, a, v)?, done.steps))
}

/// Checks that the time steps agree, and cuts the end of the longer channel.
fn cut_to_shorter(
    first: &mut Channel,
    second: &mut Channel,
    provenance: &mut Vec<String>,
) -> Result<(), MotionError> {
    require_step(first, second, "choose channels with the same time step")?;
    let shorter = first.acceleration.len().min(second.acceleration.len());
    for channel in [first, second] {
        let extra = channel.acceleration.len() - shorter;
        if extra > 0 {
            channel.acceleration.truncate(shorter);
            provenance.push(format!(
                "last {extra} samples of channel {} cut to match the length of the other channel",
                channel.name
            ));
        }
    }
    Ok(())
}

/// Returns the motion along an azimuth, computed from two horizontal components of different azimuth by
/// solving for the north and the east component. The two components need not be perpendicular.
fn rotate(
    first: (&Channel, f64),
    second: (&Channel, f64),
    azimuth: f64,
) -> Result<Channel, MotionError> {
    let (mut one, mut two) = (first.0.clone(), second.0.clone());
    let mut ignored = Vec::new();
    cut_to_shorter(&mut one, &mut two, &mut ignored)?;
    let radians = |degrees: f64| math::sin_cos(degrees.to_radians());
    let ((s1, c1), (s2, c2), (s, c)) = (radians(first.1), radians(second.1), radians(azimuth));
    let determinant = c1 * s2 - s1 * c2;
    let weight_one = (c * s2 - s * c2) / determinant;
    let weight_two = (s * c1 - c * s1) / determinant;
    let acceleration = one
        .acceleration
        .iter()
        .zip(&two.acceleration)
        .map(|(a, b)| weight_one * a + weight_two * b)
        .collect();
    Ok(Channel {
        name: format!("{azimuth} deg"),
        direction: Direction::horizontal(azimuth),
        acceleration,
        initial_velocity: weight_one * one.initial_velocity + weight_two * two.initial_velocity,
        peaks: Vec::new(),
        ..one
    })
}
