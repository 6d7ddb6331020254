//! The state as the facts that tasks speak of.

use std::collections::BTreeSet;

use super::{House, Object, Place, Warmth};

/// The predicates that are compared. The domain keeps others besides, which follow from these.
pub const COMPARED: [&str; 17] = [
    "at",
    "holding",
    "in",
    "open",
    "toggled",
    "sliced",
    "broken",
    "cooked",
    "dirty",
    "filled",
    "filled-with",
    "hot",
    "cold",
    "used-up",
    "moved",
    "supporting",
    "helping",
];

impl House {
    /// Every fact of a compared predicate that holds: `in Apple_1 Fridge_1`.
    pub fn facts(&self) -> BTreeSet<String> {
        let mut facts = BTreeSet::new();
        for object in self.things.values() {
            self.facts_of(object, &mut facts);
        }
        for (r, agent) in &self.agents {
            facts.extend(agent.at.iter().map(|x| format!("at {r} {x}")));
            facts.extend(agent.offers.iter().map(|x| format!("supporting {r} {x}")));
            facts.extend(agent.follows.iter().map(|l| format!("helping {r} {l}")));
        }
        facts
    }

    fn facts_of(&self, object: &Object, facts: &mut BTreeSet<String>) {
        let x = &object.thing.name;
        match &object.place {
            Place::In(c) => drop(facts.insert(format!("in {x} {c}"))),
            Place::Held(r) => drop(facts.insert(format!("holding {r} {x}"))),
            Place::Fixed => {}
        }
        // A burner is on when its knob is.
        let on = object.on || object.thing.kind == "StoveBurner" && self.is_hot_device(x);
        for (holds, predicate) in [
            (object.open, "open"),
            (on, "toggled"),
            (object.sliced, "sliced"),
            (object.broken, "broken"),
            (object.cooked, "cooked"),
            (object.dirty, "dirty"),
            (object.filled, "filled"),
            (object.used_up, "used-up"),
            (object.moved, "moved"),
            (object.warmth == Warmth::Hot, "hot"),
            (object.warmth == Warmth::Cold, "cold"),
        ] {
            if holds {
                facts.insert(format!("{predicate} {x}"));
            }
        }
        facts.extend(object.liquid.iter().map(|l| format!("filled-with {x} {l}")));
    }
}
