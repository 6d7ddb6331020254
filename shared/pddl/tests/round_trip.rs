//! Parsing what was printed gives the same tree, and printing that the same text.

use lamma_pddl::ast::*;
use lamma_pddl::{Name, Source, parse_condition, parse_domain, parse_ground_atom, parse_problem};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Names that are not words of the language.
fn name() -> impl Strategy<Value = Name> {
    "[a-zA-Z][a-zA-Z0-9_-]{0,6}".prop_map(|text| Name::new(format!("x{text}")))
}

fn types() -> impl Strategy<Value = Vec<Name>> {
    vec(name(), 1..3)
}

/// A typed list as a text can have it: names without a type only at the end.
fn typed_list(private: bool) -> impl Strategy<Value = Vec<TypedName>> {
    let typed = |name, types| TypedName { name, types, private_to: None };
    let block = (vec((name(), types()), 0..4), vec(name(), 0..2)).prop_map(move |(with, without)| {
        let with = with.into_iter().map(move |(name, types)| typed(name, types));
        with.chain(without.into_iter().map(move |name| typed(name, Vec::new()))).collect::<Vec<_>>()
    });
    let block = block.boxed();
    (block.clone(), block, any::<bool>()).prop_map(move |(mut list, mut owned, agent)| {
        if private && let Some(first) = owned.first().map(|object| object.name.clone()) {
            let owner = if agent { Private::Agent(first) } else { Private::Owner };
            // An owner's first name that is also an object elsewhere would be taken for the agent's.
            let distinct = list
                .iter()
                .chain(&owned)
                .map(|object| &object.name)
                .collect::<std::collections::BTreeSet<_>>();
            if agent || distinct.len() == list.len() + owned.len() {
                owned.iter_mut().for_each(|object| object.private_to = Some(owner.clone()));
                list.append(&mut owned);
            }
        }
        list
    })
}

fn variables() -> impl Strategy<Value = Vec<TypedName>> {
    typed_list(false)
}

fn term() -> impl Strategy<Value = Term> {
    prop_oneof![name().prop_map(Term::Constant), name().prop_map(Term::Variable)]
}

fn atom() -> impl Strategy<Value = Atom> {
    (name(), vec(term(), 0..4)).prop_map(|(predicate, args)| Atom { predicate, args })
}

fn ground_atom() -> impl Strategy<Value = GroundAtom> {
    (name(), vec(name(), 0..4)).prop_map(|(predicate, args)| GroundAtom { predicate, args })
}

fn function() -> impl Strategy<Value = FunctionTerm> {
    (name(), vec(term(), 0..3)).prop_map(|(function, args)| FunctionTerm { function, args })
}

fn decimal() -> impl Strategy<Value = Decimal> {
    "-?[0-9]{1,4}(\\.[0-9]{1,3})?(e-?[0-9])?".prop_map(Decimal)
}

fn numeric() -> impl Strategy<Value = NumericExpr> {
    let leaf =
        prop_oneof![decimal().prop_map(NumericExpr::Number), function().prop_map(NumericExpr::Function)];
    leaf.prop_recursive(3, 12, 3, |inner| {
        let op = prop_oneof![
            Just(ArithmeticOp::Add),
            Just(ArithmeticOp::Subtract),
            Just(ArithmeticOp::Multiply),
            Just(ArithmeticOp::Divide)
        ];
        prop_oneof![
            (op, vec(inner.clone(), 2..4)).prop_map(|(op, operands)| NumericExpr::Operation(op, operands)),
            inner.prop_map(|operand| NumericExpr::Operation(ArithmeticOp::Subtract, vec![operand])),
        ]
    })
}

fn condition() -> impl Strategy<Value = Condition> {
    let comparison = prop_oneof![
        Just(Comparison::Less),
        Just(Comparison::LessEqual),
        Just(Comparison::Equal),
        Just(Comparison::GreaterEqual),
        Just(Comparison::Greater)
    ];
    let leaf = prop_oneof![
        4 => atom().prop_map(Condition::Atom),
        1 => (term(), term()).prop_map(|(left, right)| Condition::Equal(left, right)),
        1 => (comparison, numeric(), numeric()).prop_map(|(op, left, right)| Condition::Compare(op, left, right)),
    ];
    leaf.prop_recursive(4, 24, 4, |inner| {
        let boxed = inner.clone().prop_map(Box::new).boxed();
        prop_oneof![
            vec(inner.clone(), 0..4).prop_map(Condition::And),
            vec(inner, 0..4).prop_map(Condition::Or),
            boxed.clone().prop_map(Condition::Not),
            (boxed.clone(), boxed.clone()).prop_map(|(if_, then)| Condition::Imply(if_, then)),
            (variables(), boxed.clone()).prop_map(|(params, body)| Condition::Exists(params, body)),
            (variables(), boxed).prop_map(|(params, body)| Condition::Forall(params, body)),
        ]
    })
}

fn effect() -> impl Strategy<Value = Effect> {
    let op = prop_oneof![
        Just(AssignOp::Assign),
        Just(AssignOp::Increase),
        Just(AssignOp::Decrease),
        Just(AssignOp::ScaleUp),
        Just(AssignOp::ScaleDown)
    ];
    let leaf = prop_oneof![
        2 => atom().prop_map(Effect::Add),
        2 => atom().prop_map(Effect::Delete),
        1 => (op, function(), numeric()).prop_map(|(op, function, value)| Effect::Assign(op, function, value)),
    ];
    leaf.prop_recursive(3, 16, 4, |inner| {
        prop_oneof![
            vec(inner.clone(), 0..4).prop_map(Effect::And),
            (variables(), inner.clone()).prop_map(|(params, body)| Effect::Forall(params, Box::new(body))),
            (condition(), inner).prop_map(|(condition, body)| Effect::When(condition, Box::new(body))),
        ]
    })
}

fn action() -> impl Strategy<Value = Action> {
    let agent = option::of((name(), types(), any::<bool>()));
    (name(), agent, variables(), condition(), effect(), option::of(numeric())).prop_map(
        |(name, agent, mut params, precondition, effect, duration)| {
            let agent = agent.map(|(name, types, first)| {
                let agent = TypedName { name, types, private_to: None };
                params.retain(|param| param.name != agent.name);
                // The agent is the first parameter, or stands among the others.
                params.insert(
                    if first { 0 } else { params.iter().filter(|p| !p.types.is_empty()).count() },
                    agent.clone(),
                );
                agent
            });
            Action { name, agent, params, precondition, effect, duration }
        },
    )
}

fn signature() -> impl Strategy<Value = Signature> {
    (name(), variables()).prop_map(|(name, params)| Signature { name, params, private_to: None })
}

fn signatures() -> impl Strategy<Value = Vec<Signature>> {
    let owner = prop_oneof![
        Just(Private::Owner),
        (name(), types()).prop_map(|(name, types)| Private::Variable(Box::new(TypedName {
            name,
            types,
            private_to: None
        }))),
    ];
    (vec(signature(), 0..3), owner, vec(signature(), 0..3)).prop_map(|(mut public, owner, private)| {
        public.extend(private.into_iter().map(|s| Signature { private_to: Some(owner.clone()), ..s }));
        public
    })
}

prop_compose! {
    fn domain()(
        name in name(),
        requirements in vec(name().prop_map(|name| Name::new(format!(":{name}"))), 0..3),
        types in typed_list(false),
        constants in typed_list(true),
        predicates in signatures(),
        functions in signatures(),
        actions in vec(action(), 0..3),
        axioms in vec((signature(), condition()).prop_map(|(head, body)| Axiom { head, body }), 0..2),
    ) -> Domain {
        Domain { name, requirements, types, constants, predicates, functions, actions, axioms }
    }
}

prop_compose! {
    fn problem()(
        name in name(),
        domain in name(),
        objects in typed_list(true),
        init in vec(prop_oneof![
            ground_atom().prop_map(Init::Fact),
            (ground_atom(), decimal()).prop_map(|(function, value)| Init::Value(function, value)),
        ], 0..6),
        goal in condition(),
        metric in option::of((any::<bool>(), numeric())
            .prop_map(|(minimize, expression)| Metric { minimize, expression })),
    ) -> Problem {
        Problem { name, domain, objects, init, goal, metric }
    }
}

/// The same cases in every run; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` ask for others.
fn config(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    let fixed = std::env::var_os("PROPTEST_RNG_SEED").is_none();
    let cases = if std::env::var_os("PROPTEST_CASES").is_none() { cases } else { default.cases };
    let rng_seed = if fixed { RngSeed::Fixed(20_251) } else { default.rng_seed };
    ProptestConfig { cases, rng_seed, failure_persistence: None, ..default }
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn domains(domain in domain()) {
        let text = domain.to_string();
        let read = parse_domain(&Source::new("printed", &text));
        let read = read.map_err(|report| TestCaseError::fail(format!("{text}\n{report}")))?.value;
        prop_assert_eq!(&read, &domain, "{}", text);
        prop_assert_eq!(read.to_string(), text);
    }

    #[test]
    fn problems(problem in problem()) {
        let text = problem.to_string();
        let read = parse_problem(&Source::new("printed", &text));
        let read = read.map_err(|report| TestCaseError::fail(format!("{text}\n{report}")))?.value;
        prop_assert_eq!(&read, &problem, "{}", text);
        prop_assert_eq!(read.to_string(), text);
    }

    #[test]
    fn conditions_and_facts(condition in condition(), fact in ground_atom()) {
        prop_assert_eq!(parse_condition(&condition.to_string()).ok(), Some(condition));
        prop_assert_eq!(parse_ground_atom(&fact.to_string()).ok(), Some(fact));
    }
}

#[test]
fn the_canonical_text_is_pinned() {
    let read = |file: &str| std::fs::read_to_string(format!("{}/corpus/{file}", env!("CARGO_MANIFEST_DIR")));
    let domain = |file: &str| {
        let source = Source::new(file, read(file).expect("part of the project"));
        parse_domain(&source).unwrap_or_else(|report| panic!("{report}")).value.to_string()
    };
    let problem = Source::new("breakfast.pddl", read("breakfast.pddl").expect("part of the project"));
    let problem = parse_problem(&problem).unwrap_or_else(|report| panic!("{report}")).value;
    insta::assert_snapshot!(format!("{}\n{}\n{problem}", domain("kitchen.pddl"), domain("team.pddl")));
}
