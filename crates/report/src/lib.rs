//! Documents, figures and a player for moving rigid bodies: HTML, Markdown, PDF, SVG, PNG, GIF, CSV and VTK.
//!
//! A [`Document`] is data: a verdict, [`Block`]s in reading order, warnings, provenance. [`html`]
//! turns a document into one page that needs no network, [`markdown`] into text with separate
//! figures, and [`document_pdf`] into numbered pages. Every format reads the same numbers.
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
//! Without the default feature `documents` the crate contains only [`column!`], [`described!`] and the texts of numbers.
//!
//! # Conventions
//!
//! Scenes use meters, radians and seconds, with x to the right, z up and angles counterclockwise.
//! Plots, tables and histories take numbers in the unit that their label states. A number that is
//! not finite is a gap in a line and a dash in a table. No input panics: lists of unequal length
//! are read to the end of the shorter list, and empty figures are drawn as empty axes.

#[cfg(feature = "documents")]
mod animation;
pub mod column;
#[cfg(feature = "documents")]
mod depth;
pub mod described;
#[cfg(feature = "documents")]
mod diagram;
#[cfg(feature = "documents")]
mod document;
#[cfg(feature = "documents")]
mod dots;
#[cfg(feature = "documents")]
mod drawing;
#[cfg(feature = "documents")]
mod envelope;
#[cfg_attr(not(feature = "documents"), allow(dead_code, reason = "documents use it"))]
mod escape;
#[cfg(feature = "documents")]
mod figure;
#[cfg(feature = "documents")]
mod film;
#[cfg(feature = "documents")]
mod font;
#[cfg(feature = "documents")]
mod glossary;
#[cfg(feature = "documents")]
mod html;
#[cfg(feature = "documents")]
mod markdown;
#[cfg_attr(not(feature = "documents"), allow(dead_code, reason = "documents use it"))]
mod number;
#[cfg(feature = "documents")]
mod pack;
#[cfg(feature = "documents")]
mod page;
#[cfg(feature = "documents")]
mod pages;
#[cfg(feature = "documents")]
mod paint;
#[cfg(feature = "documents")]
mod panels;
#[cfg(feature = "documents")]
mod pdf;
#[cfg(feature = "documents")]
mod player;
#[cfg(feature = "documents")]
mod player_data;
#[cfg(feature = "documents")]
mod player_html;
#[cfg(feature = "documents")]
mod plot;
#[cfg(feature = "documents")]
mod plot_drawing;
#[cfg(feature = "documents")]
mod raster;
#[cfg(feature = "documents")]
mod scene;
#[cfg(feature = "documents")]
mod sheet;
#[cfg(feature = "documents")]
mod simplify;
#[cfg(feature = "documents")]
mod strip;
#[cfg(feature = "documents")]
mod style;
#[cfg(feature = "documents")]
mod svg;
#[cfg(feature = "documents")]
mod table;
#[cfg(feature = "documents")]
mod tags;
#[cfg(feature = "documents")]
mod terminal;
#[cfg(feature = "documents")]
mod ticks;
#[cfg(feature = "documents")]
mod trial;
#[cfg(feature = "documents")]
mod vtk;

#[cfg(feature = "documents")]
pub use animation::Animation;
#[cfg(feature = "documents")]
pub use depth::{Depth, DepthBody, DepthPoses, DepthTie, Point3, Pose3, Volume};
#[cfg(feature = "documents")]
pub use diagram::{Arrow, Diagram};
#[cfg(feature = "documents")]
pub use document::{Block, Document, Tone, Verdict, Word};
#[cfg(feature = "documents")]
pub use dots::Dots;
#[cfg(feature = "documents")]
pub use envelope::{BoundarySample, Envelope};
pub use escape::{capital, csv as csv_field, listed};
#[cfg(feature = "documents")]
pub use figure::{Attachment, Figure, FigureKind, Format, attachments, figures};
#[cfg(feature = "documents")]
pub use film::Film;
#[cfg(feature = "documents")]
pub use html::{Fragment, badge, fragment, html, html_with, player_html};
#[cfg(feature = "documents")]
pub use markdown::{MarkdownBundle, markdown};
pub use number::{measured, shortest, significant};
#[cfg(feature = "documents")]
pub use pack::{POSE_QUANTUM, TIME_QUANTUM, base64};
#[cfg(feature = "documents")]
pub use page::Shell;
#[cfg(feature = "documents")]
pub use pages::{Paper, document_pdf};
#[cfg(feature = "documents")]
pub use panels::Panels;
#[cfg(feature = "documents")]
pub use player::{Pane, Player, Players};
#[cfg(feature = "documents")]
pub use plot::{Axis, Band, Mark, Plot, Scale, Series, SeriesStyle};
#[cfg(feature = "documents")]
pub use scene::{
    ContactForce, Event, EventKind, Frames, Ghosts, History, Moment, Point, Polyline, Pose2, Role,
    Scene, SceneBody, Tie, Tint, Trace,
};
#[cfg(feature = "documents")]
pub use strip::{Panel, Strip};
#[cfg(feature = "documents")]
pub use table::{Cell, Column, ColumnOf, Rating, Table};
#[cfg(feature = "documents")]
pub use terminal::{Characters, sparkline, terminal_picture};
#[cfg(feature = "documents")]
pub use ticks::{Ticks, linear_ticks, log_ticks};
#[cfg(feature = "documents")]
pub use trial::Trial;
#[cfg(feature = "documents")]
pub use vtk::{SolidBody, SolidTie, Solids, paraview, paraview_of_solids};

/// The example of the README, which is compiled and run with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
