//! Report page of a study: first the result, then the evidence for it.

use barrelstack::breakage::Breakage;
use barrelstack_fragility::{Stripe, clopper_pearson};
use barrelstack_report::{Block, Cell, Document, Table, Verdict, capital, measured, significant};

use super::cases::{Cases, Measure};
use super::curve::{BandKind, LEVEL, LimitCurve};
use super::hazard::{LimitRate, Site};
use super::loss::Losses;
use super::modes::ModeIncidence;
use super::words::{self, count, percent, range};
use super::{Decision, figures, tables};
use crate::scenario::Scenario;
use crate::study::Provenance;

/// Builds the report page of a decision.
pub(super) fn document(decision: &Decision, made: &Provenance) -> Document {
    Document {
        title: decision.cases.title.clone(),
        verdict: Verdict {
            headline: words::headline(decision),
            sentences: words::sentences(decision),
            ..Verdict::default()
        },
        blocks: blocks(decision, made),
        provenance: provenance(made),
        warnings: decision.warnings.clone(),
        words: barrelstack::report::WORDS.to_vec(),
        ..Document::default()
    }
}

/// Returns a block with the heading of a section.
pub(crate) fn heading(text: &str) -> Block {
    Block::Heading { level: 2, text: text.to_owned() }
}

/// Returns the fingerprint of a scenario as text.
pub(crate) fn fingerprint(scenario: &Scenario) -> String {
    format!("{:016x}", scenario.fingerprint())
}

pub(crate) fn text(text: impl Into<String>) -> Block {
    Block::Paragraph(text.into())
}

fn blocks(decision: &Decision, made: &Provenance) -> Vec<Block> {
    let cases = &decision.cases;
    let measure = cases.measure();
    let collapse = &decision.curves[0];
    let mut blocks = vec![
        heading("Probability of collapse"),
        Block::Figure(figures::fragility(collapse, measure)),
        Block::Table(raw(collapse, measure)),
    ];
    blocks.extend(judgment(cases, collapse, measure));
    if decision.curves.len() > 1 {
        blocks.push(heading("Numbers of barrels"));
        blocks.push(Block::Figure(figures::limits(&decision.curves, measure)));
    }
    blocks.push(Block::Table(limits(&decision.curves, cases)));
    if !decision.modes.is_empty() {
        blocks.push(heading("Modes of collapse"));
        blocks.push(Block::Figure(figures::modes(&decision.modes, collapse, measure)));
        blocks.push(Block::Table(modes(&decision.modes, measure)));
    }
    if let Some(figure) = figures::ida(cases, &collapse.returned) {
        blocks.push(heading("Motion by motion"));
        blocks.push(Block::Figure(figure));
    }
    blocks.push(heading("Losses"));
    match &decision.losses {
        Ok(found) => {
            blocks.push(Block::Figure(figures::losses(found, measure)));
            blocks.push(Block::Table(losses(found, measure)));
            blocks.push(Block::Details {
                summary: "Assumptions about barrels that burst".into(),
                blocks: assumptions(),
            });
        }
        Err(reason) => blocks.push(text(format!("Not known: {reason}."))),
    }
    if let Some(site) = &decision.site {
        blocks.extend(at_site(site, measure));
    }
    // No effects are shown for an incremental dynamic analysis, since its shares of collapse depend on the levels that
    // the hunts chose.
    if !decision.sensitivities.is_empty() {
        blocks.push(heading("Influence of the varied quantities"));
        blocks.push(Block::Table(tables::indices(&decision.sensitivities)));
        blocks.push(text(
            "The first-order index is the share of the variance that would vanish if the quantity were known; the \
             total index is the share that would remain if all other quantities were known. The total index exceeds \
             the first-order index by the effect of interactions. Demands are recorded until the stack collapses. A \
             quantity without effect in these blocks may have an effect in others; the upper end of an interval is \
             therefore never zero.",
        ));
    } else if !decision.effects.is_empty() && !cases.hunted {
        let collapsed = cases.all.iter().filter(|case| case.collapsed).count() as f64;
        let overall = collapsed / cases.all.len() as f64;
        blocks.push(heading("Influence of the varied quantities"));
        blocks.push(Block::Figure(figures::tornado(&decision.effects, overall)));
        blocks.push(Block::Table(tables::effects(decision)));
    }
    blocks.push(heading("Measures of shaking as predictors of collapse"));
    blocks.push(Block::Table(tables::measures(decision)));
    blocks.push(text(
        "Dispersion is the scatter that a measure leaves unexplained: the smaller it is, the fewer records are needed. \
         Concordance is the probability that this measure is larger for a case that collapsed than for a case that \
         stood (0.5 is no better than chance). A small p in the last columns means that the measure under \"tested \
         against\" adds information to the measure of the row, which is then not sufficient.",
    ));
    blocks.push(heading("Motions"));
    blocks.push(Block::Table(motions(decision, made)));
    blocks
}

/// Tabulates raw counts with their intervals, and the fitted curve.
pub(super) fn raw(curve: &LimitCurve, measure: &Measure) -> Table {
    let exact = |of: &Stripe| clopper_pearson(of.failures, of.cases, LEVEL);
    let fitted = |of: &Stripe| {
        let fit = curve.fit.as_ref().ok();
        Cell::maybe(fit.map(|fit| percent(fit.curve.probability(of.intensity))))
    };
    Table::of(
        format!(
            "Cases that reach the limit state \"{}\": raw counts, and the fitted curve.",
            curve.limit.words()
        ),
        curve.stripes.iter().zip(&curve.intervals),
        &[
            (&measure.label, measure.shown_unit, &|(of, _)| measure.cell(of.intensity)),
            ("cases", "", &|(of, _)| count(of.cases)),
            ("failed", "", &|(of, _)| count(of.failures)),
            ("share", "", &|(of, _)| Cell::text(percent(of.fraction()))),
            ("95 % interval (Wilson)", "", &|(_, wilson)| Cell::text(range(**wilson, percent))),
            ("95 % interval (exact)", "", &|(of, _)| Cell::text(range(exact(of), percent))),
            ("fitted curve", "", &|(of, _)| fitted(of)),
        ],
    )
}

/// Describes how the curve was fitted and how well the data support it.
fn judgment(cases: &Cases, curve: &LimitCurve, measure: &Measure) -> Vec<Block> {
    let mut said = Vec::new();
    if !cases.hunted && !cases.shares_levels(cases.main) {
        said.push(format!(
            "The cases were not run at common levels, so they are counted in {} bins of about {} neighboring cases; \
             the intensity of a bin is the geometric mean over its cases. The curve is fitted to the individual cases.",
            curve.stripes.len(),
            cases.all.len() / curve.stripes.len().max(1)
        ));
    }
    match curve.standard_errors() {
        Err(reason) => {
            said.push(format!("No curve: {}.", words::refusal(reason, |x| measure.words(x))));
        }
        Ok([median, dispersion]) => {
            said.push(format!(
                "The lognormal curve is fitted by maximum likelihood (Baker 2015). Its standard errors are {} for ln θ \
                 and {} for ln β ({}).",
                significant(median, 2),
                significant(dispersion, 2),
                if curve.left_out.is_some() {
                    "clustered by record"
                } else {
                    "for independent cases"
                }
            ));
            said.push(match curve.band_kind {
                BandKind::Records => {
                    "The band is computed by omitting one record at a time (with Student's t), which allows for dependence between cases of the same record."
                        .to_owned()
                }
                BandKind::None => {
                    "There is no band: if one particular record is omitted, no curve can be fitted to the remaining \
                     cases."
                        .to_owned()
                }
                BandKind::Likelihood => {
                    "The band comes from the profile likelihood, with the cases treated as independent.".to_owned()
                }
            });
        }
    }
    if let Some(test) = curve.goodness {
        said.push(if test.freedom == 0 {
            "There are too few levels to test whether a lognormal curve fits.".to_owned()
        } else {
            format!(
                "Raw counts against the curve: χ² = {} with {} degree{} of freedom, p = {}.",
                significant(test.pearson, 3),
                test.freedom,
                if test.freedom == 1 { "" } else { "s" },
                significant(test.p, 2)
            )
        });
    }
    said.push(format!(
        "Test of monotonicity: the raw fractions {}.",
        if curve.monotony.deviance == 0.0 {
            "never decrease with intensity".to_owned()
        } else {
            format!(
                "decrease at some intensities (p = {} under the assumption that failure never becomes less likely \
                 with intensity)",
                significant(curve.monotony.p, 2)
            )
        }
    ));
    vec![Block::List(said)]
}

fn limits(curves: &[LimitCurve], cases: &Cases) -> Table {
    let measure = cases.measure();
    let unit = measure.shown_unit;
    let failed = |curve: &LimitCurve| {
        let sum = |of: fn(&Stripe) -> u32| curve.stripes.iter().map(of).sum::<u32>();
        format!("{} of {}", sum(|of| of.failures), sum(|of| of.cases))
    };
    let fitted = |curve: &LimitCurve| curve.fit.as_ref().ok().map(|fit| fit.curve);
    let shown = |x: f64| {
        if x.is_finite() { significant(measure.shown(x), 3) } else { "∞".to_owned() }
    };
    let interval =
        |curve: &LimitCurve| fitted(curve).and(curve.median).map(|bounds| range(bounds, shown));
    let violated =
        |curve: &LimitCurve| (curve.monotony.deviance != 0.0).then_some(curve.monotony.p);
    let returned = |curve: &LimitCurve| u32::try_from(curve.returned.len()).unwrap_or(u32::MAX);
    let remark = |curve: &LimitCurve| match &curve.fit {
        Ok(_) if curve.violates_order() => "not monotone: use the raw fractions".to_owned(),
        Ok(_) => String::new(),
        Err(reason) => words::refusal(reason, |x| measure.words(x)),
    };
    Table::of(
        "Fragility of every limit state.",
        curves,
        &[
            ("limit state", "", &|of| Cell::text(capital(&of.limit.words()))),
            ("failed", "", &|of| Cell::text(failed(of))),
            ("median θ", unit, &|of| {
                fitted(of).map_or(Cell::Missing, |of| measure.cell(of.median))
            }),
            ("95 % interval", unit, &|of| Cell::maybe(interval(of))),
            ("dispersion β", "", &|of| Cell::number(fitted(of).map(|of| of.dispersion), 2)),
            ("test of monotonicity (p)", "", &|of| Cell::number(violated(of), 2)),
            (
                &format!(
                    "{} {} which the stack fails at one level and stands at a higher level",
                    cases.curves_are(),
                    if cases.curves_are() == "motions" { "under" } else { "on" }
                ),
                "",
                &|of| count(returned(of)),
            ),
            ("remark", "", &|of| Cell::text(remark(of))),
        ],
    )
}

/// Tabulates the numbers of cases that collapsed in each mode.
fn modes(modes: &[ModeIncidence], measure: &Measure) -> Table {
    let mut columns = vec![(measure.label.clone(), measure.shown_unit), ("cases".to_owned(), "")];
    columns.extend(modes.iter().map(|mode| (mode.mode.replace('-', " "), "")));
    let named: Vec<(&str, &str)> =
        columns.iter().map(|(name, unit)| (name.as_str(), *unit)).collect();
    let mut table = Table::new(
        "Cases that collapse in each mode. A case collapses in one mode only, so the numbers in each row add up to the \
         number of collapses at its level.",
        &named,
    );
    for (row, stripe) in modes[0].stripes.iter().enumerate() {
        let mut cells = vec![measure.cell(stripe.intensity), count(stripe.cases)];
        cells.extend(modes.iter().map(|mode| count(mode.stripes[row].failures)));
        table.rows.push(cells);
    }
    table
}

fn losses(losses: &Losses, measure: &Measure) -> Table {
    // The column is omitted if the study does not record forces.
    let by_force = losses.levels.iter().any(|loss| loss.burst_by_force.is_some());
    let mut columns = vec![
        (measure.label.as_str(), measure.shown_unit),
        ("cases", ""),
        ("barrels fallen", ""),
        ("95 % interval", ""),
        ("barrels burst, central assumption", ""),
        ("barrels burst, range of the assumptions", ""),
    ];
    columns.extend(by_force.then_some(("barrels burst, by force", "")));
    columns.push(("wine lost, central assumption", "L"));
    let mut table =
        Table::new("Expected losses of one stack: means over the cases of each level.", &columns);
    for loss in &losses.levels {
        let [few, central, many] = loss.burst;
        let mut cells = vec![
            measure.cell(loss.intensity),
            count(loss.cases as f64),
            Cell::Measured(loss.fallen, 1),
            Cell::text(range(loss.interval, |barrels| measured(barrels, 1))),
            Cell::Measured(central, 1),
            Cell::text(format!("{} to {}", measured(few, 1), measured(many, 1))),
        ];
        cells.extend(by_force.then(|| Cell::measured(loss.burst_by_force, 1)));
        cells.push(Cell::Measured(1000.0 * loss.wine[1], 0));
        table.rows.push(cells);
    }
    table
}

fn assumptions() -> Vec<Block> {
    let mut table = Table::new(
        "Assumed chance that a full barrel bursts, by the height of its fall.",
        &[
            ("assumption", ""),
            ("0.9 m", ""),
            ("1.8 m", ""),
            ("2.7 m", ""),
            ("3.6 m", ""),
            ("4.5 m", ""),
        ],
    );
    for (name, breakage) in ["few burst", "central", "many burst"].iter().zip(Breakage::RANGE) {
        let mut row = vec![Cell::text(*name)];
        row.extend([0.9, 1.8, 2.7, 3.6, 4.5].map(|h| Cell::text(percent(breakage.probability(h)))));
        table.rows.push(row);
    }
    vec![
        Block::Table(table),
        Block::List(vec![
            "No published drop tests of barrels with numerical results were found. About one in ten of the \
             barrels that toppled at Napa in 2014 was lost (Wines & Vines 2016); the heights of their falls are \
             not known. The central curve (lognormal, median height of fall 5 m, dispersion 0.6) was chosen to \
             match these reports: if stacks of four to six levels fall completely, 7 to 18 % of the barrels above the lowest \
             level burst."
                .into(),
            "\"By force\" means that the largest force on a barrel after it fell determines whether it bursts \
             (lognormal, median 2.2 MN, dispersion 0.36). For a fall on the floor this is equivalent to the central \
             assumption. The two assumptions differ where \
             barrels land on each other or on racks, or fall in steps; neither has been tested."
                .into(),
            "The assumed cost of a burst barrel is US$4 to US$20 per bottle of 0.75 L for its wine, plus US$400 to \
             US$1,200 for the barrel, regardless of its size."
                .into(),
            "A burst barrel loses all its wine; the volume follows from the size and the fill of the barrel in the \
             scenario. Partly filled barrels are assumed to burst like full ones. Barrels that do not burst lose \
             nothing here, although bungs may leak. Damage to neighboring stacks, racks and buildings is not counted."
                .into(),
            "Only cases that were followed until nothing moved are counted. In a plane model, every barrel \
             represents all barrels behind it in its row."
                .into(),
        ]),
    ]
}

fn at_site(site: &Site, measure: &Measure) -> Vec<Block> {
    let fitted = |of: &LimitRate| Cell::number(of.fitted.map(|rate| rate.low), 2);
    let interval = |of: &LimitRate| of.interval.map(|of| range(of, |rate| significant(rate, 2)));
    let once = |of: &LimitRate| {
        let used = of.fitted.as_ref().unwrap_or(&of.raw).low;
        Cell::number((used > 0.0).then(|| 1.0 / used), 2)
    };
    let table = Table::of(
        format!("Annual rates for one stack, with the hazard curve in {}.", site.hazard.file),
        &site.limits,
        &[
            ("limit state", "", &|of| Cell::text(capital(&of.limit.words()))),
            ("annual rate (fitted)", "1/year", &|of| fitted(of)),
            ("95 % interval", "1/year", &|of| Cell::maybe(interval(of))),
            ("annual rate (raw fractions)", "1/year", &|of| Cell::Number(of.raw.low, 2)),
            ("once in", "years", &|of| once(of)),
            (&format!("chance in {} years", site.years), "", &|of| Cell::text(percent(of.chance))),
        ],
    );
    let lost = site.lost.as_ref().map_or_else(
        || "The expected annual loss of a stack is not known, since the study does not record falls.".to_owned(),
        |lost| {
            let [few, central, many] = lost.burst.map(|rate| measured(rate.low, 2));
            let wine = lost.wine.map(|wine| measured(1000.0 * wine, 0));
            format!(
                "Expected annual loss of one stack: {} barrels fallen, {central} burst ({few} to {many}), {} L of \
                 wine lost ({} to {} L); burst barrels and wine are worth US${} to US${}. Multiply by the number of stacks.",
                measured(lost.fallen.low, 2),
                wine[1],
                wine[0],
                wine[2],
                measured(lost.money[0], 0),
                measured(lost.money[1], 0)
            )
        },
    );
    vec![
        heading("At your site"),
        Block::Table(table),
        text(lost),
        Block::Figure(figures::contributions(site, measure)),
        text(
            "The interval covers the uncertainty of the curve only; the hazard is taken as exact. Between the rows \
             of the hazard table the rate is interpolated on logarithmic scales. Shaking weaker than the first row \
             is assumed to have no effect, and shaking stronger than the last row is assumed to have the effect of \
             the last row.",
        ),
    ]
}

fn motions(decision: &Decision, made: &Provenance) -> Table {
    let mut counts = vec![(0_u32, 0_u32); decision.cases.records.len()];
    for case in &decision.cases.all {
        let (cases, collapsed) = &mut counts[case.record as usize];
        *cases += 1;
        *collapsed += u32::from(case.collapsed);
    }
    let source = |name: &str| {
        let found = made.motions.iter().find(|motion| motion.name == name);
        Cell::maybe(found.map(|motion| &motion.source))
    };
    Table::of(
        "Motions, with the number of cases run under each.",
        decision.cases.records.iter().zip(counts),
        &[
            ("motion", "", &|(name, _)| Cell::text(*name)),
            ("source", "", &|(name, _)| source(name)),
            ("cases", "", &|(_, (cases, _))| count(*cases)),
            ("collapsed", "", &|(_, (_, collapsed))| count(*collapsed)),
        ],
    )
}

fn provenance(made: &Provenance) -> Vec<(String, String)> {
    let done = format!("{} of {} chunks", made.chunks_done, made.chunks);
    [
        ("study", made.title.clone()),
        ("design", made.design.clone()),
        ("measure of the levels", made.measure.clone().unwrap_or_else(|| "none".into())),
        ("seed", made.seed.to_string()),
        ("fingerprint of the study", made.study_hash.clone()),
        ("done", done),
        ("program", format!("{} {}", made.program, made.version)),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into()
}
