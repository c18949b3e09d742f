//! Collections of files: grouping into records, measures of each record, and flatfiles.

mod flatfile;
mod grouping;
mod measured;

pub use flatfile::{FlatRow, Flatfile, record_sequence_number};
pub use grouping::{RecordFiles, group_files};
pub use measured::{Measured, MeasuredComponent, MeasuredPair, measure};
