//! Cost of many cases in lanes, as a function of the width of the lanes.

use barrelstack_dynamics::lanes::{Batch, Case, End, Task, Width, run_batch};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{Method, Planar, Scratch, State};
use barrelstack_validation::drive::Shake;

use crate::scene::Scene;
use crate::time;

/// Number of cases in the batch. It exceeds the number of lanes of the widest bundle.
const CASES: usize = 64;

/// Simulated time (s), during which the stack stands.
const STANDING: f64 = 1.2;

/// Returns the processor time (s) per simulated second of a case, with the widest lanes.
pub(crate) fn of_widest(scene: &Scene, step: f64) -> f64 {
    let run = || Width::widest().run(InLanes { scene, step });
    time::least(|| {
        run();
    }) / (CASES as f64 * STANDING)
}

/// Prints the cost for every width of the lanes.
pub(crate) fn against_width(scene: &Scene, step: f64) {
    println!(
        "lanes: {CASES} such stacks with amplitudes from 0.8 to 1.2, before they fall, steps of {} ms",
        1e3 * step
    );
    println!("  lanes     × real time   µs per step and case   against scalar");
    let simulated = CASES as f64 * STANDING;
    let mut scalar = None;
    for width in Width::ALL.into_iter().filter(|width| width.is_here()) {
        let spent = time::least(|| {
            width.run(InLanes { scene, step });
        });
        let scalar = *scalar.get_or_insert(spent);
        println!(
            "  {:8} {:12.0} {:21.3} {:16.2}",
            width.name(),
            simulated / spent,
            1e6 * spent * step / simulated,
            scalar / spent
        );
    }
}

/// Task that runs cases in lanes. The cases differ in the amplitude of the ground motion.
struct InLanes<'a> {
    scene: &'a Scene,
    step: f64,
}

impl Task for InLanes<'_> {
    type Output = ();

    fn run<R: Real>(self) {
        let mut cases = Cases { scene: self.scene, step: self.step, next: 0, ended: 0 };
        run_batch::<Planar<R>, _>(Method::VelocityVerlet, &mut cases);
        assert_eq!(cases.ended, CASES, "every case ends");
    }
}

struct Cases<'a> {
    scene: &'a Scene,
    step: f64,
    next: usize,
    ended: usize,
}

impl<'a, R: Real> Batch<'a, Planar<R>> for Cases<'a> {
    type Drive = Shake;

    fn next(&mut self, _lane: usize) -> Option<Case<'a, Planar, Shake>> {
        (self.next < CASES).then(|| {
            let factor = 0.8 + 0.4 * self.next as f64 / CASES as f64;
            self.next += 1;
            Case {
                model: &self.scene.model,
                state: self.scene.rest.clone(),
                drive: Scene::ground(factor),
                time_step: self.step,
                end_time: STANDING,
            }
        })
    }

    fn start(&mut self, _: usize, _: &State<Planar>, _: &Scratch<Planar>) {}

    fn observe(&mut self, _: &State<Planar<R>>, _: &Scratch<Planar<R>>) -> R::Mask {
        R::Mask::default()
    }

    fn end(&mut self, _: usize, end: End) {
        assert!(end.finish.is_ok(), "a case fails");
        self.ended += 1;
    }
}
