//! Figures that compare observed collapses with simulations, which are weighted by the posterior.

use barrelstack_report::{Axis, Figure, Plot, Series};

use super::ensemble::Course;
use super::observed::Time;
use super::sampler::Posterior;
use super::{PreparedTest, alike};
use crate::figures::measured;

/// Quantiles that a bar connects: the bar shows the central 90 % of the simulated times, weighted by the posterior.
const MIDDLE: [f64; 2] = [0.05, 0.95];

/// Plots the posterior weight of the observed modes, and the times of the observed events.
pub(super) fn pictures(
    tests: &[PreparedTest<'_>],
    courses: &[Option<Course>],
    posterior: &Posterior,
) -> Vec<Figure> {
    [modes(tests, courses, posterior), times(tests, courses, posterior)]
        .into_iter()
        .flatten()
        .collect()
}

/// Returns the simulated courses of the test with the index `at`. `courses` holds, for each draw of the parameters in
/// turn, one course per test.
fn of<'a>(
    courses: &'a [Option<Course>],
    at: usize,
    tests: &[PreparedTest<'_>],
) -> impl Iterator<Item = &'a Option<Course>> {
    courses.iter().skip(at).step_by(tests.len())
}

/// Plots, for each test, the posterior weight of the simulations with the observed mode; `None` if no mode was
/// observed.
fn modes(
    tests: &[PreparedTest<'_>],
    courses: &[Option<Course>],
    posterior: &Posterior,
) -> Option<Figure> {
    let mut rows = Rows::default();
    for (at, test) in tests.iter().enumerate() {
        let (name, share) = alike(test, of(courses, at, tests), posterior);
        if let Some(share) = share {
            rows.bar(format!("test {}: {name}", at + 1), [0.0, share]);
        }
    }
    let caption =
        "Posterior weight of the simulations that reproduce the observed mode of each test.";
    let x = Axis { range: Some([0.0, 1.0]), ..Axis::new("share of the weight", "") };
    rows.figure("collapse-modes", caption, x, None)
}

/// Plots the observed and simulated times of events; `None` if no time was observed.
fn times(
    tests: &[PreparedTest<'_>],
    courses: &[Option<Course>],
    posterior: &Posterior,
) -> Option<Figure> {
    let mut rows = Rows::default();
    let mut observed = Vec::new();
    for (at, test) in tests.iter().enumerate() {
        let test = test.observed;
        let loss = |course: &Course| Some(course.loss);
        let first = |course: &Course| course.first_fall().map(|(_, time)| Time::At(time));
        let mut row = |name: &str, time: Time, simulated: &dyn Fn(&Course) -> Option<Time>| {
            let Time::At(time) = time else { return };
            let weighed = of(courses, at, tests).zip(&posterior.weights);
            let weighed = weighed.filter_map(|(course, weight)| {
                let Some(Time::At(time)) = simulated(course.as_ref()?) else { return None };
                Some((time, *weight))
            });
            rows.bar(format!("test {}: {name}", at + 1), middle(weighed.collect()));
            observed.push(time);
        };
        if let Some(time) = test.loss {
            row("loss of a seat", time, &loss);
        }
        if let Some(time) = test.first_fall {
            row("first fall", time, &first);
        }
        for (barrel, time) in &test.falls {
            row(&format!("{barrel} fell"), *time, &|course| course.fall(barrel));
        }
    }
    let caption = "Observed times of the events. Bars show the simulated times: the central 90 % of the posterior \
                   weight of the simulations in which the event happens. A row has no bar if the event happens in \
                   none of these simulations.";
    rows.figure("collapse-times", caption, Axis::new("time", "s"), Some(observed))
}

/// Returns the quantiles [`MIDDLE`] of weighted values; NaN if all weights are zero.
pub(crate) fn middle(mut weighed: Vec<(f64, f64)>) -> [f64; 2] {
    weighed.sort_by(|one, other| one.0.total_cmp(&other.0));
    let all: f64 = weighed.iter().map(|(_, weight)| weight).sum();
    MIDDLE.map(|share| {
        let mut sum = 0.0;
        let reached = |(_, weight): &&(f64, f64)| {
            sum += weight;
            sum >= share * all
        };
        weighed.iter().find(reached).map_or(f64::NAN, |(time, _)| *time)
    })
}

/// Rows of a figure, each with a name and a bar.
#[derive(Default)]
pub(crate) struct Rows {
    names: Vec<String>,
    bars: Vec<[f64; 2]>,
}

impl Rows {
    pub(crate) fn bar(&mut self, name: String, bar: [f64; 2]) {
        self.bars.push(bar);
        self.names.push(name);
    }

    /// Plots the rows, with the observed value of each row if `observed` is given; `None` if there are no rows.
    pub(crate) fn figure(
        self,
        id: &str,
        caption: &str,
        x: Axis,
        observed: Option<Vec<f64>>,
    ) -> Option<Figure> {
        let rows = (0..self.names.len()).map(Axis::row).collect();
        let bars = Series::bars("simulated", self.bars.into_iter().enumerate());
        let observed = observed.map(|times| measured("observed", times, rows, 1));
        let plot = Plot {
            x,
            y: Axis::named(self.names),
            series: std::iter::once(bars).chain(observed).collect(),
            ..Plot::default()
        };
        (!plot.y.names.is_empty()).then(|| Figure::new(id, caption, plot))
    }
}
