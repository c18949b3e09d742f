//! Options for the formats of figures.

use barrelstack_report::{Format, Paper};

use crate::number::real;
use crate::typed::typed;

/// Formats of figures besides SVG.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct FigureArgs {
    /// Format of figures, which are always written as SVG too; may be repeated. The default is PNG and PDF.
    #[arg(long, value_enum, value_name = "FORMAT")]
    format: Vec<FormatName>,
    /// Resolution (dots per inch) of figures in PNG.
    #[arg(
        long, value_name = "DPI", default_value = "200", allow_negative_numbers = true,
        value_parser = real(
            "a number of dots per inch from 20 to 1200, such as 300",
            |number| (20.0..=1200.0).contains(&number)
        )
    )]
    pub(crate) dpi: f64,
}

impl FigureArgs {
    /// Returns `true` if any format was requested by name.
    pub(crate) fn names_any(&self) -> bool {
        !self.format.is_empty()
    }

    /// Returns the formats, each once, SVG first.
    pub(crate) fn formats(&self) -> Vec<Format> {
        let requested = |format: &Format| {
            let named = self.format.iter().any(|name| Format::from(*name) == *format);
            *format == Format::Svg || self.format.is_empty() || named
        };
        Format::ALL.into_iter().filter(requested).collect()
    }
}

typed! {
    /// The formats, by their names on the command line.
    pub(crate) enum FormatName of Format {
        /// Vector graphics, for web pages and for editing.
        Svg = Self::Svg,
        /// Pixel graphics.
        Png = Self::Png,
        /// Vector graphics, for typesetting.
        Pdf = Self::Pdf,
    }
}

typed! {
    /// The paper sizes, by their names on the command line.
    pub(crate) enum PaperName of Paper {
        /// 210 by 297 mm.
        A4 = Self::A4,
        /// 8½ by 11 inches.
        Letter = Self::Letter,
    }
}
