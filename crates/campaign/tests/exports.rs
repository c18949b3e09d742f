//! Exports to other programs: contents of the files, and runs of `OpenQuake` and Pelicun with them.

#![allow(clippy::print_stdout, reason = "numbers of other programs are read with --nocapture")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::common::{capacity, ordinary, skipped, study};
use barrelstack_campaign::decision::{Decision, Exported, Request, decide, export};
use barrelstack_campaign::study::Collected;
use barrelstack_fragility::Lognormal;

/// Returns a study in which more barrels fall the more the shaking exceeds the capacity.
fn gradual() -> Collected {
    study(|record, level| match level / capacity(record) {
        over if over < 1.0 => 0,
        over if over < 1.2 => 1,
        over if over < 1.5 => 3,
        _ => 6,
    })
}

/// Returns the decision of a study and its export.
fn exported(collected: &Collected, asset: &str) -> (Decision, Exported) {
    let decision = decide(collected, &Request::default()).unwrap();
    let found = export(&decision, &collected.provenance, asset).unwrap();
    (decision, found)
}

fn text<'a>(found: &'a Exported, name: &str) -> &'a str {
    &found.files.iter().find(|(known, _)| *known == name).expect("a file").1
}

/// Returns the levels (cm/s), means and coefficients of variation of a vulnerability function.
fn vulnerability(found: &Exported, name: &str) -> [Vec<f64>; 3] {
    let parsed = roxmltree::Document::parse(text(found, name)).unwrap();
    ["imls", "meanLRs", "covLRs"].map(|name| {
        let node = parsed.descendants().find(|n| n.has_tag_name(name)).expect("a node");
        node.text().unwrap().split_whitespace().map(|n| n.parse().unwrap()).collect()
    })
}

const FUNCTIONS: [&str; 2] =
    ["openquake-vulnerability-barrels.xml", "openquake-vulnerability-wine.xml"];

#[test]
fn what_is_exported_is_the_same_curve_to_four_digits() {
    let (decision, found) = exported(&ordinary(), "stack <A>");
    // OpenQuake describes a lognormal capacity by its mean and standard deviation, here of PGV in cm/s.
    let parsed = roxmltree::Document::parse(text(&found, "openquake-fragility.xml")).unwrap();
    let node = |name: &str| parsed.descendants().find(|n| n.has_tag_name(name)).expect("a node");
    assert_eq!(node("imls").attribute("imt"), Some("PGV"));
    assert!(node("description").text().unwrap().contains("seed 7"));
    let names: Vec<&str> = node("limitStates").text().unwrap().split_whitespace().collect();
    let params: Vec<_> = parsed.descendants().filter(|n| n.has_tag_name("params")).collect();
    assert_eq!(params.iter().map(|n| n.attribute("ls").unwrap()).collect::<Vec<_>>(), names);
    let fitted: Vec<_> =
        decision.curves.iter().filter_map(|curve| curve.fit.as_ref().ok()).collect();
    assert_eq!(fitted.len(), names.len());
    let row = text(&found, "pelicun-fragility.csv").lines().nth(1).unwrap();
    let row: Vec<&str> = row.split(',').collect();
    assert_eq!(row[2..6], ["Peak Ground Velocity", "cmps", "0", "1"], "a directional demand");
    for (at, (node, fit)) in params.iter().zip(&fitted).enumerate() {
        let number = |name| node.attribute(name).unwrap().parse::<f64>().unwrap();
        let (mean, deviation) = (number("mean"), number("stddev"));
        let variance = (1.0 + (deviation / mean).powi(2)).ln();
        let median = mean / (0.5 * variance).exp();
        let theirs = Lognormal { median, dispersion: variance.sqrt() };
        let column = |k: usize| row[6 + 4 * at + k].parse::<f64>().unwrap();
        let pelicun = Lognormal { median: column(1), dispersion: column(2) };
        for x in [0.3, 0.5, 0.8] {
            let ours = fit.curve.probability(x);
            // Measured: 1e-15.
            assert!((theirs.probability(100.0 * x) - ours).abs() < 1e-12);
            assert!((pelicun.probability(100.0 * x) - ours).abs() < 1e-12);
        }
    }
}

#[test]
fn scatter_of_losses_is_feasible_wherever_openquake_interpolates_and_means_are_ours() {
    let rare = study(|record, level| match level / capacity(record) {
        over if over < 1.0 => 0,
        over if record == 0 || over < 1.3 => 1,
        _ => 6,
    });
    let some_fall_early = study(|record, level| {
        if level >= capacity(record) { 6 } else { usize::from(record % 2 == 0 && level > 0.25) }
    });
    for collected in [ordinary(), gradual(), rare, some_fall_early] {
        let (decision, found) = exported(&collected, "stack");
        let losses = decision.losses.as_ref().unwrap();
        for name in FUNCTIONS {
            let [x, mean, variation] = vulnerability(&found, name);
            assert!(x.windows(2).all(|pair| pair[0] < pair[1]) && x.len() < 400, "{}", x.len());
            let steps = 1000;
            for at in 0..(x.len() - 1) * steps {
                let (k, t) = (at / steps, (at % steps) as f64 / steps as f64);
                let between = |of: &[f64]| of[k] + t * (of[k + 1] - of[k]);
                let (x, m, c) = (between(&x), between(&mean), between(&variation));
                // A beta distribution requires a variance below m (1 − m).
                let variance = (c * m).powi(2);
                assert!(
                    variance == 0.0 || variance < m * (1.0 - m),
                    "{name} at {x} cm/s: {m} ± {c}"
                );
                if name == FUNCTIONS[0] {
                    let ours = losses.fallen(0.01 * x) / 6.0;
                    // The tolerance is slightly larger than that of the exporter, which tests the difference at other
                    // points.
                    let off = (m - ours).abs();
                    assert!(off < 3e-3 * ours + 2e-7, "{name} at {x} cm/s: {m} and {ours}");
                }
            }
            // At the levels themselves the scatter is that of the cases, up to its limit.
            let at = |level: f64| x.iter().position(|x| (x - level).abs() < 1e-9).unwrap();
            let k = at(50.0);
            assert!(variation[k] > 0.0, "{name}");
        }
    }
}

#[test]
fn one_name_goes_through_fragility_vulnerability_mapping_and_exposure() {
    let (_, found) = exported(&gradual(), "stack <A>");
    let noted = |note: &str| found.notes.iter().any(|known| known == note);
    assert!(noted("OpenQuake does not accept the name stack <A>; it is exported as stack__A_"));
    for name in ["openquake-fragility.xml", FUNCTIONS[0], FUNCTIONS[1]] {
        let parsed = roxmltree::Document::parse(text(&found, name)).unwrap();
        let function = |n: &roxmltree::Node<'_, '_>| n.tag_name().name().ends_with("Function");
        let ids: Vec<_> =
            parsed.descendants().filter(function).map(|n| n.attribute("id").unwrap()).collect();
        assert_eq!(ids, ["stack__A_"], "{name}");
    }
    let mapping = text(&found, "openquake-taxonomy-mapping.csv");
    assert_eq!(mapping, "taxonomy,risk_id,weight\nstack__A_,stack__A_,1\n");
    let assets = text(&found, "openquake-exposure.csv");
    // Six barrels of 225 L.
    assert_eq!(
        assets,
        "id,lon,lat,taxonomy,number,contents,nonstructural\nstack_1,0,0,stack__A_,1,1.35,6\n"
    );
    let readme = text(&found, "README.txt");
    assert!(readme.contains("PGV in cm/s of the horizontal component"), "{readme}");
}

#[test]
fn names_in_other_programs_are_no_formulas_no_markup_and_not_too_long() {
    let collected = ordinary();
    for name in ["=1+1", "+1", "-a,b", "@x", "\t=1", "\"=1\"", "a\nb", "", &"fût ".repeat(40)] {
        let (_, found) = exported(&collected, name);
        let mapping = text(&found, "openquake-taxonomy-mapping.csv");
        let in_openquake = mapping.lines().nth(1).unwrap().split(',').next().unwrap();
        let pelicun = text(&found, "pelicun-fragility.csv");
        let in_pelicun = pelicun.lines().nth(1).unwrap().split(',').next().unwrap();
        assert_eq!(pelicun.lines().count(), 2);
        for found in [in_openquake, in_pelicun] {
            let first = found.chars().next().unwrap();
            assert!(first.is_ascii_alphanumeric() || first == '_', "{name}: {found}");
            let known = |c: char| c.is_ascii_alphanumeric() || "_.:-".contains(c);
            assert!(found.len() <= 75 && found.chars().all(known), "{name}: {found}");
        }
    }
}

/// Intensities (m/s) at which the other programs are run.
const INTENSITIES: [f64; 5] = [0.25, 0.42, 0.5, 0.66, 0.85];

/// Returns the probabilities of the limit states at an intensity (m/s), in order.
fn ours(decision: &Decision, intensity: f64) -> Vec<f64> {
    let fits = decision.curves.iter().filter_map(|curve| curve.fit.as_ref().ok());
    fits.map(|fit| fit.curve.probability(intensity)).collect()
}

/// Returns a Python that has a module: that of `BARRELSTACK_PYTHON`, which must have the module, or `python3`.
fn python(module: &str) -> Option<String> {
    let named = std::env::var("BARRELSTACK_PYTHON").ok();
    let name = named.clone().unwrap_or_else(|| "python3".to_owned());
    let import = Command::new(&name).args(["-c", &format!("import {module}")]).output();
    if import.as_ref().is_ok_and(|done| done.status.success()) {
        return Some(name);
    }
    assert!(named.is_none(), "{name} cannot import {module}: {import:?}");
    skipped(&format!("python3 has no module {module}; `cargo xtask python heavy` runs with it"));
    None
}

fn put_all(folder: &Path, found: &Exported) {
    for (name, text) in &found.files {
        std::fs::write(folder.join(name), text).unwrap();
    }
}

/// Pelicun script for a stack that is shaken along direction 1, while direction 2 has three times the demand.
const PELICUN: &str = "
import sys, warnings, numpy, pandas
warnings.filterwarnings('ignore')
from pelicun.assessment import DLCalculationAssessment
path, name, demands, many = sys.argv[1], 'stack', [float(x) for x in sys.argv[2:]], 20000
for demand in demands:
    one = DLCalculationAssessment({'PrintLog': False, 'Seed': 1})
    one.stories = 1
    index = pandas.MultiIndex.from_tuples([('PGV', '1', '1'), ('PGV', '1', '2')])
    rows = [['cmps', 'cmps'], *[[demand, 3 * demand]] * many]
    one.demand.load_sample(pandas.DataFrame(rows, columns=index, index=['Units', *range(many)], dtype=object))
    marginals = {'Units': ['ea'], 'Location': ['1'], 'Direction': ['1'], 'Theta_0': [1], 'Blocks': [1]}
    one.asset.load_cmp_model({'marginals': pandas.DataFrame(marginals, index=[name])})
    one.asset.generate_cmp_sample(many)
    one.damage.load_model_parameters([path], {name})
    limits = {c for c in one.damage.ds_model.damage_params.columns.get_level_values(0) if c.startswith('LS')}
    one.damage.calculate()
    sample = one.damage.ds_model.sample
    states = sample.columns.get_level_values('ds').astype(int).to_numpy()
    worst = ((sample.to_numpy(float) > 0) * states).max(axis=1)
    print('found', *[(worst >= k).mean() for k in range(1, len(limits) + 1)])
";

#[test]
#[ignore = "needs Pelicun; `cargo xtask python heavy` runs it"]
fn pelicun_computes_the_damage_that_we_compute() {
    let Some(python) = python("pelicun.assessment") else { return };
    let (decision, found) = exported(&gradual(), "stack");
    let folder = tempfile::tempdir().unwrap();
    put_all(folder.path(), &found);
    let mut command = Command::new(python);
    command.arg("-c").arg(PELICUN).arg(folder.path().join("pelicun-fragility.csv"));
    let output = command.args(INTENSITIES.map(|x| (100.0 * x).to_string())).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    let rows: Vec<Vec<f64>> = said
        .lines()
        .filter_map(|line| line.strip_prefix("found "))
        .map(|line| line.split(' ').map(|n| n.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), INTENSITIES.len(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    for (x, theirs) in INTENSITIES.into_iter().zip(rows) {
        let ours = ours(&decision, x);
        println!("Pelicun at {:.0} cm/s: {theirs:.4?}, ours {ours:.4?}", 100.0 * x);
        assert_eq!(theirs.len(), ours.len());
        for (theirs, ours) in theirs.iter().zip(&ours) {
            // 20,000 samples, drawn evenly.
            assert!((theirs - ours).abs() < 2e-3, "{x} m/s: {theirs}, not {ours}");
        }
    }
}

/// Number of events of a scenario.
const EVENTS: usize = 2000;

/// Runs `OpenQuake` on a job with five stacks, each at its own place and shaken equally in all events.
///
/// Returns the columns of the output file `wanted` for each stack.
fn openquake(
    python: &str,
    job: &str,
    found: &Exported,
    wanted: &str,
) -> Vec<BTreeMap<String, f64>> {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    put_all(folder, found);
    let put = |name: &str, text: String| std::fs::write(folder.join(name), text).unwrap();
    // The exposure template with five stacks at different places.
    let stub = text(found, "openquake-exposure.csv");
    let (head, stack) = stub.trim_end().split_once('\n').unwrap();
    let (mut assets, mut sites) = (head.to_owned(), "site_id,lon,lat".to_owned());
    let mut shaking = "sid,eid,gmv_PGV\n".to_owned();
    for (k, x) in INTENSITIES.iter().enumerate() {
        let place = format!("stack_{k},0.{k},0,");
        write!(assets, "\n{}", stack.replacen("stack_1,0,0,", &place, 1)).unwrap();
        write!(sites, "\n{k},0.{k},0").unwrap();
        for event in 0..EVENTS {
            writeln!(shaking, "{k},{event},{}", 100.0 * x).unwrap();
        }
    }
    put("openquake-exposure.csv", assets);
    put("sites.csv", sites);
    put("shaking.csv", shaking);
    let common = "[general]\ndescription = test\nexposure_file = openquake-exposure.xml\n\
                  taxonomy_mapping_csv = openquake-taxonomy-mapping.csv\ngmfs_csv = shaking.csv\nsites_csv = sites.csv\n";
    put("job.ini", format!("{common}{job}"));
    let run = Command::new(Path::new(python).with_file_name("oq"))
        .args(["engine", "--run", "job.ini", "--exports", "csv"])
        .current_dir(folder)
        .env("OQ_DATADIR", folder.join("data"))
        .env("OQ_DISTRIBUTE", "no")
        .env("HOME", folder)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{}{said}", String::from_utf8_lossy(&run.stdout));
    let written = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().starts_with(wanted);
    let path = written.into_iter().find(|path| name(path)).expect("what was exported");
    let table = std::fs::read_to_string(path).unwrap();
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells = head.iter().zip(line.split(','));
        cells.filter_map(|(name, cell)| Some(((*name).to_owned(), cell.parse().ok()?))).collect()
    };
    lines.map(row).collect()
}

#[test]
#[ignore = "needs OpenQuake; `cargo xtask python heavy` runs it"]
fn openquake_computes_the_damage_that_we_compute() {
    let Some(python) = python("openquake.calculators.base") else { return };
    let (decision, found) = exported(&gradual(), "stack");
    let job =
        "calculation_mode = scenario_damage\ncontents_fragility_file = openquake-fragility.xml\n";
    let rows = openquake(&python, job, &found, "avg_damages");
    assert_eq!(rows.len(), INTENSITIES.len());
    for (x, row) in INTENSITIES.into_iter().zip(rows) {
        let ours = ours(&decision, x);
        let names = decision.curves.iter().filter(|curve| curve.fit.is_ok());
        let states: Vec<f64> = names
            .map(|curve| row[&format!("contents-{}", curve.limit.name().replace('-', "_"))])
            .collect();
        // OpenQuake gives the share in each damage state, and `ours` is the probability of that state or a more severe
        // one.
        let theirs: Vec<f64> = (0..states.len()).map(|k| states[k..].iter().sum()).collect();
        println!("OpenQuake at {:.0} cm/s: {theirs:.4?}, ours {ours:.4?}", 100.0 * x);
        for (theirs, ours) in theirs.iter().zip(&ours) {
            // OpenQuake holds probabilities below 5e-5 constant and has single precision.
            assert!((theirs - ours).abs() < 1e-4, "{x} m/s: {theirs}, not {ours}");
        }
    }
}

#[test]
#[ignore = "needs OpenQuake; `cargo xtask python heavy` runs it"]
fn openquake_computes_the_losses_that_we_compute() {
    let Some(python) = python("openquake.calculators.base") else { return };
    // A ratio that is either 0 or 1 has the largest possible scatter.
    for collected in [gradual(), ordinary()] {
        let (decision, found) = exported(&collected, "stack");
        let losses = decision.losses.as_ref().unwrap();
        let [levels, _, variation] = vulnerability(&found, FUNCTIONS[0]);
        for (means, draws) in [(true, ""), (false, "master_seed = 42\n")] {
            let job = format!(
                "calculation_mode = scenario_risk\nignore_covs = {means}\n{draws}\
                 contents_vulnerability_file = {}\nnonstructural_vulnerability_file = {}\n",
                FUNCTIONS[1], FUNCTIONS[0]
            );
            let rows = openquake(&python, &job, &found, "avg_losses-");
            assert_eq!(rows.len(), INTENSITIES.len());
            for (x, row) in INTENSITIES.into_iter().zip(rows) {
                let (barrels, wine) = (row["nonstructural"], row["contents"]);
                let (fallen, lost) = (losses.fallen(x), losses.wine(x, 1));
                let what = if means { "means" } else { "drawn" };
                println!(
                    "OpenQuake ({what}) at {:.0} cm/s: {barrels:.3} barrels and {wine:.4} m3, ours {fallen:.3} and \
                     {lost:.4}",
                    100.0 * x
                );
                if means {
                    assert!((barrels / fallen - 1.0).abs() < 4e-3, "{x}: {barrels}, not {fallen}");
                    assert!((wine / lost - 1.0).abs() < 4e-3, "{x}: {wine}, not {lost}");
                    continue;
                }
                // The tolerance is five standard errors of the mean of the draws.
                let level = levels.iter().position(|level| *level >= 100.0 * x).unwrap();
                let scatter = variation[level].max(variation[level - 1]);
                let error = 5.0 * scatter / (EVENTS as f64).sqrt() + 1e-3;
                assert!((barrels / fallen - 1.0).abs() < error, "{x}: {barrels}, not {fallen}");
                assert!((wine / lost - 1.0).abs() < 2.0 * error, "{x}: {wine}, not {lost}");
            }
        }
    }
}
