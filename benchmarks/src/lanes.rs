//! Many cases in lanes: against the width, on threads, and from scenario to result.

use std::cell::Cell;
use std::sync::Arc;

use barrelstack::Scenario;
use barrelstack::ensemble::{Audience, Prepared, simulate_in};
use barrelstack_dynamics::lanes::{Case, Crew, End, Task, Width, march};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{Method, Planar, Scratch, State};
use barrelstack_validation::drive::Shake;

use crate::scene::Scene;
use crate::{Failure, time};

/// Cases of a march; more than any bundle has lanes.
const CASES: usize = 64;

/// Until then (s) the stack stands.
const STANDING: f64 = 1.2;

/// Prints the cost against the width and gives that of the widest (s a simulated second).
pub(crate) fn against_width(scene: &Scene, step: f64) -> f64 {
    println!(
        "lanes: {CASES} such stacks with amplitudes from 0.8 to 1.2, before they fall, steps of {} ms",
        1e3 * step
    );
    println!("  lanes     × real time   µs a step of a case   against scalar");
    let simulated = CASES as f64 * STANDING;
    let mut scalar = None;
    let mut last = f64::INFINITY;
    for width in Width::ALL.into_iter().filter(|width| width.is_here()) {
        let spent = time::least(|| {
            width.run(Marching { scene, step });
        });
        let scalar = *scalar.get_or_insert(spent);
        println!(
            "  {:8} {:12.0} {:21.3} {:16.2}",
            width.name(),
            simulated / spent,
            1e6 * spent * step / simulated,
            scalar / spent
        );
        last = spent / simulated;
    }
    last
}

/// Prints how the widest lanes scale over threads.
pub(crate) fn threads(scene: &Scene, step: f64) {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    println!("threads: as many marches as threads, widest lanes ({cores} cores)");
    println!("  threads   × real time on the clock   against one thread");
    let mut one = None;
    let mut count = 1;
    while count <= cores {
        let spent = time::least_wall(|| {
            std::thread::scope(|scope| {
                for _ in 0..count {
                    scope.spawn(|| Width::widest().run(Marching { scene, step }));
                }
            });
        });
        let speed = count as f64 * CASES as f64 * STANDING / spent;
        println!("  {count:7} {speed:26.0} {:20.2}", speed / *one.get_or_insert(speed));
        count *= 2;
    }
}

/// Prints what an ensemble of scenarios costs with all it does: building, settling, judging.
pub(crate) fn scenario() -> Result<(), Failure> {
    let cases: Result<Vec<Prepared>, Failure> = (0..CASES)
        .map(|k| {
            let friction = 0.3 + 0.4 * k as f64 / CASES as f64;
            let setting = format!("interface.rack-ground.friction.coefficient={friction}");
            let settings = [setting, "run.step=\"0.5 ms\"".into()];
            let scenario = Scenario::builtin("candia-8-barrels", &settings)?;
            let ground = Arc::new(scenario.ground()?);
            Ok(Prepared { scenario: Arc::new(scenario), ground })
        })
        .collect();
    let cases = cases?;
    println!("ensemble: {CASES} scenarios candia-8-barrels to their collapse and 4 s on, 0.5 ms");
    println!("  lanes     × real time with all it takes");
    for width in Width::ALL.into_iter().filter(|width| width.is_here()) {
        let simulated = Cell::new(0.0);
        let spent = time::least(|| {
            let mut audience = Audience { tell: &mut |_| {}, stop: &|| false };
            let results = simulate_in(width, &cases, &mut audience).unwrap_or_default();
            simulated.set(results.iter().filter_map(|result| result.end_time).sum());
        });
        println!("  {:8} {:12.0}", width.name(), simulated.get() / spent);
    }
    Ok(())
}

/// Cases that differ in the amplitude of the ground.
struct Marching<'a> {
    scene: &'a Scene,
    step: f64,
}

impl Task for Marching<'_> {
    type Output = ();

    fn run<R: Real>(self) {
        let mut cases = Cases { scene: self.scene, step: self.step, next: 0, ended: 0 };
        march::<R, _>(Method::VelocityVerlet, &mut cases);
        assert_eq!(cases.ended, CASES, "every case ends");
    }
}

struct Cases<'a> {
    scene: &'a Scene,
    step: f64,
    next: usize,
    ended: usize,
}

impl<'a, R: Real> Crew<'a, R> for Cases<'a> {
    type Drive = Shake;

    fn next(&mut self, _lane: usize) -> Option<Case<'a, Shake>> {
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
        assert!(end.finish.is_ok(), "a case breaks down");
        self.ended += 1;
    }
}
