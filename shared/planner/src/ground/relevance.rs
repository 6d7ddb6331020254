//! Which instances of actions can matter for the goal, found on the lifted task, so that the others are never
//! grounded: of a kitchen's thousands of ways to put something somewhere a goal needs a few.
//!
//! Backwards from the goal: what is needed has makers, and what these ask for is needed as well. A literal that
//! holds at first needs makers only where an action that matters makes it false. Let R be the actions found this
//! way, and take any plan without those outside R. By induction over its steps, every needed literal that held in
//! the full plan holds in the shorter one: if nobody in R makes it false, it never changes; else all its makers are
//! in R, and what made it true last is still there. A conditional effect that makes a needed literal false needs the
//! negation of its condition, so that it happens no more often than before. So R loses no plan, and a cheapest plan
//! needs nothing else.
//!
//! Sets of literals and of actions are kept as a few patterns, rows of objects with gaps; too many become one
//! more general pattern, which is as right and less sharp. Gaps are filled from facts that never change where few of
//! them fit: what must be a knife is one of the two knives.

use lamma_pddl::ast::AssignOp;

use super::join::UNBOUND;
use super::patterns::{Pattern, Patterns, covers, meet, row};
use crate::lifted::{Body, Change, Expr, Formula, Head, Lifted, LiftedAtom, Role, Rule, Term};

/// A body is looked at once for each way to fill its gaps from facts that never change, if there are so few ...
const MAX_WAYS: usize = 8;
/// ... of predicates with so few of them.
const MAX_STATIC_FACTS: usize = 2000;

/// Values of a rule's slots that an instance must have.
pub(super) type Values = Vec<(u32, u32)>;

/// For each rule which of its instances can matter: those with the values of one of these. `None`: all.
pub(super) type Filters = Vec<Option<Vec<Values>>>;

/// Works out which instances of each rule can matter.
pub(super) fn filters(lifted: &Lifted) -> Filters {
    let mut search = Backward::new(lifted);
    search.goal();
    while let Some(item) = search.agenda.pop() {
        search.follow(item);
    }
    lifted.rules.iter().map(|rule| search.filter(rule)).collect()
}

/// Whether an instance with this binding matters.
#[inline]
pub(super) fn matters(filter: &[Values], binding: &[u32]) -> bool {
    filter.iter().any(|values| values.iter().all(|&(slot, object)| binding[slot as usize] == object))
}

/// A literal's predicate and whether it holds: twice the predicate, plus one where it does not.
type Kind = u32;

fn kind(predicate: u32, holds: bool) -> Kind {
    predicate * 2 + u32::from(!holds)
}

/// Something new to follow.
enum Item {
    /// A condition that matters.
    Needed(Kind, Pattern),
    /// Something that an action that matters makes false.
    Falsified(Kind, Pattern),
    /// A condition whose makers matter.
    Live(Kind, Pattern),
    /// An action that matters.
    Action(u32, Pattern),
    /// A number that matters.
    Number(u32, Pattern),
}

/// An effect: of which action, and its place among the action's plain or conditional ones.
#[derive(Clone, Copy)]
struct Maker {
    action: u32,
    conditional: bool,
    effect: u32,
}

/// Which signs of a condition's literals are needed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Signs {
    Same,
    Opposite,
    Both,
}

struct Backward<'a> {
    lifted: &'a Lifted,
    needed: Vec<Patterns>,
    falsified: Vec<Patterns>,
    live: Vec<Patterns>,
    actions: Vec<Patterns>,
    numbers: Vec<Patterns>,
    agenda: Vec<Item>,
    /// By kind of literal.
    makers: Vec<Vec<Maker>>,
    /// By function.
    changers: Vec<Vec<Maker>>,
    /// The rules of each action, of each conditional effect of each action, and of each derived predicate.
    act_rules: Vec<Vec<usize>>,
    effect_rules: Vec<Vec<Vec<usize>>>,
    axioms: Vec<Vec<usize>>,
    /// The initial facts of each predicate.
    init: Vec<Vec<usize>>,
}

impl<'a> Backward<'a> {
    fn new(lifted: &'a Lifted) -> Self {
        let (predicates, functions) = (lifted.symbols.predicates.len(), lifted.symbols.functions.len());
        let mut search = Backward {
            lifted,
            needed: vec![Patterns::default(); predicates * 2],
            falsified: vec![Patterns::default(); predicates * 2],
            live: vec![Patterns::default(); predicates * 2],
            actions: vec![Patterns::default(); lifted.schemas.len()],
            numbers: vec![Patterns::default(); functions],
            agenda: Vec::new(),
            makers: vec![Vec::new(); predicates * 2],
            changers: vec![Vec::new(); functions],
            act_rules: vec![Vec::new(); lifted.schemas.len()],
            effect_rules: lifted.schemas.iter().map(|s| vec![Vec::new(); s.conditional.len()]).collect(),
            axioms: vec![Vec::new(); predicates],
            init: vec![Vec::new(); predicates],
        };
        for (at, rule) in lifted.rules.iter().enumerate() {
            match &rule.head {
                Head::Act { action } => search.act_rules[*action as usize].push(at),
                Head::Effect { action, effect } => {
                    search.effect_rules[*action as usize][*effect as usize].push(at);
                }
                Head::Derived(head) => search.axioms[head.predicate as usize].push(at),
            }
        }
        for (action, schema) in lifted.schemas.iter().enumerate() {
            for (change, conditional, effect) in schema.changes() {
                let maker = Maker { action: action as u32, conditional, effect };
                match change {
                    Change::Add(atom) => search.makers[kind(atom.predicate, true) as usize].push(maker),
                    Change::Delete(atom) => search.makers[kind(atom.predicate, false) as usize].push(maker),
                    Change::Numeric(_, of, _) => search.changers[of.predicate as usize].push(maker),
                }
            }
        }
        for (at, (predicate, _)) in lifted.init.iter().enumerate() {
            search.init[*predicate as usize].push(at);
        }
        search
    }

    fn goal(&mut self) {
        let body = &self.lifted.goal;
        self.need_body(body, 0, &vec![UNBOUND; body.variables.len()], Signs::Same);
    }

    fn follow(&mut self, item: Item) {
        match item {
            Item::Needed(kind, pattern) => self.follow_needed(kind, &pattern),
            Item::Falsified(kind, pattern) => {
                let needed: Vec<Pattern> =
                    self.needed[kind as usize].0.iter().filter_map(|needed| meet(needed, &pattern)).collect();
                needed.into_iter().for_each(|common| self.enliven(kind, common));
            }
            Item::Live(kind, pattern) => {
                for maker in self.makers[kind as usize].clone() {
                    self.involve(maker, &pattern);
                }
            }
            Item::Action(action, pattern) => self.follow_action(action, &pattern),
            Item::Number(function, pattern) => {
                for maker in self.changers[function as usize].clone() {
                    self.involve(maker, &pattern);
                }
            }
        }
    }

    fn follow_needed(&mut self, kind: Kind, pattern: &[u32]) {
        let lifted = self.lifted;
        let (predicate, holds) = ((kind / 2) as usize, kind.is_multiple_of(2));
        if lifted.symbols.predicates[predicate].role == Role::Derived {
            for at in self.axioms[predicate].clone() {
                let rule = &lifted.rules[at];
                let Head::Derived(head) = &rule.head else { continue };
                if let Some(binding) = self.unify(head, pattern, &rule.body.variables, &[]) {
                    for binding in self.ways(&rule.body, binding) {
                        self.need_body(&rule.body, 0, &binding, Signs::Both);
                    }
                }
            }
            return;
        }
        // What does not hold at first.
        let at_first = |search: &Self| {
            let facts = search.init[predicate].iter().map(|&at| &lifted.init[at].1);
            facts.filter(|args| covers(pattern, args)).cloned().collect::<Vec<_>>()
        };
        if holds {
            if pattern.contains(&UNBOUND) || at_first(self).is_empty() {
                self.enliven(kind, pattern.to_vec());
            }
        } else {
            at_first(self).into_iter().for_each(|args| self.enliven(kind, args));
        }
        let falsified: Vec<Pattern> = self.falsified[kind as usize]
            .0
            .iter()
            .filter_map(|made_false| meet(made_false, pattern))
            .collect();
        falsified.into_iter().for_each(|common| self.enliven(kind, common));
        // What conditional effects on it ask for.
        for holds in [true, false] {
            for maker in self.makers[self::kind(predicate as u32, holds) as usize].clone() {
                for action in self.actions[maker.action as usize].0.clone() {
                    self.need_condition(maker, &action, kind, pattern);
                }
            }
        }
    }

    fn follow_action(&mut self, action: u32, pattern: &[u32]) {
        let lifted = self.lifted;
        let schema = &lifted.schemas[action as usize];
        for at in self.act_rules[action as usize].clone() {
            let body = &lifted.rules[at].body;
            let mut binding = vec![UNBOUND; body.variables.len()];
            binding[..pattern.len()].copy_from_slice(pattern);
            for binding in self.ways(body, binding) {
                self.need_body(body, 0, &binding, Signs::Same);
            }
        }
        schema.cost.iter().for_each(|cost| self.need_numbers(cost, pattern));
        for (change, conditional, effect) in schema.changes() {
            let atom = match change {
                Change::Add(atom) => {
                    self.falsify(kind(atom.predicate, false), row(atom, pattern));
                    atom
                }
                Change::Delete(atom) => {
                    self.falsify(kind(atom.predicate, true), row(atom, pattern));
                    atom
                }
                Change::Numeric(op, of, value) => {
                    self.need_for_change(*op, of, value, pattern);
                    if conditional {
                        self.need_numeric_condition(action, effect, pattern);
                    }
                    continue;
                }
            };
            let maker = Maker { action, conditional, effect };
            for kind in [true, false].map(|holds| kind(atom.predicate, holds)) {
                for needed in self.needed[kind as usize].0.clone() {
                    self.need_condition(maker, pattern, kind, &needed);
                }
            }
        }
    }

    /// What decides whether a number changes.
    fn need_numeric_condition(&mut self, action: u32, effect: u32, pattern: &[u32]) {
        for at in self.effect_rules[action as usize][effect as usize].clone() {
            let body = &self.lifted.rules[at].body;
            let mut binding = vec![UNBOUND; body.variables.len()];
            binding[..pattern.len()].copy_from_slice(pattern);
            self.need_body(body, 1, &binding, Signs::Both);
        }
    }

    /// What an action's conditional effect on something needed asks for: its condition where it makes it true, the
    /// condition's negation where it makes it false.
    fn need_condition(&mut self, maker: Maker, action: &[u32], kind: Kind, needed: &[u32]) {
        let lifted = self.lifted;
        if !maker.conditional {
            return;
        }
        // The first atom says that the action was reached, the second of a delete what is deleted.
        let (atom, skip, makes) = match self.change(maker) {
            Change::Add(atom) => (atom, 1, true),
            Change::Delete(atom) => (atom, 2, false),
            Change::Numeric(..) => return,
        };
        let signs = if makes == kind.is_multiple_of(2) { Signs::Same } else { Signs::Opposite };
        for at in self.effect_rules[maker.action as usize][maker.effect as usize].clone() {
            let body = &lifted.rules[at].body;
            if let Some(binding) = self.unify(atom, needed, &body.variables, action) {
                for binding in self.ways(body, binding) {
                    self.need_body(body, skip, &binding, signs);
                }
            }
        }
    }

    /// The action matters where an effect of it on a row of the pattern does.
    fn involve(&mut self, maker: Maker, pattern: &[u32]) {
        let lifted = self.lifted;
        let schema = &lifted.schemas[maker.action as usize];
        let rules = if maker.conditional {
            &self.effect_rules[maker.action as usize][maker.effect as usize]
        } else {
            &self.act_rules[maker.action as usize]
        };
        // Without a rule the condition can never hold.
        let Some(&rule) = rules.first() else { return };
        let (Change::Add(atom) | Change::Delete(atom) | Change::Numeric(_, atom, _)) = self.change(maker);
        let Some(mut binding) = self.unify(atom, pattern, &lifted.rules[rule].body.variables, &[]) else {
            return;
        };
        binding.truncate(schema.params);
        for at in self.act_rules[maker.action as usize].clone() {
            let body = &lifted.rules[at].body;
            let mut whole = vec![UNBOUND; body.variables.len()];
            whole[..binding.len()].copy_from_slice(&binding);
            for mut way in self.ways(body, whole) {
                way.truncate(schema.params);
                if let Some(added) = self.actions[maker.action as usize].add(way) {
                    self.agenda.push(Item::Action(maker.action, added));
                }
            }
        }
    }

    /// The binding with its gaps filled from facts that never change, once for each way, where there are few; none
    /// where no such fact fits.
    fn ways(&self, body: &Body, binding: Vec<u32>) -> Vec<Vec<u32>> {
        let mut ways = vec![binding];
        for atom in &body.atoms {
            let facts = &self.init[atom.predicate as usize];
            let role = self.lifted.symbols.predicates[atom.predicate as usize].role;
            if role != Role::Static || facts.len() > MAX_STATIC_FACTS {
                continue;
            }
            let mut filled = Vec::new();
            for way in &ways {
                let fitting = facts
                    .iter()
                    .filter_map(|&at| self.unify(atom, &self.lifted.init[at].1, &body.variables, way));
                filled.extend(fitting.take(MAX_WAYS + 1));
                if filled.len() > MAX_WAYS {
                    break;
                }
            }
            if filled.len() <= MAX_WAYS {
                ways = filled;
            }
        }
        ways
    }

    fn change(&self, maker: Maker) -> &'a Change {
        let schema = &self.lifted.schemas[maker.action as usize];
        let at = maker.effect as usize;
        if maker.conditional { &schema.conditional[at].change } else { &schema.effects[at] }
    }

    /// An effect on a number of an action that matters: what it reads is needed; and the number itself, where the
    /// action applies only if it has a value.
    fn need_for_change(&mut self, op: AssignOp, of: &LiftedAtom, value: &Expr, binding: &[u32]) {
        self.need_numbers(value, binding);
        if op != AssignOp::Assign {
            self.need_number(of, binding);
        }
    }

    fn need_numbers(&mut self, expression: &Expr, binding: &[u32]) {
        match expression {
            Expr::Number(_) => {}
            Expr::Value(of) => self.need_number(of, binding),
            Expr::Operation(_, parts) => parts.iter().for_each(|part| self.need_numbers(part, binding)),
        }
    }

    fn need_number(&mut self, of: &LiftedAtom, binding: &[u32]) {
        if self.lifted.symbols.functions[of.predicate as usize].role == Role::Static {
            return;
        }
        if let Some(added) = self.numbers[of.predicate as usize].add(row(of, binding)) {
            self.agenda.push(Item::Number(of.predicate, added));
        }
    }

    /// What a body asks for, without its first `skip` atoms.
    fn need_body(&mut self, body: &Body, skip: usize, binding: &[u32], signs: Signs) {
        body.atoms[skip..].iter().for_each(|atom| self.need(atom, true, binding, signs));
        body.absent.iter().for_each(|atom| self.need(atom, false, binding, signs));
        body.foralls.iter().for_each(|forall| self.need_formula(forall, binding, signs));
        for comparison in &body.comparisons {
            self.need_numbers(&comparison.left, binding);
            self.need_numbers(&comparison.right, binding);
        }
    }

    /// The variables of quantifiers are unbound, so they stand for any object.
    fn need_formula(&mut self, formula: &Formula, binding: &[u32], signs: Signs) {
        match formula {
            Formula::Literal { atom, positive } => self.need(atom, *positive, binding, signs),
            Formula::Equal { .. } => {}
            Formula::Compare(comparison) => {
                self.need_numbers(&comparison.left, binding);
                self.need_numbers(&comparison.right, binding);
            }
            Formula::And(parts) | Formula::Or(parts) => {
                parts.iter().for_each(|part| self.need_formula(part, binding, signs));
            }
            Formula::Exists(_, inner) | Formula::Forall(_, inner) => self.need_formula(inner, binding, signs),
        }
    }

    fn need(&mut self, atom: &LiftedAtom, holds: bool, binding: &[u32], signs: Signs) {
        if matches!(
            self.lifted.symbols.predicates[atom.predicate as usize].role,
            Role::Static | Role::Applied
        ) {
            return;
        }
        let pattern = row(atom, binding);
        for sign in [true, false] {
            let wanted = match signs {
                Signs::Same => sign == holds,
                Signs::Opposite => sign != holds,
                Signs::Both => true,
            };
            let kind = kind(atom.predicate, sign);
            if wanted && let Some(added) = self.needed[kind as usize].add(pattern.clone()) {
                self.agenda.push(Item::Needed(kind, added));
            }
        }
    }

    fn falsify(&mut self, kind: Kind, pattern: Pattern) {
        if let Some(added) = self.falsified[kind as usize].add(pattern) {
            self.agenda.push(Item::Falsified(kind, added));
        }
    }

    fn enliven(&mut self, kind: Kind, pattern: Pattern) {
        if let Some(added) = self.live[kind as usize].add(pattern) {
            self.agenda.push(Item::Live(kind, added));
        }
    }

    /// The binding of a scope, of which the first values may be given, that makes the atom one of the pattern's rows.
    fn unify(
        &self,
        atom: &LiftedAtom,
        pattern: &[u32],
        variables: &[u32],
        first: &[u32],
    ) -> Option<Vec<u32>> {
        let mut binding = vec![UNBOUND; variables.len()];
        binding[..first.len()].copy_from_slice(first);
        for (&term, &object) in atom.args.iter().zip(pattern).filter(|(_, object)| **object != UNBOUND) {
            match term {
                Term::Object(known) if known != object => return None,
                Term::Object(_) => {}
                Term::Variable(slot) => {
                    let bound = &mut binding[slot as usize];
                    if *bound != UNBOUND && *bound != object {
                        return None;
                    }
                    *bound = object;
                    let range = &self.lifted.symbols.ranges[variables[slot as usize] as usize];
                    if !range.contains[object as usize] {
                        return None;
                    }
                }
            }
        }
        Some(binding)
    }

    /// Which instances of a rule can matter: those of actions that do, and effects on something needed.
    fn filter(&self, rule: &Rule) -> Option<Vec<Values>> {
        let mut filter = Vec::new();
        let mut allow = |binding: &[u32]| {
            let bound = binding.iter().zip(0..).filter(|(object, _)| **object != UNBOUND);
            filter.push(bound.map(|(&object, slot)| (slot, object)).collect::<Values>());
        };
        match &rule.head {
            Head::Derived(_) => return None,
            Head::Act { action } => self.actions[*action as usize].0.iter().for_each(|row| allow(row)),
            Head::Effect { action, effect } => {
                let maker = Maker { action: *action, conditional: true, effect: *effect };
                let (Change::Add(atom) | Change::Delete(atom)) = self.change(maker) else { return None };
                for holds in [true, false] {
                    for needed in &self.needed[kind(atom.predicate, holds) as usize].0 {
                        if let Some(binding) = self.unify(atom, needed, &rule.body.variables, &[]) {
                            allow(&binding);
                        }
                    }
                }
            }
        }
        let everything = filter.iter().any(Vec::is_empty);
        (!everything).then_some(filter)
    }
}
