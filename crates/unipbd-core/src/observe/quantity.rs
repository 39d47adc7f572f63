//! Quantities of the diagnostics: the one table that log, JSON, `--stop-on`, Python and documents read.

use crate::math::Vector64;
use crate::phase::Phase;

/// The value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// A whole number.
    Count(u64),
    /// A real number.
    Number(f64),
    /// A vector in the plane.
    Vector(Vector64),
    /// One word of a fixed set.
    Word(&'a str),
    /// Particles by phase, in the order of [`Phase::ALL`].
    ByPhase([u64; Phase::ALL.len()]),
}

impl Value<'_> {
    /// The values of the [columns](Quantity::columns): two of a vector, one for each phase, else one.
    pub fn columns(self) -> Vec<Self> {
        match self {
            Value::Vector(vector) => vec![Value::Number(vector.x), Value::Number(vector.y)],
            Value::ByPhase(counts) => counts.map(Value::Count).to_vec(),
            single => vec![single],
        }
    }

    /// The value as a real number; `None` for one that is a word or has several columns.
    pub fn number(self) -> Option<f64> {
        match self {
            Value::Count(count) => Some(count as f64),
            Value::Number(number) => Some(number),
            Value::Vector(_) | Value::Word(_) | Value::ByPhase(_) => None,
        }
    }
}

/// One quantity of a table: its declaration, and how it is read and written.
#[derive(Clone, Copy, Debug)]
pub struct Quantity<T: 'static> {
    /// Name in JSON and Python.
    pub name: &'static str,
    /// Unit; `1` for a fraction, empty for counts and words.
    pub unit: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Field number of the first column in binary formats. Never reused.
    pub tag: u32,
    /// Reads the quantity.
    pub read: fn(&T) -> Value<'static>,
    /// Sets the quantity from a value of the same kind; `None` where it follows from others.
    pub write: Option<fn(&mut T, Value<'_>)>,
}

impl<T: Default> Quantity<T> {
    /// Names in flat tables, where a vector and counts by phase take several columns: `momentum_x`, `count_liquid`.
    pub fn columns(&self) -> Vec<String> {
        match (self.read)(&T::default()) {
            Value::Vector(_) => ["x", "y"].map(|axis| format!("{}_{axis}", self.name)).to_vec(),
            Value::ByPhase(_) => Phase::ALL.map(|phase| format!("count_{}", phase.name())).to_vec(),
            Value::Count(_) | Value::Number(_) | Value::Word(_) => vec![self.name.to_owned()],
        }
    }
}

/// A type whose quantities are in a table.
///
/// ```
/// # use unipbd_core::{BuildOptions, scene::*};
/// # use unipbd_core::observe::{Diagnostics, Table};
/// # let water = vec![Liquid::new("water", 1000.0)];
/// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
/// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
/// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
/// let solver = scene.build(BuildOptions::default())?;
/// let now = solver.diagnostics();
/// for quantity in Diagnostics::QUANTITIES {
///     println!("{} [{}]: {:?}", quantity.name, quantity.unit, (quantity.read)(&now));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Table: Default + 'static {
    /// Name of the type.
    const TYPE: &'static str;
    /// Its quantities, in order.
    const QUANTITIES: &'static [Quantity<Self>];
}

/// A table with one named entry per material, group or wall.
pub trait Entry: Table {
    /// Name of the list of entries.
    const LIST: &'static str;
    /// Field number of the list in binary formats.
    const TAG: u32;

    /// Name of this entry.
    fn name(&self) -> &str;

    /// An entry whose quantities have their default values.
    fn named(name: &str) -> Self;
}

/// The type of a field that holds a quantity.
pub(super) trait Field {
    /// The value of the field.
    fn value(&self) -> Value<'static>;

    /// Sets the field; a value of another kind is ignored.
    fn set(&mut self, value: Value<'_>);
}

macro_rules! plain_fields {
    ($($type:ty: $kind:ident, $in:expr, $out:expr;)*) => { $(
        impl Field for $type {
            fn value(&self) -> Value<'static> {
                Value::$kind($in(*self))
            }

            fn set(&mut self, value: Value<'_>) {
                if let Value::$kind(value) = value {
                    *self = $out(value);
                }
            }
        }
    )* };
}

plain_fields! {
    f64: Number, f64::from, f64::from;
    u64: Count, u64::from, u64::from;
    u32: Count, u64::from, |count| u32::try_from(count).unwrap_or(u32::MAX);
    Vector64: Vector, Vector64::from, Vector64::from;
    [u64; Phase::ALL.len()]: ByPhase, From::from, From::from;
}

/// Declares a struct and the table of its quantities at once.
///
/// A quantity is a field with `#[quantity(TAG)]` or `#[quantity(TAG, UNIT)]`; its doc comment, one sentence without
/// the unit, is its description. `derived` lists quantities that follow from others, `beside` fields that are none.
macro_rules! table {
    (
        $(#[$about:meta])*
        pub struct $table:ident {
            $(
                $(#[doc = $description:literal])+
                #[quantity($tag:literal $(, $unit:literal)?)]
                pub $field:ident: $type:ty,
            )*
        }
        derived {
            $(
                $(#[doc = $derived_description:literal])+
                #[quantity($derived_tag:literal $(, $derived_unit:literal)?)]
                $derived:ident = $read:expr,
            )*
        }
        beside {
            $( $(#[$beside_about:meta])* pub $beside:ident: $beside_type:ty, )*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct $table {
            $(
                $(#[doc = $description])+
                $(#[doc = concat!(" Unit: `", $unit, "`.")])?
                pub $field: $type,
            )*
            $( $(#[$beside_about])* pub $beside: $beside_type, )*
        }

        impl Table for $table {
            const TYPE: &'static str = stringify!($table);
            const QUANTITIES: &'static [Quantity<Self>] = &[
                $(
                    Quantity {
                        name: stringify!($field),
                        unit: concat!($($unit)?),
                        description: concat!($($description),+).trim_ascii(),
                        tag: $tag,
                        read: |from| Field::value(&from.$field),
                        write: Some(|to, value| Field::set(&mut to.$field, value)),
                    },
                )*
                $(
                    Quantity {
                        name: stringify!($derived),
                        unit: concat!($($derived_unit)?),
                        description: concat!($($derived_description),+).trim_ascii(),
                        tag: $derived_tag,
                        read: |from| Field::value(&$read(from)),
                        write: None,
                    },
                )*
            ];
        }
    };
}

/// Declares a table with named entries as `table!` does; `LIST = TAG` names their list.
macro_rules! entries {
    (
        $list:ident = $list_tag:literal;
        $(#[$about:meta])*
        pub struct $table:ident { $($quantities:tt)* }
    ) => {
        table! {
            $(#[$about])*
            pub struct $table { $($quantities)* }
            derived {}
            beside {
                /// Name of the entry.
                pub name: String,
            }
        }

        impl Entry for $table {
            const LIST: &'static str = stringify!($list);
            const TAG: u32 = $list_tag;

            fn name(&self) -> &str {
                &self.name
            }

            fn named(name: &str) -> Self {
                $table { name: name.to_owned(), ..$table::default() }
            }
        }
    };
}

pub(super) use {entries, table};
