//! Implements `Display` for enums without fields.

/// Implements `Display` for an enum without fields, with one word per variant.
macro_rules! printed_as {
    ($type:ident, $($variant:ident = $word:literal),+) => {
        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(match self {
                    $(Self::$variant => $word),+
                })
            }
        }
    };
}
