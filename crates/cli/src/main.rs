//! The `bowknot` command.
fn main() {}
