# The chores, by name. Everything here is a plain cargo command.

# What CI runs.
test:
    cargo test --workspace

# What a reviewer runs first.
lint:
    cargo fmt --check
    cargo clippy --workspace --all-targets -- -D warnings
    cargo deny check licenses bans sources

# The README's first command.
demo:
    cargo run --release -- run "Put the tomato and the lettuce in the fridge, then switch off the light" --scene FloorPlan6 --team robot1,robot17,robot24
