//! What became of all variants of a scenario.

use std::collections::BTreeMap;

use barrelstack_report::described;

described! {
    /// What became of all variants of a scenario.
    #[derive(Clone, Debug, PartialEq)]
    pub struct EnsembleSummary {
        /// Variants that were run and have a verdict.
        pub variants: usize,
        /// Variants that collapse.
        pub collapsed: usize,
        /// Share of them that collapse.
        pub share: f64 as "1",
        /// 95 % interval of the chance of collapse (Wilson).
        pub interval: [f64; 2] as "1",
        /// When the first barrel falls, of the variants where one does; null where none does.
        pub first_fall: Option<Percentiles> as "s",
        /// Barrels that fall.
        pub barrels_fallen: Percentiles,
        /// Variants by the mode of their collapse.
        pub modes: BTreeMap<String, usize>,
    }

    /// How a number spreads over the variants.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Percentiles {
        /// Five in a hundred lie below.
        pub p05: f64 as "of the quantity",
        /// Half lie below.
        pub p50: f64 as "of the quantity",
        /// Five in a hundred lie above.
        pub p95: f64 as "of the quantity",
    }
}
