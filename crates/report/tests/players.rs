//! Several scenes in step: data in the page, static pictures, Markdown.

use std::sync::Arc;

use crate::common::{HOSTILE, document, payload, scene};
use barrelstack_report::{
    Block, Event, EventKind, Ghosts, History, Moment, Pane, Players, Scene, Tone, attachments,
    html, markdown,
};

fn players(scenes: Vec<Scene>) -> Players {
    let panes = scenes.into_iter().enumerate().map(|(at, scene)| Pane {
        mark: ["A", "B", "C"][at].into(),
        name: format!("run {}", at + 1),
        verdict: format!("Verdict {}.", at + 1),
        tone: if at == 0 { Tone::Falls } else { Tone::Stands },
        scene: Arc::new(scene),
        traces: vec![],
    });
    let history = History {
        label: "ground".into(),
        unit: "g".into(),
        times: vec![0.0, 1.0],
        values: vec![0.0, 0.3],
    };
    Players {
        id: "both".into(),
        caption: "Two runs.".into(),
        panes: panes.collect(),
        ground: vec![history],
        overlay: None,
    }
}

fn low_and_high() -> Players {
    let mut high = scene(8, 60);
    high.events.push(Event {
        time: 0.05,
        body: Some(2),
        kind: EventKind::LossOfSeat,
        text: "B2 leaves".into(),
    });
    players(vec![scene(2, 30), high])
}

#[test]
fn all_panes_share_one_scale_one_foot_and_one_strip() {
    let data = payload(&html(&document(vec![Block::Players(low_and_high())])));
    let player = &data["players"][0];
    assert_eq!(data["players"].as_array().unwrap().len(), 1);
    assert_eq!(player["ground"].as_array().unwrap().len(), 1);
    let views: Vec<Vec<f64>> = player["panes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|pane| pane["view"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect())
        .collect();
    assert_eq!(views.len(), 2);
    for axis in 0..2 {
        let sizes: Vec<f64> = views.iter().map(|view| view[axis + 2] - view[axis]).collect();
        assert!((sizes[0] - sizes[1]).abs() < 1e-12, "{sizes:?}");
    }
    assert_eq!(views[0][1].to_bits(), views[1][1].to_bits());
    let frames = |at: usize| player["panes"][at]["times"]["n"].as_u64().unwrap();
    assert_eq!((frames(0), frames(1)), (30, 60));
}

#[test]
fn every_pane_has_its_verdict_with_a_sign_and_events_say_whose_they_are() {
    let page = html(&document(vec![Block::Players(low_and_high())]));
    assert!(page.contains("<div class=\"pane-head falls\"><svg class=\"sign\""));
    assert!(page.contains("<div class=\"pane-head stands\"><svg class=\"sign\""));
    for words in ["Verdict 1.", "Verdict 2.", "run 1", "run 2"] {
        // Once above the stage and once in print.
        assert_eq!(page.matches(words).count(), 2, "{words}");
    }
    let event = page.find("B2 leaves</span>").unwrap();
    assert!(page[..event].ends_with("<b class=\"mark\">B</b> "));
    // In order of time, across panes.
    assert!(event < page.find("B1 falls</span>").unwrap());
}

#[test]
fn sentences_behind_the_verdict_of_a_pane_follow_the_player() {
    let mut both = low_and_high();
    both.panes[0].verdict = "Falls. 15 of 16 variants fall (72–99 %). Depending on the friction of the seats, which is uncertain, 19 to 100 % fall; none of these decides alone.".into();
    let page = html(&document(vec![Block::Players(both)])).replace('\u{a0}', " ");
    assert_eq!(page.matches("<span>Falls. 15 of 16 variants fall (72–99 %).</span>").count(), 2);
    let rest = page.find("<b class=\"mark\">A</b> Depending on").unwrap();
    assert!(rest > page.find("</figure>").unwrap());
}

#[test]
fn on_paper_the_panes_stand_at_the_same_times() {
    let figures = low_and_high().paper_figures();
    assert_eq!(figures.len(), 2);
    let times = |at: usize| -> Vec<String> {
        let csv = figures[at].to_csv();
        let mut times: Vec<String> =
            csv.lines().skip(1).map(|row| row.split(',').next().unwrap().to_owned()).collect();
        times.dedup();
        times
    };
    // The second run is twice as long; the first holds its last frame.
    let (first, second) = (times(0), times(1));
    assert_eq!(first[..2], second[..2]);
    assert!(second.len() == 4 && first.len() <= 4, "{first:?} {second:?}");
}

#[test]
fn markdown_shows_every_pane_and_all_events() {
    let document = document(vec![Block::Players(low_and_high())]);
    let bundle = markdown(&document, "figures");
    for words in ["both-1.svg", "both-2.svg", "A: run 1. Verdict 1.", "B: B2 leaves", "Two runs."] {
        assert!(bundle.text.contains(words), "{words} is missing from:\n{}", bundle.text);
    }
    let names: Vec<String> = attachments(&document).into_iter().map(|file| file.name).collect();
    assert_eq!(names, ["both-1.svg", "both-1.csv", "both-2.svg", "both-2.csv"]);
}

#[test]
fn a_player_opens_on_the_first_that_falls_and_starts_before_the_ground_is_strong() {
    let moment = |time: f64, falls: bool| Moment { time, body: 0, text: "here".into(), falls };
    let mut both = low_and_high();
    let with = |at: &mut Pane, moment: Option<Moment>| {
        at.scene = Arc::new(Scene { moment, ..(*at.scene).clone() });
    };
    let opens = |both: &Players| {
        payload(&html(&document(vec![Block::Players(both.clone())])))["players"][0].clone()
    };
    assert!(opens(&both)["opens"].is_null());
    with(&mut both.panes[0], Some(moment(0.1, false)));
    assert_eq!(opens(&both)["opens"], 0);
    with(&mut both.panes[1], Some(moment(0.3, true)));
    assert_eq!(opens(&both)["opens"], 1, "what sways earlier is not what falls");
    with(&mut both.panes[0], Some(moment(f64::NAN, true)));
    let data = opens(&both);
    assert!(data["panes"][0]["moment"].is_null());
    // The ground reaches a tenth of its peak at 5 s.
    both.ground[0].times = vec![0.0, 4.9, 5.0, 8.0];
    both.ground[0].values = vec![0.0, 0.02, -0.03, 0.3];
    assert_eq!(opens(&both)["begins"], 4.0);
    both.ground[0].values = vec![0.0; 4];
    assert!(opens(&both)["begins"].is_null());
}

#[test]
fn ghosts_come_back_from_the_page_within_a_centimeter() {
    let mut both = low_and_high();
    let straight: Vec<[f64; 2]> = (0..100).map(|k| [0.01 * f64::from(k), 1.0]).collect();
    let ghosts = Ghosts {
        label: "all".into(),
        count: 2,
        paths: vec![straight, vec![[0.0, 0.0], [0.3, 0.7], [0.9, 0.1]]],
        ends: vec![(1, [0.5, 0.25, 1.0]), (9, [0.0; 3])],
    };
    both.panes[0].scene =
        Arc::new(Scene { ghosts: Some(ghosts), ..(*both.panes[0].scene).clone() });
    let data = payload(&html(&document(vec![Block::Players(both)])));
    let ghosts = &data["players"][0]["panes"][0]["ghosts"];
    // The straight path keeps its two ends, the other its corner; each is followed by a gap.
    assert_eq!(ghosts["paths"]["n"], 7, "{ghosts}");
    assert_eq!(ghosts["bodies"], serde_json::json!([1]), "a body that is not there has no end");
    assert!(data["players"][0]["panes"][1]["ghosts"].is_null());
}

#[test]
fn no_pane_or_hostile_names_break_nothing() {
    let none = Players { panes: vec![], ..low_and_high() };
    let data = payload(&html(&document(vec![Block::Players(none)])));
    assert_eq!(data["players"][0]["panes"].as_array().unwrap().len(), 0);
    let mut hostile = low_and_high();
    for pane in &mut hostile.panes {
        (pane.mark, pane.name, pane.verdict) = (HOSTILE.into(), HOSTILE.into(), HOSTILE.into());
    }
    let page = html(&document(vec![Block::Players(hostile)]));
    assert!(!page.contains("<i>c</i>"));
    assert_eq!(page.matches("</script").count(), 2);
}
