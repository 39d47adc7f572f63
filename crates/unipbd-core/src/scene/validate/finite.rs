//! Finds NaN and infinity in every number of a scene, whatever its kind: by walking what serde
//! would write.

use serde::Serialize;
use serde::ser::{self, Serializer};

use super::checker::Checker;
use crate::scene::{KeyPath, KeySegment};

pub(super) fn check(checker: &mut Checker) {
    let mut finder = Finder::default();
    // A scene is plain data: writing it into the finder cannot fail.
    let _ = checker.scene.serialize(&mut finder);
    for (path, value) in finder.found {
        let value = if value.is_nan() { "nan" } else { "an infinite number" };
        checker.problem(
            path,
            format!("must be a finite number, found {value}"),
            "write an ordinary number, such as 1.5",
        );
    }
}

/// A serializer that writes nothing and remembers where numbers are not finite.
#[derive(Default)]
struct Finder {
    path: Vec<KeySegment>,
    found: Vec<(KeyPath, f64)>,
}

type Done = Result<(), std::fmt::Error>;

impl Finder {
    fn inside<T: Serialize + ?Sized>(&mut self, segment: KeySegment, value: &T) -> Done {
        self.path.push(segment);
        let done = value.serialize(&mut *self);
        self.path.pop();
        done
    }
}

/// The elements of an array, a table or a map.
struct Entries<'a> {
    finder: &'a mut Finder,
    index: usize,
}

impl Entries<'_> {
    fn element<T: Serialize + ?Sized>(&mut self, value: &T) -> Done {
        let segment = KeySegment::Index(self.index);
        self.index += 1;
        self.finder.inside(segment, value)
    }

    fn field<T: Serialize + ?Sized>(&mut self, key: &str, value: &T) -> Done {
        self.finder.inside(KeySegment::Key(key.to_owned()), value)
    }
}

macro_rules! ignore {
    ($($method:ident: $kind:ty),* $(,)?) => {
        $(fn $method(self, _: $kind) -> Done { Ok(()) })*
    };
}

impl<'a> Serializer for &'a mut Finder {
    type Ok = ();
    type Error = std::fmt::Error;
    type SerializeSeq = Entries<'a>;
    type SerializeTuple = Entries<'a>;
    type SerializeTupleStruct = Entries<'a>;
    type SerializeTupleVariant = Entries<'a>;
    type SerializeMap = Entries<'a>;
    type SerializeStruct = Entries<'a>;
    type SerializeStructVariant = Entries<'a>;

    ignore! {
        serialize_bool: bool, serialize_char: char, serialize_str: &str, serialize_bytes: &[u8],
        serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64,
        serialize_unit_struct: &'static str,
    }

    fn serialize_f32(self, value: f32) -> Done {
        self.serialize_f64(f64::from(value))
    }

    fn serialize_f64(self, value: f64) -> Done {
        if !value.is_finite() {
            self.found.push((KeyPath(self.path.clone()), value));
        }
        Ok(())
    }

    fn serialize_none(self) -> Done {
        Ok(())
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Done {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Done {
        Ok(())
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Done {
        Ok(())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Done {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Done {
        self.inside(KeySegment::Key(variant.to_owned()), value)
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }

    fn serialize_tuple(self, _: usize) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Entries<'a>, Self::Error> {
        Ok(Entries { finder: self, index: 0 })
    }
}

macro_rules! elements {
    ($($kind:ident::$method:ident),*) => {
        $(impl ser::$kind for Entries<'_> {
            type Ok = ();
            type Error = std::fmt::Error;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Done {
                self.element(value)
            }

            fn end(self) -> Done {
                Ok(())
            }
        })*
    };
}

elements!(
    SerializeSeq::serialize_element,
    SerializeTuple::serialize_element,
    SerializeTupleStruct::serialize_field,
    SerializeTupleVariant::serialize_field
);

macro_rules! fields {
    ($($kind:ident),*) => {
        $(impl ser::$kind for Entries<'_> {
            type Ok = ();
            type Error = std::fmt::Error;

            fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Done {
                self.field(key, value)
            }

            fn end(self) -> Done {
                Ok(())
            }
        })*
    };
}

fields!(SerializeStruct, SerializeStructVariant);

impl ser::SerializeMap for Entries<'_> {
    type Ok = ();
    type Error = std::fmt::Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, _: &T) -> Done {
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Done {
        self.element(value)
    }

    fn end(self) -> Done {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Gas, Scene};

    #[test]
    fn numbers_that_are_not_finite_are_found_at_every_depth() {
        let gas = Gas { lifetime: Some(f64::INFINITY), ..Gas::default() };
        let scene = Scene { gravity: [0.0, f64::NAN], gas: vec![Gas::default(), gas], ..Scene::default() };
        let mut finder = Finder::default();
        scene.serialize(&mut finder).unwrap();
        let paths: Vec<String> = finder.found.iter().map(|(path, _)| path.to_string()).collect();
        assert_eq!(paths, ["gravity[1]", "gas[1].lifetime"]);
    }
}
