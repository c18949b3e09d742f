//! Reads and checks study files.

mod factor;

use std::path::Path;

use barrelstack_fragility::sobol;
use barrelstack_input::names::advice;
use barrelstack_motion::IntensityMeasure;

use crate::scenario::field::{Kind, Range};
use crate::scenario::reader::Reader;
use crate::scenario::template::Opened;
use crate::scenario::tree::Origin;
use crate::scenario::{Dimension, FileRef, MotionSource, Place, Problem, Scenario, ScenarioError};

use super::design::{Cases, Design};
use super::error::StudyError;
use super::fields::{DesignKind, STUDY};
use super::ida::Hunt;
use super::motions::{Motion, Shaking, hash_files, unreadable};
use super::plan::{Chunks, Sizes};
use super::prepare::runs;
use super::setting::{Domain, Setting, required};
use factor::{LOW, Room, clash, read_factor, read_variation};

use super::{Correlation, Factor, Intensity, Levels, Study, Variation, ensembles};

/// Maximum number of cases of a design.
const MOST_CASES: u64 = 10_000_000;

/// Maximum number of strata of a Latin hypercube, over all quantities together; each stratum takes four
/// bytes.
const MOST_STRATA: usize = 50_000_000;

/// Default chunk size of three-dimensional studies and incremental dynamic analyses. It is small, because each case or
/// each hunt takes a long time.
const FEW: Sizes = Sizes::Given(8);

impl Study {
    /// Reads a study file, the scenarios that it extends, and the bytes of its records.
    ///
    /// # Errors
    /// If the study is invalid; the error states the first problem and where it is.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        read(&Opened::load(path)?, None)
    }

    /// Reads a study from text, which may extend built-in scenarios only; `source_name` is the name of the
    /// text in error messages.
    ///
    /// # Errors
    /// As for [`Study::load`].
    pub fn parse(source_name: &str, text: &str) -> Result<Self, StudyError> {
        read(&Opened::parse(source_name, text)?, None)
    }

    /// Reads a study from generated text. The paths of its records come from the caller.
    ///
    /// Errors state no location in the text, since the user does not know the text. They may quote the content of the
    /// records, since the caller has named these files.
    pub(crate) fn written(name: &str, text: &str) -> Result<Self, StudyError> {
        let mut study = Self::parse(&format!("{name}.toml"), text).map_err(|error| {
            let StudyError::File(error) = error else { return error };
            ScenarioError::new(error.problem().clone(), Place::Unknown).into()
        })?;
        for motion in &mut study.motions {
            if let Shaking::Spec(spec) = &mut motion.shaking {
                spec.files_mut().for_each(|file| *file = FileRef::of_caller(file.path.clone()));
            }
        }
        Ok(study)
    }

    /// Reads a study from text, as [`Study::parse`] does, but without opening files. `fetch` returns the bytes of the
    /// record at a path.
    ///
    /// ```
    /// use barrelstack_campaign::Study;
    ///
    /// let record = barrelstack_motion::bundled("napa-college-2014").expect("a bundled record");
    /// let bytes = barrelstack_motion::write::text(&record)?.into_bytes();
    /// let study = Study::parse_with(
    ///     "sites.toml",
    ///     r#"
    ///     schema = 1
    ///     [base]
    ///     extends = "sliding-block"
    ///     [[motion]]
    ///     records = ["site.txt"]
    ///     [design]
    ///     kind = "full-factorial"
    ///     "#,
    ///     &mut |_| Ok(bytes.clone()),
    /// )?;
    /// assert_eq!(study.table()?.texts("record"), Some(&[Some("site".to_owned())][..]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Study::load`], or if `fetch` fails.
    pub fn parse_with(
        source_name: &str,
        text: &str,
        fetch: &mut dyn FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Self, StudyError> {
        read(&Opened::parse(source_name, text)?, Some(fetch))
    }

    /// Reads a built-in study.
    ///
    /// # Errors
    /// If there is no built-in study with that name.
    pub fn built_in(name: &str) -> Result<Self, StudyError> {
        let Some(text) = super::builtin::get(name) else {
            let known: Vec<&str> = super::builtin::names().collect();
            let next = advice(name, &known);
            return Err(StudyError::BuiltIn(format!(
                "there is no built-in study \"{name}\": {next}"
            )));
        };
        Self::parse(&format!("{name}.toml"), text)
    }
}

/// Callback that returns the bytes of the file at a path, or the reason why the file cannot be read.
type Fetch<'a> = &'a mut dyn FnMut(&Path) -> Result<Vec<u8>, String>;

fn read(opened: &Opened, fetch: Option<Fetch<'_>>) -> Result<Study, StudyError> {
    let top = Reader::open(
        &opened.sources,
        &STUDY,
        String::new(),
        Some(&opened.table),
        Origin::Whole(0),
    )?;
    top.integer("schema")?;
    let title = top.optional_text("title")?.unwrap_or_else(|| opened.stem());
    let seed = u64::from(top.integer("seed")?);
    // The reader of scenarios reads the base later; here the base only has to be a table.
    let base = top.table("base")?;
    let sets = top.sections("motion")?;
    if let Some(motion) = base.get("motion").filter(|_| !sets.is_empty()) {
        let message =
            "the study has both [base.motion] and [[motion]], which replaces it; keep one of them"
                .to_owned();
        return Err(top.error_at(motion.origin, Problem::Inconsistent { message }).into());
    }
    let mut template = opened.template("base", &title, sets.is_empty())?;
    // An inherited duration is dropped, since it suits the scenario's own motion and its animation.
    template.forget_inherited("run", &crate::scenario::run::ENDS);
    let scenario = template.with([])?;
    runs(&top, &scenario)?;
    let mut motions = Vec::new();
    for (number, set) in (1..).zip(sets) {
        motions.extend(ensembles::read(&set, opened, number, seed)?);
        set.finish();
        few(&top, &motions)?;
    }
    let own = motions.is_empty();
    if own {
        motions.push(Motion { name: "base".to_owned(), shaking: Shaking::Base });
    }
    of_their_own_names(&top, &motions)?;

    let mut room = room_for(&top, motions.len())?;
    let mut factors: Vec<Factor> = Vec::new();
    for reader in top.sections("factor")? {
        let factor = read_factor(reader, &template, &scenario, own, &mut room)?;
        if let Some(error) = clash(&top, &factors, &factor) {
            return Err(error.into());
        }
        factors.push(factor);
    }
    let intensity = top.optional_section("intensity")?.map(read_intensity).transpose()?;
    if intensity.is_some() && own && scenario.motion.source == MotionSource::None {
        let message =
            "there is no motion to scale: the ground in [base] remains at rest; add [[motion]]"
                .to_owned();
        return Err(top.inconsistent("intensity", message).into());
    }
    let in_space = scenario.is_spatial() || factors.iter().any(|factor| factor.in_space);
    let correlations = read_correlations(&top, &factors)?;
    let (design, chunk, intensity) = read_design(top.section("design")?, intensity, &factors)?;
    // Three-dimensional cases do not run in lockstep, and each takes as long as many cases in a plane.
    let usual = if in_space || matches!(design, Design::Ida(_)) { FEW } else { Sizes::Growing };
    let levels = match &intensity {
        Some(Intensity { levels: Levels::List(levels), .. }) => {
            levels.iter().copied().map(Some).collect()
        }
        _ => vec![None],
    };
    top.finish();

    let mut study = Study {
        title,
        seed,
        design,
        text: opened.sources.files[0].text.clone(),
        template,
        held: Vec::new(),
        factors,
        correlations,
        motions,
        intensity,
        in_space,
        levels,
        chunk: chunk.map_or(usual, Sizes::Given),
        cases: Cases::Crossed,
        chunks: Chunks::Even { count: 0, sizes: Sizes::Growing },
        hash: 0,
    };
    study.cases = Cases::new(&study);
    possible(&study, opened)?;
    study.chunks = Chunks::of(&study);
    if let Some(fetch) = fetch {
        hold(&mut study, fetch)?;
    }
    let base = study.scenario(&[])?;
    study.hash = hash(&study, own.then_some(&base))?;
    Ok(study)
}

/// Returns an error if the design does not suit the factors, or has too many cases.
fn possible(study: &Study, opened: &Opened) -> Result<(), StudyError> {
    let refused = |message: String| -> StudyError {
        opened.sources.error(Origin::Whole(0), Problem::Inconsistent { message }).into()
    };
    if matches!(study.design, Design::Saltelli { .. }) && study.varied().is_empty() {
        return Err(refused(
            "nothing varies: a sensitivity design needs a [[factor]], or several motions or levels"
                .to_owned(),
        ));
    }
    if !study.correlations.is_empty()
        && matches!(study.design, Design::Saltelli { .. } | Design::OneAtATime { .. })
    {
        return Err(refused(format!(
            "the design \"{}\" changes factors separately, so the factors cannot be correlated: remove \
             [[correlation]], or use a sampled design such as \"sobol\"",
            study.design.name()
        )));
    }
    let cases = study.cases();
    if cases > MOST_CASES {
        return Err(refused(format!(
            "the study has more than {MOST_CASES} cases: use fewer values, or a sampled design"
        )));
    }
    Ok(())
}

/// Loads the files of all motions into memory.
fn hold(study: &mut Study, fetch: Fetch<'_>) -> Result<(), StudyError> {
    let mut base = study.scenario(&[])?.motion;
    for motion in &mut study.motions {
        let spec = match &mut motion.shaking {
            Shaking::Base => &mut base,
            Shaking::Spec(spec) => spec,
            Shaking::Synthetic(_) => continue,
        };
        for file in spec.files_mut() {
            let path = file.resolve();
            let bytes = fetch(&path).map_err(|reason| unreadable(&motion.name, &path, reason))?;
            file.hold(bytes);
        }
    }
    study.held = base.files_mut().map(|file| file.clone()).filter(FileRef::is_held).collect();
    Ok(())
}

/// Returns a fingerprint of all inputs on which the rows of the study depend.
fn hash(study: &Study, scenario: Option<&Scenario>) -> Result<u64, StudyError> {
    let mut all = vec![env!("CARGO_PKG_VERSION").to_owned(), crate::ensemble::VERSION.to_string()];
    all.extend(study.template.texts().map(str::to_owned));
    for motion in &study.motions {
        let files = motion.shaking.files(scenario.map(|scenario| &scenario.motion));
        let bytes = hash_files(&motion.name, &files)?.unwrap_or(0);
        all.push(format!("{} {bytes:016x}", motion.name));
    }
    Ok(crate::scenario::fnv1a(all.join("\u{0}").as_bytes()))
}

/// Returns the limits on the number of factor values, given the number of motions and the kind of design.
fn room_for(top: &Reader<'_>, motions: usize) -> Result<Room, ScenarioError> {
    let crossing = [DesignKind::FullFactorial, DesignKind::Stripes, DesignKind::Ida];
    let kind: Option<DesignKind> =
        top.optional_section("design")?.and_then(|design| design.choice("kind").ok());
    let crosses = kind.is_some_and(|kind| crossing.contains(&kind));
    Ok(Room::new(motions, crosses.then_some(MOST_CASES)))
}

/// Returns an error if there are too many motions.
fn few(top: &Reader<'_>, motions: &[Motion]) -> Result<(), ScenarioError> {
    if motions.len() > ensembles::MOST {
        let message = format!(
            "the study has {} motions, more than the maximum of {}: use fewer, or several studies with different seeds",
            motions.len(),
            ensembles::MOST
        );
        return Err(top.inconsistent("motion", message));
    }
    Ok(())
}

/// Returns an error if two motions have the same name.
fn of_their_own_names(top: &Reader<'_>, motions: &[Motion]) -> Result<(), ScenarioError> {
    let mut names = std::collections::BTreeSet::new();
    for motion in motions {
        if !names.insert(&motion.name) {
            let message = format!(
                "two motions have the name \"{}\"; give each motion its own name: state `name` in its [[motion]], or \
                 rename its file",
                motion.name
            );
            return Err(top.inconsistent("motion", message));
        }
    }
    Ok(())
}

/// Returns the dimensions in which levels of a measure may be written; `None` if motions cannot be scaled to
/// the measure.
fn dimension_of(measure: IntensityMeasure) -> Option<&'static [Dimension]> {
    match measure.unit() {
        "m/s2" => Some(&[Dimension::ACCELERATION]),
        "m/s" => Some(&[Dimension::VELOCITY]),
        "m" => Some(&[Dimension::LENGTH]),
        _ => None,
    }
}

/// Reads the groups of factors that are correlated with each other.
fn read_correlations(
    top: &Reader<'_>,
    factors: &[Factor],
) -> Result<Vec<Correlation>, ScenarioError> {
    let mut groups = Vec::new();
    for reader in top.sections("correlation")? {
        groups.push(read_correlation(reader, factors, &groups)?);
    }
    Ok(groups)
}

/// Reads a group of factors that are correlated with each other.
fn read_correlation(
    reader: Reader<'_>,
    factors: &[Factor],
    others: &[Correlation],
) -> Result<Correlation, ScenarioError> {
    let names = reader.texts("factors")?;
    let coefficient = reader.number("coefficient")?;
    let refused = |message: String| Err(reader.inconsistent("factors", message));
    for (at, name) in names.iter().enumerate() {
        let Some(factor) = factors.iter().find(|factor| factor.name == *name) else {
            let known: Vec<&str> = factors.iter().map(|factor| &*factor.name).collect();
            return refused(format!("there is no factor \"{name}\": {}", advice(name, &known)));
        };
        let drawn = match &factor.variation {
            Variation::Distribution(distribution) => distribution.settings().is_none(),
            Variation::Values(_) => false,
        };
        if !drawn {
            return refused(format!(
                "the factor \"{name}\" has no continuous distribution, so it cannot be correlated with other factors: \
                 give it such a distribution, or remove its name here"
            ));
        }
        if names[..at].contains(name) || others.iter().any(|other| other.contains(name)) {
            return refused(format!(
                "the factor \"{name}\" is listed twice: keep its name in one [[correlation]]"
            ));
        }
    }
    if names.len() < 2 {
        return refused("a correlation needs the names of at least two factors".to_owned());
    }
    reader.finish();
    Ok(Correlation { factors: names, coefficient })
}

fn read_intensity(reader: Reader<'_>) -> Result<Intensity, ScenarioError> {
    let text = reader.text("measure")?;
    let measure: IntensityMeasure = text
        .parse()
        .map_err(|error| reader.inconsistent("measure", format!("`intensity.measure`: {error}")))?;
    let Some(dimensions) = dimension_of(measure) else {
        let message = format!(
            "motions cannot be scaled to {measure}; use pga, pgv, pgd, arias, cav or sa(0.5)"
        );
        return Err(reader.inconsistent("measure", message));
    };
    let (variation, _) = read_variation(&reader, Domain::positive(dimensions), "levels")?;
    if let Some(Variation::Distribution(distribution)) = &variation
        && distribution.quantile(LOW).number() <= 0.0
    {
        let message = "levels must be above zero, but the distribution includes zero or negative values; truncate it \
             with `least`";
        return Err(reader.inconsistent("distribution", message.to_owned()));
    }
    reader.finish();
    let levels = match variation {
        Some(Variation::Values(values)) => {
            Levels::List(values.iter().map(Setting::number).collect())
        }
        Some(Variation::Distribution(distribution)) => Levels::Distribution(distribution),
        None => Levels::Hunted,
    };
    Ok(Intensity { measure, levels })
}

/// Reads the `[design]` table, and checks that `intensity` suits the design. Returns the design, the chunk size if
/// the table specifies it, and `intensity`, which is unchanged.
fn read_design(
    reader: Reader<'_>,
    intensity: Option<Intensity>,
    factors: &[Factor],
) -> Result<(Design, Option<u32>, Option<Intensity>), ScenarioError> {
    let kind: DesignKind = reader.choice("kind")?;
    let chunk = reader.optional_integer("chunk")?;
    let refuse = |message: &str| Err(reader.inconsistent("kind", message.to_owned()));
    let hunted = matches!(&intensity, Some(Intensity { levels: Levels::Hunted, .. }));
    if hunted && kind != DesignKind::Ida {
        return refuse(
            "[intensity] has no levels; give it `levels`, a `range` or a `distribution`",
        );
    }
    let drawn_levels =
        matches!(&intensity, Some(Intensity { levels: Levels::Distribution(_), .. }));
    let drawn = factors.iter().find(|factor| factor.crossed().is_none());
    let design = match kind {
        DesignKind::FullFactorial => {
            if let Some(factor) = drawn {
                return refuse(&format!(
                    "a full factorial design combines listed values, but `{}` has a distribution: list its `values`, \
                     or use a sampled design such as \"sobol\"",
                    factor.name
                ));
            }
            Design::FullFactorial
        }
        DesignKind::OneAtATime => {
            if factors.is_empty() {
                return refuse("a one-at-a-time design needs at least one [[factor]]");
            }
            let nodes = reader.nodes("quantiles")?.unwrap_or_default();
            let range = Range { least: 0.0, above: true, greatest: 1.0 - 1e-9 };
            let quantiles = nodes.iter().map(|node| reader.read_number("quantiles", node, range));
            let (quantiles, draws) =
                (quantiles.collect::<Result<_, _>>()?, reader.integer("draws")?);
            if draws > 0 && factors.iter().all(|factor| factor.crossed().is_none()) {
                return refuse(
                    "every factor is drawn at random, which leaves none to change one at a time: give at least one of \
                     them `values`, or use \"stripes\"",
                );
            }
            Design::OneAtATime { quantiles, draws }
        }
        DesignKind::LatinHypercube => {
            let count = reader.integer("count")?;
            let axes = factors.len() + 2;
            if count as usize > MOST_STRATA / axes {
                let message = format!(
                    "{count} samples of {axes} quantities (motion, level and factors) do not fit into memory: use at \
                     most {} samples, or the design \"sobol\"",
                    MOST_STRATA / axes
                );
                return Err(reader.inconsistent("count", message));
            }
            Design::LatinHypercube { count }
        }
        DesignKind::Sobol => {
            let most = sobol::DIMENSIONS - 2;
            if factors.len() > most {
                return refuse(&format!(
                    "a \"sobol\" design has at most {most} factors, but this study has {}; use \
                     \"latin-hypercube\"",
                    factors.len()
                ));
            }
            Design::Sobol { count: reader.integer("count")? }
        }
        DesignKind::Saltelli => {
            let most = sobol::DIMENSIONS / 2 - 2;
            if factors.len() > most {
                return refuse(&format!(
                    "a \"saltelli\" design has at most {most} factors, but this study has {}; omit the least \
                     important ones",
                    factors.len()
                ));
            }
            Design::Saltelli { count: reader.integer("count")? }
        }
        DesignKind::MonteCarlo => {
            let (least, most) = (reader.integer("least")?, reader.integer("most")?);
            let half_width = reader.optional_number("half_width")?;
            if half_width.is_some() && least > most {
                return refuse(&format!("`least` is {least}, above `most`, {most}"));
            }
            Design::MonteCarlo { half_width, least, most }
        }
        DesignKind::Stripes => {
            if !matches!(&intensity, Some(Intensity { levels: Levels::List(_), .. })) {
                return refuse("stripes need levels: add [intensity] with `levels` or a `range`");
            }
            Design::Stripes
        }
        DesignKind::Ida => Design::Ida(read_hunt(&reader, intensity.as_ref())?),
    };
    if drawn_levels && matches!(kind, DesignKind::FullFactorial | DesignKind::OneAtATime) {
        return refuse(
            "this design needs a list of levels, but [intensity] has a distribution: give it `levels` or a `range`",
        );
    }
    reader.finish();
    Ok((design, chunk, intensity))
}

fn read_hunt(reader: &Reader<'_>, intensity: Option<&Intensity>) -> Result<Hunt, ScenarioError> {
    let Some(Intensity { measure, levels: Levels::Hunted }) = intensity else {
        let message = "an incremental dynamic analysis needs [intensity] with a `measure` and finds the levels itself: \
                       leave out `levels`, `range` and `distribution`";
        return Err(reader.inconsistent("kind", message.to_owned()));
    };
    let dimensions = dimension_of(*measure).unwrap_or(&[Dimension::NONE]);
    let needed = |name: &'static str| {
        let kind = Kind::Quantity(dimensions, Range::POSITIVE);
        let node = required(reader, name, kind)?;
        reader.read_quantity(name, &node, dimensions, Range::POSITIVE).map(|read| read.value)
    };
    let (first, step) = (needed("first")?, needed("step")?);
    let growth = reader.node("growth")?.map_or(Ok(0.5 * step), |node| {
        let read = reader.read_quantity("growth", &node, dimensions, Range::NOT_NEGATIVE);
        read.map(|read| read.value)
    })?;
    let resolution = reader.number("resolution")?;
    Ok(Hunt { first, step, growth, resolution, runs: reader.integer("runs")? })
}
