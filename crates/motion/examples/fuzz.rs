//! Feeds damaged files to every reader and monitors time and memory.
//!
//! Run it in release mode with `cargo xtask fuzz`. Execution `k` of a reader depends only on the
//! reader's name and `k`, so it is the same on every machine.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::exit,
    reason = "an interactive program that exits when a reader fails"
)]

#[path = "../tests/fuzz/mod.rs"]
mod fuzz;
#[path = "../tests/fuzz/large.rs"]
mod large;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use barrelstack_motion::{Random, read};
use fuzz::{Reader, Sample, must_hold, mutate, options, samples, samples_of};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory limit of one execution (MB).
const MOST_MEGABYTES: f64 = 256.0;
/// Time limit of one execution (s): far below a hang, far above the delays of a busy machine.
const LONGEST: f64 = 10.0;
/// Number of damaged copies of each one-megabyte file.
const DAMAGED: u32 = 4;

const USAGE: &str = "usage: fuzz [--executions N] [--reader NAME] [--first K]";

/// Results of one reader, counted.
#[derive(Default)]
struct Statistics {
    executions: u64,
    read: u64,
    slowest: f64,
    megabytes: f64,
}

/// The current execution for the time limit: its number, and below its start (ms).
static NOW: AtomicU64 = AtomicU64::new(u64::MAX);
static SINCE: AtomicU64 = AtomicU64::new(0);

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (mut executions, mut only, mut first) = (100_000, None, 0);
    for pair in words.chunks(2) {
        let number = || pair.get(1).and_then(|word| word.replace('_', "").parse().ok());
        match (pair[0].as_str(), pair.get(1), number()) {
            ("--executions", _, Some(n)) => executions = n,
            ("--first", _, Some(n)) => first = n,
            ("--reader", Some(name), _) => only = Some(name.clone()),
            _ => {
                eprintln!("{USAGE}");
                std::process::exit(2);
            }
        }
    }
    let readers: Vec<Reader> = Reader::all()
        .into_iter()
        .filter(|reader| only.as_ref().is_none_or(|name| name == reader.name()))
        .collect();
    if readers.is_empty() {
        eprintln!("there is no reader named {}", only.unwrap_or_default());
        std::process::exit(2);
    }
    let start = Instant::now();
    watch(start);
    // A panic is reported below, together with its execution.
    std::panic::set_hook(Box::new(|_| {}));
    let samples = samples();
    println!("reader       executions       read  rate (1/s)  slowest (ms)  most memory (MB)");
    let mut faults = Vec::new();
    for reader in readers {
        let began = Instant::now();
        let mut statistics = Statistics::default();
        faults.extend(small(reader, &samples, first, executions, &mut statistics, start).err());
        report(reader.name(), &statistics, began.elapsed());
        if first == 0 {
            let began = Instant::now();
            let mut statistics = Statistics::default();
            faults.extend(large(reader, &samples, &mut statistics, start).err());
            report("  at 1 MB", &statistics, began.elapsed());
        }
    }
    if faults.is_empty() {
        println!("no panic, no hang, nothing above {LONGEST} s or {MOST_MEGABYTES} MB");
    } else {
        eprintln!("{}", faults.join("\n"));
        std::process::exit(1);
    }
}

fn report(name: &str, statistics: &Statistics, time: Duration) {
    println!(
        "{name:<11} {:>11} {:>10} {:>11.0} {:>13.2} {:>17.3}",
        statistics.executions,
        statistics.read,
        statistics.executions as f64 / time.as_secs_f64(),
        1e3 * statistics.slowest,
        statistics.megabytes
    );
}

/// Returns the seed of one execution of a reader.
fn seed(reader: Reader, k: u64) -> u64 {
    let name = reader.name().bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    name ^ k.wrapping_mul(0x9E37_79B9_7F4A_7C15)
}

fn small(
    reader: Reader,
    samples: &[Sample],
    first: u64,
    count: u64,
    statistics: &mut Statistics,
    start: Instant,
) -> Result<(), String> {
    let own = samples_of(reader, samples);
    for k in first..first + count {
        let mut random = Random::new(seed(reader, k));
        let sample = own[usize::try_from(random.bits() % own.len() as u64).unwrap()];
        let bytes = mutate(&sample.bytes, samples, &mut random);
        execute(reader, k, &bytes, &mut random, statistics, start)?;
    }
    Ok(())
}

fn large(
    reader: Reader,
    samples: &[Sample],
    statistics: &mut Statistics,
    start: Instant,
) -> Result<(), String> {
    let mut k = 0;
    for sample in samples_of(reader, samples) {
        for bytes in large::files(&sample.bytes) {
            let mut random = Random::new(seed(reader, k));
            execute(reader, k, &bytes, &mut random, statistics, start)?;
            for _ in 0..DAMAGED {
                let mut damaged = mutate(&bytes, samples, &mut random);
                damaged.truncate(large::SIZE);
                execute(reader, k, &damaged, &mut random, statistics, start)?;
            }
            k += 1;
        }
    }
    Ok(())
}

/// Executes a reader once, and sometimes the format detection on the same bytes.
///
/// A fault is returned as a sentence that identifies the input.
fn execute(
    reader: Reader,
    k: u64,
    bytes: &[u8],
    random: &mut Random,
    statistics: &mut Statistics,
    start: Instant,
) -> Result<(), String> {
    let given = options(random);
    let before = PeakAlloc.current_usage();
    PeakAlloc.reset_peak_usage();
    let began = Instant::now();
    SINCE.store(u64::try_from((began - start).as_millis()).unwrap(), Ordering::Relaxed);
    NOW.store(k, Ordering::Relaxed);
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        let taken = reader.take(bytes, &given);
        if k.is_multiple_of(8) {
            must_hold(&read(bytes, "fuzz", &given));
        }
        taken
    }));
    NOW.store(u64::MAX, Ordering::Relaxed);
    let time = began.elapsed().as_secs_f64();
    let megabytes = PeakAlloc.peak_usage().saturating_sub(before) as f64 / 1e6;
    statistics.executions += 1;
    statistics.slowest = statistics.slowest.max(time);
    statistics.megabytes = statistics.megabytes.max(megabytes);
    let fault = match outcome {
        Err(payload) => {
            let text = payload
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string));
            format!("panicked: {}", text.unwrap_or_default())
        }
        Ok(_) if megabytes > MOST_MEGABYTES => format!("took {megabytes:.0} MB"),
        Ok(_) if time > LONGEST => format!("took {time:.1} s"),
        Ok(read) => {
            statistics.read += u64::from(read);
            return Ok(());
        }
    };
    let file = std::env::temp_dir().join(format!("fuzz-{}-{k}", reader.name()));
    std::fs::write(&file, bytes).unwrap();
    Err(format!(
        "{}, execution {k}, {given:?}: {fault}; the input is in {}",
        reader.name(),
        file.display()
    ))
}

/// Terminates the program if an execution hangs.
fn watch(start: Instant) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let k = NOW.load(Ordering::Relaxed);
            let since = Duration::from_millis(SINCE.load(Ordering::Relaxed));
            if k != u64::MAX && start.elapsed().saturating_sub(since).as_secs_f64() > 6.0 * LONGEST
            {
                eprintln!("execution {k} hangs; repeat it with --first {k} --executions 1");
                std::process::exit(1);
            }
        }
    });
}
