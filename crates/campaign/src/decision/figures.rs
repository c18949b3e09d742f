//! Figures of the report page of a study.

use std::collections::BTreeMap;

use barrelstack_fragility::{Ida, Interval, Returned, Stripe};
use barrelstack_report::{Axis, Figure, Mark, Plot, Series, SeriesStyle};

use super::cases::{Cases, Measure};
use super::curve::LimitCurve;
use super::hazard::Site;
use super::loss::Losses;
use super::modes::ModeIncidence;
use super::sensitivity::{Effect, Group};

fn style(index: usize) -> SeriesStyle {
    SeriesStyle { index: Some(index), ..SeriesStyle::default() }
}

fn muted() -> SeriesStyle {
    SeriesStyle { muted: true, ..SeriesStyle::default() }
}

/// Returns a series of single values with error bars.
pub(crate) fn points(
    label: &str,
    x: &[f64],
    y: impl Iterator<Item = f64>,
    bounds: impl Iterator<Item = Interval>,
    index: usize,
) -> Series {
    let style = SeriesStyle { points: true, ..style(index) };
    let range = bounds.map(|bounds| [bounds.low, bounds.high]).collect();
    Series { range, style, ..Series::new(label, x.to_vec(), y.collect()) }
}

fn axis(measure: &Measure) -> Axis {
    Axis::new(&measure.label, measure.shown_unit)
}

/// Returns a vertical axis for a probability from 0 to 1.
pub(crate) fn chance_axis(label: &str) -> Axis {
    Axis { range: Some([0.0, 1.0]), ..Axis::new(label, "") }
}

/// Returns the fitted curve of a limit state, if there is one; intensities are multiplied by `scale`.
pub(crate) fn fitted(curve: &LimitCurve, scale: f64, label: &str) -> Option<Series> {
    let fit = curve.fit.as_ref().ok()?;
    let (x, y) = curve.grid.iter().map(|x| (scale * x, fit.curve.probability(*x))).unzip();
    Some(Series::new(label, x, y))
}

/// Returns the raw fractions of a limit state with their intervals; intensities are multiplied by `scale`.
pub(crate) fn raw(curve: &LimitCurve, scale: f64, label: &str, index: usize) -> Series {
    let x: Vec<f64> = curve.stripes.iter().map(|stripe| scale * stripe.intensity).collect();
    points(
        label,
        &x,
        curve.stripes.iter().map(Stripe::fraction),
        curve.intervals.iter().copied(),
        index,
    )
}

/// Plots the raw fractions with their intervals, and the fitted curve with its confidence band.
pub(super) fn fragility(curve: &LimitCurve, measure: &Measure) -> Figure {
    let range: Vec<[f64; 2]> = curve.band.iter().map(|band| [band.low, band.high]).collect();
    let label = if range.is_empty() { "fitted curve" } else { "fitted curve, 95 % band" };
    let line = fitted(curve, measure.scale, label);
    let line = line.map(|line| Series { range, style: style(0), ..line });
    let dots = raw(curve, measure.scale, "raw fractions with 95 % intervals", 1);
    let series = line.into_iter().chain([dots]).collect();
    let caption = format!(
        "Chance of the limit state \"{}\" as a function of {}. Dots: the share of cases that fail at each level or \
         in each bin, not smoothed, with Wilson's interval.{}",
        curve.limit.words(),
        measure.label,
        if curve.fit.is_ok() {
            " Line: the lognormal curve fitted by maximum likelihood; shaded: its 95 % band."
        } else {
            ""
        }
    );
    Figure::new(
        "fragility",
        caption,
        Plot { x: axis(measure), y: chance_axis("chance of failure"), series, ..Plot::default() },
    )
}

/// Plots the fitted curve or the raw fractions of each limit state.
pub(super) fn limits(curves: &[LimitCurve], measure: &Measure) -> Figure {
    let series_of = |(index, curve): (usize, &LimitCurve)| {
        let words = curve.limit.words();
        let style = style(index);
        fitted(curve, measure.scale, &words).map_or_else(
            || raw(curve, measure.scale, &format!("{words} (raw)"), index),
            |line| Series { style, ..line },
        )
    };
    let series = curves.iter().enumerate().map(series_of).collect();
    Figure::new(
        "limit-states",
        "Chance of each limit state. Lines are fitted curves; where no curve can be fitted to the cases, dots show the \
         raw fractions with their 95 % intervals.",
        Plot { x: axis(measure), y: chance_axis("chance"), series, ..Plot::default() },
    )
}

/// Plots the cumulative incidence of each mode, and the fragility curve of collapse in any mode.
pub(super) fn modes(modes: &[ModeIncidence], collapse: &LimitCurve, measure: &Measure) -> Figure {
    let grid = || collapse.grid.iter().map(|x| measure.shown(*x)).collect::<Vec<f64>>();
    let mut series = Vec::new();
    for (index, mode) in modes.iter().enumerate() {
        let name = mode.mode.replace('-', " ");
        let at: Vec<f64> = mode.stripes.iter().map(|s| measure.shown(s.intensity)).collect();
        let raw = mode.stripes.iter().map(Stripe::fraction);
        series.push(points(&format!("{name} (raw)"), &at, raw, std::iter::empty(), index + 1));
        if !mode.fitted.is_empty() {
            let line = Series::new(name, grid(), mode.fitted.clone());
            series.push(Series { style: style(index + 1), ..line });
        }
    }
    let line = fitted(collapse, measure.scale, "all modes");
    series.extend(line.map(|line| Series { style: style(0), ..line }));
    Figure::new(
        "modes",
        "Chance of collapse in each mode (cumulative incidence). The modes compete: their chances add up to the chance \
         of collapse, and one mode may become rarer where another becomes more frequent. The part of \
         each mode in the chance of collapse is estimated by probit regression.",
        Plot { x: axis(measure), y: chance_axis("chance"), series, ..Plot::default() },
    )
}

/// Maximum number of curves in a plot of incremental dynamic analysis; each curve belongs to one motion.
const MOST_CURVES: usize = 60;

/// Plots the curves of an incremental dynamic analysis with their fractiles; `None` if there are too few levels per
/// record.
pub(super) fn ida(cases: &Cases, returned: &[Returned]) -> Option<Figure> {
    if !cases.leveled || cases.sampled {
        return None;
    }
    let measure = cases.measure();
    let mut runs: BTreeMap<u32, Vec<(f64, f64)>> = BTreeMap::new();
    for case in &cases.all {
        let key = case.curve;
        let Some(level) = case.intensity(cases.main) else { continue };
        let demand = if case.collapsed { Some(f64::INFINITY) } else { case.drift() };
        if let Some(demand) = demand {
            runs.entry(key).or_default().push((level, demand));
        }
    }
    let all: Vec<Ida> = runs.into_values().map(Ida::new).collect();
    if all.is_empty() || all.iter().any(|ida| ida.points().len() < 3) {
        return None;
    }
    let percent = |drift: f64| 100.0 * drift;
    let standing = all.iter().flat_map(Ida::points).map(|(_, d)| *d).filter(|d| d.is_finite());
    let edge = 1.15 * percent(standing.fold(0.0, f64::max)).max(1e-3);
    let top = all.iter().flat_map(Ida::points).map(|(x, _)| *x).fold(0.0, f64::max);
    // A collapse is drawn at the right edge of the plot. If the stack stands again at a higher level, its curve leaves
    // the edge.
    let place = |demand: f64| percent(demand).min(edge);
    let mut series: Vec<Series> = all
        .iter()
        .take(MOST_CURVES)
        .enumerate()
        .map(|(index, ida)| {
            let points = std::iter::once((0.0, 0.0)).chain(ida.points().iter().copied());
            let (y, x) = points.map(|(x, d)| (measure.shown(x), place(d))).unzip();
            let label = if index == 0 { "single motions" } else { "" };
            Series { style: muted(), ..Series::new(label, x, y) }
        })
        .collect();
    let grid: Vec<f64> = (1..=60).map(|i| top * f64::from(i) / 60.0).collect();
    for (index, (share, label)) in
        [(0.16, "16 % of the motions"), (0.5, "median"), (0.84, "84 %")].into_iter().enumerate()
    {
        let found = grid.iter().map(|x| (measure.shown(*x), Ida::fractile(&all, *x, share)));
        let (y, x) = found.map(|(x, d)| (x, d.map_or(f64::NAN, place))).unzip();
        series.push(Series { style: style(index), ..Series::new(label, x, y) });
    }
    let note = match returned.len() {
        0 => String::new(),
        count => format!(
            " On {count} of {} curves, the stack collapses at one level and stands at a higher one.",
            cases.curves()
        ),
    };
    Some(Figure::new(
        "ida",
        format!(
            "Incremental dynamic analysis: {} as a function of the peak drift of the top while the stack stands. A \
             collapse is plotted at the right edge, at the level of shaking that causes it.{note}",
            measure.label
        ),
        Plot {
            x: Axis { range: Some([0.0, edge]), ..Axis::new("drift of the top", "%") },
            y: axis(measure),
            series,
            ..Plot::default()
        },
    ))
}

/// Plots the effects of the factors on the share of cases that collapse (tornado diagram).
pub(super) fn tornado(effects: &[Effect], overall: f64) -> Figure {
    let bar = |effect: &Effect| {
        let shares = || effect.groups.iter().map(Group::share);
        [shares().fold(1.0, f64::min), shares().fold(0.0, f64::max)]
    };
    let bars = effects.iter().map(bar).enumerate();
    let series = vec![Series::bars("lowest to highest share of collapse", bars)];
    Figure::new(
        "tornado",
        "Effect of each varied quantity: the share of cases that collapse at its least favorable value and at its \
         most favorable value, over all motions and levels. If a quantity has many values, they are grouped into \
         thirds. The vertical line marks the share for all cases together.",
        Plot {
            x: Axis { range: Some([0.0, 1.0]), ..Axis::new("share of collapse", "") },
            y: Axis::named(effects.iter().map(|effect| effect.factor.clone()).collect()),
            series,
            marks: vec![Mark { at: overall, label: "all cases".into() }],
            ..Plot::default()
        },
    )
}

/// Plots the numbers of barrels that fall and that burst against the intensity measure.
pub(super) fn losses(losses: &Losses, measure: &Measure) -> Figure {
    let x: Vec<f64> = losses.levels.iter().map(|loss| measure.shown(loss.intensity)).collect();
    let levels = || losses.levels.iter();
    let burst = |i: usize| levels().map(move |loss| loss.burst[i]);
    let assumed = burst(0).zip(burst(2)).map(|(low, high)| Interval { low, high });
    let series = vec![
        points(
            "barrels that fall, 95 % interval of the mean",
            &x,
            levels().map(|loss| loss.fallen),
            levels().map(|loss| loss.interval),
            0,
        ),
        points("barrels that burst, range of the assumptions", &x, burst(1), assumed, 1),
    ];
    Figure::new(
        "losses",
        format!(
            "Mean number of barrels (of {}) that fall and that burst. The chance that a barrel bursts is assumed from \
             the height of its fall; the range covers the assumptions listed below.",
            losses.barrels
        ),
        Plot {
            x: axis(measure),
            y: Axis { range: Some([0.0, f64::from(losses.barrels)]), ..Axis::new("barrels", "") },
            series,
            ..Plot::default()
        },
    )
}

/// Plots the contribution of each range of intensity to the annual rate of collapse.
pub(super) fn contributions(site: &Site, measure: &Measure) -> Figure {
    let total: f64 = site.contributions.iter().map(|part| part.rate).sum();
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for part in &site.contributions {
        let share = if total > 0.0 { part.rate / total } else { 0.0 };
        x.extend([measure.shown(part.from), measure.shown(part.to)]);
        y.extend([share, share]);
    }
    let area = SeriesStyle { area: true, ..style(0) };
    Figure::new(
        "contributions",
        "Contributions to the annual rate of collapse, by ranges of intensity. Weak shaking is more frequent; strong \
         shaking makes more stacks collapse.",
        Plot {
            x: axis(measure).log(),
            y: Axis::new("share of the rate", ""),
            series: vec![Series { style: area, ..Series::new("", x, y) }],
            ..Plot::default()
        },
    )
}
