//! How fast stacks are computed: one run, many in lanes, and a game engine on the same scene.
//!
//! ```sh
//! cargo xtask bench
//! ```
//!
//! All figures are of one process, so that their ratios hold on a machine that others use, too;
//! times are those the processor spent on it where the system tells them, and of one core where
//! nothing else is said.

mod accuracy;
mod count;
mod growth;
mod lanes;
mod peer;
mod scene;
mod time;

use barrelstack_dynamics::Method;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let scene = scene::Scene::consensus(20.0)?;
    let step = accuracy::work_and_precision(&scene)?;
    println!();
    let lanes = lanes::against_width(&scene, step);
    println!();
    peer::compare(&scene, lanes)?;
    println!();
    lanes::scenario()?;
    println!();
    lanes::threads(&scene, step);
    println!();
    count::per_step(&scene, Method::VelocityVerlet, step);
    println!();
    growth::with_size()
}
