//! Figures that others have published on MAT-THOR, to stand beside ours.
//!
//! None of them was measured on our suite: each row says on what. What a source does not state is left open.

use std::fmt::Write;

/// SR, RU, GCR, Eff, Exe of one category, where published.
type Figures = [Option<f64>; 5];

/// A published method.
struct Published {
    method: &'static str,
    /// Compound, complex, vague.
    figures: [Figures; 3],
    measured_on: &'static str,
}

/// Only the success rate was published.
const fn sr(value: f64) -> Figures {
    [Some(value), None, None, None, None]
}

const fn all(sr: f64, ru: f64, gcr: f64, eff: f64, exe: f64) -> Figures {
    [Some(sr), Some(ru), Some(gcr), Some(eff), Some(exe)]
}

/// Sources: LaMMA-P's Table I (Zhang et al., ICRA 2025, arXiv 2409.20560) and Kawabe & Takano (ICRA 2026, arXiv
/// 2602.21670).
const PUBLISHED: [Published; 5] = [
    Published {
        method: "CoT (GPT-4o)",
        figures: [sr(0.32), sr(0.0), sr(0.0)],
        measured_on: "70 tasks of MAT-THOR in AI2-THOR, by LaMMA-P's authors",
    },
    Published {
        method: "SMART-LLM (GPT-4o)",
        figures: [sr(0.70), sr(0.20), sr(0.0)],
        measured_on: "70 tasks of MAT-THOR in AI2-THOR, by LaMMA-P's authors",
    },
    Published {
        method: "LaMMA-P (Llama-3.1-8B)",
        figures: [sr(0.45), sr(0.15), sr(0.0)],
        measured_on: "70 tasks of MAT-THOR in AI2-THOR, by its authors",
    },
    Published {
        method: "LaMMA-P (GPT-4o)",
        figures: [
            all(0.93, 0.91, 0.94, 0.90, 1.0),
            all(0.77, 0.87, 0.83, 0.67, 1.0),
            all(0.45, 0.71, 0.48, 0.65, 0.93),
        ],
        measured_on: "70 tasks of MAT-THOR in AI2-THOR, by its authors",
    },
    Published {
        method: "Kawabe & Takano 2026",
        figures: [sr(0.95), sr(0.84), sr(0.60)],
        measured_on: "MAT-THOR in AI2-THOR, by its authors",
    },
];

const CATEGORIES: [&str; 3] = ["compound", "complex", "vague"];

/// The rows as text, each with what it was measured on.
pub fn text() -> String {
    let mut out = String::from("published, not measured on these tasks        SR    RU   GCR   Eff   Exe\n");
    for method in &PUBLISHED {
        for (category, figures) in CATEGORIES.iter().zip(&method.figures) {
            // Writing to a string does not fail.
            let _ = write!(out, "{:24}  {:16}", method.method, category);
            for figure in figures {
                let _ = match figure {
                    Some(value) => write!(out, "  {value:.2}"),
                    None => write!(out, "     -"),
                };
            }
            out.push('\n');
        }
        let _ = writeln!(out, "    measured on {}", method.measured_on);
    }
    out
}
