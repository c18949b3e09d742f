//! Imperfections: random differences from stack to stack.

use barrelstack_input::section;

use super::dimension::Dimension;
use super::field::{Default, Kind, Range, names};
use super::run::Until;

const SHARE: Kind = Kind::Number(Range::between(0.0, 0.1));

section! {
    /// Random differences from stack to stack, and the number of variants that are drawn.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Imperfections;
    /// Random differences from stack to stack, centered on the values of the scenario, and the number of variants of
    /// the stack. The uncertain constants that all bodies of a stack share are in the table `unknowns`.
    pub static IMPERFECTIONS = "imperfections";
    /// Number of variants of the stack that are run in each plane, in addition to the stack as stated; 0 to run only
    /// the stack as stated.
    variants: u32 = Kind::Integer(0, 4096), Default::Value("64");
    /// Criterion that ends the runs of the variants; used only if `run.until` is "rest". The value "verdict" ends such
    /// a run 2 s after the first loss of a seat; a run without such a loss ends when all bodies are at rest and the
    /// ground acceleration stays below 0.02 g. The value "rest" ends such a run when all bodies have come to rest.
    until: Until = Kind::Choice(names::<Until>), Default::Value("\"verdict\"");
    /// Seed of the random numbers from which the imperfections and the unknown constants of the variants are drawn.
    seed: u32 = Kind::Integer(0, u32::MAX as i64), Default::Value("1");
    /// True to draw the position and the mass of every rack and barrel at random; false to keep them as stated in all
    /// variants.
    drawn: bool = Kind::Flag, Default::Value("true");
    /// Largest offset, to either side, of every rack on its supports and of every barrel in its cradle. The offset is
    /// uniformly distributed and drawn for each body. The default is an assumption: forklifts do not place racks and
    /// barrels more precisely than this.
    placement: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 0.02)), Default::Value("\"1 mm\"");
    /// Standard deviation of the mass of every barrel and rack, as a fraction of that mass. The mass is normally
    /// distributed, cut off at three standard deviations, and drawn for each body. The default is an assumption; for a
    /// full barrel, it is equivalent to 3 L of missing wine, or of water in the wood.
    mass: f64 = SHARE, Default::Value("0.01");
    /// True to mirror the stack left to right in half of the variants, which are chosen at random; false to mirror no
    /// variant.
    sign: bool = Kind::Flag, Default::Value("false");
}
