//! Display names of records: event with year, station, and component.

use crate::record::{Channel, Record};

/// Words of two letters that are converted to title case. Other words of one or two letters are
/// treated as codes, which remain in capitals.
const SHORT: [&str; 5] = ["EL", "LA", "LE", "DE", "OF"];

impl Record {
    /// Returns the display name of the event, such as "Northridge 1994", or `None` if the header
    /// states no event.
    ///
    /// ```
    /// let napa = barrelstack_motion::bundled("napa-college-2014").unwrap();
    /// assert_eq!(napa.event_name().as_deref(), Some("South Napa 2014"));
    /// ```
    pub fn event_name(&self) -> Option<String> {
        let text = self.event.split_whitespace().collect::<Vec<_>>().join(" ");
        let text = text.trim_start_matches("Rcrd of ").trim_start_matches("Record of ");
        let words: Vec<&str> = text.split(' ').collect();
        let dated = words.iter().position(|word| year(word).is_some());
        let letters = |word: &&&str| word.chars().any(char::is_alphabetic);
        let before = &words[..dated.unwrap_or(words.len())];
        // Some headers begin with the date, followed by the name.
        let after = words.iter().skip(dated.map_or(0, |at| at + 1));
        let name = if before.iter().any(|word| letters(&word)) {
            before.join(" ")
        } else {
            after.skip_while(|word| !letters(word)).copied().collect::<Vec<_>>().join(" ")
        };
        let name = name.split(',').next().unwrap_or_default().trim().to_owned();
        let year = dated.and_then(|at| year(words[at]));
        let named = name.chars().filter(|c| c.is_alphabetic()).count() > 2;
        named.then(|| match year {
            Some(year) => format!("{} {year}", softened(&name)),
            None => softened(&name),
        })
    }

    /// Returns the display name of the station, or `None` if the header states no station.
    pub fn station_name(&self) -> Option<String> {
        let text = self.station.split_whitespace().collect::<Vec<_>>().join(" ");
        // Remove a network code before the name.
        let coded =
            text.split_once(' ').filter(|(code, _)| code.chars().any(|c| c.is_ascii_digit()));
        let name = coded.map_or(text.as_str(), |(_, name)| name);
        // Remove the state after the name. Also remove the town before the name if the name begins
        // with the town.
        let name = name.split_once(", ").map_or(name, |(name, _)| name);
        let name = match name.split_once(" - ") {
            Some((town, place)) if place.starts_with(town) => place,
            _ => name,
        };
        (!name.is_empty()).then(|| softened(name))
    }

    /// Returns the display name of a channel, such as "Northridge 1994, Arleta, 360°". If the
    /// header states neither event nor station, the file name is used.
    pub fn name_of(&self, channel: &Channel) -> String {
        let file = || self.file.rsplit(['/', '\\']).next().unwrap_or(&self.file).to_owned();
        let known: Vec<String> = self.event_name().into_iter().chain(self.station_name()).collect();
        let degrees = if channel.name.parse::<f64>().is_ok() { "°" } else { "" };
        let place = if known.is_empty() { file() } else { known.join(", ") };
        let component = format!("{}{degrees}", channel.name);
        // If the header states nothing, some channels are named after their file.
        if component.is_empty() || (known.is_empty() && place.contains(&component)) {
            place
        } else {
            format!("{place}, {component}")
        }
    }
}

/// Parses the year of a date such as 01/17/94, 2014-08-24 or 1989.
fn year(word: &str) -> Option<u32> {
    let word = word.trim_matches(|c: char| !c.is_ascii_digit());
    let parts: Vec<&str> = word.split(['/', '-']).collect();
    let number = |text: &str| text.parse::<u32>().ok();
    let full = |year: &u32| (1900..2100).contains(year);
    match parts.as_slice() {
        [year] | [year, _, _] | [_, _, year] if year.len() == 4 => number(year).filter(full),
        // Two-digit years below 30 are in this century; no instrument recorded before 1930.
        [_, _, year] if year.len() == 2 => {
            number(year).map(|year| if year < 30 { 2000 + year } else { 1900 + year })
        }
        _ => None,
    }
}

/// Converts a text in capitals to title case; a text with lowercase letters is unchanged.
fn softened(text: &str) -> String {
    if text.chars().any(char::is_lowercase) {
        return text.to_owned();
    }
    let soft = |word: &str| {
        // Codes of stations and states remain in capitals.
        if word.chars().any(|c| c.is_ascii_digit()) || (word.len() < 3 && !SHORT.contains(&word)) {
            return word.to_owned();
        }
        let mut first = true;
        let lower = |c: char| {
            let kept = std::mem::replace(&mut first, !c.is_alphabetic());
            if kept { c } else { c.to_ascii_lowercase() }
        };
        word.chars().map(lower).collect()
    };
    text.split(' ').map(soft).collect::<Vec<String>>().join(" ")
}

#[cfg(test)]
mod tests {
    use crate::record::{Channel, Record, Stage};
    use crate::{Direction, ReadOptions};

    fn record(event: &str, station: &str) -> Record {
        let mut record = Record::new("peer", "/home/me/RSN1.AT2", Stage::Unknown);
        (record.event, record.station) = (event.to_owned(), station.to_owned());
        record
    }

    #[test]
    fn records_are_called_as_people_call_them_and_else_by_their_file_without_its_folder() {
        let cases = [
            ("NORTHRIDGE 01/17/94 1231", "ARLETA", "360", "Northridge 1994, Arleta, 360°"),
            (
                "IMPERIAL VALLEY 5/19/40 0439",
                "EL CENTRO ARRAY #9",
                "180",
                "Imperial Valley 1940, El Centro Array #9, 180°",
            ),
            (
                "South Napa, California, 2014-08-24 10:20:44 UTC, M 6.0",
                "CE.68150 Napa - Napa College, California",
                "E",
                "South Napa 2014, Napa College, E",
            ),
            ("1989  10  18    0004 Loma Prieta, CA", "", "H1", "Loma Prieta 1989, H1"),
            ("Chi-Chi, Taiwan 9/20/1999", "TCU065", "E", "Chi-Chi 1999, TCU065, E"),
            ("", "", "090", "RSN1.AT2, 090°"),
            ("2019/07/06 03:19", "", "RSN1", "RSN1.AT2"),
        ];
        for (event, station, name, words) in cases {
            let channel = Channel::new(name, Direction::some_horizontal(), 0.01, Vec::new());
            assert_eq!(record(event, station).name_of(&channel), words);
        }
    }

    #[test]
    fn no_header_of_a_format_gives_a_name_without_letters() {
        let text = b"PEER\n 01/17/94 1231, , 360\nACCELERATION IN UNITS OF G\nNPTS=  4, DT= .02000 SEC\n 0 1 -1 0\n";
        let read = crate::read(text, "a/b.AT2", &ReadOptions::default()).unwrap();
        assert!(read.event_name().is_none_or(|name| name.chars().any(char::is_alphabetic)));
    }
}
