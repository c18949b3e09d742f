//! Shares of time by phase of the step, for typical runs.
//!
//! `perf` of Linux samples this program while it runs one kind of work, and `addr2line` names the source
//! lines of each sample, including those of inlined functions. A sample belongs to the phase of the innermost source
//! line of the engine that is not basic arithmetic.

use std::collections::{BTreeMap, HashMap};
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::{Failure, space, user};

/// Samples per second of processor time.
const RATE: &str = "1997";

/// Name and title of each kind of work.
const KINDS: [(&str, &str); 4] = [
    ("standing", "plane, study standing"),
    ("collapse", "plane, study collapsing"),
    ("demo", "plane, single run of the demo along"),
    ("space", "three dimensions, single run standing"),
];

/// Phases by the beginning of the path below `crates`; the first match applies. An empty name marks arithmetic, which
/// is counted in the phase that uses it.
const PHASES: [(&str, &str); 23] = [
    ("dynamics/src/real.rs", ""),
    ("dynamics/src/math.rs", ""),
    ("dynamics/src/space/", ""),
    ("dynamics/src/lanes/bundle.rs", ""),
    ("dynamics/src/lanes/mod.rs", ""),
    (LANEWISE, ""),
    ("dynamics/src/pairs.rs", "broad search of pairs"),
    ("dynamics/src/contact_elements.rs", "broad search of pairs"),
    ("dynamics/src/shape/", "narrow: closest points"),
    ("dynamics/src/solid/", "narrow: closest points"),
    ("dynamics/src/pair_frame.rs", "narrow: closest points"),
    ("dynamics/src/contact/", "contact forces"),
    ("dynamics/src/forces/", "contact forces"),
    ("dynamics/src/model.rs", "contact forces"),
    ("dynamics/src/integrate/", "integration"),
    ("dynamics/src/state.rs", "integration"),
    ("dynamics/src/simulate.rs", "integration"),
    ("dynamics/src/energy.rs", "energy balance"),
    ("dynamics/src/lanes/", LANES),
    ("dynamics/src/settle/", "settling"),
    ("series/", "ground motion"),
    ("stack/src/ground", "ground motion"),
    ("space/src/ground", "ground motion"),
];

/// Phase of all other code of the engine: verdicts, stresses, recordings.
const OBSERVERS: &str = "observers";
/// Phase of code that copies one lane and is not part of another phase. [`LANEWISE`] is the file of this code.
const LANES: &str = "filling and emptying of lanes";
const LANEWISE: &str = "dynamics/src/lanes/lanewise.rs";
/// Phase of code that does not belong to the engine.
const OTHER: &str = "standard library and system";

/// Runs one kind of work, which a profiler watches.
pub(crate) fn work(kind: &str) -> Result<(), Failure> {
    match kind {
        "standing" => user::study(user::STANDING).map(drop),
        "collapse" => user::collapsing().map(drop),
        "demo" => user::single("demo-napa", &["stack.view=longitudinal".to_owned()]).map(drop),
        "space" => space::single().map(drop),
        other => Err(format!("no work `{other}`").into()),
    }
}

/// Prints the shares of time by phase.
pub(crate) fn print() -> Result<(), Failure> {
    let shares = KINDS.map(|(kind, _)| shares(kind));
    let shares: Vec<BTreeMap<&str, f64>> = shares.into_iter().collect::<Result<_, _>>()?;
    let mut phases: Vec<&str> = PHASES.iter().map(|(_, phase)| *phase).collect();
    phases.extend([OBSERVERS, OTHER]);
    phases.retain(|phase| !phase.is_empty());
    phases.dedup();
    println!("| phase | {} |", KINDS.map(|(_, title)| title).join(" | "));
    println!("| :--- | {} |", KINDS.map(|_| "---:").join(" | "));
    for phase in phases {
        let cells = shares.iter().map(|all| all.get(phase).copied().unwrap_or_default());
        let cells: Vec<f64> = cells.collect();
        // Rows that would show only zeros are left out.
        if cells.iter().all(|share| *share < 0.005) {
            continue;
        }
        let cells: Vec<String> =
            cells.iter().map(|share| format!("{:.0} %", 100.0 * share)).collect();
        println!("| {phase} | {} |", cells.join(" | "));
    }
    Ok(())
}

/// Returns the share of each phase in the time of one kind of work.
fn shares(kind: &str) -> Result<BTreeMap<&'static str, f64>, Failure> {
    let program = std::env::current_exe()?;
    let data = std::env::temp_dir().join(format!("barrelstack-{}-{kind}.perf", std::process::id()));
    let recorded = Command::new("perf")
        .args(["record", "--quiet", "-e", "cpu-clock:u", "-F", RATE, "-o"])
        .arg(&data)
        .arg("--")
        .arg(&program)
        .args(["work", kind])
        .stdout(Stdio::null())
        .status()
        .map_err(|error| format!("perf: {error}; it is part of the package linux-perf"))?;
    if !recorded.success() {
        return Err("perf could not record: see its message above".into());
    }
    let script = output(
        Command::new("perf")
            .args(["script", "--show-mmap-events", "-F", "ip,event", "-i"])
            .arg(&data),
    )?;
    std::fs::remove_file(&data)?;
    let counts = addresses(&script, &program, offset(&program)?);
    let all: u64 = counts.values().sum();
    if all == 0 {
        return Err("perf has no samples of this program".into());
    }
    let mut shares = BTreeMap::new();
    for (address, phase) in phases(&program, counts.keys().filter_map(|address| *address))? {
        *shares.entry(phase).or_default() += counts[&Some(address)] as f64 / all as f64;
    }
    *shares.entry(OTHER).or_default() +=
        counts.get(&None).copied().unwrap_or_default() as f64 / all as f64;
    Ok(shares)
}

/// Returns the number of samples at every address of a program file. The key `None` counts the samples in other files.
///
/// `offset` is the address of machine code minus its position in the file ([`offset`]).
fn addresses(script: &str, program: &Path, offset: u64) -> HashMap<Option<u64>, u64> {
    let name = program.to_string_lossy();
    // Where parts of the file are in memory: start, length and place in the file.
    let mut mapped: Vec<[u64; 3]> = Vec::new();
    let mut counts = HashMap::new();
    for line in script.lines() {
        if let Some((_, map)) = line.split_once("PERF_RECORD_MMAP") {
            if !map.contains(&*name) {
                continue;
            }
            let numbers: Vec<u64> = map
                .split(['[', '(', ')', ' ', '@'])
                .filter_map(|word| u64::from_str_radix(word.strip_prefix("0x")?, 16).ok())
                .collect();
            if let [start, length, rest @ ..] = numbers.as_slice() {
                mapped.push([*start, *length, rest.first().copied().unwrap_or(0)]);
            }
            continue;
        }
        let Some(Ok(at)) = line.split_whitespace().last().map(|word| u64::from_str_radix(word, 16))
        else {
            continue;
        };
        let own = mapped.iter().find(|[start, length, _]| (*start..start + length).contains(&at));
        let address = own.map(|[start, _, place]| at - start + place + offset);
        *counts.entry(address).or_default() += 1;
    }
    counts
}

/// Returns the address of the machine code minus its position in the program file (bytes).
fn offset(program: &Path) -> Result<u64, Failure> {
    let headers = output(Command::new("readelf").arg("-lW").arg(program))?;
    let number = |word: &str| u64::from_str_radix(word.trim_start_matches("0x"), 16).ok();
    let code = headers.lines().find_map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let is_code = words.first() == Some(&"LOAD") && words.contains(&"E");
        is_code.then(|| Some(number(words[2])? - number(words[1])?)).flatten()
    });
    code.ok_or_else(|| "readelf names no machine code".into())
}

/// Returns the phase of every address.
fn phases(
    program: &Path,
    addresses: impl Iterator<Item = u64>,
) -> Result<Vec<(u64, &'static str)>, Failure> {
    let mut child = Command::new("addr2line")
        .args(["-i", "-a", "-e"])
        .arg(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| format!("addr2line: {error}; it is part of the package binutils"))?;
    let words: String = addresses.map(|address| format!("{address:#x}\n")).collect();
    let mut input = child.stdin.take().ok_or("addr2line takes no input")?;
    let writer = std::thread::spawn(move || input.write_all(words.as_bytes()));
    let named = child.wait_with_output()?;
    writer.join().map_err(|_| "addr2line stopped")??;
    let mut found: Vec<(u64, &str)> = Vec::new();
    for line in String::from_utf8(named.stdout)?.lines() {
        if let Some(address) = line.strip_prefix("0x") {
            found.push((u64::from_str_radix(address, 16)?, OTHER));
        } else if let Some((_, known)) = found.last_mut() {
            // The innermost line comes first.
            match phase(line) {
                Some(own) if [OTHER, LANES].contains(known) => *known = own,
                None if line.contains(LANEWISE) => *known = LANES,
                _ => {}
            }
        }
    }
    Ok(found)
}

/// Returns the phase of a source line; `None` for arithmetic and for code outside the engine.
fn phase(line: &str) -> Option<&'static str> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?;
    let path = line.strip_prefix(root.to_str()?)?.strip_prefix("/crates/")?;
    let known = PHASES.iter().find(|(start, _)| path.starts_with(start));
    known.map_or(Some(OBSERVERS), |(_, phase)| Some(*phase).filter(|phase| !phase.is_empty()))
}

fn output(command: &mut Command) -> Result<String, Failure> {
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
