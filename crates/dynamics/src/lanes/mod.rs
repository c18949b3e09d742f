//! Runs of many cases side by side, in the lanes of a vector register.
//!
//! The results of a lane are bit-identical to those of a single run, and the source code is the same: contact laws,
//! shapes, integration methods and the energy balance are generic over [`Real`], which the bundles of this module
//! implement. The vector unit is detected at run time, if the feature `vector-units` of this crate is on, as it is by
//! default.
//!
//! - `Bundle`: eight numbers of one vector unit.
//! - [`Topology`]: properties that must be equal for cases that run in one bundle.
//! - [`Lanewise`]: insertion and extraction of single lanes.
//! - [`run_batch`]: the run loop of all lanes. When a case has ended, its lane gets the next case.

mod batch;
#[cfg(all(target_arch = "x86_64", feature = "vector-units"))]
mod bundle;
mod lanewise;
mod topology;

use crate::real::Real;

pub use batch::{Batch, Case, End, run_batch};
#[doc(hidden)]
pub use lanewise::{ALIKE, put_truth};
pub use lanewise::{Lanewise, PerLane};
pub use topology::Topology;
pub(crate) use topology::kind;

/// Number of lanes of a bundle; the same for every vector unit.
pub const LANES: usize = 8;

/// Upper bound on the number of lanes of a bundle.
const MOST_LANES: usize = 16;

/// Kind of vector unit used for the computation. Without a vector unit, all operations act on scalars; with a vector
/// unit, they act on bundles of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Width {
    /// No vector unit: scalars.
    Scalar,
    /// AVX2.
    Avx2,
    /// AVX-512 with the extensions of Ice Lake.
    Avx512,
}

/// A task that is generic over the scalar, so that it can run with bundles of any width.
pub trait Task {
    /// Result of the task.
    type Output;
    /// Runs the task with `R` as the scalar.
    fn run<R: Real>(self) -> Self::Output;
}

impl Width {
    /// All widths, the narrowest first.
    pub const ALL: [Self; 3] = [Self::Scalar, Self::Avx2, Self::Avx512];

    /// Returns the largest width that this machine supports.
    pub fn widest() -> Self {
        Self::ALL.into_iter().rev().find(|width| width.is_here()).unwrap_or(Self::Scalar)
    }

    /// Returns `true` if this machine supports the width.
    pub fn is_here(self) -> bool {
        match self {
            Self::Scalar => true,
            Self::Avx2 => units::has_avx2(),
            Self::Avx512 => units::has_avx512(),
        }
    }

    /// Returns the name that files and reports use for the width.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// Returns the width with the given [`Width::name`]; `None` if there is no such width.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|width| width.name() == name)
    }

    /// Runs a task with the widest bundles that this machine supports; `None` if it has no vector unit.
    ///
    /// Unlike [`Width::run`], this does not compile the task for scalars.
    pub fn run_in_bundles<T: Task>(task: T) -> Option<T::Output> {
        units::run(Self::widest(), task)
    }

    /// Runs a task with the bundles of this width; `None` if this machine does not support the width.
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

/// The vector units supported on this processor architecture.
///
/// A token is a value that proves that the machine has a vector unit. Every operation of a bundle requires the token,
/// so the token is a constant of the type. Code that uses the token is accessible only through the functions of this
/// module, which first check that the machine has the unit.
#[cfg(all(target_arch = "x86_64", feature = "vector-units"))]
#[expect(unsafe_code, reason = "tokens as constants; every path to them checks the machine first")]
pub(crate) mod units {
    use std::sync::LazyLock;

    use fearless_simd::{Avx2, Avx512, Level, Simd as _};

    use super::bundle::{Bundle, Unit};
    use super::{Task, Width};

    impl Unit for Avx2 {
        // SAFETY: `run` is the only user, and checks `has_avx2` first.
        const TOKEN: Self = unsafe { Self::assume_supported() };
    }
    impl Unit for Avx512 {
        // SAFETY: `run` is the only user, and checks `has_avx512` first.
        const TOKEN: Self = unsafe { Self::assume_supported() };
    }

    pub(super) fn has_avx2() -> bool {
        Level::new().as_avx2().is_some()
    }

    pub(super) fn has_avx512() -> bool {
        Level::new().as_avx512().is_some()
    }

    /// Runs scalar work with the AVX2 instruction set, if the machine supports it. Its instructions have a separate
    /// operand for the result, which saves a tenth of all instructions. No multiplication is fused with an addition, so
    /// the results are bit-identical.
    #[inline(always)]
    pub(crate) fn single<T>(work: impl FnOnce() -> T) -> T {
        static AVX2: LazyLock<Option<Avx2>> = LazyLock::new(|| Level::new().as_avx2());
        match *AVX2 {
            Some(unit) => unit.vectorize(work),
            None => unaided(work),
        }
    }

    /// Runs scalar work with the baseline instruction set of the architecture. This function is not inlined, so that
    /// the work is compiled only once and not again at every call.
    #[inline(never)]
    fn unaided<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Runs a task with the bundles of a width; `None` for scalars, and if this machine does not support the width.
    pub(super) fn run<T: Task>(width: Width, task: T) -> Option<T::Output> {
        match width {
            Width::Scalar => None,
            Width::Avx2 => has_avx2().then(|| task.run::<Bundle<Avx2>>()),
            Width::Avx512 => has_avx512().then(|| task.run::<Bundle<Avx512>>()),
        }
    }
}

/// Scalar fallback for other architectures, and for builds without the feature `vector-units`.
#[cfg(not(all(target_arch = "x86_64", feature = "vector-units")))]
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
