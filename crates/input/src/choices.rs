//! Closed sets in files: plain names, and variants with fields of their own.

use crate::InputError;
use crate::field::{Section, Variant};
use crate::reader::Reader;
use crate::tree::Table;
use crate::writer::Writer;

/// A variant of several, each with its own fields in the table that selects it; declared by
/// [`choices!`](crate::choices!).
pub trait Chosen: Sized {
    /// Returns all variants.
    fn variants() -> &'static [Variant];

    /// Returns their names.
    fn names() -> Vec<&'static str> {
        Self::variants().iter().map(|variant| variant.name).collect()
    }

    /// Returns the name of this variant.
    fn name(&self) -> &'static str;

    /// Reads the variant that a table selects, with its fields.
    fn read_chosen(reader: &Reader<'_>) -> Result<Self, InputError>;

    /// Writes the fields of the variant.
    fn write_chosen(&self, writer: &mut Writer);

    /// Writes a table that has only these fields.
    fn write_as(&self, section: &'static Section) -> Table {
        let mut writer = Writer::chosen(section, self.name());
        self.write_chosen(&mut writer);
        writer.finish()
    }
}

/// Declares a closed set whose members have names in files, in the order in which they are listed.
///
/// ```
/// use barrelstack_input::field::{Named, names};
/// use barrelstack_input::named;
///
/// named! {
///     /// On which side.
///     pub enum Side {
///         /// On the left.
///         Left = "left",
///         /// On the right.
///         Right = "right",
///     }
/// }
///
/// assert_eq!((Side::Right.name(), names::<Side>()), ("right", vec!["left", "right"]));
/// ```
#[macro_export]
macro_rules! named {
    (
        $(#[$about:meta])*
        $visible:vis enum $type:ident { $($(#[$text:meta])* $member:ident = $name:literal),+ $(,)? }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        $visible enum $type {
            $($(#[$text])* #[doc = concat!("`", $name, "` in files.")] $member),+
        }

        impl $crate::field::Named for $type {
            const NAMES: &'static [(&'static str, Self)] = &[$(($name, Self::$member)),+];
        }
    };
}

/// Declares a type that is one of several with fields of their own: each with its name in files and its help, which
/// is its doc comment, and its fields as in [`section!`](crate::section).
///
/// The variants are in the static that is named.
/// A choice declared `among` the fields of a table stands in the field that chooses it there.
///
/// ```
/// use barrelstack_input::choices::Chosen;
/// use barrelstack_input::field::{Default, Kind, Range};
/// use barrelstack_input::{Dimension, choices};
///
/// choices! {
///     /// What bodies roll on.
///     #[derive(Clone, Debug, PartialEq)]
///     pub enum Path;
///     /// What they are.
///     static PATHS;
///     /// A level path.
///     Flat = "flat";
///     /// A circular dish.
///     Dish = "dish" {
///         /// Radius.
///         radius: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::POSITIVE), Default::Required;
///     }
/// }
///
/// assert_eq!(Path::Dish { radius: 1.0 }.name(), "dish");
/// assert_eq!(PATHS[1].fields[0].help, "Radius.");
/// ```
#[macro_export]
macro_rules! choices {
    (
        $(#[$about:meta])*
        $visible:vis enum $type:ident $(, among the fields of $holder:ident)?;
        $(#[doc = $all:literal])+
        $vis:vis static $list:ident;
        $(
            $(#[doc = $help:literal])+
            $variant:ident = $name:literal $({
                $(
                    $(#[doc = $text:literal])+
                    $field:ident: $held:ty = $kind:expr, $default:expr;
                )+
            })? $(;)?
        )+
    ) => {
        $(#[$about])*
        $visible enum $type {
            $(
                $(#[doc = $help])+
                $variant $({
                    $(
                        $(#[doc = $text])+
                        #[doc = concat!("\n\nIn files: `", stringify!($kind), "`, `", stringify!($default), "`.")]
                        $field: $held,
                    )+
                })?,
            )+
        }

        $(#[doc = $all])+
        $vis static $list: [$crate::field::Variant; [$($name),+].len()] = [$(
            $crate::field::Variant {
                name: $name,
                help: concat!($($help),+).trim_ascii(),
                fields: &$crate::fields!($($($(#[doc = $text])+ $field = $kind, $default;)+)?),
            },
        )+];

        impl $crate::choices::Chosen for $type {
            fn variants() -> &'static [$crate::field::Variant] {
                &$list
            }

            fn name(&self) -> &'static str {
                match self { $(Self::$variant { .. } => $name,)+ }
            }

            fn read_chosen(
                reader: &$crate::reader::Reader<'_>,
            ) -> ::std::result::Result<Self, $crate::InputError> {
                Ok(match reader.chosen()? {
                    $($name => Self::$variant $({
                        $($field: $crate::declared::Held::read(reader, stringify!($field))?,)+
                    })?,)+
                    other => panic!("\"{other}\" is none of those declared"),
                })
            }

            #[allow(unused_variables, reason = "where none has fields")]
            fn write_chosen(&self, writer: &mut $crate::writer::Writer) {
                match self {
                    $(Self::$variant $({ $($field),+ })? => {
                        $($($crate::declared::Held::write($field, writer, stringify!($field));)+)?
                    })+
                }
            }
        }

        $(
            #[doc = concat!("Read from the table `", stringify!($holder), "`, at whose end its own fields are written.")]
            impl $crate::declared::Held for $type {
                fn read(
                    reader: &$crate::reader::Reader<'_>,
                    _: &'static str,
                ) -> ::std::result::Result<Self, $crate::InputError> {
                    $crate::choices::Chosen::read_chosen(reader)
                }

                fn write(&self, _: &mut $crate::writer::Writer, _: &'static str) {}
            }
        )?
    };
}
