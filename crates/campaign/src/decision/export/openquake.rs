//! Input files of `OpenQuake` (`nrml` 0.5): fragility, vulnerability, a taxonomy mapping, and an exposure template.

use std::fmt::Write as _;

use barrelstack::breakage::Breakage;
use barrelstack_fragility::Lognormal;

use super::Foreign;
use crate::decision::Decision;
use crate::decision::cases::JudgedCase;
use crate::decision::curve::interpolate;
use crate::scenario::quantity::plain;

/// Name of the file with the fragility curves.
pub(super) const FRAGILITY: &str = "openquake-fragility.xml";

/// Name of the file with the vulnerability function of the wine.
pub(super) const WINE: &str = "openquake-vulnerability-wine.xml";

/// Name of the file with the vulnerability function of the barrels.
pub(super) const BARRELS: &str = "openquake-vulnerability-barrels.xml";

/// Name of the file with the taxonomy mapping.
pub(super) const MAPPING: &str = "openquake-taxonomy-mapping.csv";

/// Name of the file with the exposure template.
pub(super) const EXPOSURE: &str = "openquake-exposure.xml";

/// Name of the file with the assets of the exposure template.
pub(super) const ASSETS: &str = "openquake-exposure.csv";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Converts a name to an `OpenQuake` identifier of up to 75 characters: letters, digits and underscores, and
/// colons and dashes after the first character.
pub(super) fn identity(text: &str) -> String {
    let known = |(at, c): &(usize, char)| {
        c.is_ascii_alphanumeric() || *c == '_' || (*at > 0 && matches!(c, '-' | ':'))
    };
    let signs = text.chars().take(75).enumerate();
    signs.map(|sign| if known(&sign) { sign.1 } else { '_' }).collect()
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(plain).collect::<Vec<_>>().join(" ")
}

const HEAD: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<nrml xmlns=\"http://openquake.org/xmlns/nrml/0.5\">\n";

/// Returns the mean and the standard deviation of a lognormal capacity. `OpenQuake` describes a fragility curve by
/// these two numbers.
fn moments(curve: &Lognormal) -> (f64, f64) {
    let variance = curve.dispersion * curve.dispersion;
    let mean = curve.median * libm::exp(0.5 * variance);
    (mean, mean * libm::expm1(variance).sqrt())
}

pub(super) fn fragility(
    limits: &[(String, Lognormal)],
    imls: &[f64],
    foreign: &Foreign,
    asset: &str,
    about: &str,
) -> String {
    let names: Vec<&str> = limits.iter().map(|(name, _)| name.as_str()).collect();
    // Outside of this range, OpenQuake keeps the probability constant. The range extends to probabilities of 5e-5 and
    // 1 - 5e-5, so that the constant value is wrong by at most 5e-5.
    let reaches = |p: f64| limits.iter().map(move |(_, curve)| curve.intensity(p));
    let first = reaches(5e-5).fold(imls[0], f64::min);
    let last = reaches(1.0 - 5e-5).fold(imls[imls.len() - 1], f64::max);
    let mut text = format!(
        "{HEAD}  <fragilityModel id=\"barrelstack\" assetCategory=\"contents\" lossCategory=\"contents\">\n    \
         <description>{}</description>\n    <limitStates>{}</limitStates>\n    \
         <fragilityFunction id=\"{}\" format=\"continuous\" shape=\"logncdf\">\n      \
         <imls imt=\"{}\" noDamageLimit=\"0\" minIML=\"{}\" maxIML=\"{}\"/>\n",
        escaped(about),
        names.join(" "),
        asset,
        foreign.imt,
        plain(first),
        plain(last)
    );
    for (name, curve) in limits {
        let (mean, deviation) = moments(curve);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "      <params ls=\"{name}\" mean=\"{}\" stddev=\"{}\"/>",
            plain(mean),
            plain(deviation)
        );
    }
    text.push_str("    </fragilityFunction>\n  </fragilityModel>\n</nrml>\n");
    text
}

/// Returns the share of a stack's wine that is lost from burst barrels, under the central assumption about breakage; 0
/// if the stack holds no wine.
fn wine_lost(case: &JudgedCase) -> f64 {
    let lost = |(fall, wine): (&f64, &f64)| wine * Breakage::RANGE[1].probability(*fall);
    // The sum starts from 0, since an empty sum of floats is -0.
    let lost = case.falls.iter().zip(&case.wines).map(lost).fold(0.0, |sum, lost| sum + lost);
    if case.wine > 0.0 { lost / case.wine } else { 0.0 }
}

/// Maximum variance of a loss ratio in an exported file, as a share of m (1 − m), where m is the mean loss ratio. The
/// variance of a ratio between 0 and 1 cannot exceed m (1 − m).
///
/// `OpenQuake` draws ratios from a beta distribution, whose variance must be below m (1 − m). Between two levels,
/// `OpenQuake` interpolates the mean and the coefficient of variation separately, so that a margin is needed.
const MOST_SCATTER: f64 = 0.99;

/// Maximum variance of a loss ratio that is interpolated between two exported levels, as a share of m (1 − m), where m
/// is the interpolated mean.
const MOST_BETWEEN: f64 = 0.999;

/// Maximum relative and absolute difference between two interpolated means: the mean that `OpenQuake` interpolates
/// linearly in the intensity, and the mean that [`Ratios::at`] interpolates linearly in the logarithm of the intensity.
const MEAN_TOLERANCE: [f64; 2] = [2e-3, 1e-7];

/// One level of a vulnerability function.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    /// Intensity.
    x: f64,
    /// Mean loss ratio.
    mean: f64,
    /// Coefficient of variation of the loss ratio.
    variation: f64,
}

/// Loss ratios as a function of intensity: at each level of a study, the mean m, and the variance as a share
/// of m (1 − m).
struct Ratios {
    means: Vec<(f64, f64)>,
    shares: Vec<(f64, f64)>,
}

impl Ratios {
    fn of(groups: &[(f64, Vec<&JudgedCase>)], of: impl Fn(&JudgedCase) -> f64) -> Self {
        let (mut means, mut shares) = (Vec::new(), Vec::new());
        for (x, cases) in groups {
            let n = cases.len() as f64;
            let mean = cases.iter().map(|case| of(case)).sum::<f64>() / n;
            means.push((*x, mean));
            // If all or nothing is lost, m (1 − m) is zero and the share is not defined.
            if mean > 0.0 && mean < 1.0 {
                let square = cases.iter().map(|case| of(case) - mean).map(|off| off * off);
                let variance = square.sum::<f64>() / (n - 1.0).max(1.0);
                shares.push((*x, (variance / (mean * (1.0 - mean))).min(MOST_SCATTER)));
            }
        }
        Self { means, shares }
    }

    /// Returns the mean and the coefficient of variation of the loss ratio at an intensity. Between the levels of the
    /// study, `means` and `shares` are interpolated linearly in the logarithm of the intensity.
    fn at(&self, x: f64) -> Level {
        let mean = interpolate(&self.means, x);
        // Below the lowest level the share is constant; only the mean tends to zero.
        let share =
            self.shares.first().map_or(0.0, |(first, _)| interpolate(&self.shares, x.max(*first)));
        let scatters = mean > 0.0 && mean < 1.0;
        let variation = if scatters { (share * (1.0 - mean) / mean).sqrt() } else { 0.0 };
        Level { x, mean, variation }
    }

    /// Returns the levels to be written: the levels of the study, and as many levels between them as linear
    /// interpolation requires.
    fn levels(&self) -> Vec<Level> {
        let Some((lowest, _)) = self.means.first() else { return Vec::new() };
        let first = self.at(*lowest);
        let mut found = Vec::new();
        if first.mean > 0.0 {
            // Below the lowest level losses are taken as proportional to the intensity.
            let part = 1e-3;
            found.push(Level { x: part * first.x, mean: part * first.mean, ..first });
        }
        found.push(first);
        for (x, _) in &self.means[1..] {
            self.refine(found[found.len() - 1], self.at(*x), 0, &mut found);
        }
        found
    }

    /// Adds the levels that are needed between `from` and `to`, and then `to` itself.
    fn refine(&self, from: Level, to: Level, depth: u32, found: &mut Vec<Level>) {
        let middle = self.at((from.x * to.x).sqrt());
        if depth < 20 && !self.is_fine(from, to) {
            self.refine(from, middle, depth + 1, found);
            self.refine(middle, to, depth + 1, found);
        } else {
            found.push(to);
        }
    }

    /// Returns `true` if linear interpolation between two levels gives a valid variance and a mean close to that of
    /// [`Ratios::at`].
    fn is_fine(&self, from: Level, to: Level) -> bool {
        (1..16).map(|k| f64::from(k) / 16.0).all(|t| {
            let between = |from: f64, to: f64| from + t * (to - from);
            let mean = between(from.mean, to.mean);
            let variation = between(from.variation, to.variation);
            let ours = self.at(between(from.x, to.x)).mean;
            let [relative, absolute] = MEAN_TOLERANCE;
            variation * variation * mean <= MOST_BETWEEN * (1.0 - mean)
                && (mean - ours).abs() <= relative * ours + absolute
        })
    }
}

/// Returns a vulnerability function as XML. `loss` is the loss category in `OpenQuake`, `words` describes the loss
/// ratio, and `ratio` returns the loss ratio of a case.
fn vulnerability(
    decision: &Decision,
    foreign: &Foreign,
    asset: &str,
    about: &str,
    (loss, words): (&str, &str),
    ratio: fn(&JudgedCase) -> f64,
) -> String {
    let known = decision.cases.with_known_falls();
    let levels = Ratios::of(&known.groups(known.main), ratio).levels();
    let values = |of: fn(&Level) -> f64| numbers(levels.iter().map(of));
    format!(
        "{HEAD}  <vulnerabilityModel id=\"barrelstack\" assetCategory=\"contents\" lossCategory=\"{loss}\">\n    \
         <description>{}; loss ratio: {words}</description>\n    \
         <vulnerabilityFunction id=\"{asset}\" dist=\"BT\">\n      <imls imt=\"{}\">{}</imls>\n      \
         <meanLRs>{}</meanLRs>\n      <covLRs>{}</covLRs>\n    </vulnerabilityFunction>\n  \
         </vulnerabilityModel>\n</nrml>\n",
        escaped(about),
        foreign.imt,
        numbers(levels.iter().map(|level| foreign.scale * level.x)),
        values(|level| level.mean),
        values(|level| level.variation)
    )
}

/// Returns two vulnerability functions as XML: one for the barrels and one for the wine.
pub(super) fn vulnerabilities(
    decision: &Decision,
    foreign: &Foreign,
    asset: &str,
    about: &str,
) -> [(&'static str, String); 2] {
    let barrels = ("nonstructural", "share of the barrels that fall");
    let wine = ("contents", "share of the wine that is lost (central assumption of breakage)");
    [
        (
            BARRELS,
            vulnerability(decision, foreign, asset, about, barrels, JudgedCase::fallen_share),
        ),
        (WINE, vulnerability(decision, foreign, asset, about, wine, wine_lost)),
    ]
}

/// Returns an exposure template with one stack at 0° E, 0° N, and the taxonomy mapping of that stack.
///
/// In the template, `contents` is the volume of wine in the stack (m³), and `nonstructural` is the number of barrels.
pub(super) fn exposure(
    decision: &Decision,
    asset: &str,
    about: &str,
) -> [(&'static str, String); 3] {
    let model = format!(
        "{HEAD}  <exposureModel id=\"barrelstack\" category=\"contents\" taxonomySource=\"barrelstack\">\n    \
         <description>{}</description>\n    <conversions>\n      <costTypes>\n        \
         <costType name=\"contents\" type=\"per_asset\" unit=\"m3\"/>\n        \
         <costType name=\"nonstructural\" type=\"per_asset\" unit=\"barrels\"/>\n      </costTypes>\n    \
         </conversions>\n    <assets>{ASSETS}</assets>\n  </exposureModel>\n</nrml>\n",
        escaped(about)
    );
    let assets = format!(
        "id,lon,lat,taxonomy,number,contents,nonstructural\nstack_1,0,0,{asset},1,{},{}\n",
        plain(decision.cases.most_wine()),
        decision.cases.most_barrels()
    );
    let mapping = format!("taxonomy,risk_id,weight\n{asset},{asset},1\n");
    [(EXPOSURE, model), (ASSETS, assets), (MAPPING, mapping)]
}
