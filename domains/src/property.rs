//! AI2-THOR's object properties: which types have them, and what they are in PDDL.

use std::collections::BTreeMap;

use lamma_pddl::ast::{Atom, Condition, Term, TypedName};

use crate::goal::PropertyValue;
use crate::kinds::{self, Kinds};
use crate::nearest;

/// A property that goals and starting states speak of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Property {
    /// `isOpen`
    Open,
    /// `isToggled`
    Toggled,
    /// `isSliced`
    Sliced,
    /// `isCooked`
    Cooked,
    /// `isBroken`
    Broken,
    /// `isDirty`
    Dirty,
    /// `isUsedUp`
    UsedUp,
    /// `isPickedUp`
    PickedUp,
    /// `isFilledWithLiquid`
    Filled,
    /// `fillLiquid`
    FillLiquid,
    /// `temperature`
    Temperature,
}

/// AI2-THOR's name, our property, the predicate of a flag.
const TABLE: [(&str, Property, &str); 11] = [
    ("isOpen", Property::Open, "open"),
    ("isToggled", Property::Toggled, "toggled"),
    ("isSliced", Property::Sliced, "sliced"),
    ("isCooked", Property::Cooked, "cooked"),
    ("isBroken", Property::Broken, "broken"),
    ("isDirty", Property::Dirty, "dirty"),
    ("isUsedUp", Property::UsedUp, "used-up"),
    ("isPickedUp", Property::PickedUp, ""),
    ("isFilledWithLiquid", Property::Filled, "filled"),
    ("fillLiquid", Property::FillLiquid, ""),
    ("temperature", Property::Temperature, ""),
];

/// The liquids there are.
pub const LIQUIDS: [&str; 3] = ["water", "coffee", "wine"];
/// The temperatures there are.
pub const TEMPERATURES: [&str; 3] = ["Hot", "Cold", "RoomTemp"];

impl Property {
    /// The property of that AI2-THOR name, or what is wrong with the name.
    pub fn parse(name: &str) -> Result<Property, String> {
        TABLE.iter().find(|(n, ..)| *n == name).map(|(_, p, _)| *p).ok_or_else(|| {
            let names = TABLE.iter().map(|(n, ..)| *n);
            let list: Vec<&str> = names.clone().collect();
            format!(
                "unknown property `{name}`{}; properties are: {}",
                nearest::hint(name, names),
                list.join(" ")
            )
        })
    }

    /// Its AI2-THOR name.
    pub fn name(self) -> &'static str {
        TABLE.iter().find(|(_, p, _)| *p == self).map_or("", |(n, ..)| n)
    }

    /// The predicate of a flag; empty for what is not one fact of one object.
    pub(crate) fn predicate(self) -> &'static str {
        TABLE.iter().find(|(_, p, _)| *p == self).map_or("", |(.., predicate)| predicate)
    }

    /// Whether things of the type, with these affordances, have it.
    pub fn applies(self, kind: &str, can: impl Fn(&str) -> bool) -> bool {
        match self {
            Property::Open => can("openable"),
            // A burner is on or off, but only its knob can be switched.
            Property::Toggled => can("toggleable") || kind == "StoveBurner",
            Property::Sliced => can("sliceable"),
            Property::Cooked => can("cookable") || kinds::cooks_when_cut(kind),
            Property::Broken => can("breakable"),
            Property::Dirty => can("dirtyable") || kinds::washable(kind),
            Property::UsedUp => kinds::consumable(kind),
            Property::PickedUp => can("pickupable"),
            Property::Filled | Property::FillLiquid => can("canFillWithLiquid"),
            Property::Temperature => true,
        }
    }

    /// What is wrong with the value, if anything.
    pub fn check_value(self, value: &PropertyValue) -> Result<(), String> {
        let one_of = |words: &[&str], given: &str| {
            if words.contains(&given) {
                Ok(())
            } else {
                let hint = nearest::hint(given, words.iter().copied());
                Err(format!(
                    "`{}` cannot be \"{given}\"{hint}; give one of: {}",
                    self.name(),
                    words.join(" ")
                ))
            }
        };
        match (self, value) {
            (Property::FillLiquid, PropertyValue::Word(word)) => one_of(&LIQUIDS, word),
            (Property::Temperature, PropertyValue::Word(word)) => one_of(&TEMPERATURES, word),
            (Property::FillLiquid, _) => Err(format!("`fillLiquid` is one of: {}", LIQUIDS.join(" "))),
            (Property::Temperature, _) => Err(format!("`temperature` is one of: {}", TEMPERATURES.join(" "))),
            (_, PropertyValue::Flag(_)) => Ok(()),
            (_, PropertyValue::Word(word)) => {
                Err(format!("`{}` is true or false, not \"{word}\"", self.name()))
            }
        }
    }

    /// That `x` has this value of the property. The value has been checked.
    pub fn condition(self, x: &Term, value: &PropertyValue) -> Condition {
        let atom = |predicate: &str, args: &[&Term]| {
            Condition::Atom(Atom {
                predicate: predicate.into(),
                args: args.iter().map(|t| (*t).clone()).collect(),
            })
        };
        let not = |condition| Condition::Not(Box::new(condition));
        match (self, value) {
            (Property::Temperature, PropertyValue::Word(word)) => match word.as_str() {
                "Hot" => atom("hot", &[x]),
                "Cold" => atom("cold", &[x]),
                _ => Condition::And(vec![not(atom("hot", &[x])), not(atom("cold", &[x]))]),
            },
            (Property::FillLiquid, PropertyValue::Word(word)) => {
                atom("filled-with", &[x, &Term::Constant(word.as_str().into())])
            }
            (Property::PickedUp, PropertyValue::Flag(yes)) => {
                let robot = Term::Variable("holder".into());
                let held = Condition::Exists(
                    vec![TypedName::new("holder", "robot")],
                    Box::new(atom("holding", &[&robot, x])),
                );
                if *yes { held } else { not(held) }
            }
            (flag, PropertyValue::Flag(true)) => atom(flag.predicate(), &[x]),
            (flag, _) => not(atom(flag.predicate(), &[x])),
        }
    }
}

/// What is wrong with properties given for a type, if anything.
pub fn check_properties(kind: &str, is: &BTreeMap<String, PropertyValue>) -> Result<(), String> {
    let of = Kinds::get().find(kind);
    for (name, value) in is {
        let property = Property::parse(name)?;
        property.check_value(value)?;
        if !property.applies(kind, |a| of.is_some_and(|k| k.is(a))) {
            return Err(format!("a {kind} has no `{name}`"));
        }
    }
    Ok(())
}
