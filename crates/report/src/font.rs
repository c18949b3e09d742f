//! The bundled font: glyphs, their widths and their outlines.
//!
//! Raster images and PDF files look the same on every machine, because their text is drawn with
//! this font only. SVG refers to the fonts of the reader's system.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// One weight of the font.
pub(crate) struct Font {
    pub(crate) bytes: &'static [u8],
    pub(crate) name: &'static str,
    pub(crate) face: Face<'static>,
}

static REGULAR: LazyLock<Font> =
    LazyLock::new(|| font(include_bytes!("../assets/fonts/Inter-Regular.ttf"), "Inter-Regular"));
static STRONG: LazyLock<Font> =
    LazyLock::new(|| font(include_bytes!("../assets/fonts/Inter-SemiBold.ttf"), "Inter-SemiBold"));

fn font(bytes: &'static [u8], name: &'static str) -> Font {
    Font { bytes, name, face: Face::parse(bytes, 0).expect("the bundled font is a font") }
}

impl Font {
    /// Returns the regular or the bold font.
    pub(crate) fn of(strong: bool) -> &'static Self {
        if strong { &STRONG } else { &REGULAR }
    }

    /// Returns the glyphs of `text` in order, each with its character and its width as a fraction
    /// of the font size.
    ///
    /// Control characters have no glyph; a character that the font lacks is shown as a box.
    pub(crate) fn glyphs(&self, text: &str) -> impl Iterator<Item = (u16, char, f64)> {
        text.chars().filter(|c| !is_invisible(*c)).map(|c| {
            let glyph = self.face.glyph_index(c).unwrap_or(GlyphId(0));
            (glyph.0, c, self.advance(glyph.0))
        })
    }

    /// Returns the width of a glyph as a fraction of the font size.
    pub(crate) fn advance(&self, glyph: u16) -> f64 {
        let advance = self.face.glyph_hor_advance(GlyphId(glyph)).unwrap_or(0);
        f64::from(advance) / self.units()
    }

    /// Returns the width of a line of text at `size`, in the unit of the size.
    pub(crate) fn width(&self, text: &str, size: f64) -> f64 {
        size * self.glyphs(text).map(|(_, _, width)| width).sum::<f64>()
    }

    /// Returns the number of font units per em.
    pub(crate) fn units(&self) -> f64 {
        f64::from(self.face.units_per_em())
    }

    /// Draws the outline of a glyph, in font units with y upward.
    pub(crate) fn outline(&self, glyph: u16, pen: &mut dyn OutlineBuilder) {
        self.face.outline_glyph(GlyphId(glyph), pen);
    }

    /// Converts a length from font units to a fraction of the font size.
    pub(crate) fn share(&self, length: i16) -> f64 {
        f64::from(length) / self.units()
    }
}

/// `true` for invisible control characters.
fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_knows_what_reports_say() {
        const SAID: &str = "AZaz09µμσφηω°×·−±√≤≥≈→–—“”‘’…²³⁻⁰¹⁴⁵⁶⁷⁸⁹₁₂éñÁü½′";
        for strong in [false, true] {
            let font = Font::of(strong);
            let missing: String =
                font.glyphs(SAID).filter(|(glyph, ..)| *glyph == 0).map(|(_, c, _)| c).collect();
            assert_eq!(missing, "");
        }
    }

    #[test]
    fn digits_are_equally_wide_so_columns_line_up() {
        let font = Font::of(false);
        assert_eq!(font.width("1111", 12.0), font.width("0987", 12.0));
        assert_eq!(font.width("\u{202e}\u{0}", 12.0), 0.0);
    }
}
