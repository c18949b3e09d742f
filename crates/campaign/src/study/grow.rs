//! Checks whether finished chunks remain valid after a study has changed: computes the keys of chunks, and compares a
//! study with the study in a folder.

use barrelstack_report::described;

use super::Study;
use super::design::{Design, PlannedCase};
use super::error::StudyError;
use super::folder::{MotionSource, Provenance};
use super::motions::hash_files;
use crate::scenario::fnv1a;
use crate::scenario::quantity::plain;

// The motions and the number of samples are not among these inputs, since a study may grow by motions and samples that
// are added after the existing ones. Instead, the key of a chunk covers the cases of the chunk and their motions.
described! {
    /// An input on which every case of a study depends.
    #[derive(Clone, Debug, PartialEq, Eq, serde::Deserialize)]
    pub struct Common {
        /// Name of the input, as it appears in messages.
        pub what: String,
        /// Fingerprint of the input.
        pub hash: String,
    }
}

/// Fingerprints from which the keys of the shards of a study are computed.
pub(super) struct Keys {
    /// Fingerprint of the inputs that all cases share.
    common: String,
    /// Fingerprints of the motions, in the order of the motions in the study.
    motions: Vec<u64>,
}

impl Study {
    /// Returns the inputs that all cases share.
    pub(super) fn common(&self) -> Result<Vec<Common>, StudyError> {
        let base = self.template.with([])?;
        let factors: Vec<String> = self
            .factors
            .iter()
            .map(|f| format!("{} {:?} {:?}", f.name, f.fields, f.variation))
            .collect();
        let intensity = self.intensity.as_ref().map(|i| format!("{} {:?}", i.measure, i.levels));
        let design = match &self.design {
            Design::LatinHypercube { count } => format!("latin-hypercube of {count}"),
            Design::Ida(hunt) => format!("{hunt:?}"),
            Design::OneAtATime { quantiles, draws: 0 } => format!("one-at-a-time {quantiles:?}"),
            Design::OneAtATime { draws, .. } => format!("one-at-a-time of {draws} draws"),
            Design::FullFactorial
            | Design::Sobol { .. }
            | Design::Saltelli { .. }
            | Design::MonteCarlo { .. }
            | Design::Stripes => self.design.name().to_owned(),
        };
        let motions =
            if self.is_sampled() { self.motions.len().to_string() } else { String::new() };
        let version = format!("{} {}", env!("CARGO_PKG_VERSION"), crate::ensemble::VERSION);
        let seed = self.seed.to_string();
        let base = format!("{:016x}", base.fingerprint());
        let parts = [
            ("the version of the program", version),
            ("`seed`", seed),
            ("the scenario in [base]", base),
            ("a [[factor]]", factors.join("\n")),
            ("[intensity]", intensity.unwrap_or_default()),
            ("[design]", format!("{design}, chunks of {:?}", self.chunk)),
            ("the number of motions, from which each sample takes one,", motions),
        ];
        let common = |(what, text): (&str, String)| Common {
            what: what.to_owned(),
            hash: format!("{:016x}", fnv1a(text.as_bytes())),
        };
        Ok(parts.into_iter().map(common).collect())
    }

    /// `true` if the motion of a case is sampled, and therefore depends on the number of motions.
    fn is_sampled(&self) -> bool {
        self.design.is_sample() || matches!(self.design, Design::Saltelli { .. })
    }

    /// Returns the fingerprints from which the keys of shards are computed.
    pub(super) fn keys(&self) -> Result<Keys, StudyError> {
        let common: Vec<String> = self.common()?.into_iter().map(|one| one.hash).collect();
        Ok(Keys { common: common.join(" "), motions: self.motion_keys()? })
    }

    /// Returns a fingerprint of each motion, from its method and the bytes of its files.
    fn motion_keys(&self) -> Result<Vec<u64>, StudyError> {
        let base = self.scenario(&[])?;
        let key = |motion: &super::Motion| {
            let files = hash_files(&motion.name, &motion.shaking.files(Some(&base.motion)))?;
            let text = format!("{} {:016x} {files:?}", motion.name, motion.shaking.key());
            Ok(fnv1a(text.as_bytes()))
        };
        self.motions.iter().map(key).collect()
    }

    /// Returns the key of a chunk: a fingerprint of the inputs that all cases share, and of the cases of the
    /// chunk with their motions, levels and values.
    pub(super) fn chunk_key(&self, chunk: usize, keys: &Keys) -> u64 {
        let words = |case: &PlannedCase| {
            let settings: Vec<String> = case
                .settings
                .iter()
                .map(|setting| setting.as_ref().map_or_else(String::new, super::Setting::word))
                .collect();
            let level = case.level.map_or_else(String::new, plain);
            let motion = keys.motions[case.motion];
            format!("{} {:016x} {motion:016x} {level} {settings:?}", case.number, case.id)
        };
        let numbers = self.chunks.numbers(chunk);
        let cases = numbers.iter().map(|number| words(&self.cases.case(self, *number)));
        let all: Vec<String> = std::iter::once(keys.common.clone()).chain(cases).collect();
        fnv1a(all.join("\n").as_bytes())
    }
}

/// Describes how the study in a folder differs from another study in the inputs that all cases share.
///
/// Returns `None` if there is no such difference, so that finished chunks may be kept.
pub(super) fn difference(known: &Provenance, wanted: &Provenance) -> Option<String> {
    if known.version != wanted.version {
        return Some(format!(
            "it was written by version {}, and this is version {}",
            known.version, wanted.version
        ));
    }
    if known.seed != wanted.seed {
        return Some(format!(
            "its seed is {}, and the seed of this study is {}",
            known.seed, wanted.seed
        ));
    }
    // If a motion is removed or replaced, existing rows would belong to no motion of the study.
    let same = |a: &MotionSource, b: &MotionSource| {
        (&a.name, &a.hash, &a.key) == (&b.name, &b.hash, &b.key)
    };
    let is_kept = |motion: &&MotionSource| wanted.motions.iter().any(|other| same(motion, other));
    let changed = known.motions.iter().find(|motion| !is_kept(motion));
    if let Some(motion) = changed {
        let same_name = wanted.motions.iter().any(|other| other.name == motion.name);
        let what = if motion.hash.is_some() { "record" } else { "motion" };
        return Some(if same_name {
            format!("the {what} \"{}\" has changed", motion.name)
        } else {
            format!("it has the motion \"{}\", which this study does not have", motion.name)
        });
    }
    let changed = known.common.iter().find(|common| !wanted.common.contains(common));
    changed.map(|common| format!("{} has changed", common.what))
}
