//! Declares a table once: its type, its fields, and how they are read and written.

use crate::error::InputError;
use crate::field::{Kind, Named, Section};
use crate::reader::Reader;
use crate::tree::Table;
use crate::writer::Writer;

/// A type that [`section!`](crate::section) declares together with the definition of its table in an input file.
pub trait Declared: Sized {
    /// Returns the definition of the table.
    fn section() -> &'static Section;

    /// Reads the fields. The caller checks that they are consistent and calls [`Reader::finish`].
    fn read_fields(reader: &Reader<'_>) -> Result<Self, InputError>;

    /// Writes the common fields only, not the fields of the selected variant.
    fn write_fields(&self, writer: &mut Writer);

    /// Creates a writer for the table.
    fn start(&self) -> Writer {
        Writer::new(Self::section())
    }

    /// Writes the fields of the selected variant.
    fn write_chosen(&self, _: &mut Writer) {}

    /// Reads the complete table, without checking that the fields are consistent.
    fn read(reader: Reader<'_>) -> Result<Self, InputError> {
        let read = Self::read_fields(&reader)?;
        reader.finish();
        Ok(read)
    }

    /// Writes the complete table: the common fields, then the fields of the selected variant.
    fn write(&self) -> Table {
        let mut writer = self.start();
        self.write_fields(&mut writer);
        self.write_chosen(&mut writer);
        writer.finish()
    }
}

/// A Rust type that can hold the value of a field.
pub trait Held: Sized {
    /// Reads the value of a field.
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError>;

    /// Writes the value of a field.
    fn write(&self, writer: &mut Writer, name: &'static str);

    /// Reads the value of a field; returns `None` if the field is absent.
    fn read_optional(reader: &Reader<'_>, name: &'static str) -> Result<Option<Self>, InputError> {
        (!reader.leaves_out(name)).then(|| Self::read(reader, name)).transpose()
    }

    /// Marks a field as intentionally not written.
    fn omit(writer: &mut Writer, name: &'static str) {
        writer.omit(&[name]);
    }

    /// Reads the value of a field, or clones `known` if the field is absent.
    fn read_over(reader: &Reader<'_>, name: &'static str, known: &Self) -> Result<Self, InputError>
    where
        Self: Clone,
    {
        if reader.leaves_out(name) { Ok(known.clone()) } else { Self::read(reader, name) }
    }
}

/// A plain number, or a quantity in SI units.
impl Held for f64 {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        if is_plain(reader.kind_of(name)) { reader.number(name) } else { reader.quantity(name) }
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        if is_plain(writer.kind_of(name)) {
            writer.number(name, *self);
        } else {
            writer.quantity(name, *self);
        }
    }

    fn read_optional(reader: &Reader<'_>, name: &'static str) -> Result<Option<Self>, InputError> {
        let kind = reader.kind_of(name);
        if has_word(kind) {
            reader.word_or_quantity(name)
        } else if is_plain(kind) {
            reader.optional_number(name)
        } else {
            reader.optional_quantity(name)
        }
    }

    fn omit(writer: &mut Writer, name: &'static str) {
        if has_word(writer.kind_of(name)) {
            writer.word_or_quantity(name, None);
        } else {
            writer.omit(&[name]);
        }
    }
}

fn is_plain(kind: Kind) -> bool {
    matches!(kind, Kind::Number(_))
}

/// An optional value. `None` represents an absent field, or the word that the field accepts ([`Kind::WordOr`]).
impl<T: Held> Held for Option<T> {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        T::read_optional(reader, name)
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        match self {
            Some(value) => value.write(writer, name),
            None => T::omit(writer, name),
        }
    }
}

fn has_word(kind: Kind) -> bool {
    matches!(kind, Kind::WordOr(..))
}

/// Implements [`Held`] for each listed type, using the given functions for reading and writing.
macro_rules! held {
    ($($type:ty: $read:expr, $write:expr;)*) => {$(
        impl Held for $type {
            fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
                $read(reader, name)
            }

            fn write(&self, writer: &mut Writer, name: &'static str) {
                let write: fn(&mut Writer, &'static str, &Self) = $write;
                write(writer, name, self);
            }
        }
    )*};
}

held! {
    [f64; 2]: Reader::point, |writer, name, value| writer.point(name, *value);
    [f64; 3]: Reader::triple, |writer, name, value| writer.triple(name, *value);
    String: Reader::text, |writer, name, value| writer.text(name, value);
    [String; 2]: Reader::pair, Writer::pair;
    u32: Reader::integer, |writer, name, value| writer.integer(name, *value);
    bool: Reader::flag, |writer, name, value| writer.flag(name, *value);
    Vec<[f64; 2]>: Reader::points, |writer, name, value| writer.points(name, value);
}

/// A list of tables.
impl<T: Declared> Held for Vec<T> {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        reader.sections(name)?.into_iter().map(T::read).collect()
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        writer.tables(name, self.iter().map(T::write).collect());
    }
}

/// A member of a closed set.
///
/// If the field is absent and has no fixed default, the first member is read as a placeholder. The caller
/// replaces it.
impl<T: Named> Held for T {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        if reader.leaves_out(name) { Ok(T::NAMES[0].1) } else { reader.choice(name) }
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        writer.choice(name, *self);
    }
}

/// Declares a type and the table it is read from.
///
/// Each field is listed once with its type, kind and default; its doc comment is also its help text. `as` gives the key
/// of the field in files if the key differs from the Rust name. `by` names the tag field, whose value selects a variant
/// with fields of its own; the type of the tag field is declared with [`choices!`](crate::choices!).
///
/// ```
/// use barrelstack_input::declared::Declared;
/// use barrelstack_input::field::{Default, Kind, Range};
/// use barrelstack_input::{Dimension, section};
///
/// section! {
///     /// A spring that fails when its strength is exceeded.
///     #[derive(Clone, Debug, PartialEq)]
///     pub struct Spring;
///     /// A spring.
///     pub static SPRING = "spring";
///     /// Force per elongation.
///     stiffness: f64 = Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Required;
///     /// Force above which the spring fails; unlimited if absent.
///     strength: Option<f64> = Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
/// }
///
/// let spring = Spring { stiffness: 1e5, strength: None };
/// assert_eq!(SPRING.help, "A spring.");
/// assert_eq!(SPRING.fields[0].example(), "`stiffness = \"9.8 kN/cm\"`");
/// assert_eq!(barrelstack_input::writer::to_toml(&spring.write()), "stiffness = \"100000 N/m\"\n");
/// ```
#[macro_export]
macro_rules! section {
    (
        $(#[$about:meta])*
        $visible:vis struct $type:ident;
        $(#[doc = $help:literal])+
        $vis:vis static $section:ident = $name:literal $(, at most one of $rivals:expr)? $(, by $tag:ident of $choices:expr)?;
        $(
            $(#[doc = $text:literal])+
            $field:ident $(as $key:literal)?: $held:ty = $kind:expr, $default:expr;
        )*
    ) => {
        $(#[$about])*
        $visible struct $type {
            $(
                #[doc = concat!($($text),+)]
                #[doc = concat!("\n\nIn files: `", stringify!($kind), "`, `", stringify!($default), "`.")]
                pub $field: $held,
            )*
        }

        $crate::table! {
            $(#[doc = $help])+
            $vis static $section = $name;
            $($(#[doc = $text])+ $field $(as $key)? = $kind, $default;)*
            $(of $choices, by $tag;)?
            $(at most one of $rivals;)?
        }

        impl $crate::declared::Declared for $type {
            fn section() -> &'static $crate::field::Section {
                &$section
            }

            fn read_fields(
                reader: &$crate::reader::Reader<'_>,
            ) -> ::std::result::Result<Self, $crate::InputError> {
                Ok(Self {
                    $($field: $crate::declared::Held::read(
                        reader,
                        $crate::first!($($key,)? stringify!($field)),
                    )?,)*
                })
            }

            fn write_fields(&self, writer: &mut $crate::writer::Writer) {
                $($crate::declared::Held::write(
                    &self.$field,
                    writer,
                    $crate::first!($($key,)? stringify!($field)),
                );)*
            }

            $(
                fn start(&self) -> $crate::writer::Writer {
                    let name = $crate::choices::Chosen::name(&self.$tag);
                    $crate::writer::Writer::chosen(&$section, name)
                }

                fn write_chosen(&self, writer: &mut $crate::writer::Writer) {
                    $crate::choices::Chosen::write_chosen(&self.$tag, writer);
                }
            )?
        }

        impl $crate::declared::Held for $type {
            fn read(
                reader: &$crate::reader::Reader<'_>,
                name: &'static str,
            ) -> ::std::result::Result<Self, $crate::InputError> {
                $crate::declared::Declared::read(reader.section(name)?)
            }

            fn write(&self, writer: &mut $crate::writer::Writer, name: &'static str) {
                writer.table(name, $crate::declared::Declared::write(self));
            }
        }
    };
}

/// Declares a table that is read by hand-written code.
///
/// Each field is listed once with its kind and its default; its doc comment is its help text. `by` names the tag field,
/// whose value selects a variant. The fields of the variants follow in braces; alternatively, `of` refers to variants
/// declared with [`choices!`](crate::choices!). `at most one of` lists mutually exclusive fields.
///
/// ```
/// use barrelstack_input::field::{Default, Field, Kind, Range};
/// use barrelstack_input::table;
///
/// const COUNT: Field = Field::new("count", Kind::Integer(1, 9), Default::Required, "Count.");
///
/// table! {
///     /// Source of the values.
///     static DRAW = "draw";
///     /// Kind of source.
///     kind = Kind::Text, Default::Required;
///     by kind {
///         /// Values from a list.
///         "list" with [COUNT] {}
///         /// Random values.
///         "random" {
///             /// Seed of the random numbers.
///             seed = Kind::Integer(0, 9), Default::Value("1");
///         } then [COUNT]
///     }
///     at most one of &["seed", "kind"];
/// }
///
/// let random = &DRAW.variants.as_ref().unwrap().list[1];
/// assert_eq!((DRAW.fields[0].help, random.help), ("Kind of source.", "Random values."));
/// assert_eq!(random.fields.iter().map(|field| field.name).collect::<Vec<_>>(), ["seed", "count"]);
/// ```
#[macro_export]
macro_rules! table {
    (
        $(#[doc = $help:literal])+
        $vis:vis static $section:ident = $name:literal;
        $($(#[doc = $text:literal])+ $field:ident $(as $key:literal)? = $kind:expr, $default:expr;)*
        $(by $tag:ident {$(
            $(#[doc = $meaning:literal])+
            $variant:literal $(with [$($first:expr),+])? {
                $($(#[doc = $own_text:literal])+ $own:ident = $own_kind:expr, $own_default:expr;)*
            } $(then [$($last:expr),+])?
        )+})?
        $(of $choices:expr, by $chooser:ident;)?
        $(at most one of $rivals:expr;)*
    ) => {
        $(#[doc = $help])+
        $vis static $section: $crate::field::Section = $crate::field::Section {
            name: $name,
            help: concat!($($help),+).trim_ascii(),
            fields: &$crate::fields!($($(#[doc = $text])+ $field $(as $key)? = $kind, $default;)*),
            variants: $crate::first!($(Some($crate::field::Variants {
                tag: stringify!($tag),
                list: &[$($crate::field::Variant {
                    name: $variant,
                    help: concat!($($meaning),+).trim_ascii(),
                    fields: &$crate::fields!(
                        $(with [$($first),+])?
                        $($(#[doc = $own_text])+ $own = $own_kind, $own_default;)*
                        $(then [$($last),+])?
                    ),
                }),+],
            }),)? $(Some($crate::field::Variants {
                tag: stringify!($chooser),
                list: &$choices,
            }),)? None),
            exclusive: &[$($rivals),*],
        };
    };
}

/// Expands to an array of fields declared in the syntax of [`table!`](crate::table). Existing fields may be added:
/// those listed after `with` are placed before the declared fields, and those listed after `then` are placed after the
/// declared fields.
#[macro_export]
macro_rules! fields {
    (
        $(with [$($first:expr),+])?
        $($(#[doc = $text:literal])+ $field:ident $(as $key:literal)? = $kind:expr, $default:expr;)*
        $(then [$($last:expr),+])?
    ) => {
        [
            $($($first,)+)?
            $($crate::field::Field::new(
                $crate::first!($($key,)? stringify!($field)),
                $kind,
                $default,
                concat!($($text),+).trim_ascii(),
            ),)*
            $($($last,)+)?
        ]
    };
}

/// Expands to the first of its arguments; used for optional parts of declarations.
#[doc(hidden)]
#[macro_export]
macro_rules! first {
    ($first:expr $(, $other:expr)*) => {
        $first
    };
}
