//! The report: the numbers and figures of the paper, in the order of the paper, compared with ours,
//! and the reasons for differences.

use std::fmt::Write as _;

use barrelstack::Summary;
use barrelstack::report::scene;
use barrelstack_report::{Block, Cell, Document, Table, Tone, Verdict as Headline, significant};

use super::cases::Motion;
use super::compare::{Agreement, Comparison, percent};
use super::results::{Ran, Results};
use super::study::Subject;
use super::{ensemble, figures, neighborhood, numbering, racks, tornado};

/// Builds the whole report.
pub(super) fn document(results: &Results, rows: &[Comparison], stopped: bool) -> Document {
    Document {
        title: "Candia, de la Llera and Almazán (2008): published results compared with ours".into(),
        verdict: Headline {
            headline: headline(rows),
            sentences: vec![
                "All cases use one geometry. The paper's text gives no dimension of its racks, so the \
                 rack is a reconstruction; no parameter is fitted to a single case."
                    .into(),
                "If a number differs from the published number, the studies below show the effect of changing one \
                 quantity at a time."
                    .into(),
            ],
            tone: Tone::Neutral,
            ..Headline::default()
        },
        blocks: blocks(results, rows),
        provenance: provenance(results),
        warnings: warnings(&results.motion)
            .into_iter()
            .chain(stopped.then(|| {
                "The studies were stopped before they were completed. All cases of the paper were run, but the effects of \
                 single quantities on their numbers are not shown."
                    .to_owned()
            }))
            .collect(),
        ..Document::default()
    }
}

/// Returns a sentence that says how many published results agree, how many lie within a wider band, and how many differ.
pub(super) fn headline(rows: &[Comparison]) -> String {
    let count = |agreement| rows.iter().filter(|row| row.agreement == agreement).count();
    let compared = rows.len() - count(Agreement::NotCompared);
    let agree = count(Agreement::Agrees);
    let published = rows.iter().filter(|row| row.is_published()).count();
    let mut text = if compared < published {
        format!("{compared} of {published} published results could be compared: {agree} agree")
    } else {
        format!("{agree} of {compared} published results agree")
    };
    // Writing to a String cannot fail.
    if count(Agreement::InBand) > 0 {
        let _ = write!(text, ", {} more within a wider band", count(Agreement::InBand));
    }
    let differ = match count(Agreement::Differs) {
        1 => "1 differs".to_owned(),
        some => format!("{some} differ"),
    };
    let _ = write!(text, ", {differ}");
    text.push('.');
    text
}

fn warnings(motion: &Motion) -> Vec<String> {
    const OBTAIN: &str = "download record sequence number 995 (Northridge-01, LA - Hollywood Stor FF) \
                          from the PEER NGA-West2 database, keep the component PEL360 and reproduce the \
                          paper with it";
    match motion {
        Motion::Paper { .. } => Vec::new(),
        Motion::Other { file, pga } => vec![format!(
            "{file} is not the paper's record: its peak is {} g, and the peak of PEL360 is 0.358 \
             g. Results that \
             depend on the motion are shown but not compared. To get the paper's record, {OBTAIN}.",
            significant(pga / barrelstack_motion::STANDARD_GRAVITY, 3)
        )],
        Motion::Bundled => vec![format!(
            "The paper's record cannot be distributed with the program, and no record file was given. The six barrels \
             are shaken by the bundled record of South Napa instead; results that depend on the motion are shown but \
             not compared. To get the paper's record, {OBTAIN}."
        )],
    }
}

fn text(text: impl Into<String>) -> Block {
    Block::Paragraph(text.into())
}

fn blocks(results: &Results, rows: &[Comparison]) -> Vec<Block> {
    let mut blocks =
        vec![Block::heading(2, "Published results and our results"), Block::Table(overview(rows))];
    blocks.push(text(
        "A number agrees if it is within ±20 % of the published number; a finding agrees if the same event occurs. For \
         some numbers, a larger difference is also accepted, since the paper does not state the dimensions of its \
         racks; the column “band” gives the accepted range.",
    ));
    let reasons = vec![Block::Table(reasons(rows))];
    let summary = "How each row is measured, and why it differs";
    blocks.push(Block::details_on_screen(summary, reasons));
    blocks.push(Block::heading(2, "Body numbers"));
    blocks.push(Block::Table(numbering::table()));
    blocks.extend(figure_6(results));
    blocks.extend(figure_7(results));
    blocks.extend(along(results));
    if results.studies.is_empty() {
        blocks.push(text(
            "The studies were left out. They show the effect of changing one quantity at a time, and of changing \
             contact parameters by 10 %.",
        ));
    } else {
        blocks.push(Block::heading(2, "Contact parameters changed by 10 %"));
        blocks.extend(ensemble::blocks(&results.eight.summary, &results.ensemble));
        blocks.push(text(
            "Two mechanisms compete: the top level slides off alone, or level 3 slides off and carries the \
             top level along, as in the six barrels. Until the first fall, different bodies move in the two mechanisms, so no \
             definition of the mode covers both. Which of the two mechanisms occurs depends on the rack, \
             which the paper's text does not describe:",
        ));
        blocks.push(racks::block(&results.racks));
        blocks.push(neighborhood::block(&results.neighborhood));
        blocks.extend(studies(results));
    }
    blocks.push(Block::heading(2, "What is not compared"));
    blocks.push(Block::List(NOT_COMPARED.iter().map(|s| (*s).to_owned()).collect()));
    blocks
}

/// Results of the paper that are not compared, with the reasons.
const NOT_COMPARED: [&str; 5] = [
    "The curves and drawings of Figs. 6 and 7 point by point: only the text of the paper was available, so \
     our figures are shown without those of the paper.",
    "Figs. 1 to 4, which define the model; the program's own tests check the equations.",
    "The dimensions of Fig. 2, which the text does not state.",
    "The calibration of k, c and μ on barrels and racks, for which the paper cites its reference 5.",
    "The photographs of the shaking-table test, reference 1 of the paper.",
];

fn overview(rows: &[Comparison]) -> Table {
    Table::of(
        "All numbers and findings that the paper states.",
        rows,
        &[
            ("in the paper", "", &|row| Cell::text(row.place)),
            ("quantity", "", &|row| Cell::text(&row.quantity)),
            ("published", "", &|row| Cell::text(&row.published)),
            ("ours", "", &|row| Cell::text(&row.ours)),
            ("difference", "", &|row| Cell::maybe(row.difference.map(percent))),
            ("band", "", &|row| Cell::maybe(row.band)),
            ("verdict", "", &|row| Cell::text(row.agreement.words())),
        ],
    )
}

fn reasons(rows: &[Comparison]) -> Table {
    Table::of(
        "How each row is measured, and why it differs.",
        rows,
        &[
            ("quantity", "", &|row| Cell::text(&row.quantity)),
            ("verdict", "", &|row| Cell::text(row.agreement.words())),
            ("how and why", "", &|row| Cell::text(&row.why)),
        ],
    )
}

fn figure_6(results: &Results) -> Vec<Block> {
    let (six, slippery) = (&results.six.run, &results.slippery.run);
    let scene = scene(six);
    let under = results.motion.words();
    let mut blocks = vec![Block::heading(2, "Fig. 6: six barrels on three levels")];
    if !results.motion.is_papers() {
        blocks.push(text(stand_in(results)));
    }
    blocks.push(Block::heading(3, "(a) collapse sequence"));
    blocks.push(figures::strip(
        &scene,
        "figure-6a",
        &format!(
            "Six barrels under {under}. The friction coefficient between rack and ground is 0.4."
        ),
        figures::moments(six),
    ));
    blocks.push(figures::player(
        &scene,
        "six-barrels",
        &format!(
            "Animation of the six barrels under {under}. The friction coefficient between rack and ground is 0.4."
        ),
    ));
    blocks.push(Block::heading(3, "(b) line load on barrel 1 (normal stress in the paper)"));
    blocks.extend(figures::envelope(
        six,
        1,
        "figure-6b",
        &format!(
            "Line load on barrel 1 (B1.1) under {under}. The line load is the normal force per meter of boundary. The \
             figure shows the line load at rest, and its largest value until the first loss of a seat."
        ),
    ));
    blocks.push(Block::heading(3, "(c) horizontal displacement of barrels 1, 4 and 7"));
    for (run, id, friction) in
        [(six, "figure-6c-upper", "0.4"), (slippery, "figure-6c-lower", "0.1")]
    {
        blocks.push(figures::histories(
            run,
            id,
            &format!(
                "Horizontal displacement relative to the ground under {under}. The friction coefficient between rack \
                 and ground is {friction}."
            ),
        ));
    }
    blocks
}

/// Describes the results of the six barrels under the motion that replaces the paper's record.
fn stand_in(results: &Results) -> String {
    let slip = |summary: &Summary| {
        let slip = summary.demands.base_slip_residual.unwrap_or(f64::NAN);
        significant(100.0 * slip.abs(), 2)
    };
    let (six, slippery) = (&results.six.summary, &results.slippery.summary);
    let what = |summary: &Summary| match (summary.outcome.mode, summary.outcome.time) {
        (Some(mode), Some(time)) => {
            format!("{mode} after {} s", significant(time, 3))
        }
        _ => summary.outcome.kind.to_owned(),
    };
    format!(
        "This is not the paper's motion, so the results cannot be compared with the paper's numbers. The six \
         barrels were run under {}. With a friction coefficient of 0.4 between rack and ground, the outcome is “{}” \
         and the residual slip is {} cm. With a friction coefficient of 0.1 between rack and ground, the outcome is \
         “{}” and the residual slip is {} cm.",
        results.motion.name(),
        what(six),
        slip(six),
        what(slippery),
        slip(slippery)
    )
}

/// Converts the times (s) of panels at full scale to the equivalent times at half scale, which are smaller by a factor
/// of √2.
fn equivalent(panels: &[(f64, String)]) -> Vec<(f64, String)> {
    let root = 2.0_f64.sqrt();
    panels.iter().map(|(time, note)| (time / root, note.clone())).collect()
}

fn figure_7(results: &Results) -> Vec<Block> {
    let (full, half) = (&results.eight.run, &results.half.run);
    let (full_scene, half_scene) = (scene(full), scene(half));
    let moments = figures::moments(full);
    let mut blocks = vec![
        Block::heading(2, "Fig. 7: eight barrels on four levels"),
        figures::player(
            &full_scene,
            "eight-barrels",
            "Animation of the eight barrels at full scale.",
        ),
        Block::heading(3, "(a) contact bodies, target bodies, and the collapse"),
        figures::contact_bodies(
            full,
            "figure-7a-pairs",
            "The transverse section with the paper's body numbers. Each arrow points from a contact body, which \
             carries the nodes, to its target body, whose surface the nodes touch.",
        ),
        figures::strip(
            &full_scene,
            "figure-7a-sequence",
            "The main events of the collapse, in the transverse section.",
            figures::events(full),
        ),
        figures::pairs(
            full,
            "Bodies that touch by design, with the paper's numbers and our names.",
        ),
    ];
    if figures::racks_carry_the_nodes(full) {
        blocks.push(text(
            "All nodes belong to racks, as the paper states for the longitudinal case, where every contact \
             body touches target bodies above and below it. The model also has the pairs that meet only in a \
             collapse, such as barrel on barrel.",
        ));
    }
    blocks.push(Block::heading(3, "(b) half scale at t* against full scale at √2 t*"));
    blocks.push(figures::strip(
        &half_scene,
        "figure-7b-half",
        "Half scale, sine with an amplitude of 2 in and a period of 0.76 s, at the instants t*.",
        equivalent(&moments),
    ));
    blocks.push(figures::strip(
        &full_scene,
        "figure-7b-full",
        "Full scale, sine with an amplitude of 4 in and a period of 0.76 √2 s, at the instants √2 t*.",
        moments,
    ));
    blocks.push(Block::heading(3, "(c) line load on bodies 2 and 3 (normal stress in the paper)"));
    for (number, what) in [(2, "barrel B1.2 (body 2)"), (3, "rack R1 (body 3)")] {
        blocks.extend(figures::envelope(
            full,
            number,
            &format!("figure-7c-body-{number}"),
            &format!(
                "Line load on {what}. The line load is the normal force per meter of boundary. The figure shows the \
                 line load at rest, and its largest value until the first loss of a seat."
            ),
        ));
    }
    blocks
}

fn along(results: &Results) -> Vec<Block> {
    let run = &results.along.run;
    let scene = scene(run);
    vec![
        Block::heading(2, "Along the barrels: rack sliding"),
        text("The paper describes this case but does not show it in a figure."),
        figures::strip(
            &scene,
            "along",
            "Four levels along the barrels under the sine with an amplitude of 4 in: the rack of level 2 (body 4, R2) \
             walks off the barrel below.",
            figures::moments(run),
        ),
        figures::player(&scene, "along-the-barrels", "Animation of the same run."),
        figures::contact_bodies(
            run,
            "along-pairs",
            "The section along the barrels with the paper's body numbers; every contact body, which carries the nodes, \
             touches target bodies above and below it.",
        ),
        figures::pairs(run, "Contact and target bodies along the barrels."),
    ]
}

fn studies(results: &Results) -> Vec<Block> {
    let mut blocks = vec![
        Block::heading(2, "Effects of single quantities"),
        text(
            "The paper gives neither the dimensions of its racks nor the number of its contact elements, and it does \
             not state how its sine begins. Here, these quantities and the parameters that the paper states are \
             changed one at a time.",
        ),
    ];
    for study in &results.studies {
        let (title, id, published) = match study.subject {
            Subject::Six => ("Six barrels, μ 0.4", "study-six", [Some(10.0), None, Some(2.9)]),
            Subject::Eight => ("Eight barrels", "study-eight", [Some(1.5), Some(0.052), Some(3.0)]),
            Subject::Along => ("Along the barrels", "study-along", [Some(4.5), None, None]),
        };
        blocks.push(Block::heading(3, title));
        blocks.extend(tornado::blocks(study, id, published));
    }
    if !results.motion.is_papers() {
        blocks.push(text("The study of the six barrels needs the paper's record."));
    }
    blocks
}

fn provenance(results: &Results) -> Vec<(String, String)> {
    let mut pairs = Vec::new();
    let mut pair = |name: &str, value: String| pairs.push((name.to_owned(), value));
    let eight = &results.eight.summary;
    pair("program", format!("barrelstack {}", eight.provenance.version));
    for (name, Ran { summary, .. }) in [
        ("six barrels, μ 0.4", &results.six),
        ("six barrels, μ 0.1", &results.slippery),
        ("eight barrels", &results.eight),
        ("eight barrels at half scale", &results.half),
        ("along the barrels", &results.along),
    ] {
        let balance = summary.energy.as_ref();
        let residual = balance.map(|balance| format!("{:.0e}", balance.residual_ratio));
        let text = format!(
            "{}, step {} ms, constants per {}, energy residual {}",
            summary.run.method,
            significant(1e3 * summary.run.time_step, 3),
            summary.run.stiffness_basis,
            residual.as_deref().unwrap_or("lost")
        );
        pair(name, text);
    }
    for (index, step) in results.six.summary.provenance.motion.iter().enumerate() {
        pair(&format!("motion of the six barrels, step {}", index + 1), step.clone());
    }
    pairs
}
