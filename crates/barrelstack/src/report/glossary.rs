//! Technical terms of the pages, explained for winery managers.

use barrelstack_report::Word;

/// Each is explained where it occurs; GLOSSARY.md has the same list.
pub const WORDS: &[Word] = &[
    word(
        "variant",
        "the same stack a little different: set down millimeters elsewhere, a little heavier, more or less slippery",
    ),
    word("95 % interval", "the range in which the true share lies in 19 of 20 such samples"),
    word("across the barrels", "seen from the head of the barrels, which are circles then"),
    word("along the barrels", "seen from the side of the barrels, which are longer than high then"),
    word("cradle", "the two bars of a rack between which a barrel lies"),
    word("seat", "the place that holds a barrel in its rack, or a rack on the barrels below"),
    word("ejection", "the top level leaves the stack, or a barrel its rack"),
    word("rocking", "upper levels rock on the barrels below and topple together"),
    word("rack-sliding", "a rack walks along the barrels below until it is off them"),
    word("overturning", "the whole stack turns over about its foot"),
    word("gravity", "the stack falls under its own weight, before it is shaken"),
    word("drift", "how far the top moves sideways, over the height of the stack"),
    word("uplift", "how far a body rises from what it stands on"),
    word("pretension", "the force to which a strap is tightened when it is put on"),
    word(
        "stress amplification",
        "the largest pressure until the first loss of seat, over the largest at rest",
    ),
    word("PGA", "peak ground acceleration: the largest acceleration of the ground"),
    word("PGV", "peak ground velocity: the largest speed of the ground"),
    word("contact constants", "how stiff and how damped bodies are where they touch"),
    word(
        "energy balance",
        "what energy came in, is stored and was lost; what is missing is an error of the computation",
    ),
    word(
        "residual",
        "what is left over: of energy an error of the computation, of displacement where a body stays",
    ),
    word("similitude", "a model at another scale that behaves like the full-size one"),
];

const fn word(word: &'static str, meaning: &'static str) -> Word {
    Word { word, meaning }
}
