//! Random small tasks with every connective, quantifier, conditional effects and axioms; a seed is a task.
//! With numbers, too: small whole ones, so that there are few states.
#![allow(dead_code)]

use lamma_pddl::Name;
use lamma_pddl::ast::*;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
    fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }
    fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }
}

/// Predicates with the types of their parameters; `s` and `t` are static, `d` is derived.
const PREDICATES: [(&str, &[&str]); 7] = [
    ("p", &["a"]),
    ("q", &["b"]),
    ("r", &["a", "b"]),
    ("g", &[]),
    ("s", &["a", "b"]),
    ("t", &["a"]),
    ("d", &["a"]),
];
const OBJECTS: [(&str, &str); 4] = [("a1", "a"), ("a2", "a"), ("b1", "b"), ("b2", "b")];

type Scope = Vec<(String, &'static str)>;

fn atom(random: &mut Random, scope: &Scope, choices: &[usize]) -> Option<Atom> {
    let (name, types) = PREDICATES[*random.pick(choices)];
    let mut args = Vec::new();
    for of in types {
        let mut terms: Vec<Term> =
            scope.iter().filter(|(_, t)| t == of).map(|(v, _)| Term::Variable(Name::new(v))).collect();
        if terms.is_empty() || random.chance(15) {
            terms =
                OBJECTS.iter().filter(|(_, t)| t == of).map(|(o, _)| Term::Constant(Name::new(o))).collect();
        }
        args.push(random.pick(&terms).clone());
    }
    Some(Atom { predicate: Name::new(name), args })
}

fn quantified(random: &mut Random, scope: &Scope) -> (Vec<TypedName>, Scope) {
    let of = if random.chance(50) { "a" } else { "b" };
    let name = format!("v{}", scope.len());
    let mut inner = scope.clone();
    inner.push((name.clone(), of));
    (vec![TypedName::new(name, of)], inner)
}

fn condition(random: &mut Random, scope: &Scope, depth: usize, derived: bool) -> Condition {
    let all: &[usize] = if derived { &[0, 1, 2, 3, 4, 5, 6] } else { &[0, 1, 2, 3, 4, 5] };
    let kind = if depth == 0 { random.below(40) } else { random.below(100) };
    let parts = |random: &mut Random| {
        (0..1 + random.below(3)).map(|_| condition(random, scope, depth.saturating_sub(1), derived)).collect()
    };
    match kind {
        0..30 => Condition::Atom(atom(random, scope, all).expect("a scope")),
        // Derived predicates are not negated: the plain executor does not stratify.
        30..40 => Condition::Not(Box::new(Condition::Atom(
            atom(random, scope, &[0, 1, 2, 3, 4, 5]).expect("a scope"),
        ))),
        40..55 => Condition::And(parts(random)),
        55..68 => Condition::Or(parts(random)),
        68..76 => Condition::Not(Box::new(condition(random, scope, depth - 1, false))),
        76..82 => Condition::Imply(
            Box::new(condition(random, scope, depth - 1, false)),
            Box::new(condition(random, scope, depth - 1, derived)),
        ),
        82..96 => {
            let (variables, inner) = quantified(random, scope);
            let body = Box::new(condition(random, &inner, depth - 1, derived));
            if random.chance(50) {
                Condition::Exists(variables, body)
            } else {
                Condition::Forall(variables, body)
            }
        }
        _ => {
            let terms: Vec<Term> = scope
                .iter()
                .map(|(v, _)| Term::Variable(Name::new(v)))
                .chain(OBJECTS.iter().map(|(o, _)| Term::Constant(Name::new(o))))
                .collect();
            Condition::Equal(random.pick(&terms).clone(), random.pick(&terms).clone())
        }
    }
}

fn effect(random: &mut Random, scope: &Scope, depth: usize) -> Effect {
    match if depth == 0 { random.below(50) } else { random.below(100) } {
        0..28 => Effect::Add(atom(random, scope, &[0, 1, 2, 3]).expect("a scope")),
        28..50 => Effect::Delete(atom(random, scope, &[0, 1, 2, 3]).expect("a scope")),
        50..70 => Effect::And((0..1 + random.below(3)).map(|_| effect(random, scope, depth - 1)).collect()),
        70..85 => {
            let (variables, inner) = quantified(random, scope);
            Effect::Forall(variables, Box::new(effect(random, &inner, depth - 1)))
        }
        _ => Effect::When(condition(random, scope, 2, true), Box::new(effect(random, scope, depth - 1))),
    }
}

pub fn task(seed: u64) -> (Domain, Problem) {
    let mut random = Random(seed);
    let actions = (0..2 + random.below(3))
        .map(|index| {
            let mut scope = Scope::new();
            let mut params = Vec::new();
            for at in 0..random.below(3) {
                let of = if random.chance(50) { "a" } else { "b" };
                scope.push((format!("x{at}"), of));
                params.push(TypedName::new(format!("x{at}"), of));
            }
            let precondition = condition(&mut random, &scope, 3, true);
            Action {
                name: Name::new(format!("act{index}")),
                agent: None,
                params,
                precondition,
                effect: Effect::And(
                    (0..1 + random.below(3)).map(|_| effect(&mut random, &scope, 3)).collect(),
                ),
                duration: None,
            }
        })
        .collect();
    let predicates = PREDICATES
        .iter()
        .map(|(name, types)| Signature {
            name: Name::new(name),
            params: types.iter().enumerate().map(|(at, of)| TypedName::new(format!("x{at}"), *of)).collect(),
            private_to: None,
        })
        .collect();
    let axioms = (0..random.below(3))
        .map(|_| {
            let scope = vec![("x".to_string(), "a")];
            Axiom {
                head: Signature {
                    name: Name::new("d"),
                    params: vec![TypedName::new("x", "a")],
                    private_to: None,
                },
                body: condition(&mut random, &scope, 2, true),
            }
        })
        .filter(|axiom| !negates_derived(&axiom.body, true))
        .collect();
    let mut init = Vec::new();
    for (name, types) in &PREDICATES[..6] {
        let mut rows = vec![Vec::new()];
        for of in *types {
            rows = rows
                .into_iter()
                .flat_map(|row: Vec<&str>| {
                    OBJECTS
                        .iter()
                        .filter(|(_, t)| t == of)
                        .map(move |(o, _)| [row.clone(), vec![*o]].concat())
                })
                .collect();
        }
        let chosen = rows.into_iter().filter(|_| random.chance(35)).collect::<Vec<_>>();
        init.extend(chosen.into_iter().map(|row| Init::Fact(GroundAtom::new(*name, row))));
    }
    let goal = Condition::And(
        (0..1 + random.below(3)).map(|_| condition(&mut random, &Scope::new(), 3, true)).collect(),
    );
    let domain = Domain {
        name: Name::new("random"),
        requirements: Vec::new(),
        types: vec![TypedName::new("a", "object"), TypedName::new("b", "object")],
        constants: OBJECTS.iter().map(|(o, of)| TypedName::new(*o, *of)).collect(),
        predicates,
        functions: Vec::new(),
        actions,
        axioms,
    };
    let problem = Problem {
        name: Name::new("p"),
        domain: Name::new("random"),
        objects: Vec::new(),
        init,
        goal,
        metric: None,
    };
    (domain, problem)
}

/// Tasks of actions that do one thing each, often under a condition, so that all hangs on single effects: what
/// only takes a condition away from another action's effect is needed as well.
pub fn narrow_task(seed: u64) -> (Domain, Problem) {
    let (mut domain, mut problem) = task(seed);
    let mut random = Random(seed ^ 0x5EED);
    domain.actions = (0..4 + random.below(5))
        .map(|index| {
            let scope = if random.chance(40) { vec![("x0".to_string(), "a")] } else { Scope::new() };
            let mut effects = Vec::new();
            if random.chance(70) {
                effects.push(narrow_effect(&mut random, &scope));
            }
            if random.chance(60) {
                let condition = narrow_condition(&mut random, &scope);
                effects.push(Effect::When(condition, Box::new(narrow_effect(&mut random, &scope))));
            }
            let asks = random.chance(50);
            Action {
                name: Name::new(format!("act{index}")),
                agent: None,
                params: scope.iter().map(|(name, of)| TypedName::new(name.clone(), *of)).collect(),
                precondition: Condition::And(if asks {
                    vec![narrow_condition(&mut random, &scope)]
                } else {
                    Vec::new()
                }),
                effect: Effect::And(effects),
                duration: None,
            }
        })
        .collect();
    problem.goal = Condition::And(
        (0..2 + random.below(2)).map(|_| narrow_condition(&mut random, &Scope::new())).collect(),
    );
    (domain, problem)
}

fn narrow_effect(random: &mut Random, scope: &Scope) -> Effect {
    let atom = atom(random, scope, &[0, 1, 3]).expect("a scope");
    if random.chance(50) { Effect::Add(atom) } else { Effect::Delete(atom) }
}

fn narrow_condition(random: &mut Random, scope: &Scope) -> Condition {
    let atom = Condition::Atom(atom(random, scope, &[0, 1, 3]).expect("a scope"));
    if random.chance(50) { atom } else { Condition::Not(Box::new(atom)) }
}

fn negates_derived(condition: &Condition, positive: bool) -> bool {
    match condition {
        Condition::Atom(atom) => !positive && atom.predicate == "d",
        Condition::And(parts) | Condition::Or(parts) => parts.iter().any(|p| negates_derived(p, positive)),
        Condition::Not(inner) => negates_derived(inner, !positive),
        Condition::Imply(a, b) => negates_derived(a, !positive) || negates_derived(b, positive),
        Condition::Exists(_, inner) | Condition::Forall(_, inner) => negates_derived(inner, positive),
        Condition::Equal(..) | Condition::Compare(..) => false,
    }
}

/// Numeric functions with the types of their parameters; `k` never changes.
const FUNCTIONS: [(&str, &[&str]); 3] = [("n", &[]), ("m", &["a"]), ("k", &["a"])];

/// No number leaves the range from minus this to twice this.
const LARGEST: i64 = 3;

fn function(random: &mut Random, scope: &Scope, choices: &[usize]) -> FunctionTerm {
    let (name, types) = FUNCTIONS[*random.pick(choices)];
    let args = types.iter().map(|of| {
        let mut terms: Vec<Term> =
            scope.iter().filter(|(_, t)| t == of).map(|(v, _)| Term::Variable(Name::new(v))).collect();
        if terms.is_empty() {
            let objects = OBJECTS.iter().filter(|(_, t)| t == of);
            terms = objects.map(|(o, _)| Term::Constant(Name::new(o))).collect();
        }
        random.pick(&terms).clone()
    });
    FunctionTerm { function: Name::new(name), args: args.collect() }
}

fn whole(value: i64) -> NumericExpr {
    NumericExpr::Number(Decimal(value.to_string()))
}

fn number(random: &mut Random, scope: &Scope, depth: usize) -> NumericExpr {
    match if depth == 0 { random.below(70) } else { random.below(100) } {
        0..25 => whole(random.below(5) as i64 - 1),
        25..70 => NumericExpr::Function(function(random, scope, &[0, 1, 2])),
        _ => {
            let op = *random.pick(&[ArithmeticOp::Add, ArithmeticOp::Subtract, ArithmeticOp::Multiply]);
            let parts = (0..2).map(|_| number(random, scope, depth - 1)).collect();
            NumericExpr::Operation(op, parts)
        }
    }
}

fn comparison(random: &mut Random, scope: &Scope) -> Condition {
    const ALL: [Comparison; 5] = [
        Comparison::Less,
        Comparison::LessEqual,
        Comparison::Equal,
        Comparison::GreaterEqual,
        Comparison::Greater,
    ];
    let compared = Condition::Compare(*random.pick(&ALL), number(random, scope, 1), number(random, scope, 1));
    if random.chance(20) { Condition::Not(Box::new(compared)) } else { compared }
}

/// A change of a number that stays small.
fn change(random: &mut Random, scope: &Scope) -> Effect {
    let target = function(random, scope, &[0, 1]);
    let now = NumericExpr::Function(target.clone());
    let below = Condition::Compare(Comparison::Less, now.clone(), whole(LARGEST));
    let above = Condition::Compare(Comparison::Greater, now, whole(-LARGEST));
    let step = NumericExpr::Function(function(random, scope, &[2]));
    let (op, value) = match random.below(6) {
        0 => (AssignOp::Assign, whole(random.below(4) as i64 - 1)),
        1 => (AssignOp::Assign, step),
        2 => (AssignOp::Increase, step),
        3 => (AssignOp::Increase, whole(1)),
        4 => (AssignOp::ScaleUp, whole(-1)),
        _ => (AssignOp::Decrease, whole(2)),
    };
    let small = Condition::And(vec![below, above]);
    Effect::When(small, Box::new(Effect::Assign(op, target, value)))
}

/// A task whose conditions and effects are about numbers, too.
pub fn numeric_task(seed: u64) -> (Domain, Problem) {
    let (mut domain, mut problem) = task(seed);
    let random = &mut Random(!seed);
    domain.functions = FUNCTIONS
        .iter()
        .map(|(name, types)| Signature {
            name: Name::new(name),
            params: types.iter().map(|of| TypedName::new("x", *of)).collect(),
            private_to: None,
        })
        .collect();
    for action in &mut domain.actions {
        let scope: Scope = action
            .params
            .iter()
            .map(|param| (param.name.to_string(), if param.types[0] == "a" { "a" } else { "b" }))
            .collect();
        if random.chance(40) {
            let parts = vec![action.precondition.clone(), comparison(random, &scope)];
            action.precondition = Condition::And(parts);
        }
        // One change a function: several at once have no order.
        if random.chance(80) {
            let change = change(random, &scope);
            let change = if random.chance(30) {
                Effect::When(comparison(random, &scope), Box::new(change))
            } else {
                change
            };
            action.effect = Effect::And(vec![action.effect.clone(), change]);
        }
    }
    for axiom in &mut domain.axioms {
        if random.chance(40) {
            let scope = vec![("x".to_string(), "a")];
            axiom.body = Condition::Or(vec![axiom.body.clone(), comparison(random, &scope)]);
        }
    }
    for (name, args) in
        [("n", None), ("m", Some("a1")), ("m", Some("a2")), ("k", Some("a1")), ("k", Some("a2"))]
    {
        let value = Decimal((random.below(4) as i64 - 1).to_string());
        problem.init.push(Init::Value(GroundAtom::new(name, args), value));
    }
    let wanted = if random.chance(50) {
        comparison(random, &Scope::new())
    } else {
        let scope = vec![("v".to_string(), "a")];
        Condition::Forall(vec![TypedName::new("v", "a")], Box::new(comparison(random, &scope)))
    };
    problem.goal = if random.chance(75) { wanted } else { Condition::And(vec![problem.goal, wanted]) };
    (domain, problem)
}
