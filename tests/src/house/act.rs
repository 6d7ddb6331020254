//! What robots can do, and what comes of it.

use std::collections::BTreeSet;

use lamma_domains::kinds;

use super::{House, Object, Place, Refused, Warmth};

/// Refuses with the reason unless it holds.
fn ensure(holds: bool, reason: Refused) -> Result<(), Refused> {
    if holds { Ok(()) } else { Err(reason) }
}

impl House {
    /// Does the act, given as its words, or says why it is not possible; then nothing has changed.
    pub fn act(&mut self, words: &[&str]) -> Result<(), Refused> {
        let [action, robot, args @ ..] = words else { return Err("an act names a robot") };
        let agent = self.agents.get(*robot).ok_or("there is no such robot")?;
        ensure(!agent.lost, "the robot is lost")?;
        let skill = match *action {
            "SupportObject" | "WithdrawHand" | "PickupTogether" => "PickupObject",
            "PutTogether" => "PutObject",
            skill => skill,
        };
        ensure(agent.robot.has(skill), "the robot has no such skill")?;
        match (*action, args) {
            ("GoToObject", [x]) => self.go(robot, x),
            ("PickupObject", [x, c]) => self.pick_up(robot, x, c),
            ("PutObject", [x, c]) => self.put(robot, x, c),
            ("DropHandObject", [x]) => self.drop(robot, x),
            ("ThrowObject", [x]) => self.throw(robot, x),
            ("SupportObject", [x]) => self.offer(robot, x),
            ("WithdrawHand", [x]) => self.withdraw(robot, x),
            ("PickupTogether", [g, x, c]) => self.pick_up_together(robot, g, x, c),
            ("PutTogether", [g, x, c]) => self.put_together(robot, g, x, c),
            ("FillObject", [x, liquid]) => self.pour(robot, x, liquid),
            (_, [x]) => self.work(action, robot, x),
            _ => Err("there is no such act"),
        }
    }

    /// What happens without the team, if it is possible: somebody carries a thing elsewhere, or shuts a door.
    pub fn happen(&mut self, words: &[&str]) -> Result<(), Refused> {
        match words {
            ["ObjectMoved", x, to] => self.carry_off(x, to),
            ["DoorClosed", x] => {
                let door = self.thing(x)?;
                ensure(door.thing.can("openable") && door.open, "it is no open door")?;
                ensure(self.exposed(x), "it cannot be reached")?;
                if let Some(door) = self.things.get_mut(*x) {
                    door.open = false;
                }
                Ok(())
            }
            _ => Err("there is no such event"),
        }
    }

    fn carry_off(&mut self, x: &str, to: &str) -> Result<(), Refused> {
        let object = self.thing(x)?;
        ensure(object.is_item() && !matches!(object.place, Place::Held(_)), "it does not lie anywhere")?;
        ensure(object.place != Place::In(to.to_string()), "it is there already")?;
        ensure(self.accepts(to, x) && self.accessible(to) && self.exposed(to), "it does not go there")?;
        ensure(!self.heats(to) && !self.cools(to) && !self.rinses(to), "nobody reaches into that")?;
        ensure(self.hands_on(x).is_empty(), "robots offer a hand for it")?;
        if let Some(object) = self.things.get_mut(x) {
            object.place = Place::In(to.to_string());
        }
        for agent in self.agents.values_mut() {
            agent.at.remove(x);
        }
        Ok(())
    }

    /// The robot's process is gone: what it holds or helps to hold lies on the floor.
    pub fn lose(&mut self, robot: &str) {
        let Some(agent) = self.agents.get_mut(robot) else { return };
        agent.lost = true;
        agent.at.clear();
        let (offered, leader) = (agent.offers.take(), agent.follows.take());
        let mut fallen: BTreeSet<String> = self.held_by(robot).iter().map(|o| o.thing.name.clone()).collect();
        if leader.is_some() {
            fallen.extend(offered);
        }
        let floors = self.floors();
        for x in &fallen {
            for helper in self.hands_on(x) {
                self.release(&helper, &floors);
            }
            self.lay(x, &floors);
        }
    }

    fn lay(&mut self, x: &str, floors: &BTreeSet<String>) {
        if let (Some(object), Some(floor)) = (self.things.get_mut(x), floors.first()) {
            object.place = Place::In(floor.clone());
        }
    }

    fn release(&mut self, helper: &str, at: &BTreeSet<String>) {
        if let Some(agent) = self.agents.get_mut(helper) {
            (agent.offers, agent.follows) = (None, None);
            agent.at.extend(at.iter().cloned());
        }
    }

    fn is_at(&self, robot: &str, x: &str) -> bool {
        self.agents.get(robot).is_some_and(|a| a.at.contains(x))
    }

    fn can_move(&self, robot: &str) -> bool {
        self.agents.get(robot).is_some_and(|a| a.offers.is_none())
    }

    fn go(&mut self, robot: &str, x: &str) -> Result<(), Refused> {
        let object = self.thing(x)?;
        ensure(object.thing.kind != "Floor", "one is always on the floor")?;
        ensure(!matches!(object.place, Place::Held(_)), "somebody holds it")?;
        ensure(self.can_move(robot), "it offers a hand")?;
        let mut at = self.floors();
        at.insert(x.to_string());
        at.extend(self.contents(x));
        if let Place::In(container) = &object.place
            && !matches!(self.thing(container)?.place, Place::Held(_))
        {
            at.insert(container.clone());
        }
        for place in [Some(x), object.place.container()].into_iter().flatten() {
            let thing = &self.thing(place)?.thing;
            let one_only = self.rules.exclusive.iter().any(|e| *e == thing.kind || *e == thing.name);
            let taken = self.agents.iter().any(|(other, a)| other != robot && a.at.contains(place));
            ensure(!(one_only && taken), "somebody stands there")?;
        }
        if let Some(agent) = self.agents.get_mut(robot) {
            agent.at = at;
        }
        Ok(())
    }

    /// Whether the thing can be taken from there by somebody at hand.
    fn can_take(&self, robot: &str, x: &str, c: &str) -> Result<(), Refused> {
        let object = self.thing(x)?;
        ensure(object.is_item() && !object.in_pieces(), "it cannot be picked up")?;
        ensure(object.place == Place::In(c.to_string()), "it is not there")?;
        ensure(self.is_at(robot, x) && self.is_at(robot, c), "it is not at hand")?;
        ensure(self.exposed(c) && self.accessible(c), "a door is closed")?;
        ensure(self.has_hand(robot), "no hand is free")
    }

    fn take(&mut self, robot: &str, x: &str) {
        if let Some(object) = self.things.get_mut(x) {
            object.place = Place::Held(robot.to_string());
        }
        for agent in self.agents.values_mut() {
            agent.at.remove(x);
        }
    }

    fn pick_up(&mut self, robot: &str, x: &str, c: &str) -> Result<(), Refused> {
        self.can_take(robot, x, c)?;
        ensure(self.is_strong_enough(robot, self.thing(x)?.thing.mass_kg), "it is too heavy")?;
        ensure(self.hands_on(x).is_empty(), "others offer a hand for it")?;
        self.take(robot, x);
        Ok(())
    }

    /// Whether what the robot holds can be put there.
    fn can_put(&self, robot: &str, x: &str, c: &str) -> Result<(), Refused> {
        ensure(self.thing(x)?.place == Place::Held(robot.to_string()), "the robot does not hold it")?;
        ensure(self.accepts(c, x), "it does not belong there")?;
        ensure(self.accessible(c) && self.exposed(c), "a door is closed")?;
        ensure(self.is_at(robot, c), "the place is not at hand")
    }

    fn holds_alone(&self, robot: &str, x: &str) -> Result<(), Refused> {
        let object = self.thing(x)?;
        ensure(object.place == Place::Held(robot.to_string()), "the robot does not hold it")?;
        ensure(self.is_strong_enough(robot, object.thing.mass_kg), "it is too heavy")
    }

    fn put(&mut self, robot: &str, x: &str, c: &str) -> Result<(), Refused> {
        self.holds_alone(robot, x)?;
        self.can_put(robot, x, c)?;
        self.arrive(robot, x, c);
        Ok(())
    }

    /// The thing comes to lie there, with what the place does to it.
    fn arrive(&mut self, robot: &str, x: &str, c: &str) {
        let (heats, cools, rinses) = (self.heats(c), self.cools(c), self.rinses(c));
        let brews = heats && self.things.get(c).is_some_and(|o| o.thing.kind == "CoffeeMachine");
        let contents = self.contents(x);
        for inner in contents.iter().map(String::as_str).chain([x]) {
            let Some(object) = self.things.get_mut(inner) else { continue };
            if heats {
                object.warm();
            }
            if cools {
                object.warmth = Warmth::Cold;
            }
        }
        if let Some(object) = self.things.get_mut(x) {
            object.place = Place::In(c.to_string());
            if rinses {
                object.dirty = false;
                object.fill("water");
            }
            if brews {
                object.fill("coffee");
            }
        }
        if let Some(agent) = self.agents.get_mut(robot) {
            agent.at.insert(x.to_string());
        }
    }

    fn drop(&mut self, robot: &str, x: &str) -> Result<(), Refused> {
        self.holds_alone(robot, x)?;
        let floors = self.floors();
        self.lay(x, &floors);
        if let Some(agent) = self.agents.get_mut(robot) {
            agent.at.insert(x.to_string());
        }
        Ok(())
    }

    fn throw(&mut self, robot: &str, x: &str) -> Result<(), Refused> {
        self.holds_alone(robot, x)?;
        let floors = self.floors();
        self.lay(x, &floors);
        if let Some(object) = self.things.get_mut(x).filter(|o| o.thing.can("breakable")) {
            object.smash();
        }
        Ok(())
    }

    fn offer(&mut self, robot: &str, x: &str) -> Result<(), Refused> {
        let object = self.thing(x)?;
        ensure(object.is_item() && !object.in_pieces(), "it cannot be picked up")?;
        ensure(self.is_needed_for(robot, x), "nobody needs its hand")?;
        ensure(self.has_hand(robot) && self.can_move(robot), "no hand is free")?;
        ensure(self.is_at(robot, x) && self.exposed(x), "it is not at hand")?;
        if let Some(agent) = self.agents.get_mut(robot) {
            agent.offers = Some(x.to_string());
        }
        Ok(())
    }

    fn withdraw(&mut self, robot: &str, x: &str) -> Result<(), Refused> {
        let agent = self.agents.get_mut(robot).ok_or("there is no such robot")?;
        ensure(agent.offers.as_deref() == Some(x) && agent.follows.is_none(), "nothing to withdraw from")?;
        agent.offers = None;
        Ok(())
    }

    fn crew(&self, robot: &str, g: &str, x: &str) -> Result<BTreeSet<String>, Refused> {
        let members = self.crews.get(g).ok_or("there is no such crew")?;
        ensure(members.contains(robot), "the robot is not in the crew")?;
        ensure(self.is_crew_for(members, x), "it is not a crew for this")?;
        Ok(members.iter().filter(|m| *m != robot).cloned().collect())
    }

    fn pick_up_together(&mut self, robot: &str, g: &str, x: &str, c: &str) -> Result<(), Refused> {
        let others = self.crew(robot, g, x)?;
        self.can_take(robot, x, c)?;
        ensure(self.can_move(robot), "it offers a hand itself")?;
        ensure(self.hands_on(x) == others, "not exactly the others of the crew offer a hand")?;
        self.take(robot, x);
        for helper in &others {
            if let Some(agent) = self.agents.get_mut(helper) {
                agent.follows = Some(robot.to_string());
                agent.at.clear();
            }
        }
        Ok(())
    }

    fn put_together(&mut self, robot: &str, g: &str, x: &str, c: &str) -> Result<(), Refused> {
        let others = self.crew(robot, g, x)?;
        self.can_put(robot, x, c)?;
        ensure(self.hands_on(x) == others, "other robots help to carry it")?;
        self.arrive(robot, x, c);
        let mut at = self.floors();
        at.extend([c.to_string(), x.to_string()]);
        for helper in &others {
            self.release(helper, &at);
        }
        Ok(())
    }

    fn pour(&mut self, robot: &str, x: &str, liquid: &str) -> Result<(), Refused> {
        self.at_hand(robot, x)?;
        ensure(["water", "coffee", "wine"].contains(&liquid), "there is no such liquid")?;
        let object = self.thing(x)?;
        ensure(
            object.thing.can("canFillWithLiquid") && !object.filled && !object.broken,
            "it cannot be filled",
        )?;
        if let Some(object) = self.things.get_mut(x) {
            object.fill(liquid);
        }
        Ok(())
    }

    fn at_hand(&self, robot: &str, x: &str) -> Result<(), Refused> {
        self.thing(x)?;
        ensure(self.is_at(robot, x) && self.exposed(x), "it is not at hand")
    }

    /// Acts on one thing that is at hand and stays where it is.
    fn work(&mut self, action: &str, robot: &str, x: &str) -> Result<(), Refused> {
        self.at_hand(robot, x)?;
        let armed = self.is_armed(robot);
        let heated = self.thing(x)?.place.container().is_some_and(|c| self.heats(c));
        let object = self.things.get_mut(x).ok_or("there is no such thing")?;
        let can = |affordance: &str| object.thing.can(affordance);
        let microwave = object.thing.kind == "Microwave";
        let (ajar, cooking) = (microwave && object.open, microwave && object.on);
        let possible = match action {
            "OpenObject" => can("openable") && !object.open && !cooking,
            "CloseObject" => can("openable") && object.open,
            "SwitchOn" => can("toggleable") && !object.on && !object.broken && !ajar,
            "SwitchOff" => can("toggleable") && object.on,
            "SliceObject" => can("sliceable") && armed && !object.sliced && !object.broken,
            "BreakObject" => can("breakable") && !object.broken && !object.sliced,
            "CleanObject" => can("dirtyable") && object.dirty,
            "DirtyObject" => can("dirtyable") && !object.dirty,
            "EmptyObject" => can("canFillWithLiquid") && object.filled,
            "UseUpObject" => kinds::consumable(&object.thing.kind) && !object.used_up,
            "PushObject" | "PullObject" => can("pickupable") || can("moveable"),
            _ => false,
        };
        ensure(possible, "its state does not allow that")?;
        match action {
            "OpenObject" => object.open = true,
            "CloseObject" => object.open = false,
            "SwitchOff" => object.on = false,
            "BreakObject" => object.smash(),
            "CleanObject" => object.dirty = false,
            "DirtyObject" => object.dirty = true,
            "EmptyObject" => (object.filled, object.liquid) = (false, None),
            "UseUpObject" => object.used_up = true,
            "PushObject" | "PullObject" => object.moved = true,
            "SliceObject" => {
                object.sliced = true;
                object.cooked |= heated && kinds::cooks_when_cut(&object.thing.kind);
            }
            _ => self.switch_on(x),
        }
        Ok(())
    }

    fn switch_on(&mut self, x: &str) {
        let Some(switch) = self.things.get_mut(x) else { return };
        switch.on = true;
        let (devices, basins) = (switch.thing.controls.clone(), switch.thing.fills.clone());
        for device in &devices {
            let brews = self.things.get(device).is_some_and(|d| d.thing.kind == "CoffeeMachine");
            for outer in self.contents(device) {
                for inner in self.contents(&outer) {
                    self.change(&inner, Object::warm);
                }
                self.change(&outer, |o| {
                    o.warm();
                    if brews {
                        o.fill("coffee");
                    }
                });
            }
        }
        let rinsed: Vec<String> = basins.iter().flat_map(|b| self.contents(b)).collect();
        for inner in rinsed {
            self.change(&inner, |o| {
                o.dirty = false;
                o.fill("water");
            });
        }
    }

    fn change(&mut self, x: &str, change: impl FnOnce(&mut Object)) {
        if let Some(object) = self.things.get_mut(x) {
            change(object);
        }
    }
}

impl Place {
    pub(super) fn container(&self) -> Option<&str> {
        match self {
            Place::In(container) => Some(container),
            Place::Fixed | Place::Held(_) => None,
        }
    }
}
