//! Date and commit that are printed on report pages.

use barrelstack_input::system;
use barrelstack_motion::Utc;
use barrelstack_report::Stamp;

/// Adds the date, and the commit from which the program was built, to all pages that the process writes from now on.
/// The date is read from the environment variable `SOURCE_DATE_EPOCH` if it is set, otherwise from the clock.
///
/// The environment variable `BARRELSTACK_COMMIT` replaces the commit. It is read when the program runs, not only
/// when it is built, so that the pages of two builds can be compared bit for bit, as the tests do.
///
/// # Errors
/// Returns the reason why the date is unknown; each page then states this reason in place of the date.
#[expect(clippy::disallowed_methods, reason = "pages state their commit, which enters no result")]
pub fn stamp_pages(built: &str) -> Result<(), String> {
    let commit = std::env::var("BARRELSTACK_COMMIT").unwrap_or_else(|_| built.to_owned());
    let stated = || date().unwrap_or_else(|reason| format!("unknown ({reason})"));
    Stamp { date: stated, commit }.state();
    date().map(drop)
}

fn date() -> Result<String, String> {
    let seconds = system::clock()?;
    let now = Utc::of_unix(seconds).ok_or_else(|| {
        format!("SOURCE_DATE_EPOCH: expected a time before the year 2200, in seconds since 1970, found {seconds}; correct or unset this variable")
    })?;
    Ok(format!("{} (UTC)", now.date()))
}
