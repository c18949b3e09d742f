//! Players: animated scenes with controls, either a single scene or several synchronized scenes.

use std::sync::Arc;

use crate::{Block, Figure, FigureKind, History, Panel, Scene, Strip, Tone, Trace, figure::walk};

/// An animated scene with controls.
#[derive(Clone, Debug, PartialEq)]
pub struct Player {
    /// Short name, from which names of anchors and files are derived.
    pub id: String,
    /// Caption: what the scene shows and how to read it.
    pub caption: String,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Points whose paths are drawn.
    pub traces: Vec<Trace>,
}

impl Player {
    /// Returns the printed picture of the player in a document with these blocks: a strip of six
    /// frames or, if the document already contains a strip of this scene, the first frame with the
    /// names of the bodies.
    pub fn paper_figure(&self, blocks: &[Block]) -> Figure {
        let scene = Arc::clone(&self.scene);
        let strip =
            if shows_strip(blocks, &scene) { Strip::still(scene) } else { Strip::of_run(scene, 6) };
        Figure::new(&self.id, &self.caption, strip)
    }
}

/// Several synchronized scenes side by side, at one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Players {
    /// Short name, from which names of anchors and files are derived.
    pub id: String,
    /// Caption: what the scenes show and how to read them.
    pub caption: String,
    /// The scenes, in reading order.
    pub panes: Vec<Pane>,
    /// Histories shown in the strip below the pictures, in place of the histories of the scenes.
    pub ground: Vec<History>,
    /// Label of a switch that draws the bodies of the first scene over all other scenes; `None` if
    /// there is no such switch.
    pub overlay: Option<String>,
}

/// One of the scenes of [`Players`], with its heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Pane {
    /// A short mark, such as a letter, by which lists refer to the pane.
    pub mark: String,
    /// Name of the pane, short enough for a heading that is a third of the page wide.
    pub name: String,
    /// Verdict of the pane, in one or more sentences.
    pub verdict: String,
    /// Tone of the verdict.
    pub tone: Tone,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Points whose paths are drawn.
    pub traces: Vec<Trace>,
}

/// Number of printed pictures per scene.
const ON_PAPER: usize = 4;

impl Players {
    /// Returns the printed pictures of the scenes: one strip per scene, all at the same times.
    pub fn paper_figures(&self) -> Vec<Figure> {
        let times = self.paper_times();
        self.panes
            .iter()
            .enumerate()
            .map(|(at, pane)| {
                let panels = times.iter().map(|&time| Panel { time, note: String::new() });
                let strip = Strip { scene: Arc::clone(&pane.scene), panels: panels.collect() };
                let caption = format!("{}: {}. {}", pane.mark, pane.name, pane.verdict);
                Figure::new(format!("{}-{}", self.id, at + 1), caption, strip)
            })
            .collect()
    }

    /// Returns the times (s) of the printed pictures, which are the same for all scenes. [`Strip::of_run`] selects
    /// these times for the scene with the most events.
    fn paper_times(&self) -> Vec<f64> {
        let richest = self.panes.iter().rev().max_by_key(|pane| pane.scene.events.len());
        let strip = richest.map(|pane| Strip::of_run(Arc::clone(&pane.scene), ON_PAPER));
        strip.map(|strip| strip.panels.iter().map(|panel| panel.time).collect()).unwrap_or_default()
    }
}

fn shows_strip(blocks: &[Block], scene: &Arc<Scene>) -> bool {
    let mut shown = false;
    walk(blocks, &mut |block| {
        if let Block::Figure(Figure { kind: FigureKind::Strip(strip), .. }) = block {
            shown |= Arc::ptr_eq(&strip.scene, scene);
        }
    });
    shown
}
