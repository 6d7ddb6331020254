//! The stable codes of findings, and what each means: the text behind `lamma explain CODE`.

macro_rules! codes {
    ($($name:ident = $code:literal : $explanation:literal)*) => {
        $(#[doc = concat!("`", $code, "`: ", $explanation)] pub const $name: &str = $code;)*

        /// Every code with its explanation, in the order of this file.
        pub const ALL: &[(&str, &str)] = &[$(($code, $explanation)),*];
    };
}

codes! {
    TOO_LARGE = "pddl::too-large":
        "The text is longer than 64 MiB or has more than 8 million words and parentheses. Nothing of it was read. \
        Split the problem, or generate fewer facts: static facts that no action mentions can go."
    TOO_DEEP = "pddl::too-deep":
        "Parentheses are nested more than 256 deep. Formulas this deep are written by programs: make them flat, \
        `(and a b c)` instead of `(and a (and b (and c)))`."
    NAME_TOO_LONG = "pddl::name-too-long":
        "A name is longer than 1024 bytes. Usually a space or a parenthesis is missing somewhere in it."
    BAD_CHARACTER = "pddl::bad-character":
        "PDDL names are ASCII letters, digits, `-` and `_`; a variable has a `?` before it, a keyword a `:`. Anything \
        else is allowed in comments only, which run from `;` to the end of the line. Quotation marks and commas have \
        no meaning in PDDL."
    UNCLOSED = "pddl::unclosed-parenthesis":
        "A parenthesis is opened and never closed. The place shown is where the next section begins or the text ends; \
        the missing `)` belongs somewhere between the other place shown and there."
    STRAY = "pddl::stray-parenthesis":
        "A `)` closes nothing. Often the parenthesis before it was one too many, and the sections after it are then \
        outside the `(define ...)`."
    TRAILING = "pddl::trailing-text":
        "There is more text after the end of the `(define ...)`. A file holds one domain or one problem; only comments \
        may follow it."
    WRONG_FILE = "pddl::wrong-file":
        "A domain begins with `(define (domain NAME) ...)` and a problem with `(define (problem NAME) (:domain NAME) ...)`. \
        The text is something else; often the two files were given in the wrong order."
    SYNTAX = "pddl::syntax":
        "Something else was expected here. The message says what; the help shows the form."
    UNKNOWN_SECTION = "pddl::unknown-section":
        "This section is not part of PDDL. A domain has :requirements :types :constants :predicates :functions \
        :action :durative-action :derived; a problem has :domain :objects :init :goal :metric."
    DUPLICATE_SECTION = "pddl::duplicate-section":
        "The section was written twice. Its parts were joined, as if it had been written once; other planners refuse \
        this or take only the last."
    MISSING_SECTION = "pddl::missing-section":
        "A section that is needed is not there: a problem without a goal says nothing to plan for."
    UNSUPPORTED = "pddl::unsupported":
        "This is PDDL, of a part that is not supported: preferences and trajectory constraints (PDDL 3), timed initial \
        literals, continuous effects, object fluents, probabilistic effects, and hierarchical tasks. Everything of \
        PDDL 2.1 without time, axioms, durative actions as whole steps and MA-PDDL is."
    BAD_NUMBER = "pddl::bad-number":
        "A number was expected, such as `3`, `0.5` or `-2`, and it must be finite."
    NEGATIVE_INIT = "pddl::negative-init":
        "What `:init` does not name is false, so `(not ...)` there says nothing. It was ignored."
    DURATION_RANGE = "pddl::duration-range":
        "The duration is a range and the planner's schedules need a number. The lower bound was taken."
    DIGIT_NAME = "pddl::digit-name":
        "PDDL names start with a letter. A name that starts with a digit is understood here, but not everywhere."
    UNKNOWN_REQUIREMENT = "pddl::unknown-requirement":
        "This requirement is not one PDDL knows, so it says nothing. It was ignored."
    UNDECLARED_REQUIREMENT = "pddl::undeclared-requirement":
        "The domain uses a part of PDDL that its `:requirements` do not name. It is understood all the same; other \
        planners and validators may refuse it. Add the requirement."
    UNKNOWN_TYPE = "pddl::unknown-type":
        "The type is not declared in `(:types ...)`. Without a declaration it has no objects. Declare it, or correct \
        the spelling."
    CYCLIC_TYPES = "pddl::cyclic-types":
        "A type is, through its supertypes, a kind of itself. Remove one of the links of the circle."
    UNKNOWN_PREDICATE = "pddl::unknown-predicate":
        "The predicate is not declared in `(:predicates ...)` of the domain. A condition on it could never hold unless an \
        effect or `:init` uses the same undeclared name; most often it is a misspelling or was forgotten. Declare it, \
        with a type for each parameter."
    UNKNOWN_FUNCTION = "pddl::unknown-function":
        "The numeric function is not declared in `(:functions ...)` of the domain."
    UNKNOWN_OBJECT = "pddl::unknown-object":
        "The name is neither an object of the problem nor a constant of the domain. Actions that name an object \
        directly need it among the domain's `(:constants ...)`."
    UNKNOWN_VARIABLE = "pddl::unknown-variable":
        "The variable is neither a parameter nor bound by a surrounding `forall` or `exists`."
    UNKNOWN_ACTION = "pddl::unknown-action":
        "The plan names an action the domain does not have."
    WRONG_ARITY = "pddl::wrong-arity":
        "A predicate, function or action has another number of arguments here than where it is declared."
    WRONG_TYPE = "pddl::wrong-type":
        "An argument is of a type that the declaration does not allow in this place, so no object fits both. Where \
        some objects may fit and others not, it is a warning."
    DUPLICATE = "pddl::duplicate":
        "The same name is declared twice. PDDL does not distinguish upper from lower case, so `Open` and `open` are \
        the same name."
    SHADOWED = "pddl::shadowed-variable":
        "A `forall` or `exists` uses a variable name that already means something here. Inside, the inner one counts. \
        Give it another name if that is not meant."
    DERIVED_EFFECT = "pddl::derived-in-effect":
        "A predicate with a `(:derived ...)` rule follows from the other facts; actions and `:init` cannot set it."
    UNSTRATIFIED = "pddl::unstratified-axioms":
        "A derived predicate depends on its own negation, so there is no order in which the rules can be applied \
        (axioms must be stratified: Thiébaux, Hoffmann & Nebel, \"In defense of PDDL axioms\", 2005)."
    DOMAIN_MISMATCH = "pddl::domain-mismatch":
        "The problem's `(:domain ...)` names another domain than the one given. It is used with the domain given."
    PLAN_SYNTAX = "plan::syntax":
        "A plan has one action a line, `(action argument ...)`, with an optional time before it (`0.000:`) and an \
        optional duration after it (`[1.000]`). Comments run from `;` to the end of the line."
}

/// A paragraph about the findings with this `code`, with or without its `pddl::` in front.
pub fn explain(code: &str) -> Option<&'static str> {
    let short = |full: &str| full.rsplit("::").next().is_some_and(|last| last == code);
    ALL.iter().find(|(known, _)| *known == code || short(known)).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_explained() {
        for (code, text) in ALL {
            assert_eq!(explain(code), Some(*text), "{code} is there twice");
            assert!(text.ends_with('.') && !text.contains("  "), "{code}: {text}");
        }
        let short = explain("unknown-predicate");
        assert!(short.is_some() && short == explain("pddl::unknown-predicate"));
        assert_eq!(explain("pddl::nonsense"), None);
    }
}
