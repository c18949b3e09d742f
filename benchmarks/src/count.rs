//! Number of arithmetic operations in a step, their rate as a share of the peak rate of the
//! machine, and the memory that the lanes use.

use barrelstack_dynamics::lanes::{Batch, Case, End, Task, Width, run_batch};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{Method, Planar, Scratch, State};
use barrelstack_validation::counting::Work;
use barrelstack_validation::drive::Shake;

use crate::scene::Scene;
use crate::{memory, time};

/// Prints the number of operations in a step and, for every width of the lanes, their rate as a
/// share of the peak rate.
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
    let clock = time::clock();
    println!(
        "  peak: independent additions and multiplications in registers; a core with two vector ports starts \
         two per cycle, at {:.2} GHz",
        1e-9 * clock
    );
    println!(
        "  lanes     peak, 10⁹/s   numbers per cycle, of possible      a step reaches   KB held   instructions \
         per step and case"
    );
    for width in Width::ALL.into_iter().filter(|width| width.is_here()) {
        // With AVX2 a bundle takes two of the sixteen registers, so six sums fit beside the two constants.
        let (peak, ports) = match width {
            Width::Scalar => (width.run(Peak::<12>), 2.0),
            Width::Avx2 => (width.run(Peak::<6>), 8.0),
            Width::Avx512 => (width.run(Peak::<12>), 16.0),
        };
        let Some(peak) = peak else { continue };
        let marched = || width.run(Many { scene, step, end_time });
        let spent = time::least(|| {
            marched();
        });
        let held = marched().unwrap_or_default();
        let instructions = time::instructions(|| {
            marched();
        });
        let instructions = instructions.map_or("not counted".to_owned(), |count| {
            format!("{:.0}", count as f64 / (steps * MANY as f64))
        });
        let reached = plain * steps * MANY as f64 / spent;
        println!(
            "  {:8} {:12.1} {:17.1} of {ports:2} {:28.0} % {:9.0}   {instructions}",
            width.name(),
            1e-9 * peak,
            peak / clock,
            100.0 * reached / peak,
            1e-3 * held as f64
        );
    }
    if time::instructions(|| {}).is_none() {
        println!(
            "  (this machine or its operating system does not let programs count instructions)"
        );
    }
}

/// Measures the number of additions and multiplications per second for `COUNT` independent bundles
/// in registers.
struct Peak<const COUNT: usize>;

impl<const COUNT: usize> Task for Peak<COUNT> {
    type Output = f64;

    fn run<R: Real>(self) -> f64 {
        const ROUNDS: usize = 4_000_000;
        let (factor, step) = (R::splat(0.999_999), R::splat(1e-9));
        let spent = time::least(|| {
            R::scope(
                #[inline(always)]
                || {
                    let mut sums = [R::splat(1.0); COUNT];
                    for _ in 0..ROUNDS {
                        for sum in &mut sums {
                            *sum = *sum * factor + step;
                        }
                    }
                    // Only the total is passed to `black_box`: an array would be stored to memory in every round.
                    let mut all = R::zero();
                    for sum in sums {
                        all += sum;
                    }
                    std::hint::black_box(all);
                },
            );
        });
        (ROUNDS * COUNT * 2 * R::LANES) as f64 / spent
    }
}

/// Number of cases that run in lanes.
const MANY: usize = 64;

struct Many<'a> {
    scene: &'a Scene,
    step: f64,
    end_time: f64,
}

impl Task for Many<'_> {
    /// Number of bytes that all lanes together use.
    type Output = usize;

    fn run<R: Real>(self) -> usize {
        let Self { scene, step, end_time } = self;
        let before = memory::in_use();
        let mut batch = Repeated { scene, step, end_time, left: MANY, before, held: 0 };
        run_batch::<Planar<R>, _>(Method::VelocityVerlet, &mut batch);
        batch.held
    }
}

struct Repeated<'a> {
    scene: &'a Scene,
    step: f64,
    end_time: f64,
    left: usize,
    before: usize,
    held: usize,
}

impl<'a, R: Real> Batch<'a, Planar<R>> for Repeated<'a> {
    type Drive = Shake;

    fn next(&mut self, _: usize) -> Option<Case<'a, Planar, Shake>> {
        self.left = self.left.checked_sub(1)?;
        Some(case(self.scene, self.step, self.end_time))
    }
    fn start(&mut self, _: usize, _: &State<Planar>, _: &Scratch<Planar>) {}
    fn observe(&mut self, _: &State<Planar<R>>, _: &Scratch<Planar<R>>) -> R::Mask {
        if self.held == 0 {
            self.held = memory::in_use().saturating_sub(self.before);
        }
        R::Mask::default()
    }
    fn end(&mut self, _: usize, _: End) {}
}

fn case(scene: &Scene, time_step: f64, end_time: f64) -> Case<'_, Planar, Shake> {
    let drive = Scene::ground(1.0);
    Case { model: &scene.model, state: scene.rest.clone(), drive, time_step, end_time }
}
