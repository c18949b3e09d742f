//! Checks frame by frame that bodies do not overlap while stacks collapse.

use std::path::{Path, PathBuf};

use crate::problem::{absolute, setting};
use crate::{Effort, Failure, Outcome, Problem};
use barrelstack::overlap::Boundaries;
use barrelstack::scenario::{RackKind, Scenario, catalog};

/// Creates the problem of the deepest overlap of two bodies neither of which rests on the other in the initial stack.
/// Stacks of all kinds are strongly shaken, and all frames until the bodies come to rest are checked.
pub(super) fn problem() -> Problem {
    setting(
        "solids/overlap-of-falling-stacks",
        "stacks of two to six levels, both planes, all racks, shaken until they fall, all frames",
        "bodies are solid",
    )
    .quantity("deepest overlap, except at seats", "m", absolute(0.0, 0.015))
    .by(|effort| {
        let (count, records) =
            if effort == Effort::Full { (300, records()) } else { (8, Vec::new()) };
        let mut worst = Survey::default();
        let (mut fallen, mut unstable) = (0, 0);
        for case in 0..count {
            let scenario = random_stack(case, &records)?;
            let run = match scenario.run() {
                Ok(run) => run,
                // A stack whose rails are too steep for the staves does not come to rest; it is counted as unstable.
                Err(barrelstack::RunFailure::Settle(_)) => {
                    unstable += 1;
                    continue;
                }
                Err(failure) => return Err(failure.into()),
            };
            fallen += usize::from(run.fates.collapse_time().is_some());
            worst.look(&run);
        }
        if fallen * 3 < count {
            return Err(Failure::Absent(format!("only {fallen} of {count} stacks fell")));
        }
        let note = format!(
            "{fallen} of {count} stacks fell; {unstable} did not stand at rest; {} records besides \
             the bundled one; overlap at seats {:.1} mm; at the end {:.1} mm, and {:.1} mm at \
             seats; largest residual of the energy balance {:.1e}",
            records.len(),
            1e3 * worst.seat,
            1e3 * worst.end,
            1e3 * worst.seat_end,
            worst.balance
        );
        Ok(Outcome::of(worst.loose).noted(note))
    })
}

/// Deepest overlaps (m) and largest residual of the energy balance in all runs so far.
#[derive(Default)]
struct Survey {
    /// Deepest overlap of two bodies neither of which rests on the other in the initial stack.
    loose: f64,
    /// Deepest overlap of two bodies one of which rests on the other in the initial stack.
    seat: f64,
    /// The same as `loose`, but only in the last frame.
    end: f64,
    /// The same as `seat`, but only in the last frame.
    seat_end: f64,
    /// Largest residual of the energy balance, as a fraction of the energy that passed through the system.
    balance: f64,
}

impl Survey {
    fn look(&mut self, run: &barrelstack::Run) {
        let boundaries = Boundaries::new(&run.assembly);
        let parts = &run.assembly.parts;
        let joined = |a: usize, b: usize| {
            parts[b].carrier == Some(a)
                || parts[a].carrier == Some(b)
                || parts[a].supports.contains(&b)
                || parts[b].supports.contains(&a)
                || (a == 0 && parts[b].supports.is_empty() && parts[b].carrier.is_none())
        };
        let frames = &run.recording.frames;
        for (index, poses) in frames.all_poses().enumerate() {
            for overlap in boundaries.overlaps(&poses) {
                let seat = joined(overlap.bodies[0], overlap.bodies[1]);
                let last = index + 1 == frames.times.len();
                let most = if seat { &mut self.seat } else { &mut self.loose };
                *most = most.max(overlap.depth);
                if last {
                    let most = if seat { &mut self.seat_end } else { &mut self.end };
                    *most = most.max(overlap.depth);
                }
            }
        }
        if let Some(energy) = &run.energy {
            self.balance = self.balance.max(energy.residual_ratio());
        }
    }
}

/// Returns the paths of additional records of horizontal motion. These must not be distributed with the program, so
/// only the files that exist in a folder next to the working copy are returned.
fn records() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions/peer");
    [
        "RSN995_NORTHR_PEL360",
        "RSN995_NORTHR_PEL090",
        "RSN1063_NORTHR_RRS228",
        "RSN1503_CHICHI_TCU065-E",
    ]
    .into_iter()
    .chain(["RSN6_IMPVALL.I_I-ELC180"])
    .map(|name| folder.join(format!("{name}.AT2")))
    .filter(|path| path.is_file())
    .collect()
}

/// Returns a random stack, which is determined by the number of the case and by the records.
fn random_stack(case: usize, records: &[PathBuf]) -> Result<Scenario, Failure> {
    // Each choice is one step of the generator SplitMix64.
    let pick = |salt: usize, count: usize| {
        let mut z = ((case * 64 + salt) as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 33) as usize % count
    };
    let view = ["transverse", "longitudinal"][pick(1, 2)];
    let racks = catalog::RACKS.iter();
    let racks: Vec<_> =
        racks.filter(|r| view == "transverse" || r.rack.kind == RackKind::OnBarrels).collect();
    let rack = racks[pick(2, racks.len())].rack.base;
    let columns = match (view, rack) {
        ("transverse", _) | (_, "four-barrel") => 2,
        _ => 1,
    };
    let motion = match records.get(pick(8, records.len() + 1)) {
        Some(record) => format!("record = '{}'", record.display()),
        None => format!(
            "bundled = \"napa-college-2014\"\ncomponent = \"horizontal-{}\"\nvertical = \"UP\"",
            1 + pick(6, 2)
        ),
    };
    let text = format!(
        "schema = 1\ntitle = \"case {case}\"\n[stack]\nview = \"{view}\"\nlevels = {}\ncolumns = {columns}\n\
         rack = \"{rack}\"\n[interface.rack-ground.friction]\ncoefficient = {}\n\
         [interface.barrel-rack.friction]\ncoefficient = {}\n\
         [motion]\n{motion}\nscale = {{ pgv = \"{} cm/s\" }}\n[record]\nframe_rate = \"50 Hz\"\n",
        2 + pick(3, 5),
        [0.4, 0.5, 0.65][pick(4, 3)],
        [0.2, 0.3, 0.45][pick(5, 3)],
        [80, 120, 160][pick(7, 3)],
    );
    Ok(Scenario::parse("random stack", &text, &[])?)
}
