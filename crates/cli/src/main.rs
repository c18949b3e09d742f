//! The `barrelstack` command.

fn main() {}
