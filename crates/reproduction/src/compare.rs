//! Comparison of one published result with ours, and their agreement.

use std::fmt::Write as _;

use barrelstack_report::capital;

/// Largest relative difference from the published number that is considered agreement.
pub(super) const CLOSE: f64 = 0.20;

/// The result of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Agreement {
    /// Within ±20 % of the published number, or qualitatively equal.
    Agrees,
    /// Off by more than 20 %, but within the wider band that the project accepts.
    InBand,
    /// Neither within ±20 % nor within the wider band, or qualitatively different.
    Differs,
    /// Not compared: the paper's record was not given, or the paper states no result.
    NotCompared,
}

impl Agreement {
    /// Returns the agreement as worded in the tables.
    pub fn words(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::InBand => "within the band",
            Self::Differs => "differs",
            Self::NotCompared => "not compared",
        }
    }
}

/// One published result compared with ours.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Place in the paper, such as "section 4" or "Fig. 6b".
    pub place: &'static str,
    /// The quantity compared.
    pub quantity: String,
    /// The published result, with its unit.
    pub published: String,
    /// Our result, with its unit.
    pub ours: String,
    /// Relative difference: our number divided by the published number, minus one. `None` if no
    /// numbers are compared.
    pub difference: Option<f64>,
    /// The wider band that the project accepts, in words, if there is one.
    pub band: Option<&'static str>,
    /// Agreement of our result with the published result.
    pub agreement: Agreement,
    /// Explanation of the difference, or method of measurement.
    pub why: String,
}

/// Placeholder for a result that the paper does not state.
pub(crate) const NOT_STATED: &str = "not stated";

impl Comparison {
    /// Returns `true` if the paper states a result.
    pub fn is_published(&self) -> bool {
        self.published != NOT_STATED
    }
}

/// Formats a fraction as a signed percentage.
pub fn percent(share: f64) -> String {
    let rounded = (100.0 * share).round();
    let sign = if rounded < 0.0 { "−" } else { "+" };
    format!("{sign}{} %", rounded.abs())
}

/// Formats all comparisons as one Markdown table, as in `validation/README.md`.
pub(super) fn table(rows: &[Comparison]) -> String {
    let mut text = String::from(
        "| quantity | published | ours | difference | band | verdict | why |\n\
         | :--- | :--- | :--- | :--- | :--- | :--- | :--- |\n",
    );
    for row in rows {
        let difference = row.difference.map_or_else(|| "–".to_owned(), percent);
        let cells = [
            row.quantity.as_str(),
            &row.published,
            &row.ours,
            &difference,
            row.band.unwrap_or("–"),
            row.agreement.words(),
            &sentence(&row.why),
        ];
        let cells = cells.map(|cell| cell.replace('*', "\\*").replace('|', "\\|"));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text
}

/// Capitalizes a phrase and ends it with a period; an empty phrase stays empty.
fn sentence(words: &str) -> String {
    let end = if words.is_empty() || words.ends_with('.') { "" } else { "." };
    format!("{}{end}", capital(words))
}

/// Wider band that the project accepts for a number: lower limit, upper limit, and description.
pub(super) type Band = (f64, f64, &'static str);

/// Compares our number with the published one, in the same unit.
///
/// `ours` is `None` if the published event does not happen in our run; this counts as a difference.
pub(super) fn number(
    place: &'static str,
    quantity: &str,
    (published, unit): (f64, &str),
    ours: Option<f64>,
    band: Option<Band>,
    why: impl Into<String>,
) -> Comparison {
    let difference = ours.map(|ours| ours / published - 1.0);
    let within = |(low, high, _): Band| ours.is_some_and(|ours| (low..=high).contains(&ours));
    let agreement = if difference.is_some_and(|d| d.abs() <= CLOSE) {
        Agreement::Agrees
    } else if band.is_some_and(within) {
        Agreement::InBand
    } else {
        Agreement::Differs
    };
    let text = |value: String| format!("{value} {unit}").trim_end().to_owned();
    let shown = |ours: f64| text(barrelstack_report::significant(ours, 3));
    Comparison {
        place,
        quantity: quantity.to_owned(),
        // Published numbers have two digits; a third would claim more than the paper states.
        published: text(published.to_string()),
        ours: ours.map_or_else(|| "does not happen".to_owned(), shown),
        difference,
        band: band.map(|(_, _, words)| words),
        agreement,
        why: why.into(),
    }
}

/// Compares a qualitative finding.
pub(super) fn finding(
    place: &'static str,
    quantity: &str,
    published: &str,
    ours: impl Into<String>,
    same: bool,
    why: impl Into<String>,
) -> Comparison {
    Comparison {
        place,
        quantity: quantity.to_owned(),
        published: published.to_owned(),
        ours: ours.into(),
        difference: None,
        band: None,
        agreement: if same { Agreement::Agrees } else { Agreement::Differs },
        why: why.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Agreement, Band, number};

    fn judge(ours: Option<f64>, band: Option<Band>) -> Agreement {
        number("", "", (10.0, "s"), ours, band, "").agreement
    }

    #[test]
    fn the_agreement_is_the_narrowest_band_that_holds() {
        let band = Some((5.0, 15.0, "5 to 15 s"));
        assert_eq!(judge(Some(11.9), band), Agreement::Agrees);
        assert_eq!(judge(Some(12.1), band), Agreement::InBand);
        assert_eq!(judge(Some(12.1), None), Agreement::Differs);
        assert_eq!(judge(Some(15.1), band), Agreement::Differs);
        assert_eq!(judge(None, band), Agreement::Differs);
    }
}
