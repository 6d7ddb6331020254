//! `--method` and `--without`: which way `lamma bench` takes from an instruction to a plan, and the paper's ablation.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use lamma_coordinator::{Method, Steps};
use lamma_lm::Wording;

use crate::cli::{AllocatorArg, BenchArgs};
use crate::error::Failure;
use crate::spec::RunSpec;

/// Methods that can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodArg {
    /// Sub-tasks by the language model, allocation, and a PDDL planner in every robot.
    LammaP,
    /// Sub-tasks, allocation and steps by the language model; no planner (after SMART-LLM, 2023).
    SmartLlm,
    /// The whole plan by the language model in one answer, thinking step by step.
    Cot,
}

/// A module of LaMMA-P.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Module {
    /// Precondition identifier: what things afford, what holds and what actions need is told to the model.
    Preconditions,
    /// PDDL validator: what the model answers is checked, sent back, and replaced by the embedded default's answer.
    Validator,
    /// Problem generator: each robot's planner gets a PDDL problem.
    Generator,
    /// Decomposition into sub-tasks that may be done side by side.
    Decomposition,
}

use Module::{Decomposition, Generator, Preconditions, Validator};

/// All, in the order of the table.
pub const MODULES: [Module; 4] = [Preconditions, Validator, Generator, Decomposition];

impl Module {
    /// `P`
    pub fn letter(self) -> char {
        match self {
            Preconditions => 'P',
            Validator => 'V',
            Generator => 'G',
            Decomposition => 'D',
        }
    }

    /// Whether leaving it out changes only what a chat model is told and asked for.
    fn needs_a_model(self) -> bool {
        self != Decomposition
    }
}

/// One row of the ablation: the modules that are left out together, such as `P` or `PV`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Without(pub Vec<Module>);

impl FromStr for Without {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let module = |letter: char| MODULES.into_iter().find(|m| m.letter() == letter.to_ascii_uppercase());
        let mut modules = Vec::new();
        for letter in text.trim().chars() {
            modules.push(module(letter).ok_or_else(|| {
                format!(
                    "`{letter}` is no module: P (precondition identifier), V (PDDL validator), G (problem generator), \
                     D (decomposition); P,V is two runs, PV one without both"
                )
            })?);
        }
        modules.sort_unstable();
        modules.dedup();
        if modules.is_empty() { Err("name a module: P, V, G or D".into()) } else { Ok(Without(modules)) }
    }
}

/// A way to run a suite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Which method.
    pub method: MethodArg,
    /// Without what.
    pub without: Vec<Module>,
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.method {
            MethodArg::LammaP => "lamma-p",
            MethodArg::SmartLlm => "smart-llm",
            MethodArg::Cot => "cot",
        })?;
        if !self.without.is_empty() {
            f.write_str("-without-")?;
        }
        self.without.iter().try_for_each(|module| write!(f, "{}", module.letter()))
    }
}

impl Variant {
    /// The ways that the arguments ask for, checked: with `--without` the whole method first.
    pub fn of(args: &BenchArgs) -> Result<Vec<Variant>, Failure> {
        let method = args.method;
        if !args.without.is_empty() && method != MethodArg::LammaP {
            return Err(Failure::bad_input("--without is about the modules of --method lamma-p"));
        }
        let mut variants = vec![Variant { method, without: Vec::new() }];
        for Without(modules) in &args.without {
            let variant = Variant { method, without: modules.clone() };
            if variants.contains(&variant) {
                return Err(Failure::bad_input(format!("--without: {variant} is named twice")));
            }
            variants.push(variant);
        }
        let needs = variants.iter().find(|v| v.needs_a_model());
        if let Some(variant) = needs.filter(|_| args.common.lm == "offline") {
            return Err(Failure::bad_input(format!(
                "{variant} needs a chat model: the embedded default is told nothing, needs no check and writes no plans. \
                 Give --lm openai, record:FILE or replay:FILE (--without D works with any)"
            )));
        }
        if let Some(variant) = needs.filter(|_| args.goals_given) {
            return Err(Failure::bad_input(format!(
                "{variant} is about what a model makes of a sentence: leave --goals-given out"
            )));
        }
        if variants.iter().any(|v| *v != Variant::default()) && args.codmap.is_some() {
            return Err(Failure::bad_input(
                "--method and --without are for household tasks, not for --codmap",
            ));
        }
        Ok(variants)
    }

    fn needs_a_model(&self) -> bool {
        self.method != MethodArg::LammaP || self.without.iter().any(|m| m.needs_a_model())
    }

    /// Whether a module is left out.
    pub fn lacks(&self, module: Module) -> bool {
        self.without.contains(&module)
    }

    /// The run in this way.
    pub fn apply(&self, spec: &mut RunSpec) {
        let lamma_p = self.method == MethodArg::LammaP;
        spec.method = Method {
            divide: !self.lacks(Decomposition),
            steps: match self.method {
                MethodArg::LammaP if self.lacks(Generator) => Steps::WrittenForAllocation,
                MethodArg::LammaP => Steps::Planned,
                MethodArg::SmartLlm => Steps::WrittenForAdvice,
                MethodArg::Cot => Steps::Written,
            },
            checked: lamma_p && !self.lacks(Validator),
        };
        if self.method == MethodArg::SmartLlm {
            spec.allocator = AllocatorArg::Lm;
        }
        // The methods to compare with have none of these modules, but they are told the scene.
        spec.lm.wording =
            Wording { bare: self.lacks(Preconditions), allocate: self.method == MethodArg::SmartLlm };
        spec.lm.unchecked = self.lacks(Validator);
        spec.lm.alone = self.lacks(Validator) || !lamma_p;
    }
}

impl Default for Variant {
    fn default() -> Self {
        Variant { method: MethodArg::LammaP, without: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_read_by_their_letters() {
        assert_eq!("vP".parse(), Ok(Without(vec![Preconditions, Validator])));
        for wrong in ["", "X", "P V"] {
            assert!(wrong.parse::<Without>().is_err(), "{wrong}");
        }
        let variant = Variant { method: MethodArg::LammaP, without: vec![Preconditions, Validator] };
        assert_eq!(variant.to_string(), "lamma-p-without-PV");
    }
}
