//! Instants of universal time, as stated in file headers.

use std::fmt;
use std::str::FromStr;

use crate::error::MotionError;

const MICROSECOND: f64 = 1e-6;
const DAY: i64 = 86_400_000_000;
/// Largest offset of a local time from universal time (h).
const LARGEST_OFFSET: u32 = 14;

/// An instant of universal time (UTC) with microsecond resolution; leap seconds are not counted.
///
/// The text form is `2014-08-24T10:20:33.000Z`.
///
/// ```
/// use barrelstack_motion::Utc;
/// let start: Utc = "2014-08-24T10:20:33.500Z".parse()?;
/// assert_eq!(start.later(86_400.0).since(start), 86_400.0);
/// assert_eq!(start.to_string(), "2014-08-24T10:20:33.500Z");
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Utc {
    /// Microseconds since the beginning of 1970.
    microseconds: i64,
}

/// Order of month and day in a date that does not begin with the year.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DateOrder {
    /// Month before day, as in the United States.
    MonthFirst,
    /// Day before month, as in most other countries.
    DayFirst,
}

impl Utc {
    /// Creates an instant from a Gregorian date and a time of day. Returns `None` if the instant
    /// does not exist or is outside the years 1900 to 2199.
    pub fn new(
        year: i64,
        month: i64,
        day: i64,
        hour: i64,
        minute: i64,
        seconds: f64,
    ) -> Option<Self> {
        if !(1..=12).contains(&month) || !(1..=days_in(year, month)).contains(&day) {
            return None;
        }
        let before: i64 = (1..month).map(|month| days_in(year, month)).sum();
        Self::ordinal(year, before + day, hour, minute, seconds)
    }

    /// Creates an instant like [`Utc::new`], from the day of the year, counted from 1.
    pub fn ordinal(year: i64, day: i64, hour: i64, minute: i64, seconds: f64) -> Option<Self> {
        let sound = (1900..2200).contains(&year)
            && (1..=365 + i64::from(is_leap(year))).contains(&day)
            && (0..24).contains(&hour)
            && (0..60).contains(&minute)
            && (0.0..61.0).contains(&seconds);
        // The numbers of a damaged header may overflow.
        if !sound {
            return None;
        }
        let years: i64 = (1900..year).map(|year| 365 + i64::from(is_leap(year))).sum();
        // From 1900 to 1969 there are 70 years, 17 of them leap years.
        let days = years - (70 * 365 + 17) + day - 1;
        let clock = Self { microseconds: days * DAY + (hour * 60 + minute) * 60_000_000 };
        Some(clock.later(seconds))
    }

    /// Creates an instant from the seconds since the beginning of 1970. Returns `None` after the
    /// year 2199.
    ///
    /// ```
    /// use barrelstack_motion::Utc;
    /// assert_eq!(Utc::of_unix(951_868_799).map(|day| day.date()).as_deref(), Some("2000-02-29"));
    /// ```
    pub fn of_unix(seconds: u64) -> Option<Self> {
        let microseconds = i64::try_from(seconds).ok()?.checked_mul(1_000_000)?;
        let end = Self::new(2199, 12, 31, 23, 59, 60.0)?;
        Some(Self { microseconds }).filter(|instant| *instant < end)
    }

    /// Returns the date, such as "2014-08-24".
    pub fn date(self) -> String {
        let mut text = self.to_string();
        text.truncate(10);
        text
    }

    /// Returns the seconds from `other` to this instant.
    pub fn since(self, other: Self) -> f64 {
        (self.microseconds - other.microseconds) as f64 * MICROSECOND
    }

    /// Returns the instant `seconds` later, or earlier if `seconds` is negative. The shift is
    /// limited to about a century.
    #[must_use]
    pub fn later(self, seconds: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "at most a century of microseconds")]
        let away = (seconds / MICROSECOND).round().clamp(-3.2e15, 3.2e15) as i64;
        Self { microseconds: self.microseconds + away }
    }

    /// Parses an instant from the numbers in a string such as `8/24/14, 10:20:33.0 UTC`.
    ///
    /// A two-digit year is between 1950 and 2049. A UTC offset after the time of day, such as
    /// `+03:00`, is subtracted; `AM` and `PM` are recognized.
    pub(crate) fn in_header(text: &str, order: DateOrder) -> Option<Self> {
        let (text, offset) = without_offset(text);
        let lower = text.to_ascii_lowercase();
        let half = ["am", "pm"].into_iter().find(|half| lower.trim_end().ends_with(half));
        let mut numbers = text
            .split(|c: char| !c.is_ascii_digit() && c != '.')
            .filter(|part| part.contains(|c: char| c.is_ascii_digit()))
            .map(|part| part.trim_matches('.').parse::<f64>().ok());
        let mut next = || numbers.next().flatten();
        #[expect(clippy::cast_possible_truncation, reason = "saturates, and is checked then")]
        let whole = |value: f64| value as i64;
        let date = [next()?, next()?, next()?].map(whole);
        let (mut hour, minute, seconds) = (whole(next()?), whole(next()?), next().unwrap_or(0.0));
        if let Some(half) = half.filter(|_| (1..=12).contains(&hour)) {
            hour = hour % 12 + if half == "pm" { 12 } else { 0 };
        }
        let [first, second, third] = date;
        let (mut year, month, day) = match order {
            _ if first >= 1000 => (first, second, third),
            DateOrder::MonthFirst => (third, first, second),
            DateOrder::DayFirst => (third, second, first),
        };
        if (0..100).contains(&year) {
            year += if year < 50 { 2000 } else { 1900 };
        }
        Self::new(year, month, day, hour, minute, seconds).map(|local| local.later(-offset))
    }
}

/// Splits a UTC offset, such as `+03:00`, off the end of a time of day. Returns the rest and the offset (s). If there
/// is no offset, returns the whole string and zero.
fn without_offset(text: &str) -> (&str, f64) {
    let split = || {
        let at = text.rfind(['+', '-'])?;
        let (before, sign) =
            (text.get(..at)?, if text[at..].starts_with('-') { -1.0 } else { 1.0 });
        // Accepts `+03:00`, `+0300` and `+03`, also in parentheses or after `UTC`.
        let digits = text[at + 1..].trim().trim_end_matches(')').replace(':', "");
        let number = digits.bytes().all(|c| c.is_ascii_digit()).then_some(digits)?;
        let (hours, minutes) = match number.len() {
            2 => (number.parse::<u32>().ok()?, 0),
            4 => (number[..2].parse().ok()?, number[2..].parse().ok()?),
            _ => return None,
        };
        if hours > LARGEST_OFFSET || minutes >= 60 {
            return None;
        }
        // A date also contains dashes; unlike an offset, they do not follow a time of day.
        let offset = f64::from(hours * 3600 + minutes * 60);
        before.contains(':').then_some((before, sign * offset))
    };
    split().unwrap_or((text, 0.0))
}

fn is_leap(year: i64) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

fn days_in(year: i64, month: i64) -> i64 {
    match month {
        2 => 28 + i64::from(is_leap(year)),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

impl fmt::Display for Utc {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut day = self.microseconds.div_euclid(DAY);
        let clock = self.microseconds.rem_euclid(DAY);
        let (mut year, mut month) = (1970, 1);
        while day < 0 {
            year -= 1;
            day += 365 + i64::from(is_leap(year));
        }
        while day >= 365 + i64::from(is_leap(year)) {
            day -= 365 + i64::from(is_leap(year));
            year += 1;
        }
        while day >= days_in(year, month) {
            day -= days_in(year, month);
            month += 1;
        }
        let (second, micro) = (clock / 1_000_000, clock % 1_000_000);
        write!(
            f,
            "{year:04}-{month:02}-{:02}T{:02}:{:02}:{:02}",
            day + 1,
            second / 3600,
            second / 60 % 60,
            second % 60
        )?;
        if micro % 1000 == 0 {
            write!(f, ".{:03}Z", micro / 1000)
        } else {
            write!(f, ".{micro:06}Z")
        }
    }
}

impl FromStr for Utc {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        Self::in_header(text, DateOrder::DayFirst).ok_or_else(|| {
            MotionError::parameter(
                "instant (UTC)",
                "a date and a time such as 2014-08-24T10:20:33.000Z",
                format!("\"{text}\""),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_day_of_three_centuries_prints_and_parses_back() {
        let mut day = Utc::new(1900, 1, 1, 23, 59, 58.25).unwrap();
        // 300 years, 73 of them leap years; 1900 and 2100 are not.
        for _ in 0..300 * 365 + 73 {
            let text = day.to_string();
            assert_eq!(text.parse::<Utc>().unwrap(), day, "{text}");
            day = day.later(86_400.0);
        }
        assert!(day.to_string().starts_with("2200-01-01T23:59:58.250"));
    }

    #[test]
    fn known_instants_are_met() {
        assert_eq!(Utc::new(1970, 1, 1, 0, 0, 0.0).unwrap().microseconds, 0);
        assert_eq!(Utc::of_unix(0), Utc::new(1970, 1, 1, 0, 0, 0.0));
        for (seconds, date) in [
            (86_399, "1970-01-01"),
            (68_256_000, "1972-03-01"),
            (1_408_875_644, "2014-08-24"),
            (4_107_542_399, "2100-02-28"),
            (4_107_542_400, "2100-03-01"),
            (7_258_118_399, "2199-12-31"),
        ] {
            assert_eq!(Utc::of_unix(seconds).unwrap().date(), date);
        }
        assert_eq!([7_258_118_400, u64::MAX].map(Utc::of_unix), [None; 2]);
        // 946 684 800 s: the Unix time of the year 2000.
        assert_eq!(Utc::new(2000, 1, 1, 0, 0, 0.0).unwrap().microseconds, 946_684_800_000_000);
        let napa = Utc::new(2014, 8, 24, 10, 20, 33.0);
        assert_eq!(napa, Utc::ordinal(2014, 236, 10, 20, 33.0));
        let us = |text: &str| Utc::in_header(text, DateOrder::MonthFirst);
        assert_eq!(us(" 8/24/14, 10:20:33.0 UTC (GPS)"), napa);
        assert_eq!(us("08/24/2014, 10:20:33.000 UTC (Q=2)"), napa);
        assert_eq!(us("2014/08/24 10:20:33.0 UTC (Q=5)"), napa);
        assert_eq!(Utc::in_header("24/08/2014 10:20:33.000000 (GMT)", DateOrder::DayFirst), napa);
        assert_eq!(us("2014-08-24T12:20:33+02:00"), napa);
        for local in ["06:20:33 -04:00", "06:20:33-0400", "06:20:33 -04", "13:20:33 (UTC+0300)"] {
            assert_eq!(us(&format!("2014-08-24 {local}")), napa, "{local}");
        }
        assert_eq!(us("8/24/2014 10:20:33 AM"), napa);
        assert_eq!(us("8/24/2014 12:20:33 AM"), Utc::new(2014, 8, 24, 0, 20, 33.0));
        assert_eq!(us("8/24/2014 10:20:33 PM"), Utc::new(2014, 8, 24, 22, 20, 33.0));
        for nothing in ["", "To be determined", "13/45/14, 10:20:33", "2014 02 30 1 1 1", "1 2 3"] {
            assert_eq!(us(nothing), None, "{nothing}");
        }
    }
}
