//! Closed sets of values in input files: plain names, and variants with fields of their own.

use crate::InputError;
use crate::field::{Section, Variant};
use crate::reader::Reader;
use crate::tree::Table;
use crate::writer::Writer;

/// A closed set of variants. A table selects a variant by its tag field, and also contains the fields of the selected
/// variant. Such a set is declared with [`choices!`](crate::choices!).
pub trait Chosen: Sized {
    /// Returns all variants.
    fn variants() -> &'static [Variant];

    /// Returns the names of all variants.
    fn names() -> Vec<&'static str> {
        Self::variants().iter().map(|variant| variant.name).collect()
    }

    /// Returns the name of this variant.
    fn name(&self) -> &'static str;

    /// Reads the variant that a table selects, including its fields.
    fn read_chosen(reader: &Reader<'_>) -> Result<Self, InputError>;

    /// Writes the fields of this variant.
    fn write_chosen(&self, writer: &mut Writer);

    /// Writes a complete table that has only the tag field and the fields of this variant.
    fn write_as(&self, section: &'static Section) -> Table {
        let mut writer = Writer::chosen(section, self.name());
        self.write_chosen(&mut writer);
        writer.finish()
    }
}

/// Declares an enum whose members are written by name in files.
///
/// ```
/// use barrelstack_input::field::{Named, names};
/// use barrelstack_input::named;
///
/// named! {
///     /// Side of a body.
///     pub enum Side {
///         /// The left side.
///         Left = "left",
///         /// The right side.
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

/// Declares an enum whose variants have fields of their own in files.
///
/// Each variant is listed with its name in files and its fields, which are written as in
/// [`section!`](crate::section). The doc comment of a variant is also its help text. The
/// definitions of the variants are stored in the static that is declared after the enum. A type
/// declared `among the fields of` a table can be used as the type of the tag field of that table.
///
/// ```
/// use barrelstack_input::choices::Chosen;
/// use barrelstack_input::field::{Default, Kind, Range};
/// use barrelstack_input::{Dimension, choices};
///
/// choices! {
///     /// A path on which bodies roll.
///     #[derive(Clone, Debug, PartialEq)]
///     pub enum Path;
///     /// The kinds of path.
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
                    other => panic!("\"{other}\" is not a declared variant"),
                })
            }

            #[allow(unused_variables, reason = "unused if no variant has fields")]
            fn write_chosen(&self, writer: &mut $crate::writer::Writer) {
                match self {
                    $(Self::$variant $({ $($field),+ })? => {
                        $($($crate::declared::Held::write($field, writer, stringify!($field));)+)?
                    })+
                }
            }
        }

        $(
            #[doc = concat!("Stored in the fields of the table `", stringify!($holder), "` itself.")]
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
