//! Target of a selection, from the options of the command.

use std::path::Path;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_selection::{Condition, PERIODS, SelectionTarget};

use super::SelectArgs;
use crate::commands::motion::input::{number_or, quantity};
use crate::commands::motion::target as code;

/// Returns the target spectrum, limited to the requested range of periods.
pub(super) fn target(args: &SelectArgs) -> anyhow::Result<SelectionTarget> {
    let shortest = quantity("--shortest", &args.shortest, Dimension::TIME)?;
    let longest = quantity("--longest", &args.longest, Dimension::TIME)?;
    let counts = |period: f64| (shortest..=longest).contains(&period);
    let is_code = args.target.split_once(':').is_some_and(|(name, _)| name.len() > 1);
    if is_code {
        if args.at.is_some() {
            bail!(
                "--at: a code spectrum states no standard deviation, so it cannot be made conditional: leave --at out"
            );
        }
        let spectrum = code::target(&args.target)?;
        let periods: Vec<f64> = PERIODS.into_iter().filter(|t| counts(*t)).collect();
        return Ok(SelectionTarget::of_spectrum(&spectrum, &periods)?);
    }
    let columns = "a period, a median and the standard deviation of ln Sa, separated by commas";
    let header = "period (s), median (g), sigma";
    let mut model = code::rows(Path::new(&args.target), columns, header, |_, _| Ok(()))?;
    let at = args.at.as_deref().map(|text| number_or("--at", text, Dimension::TIME)).transpose()?;
    model.retain(|[period, ..]: &[f64; 3]| counts(*period));
    // Medians (m/s²), and standard deviations of ln Sa.
    let [periods, median, sigma] =
        [0, 1, 2].map(|column| model.iter().map(|row| row[column]).collect::<Vec<_>>());
    let condition = match at {
        None => None,
        Some(period) => {
            let place = periods.iter().position(|t| *t == period).ok_or_else(|| {
                let listed: Vec<String> = periods.iter().map(f64::to_string).collect();
                anyhow!(
                    "--at: {period} s is not one of the matched periods, which are {} s",
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
                (None, None) => {
                    bail!(
                        "--at: give the target value of Sa at this period with --level \"0.6 g\" or --epsilon 2"
                    )
                }
            })
        }
    };
    Ok(SelectionTarget::new(&periods, &median, &sigma, condition)?)
}
