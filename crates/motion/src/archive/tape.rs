//! Access to the files inside a tar archive.

/// Returns `true` if the bytes begin with the header of a tar archive with a valid checksum.
pub(super) fn is_tar(bytes: &[u8]) -> bool {
    let Some(head) = bytes.get(..512) else { return false };
    let sum: u32 = head
        .iter()
        .enumerate()
        .map(|(at, byte)| u32::from(if (148..156).contains(&at) { b' ' } else { *byte }))
        .sum();
    let stated = tar::Header::from_byte_slice(head).cksum();
    head[0] != 0 && stated.is_ok_and(|stated| stated == sum)
}

/// Calls `take` with the name and the content of every file until `take` returns `false`.
///
/// If the archive is truncated within a file, `take` receives `None` as the content of this file.
///
/// # Errors
/// The outer result is an error if the archive is damaged; the inner result is an error if `take` returns one.
pub(super) fn each_file<E>(
    archive: &[u8],
    mut take: impl FnMut(&str, Option<&[u8]>) -> Result<bool, E>,
) -> std::io::Result<Result<(), E>> {
    for entry in tar::Archive::new(archive).entries()? {
        let entry = entry?;
        if !entry.header().entry_type().is_file() {
            continue;
        }
        let path = entry.path_bytes();
        let name = String::from_utf8_lossy(&path);
        let begin = usize::try_from(entry.raw_file_position()).unwrap_or(usize::MAX);
        let size = usize::try_from(entry.size()).unwrap_or(usize::MAX);
        let bytes = begin.checked_add(size).and_then(|end| archive.get(begin..end));
        match take(name.trim_start_matches("./"), bytes) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => return Ok(Err(error)),
        }
    }
    Ok(Ok(()))
}
