//! Goals in the words of the task files: AI2-THOR's object types and property names.
//!
//! The format is the contract's ("Task files"); the embedded parser and every language model answer in it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Content {
    /// A type or one object.
    Named(String),
    /// A type or one object with conditions of its own.
    With(Box<GoalEntry>),
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
