//! Declaration of types whose default values come from a catalog entry.

/// Declares a type whose fields in a file override the fields of a catalog entry.
///
/// Members that are not fields in files come first. The fields follow, in the form of
/// [`section!`](barrelstack_input::section); `as` states the key of a field in files if it differs from the name of the
/// member. A field that a file leaves out takes the value of the catalog.
macro_rules! known {
    (
        $(#[$about:meta])*
        pub struct $type:ident { $($(#[$kept:meta])* pub $own:ident: $given:ty,)* }
        $(#[doc = $list:literal])+
        const $fields:ident $(, after { $($first:tt)+ })?;
        $(
            $(#[doc = $help:literal])+
            $field:ident $(as $key:literal)?: $held:ty = $kind:expr, $default:expr;
        )+
    ) => {
        $(#[$about])*
        pub struct $type {
            $($(#[$kept])* pub $own: $given,)*
            $(
                $(#[doc = $help])+
                #[doc = concat!("\n\nIn files: `", stringify!($kind), "`, `", stringify!($default), "`.")]
                pub $field: $held,
            )+
        }

        $(#[doc = $list])+
        const $fields: &[barrelstack_input::field::Field] = &barrelstack_input::fields! {
            $($($first)+)?
            $($(#[doc = $help])+ $field $(as $key)? = $kind, $default;)+
        };

        impl $type {
            /// Reads the fields, with the values of a catalog entry as defaults.
            fn read_over(reader: &Reader<'_>, known: &Self) -> Result<Self, ScenarioError> {
                Ok(Self {
                    $($own: Clone::clone(&known.$own),)*
                    $($field: Held::read_over(
                        reader,
                        barrelstack_input::first!($($key,)? stringify!($field)),
                        &known.$field,
                    )?,)+
                })
            }

            /// Writes the fields.
            fn write_fields(&self, writer: &mut Writer) {
                $(self.$field.write(
                    writer,
                    barrelstack_input::first!($($key,)? stringify!($field)),
                );)+
            }
        }
    };
}

pub(super) use known;
