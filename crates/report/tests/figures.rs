//! Figures as SVG and CSV: well formed whatever the data, with gaps where numbers are missing.

use std::sync::Arc;

use crate::common::{HOSTILE, document, player, scene};
use barrelstack_report::{
    Axis, Band, BoundarySample, Envelope, Figure, FigureKind, Mark, Panel, Plot, Polyline, Scene,
    Series, SeriesStyle, Strip, Tie, attachments,
};

fn figure(kind: FigureKind) -> Figure {
    Figure {
        id: "figure 1".into(),
        caption: HOSTILE.into(),
        kind,
        language: barrelstack_report::Language::English,
    }
}

fn parsed(svg: &str) -> roxmltree::Document<'_> {
    roxmltree::Document::parse(svg).unwrap_or_else(|error| panic!("{error}\n{svg}"))
}

fn plot(series: Vec<Series>) -> Plot {
    Plot { x: Axis::new("time", "s"), y: Axis::new("slip", "cm"), series, ..Plot::default() }
}

fn full_plot() -> Plot {
    let style = SeriesStyle { area: true, dots: true, ..SeriesStyle::default() };
    let muted = SeriesStyle { muted: true, ..SeriesStyle::default() };
    Plot {
        series: vec![
            Series { style, ..Series::new(HOSTILE, vec![0.0, 1.0, 2.0], vec![1.0, -1.0, 3.0]) },
            Series { style: muted, ..Series::new("", vec![0.0, 2.0], vec![0.5, 0.5]) },
        ],
        marks: vec![Mark { at: 1.0, label: HOSTILE.into() }],
        levels: vec![Mark { at: 0.5, label: HOSTILE.into() }],
        bands: vec![Band { from: 0.5, to: 1.5, label: HOSTILE.into() }],
        ..plot(vec![])
    }
}

fn envelope(stress: &[f64]) -> Envelope {
    let sample = |k: usize| {
        let (nz, nx) = (0.1 * k as f64).sin_cos();
        BoundarySample { x: 0.3 * nx, z: 0.3 * nz, nx, nz, coordinate: 0.1 * k as f64 }
    };
    Envelope {
        outline: vec![Polyline::circle(0.3, 24)],
        samples: (0..stress.len()).map(sample).collect(),
        closed: true,
        static_stress: stress.to_vec(),
        dynamic_stress: stress.iter().map(|s| 2.0 * s).collect(),
        unit: "kN/m".into(),
        amplification: Some(2.0),
        coordinate: ("angle".into(), "rad".into()),
    }
}

#[test]
fn every_figure_is_well_formed_xml_whatever_it_holds() {
    let nothing = Series::new("", vec![], vec![]);
    let infinite = Series::new("x", vec![f64::INFINITY, f64::NAN], vec![f64::NAN, 1.0]);
    let log = Plot {
        x: Axis::new("period", "s").log(),
        y: Axis::new("acceleration", "g").log(),
        ..plot(vec![Series::new("a", vec![0.0, 0.1, 10.0], vec![-1.0, 1e-9, 1e9])])
    };
    let kinds = vec![
        FigureKind::Plot(Plot::default()),
        FigureKind::Plot(full_plot()),
        FigureKind::Plot(plot(vec![nothing])),
        FigureKind::Plot(plot(vec![infinite])),
        FigureKind::Plot(plot(vec![Series::new("one", vec![3.0], vec![3.0])])),
        FigureKind::Plot(plot(vec![Series::new("flat", vec![0.0, 1.0], vec![1e300, 1e300])])),
        FigureKind::Plot(log),
        FigureKind::Strip(Strip { scene: Arc::new(Scene::default()), panels: vec![] }),
        FigureKind::Strip(Strip {
            scene: Arc::new(Scene::default()),
            panels: vec![Panel { time: f64::NAN, note: HOSTILE.repeat(9) }],
        }),
        FigureKind::Strip(Strip::of_run(Arc::new(scene(3, 1)), 6)),
        FigureKind::Strip(Strip::of_run(Arc::new(scene(3, 90)), 6)),
        FigureKind::Envelope(Envelope::default()),
        FigureKind::Envelope(envelope(&[1.0; 63])),
        FigureKind::Envelope(envelope(&[f64::NAN, 0.0, 1.0, f64::INFINITY, -1.0, 2.0])),
    ];
    for kind in kinds {
        let svg = figure(kind.clone()).to_svg();
        let tree = parsed(&svg);
        let root = tree.root_element();
        assert_eq!(root.tag_name().name(), "svg");
        for side in ["width", "height"] {
            let length: f64 = root.attribute(side).unwrap().parse().unwrap();
            assert!(length > 0.0 && length < 5000.0, "{length} {kind:?}");
        }
        for node in tree.descendants() {
            for attribute in node.attributes() {
                let value = attribute.value();
                assert!(!value.contains("NaN") && !value.contains("inf"), "{value} in {kind:?}");
            }
        }
        assert!(!svg.contains("var(--"), "a file on its own knows its colors");
        let png = figure(kind.clone()).to_png(40.0);
        assert!(png.starts_with(b"\x89PNG"), "{kind:?}");
        let pdf = lopdf::Document::load_mem(&figure(kind.clone()).to_pdf()).unwrap();
        assert_eq!(pdf.get_pages().len(), 1, "{kind:?}");
    }
}

#[test]
fn a_hostile_caption_is_the_title_word_for_word() {
    let svg = figure(FigureKind::Plot(full_plot())).to_svg();
    let tree = parsed(&svg);
    let title = tree.descendants().find(|n| n.has_tag_name("title")).unwrap();
    let wanted = HOSTILE.replace(['\u{0}', '\u{7}'], "\u{fffd}");
    assert_eq!(title.text().unwrap(), wanted);
}

#[test]
fn a_missing_value_divides_a_line_in_two() {
    let moves = |y: Vec<f64>| {
        let x = (0..y.len()).map(|k| k as f64).collect();
        let svg = figure(FigureKind::Plot(plot(vec![Series::new("", x, y)]))).to_svg();
        let tree = parsed(&svg);
        let path = tree.descendants().find(|n| n.attribute("class") == Some("series s0")).unwrap();
        path.attribute("d").unwrap().matches('M').count()
    };
    assert_eq!(moves(vec![0.0, 1.0, 0.0, 1.0]), 1);
    assert_eq!(moves(vec![0.0, 1.0, f64::NAN, 0.0, 1.0]), 2);
    assert_eq!(moves(vec![f64::NAN, 1.0, f64::NAN, 0.0, f64::INFINITY]), 2);
}

#[test]
fn where_a_color_comes_again_the_dashes_differ() {
    let lines = (0..12).map(|_| Series::new("", vec![0.0, 1.0], vec![0.0, 1.0])).collect();
    let svg = figure(FigureKind::Plot(plot(lines))).to_svg();
    let tree = parsed(&svg);
    let looks: Vec<_> = tree
        .descendants()
        .filter(|n| n.attribute("class").is_some_and(|class| class.starts_with("series s")))
        .map(|n| (n.attribute("class"), n.attribute("stroke-dasharray")))
        .collect();
    let different: std::collections::BTreeSet<_> = looks.iter().collect();
    assert_eq!((looks.len(), different.len()), (12, 12), "{looks:?}");
}

#[test]
fn plot_csv_reads_back_to_the_same_bits_with_gaps_empty() {
    let values = vec![0.1 + 0.2, f64::NAN, -1e-300];
    let shared = vec![0.0, 1.0, 2.0];
    let csv = figure(FigureKind::Plot(plot(vec![
        Series::new("a, \"b\"", shared.clone(), values.clone()),
        Series::new("c", shared, vec![1.0, 2.0, 3.0]),
        Series::new("short", vec![5.0], vec![6.0]),
    ])))
    .to_csv();
    let lines: Vec<&str> = csv.lines().collect();
    // Series over the same x share its column.
    assert_eq!(lines[0], "time (s),\"a, \"\"b\"\" (cm)\",c (cm),time (s),short (cm)");
    assert_eq!(lines[2], "1,,2,,");
    let cell: f64 = lines[1].split(',').nth(1).unwrap().parse().unwrap();
    assert_eq!(cell.to_bits(), values[0].to_bits());
    assert_eq!(lines[3].split(',').nth(1).unwrap().parse::<f64>().unwrap(), -1e-300);
}

#[test]
fn strips_color_their_bodies_with_rules_that_reach_into_use() {
    let svg = figure(FigureKind::Strip(Strip::of_run(Arc::new(scene(2, 60)), 4))).to_svg();
    let tree = parsed(&svg);
    let style = tree.descendants().find(|n| n.has_tag_name("style")).unwrap().text().unwrap();
    let drawn: Vec<&str> = tree
        .descendants()
        .filter(|n| n.has_tag_name("path") && n.ancestors().any(|a| a.has_tag_name("defs")))
        .filter_map(|n| n.attribute("class"))
        .collect();
    assert!(drawn.contains(&"bs-body bs-barrel"));
    for class in drawn.iter().flat_map(|class| class.split(' ')) {
        // A selector with an ancestor matches nothing inside <use>.
        assert!(
            style.lines().any(|line| line.starts_with(&format!(".{class} {{"))),
            "no rule of its own for {class}"
        );
    }
}

#[test]
fn all_panels_of_a_strip_have_one_scale_and_one_size() {
    let mut moving = scene(4, 120);
    for frame in 60..120 {
        moving.frames.poses[frame][2] = [40.0, 0.3, 1.0];
    }
    let svg = figure(FigureKind::Strip(Strip::of_run(Arc::new(moving), 6))).to_svg();
    let tree = parsed(&svg);
    let of = |name: &'static str, with: &str| -> Vec<String> {
        tree.descendants()
            .filter_map(|n| n.attribute(name))
            .filter(|value| value.starts_with(with))
            .map(|value| value.rsplit_once(' ').map_or(value, |(head, _)| head).to_owned())
            .collect()
    };
    let transforms = of("transform", "matrix(");
    assert_eq!(transforms.len(), 6);
    assert!(transforms.windows(2).all(|pair| pair[0] == pair[1]), "{transforms:?}");
    // 4 barrels are 1.8 m high: a body 40 m away does not reduce them below 90 px per meter.
    let scale: f64 = transforms[0]["matrix(".len()..].split(' ').next().unwrap().parse().unwrap();
    assert!(scale > 90.0, "{scale}"); // measured 103
}

#[test]
fn the_hatch_of_the_ground_covers_the_picture_and_not_the_county() {
    let svg = figure(FigureKind::Strip(Strip::of_run(Arc::new(scene(2, 60)), 3))).to_svg();
    let tree = parsed(&svg);
    let hatch = tree
        .descendants()
        .filter(|n| n.attribute("class") == Some("bs-body bs-ground bs-open"))
        .filter_map(|n| n.attribute("d"))
        .map(|d| d.matches('M').count())
        .max()
        .unwrap();
    assert!((10..120).contains(&hatch), "{hatch}");
}

#[test]
fn a_strip_holds_only_the_bodies_that_it_shows() {
    // A three-dimensional body has a drawing for each direction of view; most directions occur only between the panels.
    let mut scene = scene(3, 60);
    for (frame, poses) in scene.frames.poses.iter_mut().enumerate() {
        if frame != 7 {
            poses[2] = [f64::NAN; 3];
        }
    }
    let hidden = figure(FigureKind::Strip(Strip::of_run(Arc::new(scene), 2))).to_svg();
    assert!(hidden.contains("-b1\"") && !hidden.contains("-b2\""));
}

#[test]
fn a_tie_is_drawn_between_its_bodies_until_it_tears() {
    let mut tied = scene(2, 60);
    let torn_at = tied.frames.times[30];
    let points = [[0.0, 0.1], [0.0, -0.1]];
    tied.ties = vec![
        Tie { bodies: [1, 2], points, torn_at: None },
        Tie { bodies: [1, 2], points, torn_at: Some(torn_at) },
        // A body that does not exist.
        Tie { bodies: [1, 9], points, torn_at: None },
    ];
    let panels = [0.0, tied.frames.times[59]].map(|time| Panel { time, note: String::new() });
    let panels =
        |at: usize| Strip { scene: Arc::new(tied.clone()), panels: vec![panels[at].clone()] };
    let drawn = |at: usize| {
        let svg = figure(FigureKind::Strip(panels(at))).to_svg();
        parsed(&svg).descendants().filter(|n| n.attribute("class") == Some("bs-tie")).count()
    };
    assert_eq!((drawn(0), drawn(1)), (2, 1));
}

#[test]
fn a_strip_shows_first_and_last_and_what_happened() {
    let strip = Strip::of_run(Arc::new(scene(2, 600)), 4);
    let times: Vec<f64> = strip.panels.iter().map(|p| p.time).collect();
    assert_eq!(times.len(), 4);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!((times[0], times[3]), (0.0, 599.0 / 60.0));
    let short = Strip::of_run(Arc::new(scene(2, 60)), 4);
    assert!(short.panels.iter().any(|p| p.time == 0.1 && p.note == "B1: fall"));
    assert_eq!(Strip::of_run(Arc::new(scene(2, 1)), 4).panels.len(), 1);
    assert!(Strip::of_run(Arc::new(Scene::default()), 4).panels.is_empty());
}

#[test]
fn attachments_have_names_that_differ_and_are_safe() {
    let twice = figure(FigureKind::Plot(full_plot()));
    let blocks = vec![
        player(scene(1, 10)),
        barrelstack_report::Block::Figure(twice.clone()),
        barrelstack_report::Block::Figure(Figure { id: "../σ/é".into(), ..twice.clone() }),
        barrelstack_report::Block::Figure(twice),
    ];
    let names: Vec<String> = attachments(&document(blocks)).into_iter().map(|a| a.name).collect();
    let mut unique = names.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), names.len(), "{names:?}");
    for name in &names {
        let safe = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-.".contains(c);
        assert!(name.chars().all(safe) && !name.starts_with('.'), "{name}");
    }
}

/// Returns the position and alignment of a text of a drawing.
fn word(svg: &roxmltree::Document<'_>, text: &str) -> ([f64; 2], &'static str) {
    let node =
        svg.descendants().find(|node| node.text() == Some(text) && node.has_tag_name("text"));
    let node = node.unwrap_or_else(|| panic!("no word {text:?}"));
    let number = |name: &str| node.attribute(name).and_then(|text| text.parse::<f64>().ok());
    let number = |name: &str| number(name).unwrap_or_else(|| panic!("{text:?} has no {name}"));
    let anchor = match node.attribute("text-anchor") {
        Some("end") => "end",
        Some("middle") => "middle",
        _ => "start",
    };
    ([number("x"), number("y")], anchor)
}

fn named() -> Plot {
    let (x, y) = (vec![0.1, 0.4, f64::NAN, 0.2, 0.9], vec![Axis::row(0), Axis::row(0), 0.0]);
    let y = [y, vec![Axis::row(1), Axis::row(1)]].concat();
    let style = SeriesStyle { bar: true, ..SeriesStyle::default() };
    let names =
        vec!["friction".to_owned(), "interface.rack-ground.friction.coefficient".to_owned()];
    Plot {
        x: Axis::new("share", ""),
        y: Axis::named(names),
        series: vec![Series { style, ..Series::new("lowest to highest", x, y) }],
        ..Plot::default()
    }
}

#[test]
fn a_name_stands_left_of_its_bar_and_at_its_height() {
    let svg = figure(FigureKind::Plot(named())).to_svg();
    let parsed = parsed(&svg);
    let bars = parsed.descendants().find(|n| n.attribute("class") == Some("series s0 bar"));
    let data = bars.unwrap().attribute("d").unwrap();
    let starts: Vec<Vec<f64>> = data
        .split('M')
        .skip(1)
        .map(|run| {
            let start = run.split('l').next().unwrap();
            start.split(' ').map(|number| number.parse().unwrap()).collect()
        })
        .collect();
    let ([x, y], anchor) = word(&parsed, "friction");
    assert_eq!(anchor, "end");
    assert!(x < starts[0][0] && (y - 4.0 - starts[0][1]).abs() < 1.0, "{x} {y} {starts:?}");
    // A long name is broken at joining characters, and its lines are centered on its bar.
    let ([_, first], _) = word(&parsed, "interface.rack-ground.friction.");
    let ([_, last], _) = word(&parsed, "coefficient");
    assert!((0.5 * (first + last) - 4.0 - starts[1][1]).abs() < 1.0, "{first} {last} {starts:?}");
    // An axis of names has no numbers.
    assert!(
        !parsed
            .descendants()
            .any(|n| n.attribute("text-anchor") == Some("end")
                && n.attribute("class") == Some("tick"))
    );
}

#[test]
fn a_table_of_bars_names_its_rows() {
    let csv = figure(FigureKind::Plot(named())).to_csv();
    assert!(csv.contains("\n0.9,interface.rack-ground.friction.coefficient\n"), "{csv}");
}

#[test]
fn single_values_are_not_joined_and_have_bars_of_their_own() {
    let range = vec![[0.0, 0.3], [0.2, 0.8]];
    let style = SeriesStyle { points: true, ..SeriesStyle::default() };
    let raw = Series { range, style, ..Series::new("raw", vec![1.0, 2.0], vec![0.1, 0.5]) };
    let figure = figure(FigureKind::Plot(plot(vec![raw])));
    let svg = figure.to_svg();
    let parsed = parsed(&svg);
    let of =
        |class: &str| parsed.descendants().filter(|n| n.attribute("class") == Some(class)).count();
    // Two dots and one in the legend; two bars in one path and one in the legend; no line.
    assert_eq!([of("dot s0"), of("whisker s0"), of("series s0")], [3, 2, 0]);
    assert_eq!(
        figure.to_csv(),
        "time (s),raw (cm),\"raw, from (cm)\",\"raw, to (cm)\"\n1,0.1,0,0.3\n2,0.5,0.2,0.8\n"
    );
}

#[test]
fn a_band_is_filled_and_its_bounds_are_in_sight() {
    let range = vec![[0.0, 7.0], [0.2, 9.0]];
    let line = Series { range, ..Series::new("fit", vec![1.0, 2.0], vec![0.1, 0.5]) };
    let svg = figure(FigureKind::Plot(plot(vec![line]))).to_svg();
    let parsed = parsed(&svg);
    assert_eq!(parsed.descendants().filter(|n| n.attribute("class") == Some("area s0")).count(), 2);
    // The axis reaches beyond the band, which is higher than the line.
    word(&parsed, "8");
}
