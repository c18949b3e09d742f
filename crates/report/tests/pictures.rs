//! Pixels, PDF and films reproduce the drawing, as checked by decoders.

use std::sync::Arc;

use crate::common::{HOSTILE, document, player, scene};
use barrelstack_report::{
    Animation, Block, Cell, Document, Figure, FigureKind, Film, Pane, Paper, Players, Strip, Table,
    Tone, document_pdf, html, markdown,
};

fn strip() -> Figure {
    Figure {
        id: "strip".into(),
        caption: "Two barrels.".into(),
        kind: FigureKind::Strip(Strip::of_run(Arc::new(scene(2, 60)), 1)),
        language: barrelstack_report::Language::English,
    }
}

/// Returns red, green and blue of a PNG, row by row.
struct Pixels {
    width: usize,
    height: usize,
    rgb: Vec<[u8; 3]>,
    per_meter: u32,
}

fn decoded(file: &[u8]) -> Pixels {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(frame.color_type, png::ColorType::Rgb);
    let rgb = bytes[..frame.buffer_size()].as_chunks().0.to_vec();
    Pixels {
        width: frame.width as usize,
        height: frame.height as usize,
        rgb,
        per_meter: reader.info().pixel_dims.map_or(0, |dims| dims.xppu),
    }
}

#[test]
fn a_png_has_the_size_and_the_colors_of_the_drawing() {
    let svg = strip().to_svg();
    let tree = roxmltree::Document::parse(&svg).unwrap();
    let side = |name: &str| tree.root_element().attribute(name).unwrap().parse::<f64>().unwrap();
    for dpi in [96.0, 300.0] {
        let pixels = decoded(&strip().to_png(dpi));
        let wanted = [side("width"), side("height")].map(|side| (side * dpi / 96.0).ceil());
        assert_eq!([pixels.width as f64, pixels.height as f64], wanted);
        assert_eq!(f64::from(pixels.per_meter), (dpi / 0.0254).floor());
        assert_eq!(pixels.rgb[0], [255; 3]);
        let share = |color: [u8; 3]| {
            pixels.rgb.iter().filter(|pixel| **pixel == color).count() as f64
                / pixels.rgb.len() as f64
        };
        // Wood: two discs. Edges and marks take a smaller share at higher resolution.
        let wood = share([0xdc, 0xb6, 0x7f]);
        assert!((0.40..0.46).contains(&wood), "{wood}"); // measured 0.431 at 96 dpi, 0.436 at 300
    }
}

#[test]
fn pictures_are_the_same_bytes_twice() {
    let animated = || {
        let animation = Animation::of(&Film::of_run(Arc::new(scene(2, 30)), 20.0), 120).unwrap();
        (animation.gif(), animation.apng())
    };
    assert_eq!(strip().to_png(96.0), strip().to_png(96.0));
    assert_eq!(strip().to_pdf(), strip().to_pdf());
    assert_eq!(animated(), animated());
}

fn on_paper(document: &Document, paper: Paper) -> lopdf::Document {
    lopdf::Document::load_mem(&document_pdf(document, paper)).unwrap()
}

/// Returns the text of a PDF, with single spaces.
fn words(pdf: &lopdf::Document) -> String {
    let pages: Vec<u32> = pdf.get_pages().keys().copied().collect();
    let text = pdf.extract_text(&pages).unwrap();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn figures_and_tables_have_the_same_numbers_in_every_format() {
    let table = |caption: &str| {
        let mut table = Table::new(caption, &[("quantity", "")]);
        table.rows.push(vec![Cell::text("slip")]);
        Block::Table(table)
    };
    let figure = |caption: &str| Block::Figure(Figure { caption: caption.into(), ..strip() });
    let pane = |mark: &str| Pane {
        mark: mark.into(),
        name: format!("run {mark}"),
        verdict: "It falls.".into(),
        tone: Tone::Falls,
        scene: Arc::new(scene(2, 60)),
        traces: Vec::new(),
    };
    let players = Players {
        id: "players".into(),
        caption: "Two runs.".into(),
        panes: vec![pane("A"), pane("B")],
        ground: Vec::new(),
        overlay: None,
    };
    let folded = Block::details("Folded", vec![table("Inner."), figure("Folded strip.")]);
    let document =
        document(vec![Block::Players(players), folded, table("Outer."), figure("Open strip.")]);
    let wanted =
        ["Table 1. Inner.", "Table 2. Outer.", "Figure 2. Folded strip.", "Figure 3. Open strip."];
    let panes = ["Figure 1a. A: run A.", "Figure 1b. B: run B."];
    let plain = |text: &str| text.replace("**", "").replace("<b>", "").replace("</b>", "");
    let page = plain(&html(&document));
    let text = plain(&markdown(&document, "").text);
    let paper = words(&on_paper(&document, Paper::A4));
    for wanted in wanted {
        for (format, text) in [("page", &page), ("Markdown", &text), ("paper", &paper)] {
            assert!(text.contains(wanted), "{wanted} is missing from the {format}:\n{text}");
        }
    }
    assert!(page.contains("Figure 1. Two runs.") && text.contains("Figure 1. Two runs."));
    assert!(panes.iter().all(|pane| text.contains(pane) && paper.contains(pane)), "{paper}");
}

#[test]
fn words_on_paper_are_words() {
    let mut table = Table::new("Peak values", &[("quantity", ""), ("value", "cm")]);
    for row in 0..80 {
        table.rows.push(vec![Cell::text(format!("slip {row}")), Cell::Number(2.04, 3)]);
    }
    let document = Document {
        warnings: vec!["Heed μ ≤ 0.3 and 3×10⁻⁴ m²: Almazán’s “test”.".into()],
        ..document(vec![
            Block::Heading { level: 2, text: "Collapse sequence".into() },
            Block::Figure(strip()),
            Block::Table(table),
            player(scene(2, 60)),
        ])
    };
    let pdf = on_paper(&document, Paper::A4);
    let text = words(&pdf);
    let pages = pdf.get_pages().len();
    for wanted in [
        "Three levels",
        "The stack stands.",
        "Heed μ ≤ 0.3 and 3×10⁻⁴ m²: Almazán’s “test”.",
        "Collapse sequence",
        "Figure 1. Two barrels.",
        "Table 1. Peak values",
        "slip 79",
        &format!("{pages} of {pages}"),
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    assert!(pages >= 3, "{pages}");
    // The head of a table is repeated on the next page.
    assert!(text.matches("value (cm)").count() >= 2, "{text}");
    assert_eq!(text.matches("2.04").count(), 80);
}

#[test]
fn paper_has_its_size_and_fonts_that_are_in_the_file() {
    for (paper, size) in [(Paper::A4, [595.28, 841.89]), (Paper::Letter, [612.0, 792.0])] {
        let pdf = on_paper(&document(vec![Block::Paragraph("Words.".into())]), paper);
        for page in pdf.get_pages().values() {
            let dictionary = pdf.get_dictionary(*page).unwrap();
            let media = dictionary.get(b"MediaBox").unwrap().as_array().unwrap();
            for (side, wanted) in media[2..].iter().zip(size) {
                assert!((f64::from(side.as_float().unwrap()) - wanted).abs() < 0.01);
            }
        }
        let embedded = pdf
            .objects
            .values()
            .filter(|object| object.as_dict().is_ok_and(|dictionary| dictionary.has(b"FontFile2")));
        assert_eq!(embedded.count(), 2, "plain words and strong ones");
    }
}

#[test]
fn a_document_of_hostile_words_is_still_a_pdf() {
    let mut table = Table::new(HOSTILE, &[(HOSTILE, HOSTILE), ("", "")]);
    table.rows =
        vec![vec![Cell::text(HOSTILE.repeat(50))], vec![], vec![Cell::Number(f64::NAN, 9)]];
    let folded = vec![Block::List(vec![HOSTILE.repeat(400)]), Block::Table(Table::new("", &[]))];
    let mut hostile = document(vec![
        Block::Heading { level: 9, text: HOSTILE.into() },
        Block::Table(table),
        Block::Details { summary: HOSTILE.repeat(20), blocks: folded },
        player(scene(0, 0)),
    ]);
    hostile.title = HOSTILE.repeat(10);
    hostile.provenance = vec![(HOSTILE.repeat(9), HOSTILE.repeat(99))];
    assert!(on_paper(&hostile, Paper::Letter).get_pages().len() > 2);
}

/// Returns every picture of a GIF, composed, with its delay (hundredths of a second).
fn gif_pictures(file: &[u8]) -> Vec<(Vec<[u8; 3]>, u32)> {
    let mut reader = gif::DecodeOptions::new().read_info(file).unwrap();
    let (width, height) = (usize::from(reader.width()), usize::from(reader.height()));
    let palette: Vec<[u8; 3]> = reader.global_palette().unwrap().as_chunks().0.to_vec();
    let mut canvas = vec![[0; 3]; width * height];
    let mut shown = Vec::new();
    while let Some(frame) = reader.read_next_frame().unwrap() {
        for (at, index) in frame.buffer.iter().enumerate() {
            let wide = usize::from(frame.width);
            let (x, y) = (usize::from(frame.left) + at % wide, usize::from(frame.top) + at / wide);
            if frame.transparent != Some(*index) {
                canvas[y * width + x] = palette[usize::from(*index)];
            }
        }
        shown.push((canvas.clone(), u32::from(frame.delay)));
    }
    shown
}

/// Returns every picture of an animated PNG, composed, with its delay.
fn apng_pictures(file: &[u8]) -> Vec<(Vec<[u8; 3]>, u32)> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let info = reader.info();
    let (width, height) = (info.width as usize, info.height as usize);
    let palette: Vec<[u8; 3]> = info.palette.as_ref().unwrap().as_chunks().0.to_vec();
    let count = info.animation_control.unwrap().num_frames;
    let mut canvas = vec![[0; 3]; width * height];
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let mut shown = Vec::new();
    for _ in 0..count {
        let frame = reader.next_frame(&mut bytes).unwrap();
        let control = *reader.info().frame_control().unwrap();
        assert_eq!(frame.color_type, png::ColorType::Indexed);
        for (at, index) in bytes[..frame.buffer_size()].iter().enumerate() {
            let wide = frame.width as usize;
            let x = control.x_offset as usize + at % wide;
            let y = control.y_offset as usize + at / wide;
            if *index != 0 {
                canvas[y * width + x] = palette[usize::from(*index)];
            }
        }
        assert_eq!(control.delay_den, 100);
        shown.push((canvas.clone(), u32::from(control.delay_num)));
    }
    shown
}

#[test]
fn an_animation_shows_the_pictures_of_the_film() {
    let film = Film::of_run(Arc::new(scene(4, 90)), 15.0);
    let animation = Animation::of(&film, 300).unwrap();
    let shown = gif_pictures(&animation.gif());
    assert_eq!(shown, apng_pictures(&animation.apng()));
    // Everything moves in every frame: no picture is merged with the one before.
    assert_eq!(shown.len(), film.len());
    let whole = decoded(&film.png(0, 96.0).unwrap());
    let dpi = 96.0 * 300.0 / whole.width.max(whole.height) as f64;
    for (at, (picture, _)) in shown.iter().enumerate() {
        let painted = decoded(&film.png(at, dpi).unwrap());
        assert_eq!(painted.rgb.len(), picture.len());
        let off = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap();
        let differences: Vec<u8> = painted.rgb.iter().zip(picture).map(off).collect();
        let mean = differences.iter().map(|d| f64::from(*d)).sum::<f64>() / picture.len() as f64;
        assert!(mean < 0.5, "{mean}"); // measured 0.26
        assert!(differences.iter().all(|d| *d < 40)); // measured 22
    }
    let total: u32 = shown.iter().map(|(_, delay)| delay).sum();
    let span = film.time(film.len() - 1).unwrap();
    assert!((f64::from(total) / 100.0 - span - 1.5).abs() < 0.006, "{total}");
}

#[test]
fn ten_seconds_of_a_moving_stack_fit_a_mail() {
    // A tenth of them here, with everything moving.
    let film = Film::of_run(Arc::new(scene(8, 61)), 25.0);
    assert_eq!(film.len(), 26);
    let animation = Animation::of(&film, 480).unwrap();
    let sizes = [animation.gif(), animation.apng()].map(|file| file.len());
    // Measured 185 and 181 kB.
    assert!(sizes.iter().all(|size| *size < 300_000), "{sizes:?}");
}

/// A structure element of a PDF: its role, its text alternative, and the pages with its content.
struct Element {
    role: String,
    words: Option<String>,
    pages: Vec<lopdf::ObjectId>,
}

/// Returns the elements in reading order.
fn elements(pdf: &lopdf::Document) -> Vec<Element> {
    fn walk(pdf: &lopdf::Document, id: lopdf::ObjectId, found: &mut Vec<Element>) {
        let element = pdf.get_dictionary(id).unwrap();
        let role = element.get(b"S").unwrap().as_name().unwrap();
        let words = element.get(b"Alt").ok().map(|alt| lopdf::decode_text_string(alt).unwrap());
        let role = String::from_utf8(role.to_vec()).unwrap();
        found.push(Element { role, words, pages: Vec::new() });
        let place = found.len() - 1;
        for kid in element.get(b"K").unwrap().as_array().unwrap() {
            if let lopdf::Object::Reference(id) = kid {
                walk(pdf, *id, found);
            } else {
                let painted = kid.as_dict().unwrap();
                assert!(painted.has(b"MCID"));
                found[place].pages.push(painted.get(b"Pg").unwrap().as_reference().unwrap());
            }
        }
    }
    let catalog = pdf.catalog().unwrap();
    let root = catalog.get(b"StructTreeRoot").unwrap().as_reference().unwrap();
    let root = pdf.get_dictionary(root).unwrap();
    let mut found = Vec::new();
    walk(pdf, root.get(b"K").unwrap().as_reference().unwrap(), &mut found);
    found
}

#[test]
fn paper_is_tagged_from_the_headline_to_the_last_cell() {
    let mut table = Table::new("Peak values", &[("quantity", ""), ("value", "cm")]);
    table.rows = vec![vec![Cell::text("slip"), Cell::Number(2.04, 3)]; 70];
    let folded = Block::Details { summary: "All inputs".into(), blocks: vec![Block::Table(table)] };
    let list = Block::List(vec!["one".into(), "two".into()]);
    let pdf = on_paper(&document(vec![player(scene(2, 60)), folded, list]), Paper::A4);
    let found = elements(&pdf);
    let count = |role: &str| found.iter().filter(|element| element.role == role).count();
    assert_eq!(["TH", "LI", "H1"].map(count), [2, 2, 1]);
    // Two cells of each row, and those of provenance and events.
    assert!(count("TD") >= 142, "{}", count("TD"));
    let figure = found.iter().find(|element| element.role == "Figure").unwrap();
    assert!(figure.words.as_ref().is_some_and(|words| !words.is_empty()));
    // The picture is on the first page, the folded table after everything else.
    assert_eq!(Some(&figure.pages[0]), pdf.get_pages().get(&1));
    let first_head = found.iter().position(|element| element.role == "TH").unwrap();
    let last_list = found.iter().rposition(|element| element.role == "L").unwrap();
    assert!(first_head > last_list, "{first_head} {last_list}");
    let text = words(&pdf);
    let at = |words: &str| text.find(words).unwrap_or_else(|| panic!("{words}: {text}"));
    assert!(
        at("All inputs: see the appendix.") < at("Appendix") && at("Appendix") < at("Peak values")
    );
}

#[test]
fn everything_painted_is_an_element_or_decorates() {
    let mut table = Table::new("Peak values", &[("quantity", ""), ("value", "cm")]);
    table.rows = vec![vec![Cell::text("slip"), Cell::Number(2.04, 3)]; 90];
    let pdf = on_paper(&document(vec![player(scene(2, 60)), Block::Table(table)]), Paper::A4);
    for (number, page) in pdf.get_pages() {
        let content = pdf.get_and_decode_page_content(page).unwrap();
        let mut open = 0;
        for operation in &content.operations {
            match operation.operator.as_str() {
                "BDC" | "BMC" => {
                    assert_eq!(open, 0, "page {number}");
                    open += 1;
                }
                "EMC" => open -= 1,
                "f" | "S" | "Tj" => assert_eq!(open, 1, "page {number} paints what has no tag"),
                _ => {}
            }
        }
        assert_eq!(open, 0, "page {number}");
    }
}
