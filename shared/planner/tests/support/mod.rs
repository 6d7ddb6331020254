//! An executor for plans that shares nothing with the planner but the syntax tree: it enumerates objects and
//! looks facts up, and is meant to be obviously right, not fast.
#![allow(dead_code)]

use std::collections::{BTreeMap, BTreeSet};

use lamma_pddl::ast::*;
use lamma_pddl::{Name, Source, parse_domain, parse_problem};
use lamma_planner::Plan;

pub fn parse(domain: &str, problem: &str) -> (Domain, Problem) {
    let (domain_source, problem_source) =
        (Source::new("domain.pddl", domain), Source::new("problem.pddl", problem));
    let domain = parse_domain(&domain_source).unwrap_or_else(|report| panic!("{}", report.render()));
    let problem = parse_problem(&problem_source).unwrap_or_else(|report| panic!("{}", report.render()));
    (domain.value, problem.value)
}

#[derive(Clone, Debug, PartialEq)]
pub struct World {
    pub facts: BTreeSet<GroundAtom>,
    pub values: BTreeMap<GroundAtom, f64>,
}

pub struct Executor<'a> {
    pub domain: &'a Domain,
    pub problem: &'a Problem,
}

type Binding = Vec<(Name, Name)>;

/// Added, deleted, and changed numbers.
type Changes = (Vec<GroundAtom>, Vec<GroundAtom>, Vec<(AssignOp, GroundAtom, f64)>);

impl Executor<'_> {
    pub fn initial(&self) -> World {
        let mut world = World { facts: BTreeSet::new(), values: BTreeMap::new() };
        for fact in &self.problem.init {
            match fact {
                Init::Fact(atom) => {
                    world.facts.insert(atom.clone());
                }
                Init::Value(atom, value) => {
                    world.values.insert(atom.clone(), value.value());
                }
            }
        }
        self.derive(world)
    }

    fn objects(&self) -> impl Iterator<Item = &TypedName> {
        self.domain.constants.iter().chain(&self.problem.objects)
    }

    fn is_a(&self, of: &Name, wanted: &Name, depth: usize) -> bool {
        if of == wanted || *wanted == "object" {
            return true;
        }
        let mut declared = self.domain.types.iter().filter(|t| t.name == *of);
        depth < 50 && declared.any(|t| t.types.iter().any(|up| self.is_a(up, wanted, depth + 1)))
    }

    pub fn members(&self, types: &[Name]) -> Vec<Name> {
        let fits = |object: &&TypedName| {
            types.is_empty()
                || types.iter().any(|t| *t == "object" || object.types.iter().any(|of| self.is_a(of, t, 0)))
        };
        let names: BTreeSet<Name> = self.objects().filter(fits).map(|o| o.name.clone()).collect();
        names.into_iter().collect()
    }

    /// Derived atoms start false; axioms are applied until nothing changes. Right for axioms that do not
    /// negate derived predicates, which is all the tests use.
    pub fn derive(&self, mut world: World) -> World {
        let heads: BTreeSet<Name> = self.domain.axioms.iter().map(|a| a.head.name.clone()).collect();
        world.facts.retain(|f| !heads.contains(&f.predicate));
        loop {
            let before = world.facts.len();
            for axiom in &self.domain.axioms {
                for binding in self.bindings(&axiom.head.params) {
                    if self.holds(&world, &axiom.body, &binding) {
                        let args = binding.iter().map(|(_, o)| o.clone()).collect();
                        world.facts.insert(GroundAtom { predicate: axiom.head.name.clone(), args });
                    }
                }
            }
            if world.facts.len() == before {
                return world;
            }
        }
    }

    fn bindings(&self, variables: &[TypedName]) -> Vec<Binding> {
        let mut all = vec![Vec::new()];
        for variable in variables {
            let members = self.members(&variable.types);
            all = all
                .into_iter()
                .flat_map(|b: Binding| {
                    members.iter().map(move |m| {
                        let mut b = b.clone();
                        b.push((variable.name.clone(), m.clone()));
                        b
                    })
                })
                .collect();
        }
        all
    }

    fn term(&self, term: &Term, binding: &Binding) -> Name {
        match term {
            Term::Constant(name) => name.clone(),
            Term::Variable(name) => binding.iter().rev().find(|(v, _)| v == name).expect("bound").1.clone(),
        }
    }

    fn atom(&self, atom: &Atom, binding: &Binding) -> GroundAtom {
        GroundAtom {
            predicate: atom.predicate.clone(),
            args: atom.args.iter().map(|t| self.term(t, binding)).collect(),
        }
    }

    fn extended(&self, variables: &[TypedName], binding: &Binding) -> Vec<Binding> {
        let extend = |more: Binding| binding.iter().cloned().chain(more).collect();
        self.bindings(variables).into_iter().map(extend).collect()
    }

    pub fn value(&self, world: &World, expr: &NumericExpr, binding: &Binding) -> f64 {
        match expr {
            NumericExpr::Number(n) => n.value(),
            NumericExpr::Function(f) => {
                let args = f.args.iter().map(|t| self.term(t, binding)).collect();
                world.values[&GroundAtom { predicate: f.function.clone(), args }]
            }
            NumericExpr::Operation(op, parts) => {
                let values: Vec<f64> = parts.iter().map(|p| self.value(world, p, binding)).collect();
                let (first, rest) = values.split_first().expect("operands");
                match op {
                    ArithmeticOp::Subtract if rest.is_empty() => -first,
                    ArithmeticOp::Add => rest.iter().fold(*first, |a, b| a + b),
                    ArithmeticOp::Subtract => rest.iter().fold(*first, |a, b| a - b),
                    ArithmeticOp::Multiply => rest.iter().fold(*first, |a, b| a * b),
                    ArithmeticOp::Divide => rest.iter().fold(*first, |a, b| a / b),
                }
            }
        }
    }

    pub fn holds(&self, world: &World, condition: &Condition, binding: &Binding) -> bool {
        match condition {
            Condition::And(parts) => parts.iter().all(|p| self.holds(world, p, binding)),
            Condition::Or(parts) => parts.iter().any(|p| self.holds(world, p, binding)),
            Condition::Not(inner) => !self.holds(world, inner, binding),
            Condition::Imply(a, b) => !self.holds(world, a, binding) || self.holds(world, b, binding),
            Condition::Exists(vars, inner) => {
                self.extended(vars, binding).iter().any(|b| self.holds(world, inner, b))
            }
            Condition::Forall(vars, inner) => {
                self.extended(vars, binding).iter().all(|b| self.holds(world, inner, b))
            }
            Condition::Atom(atom) => world.facts.contains(&self.atom(atom, binding)),
            Condition::Equal(a, b) => self.term(a, binding) == self.term(b, binding),
            Condition::Compare(comparison, a, b) => {
                let (a, b) = (self.value(world, a, binding), self.value(world, b, binding));
                match comparison {
                    Comparison::Less => a < b,
                    Comparison::LessEqual => a <= b,
                    Comparison::Equal => a == b,
                    Comparison::GreaterEqual => a >= b,
                    Comparison::Greater => a > b,
                }
            }
        }
    }

    fn effects(&self, world: &World, effect: &Effect, binding: &Binding, out: &mut Changes) {
        match effect {
            Effect::And(parts) => parts.iter().for_each(|p| self.effects(world, p, binding, out)),
            Effect::Forall(vars, inner) => {
                self.extended(vars, binding).iter().for_each(|b| self.effects(world, inner, b, out));
            }
            Effect::When(condition, inner) => {
                if self.holds(world, condition, binding) {
                    self.effects(world, inner, binding, out);
                }
            }
            Effect::Add(atom) => out.0.push(self.atom(atom, binding)),
            Effect::Delete(atom) => out.1.push(self.atom(atom, binding)),
            Effect::Assign(op, target, value) => {
                let args = target.args.iter().map(|t| self.term(t, binding)).collect();
                let target = GroundAtom { predicate: target.function.clone(), args };
                out.2.push((*op, target, self.value(world, value, binding)));
            }
        }
    }

    /// The state after an action, or why it cannot be applied.
    pub fn apply(&self, world: &World, name: &Name, args: &[Name]) -> Result<World, String> {
        let mut actions = self.domain.actions.iter().filter(|a| a.name == *name);
        let action = actions.next().ok_or_else(|| format!("no action {name}"))?;
        if action.params.len() != args.len() {
            return Err(format!("{name} takes {} arguments", action.params.len()));
        }
        for (param, arg) in action.params.iter().zip(args) {
            if !self.members(&param.types).contains(arg) {
                return Err(format!("{arg} is not of the type of ?{}", param.name));
            }
        }
        let binding: Binding =
            action.params.iter().map(|p| p.name.clone()).zip(args.iter().cloned()).collect();
        if !self.holds(world, &action.precondition, &binding) {
            return Err("the precondition does not hold".into());
        }
        let mut out = Default::default();
        self.effects(world, &action.effect, &binding, &mut out);
        let mut next = world.clone();
        next.facts.retain(|fact| !out.1.contains(fact));
        next.facts.extend(out.0);
        for (op, target, value) in out.2 {
            let slot = next.values.entry(target).or_insert(0.0);
            match op {
                AssignOp::Assign => *slot = value,
                AssignOp::Increase => *slot += value,
                AssignOp::Decrease => *slot -= value,
                AssignOp::ScaleUp => *slot *= value,
                AssignOp::ScaleDown => *slot /= value,
            }
        }
        Ok(self.derive(next))
    }

    /// Runs a plan; the cost it really has.
    pub fn check(&self, plan: &Plan) -> Result<f64, String> {
        let mut world = self.initial();
        for (step, act) in plan.acts.iter().enumerate() {
            world = self
                .apply(&world, &act.action, &act.args)
                .map_err(|why| format!("step {step} {act}: {why}"))?;
        }
        if !self.holds(&world, &self.problem.goal, &Vec::new()) {
            return Err("the goal does not hold at the end".into());
        }
        match &self.problem.metric {
            Some(metric) if metric.minimize => Ok(self.value(&world, &metric.expression, &Vec::new())),
            _ => Ok(plan.acts.len() as f64),
        }
    }
}
