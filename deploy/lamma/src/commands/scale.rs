//! `lamma scale`: teams of growing size, a table and a plot.

use std::time::Duration;

use serde_json::json;

use crate::cli::{BusArg, Format, ScaleArgs};
use crate::error::Failure;
use crate::exit;
use crate::out::say;
use crate::scale::{Level, Sizes, run, svg};
use crate::supervise::RunDir;

/// Meetings shared among the robots of a team: small teams meet often, large ones cost more each time.
const MEETINGS: u32 = 2000;

const HEADER: &str = "robots  procs  start s  plan s   act s  private KiB/robot   barrier us    (p99)  actions/s  total s   cpu s  left";

/// Measures each size, prints the table and writes the plot; 0 if all came to their end and left nothing.
pub fn scale(args: &ScaleArgs) -> Result<u8, Failure> {
    match args.bus {
        BusArg::Inproc => {
            return Err(Failure::bad_input("a team of processes needs --bus iceoryx2 or zenoh"));
        }
        BusArg::Zenoh if args.workers.is_some() => {
            return Err(Failure::bad_input(
                "--workers is for --bus iceoryx2: over zenoh each robot is a process",
            ));
        }
        BusArg::Zenoh | BusArg::Iceoryx2 => {}
    }
    let folder = RunDir::create(args.run_dir.as_deref()).map_err(Failure::bad_input)?;
    if args.format == Format::Text {
        say(HEADER);
    }
    let mut levels: Vec<Level> = Vec::new();
    for &agents in &args.agents {
        let sizes = Sizes {
            bus: args.bus,
            agents,
            workers: args.workers,
            rounds: args.rounds.unwrap_or((MEETINGS / u32::from(agents)).clamp(20, 200)),
            seed: args.seed,
            // Bounded by the parser of the option.
            limit: Duration::from_secs_f64(args.time_limit),
        };
        let folder = folder.path().join(format!("{agents}-robots"));
        let logs = folder.join("logs");
        std::fs::create_dir_all(&logs).map_err(|e| Failure::io("create", &logs, &e))?;
        let level = run(&sizes, &folder)?;
        if args.format == Format::Text {
            say(row(&level));
        }
        levels.push(level);
    }
    let write = std::fs::write(&args.plot, svg(&levels));
    write.map_err(|e| Failure::bad_input(format!("cannot write {}: {e}", args.plot.display())))?;
    let left: usize = levels.iter().map(|l| l.processes_left + l.files_left).sum();
    match args.format {
        Format::Text => {
            say(format_args!("plot in {}; logs in {}", args.plot.display(), folder.path().display()));
        }
        Format::Json => {
            let value = json!({
                "bus": args.bus.name(),
                "seed": args.seed,
                "workers": args.workers,
                "plot": args.plot,
                "run_dir": folder.path(),
                "levels": levels,
            });
            say(serde_json::to_string(&value).map_err(Failure::fault)?);
        }
    }
    Ok(if left == 0 { exit::SUCCESS } else { exit::FAULT })
}

fn row(level: &Level) -> String {
    let left = match (level.processes_left, level.files_left) {
        (0, 0) => "none".to_owned(),
        (processes, files) => format!("{processes} processes, {files} files"),
    };
    format!(
        "{:>6}  {:>5}  {:>7.2}  {:>6.2}  {:>6.2}  {:>8.0} (max {:>5.0})  {:>10.0} {:>8.0}  {:>9.0}  {:>7.2}  {:>6.2}  {left}",
        level.agents,
        level.processes,
        level.start_s,
        level.plan_s,
        level.act_s,
        level.private_kib.p50,
        level.private_kib.max,
        level.barrier_us.p50,
        level.barrier_us.p99,
        level.actions_per_s,
        level.total_s,
        level.cpu_s,
    )
}
