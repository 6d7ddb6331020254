//! The table of the ablation, laid out like the paper's second: one row per set of modules, marked by what it has,
//! and the metrics of each category.

use std::fmt::Write;

use crate::method::{MODULES, Variant};
use crate::table::Row;

/// The table: what each row has, then the metrics of every category.
pub fn text(runs: &[(&Variant, Vec<Row>)]) -> String {
    let mut out = String::from("\nablation: x marks the modules that a row has\n");
    let Some((_, first)) = runs.first() else { return out };
    let modules: String = MODULES.iter().map(|m| format!(" {}", m.letter())).collect();
    for (index, row) in first.iter().enumerate() {
        // Writing to a string does not fail.
        let _ = writeln!(out, "{} (n = {})\n {modules}    SR    RU   GCR   Eff   Exe", row.name, row.n);
        for (variant, rows) in runs {
            let marks: String = MODULES.iter().map(|m| if variant.lacks(*m) { " -" } else { " x" }).collect();
            let Some(row) = rows.get(index) else { continue };
            let optional = |v: Option<f64>| v.map_or("   -".to_string(), |v| format!("{v:.2}"));
            let _ = writeln!(
                out,
                " {marks}  {:.2}  {}  {:.2}  {}  {:.2}",
                row.sr,
                optional(row.ru),
                row.gcr,
                optional(row.eff),
                row.exe
            );
        }
    }
    out
}
