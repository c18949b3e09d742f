//! Documents, figures and a player for moving rigid bodies: HTML, Markdown, PDF, SVG, PNG, GIF, CSV and VTK.
//!
//! A [`Document`] is data: a verdict, [`Block`]s in reading order, warnings, provenance. [`html`]
//! turns a document into one page that needs no network, [`markdown`] into text with separate
//! figures, and [`document_pdf`] into numbered pages. All formats contain the same numbers.
//!
//! A [`Figure`] is drawn once, as data, which is then written as SVG, pixels or PDF with one style
//! sheet. A [`Film`] is a sequence of such drawings, and an [`Animation`] is a file of a whole
//! film.
//!
//! ```
//! use barrelstack_report::{Block, Cell, Document, Table, Tone, Verdict, html};
//!
//! let mut table = Table::new("Peak values", &[("quantity", ""), ("value", "cm")]);
//! table.rows.push(vec![Cell::text("slip"), Cell::Number(2.04, 2)]);
//! let document = Document {
//!     title: "Three levels".into(),
//!     verdict: Verdict {
//!         headline: "The stack stands.".into(),
//!         sentences: vec!["It slid 2 cm.".into()],
//!         tone: Tone::Stands,
//!         ..Verdict::default()
//!     },
//!     blocks: vec![Block::Table(table)],
//!     provenance: vec![],
//!     warnings: vec![],
//!     ..Document::default()
//! };
//! assert!(html(&document).contains("<td class=\"number\">2.0</td>"));
//! ```
//!
//! # Conventions
//!
//! Scenes use meters, radians and seconds, with x to the right, z up and angles counterclockwise.
//! Plots, tables and histories take numbers in the unit that their label states. A number that is
//! not finite is a gap in a line and a dash in a table. No input causes a panic: lists of unequal length
//! are read to the end of the shorter list, and empty figures are drawn as empty axes.

mod animation;
mod depth;
mod diagram;
mod document;
mod dots;
mod drawing;
mod envelope;
mod escape;
mod figure;
mod film;
mod floor_plan;
mod font;
mod glossary;
mod html;
mod language;
mod markdown;
mod pack;
mod page;
mod pages;
mod paint;
mod panels;
mod pdf;
mod player;
mod player_data;
mod player_html;
mod plot;
mod plot_drawing;
mod raster;
mod scene;
mod sheet;
mod simplify;
mod stamp;
mod strip;
mod style;
mod svg;
mod table;
mod tags;
mod terminal;
mod ticks;
mod trial;
mod vtk;

use barrelstack_columns::{number, with_unit};

pub use animation::Animation;
pub use barrelstack_columns::{
    capital, column, csv_field, described, listed, measured, shortest, significant,
};
pub use depth::{Depth, DepthBody, DepthPoses, DepthTie, Point3, Pose3, Volume};
pub use diagram::{Arrow, Diagram};
pub use document::{Block, Document, Tone, Verdict, Word};
pub use dots::Dots;
pub use envelope::{BoundarySample, Envelope};
pub use figure::{Attachment, Figure, FigureKind, Format, attachments, figures};
pub use film::Film;
pub use floor_plan::{FloorPlan, Heat, Region, RegionKind};
pub use html::{Fragment, badge, fragment, html, html_with, player_html};
pub use language::{Language, UnknownLanguage};
pub use markdown::{MarkdownBundle, markdown};
pub use pack::{POSE_QUANTUM, TIME_QUANTUM, base64};
pub use page::Shell;
pub use pages::{Paper, document_pdf};
pub use panels::Panels;
pub use player::{Pane, Player, Players};
pub use plot::{Axis, Band, Mark, Plot, Scale, Series, SeriesStyle};
pub use scene::{
    ContactForce, Event, EventKind, Frames, Ghosts, History, Moment, Point, Polyline, Pose2, Role,
    Scene, SceneBody, Tie, Tint, Trace,
};
pub use stamp::Stamp;
pub use strip::{Panel, Strip};
pub use table::{Cell, Column, ColumnOf, Rating, Table};
pub use terminal::{Characters, sparkline, terminal_picture};
pub use ticks::{Ticks, linear_ticks, log_ticks};
pub use trial::Trial;
pub use vtk::{SolidBody, SolidTie, Solids, paraview, paraview_of_solids};

/// The example in the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
