//! Glossary of the report pages, written for winery managers.

use barrelstack_report::Word;

/// Terms with their explanations; a page explains each term where it occurs. GLOSSARY.md has the
/// same list.
pub const WORDS: &[Word] = &[
    word(
        "variant",
        "the same stack with small differences: millimeters out of place, a little heavier or lighter, more or less slippery",
    ),
    word(
        "95 % interval",
        "a range computed from a sample; 19 of 20 such ranges contain the true share",
    ),
    word("across the barrels", "in the plane that shows the heads of the barrels, as circles"),
    word("along the barrels", "in the plane that shows the barrels from the side"),
    word("cradle", "the two bars of a rack between which a barrel lies"),
    word("seat", "the place that holds a barrel in its rack, or a rack on the barrels below"),
    word("ejection", "the top level leaves the stack, or a barrel leaves its rack"),
    word("rocking", "upper levels rock on the barrels below and topple together"),
    word("rack-sliding", "a rack slides along the barrels below until it leaves them"),
    word("overturning", "the whole stack turns over about its foot"),
    word("gravity", "the stack falls under its own weight, before it is shaken"),
    word("drift", "sideways displacement of the top, divided by the height of the stack"),
    word("uplift", "how far a body rises above its support"),
    word("pretension", "the force to which a strap is tightened when it is installed"),
    word(
        "stress amplification",
        "the largest line load (normal force at a contact per meter of boundary) until the first loss of a seat, \
         divided by the largest line load at rest",
    ),
    word("PGA", "peak ground acceleration: the largest acceleration of the ground"),
    word("PGV", "peak ground velocity: the largest speed of the ground"),
    word("contact constants", "stiffness and damping of the contact between two bodies"),
    word(
        "energy balance",
        "comparison of the energy supplied with the energy stored and dissipated; the difference is the error of the computation",
    ),
    word(
        "residual",
        "what remains at the end: for the energy balance, the error of the computation; for a displacement, the displacement at the end of the run",
    ),
    word("falls by itself", "a stack that loses a seat before a body of another stack touches it"),
    word("knocked over", "a stack that loses a seat after a body of another stack touched it"),
    word("similitude", "scaling of a stack to a model that behaves like the full-size stack"),
];

const fn word(word: &'static str, meaning: &'static str) -> Word {
    Word { word, meaning }
}
