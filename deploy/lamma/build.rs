//! How the binary is linked.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // A position-independent executable of this size has 47,000 addresses to correct at each start, all over its
    // data: nearly a millisecond, and a planner's whole call takes two.
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        println!("cargo:rustc-link-arg-bin=lamma=-no-pie");
    }
}
