//! Single declaration of a table: the type, its fields, and how they are read and written.

use crate::error::InputError;
use crate::field::{Kind, Named, Section};
use crate::reader::Reader;
use crate::tree::Table;
use crate::writer::Writer;

/// A type declared together with its fields in files; declared by [`section!`](crate::section).
pub trait Declared: Sized {
    /// Returns the definition of the table.
    fn section() -> &'static Section;

    /// Reads the fields; the caller checks their consistency and calls [`Reader::finish`].
    fn read_fields(reader: &Reader<'_>) -> Result<Self, InputError>;

    /// Writes the fields, except those of the selected variant.
    fn write_fields(&self, writer: &mut Writer);

    /// Starts the table.
    fn start(&self) -> Writer {
        Writer::new(Self::section())
    }

    /// Writes the fields of the selected variant.
    fn write_chosen(&self, _: &mut Writer) {}

    /// Reads a table that has only these fields and no constraints between them.
    fn read(reader: Reader<'_>) -> Result<Self, InputError> {
        let read = Self::read_fields(&reader)?;
        reader.finish();
        Ok(read)
    }

    /// Writes a table that has only these fields.
    fn write(&self) -> Table {
        let mut writer = self.start();
        self.write_fields(&mut writer);
        self.write_chosen(&mut writer);
        writer.finish()
    }
}

/// A type that a field of a declared type may have.
pub trait Held: Sized {
    /// Reads the field.
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError>;

    /// Writes the field.
    fn write(&self, writer: &mut Writer, name: &'static str);

    /// Reads the field; `None` if it is absent.
    fn read_optional(reader: &Reader<'_>, name: &'static str) -> Result<Option<Self>, InputError> {
        (!reader.leaves_out(name)).then(|| Self::read(reader, name)).transpose()
    }

    /// Omits the field.
    fn omit(writer: &mut Writer, name: &'static str) {
        writer.omit(&[name]);
    }

    /// Reads the field, falling back to `known`.
    fn read_over(reader: &Reader<'_>, name: &'static str, known: &Self) -> Result<Self, InputError>
    where
        Self: Clone,
    {
        if reader.leaves_out(name) { Ok(known.clone()) } else { Self::read(reader, name) }
    }
}

/// A plain number, or a quantity in SI.
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

/// An optional field, or one that allows a word in place of the value.
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

/// Implements [`Held`] for a type by a reading and a writing function.
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

/// A member of a closed set; if absent with a derived default, the first member, which the caller corrects.
impl<T: Named> Held for T {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        if reader.leaves_out(name) { Ok(T::NAMES[0].1) } else { reader.choice(name) }
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        writer.choice(name, *self);
    }
}

/// Declares a type with the table that it is read from: each field once, with its type, its kind, its default
/// and its doc comment, which is its help; `as` gives its key in files, if that differs.
///
/// A table whose further fields are selected `by` one of its fields says so, and the type of that field is declared by
/// [`choices!`](crate::choices!).
///
/// ```
/// use barrelstack_input::declared::Declared;
/// use barrelstack_input::field::{Default, Kind, Range};
/// use barrelstack_input::{Dimension, section};
///
/// section! {
///     /// A spring that ends when it tears.
///     #[derive(Clone, Debug, PartialEq)]
///     pub struct Spring;
///     /// A spring.
///     pub static SPRING = "spring";
///     /// Force per elongation.
///     stiffness: f64 = Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Required;
///     /// Force above which it tears; without it it never does.
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

/// Declares a table that is read by hand: each field once, with what it holds, what an absent one means, and its help,
/// which is its doc comment; then the fields that depend on one of them, listed here or
/// by [`choices!`](crate::choices!), and those of which at most one may be given.
///
/// ```
/// use barrelstack_input::field::{Default, Field, Kind, Range};
/// use barrelstack_input::table;
///
/// const COUNT: Field = Field::new("count", Kind::Integer(1, 9), Default::Required, "How many.");
///
/// table! {
///     /// How values are drawn.
///     static DRAW = "draw";
///     /// The form.
///     kind = Kind::Text, Default::Required;
///     by kind {
///         /// One after the other.
///         "list" with [COUNT] {}
///         /// At random.
///         "random" {
///             /// Start of all numbers.
///             seed = Kind::Integer(0, 9), Default::Value("1");
///         } then [COUNT]
///     }
///     at most one of &["seed", "kind"];
/// }
///
/// let random = &DRAW.variants.as_ref().unwrap().list[1];
/// assert_eq!((DRAW.fields[0].help, random.help), ("The form.", "At random."));
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

/// A list of fields in the words of [`table!`](crate::table): each once, under its name or the key in its place, between
/// others that are known.
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

/// The first of some, for what may be left out of a declaration.
#[doc(hidden)]
#[macro_export]
macro_rules! first {
    ($first:expr $(, $other:expr)*) => {
        $first
    };
}
