//! Decisions from tables with known results.

use crate::common::{capacity, number, ordinary, study};
use barrelstack_campaign::decision::{DecisionError, LimitState, Request, SiteHazard, decide};
use barrelstack_campaign::study::{Collected, Role, StudyTable, Values};
use barrelstack_report::html;

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
    // The number comes first, then the stack and the direction.
    let headline = &found.document.verdict.headline;
    let stacks = "), half of the stacks of 4 levels on two-barrel racks, shaken along the barrels, collapse.";
    assert!(headline.starts_with("At a PGV of ") && headline.ends_with(stacks), "{headline}");
    // The raw counts must be those of the table.
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
fn an_island_of_collapse_is_reported_with_its_levels_and_not_smoothed_away() {
    // Stacks fall under all records from 0.3 to 0.5 m/s, under one record from 0.6 to 0.8 m/s, and under all again at
    // the top.
    let island = study(|record, level| {
        let falls = (0.3..0.55).contains(&level) || level > 0.85 || (record == 0 && level > 0.3);
        if falls { 2 } else { 0 }
    });
    let found = decide(&island, &Request::default()).unwrap();
    let warning =
        found.warnings.iter().find(|w| w.contains("steadily likelier")).expect("a warning");
    assert!(
        warning.contains("12 of 12 cases at 50 cm/s, but only in 1 of 12 at 60 cm/s"),
        "{warning}"
    );
    assert!(found.document.verdict.headline.contains("raw fractions"));
    assert!(found.warnings.iter().any(|w| w.contains("collapses at a lower level")));
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
    assert!(
        found.document.verdict.headline.starts_with("0 of 96 cases of stacks of 4 levels on "),
        "{}",
        found.document.verdict.headline
    );
}

#[test]
fn losses_count_barrels_and_burst_them_by_the_height_of_their_fall() {
    let found = decide(&ordinary(), &Request::default()).unwrap();
    let last = found.losses.as_ref().unwrap().levels.last().unwrap();
    let collapsed = (0..12).filter(|record| capacity(*record) <= 0.9).count() as f64;
    assert!((last.fallen - 4.0 * collapsed / 12.0).abs() < 1e-12);
    let chance = barrelstack::breakage::Breakage::RANGE[1].probability(1.8);
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
    assert!(error.to_string().contains("is for pgv; give"), "{error}");
}

#[test]
fn a_table_without_forces_gives_no_bursts_by_force() {
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
    // The first eight cases have another friction; the base values of both factors are in the missing part.
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
    let groups: Vec<_> = effects.iter().map(|of| (of.factor.as_str(), of.groups.len())).collect();
    assert_eq!(groups, [("cask", 2)]);
}

#[test]
fn shares_of_one_change_at_a_time_are_reported_at_each_level_with_intervals_that_count_motions() {
    let mut collected = ordinary();
    let mut columns = collected.table.columns().to_vec();
    // One friction is drawn for every record, and each of these is run with two kinds of cask.
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
            // With one case per motion, the interval is that of Wilson, slightly wider by Student's t.
            let one = barrelstack_fragility::wilson(level.collapsed, 12, 0.95);
            assert!(level.interval.high - level.interval.low >= one.high - one.low - 1e-9);
        }
        // All levels of a motion are clustered, so that the interval is wider than that of independent cases.
        let alone = barrelstack_fragility::wilson(group.collapsed, 96, 0.95);
        assert!(group.interval.low < alone.low && group.interval.high > alone.high);
    }
    assert!(html(&found.document).contains("Intervals are clustered by motion"));
}

#[test]
fn cases_of_one_record_that_repeat_each_other_make_a_median_no_surer() {
    let once = ordinary();
    let mut collected = once.clone();
    let mut columns = collected.table.columns().to_vec();
    let rows: Vec<usize> = (0..96).flat_map(|row| [row; 9]).collect();
    for column in &mut columns {
        let mut values = Values::empty(column.spec.kind);
        for row in &rows {
            values.push(column.values.get(*row)).unwrap();
        }
        column.values = values;
    }
    collected.table = StudyTable::new(columns).unwrap();
    let errors = |collected: &Collected| {
        let found = decide(collected, &Request::default()).unwrap();
        let stated = found.to_document().fragility[0].ln_median_standard_error.unwrap();
        let [median, _] = found.curves[0].standard_errors().unwrap();
        assert_eq!(stated, median);
        // With nine times as many independent cases, the error would be a third.
        (median, found.curves[0].fit.as_ref().unwrap().median_error)
    };
    let ((clustered, alone), (again, thrice)) = (errors(&once), errors(&collected));
    assert!((alone / thrice - 3.0).abs() < 0.01, "{alone} and {thrice}");
    assert!((again / clustered - 1.0).abs() < 1e-3, "{clustered} and {again}");
}

#[test]
fn every_measure_stands_in_one_table_and_the_cause_comes_first() {
    let found = decide(&ordinary(), &Request::default()).unwrap();
    assert_eq!(found.measures.len(), 2);
    let first = &found.cases.measures[found.measures[0].measure].name;
    // Capacities are in PGV and decrease with the number of the record, on which PGA depends.
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
    assert!(found.warnings.iter().any(|w| w.starts_with("The levels were chosen by searches")));
}
