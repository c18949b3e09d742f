//! Positions in a text file: a line, a column, or a block of columns.

/// Layout of a block of numbers in Fortran columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    /// Number of blank columns before the first field.
    pub(crate) indent: usize,
    /// Number of fields per line.
    pub(crate) per_line: usize,
    /// Number of characters per field.
    pub(crate) width: usize,
}

impl Columns {
    pub(crate) fn new(per_line: usize, width: usize) -> Self {
        Self { indent: 0, per_line, width }
    }

    /// Parses a Fortran format such as `8F10.5`, `(10I8)` or `(1X,10F7.3)`; repeated groups such as
    /// `5(E15.7)` are not supported.
    pub(crate) fn parse(format: &str) -> Option<Self> {
        let inner = format.trim().trim_start_matches('(');
        let inner = inner.split(')').next()?.trim();
        let mut indent = 0;
        let mut block = None;
        for part in inner.split(',') {
            let part = part.trim().to_ascii_uppercase();
            if let Some(blanks) = part.strip_suffix('X') {
                indent += blanks.parse::<usize>().ok()?;
                continue;
            }
            let letter = part.find(['F', 'E', 'I', 'G', 'D'])?;
            let per_line = if letter == 0 { 1 } else { part[..letter].parse().ok()? };
            let width: usize = part[letter + 1..].split('.').next()?.parse().ok()?;
            block = Some(Self { indent, per_line, width });
        }
        let block = block?;
        ((1..=1000).contains(&block.per_line) && (1..=100).contains(&block.width)).then_some(block)
    }
}

/// Position in a file, counted from 0.
#[derive(Clone, Copy, Default)]
pub(crate) struct FilePosition {
    pub(crate) line: Option<usize>,
    pub(crate) column: Option<usize>,
}

impl From<()> for FilePosition {
    fn from((): ()) -> Self {
        Self::default()
    }
}

impl From<usize> for FilePosition {
    fn from(line: usize) -> Self {
        Self { line: Some(line), column: None }
    }
}

impl From<Option<usize>> for FilePosition {
    fn from(line: Option<usize>) -> Self {
        Self { line, column: None }
    }
}

impl From<(usize, usize)> for FilePosition {
    fn from((line, column): (usize, usize)) -> Self {
        Self { line: Some(line), column: Some(column) }
    }
}
