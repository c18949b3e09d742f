//! Tables, Markdown and tick labels: every number once, every text harmless.

use crate::common::{HOSTILE, document, player, scene};
use barrelstack_report::{
    Block, Cell, Figure, FigureKind, Plot, Table, html, linear_ticks, log_ticks, markdown,
};

fn table() -> Table {
    let mut table = Table::new("Peak | values", &[("quantity", ""), ("a|b", "cm"), ("note", "")]);
    table.rows = vec![
        vec![Cell::text("slip | walk\nnext"), Cell::Number(2.0449, 3), Cell::Missing],
        vec![Cell::text("樽"), Cell::Number(f64::NAN, 3), Cell::text("x"), Cell::text("surplus")],
        vec![Cell::text("short")],
    ];
    table
}

/// Returns the cells of a line of a Markdown table; an escaped bar does not divide.
fn cells(line: &str) -> Vec<String> {
    line.trim_start_matches("| ")
        .trim_end_matches(" |")
        .replace("\\|", "\u{1}")
        .split(" | ")
        .map(|cell| cell.replace('\u{1}', "\\|"))
        .collect()
}

#[test]
fn a_markdown_table_has_as_many_cells_in_every_row() {
    let text = markdown(&document(vec![Block::Table(table())]), "").text;
    let rows: Vec<&str> = text.lines().filter(|l| l.starts_with("| ")).take(5).collect();
    assert_eq!(cells(rows[0]), ["quantity", "a\\|b (cm)", "note"]);
    assert_eq!(cells(rows[1]), [":---", "---:", ":---"]);
    assert_eq!(cells(rows[2]), ["slip \\| walk next", "2.04", "–"]);
    assert_eq!(cells(rows[3]), ["樽", "–", "x"]);
    assert_eq!(cells(rows[4]), ["short", "–", "–"]);
}

#[test]
fn a_table_says_the_same_in_html_markdown_and_csv() {
    let doc = document(vec![Block::Table(table())]);
    let page = html(&doc);
    // On a narrow screen the row is a card, in which the value has this name.
    assert!(page.contains("<table class=\"cards\">"));
    assert!(page.contains("<td class=\"number\" data-name=\"a|b (cm)\">2.04</td>"));
    assert!(
        page.contains("<th scope=\"col\" class=\"number\">a|b <span class=\"unit\">(cm)</span>")
    );
    assert!(markdown(&doc, "").text.contains("| 2.04 |"));
    let csv = table().to_csv();
    assert!(csv.starts_with("quantity,a|b (cm),note\n"));
    assert!(csv.contains("\"slip | walk\nnext\",2.0449,\n"));
    assert!(!csv.contains("surplus"));
}

#[test]
fn markdown_names_only_files_that_go_with_it() {
    let figure = |id: &str| {
        Block::Figure(Figure {
            id: id.into(),
            caption: HOSTILE.into(),
            kind: FigureKind::Plot(Plot::default()),
            language: barrelstack_report::Language::English,
        })
    };
    let doc = document(vec![
        player(scene(2, 30)),
        figure("a"),
        Block::Details { summary: "more".into(), blocks: vec![figure("a"), figure("b c")] },
    ]);
    let bundle = markdown(&doc, "my figures (1)/");
    let names: Vec<&str> = bundle.files.iter().map(|f| f.name.as_str()).collect();
    let folder = "(my%20figures%20%281%29/";
    let linked: Vec<&str> =
        bundle.text.split(folder).skip(1).map(|rest| rest.split(')').next().unwrap()).collect();
    assert_eq!(linked.len(), 8);
    assert!(linked.iter().all(|name| names.contains(name)), "{linked:?} {names:?}");
}

#[test]
fn hostile_text_in_markdown_opens_nothing() {
    let mut doc = document(vec![
        Block::Heading { level: 2, text: HOSTILE.into() },
        Block::Paragraph(HOSTILE.into()),
        Block::List(vec![HOSTILE.into(), "- nested".into()]),
    ]);
    doc.title = HOSTILE.into();
    doc.provenance = vec![(HOSTILE.into(), HOSTILE.into())];
    let text = markdown(&doc, "").text;
    let bare = text.replace("\\<", "").replace("\\>", "").replace("\\`", "").replace("\\*", "");
    assert!(!bare.contains('<') && !bare.contains('`'));
    assert!(text.contains("- \\- nested"));
    let row = text.lines().rfind(|l| l.starts_with("| ") && !l.ends_with("| |")).unwrap();
    assert_eq!(cells(row).len(), 2);
}

#[test]
fn linear_ticks_lie_inside_at_even_steps_of_one_two_or_five() {
    let ranges =
        [(0.0, 1.0), (-3.7, 12.9), (1e-9, 3e-9), (-5e7, 8e7), (99.99, 100.01), (-1e-3, 0.0)];
    for (low, high) in ranges {
        for target in 1..12 {
            let ticks = linear_ticks(low, high, target);
            assert_eq!(ticks.values.len(), ticks.labels.len());
            assert!(ticks.values.len() <= target + 1, "{low} {high} {target}");
            let slack = 1e-9 * (high - low);
            assert!(ticks.values.iter().all(|v| *v >= low - slack && *v <= high + slack));
            let Some(pair) = ticks.values.get(..2) else { continue };
            let step = pair[1] - pair[0];
            let lead = step / 10_f64.powf(step.log10().floor());
            assert!(
                [1.0, 2.0, 5.0, 10.0].iter().any(|f| (lead - f).abs() < 1e-6),
                "step {step} for {low}..{high}"
            );
            for next in ticks.values.windows(2) {
                assert!((next[1] - next[0] - step).abs() < 1e-9 * step.max(high.abs()));
            }
            // Labels are distinct.
            let mut labels = ticks.labels.clone();
            labels.dedup();
            assert_eq!(labels.len(), ticks.labels.len(), "{:?}", ticks.labels);
        }
    }
}

#[test]
fn ranges_without_an_inside_have_no_ticks() {
    for (low, high) in
        [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (1.0, 1.0 + 1e-15)]
    {
        assert!(linear_ticks(low, high, 5).values.is_empty(), "{low} {high}");
    }
    for (low, high) in [(0.0, 1.0), (-1.0, 1.0), (2.0, 1.0), (1.0, f64::INFINITY)] {
        assert!(log_ticks(low, high).values.is_empty(), "{low} {high}");
    }
}

#[test]
fn logarithmic_ticks_climb_and_label_every_power_of_ten() {
    for (low, high) in [(0.01, 10.0), (1e-12, 1e12), (0.3, 0.9), (2e5, 7e7)] {
        let ticks = log_ticks(low, high);
        assert!(ticks.values.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(!ticks.values.is_empty() && ticks.values.len() < 40, "{low} {high}");
        assert!(ticks.labels.iter().any(|label| !label.is_empty()));
    }
    assert_eq!(log_ticks(0.01, 10.0).labels.first().map(String::as_str), Some("0.01"));
    assert!(log_ticks(1e4, 1e8).labels.contains(&"10⁶".to_owned()));
}
