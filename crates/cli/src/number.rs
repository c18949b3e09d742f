//! Numbers as command-line arguments. The error about a wrong number states the permitted numbers in words.

use std::fmt::Display;
use std::num::NonZero;
use std::ops::RangeInclusive;

/// Returns a parser of whole numbers in a range.
pub(crate) fn whole<T>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync
where
    T: TryFrom<u64> + PartialOrd + Display + Clone + Send + Sync,
{
    move |text| {
        let number = text.parse::<u64>().ok().and_then(|number| T::try_from(number).ok());
        number.filter(|number| range.contains(number)).ok_or_else(|| {
            format!("expected a whole number from {} to {}", range.start(), range.end())
        })
    }
}

/// Returns a parser of whole numbers above zero.
pub(crate) fn counting() -> impl Fn(&str) -> Result<NonZero<usize>, String> + Clone + Send + Sync {
    let number = whole(1..=usize::MAX);
    move |text| {
        let number = number(text)?;
        NonZero::new(number).ok_or_else(String::new)
    }
}

/// Returns a parser of finite numbers for which `fits` returns `true`. `expected` describes these numbers with an
/// example, such as `a number above 0, such as 2.5`.
pub(crate) fn real(
    expected: &'static str,
    fits: impl Fn(f64) -> bool + Clone + Send + Sync,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync {
    move |text| {
        let number = text.parse::<f64>().ok();
        number
            .filter(|number| number.is_finite() && fits(*number))
            .ok_or_else(|| format!("expected {expected}"))
    }
}

#[cfg(test)]
mod tests {
    use std::any::TypeId;

    use clap::builder::ValueParser;
    use clap::error::ErrorKind;
    use clap::{Arg, ArgAction, Command, CommandFactory as _};

    use crate::args::Args;

    /// Calls `visit` with the words of every command, and with every option and argument of the command.
    fn walk(command: &Command, words: &[String], visit: &mut impl FnMut(&[String], &Arg)) {
        for arg in command.get_arguments() {
            visit(words, arg);
        }
        for below in command.get_subcommands().filter(|below| below.get_name() != "help") {
            walk(below, &[words, &[below.get_name().to_owned()]].concat(), visit);
        }
    }

    /// Returns the error about the value `value` of an option; `None` if the value itself is accepted. Errors about
    /// options that are missing do not count.
    fn refusal(words: &[String], option: &str, value: &[&str]) -> Option<String> {
        let mut line = words.to_vec();
        match value {
            [one] => line.push(format!("--{option}={one}")),
            _ => line.extend([format!("--{option}"), value.concat()]),
        }
        let error = Args::command().try_get_matches_from(line).err()?;
        let other = [ErrorKind::MissingRequiredArgument, ErrorKind::MissingSubcommand];
        (!other.contains(&error.kind())).then(|| error.render().to_string())
    }

    fn is<T: 'static>(parser: &ValueParser) -> bool {
        parser.type_id() == TypeId::of::<T>()
    }

    /// Returns the two numbers after `expected a whole number from`.
    fn range(said: &str) -> Option<[u128; 2]> {
        let (_, range) = said.split_once("expected a whole number from ")?;
        let (low, rest) = range.split_once(" to ")?;
        Some([low.parse().ok()?, rest.lines().next()?.parse().ok()?])
    }

    #[test]
    fn every_number_that_an_option_refuses_is_answered_with_the_permitted_range_in_words() {
        let mut command = Args::command();
        command.build();
        let (mut wholes, mut reals, mut wrong) = (0, 0, Vec::new());
        walk(&command, &["barrelstack".to_owned()], &mut |words, arg| {
            let parser = arg.get_value_parser();
            let whole = is::<u32>(parser) || is::<u64>(parser) || is::<usize>(parser);
            let nonzero = is::<std::num::NonZero<usize>>(parser);
            let real = is::<f64>(parser);
            let counts = matches!(arg.get_action(), ArgAction::Set | ArgAction::Append);
            if !counts || !(whole || nonzero || real) {
                return;
            }
            let option = arg.get_long().expect("numbers are given as options");
            let mut require = |holds: bool, what: &str| {
                if !holds {
                    wrong.push(format!("{} --{option}: {what}", words.join(" ")));
                }
            };
            let texts = ["abc", "", "nan", "1e999", "-1e999", "2.5.1"];
            for text in texts {
                let said = refusal(words, option, &[text]).unwrap_or_default();
                let start = format!("error: invalid value '{text}' for '--{option} <");
                let expected = if real { ">': expected a" } else { ">': expected a whole number" };
                let odd = ["..", "literal", "digit", "target type", "is not in"];
                require(said.starts_with(&start), &format!("{text:?} says {said:?}"));
                require(said.contains(expected), &format!("{text:?} says {said:?}"));
                require(!odd.iter().any(|odd| said.contains(odd)), &said);
                require(!real || said.contains("such as"), &said);
            }
            // A negative number is not read as the name of another option.
            let negative = refusal(words, option, &["-", "1e999"]);
            require(
                negative.as_ref().is_some_and(|said| said.contains("': expected a")),
                &format!("a negative number says {negative:?}"),
            );
            reals += u32::from(real);
            if real {
                return;
            }
            wholes += 1;
            let Some([low, high]) = range(&refusal(words, option, &["x"]).unwrap_or_default())
            else {
                require(false, "no range");
                return;
            };
            for end in [low, high] {
                let said = refusal(words, option, &[&end.to_string()]);
                require(
                    !said.is_some_and(|said| said.contains("expected a whole")),
                    "an end of the range is refused",
                );
            }
            for outside in [low.checked_sub(1), Some(high + 1)].into_iter().flatten() {
                require(
                    refusal(words, option, &[&outside.to_string()]).is_some(),
                    "the range is wider",
                );
            }
        });
        assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
        assert!(wholes >= 20 && reals >= 12, "{wholes} and {reals}");
    }
}
