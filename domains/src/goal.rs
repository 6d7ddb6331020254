//! Goals in the words of the task files: AI2-THOR's object types and property names.
//!
//! The format is the contract's ("Task files"); the embedded parser and every language model answer in it.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// What shall be true of one object: "some Fridge contains an Apple and a Lettuce".
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalEntry {
    /// A type (`Fridge`) or one object (`Fridge_1`).
    pub object: String,
    /// What it holds; a type named twice means two different objects.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contains: Vec<Content>,
    /// AI2-THOR properties and their values.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub is: BTreeMap<String, PropertyValue>,
    /// Every object of the type instead of some.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub all: bool,
    /// Entries with the same mark speak of the same object.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub same: Option<String>,
}

/// Something that is contained.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Content {
    /// A type or one object.
    Named(String),
    /// A type or one object with conditions of its own.
    With(Box<GoalEntry>),
}

impl<'de> Deserialize<'de> for Content {
    /// A derived untagged enum would say no more of a mistake than that no variant fits.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        name_or_object(deserializer, "a type, an object or a goal entry", Content::Named, |entry| {
            Content::With(Box::new(entry))
        })
    }
}

/// Reads a string as one thing and a JSON object as another.
pub(crate) fn name_or_object<'de, D: Deserializer<'de>, T: Deserialize<'de>, R>(
    deserializer: D,
    expected: &'static str,
    name: impl FnOnce(String) -> R,
    object: impl FnOnce(T) -> R,
) -> Result<R, D::Error> {
    struct Either<N, O, T>(&'static str, N, O, PhantomData<T>);
    impl<'de, R, T: Deserialize<'de>, N: FnOnce(String) -> R, O: FnOnce(T) -> R> Visitor<'de>
        for Either<N, O, T>
    {
        type Value = R;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str(self.0)
        }

        fn visit_str<E: de::Error>(self, text: &str) -> Result<R, E> {
            Ok((self.1)(text.to_string()))
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<R, A::Error> {
            T::deserialize(MapAccessDeserializer::new(map)).map(self.2)
        }
    }
    deserializer.deserialize_any(Either(expected, name, object, PhantomData))
}

/// The value of a property.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum PropertyValue {
    /// `isOpen: true`
    Flag(bool),
    /// `temperature: "Hot"`, `fillLiquid: "water"`
    Word(String),
}
