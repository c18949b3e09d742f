//! The verdict on results that several engines computed.

use barrelstack::ensemble::CaseResult;
use barrelstack::scenario::View;
use barrelstack::variants::{Plane, Spread, together, words};
use barrelstack_report::{Language, badge};
use serde::Serialize;

use crate::{Case, Request, trails};

/// The verdict on the results of variants.
#[derive(Serialize)]
pub(crate) struct Verdict {
    /// Verdict in one sentence.
    headline: String,
    /// HTML that shows the verdict as a symbol and a word.
    badge: String,
    tone: &'static str,
    /// Verdict in each plane.
    planes: Vec<Judged>,
}

/// The verdict in one plane.
#[derive(Serialize)]
struct Judged {
    view: &'static str,
    /// Name of the plane, such as "across the barrels".
    words: String,
    /// Result in this plane, such as "falls in 97 % of variants".
    fate: String,
    spread: Spread,
}

impl Verdict {
    pub(crate) fn of(
        planes: &[Plane],
        request: Request,
        language: Language,
    ) -> Result<Self, String> {
        let numbers = request.numbers.clone();
        let found = together(planes, &numbers, given(planes, request)?);
        let spreads: Vec<(View, &Spread)> =
            found.iter().filter_map(|one| Some((one.view?, &one.spread))).collect();
        let tone = words::tone(&spreads);
        let judged = |&(view, spread): &(View, &Spread)| Judged {
            view: view.name(),
            words: language.text(view.words()),
            fate: language.text(&words::fate(spread)),
            spread: spread.clone(),
        };
        Ok(Self {
            headline: language.text(&words::headline(&spreads)),
            badge: badge(tone, language),
            tone: tone.class(),
            planes: spreads.iter().map(judged).collect(),
        })
    }
}

/// Returns the results in a request, one list for each plane. The first result of a list is that of the nominal case.
fn given(planes: &[Plane], request: Request) -> Result<Vec<Vec<CaseResult>>, String> {
    let Request { numbers, cases, .. } = request;
    let whole = cases.iter().all(|plane| plane.len() == numbers.len());
    if cases.len() != planes.len() || !whole || numbers.first() != Some(&0) {
        return Err(format!(
            "`cases` must have one list for each plane (planes: {}), and each list must have one result for each value \
             in `numbers`; the first value in `numbers` must be 0",
            planes.len()
        ));
    }
    cases.into_iter().map(|plane| plane.into_iter().map(Case::result).collect()).collect()
}

/// Returns the results of all variants, with the paths of their barrels.
pub(crate) fn results(
    planes: &[Plane],
    request: Request,
    trails: &[u8],
) -> Result<Vec<Vec<CaseResult>>, String> {
    let all = planes.first().map(Plane::numbers).unwrap_or_default();
    let mut trails = trails::read(trails).ok_or("the request ends within its trails")?;
    if request.numbers != all {
        return Err(format!(
            "a report needs the results of all {} variants, but the request has the results of only {}",
            all.len().saturating_sub(1),
            request.numbers.len().saturating_sub(1)
        ));
    }
    let mut results = given(planes, request)?;
    for (plane, results) in (0..).zip(&mut results) {
        for (number, result) in all.iter().zip(results) {
            let trail = trails.remove(&(plane, *number));
            result.trail = trail.ok_or_else(|| format!("no barrel paths of variant {number}"))?;
        }
    }
    Ok(results)
}
