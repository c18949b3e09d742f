//! Ground motions bundled with this crate. Their headers contain the notices required by their
//! owners.

use crate::format::{ReadOptions, read};
use crate::record::Record;

/// Names accepted by [`bundled`].
pub const BUNDLED: &[&str] = &["napa-college-2014"];

const NAPA_COLLEGE: &[u8] = include_bytes!("../records/napa-college-2014.txt");

/// Returns a bundled record by name, or `None` if there is no such record.
///
/// `napa-college-2014` is the South Napa earthquake of 24 August 2014, M 6.0, at Napa College
/// (CE.68150): E (PGA 0.373 g), N (0.339 g) and up (0.215 g), 200 Hz, 35 s. The series was cut
/// after filtering, so plain integration drifts by half a meter. The file therefore states the
/// processing stage [`Raw`](crate::Stage::Raw), and the default processing filters the series again.
///
/// ```
/// let napa = barrelstack_motion::bundled("napa-college-2014").unwrap();
/// let motion = napa.default_motion()?;
/// assert!(motion.pgv() > 0.4);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
pub fn bundled(name: &str) -> Option<Record> {
    match name {
        "napa-college-2014" => {
            read(NAPA_COLLEGE, "napa-college-2014.txt", &ReadOptions::default()).ok()
        }
        _ => None,
    }
}
