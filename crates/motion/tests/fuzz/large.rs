//! Files of one megabyte made from a small one: enlarged consistently if possible, or absurd.

/// Size of the files (bytes).
pub(crate) const SIZE: usize = 1_000_000;

/// Returns large files derived from a sample.
pub(crate) fn files(sample: &[u8]) -> Vec<Vec<u8>> {
    let mut files = vec![repeated(sample, sample), repeated(&[], sample)];
    files.extend(sound(sample));
    let head = &sample[..sample.len().min(4000)];
    for filling in [
        b"\n".as_slice(),
        b" ",
        b"1 ",
        b"1,",
        b"-",
        b"1.5-1.5",
        b"0.1 0.2\n",
        b"9",
        b"\0",
        b":",
        b"/",
        b"|\n",
    ] {
        files.push(repeated(sample, filling));
        files.push(repeated(head, filling));
        // Insert in front, so that the header becomes absurd.
        let mut front = filling.repeat((SIZE - sample.len().min(SIZE / 2)) / filling.len());
        front.extend(sample);
        files.push(front);
    }
    // Without line ends the whole file is one line.
    files.push(repeated(sample, sample).into_iter().filter(|&b| b != b'\n').collect());
    files
}

/// Returns a sample enlarged to a large file, for each kind of count in its format.
pub(crate) fn sound(sample: &[u8]) -> Vec<Vec<u8>> {
    let rows = [Counts::Values, Counts::Rows].into_iter().filter_map(|c| grown(sample, c));
    rows.chain(grown_words(sample)).collect()
}

fn repeated(start: &[u8], filling: &[u8]) -> Vec<u8> {
    let mut file = start.to_vec();
    while file.len() < SIZE {
        file.extend(filling);
    }
    file.truncate(SIZE.max(start.len()));
    file
}

fn is_data(line: &[u8]) -> bool {
    let plain = line.trim_ascii();
    !plain.is_empty() && plain.iter().all(|b| b.is_ascii_digit() || b"+-.eE \t,;".contains(b))
}

/// Unit of the count in a header, which depends on the format.
#[derive(Clone, Copy)]
enum Counts {
    Values,
    Rows,
}

/// Repeats the longest block of full rows of numbers, and corrects the counts before it.
fn grown(sample: &[u8], counts: Counts) -> Option<Vec<u8>> {
    let lines: Vec<&[u8]> = sample.split_inclusive(|&b| b == b'\n').collect();
    let mut best = 0..0;
    let mut from = 0;
    for k in 0..=lines.len() {
        let goes_on = k > from
            && k < lines.len()
            && is_data(lines[from])
            && is_data(lines[k])
            && fields(lines[k]) == fields(lines[from]);
        if !goes_on {
            if k - from > best.len() {
                best = from..k;
            }
            from = k;
        }
    }
    let block = lines[best.clone()].concat();
    if best.len() < 3 {
        return None;
    }
    let times = (SIZE - sample.len().min(SIZE)) / block.len();
    let rows = times * best.len();
    let more = match counts {
        Counts::Values => rows * fields(lines[best.start]),
        Counts::Rows => rows,
    };
    let mut file = Vec::with_capacity(SIZE);
    for line in &lines[..best.start] {
        file.extend(with_counts(line, more));
    }
    for _ in 0..=times {
        file.extend(&block);
    }
    file.extend(lines[best.end..].concat());
    Some(file)
}

fn fields(line: &[u8]) -> usize {
    line.split(|b| b.is_ascii_whitespace() || *b == b',').filter(|f| !f.is_empty()).count()
}

/// Increases the counts in a header line by the number of added values. In all samples, counts are
/// integers from 101 to 103.
fn with_counts(line: &[u8], more: usize) -> Vec<u8> {
    let text: String = line.iter().map(|&b| char::from(b)).collect();
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit()) {
        let end = rest[at..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |k| at + k);
        let word = &rest[at..end];
        let whole = !rest[..at].ends_with(['.', '-', '_']) && !rest[end..].starts_with('.');
        match word.parse::<usize>() {
            Ok(count @ 101..=103) if whole => {
                let wide = (count + more).to_string();
                // Keep the columns, if blanks precede the count.
                let blanks = rest[..at].len() - rest[..at].trim_end_matches(' ').len();
                let eaten = (wide.len() - word.len()).min(blanks.saturating_sub(1));
                out.push_str(&rest[..at - eaten]);
                out.push_str(&wide);
            }
            _ => out.push_str(&rest[..end]),
        }
        rest = &rest[end..];
    }
    out.push_str(rest);
    out.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect()
}

/// Repeats the samples of a binary file consistently.
fn grown_words(sample: &[u8]) -> Option<Vec<u8>> {
    grown_sac(sample).or_else(|| grown_miniseed(sample))
}

/// Increases the header words that state the count.
fn grown_sac(sample: &[u8]) -> Option<Vec<u8>> {
    const HEADER: usize = 632;
    const COUNT: usize = 79 * 4;
    let little = sample.get(76 * 4..77 * 4)? == 6_i32.to_le_bytes();
    let big = sample.get(76 * 4..77 * 4)? == 6_i32.to_be_bytes();
    if !little && !big {
        return None;
    }
    let mut file = sample.to_vec();
    while file.len() + sample.len() < SIZE {
        file.extend(&sample[HEADER..]);
    }
    let count = i32::try_from((file.len() - HEADER) / 4).ok()?;
    let word = if little { count.to_le_bytes() } else { count.to_be_bytes() };
    file[COUNT..COUNT + 4].copy_from_slice(&word);
    Some(file)
}

/// Shifts the times of the data records so that they follow one another, as in one channel.
fn grown_miniseed(sample: &[u8]) -> Option<Vec<u8>> {
    /// Ticks per second of the clock in the header (1/s).
    const TICKS: u32 = 10_000;
    let looks_like_one = sample.len() >= 64
        && sample[..6].iter().all(u8::is_ascii_digit)
        && sample[6] == b'D'
        && (7..=20).contains(&sample[54]);
    if !looks_like_one {
        return None;
    }
    let number = |at: usize| u16::from_be_bytes([sample[at], sample[at + 1]]);
    let length = 1_usize << sample[54];
    let records = sample.chunks_exact(length);
    let samples: u32 =
        records.map(|record| u32::from(u16::from_be_bytes([record[30], record[31]]))).sum();
    // The sampling rate is an integer in Hz.
    let span = samples * TICKS / u32::from(number(32));
    let mut file = Vec::with_capacity(SIZE);
    let mut shift = 0;
    while file.len() + sample.len() <= SIZE {
        for record in sample.chunks_exact(length) {
            let mut record = record.to_vec();
            let fraction = u32::from(u16::from_be_bytes([record[28], record[29]]));
            let clock =
                u32::from(record[24]) * 3600 + u32::from(record[25]) * 60 + u32::from(record[26]);
            let now = clock * TICKS + fraction + shift;
            let seconds = now / TICKS;
            record[24] = u8::try_from(seconds / 3600 % 24).ok()?;
            record[25] = u8::try_from(seconds / 60 % 60).ok()?;
            record[26] = u8::try_from(seconds % 60).ok()?;
            record[28..30].copy_from_slice(&u16::try_from(now % TICKS).ok()?.to_be_bytes());
            file.extend(record);
        }
        shift += span;
    }
    Some(file)
}
