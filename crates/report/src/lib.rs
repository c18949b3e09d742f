//! Documents, figures and a player for moving rigid bodies, as HTML, Markdown, SVG, CSV and VTK.
//!
//! A [`Document`] is data: a verdict, [`Block`]s in reading order, warnings, provenance.
//! [`html`] turns it into one page that needs no network, [`markdown`] into text with figures
//! beside it. Every format reads the same numbers.
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
//!     },
//!     blocks: vec![Block::Table(table)],
//!     provenance: vec![],
//!     warnings: vec![],
//! };
//! assert!(html(&document).contains("<td class=\"number\">2.0</td>"));
//! ```
//!
//! # Conventions
//!
//! Scenes use meters, radians and seconds, x to the right, z up, angles counterclockwise.
//! Plots, tables and histories take numbers in the unit their label states.
//! A number that is not finite is a gap in a line and a dash in a table. No input panics: lists
//! of unequal length are read to the end of the shorter, empty figures draw empty axes.

mod document;
mod envelope;
mod escape;
mod figure;
mod film;
mod html;
mod markdown;
mod number;
mod pack;
mod page;
mod player;
mod plot;
mod plot_svg;
mod scene;
mod simplify;
mod strip;
mod svg;
mod table;
mod ticks;
mod vtk;

pub use document::{Block, Document, Tone, Verdict};
pub use envelope::{BoundarySample, Envelope};
pub use figure::{Attachment, Figure, FigureKind, attachments};
pub use film::Film;
pub use html::html;
pub use markdown::{MarkdownBundle, markdown};
pub use number::significant;
pub use pack::{POSE_QUANTUM, TIME_QUANTUM};
pub use player::Player;
pub use plot::{Axis, Band, Mark, Plot, Scale, Series, SeriesStyle};
pub use scene::{
    ContactForce, Event, EventKind, Frames, History, Point, Polyline, Pose2, Role, Scene,
    SceneBody, Trace,
};
pub use strip::{Panel, Strip};
pub use table::{Cell, Column, Rating, Table};
pub use ticks::{Ticks, linear_ticks, log_ticks};
pub use vtk::paraview;
