//! stub
#![allow(dead_code, unused_imports, reason = "the commands that use it follow")]
mod supervise;
fn main() {}
