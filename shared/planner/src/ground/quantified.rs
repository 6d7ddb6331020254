//! Universally quantified conditions, expanded over the objects on ground level.
//!
//! Static facts decide most instances at once (`(forall (?y) (imply (heavy ?y) …))` is about the few heavy
//! objects), so the expansion prunes as soon as they do.

use std::collections::HashMap;

use super::instantiate::{Value, World, object};
use super::join::UNBOUND;
use super::limits::Ticks;
use super::propositional::{Ground, GroundRule, Lit};
use super::{GroundError, GroundLimits};
use crate::lifted::{Formula, Role};

/// A rule, its quantified condition, and the values of the free variables.
type Instance = ((u32, u32), Vec<u32>);

/// Expands conditions and remembers the disjunctions it made.
#[derive(Default)]
pub(super) struct Expander {
    /// Disjunctions that were made before: their parts, and the derived atom that stands for them.
    made: HashMap<Vec<Vec<Lit>>, u32>,
    /// Expansions by rule, quantifier, and the values of the free variables.
    known: HashMap<Instance, Option<Vec<Lit>>>,
    ticks: Ticks,
}

/// A ground condition: a constant, or a disjunction of conjunctions.
enum Expanded {
    False,
    /// All of these (none: true).
    All(Vec<Lit>),
}

impl Expander {
    /// Forgets the expansions of a rule, so that its number can be used again.
    pub fn forget(&mut self, rule: u32) {
        self.known.retain(|((known, _), _), _| *known != rule);
    }

    /// Expands `forall` into literals at the end of `out`; false if it cannot hold.
    #[allow(clippy::too_many_arguments)]
    pub fn expand(
        &mut self,
        world: &World<'_>,
        ground: &mut Ground,
        rule: (u32, u32),
        forall: &Formula,
        ranges: &[u32],
        binding: &mut Vec<u32>,
        limits: &GroundLimits<'_>,
        out: &mut Vec<Lit>,
    ) -> Result<bool, GroundError> {
        ground.approximate = true;
        let free = crate::lifted::free_variables(forall);
        let key = (rule, free.iter().map(|&slot| binding[slot as usize]).collect::<Vec<_>>());
        if let Some(known) = self.known.get(&key) {
            out.extend(known.iter().flatten());
            return Ok(known.is_some());
        }
        let mut expansion = Expansion {
            world,
            ground,
            ranges,
            binding,
            made: &mut self.made,
            ticks: &mut self.ticks,
            limits,
        };
        let lits = match expansion.expand(forall)? {
            Expanded::False => None,
            Expanded::All(lits) => Some(lits),
        };
        out.extend(lits.iter().flatten());
        let possible = lits.is_some();
        self.known.insert(key, lits);
        Ok(possible)
    }
}

struct Expansion<'a, 'w> {
    world: &'a World<'w>,
    ground: &'a mut Ground,
    ranges: &'a [u32],
    binding: &'a mut Vec<u32>,
    made: &'a mut HashMap<Vec<Vec<Lit>>, u32>,
    ticks: &'a mut Ticks,
    limits: &'a GroundLimits<'a>,
}

impl Expansion<'_, '_> {
    fn expand(&mut self, formula: &Formula) -> Result<Expanded, GroundError> {
        match formula {
            Formula::And(parts) => {
                let mut all = Vec::new();
                for part in parts {
                    match self.expand(part)? {
                        Expanded::False => return Ok(Expanded::False),
                        Expanded::All(lits) => all.extend(lits),
                    }
                }
                Ok(Expanded::All(all))
            }
            Formula::Or(parts) => {
                let mut choices = Vec::new();
                for part in parts {
                    if let Expanded::All(lits) = self.expand(part)? {
                        choices.push(lits);
                    }
                }
                self.either(choices)
            }
            Formula::Forall(slots, inner) => {
                let mut all = Vec::new();
                let held = self.instances(slots, inner, true, &mut |expanded| match expanded {
                    Expanded::False => false,
                    Expanded::All(lits) => {
                        all.extend(lits);
                        true
                    }
                })?;
                Ok(if held { Expanded::All(all) } else { Expanded::False })
            }
            Formula::Exists(slots, inner) => {
                let mut choices = Vec::new();
                self.instances(slots, inner, false, &mut |expanded| {
                    if let Expanded::All(lits) = expanded {
                        choices.push(lits);
                    }
                    true
                })?;
                self.either(choices)
            }
            Formula::Literal { atom, positive } => {
                Ok(match self.world.literal(atom, *positive, self.binding) {
                    Value::Constant(false) => Expanded::False,
                    Value::Constant(true) => Expanded::All(Vec::new()),
                    Value::Open(lit) => Expanded::All(vec![lit]),
                })
            }
            Formula::Equal { left, right, positive } => {
                let same = object(*left, self.binding) == object(*right, self.binding);
                Ok(if same == *positive { Expanded::All(Vec::new()) } else { Expanded::False })
            }
            Formula::Compare(comparison) => {
                Ok(match self.world.compare(comparison, self.binding, self.ground) {
                    Value::Constant(false) => Expanded::False,
                    Value::Constant(true) => Expanded::All(Vec::new()),
                    Value::Open(lit) => Expanded::All(vec![lit]),
                })
            }
        }
    }

    /// Calls `each` with the expansion of every instance that static facts leave open; stops when it says so.
    fn instances(
        &mut self,
        slots: &[u32],
        inner: &Formula,
        universal: bool,
        each: &mut dyn FnMut(Expanded) -> bool,
    ) -> Result<bool, GroundError> {
        self.ticks.tick(self.limits)?;
        // Instances with this value say nothing: true ones of "for all", false ones of "exists".
        if self.static_value(inner) == Some(universal) {
            return Ok(true);
        }
        let Some((&slot, rest)) = slots.split_first() else {
            let expanded = self.expand(inner)?;
            return Ok(each(expanded));
        };
        let world = self.world;
        for &member in &world.lifted.symbols.ranges[self.ranges[slot as usize] as usize].members {
            self.binding[slot as usize] = member;
            if !self.instances(rest, inner, universal, each)? {
                self.binding[slot as usize] = UNBOUND;
                return Ok(false);
            }
        }
        self.binding[slot as usize] = UNBOUND;
        Ok(true)
    }

    /// The value of a formula as far as equality and static facts under the binding so far decide it.
    fn static_value(&self, formula: &Formula) -> Option<bool> {
        match formula {
            Formula::And(parts) => {
                let mut all = Some(true);
                for part in parts {
                    match self.static_value(part) {
                        Some(false) => return Some(false),
                        Some(true) => {}
                        None => all = None,
                    }
                }
                all
            }
            Formula::Or(parts) => {
                let mut any = Some(false);
                for part in parts {
                    match self.static_value(part) {
                        Some(true) => return Some(true),
                        Some(false) => {}
                        None => any = None,
                    }
                }
                any
            }
            Formula::Literal { atom, positive } => {
                let args: Vec<u32> = atom.args.iter().map(|&term| object(term, self.binding)).collect();
                let role = self.world.lifted.symbols.predicates[atom.predicate as usize].role;
                if args.contains(&UNBOUND) || role != Role::Static {
                    return None;
                }
                let found = self.world.reached.relations[atom.predicate as usize].find(&args).is_some();
                Some(found == *positive)
            }
            Formula::Equal { left, right, positive } => {
                let (left, right) = (object(*left, self.binding), object(*right, self.binding));
                (left != UNBOUND && right != UNBOUND).then_some((left == right) == *positive)
            }
            Formula::Compare(_) | Formula::Exists(..) | Formula::Forall(..) => None,
        }
    }

    /// A disjunction; where it is a real one, a derived atom stands for it.
    fn either(&mut self, mut choices: Vec<Vec<Lit>>) -> Result<Expanded, GroundError> {
        for choice in &mut choices {
            choice.sort_unstable();
            choice.dedup();
        }
        choices.sort();
        choices.dedup();
        if choices.first().is_some_and(Vec::is_empty) {
            return Ok(Expanded::All(Vec::new()));
        }
        if choices.len() <= 1 {
            return Ok(choices.pop().map_or(Expanded::False, Expanded::All));
        }
        if let Some(&atom) = self.made.get(&choices) {
            return Ok(Expanded::All(vec![Lit::new(atom, true)]));
        }
        let atom = self.ground.new_derived();
        for choice in &choices {
            let body = self.ground.store(choice);
            self.ground.rules.push(GroundRule { head: atom, body });
        }
        if self.ground.rules.len() > self.limits.instances {
            return Err(GroundError::TooLarge {
                what: "parts of quantified conditions",
                limit: self.limits.instances as u64,
            });
        }
        self.made.insert(choices, atom);
        Ok(Expanded::All(vec![Lit::new(atom, true)]))
    }
}
