//! Every `.pddl` file of the data folder, and of the folder `LAMMA_PDDL_FOLDER` names if it is set, is read or
//! it is said exactly what in it is not PDDL.

use std::path::{Path, PathBuf};

use lamma_pddl::{Report, Source, parse_domain, parse_problem};

/// The folder of other people's files, which is not part of the project.
fn data_folder() -> PathBuf {
    match std::env::var_os("LAMMA_SHARED") {
        Some(folder) => PathBuf::from(folder).join("data"),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
    }
}

fn pddl_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "pddl") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn read(path: &Path) -> Result<Report, Report> {
    let source = Source::read(path).expect("the file was just listed");
    let is_problem = source.text.to_ascii_lowercase().contains("(:domain");
    if is_problem {
        parse_problem(&source).map(|parsed| parsed.warnings)
    } else {
        parse_domain(&source).map(|parsed| parsed.warnings)
    }
}

#[test]
fn every_file_of_the_data_folder_is_read_or_its_fault_is_named() {
    let extra = std::env::var_os("LAMMA_PDDL_FOLDER").map(PathBuf::from);
    let folders: Vec<PathBuf> =
        std::iter::once(data_folder()).chain(extra).filter(|path| path.is_dir()).collect();
    if folders.is_empty() {
        println!("skipped: no data folder at {}", data_folder().display());
        return;
    }
    let (mut files, mut warned) = (0, 0);
    let mut refused = Vec::new();
    for path in folders.iter().flat_map(|folder| pddl_files(folder)) {
        files += 1;
        match read(&path) {
            Ok(warnings) if warnings.is_empty() => {}
            Ok(warnings) => {
                warned += 1;
                println!("{warnings}");
            }
            Err(report) => {
                assert!(report.errors().all(|error| !error.message.is_empty()), "{}", path.display());
                refused.push(report);
            }
        }
    }
    refused.iter().for_each(|report| println!("{report}"));
    println!(
        "{files} files: {} read, {warned} of them with warnings, {} are not PDDL",
        files - refused.len(),
        refused.len()
    );
}
