//! Prints tasks made up for a scene, in the format of task files.
//!
//! `cargo run -p lamma-domains --example make_tasks -- FloorPlan6 5 1`: the scene, how many, the seed.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let scene = args.next().ok_or("usage: make_tasks SCENE [COUNT [SEED]]")?;
    let count = args.next().map_or(Ok(5), |n| n.parse())?;
    let seed = args.next().map_or(Ok(0), |n| n.parse())?;
    for task in lamma_domains::generate::tasks(&scene, count, seed)? {
        println!("{}", serde_json::to_string(&task)?);
    }
    Ok(())
}
