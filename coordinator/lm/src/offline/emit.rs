//! From facts to sub-tasks: what lasts, what must come first, and which entries speak of one object.

use std::collections::{BTreeMap, BTreeSet};

use lamma_domains::goal::{Content, GoalEntry, PropertyValue};

use super::effect::{Change, Fact};
use super::lexicon::Settings;
use super::mention::{Discourse, Which};
use super::syntax::{Clause, Link};
use crate::Subtask;

/// Contents within contents go no deeper than this.
const DEEPEST: usize = 4;

/// A thing that stays in the device it was treated with, when nothing else is said.
pub struct Stay {
    /// The clause of the treatment.
    pub clause: usize,
    /// The thing.
    pub entity: usize,
    /// The type of the device.
    pub device: String,
}

/// Turns the facts of clauses into sub-tasks.
pub struct Emitter<'e, 'a> {
    discourse: &'e Discourse<'a>,
    facts: Vec<Fact>,
    /// The facts that still hold at the end.
    lasting: Vec<bool>,
}

impl<'e, 'a> Emitter<'e, 'a> {
    /// Completes the facts (what is chilled stays in the fridge, what is put down is not held) and finds
    /// out which of them last.
    pub fn new(discourse: &'e mut Discourse<'a>, mut facts: Vec<Fact>, stays: &[Stay]) -> Self {
        // Of what is chilled and then heated, the last says where it stays.
        for Stay { clause, entity, device } in stays.iter().rev() {
            let (clause, entity) = (*clause, *entity);
            let placed = facts
                .iter()
                .any(|fact| fact.entity == entity && matches!(fact.change, Change::Inside(_) | Change::Held));
            let kind = discourse.entities[entity].kind().to_owned();
            if !placed && discourse.scene.accepts(device, &kind) {
                discourse.assume(format!("the {kind} stays in the {device}"), 0.98);
                let place = discourse.place_of_kind(device);
                facts.push(Fact { clause, entity, change: Change::Inside(place) });
            }
        }
        imply_purpose(discourse, &mut facts);
        // What is picked up only to be put down or to be treated is not held.
        let facts: Vec<Fact> = (0..facts.len())
            .filter(|&i| {
                facts[i].change != Change::Held
                    || !facts.iter().skip(i + 1).any(|later| {
                        later.entity == facts[i].entity
                            && (matches!(later.change, Change::Inside(_))
                                || later.clause > facts[i].clause && is_treatment(&later.change))
                    })
            })
            .map(|i| facts[i].clone())
            .collect();
        let discourse = &*discourse;
        let lasting = (0..facts.len()).map(|i| lasts(&facts, i, discourse)).collect();
        Self { discourse, facts, lasting }
    }

    /// The sub-tasks, in the order of the clauses.
    pub fn subtasks(&self, clauses: &[Clause<'_>]) -> Vec<Subtask> {
        let mut found: Vec<(usize, Subtask)> = Vec::new();
        let mut numbers: BTreeMap<usize, Vec<String>> = BTreeMap::new();
        let mut ancestors: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (index, clause) in clauses.iter().enumerate() {
            for lasting in [false, true] {
                let goal = self.goal(index, lasting);
                if goal.is_empty() {
                    continue;
                }
                let id = format!("s{}", found.len() + 1);
                let mut after = self.after(index, clauses, &numbers);
                after.extend(numbers.get(&index).into_iter().flatten().cloned());
                after.sort_by_key(|id| id[1..].parse::<usize>().unwrap_or(0));
                after.dedup();
                let implied: BTreeSet<String> =
                    after.iter().filter_map(|id| ancestors.get(id)).flatten().cloned().collect();
                after.retain(|id| !implied.contains(id));
                ancestors.insert(id.clone(), implied.into_iter().chain(after.iter().cloned()).collect());
                numbers.entry(index).or_default().push(id.clone());
                found.push((
                    index,
                    Subtask {
                        id,
                        text: if clause.negated {
                            format!("not {}", clause.text)
                        } else {
                            clause.text.clone()
                        },
                        goal,
                        after,
                        robots: clause.robots.clone(),
                        lasting,
                    },
                ));
            }
        }
        let mut subtasks: Vec<Subtask> = found.into_iter().map(|(_, subtask)| subtask).collect();
        drop_lonely_marks(&mut subtasks);
        subtasks
    }

    /// The sub-tasks that must be done before a clause.
    fn after(
        &self,
        index: usize,
        clauses: &[Clause<'_>],
        numbers: &BTreeMap<usize, Vec<String>>,
    ) -> Vec<String> {
        let mut found = Vec::new();
        for earlier in 0..index {
            let stated = clauses[earlier + 1..=index].iter().any(|clause| clause.link == Link::Then);
            if stated || self.share(earlier, index) {
                found.extend(numbers.get(&earlier).into_iter().flatten().cloned());
            }
        }
        found
    }

    /// Whether two clauses do something to the same thing.
    fn share(&self, a: usize, b: usize) -> bool {
        let touched = |clause: usize| -> (BTreeSet<usize>, BTreeSet<usize>) {
            let facts = self.facts.iter().filter(|fact| fact.clause == clause);
            let mut subjects = BTreeSet::new();
            let mut places = BTreeSet::new();
            for fact in facts {
                subjects.insert(fact.entity);
                if let Change::Inside(place) = fact.change {
                    places.insert(place);
                }
            }
            (subjects, places)
        };
        let ((subjects, places), (later_subjects, later_places)) = (touched(a), touched(b));
        !subjects.is_disjoint(&later_subjects)
            || !subjects.is_disjoint(&later_places)
            || !places.is_disjoint(&later_subjects)
    }

    /// The goal entries of a clause: those that last, or those that do not.
    fn goal(&self, clause: usize, lasting: bool) -> Vec<GoalEntry> {
        let mine: Vec<usize> = (0..self.facts.len())
            .filter(|&i| self.facts[i].clause == clause && self.lasting[i] == lasting)
            .collect();
        let mut entries: Vec<(usize, GoalEntry)> = Vec::new();
        let mut contained: BTreeSet<usize> = BTreeSet::new();
        for &i in &mine {
            if let Change::Inside(_) = self.facts[i].change {
                contained.insert(self.facts[i].entity);
            }
        }
        for &i in &mine {
            let Fact { entity, change, .. } = &self.facts[i];
            match change {
                Change::Inside(place) if !(contained.contains(place) && lasting) => {
                    let contents = self.contents(*entity, clause, 0);
                    let at = self.entry(&mut entries, *place);
                    for content in contents {
                        if !matches!(&content, Content::Named(name) if entries[at].1.contains.iter().any(|c| matches!(c, Content::Named(n) if n == name)) && self.is_name(name))
                        {
                            entries[at].1.contains.push(content);
                        }
                    }
                }
                Change::Inside(_) => {}
                _ if contained.contains(entity) => {}
                Change::State(property, value) => {
                    let at = self.entry(&mut entries, *entity);
                    entries[at].1.is.insert(property.clone(), value.clone());
                }
                Change::Held => {
                    let at = self.entry(&mut entries, *entity);
                    entries[at].1.is.insert("isPickedUp".to_owned(), super::yes());
                }
            }
        }
        entries.into_iter().map(|(_, entry)| entry).collect()
    }

    fn is_name(&self, name: &str) -> bool {
        self.discourse.scene.named(name).is_some()
    }

    fn entry(&self, entries: &mut Vec<(usize, GoalEntry)>, entity: usize) -> usize {
        if let Some(at) = entries.iter().position(|(known, _)| *known == entity) {
            return at;
        }
        entries.push((entity, self.bare(entity)));
        entries.len() - 1
    }

    /// An entity as an entry that says nothing of it yet.
    fn bare(&self, entity: usize) -> GoalEntry {
        let thing = &self.discourse.entities[entity];
        let (object, all) = match &thing.which {
            Which::Named(name) => (name.clone(), false),
            Which::All => (thing.kind().to_owned(), true),
            Which::Any => (thing.kind().to_owned(), false),
        };
        let one_of_many = thing.which == Which::Any && self.discourse.scene.of_kind(thing.kind()).len() != 1;
        let same = one_of_many.then(|| format!("{}-{}", thing.kind().to_lowercase(), entity + 1));
        GoalEntry { object, all, same, ..GoalEntry::default() }
    }

    /// An entity as what is contained: with the states it has by then, and its own contents.
    fn contents(&self, entity: usize, clause: usize, depth: usize) -> Vec<Content> {
        let thing = &self.discourse.entities[entity];
        let mut entry = self.bare(entity);
        entry.is = self.states(entity, clause);
        if depth < DEEPEST {
            for (i, fact) in self.facts.iter().enumerate() {
                if fact.change == Change::Inside(entity)
                    && fact.clause <= clause
                    && self.lasting[i]
                    && fact.entity != entity
                {
                    entry.contains.extend(self.contents(fact.entity, clause, depth + 1));
                }
            }
        }
        if thing.which == Which::All {
            let objects = self.discourse.scene.of_kind(thing.kind());
            return objects
                .iter()
                .map(|object| {
                    content(GoalEntry {
                        object: object.name.clone(),
                        all: false,
                        same: None,
                        ..entry.clone()
                    })
                })
                .collect();
        }
        vec![content(entry)]
    }

    /// The lasting states an entity has when a clause is done.
    fn states(&self, entity: usize, clause: usize) -> Settings {
        let mut states = Settings::new();
        for (fact, lasting) in self.facts.iter().zip(&self.lasting) {
            if let (true, true, Change::State(property, value)) =
                (fact.entity == entity && fact.clause <= clause, *lasting, &fact.change)
            {
                states.insert(property.clone(), value.clone());
            }
        }
        states
    }
}

/// What is put into a fridge or a microwave only to be taken out again is to be cold or hot.
fn imply_purpose(discourse: &mut Discourse<'_>, facts: &mut Vec<Fact>) {
    for i in 0..facts.len() {
        let Fact { clause, entity, change: Change::Inside(place) } = facts[i] else { continue };
        let device = discourse.entities[place].kind().to_owned();
        let scene = discourse.scene;
        let word = match (scene.affords(&device, "isColdSource"), scene.affords(&device, "isHeatSource")) {
            (true, _) => "Cold",
            (_, true) if scene.affords(&device, "openable") => "Hot",
            _ => continue,
        };
        let of_it = |fact: &&Fact| fact.entity == entity;
        let leaves = facts[i + 1..].iter().filter(of_it).any(|fact| {
            matches!(fact.change, Change::Inside(other) if other != place) || fact.change == Change::Held
        });
        let stated = facts
            .iter()
            .filter(of_it)
            .any(|fact| matches!(&fact.change, Change::State(p, _) if p == "temperature"));
        if leaves && !stated {
            let kind = discourse.entities[entity].kind().to_owned();
            discourse
                .assume(format!("the {kind} is put into the {device} to get {}", word.to_lowercase()), 0.9);
            let value = PropertyValue::Word(word.to_owned());
            facts.insert(
                i + 1,
                Fact { clause, entity, change: Change::State("temperature".to_owned(), value) },
            );
        }
    }
}

/// What is done to a thing that was picked up for it: washing, slicing, heating.
fn is_treatment(change: &Change) -> bool {
    matches!(change, Change::State(property, _)
        if ["isDirty", "isSliced", "temperature", "isCooked", "isBroken", "isFilledWithLiquid"].contains(&property.as_str()))
}

fn content(entry: GoalEntry) -> Content {
    if entry.is.is_empty() && entry.contains.is_empty() && entry.same.is_none() {
        Content::Named(entry.object)
    } else {
        Content::With(Box::new(entry))
    }
}

/// Whether nothing later undoes a fact: another value, another place, a fridge for what is hot.
fn lasts(facts: &[Fact], index: usize, discourse: &Discourse<'_>) -> bool {
    let fact = &facts[index];
    let mut ends_cold = false;
    for (i, other) in facts.iter().enumerate() {
        let (mine, its) = (&discourse.entities[fact.entity], &discourse.entities[other.entity]);
        // Named twice, in other words, it is one thing where there is only one.
        let only_one = mine.kind() == its.kind() && discourse.scene.of_kind(mine.kind()).len() == 1;
        if other.entity != fact.entity && !only_one {
            continue;
        }
        let later = i > index;
        match (&fact.change, &other.change) {
            (Change::State(a, x), Change::State(b, y)) if later && a == b && x != y => return false,
            (Change::Inside(x), Change::Inside(y)) if later && x != y => return false,
            (Change::Inside(_), Change::Held) | (Change::Held, Change::Inside(_)) if later => return false,
            (Change::State(property, value), Change::Inside(place))
                if property == "temperature" && *value == PropertyValue::Word("Hot".to_owned()) =>
            {
                ends_cold = discourse.scene.affords(discourse.entities[*place].kind(), "isColdSource");
            }
            _ => {}
        }
    }
    !ends_cold
}

/// Removes marks that tie nothing: a mark on one entry alone.
fn drop_lonely_marks(subtasks: &mut [Subtask]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut entries: Vec<&mut GoalEntry> =
        subtasks.iter_mut().flat_map(|subtask| &mut subtask.goal).collect();
    for entry in &mut entries {
        visit(entry, &mut |entry| {
            if let Some(mark) = &entry.same {
                *counts.entry(mark.clone()).or_default() += 1;
            }
        });
    }
    for entry in &mut entries {
        visit(entry, &mut |entry| {
            if entry.same.as_ref().is_some_and(|mark| counts.get(mark) == Some(&1)) {
                entry.same = None;
            }
        });
        simplify(entry);
    }
}

/// Calls a function on an entry and on all it contains; entries are no deeper than [`DEEPEST`].
fn visit(entry: &mut GoalEntry, action: &mut dyn FnMut(&mut GoalEntry)) {
    action(entry);
    for content in &mut entry.contains {
        if let Content::With(inner) = content {
            visit(inner, action);
        }
    }
}

/// Writes contents that have lost their conditions as names.
fn simplify(entry: &mut GoalEntry) {
    for slot in &mut entry.contains {
        if let Content::With(inner) = slot {
            simplify(inner);
            *slot = content(std::mem::take(inner.as_mut()));
        }
    }
}
