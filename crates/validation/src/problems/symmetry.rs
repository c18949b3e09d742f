//! The order of bodies: exchanging the two bodies of a contact must not change the motion.

use barrelstack_dynamics::Space;

use crate::order::{Order, planar_heap, planar_pairs, spatial_heap, spatial_pairs};
use crate::problem::{Reference, absolute, setting};
use crate::{Effort, Outcome, Problem};

/// Time step (s).
const STEP: f64 = 1e-4;
/// End time (s).
const END: f64 = 1.0;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let limit = || absolute(0.0, 1e-9);
    vec![
        problem("two-in-the-plane", "two bodies in a plane that collide", limit(), |_| {
            planar_pairs()
        }),
        problem("two-in-space", "two solids in space that collide", limit(), |_| spatial_pairs()),
        problem("four-on-a-floor", "four bodies in a plane on a floor", limit(), |effort| {
            (0..if effort == Effort::Full { 24 } else { 4 }).map(planar_heap).collect()
        }),
        problem("two-on-a-floor", "two solids on a floor", limit(), |effort| {
            (0..if effort == Effort::Full { 15 } else { 4 }).map(spatial_heap).collect()
        }),
        // A change of the last bit of the initial state also moves the blocks by 1.4e-9 m.
        problem("blocks-on-a-floor", "two blocks on a floor", absolute(0.0, 1e-8), |_| {
            vec![spatial_heap(15)]
        }),
    ]
}

fn problem<S: Space<Real = f64>>(
    name: &str,
    title: &str,
    reference: Reference,
    scenes: fn(Effort) -> Vec<Order<S>>,
) -> Problem {
    setting(format!("symmetry/{name}"), title, "symmetry of mechanics")
        .quantity("largest difference between the two orders within one second", "m", reference)
        .by(move |effort| {
            let (scenes, mut worst) = (scenes(effort), (0.0_f64, String::new()));
            let count = scenes.len();
            for scene in scenes {
                let apart = scene.reversal(STEP, END)?;
                if apart > worst.0 || apart.is_nan() {
                    worst = (apart, format!(": {}", scene.name));
                }
            }
            Ok(Outcome::of(worst.0).noted(format!("worst of {count} scenes{}", worst.1)))
        })
}
