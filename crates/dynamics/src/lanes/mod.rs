//! Many cases side by side in the lanes of a vector register.
//!
//! A lane computes what a single run computes, with the same source and the same bits: laws, shapes,
//! methods and books are written once over [`Real`], and here are the bundles that stand in for it.
//! Which vector unit they use is found out when the program runs.
//!
//! - `Bundle`: eight numbers of one vector unit.
//! - [`Topology`]: what cases must share to run in one bundle.
//! - [`Lanewise`]: how a single thing is put into a lane, and taken out of it.
//! - [`run_batch`]: the run loop of all lanes, which refills the lane of a case that has ended.

mod batch;
#[cfg(target_arch = "x86_64")]
mod bundle;
mod lanewise;
mod topology;

use crate::real::Real;

pub use batch::{Batch, Case, End, run_batch};
#[doc(hidden)]
pub use lanewise::{ALIKE, put_truth};
pub use lanewise::{Lanewise, PerLane};
pub use topology::Topology;

/// No bundle has more lanes.
const MOST_LANES: usize = 16;

/// How numbers are bundled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Width {
    /// One number after the other.
    Scalar,
    /// AVX2.
    Avx2,
    /// AVX-512 of the kind that Ice Lake brought.
    Avx512,
}

/// Work that is written over the scalar and done with the bundles of a width.
pub trait Task {
    /// What it makes.
    type Output;
    /// Does it.
    fn run<R: Real>(self) -> Self::Output;
}

impl Width {
    /// All of them, the narrowest first.
    pub const ALL: [Self; 3] = [Self::Scalar, Self::Avx2, Self::Avx512];

    /// The widest that this machine has.
    pub fn widest() -> Self {
        Self::ALL.into_iter().rev().find(|width| width.is_here()).unwrap_or(Self::Scalar)
    }

    /// Whether this machine has it.
    pub fn is_here(self) -> bool {
        match self {
            Self::Scalar => true,
            Self::Avx2 => units::has_avx2(),
            Self::Avx512 => units::has_avx512(),
        }
    }

    /// The word used in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The width of a [`Width::name`].
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|width| width.name() == name)
    }

    /// Does work with the bundles of this width; none where this machine does not have it.
    pub fn run<T: Task>(self, task: T) -> Option<T::Output> {
        if !self.is_here() {
            return None;
        }
        match self {
            Self::Scalar => Some(task.run::<f64>()),
            Self::Avx2 | Self::Avx512 => units::run(self, task),
        }
    }
}

/// The vector units of this kind of processor.
///
/// A token proves that the machine has a unit; bundles need it in every number they make, so it is a
/// constant here, and the functions of this module are the only way to code that uses it: each asks
/// the machine first.
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "tokens as constants; every way to them asks the machine first")]
pub(crate) mod units {
    use std::sync::LazyLock;

    use fearless_simd::{Avx2, Avx512, Level, Simd as _};

    use super::bundle::{Bundle, Unit};
    use super::{Task, Width};

    impl Unit for Avx2 {
        // SAFETY: `run` is the only user, and asks `has_avx2` first.
        const TOKEN: Self = unsafe { Self::assume_supported() };
    }
    impl Unit for Avx512 {
        // SAFETY: `run` is the only user, and asks `has_avx512` first.
        const TOKEN: Self = unsafe { Self::assume_supported() };
    }

    pub(super) fn has_avx2() -> bool {
        Level::new().as_avx2().is_some()
    }

    pub(super) fn has_avx512() -> bool {
        Level::new().as_avx512().is_some()
    }

    /// Does work with single numbers by the instructions of a vector unit, where the machine has one: these keep
    /// what they compute from, and are a tenth fewer. None of them fuses a product and a sum, so bits stay.
    #[inline(always)]
    pub(crate) fn single<T>(work: impl FnOnce() -> T) -> T {
        static AVX2: LazyLock<Option<Avx2>> = LazyLock::new(|| Level::new().as_avx2());
        match *AVX2 {
            Some(unit) => unit.vectorize(work),
            None => work(),
        }
    }

    pub(super) fn run<T: Task>(width: Width, task: T) -> Option<T::Output> {
        match width {
            Width::Scalar => Some(task.run::<f64>()),
            Width::Avx2 => has_avx2().then(|| task.run::<Bundle<Avx2>>()),
            Width::Avx512 => has_avx512().then(|| task.run::<Bundle<Avx512>>()),
        }
    }
}

/// Elsewhere one number goes after the other.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) mod units {
    use super::{Task, Width};

    pub(super) fn has_avx2() -> bool {
        false
    }

    pub(super) fn has_avx512() -> bool {
        false
    }

    #[inline(always)]
    pub(crate) fn single<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    pub(super) fn run<T: Task>(_width: Width, _task: T) -> Option<T::Output> {
        None
    }
}
