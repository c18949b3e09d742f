//! A file of VTK `PolyData`: markup, followed by all arrays in one block of bytes.

use std::fmt::Write as _;
use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::POSE_QUANTUM;

/// A VTK `PolyData` file under construction. Each array is compressed separately.
pub(super) struct PolyData {
    markup: String,
    arrays: Vec<u8>,
}

impl PolyData {
    /// Starts a file of one piece with the given numbers of points, vertices, lines and polygons.
    pub(super) fn new(points: usize, [vertices, lines, polygons]: [usize; 3]) -> Self {
        let markup = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" \
             header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n\
             <Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{vertices}\" NumberOfLines=\"{lines}\" \
             NumberOfStrips=\"0\" NumberOfPolys=\"{polygons}\">\n"
        );
        Self { markup, arrays: Vec::new() }
    }

    /// Opens an XML element: `element` is its name, followed by its attributes if it has any.
    pub(super) fn open(&mut self, element: &str) {
        // Writing to a String cannot fail, here and below.
        let _ = writeln!(self.markup, "<{element}>");
    }

    /// Closes an XML element.
    pub(super) fn close(&mut self, name: &str) {
        self.open(&format!("/{name}"));
    }

    /// Adds the positions (m) of the points.
    pub(super) fn points(&mut self, values: impl Iterator<Item = [f64; 3]>) {
        self.open("Points");
        self.lengths("points", values);
        self.close("Points");
    }

    /// Adds an array of positions or displacements (m), with components rounded to multiples of [`POSE_QUANTUM`].
    ///
    /// The rounding is too small to be visible and makes the file smaller by a third.
    pub(super) fn lengths(&mut self, name: &str, values: impl Iterator<Item = [f64; 3]>) {
        self.vectors(
            name,
            values.map(|vector| vector.map(|v| (v / POSE_QUANTUM).round() * POSE_QUANTUM)),
        );
    }

    /// Adds an array of vectors in single precision.
    #[expect(clippy::cast_possible_truncation, reason = "single precision suffices for a picture")]
    pub(super) fn vectors(&mut self, name: &str, values: impl Iterator<Item = [f64; 3]>) {
        self.array(
            ("Float32", name, 3),
            values.flatten().map(|value| (value as f32).to_le_bytes()),
        );
    }

    /// Adds an array of 32-bit integers; the values are far below the limit of this type.
    pub(super) fn whole(&mut self, name: &str, values: impl Iterator<Item = usize>) {
        let number = |value| i32::try_from(value).unwrap_or(i32::MAX).to_le_bytes();
        self.array(("Int32", name, 1), values.map(number));
    }

    /// Adds all cells of one kind, such as `Lines`.
    ///
    /// `points` are the indices of their points, cell by cell, and `counts` are the numbers of points per cell.
    pub(super) fn cells(
        &mut self,
        name: &str,
        points: impl Iterator<Item = usize>,
        counts: impl Iterator<Item = usize>,
    ) {
        self.open(name);
        self.whole("connectivity", points);
        let ends = counts.scan(0, |end, count| {
            *end += count;
            Some(*end)
        });
        self.whole("offsets", ends);
        self.close(name);
    }

    /// Adds an array as one compressed block, preceded by the sizes of the block before and after
    /// compression. Written as text, the series of a collapse would take a gigabyte.
    fn array(
        &mut self,
        (kind, name, components): (&str, &str, u32),
        values: impl Iterator<Item = [u8; 4]>,
    ) {
        let _ = writeln!(
            self.markup,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/>",
            self.arrays.len()
        );
        let bytes: Vec<u8> = values.flatten().collect();
        if bytes.is_empty() {
            // An array without blocks.
            self.arrays.extend([0; 12]);
            return;
        }
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::default());
        // Writing to memory cannot fail.
        let packed = packer.write_all(&bytes).and_then(|()| packer.finish()).unwrap_or_default();
        let size = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        for number in [1, size(&bytes), 0, size(&packed)] {
            self.arrays.extend(number.to_le_bytes());
        }
        self.arrays.extend(packed);
    }

    /// Returns the whole file.
    pub(super) fn finish(self) -> Vec<u8> {
        let mut file = self.markup.into_bytes();
        file.extend(b"</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
        file.extend(self.arrays);
        file.extend(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}
