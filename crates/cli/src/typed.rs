//! Closed sets of values as command-line arguments.

use clap::ValueEnum;

/// Declares, for the members of a closed set, the words that the command line accepts and their
/// help.
macro_rules! typed {
    (
        $(#[$about:meta])*
        $visible:vis enum $name:ident of $set:ty {
            $($(#[$help:meta])* $word:ident = $member:expr,)*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
        $visible enum $name {
            $($(#[$help])* $word,)*
        }

        impl From<$name> for $set {
            fn from(typed: $name) -> Self {
                match typed {
                    $($name::$word => $member,)*
                }
            }
        }
    };
}

pub(crate) use typed;

/// Returns the command-line word for a member of a closed set.
pub(crate) fn word(member: impl ValueEnum + Copy) -> String {
    member.to_possible_value().map_or_else(String::new, |word| word.get_name().to_owned())
}
