//! JSON in which a number that is not finite is a word: `"infinite"`, `"-infinite"` or `"not a number"`, never `null`.
//!
//! The files of a run and what the command line prints pass through [`Explicit`]. [`number`] and [`numbers`] read such values back.

use serde::de::Error as _;
use serde::ser::{self, Serialize, Serializer};
use serde::{Deserialize, Deserializer};

/// Wrapper of a value or a serializer. Numbers that are not finite become strings.
#[derive(Debug)]
pub struct Explicit<T>(pub T);

impl<T: Serialize + ?Sized> Serialize for Explicit<&T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(Explicit(serializer))
    }
}

const INFINITE: &str = "infinite";
const MINUS_INFINITE: &str = "-infinite";
const NOT_A_NUMBER: &str = "not a number";

/// Methods that pass their only argument on.
macro_rules! pass_on {
    ($($method:ident: $type:ty),*) => {
        $(fn $method(self, value: $type) -> Result<S::Ok, S::Error> { self.0.$method(value) })*
    };
}

/// Methods that begin a list or a table.
macro_rules! begin {
    ($($method:ident($($name:ident: $type:ty),*) -> $part:ident),*) => {
        $(fn $method(self, $($name: $type),*) -> Result<Self::$part, S::Error> { self.0.$method($($name),*).map(Explicit) })*
    };
}

impl<S: Serializer> Serializer for Explicit<S> {
    type Ok = S::Ok;
    type Error = S::Error;
    type SerializeSeq = Explicit<S::SerializeSeq>;
    type SerializeTuple = Explicit<S::SerializeTuple>;
    type SerializeTupleStruct = Explicit<S::SerializeTupleStruct>;
    type SerializeTupleVariant = Explicit<S::SerializeTupleVariant>;
    type SerializeMap = Explicit<S::SerializeMap>;
    type SerializeStruct = Explicit<S::SerializeStruct>;
    type SerializeStructVariant = Explicit<S::SerializeStructVariant>;

    pass_on!(serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64);
    pass_on!(serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_f32: f32);
    pass_on!(serialize_char: char, serialize_str: &str, serialize_bytes: &[u8], serialize_unit_struct: &'static str);

    fn serialize_f64(self, value: f64) -> Result<S::Ok, S::Error> {
        match value {
            f64::INFINITY => self.0.serialize_str(INFINITE),
            f64::NEG_INFINITY => self.0.serialize_str(MINUS_INFINITE),
            _ if value.is_nan() => self.0.serialize_str(NOT_A_NUMBER),
            _ => self.0.serialize_f64(value),
        }
    }

    fn serialize_none(self) -> Result<S::Ok, S::Error> {
        self.0.serialize_none()
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<S::Ok, S::Error> {
        self.0.serialize_some(&Explicit(value))
    }

    fn serialize_unit(self) -> Result<S::Ok, S::Error> {
        self.0.serialize_unit()
    }

    fn serialize_unit_variant(self, name: &'static str, index: u32, variant: &'static str) -> Result<S::Ok, S::Error> {
        self.0.serialize_unit_variant(name, index, variant)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, name: &'static str, value: &T) -> Result<S::Ok, S::Error> {
        self.0.serialize_newtype_struct(name, &Explicit(value))
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<S::Ok, S::Error> {
        self.0.serialize_newtype_variant(name, index, variant, &Explicit(value))
    }

    begin!(serialize_seq(length: Option<usize>) -> SerializeSeq, serialize_map(length: Option<usize>) -> SerializeMap);
    begin!(serialize_tuple(length: usize) -> SerializeTuple);
    begin!(serialize_tuple_struct(name: &'static str, length: usize) -> SerializeTupleStruct);
    begin!(serialize_struct(name: &'static str, length: usize) -> SerializeStruct);
    begin!(serialize_tuple_variant(name: &'static str, index: u32, variant: &'static str, length: usize) -> SerializeTupleVariant);
    begin!(serialize_struct_variant(name: &'static str, index: u32, variant: &'static str, length: usize) -> SerializeStructVariant);
}

/// Lists and tables whose values pass through [`Explicit`] as well.
macro_rules! parts {
    ($($trait:ident: $($method:ident($($key:ident)?)),+;)*) => {
        $(impl<S: ser::$trait> ser::$trait for Explicit<S> {
            type Ok = S::Ok;
            type Error = S::Error;

            $(fn $method<T: Serialize + ?Sized>(&mut self, $($key: &'static str,)? value: &T) -> Result<(), S::Error> {
                self.0.$method($($key,)? &Explicit(value))
            })+

            fn end(self) -> Result<S::Ok, S::Error> {
                self.0.end()
            }
        })*
    };
}

parts! {
    SerializeSeq: serialize_element();
    SerializeTuple: serialize_element();
    SerializeTupleStruct: serialize_field();
    SerializeTupleVariant: serialize_field();
    SerializeStruct: serialize_field(key);
    SerializeStructVariant: serialize_field(key);
    SerializeMap: serialize_key(), serialize_value();
}

/// A number or its word.
struct Number(f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Number, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a value that is no number, and no word for one")]
        enum Written {
            Finite(f64),
            Word(String),
            Null(()),
        }
        match Written::deserialize(from)? {
            Written::Finite(number) => Ok(Number(number)),
            Written::Word(word) if word == INFINITE => Ok(Number(f64::INFINITY)),
            Written::Word(word) if word == MINUS_INFINITE => Ok(Number(f64::NEG_INFINITY)),
            Written::Word(word) if word == NOT_A_NUMBER => Ok(Number(f64::NAN)),
            Written::Word(word) => Err(D::Error::custom(format!("`{word}` is no number"))),
            Written::Null(()) => Ok(Number(f64::INFINITY)),
        }
    }
}

/// Reads a number. `null`, which earlier versions wrote for a number that is not finite, is infinite.
///
/// # Errors
/// The deserializer's own, and any word but the three for numbers that are not finite.
pub fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Number::deserialize(from).map(|number| number.0)
}

/// Reads a list of numbers, each as [`number`] does.
///
/// # Errors
/// As [`number`].
pub fn numbers<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
    Vec::<Number>::deserialize(from).map(|list| list.into_iter().map(|number| number.0).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_is_not_finite_is_a_word_at_any_depth() {
        let value = (vec![Some(f64::INFINITY), None], [("a", (f64::NAN, -f64::INFINITY))], "text", 0.1, 3u8);
        let text = serde_json::to_string(&Explicit(&value)).expect("JSON");
        assert_eq!(text, r#"[["infinite",null],[["a",["not a number","-infinite"]]],"text",0.1,3]"#);
        let read = numbers(&mut serde_json::Deserializer::from_str(r#"[1.5, "infinite", null, "-infinite"]"#));
        assert_eq!(read.expect("numbers"), [1.5, f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY]);
    }
}
