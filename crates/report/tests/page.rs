//! Pages: no text becomes markup, no page makes network requests, empty blocks are harmless.

use std::sync::Arc;

use crate::common::{HOSTILE, document, payload, player, scene};
use barrelstack_report::{
    Axis, Block, Cell, Figure, FigureKind, Frames, Language, Plot, Scene, Series, Shell, Strip,
    Table, Tone, Trial, Word, html, html_with, markdown,
};

/// Returns a page without the contents of its scripts and styles.
fn markup(page: &str) -> String {
    let mut out = String::new();
    let mut rest = page;
    while let Some(at) = [rest.find("<script"), rest.find("<style")].into_iter().flatten().min() {
        let close = if rest[at..].starts_with("<script") { "</script>" } else { "</style>" };
        out.push_str(&rest[..at]);
        let end = at + rest[at..].find(close).expect("every script and style ends");
        rest = &rest[end + close.len()..];
    }
    out + rest
}

fn hostile_page() -> String {
    let mut moving = scene(2, 30);
    moving.bodies[1].name = HOSTILE.into();
    moving.events[0].text = HOSTILE.into();
    moving.ground[0].label = HOSTILE.into();
    let mut table = Table::new(HOSTILE, &[(HOSTILE, HOSTILE)]);
    table.rows.push(vec![Cell::text(HOSTILE)]);
    let series = Series::new(HOSTILE, vec![0.0, 1.0], vec![0.0, 1.0]);
    let x = Axis::new(HOSTILE, HOSTILE);
    let plot = Plot { x, series: vec![series], interactive: true, ..Plot::default() };
    let mut doc = document(vec![
        Block::Heading { level: 2, text: HOSTILE.into() },
        Block::Paragraph(HOSTILE.into()),
        Block::List(vec![HOSTILE.into()]),
        player(moving),
        Block::Table(table),
        Block::Figure(Figure {
            id: HOSTILE.into(),
            caption: HOSTILE.into(),
            kind: FigureKind::Plot(plot),
            language: Language::English,
        }),
        Block::Details { summary: HOSTILE.into(), blocks: vec![Block::Paragraph("x".into())] },
    ]);
    doc.title = HOSTILE.into();
    doc.verdict.headline = HOSTILE.into();
    doc.verdict.sentences = vec![HOSTILE.into()];
    doc.verdict.advice = HOSTILE.into();
    doc.verdict.command = HOSTILE.into();
    doc.verdict.fine = vec![HOSTILE.into()];
    doc.warnings = vec![HOSTILE.into()];
    doc.provenance = vec![(HOSTILE.into(), HOSTILE.into())];
    html(&doc)
}

#[test]
fn a_long_headline_opens_with_its_verdict_and_continues_in_smaller_type() {
    let verdict = "Not safe. Shaken along the barrels most of all variants fall, across the barrels some of all fall.";
    let rest = "Depending on the friction of the seats, which is uncertain, hardly any or nearly all fall; the stiffness decides.";
    let shown = |headline: String| {
        let mut doc = document(Vec::new());
        doc.verdict.headline = headline;
        markup(&html(&doc))
    };
    let page = shown(format!("{verdict} {rest}"));
    assert!(page.contains(&format!("<h1>{verdict}</h1>\n</header>")), "{page}");
    assert!(page.contains(&format!("<p class=\"rest\">{rest}</p>")), "{page}");
    assert!(shown(verdict.to_owned()).contains(&format!("<h1>{verdict}</h1>")));
}

#[test]
fn advice_stands_under_the_headline_and_the_numbers_behind_it_are_folded() {
    let mut doc = document(vec![Block::Paragraph("Its drift is 2 %.".into())]);
    doc.verdict.advice = "Three levels would have stood.".into();
    doc.verdict.command = "barrelstack compare 'a b'".into();
    doc.verdict.fine = vec!["The motion reaches 0.37 g.".into()];
    doc.words = vec![
        Word { word: "drift", meaning: "how far the top moves" },
        Word { word: "uplift", meaning: "how far a body rises" },
    ];
    let page = markup(&html(&doc));
    let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("no {text} in {page}"));
    assert!(at("<h1>") < at("</header>") && at("</header>") < at("Three levels would have stood."));
    assert!(at("Three levels would have stood.") < at("class=\"lead\""));
    assert!(at("<code>barrelstack compare &#39;a b&#39;</code>") < at("<details class=\"fine\">"));
    assert!(at("<details class=\"fine\">") < at("0.37\u{a0}g"));
    // A term that does not occur in the page is not explained.
    assert!(page.contains("id=\"word-0\">how far the top moves") && !page.contains("uplift"));
    let text = markdown(&doc, "").text;
    let at = |part: &str| text.find(part).unwrap_or_else(|| panic!("no {part} in {text}"));
    assert!(at("**Three levels would have stood.**") < at("## The numbers behind the verdict"));
    assert!(at("## The numbers behind the verdict") < at("0.37"));
    assert!(at("- **drift**: how far the top moves") > at("Its drift") && !text.contains("uplift"));
}

#[test]
fn hostile_text_never_becomes_markup() {
    let page = hostile_page();
    let markup = markup(&page);
    assert!(!markup.contains("<i>c</i>"));
    assert!(!markup.contains("<!--"));
    assert!(!markup.contains("\"a\""), "a quote would end an attribute");
    assert!(markup.contains("&lt;/script&gt;"));
    assert!(!page.contains('\u{0}') && !page.contains('\u{7}'));
    // The page has three scripts (data, library, own code), whatever its texts contain.
    assert_eq!(page.matches("<script").count(), 3);
    assert_eq!(page.matches("</script").count(), 3);
}

#[test]
fn hostile_text_reads_back_from_the_data_as_it_was() {
    let data = payload(&hostile_page());
    assert_eq!(data["players"][0]["panes"][0]["bodies"][1]["name"], HOSTILE);
    assert_eq!(data["players"][0]["panes"][0]["events"][0]["text"], HOSTILE);
    assert_eq!(data["plots"][0]["series"][0]["label"], HOSTILE);
}

#[test]
fn a_page_requests_nothing_from_the_network() {
    let page = hostile_page();
    let markup = markup(&page);
    assert!(markup.split("url(").skip(1).all(|place| place.starts_with('#')));
    for word in [" src=", "@import", "<link rel=\"stylesheet\""] {
        assert!(!markup.contains(word), "{word}");
    }
    assert!(page.contains("default-src 'none'"));
    let links = markup.split("href=\"").skip(1);
    assert!(links.clone().count() > 2);
    assert!(links.clone().all(|to| to.starts_with('#') || to.starts_with("data:,")));
}

#[test]
fn every_link_of_a_page_has_a_target() {
    let section = |text: &str| Block::Heading { level: 2, text: text.into() };
    let mut doc =
        document(vec![section("Forces"), section("Forces"), section("力"), player(scene(1, 9))]);
    doc.warnings = vec!["mind the gap".into()];
    let markup = markup(&html(&doc));
    for link in markup.split("href=\"#").skip(1) {
        let id = link.split('"').next().unwrap();
        assert_eq!(markup.matches(&format!(" id=\"{id}\"")).count(), 1, "{id}");
    }
    assert!(markup.contains("href=\"#warnings\""));
}

#[test]
fn every_tone_shows_a_word_and_a_sign() {
    for (tone, word) in [
        (Tone::Stands, "Stands"),
        (Tone::Falls, "Falls"),
        (Tone::Invalid, "Not valid"),
        (Tone::Neutral, "Summary"),
    ] {
        let mut doc = document(vec![]);
        doc.verdict.tone = tone;
        let page = html(&doc);
        assert!(page.contains(&format!("<span>{word}</span>")));
        assert!(page.contains("<svg class=\"sign\""));
    }
}

#[test]
fn scenes_with_nothing_or_one_of_everything_make_a_page() {
    let empty = Scene::default();
    let no_body = Scene {
        frames: Frames { times: vec![0.0, 1.0], poses: vec![vec![], vec![]], forces: vec![] },
        ..Scene::default()
    };
    let no_pose = Scene { frames: Frames::default(), ..scene(2, 1) };
    for (scene, frames) in [(empty, 0), (no_body, 2), (no_pose, 0), (scene(2, 1), 1)] {
        let data = payload(&html(&document(vec![player(scene)])));
        assert_eq!(data["players"][0]["panes"][0]["times"]["n"], frames);
        let view = data["players"][0]["panes"][0]["view"].as_array().unwrap();
        let corner = |at: usize| view[at].as_f64().expect("a finite view");
        assert!(corner(2) > corner(0) && corner(3) > corner(1));
    }
}

#[test]
fn a_page_without_players_and_live_plots_has_no_script() {
    assert!(!html(&document(vec![Block::Paragraph("words".into())])).contains("<script"));
}

#[test]
fn a_plot_whose_x_turns_back_is_drawn_and_never_live() {
    let figure = |x: Vec<f64>| {
        let series = Series::new("loop", x, vec![0.0, 1.0, 0.0]);
        let plot = Plot { series: vec![series], interactive: true, ..Plot::default() };
        Block::Figure(Figure {
            id: "a".into(),
            caption: "A.".into(),
            kind: FigureKind::Plot(plot),
            language: Language::English,
        })
    };
    let page = html(&document(vec![figure(vec![0.0, 1.0, 0.5])]));
    assert!(!page.contains("data-plot=") && page.contains("<div class=\"drawing\"><svg"));
    assert!(html(&document(vec![figure(vec![0.0, 0.5, 1.0])])).contains("data-plot=\"0\""));
}

#[test]
fn few_events_are_shown_and_the_rest_folded() {
    let page = |count: usize| {
        let mut scene = scene(2, 30);
        let event = scene.events[0].clone();
        scene.events = vec![event; count];
        html(&document(vec![player(scene)]))
    };
    assert!(!page(5).contains("<details"));
    let many = page(9);
    assert!(many.contains("<summary>5 more events</summary>"));
    assert_eq!(many.matches("data-time=\"0.1\"").count(), 9);
}

#[test]
fn on_paper_a_player_beside_a_strip_of_the_same_scene_is_one_picture() {
    let shared = Arc::new(scene(2, 60));
    let block = player(Scene::clone(&shared));
    let Block::Player(mut alone) = block else { panic!("a player was made") };
    alone.scene = Arc::clone(&shared);
    let strip = Block::Figure(Figure {
        id: "strip".into(),
        caption: "A strip.".into(),
        kind: FigureKind::Strip(Strip::of_run(shared, 6)),
        language: Language::English,
    });
    let pictures = |page: &str| markup(page).matches("<svg class=\"bs\"").count();
    let with = html(&document(vec![Block::Player(alone.clone()), strip]));
    let without = html(&document(vec![Block::Player(alone)]));
    assert_eq!((pictures(&with), pictures(&without)), (1 + 6, 6));
    // The single picture is large enough for names.
    assert!(with.contains(">B1</text>"));
}

#[test]
fn what_stands_still_has_a_drawing_for_a_phone_with_letters_as_large() {
    let label =
        "a label that is far too long for one line on the screen of a phone, whatever it says";
    let series = Series::new(label, vec![0.0, 1.0, 0.5], vec![0.0, 1.0, 0.0]);
    let plot = Plot { series: vec![series], interactive: true, ..Plot::default() };
    let kind = FigureKind::Plot(plot);
    let page = html(&document(vec![Block::Figure(Figure {
        id: "a".into(),
        caption: "A.".into(),
        kind,
        language: Language::English,
    })]));
    let drawing = |class: &str| {
        let start = page.find(&format!("<div class=\"{class}\"><svg")).unwrap();
        let svg = &page[start..][page[start..].find("<svg").unwrap()..];
        svg[..svg.find("</svg>").unwrap() + 6].to_owned()
    };
    for (class, most) in [("drawing", 680.0), ("drawing phone", 358.0)] {
        let svg = drawing(class);
        let parsed = roxmltree::Document::parse(&svg).unwrap();
        let width: f64 = parsed.root_element().attribute("width").unwrap().parse().unwrap();
        assert!(width <= most, "{width}");
        for word in parsed.descendants().filter(|node| node.attribute("class") == Some("label")) {
            let x: f64 = word.attribute("x").unwrap().parse().unwrap();
            if word.attribute("text-anchor") == Some("start") {
                // Half the font size per letter is more than the letters take.
                let wide = 0.5 * 12.0 * word.text().unwrap().len() as f64;
                assert!(x + wide <= width, "{:?} leaves the picture", word.text());
            }
        }
    }
}

#[test]
fn a_program_that_a_page_holds_cannot_end_its_script_and_may_request_nothing() {
    let start = serde_json::json!({ "text": HOSTILE }).to_string();
    let trial = Trial { page: HOSTILE, start: &start };
    let report = html_with(&document(vec![Block::Paragraph("x".into())]), &trial);
    let held: &[(&str, &[u8])] = &[("engine", HOSTILE.as_bytes())];
    let shell = Shell {
        language: Language::English,
        title: HOSTILE,
        style: "",
        body: "<main></main>\n",
        at_hand: held,
        worker: "",
        scripts: &["// of no use there\n  let kept = 1;\n"],
        held,
    };
    let page = shell.html();
    assert!(page.contains("\nlet kept = 1;\n") && !page.contains("of no use there"));
    // Data that are loaded last follow the scripts.
    assert!(page.rfind("id=\"engine\"") > page.find("let kept"));
    for page in [report, shell.html()] {
        assert!(!page.contains(HOSTILE));
        // Every script ends where intended.
        assert!(!markup(&page).contains("</script"), "{}", markup(&page));
        let policy =
            page.split("content=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        assert!(
            policy.starts_with("default-src 'none'") && !policy.contains("connect-src"),
            "{policy}"
        );
    }
}
