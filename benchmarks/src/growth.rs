//! The cost of a step against the size of the stack: it must grow with the contacts, and no faster.

use barrelstack::Scenario;
use barrelstack::assemble::assemble;
use barrelstack::ground::Ground;
use barrelstack::step::default_step;
use barrelstack_dynamics::lanes::{Case, Crew, End, Task, Width, march};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{Method, Model, Planar, Scratch, State, settle};

use crate::{Failure, time};

/// The stack still stands then (s).
const STANDING: f64 = 0.5;

/// Cases side by side.
const CASES: usize = 32;

/// Prints the cost against levels and against columns, alone and in lanes.
pub(crate) fn with_size() -> Result<(), Failure> {
    println!("a step of the standing paper stack against its size");
    println!(
        "  levels  columns  bodies  touching contacts   ns a contact alone   in {} lanes",
        Width::widest().name()
    );
    for (levels, columns) in [(2, 2), (4, 2), (6, 2), (8, 2), (4, 4), (4, 8), (4, 16)] {
        let stage = Stage::new(levels, columns)?;
        let steps = STANDING / stage.step;
        let touching = stage.touching(steps);
        let spent = |width: Width, cases: usize| {
            let spent = time::least(|| {
                width.run(Marching { stage: &stage, cases });
            });
            1e9 * spent / (cases as f64 * steps * touching)
        };
        println!(
            "  {levels:6} {columns:8} {:7} {touching:18.1} {:20.1} {:12.1}",
            stage.model.bodies().len() - 1,
            spent(Width::Scalar, 1),
            spent(Width::widest(), CASES)
        );
    }
    Ok(())
}

struct Stage {
    model: Model<Planar>,
    rest: State<Planar>,
    ground: Ground,
    step: f64,
}

impl Stage {
    fn new(levels: u32, columns: u32) -> Result<Self, Failure> {
        let settings = [format!("stack.levels={levels}"), format!("stack.columns={columns}")];
        let scenario = Scenario::builtin("candia-8-barrels", &settings)?;
        let assembly = assemble(&scenario)?;
        let step = default_step(&assembly, 1.0);
        let mut rest = State::initial(&assembly.model);
        settle(&assembly.model, &mut rest, &mut Scratch::new(&assembly.model), 1e-9)?;
        Ok(Self { model: assembly.model, rest, ground: scenario.ground()?, step })
    }

    /// Contacts that touch in a step, in the mean.
    fn touching(&self, steps: f64) -> f64 {
        let mut crew = Cases { stage: self, left: 1, touched: 0 };
        march::<f64, _>(Method::VelocityVerlet, &mut crew);
        crew.touched as f64 / steps
    }
}

struct Marching<'a> {
    stage: &'a Stage,
    cases: usize,
}

impl Task for Marching<'_> {
    type Output = ();

    fn run<R: Real>(self) {
        let mut crew = Cases { stage: self.stage, left: self.cases, touched: 0 };
        march::<R, _>(Method::VelocityVerlet, &mut crew);
    }
}

struct Cases<'a> {
    stage: &'a Stage,
    left: usize,
    touched: usize,
}

impl<'a, R: Real> Crew<'a, R> for Cases<'a> {
    type Drive = &'a Ground;

    fn next(&mut self, _: usize) -> Option<Case<'a, &'a Ground>> {
        self.left = self.left.checked_sub(1)?;
        let Stage { model, rest, ground, step } = self.stage;
        Some(Case {
            model,
            state: rest.clone(),
            drive: ground,
            time_step: *step,
            end_time: STANDING,
        })
    }
    fn start(&mut self, _: usize, _: &State<Planar>, _: &Scratch<Planar>) {}
    fn observe(&mut self, _: &State<Planar<R>>, scratch: &Scratch<Planar<R>>) -> R::Mask {
        self.touched += scratch.touching();
        R::Mask::default()
    }
    fn end(&mut self, _: usize, _: End) {}
}
