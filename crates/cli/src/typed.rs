//! Enums as command-line arguments.

use clap::ValueEnum;

/// Declares an enum whose variants are the words that a command-line argument accepts, and the conversion of each
/// variant to a value of the type after `of`. The doc comment of a variant is the help text of its word.
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

/// Returns the word for an enum variant on the command line.
pub(crate) fn word(member: impl ValueEnum + Copy) -> String {
    member.to_possible_value().map_or_else(String::new, |word| word.get_name().to_owned())
}
