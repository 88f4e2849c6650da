//! The `bowknot-bench` command.

fn main() {}
