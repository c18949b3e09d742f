//! Report of a three-dimensional run: verdict, synchronized views, collapse sequence, and tables.

use std::sync::Arc;

use barrelstack::outcome::Outcome;
use barrelstack::report::{
    RANGES, WORDS, balanced, command, demand_table, device_table, inputs, interface_table, legend,
    not_modeled, record_fingerprints, trust, unknowns,
};
use barrelstack::variants::words::{self, ShownOutcome, dots_of};
use barrelstack::variants::{Range, Remedy};
use barrelstack::verify::Verification;
use barrelstack_report::{
    Block, Cell, Document, Figure, Pane, Player, Players, Scene, Strip, Table, Verdict, capital,
};

use crate::drawing::{Sight, ground_histories, scene, traces};
use crate::fate::Heading;
use crate::run::Run;
use crate::summary::Summary;
use crate::variants::Answer;
use crate::words::{headline, rows, sentences, tone};

/// Returns the player of a run, with a view that the reader can rotate. `scene` is the drawing of the run in the view
/// across the barrels; it also contains the three-dimensional scene.
pub fn player(run: &Run, scene: Scene) -> Player {
    Player {
        id: "player".into(),
        caption: format!(
            "The computed motion of the run, to scale, in a view that can be turned. Arrows show contact \
             forces, each drawn on the body that the force pushes up.{}",
            legend(&scene)
        ),
        scene: Arc::new(Scene { ground: ground_histories(run), ..scene }),
        traces: Vec::new(),
    }
}

/// Returns the report on a result as a document that does not depend on the output format.
pub fn document(answer: &Answer) -> Document {
    let Answer { run, summary, .. } = answer;
    let scenes = Sight::ALL.map(|sight| (sight, scene(run, sight)));
    let pane = |(sight, scene): &(Sight, _)| Pane {
        mark: match sight {
            Sight::Across => "X",
            Sight::Along => "Y",
            Sight::Above => "Z",
        }
        .to_owned(),
        name: capital(sight.words(&run.stack)),
        verdict: String::new(),
        tone: tone(run, summary),
        scene: Arc::clone(scene),
        traces: traces(run, scene),
    };
    let mut blocks = vec![Block::Players(Players {
        id: "players".into(),
        caption: format!(
            "One run, in a view that can be turned, or in three flat views that show the same instant at the same \
             scale. In the flat views, bodies are drawn in the order of their depth at rest. Arrows show contact \
             forces, each drawn on the body that the force pushes up.{}",
            legend(&scenes[0].1)
        ),
        panes: scenes.iter().map(pane).collect(),
        overlay: None,
        ground: ground_histories(run),
    })];
    let heading = |text: &str| Block::heading(2, text);
    blocks.extend(of_variants(summary));
    let free = run.stack.is_free();
    blocks.push(heading(if free { "Sequence" } else { "Collapse sequence" }));
    // All views show the same moments; each view lists only the events that it shows.
    let views: Vec<&Scene> = scenes.iter().map(|(_, scene)| &**scene).collect();
    for (sight, scene) in &scenes {
        blocks.push(Block::Figure(Figure::new(
            format!("sequence-{}", sight.words(&run.stack).replace(' ', "-")),
            format!(
                "The {} viewed {}, at the decisive moments.",
                if free { "scene" } else { "stack" },
                sight.words(&run.stack)
            ),
            Strip::of_views(Arc::clone(scene), &views, 6),
        )));
    }
    if let Some(found) = &summary.verification {
        blocks.push(heading("How far to trust this run"));
        blocks.extend(trust(found));
    }
    blocks.extend([heading("In numbers"), numbers(run, summary)]);
    // The numbers of a failed run look like results but are invalid.
    if !matches!(run.outcome, Outcome::Invalid { .. }) {
        blocks.push(heading("Outcome of every body"));
        blocks.push(Block::Table(if free { ends(summary) } else { fates(run) }));
        if !free {
            blocks.extend([
                heading("Demands"),
                Block::Table(demand_table(&summary.demands, &summary.demands_whole_run)),
            ]);
            let table = interface_table(
                "Force on the upper body of each pair in the run that is shown, or on the body named first if neither \
                 body rests on the other. Two forces are given: the one of largest magnitude until the first loss of \
                 a seat, and the one of largest magnitude over the whole run, falls included. Each horizontal force is the resultant of its two horizontal components.",
                &summary.interfaces,
            );
            blocks.extend([heading("Forces at the seats"), Block::Table(table)]);
        }
        for device in &summary.devices.0 {
            let table = device_table(device);
            if !table.is_empty() {
                blocks.push(heading(&capital(device.words.many)));
                blocks.extend(table);
            }
        }
    }
    blocks.extend([heading("For the engineer"), for_engineers(answer)]);
    Document {
        title: summary.title.clone(),
        verdict: Verdict {
            headline: headline(run, summary),
            dots: summary.ensemble.iter().map(|spread| dots_of(None, spread)).collect(),
            advice: summary.remedy.as_ref().map(Remedy::sentence).unwrap_or_default(),
            command: command(summary.remedy.as_ref()),
            sentences: sentences(run, summary)
                .into_iter()
                .chain(summary.verification.iter().flat_map(Verification::sentences))
                .collect(),
            shown: shown_run(summary),
            fine: Vec::new(),
            tone: tone(run, summary),
        },
        blocks,
        provenance: provenance(run, summary),
        words: WORDS.to_vec(),
        warnings: run.warnings.clone(),
        ..Document::default()
    }
}

/// States which run is shown, what its outcome is, and how many variants collapse. Empty if there are no variants.
fn shown_run(summary: &Summary) -> String {
    let kind = summary.outcome.common.kind;
    let outcome = summary.ensemble.iter().map(|spread| ShownOutcome { view: None, kind, spread });
    words::shown_run(summary.variant, &outcome.collect::<Vec<_>>())
}

/// Returns the table of the results of the run.
fn numbers(run: &Run, summary: &Summary) -> Block {
    let caption = if run.stack.is_free() {
        "Results of the run that is shown."
    } else {
        "Results of the run that is shown. Demands are the largest values until the first loss of a seat or, if no \
         seat is lost, over the whole run."
    };
    let mut numbers = Table::new(caption, &[("", ""), ("", "")]);
    let row = |(a, b)| vec![Cell::text(a), Cell::text(b)];
    numbers.rows.extend(rows(run, summary).into_iter().map(row));
    Block::Table(numbers)
}

/// Returns a section for engineers with the energy balance, the inputs, and what is not modeled. The section is
/// collapsed by default.
fn for_engineers(answer: &Answer) -> Block {
    let mut blocks = Vec::new();
    if let Some(balance) = &answer.summary.energy {
        let energy = Block::Paragraph(balanced(balance));
        blocks.extend([Block::heading(3, "Energy balance"), energy]);
    }
    blocks.push(Block::heading(3, "Inputs"));
    blocks.extend(inputs(&answer.scenario));
    if !answer.run.stack.is_free() {
        blocks.extend([Block::heading(3, "What is not modeled"), not_modeled(true)]);
    }
    Block::details("Energies, inputs and limits", blocks)
}

/// Returns the report sections about the variants: their statistics, the constants that decide the outcome, and the
/// changes that would have kept the stack up.
fn of_variants(summary: &Summary) -> Vec<Block> {
    let heading = |text: &str| Block::heading(2, text);
    let mut blocks = Vec::new();
    if let Some(table) = variants(summary) {
        blocks.extend([heading("Results of all variants"), Block::Table(table)]);
    }
    let decides = summary.ensemble.as_ref().map(|spread| unknowns(&[("", spread)]));
    if let Some(decides) = decides.filter(|blocks| !blocks.is_empty()) {
        blocks.push(heading("What decides the outcome"));
        blocks.extend(decides);
    }
    if let Some(found) = &summary.remedy {
        blocks.push(heading("What would have kept the stack up"));
        blocks.extend(found.blocks(summary.ensemble.as_ref().and_then(|all| all.share), false));
    }
    blocks
}

/// Returns a table with the statistics of all variants; `None` without variants.
fn variants(summary: &Summary) -> Option<Table> {
    let (spread, directions) = (summary.ensemble.as_ref()?, summary.directions.as_ref()?);
    let mut table = Table::new(
        format!(
            "{RANGES} The first body is the body that loses its seat first; its direction is the direction in which \
             it leaves the seat. The direction of a barrel that fell{} is the direction from its position at rest to \
             its position at the end of the run.",
            spread.counted("the first loss of a seat")
        ),
        &[("", ""), ("in three dimensions", "")],
    );
    let mut row = |name: &str, value: String| {
        table.rows.push(vec![Cell::text(name), Cell::text(value)]);
    };
    row("variants with a verdict", spread.variants.to_string());
    row("variants that collapse", spread.collapsed.to_string());
    if let Some(share) = spread.share {
        let percent = words::percent;
        let [low, high] = spread.interval.map(percent);
        row(
            "share of variants that collapse, with its 95 % interval",
            format!("{} ({low} to {high})", percent(share)),
        );
    }
    if let Some([low, high]) = spread.range.map(|range| range.map(words::percent)) {
        row("range of this share over the uncertain constants", format!("{low} to {high}"));
    }
    let range = |Range { p05, p95, .. }: Range, decimals: usize| {
        format!("{p05:.decimals$} to {p95:.decimals$}")
    };
    if let Some(loss) = spread.first_loss {
        row("first loss of a seat", format!("{} s", range(loss, 1)));
    }
    if let Some(fall) = spread.first_fall {
        let counted = spread.counted("the first loss of a seat");
        let only = if counted.is_empty() {
            String::new()
        } else {
            format!("; only falls{counted} are counted")
        };
        row("first fall", format!("{} s{only}", range(fall, 1)));
    }
    if let Some(fallen) = spread.barrels_fallen {
        row(
            "barrels fallen in a collapse",
            format!(
                "{} of {} barrels fall{}",
                range(fallen, 0),
                spread.barrels,
                spread.counted("the first loss of a seat")
            ),
        );
    }
    let modes: Vec<String> = spread.modes.iter().map(|(mode, n)| format!("{mode} {n}")).collect();
    if !modes.is_empty() {
        row("by mode", modes.join(", "));
    }
    let d = directions;
    if spread.collapsed > 0 {
        let four = |[right, left, away, near]: [u32; 4]| {
            format!(
                "across {} ({right} right, {left} left), along {} ({away} to the far side, {near} to the near side)",
                right + left,
                away + near
            )
        };
        row(
            "direction of the first body",
            four([d.first_right, d.first_left, d.first_away, d.first_near]),
        );
        row(
            "directions of the fallen barrels",
            four([d.debris_right, d.debris_left, d.debris_away, d.debris_near]),
        );
    }
    if spread.cannot_stand > 0 {
        row(
            "fallen under their own weight, before they are shaken",
            spread.cannot_stand.to_string(),
        );
    }
    if spread.broken > 0 {
        row("variants without a verdict", spread.broken.to_string());
    }
    Some(table)
}

fn fates(run: &Run) -> Table {
    let time = |at: Option<f64>| Cell::measured(at, 2);
    let length = |value: f64| Cell::Measured(100.0 * value, 1);
    Table::of(
        "Slips are displacements of a body relative to its supports, before the first loss of a seat or, if no seat is \
         lost, during the whole run. All other displacements are those at the end of the run.",
        run.stack.parts.iter().zip(&run.fates).skip(1),
        &[
            ("body", "", &|(part, _)| Cell::verbatim(&part.name)),
            ("leaves its seat", "s", &|(_, fate)| time(fate.left_seat.map(|(at, ..)| at))),
            ("toward", "", &|(_, fate)| {
                Cell::maybe(fate.left_seat.map(|(.., heading): (_, _, Heading)| heading.name()))
            }),
            ("falls", "s", &|(_, fate)| time(fate.fell_at)),
            ("moved across", "cm", &|(_, fate)| length(fate.moved.x)),
            ("along", "cm", &|(_, fate)| length(fate.moved.y)),
            ("up", "cm", &|(_, fate)| length(fate.moved.z)),
            ("largest slip", "cm", &|(_, fate)| length(fate.until_loss.slip)),
            ("across", "cm", &|(_, fate)| length(fate.peak_slip[0])),
            ("along", "cm", &|(_, fate)| length(fate.peak_slip[1])),
        ],
    )
}

/// Returns a table with the displacements and speeds of the bodies of a free scene at the end of the run, and their
/// largest displacements.
fn ends(summary: &Summary) -> Table {
    let measured = |value: f64| Cell::Measured(value, 4);
    let length = |[x, y, z]: [f64; 3]| measured((x * x + y * y + z * z).sqrt());
    Table::of(
        "Displacements are relative to the ground, measured from the initial position.",
        &summary.bodies,
        &[
            ("body", "", &|body| Cell::verbatim(&body.name)),
            ("moved along x", "m", &|body| measured(body.moved[0])),
            ("y", "m", &|body| measured(body.moved[1])),
            ("z", "m", &|body| measured(body.moved[2])),
            ("largest horizontal displacement", "m", &|body| measured(body.peak_displacement)),
            ("largest rise", "m", &|body| measured(body.peak_uplift)),
            ("speed at the end", "m/s", &|body| length(body.velocity)),
            ("spin at the end", "rad/s", &|body| length(body.spin)),
        ],
    )
}

pub(crate) fn provenance(run: &Run, summary: &Summary) -> Vec<(String, String)> {
    let made = &summary.provenance;
    let mut rows = vec![
        ("program".to_owned(), format!("{} {}", made.program, made.version)),
        ("scenario fingerprint".to_owned(), made.scenario_hash.clone()),
        ("view".to_owned(), "spatial".to_owned()),
        (
            "method".to_owned(),
            format!("{}, steps of {:.3} ms", summary.run.method, 1e3 * run.stack.step),
        ),
    ];
    rows.extend(record_fingerprints(&run.scenario.motion));
    rows.extend(made.motion.iter().map(|step| ("motion".to_owned(), step.clone())));
    rows
}
