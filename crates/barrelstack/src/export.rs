//! The files of a run, in one folder.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::report;
use crate::run::Run;
use crate::summary::Summary;

/// The names of all files that a run writes; nothing else in a folder is ever touched.
const FILES: [&str; 8] = [
    "summary.json",
    "scenario.toml",
    "histories.csv",
    "histories.npz",
    "forces.csv",
    "envelopes.csv",
    "frames.csv",
    "report.html",
];

/// Why files could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Something of an earlier run is there.
    #[error(
        "{folder} already holds {file}: name another folder, or add --overwrite to replace the \
         earlier run",
        folder = folder.display()
    )]
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// A file that is there.
        file: String,
    },
    /// The system refused.
    #[error("cannot write {path}: {reason}", path = path.display())]
    Write {
        /// The path.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
}

/// A folder that is ready to take the files of a run.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Checks a folder before the work is done; makes nothing yet.
    ///
    /// # Errors
    /// When it holds files of an earlier run and `overwrite` is not set, or is no folder.
    pub fn prepare(path: &Path, overwrite: bool) -> Result<Self, ExportError> {
        if path.exists() && !path.is_dir() {
            return Err(ExportError::Write {
                path: path.to_owned(),
                reason: "it is a file, not a folder".into(),
            });
        }
        let earlier = FILES.iter().find(|file| path.join(file).exists());
        if let (false, Some(file)) = (overwrite, earlier) {
            return Err(ExportError::Occupied {
                folder: path.to_owned(),
                file: (*file).to_owned(),
            });
        }
        Ok(Self { path: path.to_owned() })
    }

    /// Where the report is.
    pub fn report(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// Writes all files; each under a temporary name first, so that none is ever half there.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn write(&self, run: &Run, summary: &Summary) -> Result<(), ExportError> {
        std::fs::create_dir_all(&self.path).map_err(|error| self.refused("", &error))?;
        self.put("summary.json", (summary.to_json() + "\n").as_bytes())?;
        self.put("scenario.toml", run.scenario.to_resolved_toml().as_bytes())?;
        self.put("histories.csv", histories_csv(run).as_bytes())?;
        self.put("histories.npz", &self.histories_npz(run)?)?;
        self.put("forces.csv", forces_csv(run).as_bytes())?;
        self.put("envelopes.csv", envelopes_csv(run).as_bytes())?;
        self.put("frames.csv", frames_csv(run).as_bytes())?;
        let document = report::document(run, summary);
        self.put("report.html", barrelstack_report::html(&document).as_bytes())
    }

    fn put(&self, name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        let temporary = self.path.join(format!("{name}.part"));
        let write = || -> std::io::Result<()> {
            let mut file = std::fs::File::create(&temporary)?;
            file.write_all(bytes)?;
            std::fs::rename(&temporary, self.path.join(name))
        };
        write().map_err(|error| self.refused(name, &error))
    }

    fn refused(&self, name: &str, error: &std::io::Error) -> ExportError {
        ExportError::Write { path: self.path.join(name), reason: error.to_string() }
    }

    /// All channels as arrays, named like the columns of the CSV, and "time".
    fn histories_npz(&self, run: &Run) -> Result<Vec<u8>, ExportError> {
        let recording = &run.recording;
        let mut arrays = vec![("time".to_owned(), recording.times.as_slice())];
        for channel in &recording.channels {
            arrays.push((channel.name.replace(' ', "_"), &channel.values));
        }
        for joint in &recording.joints {
            let name = joint.name.replace(' ', "_");
            arrays.push((format!("{name}_vertical_force"), &joint.vertical));
            arrays.push((format!("{name}_horizontal_force"), &joint.horizontal));
        }
        npz(&arrays).map_err(|error| self.refused("histories.npz", &error))
    }
}

/// NumPy's archive: an uncompressed zip of one `.npy` for every array.
fn npz(arrays: &[(String, &[f64])]) -> std::io::Result<Vec<u8>> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    // The default date of the archive is a constant, so equal runs give equal bytes.
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (name, values) in arrays {
        archive.start_file(format!("{name}.npy"), options)?;
        archive.write_all(&npy(values))?;
    }
    Ok(archive.finish()?.into_inner())
}

/// NumPy's array format, version 1.0: a magic word, a padded description, the numbers.
fn npy(values: &[f64]) -> Vec<u8> {
    let mut description =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", values.len());
    // Magic, version, length, description and line feed together fill a multiple of 64 bytes.
    while (10 + description.len() + 1) % 64 != 0 {
        description.push(' ');
    }
    description.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(description.len()).unwrap_or(u16::MAX).to_le_bytes());
    bytes.extend(description.as_bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// Columns side by side, `time (s)` first.
fn csv(times: &[f64], columns: &[(String, &[f64])]) -> String {
    let mut text = String::from("time (s)");
    for (name, _) in columns {
        let _ = write!(text, ",{name}");
    }
    text.push('\n');
    for (row, time) in times.iter().enumerate() {
        let _ = write!(text, "{time}");
        for (_, values) in columns {
            match values.get(row) {
                Some(value) => _ = write!(text, ",{value}"),
                None => text.push(','),
            }
        }
        text.push('\n');
    }
    text
}

fn histories_csv(run: &Run) -> String {
    let columns: Vec<(String, &[f64])> = run
        .recording
        .channels
        .iter()
        .map(|c| (format!("{} ({})", c.name, c.unit), c.values.as_slice()))
        .collect();
    csv(&run.recording.times, &columns)
}

fn forces_csv(run: &Run) -> String {
    let columns: Vec<(String, &[f64])> = run
        .recording
        .joints
        .iter()
        .flat_map(|joint| {
            [
                (format!("{} vertical (N)", joint.name), joint.vertical.as_slice()),
                (format!("{} horizontal (N)", joint.name), joint.horizontal.as_slice()),
            ]
        })
        .collect();
    csv(&run.recording.times, &columns)
}

fn envelopes_csv(run: &Run) -> String {
    let mut text = String::from(
        "body,x (m),z (m),coordinate (rad or m),stress at rest (N/m),largest stress (N/m)\n",
    );
    for envelope in &run.stresses.envelopes {
        let name = &run.assembly.parts[envelope.body].name;
        for ((point, rest), peak) in
            envelope.points.iter().zip(&envelope.at_rest).zip(&envelope.peak)
        {
            let _ = writeln!(
                text,
                "{name},{},{},{},{rest},{peak}",
                point.position.x, point.position.z, point.coordinate
            );
        }
    }
    text
}

fn frames_csv(run: &Run) -> String {
    let mut text = String::from("time (s)");
    for part in &run.assembly.parts {
        let _ = write!(text, ",{0} x (m),{0} z (m),{0} angle (rad)", part.name);
    }
    text.push('\n');
    for (time, poses) in run.recording.frames.times.iter().zip(&run.recording.frames.poses) {
        let _ = write!(text, "{time}");
        for pose in poses {
            let _ = write!(text, ",{},{},{}", pose[0], pose[1], pose[2]);
        }
        text.push('\n');
    }
    text
}
