//! The command line that compares the unchanged stack with the stack after the smallest sufficient change (the remedy).

use barrelstack::variants::Remedy;

use crate::args::{ScenarioArgs, VariantArgs};

/// Command-line arguments of the run of the unchanged stack. The command line of the comparison is built from them.
pub(crate) struct Command<'a> {
    scenario: &'a ScenarioArgs,
    variants: VariantArgs,
}

impl<'a> Command<'a> {
    pub(crate) fn of(scenario: &'a ScenarioArgs, variants: VariantArgs) -> Self {
        Self { scenario, variants }
    }

    /// Returns the command line that compares the unchanged stack with the stack after each sufficient change. Only
    /// changes that a single `--against` option can express are included.
    ///
    /// Returns `None` if there is no such change, or if the scenario was read from standard input.
    pub(crate) fn against(&self, found: &Remedy) -> Option<String> {
        let ScenarioArgs { scenario, set, record } = self.scenario;
        let all = [&found.height, &found.straps].into_iter().flatten();
        let against: Vec<String> = all
            .filter_map(|one| match one.changes.as_slice() {
                [change] => Some(format!(" --against {}", quoted(change))),
                _ => None,
            })
            .collect();
        if against.is_empty() || scenario == "-" {
            return None;
        }
        let set = set.iter().map(|change| format!(" --set {}", quoted(change)));
        let record =
            record.iter().map(|path| format!(" --record {}", quoted(&path.to_string_lossy())));
        let variants = self.variants.variants.map(|number| format!(" --variants {number}"));
        let options: String = set.chain(record).chain(variants).chain(against).collect();
        Some(format!("barrelstack compare {}{options}", quoted(scenario)))
    }
}

/// Quotes a word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=:,+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_word_stays_one_word_in_a_shell() {
        let said = |word: &str| {
            let output = std::process::Command::new("sh")
                .args(["-c", &format!("printf %s {}", quoted(word))])
                .output();
            output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned())
        };
        for word in
            ["stack.levels=3", "a b", "stack.strap={ ties = \"x\" }", "it's", "", "$HOME `x`"]
        {
            // The test passes without a shell.
            assert!(said(word).map_or(true, |said| said == word), "{word}");
        }
    }
}
