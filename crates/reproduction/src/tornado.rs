//! A study as a tornado plot and a table: the effect of each change on time, drift and stress.

use barrelstack::summary::Summary;
use barrelstack_report::{Axis, Block, Cell, Figure, Mark, Plot, Series, SeriesStyle, Table};

use super::study::{Study, Subject};

/// Vertical offsets, within a row, of the bars of the three quantities, as fractions of the row spacing.
const PLACES: [f64; 3] = [0.26, 0.0, -0.26];

/// Builds the plot and the table of a study. `published` contains the paper's values of the compared time (s),
/// the drift ratio of the top and the stress amplification.
pub(super) fn blocks(study: &Study, id: &str, published: [Option<f64>; 3]) -> Vec<Block> {
    vec![Block::Figure(figure(study, id, published)), Block::Table(table(study))]
}

/// Returns the compared time ([`Subject::time`], s), the drift ratio of the top and the stress amplification of a run;
/// `None` for a value that is not in the summary.
fn values(subject: Subject, summary: &Summary) -> [Option<f64>; 3] {
    [subject.time(summary), summary.demands.top_drift_ratio, summary.demands.stress_amplification]
}

fn figure(study: &Study, id: &str, published: [Option<f64>; 3]) -> Figure {
    let subject = study.subject;
    let base = values(subject, &study.base);
    let change = |quantity: usize, summary: &Summary| -> Option<f64> {
        Some(100.0 * (values(subject, summary)[quantity]? / base[quantity]? - 1.0))
    };
    let mut series: Vec<Series> = [subject.clock(), "drift of the top", "stress amplification"]
        .into_iter()
        .enumerate()
        .map(|(quantity, label)| Series {
            style: SeriesStyle {
                dots: true,
                bar: true,
                index: Some(quantity),
                ..SeriesStyle::default()
            },
            ..Series::new(label, Vec::new(), Vec::new())
        })
        .collect();
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for (row, effect) in study.effects.iter().enumerate() {
        for (quantity, line) in series.iter_mut().enumerate() {
            let y = Axis::row(row) + PLACES[quantity];
            for x in effect.ends.iter().filter_map(|(_, summary)| change(quantity, summary)) {
                (low, high) = (low.min(x), high.max(x));
                // Every bar starts at zero, the value of the case as stated. The NaN ends the bar, so that it is not
                // joined to the next.
                for (x, y) in [(0.0, y), (x, y), (f64::NAN, y)] {
                    line.x.push(x);
                    line.y.push(y);
                }
            }
        }
    }
    let marks = published.iter().zip(base).zip(["time", "drift", "stress"]).filter_map(
        |((published, base), label)| {
            let at = 100.0 * ((*published)? / base? - 1.0);
            (low.min(-30.0)..=high.max(30.0))
                .contains(&at)
                .then(|| Mark { at, label: format!("paper’s {label}") })
        },
    );
    let marks: Vec<Mark> = marks.collect();
    for mark in &marks {
        (low, high) = (low.min(mark.at), high.max(mark.at));
    }
    let span = (high - low).max(1.0);
    let range = [low - 0.05 * span, high + 0.05 * span];
    let names = study.effects.iter().map(|effect| effect.name.clone()).collect();
    let caption = format!(
        "Effects of single quantities, {}: change from the case as stated when one quantity is changed; \
         the quantity with the largest effect on the {} is on top. The table below states the changes. Vertical lines \
         mark the published values.",
        subject.name(),
        subject.clock()
    );
    let x = Axis { range: Some(range), ..Axis::new("change", "%") };
    Figure::new(id, caption, Plot { x, y: Axis::named(names), series, marks, ..Plot::default() })
}

fn table(study: &Study) -> Table {
    let subject = study.subject;
    let caption = format!(
        "The {} with one quantity changed at a time. The time is that of the {}.",
        subject.name(),
        subject.clock()
    );
    let changed = study.effects.iter().flat_map(|effect| {
        effect.ends.iter().enumerate().map(|(at, (label, summary))| {
            (if at == 0 { effect.name.as_str() } else { "" }, label.as_str(), summary)
        })
    });
    let [time, drift, stress] =
        [0, 1, 2].map(|quantity| move |summary: &Summary| values(subject, summary)[quantity]);
    Table::of(
        caption,
        std::iter::once(("as stated", "", &study.base)).chain(changed),
        &[
            ("quantity", "", &|(name, ..)| Cell::text(*name)),
            ("changed", "", &|(_, label, _)| Cell::text(*label)),
            ("outcome", "", &|(.., m)| Cell::text(m.outcome.mode.unwrap_or(m.outcome.kind))),
            ("first", "", &|(.., m)| Cell::maybe(m.outcome.first.as_ref())),
            ("time", "s", &|(.., m)| Cell::number(time(m), 3)),
            ("drift", "%", &|(.., m)| Cell::number(drift(m).map(|d| 100.0 * d), 3)),
            ("largest stress", "× at rest", &|(.., m)| Cell::number(stress(m), 3)),
        ],
    )
}
