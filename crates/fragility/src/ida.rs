//! Curves of incremental dynamic analysis (IDA): demand against intensity, one curve per record.

use crate::math::quantile;

/// IDA curve of one record: results of runs at ascending intensities.
#[derive(Clone, Debug, PartialEq)]
pub struct Ida {
    /// Pairs `(intensity, demand)` of the runs, in ascending order of intensity. An infinite demand represents
    /// collapse.
    points: Vec<(f64, f64)>,
}

impl Ida {
    /// Creates a curve from pairs `(intensity, demand)` of runs in any order. Runs are omitted if their intensity is
    /// not positive and finite, or if their demand is NaN. Of several runs at one intensity, the one with the largest
    /// demand is kept.
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let sound = |(x, d): &(f64, f64)| x.is_finite() && *x > 0.0 && !d.is_nan();
        let mut points: Vec<(f64, f64)> = points.into_iter().filter(sound).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|later, first| {
            let same = later.0 == first.0;
            if same {
                first.1 = first.1.max(later.1);
            }
            same
        });
        Self { points }
    }

    /// Returns the pairs `(intensity, demand)` of the runs, in ascending order of intensity. An infinite demand
    /// represents collapse.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Returns the demand at an intensity.
    ///
    /// The demand is interpolated linearly between runs, and from zero at zero intensity to the first run. Between a
    /// run in which the structure stood and a run in which it collapsed, in either order, the boundary is placed at the
    /// geometric mean of the two intensities. On one side of the boundary the demand equals the demand of the standing
    /// run, and on the other side it is infinite. Above the last run, the demand is infinite if the structure
    /// collapsed in that run, because an analysis usually ends at the collapse. The demand is `None` (unknown) if the
    /// structure stood in that run.
    pub fn demand(&self, intensity: f64) -> Option<f64> {
        let after = self.points.partition_point(|(x, _)| *x < intensity);
        let before = after.checked_sub(1).map_or((0.0, 0.0), |i| self.points[i]);
        let Some(&next) = self.points.get(after) else {
            return before.1.is_infinite().then_some(f64::INFINITY);
        };
        if next.0 == intensity {
            return Some(next.1);
        }
        Some(match (before.1.is_finite(), next.1.is_finite()) {
            (true, true) => {
                let part = (intensity - before.0) / (next.0 - before.0);
                before.1 + part * (next.1 - before.1)
            }
            (false, false) => f64::INFINITY,
            (first_stands, _) => {
                let past = intensity * intensity >= before.0 * next.0 && before.0 > 0.0;
                let standing = if first_stands { before.1 } else { next.1 };
                if past == first_stands { f64::INFINITY } else { standing }
            }
        })
    }

    /// Returns the fractile `share` of the demands of all records at an intensity.
    ///
    /// The fractile is infinite if the structure collapses under too many of the records. It is `None` if the
    /// demand of any record is unknown, so that no record is silently excluded. A structure that collapses
    /// under a record at a lower intensity but stands at the given intensity counts as standing.
    pub fn fractile(all: &[Self], intensity: f64, share: f64) -> Option<f64> {
        let mut demands =
            all.iter().map(|ida| ida.demand(intensity)).collect::<Option<Vec<_>>>()?;
        if demands.is_empty() {
            return None;
        }
        demands.sort_by(f64::total_cmp);
        Some(quantile(&demands, share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn returning() -> Ida {
        Ida::new([(0.4, f64::INFINITY), (0.1, 1.0), (0.2, 3.0), (0.8, 5.0), (1.6, f64::INFINITY)])
    }

    #[test]
    fn demand_is_linear_between_runs_and_collapse_lies_at_the_geometric_middle() {
        let ida = returning();
        assert_eq!(ida.demand(0.05), Some(0.5));
        assert!((ida.demand(0.15).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(ida.demand(0.28), Some(3.0));
        assert_eq!(ida.demand(0.29), Some(f64::INFINITY));
        assert_eq!(ida.demand(0.56), Some(f64::INFINITY));
        assert_eq!(ida.demand(0.57), Some(5.0));
        assert_eq!(ida.demand(9.0), Some(f64::INFINITY));
        assert_eq!(Ida::new([(0.1, 1.0)]).demand(0.2), None);
    }

    #[test]
    fn fractiles_come_back_where_enough_records_stand_again() {
        let steady = Ida::new([(0.1, 0.5), (0.8, 4.0), (1.6, f64::INFINITY)]);
        let all = [returning(), steady.clone(), returning()];
        assert_eq!(Ida::fractile(&all, 0.4, 0.5), Some(f64::INFINITY));
        assert_eq!(Ida::fractile(&all, 0.4, 0.0), steady.demand(0.4));
        assert_eq!(Ida::fractile(&all, 0.8, 0.5), Some(5.0));
        assert_eq!(Ida::fractile(&[], 0.8, 0.5), None);
    }

    #[test]
    fn of_runs_at_one_intensity_the_larger_demand_counts() {
        let ida = Ida::new([(0.1, 2.0), (0.1, 3.0), (f64::NAN, 1.0), (0.2, f64::NAN)]);
        assert_eq!(ida.points(), [(0.1, 3.0)]);
    }
}
