//! Stacks that survive an aftershock, for several strengths of the aftershock after the same main shock.

use std::ops::ControlFlow;
use std::path::Path;

use barrelstack::report::WORDS;
use barrelstack::summary::Unfinished;
use barrelstack::variants::{Advance, Range};
use barrelstack_report::{
    Block, Cell, Document, Language, Table, Tone, Verdict, described, listed,
};

use crate::answer::shared;
use crate::report::count;
use crate::sample::{Case, CellarFailure, Prepared, each};
use crate::scenario::Cellar;
use crate::summary::{self, Count, Mean, ShockAnswer};
use crate::words::{failed, followed, longest_cut, mean_share, span, survival};

described! {
    /// Stacks of a cellar that survive aftershocks of several strengths. The main shock of every variant is run once;
    /// each aftershock starts with the bodies at rest in the poses in which the main shock left them.
    #[derive(Clone, Debug)]
    pub struct AftershockSummary {
        /// Name and version of the format of this document.
        pub schema: &'static str ["aftershocks/1"],
        /// Title of the cellar.
        pub title: String,
        /// Result in one sentence.
        pub headline: String,
        /// Fingerprint of the cellar.
        pub cellar_hash: String,
        /// Number of stacks.
        pub stacks: usize,
        /// Motion that is multiplied by each factor of `aftershocks`: the main shock, or the record of the aftershock.
        pub factor_of: &'static str ["main-shock", "record"],
        /// Number of variants that the statistics count; 1 if only the room as stated was run.
        pub counted: u32,
        /// Numbers of the variants whose computation failed; they are not counted.
        pub broken: Vec<u32>,
        /// Number of finished variants; null if the work was not stopped early.
        pub unfinished: Option<Unfinished>,
        /// The main shock; null if no run is counted.
        pub main: Option<ShockAnswer>,
        /// The aftershocks, the weakest first; empty if no run is counted.
        pub aftershocks: Vec<Strength>,
        /// Stacks that stand after the main shock in at least one variant, in the order in which to inspect them:
        /// sorted by how often they fall under the weakest aftershock, then under each stronger aftershock, and finally
        /// by how far they moved; the largest values come first.
        pub inspection: Vec<Margin>,
        /// Warnings, one sentence each.
        pub warnings: Vec<String>,
        /// Name of the program.
        pub program: &'static str,
        /// Version of the program.
        pub version: &'static str,
        /// Sentences on the sources of the motions, on their processing, and on bodies that do not start as built.
        pub provenance: Vec<String>,
        /// Wall-clock time of the computation; null if not measured.
        pub wall_seconds: Option<f64> as "s",
    }

    /// An aftershock.
    #[derive(Clone, Debug)]
    pub struct Strength {
        /// Factor that multiplies the motion named by `factor_of`.
        pub factor: f64 as "1",
        /// Survival of the stacks that stand after the main shock.
        pub shock: ShockAnswer,
    }

    /// Survival of one stack in the aftershocks.
    #[derive(Clone, Debug)]
    pub struct Margin {
        /// Name of the stack.
        pub name: String,
        /// Variants in which the stack stands after the main shock.
        pub stands: Count,
        /// For each aftershock, the number of variants in which the stack falls, of those in which it stands after the
        /// main shock.
        pub falls: Vec<Count>,
        /// Distribution of the largest horizontal displacement of a body of the stack at the end of the main shock,
        /// over the variants in which the stack stands.
        pub moved: Option<Range> as "m",
    }
}

/// Results of one variant: one case for each aftershock strength, in the order of the strengths.
type OfVariant = Vec<Case>;

/// Runs the main shock of every variant of a cellar, and then each of several alternative aftershocks.
///
/// An aftershock has the motion in the file `record`, or the motion of the cellar if `record` is `None`. Each strength
/// is a factor by which this motion is multiplied. The observer receives the progress and may stop the work; the
/// results obtained until then are returned.
///
/// # Errors
/// If `strengths` is empty, the cellar already has a sequence of shocks, the scale of its motion cannot be multiplied
/// by a factor, the plan has a problem, or a stack cannot be built or does not stand under its own weight.
pub fn aftershocks(
    cellar: &Cellar,
    strengths: &[f64],
    record: Option<&Path>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<AftershockSummary, CellarFailure> {
    let followed = |factor: &f64| -> Result<Prepared, CellarFailure> {
        Prepared::new(&cellar.clone().with_aftershock(*factor, record)?)
    };
    let prepared: Vec<Prepared> = strengths.iter().map(followed).collect::<Result<_, _>>()?;
    let Some(main) = prepared.first() else {
        let message = "there is no aftershock: state at least one strength".to_owned();
        return Err(cellar.host.error(&["motion"], message).into());
    };
    let numbers: Vec<u32> = (main.count().min(1)..=main.count()).collect();
    let of = numbers.len();
    let report = shared(observer);
    let report = |done| report(Advance::Variants { done, of });
    let found = each(&numbers, &report, &|number, threads, look| {
        let (room, first) = main.first(number, threads, look)?;
        let mut cases = OfVariant::new();
        for one in &prepared {
            let run = one.continued(room.clone(), first.clone(), threads, look)?;
            if run.interrupted {
                return Ok(None);
            }
            cases.push(one.case(number, &run));
        }
        Ok(Some(cases))
    })?;
    let found: Vec<OfVariant> = found.into_iter().flatten().collect();
    let unfinished = (found.len() < of).then_some(Unfinished { done: found.len(), of });
    let factor_of = if record.is_some() { "record" } else { "main-shock" };
    Ok(summarized((strengths, factor_of), &prepared, &found, unfinished))
}

fn summarized(
    (strengths, factor_of): (&[f64], &'static str),
    prepared: &[Prepared],
    found: &[OfVariant],
    unfinished: Option<Unfinished>,
) -> AftershockSummary {
    let valid = |of: &&OfVariant| of.iter().all(|case| case.valid);
    let counted: Vec<&OfVariant> = found.iter().filter(valid).collect();
    // All strengths are compared in the same variants: those that are valid under every strength.
    let cases = |at: usize| -> Vec<&Case> { counted.iter().map(|of| &of[at]).collect() };
    let shocks = |at: usize| {
        let all = cases(at);
        let shown = all.first()?;
        let [main, after] = <[_; 2]>::try_from(summary::shocks(&prepared[at], &all, shown)).ok()?;
        Some((main, after))
    };
    let answers: Vec<_> = (0..prepared.len()).filter_map(shocks).collect();
    let warnings = found.iter().flatten().flat_map(|case| &case.warnings);
    let mut warnings = summary::grouped(warnings);
    warnings.extend(unfinished.as_ref().map(Unfinished::warning));
    let first = &prepared[0];
    let mut provenance = Vec::new();
    for step in prepared.iter().flat_map(summary::provenance) {
        if !provenance.contains(&step) {
            provenance.push(step);
        }
    }
    let mut summary = AftershockSummary {
        schema: "aftershocks/1",
        title: first.cellar.title.clone(),
        headline: String::new(),
        cellar_hash: first.plan.summary.cellar_hash.clone(),
        stacks: first.plan.stacks.len(),
        factor_of,
        counted: u32::try_from(counted.len()).unwrap_or(u32::MAX),
        broken: found.iter().filter(|of| !valid(of)).map(|of| of[0].variant).collect(),
        unfinished,
        main: answers.first().map(|(main, _)| main.clone()),
        aftershocks: strengths
            .iter()
            .zip(answers)
            .map(|(factor, (_, shock))| Strength { factor: *factor, shock })
            .collect(),
        inspection: inspection(first, &counted),
        warnings,
        program: "barrelstack",
        version: env!("CARGO_PKG_VERSION"),
        provenance,
        wall_seconds: None,
    };
    summary.headline = headline(&summary);
    summary
}

/// Returns the stacks that stand after the main shock in at least one variant, in the order in which they should be
/// inspected.
fn inspection(prepared: &Prepared, counted: &[&OfVariant]) -> Vec<Margin> {
    let margin = |(at, standing): (usize, &crate::scenario::Standing)| {
        let after = |case: &Case| !case.shocks[1].stacks[at].fallen_before;
        let first: Vec<&Case> = counted.iter().map(|of| &of[0]).collect();
        let standing_in: Vec<&&OfVariant> = counted.iter().filter(|of| after(&of[0])).collect();
        let strengths = 0..counted.first().map_or(0, |of| of.len());
        let falls = |strength: usize| {
            let cases: Vec<&Case> = standing_in.iter().map(|of| &of[strength]).collect();
            Count::of(&cases, |case| case.shocks[1].stacks[at].fell_at.is_some())
        };
        Margin {
            name: standing.name.clone(),
            stands: Count::of(&first, after),
            falls: strengths.map(falls).collect(),
            moved: Range::of(standing_in.iter().map(|of| of[0].shocks[0].stacks[at].moved)),
        }
    };
    let all = prepared.plan.stacks.iter().enumerate().map(margin);
    let mut all: Vec<Margin> = all.filter(|margin| margin.stands.of_variants > 0).collect();
    let key = |margin: &Margin| -> Vec<f64> {
        let moved = margin.moved.map_or(0.0, |moved| moved.p50);
        margin.falls.iter().map(|count| count.share.unwrap_or(0.0)).chain([moved]).collect()
    };
    all.sort_by(|a, b| key(b).partial_cmp(&key(a)).unwrap_or(std::cmp::Ordering::Equal));
    all
}

/// Returns the result in one sentence.
fn headline(summary: &AftershockSummary) -> String {
    if let Some(Unfinished { done, of }) = summary.unfinished {
        return format!("Stopped after {done} of {of} variants: there is no verdict.");
    }
    let Some(main) = &summary.main else { return "No run has a valid result.".to_owned() };
    let (stacks, of) = (summary.stacks, summary.counted);
    let shocks = summary.aftershocks.iter().map(|one| &one.shock).chain([main]);
    let cut = longest_cut(shocks).map_or(String::new(), |cut| format!(" {}", followed(cut)));
    let Some(first) = summary.aftershocks.first().filter(|one| one.shock.stood_in > 0) else {
        let variants = if of == 1 { String::new() } else { format!(" in any of {of} variants") };
        return format!("No stack stands after the main shock{variants}.{cut}");
    };
    let clause = |(at, one): (usize, &Strength)| {
        let some = match one.shock.share_survive.filter(|_| of > 1) {
            Some(share) => mean_share(&share),
            None => surviving(&one.shock).to_string(),
        };
        let survive = if some == "1" { "survives" } else { "survive" };
        match at {
            0 => format!("{some} {survive} an aftershock of {}", strength(summary, one.factor)),
            _ => format!("{some} {survive} one of {} times the strength", one.factor),
        }
    };
    let clauses = listed(summary.aftershocks.iter().enumerate().map(clause));
    let stood = first.shock.stood;
    if of == 1 {
        let stand = if stood.to_string() == "1" { "stands" } else { "stand" };
        return format!(
            "Of {stacks} stacks, {stood} {stand} after the main shock, in one run. Of these, {clauses}.{cut}"
        );
    }
    format!(
        "Of {stacks} stacks, {stood:.1} stand after the main shock on average. Of these, {clauses}.{cut}"
    )
}

/// Returns a phrase that names a factor and the motion that it scales.
fn strength(summary: &AftershockSummary, factor: f64) -> String {
    let of = if summary.factor_of == "record" { "its record" } else { "the main shock" };
    format!("{factor} times the strength of {of}")
}

/// Returns the mean number of stacks that survive a shock.
fn surviving(shock: &ShockAnswer) -> f64 {
    shock.stood - shock.by_themselves - shock.knocked_over
}

/// Largest number of stacks named in the sentence that states which stacks to inspect first.
const LISTED: usize = 5;

/// Returns the sentences that support the headline: one for each aftershock, and the stacks to inspect first.
pub fn sentences(summary: &AftershockSummary) -> Vec<String> {
    if summary.unfinished.is_some() {
        return Vec::new();
    }
    let of = summary.counted;
    let sentence = |one: &Strength| {
        let strength = strength(summary, one.factor);
        format!("An aftershock of {strength}: {}.", survival(&one.shock, of))
    };
    let mut all: Vec<String> = summary.aftershocks.iter().map(sentence).collect();
    let first: Vec<&String> =
        summary.inspection.iter().take(LISTED).map(|margin| &margin.name).collect();
    if !first.is_empty() {
        all.push(format!("Stacks to inspect first, if they still stand: {}.", listed(first)));
    }
    all.extend(failed(summary.broken.len()));
    all
}

/// Returns two tables: one with a row per aftershock strength, and one with a row per stack that stands after the main
/// shock.
pub fn tables(summary: &AftershockSummary) -> [Table; 2] {
    let strengths = Table::of(
        "Aftershocks after the same main shock. Numbers of stacks are means over the variants; the share of the \
         stacks that survive is taken over the variants in which at least one stack stands after the main shock, \
         with its 95 % interval.",
        &summary.aftershocks,
        &[
            ("strength", "of the motion", &|one| Cell::text(one.factor.to_string())),
            ("stacks standing before", "", &|one| Cell::Measured(one.shock.stood, 1)),
            ("fall by themselves", "", &|one| Cell::Measured(one.shock.by_themselves, 1)),
            ("knocked over", "", &|one| Cell::Measured(one.shock.knocked_over, 1)),
            ("survive", "", &|one| Cell::maybe(one.shock.share_survive.as_ref().map(mean_share))),
            ("all survive", "", &|one| count(&one.shock.all_survive)),
            ("barrels fallen", "", &|one| {
                Cell::text(span(&one.shock.barrels_fallen, summary.counted, 0, "").trim_end())
            }),
        ],
    );
    let names: Vec<String> = summary
        .aftershocks
        .iter()
        .map(|one| format!("falls under strength {}", one.factor))
        .collect();
    let mut columns: Vec<Column<'_>> = vec![
        ("stack", "", Box::new(|one| Cell::text(&one.name))),
        ("stands after the main shock", "", Box::new(|one| count(&one.stands))),
    ];
    for (at, name) in names.iter().enumerate() {
        columns.push((
            name,
            "",
            Box::new(move |one| one.falls.get(at).map_or(Cell::Missing, count)),
        ));
    }
    columns.push((
        "movement",
        "cm",
        Box::new(|one| Cell::measured(one.moved.map(|moved| 100.0 * moved.p50), 1)),
    ));
    let columns: Vec<_> = columns.iter().map(|(name, unit, of)| (*name, *unit, &**of)).collect();
    let stacks = Table::of(
        "Stacks in the order in which to inspect them. Shares are given with their 95 % intervals: the share of all \
         variants in which a stack stands after the main shock, and the share of these variants in which it falls \
         under an aftershock. Movement in the main shock is the median over the variants in which the stack stands \
         after it.",
        summary.inspection.iter().cloned(),
        &columns,
    );
    [strengths, stacks]
}

/// Returns the machine-readable counterparts of [`tables`], with one number in each cell. The first has one row per
/// aftershock strength; the second has one row per stack and strength.
fn numbers(summary: &AftershockSummary) -> [Table; 2] {
    let number = |value: f64| Cell::Number(value, 6);
    let share = |one: &Strength, of: fn(&Mean) -> f64| {
        Cell::number(one.shock.share_survive.as_ref().map(of), 6)
    };
    let strengths = Table::of(
        "",
        &summary.aftershocks,
        &[
            ("strength", "1", &|one| number(one.factor)),
            ("stacks standing before", "1", &|one| number(one.shock.stood)),
            ("fall by themselves", "1", &|one| number(one.shock.by_themselves)),
            ("knocked over", "1", &|one| number(one.shock.knocked_over)),
            ("share that survives", "1", &|one| share(one, |share| share.mean)),
            ("interval low", "1", &|one| share(one, |share| share.interval[0])),
            ("interval high", "1", &|one| share(one, |share| share.interval[1])),
            ("all survive", "variants", &|one| number(one.shock.all_survive.of_variants.into())),
            ("some stand before", "variants", &|one| number(one.shock.stood_in.into())),
            ("median of barrels fallen", "1", &|one| number(one.shock.barrels_fallen.p50)),
        ],
    );
    let factors: Vec<f64> = summary.aftershocks.iter().map(|one| one.factor).collect();
    let rows = summary.inspection.iter().flat_map(|margin| {
        factors.iter().zip(&margin.falls).map(move |(factor, falls)| (margin, *factor, *falls))
    });
    let rows: Vec<(&Margin, f64, Count)> = rows.collect();
    let stacks = Table::of(
        "",
        rows,
        &[
            ("stack", "", &|(one, ..)| Cell::text(&one.name)),
            ("strength", "1", &|(_, factor, _)| number(*factor)),
            ("stands after the main shock", "variants", &|(one, ..)| {
                number(one.stands.of_variants.into())
            }),
            ("falls", "variants", &|(.., falls)| number(falls.of_variants.into())),
            ("median movement in the main shock", "m", &|(one, ..)| {
                Cell::number(one.moved.map(|moved| moved.p50), 6)
            }),
        ],
    );
    [strengths, stacks]
}

/// A column of a table: its name, its unit, and its cells.
type Column<'a> = (&'a str, &'a str, Box<dyn Fn(&Margin) -> Cell + 'a>);

/// Returns the report as a document that does not depend on the output format.
pub fn document(summary: &AftershockSummary) -> Document {
    let [strengths, stacks] = tables(summary);
    let mut blocks =
        vec![Block::heading(2, "Results by strength of the aftershock"), Block::Table(strengths)];
    if !summary.inspection.is_empty() {
        blocks.extend([Block::heading(2, "What to inspect first"), Block::Table(stacks)]);
    }
    let row = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    let mut provenance = vec![
        row("program", &format!("{} {}", summary.program, summary.version)),
        row("cellar", &summary.cellar_hash),
        row("variants", &summary.counted.to_string()),
    ];
    provenance.extend(summary.provenance.iter().map(|step| row("source", step)));
    Document {
        title: summary.title.clone(),
        verdict: Verdict {
            headline: summary.headline.clone(),
            sentences: sentences(summary),
            tone: if summary.unfinished.is_some() || summary.main.is_none() {
                Tone::Invalid
            } else {
                Tone::Neutral
            },
            ..Verdict::default()
        },
        blocks,
        provenance,
        words: WORDS.to_vec(),
        warnings: summary.warnings.clone(),
        ..Document::default()
    }
}

/// Returns the name and the contents of each output file; the report is in the given language.
///
/// # Errors
/// If the summary cannot be written as JSON.
pub fn files(
    summary: &AftershockSummary,
    language: Language,
) -> Result<Vec<(String, Vec<u8>)>, serde_json::Error> {
    let page = barrelstack_report::html(&document(summary).in_language(language));
    let json = described::to_json(summary)? + "\n";
    let [strengths, stacks] = numbers(summary).map(|table| table.to_csv().into_bytes());
    Ok(vec![
        ("report.html".to_owned(), page.into_bytes()),
        ("aftershocks.json".to_owned(), json.into_bytes()),
        ("aftershocks.csv".to_owned(), strengths),
        ("inspection.csv".to_owned(), stacks),
    ])
}
