//! A number type that counts arithmetic operations, so that the work of a time step can be compared between versions of
//! the program.
//!
//! Counts depend on the algorithm only, not on the machine, its load or the compiler.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use barrelstack_dynamics::lanes::{Batch, Case, End, run_batch};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{Drive, Method, Planar, Scratch, State};

thread_local! {
    static DONE: Cell<Operations> = const { Cell::new(Operations::NONE) };
}

/// Numbers of arithmetic operations, by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// Number of additions, subtractions and multiplications.
    pub plain: u64,
    /// Number of divisions and square roots.
    pub divisions: u64,
    /// Number of comparisons, selections and changes of sign.
    pub choices: u64,
}

impl Operations {
    const NONE: Self = Self { plain: 0, divisions: 0, choices: 0 };

    /// Counts the operations on [`Counting`] numbers that `work` performs on this thread.
    pub fn of(work: impl FnOnce()) -> Self {
        DONE.set(Self::NONE);
        work();
        DONE.get()
    }
}

fn count(one: fn(&mut Operations) -> &mut u64) {
    let mut done = DONE.get();
    *one(&mut done) += 1;
    DONE.set(done);
}

fn plain() {
    count(|done| &mut done.plain);
}

fn division() {
    count(|done| &mut done.divisions);
}

fn choice() {
    count(|done| &mut done.choices);
}

/// A number that counts operations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counting(f64);

impl Real for Counting {
    type Mask = bool;
    const LANES: usize = 1;

    fn splat(value: f64) -> Self {
        Self(value)
    }
    fn sqrt(self) -> Self {
        division();
        Self(self.0.sqrt())
    }
    fn abs(self) -> Self {
        choice();
        Self(self.0.abs())
    }
    fn lt(self, other: Self) -> bool {
        choice();
        self.0 < other.0
    }
    fn le(self, other: Self) -> bool {
        choice();
        self.0 <= other.0
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        choice();
        if mask { yes } else { no }
    }
    fn lane(self, _: usize) -> f64 {
        self.0
    }
    fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        Self(value(0))
    }
}

macro_rules! counted {
    ($($operation:ident $method:ident $kind:expr),*) => {$(
        impl $operation for Counting {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                $kind();
                Self($operation::$method(self.0, other.0))
            }
        }
    )*};
}
counted!(Add add plain, Sub sub plain, Mul mul plain, Div div division);

impl Neg for Counting {
    type Output = Self;
    fn neg(self) -> Self {
        choice();
        Self(-self.0)
    }
}
impl AddAssign for Counting {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Counting {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// Computational work of a run: steps, nodes in contact and arithmetic operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// Number of accepted steps.
    pub steps: u64,
    /// Number of nodes in contact, summed over the steps.
    pub touching: u64,
    /// Arithmetic operations of the whole run, including its initialization.
    pub operations: Operations,
}

impl Work {
    /// Runs a case, and counts its steps, nodes in contact and arithmetic operations.
    pub fn of<D: Drive<Planar>>(method: Method, case: Case<'_, Planar, D>) -> Self {
        let mut one = One { case: Some(case), touching: 0, steps: 0 };
        let operations = Operations::of(|| run_batch::<Planar<Counting>, _>(method, &mut one));
        Self { steps: one.steps, touching: one.touching, operations }
    }
}

/// Batch that contains a single case and counts the steps and the nodes in contact.
struct One<'a, D> {
    case: Option<Case<'a, Planar, D>>,
    touching: u64,
    steps: u64,
}

impl<'a, D: Drive<Planar>> Batch<'a, Planar<Counting>> for One<'a, D> {
    type Drive = D;

    fn next(&mut self, _: usize) -> Option<Case<'a, Planar, D>> {
        self.case.take()
    }
    fn start(&mut self, _: usize, _: &State<Planar>, _: &Scratch<Planar>) {}
    fn observe(
        &mut self,
        _: &State<Planar<Counting>>,
        scratch: &Scratch<Planar<Counting>>,
    ) -> bool {
        self.steps += 1;
        self.touching += scratch.touching() as u64;
        false
    }
    fn end(&mut self, _: usize, _: End) {}
}
