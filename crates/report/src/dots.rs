//! Outcomes of variants, drawn as one dot for each variant.

use crate::{
    Language,
    drawing::{Drawing, Item},
};

/// Numbers of variants by outcome, for one direction of the shaking or for a three-dimensional model. Each
/// variant is drawn as a dot below the headline.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dots {
    /// Direction of the shaking, such as "along the barrels"; empty for a three-dimensional model.
    pub direction: String,
    /// Number of variants that fall.
    pub fell: u32,
    /// Number of variants that stand.
    pub stood: u32,
    /// Number of variants without a verdict.
    pub open: u32,
}

/// Number of dots in a row.
const ROW: u32 = 64;
/// Largest number of dots that are drawn; no dots are drawn for more variants than this.
const MOST: u32 = 4 * ROW;
/// Distance between the centers of two dots (px).
const PITCH: f64 = 10.0;
/// Radius of a dot (px).
const RADIUS: f64 = 3.6;

impl Dots {
    /// Returns a description of the dots: the number of variants with each outcome, followed by the appearance of
    /// their dots, such as "Along the barrels: 53 fall (filled), 11 stand (rings)".
    pub(crate) fn words(&self, language: Language) -> String {
        let counts: Vec<String> = [
            (self.fell, ["falls", "fall"], "filled"),
            (self.open, ["has no verdict", "have no verdict"], "gray"),
            (self.stood, ["stands", "stand"], "rings"),
        ]
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, verbs, look)| {
            let verb = language.fixed(verbs[usize::from(count != 1)]);
            format!("{count} {verb} ({})", language.fixed(look))
        })
        .collect();
        let place =
            if self.direction.is_empty() { language.fixed("variants") } else { &self.direction };
        format!("{}: {}", crate::capital(place), counts.join(", "))
    }

    /// Draws the dots in rows, beginning with the variants that fall. Returns `None` if there are no variants, or more
    /// than `MOST`.
    pub(crate) fn draw(&self, language: Language) -> Option<Drawing> {
        let all = self.fell + self.open + self.stood;
        if all == 0 || all > MOST {
            return None;
        }
        let columns = all.min(ROW);
        let size = [columns, all.div_ceil(ROW)].map(|count| PITCH * f64::from(count));
        let mut drawing = Drawing::new(size[0], size[1], &self.words(language));
        for dot in 0..all {
            let class = match dot {
                fell if fell < self.fell => "variant fell",
                open if open < self.fell + self.open => "variant open",
                _ => "variant stood",
            };
            let center = [dot % ROW, dot / ROW].map(|at| PITCH * (f64::from(at) + 0.5));
            drawing.push(Item::Circle { class: class.to_owned(), center, radius: RADIUS });
        }
        Some(drawing)
    }
}

#[cfg(test)]
mod tests {
    use super::Dots;
    use crate::{Document, Language, Verdict, drawing::Item, html::html};

    fn dots(fell: u32, open: u32, stood: u32) -> Dots {
        Dots { direction: "along the barrels".into(), fell, stood, open }
    }

    #[test]
    fn each_variant_has_one_dot_and_those_that_fall_come_first() {
        let drawing = dots(53, 1, 76).draw(Language::English).unwrap();
        let classes: Vec<&str> = drawing
            .items
            .iter()
            .map(|item| {
                let Item::Circle { class, center, radius } = item else { panic!("{item:?}") };
                assert!((0..2).all(|axis| center[axis] - radius >= 0.0));
                assert!(center[0] + radius <= drawing.width);
                assert!(center[1] + radius <= drawing.height);
                class.as_str()
            })
            .collect();
        assert_eq!(classes.len(), 130);
        assert!(classes[..53].iter().all(|class| *class == "variant fell"));
        assert_eq!(classes[53], "variant open");
        assert!(classes[54..].iter().all(|class| *class == "variant stood"));
    }

    #[test]
    fn counts_are_stated_in_words() {
        assert_eq!(
            dots(53, 0, 11).words(Language::English),
            "Along the barrels: 53 fall (filled), 11 stand (rings)"
        );
        assert_eq!(dots(0, 0, 1).words(Language::English), "Along the barrels: 1 stands (rings)");
        let in_space = Dots { direction: String::new(), ..dots(1, 2, 0) };
        assert_eq!(
            in_space.words(Language::English),
            "Variants: 1 falls (filled), 2 have no verdict (gray)"
        );
    }

    #[test]
    fn a_page_shows_a_dot_for_every_variant_below_the_headline() {
        let verdict = Verdict { dots: vec![dots(2, 0, 3)], ..Verdict::default() };
        let page = html(&Document { verdict, ..Document::default() });
        let header = page.split("</header>").next().unwrap();
        assert_eq!(header.matches("class=\"variant fell\"").count(), 2);
        assert_eq!(header.matches("class=\"variant stood\"").count(), 3);
        assert!(header.contains("Along the barrels: 2 fall (filled), 3 stand (rings)"));
    }

    #[test]
    fn no_dots_are_drawn_where_they_would_be_too_many() {
        assert!(dots(0, 0, 0).draw(Language::English).is_none());
        assert!(dots(100, 0, 156).draw(Language::English).is_some());
        assert!(dots(100, 0, 157).draw(Language::English).is_none());
    }
}
