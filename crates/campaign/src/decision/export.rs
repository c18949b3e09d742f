//! Export of fragility and loss to other programs (`OpenQuake` and Pelicun), with the provenance of the study.

mod openquake;

use std::fmt::Write as _;

use barrelstack_fragility::Lognormal;
use barrelstack_motion::STANDARD_GRAVITY;

use super::Decision;
use crate::scenario::quantity::plain;
use crate::study::Provenance;

/// Files for other programs, with notes on what could not be exported unchanged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exported {
    /// Name and text of each file.
    pub files: Vec<(&'static str, String)>,
    /// Notes on what was omitted or changed in the export, each with a reason.
    pub notes: Vec<String>,
}

/// Reason why a study cannot be exported.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// The other programs do not support the intensity measure of the study.
    #[error(
        "neither OpenQuake nor Pelicun supports the intensity measure {0} of this study; run the study with pga, pgv, \
         pgd or sa(T)"
    )]
    Measure(String),
    /// No limit state has a fitted curve.
    #[error("no limit state of this study has a fitted curve ({0}), so there is nothing to export")]
    NoCurve(String),
}

/// Intensity measure of a study, with the names and units that it has in the other programs.
struct Foreign {
    /// Name of the measure in `OpenQuake`.
    imt: String,
    /// Demand type of the measure in Pelicun.
    demand: String,
    /// Unit of the measure in Pelicun.
    unit: &'static str,
    /// Factor from the SI unit to the unit of the other programs (g, cm/s or cm).
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

/// Exports the curves of a decision for other programs; `asset` is the name of a stack in these programs.
///
/// # Errors
/// If the other programs do not support the measure, or no limit state has a fitted curve.
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
                        "{}: the exported curve hides that the raw fractions do not grow steadily with intensity",
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
    let asset = if asset.is_empty() { "stack" } else { asset };
    let (openquake, in_pelicun) = (openquake::identity(asset), pelicun_identity(asset));
    for (program, name) in [("OpenQuake", &openquake), ("Pelicun", &in_pelicun)] {
        if name != asset {
            found.notes.push(format!(
                "{program} does not accept the name {asset}; it is exported as {name}"
            ));
        }
    }
    let fragility = openquake::fragility(&limits, &imls, &foreign, &openquake, &about);
    found.files.push((openquake::FRAGILITY, fragility));
    found.files.push(("pelicun-fragility.csv", pelicun(&limits, &foreign, &in_pelicun)));
    match &decision.losses {
        Ok(_) => {
            let all = openquake::vulnerabilities(decision, &foreign, &openquake, &about);
            found.files.extend(all);
        }
        Err(reason) => found.notes.push(format!("losses are left out: {reason}")),
    }
    found.files.extend(openquake::exposure(decision, &openquake, &about));
    let readme = readme(&found.notes, &about, &foreign, decision.losses.is_ok());
    found.files.push(("README.txt", readme));
    Ok(found)
}

/// Returns a note for each pair of limit states whose curves cross, so that the more severe state is more
/// probable than the less severe one at some intensities.
fn crossings(limits: &[(String, Lognormal)], imls: &[f64], unit: &str) -> Vec<String> {
    let crosses = |pair: &[(String, Lognormal)]| {
        let above = |x: &&f64| pair[1].1.probability(**x) > pair[0].1.probability(**x) + 1e-6;
        let at = imls.iter().find(above)?;
        Some(format!(
            "the curve of {} lies above that of {} at {} {unit}: programs that require nested limit states \
             reject such curves",
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

/// Returns a fragility database with one component, in which each limit state is a damage state.
fn pelicun(limits: &[(String, Lognormal)], foreign: &Foreign, asset: &str) -> String {
    let mut head =
        "ID,Incomplete,Demand-Type,Demand-Unit,Demand-Offset,Demand-Directional".to_owned();
    // The demand is directional. For a nondirectional demand, Pelicun uses 1.2 times the largest of all directions.
    let mut row = format!("{asset},0,{},{},0,1", foreign.demand, foreign.unit);
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

/// Converts a name to a Pelicun identifier of up to 75 characters: letters, digits and underscores, and
/// dots after the first character.
fn pelicun_identity(text: &str) -> String {
    let known =
        |(at, c): &(usize, char)| c.is_ascii_alphanumeric() || *c == '_' || (*at > 0 && *c == '.');
    let name = text.chars().take(75).enumerate();
    name.map(|sign| match sign {
        sign if known(&sign) => sign.1,
        (1.., '-') => '.',
        _ => '_',
    })
    .collect()
}

fn readme(notes: &[String], about: &str, foreign: &Foreign, losses: bool) -> String {
    use openquake::{BARRELS, EXPOSURE, FRAGILITY, MAPPING, WINE};
    let notes: Vec<String> = notes.iter().map(|note| format!("- {note}\n")).collect();
    let risk = if losses {
        format!(
            " For scenario_risk: contents_vulnerability_file = {WINE} and nonstructural_vulnerability_file = {BARRELS}."
        )
    } else {
        String::new()
    };
    format!(
        "{about}\n{}\nIntensity: {} in {} of the horizontal component that the scenario names, after processing \
         and scaling. Most ground-motion models give the mean or the median of two components instead: convert \
         one to the other before you combine them.\n\n\
         OpenQuake: a job names exposure_file = {EXPOSURE}, taxonomy_mapping_csv = {MAPPING}, and for scenario_damage \
         contents_fragility_file = {FRAGILITY}.{risk} The exposure is a template with one stack at 0 E, 0 N: replace its \
         coordinates and its number. Its contents are wine (m3); its nonstructural value is barrels.\n\n\
         Pelicun: load pelicun-fragility.csv as a damage model. Demand-Directional is 1: the demand in the direction of \
         the performance group is used unchanged.\n",
        notes.concat(),
        foreign.imt,
        if foreign.unit == "cmps" { "cm/s" } else { foreign.unit },
    )
}
