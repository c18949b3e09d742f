//! How much arithmetic a step takes, and how much of the machine's peak that is.

use barrelstack_dynamics::lanes::{Case, Crew, End, Task, Width, march};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{Method, Planar, Scratch, State};
use barrelstack_validation::counting::Work;
use barrelstack_validation::drive::Shake;

use crate::scene::Scene;
use crate::time;

/// Prints the operations of a step, and the share of the machine's peak that lanes reach.
pub(crate) fn per_step(scene: &Scene, method: Method, step: f64) {
    let end_time = 1.0;
    let Work { steps, touching, operations } = Work::of(method, case(scene, step, end_time));
    let steps = steps as f64;
    let [plain, divisions, choices] = [operations.plain, operations.divisions, operations.choices]
        .map(|count| count as f64 / steps);
    println!("arithmetic of a step of one stack, counted over {steps} steps");
    println!("  contacts that touch            {:10.1}", touching as f64 / steps);
    println!("  additions and multiplications  {plain:10.0}");
    println!("  divisions and square roots     {divisions:10.0}");
    println!("  comparisons, choices, signs    {choices:10.0}");
    println!("  lanes     peak, 10⁹ additions and multiplications a second   a step reaches of it");
    for width in Width::ALL.into_iter().filter(|width| width.is_here()) {
        let Some((operations, spent)) = width.run(Peak) else { continue };
        let peak = operations / spent;
        let marching = Many { scene, step, end_time };
        let spent = time::least(|| {
            width.run(Marching(&marching));
        });
        let reached = plain * steps * MANY as f64 / spent;
        println!("  {:8} {:30.1} {:40.0} %", width.name(), 1e-9 * peak, 100.0 * reached / peak);
    }
}

/// Independent additions and multiplications in registers.
struct Peak;

impl Task for Peak {
    type Output = (f64, f64);

    fn run<R: Real>(self) -> (f64, f64) {
        const ROUNDS: usize = 4_000_000;
        let mut sums = [R::splat(1.0); 12];
        let (factor, step) = (R::splat(0.999_999), R::splat(1e-9));
        let spent = time::least(|| {
            R::scope(
                #[inline(always)]
                || {
                    for _ in 0..ROUNDS {
                        for sum in &mut sums {
                            *sum = *sum * factor + step;
                        }
                    }
                },
            );
        });
        std::hint::black_box(&sums);
        ((ROUNDS * sums.len() * 2 * R::LANES) as f64, spent)
    }
}

/// Cases in lanes when the peak is compared.
const MANY: usize = 64;

struct Many<'a> {
    scene: &'a Scene,
    step: f64,
    end_time: f64,
}

struct Marching<'a>(&'a Many<'a>);

impl Task for Marching<'_> {
    type Output = ();

    fn run<R: Real>(self) {
        let Many { scene, step, end_time } = *self.0;
        let mut crew = Repeated { scene, step, end_time, left: MANY };
        march::<R, _>(Method::VelocityVerlet, &mut crew);
    }
}

struct Repeated<'a> {
    scene: &'a Scene,
    step: f64,
    end_time: f64,
    left: usize,
}

impl<'a, R: Real> Crew<'a, R> for Repeated<'a> {
    type Drive = Shake;

    fn next(&mut self, _: usize) -> Option<Case<'a, Shake>> {
        self.left = self.left.checked_sub(1)?;
        Some(case(self.scene, self.step, self.end_time))
    }
    fn start(&mut self, _: usize, _: &State<Planar>, _: &Scratch<Planar>) {}
    fn observe(&mut self, _: &State<Planar<R>>, _: &Scratch<Planar<R>>) -> R::Mask {
        R::Mask::default()
    }
    fn end(&mut self, _: usize, _: End) {}
}

fn case(scene: &Scene, time_step: f64, end_time: f64) -> Case<'_, Shake> {
    let drive = Scene::ground(1.0);
    Case { model: &scene.model, state: scene.rest.clone(), drive, time_step, end_time }
}
