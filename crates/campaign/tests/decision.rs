//! Decisions from tables with known answers.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

mod common;

use barrelstack_campaign::decision::{
    DecisionError, LimitState, Request, SiteHazard, decide, export,
};
use barrelstack_campaign::study::{Collected, Role, StudyTable, Values};
use barrelstack_report::html;
use barrelstack_report::{Axis, Figure, FigureKind, Plot, Series, SeriesStyle};
use common::{integer, made, number, skipped, text};

/// Twelve records at eight levels; `falls` returns the number of fallen barrels of six for a record at a level (m/s).
fn study(falls: impl Fn(usize, f64) -> usize) -> Collected {
    let levels = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
    let cases: Vec<(usize, f64)> =
        (0..12).flat_map(|record| levels.map(|level| (record, level))).collect();
    let count: Vec<usize> = cases.iter().map(|(record, level)| falls(*record, *level)).collect();
    let each = |of: &dyn Fn(usize, f64, usize) -> Option<f64>| -> Vec<Option<f64>> {
        cases.iter().zip(&count).map(|((r, x), n)| of(*r, *x, *n)).collect()
    };
    let say = |of: &dyn Fn(usize) -> Option<String>| count.iter().map(|n| of(*n)).collect();
    let rows = cases.len();
    let columns = vec![
        integer("case", Role::Key, (0..rows).map(|row| i64::try_from(row).ok()).collect()),
        number("friction", "", Role::Factor, each(&|r, _, _| Some(0.3 + 0.02 * r as f64))),
        text(
            "record",
            Role::Motion,
            cases.iter().map(|(r, _)| Some(format!("record {r}"))).collect(),
        ),
        number("level", "m/s", Role::Motion, each(&|_, x, _| Some(x))),
        number("pga", "m/s2", Role::Intensity, each(&|r, x, _| Some(x * (6.0 + 0.5 * r as f64)))),
        number("pgv", "m/s", Role::Intensity, each(&|_, x, _| Some(x * (1.0 + 1e-12)))),
        text(
            "outcome",
            Role::Outcome,
            say(&|n| Some(if n > 0 { "collapse" } else { "stable" }.into())),
        ),
        text("ended", Role::Run, vec![Some("rest".into()); rows]),
        number("motion_left", "s", Role::Run, vec![Some(0.0); rows]),
        text("mode", Role::Outcome, say(&|n| (n > 0).then(|| "rocking".into()))),
        integer("barrels", Role::Outcome, vec![Some(6); rows]),
        text("fall_heights", Role::Outcome, say(&|n| (n > 0).then(|| vec!["1.8"; n].join(";")))),
        text("fall_forces", Role::Outcome, say(&|n| (n > 0).then(|| vec!["1.1e6"; n].join(";")))),
        text("fall_wine", Role::Outcome, say(&|n| (n > 0).then(|| vec!["0.225"; n].join(";")))),
        number("stack_wine", "m3", Role::Outcome, vec![Some(6.0 * 0.225); rows]),
        number("top_drift_ratio", "", Role::Demand, each(&|_, x, n| (n == 0).then_some(0.05 * x))),
    ];
    made(columns, "stripes", &["friction"], "record ", 12)
}

/// Capacity of each record (m/s): lognormal by its quantiles, median 0.5, dispersion 0.3.
fn capacity(record: usize) -> f64 {
    let share = (record as f64 + 0.5) / 12.0;
    0.5 * (0.3 * barrelstack_fragility::normal_quantile(share)).exp()
}

fn ordinary() -> Collected {
    study(|record, level| if level >= capacity(record) { 4 } else { 0 })
}

#[test]
fn the_fragility_of_known_capacities_is_found_and_the_curve_is_not_doubted() {
    let found = decide(&ordinary(), &Request::default()).unwrap();
    let curve = &found.curves[0];
    assert_eq!(curve.limit, LimitState::SeatLost);
    let fit = curve.fit.as_ref().unwrap();
    assert!((fit.curve.median / 0.5 - 1.0).abs() < 0.05, "{:?}", fit.curve);
    assert!((fit.curve.dispersion / 0.3 - 1.0).abs() < 0.25, "{:?}", fit.curve);
    assert!(curve.median.unwrap().holds(0.5));
    assert!(curve.returned.is_empty() && curve.monotony.p == 1.0);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    // Raw counts are those of the table.
    let failures: u32 = curve.stripes.iter().map(|stripe| stripe.failures).sum();
    assert_eq!(failures as usize, found.cases.all.iter().filter(|case| case.collapsed).count());
}

#[test]
fn the_same_study_gives_the_same_page_to_the_byte() {
    let once = || decide(&ordinary(), &Request::default()).unwrap();
    assert_eq!(html(&once().document), html(&once().document));
    let written = || serde_json::to_string(&once().to_document()).unwrap();
    assert_eq!(written(), written());
}

#[test]
fn an_island_of_collapse_is_told_with_its_levels_and_not_smoothed_away() {
    // Everything between 0.3 and 0.5 m/s falls, little stands again above, all falls at the top.
    let island = study(|record, level| {
        let falls = (0.3..0.55).contains(&level) || level > 0.85 || (record == 0 && level > 0.3);
        if falls { 2 } else { 0 }
    });
    let found = decide(&island, &Request::default()).unwrap();
    let told = found.warnings.iter().find(|w| w.contains("not monotone")).expect("a warning");
    assert!(told.contains("12 of 12 cases at 50 cm/s, but only 1 of 12 at 60 cm/s"), "{told}");
    assert!(found.document.verdict.headline.contains("raw fractions"));
    assert!(found.warnings.iter().any(|w| w.contains("standing at a higher level")));
    assert_eq!(found.curves[0].returned.len(), 11);
}

#[test]
fn a_stack_that_never_falls_gets_its_bound_and_no_curve() {
    let found = decide(&study(|_, _| 0), &Request::default()).unwrap();
    let reason = found.curves[0].fit.as_ref().unwrap_err().to_string();
    assert!(reason.starts_with("no case failed up to"), "{reason}");
    let interval = found.curves[0].intervals[7];
    assert!(interval.low == 0.0 && (interval.high - 0.2425).abs() < 1e-3, "{interval:?}");
    assert!(html(&found.document).contains("No fragility curve is fitted"));
}

#[test]
fn losses_count_barrels_and_burst_them_by_the_height_of_their_fall() {
    let found = decide(&ordinary(), &Request::default()).unwrap();
    let last = found.losses.as_ref().unwrap().levels.last().unwrap();
    let collapsed = (0..12).filter(|record| capacity(*record) <= 0.9).count() as f64;
    assert!((last.fallen - 4.0 * collapsed / 12.0).abs() < 1e-12);
    let chance = barrelstack_campaign::decision::Breakage::RANGE[1].probability(1.8);
    assert!((chance - 0.0443).abs() < 5e-4, "{chance}");
    assert!((last.burst[1] - chance * last.fallen).abs() < 1e-12);
    assert!(last.burst[0] < last.burst[1] && last.burst[1] < last.burst[2]);
    // Φ(ln(1.1/2.2)/0.36) = Φ(−1.9254).
    let by_force = last.burst_by_force.unwrap() / last.fallen;
    assert!((by_force - 0.02709).abs() < 1e-4, "{by_force}");
    assert!(html(&found.document).contains("burst, by force"));
}

#[test]
fn a_hazard_curve_gives_annual_rates_that_agree_with_the_closed_form() {
    // λ = 10⁻³ (x/0.5)⁻² from 1 cm/s to 50 m/s.
    let mut rows = String::new();
    for i in 0..=40 {
        let x = (0.2 * f64::from(i) - 100.0_f64.ln()).exp();
        rows += &[100.0 * x, 1e-3 * (x / 0.5).powi(-2)].map(|v| v.to_string()).join(",");
        rows += "\n";
    }
    let hazard =
        SiteHazard::parse("site.csv", &format!("pgv (cm/s),rate (1/year)\n{rows}")).unwrap();
    let request = Request { hazard: Some(hazard), years: Some(50.0) };
    let found = decide(&ordinary(), &request).unwrap();
    let site = found.site.as_ref().unwrap();
    let curve = found.curves[0].fit.as_ref().unwrap().curve;
    let exact =
        1e-3 * (curve.median / 0.5).powi(-2) * (0.5 * (2.0 * curve.dispersion).powi(2)).exp();
    let rate = site.limits[0].fitted.unwrap();
    assert!((rate.low / exact - 1.0).abs() < 1e-3, "{} {exact}", rate.low); // measured 1e-6
    let chance = 1.0 - (-50.0 * rate.low).exp();
    assert!((site.limits[0].chance - chance).abs() < 1e-12);
    assert!(site.lost.as_ref().is_some_and(|lost| lost.fallen.low > 0.0 && lost.wine[1] > 0.0));
    assert!(site.limits[0].interval.unwrap().holds(rate.low));
}

#[test]
fn wine_and_money_follow_what_is_in_the_barrels() {
    let hazard = "pgv (cm/s),rate (1/year)\n5,0.1\n20,0.01\n200,0.001\n";
    let lost = |each: f64| {
        let mut collected = ordinary();
        let mut columns = collected.table.columns().to_vec();
        for column in &mut columns {
            match (column.spec.name.as_str(), &mut column.values) {
                ("fall_wine", Values::Text(all)) => {
                    for one in all.iter_mut().flatten() {
                        *one = one.replace("0.225", &each.to_string());
                    }
                }
                ("stack_wine", Values::Number(all)) => all.fill(Some(6.0 * each)),
                _ => {}
            }
        }
        collected.table = StudyTable::new(columns).unwrap();
        let hazard = Some(SiteHazard::parse("site.csv", hazard).unwrap());
        let found = decide(&collected, &Request { hazard, years: None }).unwrap();
        for level in &found.losses.as_ref().unwrap().levels {
            for (wine, burst) in level.wine.iter().zip(level.burst) {
                assert!((wine - each * burst).abs() < 1e-12, "{wine} {burst}");
            }
        }
        let lost = found.site.unwrap().lost.unwrap();
        (lost.wine[1], lost.burst[1].low, lost.money)
    };
    let full = lost(0.225);
    let (wine, burst, _) = full;
    assert!((wine / burst / 0.225 - 1.0).abs() < 1e-9);
    for each in [0.0, 0.09, 0.225, 0.5] {
        let (wine, burst, money) = lost(each);
        assert!((wine - full.0 * each / 0.225).abs() < 1e-9 * full.0, "{each} m³: {wine}");
        // By hand: bottles of 0.75 L at US$4 to 20, barrels at US$400 to 1,200.
        let by_hand = [(4.0, 400.0), (20.0, 1200.0)]
            .map(|(bottle, barrel)| wine / 0.75e-3 * bottle + burst * barrel);
        for (one, other) in money.iter().zip(by_hand) {
            assert!((one - other).abs() <= 1e-9 * other, "{each} m³: {one} {other}");
        }
    }
}

#[test]
fn a_hazard_curve_that_does_not_serve_is_refused_with_the_place() {
    let refused = |text: &str| SiteHazard::parse("site.csv", text).unwrap_err().to_string();
    let said = refused("pgv (cm/s),rate\n5,0.1\n20,0.01\n");
    assert!(said.contains("site.csv, line 1") && said.contains("rate (1/year)"), "{said}");
    let said = refused("speed (cm/s),rate (1/year)\n5,0.1\n20,0.01\n");
    assert!(said.contains("pgv") && said.contains("speed"), "{said}");
    let said = refused("pgv (cm/s),rate (1/year)\n5,0.1\n20,0.2\n");
    assert!(said.contains("row 2") && said.contains("cannot be exceeded more often"), "{said}");
    let said = refused("pgv (cm/s),rate (1/year)\n5,0.1\n20,x\n");
    assert!(said.contains("line 3") && said.contains("\"x\""), "{said}");
    let hazard =
        SiteHazard::parse("site.csv", "pga (g),rate (1/year)\n0.1,0.1\n0.2,0.01\n").unwrap();
    let request = Request { hazard: Some(hazard), years: None };
    let error = decide(&ordinary(), &request).unwrap_err();
    assert!(error.to_string().contains("are over pgv; give"), "{error}");
}

#[test]
fn a_table_that_tells_no_forces_says_nothing_of_what_bursts_by_them() {
    let mut collected = ordinary();
    let mut columns = collected.table.columns().to_vec();
    columns.retain(|column| column.spec.name != "fall_forces");
    collected.table = StudyTable::new(columns).unwrap();
    let found = decide(&collected, &Request::default()).unwrap();
    let last = found.losses.as_ref().unwrap().levels.last().unwrap();
    assert!(last.burst_by_force.is_none() && last.burst[1] > 0.0);
    assert!(!html(&found.document).contains("burst, by force"));
}

#[test]
fn a_table_without_a_verdict_is_refused() {
    let mut collected = ordinary();
    let mut columns = collected.table.columns().to_vec();
    for column in &mut columns {
        if column.spec.name == "outcome" {
            column.values = Values::Text(vec![Some("error".into()); 96]);
        }
    }
    collected.table = StudyTable::new(columns).unwrap();
    let error = decide(&collected, &Request::default()).unwrap_err();
    assert!(matches!(error, DecisionError::NoCases { rows: 96 }), "{error}");
}

#[test]
fn one_at_a_time_rests_on_the_base_where_the_first_chunk_is_missing() {
    let mut collected = ordinary();
    let mut columns = collected.table.columns().to_vec();
    // Eight cases of another friction come first; the base of both factors is in the missing part.
    let first = |row: usize, one: f64, other: f64| Some(if row < 8 { one } else { other });
    columns[1] =
        number("friction", "", Role::Factor, (0..96).map(|k| first(k, 0.5, 0.3)).collect());
    let cask = |k: usize| first(k, 1.0, if k < 48 { 2.0 } else { 3.0 });
    columns.insert(2, number("cask", "", Role::Factor, (0..96).map(cask).collect()));
    collected.table = StudyTable::new(columns).unwrap();
    collected.provenance.columns = collected.table.specs().cloned().collect();
    collected.provenance.design = "one-at-a-time".into();
    collected.provenance.drawn.clear();
    let effects = decide(&collected, &Request::default()).unwrap().effects;
    let told: Vec<_> = effects.iter().map(|of| (of.factor.as_str(), of.groups.len())).collect();
    assert_eq!(told, [("cask", 2)]);
}

#[test]
fn shares_of_one_change_at_a_time_are_told_at_each_level_with_intervals_that_count_motions() {
    let mut collected = ordinary();
    let mut columns = collected.table.columns().to_vec();
    // Every record is drawn one friction; another cask is tried on all of them.
    let cask = |k: usize| Some(if k.is_multiple_of(2) { 1.0 } else { 2.0 });
    let rows: Vec<usize> = (0..96).flat_map(|row| [row, row]).collect();
    for column in &mut columns {
        let mut values = Values::empty(column.spec.kind);
        for row in &rows {
            values.push(column.values.get(*row)).unwrap();
        }
        column.values = values;
    }
    columns.insert(2, number("cask", "", Role::Factor, (0..192).map(cask).collect()));
    collected.table = StudyTable::new(columns).unwrap();
    collected.provenance.columns = collected.table.specs().cloned().collect();
    collected.provenance.design = "one-at-a-time".into();
    let found = decide(&collected, &Request::default()).unwrap();
    let effect = found.effects.iter().find(|effect| effect.factor == "cask").unwrap();
    for group in &effect.groups {
        assert_eq!((group.cases, group.levels.len()), (96, 8));
        for level in &group.levels {
            let failed = (0..12).filter(|record| capacity(*record) <= level.intensity).count();
            assert_eq!((level.cases, level.collapsed as usize), (12, failed));
            // One case per motion: the interval of Wilson, a little wider by Student's t.
            let one = barrelstack_fragility::wilson(level.collapsed, 12, 0.95);
            assert!(level.interval.high - level.interval.low >= one.high - one.low - 1e-9);
        }
        // All levels of a motion are clustered, so that the interval is wider than that of independent cases.
        let alone = barrelstack_fragility::wilson(group.collapsed, 96, 0.95);
        assert!(group.interval.low < alone.low && group.interval.high > alone.high);
    }
    assert!(html(&found.document).contains("Intervals count motions"));
}

#[test]
fn every_measure_stands_in_one_table_and_the_cause_comes_first() {
    let found = decide(&ordinary(), &Request::default()).unwrap();
    assert_eq!(found.measures.len(), 2);
    let first = &found.cases.measures[found.measures[0].measure].name;
    // Capacities were set in PGV and decrease with the number of the record, which PGA contains.
    let likelihood = |at: usize| found.measures[at].collapse.as_ref().unwrap().fit.ln_likelihood;
    assert!(likelihood(0) >= likelihood(1), "{first}");
    assert!(found.measures.iter().all(|row| row.drift.is_some()));
}

#[test]
fn hunted_levels_count_by_first_collapse_and_not_by_where_the_hunt_went() {
    let mut collected = ordinary();
    collected.provenance.design = "ida".into();
    let found = decide(&collected, &Request::default()).unwrap();
    let fit = found.curves[0].fit.as_ref().unwrap();
    assert!((fit.curve.median / 0.5 - 1.0).abs() < 0.05, "{:?}", fit.curve);
    assert!(found.curves[0].monotony.p == 1.0);
    // At the highest level the state of every record is known: it failed below or stood there.
    let last = found.curves[0].stripes.last().unwrap();
    let failed = (0..12).filter(|record| capacity(*record) <= 0.9).count();
    assert_eq!((last.intensity, last.cases, last.failures as usize), (0.9, 12, failed));
    assert!(found.warnings.iter().any(|w| w.starts_with("Levels were chosen by hunting")));
}

#[test]
fn what_is_exported_is_the_same_curve_to_four_digits() {
    let collected = ordinary();
    let decision = decide(&collected, &Request::default()).unwrap();
    let found = export(&decision, &collected.provenance, "stack <A>").unwrap();
    let text =
        |name: &str| &found.files.iter().find(|(known, _)| *known == name).expect("a file").1;
    // OpenQuake states a lognormal capacity by its mean and standard deviation, over PGV in cm/s.
    let parsed = roxmltree::Document::parse(text("openquake-fragility.xml")).unwrap();
    let node = |name: &str| parsed.descendants().find(|n| n.has_tag_name(name)).expect("a node");
    assert_eq!(node("imls").attribute("imt"), Some("PGV"));
    assert_eq!(
        node("fragilityFunction").attribute("id"),
        Some("stack__A_"),
        "as OpenQuake takes names"
    );
    assert!(
        found
            .notes
            .contains(&"OpenQuake takes no name like stack <A>: there it is stack__A_".into())
    );
    assert!(node("description").text().unwrap().contains("seed 7"));
    let names: Vec<&str> = node("limitStates").text().unwrap().split_whitespace().collect();
    let params: Vec<_> = parsed.descendants().filter(|n| n.has_tag_name("params")).collect();
    assert_eq!(params.iter().map(|n| n.attribute("ls").unwrap()).collect::<Vec<_>>(), names);
    let fitted: Vec<_> =
        decision.curves.iter().filter_map(|curve| curve.fit.as_ref().ok()).collect();
    assert_eq!(fitted.len(), names.len());
    let row: Vec<&str> = text("pelicun-fragility.csv").lines().nth(1).unwrap().split(',').collect();
    for (at, (node, fit)) in params.iter().zip(&fitted).enumerate() {
        let number = |name| node.attribute(name).unwrap().parse::<f64>().unwrap();
        let (mean, deviation) = (number("mean"), number("stddev"));
        let variance = (1.0 + (deviation / mean).powi(2)).ln();
        let median = mean / (0.5 * variance).exp();
        let theirs = barrelstack_fragility::Lognormal { median, dispersion: variance.sqrt() };
        let column = |k: usize| row[6 + 4 * at + k].parse::<f64>().unwrap();
        let pelicun = barrelstack_fragility::Lognormal { median: column(1), dispersion: column(2) };
        for x in [0.3, 0.5, 0.8] {
            let ours = fit.curve.probability(x);
            // Measured: 1e-15.
            assert!((theirs.probability(100.0 * x) - ours).abs() < 1e-12);
            assert!((pelicun.probability(100.0 * x) - ours).abs() < 1e-12);
        }
    }
    let parsed = roxmltree::Document::parse(text("openquake-vulnerability.xml")).unwrap();
    let node = |name: &str| parsed.descendants().find(|n| n.has_tag_name(name)).expect("a node");
    let numbers = |name: &str| -> Vec<f64> {
        node(name).text().unwrap().split_whitespace().map(|n| n.parse().unwrap()).collect()
    };
    let losses = decision.losses.as_ref().unwrap();
    for (mean, loss) in numbers("meanLRs").iter().zip(&losses.levels) {
        assert!((mean - loss.fallen / 6.0).abs() < 1e-12);
    }
    assert_eq!(numbers("imls").len(), numbers("covLRs").len());
    // Names of any length and script are reduced to valid OpenQuake identifiers.
    let long = export(&decision, &collected.provenance, &"fût ".repeat(40)).unwrap();
    let (_, text) = long.files.iter().find(|(name, _)| name.contains("vulnerability")).unwrap();
    let parsed = roxmltree::Document::parse(text).unwrap();
    for node in parsed.descendants().filter(|n| n.has_tag_name("vulnerabilityFunction")) {
        let id = node.attribute("id").unwrap();
        assert!(id.len() <= 75 && id.is_ascii() && id.contains("_t_f"), "{id}");
    }
}

/// Prints the probabilities at 10, 20, … 150 cm/s by OpenQuake's own reader and curves.
const OPENQUAKE: &str = "
import sys, numpy
import openquake.risklib.read_nrml
from openquake.hazardlib import nrml
model = nrml.to_python(sys.argv[1])
for functions in model.values():
    for name, curve in zip(model.limitStates, functions.build(model.limitStates, 100, 1)):
        print(*curve(numpy.linspace(10.0, 150.0, 15)))
for loss in nrml.to_python(sys.argv[1].replace('fragility', 'vulnerability')).values():
    print(*loss.mean_loss_ratios)
";

/// Prints the same by Pelicun's, which convert to m/s.
const PELICUN: &str = "
import sys, numpy
from pelicun import uq
from pelicun.assessment import DLCalculationAssessment
damage = DLCalculationAssessment({'PrintLog': False, 'Seed': 1}).damage
damage.load_model_parameters([sys.argv[1]], {'wine.barrel.stack'})
read = damage.ds_model.damage_params
for state in dict.fromkeys(c for c in read.columns.get_level_values(0) if c.startswith('LS')):
    family, *theta = (read[(state, k)].iloc[0] for k in ('Family', 'Theta_0', 'Theta_1'))
    curve = uq.rv_class_map(family)(state, theta=numpy.array(theta, dtype=float))
    print(*curve.cdf(numpy.linspace(0.1, 1.5, 15)))
";

/// Plots our curves as lines, those of another program as dots.
fn beside(at: &[f64], ours: &[Vec<f64>], theirs: &[f64]) -> Figure {
    let dots = SeriesStyle { dots: true, index: Some(5), ..SeriesStyle::default() };
    let mut series = Vec::new();
    for (ours, theirs) in ours.iter().zip(theirs.chunks(at.len())) {
        let style = SeriesStyle { index: Some(0), ..SeriesStyle::default() };
        let label = if series.is_empty() { "ours" } else { "" };
        series.push(Series { style, ..Series::new(label, at.to_vec(), ours.clone()) });
        for (x, y) in at.iter().zip(theirs) {
            let label = if *x == at[0] && series.len() == 1 { "theirs" } else { "" };
            series.push(Series { style: dots, ..Series::new(label, vec![*x], vec![*y]) });
        }
    }
    let (x, y) = (Axis::new("PGV", "m/s"), Axis::new("chance", ""));
    let kind = FigureKind::Plot(Plot { x, y, series, ..Plot::default() });
    Figure { id: "beside".into(), caption: String::new(), kind }
}

/// Checks that another program reads the exported curves and agrees from 10 to 150 cm/s.
///
/// Plots both into the folder that `BARRELSTACK_PAGES` names.
fn read_by(module: &str, file: &str, script: &str) {
    let python =
        |arguments: &[&str]| std::process::Command::new("python3").args(arguments).output();
    if !python(&["-c", &format!("import {module}")]).is_ok_and(|o| o.status.success()) {
        return skipped(&format!("python3 has no module {module}"));
    }
    // The further a stack is shaken beyond its capacity, the more barrels fall.
    let collected = study(|record, level| match level / capacity(record) {
        over if over < 1.0 => 0,
        over if over < 1.2 => 1,
        over if over < 1.5 => 3,
        _ => 6,
    });
    let decision = decide(&collected, &Request::default()).unwrap();
    let found = export(&decision, &collected.provenance, "wine.barrel.stack").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(file);
    for (name, text) in &found.files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let output = python(&["-c", script, path.to_str().unwrap()]).unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    // Other output has no lines of numbers alone.
    let numbers = |line: &str| -> Option<Vec<f64>> {
        line.split_whitespace().map(|word| word.parse().ok()).collect()
    };
    let theirs: Vec<f64> = said.lines().filter_map(numbers).flatten().collect();
    let fits = decision.curves.iter().filter_map(|curve| curve.fit.as_ref().ok());
    let at: Vec<f64> = (1..=15).map(|k| 0.1 * f64::from(k)).collect();
    let curves: Vec<Vec<f64>> =
        fits.map(|fit| at.iter().map(|x| fit.curve.probability(*x)).collect()).collect();
    if let Ok(folder) = std::env::var("BARRELSTACK_PAGES") {
        let picture = std::path::Path::new(&folder).join(file).with_extension("png");
        std::fs::write(picture, beside(&at, &curves, &theirs).to_png(144.0)).unwrap();
    }
    let mut ours = curves.concat();
    if file.starts_with("openquake") {
        let levels = &decision.losses.as_ref().unwrap().levels;
        ours.extend(levels.iter().map(|loss| loss.fallen / 6.0));
        ours.extend(levels.iter().map(|loss| loss.burst[1] / 6.0));
    }
    assert_eq!(theirs.len(), ours.len(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    for (theirs, ours) in theirs.iter().zip(&ours) {
        // Measured: 4e-16 by Pelicun, 6e-6 by OpenQuake, which holds chances constant outside its range.
        assert!((theirs - ours).abs() < 1e-4, "{file}: {theirs}, not {ours}");
    }
}

#[test]
fn openquake_reads_the_curves_that_were_exported() {
    read_by("openquake.risklib.read_nrml", "openquake-fragility.xml", OPENQUAKE);
}

#[test]
fn pelicun_reads_the_curves_that_were_exported() {
    read_by("pelicun.assessment", "pelicun-fragility.csv", PELICUN);
}
