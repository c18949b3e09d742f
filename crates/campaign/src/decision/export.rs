//! Fragility and loss for other programs: `OpenQuake` (`nrml` 0.5) and Pelicun, with the provenance of the study.

use std::fmt::Write as _;

use barrelstack_fragility::Lognormal;
use barrelstack_motion::STANDARD_GRAVITY;

use super::cases::Case;
use super::{Breakage, Decision};
use crate::scenario::quantity::plain;
use crate::study::Provenance;

/// Files for other programs, with notes on what they cannot hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exported {
    /// Name and text of each file.
    pub files: Vec<(&'static str, String)>,
    /// Missing parts, with reasons.
    pub notes: Vec<String>,
}

/// Error of an export.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// The other programs have no name for the measure.
    #[error(
        "neither OpenQuake nor Pelicun knows the intensity measure {0} of this study; run it over pga, pgv, \
         pgd or sa(T)"
    )]
    Measure(String),
    /// No limit state has a curve.
    #[error("no limit state of this study has a fitted curve ({0}), so there is nothing to export")]
    NoCurve(String),
}

/// A measure in the terms and the unit of other programs.
struct Foreign {
    /// `OpenQuake`'s name.
    imt: String,
    /// Pelicun's demand type.
    demand: String,
    /// Pelicun's unit.
    unit: &'static str,
    /// Its units per SI unit: g, cm/s, cm.
    scale: f64,
}

fn foreign(name: &str) -> Option<Foreign> {
    let of = |imt: &str, demand: &str, unit, scale| {
        Some(Foreign { imt: imt.to_owned(), demand: demand.to_owned(), unit, scale })
    };
    let g = 1.0 / STANDARD_GRAVITY;
    match name {
        "pga" => of("PGA", "Peak Ground Acceleration", "g", g),
        "pgv" => of("PGV", "Peak Ground Velocity", "cmps", 100.0),
        "pgd" => of("PGD", "Peak Ground Displacement", "cm", 100.0),
        other => {
            let period = other.strip_prefix("sa_")?;
            of(&format!("SA({period})"), &format!("Spectral Acceleration|{period}"), "g", g)
        }
    }
}

/// Exports the curves of a decision for other programs; `asset` is their name of one stack.
///
/// # Errors
/// If the other programs have no name for the measure, or no limit state has a curve.
pub fn export(
    decision: &Decision,
    made: &Provenance,
    asset: &str,
) -> Result<Exported, ExportError> {
    let measure = decision.cases.measure();
    let foreign =
        foreign(&measure.name).ok_or_else(|| ExportError::Measure(measure.label.clone()))?;
    let mut found = Exported::default();
    let mut limits: Vec<(String, Lognormal)> = Vec::new();
    for curve in &decision.curves {
        let name = curve.limit.name().replace('-', "_");
        match &curve.fit {
            Ok(fit) => {
                let median = foreign.scale * fit.curve.median;
                limits.push((name, Lognormal { median, ..fit.curve }));
                if curve.violates_order() {
                    found.notes.push(format!(
                        "{}: the raw fractions are not monotone, and the exported curve hides that",
                        curve.limit.words()
                    ));
                }
            }
            Err(reason) => {
                let reason = super::words::refusal(reason, |x| measure.words(x));
                found.notes.push(format!("{} is left out: {reason}", curve.limit.words()));
            }
        }
    }
    if limits.is_empty() {
        return Err(ExportError::NoCurve(found.notes.join("; ")));
    }
    let imls: Vec<f64> = decision.curves[0].grid.iter().map(|x| foreign.scale * x).collect();
    found.notes.extend(crossings(&limits, &imls, measure.shown_unit));
    let about = provenance(decision, made);
    // Pelicun uses the hyphen to divide the parts of an identifier.
    let (openquake, in_pelicun) = (identity(asset), asset.replace('-', "."));
    for (program, name) in [("OpenQuake", &openquake), ("Pelicun", &in_pelicun)] {
        if name != asset {
            found.notes.push(format!("{program} takes no name like {asset}: there it is {name}"));
        }
    }
    let fragility = fragility(&limits, &imls, &foreign, &openquake, &about);
    found.files.push(("openquake-fragility.xml", fragility));
    found.files.push(("pelicun-fragility.csv", pelicun(&limits, &foreign, &in_pelicun)));
    match &decision.losses {
        Ok(_) => {
            let text = vulnerability(decision, &foreign, &openquake, &about);
            found.files.push(("openquake-vulnerability.xml", text));
        }
        Err(reason) => found.notes.push(format!("losses are left out: {reason}")),
    }
    found.files.push(("README.txt", readme(&found.notes, &about)));
    Ok(found)
}

/// Reports intensities at which a more severe limit state is more probable than the one before it.
fn crossings(limits: &[(String, Lognormal)], imls: &[f64], unit: &str) -> Vec<String> {
    let crosses = |pair: &[(String, Lognormal)]| {
        let above = |x: &&f64| pair[1].1.probability(**x) > pair[0].1.probability(**x) + 1e-6;
        let at = imls.iter().find(above)?;
        Some(format!(
            "the curve of {} lies above that of {} at {} {unit}: programs that take limit states as nested refuse that",
            pair[1].0,
            pair[0].0,
            barrelstack_report::significant(*at, 3)
        ))
    };
    limits.windows(2).filter_map(crosses).collect()
}

fn provenance(decision: &Decision, made: &Provenance) -> String {
    format!(
        "{} {}: \"{}\", study {}, seed {}, {} cases under {} motions, intensity {}",
        made.program,
        made.version,
        made.title,
        made.study_hash,
        made.seed,
        decision.cases.all.len(),
        decision.cases.records.len(),
        decision.cases.measure().label
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Converts a name to an OpenQuake identifier: at most 75 letters, digits, colons, dashes and underscores with suffix.
fn identity(text: &str) -> String {
    let known = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | ':');
    let room = 75 - "-barrels".len();
    text.chars().take(room).map(|c| if known(c) { c } else { '_' }).collect()
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(plain).collect::<Vec<_>>().join(" ")
}

const HEAD: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<nrml xmlns=\"http://openquake.org/xmlns/nrml/0.5\">\n";

/// Returns mean and standard deviation of a lognormal capacity, by which `OpenQuake` states a curve.
fn moments(curve: &Lognormal) -> (f64, f64) {
    let variance = curve.dispersion * curve.dispersion;
    let mean = curve.median * libm::exp(0.5 * variance);
    (mean, mean * libm::expm1(variance).sqrt())
}

fn fragility(
    limits: &[(String, Lognormal)],
    imls: &[f64],
    foreign: &Foreign,
    asset: &str,
    about: &str,
) -> String {
    let names: Vec<&str> = limits.iter().map(|(name, _)| name.as_str()).collect();
    // Outside of this range OpenQuake holds the probability constant, which changes none of four digits.
    let reaches = |p: f64| limits.iter().map(move |(_, curve)| curve.intensity(p));
    let first = reaches(5e-5).fold(imls[0], f64::min);
    let last = reaches(1.0 - 5e-5).fold(imls[imls.len() - 1], f64::max);
    let mut text = format!(
        "{HEAD}  <fragilityModel id=\"barrelstack\" assetCategory=\"contents\" lossCategory=\"contents\">\n    \
         <description>{}</description>\n    <limitStates>{}</limitStates>\n    \
         <fragilityFunction id=\"{}\" format=\"continuous\" shape=\"logncdf\">\n      \
         <imls imt=\"{}\" noDamageLimit=\"0\" minIML=\"{}\" maxIML=\"{}\"/>\n",
        escaped(about),
        names.join(" "),
        asset,
        foreign.imt,
        plain(first),
        plain(last)
    );
    for (name, curve) in limits {
        let (mean, deviation) = moments(curve);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "      <params ls=\"{name}\" mean=\"{}\" stddev=\"{}\"/>",
            plain(mean),
            plain(deviation)
        );
    }
    text.push_str("    </fragilityFunction>\n  </fragilityModel>\n</nrml>\n");
    text
}

/// Returns the share of the wine of a stack lost in burst barrels, by the central assumption; 0 without wine.
fn wine_lost(case: &Case) -> f64 {
    let lost = |(fall, wine): (&f64, &f64)| wine * Breakage::RANGE[1].probability(*fall);
    // Start from 0: an empty sum of floats is -0.
    let lost = case.falls.iter().zip(&case.wines).map(lost).fold(0.0, |sum, lost| sum + lost);
    if case.wine > 0.0 { lost / case.wine } else { 0.0 }
}

/// Largest variance of a beta distribution on 0 to 1, as a share of mean × (1 − mean), which it cannot reach.
const MOST_SCATTER: f64 = 0.999;

fn vulnerability(decision: &Decision, foreign: &Foreign, asset: &str, about: &str) -> String {
    let known = decision.cases.with_known_falls();
    let groups = known.groups(known.main);
    let mut text = format!(
        "{HEAD}  <vulnerabilityModel id=\"barrelstack\" assetCategory=\"contents\" lossCategory=\"contents\">\n    \
         <description>{}; loss ratios: barrels on the floor, and wine lost (central assumption of breakage)\
         </description>\n",
        escaped(about)
    );
    let share_fallen: fn(&Case) -> f64 = Case::fallen_share;
    for (name, of) in [("barrels", share_fallen), ("wine", wine_lost)] {
        let (mut means, mut scatter) = (Vec::new(), Vec::new());
        for (_, cases) in &groups {
            let n = cases.len() as f64;
            let mean = cases.iter().map(|case| of(case)).sum::<f64>() / n;
            let square = cases.iter().map(|case| of(case) - mean).map(|off| off * off).sum::<f64>();
            let variance = (square / (n - 1.0).max(1.0)).min(MOST_SCATTER * mean * (1.0 - mean));
            means.push(mean);
            scatter.push(if mean > 0.0 { variance.max(0.0).sqrt() / mean } else { 0.0 });
        }
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "    <vulnerabilityFunction id=\"{}-{name}\" dist=\"BT\">\n      <imls imt=\"{}\">{}</imls>\n      \
             <meanLRs>{}</meanLRs>\n      <covLRs>{}</covLRs>\n    </vulnerabilityFunction>\n",
            asset,
            foreign.imt,
            numbers(groups.iter().map(|(x, _)| foreign.scale * x)),
            numbers(means),
            numbers(scatter)
        );
    }
    text.push_str("  </vulnerabilityModel>\n</nrml>\n");
    text
}

/// Writes a fragility database of one component with one damage state per limit state.
fn pelicun(limits: &[(String, Lognormal)], foreign: &Foreign, asset: &str) -> String {
    let mut head =
        "ID,Incomplete,Demand-Type,Demand-Unit,Demand-Offset,Demand-Directional".to_owned();
    let quoted = asset.replace('"', "\"\"");
    let mut row = format!("\"{quoted}\",0,{},{},0,0", foreign.demand, foreign.unit);
    for (number, (_, curve)) in (1..).zip(limits) {
        // Writing to a String cannot fail.
        let _ = write!(
            head,
            ",LS{number}-Family,LS{number}-Theta_0,LS{number}-Theta_1,LS{number}-DamageStateWeights"
        );
        let _ = write!(row, ",lognormal,{},{},", plain(curve.median), plain(curve.dispersion));
    }
    format!("{head}\n{row}\n")
}

fn readme(notes: &[String], about: &str) -> String {
    let notes: Vec<String> = notes.iter().map(|note| format!("- {note}\n")).collect();
    format!("{about}\n{}", notes.concat())
}
