//! Finds NaN and infinity in every number of a scene, by a serializer that writes nothing.

use std::fmt::Error;

use serde::ser::{Impossible, Serialize, SerializeSeq, SerializeStruct, SerializeTuple, Serializer};

use super::checker::Checker;
use crate::scene::{KeyPath, KeySegment};

pub(super) fn check(checker: &mut Checker) {
    for (path, value) in not_finite(checker.scene) {
        let value = if value.is_nan() { "nan" } else { "an infinite number" };
        let message = format!("must be a finite number, found {value}");
        checker.problem(path, message, "write an ordinary number, such as 1.5");
    }
}

fn not_finite(scene: &impl Serialize) -> Vec<(KeyPath, f64)> {
    let mut finder = Finder::default();
    let done = scene.serialize(&mut finder);
    debug_assert!(done.is_ok(), "the finder does not support maps and enumerations with data");
    finder.found
}

/// Remembers where numbers are not finite.
#[derive(Default)]
struct Finder {
    /// Path of the value that is serialized. Arrays and tables add the segment of their first entry, which `visit`
    /// replaces from entry to entry and `leave` takes away.
    path: Vec<KeySegment>,
    found: Vec<(KeyPath, f64)>,
}

type Done = Result<(), Error>;

impl Finder {
    fn enter(&mut self) -> Result<&mut Self, Error> {
        self.path.push(KeySegment::Index(0));
        Ok(self)
    }

    fn visit<T: Serialize + ?Sized>(&mut self, value: &T, key: Option<&str>) -> Done {
        if let (Some(segment), Some(key)) = (self.path.last_mut(), key) {
            *segment = KeySegment::Key(key.to_owned());
        }
        value.serialize(&mut *self)?;
        if let Some(KeySegment::Index(index)) = self.path.last_mut() {
            *index += 1;
        }
        Ok(())
    }

    fn leave(&mut self) -> Done {
        self.path.pop();
        Ok(())
    }
}

/// Methods that have one answer whatever their arguments.
macro_rules! answer {
    ($result:ty, $answer:expr; $($method:ident($($kind:ty),*))*) => {
        $(fn $method(self, $(_: $kind),*) -> Result<$result, Error> { $answer(self) })*
    };
}

impl<'a> Serializer for &'a mut Finder {
    type Ok = ();
    type Error = Error;
    type SerializeSeq = &'a mut Finder;
    type SerializeTuple = &'a mut Finder;
    type SerializeStruct = &'a mut Finder;
    type SerializeTupleStruct = Impossible<(), Error>;
    type SerializeTupleVariant = Impossible<(), Error>;
    type SerializeMap = Impossible<(), Error>;
    type SerializeStructVariant = Impossible<(), Error>;

    fn serialize_f64(self, value: f64) -> Done {
        if !value.is_finite() {
            self.found.push((KeyPath(self.path.clone()), value));
        }
        Ok(())
    }

    fn serialize_f32(self, value: f32) -> Done {
        self.serialize_f64(f64::from(value))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Done {
        value.serialize(self)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Done {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(self, _: &'static str, _: u32, _: &'static str, _: &T) -> Done {
        Err(Error)
    }

    answer! { (), |_| Ok(());
        serialize_bool(bool) serialize_char(char) serialize_str(&str) serialize_bytes(&[u8])
        serialize_i8(i8) serialize_i16(i16) serialize_i32(i32) serialize_i64(i64)
        serialize_u8(u8) serialize_u16(u16) serialize_u32(u32) serialize_u64(u64)
        serialize_none() serialize_unit() serialize_unit_struct(&'static str)
        serialize_unit_variant(&'static str, u32, &'static str)
    }
    answer! { &'a mut Finder, Finder::enter;
        serialize_seq(Option<usize>) serialize_tuple(usize) serialize_struct(&'static str, usize)
    }
    answer! { Impossible<(), Error>, |_| Err(Error);
        serialize_tuple_struct(&'static str, usize) serialize_map(Option<usize>)
        serialize_tuple_variant(&'static str, u32, &'static str, usize)
        serialize_struct_variant(&'static str, u32, &'static str, usize)
    }
}

macro_rules! entries {
    ($($kind:ident::$method:ident($($key:ident)?) $name:expr;)*) => {
        $(impl $kind for &mut Finder {
            type Ok = ();
            type Error = Error;

            fn $method<T: Serialize + ?Sized>(&mut self, $($key: &'static str,)? value: &T) -> Done {
                self.visit(value, $name)
            }

            fn end(self) -> Done {
                self.leave()
            }
        })*
    };
}

entries! {
    SerializeSeq::serialize_element() None;
    SerializeTuple::serialize_element() None;
    SerializeStruct::serialize_field(key) Some(key);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Gas, Scene};

    #[test]
    fn numbers_that_are_not_finite_are_found_at_every_depth() {
        let gas = Gas { lifetime: Some(f64::INFINITY), ..Gas::default() };
        let scene = Scene { gravity: [0.0, f64::NAN], gas: vec![Gas::default(), gas], ..Scene::default() };
        let paths: Vec<String> = not_finite(&scene).iter().map(|(path, _)| path.to_string()).collect();
        assert_eq!(paths, ["gravity[1]", "gas[1].lifetime"]);
    }
}
