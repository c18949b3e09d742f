//! Sentences of a report.

use barrelstack_motion::STANDARD_GRAVITY;
use barrelstack_report::{capital, significant};

use crate::assemble::PartKind;
use crate::ground::MotionSummary;
use crate::outcome::{CollapseMode, Outcome};
use crate::run::Run;
use crate::scenario::{MotionSpec, View};
use crate::summary::{Device, EnergyBalance, RunSummary, Summary, Unfinished};
use crate::variants::words::ShownOutcome;
use crate::variants::{self, Remedy};
use crate::verify::Verification;

/// Returns the verdict on all variants or, if no variants were run, the verdict on the single run. The verdict on a
/// single run names the plane of the run, if there is one.
pub(crate) fn headline(run: &Run, summary: &Summary) -> String {
    let spreads = summary.spreads();
    if spreads.is_empty() {
        let noun = if summary.other_plane.is_some() { "barrels in this plane" } else { "barrels" };
        return single(run, summary, run.assembly.view, noun);
    }
    variants::words::headline(&spreads)
}

/// Describes the result of the shown run in one sentence that does not name the plane of the run. The sentence is meant
/// for a stack with results in two planes.
pub(crate) fn alone(run: &Run, summary: &Summary) -> String {
    single(run, summary, None, "barrels in this plane")
}

/// Describes the result of a run; `noun` is the word for its barrels.
fn single(run: &Run, summary: &Summary, plane: Option<View>, noun: &str) -> String {
    let shaken = |result: &str| match plane {
        Some(plane) => format!("Shaken {}, {result}", plane.words()),
        None => capital(result),
    };
    match &run.outcome {
        Outcome::Stable => {
            let stands = shaken(&run.cut().map_or_else(
                || "the stack stands".to_owned(),
                |left| {
                    format!(
                        "the stack stands until the run ends at {:.1} s, {left:.1} s before the end of the motion",
                        run.end_time
                    )
                },
            ));
            match crushed(summary) {
                Some(load) => format!(
                    "{stands}, but staves are crushed: their load reaches up to {load} of their stated capacity."
                ),
                None => stands + ".",
            }
        }
        Outcome::NotJudged => "The scene ran to its end.".into(),
        Outcome::Interrupted => stopped(summary.unfinished.as_ref(), run.end_time),
        Outcome::Invalid { .. } => {
            "The computation failed, so the run permits no conclusion about the stack.".into()
        }
        Outcome::Collapse { mode: CollapseMode::Gravity, .. } => {
            let plane = plane.map_or_else(String::new, |plane| format!("{}, ", plane.words()));
            capital(&format!("{plane}the stack falls under its own weight, before it is shaken."))
        }
        Outcome::Collapse { time, .. } => {
            let (fallen, barrels) =
                (summary.outcome.barrels_fallen.unwrap_or(0), summary.outcome.barrels);
            if fallen == 0 {
                let result =
                    format!("the stack comes apart after {time:.1} s, but no barrel falls.");
                return shaken(&result);
            }
            let who = match fallen {
                1 if barrels == 1 => "the barrel falls".to_owned(),
                1 => format!("one of {barrels} {noun} falls"),
                _ if fallen == barrels => format!("all {barrels} {noun} fall"),
                _ => format!("{fallen} of {barrels} {noun} fall"),
            };
            shaken(&format!("{who}: the stack gives way after {time:.1} s."))
        }
    }
}

/// Formats the largest utilization of staves until the first loss of a seat, in percent; `None` if it is at most 100 %.
fn crushed(summary: &Summary) -> Option<String> {
    let load = summary.demands.stave_utilization.filter(|load| *load > 1.0)?;
    Some(format!("{:.0} %", 100.0 * load))
}

/// States that the computation was stopped, how far it had progressed, and that there is no verdict.
pub fn stopped(variants: Option<&Unfinished>, time: f64) -> String {
    match variants {
        Some(Unfinished { done, of }) => format!(
            "Stopped after {done} of {of} runs of the stack as stated and of its variants: there is no verdict."
        ),
        None => format!("Stopped at {time:.1} s, before the end of the run: there is no verdict."),
    }
}

/// Returns the name of a range of levels, such as "level 3", "levels 2 and 3" or "levels 2 to 4".
fn levels(from: u32, to: u32) -> String {
    match to.saturating_sub(from) {
        0 => format!("level {from}"),
        1 => format!("levels {from} and {to}"),
        _ => format!("levels {from} to {to}"),
    }
}

/// Describes the course of a collapse in one sentence.
fn course(run: &Run, mode: CollapseMode, first: &str, part: &str) -> String {
    let barrel = run.assembly.parts.iter().any(|p| p.name == first && p.kind == PartKind::Barrel);
    match mode {
        CollapseMode::Ejection if barrel => format!(
            "Barrel {first} is the first barrel of {part} to lose its seat: it is thrown out of its cradle."
        ),
        CollapseMode::Ejection => {
            format!("The barrels of {part} are thrown off the stack with their rack, {first}.")
        }
        CollapseMode::Rocking => format!(
            "The upper part of the stack, {part}, rocks on the barrels below it and topples; rack {first} is the \
             first to lose its seat."
        ),
        CollapseMode::RackSliding => format!(
            "Rack {first} slides along the barrels below until it leaves them, and takes {part} with \
             it."
        ),
        CollapseMode::Overturning => "The whole stack turns over about its foot.".to_owned(),
        CollapseMode::Gravity => format!(
            "The stack falls under its own weight, before it is shaken: {first} does not stay in place."
        ),
    }
}

/// Describes the forces in a device; `None` if the device has no elements.
pub fn device(Device { words, elements }: &Device) -> Option<String> {
    let strained = elements.iter().max_by(|a, b| a.peak.abs().total_cmp(&b.peak.abs()))?;
    let kilonewtons = significant(1e-3 * strained.peak.abs(), 2);
    // Falling bodies may pull harder than standing ones.
    let most = elements.iter().map(|element| element.peak_whole_run.abs()).fold(0.0, f64::max);
    let until = if most > strained.peak.abs() {
        let later = significant(1e-3 * most, 2);
        format!(" until the first seat is lost, and up to {later} kN over the whole run")
    } else {
        String::new()
    };
    let broken = elements.iter().filter_map(|element| element.broken_at);
    let first = broken.clone().reduce(f64::min);
    let all = format!("{} {}", elements.len(), words.many);
    let alone = elements.len() == 1;
    Some(match (broken.count(), first) {
        (0, _) | (_, None) if alone => {
            format!("The {} holds; it carries up to {kilonewtons} kN{until}.", words.one)
        }
        (_, Some(time)) if alone => {
            format!("The {} {}, after {time:.1} s.", words.one, words.breaks)
        }
        (0, _) | (_, None) => {
            format!("All {all} hold; the largest force in one of them is {kilonewtons} kN{until}.")
        }
        (1, Some(time)) => format!("One of {all} {}, after {time:.1} s.", words.breaks),
        (count, Some(time)) => {
            format!("{count} of {all} {}, the first after {time:.1} s.", words.break_all)
        }
    })
}

/// States the ground motion and its components.
fn shaking(motion: &MotionSummary) -> String {
    // Formulas have common nouns as names, such as "sine", and need an article.
    let formula = motion.name.chars().all(char::is_lowercase);
    let name = if formula { format!("a {}", motion.name) } else { motion.name.clone() };
    let components = match (motion.pga == 0.0, motion.vertical) {
        (true, _) => "vertical only",
        (false, true) => "horizontal and vertical",
        (false, false) => "horizontal only",
    };
    format!("The ground motion is {name} ({components}).")
}

/// Returns further details: strength of the motion, number of the shown variant, and how the
/// variants differ.
pub fn fine(run: &Run, summary: &Summary) -> Vec<String> {
    let view = run.assembly.view.filter(|_| summary.other_plane.is_some());
    let place =
        view.map_or_else(|| "The".to_owned(), |view| format!("{}, the", capital(view.words())));
    let strength = |motion: &MotionSummary| {
        // A run that ends before its motion may miss the peaks of the motion.
        let whole = run.cut().map_or_else(String::new, |_| {
            format!("; of its {:.1} s, the run covers {:.1} s", motion.duration, run.end_time)
        });
        format!(
            "{place} ground motion that is shown reaches {:.2} g and {:.0} cm/s{whole}.",
            motion.pga / STANDARD_GRAVITY,
            100.0 * motion.pgv
        )
    };
    let mut sentences: Vec<String> =
        summary.motion.iter().filter(|motion| motion.pga > 0.0).map(strength).collect();
    sentences.extend(variants::words::fine(summary, &run.scenario));
    sentences
}

/// Returns the command that compares the stack as it is with the changes that would have kept it standing; empty if
/// there is no such command. Absolute paths in the command are shortened to file names.
pub fn command(remedy: Option<&Remedy>) -> String {
    let command = remedy.and_then(|found| found.comparison.as_deref());
    let word = |word: &str| {
        let path = word.trim_start_matches('\'');
        let quote = &word[..word.len() - path.len()];
        let whole = path.starts_with(['/', '~', '\\']) || path.get(1..3) == Some(":\\");
        let name = path.rsplit(['/', '\\']).next().filter(|_| whole);
        name.map_or_else(|| word.to_owned(), |name| format!("{quote}{name}"))
    };
    command.map(|text| text.split(' ').map(word).collect::<Vec<_>>().join(" ")).unwrap_or_default()
}

/// States which run is shown, and compares its outcome with the outcomes of all variants; empty if no variants were
/// run.
pub(super) fn shown_run(summary: &Summary) -> String {
    let planes = summary.planes();
    let several = planes.len() > 1;
    let outcomes = planes.into_iter().filter_map(|(view, one)| {
        let (view, spread) = (Some(view).filter(|_| several), one.ensemble.as_ref()?);
        Some(ShownOutcome { view, kind: one.outcome.kind, spread })
    });
    let outcomes: Vec<ShownOutcome<'_>> = outcomes.collect();
    variants::words::shown_run(summary.variant, &outcomes)
}

/// Returns an introductory phrase that names the run to which a sentence refers, such as "Along the barrels, in the run
/// that is shown, "; empty if there is only one run.
fn shown(run: &Run, summary: &Summary) -> String {
    let view = run.assembly.view.filter(|_| summary.other_plane.is_some());
    match (view, summary.ensemble.is_some()) {
        (None, false) => String::new(),
        (None, true) => "In the run that is shown, ".to_owned(),
        (Some(view), false) => format!("{}, ", capital(view.words())),
        (Some(view), true) => format!("{}, in the run that is shown, ", capital(view.words())),
    }
}

/// Prepends an introductory phrase to a sentence, and changes the first letter of the sentence to lower case; an empty
/// phrase leaves the sentence unchanged.
fn behind(begin: &str, sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().filter(|_| !begin.is_empty());
    match first {
        Some(first) => format!("{begin}{}{}", first.to_lowercase(), letters.as_str()),
        None => format!("{begin}{sentence}"),
    }
}

/// Returns the sentences that support the headline.
///
/// If the run was verified, the results of its repeats replace the warning that a single run shows only one possible
/// course of events.
pub(super) fn details(
    run: &Run,
    summary: &Summary,
    verification: Option<&Verification>,
) -> Vec<String> {
    let mut sentences = Vec::new();
    match &run.outcome {
        Outcome::Collapse { mode, first, from_level, to_level, .. } => {
            let course = course(run, *mode, first, &levels(*from_level, *to_level));
            sentences.push(behind(&shown(run, summary), &course));
        }
        Outcome::Stable => {
            let drift = summary.demands.top_drift_ratio.unwrap_or(0.0);
            let slip = summary.demands.base_slip_residual.unwrap_or(0.0).abs();
            let foot = if slip < 5e-4 {
                "the foot has no residual displacement".to_owned()
            } else {
                format!("the foot has a residual displacement of {:.1} cm", 100.0 * slip)
            };
            let top = if drift < 1e-3 {
                "The top of the stack hardly moves".to_owned()
            } else {
                format!("The top moves by up to {:.1} % of the height of the stack", 100.0 * drift)
            };
            sentences.push(behind(&shown(run, summary), &format!("{top}, and {foot}.")));
        }
        Outcome::NotJudged | Outcome::Interrupted => {}
        Outcome::Invalid { reason } => sentences.push(format!("{}.", capital(reason))),
    }
    if let Some(load) = crushed(summary) {
        let sentence = format!(
            "Before any seat is lost, staves are crushed: their load reaches up to {load} of their stated capacity."
        );
        sentences.push(behind(&shown(run, summary), &sentence));
    }
    sentences.extend(summary.devices.0.iter().filter_map(device));
    // The component of the motion depends on the plane and on whether the variant is in the second half of the
    // variants, so the sentence names the run.
    let shaken = summary.motion.as_ref().map(shaking);
    sentences.extend(shaken.map(|sentence| behind(&shown(run, summary), &sentence)));
    let judged = matches!(run.outcome, Outcome::Stable | Outcome::Collapse { .. });
    sentences.extend(variants::words::sentences(summary));
    if let Some(found) = verification {
        sentences.extend(found.sentences());
    } else if judged && summary.ensemble.is_none() {
        sentences.push(
            "One run shows only one possible course of events: small changes in friction or gaps can change which \
             bodies fall and when, so judge a stack by many runs."
                .into(),
        );
    }
    sentences
}

/// Returns one entry of the provenance for each file of a motion: the name "record fingerprint", and a value that
/// consists of the fingerprint and the file name.
pub fn record_fingerprints(motion: &MotionSpec) -> impl Iterator<Item = (String, String)> {
    let pair = |(file, print)| ("record fingerprint".to_owned(), format!("{print} ({file})"));
    motion.fingerprints().into_iter().map(pair)
}

/// Returns the provenance of the result, as pairs of name and value.
pub(crate) fn provenance(run: &Run, summary: &Summary) -> Vec<(String, String)> {
    let mut pairs = Vec::new();
    let mut pair = |name: &str, value: String| pairs.push((name.to_owned(), value));
    pair("program", format!("barrelstack {}", summary.provenance.version));
    pair("scenario fingerprint", summary.provenance.scenario_hash.clone());
    pairs.extend(record_fingerprints(&run.stated.motion));
    let mut pair = |name: &str, value: String| pairs.push((name.to_owned(), value));
    let planes = summary.planes();
    let views: Vec<&str> = planes.iter().map(|(view, _)| view.words()).collect();
    if !views.is_empty() {
        pair("view", views.join(" and "));
    }
    // Each plane has its own run.
    let place =
        |view: View| if planes.len() > 1 { format!(" {}", view.words()) } else { String::new() };
    let runs: Vec<(String, &Summary)> = if planes.is_empty() {
        vec![(String::new(), summary)]
    } else {
        planes.iter().map(|(view, one)| (place(*view), *one)).collect()
    };
    for (place, one) in &runs {
        let RunSummary { method, time_step, steps, .. } = one.run;
        let step = 1e3 * time_step;
        pair(
            &format!("integration{place}"),
            format!("{method}, time step {step:.4} ms, {steps} steps"),
        );
    }
    let constants = match summary.run.stiffness_basis {
        "seat" => "stated per seat, independent of its number of contact nodes",
        "node" => "stated per contact node, as in the paper",
        "length" => "stated per meter of boundary",
        "mixed" => "stated on different bases for different seats",
        other => other,
    };
    pair("contact constants", constants.to_owned());
    let residual = |balance: &EnergyBalance| {
        format!(
            "residual {} of the {} kJ exchanged",
            significant(balance.residual_ratio, 2),
            significant(1e-3 * balance.input, 3)
        )
    };
    let lost = || "not available, because the computation failed".to_owned();
    for (place, one) in &runs {
        let balance = one.energy.as_ref().map_or_else(lost, residual);
        pair(&format!("energy balance{place}"), balance);
    }
    let own = &summary.provenance.motion;
    let mut motion = |place: &str, steps: &[String], known: &[String]| {
        let steps = steps.iter().enumerate().filter(|(_, step)| !known.contains(step));
        for (index, step) in steps {
            pair(&format!("motion{place}, step {}", index + 1), step.clone());
        }
    };
    match (run.assembly.view, &summary.other_plane) {
        (Some(view), Some(other)) => {
            motion(&format!(" {}", view.words()), own, &[]);
            let beside =
                if view == View::Transverse { View::Longitudinal } else { View::Transverse };
            // Processing steps that both components of the motion share are stated once.
            motion(&format!(" {}", beside.words()), &other.provenance.motion, own);
        }
        _ => motion("", own, &[]),
    }
    let similitude = run.scenario.run.similitude;
    if similitude != 1.0 {
        let scale = format!("length scale {similitude}, which applies to all results");
        pair("similitude", scale);
    }
    pairs
}
