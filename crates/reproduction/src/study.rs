//! Sensitivity study of a case: changes one quantity at a time, down and up.

use barrelstack::scenario::{Scenario, StackSpec};
use barrelstack::summary::Summary;

use super::pool::Job;
use super::vary::{self, brief, with};

/// The case of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Subject {
    /// Six barrels under a record.
    Six,
    /// Eight barrels under the sine.
    Eight,
    /// A stack of four levels in the longitudinal plane, along the barrel axes, under the sine.
    Along,
}

impl Subject {
    /// Returns the name of the case in captions.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Six => "six barrels",
            Self::Eight => "eight barrels",
            Self::Along => "four levels along the barrels",
        }
    }

    /// Returns the name, for captions, of the event whose time is compared with the paper's time.
    pub(super) fn clock(self) -> &'static str {
        match self {
            Self::Six | Self::Along => "first loss of a seat",
            Self::Eight => "first fall",
        }
    }

    /// Returns the time (s) of the event that [`Subject::clock`] names; `None` if the event does not occur in the run.
    pub(super) fn time(self, summary: &Summary) -> Option<f64> {
        match self {
            Self::Six | Self::Along => summary.outcome.time,
            Self::Eight => summary.outcome.first_fall,
        }
    }

    /// Returns the maximum duration (s) of a run, and the time (s) for which the run continues after the collapse. If
    /// [`Subject::time`] is the time of the first fall, the time after the collapse must be long enough to include
    /// this fall.
    fn duration(self) -> (f64, f64) {
        match self {
            Self::Six => (20.0, 0.1),
            Self::Eight => (12.0, 1.6),
            Self::Along => (10.0, 0.1),
        }
    }
}

/// A quantity that the study changes, and its changes.
pub(super) struct Factor<Run = Scenario> {
    /// Description of the quantity, in most cases with its value in the unchanged case, such as "cradle supports at
    /// ±28°".
    pub(super) name: String,
    /// Name of each change, with its scenario or, after the runs, with its [`Summary`].
    pub(super) ends: Vec<(String, Run)>,
}

/// A factor with the results of its runs.
pub(super) type Effect = Factor<Summary>;

/// A case, and the effects of all factors on it.
pub(super) struct Study {
    /// The case.
    pub(super) subject: Subject,
    /// Result of the case without any change.
    pub(super) base: Summary,
    /// Effects of all factors, sorted by their largest effect on the compared time ([`Subject::time`]), the largest
    /// first.
    pub(super) effects: Vec<Effect>,
}

/// The two changes of a quantity, each with its name.
type Ends<'a> = [(&'a str, &'a dyn Fn(&mut StackSpec)); 2];

/// Returns the factors that the study of a case changes.
pub(super) fn factors(subject: Subject, base: &Scenario) -> Vec<Factor> {
    let (duration, after) = subject.duration();
    let mut base = brief(base, after);
    base.run.duration = Some(duration);
    let base = &base;
    let Some(stack) = base.stack() else { return Vec::new() };
    let rack = &stack.rack;

    let mut list = Vec::new();
    let mut change = |name: String, ends: Ends<'_>| {
        let ends = ends.map(|(label, change)| (label.to_owned(), with(base, change)));
        list.push(Factor { name, ends: ends.into() });
    };
    let centimeters = |value: f64| barrelstack_report::significant(100.0 * value, 3);
    let share =
        |change: fn(&mut StackSpec, f64), by: f64| move |stack: &mut StackSpec| change(stack, by);
    let percent = |list: &mut dyn FnMut(String, Ends<'_>), name: &str, f| {
        list(name.to_owned(), [("−10 %", &share(f, 0.9)), ("+10 %", &share(f, 1.1))]);
    };

    if subject == Subject::Along {
        change(
            format!("rails at ±{} cm", centimeters(rack.rail_half_spacing)),
            [
                ("−2 cm", &|s| s.rack.rail_half_spacing -= 0.02),
                ("+2 cm", &|s| s.rack.rail_half_spacing += 0.02),
            ],
        );
        change(
            format!("rails {} cm wide", centimeters(rack.rail_width)),
            [("−1 cm", &|s| s.rack.rail_width -= 0.01), ("+1 cm", &|s| s.rack.rail_width += 0.01)],
        );
    } else {
        let angle = match rack.cradle {
            barrelstack::scenario::Cradle::Supports { angle } => angle.to_degrees(),
            barrelstack::scenario::Cradle::Arc { half_angle, .. } => half_angle.to_degrees(),
        };
        change(
            format!("cradle supports at ±{}°", barrelstack_report::significant(angle, 3)),
            [
                ("−3°", &|s| vary::cradle_angle(s, -3_f64.to_radians())),
                ("+3°", &|s| vary::cradle_angle(s, 3_f64.to_radians())),
            ],
        );
        change(
            format!("feet ±{} cm", centimeters(rack.foot_half_length)),
            [
                ("−1 cm", &|s| s.rack.foot_half_length -= 0.01),
                ("+1 cm", &|s| s.rack.foot_half_length += 0.01),
            ],
        );
    }
    change(
        format!("nodes every {} cm", centimeters(rack.node_spacing)),
        [("half", &|s| s.rack.node_spacing *= 0.5), ("double", &|s| s.rack.node_spacing *= 2.0)],
    );
    change(
        format!("rack {} kg", barrelstack_report::significant(rack.mass, 3)),
        [("−10 kg", &|s| s.rack.mass -= 10.0), ("+10 kg", &|s| s.rack.mass += 10.0)],
    );
    change(
        "tangential stiffness 1 × normal".to_owned(),
        [
            ("half", &|s| vary::stick_stiffness(s, 0.5)),
            ("double", &|s| vary::stick_stiffness(s, 2.0)),
        ],
    );
    percent(&mut change, "k", vary::stiffness);
    percent(&mut change, "c", vary::damping);
    percent(&mut change, "μ barrel–rack", vary::barrel_rack_friction);
    percent(&mut change, "μ rack–ground", vary::rack_ground_friction);
    list.push(Factor {
        name: "wine turns with the wood".into(),
        ends: vec![("wine at rest".into(), with(base, vary::fluid))],
    });
    if subject != Subject::Six {
        list.push(Factor {
            name: "sine at full amplitude at once".into(),
            ends: [("grows for 0.5 cycle", 0.5), ("grows for 1 cycle", 1.0)]
                .map(|(label, cycles)| (label.to_owned(), vary::ramped(base, cycles)))
                .into(),
        });
    }
    list
}

/// Returns one run for each change of each factor, in order.
pub(super) fn jobs(subject: Subject, factors: &[Factor]) -> impl Iterator<Item = Job> {
    factors.iter().flat_map(move |factor| {
        factor.ends.iter().map(move |(label, scenario)| {
            let label = format!("{}, {}: {label}", subject.name(), factor.name);
            Job::brief(label, scenario.clone())
        })
    })
}

impl Study {
    /// Combines factors with the summaries of their runs, which `next` returns in the order of the jobs.
    pub(super) fn new(
        subject: Subject,
        base: Summary,
        factors: Vec<Factor>,
        next: &mut dyn Iterator<Item = Summary>,
    ) -> Self {
        let mut effects: Vec<Effect> = factors
            .into_iter()
            .map(|factor| Effect {
                name: factor.name,
                ends: factor.ends.into_iter().map(|(label, _)| label).zip(&mut *next).collect(),
            })
            .collect();
        let weight = |effect: &Effect| {
            let from = subject.time(&base).unwrap_or(0.0);
            // A change that prevents collapse has the largest possible effect.
            let changes = effect.ends.iter().map(|(_, summary)| {
                subject.time(summary).map_or(f64::INFINITY, |time| (time - from).abs())
            });
            changes.fold(0.0, f64::max)
        };
        effects.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
        Self { subject, base, effects }
    }

    /// Returns descriptions of all changes, with their results.
    fn changes(&self) -> impl Iterator<Item = (String, &Summary)> {
        self.effects.iter().flat_map(|Effect { name, ends }| {
            ends.iter().map(move |(label, summary)| (format!("{name} ({label})"), summary))
        })
    }

    /// Returns the smallest and the largest compared time ([`Subject::time`], s) over the unchanged case and all
    /// changes. Runs without this time are left out; `None` if no run has it.
    pub(super) fn times(&self) -> Option<[f64; 2]> {
        let all = || self.changes().map(|(_, summary)| summary).chain([&self.base]);
        let times = || all().filter_map(|summary| self.subject.time(summary));
        Some([times().reduce(f64::min)?, times().reduce(f64::max)?])
    }

    /// Returns descriptions of the changes that bring a quantity to the published value or beyond it.
    pub(super) fn reaching(
        &self,
        published: f64,
        of: impl Fn(&Summary) -> Option<f64>,
    ) -> Vec<String> {
        let Some(ours) = of(&self.base) else { return Vec::new() };
        let crosses = |value: f64| (value - published) * (ours - published) <= 0.0;
        self.holding(|summary| of(summary).is_some_and(crosses))
    }

    /// Returns descriptions of the changes for which a condition holds.
    pub(super) fn holding(&self, what: impl Fn(&Summary) -> bool) -> Vec<String> {
        self.changes().filter(|(_, summary)| what(summary)).map(|(change, _)| change).collect()
    }

    /// Returns a description of the change that brings a quantity nearest to a published value, and
    /// the resulting value of the quantity.
    pub(super) fn nearest(
        &self,
        published: f64,
        of: impl Fn(&Summary) -> Option<f64>,
    ) -> Option<(String, f64)> {
        let known = self.changes().filter_map(|(change, summary)| Some((change, of(summary)?)));
        let off = |(_, value): &(String, f64)| (value - published).abs();
        known.min_by(|one, other| off(one).total_cmp(&off(other)))
    }

    /// Returns descriptions of the `count` changes with the largest effect on a quantity, each with the resulting
    /// value of the quantity; fewer if there are fewer changes.
    pub(super) fn strongest(
        &self,
        count: usize,
        of: impl Fn(&Summary) -> Option<f64>,
        shown: impl Fn(f64) -> String,
    ) -> Vec<String> {
        let Some(ours) = of(&self.base) else { return Vec::new() };
        let known = self.changes().filter_map(|(change, summary)| Some((change, of(summary)?)));
        let mut found: Vec<(String, f64)> = known.collect();
        let moved = |(_, value): &(String, f64)| (value - ours).abs();
        found.sort_by(|one, other| moved(other).total_cmp(&moved(one)));
        found.truncate(count);
        found.into_iter().map(|(change, value)| format!("{change}: {}", shown(value))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Subject, factors};
    use barrelstack::scenario::Scenario;

    #[test]
    fn every_change_makes_another_scenario_that_can_be_built() {
        let cases = [
            (Subject::Six, "candia-6-barrels"),
            (Subject::Eight, "candia-8-barrels"),
            (Subject::Along, "candia-8-barrels-longitudinal"),
        ];
        for (subject, name) in cases {
            let base = Scenario::builtin(name, &[]).unwrap();
            let mut prints = Vec::new();
            for factor in factors(subject, &base) {
                for (label, scenario) in factor.ends {
                    let print = scenario.fingerprint();
                    assert!(
                        !prints.contains(&print),
                        "{name}, {}: {label} changes nothing",
                        factor.name
                    );
                    prints.push(print);
                    barrelstack::assemble::assemble(&scenario).unwrap_or_else(|error| {
                        panic!("{name}, {}: {label}: {error}", factor.name)
                    });
                }
            }
            // Ten quantities, and the start of the sine if there is a sine; the fill has only one changed value.
            assert_eq!(prints.len(), if subject == Subject::Six { 19 } else { 21 });
        }
    }
}
