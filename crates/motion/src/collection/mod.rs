//! Many files: which belong together, what each record measures, and what a flatfile knows of it.

mod flatfile;
mod grouping;
mod measured;

pub use flatfile::{FlatRow, Flatfile, record_sequence_number};
pub use grouping::{RecordFiles, group_files};
pub use measured::{Measured, MeasuredComponent, MeasuredPair, measure};
