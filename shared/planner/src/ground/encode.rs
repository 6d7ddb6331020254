//! From propositions to finite-domain variables packed into words.

mod effects;

use super::invariant::Groups;
use super::limits::Ticks;
use super::propositional::{Ground, GroundOperator, Lit, Stretch};
use super::relation::Relation;
use super::{GroundError, GroundLimits};
use crate::csr::Csr;
use crate::lifted::Lifted;
use crate::numeric::NumericEffect;
use crate::task::{AtomText, Axiom, ConditionalEffect, Fact, FactId, Names, Operator, Task, Variable, Write};

/// No plan is long enough to leave the range of doubles in steps smaller than this.
const MAX_SAFE_GAIN: f64 = 1e200;

/// Builds the task. Of the `groups`, each of the disjoint ones becomes one variable.
pub(crate) fn encode(
    mut lifted: Lifted,
    relations: &[Relation],
    ground: Ground,
    groups: &Groups,
    limits: &GroundLimits<'_>,
) -> Result<Task, GroundError> {
    let mut encoder = Encoder {
        task: Task {
            has_costs: lifted.has_costs,
            warnings: std::mem::take(&mut lifted.warnings),
            ..Task::default()
        },
        atoms: Vec::new(),
        ground: &ground,
    };
    encoder.names(lifted, relations);
    encoder.task.warnings.extend(ground.numbers.missing.clone());
    if !ground.impossible.is_empty() {
        encoder.impossible();
        return Ok(encoder.task);
    }
    encoder.variables(&groups.disjoint);
    encoder.exclusive(&groups.all);
    encoder.initial_state();
    let numbers = encoder.numbers();
    encoder.operators(&numbers, limits)?;
    encoder.axioms()?;
    let goal = encoder.conditions(ground.goal);
    let in_goal = |group: &[FactId]| -> Vec<FactId> {
        group.iter().copied().filter(|fact| goal.binary_search(fact).is_ok()).collect()
    };
    let clash = goal
        .windows(2)
        .find(|pair| encoder.variable(pair[0]) == encoder.variable(pair[1]))
        .map(<[_]>::to_vec)
        .or_else(|| encoder.task.exclusive.rows().map(in_goal).find(|clash| clash.len() > 1));
    let Encoder { mut task, .. } = encoder;
    if let Some(pair) = clash {
        let texts: Vec<String> = pair.iter().map(|&fact| task.fact_text(fact)).collect();
        task.impossible.push(format!("{} (they exclude each other)", texts.join(" together with ")));
    }
    task.goal = goal;
    let mut init = std::mem::take(&mut task.init);
    task.evaluate_axioms(&mut init);
    task.init = init;
    Ok(task)
}

/// Where an atom is encoded: as a value of a group's variable, as a variable of its own, or as both (a
/// condition that the atom does *not* hold is a single fact only of its own variable).
#[derive(Clone, Copy, Default)]
struct Place {
    group: Option<FactId>,
    /// The fact that it does not hold; the fact that it does is the next.
    own: Option<FactId>,
}

struct Encoder<'a> {
    task: Task,
    atoms: Vec<Place>,
    ground: &'a Ground,
}

impl Encoder<'_> {
    fn names(&mut self, lifted: Lifted, relations: &[Relation]) {
        let ground = self.ground;
        let mut names = Names {
            objects: lifted.symbols.objects,
            predicates: lifted.symbols.predicates.into_iter().map(|p| p.name).collect(),
            schemas: lifted.schemas.into_iter().map(|s| (s.name, s.params)).collect(),
            atoms: Vec::with_capacity(ground.names.len()),
            args: ground.args.clone(),
        };
        let mut explained: Vec<Option<String>> = vec![None; names.predicates.len()];
        for (predicate, text) in lifted.explained {
            explained[predicate as usize] = Some(text);
        }
        for name in &ground.names {
            names.atoms.push(match name {
                None => AtomText::Condition("(a quantified condition)".into()),
                Some(name) => match &explained[name.predicate as usize] {
                    Some(text) => AtomText::Condition(text.clone()),
                    None => {
                        let start = names.args.len() as u32;
                        names.args.extend_from_slice(relations[name.predicate as usize].row(name.row));
                        AtomText::Atom { predicate: name.predicate, args: start..names.args.len() as u32 }
                    }
                },
            });
        }
        for (atom, _, text) in &ground.numbers.comparisons {
            names.atoms[*atom as usize] = AtomText::Condition(text.clone());
        }
        self.task.names = names;
    }

    /// The task without solution: only the reasons remain.
    fn impossible(&mut self) {
        let ground = self.ground;
        self.task.impossible = if ground.unreachable_goals.is_empty() {
            ground.impossible.clone()
        } else {
            // Facts for the unreachable atoms, only to print them.
            let texts = ground.unreachable_goals.iter().map(|lit| {
                let fact = Fact {
                    variable: 0,
                    word: 0,
                    mask: 0,
                    bits: 0,
                    atom: Some((lit.atom() as u32, lit.holds())),
                };
                let probe = Task { facts: vec![fact], names: Names::default(), ..Task::default() };
                (probe, lit)
            });
            let mut out = Vec::new();
            for (mut probe, _) in texts {
                std::mem::swap(&mut probe.names, &mut self.task.names);
                out.push(probe.fact_text(FactId(0)));
                std::mem::swap(&mut probe.names, &mut self.task.names);
            }
            out
        };
    }

    fn variables(&mut self, groups: &[Vec<u32>]) {
        let ground = self.ground;
        let atoms = ground.names.len();
        self.atoms = vec![Place::default(); atoms];
        let mut asked_false = vec![false; atoms];
        let conditions = ground.operators.iter().map(|o| o.precondition);
        let conditions = conditions
            .chain(ground.conditional.iter().map(|e| e.condition))
            .chain(ground.rules.iter().map(|r| r.body))
            .chain([ground.goal]);
        for stretch in conditions {
            for lit in ground.lits(stretch).iter().filter(|lit| !lit.holds()) {
                asked_false[lit.atom()] = true;
            }
        }
        let mut layout = Layout::default();
        for group in groups {
            let values = group.iter().map(|&atom| Some((atom, true))).chain([None]);
            let first = layout.add(&mut self.task, values);
            for (value, &atom) in group.iter().enumerate() {
                self.atoms[atom as usize].group = Some(FactId(first.0 + value as u32));
            }
        }
        for derived in [false, true] {
            for (atom, &asked_false) in asked_false.iter().enumerate() {
                let wanted = ground.relevant[atom] && ground.derived[atom] == derived;
                if wanted && (self.atoms[atom].group.is_none() || asked_false) {
                    let atom = atom as u32;
                    let first =
                        layout.add(&mut self.task, [Some((atom, false)), Some((atom, true))].into_iter());
                    self.atoms[atom as usize].own = Some(first);
                }
            }
            if !derived {
                self.task.primary_variables = self.task.variables.len();
            }
        }
        self.task.words = layout.words.max(1);
        self.task.numeric.base = self.task.words;
        let mut masks = vec![0u64; self.task.words];
        for variable in &self.task.variables[self.task.primary_variables..] {
            masks[variable.word as usize] |= variable.mask << variable.shift;
        }
        self.task.derived_masks = masks.into_iter().enumerate().filter(|&(_, mask)| mask != 0).collect();
    }

    fn exclusive(&mut self, groups: &[Vec<u32>]) {
        for group in groups {
            let facts = group.iter().map(|&atom| self.fact(Lit::new(atom, true)));
            let facts: Vec<FactId> = facts.collect();
            self.task.exclusive.push_row(facts);
        }
    }

    fn initial_state(&mut self) {
        let mut init = vec![0; self.task.words];
        // A group's last value means that none of its atoms holds.
        for variable in &self.task.variables {
            let last = FactId(variable.first.0 + variable.size - 1);
            if self.task.facts[last.index()].atom.is_none() {
                self.task.facts[last.index()].set(&mut init);
            }
        }
        for (atom, place) in self.atoms.iter().enumerate() {
            let holds = self.ground.init[atom] && !self.ground.derived[atom];
            for fact in self.facts_to_set(*place, holds).into_iter().flatten() {
                self.task.facts[fact.index()].set(&mut init);
            }
        }
        self.task.init = init;
    }

    /// The facts that make an atom true, or false where it is a variable of its own.
    fn facts_to_set(&self, place: Place, holds: bool) -> [Option<FactId>; 2] {
        let own = place.own.map(|first| FactId(first.0 + u32::from(holds)));
        [own, place.group.filter(|_| holds)]
    }

    /// The fact that a literal is as a condition.
    fn fact(&self, lit: Lit) -> FactId {
        let place = self.atoms[lit.atom()];
        let own = place.own.map(|first| FactId(first.0 + u32::from(lit.holds())));
        let fact = if lit.holds() { place.group.or(own) } else { own };
        fact.expect("every atom that a condition asks for is relevant and has been placed")
    }

    fn conditions(&self, stretch: Stretch) -> Vec<FactId> {
        let mut facts: Vec<FactId> = self.ground.lits(stretch).iter().map(|&lit| self.fact(lit)).collect();
        facts.sort_unstable();
        facts.dedup();
        facts
    }

    /// Whether facts ask for two values of one variable.
    fn contradictory(&self, facts: &[FactId]) -> bool {
        facts.windows(2).any(|pair| self.variable(pair[0]) == self.variable(pair[1]))
    }

    fn variable(&self, fact: FactId) -> u32 {
        self.task.facts[fact.index()].variable
    }

    /// The value of a group's variable that means none of its atoms holds.
    fn none_of(&self, fact: FactId) -> FactId {
        let variable = &self.task.variables[self.variable(fact) as usize];
        FactId(variable.first.0 + variable.size - 1)
    }

    /// Numbers the numbers that matter, in the order of the ground task; the index of each of those.
    fn numbers(&mut self) -> Vec<u32> {
        let numbers = &self.ground.numbers;
        let mut used = vec![false; numbers.initial.len()];
        let mut mark = |number: u32| used[number as usize] = true;
        let relevant = || {
            let all = numbers.comparisons.iter();
            all.filter(|(atom, ..)| self.ground.relevant[*atom as usize])
        };
        relevant().for_each(|(_, comparison, _)| comparison.for_each_variable(&mut mark));
        for effect in &numbers.effects {
            mark(effect.target);
            effect.value.for_each_variable(&mut mark);
        }
        let mut index = vec![u32::MAX; used.len()];
        for number in (0..used.len()).filter(|&number| used[number]) {
            index[number] = self.task.numeric.initial.len() as u32;
            self.task.numeric.initial.push(numbers.initial[number]);
        }
        let comparisons = relevant().map(|(atom, comparison, _)| {
            (self.fact(Lit::new(*atom, true)), comparison.renumbered(&|number| index[number as usize]))
        });
        self.task.numeric.comparisons = comparisons.collect();
        self.task.words += self.task.numeric.initial.len();
        self.task.init.extend(self.task.numeric.initial.iter().map(|value| (value + 0.0).to_bits()));
        index
    }

    /// An operator's effects on numbers.
    fn numeric_effects(&mut self, operator: &GroundOperator, numbers: &[u32]) {
        if self.task.numeric.initial.is_empty() {
            return;
        }
        let mut fallible = false;
        for effect in &self.ground.numbers.effects[operator.numeric.range()] {
            let condition = self.conditions(effect.condition);
            if self.contradictory(&condition) {
                continue;
            }
            let row = self.task.effect_conditions.len() as u32;
            self.task.effect_conditions.push_row(condition);
            let target = numbers[effect.target as usize];
            let value = effect.value.renumbered(&|number| numbers[number as usize]);
            let effect = NumericEffect { condition: row, op: effect.op, target, value };
            let defined = !self.task.numeric.initial[target as usize].is_nan();
            fallible |= !(effect.gain().is_some_and(|gain| gain.abs() < MAX_SAFE_GAIN) && defined);
            self.task.numeric.effects.push(effect);
        }
        self.task.numeric.effects.end_row();
        self.task.numeric.fallible.push(fallible);
    }

    fn operators(&mut self, numbers: &[u32], limits: &GroundLimits<'_>) -> Result<(), GroundError> {
        let mut ticks = Ticks::default();
        let ground = self.ground;
        let scale = cost_scale(&ground.operators);
        for operator in &ground.operators {
            ticks.tick(limits)?;
            let precondition = self.conditions(operator.precondition);
            if self.contradictory(&precondition) {
                continue;
            }
            let effects = self.effects(operator, &precondition);
            self.task.operators.push(Operator {
                cost: operator.cost,
                units: (operator.cost * scale).round().min(1e9) as u32,
                schema: operator.schema,
                args: operator.args,
            });
            self.task.preconditions.push_row(precondition);
            for (condition, fact) in effects.conditional {
                let row = self.task.effect_conditions.len() as u32;
                self.task.effect_conditions.push_row(condition);
                self.task.conditional.push(ConditionalEffect { condition: row, fact });
            }
            self.task.conditional.end_row();
            self.numeric_effects(operator, numbers);
            let writes = self.writes(&effects.plain);
            self.task.writes.push_row(writes);
            self.task.effects.push_row(effects.plain);
        }
        Ok(())
    }

    fn writes(&self, plain: &[FactId]) -> Vec<Write> {
        let mut writes: Vec<Write> = Vec::new();
        for fact in plain {
            let fact = &self.task.facts[fact.index()];
            match writes.iter_mut().find(|write| write.word == fact.word) {
                Some(write) => {
                    write.clear |= fact.mask;
                    write.set |= fact.bits;
                }
                None => writes.push(Write { word: fact.word, clear: fact.mask, set: fact.bits }),
            }
        }
        writes
    }

    fn axioms(&mut self) -> Result<(), GroundError> {
        let rules = &self.ground.rules;
        let layering = super::layers::layers(self.ground)?;
        for layer in layering.layers {
            let start = self.task.axioms.len();
            for rule in layer {
                let rule = rules[rule as usize];
                let body = self.conditions(rule.body);
                if self.contradictory(&body) {
                    continue;
                }
                let head = self.fact(Lit::new(rule.head, true));
                self.task.axioms.push(Axiom { head, body: self.task.axiom_bodies.len() as u32 });
                self.task.axiom_bodies.push_row(body);
            }
            self.task.axiom_layers.push(start..self.task.axioms.len());
        }
        if layering.recursive {
            let bodies = &self.task.axiom_bodies;
            let asks = self.task.axioms.iter().enumerate().flat_map(|(at, axiom)| {
                bodies.row(axiom.body as usize).iter().map(move |fact| (fact.0, at as u32))
            });
            self.task.waiting_axioms = Some(Csr::from_pairs(self.task.facts.len(), asks));
        }
        Ok(())
    }
}

/// Packs variables into words; none crosses a word.
#[derive(Default)]
struct Layout {
    words: usize,
    used: u32,
}

impl Layout {
    fn add(&mut self, task: &mut Task, values: impl Iterator<Item = Option<(u32, bool)>>) -> FactId {
        let first = FactId(task.facts.len() as u32);
        let variable = task.variables.len() as u32;
        for atom in values {
            task.facts.push(Fact { variable, word: 0, mask: 0, bits: 0, atom });
        }
        let size = task.facts.len() as u32 - first.0;
        let bits = u32::BITS - (size - 1).leading_zeros();
        if self.words == 0 || self.used + bits > u64::BITS {
            self.words += 1;
            self.used = 0;
        }
        let (word, shift, mask) = (self.words as u32 - 1, self.used, (1u64 << bits) - 1);
        self.used += bits;
        for (value, fact) in task.facts[first.index()..].iter_mut().enumerate() {
            *fact = Fact { word, mask: mask << shift, bits: (value as u64) << shift, ..*fact };
        }
        task.variables.push(Variable { first, size, word, shift, mask });
        first
    }
}

/// What costs are multiplied with to become whole numbers.
fn cost_scale(operators: &[GroundOperator]) -> f64 {
    if operators.iter().all(|operator| operator.cost.fract() == 0.0) { 1.0 } else { 1000.0 }
}
