//! Ground motion of a scenario: read or generated, scaled, and ready to drive a run.

use std::path::Path;

use barrelstack_columns::described;
use barrelstack_motion::{GroundMotion, MotionError, Record};

use crate::scenario::{FileRef, MotionSource, RecordMotion, RecordSource, Scenario};

pub use barrelstack_shaking::ground::{
    Ground, GroundError, RECORD_LIMIT, event, from_disk, held, of_record, of_spec, other_component,
    scaled, turn_to_other,
};

described! {
    /// Ground motion of the run.
    #[derive(Clone, Debug)]
    pub struct MotionSummary of motion: &GroundMotion {
        /// Name of the motion.
        pub name: String = motion.name.clone(),
        /// Peak horizontal acceleration (m/s²).
        pub pga: f64 as "m/s2" = motion.pga(),
        /// Peak horizontal velocity (m/s).
        pub pgv: f64 as "m/s" = motion.pgv(),
        /// Peak horizontal displacement (m).
        pub pgd: f64 as "m" = motion.pgd(),
        /// True if there is a vertical component.
        pub vertical: bool = motion.vertical.is_some(),
        /// Time at which the shaking ends.
        pub duration: f64 as "s" = motion.duration,
    }
}

impl Scenario {
    /// Reads or generates the ground motion of the scenario, and scales it.
    ///
    /// The warnings of the result include the [warnings](Self::warnings) of the scenario.
    ///
    /// # Errors
    /// If a record cannot be read, lacks the requested component, or cannot be scaled.
    pub fn ground(&self) -> Result<Ground, GroundError> {
        let mut ground = of_spec(&self.motion, self.run.similitude)?;
        ground.warnings.splice(0..0, self.warnings().iter().cloned());
        Ok(ground)
    }

    /// Returns the ground motion of a record in memory, in place of the scenario's own motion.
    ///
    /// Components, processing and scale are taken from the scenario. If the scenario's own motion is not a record, the
    /// first horizontal component with the default processing is used.
    ///
    /// ```
    /// use barrelstack_stack::Scenario;
    ///
    /// let record = barrelstack_motion::bundled("napa-college-2014").expect("a bundled record");
    /// let scenario =
    ///     Scenario::builtin("candia-8-barrels", &["motion.scale.pgv=60 cm/s".to_owned()])?;
    /// let motion = scenario.ground_of(&record)?.motion.expect("a record moves");
    /// assert!((motion.pgv() - 0.6).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the record lacks a requested component, or cannot be scaled.
    pub fn ground_of(&self, record: &Record) -> Result<Ground, GroundError> {
        let spec = self.recorded(RecordSource::Bundled(record.file.clone()));
        of_record(record, &spec, &self.motion, self.run.similitude)
    }

    /// Returns the scenario with the records of its motion loaded into memory, so that the scenario opens no file
    /// afterwards.
    ///
    /// `fetch` returns the content of a file by its path; records already in memory are not fetched. A run loads files
    /// with [`from_disk`]. On failure, `fetch` returns the message from the operating system, such as "there is no
    /// such file".
    ///
    /// ```
    /// use barrelstack_stack::Scenario;
    ///
    /// let scenario = Scenario::builtin("candia-6-barrels", &["run.duration=2 s".to_owned()])?;
    /// let record = barrelstack_motion::bundled("napa-college-2014").expect("a bundled record");
    /// let bytes = barrelstack_motion::write::text(&record)?.into_bytes();
    /// let scenario = scenario.with_records(&mut |_| Ok(bytes.clone()))?;
    /// assert!(scenario.run()?.ground.motion.is_some());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `fetch` fails.
    pub fn with_records(
        &self,
        fetch: &mut dyn FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Self, GroundError> {
        let mut held = self.clone();
        held.motion = held.motion.with_files(fetch)?;
        Ok(held)
    }

    /// Returns the scenario with a record in memory in place of its own motion.
    ///
    /// The components, the processing and the scale of the scenario are kept.
    ///
    /// # Errors
    /// If the record has no channel, or if its channels have different time steps.
    pub fn with_record(&self, record: &Record) -> Result<Self, MotionError> {
        Ok(self.with_record_file(&held(record)?))
    }

    /// Returns the scenario with the record in `file` in place of its own motion.
    ///
    /// Many scenarios can share one file in memory; see [`held`].
    #[must_use]
    pub fn with_record_file(&self, file: &FileRef) -> Self {
        let mut scenario = self.clone();
        let source = RecordSource::File(file.clone());
        scenario.motion.source = MotionSource::Record(self.recorded(source));
        scenario.retitle();
        scenario
    }

    /// Returns a motion that consists of the given record, with the components and the processing that the scenario
    /// states for its own record. If the scenario has no record, the first horizontal component with the default
    /// processing is used.
    fn recorded(&self, source: RecordSource) -> RecordMotion {
        match &self.motion.source {
            MotionSource::Record(own) => RecordMotion { source, ..own.clone() },
            MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_) => {
                RecordMotion::of(source)
            }
        }
    }
}
