//! Advice on mistyped names: finds the valid name that is most similar to a mistyped name.

/// Names that users of other programs write out of habit, each with a corresponding name in this program.
const HABITS: &[(&str, &str)] = &[
    ("mu", "coefficient"),
    ("mu", "friction"),
    ("mu_s", "static_coefficient"),
    ("k", "stiffness"),
    ("kn", "stiffness"),
    ("c", "damping"),
    ("e", "restitution"),
    ("cor", "restitution"),
    ("dt", "step"),
    ("integrator", "method"),
    ("tol", "tolerance"),
    ("file", "record"),
    ("diameter", "bilge_diameter"),
    ("material", "kind"),
];

/// Largest number of names that an error message lists.
const MOST_LISTED: usize = 12;

/// Returns the valid name most similar to a word, if any is close enough. The words of a name may be in another order,
/// such as `napa-demo` for `demo-napa`.
pub fn nearest(word: &str, valid: &[&str]) -> Option<String> {
    if word.len() > 60 {
        return None;
    }
    let plain = |text: &str| text.trim().to_lowercase().replace(['-', ' '], "_");
    let sorted = |text: &str| {
        let mut words: Vec<&str> = text.split('_').collect();
        words.sort_unstable();
        words.join("_")
    };
    let word = plain(word);
    let habit = HABITS.iter().find(|(habit, name)| *habit == word && valid.contains(name));
    if let Some((_, name)) = habit {
        return Some((*name).to_owned());
    }
    // The heading of a column without its unit, such as `dx` for `dx (m)`.
    let headed = |name: &&&str| plain(name).split_once("_(").is_some_and(|(name, _)| name == word);
    if let Some(name) = valid.iter().find(headed) {
        return Some((*name).to_owned());
    }
    let distance = |name: &str| {
        let name = plain(name);
        // Another order of the words counts as one mistake.
        let reordered = 1 + strsim::damerau_levenshtein(&sorted(&word), &sorted(&name));
        strsim::damerau_levenshtein(&word, &name).min(reordered)
    };
    valid
        .iter()
        .filter(|name| !differ_in_digits(&word, &plain(name)))
        .map(|name| (distance(name), *name))
        .filter(|(distance, name)| *distance <= 1 + name.len().max(word.len()) / 4)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name.to_owned())
        .or_else(|| {
            // The word may be part of the right key, such as `coefficient` for
            // `static_coefficient`.
            let part = |name: &&&str| plain(name).contains(&word) || word.contains(&plain(name));
            valid.iter().filter(|_| word.len() >= 3).find(part).map(|name| (*name).to_owned())
        })
}

/// Returns `true` if two names are different numbers after the same letter, such as the bodies `B9.1` and `B1.1`. One of
/// them is then unlikely to be a misspelling of the other.
fn differ_in_digits(one: &str, other: &str) -> bool {
    let plain = |text: &str| text.replace(|c: char| c.is_ascii_digit(), "");
    let letters = one.chars().filter(char::is_ascii_alphabetic).count();
    letters <= 1 && one != other && plain(one) == plain(other)
}

/// Returns the end of an error message about a name that is not in the list `valid`: the most similar valid name, if
/// any is close enough, and all valid names, or the first and the last of many.
///
/// ```
/// use barrelstack_input::names::advice;
///
/// let racks = ["single-bar", "two-barrel"];
/// assert_eq!(
///     advice("barrel-two", &racks),
///     "did you mean `two-barrel`? The names are single-bar, two-barrel"
/// );
/// assert_eq!(advice("shelf", &racks), "use one of single-bar, two-barrel");
/// assert_eq!(advice("B9.1", &["B1.1", "B1.2"]), "use one of B1.1, B1.2");
/// let columns = ["qx", "dx (m)"];
/// assert!(advice("dx", &columns).starts_with("did you mean `dx (m)`?"));
/// ```
pub fn advice(word: &str, valid: &[&str]) -> String {
    let listed = match valid {
        [first, .., last] if valid.len() > MOST_LISTED => {
            format!("the {} names from {first} to {last}", valid.len())
        }
        _ => valid.join(", "),
    };
    match nearest(word, valid) {
        Some(near) if valid.len() > MOST_LISTED || valid.len() == 1 => {
            format!("did you mean `{near}`?")
        }
        Some(near) => format!("did you mean `{near}`? The names are {listed}"),
        None if valid.len() == 1 => format!("the only name is {listed}"),
        None => format!("use one of {listed}"),
    }
}
