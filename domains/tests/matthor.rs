//! The released task files: every line is read or reported. Skips where the files are absent.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;

use lamma_domains::matthor::{Import, RobotIds, import};

fn folder(name: &str) -> Option<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name);
    if root.is_dir() {
        return Some(root);
    }
    println!("skipped: {} is not there", root.display());
    None
}

fn read_all(name: &str) -> Option<Vec<(String, Import)>> {
    let root = folder(name)?;
    let robots = RobotIds::from_json(&std::fs::read_to_string(root.join("robots.json")).unwrap()).unwrap();
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(root.join("tasks")).unwrap().map(|f| f.unwrap().path()).collect();
    files.sort();
    let read = |path: &PathBuf| {
        let file = path.file_name().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(path).unwrap();
        (file.clone(), import(&file, &text, name, &robots))
    };
    Some(files.iter().map(read).collect())
}

#[test]
fn every_line_of_mat_thor_is_read_or_reported() {
    let Some(files) = read_all("mat-thor") else { return };
    let mut count = [0; 6];
    for (file, import) in &files {
        for task in &import.tasks {
            println!("{} [{}] {}", task.task.id, task.task.category, task.task.instruction);
            println!("    goal {}", serde_json::to_string(&task.task.goal).unwrap());
            task.repairs.iter().for_each(|r| println!("    repaired: {r}"));
            task.impossible.iter().for_each(|r| println!("    impossible: {r}"));
            task.agreement.reasons.iter().for_each(|r| println!("    disagrees: {r}"));
            count[0] += 1;
            count[1] += usize::from(task.impossible.is_some());
            count[2] += usize::from(task.agreement.agrees);
            count[3] += usize::from(task.impossible.is_none() && task.agreement.agrees);
            count[4] += usize::from(!task.repairs.is_empty());
            if task.impossible.is_none() {
                task.task.world(0).unwrap_or_else(|e| panic!("{}: {e}", task.task.id));
            }
        }
        for unread in &import.unread {
            println!("{file}:{}: not read: {}", unread.line, unread.what);
            count[5] += 1;
        }
    }
    println!("read, impossible, agreeing, agreeing and possible, repaired, not read: {count:?}");
    assert_eq!(count[0] + count[5], 51, "lines of the release of June 2025");
    assert_eq!(count[5], 0, "all of them can be read");
}

#[test]
fn every_line_of_smart_llm_is_read_or_reported() {
    let Some(files) = read_all("smart-llm") else { return };
    let mut read = 0;
    for (file, import) in &files {
        for task in &import.tasks {
            let id = &task.task.id;
            println!("{id} {} {:?} {:?}", task.task.instruction, task.impossible, task.agreement);
        }
        assert!(import.unread.is_empty(), "{file}: {:?}", import.unread);
        read += import.tasks.len();
    }
    assert_eq!(read, 36);
}
