//! Motions of a study: records, formulas and synthetic ensembles.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use barrelstack_motion::{
    BooreSource, CloughPenzien, Envelope, GroundMotion, IntensityMeasure, MotionError, NearFault,
};

use crate::ground::{self, Ground, GroundError, RECORD_LIMIT};
use crate::scenario::{
    FileRef, MotionSource, MotionSpec, RecordMotion, RecordSource, Vertical, fnv1a,
};

use super::error::StudyError;

/// Motion of a study.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// Name of the motion in the table; no other motion of the study has this name.
    pub(super) name: String,
    /// Source of the motion.
    pub(super) shaking: Shaking,
}

/// Source of a motion.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shaking {
    /// The motion of the base scenario, with the changes that the factors of the case make.
    Base,
    /// A motion that is specified as in a scenario file.
    Spec(Box<MotionSpec>),
    /// One realization of a synthetic ensemble.
    Synthetic(Box<Synthetic>),
}

/// One realization of a synthetic ensemble.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Synthetic {
    pub(super) maker: Making,
    /// Time step of the samples (s).
    pub(super) time_step: f64,
    pub(super) seed: u64,
    pub(super) scale: crate::scenario::Scale,
}

/// Model of a synthetic motion.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Making {
    Boore(BooreSource),
    CloughPenzien { noise: CloughPenzien, envelope: Envelope, duration: f64 },
    NearFault(NearFault),
}

impl std::fmt::Display for Making {
    /// Describes the model and its parameters with their units.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Boore(source) => write!(f, "stochastic method: {source}"),
            Self::CloughPenzien { noise, envelope, duration } => {
                write!(f, "Clough-Penzien noise: {noise}, {envelope}, {duration} s long")
            }
            Self::NearFault(fault) => write!(f, "near-fault motion: {fault}"),
        }
    }
}

impl Synthetic {
    /// `true` if this motion differs from another motion in its seed only.
    pub(super) fn is_of_ensemble(&self, other: &Self) -> bool {
        Self { seed: 0, ..self.clone() } == Self { seed: 0, ..other.clone() }
    }

    fn motion(&self) -> Result<GroundMotion, MotionError> {
        let (step, seed) = (self.time_step, self.seed);
        match &self.maker {
            Making::Boore(source) => source.motion(step, seed),
            Making::CloughPenzien { noise, envelope, duration } => {
                noise.motion(envelope, *duration, step, seed)
            }
            Making::NearFault(fault) => fault.motion(step, seed),
        }
    }
}

impl Shaking {
    /// Returns the motion for a stack with the length scale `similitude`. Its amplitude is scaled as the source
    /// specifies.
    pub(super) fn ground(&self, base: &MotionSpec, similitude: f64) -> Result<Ground, GroundError> {
        match self {
            Self::Base => ground::of_spec(base, similitude),
            Self::Spec(spec) => ground::of_spec(spec, similitude),
            Self::Synthetic(synthetic) => {
                let spec = MotionSpec {
                    source: MotionSource::None,
                    scale: synthetic.scale,
                    similitude: 1.0,
                };
                Ok(ground::scaled(synthetic.motion()?, &spec, similitude)?.into())
            }
        }
    }

    /// Returns all components of the motion for a stack with the length scale `similitude`. Their amplitude is scaled
    /// as the source specifies.
    fn in_space(
        &self,
        base: &MotionSpec,
        similitude: f64,
    ) -> Result<barrelstack_space::Ground, GroundError> {
        match self {
            Self::Base => barrelstack_space::Ground::of_spec(base, similitude),
            Self::Spec(spec) => barrelstack_space::Ground::of_spec(spec, similitude),
            // Synthetic motions have one component.
            Self::Synthetic(_) => Ok(self.ground(base, similitude)?.into()),
        }
    }

    /// Describes the source in words; numbers that the study file contains are omitted.
    pub(super) fn source(&self, base: &MotionSpec) -> String {
        let spec: &MotionSpec = match self {
            Self::Base => base,
            Self::Spec(spec) => spec,
            Self::Synthetic(synthetic) => {
                return format!("{}, seed {}", synthetic.maker, synthetic.seed);
            }
        };
        match &spec.source {
            MotionSource::None => "ground at rest".to_owned(),
            MotionSource::Sine(_) => "a harmonic motion".to_owned(),
            MotionSource::Pulse(_) => "a pulse".to_owned(),
            MotionSource::Record(RecordMotion { source: RecordSource::Bundled(name), .. }) => {
                format!("the bundled record {name}")
            }
            MotionSource::Record(_) => {
                let files = self.files(Some(base));
                files.iter().map(|file| file.path.as_str()).collect::<Vec<_>>().join(" and ")
            }
        }
    }

    /// Returns a fingerprint of the source, which does not depend on the paths and names of its files.
    pub(super) fn key(&self) -> u64 {
        let mut made = self.clone();
        if let Self::Spec(spec) = &mut made {
            spec.files_mut().for_each(|file| *file = FileRef::new("", PathBuf::new()));
        }
        fnv1a(format!("{made:?}").as_bytes())
    }

    /// Returns the files from which the motion is read.
    pub(super) fn files<'a>(&'a self, base: Option<&'a MotionSpec>) -> Vec<&'a FileRef> {
        let spec = match self {
            Self::Base => base,
            Self::Spec(spec) => Some(&**spec),
            Self::Synthetic(_) => None,
        };
        let Some(MotionSource::Record(record)) = spec.map(|spec| &spec.source) else {
            return Vec::new();
        };
        let mut files = Vec::new();
        if let RecordSource::File(file) = &record.source {
            files.push(file);
        }
        if let Vertical::File(file) = &record.vertical {
            files.push(file);
        }
        files
    }
}

/// Returns a fingerprint of the bytes of files; `None` if there are no files.
pub(super) fn hash_files(name: &str, files: &[&FileRef]) -> Result<Option<u64>, StudyError> {
    let mut all = Vec::new();
    for file in files {
        let bytes =
            file.read(RECORD_LIMIT).map_err(|reason| unreadable(name, &file.resolve(), reason))?;
        all.extend(fnv1a(&bytes).to_le_bytes());
    }
    Ok((!files.is_empty()).then(|| fnv1a(&all)))
}

pub(super) fn unreadable(name: &str, path: &Path, reason: String) -> StudyError {
    let obtain = "; correct the path, or remove the file from its folder".to_owned();
    let error = GroundError::Unreadable { path: path.to_owned(), reason, obtain };
    StudyError::Motion { name: name.to_owned(), error: Box::new(error) }
}

/// Intensity measures in the table of a study, each with the name of its column.
pub(super) const MEASURES: [(&str, IntensityMeasure); 9] = [
    ("pga", IntensityMeasure::Pga),
    ("pgv", IntensityMeasure::Pgv),
    ("pgv_over_pga", IntensityMeasure::PgvOverPga),
    ("sa_0.3", IntensityMeasure::Sa { period: 0.3, damping: 0.05 }),
    ("sa_0.5", IntensityMeasure::Sa { period: 0.5, damping: 0.05 }),
    ("sa_1.0", IntensityMeasure::Sa { period: 1.0, damping: 0.05 }),
    ("arias", IntensityMeasure::Arias),
    ("cav", IntensityMeasure::Cav),
    ("d5_95", IntensityMeasure::D5_95),
];

/// A scaled motion and its intensity measures.
#[derive(Clone, Debug)]
pub(super) struct Shaken {
    pub(super) ground: Arc<Ground>,
    /// Factor by which the motion was scaled to its level.
    pub(super) factor: f64,
    /// Values (SI) of the [`MEASURES`] of the horizontal component after scaling; `None` if the ground is at
    /// rest.
    pub(super) measures: Option<[f64; 9]>,
}

/// Cache entry: an unscaled motion that several cases share.
#[derive(Debug)]
struct Kept<T> {
    shaking: Shaking,
    /// Motion of the base scenario, if the source is that motion.
    base: Option<MotionSpec>,
    similitude: f64,
    /// Cached value.
    made: Arc<T>,
    /// Size of the value (bytes).
    size: usize,
}

/// Cache of the most recently used motions.
#[derive(Debug)]
struct Shelf<T>(Mutex<Vec<Kept<T>>>);

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

/// Caches of the most recently used motions, which avoid reading a motion again for every case.
#[derive(Debug, Default)]
pub(super) struct MotionCache {
    in_plane: Shelf<Shaken>,
    in_space: Shelf<barrelstack_space::Ground>,
}

/// Maximum memory (bytes) of each cache.
const CACHE: usize = 64 << 20;

impl<T> Shelf<T> {
    /// Returns the cached value of a motion. If the cache has none, `make` computes the value and its size
    /// (bytes).
    fn get(
        &self,
        motion: &Motion,
        base: &MotionSpec,
        similitude: f64,
        make: impl FnOnce() -> Result<(T, usize), GroundError>,
    ) -> Result<Arc<T>, StudyError> {
        let own = (motion.shaking == Shaking::Base).then(|| base.clone());
        let same = |kept: &Kept<T>| {
            kept.similitude == similitude && kept.base == own && kept.shaking == motion.shaking
        };
        if let Ok(mut cache) = self.0.lock()
            && let Some(at) = cache.iter().position(same)
        {
            // The most recently used entry is last; the first is evicted first.
            let kept = cache.remove(at);
            let made = Arc::clone(&kept.made);
            cache.push(kept);
            return Ok(made);
        }
        let (made, size) = make().map_err(|error| StudyError::Motion {
            name: motion.name.clone(),
            error: Box::new(error),
        })?;
        let made = Arc::new(made);
        if let Ok(mut cache) = self.0.lock() {
            let (shaking, made) = (motion.shaking.clone(), Arc::clone(&made));
            cache.push(Kept { shaking, base: own, similitude, made, size });
            let mut total: usize = cache.iter().map(|kept| kept.size).sum();
            while total > CACHE && cache.len() > 1 {
                total -= cache.remove(0).size;
            }
        }
        Ok(made)
    }
}

impl MotionCache {
    /// Returns an unscaled motion from the cache, or reads it from its source.
    pub(super) fn unscaled(
        &self,
        motion: &Motion,
        base: &MotionSpec,
        similitude: f64,
    ) -> Result<Arc<Shaken>, StudyError> {
        self.in_plane.get(motion, base, similitude, || {
            let ground = motion.shaking.ground(base, similitude)?;
            let measures = ground.motion.as_ref().map(measure).transpose()?;
            let size = size(&ground);
            Ok((Shaken { ground: Arc::new(ground), factor: 1.0, measures }, size))
        })
    }

    /// Returns all components of an unscaled motion from the cache, or reads them from the source. They are not yet
    /// rotated by the azimuth of the stack.
    pub(super) fn in_space(
        &self,
        motion: &Motion,
        base: &MotionSpec,
        similitude: f64,
    ) -> Result<Arc<barrelstack_space::Ground>, StudyError> {
        self.in_space.get(motion, base, similitude, || {
            let ground = motion.shaking.in_space(base, similitude)?;
            let size = size(&ground.first) + ground.second.as_ref().map_or(0, size);
            Ok((ground, size))
        })
    }

    /// Returns a motion scaled to a level of an intensity measure, or unscaled if there is no level.
    pub(super) fn at_level(
        &self,
        motion: &Motion,
        base: &MotionSpec,
        similitude: f64,
        level: Option<(IntensityMeasure, f64)>,
    ) -> Result<Shaken, StudyError> {
        let unscaled = self.unscaled(motion, base, similitude)?;
        let (Some((measure, level)), Some(as_read)) = (level, &unscaled.ground.motion) else {
            return Ok(Shaken::clone(&unscaled));
        };
        let failed = |error: MotionError| StudyError::Motion {
            name: motion.name.clone(),
            error: Box::new(error.into()),
        };
        let factor = as_read.scale_factor(measure, level).map_err(failed)?;
        let scaled = as_read.scaled(factor);
        let warnings = unscaled.ground.warnings.clone();
        let measures = unscaled.measures.map(|measures| scaled_measures(measures, factor));
        Ok(Shaken { ground: Arc::new(Ground { motion: Some(scaled), warnings }), factor, measures })
    }
}

fn measure(motion: &GroundMotion) -> Result<[f64; 9], MotionError> {
    let mut values = [0.0; 9];
    for (value, (_, measure)) in values.iter_mut().zip(MEASURES) {
        *value = motion.intensity(measure)?;
    }
    Ok(values)
}

/// Converts the intensity measures of a motion to those of the motion multiplied by `factor`.
///
/// The Arias intensity is proportional to the square of the factor. PGV/PGA and the duration do not change.
/// All other measures are proportional to the factor.
fn scaled_measures(mut values: [f64; 9], factor: f64) -> [f64; 9] {
    for (value, (_, measure)) in values.iter_mut().zip(MEASURES) {
        if measure == IntensityMeasure::Arias {
            *value *= factor * factor;
        } else if measure != IntensityMeasure::PgvOverPga && measure != IntensityMeasure::D5_95 {
            *value *= factor.abs();
        }
    }
    values
}

/// Returns the memory (bytes) that a motion takes: acceleration, velocity and displacement at every step.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of samples")]
fn size(ground: &Ground) -> usize {
    let Some(motion) = &ground.motion else { return 0 };
    let of = |history: &barrelstack_motion::History| {
        24 * (history.duration() / history.natural_step()).clamp(0.0, 1e8) as usize
    };
    of(&motion.horizontal) + motion.vertical.as_ref().map_or(0, of)
}

#[cfg(test)]
mod tests {
    use super::{MEASURES, measure, scaled_measures};

    #[test]
    fn realizations_of_an_ensemble_are_equally_long() {
        let text = |kind: &str| {
            format!(
                "schema = 1\ntitle = \"lengths\"\n[base]\nextends = \"candia-8-barrels\"\n[design]\nkind = \"stripes\"\n\
                 [intensity]\nmeasure = \"pgv\"\nlevels = [\"20 cm/s\"]\n\
                 [[motion]]\nsynthetic = {{ count = 6, {kind} }}\n"
            )
        };
        for kind in [
            "kind = \"boore\", magnitude = 6.0, distance = \"8 km\"",
            "kind = \"clough-penzien\", rms = \"1 m/s2\"",
            "kind = \"near-fault\", magnitude = 6.0, distance = \"8 km\", pulse_velocity = \"40 cm/s\", pulse_period = \"1 s\"",
        ] {
            let study = crate::Study::parse("lengths.toml", &text(kind)).unwrap();
            let base = study.scenario(&[]).unwrap().motion;
            let end = |at: usize| study.motions[at].shaking.ground(&base, 1.0).unwrap().end();
            assert!((1..6).all(|at| end(at) == end(0)), "{kind}");
        }
    }

    #[test]
    fn measures_of_a_scaled_motion_are_the_scaled_measures() {
        let record = barrelstack_motion::bundled("napa-college-2014").unwrap();
        let motion = record.default_motion().unwrap();
        let expected = measure(&motion.scaled(1.7)).unwrap();
        let scaled = scaled_measures(measure(&motion).unwrap(), 1.7);
        for ((name, _), (a, b)) in MEASURES.iter().zip(expected.iter().zip(scaled)) {
            // Measured: 4e-16.
            assert!((a / b - 1.0).abs() < 1e-12, "{name}: {a} and {b}");
        }
    }
}
