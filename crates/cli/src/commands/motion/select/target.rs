//! What a selection is asked to look like, as typed.

use std::path::Path;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::AccelerationUnit;
use barrelstack_selection::{Condition, PERIODS, SelectionTarget};

use super::SelectArgs;
use crate::commands::motion::input::{self, quantity};
use crate::commands::motion::target as code;

/// The target within the periods that count.
pub(super) fn target(args: &SelectArgs) -> anyhow::Result<SelectionTarget> {
    let shortest = quantity("--shortest", &args.shortest, Dimension::TIME)?;
    let longest = quantity("--longest", &args.longest, Dimension::TIME)?;
    let counts = |period: f64| (shortest..=longest).contains(&period);
    let is_code = args.target.split_once(':').is_some_and(|(name, _)| name.len() > 1);
    if is_code {
        if args.at.is_some() {
            bail!("--at: a code's spectrum has no spread that could be conditional");
        }
        let spectrum = code::target(&args.target)?;
        let periods: Vec<f64> = PERIODS.into_iter().filter(|t| counts(*t)).collect();
        return Ok(SelectionTarget::of_spectrum(&spectrum, &periods)?);
    }
    let path = Path::new(&args.target);
    let model = Model::read(path)?;
    let at = args.at.as_deref().map(|text| plain_time("--at", text)).transpose()?;
    let within: Vec<usize> =
        (0..model.periods.len()).filter(|k| counts(model.periods[*k])).collect();
    let pick = |values: &[f64]| within.iter().map(|k| values[*k]).collect::<Vec<f64>>();
    let (periods, median, sigma) = (pick(&model.periods), pick(&model.median), pick(&model.sigma));
    let condition = match at {
        None => None,
        Some(period) => {
            let place = periods.iter().position(|t| *t == period).ok_or_else(|| {
                let listed: Vec<String> = periods.iter().map(f64::to_string).collect();
                anyhow!(
                    "--at: {period} s is none of the periods that count: {} s",
                    listed.join(", ")
                )
            })?;
            Some(match (&args.level, args.epsilon) {
                (Some(level), _) => {
                    let acceleration = quantity("--level", level, Dimension::ACCELERATION)?;
                    Condition { period, acceleration }
                }
                (None, Some(epsilon)) => {
                    Condition::at_epsilon(period, median[place], sigma[place], epsilon)
                }
                (None, None) => bail!("--at: give Sa there, with --level \"0.6 g\" or --epsilon 2"),
            })
        }
    };
    Ok(SelectionTarget::new(&periods, &median, &sigma, condition)?)
}

/// A time as a plain number of seconds or with its unit.
fn plain_time(option: &str, text: &str) -> anyhow::Result<f64> {
    match text.trim().parse::<f64>() {
        Ok(value) => Ok(value),
        Err(_) => quantity(option, text, Dimension::TIME),
    }
}

/// The table of a ground-motion model.
struct Model {
    periods: Vec<f64>,
    /// Medians (m/s²).
    median: Vec<f64>,
    /// Standard deviations of ln Sa.
    sigma: Vec<f64>,
}

impl Model {
    fn read(path: &Path) -> anyhow::Result<Self> {
        let bytes = input::bytes(path)?;
        let text = String::from_utf8_lossy(&bytes);
        let mut model = Self { periods: Vec::new(), median: Vec::new(), sigma: Vec::new() };
        let mut unit = None;
        for (line, row) in text.lines().enumerate() {
            let row = row.trim().trim_start_matches('\u{feff}');
            if row.is_empty() || row.starts_with('#') {
                continue;
            }
            let place = format!("{}, line {}", path.display(), line + 1);
            let cells: Vec<&str> = row.split([',', ';', '\t']).map(str::trim).collect();
            let [period, median, sigma] = cells.as_slice() else {
                bail!(
                    "{place}: expected a period, a median and the standard deviation of ln Sa with \
                     commas between, found {} columns",
                    cells.len()
                );
            };
            let Some(factor) = unit else {
                let stated = median.split_once('(').and_then(|(_, rest)| rest.split_once(')'));
                let stated = stated.and_then(|(word, _)| word.parse::<AccelerationUnit>().ok());
                let Some(stated) = stated.filter(|_| period.contains("(s)")) else {
                    bail!(
                        "{place}: expected a header that states the units, such as \"period (s), median \
                         (g), sigma\", found \"{row}\""
                    );
                };
                unit = Some(stated.factor());
                continue;
            };
            let number = |cell: &str| {
                let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
                value.ok_or_else(|| anyhow!("{place}: expected a number, found \"{cell}\""))
            };
            model.periods.push(number(period)?);
            model.median.push(factor * number(median)?);
            model.sigma.push(number(sigma)?);
        }
        Ok(model)
    }
}
