//! Problems with exact or published answers, against which the program is validated.
//!
//! A [`Problem`] holds the scene, the exact or published answer with its source, and the tolerance. The tests of this
//! crate run all problems in a fast form. The program of this crate runs them in full:
//!
//! ```sh
//! cargo xtask validate
//! ```
//!
//! # Order of convergence
//!
//! Penalty contact has two small parameters, the time step and the duration of a contact. A refinement halves both: the
//! time step directly, and the duration of a contact by making it four times as stiff, with the same damping ratio. In
//! the limit, the bodies are rigid, as in the closed-form solution. The measured order is therefore the order of
//! convergence to the exact answer. Thresholds found by bisection have no order.
//!
//! # Adding a problem
//!
//! A problem that needs only bodies, a motion and one of the predefined quantities is a file in `cases/` (see
//! [`cases`]); any other problem is a function in one of the modules of [`problems`].

pub mod cases;
pub mod counting;
pub mod dominoes;
pub mod execute;
pub mod field;
pub mod ode;
pub mod oracle;
pub mod page;
pub mod problem;
pub mod problems;
pub mod rocking;
pub mod swing;

pub use execute::{Row, execute};
pub use problem::{Effort, Failure, Outcome, Problem, Tolerance};
pub use problems::all;

pub use barrelstack_scenes::{GRAVITY, drive, order, scene, spatial, theory, tumble};
